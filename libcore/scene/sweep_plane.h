/* The planes that the rings of a sweep lie in, by the formulas of scene.h: B, T, X and Y. */
#ifndef MESO_SWEEP_PLANE_H
#define MESO_SWEEP_PLANE_H

#include "libcore/scene/scene.h"

typedef struct MesoSweepPlane {
    MesoVec3 origin, x, y, tangent;
    float speed;    /* |B'| */
} MesoSweepPlane;

/* Planes close by before and behind one, for differences. */
typedef struct MesoSweepBeside {
    float v[2];
    MesoSweepPlane planes[2];
} MesoSweepBeside;

/* By how much B, X and Y change with v. */
typedef struct MesoSweepPlaneChange {
    MesoVec3 origin, x, y;
} MesoSweepPlaneChange;

/* X and T of the trajectory at one place. */
typedef struct MesoSweepStation {
    MesoVec3 point, x, tangent;
} MesoSweepStation;

/* What the planes of one sweep share. */
typedef struct MesoSweepFrames {
    const MesoSweepInstance *sweep;
    MesoFrameRule rule;
    float length;           /* of the trajectory, where there is a mitre */
    float lean, ease;       /* m, and how much of the way from v to w(v) u goes; over 1: on to w(w(v)) */
    MesoSweepStation stations[MESO_FRAME_STEPS + 1];    /* of the rule that needs them */
} MesoSweepFrames;

MesoSweepFrames meso_sweep_frames(MesoFrameRule rule, const MesoSweepInstance *sweep);

MesoSweepPlane meso_sweep_plane(const MesoSweepFrames *frames, float v);

MesoSweepBeside meso_sweep_beside(const MesoSweepFrames *frames, float v);

/* At v, which `beside` is of. */
MesoSweepPlaneChange meso_sweep_plane_change(const MesoSweepFrames *frames, const MesoSweepBeside *beside, float v);

/*
 * b of a crease over section_scale, in `plane`, which is that at v: rings meet where its product with the place in the
 * plane is 1. (0, 0) at the ends, and where there is no crease. T' is taken by differences.
 */
MesoVec2 meso_sweep_bend(const MesoSweepFrames *frames, const MesoSweepPlane *plane, float v);

/* The same of those of `beside`, where planes close by are known. */
MesoVec2 meso_sweep_bend_between(const MesoSweepFrames *frames, const MesoSweepPlane *plane,
                                 const MesoSweepBeside *beside, float v);

/* The plane across `tangent`, X across `up`. */
MesoSweepPlane meso_sweep_plane_across(MesoVec3 origin, MesoVec3 up, MesoVec3 tangent, float speed);

/* The twist of a sweep under MESO_FRAME_MINIMAL, in [-pi, pi]; the same by its frames, of that rule or of a crease. */
float meso_sweep_twist(const MesoSweepInstance *sweep);
float meso_sweep_frames_twist(const MesoSweepFrames *frames);

#endif
