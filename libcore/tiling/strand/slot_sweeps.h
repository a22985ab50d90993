/* Sweeps of slots: each kind's instance on a slot, where the slot's ports lie. */
#ifndef MESO_SLOT_SWEEPS_H
#define MESO_SLOT_SWEEPS_H

#include <stdatomic.h>

#include "libcore/scene/sweep.h"
#include "libcore/scene/sweep_maker.h"
#include "libcore/tiling/strand/profile_set.h"
#include "libcore/tiling/strand/strand_port.h"

typedef struct MesoSlotSweeps {
    const MesoModel *model;         /* wound */
    MesoMapOptions options;         /* resolved */
    MesoScene scene;                /* as it is once it has its kinds */
    const MesoKindOrigin *origins;  /* of the scene's kinds */
    const MesoKindReach *reaches;   /* [kind_count] */
    MesoShell shell;
    MesoShellCell cell;             /* in whose ports sweeps begin and end where sections deform; points into itself */
    MesoPortFinder ports;
    uint32_t *bucket_slots;         /* [slot_count] slots by tile and mirroring, ascending within */
    uint32_t *bucket_begin;         /* [2 * tile_count + 1] */
    uint32_t *rank;                 /* [slot_count] of slots in their buckets, where sweeps are made when wanted */
    uint32_t *bucket_kinds;         /* [2 * tile_count + 1] the scene's kinds of each bucket, which lie together */
    float *kind_sizes;              /* [kind_count] */
    uint32_t slots_a_bundle, bundles_a_slot;
    MesoSweepMaker maker;
    atomic_uint_fast64_t failed;    /* smallest sweep whose slot has no port, of those that have been noted */
} MesoSlotSweeps;

/* Fills in the slots by tile and mirroring. */
MesoStatus meso_slot_sweeps_sort(MesoSlotSweeps *sweeps, MesoArena *arena, MesoError *error);

/* Sweep `i` of the scene, one of `kind`. MESO_ERR_INPUT where the slot has no port. */
MesoStatus meso_slot_sweep(const MesoSlotSweeps *sweeps, uint32_t kind, uint32_t i, MesoSweepInstance *out,
                           MesoError *error);

/* Notes that a sweep's slot has no port; from any thread. */
void meso_slot_sweeps_note(MesoSlotSweeps *sweeps, uint64_t sweep);

/* MESO_ERR_INPUT for the first of those, found again alone, so that the message does not depend on the threads. */
MesoStatus meso_slot_sweeps_check(MesoSlotSweeps *sweeps, MesoError *error);

/*
 * Gives the scene, which has its kinds, a maker in place of sweeps: those of a few slots are a bundle. What it needs
 * lives in `arena`. What has no port is noted when it is made. O(slots * kinds of each).
 */
MesoStatus meso_slot_sweeps_maker(MesoSlotSweeps *sweeps, MesoScene *scene, MesoArena *arena, uint32_t thread_count,
                                  MesoError *error);

/* Slots by tile and mirroring: that of a kind's. */
static inline uint32_t meso_kind_bucket(const MesoKindOrigin *origin)
{
    return 2 * origin->tile + origin->mirrored;
}

/* What one edge length in the drawings is in a cell, whose edges have the mean length. */
float meso_cell_scale(const MesoMapOptions *options, const MesoModel *model);

#endif
