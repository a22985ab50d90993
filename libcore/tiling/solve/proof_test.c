/* Proofs of the exact engine, checked by other code; and that what was tampered with is refused. */
#include "libcore/base/random.h"
#include "libcore/sat/drat_checker.h"
#include "libcore/tiling/exact/exact_cubes.h"
#include "libcore/tiling/fixture/random_case.h"
#include "libcore/tiling/fixture/small_graphs.h"
#include "libcore/tiling/fixture/small_sets.h"

typedef struct Text {
    char *data;                 /* [size] and a zero */
    size_t size, room;
} Text;

typedef struct Proof {
    Text formula, lines;
} Proof;

static void append(Text *text, const char *data, size_t size)
{
    if (text->room - text->size <= size) {
        text->room = 2 * (text->room + size + 1);
        text->data = realloc(text->data, text->room);
        CHECK(text->data);
    }
    memcpy(text->data + text->size, data, size);
    text->size += size;
    text->data[text->size] = 0;
}

static bool take_proof(void *context, const char *data, size_t size)
{
    append(&((Proof *)context)->lines, data, size);
    return true;
}

static void take_clause(void *context, const int32_t *literals, uint32_t count)
{
    char number[16];
    for (uint32_t i = 0; i <= count; i++) {
        int size = snprintf(number, sizeof number, "%d%c", i < count ? (int)literals[i] : 0, i < count ? ' ' : '\n');
        append(&((Proof *)context)->formula, number, (size_t)size);
    }
}

static void clear(Proof *proof)
{
    proof->formula.size = proof->lines.size = 0;
    append(&proof->formula, "", 0);
    append(&proof->lines, "", 0);
}

static void release(Proof *proof)
{
    free(proof->formula.data);
    free(proof->lines.data);
}

static uint32_t formulas;

static void begin_formula(void *context)
{
    clear(context);
    formulas++;
}

/* Solves and keeps the proof. */
static MesoSolveResult solve(Proof *proof, MesoArena *arena, MesoEngine engine, const MesoTileSet *set,
                             const MesoSlotGraph *graph, const MesoConstraints *constraints)
{
    MesoVariantSet variants;
    MesoSolveResult result;
    const MesoSolveOptions options = {.engine = engine, .max_attempts = 1,
                                      .proof = take_proof, .clause = take_clause, .formula = begin_formula,
                                      .proof_context = proof};
    clear(proof);
    CHECK(meso_variant_set_build(&variants, arena, set, NULL) == MESO_OK);
    CHECK(meso_solve(&result, arena, &(MesoTilingProblem){set, &variants, graph, constraints},
                     &options, NULL) == MESO_OK);
    return result;
}

/* What is wrong with the lines as a proof for the formula; NULL where nothing is. */
static const char *finding_in(const char *formula, const char *lines)
{
    static DratChecker checker;
    drat_init(&checker);
    drat_read_formula(&checker, formula);
    CHECK(!checker.finding);
    drat_check(&checker, lines);
    const char *finding = checker.finding;
    drat_release(&checker);
    return finding;
}

static void check_proof(const Proof *proof)
{
    const char *finding = finding_in(proof->formula.data, proof->lines.data);
    if (finding)
        fprintf(stderr, "the proof %s\n", finding);
    CHECK(!finding);
}

/* The checker itself: propagation, a resolvent, deletions, and what is wrong. */
static void test_checker(void)
{
    static const char square[] = "p cnf 2 4\n1 2 0\n-1 2 0\n1 -2 0\n-1 -2 0\n";
    static const char open[] = "c\np cnf 3 2\n1 2 0\n-1 -2 0\n";
    CHECK(!finding_in(square, "2 0\n0\n"));
    CHECK(!finding_in(square, "2 0\nd -1 2 0\nd 2 1 0\n0\n"));
    CHECK(finding_in(square, "0\n"));
    CHECK(finding_in(square, "2 0\n"));
    CHECK(finding_in(square, ""));
    CHECK(finding_in(square, "d 1 -2 0\n2 0\n0\n"));
    CHECK(finding_in(square, "d 1 2 3 0\n2 0\n0\n"));
    CHECK(finding_in(square, "2 x 0\n"));
    CHECK(!finding_in("1 0\n0\n", ""));
    /* 3 = 1 as a definition: resolvents follow on the first literal, if there is one that is new. */
    CHECK(!strcmp(finding_in(open, "3 -1 0\n-3 1 0\n"), "ends without the empty clause"));
    CHECK(!strcmp(finding_in(open, "3 -1 0\n-1 3 0\n-3 0\n"), "adds a clause that does not follow"));
    CHECK(!strcmp(finding_in(open, "1 0\n"), "adds a clause that does not follow"));
}

static uint32_t proofs;

static void check_small_graph(void *context, const uint32_t *twin, uint32_t symmetries)
{
    static Proof proof;
    uint32_t *slot_count = context;
    MesoArena arena;
    (void)symmetries;
    for (uint32_t i = 0; twin && i < 30; i++) {
        static uint32_t number;
        meso_arena_init(&arena);
        MesoTileSet set = small_set(&arena, 1, number++ * 389 % SMALL_SETS_ONE);
        MesoSlotGraph graph = small_graph(&arena, twin, *slot_count, number);
        MesoSolveResult result = solve(&proof, &arena, MESO_ENGINE_EXACT, &set, &graph, NULL);
        if (result.verdict == MESO_VERDICT_UNSOLVABLE && result.decider == MESO_DECIDER_EXACT) {
            check_proof(&proof);
            proofs++;
        }
        meso_arena_release(&arena);
    }
    if (!twin)
        release(&proof);
}

static void test_small_graphs(void)
{
    uint32_t slot_count = 3;
    small_graphs_list(slot_count, check_small_graph, &slot_count);
    check_small_graph(&slot_count, NULL, 0);
    CHECK(proofs > 20);
}

/*
 * The eleven Wang tiles of Jeandel and Rao, "An aperiodic set of 11 Wang tiles"
 * (2021), as right, top, left, bottom: they tile the plane, but no torus.
 */
static MesoTileSet aperiodic_set(MesoArena *arena)
{
    static const uint8_t colors[11][4] = {
        {2, 4, 2, 1}, {2, 2, 2, 0}, {1, 1, 3, 1}, {1, 2, 3, 2}, {3, 1, 3, 3}, {0, 1, 3, 1},
        {0, 0, 0, 1}, {3, 1, 0, 2}, {0, 2, 1, 2}, {1, 2, 1, 4}, {3, 3, 1, 2},
    };
    int32_t labels[11][4];
    for (uint32_t i = 0; i < 44; i++) {
        int32_t label = 1 + (i % 2 ? 4 : 0) + colors[i / 4][i % 4];
        labels[i / 4][i % 4] = i % 4 < 2 ? label : -label;
    }
    return fixture_set(arena, 9, 11, (const int32_t (*)[4])labels, false, false, false);
}

/* A crossing, and a turn of both strands to the right: chains everywhere, and an odd corner to get around. */
static const int32_t weave[2][4] = {{1, 2, -1, -2}, {-2, 1, -1, 2}};

/* With hardly a conflict for each cube, so that all of the proof comes from putting cubes together. */
static MesoSatAnswer conquer(Proof *proof, MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph,
                             uint64_t seed)
{
    MesoVariantSet variants;
    MesoPropagation propagation;
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer = MESO_SAT_UNKNOWN;
    const MesoExactOptions options = {.chains = true, .proof = take_proof, .clause = take_clause, .context = proof};
    clear(proof);
    meso_random_init(&random, seed, 0);
    CHECK(meso_variant_set_build(&variants, arena, set, NULL) == MESO_OK);
    CHECK(meso_propagation_init(&propagation, arena, &(MesoTilingProblem){set, &variants, graph, NULL},
                                NULL) == MESO_OK);
    if (propagation.initial_dead_count == 0) {
        CHECK(meso_exact_init(&exact, arena, &propagation, &options, NULL) == MESO_OK);
        CHECK(meso_exact_conquer(&exact, &answer, &random, 1, 1000000, NULL, NULL, NULL) == MESO_OK);
        meso_exact_release(&exact);
    }
    meso_propagation_release(&propagation);
    return answer;
}

static void test_cubes(void)
{
    Proof proof = {0};
    MesoRandom random;
    uint32_t refuted = 0, by_lines = 0;
    meso_random_init(&random, 11, 0);
    for (uint64_t i = 0; i < 2400; i++) {
        MesoArena arena;
        meso_arena_init(&arena);
        MesoTileSet set = i % 2 ? fixture_set(&arena, 2, 2, weave, true, true, true) : random_set(&arena, &random);
        MesoSlotGraph graph = i % 3 ? random_graph(&arena, &random) : fixture_grid(&arena, 3, 3, true, true, i % 2);
        if (conquer(&proof, &arena, &set, &graph, i) == MESO_SAT_NO) {
            check_proof(&proof);
            refuted++;
            by_lines += strstr(proof.lines.data, "\n0\n") || !strncmp(proof.lines.data, "0\n", 2);
        }
        meso_arena_release(&arena);
    }
    CHECK(refuted > 30 && by_lines == refuted);
    release(&proof);
}

/* Every tampering is one that the checker sees, or one that leaves a proof; here are many of the first kind. */
static void check_tampered(const Proof *proof)
{
    uint32_t refused = 0;
    Text other = {0};
    for (size_t at = 0, line = 0; at < proof->lines.size; line++) {
        const char *begin = proof->lines.data + at;
        size_t size = strcspn(begin, "\n") + 1;
        at += size;
        if (line % 7 || *begin == 'd' || *begin == '0')
            continue;
        for (uint32_t way = 0; way < 2; way++) {
            other.size = 0;
            append(&other, proof->lines.data, (size_t)(begin - proof->lines.data));
            if (way)        /* the first literal changes its sign */
                append(&other, "-", *begin != '-');
            if (way)
                append(&other, begin + (*begin == '-'), size - (*begin == '-'));
            append(&other, begin + size, proof->lines.size - at);
            refused += finding_in(proof->formula.data, other.data) != NULL;
        }
    }
    CHECK(refused > 10);
    free(other.data);
}

/* Tori of growing size: the last is asked about twice, with probing between, which leaves a smaller formula. */
static void test_aperiodic(void)
{
    MesoArena arena;
    Proof proof = {0};
    size_t formula_size = 0;
    meso_arena_init(&arena);
    MesoTileSet set = aperiodic_set(&arena);
    for (uint32_t width = 2; width <= 13; width++) {
        MesoSlotGraph graph = fixture_grid(&arena, width, width, true, true, false);
        formulas = 0;
        MesoSolveResult result = solve(&proof, &arena, MESO_ENGINE_EXACT, &set, &graph, NULL);
        CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.decider == MESO_DECIDER_EXACT);
        CHECK(formulas == (width < 13 ? 1 : 2) && proof.formula.size < 3 * formula_size / 2 + 10000);
        formula_size = proof.formula.size;
        check_proof(&proof);
        if (width == 5)
            check_tampered(&proof);
    }
    release(&proof);
    meso_arena_release(&arena);
}

/* Clauses that come between two questions, with many conflicts before: the proof leaves out none that it needs. */
static void test_growing_formula(void)
{
    MesoArena arena;
    MesoVariantSet variants;
    MesoPropagation propagation;
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer = MESO_SAT_UNKNOWN;
    Proof proof = {0};
    const MesoExactOptions options = {.proof = take_proof, .clause = take_clause, .context = &proof, .grows = true};
    clear(&proof);
    meso_arena_init(&arena);
    meso_random_init(&random, 13, 300);
    MesoTileSet set = aperiodic_set(&arena);
    MesoSlotGraph graph = fixture_grid(&arena, 13, 13, true, true, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    CHECK(meso_propagation_init(&propagation, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                                NULL) == MESO_OK);
    CHECK(meso_exact_init(&exact, &arena, &propagation, &options, NULL) == MESO_OK);
    while (answer == MESO_SAT_UNKNOWN) {
        CHECK(meso_sat_solve(exact.sat, &answer, NULL, 0, 300, NULL, NULL, NULL) == MESO_OK);
        for (uint32_t i = 0; i < 40 && answer == MESO_SAT_UNKNOWN; i++) {
            int32_t literals[8];
            for (uint32_t j = 0; j < 8; j++) {
                literals[j] = 1 + (int32_t)meso_random_below(&random, exact.variable_count);
                literals[j] = meso_random_below(&random, 4) ? -literals[j] : literals[j];
            }
            CHECK(meso_exact_add(&exact, literals, 8, NULL) == MESO_OK);
        }
    }
    CHECK(answer == MESO_SAT_NO);
    meso_exact_release(&exact);
    meso_propagation_release(&propagation);
    check_proof(&proof);
    release(&proof);
    meso_arena_release(&arena);
}

/*
 * Two quarter circles on each tile: on a torus all strands are loops, of four sweeps at least, and a rule that
 * allows three is disproved by what it cuts off, solution after solution.
 */
static MesoTileSet circles(MesoArena *arena)
{
    static const int32_t labels[1][4] = {{1, 1, -1, -1}};
    static const uint8_t sides[2][2] = {{0, 1}, {2, 3}};
    MesoTileSet set = fixture_set(arena, 1, 1, labels, true, true, false);
    set.sections = MESO_NEW(arena, MesoSection, 1, NULL);
    set.sweeps = MESO_NEW(arena, MesoSweep, 2, NULL);
    CHECK(set.sections && set.sweeps);
    set.sections[0].name = "s";
    set.section_count = set.interfaces[0].section_count = 1;
    set.sweep_count = set.tiles[0].sweep_count = 2;
    for (uint32_t i = 0; i < 2; i++)
        set.sweeps[i] = (MesoSweep){.from_side = sides[i][0], .to_side = sides[i][1]};
    return set;
}

static void test_strands(void)
{
    MesoArena arena;
    Proof proof = {0};
    const MesoConstraints constraints = {.strands = {.max_length = 3}};
    meso_arena_init(&arena);
    MesoTileSet set = circles(&arena);
    for (uint32_t width = 2; width <= 9; width++) {
        MesoSlotGraph graph = fixture_grid(&arena, width, 2, true, true, false);
        MesoSolveResult result = solve(&proof, &arena, MESO_ENGINE_EXACT, &set, &graph, &constraints);
        CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.decider == MESO_DECIDER_EXACT);
        check_proof(&proof);
    }
    release(&proof);
    meso_arena_release(&arena);
}

int main(void)
{
    test_checker();
    test_small_graphs();
    test_cubes();
    test_aperiodic();
    test_growing_formula();
    test_strands();
    return 0;
}
