/* Where a patch's new side is: what must be new, what must stay, and the cheapest line between. */
#include "libcore/quilt/grid_distance.h"
#include "libcore/quilt/quilt_work.h"

#include <string.h>

/* Cells of the grid along the longer side of the swatch: between these, and some 1.5 edges of the swatch wide. */
#define CELLS_LEAST 48
#define CELLS_MOST 96

/* Cells around what a patch has to do with in which its seam may end. */
#define FREE_CELLS 3.0f

/*
 * Costs of a seam through a cell: of the cell itself, where one strand is crossed, where two lie on each other, so that one
 * of them would be cut along; and of the mean mismatch of both sides.
 */
static const uint16_t LAYER_COSTS[3] = {100, 400, 2100};
#define COST_MISMATCH 800.0f

static MesoVec2 cell_centre(const MesoSeamGround *ground, uint32_t x, uint32_t y)
{
    return (MesoVec2){ground->low.x + ((float)x + 0.5f) * ground->cell, ground->low.y + ((float)y + 0.5f) * ground->cell};
}

static bool cell_of(const MesoSeamGround *ground, MesoVec2 p, size_t *at)
{
    float x = (p.x - ground->low.x) / ground->cell, y = (p.y - ground->low.y) / ground->cell;
    if (!(x >= 0 && y >= 0 && x < (float)ground->columns && y < (float)ground->rows))
        return false;
    *at = (size_t)(uint32_t)y * ground->columns + (uint32_t)x;
    return true;
}

/* ---- the ground ---- */

static void plan_grid(MesoSeamGround *ground, const MesoQuiltPlane *plane, const MesoSwatch *swatch)
{
    float longest = swatch->size.x > swatch->size.y ? swatch->size.x : swatch->size.y, cell = swatch->mean_edge;
    cell = cell > longest / CELLS_MOST ? cell : longest / CELLS_MOST;
    ground->cell = cell < longest / CELLS_LEAST ? cell : longest / CELLS_LEAST;
    ground->low = (MesoVec2){plane->low.x - 2 * ground->cell, plane->low.y - 2 * ground->cell};
    ground->columns = (uint32_t)((plane->high.x - plane->low.x) / ground->cell) + 5;
    ground->rows = (uint32_t)((plane->high.y - plane->low.y) / ground->cell) + 5;
}

typedef struct CellBox {
    uint32_t x0, x1, y0, y1;    /* cells whose middles may lie in a triangle: from the first ones to below the last ones */
    MesoVec2 p[3];              /* its corners, in cells, from the middle of the first cell */
} CellBox;

static CellBox box_cells(const MesoSeamGround *ground, const MesoVec2 *places)
{
    CellBox box;
    MesoVec2 low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        box.p[k] = (MesoVec2){(places[k].x - ground->low.x) / ground->cell - 0.5f,
                              (places[k].y - ground->low.y) / ground->cell - 0.5f};
        low = (MesoVec2){box.p[k].x < low.x ? box.p[k].x : low.x, box.p[k].y < low.y ? box.p[k].y : low.y};
        high = (MesoVec2){box.p[k].x > high.x ? box.p[k].x : high.x, box.p[k].y > high.y ? box.p[k].y : high.y};
    }
    box.x0 = low.x > 0 ? (uint32_t)low.x : 0;
    box.y0 = low.y > 0 ? (uint32_t)low.y : 0;
    box.x1 = high.x >= 0 ? (uint32_t)high.x + 1 : 0;
    box.y1 = high.y >= 0 ? (uint32_t)high.y + 1 : 0;
    box.x1 = box.x1 < ground->columns ? box.x1 : ground->columns;
    box.y1 = box.y1 < ground->rows ? box.y1 : ground->rows;
    return box;
}

/* Whether the middle of a cell lies in a triangle; of two that share a side, one has what lies on it. */
static bool covers_middle(const CellBox *box, uint32_t x, uint32_t y)
{
    for (int k = 0; k < 3; k++) {
        MesoVec2 along = meso_vec2_sub(box->p[(k + 1) % 3], box->p[k]);
        float side = meso_vec2_cross(along, meso_vec2_sub((MesoVec2){(float)x, (float)y}, box->p[k]));
        if (!(side > 0 || (side == 0 && (along.y > 0 || (along.y == 0 && along.x < 0)))))
            return false;
    }
    return true;
}

static void find_covers(MesoSeamGround *ground, const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    const MesoChart *chart = &step->chart;
    memset(ground->covers, MESO_COVER_OUTSIDE, (size_t)ground->columns * ground->rows);
    for (uint32_t t = 0; t < chart->triangle_count; t++) {
        const uint32_t *corner = &chart->corners[3 * (size_t)t];
        const MesoVec2 *places = step->plane.places;
        CellBox box = box_cells(ground, (MesoVec2[3]){places[corner[0]], places[corner[1]], places[corner[2]]});
        for (uint32_t y = box.y0; y < box.y1; y++)
            for (uint32_t x = box.x0; x < box.x1; x++)
                if (covers_middle(&box, x, y))
                    ground->covers[(size_t)y * ground->columns + x] = work->covers[chart->triangles[t]];
    }
}

/* Triangles that look up, by the cells whose middles they cover: one a strand. */
static void count_layers(MesoSeamGround *ground, const MesoOldGeometry *old)
{
    for (uint32_t t = 0; t < old->triangle_count; t++) {
        MesoVec2 places[3];
        for (size_t k = 0; k < 3; k++) {
            MesoVec3 v = old->positions[old->corners[3 * (size_t)t + k]];
            places[k] = (MesoVec2){v.x, v.y};
        }
        if (meso_vec2_cross(meso_vec2_sub(places[1], places[0]), meso_vec2_sub(places[2], places[0])) <= 0)
            continue;
        CellBox box = box_cells(ground, places);
        for (uint32_t y = box.y0; y < box.y1; y++)
            for (uint32_t x = box.x0; x < box.x1; x++) {
                uint8_t *layer = &ground->layers[(size_t)y * ground->columns + x];
                if (*layer < 255 && covers_middle(&box, x, y))
                    ++*layer;
            }
    }
}

/* Cells of the chart's rim, the edges where the surface goes on, but the chart does not, get distance 0. */
static void mark_rim(MesoSeamGround *ground, const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    const MesoChart *chart = &step->chart;
    for (uint32_t h = 0; h < 3 * chart->triangle_count; h++) {
        uint32_t half_edge = 3 * chart->triangles[h / 3] + h % 3, across = work->base->twins[half_edge];
        if (across == MESO_NO_INDEX || work->chart_triangles[across / 3] != MESO_NO_INDEX)
            continue;
        MesoVec2 a = step->plane.places[chart->corners[h]], b = step->plane.places[chart->corners[meso_next_corner(h)]];
        uint32_t steps = (uint32_t)(2 * meso_vec2_length(meso_vec2_sub(b, a)) / ground->cell) + 1;
        for (uint32_t i = 0; i <= steps; i++) {
            size_t at;
            if (cell_of(ground, meso_vec2_lerp(a, b, (float)i / (float)steps), &at))
                ground->rim[at] = 0;
        }
    }
}

static void measure_ground(MesoSeamGround *ground, const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    size_t count = (size_t)ground->columns * ground->rows;
    float far = (float)(ground->columns + ground->rows);
    for (size_t i = 0; i < count; i++)
        ground->rim[i] = far;
    mark_rim(ground, step, work);
    meso_grid_distance(ground->rim, ground->columns, ground->rows);
    float ring = step->tightness * work->ring / ground->cell;
    for (size_t i = 0; i < count; i++) {
        bool undone = ground->covers[i] < MESO_COVER_DONE && ground->rim[i] > ring;
        ground->undone[i] = undone ? 0 : far;
        ground->outside[i] = ground->covers[i] == MESO_COVER_OUTSIDE ? far : 0;
    }
    meso_grid_distance(ground->outside, ground->columns, ground->rows);
    meso_grid_distance(ground->undone, ground->columns, ground->rows);
    for (size_t i = 0; i < count; i++) {
        ground->rim[i] *= ground->cell;
        ground->undone[i] *= ground->cell;
        ground->outside[i] *= ground->cell;
    }
}

MesoStatus meso_quilt_ground(MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoSeamGround *ground = &step->ground;
    plan_grid(ground, &step->plane, work->swatch);
    size_t count = (size_t)ground->columns * ground->rows;
    ground->covers = MESO_NEW(arena, uint8_t, count, error);
    ground->layers = MESO_NEW(arena, uint8_t, count, error);
    ground->rim = MESO_NEW(arena, float, count, error);
    ground->undone = MESO_NEW(arena, float, count, error);
    ground->outside = MESO_NEW(arena, float, count, error);
    if (!ground->covers || !ground->layers || !ground->rim || !ground->undone || !ground->outside)
        return MESO_ERR_MEMORY;
    find_covers(ground, step, work);
    count_layers(ground, &step->old);
    measure_ground(ground, step, work);
    return MESO_OK;
}

/* ---- the seam of a placement ---- */

/* Distance to the sides of the swatch, less than 0 outside. */
static float swatch_distance(const MesoQuiltStep *step, const MesoQuiltWork *work, MesoVec2 p)
{
    MesoVec3 size = work->swatch->size, s = meso_step_to_swatch(step, (MesoVec3){p.x, p.y, 0});
    float x = s.x < size.x - s.x ? s.x : size.x - s.x, y = s.y < size.y - s.y ? s.y : size.y - s.y;
    return x < y ? x : y;
}

/* Distances to where the new side ends, less than 0 beyond: whole elements reach further in from the chart's rim. */
static void measure_rim(float *rim, const MesoSeamGround *ground, const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    for (uint32_t y = 0; y < ground->rows; y++)
        for (uint32_t x = 0; x < ground->columns; x++) {
            size_t at = (size_t)y * ground->columns + x;
            float side = swatch_distance(step, work, cell_centre(ground, x, y));
            float inner = ground->rim[at] - step->tightness * work->whole_margin;
            float least = side < inner ? side : inner;
            rim[at] = least;
        }
}

/*
 * At the rim the older quilt stays where there is any. Inside, what is not done becomes new, and some way around it
 * too, so that ends that fray lie on the new side; what is done is free. Some cells around are free as well, so that the
 * line has room to end there.
 */
static uint8_t choose_state(const MesoSeamGround *ground, size_t at, float rim, float tightness,
                            const MesoQuiltWork *work)
{
    uint8_t cover = ground->covers[at];
    float room = FREE_CELLS * ground->cell;
    if (cover == MESO_COVER_OUTSIDE)
        return ground->outside[at] < room && rim > -room ? MESO_SEAM_FREE : MESO_SEAM_VOID;
    if (rim > tightness * work->ring) {
        bool near = ground->undone[at] <= tightness * work->widening && rim > tightness * work->strand_margin;
        return cover != MESO_COVER_DONE || near ? MESO_SEAM_NEW : MESO_SEAM_FREE;
    }
    if (cover != MESO_COVER_NONE)
        return MESO_SEAM_OLD;
    return rim > -room ? MESO_SEAM_FREE : MESO_SEAM_VOID;
}

/* D - 1 by the table alone, in the middle of the voxel and of the bin. */
static float mismatch_at(const MesoMatchField *field, MesoMatchPoint point)
{
    uint32_t at[3];
    const float p[3] = {point.position.x - field->low.x, point.position.y - field->low.y, point.position.z - field->low.z};
    for (int k = 0; k < 3; k++) {
        float cell = p[k] / field->voxel, last = (float)(field->count[k] - 1);
        at[k] = (uint32_t)(cell > 0 ? cell < last ? cell : last : 0);
    }
    size_t bin = meso_match_nearest_bin(point.normal);
    size_t voxel = ((bin * field->count[2] + at[2]) * field->count[1] + at[1]) * field->count[0] + at[0];
    return meso_match_excess(field->costs[voxel]);
}

/* Mean mismatch of the older quilt's vertices by cell; 0 where it has none. */
static void mean_mismatch(float *means, uint16_t *numbers, const uint8_t *states, const MesoSeamGround *ground,
                          const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    const MesoOldGeometry *old = &step->old;
    for (uint32_t v = 0; v < old->vertex_count; v++) {
        size_t at;
        if (!cell_of(ground, (MesoVec2){old->positions[v].x, old->positions[v].y}, &at) || states[at] != MESO_SEAM_FREE ||
            numbers[at] == UINT16_MAX)
            continue;
        MesoVec2 normal = meso_step_unturn(step, (MesoVec2){old->normals[v].x, old->normals[v].y});
        MesoMatchPoint point = {meso_step_to_swatch(step, old->positions[v]), {normal.x, normal.y, old->normals[v].z}};
        float mismatch = mismatch_at(&work->field, point);
        means[at] += mismatch < 4 ? mismatch : 4;
        numbers[at]++;
    }
    for (size_t i = 0; i < (size_t)ground->columns * ground->rows; i++)
        means[i] = numbers[i] ? means[i] / numbers[i] : 0;
}

/* Seams are dear where strands are, most where they cross, and where both sides differ. */
static MesoStatus choose_costs(uint16_t *costs, const uint8_t *states, const MesoSeamGround *ground,
                               const MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *scratch, MesoError *error)
{
    size_t count = (size_t)ground->columns * ground->rows;
    MesoArenaMark mark = meso_arena_mark(scratch);
    float *means = MESO_NEW(scratch, float, count, error);
    uint16_t *numbers = MESO_NEW(scratch, uint16_t, count, error);
    if (!means || !numbers)
        return MESO_ERR_MEMORY;
    mean_mismatch(means, numbers, states, ground, step, work);
    for (size_t i = 0; i < count; i++)
        costs[i] = (uint16_t)((float)LAYER_COSTS[ground->layers[i] < 2 ? ground->layers[i] : 2] + COST_MISMATCH * means[i]);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

MesoStatus meso_quilt_seam(MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    const MesoSeamGround *ground = &step->ground;
    size_t count = (size_t)ground->columns * ground->rows;
    step->seam = (MesoSeamGrid){.columns = ground->columns, .rows = ground->rows, .low = ground->low,
                                .cell = ground->cell};
    step->rim = MESO_NEW(arena, float, count, error);
    uint8_t *states = MESO_NEW(arena, uint8_t, count, error);
    uint16_t *costs = MESO_NEW(arena, uint16_t, count, error);
    if (!step->rim || !states || !costs)
        return MESO_ERR_MEMORY;
    measure_rim(step->rim, ground, step, work);
    for (size_t i = 0; i < count; i++)
        states[i] = choose_state(ground, i, step->rim[i], step->tightness, work);
    MesoStatus status = choose_costs(costs, states, ground, step, work, arena, error);
    return status ? status : meso_seam_cut(&step->seam, arena, states, costs, error);
}

/* ---- what is covered ---- */

/* Distance to where the new side ends: at the chart's rim, and at the swatch's sides as they are after the warp. */
static float rim_at(const MesoQuiltStep *step, const MesoQuiltWork *work, MesoVec2 p)
{
    size_t at;
    if (!cell_of(&step->ground, p, &at))
        return 0;
    MesoVec3 moved = meso_step_warp(step, (MesoVec3){p.x, p.y, 0});
    float side = swatch_distance(step, work, (MesoVec2){2 * p.x - moved.x, 2 * p.y - moved.y});
    return side < step->rim[at] ? side : step->rim[at];
}

bool meso_quilt_cover(const MesoQuiltStep *step, MesoQuiltWork *work)
{
    const MesoChart *chart = &step->chart;
    float margin = step->tightness * work->strand_margin;
    for (uint32_t t = 0; t < chart->triangle_count; t++) {
        uint8_t *cover = &work->covers[chart->triangles[t]];
        if (*cover == MESO_COVER_DONE)
            continue;
        bool done = true, touched = false;
        for (size_t k = 0; k < 3; k++) {
            MesoVec2 p = step->plane.places[chart->corners[3 * (size_t)t + k]];
            float rim = rim_at(step, work, p);
            done &= rim > margin && meso_seam_at(&step->seam, p) > -step->ground.cell;
            touched |= rim > 0;
        }
        if (done)
            *cover = MESO_COVER_DONE;
        else if (touched)
            *cover = MESO_COVER_FRAYED;
    }
    return work->covers[step->seed] == MESO_COVER_DONE;
}
