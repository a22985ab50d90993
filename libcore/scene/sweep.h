/* Sweeps: points, vertices and faces of tubes, by the formulas of scene.h. */
#ifndef MESO_SWEEP_H
#define MESO_SWEEP_H

#include "libcore/scene/scene.h"

/* P for one instance of a swept kind at v in [0,1], with the profile point s(v). */
MesoVec3 meso_sweep_point(const MesoScene *scene, const MesoSweepInstance *sweep, MesoVec2 profile, float v);

/*
 * Vertices of one instance of `kind`, ring by ring, to `out` [column_count * division_count]; and its faces, whose
 * indices count from `base`, to `out` [joint_count * (division_count - 1)]. A cap's last row are triangles.
 */
void meso_sweep_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out);
void meso_sweep_faces(const MesoScene *scene, const MesoSweptKind *kind, uint32_t base, MesoMeshFace *out);

#endif
