/*
 * What makes a surface other than it looks: pieces that touch and are not
 * joined, windings that disagree, one-sided pieces, faces without area,
 * normals that are missing. None of it keeps a slot graph from being built.
 */
#ifndef MESO_SURFACE_CHECK_H
#define MESO_SURFACE_CHECK_H

#include "libcore/mesh/slot_graph.h"

/* Counts, each with its first faces, from 0; a pair is of two neighbours. What a count of 0 has beside it means
 * nothing. */
typedef struct MesoSurfaceFlaws {
    uint32_t pieces;            /* connected pieces of the slot graph */
    uint32_t split_edges;       /* border edges whose two ends lie where those of another one do */
    uint32_t split_faces[2];
    uint32_t reversed_edges;    /* edges whose two faces are wound against each other */
    uint32_t reversed_faces[2];
    uint32_t one_sided_pieces;  /* those that no winding of their faces sets right, like a Moebius band */
    uint32_t one_sided_faces[2];    /* at the first reversed edge of the first of them */
    uint32_t blurred_edges;     /* reversed edges of these whose normals are sums over faces of both windings */
    uint32_t flat_faces;        /* faces without area */
    uint32_t flat_face;
    uint32_t bare_corners;      /* corners without a normal, where the file gives normals to others */
    uint32_t bare_face;
    uint32_t lost_normals;      /* vertices whose normal vanishes, as faces around them face each other */
} MesoSurfaceFlaws;

/*
 * Looks at a mesh and its graph. Positions are equal where their bits are, but
 * for the sign of zero. A face has no area where it is thinner than 1e-6 of its
 * longest side, which is what positions in single precision resolve; a bow tie has some.
 * O(face_count), by hashing. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_surface_check(MesoSurfaceFlaws *flaws, MesoArena *scratch, const MesoQuadMesh *mesh,
                              const MesoSlotGraph *graph, MesoError *error);

#endif
