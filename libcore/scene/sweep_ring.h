/* Rings of a tube, and those of a cap: what all of their points share. */
#ifndef MESO_SWEEP_RING_H
#define MESO_SWEEP_RING_H

#include "libcore/scene/sweep_section.h"

/* A ring: its plane and its section. */
typedef struct MesoSweepRing {
    MesoSweepPlane plane;
    MesoSweepPlaneChange change;    /* where it is mitred */
    bool mitred, creased;
    MesoSweepBlend blend, beside[2];    /* here, and close by before and behind where it is creased */
    float tilt_scale;
    bool on_side;           /* of a cell, where points lie on the grain */
} MesoSweepRing;

/* The ring of a sweep at v in [0,1]. */
MesoSweepRing meso_sweep_ring_at(const MesoScene *scene, const MesoSweepTrack *track, float v);

/* The plane of a cap's ring at v in [0,1], from its end to its top. */
MesoSweepPlane meso_sweep_cap_plane(const MesoScene *scene, const MesoSweepInstance *cap, float v);

#endif
