// A vertex of the pattern, bent along the trajectory of its instance: the
// formulas of libcore/scene/scene.h. CAP: closes a cross-section.
layout(location = 0) in vec4 profile;           // start.xy, end.xy
layout(location = 1) in vec4 profile_normal;
layout(location = 2) in float along;
layout(location = 3) in vec3 p0;
layout(location = 4) in vec3 p1;
layout(location = 5) in vec3 p2;
layout(location = 6) in vec3 p3;
layout(location = 7) in vec3 up0;
layout(location = 8) in vec3 up1;
layout(location = 9) in vec3 direction0;
layout(location = 10) in vec3 direction1;
layout(location = 11) in uint ids;

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec4 depth_axis;
layout(location = 2) uniform float section_scale;
layout(location = 3) uniform float cap_rise;

out vec3 world_normal;
out float view_depth;
out float material_blend;
flat out uint id_row;

vec3 unit(vec3 v, vec3 otherwise)
{
    float square = dot(v, v);
    return square > 0.0 ? v * inversesqrt(square) : otherwise;
}

void main()
{
    float v = along;
#ifdef CAP
    vec3 tangent = direction0, up = up0;
    vec3 origin = p0 + section_scale * cap_rise * v * tangent;
    vec2 s = (1.0 - v * v * v * v) * profile.xy;
    vec2 n = cap_rise * profile_normal.xy;
    float lean = 4.0 * v * v * v * dot(profile.xy, profile_normal.xy);
    material_blend = 0.0;
#else
    float w = 1.0 - v, blend = v * v * (3.0 - 2.0 * v);
    vec3 origin = w * w * w * p0 + 3.0 * w * w * v * p1 + 3.0 * w * v * v * p2 + v * v * v * p3;
    vec3 derivative = 3.0 * (w * w * (p1 - p0) + 2.0 * w * v * (p2 - p1) + v * v * (p3 - p2));
    vec3 direction = v > 0.5 ? direction1 : direction0;
    vec3 tangent = v == 0.0 || v == 1.0 ? direction : unit(derivative, direction);
    vec3 up = mix(up0, up1, v);
    vec2 s = mix(profile.xy, profile.zw, blend);
    vec2 n = mix(profile_normal.xy, profile_normal.zw, blend);
    float speed = length(derivative);
    float lean = speed > 0.0
        ? -section_scale * 6.0 * v * w * dot(profile.zw - profile.xy, n) / speed : 0.0;
    material_blend = v;
#endif
    vec3 axis = abs(tangent.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    vec3 x = unit(cross(up, tangent), unit(cross(axis, tangent), axis));
    vec3 y = cross(tangent, x);
    vec3 position = origin + section_scale * (s.x * x + s.y * y);
    world_normal = unit(n.x * x + n.y * y + lean * tangent, x);
    gl_Position = clip_from_world * vec4(position, 1.0);
    view_depth = dot(depth_axis, vec4(position, 1.0));
    id_row = ids;
}
