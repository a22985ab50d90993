#include "libcore/decor/operators.h"

#include <stdio.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/triangle_area.h"

/* ---- lines ---- */

static MesoOperator *const OPERATORS[] = {
    [MESO_STEP_CONTOUR] = meso_decor_contour,
    [MESO_STEP_STREAM] = meso_decor_stream,
    [MESO_STEP_VORONOI] = meso_decor_voronoi,
    [MESO_STEP_POLYLINE] = meso_decor_polyline,
};

static void count_leaf(void *context, uint32_t leaf)
{
    MesoSplit *split = context;
    const uint32_t *begin = split->work->lists.begin;
    split->field.row_room += begin[leaf + 1] - begin[leaf];
}

/* Rows for the corners of all targets' triangles; no target shares one with another. */
static MesoStatus init_field(MesoSplit *split, MesoError *error)
{
    const MesoTriangulation *mesh = &split->work->decor->mesh;
    MesoArena *scratch = split->work->scratch;
    if (split->step->kind != MESO_STEP_CONTOUR)
        return MESO_OK;
    for (uint32_t i = 0; i < split->count; i++)
        meso_region_each_leaf(&split->work->decor->tree, split->targets[i].region, count_leaf, split);
    split->field.row = MESO_NEW(scratch, uint32_t, mesh->triangle_count, error);
    split->field.values = MESO_NEW(scratch, float, 3 * (size_t)split->field.row_room, error);
    if (!split->field.row || !split->field.values)
        return MESO_ERR_MEMORY;
    memset(split->field.row, 0xff, mesh->triangle_count * sizeof *split->field.row);
    return MESO_OK;
}

static MesoStatus draw_lines(MesoSplit *split, MesoError *error)
{
    MesoDecorWork *work = split->work;
    const MesoRegionTree *tree = &work->decor->tree;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < split->count && !status; i++) {
        MesoSplitTarget *target = &split->targets[i];
        MesoDomain domain;
        status = meso_region_domain(&domain, work->member, work->scratch, tree, &work->lists, &work->decor->mesh,
                                    target->region, error);
        if (!status)
            status = OPERATORS[split->step->kind](split, target, &domain, error);
        meso_region_domain_end(tree, target->region, work->member);
    }
    return status;
}

/* ---- what pieces are ---- */

typedef struct Looks {
    const MesoSplit *split;
    const MesoSplitTarget *target;
    const MesoPieces *pieces;
    double largest_area;        /* of the target's pieces */
} Looks;

static uint32_t band_of(const MesoSplitTarget *target, double level)
{
    uint32_t band = 0;
    while (band < target->level_count && level >= (double)target->levels[band])
        band++;
    return band;
}

static const char *contour_tag(const MesoSplitTarget *target, uint32_t band)
{
    if (target->level_count > 1)
        return "stripe";
    if (target->points)
        return band == 0 ? "dot" : "background";
    return band == 0 ? "band" : "inside";
}

static const char *tag_of(const Looks *looks, const MesoPiece *piece)
{
    const MesoStep *step = looks->split->step;
    switch (step->kind) {
    case MESO_STEP_CONTOUR:
        return contour_tag(looks->target, piece->kind);
    case MESO_STEP_STREAM:
        return "stripe";
    case MESO_STEP_POLYLINE:
        return !step->closed ? "cell" : piece->area < looks->largest_area ? "inside" : "background";
    default:
        return "cell";
    }
}

static const char *name_of(const MesoStep *step, const char *tag)
{
    for (uint32_t i = 0; i < step->after_count; i++)
        if (step->after[i].name && (!step->after[i].tag || strcmp(step->after[i].tag, tag) == 0))
            return step->after[i].name;
    return tag;
}

static MesoPieceLook look(void *context, const MesoPiece *piece)
{
    const Looks *looks = context;
    const MesoSplitTarget *target = looks->target;
    const char *tag = tag_of(looks, piece);
    float level = looks->split->step->kind == MESO_STEP_CONTOUR && target->level_count > 0
                      ? (float)piece->kind / (float)target->level_count
                      : target->largest > 0 ? (float)piece->level / target->largest : 0;
    return (MesoPieceLook){tag, name_of(looks->split->step, tag), level};
}

/* ---- regions ---- */

typedef struct Flooding {
    MesoSplit *split;
    MesoPieces *pieces;
    MesoStatus status;
    MesoError *error;
    uint32_t leaves;
} Flooding;

static void flood_leaf(void *context, uint32_t leaf)
{
    Flooding *f = context;
    f->leaves++;
    if (!f->status)
        f->status = meso_pieces_add(f->pieces, f->split->work->scratch, f->split->work, leaf,
                                    f->split->field.row ? &f->split->field : NULL, f->error);
}

/*
 * The stripe of a start is what lies to the left of the border that begins there: a corner at its vertex whose
 * half-edge is the border.
 */
static void order_stripes(const MesoSplit *split, const MesoSplitTarget *target, const MesoCutReport *report,
                          MesoPieces *pieces, uint32_t begin)
{
    const MesoTriangulation *mesh = &split->work->decor->mesh;
    for (uint32_t i = begin; i < pieces->count; i++)
        pieces->pieces[i].kind = target->start_count;
    for (uint32_t i = target->start_count; i-- > 0;) {
        if (target->start_nodes[i] == MESO_NO_INDEX)
            continue;
        MesoFan fan = meso_fan_first(mesh, report->node_vertex[target->start_nodes[i]]);
        uint32_t first = fan.corner;
        do {
            uint32_t piece = pieces->piece_of[fan.corner / 3], across = mesh->twins[fan.corner];
            bool border = across == MESO_NO_INDEX || pieces->piece_of[across / 3] == MESO_NO_INDEX ||
                          pieces->piece_of[across / 3] < begin;
            if (piece != MESO_NO_INDEX && piece >= begin && border && meso_side_is_wall(mesh, fan.corner))
                pieces->pieces[piece].kind = i;
        } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    }
    for (uint32_t i = begin; i < pieces->count; i++)
        pieces->pieces[i].level = target->start_count > 1
            ? (double)pieces->pieces[i].kind / target->start_count * (double)target->largest : 0;
}

/* Children for the leaves of a target, where any of them has come apart. */
static MesoStatus divide_target(MesoSplit *split, MesoSplitTarget *target, MesoPieces *pieces, const MesoCutReport *report,
                                MesoError *error)
{
    Flooding f = {.split = split, .pieces = pieces, .error = error};
    uint32_t begin = pieces->count;
    meso_region_each_leaf(&split->work->decor->tree, target->region, flood_leaf, &f);
    bool divided = pieces->count - begin > f.leaves;
    if (!f.status)
        f.status = meso_pieces_join_small(pieces, split->work, begin, error);
    if (f.status)
        return f.status;
    if (pieces->count - begin <= f.leaves) {
        if (!target->idle)
            target->idle = divided ? "it is too coarse: its parts are smaller than a face" : "its lines divide nothing";
        return MESO_OK;
    }
    if (split->step->kind == MESO_STEP_STREAM)
        order_stripes(split, target, report, pieces, begin);
    Looks looks = {.split = split, .target = target, .pieces = pieces};
    for (uint32_t i = begin; i < pieces->count; i++) {
        MesoPiece *piece = &pieces->pieces[i];
        if (split->step->kind == MESO_STEP_CONTOUR)
            piece->kind = band_of(target, piece->level);
        looks.largest_area = fmax(looks.largest_area, piece->area);
    }
    MesoStatus status = MESO_OK;
    for (uint32_t i = begin, end; i < pieces->count && !status; i = end) {
        for (end = i + 1; end < pieces->count && pieces->pieces[end].leaf == pieces->pieces[i].leaf; end++)
            ;
        status = meso_pieces_become_regions(pieces, split->work, i, end, look, &looks, error);
    }
    return status;
}

static void note_largest(void *context, uint32_t leaf)
{
    MesoSplit *split = context;
    const uint32_t *begin = split->work->lists.begin;
    uint32_t size = begin[leaf + 1] - begin[leaf];
    split->largest_leaf = size > split->largest_leaf ? size : split->largest_leaf;
}

static MesoStatus divide(MesoSplit *split, const MesoCutReport *report, MesoError *error)
{
    MesoDecorWork *work = split->work;
    MesoPieces pieces;
    MesoStatus status = meso_decor_refresh(work, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < split->count; i++)
        meso_region_each_leaf(&work->decor->tree, split->targets[i].region, note_largest, split);
    status = meso_pieces_init(&pieces, work->scratch, &work->decor->mesh, split->largest_leaf, error);
    if (!status && split->field.row)
        status = meso_corner_field_cut(&split->field, work->scratch, &work->decor->mesh, report, error);
    for (uint32_t i = 0; i < split->count && !status; i++)
        status = divide_target(split, &split->targets[i], &pieces, report, error);
    return status;
}

/* ---- the lines that a user may want to see ---- */

static MesoStatus keep_lines(const MesoSplit *split, MesoError *error)
{
    MesoDecor *decor = split->work->decor;
    for (uint32_t i = 0; i < split->lines.segment_count && decor->keep_lines; i++) {
        const MesoCutSegment *segment = &split->lines.segments[i];
        uint32_t room = decor->line_room;
        decor->line_steps = MESO_GROW(decor->arena, decor->line_steps, decor->line_count, decor->line_room, 4096,
                                      error);
        if (decor->line_steps && room != decor->line_room)
            decor->lines = meso_arena_enlarge(decor->arena, decor->lines, 2 * (size_t)decor->line_count,
                                              2 * (size_t)decor->line_room, sizeof *decor->lines, error);
        if (!decor->line_steps || !decor->lines)
            return MESO_ERR_MEMORY;
        for (int k = 0; k < 2; k++)
            decor->lines[2 * (size_t)decor->line_count + (size_t)k] =
                meso_cut_node_position(&decor->mesh, &split->lines.nodes[segment->node[k]]);
        decor->line_steps[decor->line_count++] = decor->operation_count + 1;
    }
    return MESO_OK;
}

/* One note a reason, of which there are few; each is a text of its own. */
static void tell_idle(const MesoSplit *split)
{
    enum { REASONS = 8 };
    const char *reasons[REASONS];
    uint32_t counts[REASONS], reason_count = 0;
    for (uint32_t i = 0; i < split->count; i++) {
        uint32_t r = 0;
        while (r < reason_count && reasons[r] != split->targets[i].idle)
            r++;
        if (!split->targets[i].idle || r == REASONS)
            continue;
        if (r == reason_count)
            counts[reason_count++] = 0;
        reasons[r] = split->targets[i].idle;
        counts[r]++;
    }
    for (uint32_t r = 0; r < reason_count; r++) {
        char text[160];
        snprintf(text, sizeof text, "%u of %u regions stay whole: %s", counts[r], split->count, reasons[r]);
        meso_decor_note(split->work, split->step, text);
    }
}

/* ---- the step ---- */

/* Root of the mean area of the targets. */
static float mean_size(const MesoSplit *split)
{
    double area = 0;
    for (uint32_t i = 0; i < split->count; i++)
        area += split->work->decor->tree.regions[split->targets[i].region].area;
    return (float)sqrt(area / split->count);
}

static MesoStatus draw_and_cut(MesoSplit *split, MesoError *error)
{
    MesoDecorWork *work = split->work;
    const MesoNoise *noise = &split->step->field.noise;
    bool perturbed = noise->of == MESO_NOISE_OF_METRIC && noise->gain != 0;
    MesoCutReport report;
    MesoStatus status = perturbed ? meso_decor_perturb(work, noise, mean_size(split), error) : MESO_OK;
    if (!status)
        status = draw_lines(split, error);
    if (!status && perturbed)
        status = meso_geodesic_set_positions(work->solver, work->decor->mesh.positions, error);
    if (!status)
        status = keep_lines(split, error);
    if (!status)
        status = meso_mesh_cut(&work->decor->mesh, &split->lines, &report, work->scratch, error);
    if (!status && work->decor->mesh.triangle_count > work->options->triangle_limit)
        status = meso_fail(error, MESO_ERR_LIMIT, "%u triangles, over the limit of %llu",
                           work->decor->mesh.triangle_count, (unsigned long long)work->options->triangle_limit);
    if (!status)
        status = meso_geodesic_update(work->solver, &report, error);
    return status ? status : divide(split, &report, error);
}

MesoStatus meso_decor_split(MesoDecorWork *work, const MesoStep *step, const MesoTargets *targets, MesoError *error)
{
    MesoSplit split = {.work = work, .step = step, .count = targets->count};
    split.targets = MESO_NEW(work->scratch, MesoSplitTarget, targets->count, error);
    if (!split.targets)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < targets->count; i++)
        split.targets[i].region = targets->targets[i].region;
    MesoStatus status = init_field(&split, error);
    if (!status)
        status = draw_and_cut(&split, error);
    if (!status)
        tell_idle(&split);
    return status;
}
