/* Placed bodies: points, vertices and faces of bodies where they are placed. */
#ifndef MESO_PLACED_H
#define MESO_PLACED_H

#include "libcore/scene/scene.h"

MesoVec3 meso_frame_point(const MesoFrame *frame, MesoVec3 p);

/* Where a point of the body lies in the scene. */
MesoVec3 meso_placed_point(const MesoScene *scene, const MesoPlacedBody *placed, MesoVec3 p);

/* Whether the place turns the body inside out, so that its faces run the other way. */
bool meso_placed_is_mirrored(const MesoScene *scene, const MesoPlacedBody *placed);

/* Vertices of the body, to `out` [vertex_count], and its faces, whose indices count from `base`, to `out`
 * [face_count]: wound the other way where the place mirrors. */
void meso_placed_vertices(const MesoScene *scene, const MesoPlacedBody *placed, MesoMeshVertex *out);
void meso_placed_faces(const MesoScene *scene, const MesoPlacedBody *placed, uint32_t base, MesoMeshFace *out);

#endif
