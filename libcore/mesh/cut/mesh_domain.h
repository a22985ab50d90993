/* Walking the parts of a mesh, with scratch that is as large as the part. A domain that is NULL is all of the mesh. */
#ifndef MESO_MESH_DOMAIN_H
#define MESO_MESH_DOMAIN_H

#include "libcore/base/bits.h"
#include "libcore/mesh/cut/triangulation.h"

static inline uint32_t meso_domain_size(const MesoDomain *domain, const MesoTriangulation *mesh)
{
    return domain && domain->triangles ? domain->triangle_count : mesh->triangle_count;
}

/* Its triangle number `i`. */
static inline uint32_t meso_domain_triangle(const MesoDomain *domain, uint32_t i)
{
    return domain && domain->triangles ? domain->triangles[i] : i;
}

static inline bool meso_domain_holds(const MesoDomain *domain, const MesoTriangulation *mesh, uint32_t triangle)
{
    return !domain || meso_domain_has(domain, mesh, triangle);
}

/* The half-edge across that lies in the domain; MESO_NO_INDEX at the domain's border. */
static inline uint32_t meso_domain_across(const MesoDomain *domain, const MesoTriangulation *mesh, uint32_t half_edge)
{
    uint32_t across = mesh->twins[half_edge];
    return across != MESO_NO_INDEX && meso_domain_holds(domain, mesh, across / 3) ? across : MESO_NO_INDEX;
}

/* The vertices of a domain's triangles, with numbers of their own by which scratch is held. */
typedef struct MesoDomainVertices {
    uint32_t vertex_count;  /* of the mesh */
    uint32_t count;         /* numbers are below this; not all are in use where the domain is most of the mesh */
    bool sparse;            /* numbered one after another, ascending; else numbers are those of the mesh */
    uint64_t *bits;         /* which vertices of the mesh they are */
    uint32_t *before;       /* [words of bits] where sparse: how many lie in the words before */
} MesoDomainVertices;

/* O(triangles of the domain), and a bit a vertex of the mesh. MESO_ERR_MEMORY alone. */
MesoStatus meso_domain_vertices_init(MesoDomainVertices *vertices, MesoArena *arena, const MesoTriangulation *mesh,
                                     const MesoDomain *domain, MesoError *error);

/* The number of a vertex that belongs. */
static inline uint32_t meso_domain_vertex_number(const MesoDomainVertices *vertices, uint32_t vertex)
{
    if (!vertices->sparse)
        return vertex;
    uint64_t below = vertices->bits[vertex / 64] & (((uint64_t)1 << vertex % 64) - 1);
    return vertices->before[vertex / 64] + (uint32_t)__builtin_popcountll(below);
}

/* The first vertex that belongs from `vertex` on; MESO_NO_INDEX where there is none. */
static inline uint32_t meso_domain_vertex_from(const MesoDomainVertices *vertices, uint32_t vertex)
{
    if (vertex >= vertices->vertex_count)
        return MESO_NO_INDEX;
    uint32_t words = meso_bits_words(vertices->vertex_count), w = vertex / 64;
    uint64_t word = vertices->bits[w] >> vertex % 64 << vertex % 64;
    while (!word && ++w < words)
        word = vertices->bits[w];
    return word ? 64 * w + (uint32_t)__builtin_ctzll(word) : MESO_NO_INDEX;
}

#endif
