/* Where the swatch goes: equations 1 to 3 over all shifts and turns. */
#include "libcore/base/random.h"
#include "libcore/quilt/grid_distance.h"
#include "libcore/quilt/quilt_work.h"

/* More points than that tell nothing new. */
#define POINT_LIMIT 1000

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

/* Normals of a copy are those of the swatch, as far as `turned` (its first vertices on its centre) tells: by triangles. */
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
static MesoStatus collect_points(MesoMatchPoint *points, float *weights, uint32_t *count, const MesoQuiltStep *step,
                                 const MesoQuiltWork *work, MesoVec2 half, MesoArena *scratch, MesoError *error)
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
        whole_normals(normals, places, work->swatch, work->composite.wholes[old->wholes[i]].element);
        for (uint32_t k = 0; k < size; k++)
            if (number++ % stride == 0 && *count < POINT_LIMIT) {
                weights[*count] = weight;
                points[(*count)++] = (MesoMatchPoint){places[k], normals[k]};
            }
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
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
}

MesoStatus meso_quilt_place(MesoMatch *matches, uint32_t *found, uint32_t wanted, MesoQuiltStep *step,
                            const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoVec3 size = work->swatch->size;
    MesoVec2 half = {0.5f * work->options.patch * size.x, 0.5f * work->options.patch * size.y};
    MesoMatchPoint *points = MESO_NEW(arena, MesoMatchPoint, POINT_LIMIT, error);
    float *weights = MESO_NEW(arena, float, POINT_LIMIT, error);
    if (!points || !weights)
        return MESO_ERR_MEMORY;
    uint32_t count = 0;
    step->points = points;
    step->point_weights = weights;
    MesoStatus status = collect_points(points, weights, &count, step, work, half, arena, error);
    if (status)
        return status;
    *found = 0;
    step->point_count = count;
    if (count)
        status = meso_match_search(matches, found, wanted, 4 * work->field.voxel, &work->field, arena, points, weights,
                                   count, (MesoVec2){-half.x, -half.y}, half, 0, work->options.turn_count, error);
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
