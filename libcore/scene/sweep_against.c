/* Faces of a sweep that are against their normals. */
#include "libcore/scene/sweep.h"

/* Columns at once, the last of which are the first of the next; and rings. */
enum { SIDE = 32, MOST_RINGS = 64 };

/* Of the cosine between a normal and a triangle's: others may come to lie on either side, as they are rounded. */
static const float LEAST_COSINE = 0.01f;

static bool is_against(const MesoMeshVertex *a, const MesoMeshVertex *b, const MesoMeshVertex *c)
{
    MesoVec3 area = meso_vec3_cross(meso_vec3_sub(b->position, a->position), meso_vec3_sub(c->position, a->position));
    float most = fmaxf(fmaxf(meso_vec3_dot(area, a->normal), meso_vec3_dot(area, b->normal)),
                       meso_vec3_dot(area, c->normal));
    return most < 0 || most * most < LEAST_COSINE * LEAST_COSINE * meso_vec3_dot(area, area);
}

/* Of both cuts of a quad. */
static uint32_t count_quad(const MesoMeshVertex *a, const MesoMeshVertex *b, const MesoMeshVertex *c,
                           const MesoMeshVertex *d)
{
    return (uint32_t)is_against(a, b, c) + (uint32_t)is_against(a, c, d) + (uint32_t)is_against(a, b, d) +
           (uint32_t)is_against(b, c, d);
}

/* Between a ring and the next, of as many columns. */
static uint32_t count_row(const MesoSweepColumn *columns, const MesoMeshVertex *ring, uint32_t width)
{
    const MesoMeshVertex *next = ring + width;
    uint32_t against = 0;
    for (uint32_t c = 0; c + 1 < width; c++)
        against += columns[c].joins_next ? count_quad(&ring[c], &next[c], &next[c + 1], &ring[c + 1]) : 0;
    return against;
}

uint32_t meso_sweep_against(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                            uint32_t enough)
{
    MesoScene straight = *scene;
    MesoMeshVertex vertices[SIDE * MOST_RINGS];
    uint32_t numbers[SIDE], against = 0;
    uint32_t rings = kind->division_count < MOST_RINGS ? kind->division_count : MOST_RINGS;
    straight.deform = MESO_SWEEP_CURVES;    /* cages do not turn faces against their normals */
    for (uint32_t begin = 0; begin + 1 < kind->column_count && against <= enough; begin += SIDE - 1) {
        uint32_t left = kind->column_count - begin, width = left < SIDE ? left : SIDE;
        for (uint32_t c = 0; c < width; c++)
            numbers[c] = begin + c;
        MesoSweepGrid grid = {.columns = numbers, .column_count = width, .ring_count = rings};
        meso_sweep_grid(&straight, kind, sweep, &grid, vertices);
        for (uint32_t r = 0; r + 1 < rings; r++)
            against += count_row(&scene->columns[kind->column_begin + begin], &vertices[(size_t)r * width], width);
    }
    return against;
}
