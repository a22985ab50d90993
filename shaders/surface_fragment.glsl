// What the later passes need to know of the nearest surface. The inside of an
// open sweep is seen from behind: its normal is turned to the eye.
in vec3 world_normal;
in float view_depth;
in float material_blend;
flat in uint id_row;
#ifdef COLORED
in vec3 vertex_color;
#endif

layout(location = 4) uniform vec4 start_color;      // albedo, roughness
layout(location = 5) uniform vec4 end_color;
layout(location = 6) uniform float start_metallic;
layout(location = 7) uniform float end_metallic;

#ifdef PACKED
// For the antialiased colour alone: the depth is in the depth buffer.
layout(location = 0) out uvec4 out_packed;

vec2 octahedral(vec3 n)
{
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : folded;
}
#else
layout(location = 0) out vec4 out_normal;           // and roughness
layout(location = 1) out vec4 out_albedo;           // and metallic
layout(location = 2) out float out_depth;
layout(location = 3) out uint out_ids;              // row + 1
#endif

void main()
{
    float blend = smoothstep(0.0, 1.0, material_blend);
    vec4 color = mix(start_color, end_color, blend);
#ifdef COLORED
    color.rgb *= vertex_color;
#endif
    float metallic = mix(start_metallic, end_metallic, blend);
    float square = dot(world_normal, world_normal);
    vec3 normal = square > 0.0 ? world_normal * inversesqrt(square) : vec3(0, 0, 1);
    if (!gl_FrontFacing)
        normal = -normal;
#ifdef PACKED
    out_packed = uvec4(packSnorm2x16(octahedral(normal)), packUnorm2x16(color.rg),
                       packUnorm2x16(vec2(color.b, metallic)), floatBitsToUint(color.a));
#else
    out_normal = vec4(normal, color.a);
    out_albedo = vec4(color.rgb, metallic);
    out_depth = view_depth;
    out_ids = id_row + 1u;
#endif
}
