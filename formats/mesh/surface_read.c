#include "formats/mesh/surface_read.h"

#include "formats/mesh/mesh_read.h"
#include "libcore/mesh/edit/triangle_pairs.h"

static MesoStatus require(const MesoSurface *surface, const MesoInput *input, unsigned needs, MesoError *error)
{
    uint32_t face;
    MesoStatus status = meso_surface_require(surface, needs, &face, error);
    return status ? meso_mesh_fail_at_face(input, face, error) : MESO_OK;
}

/* Numbers of sides come first: they need no half-edges. */
static MesoStatus make_surface(MesoSurface *surface, MesoArena *arena, const MesoPolygonMesh *mesh,
                               const MesoInput *input, unsigned needs, uint32_t thread_count, MesoError *error)
{
    const unsigned of_sides = MESO_NEEDS_QUADS | MESO_NEEDS_TRIANGLES;
    *surface = (MesoSurface){.mesh = *mesh};
    MesoStatus status = require(surface, input, needs & of_sides, error);
    if (!status)
        status = meso_surface_build(surface, arena, mesh, thread_count, error);
    return status ? status : require(surface, input, needs & ~of_sides, error);
}

MesoStatus meso_surface_read(MesoSurface *surface, MesoArena *arena, const MesoInput *input, unsigned needs,
                             uint32_t thread_count, MesoError *error)
{
    MesoPolygonMesh mesh;
    MesoStatus status = meso_polygon_mesh_read(&mesh, arena, input, thread_count, error);
    return status ? status : make_surface(surface, arena, &mesh, input, needs, thread_count, error);
}

MesoStatus meso_quad_surface_make(MesoQuadSurface *surface, MesoArena *arena, const MesoPolygonMesh *mesh,
                                  const MesoInput *input, uint32_t thread_count, MesoError *error)
{
    MesoStatus status = make_surface(&surface->surface, arena, mesh, input, MESO_NEEDS_QUADS, thread_count, error);
    if (status)
        return status;
    status = meso_quad_mesh_view(&surface->mesh, arena, &surface->surface, error);
    if (!status)
        status = meso_slot_graph_view(&surface->graph, &surface->surface, error);
    return status == MESO_ERR_INPUT ? meso_fail_prefix(error, input->path) : status;
}

MesoStatus meso_quad_surface_read(MesoQuadSurface *surface, MesoArena *arena, const MesoInput *input,
                                  uint32_t thread_count, MesoError *error)
{
    MesoPolygonMesh mesh;
    MesoStatus status = meso_polygon_mesh_read(&mesh, arena, input, thread_count, error);
    return status ? status : meso_quad_surface_make(surface, arena, &mesh, input, thread_count, error);
}

MesoStatus meso_quad_surface_read_pairs(MesoQuadSurface *surface, MesoArena *arena, const MesoInput *input,
                                        uint32_t thread_count, MesoError *error)
{
    MesoPolygonMesh triangles, quads;
    uint32_t face;
    MesoStatus status = meso_polygon_mesh_read(&triangles, arena, input, thread_count, error);
    if (status)
        return status;
    status = meso_mesh_pair_triangles(&quads, arena, &triangles, &face, error);
    if (status == MESO_ERR_INPUT)
        return meso_mesh_fail_at_face(input, face, error);
    return status ? status : meso_quad_surface_make(surface, arena, &quads, input, thread_count, error);
}

MesoStatus meso_quad_surface_wind(MesoQuadSurface *surface, MesoArena *arena, const MesoInput *input,
                                  const uint8_t *over, uint8_t **found, MesoWindCounts *counts, uint32_t thread_count,
                                  MesoError *error)
{
    const MesoSurface from = surface->surface;
    MesoStatus status = MESO_OK;
    MesoPolygonMesh mesh;
    *counts = (MesoWindCounts){0};
    if (!over) {
        *found = NULL;
        if (from.edges.reversed_count == 0)
            return MESO_OK;
        over = *found = MESO_NEW(arena, uint8_t, from.mesh.face_count, error);
        status = *found ? meso_mesh_find_windings(*found, &from.mesh, &from.edges, error) : MESO_ERR_MEMORY;
    }
    if (!status)
        status = meso_mesh_wind(&mesh, arena, &from.mesh, &from.edges, over, counts, error);
    return status ? status : meso_quad_surface_make(surface, arena, &mesh, input, thread_count, error);
}

MesoStatus meso_triangle_mesh_read(MesoTriangleMesh *mesh, MesoArena *arena, const MesoInput *input,
                                   uint32_t thread_count, MesoError *error)
{
    MesoPolygonMesh polygons;
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = meso_polygon_mesh_read(&polygons, &scratch, input, thread_count, error);
    if (!status)
        status = meso_polygon_triangulate(mesh, arena, &polygons, error);
    meso_arena_release(&scratch);
    return status;
}
