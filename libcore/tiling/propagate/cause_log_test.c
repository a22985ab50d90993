/* What dead ends hang on: against all assignments of small surfaces, and where the window forgets. */
#include "libcore/tiling/propagate/cause_log.h"

#include "libcore/base/random.h"
#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/propagate/propagate.h"

enum { MOST_ASSIGNMENTS = 100000, MOST_DEAD_ENDS = 60 };

typedef struct Tally {
    uint32_t cases, conflicts, jumps, refuted;
} Tally;

/* Nine slots, of a grid that may be closed either way; and up to a dozen tiles, few of which fit. */
static MesoSlotGraph draw_graph(MesoArena *arena, MesoRandom *random)
{
    bool around = meso_random_below(random, 4) != 0, up = meso_random_below(random, 4) != 0;
    return fixture_grid(arena, 3, 3, around, up, around && meso_random_below(random, 2));
}

static MesoTileSet draw_set(MesoArena *arena, MesoRandom *random)
{
    int32_t labels[12][4];
    uint32_t interfaces = 2 + meso_random_below(random, 2), tiles = 6 + meso_random_below(random, 7);
    for (uint32_t i = 0; i < 48; i++) {
        int32_t label = 1 + (int32_t)meso_random_below(random, interfaces);
        labels[i / 4][i % 4] = meso_random_below(random, 2) ? label : -label;
    }
    return fixture_set(arena, interfaces, tiles, (const int32_t (*)[4])labels, meso_random_below(random, 4) == 0, false,
                       false);
}

static uint32_t variant_at(const BruteForce *force, uint64_t number, uint32_t slot)
{
    while (slot-- > 0)
        number /= force->variants.count;
    return (uint32_t)(number % force->variants.count);
}

/* Whether an assignment makes all these decisions. */
static bool can_hold(const BruteForce *force, const MesoCauseLog *log, const uint64_t *decisions, uint32_t count)
{
    for (uint64_t n = 0; n < force->count; n++) {
        bool holds = true;
        for (uint32_t i = 0; i < count && holds; i++) {
            const MesoStep *step = &log->steps[meso_cause_log_find(log, decisions[i])];
            CHECK(step->decision);
            holds = variant_at(force, force->numbers[n], log->changes[step->first].slot) == step->variant;
        }
        if (holds)
            return true;
    }
    return false;
}

static void check_conflict(const MesoPropagation *propagation, const BruteForce *force, MesoConflict *conflict,
                           Tally *tally)
{
    meso_propagation_explain(propagation, conflict);
    for (uint32_t s = 0; s < propagation->graph->slot_count; s++)
        CHECK((propagation->pending[s] & 128) == 0);
    for (uint32_t i = 1; i < conflict->count; i++)
        CHECK(conflict->decisions[i] < conflict->decisions[i - 1]);
    CHECK(conflict->whole);     /* nothing is forgotten here */
    CHECK(!can_hold(force, propagation->causes, conflict->decisions, conflict->count));
    tally->conflicts++;
}

/* Backjumping to the end, or for a while; each conflict on the way is looked at. */
static void search(MesoPropagation *propagation, const BruteForce *force, MesoRandom *random, Tally *tally)
{
    MesoCauseLog *log = propagation->causes;
    MesoConflict conflict;
    for (uint32_t dead_ends = 0; propagation->queue.count && dead_ends < MOST_DEAD_ENDS;) {
        uint32_t slot = meso_bucket_queue_draw(&propagation->queue, random), state = propagation->state[slot];
        uint32_t rank = meso_random_below(random, propagation->domains.domains[state].size);
        uint32_t variant = meso_domain_variant(&propagation->domains, state, rank);
        CHECK(meso_propagation_assign(propagation, slot, variant, NULL) == MESO_OK);
        for (; propagation->dead_slot != MESO_NO_INDEX; dead_ends++) {
            check_conflict(propagation, force, &conflict, tally);
            if (conflict.count == 0) {
                CHECK(force->count == 0);
                tally->refuted++;
                return;
            }
            uint32_t step = meso_cause_log_find(log, conflict.decisions[0]);
            tally->jumps += step + 1 < log->step_count;
            slot = log->changes[log->steps[step].first].slot;
            variant = log->steps[step].variant;
            CHECK(meso_propagation_jump(propagation, step, NULL) == MESO_OK);
            CHECK(meso_propagation_exclude(propagation, slot, variant, NULL) == MESO_OK);
            meso_cause_log_conclude(log, conflict.decisions + 1, conflict.count - 1, conflict.whole);
        }
    }
    CHECK(propagation->queue.count || force->count > 0);
}

static void test_case(uint64_t seed, MesoCauseLog *log, Tally *tally)
{
    MesoArena arena;
    MesoRandom random;
    MesoPropagation propagation;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    meso_random_init(&random, seed, 0);
    MesoSlotGraph graph = draw_graph(&arena, &random);
    MesoTileSet set = draw_set(&arena, &random);
    BruteForce force = brute_force(&arena, &set, &graph, MOST_ASSIGNMENTS, true);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    CHECK(meso_propagation_init(&propagation, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                                NULL) == MESO_OK);
    if (force.count < MOST_ASSIGNMENTS && propagation.initial_dead_count == 0) {
        propagation.causes = log;
        meso_propagation_restart(&propagation);
        search(&propagation, &force, &random, tally);
        tally->cases++;
    }
    meso_propagation_release(&propagation);
    meso_arena_release(&arena);
}

/* Step i decides slot 2 i, of which slot 2 i + 1 changes. Slot 1 hangs on the steps that `causes` names. */
static void fill(MesoCauseLog *log, uint32_t steps, const uint32_t *causes, uint32_t cause_count, uint32_t before)
{
    meso_cause_log_clear(log, false);
    for (uint32_t i = 0; i < steps; i++) {
        meso_cause_log_begin(log, 0, true);
        meso_cause_log_change(log, 2 * i, 0, MESO_NO_INDEX);
        for (uint32_t c = 0; c < cause_count; c++)
            if (causes[c] == i)
                meso_cause_log_change(log, 1, before, 2 * i);
    }
}

/* The window keeps at least half of its steps, says where something is missing, and is exact where not. */
static void test_window(MesoCauseLog *log)
{
    enum { STEPS = 3 * MESO_CAUSE_LOG_STEPS };
    static uint8_t marks[2 * STEPS];
    static uint32_t initial[2 * STEPS];
    static MesoConflict conflict;
    const uint32_t early[] = {10, STEPS - 30, STEPS - 5}, late[] = {STEPS - 30, STEPS - 5};
    fill(log, STEPS, early, 3, 1);
    CHECK(log->partial && log->step_count >= MESO_CAUSE_LOG_STEPS / 2);
    meso_cause_log_explain(log, 1, MESO_NO_INDEX, initial, marks, 4, &conflict);
    CHECK(conflict.count == 2 && !conflict.whole && conflict.decisions[0] == conflict.decisions[1] + 25);
    CHECK(meso_cause_log_find(log, conflict.decisions[0]) == log->step_count - 5);
    /* The state that slot 1 had before the first of these was the initial one: nothing is missing. */
    fill(log, STEPS, late, 2, 0);
    meso_cause_log_explain(log, 1, MESO_NO_INDEX, initial, marks, 4, &conflict);
    CHECK(conflict.count == 1 && conflict.whole);
    for (uint32_t s = 0; s < 2 * STEPS; s++)
        CHECK(marks[s] == 0);
    /* A step of more changes than there is room for leaves nothing, but the next one is there again. */
    meso_cause_log_begin(log, 0, true);
    for (uint32_t i = 0; i < 2 * MESO_CAUSE_LOG_CHANGES; i++)
        meso_cause_log_change(log, i % STEPS, 0, MESO_NO_INDEX);
    CHECK(log->muted && log->step_count == 0);
    meso_cause_log_pop(log);
    meso_cause_log_begin(log, 0, true);
    meso_cause_log_change(log, 1, 0, MESO_NO_INDEX);
    meso_cause_log_explain(log, 1, MESO_NO_INDEX, initial, marks, 4, &conflict);
    CHECK(conflict.count == 1 && conflict.whole && log->step_count == 1);
}

int main(void)
{
    enum { CASES = 400 };
    static MesoCauseLog log;
    Tally tally = {0};
    for (uint64_t seed = 0; seed < CASES; seed++)
        test_case(seed, &log, &tally);
    CHECK(tally.cases > 200 && tally.conflicts > 900 && tally.jumps > 90 && tally.refuted > 50);
    test_window(&log);
    return 0;
}
