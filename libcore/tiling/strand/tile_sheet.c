#include "libcore/tiling/strand/tile_sheet.h"

#include <math.h>

#include "libcore/sketch/id_color.h"
#include "libcore/sketch/sketch.h"
#include "libcore/sketch/stroke_font.h"
#include "libcore/tiling/strand/expansion.h"

/* Cells are 1 wide and high. */
static const float PITCH_X = 1.5f, PITCH_Y = 1.8f, WIDER = 1.6f;
static const float HEIGHT = 0.5f;               /* of the shell: half an edge length */
static const float SIDE_RADIUS = 0.02f, EDGE_RADIUS = 0.006f;
static const float TEXT_UNIT = 0.025f, TEXT_DROP = 0.3f;        /* a step of the letters' grid; below the cell's top */

static const float GREY[3] = {0.35f, 0.35f, 0.37f}, INK[3] = {0.02f, 0.02f, 0.03f};

/* Corners of a cell, in the order of a tile's: side 0 runs from the first to the second. */
static const float CORNERS[4][2] = {{1, 0}, {1, 1}, {0, 1}, {0, 0}};

static MesoVec3 cell_at(uint32_t tile, uint32_t columns)
{
    return (MesoVec3){PITCH_X * (float)(tile % columns), -PITCH_Y * (float)(tile / columns), 0};
}

static MesoVec3 corner_at(uint32_t tile, uint32_t columns, uint32_t corner, float height)
{
    MesoVec3 cell = cell_at(tile, columns);
    return (MesoVec3){cell.x + CORNERS[corner & 3][0], cell.y + CORNERS[corner & 3][1], height};
}

static MesoStatus make_cells(MesoModel *model, MesoArena *arena, uint32_t columns, MesoError *error)
{
    uint32_t count = model->tile_set.tile_count;
    MesoVec3 *positions = MESO_NEW(arena, MesoVec3, 4 * (size_t)count, error);
    uint32_t *corners = MESO_NEW(arena, uint32_t, 4 * (size_t)count, error);
    model->assignment = (MesoAssignment){count, MESO_NEW(arena, uint32_t, count, error),
                                         MESO_NEW(arena, MesoTransform, count, error)};
    if (!positions || !corners || !model->assignment.tile || !model->assignment.transform)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < count; t++) {
        model->assignment.tile[t] = t;
        for (uint32_t k = 0; k < 4; k++) {
            positions[4 * t + k] = corner_at(t, columns, k, 0);
            corners[4 * t + k] = 4 * t + k;
        }
    }
    MesoStatus status = meso_quad_mesh_build(&model->surface, arena, 4 * count, positions, 0, NULL, count, corners,
                                             NULL, error);
    return status ? status : meso_slot_graph_build(&model->graph, arena, &model->surface, error);
}

/* The feet of all sides of one interface. */
static void draw_sides(MesoSketch *sketch, const MesoTileSet *set, uint32_t interface, uint32_t columns)
{
    for (uint32_t t = 0; t < set->tile_count; t++)
        for (uint32_t k = 0; k < 4; k++)
            if (meso_label_interface(set->tiles[t].labels[k]) == interface)
                meso_sketch_bar(sketch, corner_at(t, columns, k, 0), corner_at(t, columns, k + 1, 0), SIDE_RADIUS);
}

/* As the set has it; where all are the same, one that tells them apart. */
static void color_of(const MesoTileSet *set, uint32_t interface, float color[3])
{
    const MesoInterface *all = set->interfaces;
    bool same = set->interface_count > 1;
    for (uint32_t i = 1; i < set->interface_count; i++)
        for (int c = 0; c < 3; c++)
            same = same && all[i].color[c] == all[0].color[c];
    if (same)
        meso_id_color(color, interface);
    for (int c = 0; c < 3 && !same; c++)
        color[c] = all[interface].color[c];
}

static void draw_edges(MesoSketch *sketch, uint32_t count, uint32_t columns)
{
    for (uint32_t t = 0; t < count; t++)
        for (uint32_t k = 0; k < 4; k++) {
            MesoVec3 top = corner_at(t, columns, k, HEIGHT);
            meso_sketch_bar(sketch, corner_at(t, columns, k, 0), top, EDGE_RADIUS);
            meso_sketch_bar(sketch, top, corner_at(t, columns, k + 1, HEIGHT), EDGE_RADIUS);
        }
}

/* A long name is smaller, so that it does not run into the next one. */
static void draw_name(MesoSketch *sketch, const char *name, MesoVec3 cell)
{
    float width = MESO_STROKE_ADVANCE * (float)meso_stroke_count(name);
    float unit = fminf(TEXT_UNIT, 0.95f * PITCH_X / width);
    MesoVec3 start = {cell.x + 0.5f - 0.5f * unit * width, cell.y - TEXT_DROP, HEIGHT};
    meso_sketch_text(sketch, start, (MesoVec3){1, 0, 0}, (MesoVec3){0, 1, 0}, unit, name);
}

MesoStatus meso_tile_sheet(MesoScene *scene, MesoArena *arena, MesoModel *model, uint32_t columns,
                           uint32_t thread_count, MesoError *error)
{
    const MesoTileSet *set = &model->tile_set;
    if (set->tile_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "there is no tile in the set");
    if (columns == 0)
        columns = (uint32_t)ceilf(sqrtf((float)set->tile_count * WIDER * PITCH_Y / PITCH_X));
    MesoStatus status = make_cells(model, arena, columns, error);
    if (!status) {
        model->options = meso_map_options_resolve(model->options, 1);
        status = meso_model_expand(scene, NULL, arena, model, thread_count, error);
    }
    if (status)
        return status;
    MesoSketch sketch = {0};
    for (uint32_t i = 0; i < set->interface_count; i++) {
        float color[3];
        color_of(set, i, color);
        meso_sketch_part(&sketch, set->interfaces[i].name, color);
        draw_sides(&sketch, set, i, columns);
    }
    meso_sketch_part(&sketch, "cells", GREY);
    draw_edges(&sketch, set->tile_count, columns);
    meso_sketch_part(&sketch, "names", INK);
    for (uint32_t t = 0; t < set->tile_count; t++)
        draw_name(&sketch, set->tiles[t].name, cell_at(t, columns));
    return meso_sketch_finish(&sketch, scene, arena, error);
}
