#include "libcore/tiling/search/strand_places.h"

#include "libcore/tiling/fixture/solve_fixture.h"

typedef struct Ends {
    uint32_t tile;
    uint8_t from[2], to[2];     /* side and section */
} Ends;

/* A set of one interface with two sections, "a", and one with none, "b". */
static MesoTileSet set_of(MesoArena *arena, uint32_t tiles, const int32_t (*labels)[4], const Ends *ends,
                          uint32_t count)
{
    MesoTileSet set = fixture_set(arena, 2, tiles, labels, true, true, false);
    set.sections = MESO_NEW(arena, MesoSection, 2, NULL);
    set.sweeps = MESO_NEW(arena, MesoSweep, count, NULL);
    CHECK(set.sections && set.sweeps);
    set.sections[0].name = "tube";
    set.sections[1].name = "wire";
    set.section_count = set.interfaces[0].section_count = set.interfaces[1].section_begin = 2;
    for (uint32_t t = 0; t < tiles; t++) {
        set.tiles[t].sweep_begin = set.sweep_count;
        for (; set.sweep_count < count && ends[set.sweep_count].tile == t; set.sweep_count++) {
            const Ends *e = &ends[set.sweep_count];
            set.sweeps[set.sweep_count] = (MesoSweep){.from_side = e->from[0], .from_section = e->from[1],
                                                      .to_side = e->to[0], .to_section = e->to[1]};
        }
        set.tiles[t].sweep_count = set.sweep_count - set.tiles[t].sweep_begin;
    }
    return set;
}

/* Tiles that some slot of the graph may hold under the rule, as bits. */
static uint32_t tiles_left(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph, MesoStrandRule rule,
                           uint32_t first, uint32_t last)
{
    MesoVariantSet variants;
    MesoPropagation propagation;
    const MesoConstraints constraints = {.strands = rule};
    uint32_t left = 0;
    CHECK(meso_variant_set_build(&variants, arena, set, NULL) == MESO_OK);
    CHECK(meso_strand_places_init(&propagation, arena, &(MesoTilingProblem){set, &variants, graph, &constraints},
                                  NULL) == MESO_OK);
    for (uint32_t s = first; s <= last; s++)
        for (uint32_t v = 0; v < variants.count; v++)
            if (meso_bits_test(meso_domain_bits(&propagation.domains, propagation.initial[s]), v))
                left |= 1u << variants.tile[v];
    meso_propagation_release(&propagation);
    return left;
}

static const MesoStrandRule no_loops = {.no_loops = true}, acyclic = {.acyclic = true};

/* Tube and wire run side by side: t0 straight, t1 around a corner; t2 joins them; t3 is a blank. */
static const int32_t pipe_labels[5][4] = {{1, 2, -1, -2}, {1, -1, 2, 2}, {1, 2, 2, 2}, {-2, 2, 2, -2}, {1, 2, 2, 2}};
static const Ends pipe_ends[5] = {{0, {0, 0}, {2, 0}}, {0, {0, 1}, {2, 1}}, {1, {0, 0}, {1, 0}},
                                  {1, {0, 1}, {1, 1}}, {2, {0, 0}, {0, 1}}};

static void test_pipes(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSlotGraph sheet = fixture_grid(&arena, 30, 30, false, false, false);
    MesoSlotGraph torus = fixture_grid(&arena, 30, 30, true, true, false);
    MesoTileSet set = set_of(&arena, 4, pipe_labels, pipe_ends, 5);
    /* Over a border a pipe may leave; not where it is exempt, nor where there is none. */
    CHECK(tiles_left(&arena, &set, &sheet, no_loops, 0, 899) == 15);
    CHECK(tiles_left(&arena, &set, &torus, no_loops, 0, 899) == 8);
    set.interfaces[0].border_exempt = true;
    CHECK(tiles_left(&arena, &set, &sheet, no_loops, 0, 899) == 8);
    CHECK(tiles_left(&arena, &set, &sheet, acyclic, 0, 899) == 8);
    CHECK(tiles_left(&arena, &set, &sheet, (MesoStrandRule){.max_length = 9}, 0, 899) == 15);
    for (MesoEngine engine = MESO_ENGINE_AUTO; engine <= MESO_ENGINE_EXACT; engine++) {
        MesoVariantSet variants;
        MesoSolveResult result;
        const MesoConstraints constraints = {.strands = no_loops};
        const MesoSolveOptions options = {.engine = engine, .max_attempts = 1};
        CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
        CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &sheet, &constraints},
                         &options, NULL) == MESO_OK);
        CHECK(result.verdict == MESO_VERDICT_SOLVED && result.backtracks == 0 && result.conflicts == 0);
    }
    /* A plug without a sweep is an end for both. */
    set = set_of(&arena, 5, pipe_labels, pipe_ends, 5);
    CHECK(tiles_left(&arena, &set, &torus, no_loops, 0, 899) == 31);
    meso_arena_release(&arena);
}

/* One tile of quarter circles, which on a torus are rings all; pieces are looked at one by one. */
static void test_pieces(void)
{
    static const int32_t labels[2][4] = {{1, 1, -1, -1}, {1, 1, -1, -1}};
    static const Ends ends[5] = {{0, {0, 0}, {1, 0}}, {0, {2, 0}, {3, 0}},
                                 {1, {0, 0}, {1, 0}}, {1, {0, 0}, {2, 0}}, {1, {0, 0}, {3, 0}}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = set_of(&arena, 1, labels, ends, 2);
    MesoSlotGraph graph = fixture_graph(&arena, 8);
    for (uint32_t piece = 0; piece < 8; piece += 4)
        for (uint32_t s = 0; s < 4; s++) {
            uint32_t right = piece + (s ^ 1), up = piece + (s ^ 2);
            if (piece == 0 || s % 2 == 0)
                fixture_glue(&graph, piece + s, 0, right, 2);
            fixture_glue(&graph, piece + s, 1, up, 3);
        }
    CHECK(tiles_left(&arena, &set, &graph, no_loops, 0, 3) == 0);
    CHECK(tiles_left(&arena, &set, &graph, no_loops, 4, 7) == 1);
    /* With a star strands may fork on the torus: they have cycles yet. */
    set = set_of(&arena, 2, labels, ends, 5);
    CHECK(tiles_left(&arena, &set, &graph, no_loops, 0, 3) == 3);
    CHECK(tiles_left(&arena, &set, &graph, acyclic, 0, 3) == 0);
    CHECK(tiles_left(&arena, &set, &graph, acyclic, 4, 7) == 3);
    meso_arena_release(&arena);
}

/* By itself t0 has a cycle, t1 a strand of three sweeps, and t2 two strands that touch no side of it. */
static void test_alone(void)
{
    static const int32_t labels[4][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, {-1, -1, -1, -1}};
    static const Ends ends[8] = {{0, {0, 0}, {0, 1}}, {0, {0, 1}, {1, 0}}, {0, {1, 0}, {0, 0}},
                                 {1, {0, 0}, {0, 1}}, {1, {0, 1}, {1, 0}}, {1, {1, 0}, {2, 0}},
                                 {2, {4, 0}, {5, 0}}, {2, {4, 1}, {5, 1}}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = set_of(&arena, 4, labels, ends, 8);
    MesoSlotGraph graph = fixture_grid(&arena, 4, 3, false, false, false);
    set.tiles[2].side_count = 6;
    set.tiles[2].labels[MESO_SIDE_TOP] = set.tiles[2].labels[MESO_SIDE_BOTTOM] = 1;
    CHECK(tiles_left(&arena, &set, &graph, acyclic, 0, 11) == (2 | 4 | 8));
    CHECK(tiles_left(&arena, &set, &graph, no_loops, 0, 11) == 15);
    CHECK(tiles_left(&arena, &set, &graph, (MesoStrandRule){.max_length = 2}, 0, 11) == (4 | 8));
    CHECK(tiles_left(&arena, &set, &graph, (MesoStrandRule){.max_length = 3}, 0, 11) == 15);
    CHECK(tiles_left(&arena, &set, &graph, (MesoStrandRule){.connected = true}, 0, 11) == (1 | 2 | 8));
    /* A slot that is glued to itself makes more of a tile than others do. */
    MesoSlotGraph bent = fixture_graph(&arena, 1);
    static const int32_t loop_labels[1][4] = {{1, -1, 2, 2}};
    static const Ends loop_ends[1] = {{0, {0, 0}, {1, 0}}};
    fixture_glue(&bent, 0, 0, 0, 1);
    set = set_of(&arena, 1, loop_labels, loop_ends, 1);
    CHECK(tiles_left(&arena, &set, &bent, (MesoStrandRule){.connected = true}, 0, 0) == 1);
    CHECK(tiles_left(&arena, &set, &bent, no_loops, 0, 0) == 0);
    meso_arena_release(&arena);
}

int main(void)
{
    test_pipes();
    test_pieces();
    test_alone();
    return 0;
}
