#include "libcore/mesh/edit/face_loops.h"

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

static MesoStatus add_faces(MesoMeshCopies *copies, MesoArena *scratch, const MesoPolygonMesh *from, uint32_t *looped,
                            MesoError *error)
{
    MesoFaceLoops loops;
    MesoStatus status = meso_mesh_copies_init(copies, scratch, (uint64_t)from->face_count + from->corner_count / 3,
                                              from->corner_count, error);
    if (!status)
        status = meso_face_loops_init(&loops, scratch, from, from->vertex_count, error);
    for (uint32_t f = 0; f < from->face_count && !status; f++) {
        uint32_t before = copies->corner_count, faces = meso_face_loops_add(&loops, copies, NULL, f);
        *looped += faces != 1 || copies->corner_count - before != meso_polygon_sides(from, f);
    }
    return status;
}

MesoStatus meso_mesh_cut_loops(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, uint32_t *looped,
                               MesoError *error)
{
    MesoArena scratch;
    MesoMeshCopies copies;
    *looped = 0;
    meso_arena_init(&scratch);
    MesoStatus status = add_faces(&copies, &scratch, from, looped, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, from, &copies, error);
    meso_arena_release(&scratch);
    return status;
}
