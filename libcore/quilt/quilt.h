/*
 * Mesh quilting: a swatch of geometry grown over a surface, patch by patch, so
 * that elements stay whole and strands go on from patch to patch ("Mesh
 * Quilting for Geometric Texture Synthesis", Zhou et al., SIGGRAPH 2006).
 *
 * The result lies in the layer above the surface: each vertex has a triangle
 * of the base, a place in it and a height, so that it can be embedded anew
 * where the base has moved.
 */
#ifndef MESO_QUILT_H
#define MESO_QUILT_H

#include "libcore/mesh/cut/triangulation.h"
#include "libcore/quilt/swatch/swatch.h"

typedef struct MesoQuiltVertex {
    uint32_t triangle;      /* of the base */
    float b1, b2;           /* weights of its corners 1 and 2; corner 0 has the rest */
    float height;           /* above it, in the surface's units; may be negative */
} MesoQuiltVertex;

typedef struct MesoQuiltOptions {
    float scale;            /* length on the surface of one unit of the swatch, > 0 */
    float height_scale;     /* the same across it; 0: as `scale` */
    float offset;           /* height of the swatch's lowest point */
    uint32_t turn_count;    /* rotations that the swatch may take, at least 1 */
    const MesoVec3 *guide;  /* [triangle_count] the swatch's x axis, by triangle of the base; NULL: any */
    float guide_turn;       /* by how much that may be turned so that woven strands lie evenly (stripe_phases.h) */
    float patch;            /* what must match, as a share of the swatch's sides, in (0,1); 0: 0.55 */
    float lambda;           /* of equation 1, for one mean edge of the swatch; 0: 1 */
    float mu;               /* of equations 5 and 6; 0: 1 */
    uint64_t seed;
    uint32_t step_limit;    /* patches after which it ends; 0: none */
    uint64_t triangle_limit;/* MESO_ERR_LIMIT beyond; 0: none */
    uint32_t thread_count;  /* 0: all cores */
    void (*progress)(void *context, uint64_t done, uint64_t total);     /* triangles of the base */
    void *context;
} MesoQuiltOptions;

/* What happened; numbers of joins and elements are sums over all steps. */
typedef struct MesoQuiltReport {
    uint32_t patch_count;
    double matching_cost;           /* mean over patches of the mean of D - 1 (equation 3) */
    uint64_t correspondence_count;  /* pairs of sections and of whole elements */
    double deformation_rms, deformation_largest;    /* displacements, in mean edges of the swatch */
    uint32_t join_count;            /* sections joined */
    uint32_t weld_count;            /* patches that fitted vertex by vertex, so that nothing was cut */
    uint32_t cap_count;             /* sections closed because nothing went on there */
    uint32_t open_count;            /* sections left open: at borders of the surface */
    uint32_t retry_count;           /* placements given up for a better one */
    uint32_t shrunk_count;          /* patches made smaller for distortion */
    uint32_t removed_count;         /* whole elements left out, since they would have met another */
    uint32_t skipped_count;         /* triangles of the base that no patch could cover */
    uint32_t border_count;          /* sections along borders of the surface; of this and what follows, quilt_finish.h */
    uint32_t border_removed_count;  /* whole elements left out, since they lie across a border */
    uint32_t closed_count;          /* loops of open edges closed at the end */
    uint32_t debris_count;          /* pieces of strands left out, since they were too short */
    uint32_t settled_count;         /* whole elements that are as in the swatch in space; of this, quilt_settle.h */
    uint32_t added_count;           /* whole elements added where there was room */
    double seconds[6];              /* charts, matching, seams and fit, whole elements, strands, what is added to the quilt */
} MesoQuiltReport;

typedef struct MesoQuilt {
    uint32_t vertex_count, triangle_count, element_count;
    MesoQuiltVertex *vertices;      /* [vertex_count] by element */
    uint32_t *origins;              /* [vertex_count] vertex of the swatch that it is, or lies next to */
    uint32_t *corners;              /* [3 * triangle_count] by element */
    uint32_t *triangle_origins;     /* [triangle_count] triangle of the swatch that it is part of, or continues */
    uint32_t *patches;              /* [triangle_count] step that has placed it; seams lie between */
    uint32_t *vertex_begin, *triangle_begin;    /* [element_count + 1] */
    uint32_t *element_origins;      /* [element_count] element of the swatch, or the first of those that it joins */
    MesoQuiltReport report;
} MesoQuilt;

/*
 * Covers `base`, whose triangles should be small against the swatch (a tenth of its sides; base/quilt_base.h makes
 * them so) and wound alike. Strands come by their first triangle, then whole elements. To `arena`. The same bytes for
 * any number of threads. Time and memory grow with the number of triangles that come out. MESO_ERR_LIMIT,
 * MESO_ERR_INPUT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_grow(MesoQuilt *quilt, MesoArena *arena, const MesoTriangulation *base, const MesoSwatch *swatch,
                           const MesoQuiltOptions *options, MesoError *error);

/* Where a quilt lies through steps that put it anew, to the arena that is not in use: what was there before can go. */
typedef struct MesoQuiltRoom {
    MesoArena arenas[2];        /* zero to begin with */
    uint32_t used;
} MesoQuiltRoom;

static inline MesoArena *meso_quilt_room_free(MesoQuiltRoom *room)
{
    return &room->arenas[1 - room->used];
}

static inline MesoArena *meso_quilt_room_used(MesoQuiltRoom *room)
{
    return &room->arenas[room->used];
}

/*
 * After a step that has come to its end; `before`: the quilt's vertices before it. Steps may leave these where they
 * are.
 */
static inline void meso_quilt_room_turn(MesoQuiltRoom *room, const MesoQuilt *quilt, const MesoQuiltVertex *before)
{
    if (quilt->vertices == before && meso_quilt_room_used(room)->used)      /* else another array at the same place */
        return;
    room->used = 1 - room->used;
    meso_arena_release(meso_quilt_room_free(room));
}

static inline void meso_quilt_room_release(MesoQuiltRoom *room)
{
    meso_arena_release(&room->arenas[0]);
    meso_arena_release(&room->arenas[1]);
}

#endif
