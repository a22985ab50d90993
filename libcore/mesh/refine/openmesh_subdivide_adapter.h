/* Subdivision by OpenMesh, for the tests of ours: positions alone, in OpenMesh's order. */
#ifndef MESO_OPENMESH_SUBDIVIDE_ADAPTER_H
#define MESO_OPENMESH_SUBDIVIDE_ADAPTER_H

#include <stdint.h>

#include "libcore/base/error.h"
#include "libcore/math/vec.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct MesoOpenMeshPolygons {
    uint32_t vertex_count, face_count;
    const MesoVec3 *positions;  /* [vertex_count] */
    const uint32_t *face_begin; /* [face_count + 1] */
    const uint32_t *corners;    /* [face_begin[face_count]] */
} MesoOpenMeshPolygons;

/*
 * Vertices after `level_count` steps of Loop's scheme, or else of Catmull and Clark's, to `positions` [room], and their
 * number to `count`. On borders, the latter is no cubic B-spline: OpenMesh takes a third of a vertex and of the middles
 * of its edges. MESO_ERR_LIMIT where there is not enough room; MESO_ERR_INPUT for what OpenMesh does not take.
 */
MesoStatus meso_openmesh_subdivide(MesoVec3 *positions, uint32_t room, uint32_t *count,
                                   const MesoOpenMeshPolygons *polygons,
                                   int loop, uint32_t level_count, MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
