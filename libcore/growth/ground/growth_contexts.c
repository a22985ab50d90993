#include "libcore/growth/ground/growth_contexts.h"

#include "libcore/growth/language/grammar_draw.h"
#include "libcore/math/noise.h"

/* Of a look ahead: where triangles have no area, a walk may get nowhere. */
enum { LOOK_CROSSINGS = 1 << 16 };

double meso_growth_map_at(const MesoGrowthContexts *contexts, uint32_t map, uint32_t triangle, const double weight[3])
{
    return meso_map_value(contexts->ground, &contexts->maps[map], triangle, weight);
}

/* ---- looks along walks ---- */

typedef struct Ahead {
    const MesoGrowthContexts *contexts;
    const MesoGrowthMap *map;
    double sum, length;
} Ahead;

/* Weights of a point of a triangle in its frame; of the first corner where that has no area. */
static void weigh(const MesoComplex corners[3], MesoComplex at, double weight[3])
{
    double ax = corners[1].re - corners[0].re, ay = corners[1].im - corners[0].im;
    double bx = corners[2].re - corners[0].re, by = corners[2].im - corners[0].im;
    double px = at.re - corners[0].re, py = at.im - corners[0].im, area = ax * by - ay * bx;
    weight[1] = area > 0 ? (px * by - py * bx) / area : 0;
    weight[2] = area > 0 ? (ax * py - ay * px) / area : 0;
    weight[0] = 1 - weight[1] - weight[2];
}

static void add_piece(void *context, const MesoWalkPiece *piece)
{
    Ahead *ahead = context;
    MesoComplex corners[3];
    double from[3], to[3];
    double length = hypot(piece->ends[1].re - piece->ends[0].re, piece->ends[1].im - piece->ends[0].im);
    if (!(length > 0))
        return;
    meso_walk_corners(&ahead->contexts->ground->walk, piece->triangle, corners);
    weigh(corners, piece->ends[0], from);
    weigh(corners, piece->ends[1], to);
    ahead->sum += length * meso_map_mean(ahead->contexts->ground, ahead->map, piece->triangle, from, to);
    ahead->length += length;
}

static MesoTip turned_by(const MesoTip *tip, MesoComplex angle)
{
    MesoTip turned = *tip;
    turned.heading = meso_complex_times(tip->heading, angle);
    return turned;
}

static double average_ahead(const MesoGrowthContexts *contexts, const MesoTip *tip, uint32_t map, double distance)
{
    Ahead ahead = {contexts, &contexts->maps[map], 0, 0};
    MesoWalk walk = {.tip = turned_by(tip, (MesoComplex){distance < 0 ? -1 : 1, 0}), .length = fabs(distance)};
    meso_walks(&contexts->ground->walk, &walk, 1, &(MesoWalkOptions){LOOK_CROSSINGS, add_piece, &ahead});
    return ahead.length > 0 ? ahead.sum / ahead.length
                            : meso_growth_map_at(contexts, map, tip->triangle, tip->weight);
}

static double value_beside(const MesoGrowthContexts *contexts, const MesoTip *tip, uint32_t map, double distance)
{
    bool left = (distance >= 0) != tip->turned;
    MesoWalk walk = {.tip = turned_by(tip, (MesoComplex){0, left ? 1 : -1}), .length = fabs(distance)};
    meso_walks(&contexts->ground->walk, &walk, 1, &(MesoWalkOptions){.crossing_limit = LOOK_CROSSINGS});
    return meso_growth_map_at(contexts, map, walk.tip.triangle, walk.tip.weight);
}

/* ---- looks at the place ---- */

static double noise_at(const MesoGrowthContexts *contexts, const MesoTip *tip, double size, double kind)
{
    double at[3];
    meso_tip_position(contexts->ground->mesh, tip, at);
    if (!(fabs(size) > 0))
        return 0;
    uint64_t chosen = (uint64_t)(int64_t)(fabs(kind) < 0x1p52 ? kind : 0);
    MesoVec3 p = {(float)(at[0] / size), (float)(at[1] / size), (float)(at[2] / size)};
    return (double)meso_noise(p, meso_draw_key(contexts->noise, 0, chosen));
}

static double height_at(const MesoGrowthGround *ground, const MesoTip *tip)
{
    double at[3];
    meso_tip_position(ground->mesh, tip, at);
    return at[0] * (double)ground->up.x + at[1] * (double)ground->up.y + at[2] * (double)ground->up.z - ground->bottom;
}

/* From 0 where the surface is level to pi where it hangs over. */
static double slope_at(const MesoGrowthGround *ground, const MesoTip *tip)
{
    MesoVec3 n = meso_growth_normal(ground, tip->triangle, tip->weight, tip->turned);
    return (double)atan2f(meso_vec3_length(meso_vec3_cross(n, ground->up)), meso_vec3_dot(n, ground->up));
}

static double steepness(const MesoGrowthContexts *contexts, const MesoTip *tip, uint32_t map)
{
    MesoComplex g = meso_map_gradient(contexts->ground, &contexts->maps[map], tip->triangle, tip->weight);
    return hypot(g.re, g.im);
}

double meso_growth_answer(const MesoGrowthContexts *contexts, const MesoTip *tip, MesoGrowthLook look, uint32_t map,
                          double a, double b)
{
    const MesoGrowthGround *ground = contexts->ground;
    switch (look) {
    case MESO_LOOK_AHEAD:
    case MESO_LOOK_SIDE:
        if (a != 0 && isfinite(a))
            return look == MESO_LOOK_AHEAD ? average_ahead(contexts, tip, map, a) : value_beside(contexts, tip, map, a);
        /* fall through */
    case MESO_LOOK_MAP: return meso_growth_map_at(contexts, map, tip->triangle, tip->weight);
    case MESO_LOOK_GRADIENT: return steepness(contexts, tip, map);
    case MESO_LOOK_NOISE: return noise_at(contexts, tip, a, b);
    case MESO_LOOK_HEIGHT: return height_at(ground, tip);
    case MESO_LOOK_SLOPE: return slope_at(ground, tip);
    case MESO_LOOK_CURVATURE: return meso_growth_curvature(ground, tip->triangle, tip->weight, tip->turned);
    case MESO_LOOK_CLEAR: return 1;
    case MESO_LOOK_MEETS: return 0;
    }
    return 0;
}

/* ---- fields ---- */

/* Below this share of its length a vector stands on the triangle, but for rounding. */
static const double UPRIGHT_SHARE = 1e-6;

static MesoComplex laid_down(const MesoGrowthGround *ground, uint32_t triangle, double x, double y, double z)
{
    MesoTriangleFrame frame = meso_frame(ground->mesh, triangle);
    MesoComplex in = {frame.x[0] * x + frame.x[1] * y + frame.x[2] * z,
                      frame.y[0] * x + frame.y[1] * y + frame.y[2] * z};
    double square = in.re * in.re + in.im * in.im, all = x * x + y * y + z * z;
    bool stands = !(square > UPRIGHT_SHARE * UPRIGHT_SHARE * all && square < INFINITY);
    return stands ? (MesoComplex){0, 0} : meso_complex_unit(in);
}

static MesoComplex any_direction(uint64_t draw)
{
    double angle = 2 * MESO_PI * meso_draw_share(meso_draw_mix(draw));
    return (MesoComplex){cos(angle), sin(angle)};
}

static MesoComplex unit_or_nothing(MesoComplex a)
{
    return a.re != 0 || a.im != 0 ? meso_complex_unit(a) : a;
}

static MesoComplex direction_of(const MesoGrowthContexts *contexts, const MesoGrowthField *field, const MesoTip *tip,
                                uint64_t draw)
{
    const MesoGrowthGround *ground = contexts->ground;
    const double *v = field->vector;
    double at[3];
    switch (field->kind) {
    case MESO_GROWTH_TOWARDS: return laid_down(ground, tip->triangle, v[0], v[1], v[2]);
    case MESO_GROWTH_TO_POINT:
        meso_tip_position(ground->mesh, tip, at);
        return laid_down(ground, tip->triangle, v[0] - at[0], v[1] - at[1], v[2] - at[2]);
    case MESO_GROWTH_UPHILL:
        return unit_or_nothing(meso_map_gradient(ground, &contexts->maps[field->map], tip->triangle, tip->weight));
    case MESO_GROWTH_GIVEN:
    case MESO_GROWTH_LINE: break;
    case MESO_GROWTH_ANY: return any_direction(draw);
    }
    MesoVec3 given = field->vectors[tip->triangle];
    MesoComplex to = laid_down(ground, tip->triangle, (double)given.x, (double)given.y, (double)given.z);
    bool back = field->kind == MESO_GROWTH_LINE && to.re * tip->heading.re + to.im * tip->heading.im < 0;
    return back ? (MesoComplex){-to.re, -to.im} : to;
}

MesoComplex meso_growth_direction(const MesoGrowthContexts *contexts, uint32_t field, const MesoTip *tip, uint64_t draw)
{
    MesoComplex to = direction_of(contexts, &contexts->fields[field], tip, draw);
    return contexts->fields[field].reversed ? (MesoComplex){-to.re, -to.im} : to;
}

bool meso_growth_face(const MesoGrowthContexts *contexts, uint32_t field, double share, uint64_t draw, MesoTip *tip)
{
    MesoComplex to = meso_growth_direction(contexts, field, tip, draw);
    if (to.re == 0 && to.im == 0)
        return false;
    MesoComplex between = meso_complex_times(to, meso_complex_conjugate(tip->heading));
    double angle = share * atan2(between.im, between.re);
    tip->heading = share == 1 ? to : meso_complex_unit(meso_complex_times(tip->heading,
                                                                          (MesoComplex){cos(angle), sin(angle)}));
    return true;
}
