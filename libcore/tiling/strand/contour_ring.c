#include "libcore/tiling/strand/contour_ring.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* A ring's corner is sharp where it turns by more than 50 degrees. */
static const float CREASE_COSINE = 0.6428f;

typedef struct Share {
    double rest;
    uint32_t segment;
} Share;

static int compare_shares(const void *a, const void *b)
{
    const Share *x = a, *y = b;
    if (x->rest != y->rest)
        return x->rest > y->rest ? -1 : 1;
    return x->segment < y->segment ? -1 : x->segment > y->segment;
}

static double segment_length(const MesoVec2 *p, uint32_t count, uint32_t i)
{
    return (double)meso_vec2_length(meso_vec2_sub(p[(i + 1) % count], p[i]));
}

MesoStatus meso_contour_resample(const MesoVec2 *contour, uint32_t contour_count, MesoVec2 *out,
                                 uint32_t count, MesoArena *scratch, MesoError *error)
{
    assert(count >= contour_count && contour_count > 0);
    MesoArenaMark mark = meso_arena_mark(scratch);
    Share *shares = MESO_NEW(scratch, Share, contour_count, error);
    uint32_t *extra = MESO_NEW(scratch, uint32_t, contour_count, error);
    if (!shares || !extra)
        return MESO_ERR_MEMORY;

    /* Largest remainders: whole shares first, then one each where most is left. */
    double total = 0;
    for (uint32_t i = 0; i < contour_count; i++)
        total += segment_length(contour, contour_count, i);
    uint32_t left = count - contour_count;
    for (uint32_t i = 0; i < contour_count; i++) {
        double share = total > 0 ? (count - contour_count) * segment_length(contour, contour_count, i) / total : 0;
        extra[i] = (uint32_t)share < left ? (uint32_t)share : left;
        shares[i] = (Share){share - extra[i], i};
        left -= extra[i];
    }
    qsort(shares, contour_count, sizeof *shares, compare_shares);
    for (uint32_t i = 0; left > 0; i = (i + 1) % contour_count, left--)
        extra[shares[i].segment]++;

    for (uint32_t i = 0; i < contour_count; i++)
        for (uint32_t k = 0; k <= extra[i]; k++)
            *out++ = meso_vec2_lerp(contour[i], contour[(i + 1) % contour_count],
                                    (float)k / (float)(extra[i] + 1));
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

static MesoVec2 segment_direction(MesoVec2 a, MesoVec2 b)
{
    MesoVec2 d = meso_vec2_sub(b, a);
    float length = meso_vec2_length(d);
    return length > 0 ? (MesoVec2){d.x / length, d.y / length} : (MesoVec2){1, 0};
}

static bool is_crease(const MesoVec2 *points, uint32_t count, uint32_t i)
{
    MesoVec2 a = segment_direction(points[(i + count - 1) % count], points[i]);
    MesoVec2 b = segment_direction(points[i], points[(i + 1) % count]);
    return a.x * b.x + a.y * b.y < CREASE_COSINE;
}

static MesoStatus make_arrays(MesoRing *ring, MesoArena *arena, uint32_t count, MesoError *error)
{
    *ring = (MesoRing){count, MESO_NEW(arena, MesoVec2, count, error), MESO_NEW(arena, bool, count, error)};
    return ring->points && ring->creased ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_ring_resample(MesoRing *ring, MesoArena *arena, const MesoVec2 *contour, uint32_t contour_count,
                              uint32_t count, MesoError *error)
{
    MesoStatus status = make_arrays(ring, arena, count, error);
    if (!status)
        status = meso_contour_resample(contour, contour_count, ring->points, count, arena, error);
    for (uint32_t i = 0; i < count && !status; i++)
        ring->creased[i] = is_crease(ring->points, count, i);
    return status;
}

/* Point i of the contour is where (i + 1) / contour_count of the way around is; so is a ring's. */
MesoStatus meso_ring_spread(MesoRing *ring, MesoArena *arena, const MesoVec2 *contour, uint32_t contour_count,
                            uint32_t count, MesoError *error)
{
    assert(count >= contour_count && contour_count > 0);
    if (make_arrays(ring, arena, count, error))
        return MESO_ERR_MEMORY;
    for (uint32_t j = 0; j < count; j++) {
        uint64_t way = (uint64_t)(j + 1) * contour_count + (uint64_t)count * (contour_count - 1);   /* not below 0 */
        uint32_t i = (uint32_t)(way / count % contour_count);
        float t = (float)(way % count) / (float)count;
        ring->points[j] = meso_vec2_lerp(contour[i], contour[(i + 1) % contour_count], t);
    }
    for (uint32_t i = 0; i < contour_count; i++)
        if (is_crease(contour, contour_count, i)) {
            uint64_t j = ((uint64_t)(i + 1) * count + contour_count / 2) / contour_count - 1;
            ring->points[j] = contour[i];
            ring->creased[j] = true;
        }
    return MESO_OK;
}
