#include "libcore/mesh/cut/mesh_domain.h"

/* A rank takes longer than a look into a table of all vertices, which is worth it where the domain is small. */
enum { SPARSE_BELOW = 4 };

static void mark(MesoDomainVertices *vertices, const MesoTriangulation *mesh, const MesoDomain *domain)
{
    if (!domain || !domain->triangles) {
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            if (mesh->vertex_corner[v] != MESO_NO_INDEX)
                meso_bits_set(vertices->bits, v);
        return;
    }
    for (uint32_t i = 0; i < domain->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++)
            meso_bits_set(vertices->bits, mesh->corners[3 * domain->triangles[i] + k]);
}

MesoStatus meso_domain_vertices_init(MesoDomainVertices *vertices, MesoArena *arena, const MesoTriangulation *mesh,
                                     const MesoDomain *domain, MesoError *error)
{
    uint32_t words = meso_bits_words(mesh->vertex_count);
    *vertices = (MesoDomainVertices){.vertex_count = mesh->vertex_count, .count = mesh->vertex_count};
    vertices->sparse = meso_domain_size(domain, mesh) < mesh->vertex_count / SPARSE_BELOW;
    vertices->bits = MESO_NEW(arena, uint64_t, words, error);
    if (!vertices->bits)
        return MESO_ERR_MEMORY;
    mark(vertices, mesh, domain);
    if (!vertices->sparse)
        return MESO_OK;
    vertices->before = MESO_NEW(arena, uint32_t, words, error);
    if (!vertices->before)
        return MESO_ERR_MEMORY;
    vertices->count = 0;
    for (uint32_t w = 0; w < words; w++) {
        vertices->before[w] = vertices->count;
        vertices->count += (uint32_t)__builtin_popcountll(vertices->bits[w]);
    }
    return MESO_OK;
}
