#include "libcore/scene/sweep.h"
#include "libcore/tiling/relax/relax_work.h"
#include "libcore/tiling/strand/expansion.h"
#include "libcore/tiling/tile/contour.h"

static const float CONTOUR_STEP = 0.02f;

/* What overlaps by so many widths of the thinner one lies in the other, and is one thing with it. */
static const float ONE_THING = 0.95f;

/* Of hollow sweeps in a square: what it takes to know by how much they graze others. */
static const float GRAZE_STEP = 0.02f;

/* Of an edge: what gets deeper into another one is meant to. */
static const float GRAZE_MOST = 0.1f;
enum { GRAZE_RINGS = 33 };

/* Less than this part of what is within reach is drawn of hollow sections. */
static const float HOLLOW = 0.85f;

/* ---- sections of an interface ---- */

/* How far a drawing reaches in a direction. */
static float reach_of(const MesoContourSet *contours, uint32_t section, MesoVec2 direction)
{
    float reach = 0;
    for (uint32_t c = contours->section_begin[section]; c < contours->section_begin[section + 1]; c++)
        for (uint32_t i = 0; i < contours->contours[c].point_count; i++) {
            MesoVec2 p = contours->points[contours->contours[c].point_begin + i];
            reach = fmaxf(reach, p.x * direction.x + p.y * direction.y);
        }
    return reach;
}

/* Whether much less is drawn than what lies within reach. */
static bool is_hollow_section(const MesoContourSet *contours, uint32_t section)
{
    float area = 0, within = 0, reach[MESO_RELAX_DIRECTIONS];
    const float step = 2 * (float)MESO_PI / MESO_RELAX_DIRECTIONS;
    for (uint32_t c = contours->section_begin[section]; c < contours->section_begin[section + 1]; c++) {
        const MesoContour *contour = &contours->contours[c];
        const MesoVec2 *p = contours->points + contour->point_begin;
        for (uint32_t i = 0; i < contour->point_count; i++)
            area += meso_vec2_cross(p[i], p[(i + 1) % contour->point_count]) / 2;
    }
    for (uint32_t k = 0; k < MESO_RELAX_DIRECTIONS; k++)
        reach[k] = reach_of(contours, section, (MesoVec2){cosf((float)k * step), sinf((float)k * step)});
    for (uint32_t k = 0; k < MESO_RELAX_DIRECTIONS; k++) {      /* the sides of what lies within reach */
        uint32_t next = (k + 1) % MESO_RELAX_DIRECTIONS, last = (k + MESO_RELAX_DIRECTIONS - 1) % MESO_RELAX_DIRECTIONS;
        within += reach[k] * (reach[next] + reach[last] - 2 * cosf(step) * reach[k]) / sinf(step) / 2;
    }
    return area < HOLLOW * within;
}

/*
 * How far apart what lies so as drawn is to be, as a part of what it takes. Where a hollow section meets another one by
 * no more than grazing it, `graze` deep, they are to be so much farther apart.
 */
static float part_of(MesoRelaxNearness drawn, bool hollow, float graze)
{
    if (!hollow)
        return drawn.depth > ONE_THING ? 0.0f : 1.0f;
    return drawn.needed > 0 ? fminf(drawn.distance + graze / drawn.needed, 1) : drawn.distance;
}

/* Seen in the direction from one middle to the other, on a wall one wide and as high as half the thickness. */
static MesoRelaxNearness drawn_nearness(const MesoContourSet *contours, uint32_t a, uint32_t b, float scale,
                                        float thickness)
{
    MesoVec2 from = contours->center[a], to = contours->center[b];
    MesoVec2 offset = {to.x - from.x, (to.y - from.y) * thickness / 2};
    float distance = meso_vec2_length(offset);
    if (!(distance > 0))
        return (MesoRelaxNearness){0, 1, 0};
    MesoVec2 ahead = meso_vec2_scale(offset, 1 / distance), back = meso_vec2_scale(offset, -1 / distance);
    float one = scale * (reach_of(contours, a, ahead) + reach_of(contours, a, back));
    float two = scale * (reach_of(contours, b, ahead) + reach_of(contours, b, back));
    float needed = scale * (reach_of(contours, a, ahead) + reach_of(contours, b, back));
    if (!(distance < needed))
        return (MesoRelaxNearness){1, 0, 0};
    return (MesoRelaxNearness){distance / needed, (needed - distance) / fminf(one, two), needed};
}

static MesoStatus find_drawn(MesoRelaxWork *work, float scale, float thickness, MesoArena *arena, MesoArena *scratch,
                             MesoError *error)
{
    const MesoTileSet *set = &work->model->tile_set;
    MesoContourSet contours;
    uint64_t pairs = 0;
    MesoStatus status = meso_contour_set_build(&contours, scratch, set, CONTOUR_STEP, error);
    if (status)
        return status;
    for (uint32_t s = 0; s < set->section_count; s++)
        pairs += set->interfaces[set->sections[s].interface].section_count;
    work->hollow = MESO_NEW(arena, bool, set->section_count, error);
    work->drawn_begin = MESO_NEW(arena, uint64_t, set->section_count, error);
    work->drawn = MESO_NEW(arena, float, pairs, error);
    if (!work->hollow || !work->drawn_begin || !work->drawn)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < set->section_count; s++)
        work->hollow[s] = is_hollow_section(&contours, s);
    pairs = 0;
    for (uint32_t s = 0; s < set->section_count; s++) {
        const MesoInterface *interface = &set->interfaces[set->sections[s].interface];
        work->drawn_begin[s] = pairs;
        for (uint32_t i = 0; i < interface->section_count; i++)
            work->drawn[pairs++] = part_of(
                drawn_nearness(&contours, s, interface->section_begin + i, scale, thickness),
                work->hollow[s] || work->hollow[interface->section_begin + i], 0);
    }
    return MESO_OK;
}

float meso_relax_drawn(const MesoRelaxWork *work, const MesoRelaxNode *a, const MesoRelaxNode *b)
{
    const MesoTileSet *set = &work->model->tile_set;
    if (a->half_edge == MESO_NO_INDEX || a->half_edge != b->half_edge)
        return 1;
    return work->drawn[work->drawn_begin[a->section] + b->section -
                       set->interfaces[set->sections[b->section].interface].section_begin];
}

/* ---- sweeps of a tile ---- */

/* A square for each tile, apart from each other. */
static MesoStatus make_squares(MesoModel *squares, MesoArena *scratch, MesoError *error)
{
    static const MesoVec3 corners[4] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
    uint32_t count = squares->tile_set.tile_count;
    MesoVec3 *positions = MESO_NEW(scratch, MesoVec3, 4 * (size_t)count, error);
    uint32_t *faces = MESO_NEW(scratch, uint32_t, 4 * (size_t)count, error);
    squares->assignment = (MesoAssignment){count, MESO_NEW(scratch, uint32_t, count, error),
                                           MESO_NEW(scratch, MesoTransform, count, error)};
    if (!positions || !faces || !squares->assignment.tile || !squares->assignment.transform)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < 4 * count; i++) {
        positions[i] = meso_vec3_add(corners[i % 4], (MesoVec3){2 * (float)(i / 4), 0, 0});
        faces[i] = i;
        squares->assignment.tile[i / 4] = i / 4;
    }
    MesoStatus status = meso_quad_mesh_build(&squares->surface, scratch, 4 * count, positions, 0, NULL, count, faces,
                                             NULL, error);
    return status ? status : meso_slot_graph_build(&squares->graph, scratch, &squares->surface, error);
}

static bool is_hollow(const MesoRelaxWork *work, const MesoRelaxLink *link)
{
    const MesoSweep *sweep = &work->model->tile_set.sweeps[link->sweep];
    return work->hollow[sweep->from_section] || work->hollow[sweep->to_section];
}

/* What sweeps of tiles look like in their squares. */
typedef struct Drawing {
    MesoScene scene;
    MesoExpansion expansion;
    MesoMeshVertex *vertices;   /* [most of a sweep's] scratch */
} Drawing;

static MesoStatus draw_squares(Drawing *drawing, const MesoRelaxWork *work, const MesoModel *squares,
                               MesoArena *scratch, MesoError *error)
{
    MesoModel model = *squares;
    uint64_t most = 0;
    model.options.divisions = GRAZE_RINGS;
    model.options.section_step = GRAZE_STEP;
    model.inner_meshes = work->model->inner_meshes;
    MesoStatus status = meso_model_expand(&drawing->scene, &drawing->expansion, scratch, &model, 1, error);
    if (status)
        return status;
    for (uint32_t k = 0; k < drawing->scene.kind_count; k++) {
        uint64_t count = (uint64_t)drawing->scene.kinds[k].column_count * drawing->scene.kinds[k].division_count;
        most = count > most ? count : most;
    }
    drawing->vertices = MESO_NEW(scratch, MesoMeshVertex, most, error);
    return drawing->vertices ? MESO_OK : MESO_ERR_MEMORY;
}

/* How far a sweep as drawn gets below what the other one reaches, which is not hollow. */
static float graze_of(const Drawing *drawing, const MesoRelaxWork *cells, const MesoRelaxLink *hollow,
                      const MesoRelaxLink *other)
{
    float most = 0;
    for (uint32_t k = 0; k < drawing->scene.kind_count; k++) {
        const MesoSweptKind *kind = &drawing->scene.kinds[k];
        if (drawing->expansion.origins[k].sweep != hollow->sweep)
            continue;
        uint32_t vertex_count = kind->column_count * kind->division_count;
        meso_sweep_vertices(&drawing->scene, kind, &drawing->scene.sweeps[kind->instance_begin], drawing->vertices);
        for (uint32_t v = 0; v < vertex_count; v++)
            most = fmaxf(most, meso_relax_depth_within(cells, other, drawing->vertices[v].position));
    }
    return most;
}

/* The part that two sweeps of a tile are to keep. */
static float part_of_sweeps(const MesoRelaxWork *work, const MesoRelaxWork *cells, const Drawing *drawing,
                            const MesoRelaxLink *a, const MesoRelaxLink *b)
{
    MesoRelaxNearness drawn = meso_relax_nearness(cells, a, b);
    bool hollow[2] = {is_hollow(work, a), is_hollow(work, b)};
    float graze = 0;
    if (drawn.needed > 0 && a != b && hollow[0] != hollow[1])
        graze = hollow[0] ? graze_of(drawing, cells, a, b) : graze_of(drawing, cells, b, a);
    return part_of(drawn, hollow[0] || hollow[1], graze > GRAZE_MOST ? 0 : graze);
}

static MesoStatus find_meant(MesoRelaxWork *work, const MesoRelaxWork *cells, const Drawing *drawing, MesoArena *arena,
                             MesoError *error)
{
    const MesoTileSet *set = &work->model->tile_set;
    uint64_t pairs = 0;
    for (uint32_t t = 0; t < set->tile_count; t++)
        pairs += (uint64_t)set->tiles[t].sweep_count * set->tiles[t].sweep_count;
    work->meant_begin = MESO_NEW(arena, uint64_t, set->sweep_count, error);
    work->meant = MESO_NEW(arena, float, pairs, error);
    if (!work->meant_begin || !work->meant)
        return MESO_ERR_MEMORY;
    pairs = 0;
    for (uint32_t begin = 0, end; begin < cells->link_count; begin = end) {
        for (end = begin + 1; end < cells->link_count && cells->links[end].slot == cells->links[begin].slot;)
            end++;
        for (uint32_t a = begin; a < end; a++) {
            work->meant_begin[cells->links[a].sweep] = pairs;
            for (uint32_t b = begin; b < end; b++)
                work->meant[pairs++] = part_of_sweeps(work, cells, drawing, &cells->links[a], &cells->links[b]);
        }
    }
    return MESO_OK;
}

float meso_relax_meant(const MesoRelaxWork *work, const MesoRelaxLink *a, const MesoRelaxLink *b)
{
    const MesoTileSet *set = &work->model->tile_set;
    uint32_t first = set->tiles[work->model->assignment.tile[a->slot]].sweep_begin;
    return work->meant[work->meant_begin[a->sweep] + b->sweep - first];
}

MesoStatus meso_relax_find_meant(MesoRelaxWork *work, MesoArena *arena, MesoError *error)
{
    MesoArena scratch;
    float mean = work->model->surface.mean_edge_length, edge = mean > 0 ? mean : 1;
    float scale = work->options.section_scale / edge, thickness = work->options.thickness / edge;
    MesoModel squares = {.tile_set = work->model->tile_set,
                         .options = {.thickness = thickness, .section_scale = scale,
                                     .tangent_scale = work->options.tangent_scale, .frame = work->options.frame}};
    MesoRelaxWork cells = {.model = &squares, .options = meso_map_options_resolve(squares.options, 1)};
    Drawing drawing;
    meso_arena_init(&scratch);
    MesoStatus status = find_drawn(work, scale, thickness, arena, &scratch, error);
    if (!status)
        status = make_squares(&squares, &scratch, error);
    if (!status)
        status = meso_relax_build(&cells, &scratch, error);
    for (uint32_t i = 0; i < cells.link_count && !status; i++)
        meso_relax_trace(&cells.links[i], cells.nodes);
    if (!status)
        status = draw_squares(&drawing, work, &squares, &scratch, error);
    if (!status)
        status = find_meant(work, &cells, &drawing, arena, error);
    meso_arena_release(&scratch);
    return status;
}
