/* The upper texture coordinates of a shell map, moved for less stretch. */
#ifndef MESO_SHELL_MAP_RELAX_H
#define MESO_SHELL_MAP_RELAX_H

#include "libcore/base/arena.h"
#include "libcore/shell/shell_tetrahedra.h"

/* Makes the paper's measure least; keeps all tetrahedra of the texture positive, or all as it is. */
MesoStatus meso_shell_map_solve(MesoShellMap *map, MesoArena *scratch, MesoError *error);

/* Sweeps for the other measure, which never grows. */
void meso_shell_map_sweep(MesoShellMap *map, uint32_t sweeps);

#endif
