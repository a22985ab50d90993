/*
 * Small graphs, all of them, with small tile sets: verdicts of the exact engine and
 * of the whole ladder against brute force.
 *
 *     small_graphs_test [SLOTS SECONDS [PART PARTS]]
 *
 * Without arguments a test. With them it goes on to all gluings of up to SLOTS slots,
 * of which it takes each PARTS-th, and ends after SECONDS; see all_cases().
 */
#include <string.h>

#include "libcore/base/clock.h"
#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/fixture/small_graphs.h"
#include "libcore/tiling/fixture/small_sets.h"

/* Steps from one set to the next: primes that divide neither number of sets, so that all get their turn. */
enum { STEP_ONE = 389, STEP_TWO = 1000003 };

typedef struct Cases {
    MesoArena arena;
    uint32_t slot_count, sets_one, sets_two;    /* with each graph; MESO_NO_INDEX: all that are unlike */
    uint32_t part, part_count;
    double deadline;            /* 0: none */
    uint64_t graphs, taken;     /* listed; tried */
    uint64_t involutions;       /* that the listed graphs stand for */
    uint64_t tried, next_one, next_two;
    uint64_t verdicts[3], deciders[2][MESO_DECIDER_STOP + 1];   /* of the ladder; of both engines */
    uint64_t disagreements;
    uint32_t unlike[SMALL_SETS_ONE], unlike_count;
} Cases;

static void print_case(const MesoTileSet *set, const MesoSlotGraph *graph, MesoVerdict expected)
{
    fprintf(stderr, "expected %s; twins", expected == MESO_VERDICT_SOLVED ? "a tiling" : "none");
    for (uint32_t h = 0; h < 4 * graph->slot_count; h++)
        fprintf(stderr, " %d", (int)graph->twin[h]);
    for (uint32_t t = 0; t < set->tile_count; t++)
        fprintf(stderr, ", tile %d %d %d %d", set->tiles[t].labels[0], set->tiles[t].labels[1],
                set->tiles[t].labels[2], set->tiles[t].labels[3]);
    fprintf(stderr, ", rotation %d, flips %d\n", set->default_rotation, set->default_flip_x);
}

static void try_case(Cases *cases, const MesoTileSet *set, const MesoSlotGraph *graph)
{
    MesoArenaMark mark = meso_arena_mark(&cases->arena);
    bool tiling = brute_force(&cases->arena, set, graph, 1, false).count > 0;
    MesoVerdict expected = tiling ? MESO_VERDICT_SOLVED : MESO_VERDICT_UNSOLVABLE;
    bool agrees = true;
    for (uint32_t i = 0; i < 2; i++) {
        MesoSolveResult result = fixture_solve_by(i ? MESO_ENGINE_EXACT : MESO_ENGINE_AUTO, &cases->arena, set,
                                                  graph, cases->tried, 1);
        cases->deciders[i][result.decider]++;
        agrees &= result.verdict == expected;
    }
    if (!agrees)
        print_case(set, graph, expected);
    cases->disagreements += !agrees;
    cases->verdicts[expected]++;
    cases->tried++;
    meso_arena_rewind(&cases->arena, mark);
}

/* The `number`-th set on the gluing, its slots turned in a way that changes from case to case. */
static void try_set(Cases *cases, const uint32_t *twin, uint32_t interfaces, uint32_t number)
{
    MesoArenaMark mark = meso_arena_mark(&cases->arena);
    MesoTileSet set = small_set(&cases->arena, interfaces, number);
    uint32_t turns = (uint32_t)(cases->tried * 0x9e3779b97f4a7c15u >> 40) & ((1u << 2 * SMALL_SLOTS) - 1);
    MesoSlotGraph graph = small_graph(&cases->arena, twin, cases->slot_count, turns);
    try_case(cases, &set, &graph);
    meso_arena_rewind(&cases->arena, mark);
}

static void try_graph(void *context, const uint32_t *twin, uint32_t symmetries)
{
    Cases *cases = context;
    uint64_t involutions = 1;
    for (uint32_t i = 1; i <= cases->slot_count; i++)
        involutions *= 4 * i;
    CHECK(involutions % symmetries == 0);
    cases->involutions += involutions / symmetries;
    if (cases->graphs++ % cases->part_count != cases->part || (cases->deadline && meso_seconds() > cases->deadline))
        return;
    cases->taken++;
    bool all = cases->sets_one == MESO_NO_INDEX;
    for (uint32_t i = 0; i < (all ? cases->unlike_count : cases->sets_one); i++)
        try_set(cases, twin, 1, all ? cases->unlike[i]
                                    : (uint32_t)(cases->next_one++ * STEP_ONE % SMALL_SETS_ONE));
    for (uint32_t i = 0; i < cases->sets_two; i++)
        try_set(cases, twin, 2, (uint32_t)(cases->next_two++ * STEP_TWO % SMALL_SETS_TWO));
}

/* All gluings of `slot_count` slots; that all were listed shows in the number that they stand for. */
static void try_gluings(Cases *cases, uint32_t slot_count, uint32_t sets_one, uint32_t sets_two)
{
    cases->slot_count = slot_count;
    cases->sets_one = sets_one;
    cases->sets_two = sets_two;
    cases->graphs = cases->involutions = 0;
    small_graphs_list(slot_count, try_graph, cases);
    CHECK(cases->involutions == small_graphs_connected(slot_count));
}

static void start(Cases *cases)
{
    memset(cases, 0, sizeof *cases);
    meso_arena_init(&cases->arena);
    cases->part_count = 1;
    cases->unlike_count = small_sets_unlike(&cases->arena, cases->unlike);
}

static void count_pieces(Cases *cases, const MesoSlotGraph *graph, uint64_t pieces[3])
{
    MesoArenaMark mark = meso_arena_mark(&cases->arena);
    uint32_t *component = MESO_NEW(&cases->arena, uint32_t, graph->slot_count, NULL);
    CHECK(component);
    pieces[meso_slot_graph_components(graph, component)]++;
    meso_arena_rewind(&cases->arena, mark);
}

/* Every involution of the sides from `side` on, each with a few tile sets. */
static void try_involutions(Cases *cases, MesoSlotGraph *graph, uint32_t side, uint64_t pieces[3])
{
    while (side < 4 * graph->slot_count && graph->twin[side] != MESO_NO_INDEX)
        side++;
    if (side == 4 * graph->slot_count) {
        count_pieces(cases, graph, pieces);
        for (uint32_t i = 0; i < 4; i++) {
            MesoArenaMark mark = meso_arena_mark(&cases->arena);
            MesoTileSet set = small_set(&cases->arena, 1, (uint32_t)(cases->next_one++ * STEP_ONE % SMALL_SETS_ONE));
            try_case(cases, &set, graph);
            meso_arena_rewind(&cases->arena, mark);
        }
        return;
    }
    try_involutions(cases, graph, side + 1, pieces);
    for (uint32_t other = side + 1; other < 4 * graph->slot_count; other++) {
        if (graph->twin[other] != MESO_NO_INDEX)
            continue;
        graph->twin[side] = other;
        graph->twin[other] = side;
        try_involutions(cases, graph, side + 1, pieces);
        graph->twin[side] = graph->twin[other] = MESO_NO_INDEX;
    }
}

/* One and two slots in all ways, connected or not, numbered in all ways. */
static void test_involutions(void)
{
    static Cases cases;
    uint64_t pieces[3] = {0};
    start(&cases);
    for (uint32_t count = 1; count <= 2; count++) {
        MesoSlotGraph graph = fixture_graph(&cases.arena, count);
        try_involutions(&cases, &graph, 0, pieces);
    }
    CHECK(cases.tried == 4 * (10 + 764) && cases.disagreements == 0);
    CHECK(pieces[1] == small_graphs_connected(1) + small_graphs_connected(2) && pieces[2] == 10 * 10);
    meso_arena_release(&cases.arena);
}

/* All gluings of up to four slots; every set over one interface is used, in each form. */
static void test_gluings(void)
{
    static Cases cases;
    start(&cases);
    try_gluings(&cases, 1, 420, 200);
    try_gluings(&cases, 2, 60, 20);
    try_gluings(&cases, 3, 8, 4);
    try_gluings(&cases, 4, 1, 0);
    CHECK(cases.disagreements == 0 && cases.next_one > SMALL_SETS_ONE);
    CHECK(cases.verdicts[MESO_VERDICT_SOLVED] > 3000 && cases.verdicts[MESO_VERDICT_UNSOLVABLE] > 3000);
    meso_arena_release(&cases.arena);
}

/* All sets over one interface, and some over two, on strips, sheets, rings, Moebius bands and tori of up to six
 * slots. */
static void test_grids(void)
{
    static Cases cases;
    start(&cases);
    MesoArena *arena = &cases.arena;
    MesoSlotGraph graphs[] = {
        fixture_grid(arena, 3, 1, true, false, false), fixture_grid(arena, 3, 1, true, false, true),
        fixture_grid(arena, 5, 1, true, true, false), fixture_grid(arena, 5, 1, true, false, true),
        fixture_grid(arena, 6, 1, false, false, false), fixture_grid(arena, 3, 2, false, false, false),
        fixture_grid(arena, 3, 2, true, false, true), fixture_grid(arena, 3, 2, true, true, false),
    };
    for (uint32_t i = 0; i < cases.unlike_count + 300; i++) {
        MesoArenaMark mark = meso_arena_mark(arena);
        MesoTileSet set = i < cases.unlike_count
                              ? small_set(arena, 1, cases.unlike[i])
                              : small_set(arena, 2, (uint32_t)((uint64_t)i * STEP_TWO % SMALL_SETS_TWO));
        for (uint32_t g = 0; g < sizeof graphs / sizeof *graphs; g++)
            try_case(&cases, &set, &graphs[g]);
        meso_arena_rewind(arena, mark);
    }
    CHECK(cases.disagreements == 0);
    meso_arena_release(arena);
}

static void print_cases(const Cases *cases, double since)
{
    static const char *const deciders[] = {"propagation", "search", "counting", "parity", "probing", "exact",
                                           "attempts", "conflicts", "stop"};
    uint64_t graphs = (cases->graphs + cases->part_count - 1 - cases->part) / cases->part_count;
    printf("%u slots: %llu gluings, %llu of them here, %llu tried: %llu cases, %llu solvable, %llu not, %llu "
           "disagreements, %.1f s;", cases->slot_count, (unsigned long long)cases->graphs, (unsigned long long)graphs,
           (unsigned long long)cases->taken, (unsigned long long)cases->tried,
           (unsigned long long)cases->verdicts[MESO_VERDICT_SOLVED],
           (unsigned long long)cases->verdicts[MESO_VERDICT_UNSOLVABLE],
           (unsigned long long)cases->disagreements, meso_seconds() - since);
    for (uint32_t i = 0; i < 2; i++) {
        printf("%s", i ? "; exact" : " auto");
        for (MesoDecider d = MESO_DECIDER_PROPAGATION; d <= MESO_DECIDER_STOP; d++)
            if (cases->deciders[i][d])
                printf(" %s %llu", deciders[d], (unsigned long long)cases->deciders[i][d]);
    }
    printf("\n");
    fflush(stdout);
}

/*
 * Up to four slots with all sets over one interface that look unlike to their
 * neighbours, and 100 over two; five slots with 24 and 6 in turn; six with one and one.
 */
static int all_cases(uint32_t slots, double time, uint32_t part, uint32_t part_count)
{
    static Cases cases;
    static const uint32_t sets[SMALL_SLOTS][2] = {{MESO_NO_INDEX, 100}, {MESO_NO_INDEX, 100}, {MESO_NO_INDEX, 100},
                                                  {MESO_NO_INDEX, 100}, {24, 6}, {1, 1}};
    uint64_t disagreements = 0;
    double since = meso_seconds();
    CHECK(slots >= 1 && slots <= SMALL_SLOTS && part < part_count);
    for (uint32_t count = 1; count <= slots; count++) {
        double begin = meso_seconds();
        start(&cases);
        cases.deadline = since + time;
        cases.part = part;
        cases.part_count = part_count;
        cases.next_one = cases.next_two = part;
        try_gluings(&cases, count, sets[count - 1][0], sets[count - 1][1]);
        print_cases(&cases, begin);
        disagreements += cases.disagreements;
        meso_arena_release(&cases.arena);
    }
    return disagreements > 0;
}

int main(int argc, char **argv)
{
    if (argc == 3 || argc == 5)
        return all_cases((uint32_t)atoi(argv[1]), atof(argv[2]), argc == 5 ? (uint32_t)atoi(argv[3]) : 0,
                         argc == 5 ? (uint32_t)atoi(argv[4]) : 1);
    test_involutions();
    test_gluings();
    test_grids();
    return 0;
}
