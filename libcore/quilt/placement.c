/* Where the swatch goes: equations 1 to 3 over all shifts and turns. */
#include "libcore/base/random.h"
#include "libcore/quilt/grid_distance.h"
#include "libcore/quilt/quilt_work.h"

/* More points than that tell nothing new. */
#define POINT_LIMIT 1000

/*
 * Points that vote for the placement in which the quilt just goes on; votes that agree, in mean edges of the swatch; and
 * by how much it may match worse than another one, which would have to be deformed to fit.
 */
enum { VOTERS = 64 };
#define AGREE 0.1f
#define WORSE_BUT_EXACT 0.1f

/* How far the middle of what is not done lies from a seed, as a share of how far it is looked for. */
#define BACK_SHARE 0.25f

/* A window that reaches back leaves room for placements. */
#define WINDOW_MOST 0.8f

/* How far from what is not done points are worth something, as a share of the swatch's shorter side. */
#define NEAR_SHARE 0.3f

/* Cells along each side of the grid that knows how far what is not done is. */
enum { GRID = 64 };

typedef struct Nearness {
    MesoVec2 low;
    float cell, reach;
    float distance[GRID * GRID];    /* in cells */
} Nearness;

/* Distances in the plane to the triangles that are not done. */
static void measure_nearness(Nearness *near, const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    const MesoQuiltPlane *plane = &step->plane;
    MesoVec3 size = work->swatch->size;
    float width = plane->high.x - plane->low.x, depth = plane->high.y - plane->low.y;
    near->low = plane->low;
    near->cell = (width > depth ? width : depth) / (GRID - 1);
    near->cell = near->cell > 0 ? near->cell : 1;
    near->reach = NEAR_SHARE * (size.x < size.y ? size.x : size.y) / near->cell;
    for (uint32_t i = 0; i < GRID * GRID; i++)
        near->distance[i] = 2 * GRID;
    for (uint32_t t = 0; t < step->chart.triangle_count; t++) {
        if (work->covers[step->chart.triangles[t]] == MESO_COVER_DONE)
            continue;
        for (size_t k = 0; k < 3; k++) {
            MesoVec2 p = plane->places[step->chart.corners[3 * (size_t)t + k]];
            uint32_t x = (uint32_t)((p.x - near->low.x) / near->cell), y = (uint32_t)((p.y - near->low.y) / near->cell);
            near->distance[y * GRID + x] = 0;
        }
    }
    meso_grid_distance(near->distance, GRID, GRID);
}

/* 1 next to what is not done, 0 far from it. */
static float weight_at(const Nearness *near, MesoVec3 p)
{
    float x = (p.x - near->low.x) / near->cell, y = (p.y - near->low.y) / near->cell;
    if (!(x >= 0 && y >= 0 && x < (float)GRID && y < (float)GRID))
        return 0;
    float weight = 1 - near->distance[(uint32_t)y * GRID + (uint32_t)x] / near->reach;
    return weight > 0 ? weight : 0;
}

static bool is_inside(MesoVec2 half, MesoVec3 p)
{
    return p.x >= -half.x && p.x <= half.x && p.y >= -half.y && p.y <= half.y;
}

static uint32_t whole_begin(const MesoQuiltWork *work, uint32_t whole, uint32_t *count)
{
    const MesoPlacedWhole *placed = &work->composite.wholes[whole];
    const uint32_t *begin = work->swatch->vertex_begin;
    *count = begin[placed->element + 1] - begin[placed->element];
    return placed->vertex_begin;
}

/* Normals of a copy as it lies in the plane: sums of the area vectors around each vertex, at unit length. */
static void whole_normals(MesoVec3 *normals, const MesoVec3 *points, const MesoSwatch *swatch, uint32_t element)
{
    uint32_t first = swatch->vertex_begin[element], count = swatch->vertex_begin[element + 1] - first;
    for (uint32_t i = 0; i < count; i++)
        normals[i] = (MesoVec3){0, 0, 0};
    for (uint32_t t = swatch->triangle_begin[element]; t < swatch->triangle_begin[element + 1]; t++) {
        const uint32_t *corner = &swatch->corners[3 * (size_t)t];
        MesoVec3 a = points[corner[0] - first];
        MesoVec3 area = meso_vec3_cross(meso_vec3_sub(points[corner[1] - first], a),
                                        meso_vec3_sub(points[corner[2] - first], a));
        for (int k = 0; k < 3; k++)
            normals[corner[k] - first] = meso_vec3_add(normals[corner[k] - first], area);
    }
    for (uint32_t i = 0; i < count; i++)
        normals[i] = meso_vec3_unit(normals[i], (MesoVec3){0, 0, 1});
}

/* Points of the old quilt in the window: vertices of strands, and of whole elements, in even shares. */
static MesoStatus collect_points(MesoMatchPoint *points, float *weights, uint32_t *origins, uint32_t *count,
                                 const MesoQuiltStep *step, const MesoQuiltWork *work, MesoVec2 half,
                                 MesoArena *scratch, MesoError *error)
{
    Nearness near;
    measure_nearness(&near, step, work);
    const MesoOldGeometry *old = &step->old;
    uint64_t total = 0, number = 0;
    uint32_t largest = 0;
    for (uint32_t v = 0; v < old->vertex_count; v++)
        total += is_inside(half, old->positions[v]) && weight_at(&near, old->positions[v]) > 0;
    for (uint32_t i = 0; i < old->whole_count; i++) {
        uint32_t size;
        whole_begin(work, old->wholes[i], &size);
        total += is_inside(half, old->centres[i]) && weight_at(&near, old->centres[i]) > 0 ? size : 0;
        largest = size > largest ? size : largest;
    }
    uint64_t stride = total / POINT_LIMIT + 1;
    *count = 0;
    for (uint32_t v = 0; v < old->vertex_count; v++)
        if (is_inside(half, old->positions[v]) && weight_at(&near, old->positions[v]) > 0 && number++ % stride == 0 &&
            *count < POINT_LIMIT) {
            weights[*count] = weight_at(&near, old->positions[v]);
            origins[*count] = work->composite.vertex_origins[old->vertices[v]];
            points[(*count)++] = (MesoMatchPoint){old->positions[v], old->normals[v]};
        }
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoVec3 *places = MESO_NEW(scratch, MesoVec3, largest, error);
    MesoVec3 *normals = MESO_NEW(scratch, MesoVec3, largest, error);
    if (!places || !normals)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < old->whole_count; i++) {
        uint32_t size, begin = whole_begin(work, old->wholes[i], &size);
        float weight = weight_at(&near, old->centres[i]);
        if (!is_inside(half, old->centres[i]) || weight <= 0)
            continue;
        bool complete = true;
        for (uint32_t k = 0; k < size; k++)
            complete &= meso_quilt_plane_to(&step->plane, work->composite.whole_vertices[begin + k], &places[k]);
        if (!complete)
            continue;
        uint32_t element = work->composite.wholes[old->wholes[i]].element;
        whole_normals(normals, places, work->swatch, element);
        for (uint32_t k = 0; k < size; k++)
            if (number++ % stride == 0 && *count < POINT_LIMIT) {
                weights[*count] = weight;
                origins[*count] = work->swatch->vertex_begin[element] + k;
                points[(*count)++] = (MesoMatchPoint){places[k], normals[k]};
            }
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

/* The number of periods nearest to a length, as a length; 0 where there is no period. */
static float whole_periods(float length, float period)
{
    return period > 0 ? period * floorf(length / period + 0.5f) : 0;
}

/* Votes of points for a shift, up to whole periods: how many agree with that of point `i`, and their mean. */
static uint32_t count_votes(MesoVec2 *mean, const MesoVec2 *shifts, uint32_t count, uint32_t i,
                            const MesoSwatch *swatch)
{
    uint32_t votes = 0;
    double x = 0, y = 0;
    for (uint32_t k = 0; k < count; k++) {
        MesoVec2 d = meso_vec2_sub(shifts[k], shifts[i]);
        d.x -= whole_periods(d.x, swatch->period.x);
        d.y -= whole_periods(d.y, swatch->period.y);
        if (meso_vec2_length(d) > AGREE * swatch->mean_edge)
            continue;
        votes++;
        x += d.x;
        y += d.y;
    }
    *mean = (MesoVec2){shifts[i].x + (float)(x / votes), shifts[i].y + (float)(y / votes)};
    return votes;
}

/*
 * The placement in which the older quilt simply goes on: each of its vertices knows its place in the swatch, and so the
 * shift that it was laid with, up to whole periods. False where no half of them agree, or the swatch ends before.
 */
static bool go_on(MesoMatch *match, const MesoQuiltStep *step, const MesoQuiltWork *work, MesoVec2 half)
{
    const MesoSwatch *swatch = work->swatch;
    uint32_t stride = step->point_count / VOTERS + 1, most = 0;
    *match = (MesoMatch){0};
    for (uint32_t turn = 0; turn < work->options.turn_count; turn++) {
        MesoVec2 shifts[VOTERS], mean;
        uint32_t count = 0;
        double angle = 2 * MESO_PI * turn / work->options.turn_count;
        float c = (float)cos(angle), s = (float)sin(angle);
        for (uint32_t i = 0; i < step->point_count && count < VOTERS; i += stride) {
            MesoVec3 p = step->points[i].position, o = swatch->positions[step->point_origins[i]];
            shifts[count++] = (MesoVec2){o.x - (c * p.x + s * p.y), o.y - (c * p.y - s * p.x)};
        }
        for (uint32_t i = 0; i < count; i++) {
            uint32_t votes = count_votes(&mean, shifts, count, i, swatch);
            if (votes > most && 2 * votes > count) {
                most = votes;
                *match = (MesoMatch){.shift = mean, .turn = turn};
            }
        }
    }
    if (!most)
        return false;
    /* as near to the middle of the swatch as periods allow */
    match->shift.x += whole_periods(0.5f * swatch->size.x - match->shift.x, swatch->period.x);
    match->shift.y += whole_periods(0.5f * swatch->size.y - match->shift.y, swatch->period.y);
    match->cost = meso_match_cost(&work->field, step->points, step->point_weights, step->point_count, match->shift,
                                  match->turn, work->options.turn_count);
    return match->shift.x >= half.x && match->shift.y >= half.y && match->shift.x <= swatch->size.x - half.x &&
           match->shift.y <= swatch->size.y - half.y;
}

/* Where nothing is yet: anywhere in the swatch that has room for the window. */
static void place_freely(MesoMatch *match, const MesoQuiltStep *step, const MesoQuiltWork *work, MesoVec2 half)
{
    MesoRandom random;
    meso_random_init(&random, work->options.seed, step->patch);
    MesoVec3 size = work->swatch->size;
    MesoVec2 room = {0.5f * size.x - half.x, 0.5f * size.y - half.y};
    float x = (float)meso_random_below(&random, 1 << 20) / (1 << 20) - 0.5f;
    float y = (float)meso_random_below(&random, 1 << 20) / (1 << 20) - 0.5f;
    *match = (MesoMatch){.shift = {0.5f * size.x + x * room.x, 0.5f * size.y + y * room.y}};
    if (!work->in_phase)
        return;
    const double *pitches = work->pitch.pitches;
    double aside = work->phases.diagonal ? 0.5 : 0;
    const double offsets[2] = {work->pitch.offsets[0] + aside * pitches[0],
                               work->pitch.offsets[1] + aside * pitches[1]};
    match->shift.x = (float)(offsets[0] + pitches[0] * floor(((double)match->shift.x - offsets[0]) / pitches[0] + 0.5));
    match->shift.y = (float)(offsets[1] + pitches[1] * floor(((double)match->shift.y - offsets[1]) / pitches[1] + 0.5));
}

/* What must match: that share of the swatch's sides, and as far back as its middle has moved away from what is done. */
static MesoVec2 window_half(const MesoQuiltWork *work)
{
    MesoVec3 size = work->swatch->size;
    float share = work->options.patch, back = BACK_SHARE * work->seed_reach / work->options.scale;
    float most = 0.5f * fmaxf(share, WINDOW_MOST);
    return (MesoVec2){fminf(0.5f * share * size.x + back, most * size.x),
                      fminf(0.5f * share * size.y + back, most * size.y)};
}

MesoStatus meso_quilt_place(MesoMatch *matches, uint32_t *found, uint32_t wanted, MesoQuiltStep *step,
                            const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoVec2 half = window_half(work);
    MesoMatchPoint *points = MESO_NEW(arena, MesoMatchPoint, POINT_LIMIT, error);
    float *weights = MESO_NEW(arena, float, POINT_LIMIT, error);
    step->point_origins = MESO_NEW(arena, uint32_t, POINT_LIMIT, error);
    if (!points || !weights || !step->point_origins)
        return MESO_ERR_MEMORY;
    uint32_t count = 0;
    step->points = points;
    step->point_weights = weights;
    MesoStatus status = collect_points(points, weights, step->point_origins, &count, step, work, half, arena, error);
    if (status)
        return status;
    *found = 0;
    step->point_count = count;
    if (count)
        status = meso_match_search(matches, found, wanted, 4 * work->field.voxel, &work->field, arena, points, weights,
                                   count, (MesoVec2){-half.x, -half.y}, half, 0, work->options.turn_count, error);
    MesoMatch going_on;
    if (!status && count && go_on(&going_on, step, work, half) &&
        (!*found || going_on.cost <= matches[0].cost + WORSE_BUT_EXACT)) {
        matches[0] = going_on;      /* nothing else is worth a try */
        *found = 1;
    }
    if (!status && !*found) {
        place_freely(&matches[0], step, work, half);
        *found = 1;
    }
    return status;
}

void meso_quilt_choose(MesoQuiltStep *step, const MesoQuiltWork *work, MesoMatch match)
{
    step->match = match;
    double angle = 2 * MESO_PI * match.turn / work->options.turn_count;
    step->turn_cos = (float)cos(angle);
    step->turn_sin = (float)sin(angle);
}
