#include "libcore/quilt/seam/clip.h"

#include "libcore/quilt/seam/strand_fixture.h"

static MesoClip clip_mesh(const MesoFixtureMesh *mesh, const float *values, MesoArena *arena)
{
    MesoClip clip;
    MesoError error;
    CHECK(meso_clip_positive(&clip, arena, values, mesh->vertex_count, mesh->corners, mesh->triangle_count, &error) ==
          MESO_OK);
    return clip;
}

static double area_of(const MesoVec3 *positions, const uint32_t *corners, uint32_t triangle_count)
{
    double area = 0;
    for (uint32_t t = 0; t < triangle_count; t++) {
        const uint32_t *c = &corners[3 * (size_t)t];
        MesoVec3 e = meso_vec3_sub(positions[c[1]], positions[c[0]]), f = meso_vec3_sub(positions[c[2]], positions[c[0]]);
        area += 0.5 * meso_vec3_length(meso_vec3_cross(e, f));
    }
    return area;
}

/*
 *      2          a plane through both sides at 0: the upper corner is kept
 *     / \
 *    0---1
 */
static void test_one_triangle(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoVec3 positions[3] = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}};
    uint32_t corners[3] = {0, 1, 2};
    MesoFixtureMesh mesh = {3, 1, positions, corners};
    const float values[3] = {-1, -1, 1};
    MesoClip clip = clip_mesh(&mesh, values, &arena);
    CHECK(clip.kept_count == 1 && clip.vertices[0] == 2 && clip.made_count == 2 && clip.triangle_count == 1);
    CHECK(clip.shares[0] == 0.5f && clip.shares[1] == 0.5f && clip.origins[0] == 0);
    CHECK(clip.loop_count == 1 && clip.open_count == 1 && clip.loop_begin[1] == 2);
    const float whole[3] = {1, 2, 3}, none[3] = {-1, 0, -3};
    clip = clip_mesh(&mesh, whole, &arena);
    CHECK(clip.kept_count == 3 && clip.triangle_count == 1 && clip.loop_count == 0);
    clip = clip_mesh(&mesh, none, &arena);
    CHECK(clip.kept_count == 0 && clip.triangle_count == 0 && clip.loop_count == 0);
    meso_arena_release(&arena);
}

/* Both sides of random cuts: manifold, each open exactly along its loops, and together of the area of the whole. */
static void test_both_sides(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    MesoFixtureMesh mesh = meso_fixture_tube(30, 9, 0.1f, 0.05f);
    float *values = malloc(mesh.vertex_count * sizeof *values);
    CHECK(values);
    double whole = area_of(mesh.positions, mesh.corners, mesh.triangle_count);
    uint32_t ends = meso_fixture_open_edges(mesh.corners, mesh.triangle_count);
    for (int n = 0; n < 300; n++) {
        MesoArena arena;
        meso_arena_init(&arena);
        MesoVec3 a = {meso_fixture_random(&random), meso_fixture_random(&random), meso_fixture_random(&random)};
        float at = 0.5f * meso_fixture_random(&random), waves = 40 * meso_fixture_random(&random);
        double area = 0;
        uint32_t loops[2];
        for (int side = 0; side < 2; side++) {
            for (uint32_t v = 0; v < mesh.vertex_count; v++) {
                MesoVec3 p = mesh.positions[v];
                float value = meso_vec3_dot(a, p) - at + (n % 3 == 0 ? 0.2f * sinf(waves * p.x) : 0);
                values[v] = side ? -value : value;
            }
            MesoClip clip = clip_mesh(&mesh, values, &arena);
            MesoVec3 *positions = malloc(((size_t)clip.kept_count + clip.made_count + 1) * sizeof *positions);
            CHECK(positions);
            meso_clip_positions(positions, &clip, mesh.positions);
            area += area_of(positions, clip.corners, clip.triangle_count);
            uint32_t open = meso_fixture_open_edges(clip.corners, clip.triangle_count);
            CHECK(open <= ends + clip.loop_begin[clip.loop_count]);
            loops[side] = clip.loop_count;
            for (uint32_t i = 0; i < clip.made_count; i++)
                CHECK(values[clip.ends[2 * i]] > 0 && values[clip.ends[2 * i + 1]] <= 0);
            free(positions);
        }
        CHECK(loops[0] == loops[1]);
        CHECK(fabs(area - whole) < 2e-3 * whole);   /* points keep away from the ends of their edges */
        meso_arena_release(&arena);
    }
    free(values);
    meso_fixture_mesh_release(&mesh);
}

/* Three triangles around one edge. */
static void test_not_manifold(void)
{
    MesoArena arena;
    MesoClip clip;
    MesoError error;
    meso_arena_init(&arena);
    const uint32_t corners[9] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
    const float values[5] = {1, -1, -1, -1, -1};
    CHECK(meso_clip_positive(&clip, &arena, values, 5, corners, 3, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "triangles do not fit together where they are cut");
    meso_arena_release(&arena);
}

int main(void)
{
    test_one_triangle();
    test_both_sides();
    test_not_manifold();
    return 0;
}
