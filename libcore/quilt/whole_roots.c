#include "libcore/quilt/whole_roots.h"

#include "libcore/math/box.h"
#include "libcore/quilt/match/triangle_distance.h"

/* How far a root may be from its strand, in mean edges. */
#define ROOT_REACH 0.25f

static bool boxes_meet(const MesoBox *a, const MesoBox *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

static MesoBox element_box(const MesoSwatch *swatch, uint32_t element)
{
    uint32_t first = swatch->vertex_begin[element];
    return meso_box_of(&swatch->positions[first], swatch->vertex_begin[element + 1] - first);
}

/* The vertex of `element` nearest to a triangle, where that is nearer than *square. */
static void try_triangle(uint32_t *root, float *square, const MesoSwatch *swatch, uint32_t element, const MesoVec3 *p)
{
    for (uint32_t v = swatch->vertex_begin[element]; v < swatch->vertex_begin[element + 1]; v++) {
        float d = meso_triangle_square(swatch->positions[v], p[0], p[1], p[2]);
        if (d < *square) {
            *square = d;
            *root = v;
        }
    }
}

static void try_strand(uint32_t *root, float *square, const MesoSwatch *swatch, uint32_t element, const MesoBox *around,
                       uint32_t strand)
{
    for (uint32_t t = swatch->triangle_begin[strand]; t < swatch->triangle_begin[strand + 1]; t++) {
        const uint32_t *corner = &swatch->corners[3 * (size_t)t];
        const MesoVec3 p[3] = {swatch->positions[corner[0]], swatch->positions[corner[1]], swatch->positions[corner[2]]};
        MesoBox box = meso_box_of(p, 3);
        if (boxes_meet(&box, around))
            try_triangle(root, square, swatch, element, p);
    }
}

void meso_whole_roots(uint32_t *roots, const MesoSwatch *swatch)
{
    float reach = ROOT_REACH * swatch->mean_edge;
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        roots[e] = MESO_NO_INDEX;
        if (swatch->kinds[e] != MESO_ELEMENT_WHOLE)
            continue;
        MesoBox around = element_box(swatch, e);
        around.low = meso_vec3_sub(around.low, (MesoVec3){reach, reach, reach});
        around.high = meso_vec3_add(around.high, (MesoVec3){reach, reach, reach});
        float square = reach * reach;
        for (uint32_t f = 0; f < swatch->element_count; f++) {
            MesoBox box = element_box(swatch, f);
            if (swatch->kinds[f] == MESO_ELEMENT_STRAND && boxes_meet(&box, &around))
                try_strand(&roots[e], &square, swatch, e, &around, f);
        }
    }
}
