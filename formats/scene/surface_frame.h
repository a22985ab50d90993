/* What some files say of vertices beside positions, normals and texture coordinates. */
#ifndef MESO_SURFACE_FRAME_H
#define MESO_SURFACE_FRAME_H

#include "libcore/scene/parts.h"

/*
 * Lengths over the surface of one part to `out` [its vertices], in scene units: of a sweep, around from its first
 * column and along from its first ring, each by the chords of its own ring and column; of a body, its texture
 * coordinates. `vertices` are those of the part.
 */
void meso_surface_lengths(const MesoSceneParts *parts, uint32_t part, const MesoMeshVertex *vertices, MesoVec2 *out);

/* As glTF has it: unit, across the normal, the way u grows; w is -1 where cross(normal, tangent) runs against v. */
typedef struct MesoTangent {
    float x, y, z, w;
} MesoTangent;

/*
 * Tangents of one part to `out` [its vertices], from how texture coordinates lie on its faces [face_count], whose
 * corners count from `vertices`, mean over those around each vertex. Where they say nothing, any across the
 * normal.
 */
void meso_surface_tangents(uint64_t vertex_count, const MesoMeshVertex *vertices, uint64_t face_count,
                           const MesoMeshFace *faces, MesoTangent *out);

#endif
