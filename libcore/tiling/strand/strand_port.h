/* Ports of sweeps: where a section of a tile lies on its slot, moved where the model's joints are. */
#ifndef MESO_STRAND_PORT_H
#define MESO_STRAND_PORT_H

#include "libcore/shell/hexahedra.h"
#include "libcore/tiling/problem/strand_joints.h"
#include "libcore/tiling/strand/model.h"

typedef struct MesoPortFinder {
    const MesoModel *model;
    const MesoShell *shell;
    const MesoVec2 *centers;        /* [section_count] of the tile set's sections, as in MesoContourSet */
    float *slot_sizes;              /* [slot_count] where sections follow their slots, or NULL */
    MesoStrandJoints joints;        /* numbered where the model has moves of them */
} MesoPortFinder;

/*
 * What it needs lives in `arena`. O(slots) where joints are moved or sections follow their slots. MESO_ERR_MEMORY, or
 * MESO_ERR_LIMIT as meso_strand_joints_number().
 */
MesoStatus meso_port_finder_make(MesoPortFinder *finder, MesoArena *arena, const MesoModel *model,
                                 const MesoShell *shell, const MesoVec2 *centers, MesoError *error);

/* The port of a section on side 0..5 of the tile that `slot` holds. MESO_ERR_INPUT as meso_shell_wall_port(). O(1). */
MesoStatus meso_port_find(const MesoPortFinder *finder, uint32_t slot, uint32_t tile_side, uint32_t section,
                          MesoPort *port, MesoError *error);

/* Walls of a slot, for whoever wants many of its ports: zeroed at first. */
typedef struct MesoSlotWalls {
    MesoWall walls[4];
    bool made[4];
} MesoSlotWalls;
MesoStatus meso_port_find_by(const MesoPortFinder *finder, MesoSlotWalls *walls, uint32_t slot, uint32_t tile_side,
                             uint32_t section, MesoPort *port, MesoError *error);

/* Whether the drawing of a tile's side 0..3 is mirrored where its slot has it. */
bool meso_port_flipped(const MesoModel *model, uint32_t slot, uint32_t tile_side);

/* The mean length of a slot's edges. */
float meso_slot_size(const MesoQuadMesh *mesh, uint32_t slot);

/* Factor on the sections there: both slots of an edge say the same, so that their rings are equal. */
float meso_port_size(const MesoPortFinder *finder, uint32_t slot, uint32_t tile_side);

#endif
