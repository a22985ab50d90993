#include "libcore/tiling/solve/verdict_text.h"

#include <string.h>

/*
 * Names of a list that are said; kinds of slots of which is said what they can hold, in cores of how many slots
 * at most, and up to how many tiles.
 */
enum { MOST_NAMED = 8, MOST_SAID = 2, MOST_LOOKED_AT = 100, MOST_TILES_SAID = 3 };

/* `text` with `item`, number `i` of `count` in a list: "a, b and c"; after some of them "and 12 more". */
static const char *append(MesoArena *arena, const char *text, const char *item, uint32_t i, uint32_t count,
                          MesoError *error)
{
    if (!text || !item)
        return NULL;
    if (i == MOST_NAMED)
        return meso_arena_print(arena, error, "%s and %u more", text, count - i);
    if (i > MOST_NAMED)
        return text;
    return meso_arena_print(arena, error, "%s%s%s", text, i == 0 ? "" : i + 1 < count || count > MOST_NAMED ? ", "
                                                                                                        : " and ",
                            item);
}

/* "slot 3", "slots 3 and 4", "all 6 slots" */
static const char *slots_text(MesoArena *arena, const MesoConflictCore *core, uint32_t all, MesoError *error)
{
    const char *text = core->slot_count == 1 ? "slot " : "slots ";
    if (core->slot_count == all && all > 1)
        return meso_arena_print(arena, error, "all %u slots", all);
    for (uint32_t i = 0; i < core->slot_count && i <= MOST_NAMED; i++) {
        const char *item = meso_arena_print(arena, error, "%u", core->slots[i]);
        text = i == 0 && item ? meso_arena_print(arena, error, "%s%s", text, item)
                              : append(arena, text, item, i, core->slot_count, error);
    }
    return text;
}

static const char *names_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                              MesoError *error)
{
    const char *names = "";
    for (uint32_t i = 0; i < core->constraint_count && i <= MOST_NAMED; i++)
        names = append(arena, names, meso_constraint_name(problem->constraints, core->constraints[i]), i,
                       core->constraint_count, error);
    return names;
}

/* "no tiles fit together on slots 3 and 4, with pins[0]" */
static const char *misfit_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                               MesoError *error)
{
    const MesoConstraints *constraints = problem->constraints;
    const char *slots = slots_text(arena, core, problem->graph->slot_count, error);
    const char *beginning = core->slot_count == 1 ? "no tile fits" : "no tiles fit together on";
    const char *text = slots ? meso_arena_print(arena, error, "%s %s", beginning, slots) : NULL;
    if (core->constraint_count == 0)
        return text && constraints && constraints->restriction_count + constraints->quota_count
                   ? meso_arena_print(arena, error, "%s, whatever the constraints", text)
                   : text;
    const char *names = names_text(arena, problem, core, error);
    return text && names ? meso_arena_print(arena, error, "%s, with %s", text, names) : NULL;
}

/* "pins[0] and quotas[1] 'knots' cannot hold together on slots 3 and 700"; no slots: there are too few. */
static const char *quotas_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                               MesoError *error)
{
    const char *names = names_text(arena, problem, core, error);
    const char *together = core->constraint_count > 1 ? " together" : "";
    if (names && core->slot_count == 0)
        return meso_arena_print(arena, error, "%s cannot hold%s on a surface of %u slots", names, together,
                                problem->graph->slot_count);
    const char *slots = slots_text(arena, core, problem->graph->slot_count, error);
    return names && slots ? meso_arena_print(arena, error, "%s cannot hold%s on %s", names, together, slots) : NULL;
}

/* The interfaces with one of the two border rules: "interfaces 'a' and 'b' must not lie on a border"; or "". */
static const char *rule_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                             bool only, MesoError *error)
{
    const char *names = "";
    uint32_t count = 0, i = 0;
    for (uint32_t r = 0; r < core->rule_count; r++)
        count += core->rules[r].only == only;
    for (uint32_t r = 0; r < core->rule_count && i <= MOST_NAMED; r++) {
        if (core->rules[r].only != only)
            continue;
        const char *name = problem->set->interfaces[core->rules[r].interface].name;
        names = append(arena, names, meso_arena_print(arena, error, "'%s'", name), i++, count, error);
    }
    if (count == 0 || !names)
        return names;
    return meso_arena_print(arena, error, "interface%s %s %s", count == 1 ? "" : "s", names,
                            only ? "may lie on a border only" : "must not lie on a border");
}

static const char *rules_text(MesoArena *arena, const char *text, const MesoTilingProblem *problem,
                              const MesoConflictCore *core, MesoError *error)
{
    const char *exempt = rule_text(arena, problem, core, false, error);
    const char *only = rule_text(arena, problem, core, true, error);
    if (core->rule_count == 0 || !text || !exempt || !only)
        return exempt && only ? text : NULL;
    return meso_arena_print(arena, error, "%s, where %s%s%s", text, exempt, *exempt && *only ? " and " : "", only);
}

/* The tiles that rules and constraints of the core leave a slot: their number, and the first of them. */
static uint32_t tiles_at(const MesoTilingProblem *problem, const MesoConflictCore *core, uint32_t slot,
                         uint32_t tiles[MOST_TILES_SAID])
{
    uint32_t count = 0, last = MESO_NO_INDEX;
    for (uint32_t v = 0; v < problem->variants->count; v++) {
        uint32_t tile = problem->variants->tile[v];
        if (tile == last || !meso_conflict_core_admits(core, problem, slot, v))
            continue;
        last = tile;
        if (count < MOST_TILES_SAID)
            tiles[count] = tile;
        count++;
    }
    return count;
}

static uint32_t all_tiles(const MesoVariantSet *variants)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < variants->count; v++)
        count += v == 0 || variants->tile[v] != variants->tile[v - 1];
    return count;
}

/* "only 'knot' and 'bend' fit slots 3 and 5": every slot of the core that is left `tiles` [count]. */
static const char *choice_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                               const uint32_t *tiles, uint32_t count, MesoError *error)
{
    uint32_t own[MOST_TILES_SAID], alike = 0, i = 0;
    const char *names = "", *slots = "";
    for (uint32_t t = 0; t < count; t++) {
        const char *name = meso_arena_print(arena, error, "'%s'", problem->set->tiles[tiles[t]].name);
        names = append(arena, names, name, t, count, error);
    }
    for (uint32_t pass = 0; pass < 2; pass++)
        for (uint32_t s = 0; s < core->slot_count; s++) {
            if (tiles_at(problem, core, core->slots[s], own) != count || memcmp(own, tiles, count * sizeof *own) != 0)
                continue;
            if (pass == 0)
                alike++;
            else
                slots = append(arena, slots, meso_arena_print(arena, error, "%u", core->slots[s]), i++, alike, error);
        }
    if (!names || !slots)
        return NULL;
    return meso_arena_print(arena, error, "only %s %s slot%s %s", names, count == 1 ? "fits" : "fit",
                            alike == 1 ? "" : "s", slots);
}

/* What the slots with the least choice can hold, where that is little. */
static const char *tiles_text(MesoArena *arena, const char *text, const MesoTilingProblem *problem,
                              const MesoConflictCore *core, MesoError *error)
{
    uint32_t all = all_tiles(problem->variants), tiles[MOST_TILES_SAID], said[MOST_SAID][MOST_TILES_SAID] = {{0}};
    uint32_t said_count = 0;
    if (core->slot_count == 1 || core->slot_count > MOST_LOOKED_AT)
        return text;
    for (uint32_t size = 1; size <= MOST_TILES_SAID && size < all; size++)
        for (uint32_t s = 0; s < core->slot_count && said_count < MOST_SAID; s++) {
            if (tiles_at(problem, core, core->slots[s], tiles) != size ||
                (said_count == 1 && memcmp(said[0], tiles, size * sizeof *tiles) == 0))
                continue;
            memcpy(said[said_count], tiles, size * sizeof *tiles);
            const char *choice = choice_text(arena, problem, core, tiles, size, error);
            if (!text || !choice)
                return NULL;
            text = meso_arena_print(arena, error, "%s%s %s", text, said_count++ == 0 ? ":" : ",", choice);
        }
    return text;
}

const char *meso_core_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                           MesoError *error)
{
    /* Constraints ascend, quotas come last. */
    bool quotas = core->constraint_count > 0 &&
                  core->constraints[core->constraint_count - 1] >= problem->constraints->restriction_count;
    const char *text = quotas ? quotas_text(arena, problem, core, error) : misfit_text(arena, problem, core, error);
    text = rules_text(arena, text, problem, core, error);
    text = tiles_text(arena, text, problem, core, error);
    if (!text || (core->minimal && core->slot_count + core->constraint_count + core->rule_count <= 2))
        return text;
    return meso_arena_print(arena, error, "%s; %s", text,
                            core->minimal ? "each of these is needed" : "perhaps not all of these are needed");
}

const char *meso_broken_quota_text(MesoArena *arena, const MesoQuotaTrack *track, uint32_t quota, MesoError *error)
{
    const MesoQuota *rule = &track->quotas[quota];
    MesoQuotaCount count = track->counts[quota];
    if (count.inside > rule->most)
        return meso_arena_print(arena, error, "at most %u slots may hold what %s counts, and %u can hold nothing else",
                                rule->most, rule->name, count.inside);
    return meso_arena_print(arena, error, "at least %u slots are to hold what %s counts, and %u can", rule->least,
                            rule->name, count.possible);
}

static const char *budget_text(MesoArena *arena, const MesoSolveResult *result, MesoError *error)
{
    switch (result->budget) {
    case MESO_BUDGET_ATTEMPTS:
        return meso_arena_print(arena, error, "the search made its %u attempt%s", result->attempts,
                                result->attempts == 1 ? "" : "s");
    case MESO_BUDGET_OBSERVATIONS:
        return meso_arena_print(arena, error, "the search made its %llu observations",
                                (unsigned long long)result->observations);
    case MESO_BUDGET_CONFLICTS:
        return meso_arena_print(arena, error, "the exact engine met its %llu conflict%s",
                                (unsigned long long)result->conflict_limit, result->conflict_limit == 1 ? "" : "s");
    case MESO_BUDGET_CUTS:
        return "the exact engine found no more than assignments that break the rule on strands, as many as it may";
    case MESO_BUDGET_COUNTED:
        return "a quota that so many slots may count for is beyond the exact engine";
    case MESO_BUDGET_FORMULA:
        return "so many slots with so many tiles are beyond the exact engine";
    case MESO_BUDGET_TIME:
        break;
    }
    if (result->conflict_limit == 0)
        return "the time was over";
    if (result->conflicts > result->conflict_limit)
        return meso_arena_print(arena, error, "the time was over, after %llu conflicts of the exact engine",
                                (unsigned long long)result->conflicts);
    return meso_arena_print(arena, error, "the time was over, after %llu of %llu conflicts of the exact engine",
                            (unsigned long long)result->conflicts, (unsigned long long)result->conflict_limit);
}

const char *meso_gave_up_text(MesoArena *arena, const MesoSolveResult *result, const MesoTilingProblem *problem,
                              MesoError *error)
{
    const char *text = budget_text(arena, result, error);
    if (text && result->attempts > 0)
        text = meso_arena_print(arena, error, "%s; at best %u of %u slots were decided", text, result->decided_most,
                                problem->graph->slot_count);
    if (text && result->hot_spot_count > 0)
        text = meso_arena_print(arena, error, "%s; %u of %llu dead ends were at slot %u", text,
                                result->hot_spots[0].dead_ends, (unsigned long long)result->dead_ends_met,
                                result->hot_spots[0].slot);
    return text ? meso_violations_text(arena, text, result, problem->constraints, error) : NULL;
}

const char *meso_violations_text(MesoArena *arena, const char *text, const MesoSolveResult *result,
                                 const MesoConstraints *constraints, MesoError *error)
{
    uint32_t worst = 0, count = result->violations ? meso_constraint_count(constraints) : 0;
    for (uint32_t i = 0; i < count; i++)
        if (result->violations[i] > result->violations[worst])
            worst = i;
    if (count == 0 || result->violations[worst] == 0)
        return text;
    return meso_arena_print(arena, error, "%s; most often %s stood in the way: %llu times", text,
                            meso_constraint_name(constraints, worst), (unsigned long long)result->violations[worst]);
}
