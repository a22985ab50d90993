#include "libcore/tiling/exact/exact_cubes.h"

#include <string.h>

/* Conflicts under a cube where no bit is left to be assumed. */
enum { FULL_CUBE_CONFLICTS = 20000 };

/* Conflicts after which the end must be in sight: at most so many times more. */
enum { FIRST_LOOK = 12000, MOST_TIMES = 20 };

/* Score of the bits of a refutation, shared between them; bits begin with their edges over EDGES_A_POINT. */
enum { REFUTATION_SCORE = 1000, EDGES_A_POINT = 4 };

/* A bit assumed, and the clause that refuted its other way: literals of which one must hold. */
typedef struct Level {
    int32_t literal;
    bool second;                /* the other way is refuted, by `refutation` */
    uint32_t refutation_size;
    int32_t *refutation;        /* [chains] assumptions, without this level's */
} Level;

typedef struct Conquest {
    MesoExact *exact;
    MesoRandom *random;
    uint32_t level_count;
    Level *levels;              /* [chains] */
    int32_t *assumptions;       /* [chains] of the levels */
    int32_t *core;              /* [2 * chains] assumptions of the refutation at hand */
    uint32_t core_size;
    uint64_t *score;            /* [chains] */
    bool *assumed;              /* [chains] */
    uint32_t cube_conflicts;
    uint64_t conflict_limit, conflict_start;
    bool (*stop)(void *context);
    void *context;
} Conquest;

static uint32_t chain_of(const Conquest *conquest, int32_t literal)
{
    return (uint32_t)(literal < 0 ? -literal : literal) - conquest->exact->chain_first;
}

static uint64_t conflicts_used(const Conquest *conquest)
{
    return meso_sat_conflicts(conquest->exact->sat) - conquest->conflict_start;
}

static uint64_t conflicts_left(const Conquest *conquest)
{
    uint64_t used = conflicts_used(conquest);
    return used < conquest->conflict_limit ? conquest->conflict_limit - used : 0;
}

static MesoStatus ask(Conquest *conquest, MesoSatAnswer *answer, MesoError *error)
{
    bool full = conquest->level_count == conquest->exact->chain_count;
    uint64_t limit = full ? FULL_CUBE_CONFLICTS : conquest->cube_conflicts;
    uint64_t left = conflicts_left(conquest);
    return meso_sat_solve(conquest->exact->sat, answer, conquest->assumptions, conquest->level_count,
                          (uint32_t)(limit < left ? limit : left), conquest->stop, conquest->context, error);
}

/* The bit that refutations met most lately and with the fewest others; the longest chain at first. */
static void assume_another(Conquest *conquest)
{
    uint32_t best = MESO_NO_INDEX;
    for (uint32_t c = 0; c < conquest->exact->chain_count; c++)
        if (!conquest->assumed[c] && (best == MESO_NO_INDEX || conquest->score[c] > conquest->score[best]))
            best = c;
    int32_t literal = (int32_t)(conquest->exact->chain_first + best);
    if (meso_random_below(conquest->random, 2))
        literal = -literal;
    conquest->assumed[best] = true;
    conquest->assumptions[conquest->level_count] = literal;
    Level *level = &conquest->levels[conquest->level_count++];
    level->literal = literal;
    level->second = false;
}

/* Takes the assumptions that the last refutation needed for the core. */
static void read_core(Conquest *conquest)
{
    conquest->core_size = 0;
    for (uint32_t i = 0; i < conquest->level_count; i++)
        if (meso_sat_failed(conquest->exact->sat, conquest->assumptions[i]))
            conquest->core[conquest->core_size++] = conquest->assumptions[i];
    for (uint32_t i = 0; i < conquest->core_size; i++)
        conquest->score[chain_of(conquest, conquest->core[i])] += REFUTATION_SCORE / conquest->core_size;
}

static MesoStatus learn_core(Conquest *conquest, MesoError *error)
{
    int32_t *clause = conquest->core;
    for (uint32_t i = 0; i < conquest->core_size; i++)
        clause[i] = -clause[i];
    MesoStatus status = meso_sat_add_implied(conquest->exact->sat, clause, conquest->core_size, error);
    for (uint32_t i = 0; i < conquest->core_size; i++)
        clause[i] = -clause[i];
    return status;
}

/* Takes `literal` out of the core; false where it is not in there. */
static bool drop_from_core(Conquest *conquest, int32_t literal)
{
    for (uint32_t i = 0; i < conquest->core_size; i++)
        if (conquest->core[i] == literal) {
            memmove(conquest->core + i, conquest->core + i + 1,
                    (conquest->core_size - i - 1) * sizeof *conquest->core);
            conquest->core_size--;
            return true;
        }
    return false;
}

/* Resolves the core with the refutation of the other way of `level`. */
static void merge_refutation(Conquest *conquest, const Level *level)
{
    uint32_t own = conquest->core_size;
    for (uint32_t i = 0; i < level->refutation_size; i++) {
        bool known = false;
        for (uint32_t j = 0; j < own && !known; j++)
            known = conquest->core[j] == level->refutation[i];
        if (!known)
            conquest->core[conquest->core_size++] = level->refutation[i];
    }
}

/*
 * From a refutation back to the last level that it needs and that has another way
 * left: levels that it does not need are dropped. `*over` where there is none.
 */
static MesoStatus backjump(Conquest *conquest, bool *over, MesoError *error)
{
    read_core(conquest);
    MesoStatus status = learn_core(conquest, error);
    while (!status && conquest->level_count > 0) {
        Level *level = &conquest->levels[conquest->level_count - 1];
        if (drop_from_core(conquest, level->literal)) {
            if (!level->second) {
                level->second = true;
                level->literal = -level->literal;
                level->refutation_size = conquest->core_size;
                memcpy(level->refutation, conquest->core, conquest->core_size * sizeof *conquest->core);
                conquest->assumptions[conquest->level_count - 1] = level->literal;
                return MESO_OK;
            }
            merge_refutation(conquest, level);
            status = learn_core(conquest, error);
        }
        conquest->assumed[chain_of(conquest, level->literal)] = false;
        conquest->level_count--;
    }
    *over = true;
    return status;
}

static MesoStatus allocate(Conquest *conquest, MesoError *error)
{
    MesoArena *arena = conquest->exact->arena;
    uint32_t count = conquest->exact->chain_count;
    conquest->levels = MESO_NEW(arena, Level, count, error);
    conquest->assumptions = MESO_NEW(arena, int32_t, count, error);
    conquest->core = MESO_NEW(arena, int32_t, 2 * (size_t)count, error);
    conquest->score = MESO_NEW(arena, uint64_t, count, error);
    conquest->assumed = MESO_NEW(arena, bool, count, error);
    int32_t *refutations = MESO_NEW(arena, int32_t, count * (size_t)count, error);
    if (!conquest->levels || !conquest->assumptions || !conquest->core || !conquest->score ||
        !conquest->assumed || !refutations)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < count; c++) {
        conquest->levels[c].refutation = refutations + c * (size_t)count;
        conquest->score[c] = conquest->exact->chain_length[c] / EDGES_A_POINT;
    }
    return MESO_OK;
}

/* The part of all cubes that is refuted: each level has half of what the one above leaves. */
static double refuted_part(const Conquest *conquest)
{
    double part = 0, share = 1;
    for (uint32_t i = 0; i < conquest->level_count; i++) {
        share /= 2;
        part += conquest->levels[i].second ? share : 0;
    }
    return part;
}

/* At the pace so far the cubes would take far too long: so it is where solutions are plenty, but none is near. */
static bool hopeless(const Conquest *conquest)
{
    uint64_t used = conflicts_used(conquest);
    return used >= FIRST_LOOK && (double)used > refuted_part(conquest) * FIRST_LOOK * MOST_TIMES;
}

static MesoStatus conquer(Conquest *conquest, MesoSatAnswer *answer, MesoError *error)
{
    for (;;) {
        MesoStatus status = ask(conquest, answer, error);
        if (status || *answer == MESO_SAT_YES)
            return status;
        if (*answer == MESO_SAT_NO) {
            bool over = false;
            status = backjump(conquest, &over, error);
            if (status || over)
                return status;
            continue;
        }
        if (conflicts_left(conquest) == 0 || hopeless(conquest) ||
            conquest->level_count == conquest->exact->chain_count ||
            (conquest->stop && conquest->stop(conquest->context)))
            return MESO_OK;
        assume_another(conquest);
    }
}

MesoStatus meso_exact_conquer(MesoExact *exact, MesoSatAnswer *answer, MesoRandom *random,
                              uint32_t cube_conflicts, uint64_t conflict_limit, bool (*stop)(void *context),
                              void *context, MesoError *error)
{
    *answer = MESO_SAT_UNKNOWN;
    if (exact->chain_count == 0 || exact->chain_count > MESO_EXACT_MOST_CHAINS)
        return MESO_OK;
    Conquest conquest = {.exact = exact, .random = random, .cube_conflicts = cube_conflicts,
                         .conflict_limit = conflict_limit, .conflict_start = meso_sat_conflicts(exact->sat),
                         .stop = stop, .context = context};
    MesoArenaMark mark = meso_arena_mark(exact->arena);
    MesoStatus status = allocate(&conquest, error);
    if (!status)
        status = conquer(&conquest, answer, error);
    meso_arena_rewind(exact->arena, mark);
    return status;
}
