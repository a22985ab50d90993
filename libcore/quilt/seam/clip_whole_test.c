/* Meshes cut along their edges: tubes by random functions, and between two rings. */
#include "libcore/quilt/seam/clip.h"
#include "libcore/quilt/seam/strand_fixture.h"

enum { RINGS = 30, SIDES = 9 };

static MesoClip clip_mesh(const MesoFixtureMesh *mesh, const float *values, MesoArena *arena)
{
    MesoClip clip;
    MesoError error;
    CHECK(meso_clip_whole(&clip, arena, values, mesh->vertex_count, mesh->corners, mesh->triangle_count, &error) ==
          MESO_OK);
    return clip;
}

/* Values by ring: the border is a ring of the mesh, as it was, and what is kept is bands of it. */
static void test_between_rings(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoFixtureMesh mesh = meso_fixture_tube(RINGS, SIDES, 0.1f, 0.05f);
    float values[RINGS * SIDES];
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        values[v] = (float)(v / SIDES) - 11.5f;
    MesoClip clip = clip_mesh(&mesh, values, &arena);
    CHECK(clip.loop_count == 1 && clip.open_count == 0 && clip.loop_begin[1] == SIDES && clip.made_count == SIDES);
    CHECK(clip.kept_count == (RINGS - 13) * SIDES && clip.triangle_count == 2 * (RINGS - 13) * SIDES);
    MesoVec3 positions[RINGS * SIDES];
    meso_clip_positions(positions, &clip, mesh.positions);
    for (uint32_t i = 0; i < SIDES; i++) {
        uint32_t made = clip.loops[i], v = clip.ends[2 * (made - clip.kept_count)];
        CHECK(v / SIDES == 12 && positions[made].x == mesh.positions[v].x);
    }
    /* kept to the left: as the triangles there have it */
    bool along = false;
    for (uint32_t h = 0; h < 3 * clip.triangle_count; h++)
        along |= clip.corners[h] == clip.loops[0] && clip.corners[h % 3 == 2 ? h - 2 : h + 1] == clip.loops[1];
    CHECK(along);
    meso_fixture_mesh_release(&mesh);
    meso_arena_release(&arena);
}

/* Random values: manifold, open along the loops and at the ends alone, and only triangles that are positive. */
static void test_random(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    MesoFixtureMesh mesh = meso_fixture_tube(RINGS, SIDES, 0.1f, 0.05f);
    float values[RINGS * SIDES];
    uint32_t ends = meso_fixture_open_edges(mesh.corners, mesh.triangle_count);
    for (int n = 0; n < 400; n++) {
        MesoArena arena;
        meso_arena_init(&arena);
        float least = 0.9f * meso_fixture_random(&random);
        uint32_t whole = 0;
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            values[v] = meso_fixture_random(&random) - least;
        for (uint32_t t = 0; t < mesh.triangle_count; t++)
            whole += values[mesh.corners[3 * t]] > 0 && values[mesh.corners[3 * t + 1]] > 0 &&
                     values[mesh.corners[3 * t + 2]] > 0;
        MesoClip clip = clip_mesh(&mesh, values, &arena);
        CHECK(clip.triangle_count == whole);
        uint32_t open = meso_fixture_open_edges(clip.corners, clip.triangle_count);
        uint32_t in_loops = clip.loop_begin[clip.loop_count] - clip.open_count;     /* edges of them */
        CHECK(open >= in_loops && open <= in_loops + ends);
        for (uint32_t i = 0; i < clip.loop_begin[clip.loop_count]; i++)
            for (uint32_t k = 0; k < i; k++)
                CHECK(clip.loops[i] != clip.loops[k]);
        meso_arena_release(&arena);
    }
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
    const float values[5] = {1, 1, 1, -1, -1};
    CHECK(meso_clip_whole(&clip, &arena, values, 5, corners, 3, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "triangles do not fit together where they are cut");
    meso_arena_release(&arena);
}

int main(void)
{
    test_between_rings();
    test_random();
    test_not_manifold();
    return 0;
}
