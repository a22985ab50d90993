/* Conflict cores, against trying everything; by hand; on surfaces larger than a ball. */
#include "libcore/tiling/proof/conflict_core.h"

#include <string.h>

#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/fixture/random_case.h"

/* What of a problem is looked at: slots, border rules, restrictions, quotas, as bits. */
typedef struct Part {
    const MesoTilingProblem *problem;
    uint32_t slots, exempt, only, restrictions, quotas;
    uint32_t chosen[BRUTE_FORCE_SLOTS];
} Part;

static bool restrictions_hold(const Part *part, uint32_t slot)
{
    const MesoConstraints *constraints = part->problem->constraints;
    bool hold = true;
    for (uint32_t r = 0; constraints && r < constraints->restriction_count; r++) {
        const MesoRestriction *restriction = &constraints->restrictions[r];
        for (uint32_t i = 0; (part->restrictions >> r) & 1 && i < restriction->place_count; i++) {
            uint32_t place = restriction->places[i], variant = part->chosen[slot];
            if (restriction->sided && place / 4 == slot)
                hold &= meso_bits_test(restriction->allowed,
                                       meso_label_code(part->problem->variants->labels[4 * variant + place % 4]));
            else if (!restriction->sided && place == slot)
                hold &= meso_bits_test(restriction->allowed, variant);
        }
    }
    return hold;
}

static bool fits(const Part *part, uint32_t slot)
{
    const int32_t *labels = part->problem->variants->labels;
    for (uint32_t k = 0; k < 4; k++) {
        int32_t label = labels[4 * part->chosen[slot] + k];
        uint32_t twin = part->problem->graph->twin[4 * slot + k], interface = meso_label_interface(label);
        if (((twin == MESO_NO_INDEX ? part->exempt : part->only) >> interface) & 1)
            return false;
        if (twin != MESO_NO_INDEX && (part->slots >> (twin / 4)) & 1 && twin / 4 <= slot &&
            label != -labels[4 * part->chosen[twin / 4] + twin % 4])
            return false;
    }
    return restrictions_hold(part, slot);
}

/* Slots that are not in the part may count for a quota or not. */
static bool quotas_hold(const Part *part)
{
    const MesoConstraints *constraints = part->problem->constraints;
    uint32_t others = part->problem->graph->slot_count - (uint32_t)__builtin_popcount(part->slots);
    bool hold = true;
    for (uint32_t q = 0; constraints && q < constraints->quota_count; q++) {
        const MesoQuota *quota = &constraints->quotas[q];
        uint32_t held = 0;
        for (uint32_t s = 0; s < part->problem->graph->slot_count; s++)
            held += (part->slots >> s) & 1 && meso_bits_test(quota->variants, part->chosen[s]);
        if ((part->quotas >> q) & 1)
            hold &= held <= quota->most && held + others >= quota->least;
    }
    return hold;
}

/* Whether the slots of the part, from `slot` on, can have tiles; sides towards other slots are free. */
static bool can_hold(Part *part, uint32_t slot)
{
    while (slot < part->problem->graph->slot_count && !((part->slots >> slot) & 1))
        slot++;
    if (slot == part->problem->graph->slot_count)
        return quotas_hold(part);
    for (uint32_t v = 0; v < part->problem->variants->count; v++) {
        part->chosen[slot] = v;
        if (fits(part, slot) && can_hold(part, slot + 1))
            return true;
    }
    return false;
}

static Part part_of(const MesoTilingProblem *problem, const MesoConflictCore *core)
{
    Part part = {.problem = problem};
    for (uint32_t i = 0; i < core->slot_count; i++)
        part.slots |= 1u << core->slots[i];
    for (uint32_t i = 0; i < core->rule_count; i++)
        *(core->rules[i].only ? &part.only : &part.exempt) |= 1u << core->rules[i].interface;
    uint32_t restrictions = problem->constraints ? problem->constraints->restriction_count : 0;
    for (uint32_t i = 0; i < core->constraint_count; i++) {
        bool quota = core->constraints[i] >= restrictions;
        *(quota ? &part.quotas : &part.restrictions) |= 1u << (core->constraints[i] - (quota ? restrictions : 0));
    }
    return part;
}

static Part whole(const MesoTilingProblem *problem)
{
    Part part = {.problem = problem, .slots = (1u << problem->graph->slot_count) - 1, .restrictions = UINT32_MAX,
                 .quotas = UINT32_MAX};
    for (uint32_t i = 0; i < problem->set->interface_count; i++) {
        part.exempt |= (uint32_t)problem->set->interfaces[i].border_exempt << i;
        part.only |= (uint32_t)problem->set->interfaces[i].border_only << i;
    }
    return part;
}

/* With any one of `bits` taken from it, the part can hold. */
static void check_needed(Part *part, uint32_t *bits)
{
    for (uint32_t b = 0; b < 32; b++) {
        if (!((*bits >> b) & 1))
            continue;
        *bits ^= 1u << b;
        CHECK(can_hold(part, 0));
        *bits ^= 1u << b;
    }
}

static void check_core(const MesoTilingProblem *problem, const MesoConflictCore *core)
{
    Part part = part_of(problem, core), all = whole(problem);
    CHECK((core->slot_count > 0 || part.quotas) && (uint32_t)__builtin_popcount(part.slots) == core->slot_count);
    CHECK((part.exempt & ~all.exempt) == 0 && (part.only & ~all.only) == 0);
    CHECK(!can_hold(&part, 0));
    CHECK(core->minimal);       /* so small cases are within every limit */
    check_needed(&part, &part.slots);
    check_needed(&part, &part.exempt);
    check_needed(&part, &part.only);
    check_needed(&part, &part.restrictions);
    check_needed(&part, &part.quotas);
}

/* A core is found around `near` in every case without an assignment, and in no other. Returns whether it was. */
static bool check_case(MesoArena *arena, const MesoTilingProblem *problem, uint32_t near)
{
    const MesoCoreLimits limits = {0};
    MesoConflictCore core, again;
    Part all = whole(problem);
    CHECK(meso_conflict_core_find(&core, arena, problem, MESO_NO_INDEX, &limits, NULL) == MESO_OK);
    CHECK(core.found == !can_hold(&all, 0));
    if (!core.found)
        return false;
    check_core(problem, &core);
    CHECK(meso_conflict_core_find(&core, arena, problem, near, &limits, NULL) == MESO_OK);
    CHECK(meso_conflict_core_find(&again, arena, problem, near, &limits, NULL) == MESO_OK);
    CHECK(core.found == again.found && core.slot_count == again.slot_count);
    if (core.found)
        check_core(problem, &core);
    return true;
}

/* Up to two quotas of random variants. */
static void add_random_quotas(MesoConstraints *constraints, MesoArena *arena, MesoRandom *random, uint32_t slots,
                              uint32_t variants)
{
    MesoQuota *quotas = MESO_NEW(arena, MesoQuota, 2, NULL);
    CHECK(quotas);
    constraints->quotas = quotas;
    constraints->quota_count = meso_random_below(random, 3);
    for (uint32_t q = 0; q < constraints->quota_count; q++) {
        uint64_t *counted = MESO_NEW(arena, uint64_t, 1, NULL);
        CHECK(counted);
        for (uint32_t v = 0; v < variants; v++)
            if (meso_random_below(random, 2))
                meso_bits_set(counted, v);
        uint32_t least = meso_random_below(random, slots + 2);
        quotas[q] = (MesoQuota){"quotas", counted, least, least + meso_random_below(random, slots)};
    }
}

/* Up to three restrictions at random places. */
static MesoConstraints random_constraints(MesoArena *arena, MesoRandom *random, const MesoSlotGraph *graph,
                                          uint32_t variants, uint32_t codes)
{
    uint32_t count = meso_random_below(random, 4);
    MesoRestriction *restrictions = MESO_NEW(arena, MesoRestriction, count, NULL);
    CHECK(restrictions);
    for (uint32_t r = 0; r < count; r++) {
        bool sided = meso_random_below(random, 2);
        uint32_t bound = (sided ? 4 : 1) * graph->slot_count, place_count = 1 + meso_random_below(random, 2);
        uint32_t *places = MESO_NEW(arena, uint32_t, place_count, NULL);
        uint64_t *allowed = MESO_NEW(arena, uint64_t, 1, NULL);
        CHECK(places && allowed && variants <= 64);
        for (uint32_t i = 0; i < place_count; i++)
            places[i] = meso_random_below(random, bound);
        for (uint32_t b = 0; b < (sided ? codes : variants); b++)
            if (meso_random_below(random, 2))
                meso_bits_set(allowed, b);
        restrictions[r] = (MesoRestriction){"pins", sided, place_count, places, allowed};
    }
    return (MesoConstraints){.restriction_count = count, .restrictions = restrictions};
}

static void test_brute_force(void)
{
    MesoArena arena;
    MesoRandom random;
    uint32_t found = 0, restricted = 0, counted = 0;
    meso_arena_init(&arena);
    meso_random_init(&random, 3, 0);
    for (uint32_t i = 0; i < 1500; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoVariantSet variants;
        MesoTileSet set = random_set(&arena, &random);
        MesoSlotGraph graph = i % 2 ? random_graph(&arena, &random)
                                    : fixture_grid(&arena, 2 + i % 3, 2, i % 5 == 0, i % 7 == 0, false);
        CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
        MesoConstraints constraints = random_constraints(&arena, &random, &graph, variants.count,
                                                         2 * set.interface_count);
        MesoTilingProblem problem = {&set, &variants, &graph, NULL};
        uint32_t near = meso_random_below(&random, graph.slot_count);
        bool without = check_case(&arena, &problem, near);
        problem.constraints = &constraints;
        bool with = check_case(&arena, &problem, near);
        CHECK(with || !without);
        add_random_quotas(&constraints, &arena, &random, graph.slot_count, variants.count);
        bool with_quotas = check_case(&arena, &problem, near);
        CHECK(with_quotas || !with);
        found += without;
        restricted += with && !without;
        counted += with_quotas && !with;
        meso_arena_rewind(&arena, mark);
    }
    CHECK(found > 300 && restricted > 100 && counted > 100);
    meso_arena_release(&arena);
}

static MesoConflictCore find(MesoArena *arena, const MesoTilingProblem *problem, uint32_t near)
{
    const MesoCoreLimits limits = {0};
    MesoConflictCore core;
    CHECK(meso_conflict_core_find(&core, arena, problem, near, &limits, NULL) == MESO_OK);
    return core;
}

/*
 *     [0][1][2]    t0 = b a c a, t1 = c a a a; c lies on borders only
 *
 * Slot 1 would have to show neither b nor c on the left and right, but there is no such tile.
 */
static void test_border_rule(void)
{
    static const int32_t labels[2][4] = {{2, 1, 3, 1}, {3, 1, 1, 1}};
    MesoArena arena;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 2, labels, false, false, false);
    set.interfaces[2].border_only = true;
    MesoSlotGraph graph = fixture_grid(&arena, 3, 1, false, false, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    const MesoTilingProblem problem = {&set, &variants, &graph, NULL};
    MesoConflictCore core = find(&arena, &problem, 1);
    CHECK(core.found && core.minimal && core.slot_count == 1 && core.slots[0] == 1);
    CHECK(core.rule_count == 1 && core.rules[0].interface == 2 && core.rules[0].only);
    CHECK(core.tile_count == 0 && core.constraint_count == 0);
    CHECK(!meso_conflict_core_admits(&core, &problem, 1, 0) && !meso_conflict_core_admits(&core, &problem, 1, 1));
    CHECK(meso_conflict_core_admits(&core, &problem, 0, 0) && !meso_conflict_core_admits(&core, &problem, 0, 1));

    /* Two rules against each other: the only tile has c on the sides, which may not be there. */
    set.tile_count = 1;
    set.interfaces[0].border_exempt = true;
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    core = find(&arena, &problem, MESO_NO_INDEX);
    CHECK(core.found && core.slot_count == 1 && core.rule_count == 1);
    meso_arena_release(&arena);
}

/* Two pins that fight across a chain of slots; a third has no part in it, and neither have the slots beyond. */
static void test_pins(void)
{
    static const int32_t chain[3][4] = {{1, 1, -1, -1}, {2, 1, -1, -1}, {1, 1, -2, -1}};
    static const uint32_t places[3] = {500, 501, 700};
    static const uint64_t t0[1] = {1}, t1[1] = {2};
    MesoArena arena;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 3, chain, false, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 1000, 1, false, false, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    const MesoRestriction pins[3] = {{"pins[0]", false, 1, places + 2, t0}, {"pins[1]", false, 1, places, t1},
                                     {"pins[2]", false, 1, places + 1, t0}};
    const MesoConstraints constraints = {.restriction_count = 3, .restrictions = pins};
    const MesoTilingProblem problem = {&set, &variants, &graph, &constraints};
    for (uint32_t i = 0; i < 2; i++) {
        MesoConflictCore core = find(&arena, &problem, i ? 499 : MESO_NO_INDEX);
        CHECK(core.found && core.minimal && core.slot_count == 2 && core.slots[0] == 500 && core.slots[1] == 501);
        CHECK(core.constraint_count == 2 && core.constraints[0] == 1 && core.constraints[1] == 2);
        CHECK(core.tile_count == 2 && core.tiles[0] == 0 && core.tiles[1] == 1);
    }
    meso_arena_release(&arena);
}

/* Two pins that use up a quota of one, far from each other; a third pin and another quota have no part in it. */
static void test_quota(void)
{
    static const int32_t labels[2][4] = {{1, 1, -1, -1}, {1, 1, -1, -1}};
    static const uint32_t places[3] = {3, 400, 700};
    static const uint64_t t0[1] = {1}, t1[1] = {2};
    MesoArena arena;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 1, 2, labels, false, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 1000, 1, false, false, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    const MesoRestriction pins[3] = {{"pins[0]", false, 1, places, t1}, {"pins[1]", false, 1, places + 1, t0},
                                     {"pins[2]", false, 1, places + 2, t1}};
    const MesoQuota quotas[2] = {{"quotas[0]", t1, 0, 1}, {"quotas[1]", t0, 2, 1000}};
    MesoConstraints constraints = {.restriction_count = 3, .restrictions = pins, .quota_count = 2, .quotas = quotas};
    const MesoTilingProblem problem = {&set, &variants, &graph, &constraints};
    MesoConflictCore core = find(&arena, &problem, MESO_NO_INDEX);
    CHECK(core.found && core.minimal && core.slot_count == 2 && core.slots[0] == 3 && core.slots[1] == 700);
    CHECK(core.constraint_count == 3 && core.constraints[0] == 0);
    CHECK(core.constraints[1] == 2 && core.constraints[2] == 3);
    /* More than there are slots: no slot has a part in that. */
    const MesoQuota large = {"quotas[0]", t1, 1001, 1001};
    constraints = (MesoConstraints){.quota_count = 1, .quotas = &large};
    core = find(&arena, &problem, MESO_NO_INDEX);
    CHECK(core.found && core.minimal && core.slot_count == 0 && core.constraint_count == 1 && core.constraints[0] == 0);
    meso_arena_release(&arena);
}

/* A ring of an odd number of slots that must alternate is a conflict as a whole; no ball short of it is. */
static void test_ring(void)
{
    static const int32_t labels[2][4] = {{1, 3, 2, 3}, {-2, 3, -1, 3}};
    MesoArena arena;
    MesoVariantSet variants;
    const MesoCoreLimits small = {.slots = 100};
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 2, labels, false, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 301, 1, true, false, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    const MesoTilingProblem problem = {&set, &variants, &graph, NULL};
    MesoConflictCore core = find(&arena, &problem, 17);
    CHECK(core.found && core.minimal && core.slot_count == 301 && core.slots[300] == 300);
    CHECK(core.rule_count == 0 && core.tile_count == 2);
    CHECK(meso_conflict_core_find(&core, &arena, &problem, 17, &small, NULL) == MESO_OK && !core.found);
    CHECK(meso_conflict_core_find(&core, &arena, &problem, MESO_NO_INDEX, &small, NULL) == MESO_OK && !core.found);
    meso_arena_release(&arena);
}

int main(void)
{
    test_brute_force();
    test_border_rule();
    test_pins();
    test_quota();
    test_ring();
    return 0;
}
