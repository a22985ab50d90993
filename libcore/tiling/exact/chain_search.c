#include "libcore/tiling/exact/chain_search.h"

#include "libcore/tiling/exact/chain_rings.h"

/*
 * What is to be made small, in points: contradictions first; but with fewer rings there are fewer to be
 * one. Taking 1 / WORSE_REFUSED less of what is worse by one point is a temperature of one contradiction.
 */
enum { CONTRADICTION_POINTS = 20, WORSE_REFUSED = 20 };

/* Settings without contradiction of which the engine is asked, and for how many conflicts each. */
enum { MOST_QUESTIONS = 20, QUESTION_CONFLICTS = 1000 };

typedef struct Walk {
    MesoChainRings rings;
    MesoRandom *random;
    bool *values;               /* [chain_count] */
    MesoRingCount count;        /* under these */
    uint64_t work_left, conflicts_left;
    bool (*stop)(void *context);
    void *context;
} Walk;

static uint64_t points(MesoRingCount count)
{
    return (uint64_t)count.contradictions * CONTRADICTION_POINTS + count.rings;
}

/* Takes what is better, and now and then what is worse. */
static bool accepts(Walk *walk, MesoRingCount count)
{
    uint64_t before = points(walk->count), after = points(count);
    uint32_t chance = UINT32_MAX;
    for (uint64_t worse = after > before ? after - before : 0; worse > 0 && chance >= WORSE_REFUSED; worse--)
        chance -= chance / WORSE_REFUSED;
    return after <= before || meso_random_below(walk->random, UINT32_MAX) < chance;
}

static MesoRingCount look(Walk *walk)
{
    uint64_t work = (uint64_t)walk->rings.edge_count + walk->rings.slot_count;
    walk->work_left -= work < walk->work_left ? work : walk->work_left;
    return meso_chain_rings_count(&walk->rings, walk->values);
}

static bool may_go_on(const Walk *walk)
{
    return walk->work_left > 0 && walk->conflicts_left > 0 && !(walk->stop && walk->stop(walk->context));
}

static void step(Walk *walk)
{
    bool *value = &walk->values[meso_random_below(walk->random, walk->rings.chain_count)];
    *value = !*value;
    MesoRingCount count = look(walk);
    if (accepts(walk, count))
        walk->count = count;
    else
        *value = !*value;
}

/* Whether the engine finds a tiling under the bits at hand. */
static MesoStatus ask(MesoExact *exact, Walk *walk, int32_t *assumptions, MesoSatAnswer *answer, MesoError *error)
{
    for (uint32_t c = 0; c < exact->chain_count; c++) {
        int32_t bit = (int32_t)(exact->chain_first + c);
        assumptions[c] = walk->values[c] ? bit : -bit;
    }
    uint64_t before = meso_sat_conflicts(exact->sat);
    uint32_t limit = walk->conflicts_left < QUESTION_CONFLICTS ? (uint32_t)walk->conflicts_left : QUESTION_CONFLICTS;
    MesoStatus status = meso_sat_solve(exact->sat, answer, assumptions, exact->chain_count, limit, walk->stop,
                                       walk->context, error);
    uint64_t used = meso_sat_conflicts(exact->sat) - before;
    walk->conflicts_left -= used < walk->conflicts_left ? used : walk->conflicts_left;
    if (*answer == MESO_SAT_NO)
        *answer = MESO_SAT_UNKNOWN;
    return status;
}

static MesoStatus search(MesoExact *exact, Walk *walk, MesoSatAnswer *answer, MesoError *error)
{
    MesoStatus status = meso_chain_rings_build(&walk->rings, exact->arena, &exact->patterns, &exact->chains, error);
    if (status || !walk->rings.possible)
        return status;
    walk->values = MESO_NEW(exact->arena, bool, exact->chain_count, error);
    int32_t *assumptions = MESO_NEW(exact->arena, int32_t, exact->chain_count, error);
    if (!walk->values || !assumptions)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < exact->chain_count; c++)
        walk->values[c] = meso_random_below(walk->random, 2);
    walk->count = look(walk);
    uint32_t questions = 0;
    while (!status && *answer == MESO_SAT_UNKNOWN && questions < MOST_QUESTIONS && may_go_on(walk)) {
        if (walk->count.contradictions == 0) {
            questions++;
            status = ask(exact, walk, assumptions, answer, error);
        }
        step(walk);
    }
    return status;
}

MesoStatus meso_exact_search_chains(MesoExact *exact, MesoSatAnswer *answer, MesoRandom *random, uint64_t work,
                                    uint64_t conflict_limit, bool (*stop)(void *context), void *context, MesoError *error)
{
    Walk walk = {.random = random, .work_left = work, .conflicts_left = conflict_limit, .stop = stop,
                 .context = context};
    *answer = MESO_SAT_UNKNOWN;
    if (exact->chain_count == 0 || exact->chain_count > MESO_EXACT_MOST_CHAINS)
        return MESO_OK;
    MesoArenaMark mark = meso_arena_mark(exact->arena);
    MesoStatus status = search(exact, &walk, answer, error);
    meso_arena_rewind(exact->arena, mark);
    return status;
}
