// A vertex that the processors have placed, of a body or a sweep.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint shape;
layout(location = 4) in vec2 uv;
#ifdef DETAILED
layout(location = 3) in vec3 color;
#endif

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec4 depth_axis;

out vec3 world_normal;
out float view_depth;
out float along_shape;
flat out uint shape_id;
#ifdef DETAILED
out vec2 shape_uv;
out vec3 shape_color;
#endif

void main()
{
    gl_Position = clip_from_world * vec4(position, 1.0);
    world_normal = normal;
    view_depth = dot(depth_axis, vec4(position, 1.0));
    along_shape = uv.y;
    shape_id = shape;
#ifdef DETAILED
    shape_uv = uv;
    shape_color = color;
#endif
}
