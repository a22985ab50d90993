#include "libcore/mesh/face_loops.h"

MesoStatus meso_face_loops_init(MesoFaceLoops *loops, MesoArena *scratch, const MesoPolygonMesh *from,
                                uint32_t new_vertex_count, MesoError *error)
{
    uint32_t most = from->side_count;
    for (uint32_t f = 0; f < from->face_count && from->face_begin; f++)
        most = meso_polygon_sides(from, f) > most ? meso_polygon_sides(from, f) : most;
    *loops = (MesoFaceLoops){.from = from, .place = MESO_NEW(scratch, uint32_t, new_vertex_count, error)};
    loops->vertices = MESO_NEW(scratch, uint32_t, most, error);
    loops->sources = MESO_NEW(scratch, uint32_t, most, error);
    return loops->place && loops->vertices && loops->sources ? MESO_OK : MESO_ERR_MEMORY;
}

/* Takes the stack from `begin` on as a face of its own. */
static uint32_t take_loop(MesoFaceLoops *loops, MesoMeshCopies *copies, uint32_t face, uint32_t begin)
{
    uint32_t end = loops->depth;
    loops->depth = begin;
    if (end - begin < 3)
        return 0;
    for (uint32_t i = begin; i < end; i++)
        meso_mesh_copies_corner(copies, loops->sources[i], loops->vertices[i]);
    meso_mesh_copies_face(copies, face);
    return 1;
}

uint32_t meso_face_loops_add(MesoFaceLoops *loops, MesoMeshCopies *copies, const uint32_t *vertex_of, uint32_t face)
{
    const MesoPolygonMesh *from = loops->from;
    uint32_t begin = meso_polygon_begin(from, face), end = begin + meso_polygon_sides(from, face), count = 0;
    for (uint32_t c = begin; c < end; c++) {
        uint32_t vertex = vertex_of ? vertex_of[from->corners[c]] : from->corners[c], place = loops->place[vertex];
        uint32_t source = c;
        if (place < loops->depth && loops->vertices[place] == vertex) {
            source = loops->sources[place];
            count += take_loop(loops, copies, face, place);
        }
        loops->place[vertex] = loops->depth;
        loops->vertices[loops->depth] = vertex;
        loops->sources[loops->depth++] = source;
    }
    return count + take_loop(loops, copies, face, 0);
}
