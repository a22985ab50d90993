#include "libcore/growth/engine/growth_above.h"

#include "libcore/growth/engine/growth_seat.h"

/* Points in rows of four, and triangles beside the ends' that are looked at. */
enum { ROWS = 3, POINTS = 4 * ROWS, MOST_HOPS = 6 };

/* Of a triangle's size: points on sides may be rounded to either. */
static const float on_side = 1e-6f;

typedef struct Row {
    MesoFour x, y, z;
} Row;

/* Points of a curve that lie over no triangle yet, and how deep the others are at most. */
typedef struct Points {
    Row rows[ROWS];
    MesoFourBits open[ROWS];
    MesoFour deepest;
} Points;

/* A triangle's plane, and over it the weights of its second and third corner, as they grow from the first. */
typedef struct Flat {
    MesoFour origin, normal, second, third;
} Flat;

static MesoFour dot_row(const Row *row, const MesoFour *origin, const MesoFour *by)
{
    MesoFour x = row->x - meso_four_all((*origin)[0]), y = row->y - meso_four_all((*origin)[1]);
    MesoFour z = row->z - meso_four_all((*origin)[2]);
    return x * meso_four_all((*by)[0]) + y * meso_four_all((*by)[1]) + z * meso_four_all((*by)[2]);
}

/* Lanes of points that lie over a triangle, and their heights there. */
static MesoFourBits over_flat(const Row *row, const Flat *flat, MesoFour *height)
{
    MesoFour second = dot_row(row, &flat->origin, &flat->second), least = meso_four_all(-on_side);
    MesoFour third = dot_row(row, &flat->origin, &flat->third);
    *height = dot_row(row, &flat->origin, &flat->normal);
    return (second >= least) & (third >= least) & (meso_four_all(1) - second - third >= least);
}

static bool all_set(MesoFourBits bits)
{
    MesoFourWords words = (MesoFourWords)bits;
    return (words[0] & words[1]) == UINT64_MAX;
}

/* Whether all control points of a curve, and so all of the curve, are over a triangle, and above a depth. */
static bool is_over(const Flat *flat, const MesoFour p[4], float depth)
{
    const Row row = {{p[0][0], p[1][0], p[2][0], p[3][0]},
                     {p[0][1], p[1][1], p[2][1], p[3][1]},
                     {p[0][2], p[1][2], p[2][2], p[3][2]}};
    MesoFour height;
    MesoFourBits over = over_flat(&row, flat, &height);
    return all_set(over & (height >= meso_four_all(-depth)));
}

static void set_points(Points *points, const MesoFour p[4])
{
    for (uint32_t i = 0; i < ROWS; i++) {
        MesoFour t = (meso_four_all(4.0f * (float)i) + (MesoFour){1, 2, 3, 4}) * meso_four_all(1.0f / POINTS);
        MesoFour r = meso_four_all(1) - t, three = meso_four_all(3);
        MesoFour weight[4] = {r * r * r, three * r * r * t, three * r * t * t, t * t * t};
        MesoFour at[3];
        for (uint32_t k = 0; k < 3; k++)
            at[k] = weight[0] * meso_four_all(p[0][k]) + weight[1] * meso_four_all(p[1][k]) +
                    weight[2] * meso_four_all(p[2][k]) + weight[3] * meso_four_all(p[3][k]);
        points->rows[i] = (Row){at[0], at[1], at[2]};
        points->open[i] = (MesoFourBits){-1, -1, -1, -1};
    }
    points->deepest = meso_four_all(0);
}

/* False where a triangle has no area, or a corner's normal is against it. */
static bool set_flat(Flat *flat, const MesoGrowthGround *ground, uint32_t triangle)
{
    const uint32_t *c = &ground->mesh->corners[3 * (size_t)triangle];
    const MesoVec3 *positions = ground->mesh->positions;
    MesoFour a = meso_four_of(positions[c[0]]);
    MesoFour along = meso_four_of(positions[c[1]]) - a, over = meso_four_of(positions[c[2]]) - a;
    MesoFour normal = meso_four_cross(along, over);
    float square = meso_four_dot(normal, normal), inverse = square > 0 ? 1 / square : 0;
    bool agrees = square > 0;
    for (uint32_t k = 0; k < 3; k++)
        agrees &= meso_four_dot(normal, meso_four_of(ground->normals[c[k]])) > 0;
    *flat = (Flat){a, meso_four_scale(normal, sqrtf(inverse)),
                   meso_four_scale(meso_four_cross(over, normal), inverse),
                   meso_four_scale(meso_four_cross(normal, along), inverse)};
    return agrees;
}

/* Of the open points those that lie over a triangle are closed. */
static void cover(Points *points, const Flat *flat)
{
    for (uint32_t i = 0; i < ROWS; i++) {
        MesoFour height;
        MesoFourBits over = over_flat(&points->rows[i], flat, &height);
        MesoFour depth = meso_four_choose(over & points->open[i], -height, meso_four_all(0));
        points->deepest = meso_four_choose(depth > points->deepest, depth, points->deepest);
        points->open[i] &= ~over;
    }
}

static bool any_open(const Points *points)
{
    MesoFourWords all = (MesoFourWords)(points->open[0] | points->open[1] | points->open[2]);
    return (all[0] | all[1]) != 0;
}

/* The triangle across the side that the first open point lies farthest beyond. */
static uint32_t towards_open(const Points *points, const MesoGrowthGround *ground, uint32_t triangle, const Flat *flat)
{
    uint32_t at = 0, least = 0;
    while (at + 1 < POINTS && !points->open[at / 4][at % 4])
        at++;
    float second = dot_row(&points->rows[at / 4], &flat->origin, &flat->second)[at % 4];
    float third = dot_row(&points->rows[at / 4], &flat->origin, &flat->third)[at % 4];
    const float weight[3] = {1 - second - third, second, third};
    for (uint32_t k = 1; k < 3; k++)
        least = weight[k] < weight[least] ? k : least;
    uint32_t twin = ground->walk.faces[triangle].twins[meso_next_side(least)];
    return twin == MESO_NO_INDEX ? MESO_NO_INDEX : twin / 3;
}

/* By the triangles at both ends, and those beside them. */
static bool points_are_above(const MesoGrowthGround *ground, const MesoFour p[4], Flat *flat, const uint32_t ends[2],
                             float depth)
{
    uint32_t triangle = ends[0];
    Points points;
    set_points(&points, p);
    cover(&points, flat);
    for (uint32_t i = 0; i < MOST_HOPS && any_open(&points); i++) {
        triangle = i == 0 && ends[1] != ends[0] ? ends[1] : towards_open(&points, ground, triangle, flat);
        if (triangle == MESO_NO_INDEX || !set_flat(flat, ground, triangle))
            return false;
        cover(&points, flat);
    }
    MesoFour d = points.deepest;
    return !any_open(&points) && fmaxf(fmaxf(d[0], d[1]), fmaxf(d[2], d[3])) <= depth;
}

bool meso_growth_is_above(const MesoGrown *grown, const MesoGrowthGround *ground, const MesoGrowthElement *element,
                          float tolerance)
{
    const MesoJoint *from = &grown->joints[element->span.from], *to = &grown->joints[element->span.to];
    const uint32_t ends[2] = {grown->points[element->span.from].triangle, grown->points[element->span.to].triangle};
    MesoFour p[4];
    Flat flat;
    if (ground->against || meso_vec3_dot(from->normal, to->normal) < 0.9f || !set_flat(&flat, ground, ends[0]))
        return false;
    meso_four_curve(p, meso_four_of(from->position), meso_four_of(from->tangent), meso_four_of(to->position),
                    meso_four_of(to->tangent));
    MesoFour chord = p[3] - p[0];
    float depth = tolerance * sqrtf(meso_four_dot(chord, chord));
    return (ends[0] == ends[1] && is_over(&flat, p, depth)) || points_are_above(ground, p, &flat, ends, depth);
}

void meso_growth_fetch_ends(const MesoGrown *grown, const MesoGrowthGround *ground, const MesoGrowthElement *element)
{
    __builtin_prefetch(&ground->mesh->corners[3 * (size_t)grown->points[element->span.from].triangle]);
    __builtin_prefetch(&ground->mesh->corners[3 * (size_t)grown->points[element->span.to].triangle]);
}

void meso_growth_fetch_corners(const MesoGrown *grown, const MesoGrowthGround *ground,
                               const MesoGrowthElement *element)
{
    for (uint32_t end = 0; end < 2; end++) {
        uint32_t joint = end ? element->span.to : element->span.from;
        const uint32_t *c = &ground->mesh->corners[3 * (size_t)grown->points[joint].triangle];
        for (uint32_t k = 0; k < 3; k++) {
            __builtin_prefetch(&ground->mesh->positions[c[k]]);
            __builtin_prefetch(&ground->normals[c[k]]);
        }
    }
}
