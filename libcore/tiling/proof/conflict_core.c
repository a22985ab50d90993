#include "libcore/tiling/proof/conflict_core.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/random.h"
#include "libcore/mesh/slot_flood.h"

enum { DEFAULT_SLOTS = 20000, DEFAULT_CONFLICTS = 20000 };

/* Slots of the first ball, and how much larger each is than the one before. */
enum { FIRST_BALL = 8, BALL_GROWTH = 4 };

/* Conflicts for the first answer of a ball, and for each attempt to leave items out. */
enum { BALL_CONFLICTS = 4000, DROP_CONFLICTS = 400 };

/* How often a core is asked for a smaller one before items are left out; other orders to leave them out in. */
enum { REFINEMENTS = 5, OTHER_ORDERS = 4, MOST_REORDERED = 300 };

/*
 * Effort is counted in literals that CaDiCaL goes through, about 50 ns each: those of a formula for each answer,
 * a part of them for each conflict (after which many assumptions are made anew), and some times as many to build
 * it. The first limit is a second or two; the other is on the variants of all slots of a ball.
 */
static const uint64_t work_limit = (uint64_t)1 << 25;
static const uint64_t ball_limit = (uint64_t)1 << 17;
enum { BUILD_WORK = 8, CONFLICT_PART = 8 };

/* A set that may be larger than need be tells something while it is a small part of the surface. */
enum { LEAST_PART = 4 };

typedef struct Finder {
    const MesoTilingProblem *problem;
    MesoArena *arena;
    uint32_t *rank;             /* [slots] for formulas */
    uint32_t *order;            /* [order_count] slots by distance */
    uint32_t order_count;
    uint32_t item_limit;        /* items that there can be in a ball */
    uint32_t *trial;            /* [item_limit] */
    int32_t *assumptions;       /* [item_limit] */
    MesoCoreFormula formula;
    uint64_t conflicts_left, work_left;
} Finder;

/* Items that contradict each other, in the order in which they are to be left out. */
typedef struct Items {
    uint32_t count;
    uint32_t *numbers;          /* [item_limit] */
    bool minimal;
} Items;

static void spend(Finder *finder, uint64_t work)
{
    finder->work_left -= work < finder->work_left ? work : finder->work_left;
}

static MesoStatus build_formula(Finder *finder, const uint32_t *slots, uint32_t count, MesoError *error)
{
    MesoStatus status = meso_core_formula_init(&finder->formula, finder->problem, slots, count, finder->rank, error);
    spend(finder, BUILD_WORK * finder->formula.size);
    return status;
}

static MesoStatus ask(Finder *finder, const uint32_t *items, uint32_t count, uint32_t conflicts,
                      MesoSatAnswer *answer, MesoError *error)
{
    *answer = MESO_SAT_UNKNOWN;
    spend(finder, finder->formula.size + count);
    uint64_t conflict_work = finder->formula.size / CONFLICT_PART + 1, affordable = finder->work_left / conflict_work;
    if (finder->conflicts_left == 0 || affordable == 0)
        return MESO_OK;
    conflicts = conflicts < affordable ? conflicts : (uint32_t)affordable;
    for (uint32_t i = 0; i < count; i++)
        finder->assumptions[i] = meso_core_formula_literal(&finder->formula, items[i]);
    uint64_t before = meso_sat_conflicts(finder->formula.sat);
    uint32_t limit = conflicts < finder->conflicts_left ? conflicts : (uint32_t)finder->conflicts_left;
    MesoStatus status = meso_sat_solve(finder->formula.sat, answer, finder->assumptions, count, limit, NULL, NULL,
                                       error);
    uint64_t used = meso_sat_conflicts(finder->formula.sat) - before;
    finder->conflicts_left -= used < finder->conflicts_left ? used : finder->conflicts_left;
    spend(finder, used * conflict_work);
    return status;
}

/* After a no: keeps of items [count] those that had a part in it; returns how many, and of the first `at`, in `*at`. */
static uint32_t keep_failed(const Finder *finder, uint32_t *items, uint32_t count, uint32_t *at)
{
    uint32_t kept = 0, before = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!meso_sat_failed(finder->formula.sat, meso_core_formula_literal(&finder->formula, items[i])))
            continue;
        before += i < *at;
        items[kept++] = items[i];
    }
    *at = before;
    return kept;
}

/* --- a first core --- */

/* Quotas, then restrictions; `*restrictions` gets where these begin. */
static uint32_t collect_constraints(const Finder *finder, uint32_t *items, uint32_t *restrictions)
{
    const MesoConstraints *constraints = finder->problem->constraints;
    uint32_t count = 0;
    *restrictions = constraints ? constraints->quota_count : 0;
    for (uint32_t q = 0; q < *restrictions; q++)
        items[count++] = meso_core_constraint_item(finder->problem, constraints->restriction_count + q);
    for (uint32_t r = 0; constraints && r < constraints->restriction_count; r++)
        items[count++] = meso_core_constraint_item(finder->problem, r);
    return count;
}

/* Border rules, then the slots of the ball, the farthest first. */
static uint32_t collect_rules_and_slots(const Finder *finder, uint32_t ball, uint32_t *items)
{
    const MesoTileSet *set = finder->problem->set;
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->interface_count; i++) {
        if (set->interfaces[i].border_exempt)
            items[count++] = meso_core_rule_item(finder->problem, i, false);
        if (set->interfaces[i].border_only)
            items[count++] = meso_core_rule_item(finder->problem, i, true);
    }
    for (uint32_t i = ball; i-- > 0;)
        items[count++] = finder->order[i];
    return count;
}

/* Restrictions join only where there is no conflict without, and quotas where there is none with these. */
static MesoStatus ask_ball(Finder *finder, uint32_t ball, Items *items, MesoSatAnswer *answer, MesoError *error)
{
    uint32_t restrictions, rest = collect_constraints(finder, items->numbers, &restrictions);
    uint32_t all = rest + collect_rules_and_slots(finder, ball, items->numbers + rest);
    uint32_t begin[3] = {rest, restrictions, 0};
    MesoStatus status = MESO_OK;
    *answer = MESO_SAT_UNKNOWN;
    for (uint32_t i = 0; i < 3 && !status && *answer != MESO_SAT_NO; i++) {
        if (i > 0 && begin[i] == begin[i - 1])
            continue;
        items->count = all - begin[i];
        status = ask(finder, items->numbers + begin[i], items->count, BALL_CONFLICTS, answer, error);
        if (!status && *answer == MESO_SAT_NO)
            memmove(items->numbers, items->numbers + begin[i], items->count * sizeof *items->numbers);
    }
    return status;
}

/* A core of the `ball` first slots, or none: no items. */
static MesoStatus find_in_ball(Finder *finder, uint32_t ball, Items *items, MesoError *error)
{
    MesoSatAnswer answer = MESO_SAT_UNKNOWN;
    MesoStatus status = build_formula(finder, finder->order, ball, error);
    if (!status)
        status = ask_ball(finder, ball, items, &answer, error);
    bool found = !status && answer == MESO_SAT_NO;
    for (uint32_t i = 0, before = UINT32_MAX; found && i < REFINEMENTS && answer == MESO_SAT_NO; i++) {
        uint32_t at = 0;
        items->count = keep_failed(finder, items->numbers, items->count, &at);
        if (items->count == before)
            break;
        before = items->count;
        status = ask(finder, items->numbers, items->count, BALL_CONFLICTS, &answer, error);
        found = !status;
    }
    if (!found)
        items->count = 0;
    meso_core_formula_release(&finder->formula);
    return status;
}

/* --- a least one --- */

/* Leaves out runs of `size` items where the rest is a conflict without them. */
static MesoStatus drop_runs(Finder *finder, Items *items, uint32_t size, MesoError *error)
{
    uint32_t at = 0;
    items->minimal = size == 1;
    while (at < items->count) {
        uint32_t end = at + size < items->count ? at + size : items->count;
        uint32_t rest = items->count - (end - at);
        MesoSatAnswer answer;
        memcpy(finder->trial, items->numbers, at * sizeof *items->numbers);
        memcpy(finder->trial + at, items->numbers + end, (items->count - end) * sizeof *items->numbers);
        MesoStatus status = ask(finder, finder->trial, rest, DROP_CONFLICTS, &answer, error);
        if (status)
            return status;
        if (answer == MESO_SAT_NO) {
            items->count = keep_failed(finder, finder->trial, rest, &at);
            memcpy(items->numbers, finder->trial, items->count * sizeof *items->numbers);
        } else {
            items->minimal &= answer == MESO_SAT_YES;
            at = end;
        }
    }
    return MESO_OK;
}

/* The slots among the items, into `slots`; returns how many. */
static uint32_t slots_of(const Finder *finder, const Items *items, uint32_t *slots)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < items->count; i++)
        if (items->numbers[i] < finder->problem->graph->slot_count)
            slots[count++] = items->numbers[i];
    return count;
}

/* Leaves out runs, the long ones first: each round on a formula of the slots that are left. */
static MesoStatus shrink(Finder *finder, Items *items, uint32_t *slots, MesoError *error)
{
    uint32_t size = 1;
    MesoStatus status = MESO_OK;
    while (8 * size < items->count)
        size *= 2;
    for (; size > 0 && !status; size /= 2) {
        uint32_t count = slots_of(finder, items, slots);
        status = build_formula(finder, slots, count, error);
        if (!status)
            status = drop_runs(finder, items, size, error);
        meso_core_formula_release(&finder->formula);
    }
    return status;
}

/* Another order of the slots; constraints and rules stay in front. */
static void shuffle(const Finder *finder, Items *items, MesoRandom *random)
{
    uint32_t front = 0;
    while (front < items->count && items->numbers[front] >= finder->problem->graph->slot_count)
        front++;
    for (uint32_t i = items->count; i > front + 1; i--) {
        uint32_t j = front + meso_random_below(random, i - front), moved = items->numbers[i - 1];
        items->numbers[i - 1] = items->numbers[j];
        items->numbers[j] = moved;
    }
}

/* The least of what several orders lead to. */
static MesoStatus shrink_in_orders(Finder *finder, Items *items, MesoError *error)
{
    MesoRandom random;
    uint32_t *slots = MESO_NEW(finder->arena, uint32_t, finder->item_limit, error);
    Items first = *items, other = *items;
    first.numbers = MESO_NEW(finder->arena, uint32_t, finder->item_limit, error);
    other.numbers = MESO_NEW(finder->arena, uint32_t, finder->item_limit, error);
    if (!slots || !first.numbers || !other.numbers)
        return MESO_ERR_MEMORY;
    meso_random_init(&random, 0, 0);
    memcpy(first.numbers, items->numbers, items->count * sizeof *items->numbers);
    MesoStatus status = shrink(finder, items, slots, error);
    for (uint32_t i = 0; i < OTHER_ORDERS && !status && first.count <= MOST_REORDERED && items->minimal; i++) {
        other.count = first.count;
        memcpy(other.numbers, first.numbers, first.count * sizeof *first.numbers);
        shuffle(finder, &other, &random);
        status = shrink(finder, &other, slots, error);
        if (!status && other.minimal && other.count < items->count) {
            memcpy(items->numbers, other.numbers, other.count * sizeof *items->numbers);
            items->count = other.count;
        }
    }
    return status;
}

/* --- the result --- */

bool meso_conflict_core_admits(const MesoConflictCore *core, const MesoTilingProblem *problem, uint32_t slot,
                               uint32_t variant)
{
    for (uint32_t i = 0; i < 4 * core->rule_count; i++) {
        const MesoCoreRule *rule = &core->rules[i / 4];
        bool border = problem->graph->twin[4 * (size_t)slot + i % 4] == MESO_NO_INDEX;
        if (border != rule->only &&
            meso_label_interface(problem->variants->labels[4 * (size_t)variant + i % 4]) == rule->interface)
            return false;
    }
    for (uint32_t i = 0; i < core->constraint_count; i++) {
        const MesoConstraints *constraints = problem->constraints;
        if (core->constraints[i] >= constraints->restriction_count) {
            const MesoQuota *quota = &constraints->quotas[core->constraints[i] - constraints->restriction_count];
            if (quota->most == 0 && meso_bits_test(quota->variants, variant))
                return false;
            continue;
        }
        const MesoRestriction *restriction = &constraints->restrictions[core->constraints[i]];
        for (uint32_t p = 0; p < restriction->place_count; p++) {
            uint32_t place = restriction->places[p];
            if ((restriction->sided ? place / 4 : place) == slot &&
                !meso_core_allows(problem, restriction, place, variant))
                return false;
        }
    }
    return true;
}

static MesoStatus list_tiles(MesoConflictCore *core, MesoArena *arena, const MesoTilingProblem *problem,
                             MesoError *error)
{
    core->tiles = MESO_NEW(arena, uint32_t, problem->set->tile_count, error);
    if (!core->tiles)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < problem->variants->count; v++) {
        uint32_t tile = problem->variants->tile[v];
        bool admitted = core->tile_count > 0 && core->tiles[core->tile_count - 1] == tile;
        for (uint32_t i = 0; i < core->slot_count && !admitted; i++)
            if ((admitted = meso_conflict_core_admits(core, problem, core->slots[i], v)))
                core->tiles[core->tile_count++] = tile;
    }
    return MESO_OK;
}

static void sort_ascending(uint32_t *numbers, uint32_t count)
{
    for (uint32_t gap = count / 2; gap > 0; gap /= 2)
        for (uint32_t i = gap; i < count; i++)
            for (uint32_t j = i; j >= gap && numbers[j - gap] > numbers[j]; j -= gap) {
                uint32_t number = numbers[j];
                numbers[j] = numbers[j - gap];
                numbers[j - gap] = number;
            }
}

static MesoStatus tell(const Finder *finder, Items *items, MesoConflictCore *core, MesoArena *arena, MesoError *error)
{
    const MesoTilingProblem *problem = finder->problem;
    uint32_t rules = meso_core_rule_item(problem, 0, false), constraints = meso_core_constraint_item(problem, 0);
    core->slots = MESO_NEW(arena, uint32_t, items->count, error);
    core->rules = MESO_NEW(arena, MesoCoreRule, items->count, error);
    core->constraints = MESO_NEW(arena, uint32_t, items->count, error);
    if (!core->slots || !core->rules || !core->constraints)
        return MESO_ERR_MEMORY;
    sort_ascending(items->numbers, items->count);
    for (uint32_t i = 0; i < items->count; i++) {
        uint32_t item = items->numbers[i];
        if (item < rules)
            core->slots[core->slot_count++] = item;
        else if (item < constraints)
            core->rules[core->rule_count++] = (MesoCoreRule){(item - rules) / 2, (item - rules) % 2};
        else
            core->constraints[core->constraint_count++] = item - constraints;
    }
    core->found = true;
    core->minimal = items->minimal;
    return list_tiles(core, arena, problem, error);
}

/* Slots around `near` by distance, at most `most`; all of the surface, piece by piece, where there is no `near`. */
static MesoStatus order_slots(Finder *finder, uint32_t near, uint32_t most, MesoError *error)
{
    const MesoSlotGraph *graph = finder->problem->graph;
    finder->order = MESO_NEW(finder->arena, uint32_t, most, error);
    finder->rank = MESO_NEW(finder->arena, uint32_t, graph->slot_count, error);
    MesoSlotFlood flood = {.graph = graph, .slots = finder->order, .most = most,
                           .met = MESO_NEW(finder->arena, bool, graph->slot_count, error)};
    if (!finder->order || !finder->rank || !flood.met)
        return MESO_ERR_MEMORY;
    uint32_t begin = near == MESO_NO_INDEX ? 0 : near, end = near == MESO_NO_INDEX ? graph->slot_count : near + 1;
    for (uint32_t start = begin; start < end && flood.count < most; start++) {
        meso_slot_flood_meet(&flood, start);
        meso_slot_flood_all(&flood);
    }
    finder->order_count = flood.count;
    memset(finder->rank, 0xff, graph->slot_count * sizeof *finder->rank);
    return MESO_OK;
}

static MesoStatus prepare(Finder *finder, uint32_t near, uint32_t slots, Items *items, MesoError *error)
{
    const MesoTilingProblem *problem = finder->problem;
    if (order_slots(finder, near, slots, error))
        return MESO_ERR_MEMORY;
    finder->item_limit = finder->order_count + 2 * problem->set->interface_count +
                         (problem->constraints
                              ? problem->constraints->restriction_count + problem->constraints->quota_count : 0);
    finder->trial = MESO_NEW(finder->arena, uint32_t, finder->item_limit, error);
    finder->assumptions = MESO_NEW(finder->arena, int32_t, finder->item_limit, error);
    items->numbers = MESO_NEW(finder->arena, uint32_t, finder->item_limit, error);
    return finder->trial && finder->assumptions && items->numbers ? MESO_OK : MESO_ERR_MEMORY;
}

/* Balls until one contradicts itself. */
static MesoStatus find_first(Finder *finder, bool grow, Items *items, MesoError *error)
{
    MesoStatus status = MESO_OK;
    uint64_t ball = grow ? FIRST_BALL : finder->order_count;
    for (bool last = false; !last && !status && items->count == 0 && finder->work_left > 0; ball *= BALL_GROWTH) {
        last = ball >= finder->order_count;
        status = find_in_ball(finder, last ? finder->order_count : (uint32_t)ball, items, error);
    }
    return status;
}

MesoStatus meso_conflict_core_find(MesoConflictCore *core, MesoArena *arena, const MesoTilingProblem *problem,
                                   uint32_t near, const MesoCoreLimits *limits, MesoError *error)
{
    uint32_t most = limits->slots ? limits->slots : DEFAULT_SLOTS;
    uint64_t fit = ball_limit / (problem->variants->count + (uint64_t)1);
    uint32_t all = problem->graph->slot_count;
    *core = (MesoConflictCore){0};
    most = most < fit ? most : (uint32_t)fit;
    if (all == 0 || (near == MESO_NO_INDEX && all > most))
        return MESO_OK;
    MesoArena scratch;
    Items items = {0};
    Finder finder = {.problem = problem, .arena = &scratch, .work_left = work_limit,
                     .conflicts_left = limits->conflicts ? limits->conflicts : DEFAULT_CONFLICTS};
    meso_arena_init(&scratch);
    MesoStatus status = prepare(&finder, near, most < all ? most : all, &items, error);
    if (!status)
        status = find_first(&finder, near != MESO_NO_INDEX, &items, error);
    if (!status && items.count > 0)
        status = shrink_in_orders(&finder, &items, error);
    if (!status && items.count > 0 && (items.minimal || LEAST_PART * (uint64_t)items.count <= all))
        status = tell(&finder, &items, core, arena, error);
    meso_arena_release(&scratch);
    return status;
}
