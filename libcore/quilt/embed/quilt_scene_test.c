/* Quilts in space and as scenes: places, bodies by element and material, normals, coordinates, ids. */
#include "libcore/quilt/embed/quilt_scene.h"

#include "libcore/quilt/embed/quilt_embed.h"
#include "libcore/quilt/embed/quilt_fixture.h"

static bool is_near(MesoVec3 p, float x, float y, float z)
{
    return fabsf(p.x - x) < 1e-5f && fabsf(p.y - y) < 1e-5f && fabsf(p.z - z) < 1e-5f;
}

static MesoVec3 *embedded(const QuiltFixture *f, MesoArena *arena)
{
    MesoError error;
    MesoVec3 *directions = MESO_NEW(arena, MesoVec3, f->base.vertex_count, &error);
    MesoVec3 *positions = MESO_NEW(arena, MesoVec3, f->quilt.vertex_count, &error);
    CHECK(directions && positions);
    meso_quilt_directions(directions, &f->base);
    meso_quilt_embed(positions, &f->quilt, &f->base, directions, 1);
    return positions;
}

/* The sheet lies flat: a cube of half the height stands where it was put. Bent, it stands along the directions. */
static void test_places(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    QuiltFixture f = quilt_fixture(&arena);
    MesoVec3 *positions = embedded(&f, &arena);
    for (uint32_t v = 0; v < f.quilt.vertex_count; v++) {
        MesoVec3 p = f.swatch.positions[v % 8];
        CHECK(is_near(positions[v], p.x + 0.5f + 2 * (float)(v / 8), p.y + 0.5f, p.z / 2));
    }
    MesoQuiltHeights heights = meso_quilt_heights(&f.quilt);
    CHECK(heights.low == 0 && heights.high == 0.5f);

    for (uint32_t v = 0; v < f.base.vertex_count; v++)      /* stood on its edge */
        f.base.positions[v] = (MesoVec3){f.base.positions[v].x, 0, f.base.positions[v].y};
    positions = embedded(&f, &arena);
    for (uint32_t v = 0; v < 8; v++) {
        MesoVec3 p = f.swatch.positions[v];
        CHECK(is_near(positions[v], p.x + 0.5f, -p.z / 2, p.y + 0.5f));
    }
    meso_triangulation_release(&f.base);
    meso_arena_release(&arena);
}

/* Sides are of one material and five normals, the top of another. */
static void test_bodies(void)
{
    MesoArena arena;
    MesoScene scene;
    MesoError error;
    meso_arena_init(&arena);
    QuiltFixture f = quilt_fixture(&arena);
    CHECK(meso_quilt_scene(&scene, &arena, &f.quilt, &f.swatch, embedded(&f, &arena), 1, &error) == MESO_OK);
    CHECK(scene.body_count == 4 && scene.placed_count == 4 && scene.id_row_count == 2);
    CHECK(scene.bodies[0].vertex_count == 20 && scene.bodies[0].face_count == 10);
    CHECK(scene.bodies[1].vertex_count == 4 && scene.bodies[1].face_count == 2);
    CHECK(scene.placed[0].material == 0 && scene.placed[1].material == 1 && scene.placed[3].ids == 1);
    CHECK_TEXT(scene.material_names[1], "gold");
    CHECK(scene.channel_count == 3 && meso_scene_id(&scene, 1, 0) == 1 && meso_scene_id(&scene, 1, 1) == 1 &&
          meso_scene_id(&scene, 1, 2) == 0);
    for (uint32_t v = 0; v < 4; v++)
        CHECK(is_near(scene.bodies[3].normals[v], 0, 0, 1));
    for (uint32_t b = 0; b < 4; b++) {
        const MesoBody *body = &scene.bodies[b];
        for (uint32_t c = 0; c < 3 * body->face_count; c++) {
            uint32_t v = body->corners[c];
            CHECK(v < body->vertex_count);
            MesoVec3 n = body->normals[v];
            CHECK(fmaxf(fabsf(n.x), fmaxf(fabsf(n.y), fabsf(n.z))) > 0.9999f);
            CHECK(body->uvs[v].x * (1 - body->uvs[v].x) == 0 && body->uvs[v].y * (1 - body->uvs[v].y) == 0);
        }
    }
    CHECK(is_near(scene.box.low, 0.5f, 0.5f, 0) && is_near(scene.box.high, 3.5f, 1.5f, 0.5f));
    CHECK(meso_quilt_show(&scene, &arena, &f.quilt, &f.swatch, &f.base, MESO_QUILT_PRISMS, 2, &error) == MESO_OK);
    CHECK(scene.thickness == 0.5f && is_near(scene.box.high, 3.5f, 1.5f, 0.5f));
    meso_triangulation_release(&f.base);
    meso_arena_release(&arena);
}

/* A swatch without edges that show, and one without coordinates, has each vertex once. */
static void test_smooth(void)
{
    MesoArena arena;
    MesoScene scene;
    MesoError error;
    meso_arena_init(&arena);
    QuiltFixture f = quilt_fixture(&arena);
    MesoVec3 *positions = embedded(&f, &arena);
    f.swatch.corner_uvs = NULL;
    f.swatch.uvs = NULL;
    for (uint32_t h = 0; h < 36; h++)
        f.swatch.twins[h] = MESO_NO_INDEX;
    memset(f.swatch.materials, 0, 12 * sizeof *f.swatch.materials);
    CHECK(meso_quilt_scene(&scene, &arena, &f.quilt, &f.swatch, positions, 3, &error) == MESO_OK);
    CHECK(scene.body_count == 2 && scene.bodies[1].vertex_count == 8 && !scene.bodies[1].uvs);
    for (uint32_t v = 0; v < 8; v++)
        CHECK(fabsf(scene.bodies[1].normals[v].x) > 0.2f && fabsf(scene.bodies[1].normals[v].z) > 0.2f);
    meso_triangulation_release(&f.base);
    meso_arena_release(&arena);
}

static void test_nothing(void)
{
    MesoArena arena;
    MesoScene scene;
    MesoError error;
    meso_arena_init(&arena);
    QuiltFixture f = quilt_fixture(&arena);
    f.quilt.vertex_count = f.quilt.triangle_count = f.quilt.element_count = 0;
    CHECK(meso_quilt_scene(&scene, &arena, &f.quilt, &f.swatch, NULL, 1, &error) == MESO_OK);
    CHECK(scene.body_count == 0);
    meso_triangulation_release(&f.base);
    meso_arena_release(&arena);
}

int main(void)
{
    test_places();
    test_bodies();
    test_smooth();
    test_nothing();
    return 0;
}
