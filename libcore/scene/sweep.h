/* Sweeps: points, vertices and faces of tubes, by the formulas of scene.h. */
#ifndef MESO_SWEEP_H
#define MESO_SWEEP_H

#include "libcore/scene/scene.h"

/* P for one instance of a swept kind at v in [0,1], with the profile point s(v). */
MesoVec3 meso_sweep_point(const MesoScene *scene, const MesoSweepInstance *sweep, MesoVec2 profile, float v);

/* Which columns of a kind, and how many rings, as a level of detail has them (detail.h). */
typedef struct MesoSweepGrid {
    const uint32_t *columns;    /* [column_count] ascending columns of the kind; NULL: all of them */
    uint32_t column_count, ring_count;
} MesoSweepGrid;

/* Vertices of one instance of `kind` on these, to `out` [column_count * ring_count], ring by ring. */
void meso_sweep_grid(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                     const MesoSweepGrid *grid, MesoMeshVertex *out);

/*
 * Vertices of one instance of `kind`, ring by ring, to `out` [column_count * division_count]; and its faces, whose
 * indices count from `base`, to `out` [joint_count * (division_count - 1)]. A cap's last row are triangles.
 */
void meso_sweep_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out);
void meso_sweep_faces(const MesoScene *scene, const MesoSweptKind *kind, uint32_t base, MesoMeshFace *out);

#endif
