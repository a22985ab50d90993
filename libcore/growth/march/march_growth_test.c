/* Growth by marches through texels: on a flat chart as by walks, to a texel; on round ones whole, for any threads. */
#include "libcore/chart/chart_fixture.h"
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/march/march_fixture.h"

typedef struct Scene {
    MesoGrowthScenery scenery;
    MesoGeometryImage image;
    MesoTextureMarch texture;
    MesoGrowthMarch march;
} Scene;

static void init(Scene *scene, MesoTriangulation mesh, float radius, uint32_t size, const char *text)
{
    MesoGrowthScenery *scenery = &scene->scenery;
    MesoAtlas atlas;
    meso_scenery_init(scenery, mesh);
    meso_scenery_read(scenery, text);
    CHECK(!meso_atlas_build(&atlas, &scenery->arena, &scenery->mesh, &(MesoChartOptions){radius, 4, 4}, NULL));
    CHECK(!meso_geometry_image_build(&scene->image, &scenery->arena, &scenery->mesh, atlas.corner_uv,
                                     scenery->ground.normals, size, NULL));
    scene->texture = (MesoTextureMarch){.mesh = &scenery->mesh, .ground = &scenery->ground.walk,
                                        .image = &scene->image};
    scene->march = (MesoGrowthMarch){meso_texture_walks, &scene->texture};
}

static MesoGrown grow(Scene *scene, MesoArena *arena, const MesoGrowthMarch *march, uint32_t threads)
{
    MesoGrowthOptions options = meso_scenery_options(&scene->scenery, threads);
    MesoGrown grown;
    options.march = march;
    CHECK(!meso_grow(&grown, arena, &options, NULL));
    return grown;
}

/* Seeds away from the border, and steps that do not come to it: no choice hangs on a texel. */
static void test_flat(void)
{
    Scene scene;
    MesoArena arena;
    meso_arena_init(&arena);
    init(&scene, meso_fixture_flat(40, 40, 0.1f), 6, 512,
         "meso-grow 1\nunit m\nshape cord = tube\nlimit generations 12\n"
         "seed Shoot(10 mm) on vertices\n"
         "rule Shoot(w) -> {\n turn(normal(0, 20 deg))\n"
         " step(5 cm, 20 deg, shape: cord, width: w, end: 0.99*w, cross: true)\n"
         " choose { 70%: Shoot(0.99*w)\n"
         " 30%: { branch { turn(normal(45 deg, 8 deg)) Shoot(0.8*w) } Shoot(0.99*w) } } }\n");
    meso_scenery_strew(&scene.scenery, 60, 5);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene.scenery.starts.count; i++) {
        MesoGrowthStart *start = &scene.scenery.starts.starts[i];
        MesoWalk walk = {.tip = start->tip, .length = 0.8};
        bool inside = true;
        for (uint32_t k = 0; k < 8 && inside; k++) {
            walk = (MesoWalk){.tip = start->tip, .length = 0.8};
            meso_tip_turn(&walk.tip, k * MESO_PI / 4);
            meso_walks(&scene.scenery.ground.walk, &walk, 1, NULL);
            inside = walk.stop == MESO_WALK_DONE;
        }
        if (inside)
            scene.scenery.starts.starts[kept++] = *start;
    }
    CHECK(kept > 10);
    scene.scenery.starts.count = kept;
    MesoGrown walked = grow(&scene, &arena, NULL, 1), marched = grow(&scene, &arena, &scene.march, 1);
    CHECK(walked.element_count > 1000 && marched.element_count == walked.element_count);
    CHECK(marched.joint_count == walked.joint_count && marched.branch_count == walked.branch_count);
    for (uint32_t j = 0; j < walked.joint_count; j++) {
        double apart = meso_vec3_length(meso_vec3_sub(walked.joints[j].position, marched.joints[j].position));
        CHECK(apart * scene.image.texels_per_unit < 1);
    }
    meso_arena_release(&arena);
    meso_scenery_release(&scene.scenery);
}

/* With space kept clear, on a sphere of many charts. */
static void test_round(void)
{
    Scene scene;
    MesoArena arena;
    meso_arena_init(&arena);
    init(&scene, meso_fixture_sphere(32, 0.2f, 1), 0.2f, 1024,
         "meso-grow 1\nunit m\nshape cord = tube\nlimit generations 60\n"
         "seed Shoot(10 mm) on vertices\n"
         "rule Shoot(w) -> {\n turn(normal(0, 12 deg))\n"
         " step(3 cm, shape: cord, width: w, end: 0.99*w) else retry(3, 70 deg)\n"
         " choose { 80%: Shoot(0.99*w)\n"
         " 20%: { branch { turn(normal(45 deg, 8 deg)) Shoot(0.8*w) } Shoot(0.99*w) } } }\n");
    meso_scenery_strew(&scene.scenery, 18, 5);
    MesoGrown walked = grow(&scene, &arena, NULL, 1);
    for (uint32_t kind = 0; kind < 4; kind++) {
        scene.texture.snaps = kind & 1;
        scene.texture.metric = kind & 2;
        MesoGrown one = grow(&scene, &arena, &scene.march, 1), three = grow(&scene, &arena, &scene.march, 3);
        CHECK(one.element_count == three.element_count && one.joint_count == three.joint_count);
        CHECK(memcmp(one.joints, three.joints, one.joint_count * sizeof *one.joints) == 0);
        /* other ways, and so other branches, but as many */
        CHECK(fabs(one.length / walked.length - 1) < 0.15 && one.end == walked.end);
    }
    meso_arena_release(&arena);
    meso_scenery_release(&scene.scenery);
}

int main(void)
{
    test_flat();
    test_round();
    return 0;
}
