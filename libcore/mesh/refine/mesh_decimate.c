#include "libcore/mesh/refine/mesh_decimate.h"

#include <string.h>

#include "libcore/mesh/edit/ear_clip.h"
#include "libcore/mesh/edit/origins.h"
#include "libcore/mesh/refine/openmesh_decimate_adapter.h"
#include "libcore/mesh/surface.h"

/* OpenMesh has two half-edges, in an int, for each of some 3/2 edges a triangle, and 3 where it is alone. */
enum { MOST_TRIANGLES = 1 << 28 };

/* Cosine of the most that a triangle may turn in one collapse: a quarter of a turn is on its way to a fold. */
static const double FOLD = 0.2;

typedef struct Left {
    uint32_t count;
    uint32_t *triangles;        /* [count] of those before */
    uint32_t *corners;          /* [3 * count] vertices */
} Left;

static MesoStatus check(const MesoPolygonMesh *mesh, uint32_t thread_count, MesoError *error)
{
    MesoSurface surface;
    MesoArena scratch;
    if (mesh->face_count > MOST_TRIANGLES)
        return meso_fail(error, MESO_ERR_LIMIT, "%u triangles are more than can be decimated, %u", mesh->face_count,
                         MOST_TRIANGLES);
    meso_arena_init(&scratch);
    MesoStatus status = meso_surface_build(&surface, &scratch, mesh, thread_count, error);
    if (!status)
        status = meso_surface_require(&surface, MESO_NEEDS_MANIFOLD | MESO_NEEDS_ORIENTED, NULL, error);
    meso_arena_release(&scratch);
    return status;
}

static MesoStatus collapse(Left *left, MesoArena *scratch, const MesoPolygonMesh *mesh, uint32_t target,
                           MesoError *error)
{
    left->triangles = MESO_NEW(scratch, uint32_t, mesh->face_count, error);
    left->corners = MESO_NEW(scratch, uint32_t, mesh->corner_count, error);
    if (!left->triangles || !left->corners)
        return MESO_ERR_MEMORY;
    MesoDecimation decimation = {.vertex_count = mesh->vertex_count, .triangle_count = mesh->face_count,
                                 .positions = mesh->positions, .triangles = mesh->corners, .target = target, .fold = FOLD};
    return meso_openmesh_decimate(&decimation, left->triangles, left->corners, &left->count, error);
}

/* vertex_of[v] is the new number of v; first_at[v] the first corner at v. */
static void number_vertices(MesoMeshCopies *copies, uint32_t *vertex_of, const Left *left, uint32_t vertex_count)
{
    for (uint32_t c = 0; c < 3 * left->count; c++)
        vertex_of[left->corners[c]] = 1;
    for (uint32_t v = 0; v < vertex_count; v++) {
        if (!vertex_of[v])
            continue;
        copies->vertex_sources[copies->vertex_count] = v;
        vertex_of[v] = copies->vertex_count++;
    }
}

static void find_first_corners(uint32_t *first_at, const MesoPolygonMesh *mesh)
{
    memset(first_at, 0xff, mesh->vertex_count * sizeof *first_at);
    for (uint32_t c = mesh->corner_count; c-- > 0;)
        first_at[mesh->corners[c]] = c;
}

/* The corner of an old triangle that is at `vertex`, or else the first one there. */
static uint32_t source_of(const MesoPolygonMesh *mesh, const uint32_t *first_at, uint32_t triangle, uint32_t vertex)
{
    for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; c++)
        if (mesh->corners[c] == vertex)
            return c;
    return first_at[vertex];
}

static MesoStatus copy_left(MesoMeshCopies *copies, MesoArena *scratch, const MesoPolygonMesh *mesh, const Left *left,
                            MesoError *error)
{
    MesoStatus status = meso_mesh_copies_init(copies, scratch, left->count, 3 * (uint64_t)left->count, error);
    uint32_t *vertex_of = MESO_NEW(scratch, uint32_t, mesh->vertex_count, error);
    uint32_t *first_at = MESO_NEW(scratch, uint32_t, mesh->vertex_count, error);
    copies->vertex_sources = MESO_NEW(scratch, uint32_t, mesh->vertex_count, error);
    if (status || !vertex_of || !first_at || !copies->vertex_sources)
        return status ? status : MESO_ERR_MEMORY;
    number_vertices(copies, vertex_of, left, mesh->vertex_count);
    find_first_corners(first_at, mesh);
    for (uint32_t t = 0; t < left->count; t++) {
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t vertex = left->corners[3 * (size_t)t + k];
            meso_mesh_copies_corner(copies, source_of(mesh, first_at, left->triangles[t], vertex), vertex_of[vertex]);
        }
        meso_mesh_copies_face(copies, left->triangles[t]);
    }
    return MESO_OK;
}

MesoStatus meso_mesh_decimate(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, uint32_t target,
                              uint32_t thread_count, MesoError *error)
{
    Left left;
    MesoArena scratch;
    MesoMeshCopies copies;
    MesoPolygonMesh triangles;
    meso_arena_init(&scratch);
    MesoStatus status = meso_mesh_cut_faces(&triangles, &scratch, from, error);
    if (!status)
        status = check(&triangles, thread_count, error);
    if (!status)
        status = collapse(&left, &scratch, &triangles, target, error);
    if (!status)
        status = copy_left(&copies, &scratch, &triangles, &left, error);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, &triangles, &copies, error);
    meso_arena_release(&scratch);
    return status;
}
