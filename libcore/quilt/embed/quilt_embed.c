#include "libcore/quilt/embed/quilt_embed.h"

#include <string.h>

#include "libcore/base/parallel.h"

enum { GRAIN = 1 << 14 };

typedef struct Embedding {
    MesoVec3 *positions;
    const MesoQuilt *quilt;
    const MesoTriangulation *base;
    const MesoVec3 *directions;
} Embedding;

MesoQuiltHeights meso_quilt_heights(const MesoQuilt *quilt)
{
    MesoQuiltHeights range = {0, 0};
    for (uint32_t v = 0; v < quilt->vertex_count; v++) {
        range.low = fminf(range.low, quilt->vertices[v].height);
        range.high = fmaxf(range.high, quilt->vertices[v].height);
    }
    return range;
}

void meso_quilt_directions(MesoVec3 *directions, const MesoTriangulation *base)
{
    memset(directions, 0, base->vertex_count * sizeof *directions);
    for (uint32_t t = 0; t < base->triangle_count; t++) {
        const uint32_t *v = &base->corners[3 * (size_t)t];
        MesoVec3 a = base->positions[v[0]], b = base->positions[v[1]], c = base->positions[v[2]];
        MesoVec3 area = meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a));
        for (int k = 0; k < 3; k++)
            directions[v[k]] = meso_vec3_add(directions[v[k]], area);
    }
    for (uint32_t v = 0; v < base->vertex_count; v++)
        directions[v] = meso_vec3_direction(directions[v], (MesoVec3){0, 0, 1});
}

static MesoVec3 place(const Embedding *e, const MesoQuiltVertex *vertex)
{
    const uint32_t *corners = &e->base->corners[3 * (size_t)vertex->triangle];
    const float weights[3] = {1 - vertex->b1 - vertex->b2, vertex->b1, vertex->b2};
    MesoVec3 x = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        MesoVec3 above = meso_vec3_mad(e->base->positions[corners[k]], vertex->height, e->directions[corners[k]]);
        x = meso_vec3_mad(x, weights[k], above);
    }
    return x;
}

static void embed_range(void *context, uint64_t begin, uint64_t end)
{
    const Embedding *e = context;
    for (uint64_t v = begin; v < end; v++)
        e->positions[v] = place(e, &e->quilt->vertices[v]);
}

void meso_quilt_embed(MesoVec3 *positions, const MesoQuilt *quilt, const MesoTriangulation *base,
                      const MesoVec3 *directions, uint32_t thread_count)
{
    Embedding e = {positions, quilt, base, directions};
    meso_parallel_for(thread_count, quilt->vertex_count, GRAIN, embed_range, &e);
}
