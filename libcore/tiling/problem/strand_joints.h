/*
 * Joints of strands: each cross-section on an edge of the slot graph is one, shared by the slots on both sides; so is
 * each on the top or bottom of a slot, of its own. They are numbered by the sections of the label at the first of the
 * two half-edges of an edge: base + the section's place in its interface.
 */
#ifndef MESO_STRAND_JOINTS_H
#define MESO_STRAND_JOINTS_H

#include "libcore/tiling/problem/assignment.h"

typedef struct MesoStrandJoints {
    uint32_t *base;             /* [6 * slot_count] first joint of each side, top and bottom too */
    uint32_t count;
} MesoStrandJoints;

/* The sections on side 0..5 of a slot, as it lies there. */
uint32_t meso_strand_section_count(const MesoAssignment *assignment, const MesoTileSet *set, uint32_t slot,
                                   uint32_t side);

/* Numbers the joints of a checked assignment. O(slots). MESO_ERR_MEMORY, or MESO_ERR_LIMIT for 2^32 - 1 and more. */
MesoStatus meso_strand_joints_number(MesoStrandJoints *joints, MesoArena *arena, const MesoAssignment *assignment,
                                     const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error);

/* The joint of a section of the set on side 0..5 of the tile that `slot` holds. */
uint32_t meso_strand_joint(const MesoStrandJoints *joints, const MesoAssignment *assignment, const MesoTileSet *set,
                           uint32_t slot, uint32_t tile_side, uint32_t section);

#endif
