/* Decimation of triangle meshes by OpenMesh. */
#ifndef MESO_OPENMESH_DECIMATE_ADAPTER_H
#define MESO_OPENMESH_DECIMATE_ADAPTER_H

#include <stdint.h>

#include "libcore/base/error.h"
#include "libcore/math/vec.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A mesh of triangles whose edges have two faces or one, wound alike, with one fan around each vertex. */
typedef struct MesoDecimation {
    uint32_t vertex_count, triangle_count;
    const MesoVec3 *positions;  /* [vertex_count] */
    const uint32_t *triangles;  /* [3 * triangle_count] */
    uint32_t target;            /* triangles that are wanted */
    double fold;                /* cosine of the angle by which no triangle's normal may turn in one step */
} MesoDecimation;

/*
 * Collapses edges onto one of their ends, those with the least quadric error first (Garland and Heckbert, "Surface
 * simplification using quadric error metrics", 1997), until `target` triangles are left or no edge can go. Borders are
 * part of the error: a plane stands upright on each of their edges. `kept` [triangle_count] gets the triangles that are
 * left, ascending, and `corners` [3 * triangle_count] their vertices, by the old numbers; `kept_count` how many.
 * Vertices do not move. Takes some 400 bytes a vertex beside. O(n log n).
 *
 * MESO_ERR_INPUT with the number, from 1, of a triangle that cannot be one of such a mesh; MESO_ERR_MEMORY,
 * MESO_ERR_INTERNAL.
 */
MesoStatus meso_openmesh_decimate(const MesoDecimation *decimation, uint32_t *kept, uint32_t *corners,
                                  uint32_t *kept_count, MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
