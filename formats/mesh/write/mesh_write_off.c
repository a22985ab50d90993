/* OFF: positions and faces. */
#include "formats/mesh/write/mesh_writers.h"

void meso_mesh_write_off(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance)
{
    meso_mesh_sink_text(sink, "OFF\n");
    meso_mesh_sink_provenance(sink, provenance, "# ");
    meso_mesh_sink_number(sink, mesh->vertex_count);
    meso_mesh_sink_character(sink, ' ');
    meso_mesh_sink_number(sink, mesh->face_count);
    meso_mesh_sink_text(sink, " 0\n");
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float p[3] = {mesh->positions[v].x, mesh->positions[v].y, mesh->positions[v].z};
        for (int k = 0; k < 3; k++) {
            meso_mesh_sink_float(sink, p[k]);
            meso_mesh_sink_character(sink, k < 2 ? ' ' : '\n');
        }
    }
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        meso_mesh_sink_number(sink, end - begin);
        for (uint32_t c = begin; c < end; c++) {
            meso_mesh_sink_character(sink, ' ');
            meso_mesh_sink_number(sink, mesh->corners[c]);
        }
        meso_mesh_sink_character(sink, '\n');
    }
}
