/* Bodies of PLY files, behind their header. */
#ifndef MESO_PLY_BODY_H
#define MESO_PLY_BODY_H

#include "formats/file/input.h"
#include "formats/mesh/ply/ply_header.h"
#include "libcore/mesh/polygon_mesh.h"

/* Each reads all elements of a header with a plan (ply_layout.h) into `mesh`. Errors as of meso_ply_read(). */
MesoStatus meso_ply_read_binary(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                uint32_t thread_count, MesoError *error);
MesoStatus meso_ply_read_ascii(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                               uint32_t thread_count, MesoError *error);

#endif
