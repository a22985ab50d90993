/* Small problems under constraints, for the tests of this folder. */
#ifndef MESO_CONSTRAINTS_FIXTURE_H
#define MESO_CONSTRAINTS_FIXTURE_H

#include <string.h>

#include "libcore/solve/explain.h"
#include "libcore/solve/solve_fixture.h"

typedef struct FixtureCase {
    MesoArena arena;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoSlotGraph graph;
    MesoConstraints constraints;
} FixtureCase;

/* `tiles` tiles that have no turn, on a grid of open rows. */
static inline void fixture_case_begin(FixtureCase *c, const int32_t (*labels)[4], uint32_t interfaces, uint32_t tiles,
                                      uint32_t width, uint32_t height)
{
    memset(c, 0, sizeof *c);
    meso_arena_init(&c->arena);
    c->set = fixture_set(&c->arena, interfaces, tiles, labels, false, false, false);
    c->graph = fixture_grid(&c->arena, width, height, false, false, false);
    CHECK(meso_variant_set_build(&c->variants, &c->arena, &c->set, NULL) == MESO_OK);
    CHECK(c->variants.count == tiles);
}

/* Gives the tiles the permissions, and lists their variants anew. */
static inline void fixture_case_permit(FixtureCase *c, bool rotation, bool flip)
{
    for (uint32_t t = 0; t < c->set.tile_count; t++) {
        c->set.tiles[t].rotation = rotation;
        c->set.tiles[t].flip_x = flip;
    }
    CHECK(meso_variant_set_build(&c->variants, &c->arena, &c->set, NULL) == MESO_OK);
}

/* What is solved holds to the constraints, by the check's own way. */
static inline MesoSolveResult fixture_case_solve(FixtureCase *c, MesoEngine engine, uint64_t seed, uint32_t attempts)
{
    MesoSolveResult result;
    MesoError error;
    MesoSolveOptions options = {.seed = seed, .engine = engine, .max_attempts = attempts, .max_dead_ends = 10};
    CHECK(meso_solve(&result, &c->arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, &c->constraints},
                     &options, &error) == MESO_OK);
    CHECK(meso_explain(&result, &c->arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, &c->constraints},
                       options.seed, &error) == MESO_OK);
    if (result.verdict == MESO_VERDICT_SOLVED)
        CHECK(meso_constraints_check(&c->constraints, &result.assignment, &c->set, &c->variants, &c->graph,
                                     &error) == MESO_OK);
    return result;
}

static inline uint32_t fixture_uses(const MesoAssignment *assignment, uint32_t tile)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < assignment->slot_count; s++)
        count += assignment->tile[s] == tile;
    return count;
}

#endif
