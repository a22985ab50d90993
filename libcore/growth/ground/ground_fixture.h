/* Surfaces to grow on, with grammars that grow there, for tests. */
#ifndef MESO_GROUND_FIXTURE_H
#define MESO_GROUND_FIXTURE_H

#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/growth/ground/growth_seeds.h"
#include "libcore/growth/language/grammar_read.h"

typedef struct MesoGroundScene {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoGrowthGround ground;
    MesoGrammar grammar;
    MesoGrowthMap maps[8];
    MesoGrowthField fields[8];
    MesoGrowthContexts contexts;
} MesoGroundScene;

/* The mesh goes with it. */
static inline void meso_ground_scene_init(MesoGroundScene *scene, MesoTriangulation mesh)
{
    *scene = (MesoGroundScene){.mesh = mesh};
    meso_arena_init(&scene->arena);
    MesoVec3 up = {0, 0, 2};
    CHECK(meso_growth_ground_build(&scene->ground, &scene->arena, &scene->mesh, up, 2, NULL) == MESO_OK);
    scene->contexts = (MesoGrowthContexts){.ground = &scene->ground, .map_count = 8, .field_count = 8,
                                           .maps = scene->maps, .fields = scene->fields, .noise = 1};
}

static inline void meso_ground_scene_release(MesoGroundScene *scene)
{
    meso_arena_release(&scene->arena);
    meso_triangulation_release(&scene->mesh);
}

static inline void meso_ground_scene_read(MesoGroundScene *scene, const char *text)
{
    MesoError error;
    MesoGrammarOptions options = {.extent = scene->ground.extent > 0 ? scene->ground.extent : 1};
    if (meso_grammar_read(&scene->grammar, &scene->arena, "test", text, strlen(text), &options, &error)) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
}

#endif
