#include "libcore/quilt/seam/section.h"

#include "libcore/quilt/seam/clip.h"
#include "libcore/quilt/seam/strand_fixture.h"

static MesoSection measured(uint32_t count, const uint32_t *vertices, const MesoVec3 *positions)
{
    MesoSection section = {.count = count, .vertices = vertices, .positions = positions};
    meso_section_measure(&section);
    return section;
}

/* A square of side 2 in x = 3, the mesh below it. */
static void test_measure(void)
{
    const MesoVec3 positions[4] = {{3, 1, 1}, {3, 1, -1}, {3, -1, -1}, {3, -1, 1}};
    const uint32_t vertices[4] = {0, 1, 2, 3};
    MesoSection section = measured(4, vertices, positions);
    CHECK(section.centre.x == 3 && section.centre.y == 0 && section.centre.z == 0);
    CHECK(section.length == 8 && fabsf(section.reach - 1.41421356f) < 1e-6f);
    CHECK(section.area.x == 4 && section.area.y == 0 && section.area.z == 0);
}

/* The halves of a tube, cut across at random with a gap and moved apart, joined again. */
static void join_halves(MesoRandom *random, bool cap)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    MesoFixtureMesh tubes[2];
    MesoClip clips[2];
    MesoVec3 *positions[2];
    MesoVec3 slant = {1, 0.5f * meso_fixture_random(random), 0.5f * meso_fixture_random(random)};
    MesoVec3 shift = {0, 0.1f * meso_fixture_random(random), 0.1f * meso_fixture_random(random)};
    for (int side = 0; side < 2; side++) {
        tubes[side] = meso_fixture_tube(20 + meso_random_below(random, 20), 3 + meso_random_below(random, 12), 0.1f, 0.03f);
        float *values = malloc(tubes[side].vertex_count * sizeof *values);
        CHECK(values);
        for (uint32_t v = 0; v < tubes[side].vertex_count; v++) {
            float value = meso_vec3_dot(slant, tubes[side].positions[v]) - 0.5f;
            values[v] = (side ? value : -value) - 0.02f;
        }
        CHECK(meso_clip_positive(&clips[side], &arena, values, tubes[side].vertex_count, tubes[side].corners,
                                 tubes[side].triangle_count, &error) == MESO_OK);
        free(values);
        CHECK(clips[side].loop_count == 1 && clips[side].open_count == 0);
        uint32_t count = clips[side].kept_count + clips[side].made_count;
        positions[side] = MESO_NEW(&arena, MesoVec3, count, &error);
        CHECK(positions[side]);
        meso_clip_positions(positions[side], &clips[side], tubes[side].positions);
        for (uint32_t v = 0; side && v < count; v++)
            positions[side][v] = meso_vec3_add(positions[side][v], shift);
    }
    MesoSection a = measured(clips[0].loop_begin[1], clips[0].loops, positions[0]);
    MesoSection b = measured(clips[1].loop_begin[1], clips[1].loops, positions[1]);
    CHECK(a.area.x > 0 && b.area.x < 0);    /* away from both halves */
    uint32_t offset = clips[0].kept_count + clips[0].made_count, ring = a.count + b.count;
    uint32_t total = clips[0].triangle_count + clips[1].triangle_count;
    uint32_t *corners = malloc(3 * sizeof *corners * ((size_t)total + ring));
    CHECK(corners);
    memcpy(corners, clips[0].corners, 3 * sizeof *corners * clips[0].triangle_count);
    for (uint32_t i = 0; i < 3 * clips[1].triangle_count; i++)
        corners[3 * clips[0].triangle_count + i] = clips[1].corners[i] + offset;
    uint32_t before = meso_fixture_open_edges(corners, total), added = ring;
    if (cap) {
        added = a.count - 2;
        CHECK(meso_section_cap(&corners[3 * (size_t)total], &arena, &a, &error) == MESO_OK);
    } else {
        meso_section_zip(&corners[3 * (size_t)total], &a, &b, meso_section_align(&a, &b), offset);
    }
    CHECK(meso_fixture_open_edges(corners, total + added) == before - (cap ? a.count : ring));
    free(corners);
    meso_fixture_mesh_release(&tubes[0]);
    meso_fixture_mesh_release(&tubes[1]);
    meso_arena_release(&arena);
}

static void test_halves(void)
{
    MesoRandom random;
    meso_random_init(&random, 2, 0);
    for (int n = 0; n < 1000; n++)
        join_halves(&random, false);
    for (int n = 0; n < 200; n++)
        join_halves(&random, true);
}

/* Rings between loops of any points, far apart and crossing: manifold all the same. */
static void test_wild_rings(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    for (int n = 0; n < 1000; n++) {
        uint32_t counts[2] = {3 + meso_random_below(&random, 20), 3 + meso_random_below(&random, 20)};
        uint32_t vertices[46], corners[3 * 46];
        MesoVec3 positions[46];
        for (uint32_t i = 0; i < counts[0] + counts[1]; i++) {
            vertices[i] = i;
            positions[i] = (MesoVec3){meso_fixture_random(&random), meso_fixture_random(&random),
                                      meso_fixture_random(&random)};
        }
        MesoSection a = measured(counts[0], vertices, positions);
        MesoSection b = measured(counts[1], &vertices[counts[0]], positions);
        meso_section_zip(corners, &a, &b, meso_section_align(&a, &b), 0);
        CHECK(meso_fixture_open_edges(corners, counts[0] + counts[1]) == counts[0] + counts[1]);
    }
}

/* Where a loop of other vertices on the same circle is walked, points lie on the circle, in order. */
static void test_across(void)
{
    enum { A = 12, B = 31 };
    MesoVec3 positions[A + B], across[A];
    uint32_t vertices[A + B];
    for (uint32_t i = 0; i < A + B; i++) {
        float angle = i < A ? 6.2831853f * (float)i / A : -6.2831853f * ((float)(i - A) + 0.3f) / B;
        positions[i] = (MesoVec3){i < A ? 0 : 1, cosf(angle), sinf(angle)};
        vertices[i] = i;
    }
    MesoSection a = measured(A, vertices, positions), b = measured(B, &vertices[A], positions);
    meso_section_across(across, &a, &b, meso_section_align(&a, &b));
    for (uint32_t i = 0; i < A; i++) {
        MesoVec3 apart = meso_vec3_sub(across[i], positions[i]);
        CHECK(apart.x == 1 && fabsf(apart.y) < 0.15f && fabsf(apart.z) < 0.15f);
    }
}

/*
 * A wave of a strip, bent around an axis: triangles from side to side have the strip's area where it is laid flat, all
 * of one winding, and are no longer than its sides and ends.
 */
static void test_strip(void)
{
    enum { HALF = 700, COUNT = 2 * HALF };
    static MesoVec3 positions[COUNT];
    static MesoVec2 places[COUNT];
    static uint32_t vertices[COUNT], corners[3 * (COUNT - 2)];
    for (uint32_t i = 0; i < COUNT; i++) {
        bool back = i >= HALF;
        float x = 0.1f * (float)(back ? COUNT - 1 - i : i), y = sinf(0.5f * x) + (back ? 0.5f : 0);
        places[i] = (MesoVec2){x, y};
        positions[i] = (MesoVec3){12 * cosf(x / 12), 12 * sinf(x / 12), y};
        vertices[i] = i;
    }
    MesoSection section = measured(COUNT, vertices, positions);
    CHECK(meso_section_strip(corners, &section, places));
    double area = 0;
    for (uint32_t t = 0; t < COUNT - 2; t++) {
        const uint32_t *c = &corners[3 * t];
        MesoVec2 a = meso_vec2_sub(places[c[1]], places[c[0]]), b = meso_vec2_sub(places[c[2]], places[c[0]]);
        CHECK(meso_vec2_cross(a, b) < 1e-5f);       /* against the loop */
        area -= 0.5 * (double)meso_vec2_cross(a, b);
        for (uint32_t k = 0; k < 3; k++)
            CHECK(meso_vec3_length(meso_vec3_sub(positions[c[k]], positions[c[(k + 1) % 3]])) < 0.7f);
    }
    CHECK(fabs(area - 0.5 * 0.1 * (HALF - 1)) < 1e-3);
    CHECK(meso_fixture_open_edges(corners, COUNT - 2) == COUNT);
    for (uint32_t i = 0; i < COUNT; i++)    /* a loop that goes to and fro is none */
        places[i].x = fmodf(places[i].x, 7);
    CHECK(!meso_section_strip(corners, &section, places));
}

int main(void)
{
    test_measure();
    test_halves();
    test_wild_rings();
    test_across();
    test_strip();
    return 0;
}
