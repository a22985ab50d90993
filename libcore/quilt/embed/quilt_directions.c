/* Where height 1 lies over each vertex of a base, so that the layer does not fold. */
#include "libcore/quilt/embed/quilt_embed.h"
#include "libcore/shell/prisms.h"

/* Twins and a corner at each vertex, of a base that has positions and corners. */
static MesoStatus join_triangles(MesoTriangulation *joined, const MesoTriangulation *base, MesoArena *scratch,
                                 MesoError *error)
{
    MesoHalfEdges edges;
    MesoPolygonMesh polygons = {.vertex_count = base->vertex_count, .face_count = base->triangle_count,
                                .corner_count = 3 * base->triangle_count, .side_count = 3,
                                .positions = base->positions, .corners = base->corners};
    MesoStatus status = meso_half_edges_join(&edges, scratch, &polygons, 1, error);
    if (status)
        return status;
    *joined = (MesoTriangulation){.vertex_count = base->vertex_count, .triangle_count = base->triangle_count,
                                  .positions = base->positions, .corners = base->corners, .twins = edges.twin};
    joined->vertex_corner = MESO_NEW(scratch, uint32_t, base->vertex_count, error);
    if (!joined->vertex_corner)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < base->vertex_count; v++)
        joined->vertex_corner[v] = MESO_NO_INDEX;
    for (uint32_t c = 3 * base->triangle_count; c-- > 0;)
        joined->vertex_corner[base->corners[c]] = c;
    return MESO_OK;
}

MesoStatus meso_quilt_layer(MesoVec3 *directions, MesoPrismReport *report, const MesoTriangulation *base,
                            MesoQuiltHeights heights, MesoError *error)
{
    MesoArena scratch;
    MesoTriangulation joined;
    MesoError reason;
    meso_arena_init(&scratch);
    MesoStatus status = join_triangles(&joined, base, &scratch, &reason);
    MesoPrismOptions options = {heights.low, heights.high, true};
    if (!status)
        status = meso_prisms_build(directions, report, &scratch, &joined, &options, &reason);
    meso_arena_release(&scratch);
    if (status == MESO_ERR_INPUT) {     /* no layer in one sense: a base that has been moved may be anything */
        *report = (MesoPrismReport){0};
        meso_quilt_directions(directions, base);
        return MESO_OK;
    }
    if (status && error)
        *error = reason;
    return status;
}
