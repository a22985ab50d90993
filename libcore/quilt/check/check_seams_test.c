/* A strand of two patches: its seam shows where the edges there are shorter, or the tube is bent. */
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/check/check_seams.h"

enum { AROUND = 12, RINGS = 61, WAVE = 12 };

/*
 * A tube of RINGS - 1 rows whose upper half is another patch: `squeeze` makes the two rows at the seam higher, `bulge`
 * the ring there wider. With `waves` the whole tube widens and narrows, again and again, and is known to be copies of a
 * swatch that does so once.
 */
static MesoSeams measure(float squeeze, float bulge, bool waves)
{
    MesoArena arena;
    MesoSeams seams;
    MesoError error;
    meso_arena_init(&arena);
    MesoTriangulation tube = meso_fixture_tube(AROUND, RINGS - 1, 30);
    uint32_t *patches = MESO_NEW(&arena, uint32_t, tube.triangle_count, &error);
    uint32_t *elements = MESO_NEW(&arena, uint32_t, tube.triangle_count, &error);
    uint32_t *origins = MESO_NEW(&arena, uint32_t, tube.vertex_count, &error);
    CHECK(patches && elements && origins);
    const uint32_t middle = RINGS / 2;
    for (uint32_t v = 0; v < tube.vertex_count; v++) {
        uint32_t ring = (v / AROUND + WAVE / 2) % WAVE;     /* the middle is the first, borders are not */
        float width = waves ? 1 + 0.3f * cosf((float)(2 * MESO_PI * ring / WAVE)) : 1;
        origins[v] = ring * AROUND + v % AROUND;
        tube.positions[v].x *= width;
        tube.positions[v].y *= width;
    }
    for (uint32_t t = 0; t < tube.triangle_count; t++)
        patches[t] = t / (2 * AROUND) >= middle;
    for (uint32_t v = 0; v < AROUND; v++) {
        MesoVec3 *ring = &tube.positions[middle * AROUND];
        ring[v].x *= bulge;
        ring[v].y *= bulge;
    }
    for (uint32_t v = 0; v < tube.vertex_count; v++)
        tube.positions[v].z += v / AROUND > middle ? squeeze : v / AROUND < middle ? -squeeze : 0;
    const uint32_t vertex_begin[2] = {0, tube.vertex_count}, triangle_begin[2] = {0, tube.triangle_count};
    const MesoCheckMesh mesh = {
        .vertex_count = tube.vertex_count, .triangle_count = tube.triangle_count, .element_count = 1,
        .positions = tube.positions, .corners = tube.corners, .vertex_begin = vertex_begin,
        .triangle_begin = triangle_begin, .patches = patches, .twins = tube.twins, .elements = elements,
        .origins = waves ? origins : NULL,
    };
    CHECK(meso_check_seams(&seams, &arena, &mesh, &error) == MESO_OK);
    meso_triangulation_release(&tube);
    meso_arena_release(&arena);
    return seams;
}

int main(void)
{
    MesoSeams k = measure(0, 1, false);
    /* six from each vertex of the ring; borders do not count. Nothing is to be seen of a seam in a regular tube */
    CHECK(k.seam_edge_count == 6 * AROUND && k.other_edge_count == 2 * (3 * RINGS - 2 - 2) * AROUND - k.seam_edge_count);
    CHECK(k.length_distance < 0.03 && k.angle_distance < 0.03);
    CHECK(fabs(k.placed_length_distance - k.length_distance) < 1e-9);
    CHECK(fabs(k.placed_angle_distance - k.angle_distance) < 1e-9);
    k = measure(-0.3f, 1, false);       /* uprights, a third of all edges, are shorter */
    CHECK(fabs(k.length_distance - 1.0 / 3) < 0.01);
    k = measure(0, 1.2f, false);
    CHECK(k.angle_distance > 0.25);
    k = measure(0, 1, true);        /* where a strand is widest it is not as elsewhere, but a seam there is none */
    CHECK(k.length_distance > 0.1 && k.placed_length_distance < 0.02 && k.placed_angle_distance < 0.02);
    k = measure(0, 1.2f, true);
    CHECK(k.placed_length_distance > 0.1 && k.placed_angle_distance > 0.1);
    return 0;
}
