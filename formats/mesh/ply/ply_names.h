/* Names of numbers, from the comments of a header. */
#ifndef MESO_PLY_NAMES_H
#define MESO_PLY_NAMES_H

#include "formats/mesh/ply/ply_header.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * Whole numbers of faces that the comments name one by one from 0 become names, where all of them are named but -1,
 * which is none. The others stay as they are. In `arena`. O(comments * properties + faces). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_ply_name_numbers(const MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error);

#endif
