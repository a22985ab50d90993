#include "libcore/quilt/embed/quilt_lay.h"

#include "libcore/quilt/embed/quilt_charts.h"

/* ---- the layer ---- */

/* Twins and a corner at each vertex, of a base that has positions and corners. MESO_ERR_INPUT as build_layer(). */
static MesoStatus join_triangles(MesoTriangulation *joined, const MesoTriangulation *base, MesoArena *scratch,
                                 MesoError *error)
{
    MesoHalfEdges edges;
    MesoPolygonMesh polygons = {.vertex_count = base->vertex_count, .face_count = base->triangle_count,
                                .corner_count = 3 * base->triangle_count, .side_count = 3,
                                .positions = base->positions, .corners = base->corners};
    MesoStatus status = meso_half_edges_join(&edges, scratch, &polygons, 1, error);
    if (status || edges.reversed_count)
        return status ? status : MESO_ERR_INPUT;
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

/* MESO_ERR_INPUT, which is no error to tell of, where triangles are wound against each other. */
static MesoStatus build_layer(MesoVec3 *directions, MesoPrismReport *report, MesoTriangulation *joined,
                              MesoArena *scratch, const MesoTriangulation *base, const MesoPrismOptions *options,
                              MesoError *error)
{
    MesoError reason;
    MesoStatus status = join_triangles(joined, base, scratch, &reason);
    if (!status)
        status = meso_prisms_build(directions, report, scratch, joined, options, &reason);
    if (status && status != MESO_ERR_INPUT && error)
        *error = reason;
    return status;
}

MesoStatus meso_quilt_layer(MesoVec3 *directions, MesoPrismReport *report, const MesoTriangulation *base,
                            MesoQuiltHeights heights, uint32_t thread_count, MesoError *error)
{
    const MesoPrismOptions options = {heights.low, heights.high, true, thread_count};
    MesoArena scratch;
    MesoTriangulation joined;
    meso_arena_init(&scratch);
    MesoStatus status = build_layer(directions, report, &joined, &scratch, base, &options, error);
    meso_arena_release(&scratch);
    if (status != MESO_ERR_INPUT)
        return status;
    /* no layer in one sense: a base that has been moved may be anything */
    *report = (MesoPrismReport){0};
    meso_quilt_directions(directions, base);
    return MESO_OK;
}

/* ---- places ---- */

MesoQuiltEmbedding meso_quilt_embedding_named(const char *name)
{
    return *name == 'c' ? MESO_QUILT_CHARTS : *name == 'n' ? MESO_QUILT_NORMALS : MESO_QUILT_PRISMS;
}

static MesoStatus place(MesoVec3 *positions, MesoQuiltLay *lay, MesoArena *scratch, const MesoQuilt *quilt,
                        const MesoTriangulation *base, MesoQuiltEmbedding embedding, uint32_t thread_count,
                        MesoError *error)
{
    MesoTriangulation joined;
    MesoQuiltHeights heights = meso_quilt_heights(quilt);
    const MesoPrismOptions options = {heights.low, heights.high, embedding != MESO_QUILT_NORMALS, thread_count};
    MesoVec3 *directions = MESO_NEW(scratch, MesoVec3, base->vertex_count, error);
    if (!directions)
        return MESO_ERR_MEMORY;
    MesoStatus status = build_layer(directions, &lay->layer, &joined, scratch, base, &options, error);
    if (status && status != MESO_ERR_INPUT)
        return status;
    if (!status && embedding == MESO_QUILT_CHARTS && heights.low < heights.high)
        return meso_quilt_embed_charts(positions, lay, scratch, quilt, &joined, directions, heights, thread_count,
                                       error);
    if (status) {
        lay->layer = (MesoPrismReport){0};
        meso_quilt_directions(directions, base);
    }
    meso_quilt_embed(positions, quilt, base, directions, thread_count);
    return MESO_OK;
}

MesoStatus meso_quilt_lay(MesoVec3 *positions, MesoQuiltLay *lay, const MesoQuilt *quilt,
                            const MesoTriangulation *base, MesoQuiltEmbedding embedding, uint32_t thread_count,
                            MesoError *error)
{
    MesoArena scratch;
    MesoQuiltLay ignored;
    lay = lay ? lay : &ignored;
    *lay = (MesoQuiltLay){0};
    meso_arena_init(&scratch);
    MesoStatus status = place(positions, lay, &scratch, quilt, base, embedding, thread_count, error);
    meso_arena_release(&scratch);
    return status;
}
