/*
 * Cells: where the sweeps of a scene of MESO_SWEEP_SHAPE are made, to be bent into cages together with their sections.
 *
 *     F(x, y, z)   the cage at (x, y, 2 z): trilinear
 *     normal       n.x (F_y x F_z) + n.y (F_z x F_x) + n.z (F_x x F_y) made unit, outward
 *
 * A trilinear map of a box is one of its own eight corners, so that what lies in it lies in the hull of where these go.
 * Lengths grow by at most the largest norm of the derivative at a corner of the cage, of which it is a mean elsewhere.
 *
 * Two cages with the same corners on a side agree there to the bit: on points whose place along it is a multiple of the
 * grain, and nowhere else have sweeps or bodies points on a side.
 */
#ifndef MESO_CELL_H
#define MESO_CELL_H

#include "libcore/scene/scene.h"

#define MESO_CELL_HEIGHT 0.5f

/* To the next multiple of the grain, 2^-22: sums of a few such numbers, and 1 minus one, are exact. */
static inline float meso_cell_round(float x)
{
    return rintf(x * 4194304.0f) / 4194304.0f;
}

/* F. */
MesoVec3 meso_cell_point(const MesoCage *cage, MesoVec3 p);

/* F of what lies on a side of the cell, or within a millionth of it, and so on the side's grain; or elsewhere. */
MesoVec3 meso_cell_body_point(const MesoCage *cage, MesoVec3 p);

/* Replaces positions and normals in the cell by those in the cage. */
void meso_cell_bend(const MesoCage *cage, MesoMeshVertex *vertices, uint64_t count);

/* By how much lengths grow at most; and the most that F bends a straight line of length 1, |d2F/dt2|. */
typedef struct MesoCellStretch {
    float most, bend;
} MesoCellStretch;

MesoCellStretch meso_cell_stretch(const MesoCage *cage);

/* Of all cages of a kind's instances; {1, 0} where sections keep their shape. */
MesoCellStretch meso_kind_stretch(const MesoScene *scene, const MesoSweptKind *kind);

/* ---- sweeps of either deformation, in scene units ---- */

/*
 * Control points of the trajectory: p, or where sections deform the cubic with the ends and the derivatives there of
 * what becomes of it. Its ends are the very same points for both slots.
 */
void meso_sweep_trajectory(const MesoScene *scene, const MesoSweepInstance *sweep, MesoVec3 p[4]);

/* By how much lengths of the section at the start or the end grow, by its area; 1 where sections keep their shape. */
float meso_sweep_growth(const MesoScene *scene, const MesoSweepInstance *sweep, bool at_end);

/* A point of the trajectory itself. */
MesoVec3 meso_sweep_middle(const MesoScene *scene, const MesoSweepInstance *sweep, float v);

/* Points and a distance: the sweep lies no further than that from their hull. */
typedef struct MesoSweepHull {
    uint32_t count;
    MesoVec3 points[8];
    float reach;
} MesoSweepHull;

/* `radius` of the profile, as of meso_scene_kind_radius(). */
MesoSweepHull meso_sweep_hull(const MesoScene *scene, const MesoSweepInstance *sweep, float radius);

/* The scene's cages, moved so that `origin` is at 0; NULL where memory is out. */
MesoCage *meso_cages_from(const MesoScene *scene, MesoVec3 origin, MesoArena *arena, MesoError *error);

#endif
