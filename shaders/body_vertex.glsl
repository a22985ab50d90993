// A vertex of a body, placed on the CPU. COLORED: with a colour of its own.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint ids;
#ifdef COLORED
layout(location = 3) in vec3 color;
#endif

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec4 depth_axis;

out vec3 world_normal;
out float view_depth;
out float material_blend;
flat out uint id_row;
#ifdef COLORED
out vec3 vertex_color;
#endif

void main()
{
    gl_Position = clip_from_world * vec4(position, 1.0);
    world_normal = normal;
    view_depth = dot(depth_axis, vec4(position, 1.0));
    material_blend = 0.0;
    id_row = ids;
#ifdef COLORED
    vertex_color = color;
#endif
}
