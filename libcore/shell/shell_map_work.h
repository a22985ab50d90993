/* What the parts of a shell map share. */
#ifndef MESO_SHELL_MAP_WORK_H
#define MESO_SHELL_MAP_WORK_H

#include "libcore/math/vec3d.h"
#include "libcore/shell/shell_map.h"

/* Corners of a triangle's prisms, 0 to 2 below and 3 to 5 above, and how both are cut. */
typedef struct MesoShellPrism {
    MesoVec3d texture[6], shell[6];
    uint8_t tetrahedra[3][4];
} MesoShellPrism;

MesoShellPrism meso_shell_prism(const MesoShellMap *map, uint32_t triangle);

/* Whether all its tetrahedra have a volume on both sides; the rest is left as it is. */
bool meso_shell_prism_stands(const MesoShellPrism *prism);

/* Makes the paper's measure least; keeps all tetrahedra of the texture positive, or all as it is. */
MesoStatus meso_shell_map_solve(MesoShellMap *map, MesoArena *scratch, MesoError *error);

/* Sweeps for the other measure, which never grows. */
void meso_shell_map_sweep(MesoShellMap *map, uint32_t sweeps);

#endif
