#include <math.h>
#include <string.h>

#include "libcore/math/bezier.h"
#include "libcore/tiling/relax/relax_work.h"
#include "libcore/tiling/strand/profile.h"
#include "libcore/tiling/strand/trajectory.h"

/* Of drawings: what it takes to know how far they reach. */
static const float CONTOUR_STEP = 0.02f;

/* Of the farthest that round sections reach, the least: they are sampled. */
static const float ROUND = 0.98f;

/* Of sections without area, in edge lengths: how far their trajectories may go at once. */
static const float NO_AREA = 0.02f;

typedef struct Builder {
    MesoRelaxWork *work;
    MesoContourSet contours;
    MesoProfileSet profiles;
    MesoStrandJoints joints;
    MesoPortFinder ports;
    uint32_t fixed;         /* nodes behind the joints that are in use */
} Builder;

/* ---- shapes ---- */

static void add_kind(MesoRelaxShape *shape, const MesoSweptKind *kind, const MesoSweepColumn *columns)
{
    const float step = 2 * (float)MESO_PI / MESO_RELAX_DIRECTIONS;
    float sum = 0;
    shape->turn = kind->turn;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        sum += (meso_vec2_length(columns[c].start) + meso_vec2_length(columns[c].end)) / 2;
        for (uint32_t k = 0; k < MESO_RELAX_DIRECTIONS; k++) {
            float x = cosf((float)k * step), y = sinf((float)k * step);
            shape->reach[0][k] = fmaxf(shape->reach[0][k], columns[c].start.x * x + columns[c].start.y * y);
            shape->reach[1][k] = fmaxf(shape->reach[1][k], columns[c].end.x * x + columns[c].end.y * y);
        }
    }
    shape->mean = fmaxf(shape->mean, kind->column_count ? sum / (float)kind->column_count : 0);
}

static bool is_round(const float reach[MESO_RELAX_DIRECTIONS])
{
    float least = reach[0], most = reach[0];
    for (uint32_t k = 1; k < MESO_RELAX_DIRECTIONS; k++) {
        least = fminf(least, reach[k]);
        most = fmaxf(most, reach[k]);
    }
    return least > ROUND * most;
}

static void measure_shape(MesoRelaxShape *shape)
{
    const uint32_t half = MESO_RELAX_DIRECTIONS / 2;
    shape->thin = INFINITY;
    for (uint32_t end = 0; end < 2; end++)
        for (uint32_t k = 0; k < MESO_RELAX_DIRECTIONS; k++) {
            float width = shape->reach[end][k] + shape->reach[end][(k + half) % MESO_RELAX_DIRECTIONS];
            shape->most = fmaxf(shape->most, shape->reach[end][k]);
            shape->thin = fminf(shape->thin, width / 2);
        }
    shape->round = is_round(shape->reach[0]) && is_round(shape->reach[1]);
    if (!(shape->thin > 0))
        shape->thin = NO_AREA;
}

static MesoStatus make_shapes(Builder *b, MesoArena *arena, MesoError *error)
{
    MesoRelaxWork *work = b->work;
    uint32_t sweep_count = work->model->tile_set.sweep_count;
    work->shapes = MESO_NEW(arena, MesoRelaxShape, 2 * (size_t)sweep_count, error);
    if (!work->shapes)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < b->profiles.kind_count; k++) {
        const MesoKindOrigin *origin = &b->profiles.origins[k];
        if (origin->sweep != MESO_NO_INDEX)
            add_kind(&work->shapes[origin->sweep + (origin->mirrored ? sweep_count : 0)], &b->profiles.kinds[k],
                     b->profiles.columns + b->profiles.kinds[k].column_begin);
    }
    for (uint32_t s = 0; s < 2 * sweep_count; s++)
        measure_shape(&work->shapes[s]);
    return MESO_OK;
}

/* ---- nodes ---- */

void meso_relax_place(MesoRelaxNode *node)
{
    const MesoWallMove *move = &node->move;
    node->point = meso_wall_point(&node->wall, node->place.x + move->along, node->place.y + move->rise);
    MesoVec3 lean = meso_vec3_mad(meso_vec3_scale(node->axes[0], move->lean_along), move->lean_rise, node->axes[1]);
    node->tangent = meso_vec3_unit(meso_vec3_add(node->wall.normal, lean), node->wall.normal);
}

/* How far a drawing reaches along and up, in edge lengths. */
static MesoVec2 section_reach(const MesoContourSet *contours, uint32_t section)
{
    MesoVec2 reach = {0, 0};
    for (uint32_t c = contours->section_begin[section]; c < contours->section_begin[section + 1]; c++)
        for (uint32_t i = 0; i < contours->contours[c].point_count; i++) {
            MesoVec2 p = contours->points[contours->contours[c].point_begin + i];
            reach.x = fmaxf(reach.x, fabsf(p.x));
            reach.y = fmaxf(reach.y, fabsf(p.y));
        }
    return reach;
}

/* Moves along one axis that keep a section of this half width within [0,1], or no farther out than it was. */
static void bound_move(float place, float half, float *low, float *high)
{
    *low = -fminf(MESO_RELAX_REACH, fmaxf(place - half, 0));
    *high = fminf(MESO_RELAX_REACH, fmaxf(1 - half - place, 0));
}

/* A node as the slot that speaks for its wall sees it. */
static void make_wall_node(const Builder *b, MesoRelaxNode *node, const MesoWall *wall, uint32_t slot, uint32_t side,
                           uint32_t section, bool flipped, float scale)
{
    MesoVec2 reach = section_reach(&b->contours, section);
    node->wall = *wall;
    node->half_edge = 4 * slot + side;
    node->section = section;
    node->place = meso_wall_place(wall, b->contours.center[section], flipped);
    meso_wall_axes(wall, node->axes);
    float width = meso_vec3_length(meso_vec3_lerp(meso_vec3_sub(wall->low[1], wall->low[0]),
                                                  meso_vec3_sub(wall->high[1], wall->high[0]), 0.5f));
    float height = meso_vec3_length(meso_vec3_lerp(meso_vec3_sub(wall->high[0], wall->low[0]),
                                                   meso_vec3_sub(wall->high[1], wall->low[1]), 0.5f));
    bound_move(node->place.x, scale * reach.x / width, &node->low.x, &node->high.x);
    bound_move(node->place.y, scale * reach.y / height, &node->low.y, &node->high.y);
    meso_relax_place(node);
}

/* ---- links ---- */

static float one_if_none(float scale)
{
    return scale == 0 ? 1 : scale;
}

/* The node of an end of a sweep. Bit 0 of its `seen` is for links on the side of the tangent, bit 1 for others. */
static MesoStatus find_node(Builder *b, MesoRelaxLink *link, uint32_t end, uint32_t tile_side, uint32_t section,
                            uint8_t *seen, MesoError *error)
{
    MesoRelaxWork *work = b->work;
    const MesoModel *model = work->model;
    MesoPort port;
    MesoStatus status = meso_port_find(&b->ports, link->slot, tile_side, section, &port, error);
    if (status)
        return status;
    uint32_t number = meso_strand_joint(&b->joints, &model->assignment, &model->tile_set, link->slot, tile_side,
                                        section);
    uint32_t side = meso_transform_side(model->assignment.transform[link->slot], tile_side);
    uint32_t twin = side < 4 ? model->graph.twin[4 * (size_t)link->slot + side] : MESO_NO_INDEX;
    MesoWall wall = {0};
    if (side < 4)
        wall = meso_shell_wall(&work->shell, link->slot, side);
    bool other = twin != MESO_NO_INDEX && twin < 4 * link->slot + side;
    if (other && !wall.reversed)    /* what both slots draw there is not one shape */
        number = work->joint_count + b->fixed++;
    MesoRelaxNode *node = &work->nodes[number];
    link->node[end] = number;
    link->sign[end] = wall.reversed ? -1 : 1;
    link->up[end] = port.up;
    seen[number] |= wall.reversed ? 2 : 1;
    if (side >= 4 || (other && !wall.reversed)) {
        node->point = port.point;
        node->tangent = port.inward;
        node->half_edge = node->section = MESO_NO_INDEX;
        return MESO_OK;
    }
    bool flipped = meso_port_flipped(model, link->slot, tile_side) != wall.reversed;
    uint32_t half_edge = wall.reversed ? twin : 4 * link->slot + side;
    if (wall.reversed)      /* as the slot that speaks sees it */
        wall.reversed = false;
    make_wall_node(b, node, &wall, half_edge / 4, half_edge % 4, section, flipped, link->scale[end]);
    return MESO_OK;
}

static MesoStatus make_link(Builder *b, uint32_t slot, uint32_t number, uint8_t *seen, MesoRelaxLink *link,
                            MesoError *error)
{
    MesoRelaxWork *work = b->work;
    const MesoTileSet *set = &work->model->tile_set;
    const MesoAssignment *a = &work->model->assignment;
    const MesoSweep *sweep = &set->sweeps[number];
    bool mirrored = meso_transform_flips(a->transform[slot]);
    float scale = work->options.section_scale;
    *link = (MesoRelaxLink){.slot = slot, .sweep = number, .room = work->room,
                            .shape = number + (mirrored ? set->sweep_count : 0),
                            .same_side = sweep->from_side == sweep->to_side,
                            .tangent_scale = work->options.tangent_scale *
                                             one_if_none(set->tiles[a->tile[slot]].tangent_scale) *
                                             one_if_none(sweep->tangent_scale),
                            .scale = {scale * meso_port_size(&b->ports, slot, sweep->from_side),
                                      scale * meso_port_size(&b->ports, slot, sweep->to_side)}};
    MesoStatus status = find_node(b, link, 0, sweep->from_side, sweep->from_section, seen, error);
    return status ? status : find_node(b, link, 1, sweep->to_side, sweep->to_section, seen, error);
}

void meso_relax_control(const MesoRelaxLink *link, const MesoRelaxNode *start, const MesoRelaxNode *end,
                        MesoVec3 p[4])
{
    const MesoPort ports[2] = {{start->point, link->up[0], meso_vec3_scale(start->tangent, link->sign[0])},
                               {end->point, link->up[1], meso_vec3_scale(end->tangent, link->sign[1])}};
    meso_trajectory(&ports[0], &ports[1], link->same_side, link->tangent_scale, p);
}

void meso_relax_trace(MesoRelaxLink *link, const MesoRelaxNode *nodes)
{
    meso_relax_control(link, &nodes[link->node[0]], &nodes[link->node[1]], link->p);
    for (uint32_t i = 0; i <= MESO_RELAX_CHORDS; i++)
        link->points[i] = meso_bezier_point(link->p, (float)i / MESO_RELAX_CHORDS);
    for (uint32_t i = 0; i < MESO_RELAX_CHORDS; i++) {
        link->middles[i] = meso_vec3_lerp(link->points[i], link->points[i + 1], 0.5f);
        MesoVec3 along = meso_vec3_sub(link->points[i + 1], link->points[i]), none = {0, 0, 0};
        MesoVec3 tangent = meso_vec3_unit(along, none);
        MesoVec3 up = meso_vec3_lerp(link->up[0], link->up[1], ((float)i + 0.5f) / MESO_RELAX_CHORDS);
        link->halves[i] = meso_vec3_length(along) / 2;
        link->axes[i][0] = meso_vec3_unit(meso_vec3_cross(up, tangent), none);
        link->axes[i][1] = meso_vec3_cross(tangent, link->axes[i][0]);
    }
    link->box = meso_box_of(link->points, MESO_RELAX_CHORDS + 1);
}

static uint32_t tile_sweeps(const MesoRelaxWork *work, uint32_t slot)
{
    return work->model->tile_set.tiles[work->model->assignment.tile[slot]].sweep_count;
}

static MesoStatus make_links(Builder *b, MesoArena *arena, MesoArena *scratch, MesoError *error)
{
    MesoRelaxWork *work = b->work;
    uint64_t count = 0;
    for (uint32_t slot = 0; slot < work->model->assignment.slot_count; slot++)
        count += tile_sweeps(work, slot);
    if (count > UINT32_MAX / 4 || work->joint_count > UINT32_MAX / 4)
        return meso_fail(error, MESO_ERR_LIMIT, "over 2^30 sweeps; split the surface");
    uint64_t room = work->joint_count + 2 * count;
    uint8_t *seen = MESO_NEW(scratch, uint8_t, room, error);
    work->nodes = MESO_NEW(arena, MesoRelaxNode, room, error);
    work->links = MESO_NEW(arena, MesoRelaxLink, count, error);
    if (!seen || !work->nodes || !work->links)
        return MESO_ERR_MEMORY;
    for (uint32_t slot = 0; slot < work->model->assignment.slot_count; slot++) {
        const MesoTile *tile = &work->model->tile_set.tiles[work->model->assignment.tile[slot]];
        for (uint32_t s = tile->sweep_begin; s < tile->sweep_begin + tile->sweep_count; s++) {
            MesoStatus status = make_link(b, slot, s, seen, &work->links[work->link_count++], error);
            if (status)
                return status;
        }
    }
    work->node_count = work->joint_count + b->fixed;
    for (uint32_t n = 0; n < work->joint_count; n++)
        work->nodes[n].free = seen[n] == 3;
    return MESO_OK;
}

static MesoStatus list_ends(MesoRelaxWork *work, MesoArena *arena, MesoError *error)
{
    work->end_begin = MESO_NEW(arena, uint32_t, (size_t)work->node_count + 1, error);
    work->ends = MESO_NEW(arena, uint32_t, 2 * (size_t)work->link_count, error);
    work->next = MESO_NEW(arena, MesoWallMove, work->node_count, error);
    if (!work->end_begin || !work->ends || !work->next)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < 2 * work->link_count; i++)
        work->end_begin[work->links[i / 2].node[i % 2]]++;
    for (uint32_t n = 0, sum = 0; n <= work->node_count; n++) {
        uint32_t here = work->end_begin[n];
        sum += here;
        work->end_begin[n] = sum;
    }
    for (uint32_t i = 2 * work->link_count; i-- > 0;)
        work->ends[--work->end_begin[work->links[i / 2].node[i % 2]]] = i;
    for (uint32_t n = 0; n < work->node_count; n++)
        work->nodes[n].thin = INFINITY;
    for (uint32_t i = 0; i < 2 * work->link_count; i++) {
        const MesoRelaxLink *link = &work->links[i / 2];
        MesoRelaxNode *node = &work->nodes[link->node[i % 2]];
        work->links[i / 2].bound = work->shapes[link->shape].most * fmaxf(link->scale[0], link->scale[1]);
        node->thin = fminf(node->thin, link->scale[i % 2] * work->shapes[link->shape].thin);
    }
    return MESO_OK;
}

/* ---- all of it ---- */

MesoStatus meso_relax_build(MesoRelaxWork *work, MesoArena *arena, MesoError *error)
{
    MesoArena scratch;
    Builder b = {.work = work};
    const MesoModel *model = work->model;
    meso_arena_init(&scratch);
    MesoStatus status = meso_contour_set_build(&b.contours, &scratch, &model->tile_set, CONTOUR_STEP, error);
    if (!status)
        status = meso_profile_set_build(&b.profiles, &scratch, &model->tile_set, &b.contours, 2, (MesoColumnLimits){0},
                                        error);
    if (!status)
        status = meso_model_shell(&work->shell, arena, model, error);
    if (!status)
        status = meso_strand_joints_number(&b.joints, &scratch, &model->assignment, &model->tile_set, &model->graph,
                                           error);
    if (!status)
        status = meso_port_finder_make(&b.ports, &scratch, model, &work->shell, b.contours.center, error);
    work->joint_count = b.joints.count;
    if (!status)
        status = make_shapes(&b, arena, error);
    if (!status)
        status = make_links(&b, arena, &scratch, error);
    if (!status)
        status = list_ends(work, arena, error);
    meso_arena_release(&scratch);
    return status;
}
