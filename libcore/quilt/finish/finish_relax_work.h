/* What strands are relaxed by: rings of a quilt, and where they should have each other. */
#ifndef MESO_FINISH_RELAX_WORK_H
#define MESO_FINISH_RELAX_WORK_H

#include "libcore/quilt/finish/finish_work.h"
#include "libcore/quilt/quilt_work.h"

/* Rings that are looked for around each ring of the swatch. */
enum { MESO_RELAX_DIRECTIONS = 6, MESO_RELAX_NEAR = 2 * MESO_RELAX_DIRECTIONS + 2 };

/* Nodes that are looked at by one core at a time; and so many at once where what is found is then put in order. */
enum { MESO_RELAX_BLOCK = 256, MESO_RELAX_BATCH = 8192 };

/* Lengths as shares of the swatch's shorter side: below it, errors count by length, not by share of their distance. */
#define MESO_RELAX_SOFT 0.05f

typedef struct MesoRelaxNode {
    MesoVec3 foot, normal;      /* its middle on the surface, up */
    MesoVec3 origin;            /* its middle in the swatch */
    float height, rise;         /* of its middle; by which that has changed */
    MesoVec3 x, y;              /* along the surface */
    uint32_t name, patch;       /* ring of the swatch, and which copy of that */
    uint32_t count;             /* vertices */
    uint32_t next[2];           /* along the strand, or MESO_NO_INDEX */
} MesoRelaxNode;

/* Where a ring should have another one. */
typedef struct MesoRelaxPair {
    uint32_t to;
    float x, y;                 /* in the swatch, in the surface's units */
    float weight;               /* 0: it is meant to be elsewhere */
} MesoRelaxPair;

/* A pair seen from where it leads to. */
typedef struct MesoRelaxInto {
    uint32_t from;
    float weight;
} MesoRelaxInto;

/* A pair across the way of a strand of another patch, wherever along it. */
typedef struct MesoRelaxGuess {
    uint32_t from;
    MesoRelaxPair pair;
    MesoVec3 across;            /* unit, along the surface */
} MesoRelaxGuess;

typedef struct MesoRelaxing {
    const MesoSwatch *swatch;
    const MesoStrandRings *rings;       /* of the swatch */
    uint32_t *near;             /* [MESO_RELAX_NEAR * rings->count] rings around each, or MESO_NO_INDEX */
    float scale, height_scale;  /* of the swatch */
    float side;                 /* its shorter side in the surface's units */
    uint32_t node_count;
    MesoRelaxNode *nodes;
    uint32_t *table, mask;      /* nodes hashed by patch and name */
    uint32_t *begin;            /* [node_count + 1] into the pairs */
    MesoRelaxPair *pairs;
    uint32_t *into_begin;       /* [node_count + 1] into: */
    MesoRelaxInto *into;        /* [pairs] those that lead to each node, in their order */
    uint32_t guess_count, guess_room;
    MesoRelaxGuess *guesses;
    uint32_t *heads, *next_in_cell;     /* [mask + 1], [node_count] nodes hashed by place */
    double *cosines, *sines;    /* [node_count] the swatch's turn there */
    double *weights;            /* [node_count] of all pairs of each, either way */
    double *moves;              /* [3 * node_count] */
    uint32_t *carriers;         /* [swatch->element_count] ring that a whole element grows from, or MESO_NO_INDEX */
    uint32_t thread_count;
    MesoArena *arena;
} MesoRelaxing;

static inline MesoVec2 meso_relax_place(const MesoRelaxing *r, uint32_t name)
{
    return (MesoVec2){r->rings->middles[name].x, r->rings->middles[name].y};
}

static inline MesoVec3 meso_relax_along(MesoVec3 v, MesoVec3 normal)
{
    return meso_vec3_mad(v, -meso_vec3_dot(v, normal), normal);
}

/* A direction of the swatch where it lies over a node. */
static inline MesoVec3 meso_relax_turned(const MesoRelaxing *r, uint32_t node, float x, float y)
{
    float c = (float)r->cosines[node], s = (float)r->sines[node];
    MesoVec3 way = meso_vec3_scale(r->nodes[node].x, c * x - s * y);
    return meso_vec3_mad(way, s * x + c * y, r->nodes[node].y);
}

/* The entry of a ring of a patch: a node, or MESO_NO_INDEX. Of rings in pieces, the first is there. */
uint32_t *meso_relax_entry(const MesoRelaxing *r, uint32_t patch, uint32_t name);

/* Where a vertex of the swatch is if it lies as there around a node that has moved; the way begins at a triangle. */
MesoQuiltVertex meso_relax_put(const MesoRelaxing *r, const MesoFinishWork *work, uint32_t node, uint32_t triangle,
                               uint32_t origin);

/* Rings that whole elements grow from; `all`: each of these has one. */
MesoStatus meso_relax_find_carriers(bool *all, MesoRelaxing *r, MesoError *error);

/* Whole elements stand as in the swatch on the strands that carry them. */
void meso_relax_carry(MesoQuilt *quilt, const MesoRelaxing *r, const MesoFinishWork *work);

/* Rings around each of the swatch's. */
MesoStatus meso_relax_look_around(MesoRelaxing *r, MesoError *error);

/* Pairs of nodes of one patch, and along strands into others. Nodes have to be in the table. */
MesoStatus meso_relax_find_pairs(MesoRelaxing *r, MesoError *error);

/* Strands of other patches where a node should have one that its patch has not, as nodes have moved. */
MesoStatus meso_relax_guess(MesoRelaxing *r, MesoError *error);

/* Finds turns and, where nodes may move, moves; `any`: some pair is not as it should be. */
MesoStatus meso_relax_fit(bool *any, MesoRelaxing *r, bool may_move, MesoError *error);

/* Rings rise and fall along strands as in the swatch, which lies at `offset`. */
MesoStatus meso_relax_heights(MesoRelaxing *r, float offset, MesoError *error);

#endif
