// A vertex of the pattern, bent along the trajectory of its instance: the
// formulas of libcore/shell/structure.h. CAP: closes a cross-section.
layout(location = 0) in vec4 profile;           // start.xy, end.xy
layout(location = 1) in vec4 profile_normal;
layout(location = 2) in float along;
layout(location = 3) in vec3 p0;
layout(location = 4) in vec3 p1;
layout(location = 5) in vec3 p2;
layout(location = 6) in vec3 p3;
layout(location = 7) in vec3 up0;
layout(location = 8) in vec3 up1;
layout(location = 9) in uint slot;

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec4 depth_axis;
layout(location = 2) uniform float section_scale;
layout(location = 3) uniform float cap_rise;

out vec3 world_normal;
out float view_depth;
out float material_blend;
flat out uint slot_id;

vec3 unit(vec3 v, vec3 otherwise)
{
    float square = dot(v, v);
    return square > 0.0 ? v * inversesqrt(square) : otherwise;
}

void main()
{
    float v = along;
#ifdef CAP
    vec3 tangent = unit(p1 - p0, vec3(0, 0, 1));
    vec3 x = unit(cross(up0, tangent), vec3(1, 0, 0));
    vec3 y = cross(tangent, x);
    float t = 2.0 * v - v * v;
    float root = sqrt(max(t, 0.0));
    vec2 s = profile.xy, n = profile_normal.xy;
    vec3 position = p0 + section_scale * ((1.0 - t * t) * (s.x * x + s.y * y) + cap_rise * root * tangent);
    // Perpendicular to d/dt ((1 - t t) s, rise sqrt t), times sqrt t.
    world_normal = unit(0.5 * cap_rise * (n.x * x + n.y * y) + 2.0 * t * root * dot(s, n) * tangent, tangent);
    material_blend = 0.0;
#else
    float w = 1.0 - v;
    vec3 axis = w * w * w * p0 + 3.0 * w * w * v * p1 + 3.0 * w * v * v * p2 + v * v * v * p3;
    vec3 derivative = w * w * (p1 - p0) + 2.0 * w * v * (p2 - p1) + v * v * (p3 - p2);
    vec3 tangent = unit(derivative, unit(p3 - p0, vec3(0, 0, 1)));
    vec3 x = unit(cross(mix(up0, up1, v), tangent), vec3(1, 0, 0));
    vec3 y = cross(tangent, x);
    float blend = v * v * (3.0 - 2.0 * v);
    vec2 s = mix(profile.xy, profile.zw, blend);
    vec2 n = mix(profile_normal.xy, profile_normal.zw, blend);
    vec3 position = axis + section_scale * (s.x * x + s.y * y);
    world_normal = unit(n.x * x + n.y * y, tangent);
    material_blend = v;
#endif
    gl_Position = clip_from_world * vec4(position, 1.0);
    view_depth = dot(depth_axis, vec4(position, 1.0));
    slot_id = slot;
}
