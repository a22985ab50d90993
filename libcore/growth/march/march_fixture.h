/* A surface with its atlas as an image, to march over. */
#ifndef MESO_MARCH_FIXTURE_H
#define MESO_MARCH_FIXTURE_H

#include "libcore/chart/atlas.h"
#include "libcore/geodesic/transport/walk_fixture.h"
#include "libcore/growth/march/texture_march.h"

typedef struct MesoMarchScene {
    MesoWalkScene walk;
    MesoGeometryImage image;
    MesoTextureMarch march;
} MesoMarchScene;

/* Of a mesh that goes with it, by coordinates of its own. */
static inline void meso_march_scene_init_with(MesoMarchScene *scene, MesoTriangulation mesh, const MesoVec2 *uv,
                                              uint32_t size)
{
    meso_walk_scene_init(&scene->walk, mesh);
    CHECK(meso_geometry_image_build(&scene->image, &scene->walk.arena, &scene->walk.mesh, uv, NULL, size, NULL) ==
          MESO_OK);
    scene->march = (MesoTextureMarch){.mesh = &scene->walk.mesh, .ground = &scene->walk.ground, .image = &scene->image};
}

/* By an atlas of charts of about that radius; 0: the atlas chooses. */
static inline void meso_march_scene_init(MesoMarchScene *scene, MesoTriangulation mesh, float radius, uint32_t size)
{
    MesoAtlas atlas;
    MesoArena arena;
    meso_arena_init(&arena);
    CHECK(meso_atlas_build(&atlas, &arena, &mesh, &(MesoChartOptions){radius, 4, 4}, NULL) == MESO_OK);
    meso_march_scene_init_with(scene, mesh, atlas.corner_uv, size);
    meso_arena_release(&arena);
}

static inline void meso_march_scene_release(MesoMarchScene *scene)
{
    meso_walk_scene_release(&scene->walk);
}

/* How far apart two tips are, in texels. */
static inline double meso_fixture_texels_apart(const MesoMarchScene *scene, const MesoTip *a, const MesoTip *b)
{
    double p[3], q[3];
    meso_tip_position(&scene->walk.mesh, a, p);
    meso_tip_position(&scene->walk.mesh, b, q);
    return meso_fixture_apart(p, q) * scene->image.texels_per_unit;
}

/* The angle between their headings. */
static inline double meso_fixture_headings_apart(const MesoMarchScene *scene, const MesoTip *a, const MesoTip *b)
{
    double p[3], q[3];
    meso_walk_direction(&scene->walk.mesh, a->triangle, a->heading, p);
    meso_walk_direction(&scene->walk.mesh, b->triangle, b->heading, q);
    return 2 * asin(fmin(1, 0.5 * meso_fixture_apart(p, q)));
}

/* What jumps are worth: in texels, and against the straightest walk over the same seam. */
typedef struct MesoJumpErrors {
    const MesoMarchScene *scene;
    uint64_t count;
    double distance, worst_distance;    /* between the place where it lands and where a walk of that length is */
    double angle, worst_angle;          /* between the headings there */
} MesoJumpErrors;

static inline void meso_fixture_tell_jump(void *context, const MesoTextureJump *jump)
{
    MesoJumpErrors *errors = context;
    const MesoMarchScene *scene = errors->scene;
    /* a walk that stands on the seam has not turned with the surface there yet */
    double texels = 0.01 + meso_fixture_texels_apart(scene, &jump->from, &jump->to);
    MesoWalk walk = {.tip = jump->from, .length = texels / scene->image.texels_per_unit};
    meso_walks(&scene->walk.ground, &walk, 1, NULL);
    double distance = meso_fixture_texels_apart(scene, &walk.tip, &jump->to);
    double angle = meso_fixture_headings_apart(scene, &walk.tip, &jump->to);
    errors->count++;
    errors->distance += distance;
    errors->worst_distance = fmax(errors->worst_distance, distance);
    errors->angle += angle;
    errors->worst_angle = fmax(errors->worst_angle, angle);
}

#endif
