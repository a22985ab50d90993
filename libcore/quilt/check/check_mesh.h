/* A quilt and its swatch, seen alike: triangles in space, by element. */
#ifndef MESO_CHECK_MESH_H
#define MESO_CHECK_MESH_H

#include "libcore/quilt/quilt.h"

typedef struct MesoMeshFaults {
    uint32_t unplaced_count;    /* vertices that are not finite */
    uint32_t open_count;        /* edges of one triangle */
    uint32_t crowded_count;     /* edges of more than two */
    uint32_t reversed_count;    /* edges whose triangles are wound against each other */
    uint32_t collapsed_count;   /* triangles that have a vertex twice */
    uint32_t pinched_count;     /* fans of triangles that touch another in a vertex alone */
} MesoMeshFaults;

typedef struct MesoCheckMesh {
    uint32_t vertex_count, triangle_count, element_count;
    const MesoVec3 *positions;
    const uint32_t *corners;
    const uint32_t *vertex_begin, *triangle_begin;  /* [element_count + 1] */
    const uint32_t *patches;    /* [triangle_count] or NULL: one patch */
    const uint32_t *origins;    /* [vertex_count] vertices of the swatch that they are copies of, or NULL: not known */
    uint32_t *twins;            /* [3 * triangle_count] half-edge across; MESO_NO_INDEX where open or crowded */
    uint32_t *elements;         /* [triangle_count] */
} MesoCheckMesh;

typedef struct MesoElementShape {
    uint32_t triangle_count, open_count, piece_count;
    int64_t euler;              /* vertices - edges + triangles */
    double volume, area;        /* of the volume what its triangles and a point enclose where it is open */
} MesoElementShape;

/* The mesh of a quilt, its twins joined, in `arena`, and what is wrong with it. */
MesoStatus meso_check_mesh_of_quilt(MesoCheckMesh *mesh, MesoMeshFaults *faults, MesoArena *arena,
                                    const MesoQuilt *quilt, const MesoVec3 *positions, uint32_t thread_count,
                                    MesoError *error);

/* The mesh of a swatch. */
MesoStatus meso_check_mesh_of_swatch(MesoCheckMesh *mesh, MesoArena *arena, const MesoSwatch *swatch, MesoError *error);

/* shapes [mesh->element_count] */
MesoStatus meso_check_shapes(MesoElementShape *shapes, MesoArena *scratch, const MesoCheckMesh *mesh, MesoError *error);

#endif
