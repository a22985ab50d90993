// A vertex of an inner mesh, bent into its slot on the CPU.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint slot;

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec4 depth_axis;

out vec3 world_normal;
out float view_depth;
out float material_blend;
flat out uint slot_id;

void main()
{
    gl_Position = clip_from_world * vec4(position, 1.0);
    world_normal = normal;
    view_depth = dot(depth_axis, vec4(position, 1.0));
    material_blend = 0.0;
    slot_id = slot;
}
