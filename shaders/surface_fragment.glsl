// What the later passes need to know of the nearest surface. The inside of an
// open sweep is seen from behind: its normal is turned to the eye.
in vec3 world_normal;
in float view_depth;
in float material_blend;
flat in uint slot_id;

layout(location = 4) uniform vec4 start_color;      // albedo, roughness
layout(location = 5) uniform vec4 end_color;
layout(location = 6) uniform float start_metallic;
layout(location = 7) uniform float end_metallic;
layout(location = 8) uniform uint tile;

layout(location = 0) out vec4 out_normal;           // and roughness
layout(location = 1) out vec4 out_albedo;           // and metallic
layout(location = 2) out float out_depth;
layout(location = 3) out uvec2 out_ids;             // slot + 1, tile + 1

void main()
{
    float blend = smoothstep(0.0, 1.0, material_blend);
    vec4 color = mix(start_color, end_color, blend);
    float square = dot(world_normal, world_normal);
    vec3 normal = square > 0.0 ? world_normal * inversesqrt(square) : vec3(0, 0, 1);
    out_normal = vec4(gl_FrontFacing ? normal : -normal, color.a);
    out_albedo = vec4(color.rgb, mix(start_metallic, end_metallic, blend));
    out_depth = view_depth;
    out_ids = uvec2(slot_id + 1u, tile + 1u);
}
