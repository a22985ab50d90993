/* Pieces that lie apart: by boxes, since what is woven or linked does not touch. */
#include "libcore/base/disjoint_sets.h"
#include "libcore/check/inspect_work.h"

typedef struct Pieces {
    const MesoBox *boxes;           /* [piece_count] */
    uint32_t *sets;
    const MesoInspectTree *tree;
    uint32_t asking;
} Pieces;

static void join_leaf(void *context, uint32_t leaf)
{
    const Pieces *pieces = context;
    for (uint32_t i = MESO_INSPECT_LEAF * leaf; i < meso_inspect_leaf_end(pieces->tree, leaf); i++)
        if (meso_boxes_meet(&pieces->boxes[pieces->tree->order[i]], &pieces->boxes[pieces->asking]))
            meso_sets_join(pieces->sets, pieces->asking, pieces->tree->order[i]);
}

static void measure_pieces(const MesoInspectWork *work, MesoBox *boxes, double *areas, uint32_t *first)
{
    for (uint32_t p = 0; p < work->piece_count; p++)
        boxes[p] = meso_box_empty();
    for (uint32_t t = work->mesh->triangle_count; t-- > 0;) {
        uint32_t piece = work->pieces[t];
        first[piece] = t;
        if (!meso_inspect_is_finite(work->mesh, t))
            continue;
        areas[piece] += meso_vec3d_length(meso_inspect_area(work->mesh, t));
        for (uint32_t k = 0; k < 3; k++)
            meso_box_add(&boxes[piece], meso_inspect_corner(work->mesh, 3 * t + k));
    }
}

/* The set with most of the area; of equals the first. */
static uint32_t find_largest(const MesoInspectWork *work, uint32_t *sets, double *areas)
{
    uint32_t largest = 0;
    for (uint32_t p = work->piece_count; p-- > 0;)
        if (meso_sets_root(sets, p) != p)
            areas[meso_sets_root(sets, p)] += areas[p];
    for (uint32_t p = 0; p < work->piece_count; p++)
        if (meso_sets_root(sets, p) == p && areas[p] > areas[meso_sets_root(sets, largest)])
            largest = p;
    return meso_sets_root(sets, largest);
}

static MesoStatus find_floating(MesoInspectWork *work, MesoError *error)
{
    uint32_t count = work->piece_count;
    MesoInspectTree tree;
    MesoBox *boxes = MESO_NEW(work->scratch, MesoBox, count, error);
    double *areas = MESO_NEW(work->scratch, double, count, error);
    uint32_t *first = MESO_NEW(work->scratch, uint32_t, count, error);
    uint32_t *sets = MESO_NEW(work->scratch, uint32_t, count, error);
    if (!boxes || !areas || !first || !sets)
        return MESO_ERR_MEMORY;
    measure_pieces(work, boxes, areas, first);
    meso_sets_init(sets, count);
    MesoStatus status = meso_inspect_tree_build(&tree, work->scratch, boxes, NULL, count, error);
    if (status)
        return status;
    Pieces pieces = {boxes, sets, &tree, 0};
    for (pieces.asking = 0; pieces.asking < count; pieces.asking++)
        meso_inspect_tree_meet(&tree, boxes[pieces.asking], MESO_NO_INDEX, 0, join_leaf, &pieces);
    uint32_t largest = find_largest(work, sets, areas);
    for (uint32_t p = 0; p < count; p++)
        if (meso_sets_root(sets, p) != largest)
            meso_inspect_note(work, MESO_FAULT_FLOATING, first[p], 0);
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++)
        if (meso_sets_root(sets, work->pieces[t]) != largest)
            work->result->marks[t] |= 1u << MESO_FAULT_FLOATING;
    return MESO_OK;
}

MesoStatus meso_inspect_floats(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    MesoStatus status = work->piece_count > 1 ? find_floating(work, error) : MESO_OK;
    meso_arena_rewind(work->scratch, mark);
    return status;
}
