/* The writers of each kind of file, for mesh_write.c. */
#ifndef MESO_MESH_WRITERS_H
#define MESO_MESH_WRITERS_H

#include "formats/mesh/write/mesh_sink.h"
#include "libcore/mesh/polygon_mesh.h"

void meso_mesh_write_ply(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
void meso_mesh_write_obj(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
void meso_mesh_write_off(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
bool meso_mesh_ply_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute);
bool meso_mesh_obj_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute);

#endif
