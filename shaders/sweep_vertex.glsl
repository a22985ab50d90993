// A vertex of the pattern, bent along the trajectory of its instance: the
// formulas of libcore/scene/scene.h. CAP: closes a cross-section. BENT: in a
// cell, with its section bent into a cage (libcore/scene/cell.h). CREASED: some
// sweeps have creases.
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
#ifdef CREASED
layout(location = 11) uniform vec4 reach;       // in its first two: how far profiles reach, at the start and at the end
#endif

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

#ifdef CREASED
const float CREASE = 2.0;       // MESO_CREASED
bool creased()
{
    return size_twist.w >= CREASE;
}
#endif

// Up to which part of the length E turns to the way from end to end; 0: it does not.
float way_of(vec3 way)
{
    bool apart = dot(direction0, direction1) <= -0.5;
#ifdef CREASED
    if (creased()) {
        if (!apart && dot(way, direction0) >= 0.0 && dot(way, direction1) >= 0.0)
            return 0.0;
        float start = length(p1 - p0), end = length(p3 - p2);
        return start + end > 0.0 ? clamp(start / (start + end), 0.1, 0.9) : 0.5;
    }
#endif
    return apart ? 0.5 : 0.0;
}

// E of the mitre.
vec3 even_direction(float v)
{
    vec3 way = unit(p3 - p0, direction0);
    float whole = length_to(1.0), t = whole > 0.0 ? length_to(v) / whole : v, part = way_of(way);
    if (part == 0.0)
        return turn_to(direction0, direction1, t);
    return t < part ? turn_to(direction0, way, t / part) : turn_to(way, direction1, (t - part) / (1.0 - part));
}

vec3 ring_tangent(float v)
{
    float m = size_twist.w, u = v;
    if (!(v > 0.0 && v < 1.0))
        return v > 0.5 ? direction1 : direction0;
#ifdef CREASED
    if (creased()) {
        float k = floor(m / CREASE);
        float w = v * v * (3.0 - 2.0 * v);
        m -= CREASE * k;
        u = k < 4.0 ? v + exp2(1.0 - k) * (w - v) : w * w * (3.0 - 2.0 * w);
    }
#endif
    vec3 tangent = unit(derivative_at(u), u > 0.5 ? direction1 : direction0);
    return m > 0.0 ? unit(mix(tangent, even_direction(u), m), tangent) : tangent;
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

#ifdef CREASED
// The same straight from one tangent of a ring to the next.
vec3 least_turned_rings(float v)
{
    vec3 tangent = direction0, x = across(up0, direction0);
    for (int i = 1; i <= FRAME_STEPS; i++) {
        float at = min(float(i) / float(FRAME_STEPS), v);
        vec3 next = ring_tangent(at), to = reflected(x, tangent + next);
        x = unit(to - dot(to, next) * next, x);
        if (at == v)
            break;
        tangent = next;
    }
    return x;
}
#endif

// The plane of a ring, by its tangent and X.
void plane_at(float v, out vec3 tangent, out vec3 x)
{
    bool inside = v > 0.0 && v < 1.0;
    tangent = ring_tangent(v);
#ifdef CREASED
    if (inside && creased()) {
        x = least_turned_rings(v);
        return;
    }
#endif
    if (least_turn == 0 || !inside) {
        x = across(mix(up0, up1, v), tangent);
        return;
    }
    x = least_turned(v);
    if (size_twist.w > 0.0)
        x = unit(x - dot(x, tangent) * tangent, x);
}

// A section at s, of which n is the normal in its plane, and slope what it changes.
struct Section {
    vec2 s, n;
    float slope;
};

// As drawings are blended and turned.
Section section_at(float v)
{
    float blend = v * v * (3.0 - 2.0 * v), twist = size_twist.z;
    vec2 start = size_twist.x * profile.xy, end = size_twist.y * profile.zw;
    vec2 start_normal = size_twist.x * profile_normal.xy, end_normal = size_twist.y * profile_normal.zw;
    vec2 s = mix(start, end, blend), n = mix(start_normal, end_normal, blend);
    float slope = dot(end - start, n);
    if (v > 0.0 && v < 1.0 && (turn != 0.0 || twist != 0.0)) {
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
    return Section(s, n, slope);
}

const float STEP = 1.0 / 128.0;     // to both sides, for differences

#ifdef CREASED
// Keeps of what lies inwards of the bend a part of its length; of the normal, what that makes of it.
void crease(float v, vec3 tangent, vec3 x, inout Section section)
{
    const float from = 0.2, room = 0.55;
    vec3 derivative = derivative_at(v), turning = vec3(0);
    if (!(v > 0.0 && v < 1.0))
        return;
    float low = max(v - STEP, 0.0), high = min(v + STEP, 1.0);
    for (int side = 0; side < 2; side++)
        turning += (side == 0 ? -1.0 : 1.0) * ring_tangent(side == 0 ? low : high);
    float scale = 1.0 / ((high - low) * max(dot(derivative, tangent), 0.01 * length(derivative)));
    vec2 b = scale * vec2(dot(turning, x), dot(turning, cross(tangent, x)));
    float size = max(size_twist.x * reach.x, size_twist.y * reach.y), far = length(b) * section_scale * size;
    float over = (far - from) / room;
    if (!(over > 0.0))
        return;
    b = normalize(b);
    if (!(dot(section.s, b) > 0.0))
        return;
    float kept = (from + room * over / (1.0 + over)) / far, left = max(1.0 - 16.0 * min(v, 1.0 - v), 0.0);
    kept += left * left * (1.0 - kept);
    section.s += (kept - 1.0) * dot(section.s, b) * b;
    section.n = kept * section.n + (1.0 - kept) * dot(section.n, b) * b;
}
#endif

// Rings here, and close by before and behind: the normal of a mitred sweep.
struct Rings {
    vec3 tangent[3], x[3];
    Section section[3];
};

vec3 mitred_normal(float v, Rings rings)
{
    float wide = min(v + STEP, 1.0) - max(v - STEP, 0.0);
    vec3 tangent = rings.tangent[1], y = cross(tangent, rings.x[1]), derivative = derivative_at(v);
    vec2 s = rings.section[1].s, n2 = rings.section[1].n;
    vec3 dx = (rings.x[2] - rings.x[0]) / wide, n = n2.x * rings.x[1] + n2.y * y;
    vec3 dy = (cross(rings.tangent[2], rings.x[2]) - cross(rings.tangent[0], rings.x[0])) / wide;
    float slope = 6.0 * v * (1.0 - v) * rings.section[1].slope;
#ifdef CREASED
    if (creased()) {        // and frames turn about the tangent, but not at the ends
        float spin = min(8.0 * min(v, 1.0 - v), 1.0) * dot(dx, y);
        slope = dot(rings.section[2].s - rings.section[0].s, n2) / wide + spin * (s.x * n2.y - s.y * n2.x);
    }
#endif
    vec3 way = derivative + section_scale * (s.x * dx + s.y * dy);
    float forwards = dot(way, tangent), least = 0.05 * length(derivative);
    float tilt = forwards < least ? max(forwards, 0.0) / least : 1.0;
    float change = dot(derivative, n) + section_scale * slope;
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
    vec3 origin = point_at(v);
    Rings rings;
#ifndef CREASED
    plane_at(v, rings.tangent[1], rings.x[1]);
    rings.section[1] = section_at(v);
#else
    for (int i = 0; i < 3; i++) {       // one body: compilers put all calls in line
        float at = clamp(v + float(i - 1) * STEP, 0.0, 1.0);
        plane_at(at, rings.tangent[i], rings.x[i]);
        rings.section[i] = section_at(at);
        if (creased())
            crease(at, rings.tangent[i], rings.x[i], rings.section[i]);
    }
#endif
    vec3 tangent = rings.tangent[1], x = rings.x[1];
    Section section = rings.section[1];
    vec2 s = section.s, n = section.n;
    float speed = length(derivative_at(v));
    float lean = speed > 0.0 ? -section_scale * 6.0 * v * (1.0 - v) * section.slope / speed : 0.0;
#endif
    vec3 y = cross(tangent, x);
    vec3 position = origin + section_scale * (s.x * x + s.y * y);
    vec3 normal = n.x * x + n.y * y + lean * tangent;
#ifndef CAP
    if (v > 0.0 && v < 1.0 && size_twist.w > 0.0) {
#ifndef CREASED
        plane_at(max(v - STEP, 0.0), rings.tangent[0], rings.x[0]);
        plane_at(min(v + STEP, 1.0), rings.tangent[2], rings.x[2]);
#endif
        normal = mitred_normal(v, rings);
    }
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
