/* Whole elements go with the strands that they grow from: leaves with their stem. */
#include <string.h>

#include "libcore/quilt/finish/finish_relax_work.h"
#include "libcore/quilt/whole_roots.h"

/* Where the ring that an element grows from is not there, so many to each side of it along its strand may carry it. */
enum { ASIDE_MOST = 12 };

static uint32_t nearest_ring(const MesoStrandRings *rings, MesoVec3 place)
{
    uint32_t best = MESO_NO_INDEX;
    float least = INFINITY;
    for (uint32_t i = 0; i < rings->count; i++) {
        float distance = meso_vec3_length(meso_vec3_sub(rings->middles[i], place));
        best = distance < least ? i : best;
        least = fminf(distance, least);
    }
    return best;
}

MesoStatus meso_relax_find_carriers(bool *all, MesoRelaxing *r, MesoError *error)
{
    const MesoSwatch *swatch = r->swatch;
    uint32_t *roots = MESO_NEW(r->arena, uint32_t, swatch->element_count, error);
    r->carriers = MESO_NEW(r->arena, uint32_t, swatch->element_count, error);
    if (!roots || !r->carriers)
        return MESO_ERR_MEMORY;
    meso_whole_roots(roots, swatch);
    memset(r->carriers, 0xff, swatch->element_count * sizeof *r->carriers);
    *all = true;
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        if (swatch->kinds[e] == MESO_ELEMENT_STRAND)
            continue;
        if (roots[e] != MESO_NO_INDEX)
            r->carriers[e] = nearest_ring(r->rings, swatch->positions[roots[e]]);
        *all &= r->carriers[e] != MESO_NO_INDEX;
    }
    return MESO_OK;
}

/* The node that stands for a ring of a patch: its own, or the next one along the strand. */
static uint32_t carrying_node(const MesoRelaxing *r, uint32_t patch, uint32_t ring)
{
    uint32_t before[2] = {ring, ring}, at[2] = {r->rings->next[2 * (size_t)ring], r->rings->next[2 * (size_t)ring + 1]};
    uint32_t node = *meso_relax_entry(r, patch, ring);
    for (int step = 0; step < 2 * ASIDE_MOST && node == MESO_NO_INDEX; step++) {
        int way = step % 2;
        if (at[way] == MESO_NO_INDEX)
            continue;
        const uint32_t *next = &r->rings->next[2 * (size_t)at[way]];
        node = *meso_relax_entry(r, patch, at[way]);
        uint32_t after = next[next[0] == before[way]];
        before[way] = at[way];
        at[way] = after;
    }
    return node;
}

void meso_relax_carry(MesoQuilt *quilt, const MesoRelaxing *r, const MesoFinishWork *work)
{
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        uint32_t ring = r->carriers[quilt->element_origins[e]];
        uint32_t node = ring == MESO_NO_INDEX
                            ? MESO_NO_INDEX
                            : carrying_node(r, quilt->patches[quilt->triangle_begin[e]], ring);
        for (uint32_t v = quilt->vertex_begin[e]; v < quilt->vertex_begin[e + 1] && node != MESO_NO_INDEX; v++)
            quilt->vertices[v] = meso_relax_put(r, work, node, quilt->vertices[v].triangle, quilt->origins[v]);
    }
}
