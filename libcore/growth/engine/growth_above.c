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

/* A plane, alike in all lanes. */
typedef struct Plane {
    Row origin, normal, second, third;
} Plane;

MESO_FOUR Row row_of(MesoFour a)
{
    return (Row){meso_four_all(a[0]), meso_four_all(a[1]), meso_four_all(a[2])};
}

MESO_FOUR Plane plane_of(const MesoGrowthFlat *flat)
{
    return (Plane){row_of(flat->origin), row_of(flat->normal), row_of(flat->second), row_of(flat->third)};
}

MESO_FOUR MesoFour dot_row(const Row *row, const Row *origin, const Row *by)
{
    return (row->x - origin->x) * by->x + (row->y - origin->y) * by->y + (row->z - origin->z) * by->z;
}

/* Lanes of points that lie over a triangle, and their heights there. */
MESO_FOUR MesoFourBits over_plane(const Row *row, const Plane *plane, MesoFour *height)
{
    MesoFour second = dot_row(row, &plane->origin, &plane->second), least = meso_four_all(-on_side);
    MesoFour third = dot_row(row, &plane->origin, &plane->third);
    *height = dot_row(row, &plane->origin, &plane->normal);
    return (second >= least) & (third >= least) & (meso_four_all(1) - second - third >= least);
}

static bool all_set(MesoFourBits bits)
{
    MesoFourWords words = (MesoFourWords)bits;
    return (words[0] & words[1]) == UINT64_MAX;
}

/* Whether all control points of a curve, and so all of the curve, are over a triangle, and above a depth. */
static bool is_over(const MesoGrowthFlat *flat, const MesoFour p[4], float depth)
{
    const Row row = {{p[0][0], p[1][0], p[2][0], p[3][0]},
                     {p[0][1], p[1][1], p[2][1], p[3][1]},
                     {p[0][2], p[1][2], p[2][2], p[3][2]}};
    const Plane plane = plane_of(flat);
    MesoFour height;
    MesoFourBits over = over_plane(&row, &plane, &height);
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
static bool is_plain(const MesoGrowthFlat *flat)
{
    return meso_four_mask(flat->normal != meso_four_all(0)) != 0;
}

/* Of the open points those that lie over a triangle are closed. */
static void cover(Points *points, const MesoGrowthFlat *flat)
{
    const Plane plane = plane_of(flat);
    MesoFour deepest = points->deepest;
    for (uint32_t i = 0; i < ROWS; i++) {
        MesoFour height;
        MesoFourBits over = over_plane(&points->rows[i], &plane, &height);
        MesoFour depth = (MesoFour)((MesoFourBits)-height & over & points->open[i]);
        deepest = meso_four_choose(depth > deepest, depth, deepest);
        points->open[i] &= ~over;
    }
    points->deepest = deepest;
}

static bool any_open(const Points *points)
{
    MesoFourWords all = (MesoFourWords)(points->open[0] | points->open[1] | points->open[2]);
    return (all[0] | all[1]) != 0;
}

/* The triangle across the side that the first open point lies farthest beyond. */
static uint32_t towards_open(const Points *points, const MesoGrowthGround *ground, uint32_t triangle,
                             const MesoGrowthFlat *flat)
{
    uint32_t at = 0, least = 0;
    while (at + 1 < POINTS && !points->open[at / 4][at % 4])
        at++;
    const Plane plane = plane_of(flat);
    float second = dot_row(&points->rows[at / 4], &plane.origin, &plane.second)[at % 4];
    float third = dot_row(&points->rows[at / 4], &plane.origin, &plane.third)[at % 4];
    const float weight[3] = {1 - second - third, second, third};
    for (uint32_t k = 1; k < 3; k++)
        least = weight[k] < weight[least] ? k : least;
    uint32_t twin = ground->walk.faces[triangle].twins[meso_next_side(least)];
    return twin == MESO_NO_INDEX ? MESO_NO_INDEX : twin / 3;
}

/* By the triangles at both ends, and those beside them. */
static bool points_are_above(const MesoGrowthGround *ground, const MesoFour p[4], const uint32_t ends[2], float depth)
{
    uint32_t triangle = ends[0];
    Points points;
    set_points(&points, p);
    cover(&points, &ground->flats[triangle]);
    for (uint32_t i = 0; i < MOST_HOPS && any_open(&points); i++) {
        triangle = i == 0 && ends[1] != ends[0] ? ends[1]
                                                : towards_open(&points, ground, triangle, &ground->flats[triangle]);
        if (triangle == MESO_NO_INDEX || !is_plain(&ground->flats[triangle]))
            return false;
        cover(&points, &ground->flats[triangle]);
    }
    MesoFour d = points.deepest;
    return !any_open(&points) && all_set(d <= meso_four_all(depth));
}

bool meso_growth_is_above(const MesoGrown *grown, const MesoGrowthGround *ground, const MesoGrowthElement *element,
                          float tolerance)
{
    const MesoJoint *from = &grown->joints[element->span.from], *to = &grown->joints[element->span.to];
    const uint32_t ends[2] = {grown->points[element->span.from].triangle, grown->points[element->span.to].triangle};
    const MesoGrowthFlat *flat = &ground->flats[ends[0]];
    MesoFour p[4];
    if (ground->against || meso_vec3_dot(from->normal, to->normal) < 0.9f || !is_plain(flat))
        return false;
    meso_four_curve(p, meso_four_of(from->position), meso_four_of(from->tangent), meso_four_of(to->position),
                    meso_four_of(to->tangent));
    MesoFour chord = p[3] - p[0];
    float depth = tolerance * sqrtf(meso_four_dot(chord, chord));
    return (ends[0] == ends[1] && is_over(flat, p, depth)) || points_are_above(ground, p, ends, depth);
}

void meso_growth_fetch_ends(const MesoGrown *grown, const MesoGrowthGround *ground, const MesoGrowthElement *element)
{
    uint32_t first = grown->points[element->span.from].triangle, last = grown->points[element->span.to].triangle;
    __builtin_prefetch(&ground->flats[first]);
    __builtin_prefetch(&ground->flats[last]);
    if (first != last)
        __builtin_prefetch(&ground->walk.faces[last]);
}
