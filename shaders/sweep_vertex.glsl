// A vertex of the pattern, bent along the trajectory of its instance: the
// formulas of libcore/scene/scene.h. CAP: closes a cross-section. BENT: in a
// cell, with its section bent into a cage (libcore/scene/cell.h).
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
layout(location = 11) in uint shape;
layout(location = 12) in vec4 size_twist;       // size at both ends, twist, mitre

#ifdef DETAILED
layout(location = 14) in float around;
#endif

#ifdef BENT
layout(location = 13) in uint cage;
layout(std430, binding = 0) readonly buffer Cages {
    vec4 corners[];                             // of each 8, around the bottom, then around the top
};
#endif

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec4 depth_axis;
layout(location = 2) uniform float section_scale;
layout(location = 3) uniform float cap_rise;
layout(location = 8) uniform float turn;
layout(location = 9) uniform int least_turn;    // the rule of frames: 0 paper, 1 minimal
layout(location = 10) uniform vec4 middle;      // start.xy, end.xy

out vec3 world_normal;
out float view_depth;
out float along_shape;
flat out uint shape_id;
#ifdef DETAILED
out vec2 shape_uv;
out vec3 shape_color;
#endif

vec3 unit(vec3 v, vec3 otherwise)
{
    float square = dot(v, v);
    return square > 0.0 ? v * inversesqrt(square) : otherwise;
}

vec3 across(vec3 up, vec3 tangent)
{
    vec3 axis = abs(tangent.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return unit(cross(up, tangent), unit(cross(axis, tangent), axis));
}

vec2 turned(vec2 p, float angle)
{
    float c = cos(angle), s = sin(angle);
    return vec2(c * p.x - s * p.y, s * p.x + c * p.y);
}

#ifndef CAP
const int FRAME_STEPS = 8;      // MESO_FRAME_STEPS

vec3 point_at(float v)
{
    float w = 1.0 - v;
    return w * w * w * p0 + 3.0 * w * w * v * p1 + 3.0 * w * v * v * p2 + v * v * v * p3;
}

vec3 derivative_at(float v)
{
    float w = 1.0 - v;
    return 3.0 * (w * w * (p1 - p0) + 2.0 * w * v * (p2 - p1) + v * v * (p3 - p2));
}

vec3 reflected(vec3 a, vec3 axis)
{
    float square = dot(axis, axis);
    return square > 0.0 ? a - 2.0 * dot(axis, a) / square * axis : a;
}

// Double reflections from the start to v, in (0,1).
vec3 least_turned(float v)
{
    vec3 point = p0, tangent = direction0, x = across(up0, direction0);
    for (int i = 1; i <= FRAME_STEPS; i++) {
        float at = min(float(i) / float(FRAME_STEPS), v);
        vec3 next = point_at(at);
        vec3 next_tangent = unit(derivative_at(at), at > 0.5 ? direction1 : direction0);
        vec3 between = next - point;
        vec3 to = reflected(reflected(x, between), next_tangent - reflected(tangent, between));
        x = unit(to - dot(to, next_tangent) * next_tangent, x);
        if (at == v)
            break;
        point = next;
        tangent = next_tangent;
    }
    return x;
}

float length_to(float v)
{
    return v / 18.0 * (5.0 * length(derivative_at(0.11270167 * v)) + 8.0 * length(derivative_at(0.5 * v))
                       + 5.0 * length(derivative_at(0.88729833 * v)));
}

vec3 turn_to(vec3 from, vec3 to, float part)
{
    float sine = length(cross(from, to)), angle = atan(sine, dot(from, to));
    if (!(sine > 1e-4))
        return unit(mix(from, to, part), from);
    return unit(sin((1.0 - part) * angle) * from + sin(part * angle) * to, from);
}

// E of the mitre.
vec3 even_direction(float v)
{
    float whole = length_to(1.0), t = whole > 0.0 ? length_to(v) / whole : v;
    if (dot(direction0, direction1) > -0.5)
        return turn_to(direction0, direction1, t);
    vec3 way = unit(p3 - p0, direction0);
    return t < 0.5 ? turn_to(direction0, way, 2.0 * t) : turn_to(way, direction1, 2.0 * t - 1.0);
}

// The plane of a ring, by its tangent and X.
void plane_at(float v, out vec3 tangent, out vec3 x)
{
    bool inside = v > 0.0 && v < 1.0;
    vec3 direction = v > 0.5 ? direction1 : direction0;
    float mitre = size_twist.w;
    tangent = inside ? unit(derivative_at(v), direction) : direction;
    if (inside && mitre > 0.0)
        tangent = unit(mix(tangent, even_direction(v), mitre), tangent);
    if (least_turn == 0 || !inside) {
        x = across(mix(up0, up1, v), tangent);
        return;
    }
    x = least_turned(v);
    if (mitre > 0.0)
        x = unit(x - dot(x, tangent) * tangent, x);
}

// The normal of a mitred sweep at s of the section, of which n is the normal in its plane, and slope what it changes.
vec3 mitred_normal(float v, vec2 s, vec3 n, float slope, vec3 tangent)
{
    const float step = 1.0 / 128.0;
    float low = max(v - step, 0.0), high = min(v + step, 1.0);
    vec3 tangents[2], x[2], derivative = derivative_at(v);
    plane_at(low, tangents[0], x[0]);
    plane_at(high, tangents[1], x[1]);
    vec3 dx = (x[1] - x[0]) / (high - low), dy = (cross(tangents[1], x[1]) - cross(tangents[0], x[0])) / (high - low);
    vec3 way = derivative + section_scale * (s.x * dx + s.y * dy);
    float forwards = dot(way, tangent), least = 0.05 * length(derivative);
    float tilt = forwards < least ? max(forwards, 0.0) / least : 1.0;
    float change = dot(derivative, n) + section_scale * 6.0 * v * (1.0 - v) * slope;
    return max(forwards, least) * n - tilt * change * tangent;
}
#endif

#ifdef BENT
void bend(inout vec3 p, inout vec3 n)
{
    vec3 low[4], rise[4], c[4];
    for (uint i = 0; i < 4; i++) {
        low[i] = corners[8 * cage + i].xyz;
        rise[i] = 2.0 * (corners[8 * cage + 4 + i].xyz - low[i]);       // over a height of 1/2
        c[i] = low[i] + p.z * rise[i];
    }
    vec3 dx = mix(c[0] - c[3], c[1] - c[2], p.y), dy = mix(c[2] - c[3], c[1] - c[0], p.x);
    vec3 dz = mix(mix(rise[3], rise[0], p.x), mix(rise[2], rise[1], p.x), p.y);
    n = n.x * cross(dy, dz) + n.y * cross(dz, dx) + n.z * cross(dx, dy);
    p = mix(mix(c[3], c[0], p.x), mix(c[2], c[1], p.x), p.y);
}
#endif

void main()
{
    float v = along;
#ifdef CAP
    vec3 tangent = direction0, up = up0;
    vec3 origin = p0 + section_scale * cap_rise * size_twist.x * v * tangent;
    vec2 start = size_twist.x * profile.xy;
    vec2 s = (1.0 - v * v * v * v) * start;
    vec2 n = cap_rise * size_twist.x * profile_normal.xy;
    float lean = 4.0 * v * v * v * dot(start, profile_normal.xy);
    vec3 x = across(up, tangent);
#else
    bool inside = v > 0.0 && v < 1.0;
    float w = 1.0 - v, blend = v * v * (3.0 - 2.0 * v), twist = size_twist.z;
    vec3 origin = point_at(v), tangent, x;
    plane_at(v, tangent, x);
    vec2 start = size_twist.x * profile.xy, end = size_twist.y * profile.zw;
    vec2 start_normal = size_twist.x * profile_normal.xy, end_normal = size_twist.y * profile_normal.zw;
    vec2 s = mix(start, end, blend), n = mix(start_normal, end_normal, blend);
    float slope = dot(end - start, n);
    if (inside && (turn != 0.0 || twist != 0.0)) {
        vec2 middle0 = size_twist.x * middle.xy, middle1 = size_twist.y * middle.zw;
        vec2 q0 = start - middle0, q1 = turned(end - middle1, -turn);
        vec2 q = turned(mix(q0, q1, blend), turn * blend);
        n = turned(mix(start_normal, turned(end_normal, -turn), blend), turn * blend);
        s = mix(middle0, middle1, blend) + q;
        slope = dot(middle1 - middle0 + turned(q1 - q0, turn * blend), n) + turn * (q.x * n.y - q.y * n.x)
            + twist * (s.x * n.y - s.y * n.x);
        s = turned(s, twist * blend);
        n = turned(n, twist * blend);
    }
    float speed = length(derivative_at(v));
    float lean = speed > 0.0 ? -section_scale * 6.0 * v * w * slope / speed : 0.0;
#endif
    vec3 y = cross(tangent, x);
    vec3 position = origin + section_scale * (s.x * x + s.y * y);
    vec3 normal = n.x * x + n.y * y + lean * tangent;
#ifndef CAP
    if (inside && size_twist.w > 0.0)
        normal = mitred_normal(v, s, n.x * x + n.y * y, slope, tangent);
#endif
#ifdef BENT
    bend(position, normal);
#endif
    world_normal = unit(normal, x);
    gl_Position = clip_from_world * vec4(position, 1.0);
    view_depth = dot(depth_axis, vec4(position, 1.0));
    along_shape = v;
    shape_id = shape;
#ifdef DETAILED
    shape_uv = vec2(around, v);
    shape_color = vec3(1);
#endif
}
