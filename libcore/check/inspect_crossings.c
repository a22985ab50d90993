/* Triangles that cut through each other, and the things that they are of. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"
#include "libcore/check/inspect_work.h"

/* GRAIN leaves are looked through at a time; the last FEW pairs of things that were met are remembered. */
enum { GRAIN = 256, FEW = 8, SEEDS = 4, BETWEEN = 1, WITHIN = 2 };

/* Triangles that are followed into what they cut through: as many a pair, and all together. */
enum { LEAST_FOLLOWED = 4, MOST_FOLLOWED = 32, DEPTH_WORK = 1 << 14 };

MesoStatus meso_inspect_triangle_tree(MesoInspectWork *work, MesoError *error)
{
    const MesoInspectedMesh *mesh = work->mesh;
    MesoArena boxes;
    meso_arena_init(&boxes);
    MesoBox *box_of = MESO_NEW(&boxes, MesoBox, mesh->triangle_count, error);
    for (uint32_t t = 0; box_of && t < mesh->triangle_count; t++) {
        box_of[t] = meso_box_empty();
        for (uint32_t k = 0; k < 3 && work->mates[3 * t] != MESO_MATE_OUT && meso_inspect_is_finite(mesh, t); k++)
            meso_box_add(&box_of[t], meso_inspect_corner(mesh, 3 * t + k));
    }
    MesoStatus status = box_of ? meso_inspect_tree_build(&work->tree, work->scratch, box_of, work->things,
                                                         mesh->triangle_count, error)
                               : MESO_ERR_MEMORY;
    meso_arena_release(&boxes);
    return status;
}

/* ---- two triangles ---- */

bool meso_inspect_pierces(const MesoInspectTriangle *t, MesoVec3d p, MesoVec3d q, double rounding,
                          MesoInspectHole *hole)
{
    double above = meso_vec3d_dot(t->normal, meso_vec3d_sub(p, t->p[0]));
    double below = meso_vec3d_dot(t->normal, meso_vec3d_sub(q, t->p[0]));
    if (!((above > rounding && below < -rounding) || (above < -rounding && below > rounding)))
        return false;
    MesoVec3d at = meso_vec3d_mad(p, above / (above - below), meso_vec3d_sub(q, p));
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3d side = meso_vec3d_sub(t->p[(k + 1) % 3], t->p[k]);
        double height = meso_vec3d_det(t->normal, side, meso_vec3d_sub(at, t->p[k]));
        if (!(height > rounding * meso_vec3d_length(side)))
            return false;
    }
    *hole = (MesoInspectHole){at, below < 0 ? q : p};
    return true;
}

static bool share_a_place(const uint32_t *a, const uint32_t *b)
{
    for (int i = 0; i < 3; i++)
        if (a[i] == b[0] || a[i] == b[1] || a[i] == b[2])
            return true;
    return false;
}

static bool triangles_cross(const MesoInspectTriangle *s, const MesoInspectTriangle *t, double rounding)
{
    MesoInspectHole hole;
    for (uint32_t k = 0; k < 3; k++)
        if (meso_inspect_pierces(t, s->p[k], s->p[(k + 1) % 3], rounding, &hole) ||
            meso_inspect_pierces(s, t->p[k], t->p[(k + 1) % 3], rounding, &hole))
            return true;
    return false;
}

/* ---- all of them ---- */

/* What one range of leaves gives. */
typedef struct Range {
    MesoInspectCut *cuts;
    uint32_t count, room;
} Range;

typedef struct Crossings {
    MesoInspectWork *work;
    Range *ranges;
    MesoArena *arenas;              /* [workers] */
    _Atomic uint8_t *crosses;       /* [triangle_count] bits */
    atomic_bool out_of_memory;
} Crossings;

/* One leaf, and what is asked of the leaves that it meets. */
typedef struct LeafAsking {
    Crossings *crossings;
    Range *range;
    MesoArena *arena;
    uint32_t leaf;
    MesoBox boxes[MESO_INSPECT_LEAF];
    MesoInspectTriangle triangles[MESO_INSPECT_LEAF];
} LeafAsking;

static MesoBox box_of(const MesoInspectedMesh *mesh, uint32_t t)
{
    MesoBox box = meso_box_empty();
    for (uint32_t k = 0; k < 3; k++)
        meso_box_add(&box, meso_inspect_corner(mesh, 3 * t + k));
    return box;
}

static void note_cut(LeafAsking *asking, uint32_t s, uint32_t t)
{
    const MesoInspectWork *work = asking->crossings->work;
    Range *range = asking->range;
    if (work->things[s] > work->things[t] || (work->things[s] == work->things[t] && s > t)) {
        uint32_t swapped = s;
        s = t;
        t = swapped;
    }
    uint32_t a = work->things[s], b = work->things[t];
    uint8_t bit = a == b ? WITHIN : BETWEEN;
    atomic_fetch_or_explicit(&asking->crossings->crosses[s], bit, memory_order_relaxed);
    atomic_fetch_or_explicit(&asking->crossings->crosses[t], bit, memory_order_relaxed);
    for (uint32_t i = range->count; i-- > 0 && range->count - i <= FEW;)
        if (range->cuts[i].a == a && range->cuts[i].b == b) {
            range->cuts[i].pairs++;
            return;
        }
    MesoInspectCut *cuts = MESO_GROW(asking->arena, range->cuts, range->count, range->room, 4, NULL);
    if (!cuts) {
        asking->crossings->out_of_memory = true;
        range->room = range->count;
        return;
    }
    range->cuts = cuts;
    range->cuts[range->count++] = (MesoInspectCut){a, b, s, t, 1};
}

static void compare_leaves(void *context, uint32_t leaf)
{
    LeafAsking *asking = context;
    const MesoInspectWork *work = asking->crossings->work;
    const MesoInspectTree *tree = &work->tree;
    uint32_t begin = MESO_INSPECT_LEAF * asking->leaf, count = meso_inspect_leaf_end(tree, asking->leaf) - begin;
    for (uint32_t i = MESO_INSPECT_LEAF * leaf; i < meso_inspect_leaf_end(tree, leaf); i++) {
        uint32_t t = tree->order[i];
        MesoBox box = box_of(work->mesh, t);
        for (uint32_t k = 0; k < count && begin + k < i; k++) {
            uint32_t s = tree->order[begin + k];
            if (!meso_boxes_meet(&asking->boxes[k], &box) || share_a_place(&work->places[3 * s], &work->places[3 * t]))
                continue;
            MesoInspectTriangle triangle = meso_inspect_triangle(work->mesh, t);
            if (triangles_cross(&asking->triangles[k], &triangle, work->rounding))
                note_cut(asking, s, t);
        }
    }
}

static void look_through(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Crossings *crossings = context;
    const MesoInspectWork *work = crossings->work;
    const MesoInspectTree *tree = &work->tree;
    LeafAsking asking = {.crossings = crossings, .range = &crossings->ranges[begin / GRAIN],
                         .arena = &crossings->arenas[worker]};
    for (uint64_t leaf = begin; leaf < end; leaf++) {
        asking.leaf = (uint32_t)leaf;
        for (uint32_t i = MESO_INSPECT_LEAF * asking.leaf; i < meso_inspect_leaf_end(tree, asking.leaf); i++) {
            asking.boxes[i % MESO_INSPECT_LEAF] = box_of(work->mesh, tree->order[i]);
            asking.triangles[i % MESO_INSPECT_LEAF] = meso_inspect_triangle(work->mesh, tree->order[i]);
        }
        meso_inspect_tree_meet(tree, tree->boxes[tree->leaf_room + leaf], MESO_NO_INDEX, asking.leaf, compare_leaves,
                               &asking);
    }
}

/* ---- pairs of things ---- */

static int compare_cuts(const void *a, const void *b)
{
    const MesoInspectCut *x = a, *y = b;
    const uint32_t p[] = {x->a, x->b, x->s, x->t}, q[] = {y->a, y->b, y->s, y->t};
    for (int i = 0; i < 4; i++)
        if (p[i] != q[i])
            return p[i] < q[i] ? -1 : 1;
    return 0;
}

/* Cuts of one pair of things, or of one thing with itself. */
typedef struct Group {
    const MesoInspectCut *cuts;
    uint32_t count;
    double depth;
} Group;

typedef struct Groups {
    const MesoInspectWork *work;
    Group *groups;
    uint32_t count;
} Groups;

/* From cuts at even distances: they are sorted by triangles, and so lie along the things. */
static void measure_depths(void *context, uint64_t begin, uint64_t end)
{
    const Groups *groups = context;
    uint32_t most = DEPTH_WORK / groups->count;
    most = most < LEAST_FOLLOWED ? LEAST_FOLLOWED : most > MOST_FOLLOWED ? MOST_FOLLOWED : most;
    for (uint64_t g = begin; g < end; g++) {
        Group *group = &groups->groups[g];
        MesoInspectCut seeds[SEEDS];
        uint32_t count = group->count < SEEDS ? group->count : SEEDS;
        for (uint32_t i = 0; i < count; i++)
            seeds[i] = group->cuts[(uint64_t)i * group->count / count];
        group->depth = meso_inspect_depth(groups->work, seeds, count, most);
    }
}

static void note_group(MesoInspectWork *work, const Group *group)
{
    const MesoInspectCut *cut = group->cuts;
    MesoInspection *result = work->result;
    uint64_t pairs = 0;
    for (uint32_t i = 0; i < group->count; i++)
        pairs += group->cuts[i].pairs;
    meso_inspect_note(work, cut->a == cut->b ? MESO_FAULT_SELF_CROSSING : MESO_FAULT_CROSSING, cut->s, group->depth);
    if (cut->a == cut->b) {
        result->findings[MESO_FAULT_SELF_CROSSING].count += pairs - 1;
        return;
    }
    result->pairs[result->pair_count++] = (MesoCrossingPair){
        .a = work->thing_ids ? work->thing_ids[cut->a] : cut->a,
        .b = work->thing_ids ? work->thing_ids[cut->b] : cut->b,
        .triangle_pairs = pairs, .depth = group->depth, .triangle = cut->s};
}

static MesoStatus group_cuts(MesoInspectWork *work, MesoInspectCut *cuts, uint32_t count, MesoError *error)
{
    Groups groups = {.work = work, .groups = MESO_NEW(work->scratch, Group, count, error)};
    work->result->pairs = MESO_NEW(work->arena, MesoCrossingPair, count, error);
    if (!groups.groups || !work->result->pairs)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || cuts[i].a != cuts[i - 1].a || cuts[i].b != cuts[i - 1].b)
            groups.groups[groups.count++].cuts = &cuts[i];
        groups.groups[groups.count - 1].count++;
    }
    meso_parallel_for(work->options->thread_count, groups.count, 1, measure_depths, &groups);
    for (uint32_t g = 0; g < groups.count; g++)
        note_group(work, &groups.groups[g]);
    return MESO_OK;
}

static MesoStatus collect(Crossings *crossings, uint64_t range_count, MesoError *error)
{
    MesoInspectWork *work = crossings->work;
    uint64_t count = 0;
    for (uint64_t r = 0; r < range_count; r++)
        count += crossings->ranges[r].count;
    MesoInspectCut *cuts = count < UINT32_MAX ? MESO_NEW(work->scratch, MesoInspectCut, count, error) : NULL;
    if (!cuts)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for %llu crossings", (unsigned long long)count);
    for (uint64_t r = 0, to = 0; r < range_count; to += crossings->ranges[r].count, r++)
        if (crossings->ranges[r].count)
            memcpy(&cuts[to], crossings->ranges[r].cuts, crossings->ranges[r].count * sizeof *cuts);
    if (count)
        qsort(cuts, count, sizeof *cuts, compare_cuts);
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        uint8_t bits = crossings->crosses[t];
        work->result->marks[t] |= (bits & BETWEEN ? 1u << MESO_FAULT_CROSSING : 0) |
                                  (bits & WITHIN ? 1u << MESO_FAULT_SELF_CROSSING : 0);
    }
    return group_cuts(work, cuts, (uint32_t)count, error);
}

MesoStatus meso_inspect_crossings(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint32_t workers = work->options->thread_count ? work->options->thread_count : meso_parallel_cores();
    uint64_t range_count = (work->tree.leaf_count + (uint64_t)GRAIN - 1) / GRAIN;
    Crossings crossings = {.work = work};
    crossings.ranges = MESO_NEW(work->scratch, Range, range_count, error);
    crossings.arenas = MESO_NEW(work->scratch, MesoArena, workers, error);
    crossings.crosses = MESO_NEW(work->scratch, _Atomic uint8_t, work->mesh->triangle_count, error);
    if (!crossings.ranges || !crossings.arenas || !crossings.crosses)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < workers; i++)
        meso_arena_init(&crossings.arenas[i]);
    meso_parallel_team(workers, work->tree.leaf_count, GRAIN, look_through, &crossings);
    MesoStatus status = crossings.out_of_memory ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for crossings")
                                                : collect(&crossings, range_count, error);
    for (uint32_t i = 0; i < workers; i++)
        meso_arena_release(&crossings.arenas[i]);
    meso_arena_rewind(work->scratch, mark);
    return status;
}
