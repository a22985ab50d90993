/* Growth on surfaces made here, for tests and benchmarks. */
#ifndef MESO_GROWTH_FIXTURE_H
#define MESO_GROWTH_FIXTURE_H

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/geodesic/transport/walk_fixture.h"
#include "libcore/growth/engine/growth.h"
#include "libcore/growth/language/grammar_read.h"

/* A surface, a grammar whose maps are constant, and starts at random. */
typedef struct MesoGrowthScenery {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoGrowthGround ground;
    MesoGrammar grammar;
    MesoGrowthContexts contexts;
    MesoGrowthStarts starts;
    float values[16];
} MesoGrowthScenery;

/* The mesh goes with it. */
static inline void meso_scenery_init(MesoGrowthScenery *scenery, MesoTriangulation mesh)
{
    meso_arena_init(&scenery->arena);
    scenery->mesh = mesh;
    CHECK(!meso_growth_ground_build(&scenery->ground, &scenery->arena, &scenery->mesh, (MesoVec3){0, 0, 1}, 1, NULL));
}

static inline void meso_scenery_release(MesoGrowthScenery *scenery)
{
    meso_arena_release(&scenery->arena);
    meso_triangulation_release(&scenery->mesh);
}

/* Reads a grammar, whose lengths are in units of the surface where they are in metres. */
static inline void meso_scenery_read(MesoGrowthScenery *scenery, const char *text)
{
    MesoError error = {0};
    if (meso_grammar_read(&scenery->grammar, &scenery->arena, "test", text, strlen(text), NULL, &error)) {
        fprintf(stderr, "%s\n", error.message);
        CHECK(false);
    }
    MesoGrowthMap *maps = MESO_NEW(&scenery->arena, MesoGrowthMap, scenery->grammar.map_count, NULL);
    MesoGrowthField *fields = MESO_NEW(&scenery->arena, MesoGrowthField, scenery->grammar.field_count, NULL);
    CHECK(maps && fields && scenery->grammar.map_count <= 16);
    for (uint32_t i = 0; i < scenery->grammar.map_count; i++)
        maps[i] = (MesoGrowthMap){.domain = MESO_GROWTH_CONSTANT, .values = &scenery->values[i]};
    for (uint32_t i = 0; i < scenery->grammar.field_count; i++)
        fields[i] = (MesoGrowthField){.kind = MESO_GROWTH_TOWARDS, .vector = {0, 0, 1}};
    scenery->contexts = (MesoGrowthContexts){.ground = &scenery->ground, .map_count = scenery->grammar.map_count,
                                             .field_count = scenery->grammar.field_count, .maps = maps,
                                             .fields = fields, .noise = 1};
}

/* The seeds of the grammar in turn. */
static inline void meso_scenery_strew(MesoGrowthScenery *scenery, uint32_t count, uint64_t seed)
{
    MesoRandom random;
    meso_random_init(&random, seed, 0);
    scenery->starts = (MesoGrowthStarts){count, MESO_NEW(&scenery->arena, MesoGrowthStart, count, NULL)};
    CHECK(scenery->starts.starts);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t of = i % scenery->grammar.seed_count;
        scenery->starts.starts[i] = (MesoGrowthStart){
            meso_fixture_tip(&scenery->ground.walk, &random), of,
            meso_growth_seed_key(seed, scenery->grammar.seeds[of].site, i)};
    }
}

static inline MesoGrowthOptions meso_scenery_options(const MesoGrowthScenery *scenery, uint32_t thread_count)
{
    return (MesoGrowthOptions){.grammar = &scenery->grammar, .contexts = &scenery->contexts,
                               .starts = &scenery->starts, .thread_count = thread_count};
}

static inline MesoGrown meso_scenery_grow(MesoGrowthScenery *scenery, MesoArena *arena, uint32_t thread_count)
{
    MesoGrown grown;
    MesoError error = {0};
    MesoGrowthOptions options = meso_scenery_options(scenery, thread_count);
    if (meso_grow(&grown, arena, &options, &error)) {
        fprintf(stderr, "%s\n", error.message);
        CHECK(false);
    }
    return grown;
}

#endif
