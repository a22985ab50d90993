#include "libcore/replicate/deform/deform.h"

#include <math.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/mesh/polygon_mesh.h"

enum { GRAIN = 4096 };

static const double pi = 3.14159265358979323846;

const char *const meso_deform_names[] = {"stretch", "scale", "twist", "bend", "inflate", NULL};

typedef struct Vector {
    double x, y, z;
} Vector;

static Vector of(MesoVec3 a) { return (Vector){(double)a.x, (double)a.y, (double)a.z}; }
static Vector add(Vector a, double s, Vector b) { return (Vector){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static Vector cross(Vector a, Vector b)
{
    return (Vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static MesoVec3 rounded(Vector a) { return (MesoVec3){(float)a.x, (float)a.y, (float)a.z}; }

double meso_deform_share(const MesoDeformStep *step, double time)
{
    const MesoDeformKey *keys = step->keys;
    uint32_t next = 0;
    if (step->key_count == 0)
        return time < 0 ? 0 : time > 1 ? 1 : time;
    while (next < step->key_count && (double)keys[next].time <= time)
        next++;
    if (next == 0)
        return (double)keys[0].share;
    if (next == step->key_count)
        return (double)keys[next - 1].share;
    double from = (double)keys[next - 1].time, to = (double)keys[next].time;
    double share = (double)keys[next - 1].share;
    return share + (time - from) / (to - from) * ((double)keys[next].share - share);
}

/* ---- what a step does to a point ---- */

/* A step at a time, with its share taken. */
typedef struct Formula {
    MesoDeformKind kind;
    Vector center, axis, up, side;
    double by;              /* factor less 1, radians a unit of length, or length */
    double radius;
} Formula;

static Vector stretched(const Formula *f, Vector p, Vector from)
{
    return add(p, f->by * dot(from, f->axis), f->axis);
}

static Vector twisted(const Formula *f, Vector from)
{
    double along = dot(from, f->axis), angle = f->by * along;
    Vector flat = add(from, -along, f->axis), turned = cross(f->axis, flat);
    Vector q = add(add(f->center, along, f->axis), cos(angle), flat);
    return add(q, sin(angle), turned);
}

/* x runs along the arc, whose middle stays; y goes towards the arc's center. */
static Vector bent(const Formula *f, Vector from)
{
    double x = dot(from, f->axis), y = dot(from, f->up), radius = 1 / f->by, angle = f->by * x;
    /* 1 - cos by the half angle: the arc of a slight bend is nearly flat */
    double half = sin(0.5 * angle);
    Vector q = add(add(f->center, dot(from, f->side), f->side), (radius - y) * sin(angle), f->axis);
    return add(q, 2 * radius * half * half + y * cos(angle), f->up);
}

static Vector inflated(const Formula *f, Vector p, Vector from)
{
    double distance = sqrt(dot(from, from)), d = distance / f->radius, rest = 1 - d * d;
    if (!(d < 1) || distance == 0)
        return p;
    return add(p, f->by * rest * rest / distance, from);
}

static Vector deformed(const Formula *f, Vector p)
{
    Vector from = add(p, -1, f->center);
    switch (f->kind) {
    case MESO_DEFORM_STRETCH:
        return stretched(f, p, from);
    case MESO_DEFORM_SCALE:
        return add(p, f->by, from);
    case MESO_DEFORM_TWIST:
        return twisted(f, from);
    case MESO_DEFORM_BEND:
        return bent(f, from);
    default:
        return inflated(f, p, from);
    }
}

/* ---- a step ---- */

typedef struct Box {
    Vector low, high;
} Box;

static Box box_of(const MesoVec3 *positions, uint32_t count)
{
    Box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t v = 0; v < count; v++) {
        Vector p = of(positions[v]);
        box.low = (Vector){fmin(box.low.x, p.x), fmin(box.low.y, p.y), fmin(box.low.z, p.z)};
        box.high = (Vector){fmax(box.high.x, p.x), fmax(box.high.y, p.y), fmax(box.high.z, p.z)};
    }
    return count ? box : (Box){{0, 0, 0}, {0, 0, 0}};
}

static double extent_along(const MesoVec3 *positions, uint32_t count, Vector axis)
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t v = 0; v < count; v++) {
        double x = dot(of(positions[v]), axis);
        low = fmin(low, x);
        high = fmax(high, x);
    }
    return count ? high - low : 0;
}

static Vector middle(Box box)
{
    return (Vector){0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y), 0.5 * (box.low.z + box.high.z)};
}

/* Angles are spread over the length of what is deformed; something without length is not turned. */
static Formula make_formula(const MesoDeformStep *step, double share, const MesoVec3 *positions, uint32_t count)
{
    Formula f = {.kind = step->kind, .axis = of(step->axis), .up = of(step->up), .radius = (double)step->radius};
    double amount = (double)step->amount;
    f.side = cross(f.axis, f.up);
    f.center = step->centered ? of(step->center) : middle(box_of(positions, count));
    if (step->kind == MESO_DEFORM_STRETCH || step->kind == MESO_DEFORM_SCALE) {
        f.by = share * (amount - 1);
    } else if (step->kind == MESO_DEFORM_INFLATE) {
        f.by = share * amount;
    } else {
        double extent = extent_along(positions, count, f.axis);
        f.by = extent > 0 ? share * amount / extent : 0;
    }
    return f;
}

typedef struct Pass {
    const Formula *formula;
    const MesoVec3 *positions;
    MesoVec3 *out;
} Pass;

static void deform_range(void *context, uint64_t begin, uint64_t end)
{
    const Pass *pass = context;
    for (uint64_t v = begin; v < end; v++)
        pass->out[v] = rounded(deformed(pass->formula, of(pass->positions[v])));
}

static bool is_place(MesoVec3 p)
{
    return fabsf(p.x) <= MESO_COORDINATE_LIMIT && fabsf(p.y) <= MESO_COORDINATE_LIMIT &&
           fabsf(p.z) <= MESO_COORDINATE_LIMIT;
}

static MesoStatus run_step(MesoVec3 *out, const MesoDeformStep *step, double share, uint32_t count,
                           uint32_t thread_count, MesoError *error)
{
    Formula formula = make_formula(step, share, out, count);
    Pass pass = {&formula, out, out};
    if (formula.by == 0)
        return MESO_OK;
    meso_parallel_for(thread_count, count, GRAIN, deform_range, &pass);
    for (uint32_t v = 0; v < count; v++)
        if (!is_place(out[v]))
            return meso_fail(error, MESO_ERR_INPUT, "%s takes vertex %u beyond the largest coordinate, %g",
                             meso_deform_names[step->kind], v + 1, (double)MESO_COORDINATE_LIMIT);
    return MESO_OK;
}

MesoStatus meso_deform(MesoVec3 *out, const MesoVec3 *positions, uint32_t count, const MesoDeformStep *steps,
                       uint32_t step_count, double time, uint32_t thread_count, MesoError *error)
{
    MesoStatus status = MESO_OK;
    if (out != positions && count)
        memcpy(out, positions, count * sizeof *out);
    for (uint32_t i = 0; i < step_count && !status; i++)
        status = run_step(out, &steps[i], meso_deform_share(&steps[i], time), count, thread_count, error);
    return status;
}

/* ---- usual steps ---- */

static MesoVec3 unit_axis(uint32_t axis)
{
    return (MesoVec3){axis == 0 ? 1.0f : 0, axis == 1 ? 1.0f : 0, axis == 2 ? 1.0f : 0};
}

/* Of equal sides the longest is the first, and the shortest the last, so that they differ. */
MesoDeformStep meso_deform_usual(MesoDeformKind kind, const MesoVec3 *positions, uint32_t count)
{
    Box box = box_of(positions, count);
    double sides[] = {box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z};
    uint32_t longest = 0, shortest = 2;
    for (uint32_t i = 1; i < 3; i++) {
        longest = sides[i] > sides[longest] ? i : longest;
        shortest = sides[2 - i] < sides[shortest] ? 2 - i : shortest;
    }
    MesoDeformStep step = {.kind = kind, .axis = unit_axis(longest), .up = unit_axis(shortest)};
    if (kind == MESO_DEFORM_INFLATE) {
        double diagonal = sqrt(sides[0] * sides[0] + sides[1] * sides[1] + sides[2] * sides[2]);
        step.radius = diagonal > 0 ? (float)diagonal : 1;
        step.amount = (float)(0.5 * sides[longest]);
    } else {
        step.amount = kind <= MESO_DEFORM_SCALE ? 2 : (float)pi;
    }
    return step;
}
