#include "libcore/tiling/problem/strands.h"

#include <stdio.h>
#include <string.h>

#include "libcore/tiling/problem/strand_forest.h"
#include "libcore/tiling/problem/strand_joints.h"

typedef struct StrandMap {
    const MesoAssignment *assignment;
    const MesoTileSet *set;
    const MesoSlotGraph *graph;
    MesoStrandJoints joints;
    MesoStrandForest forest;
} StrandMap;

static uint32_t joint(const StrandMap *map, uint32_t slot, uint32_t side, uint32_t section)
{
    return meso_strand_joint(&map->joints, map->assignment, map->set, slot, side, section);
}

static uint32_t sections_on(const StrandMap *map, uint32_t slot, uint32_t side)
{
    return meso_strand_section_count(map->assignment, map->set, slot, side);
}

static void link_slot(StrandMap *map, uint32_t slot)
{
    const MesoTile *tile = &map->set->tiles[map->assignment->tile[slot]];
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        const MesoSweep *sweep = &map->set->sweeps[tile->sweep_begin + i];
        meso_strand_link(&map->forest, joint(map, slot, sweep->from_side, sweep->from_section),
                         joint(map, slot, sweep->to_side, sweep->to_section));
    }
}

static MesoStatus build(StrandMap *map, MesoArena *arena, const MesoAssignment *assignment,
                        const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error)
{
    *map = (StrandMap){.assignment = assignment, .set = set, .graph = graph};
    MesoStatus status = meso_strand_joints_number(&map->joints, arena, assignment, set, graph, error);
    if (!status)
        status = meso_strand_forest_init(&map->forest, arena, map->joints.count, error);
    for (uint32_t slot = 0; slot < graph->slot_count && !status; slot++)
        link_slot(map, slot);
    return status;
}

static bool is_strand(const StrandMap *map, uint32_t node)
{
    const MesoStrandNode *root = &map->forest.nodes[node];
    return root->parent == node && root->links > 0;
}

static void count_strand(MesoStrandStatistics *statistics, const MesoStrandNode *root)
{
    uint64_t length = root->links;
    statistics->strand_count++;
    statistics->link_count += length;
    statistics->loop_count += meso_strand_ring(root);
    statistics->cyclic_count += meso_strand_cyclic(root);
    statistics->lengths[63 - __builtin_clzll(length)]++;
    if (statistics->strand_count == 1 || length < statistics->shortest)
        statistics->shortest = length;
    if (length > statistics->longest)
        statistics->longest = length;
}

MesoStatus meso_strands_count(MesoStrandStatistics *statistics, const MesoAssignment *assignment,
                              const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error)
{
    StrandMap map;
    MesoArena arena;
    *statistics = (MesoStrandStatistics){0};
    meso_arena_init(&arena);
    MesoStatus status = build(&map, &arena, assignment, set, graph, error);
    for (uint32_t i = 0; !status && i < map.joints.count; i++)
        if (is_strand(&map, i))
            count_strand(statistics, &map.forest.nodes[i]);
    meso_arena_release(&arena);
    return status;
}

/* The strand of the slot's sweep `i`, by its root. */
static uint32_t strand_at(const StrandMap *map, uint32_t slot, uint32_t i)
{
    const MesoTile *tile = &map->set->tiles[map->assignment->tile[slot]];
    const MesoSweep *sweep = &map->set->sweeps[tile->sweep_begin + i];
    return meso_strand_root(&map->forest, joint(map, slot, sweep->from_side, sweep->from_section));
}

static uint32_t sweep_count(const StrandMap *map, uint32_t slot)
{
    return map->set->tiles[map->assignment->tile[slot]].sweep_count;
}

/* What a strand by itself does against the rule, or NULL. */
static const char *offence(const MesoStrandRule *rule, const MesoStrandNode *root)
{
    if (rule->acyclic && meso_strand_cyclic(root))
        return "has a cycle";
    if (rule->no_loops && meso_strand_ring(root))
        return "is a closed loop";
    if (rule->max_length && root->links > rule->max_length)
        return "is too long";
    return NULL;
}

/* `first` [pieces] holds the strand met first on each piece of the surface, or MESO_NO_INDEX. */
static MesoStatus check_strands(const StrandMap *map, const MesoStrandRule *rule, const uint32_t *component,
                                uint32_t *first, MesoError *error)
{
    for (uint32_t slot = 0; slot < map->graph->slot_count; slot++) {
        for (uint32_t i = 0; i < sweep_count(map, slot); i++) {
            uint32_t strand = strand_at(map, slot, i);
            const char *what = offence(rule, &map->forest.nodes[strand]);
            if (what)
                return meso_fail(error, MESO_ERR_INPUT, "the strand of %u sweeps through slot %u %s",
                                 map->forest.nodes[strand].links, slot, what);
            if (first[component[slot]] == MESO_NO_INDEX)
                first[component[slot]] = strand;
            if (rule->connected && first[component[slot]] != strand)
                return meso_fail(error, MESO_ERR_INPUT, "the strand of %u sweeps through slot %u is not "
                                 "connected to others", map->forest.nodes[strand].links, slot);
        }
    }
    return MESO_OK;
}

MesoStatus meso_strands_check(const MesoStrandRule *rule, const MesoAssignment *assignment,
                              const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error)
{
    StrandMap map;
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = build(&map, &arena, assignment, set, graph, error);
    uint32_t *component = MESO_NEW(&arena, uint32_t, graph->slot_count, error);
    uint32_t *first = MESO_NEW(&arena, uint32_t, graph->slot_count, error);
    if (!status && (!component || !first))
        status = MESO_ERR_MEMORY;
    if (!status) {
        meso_slot_graph_components(graph, component);
        for (uint32_t i = 0; i < graph->slot_count; i++)
            first[i] = MESO_NO_INDEX;
        status = check_strands(&map, rule, component, first, error);
    }
    meso_arena_release(&arena);
    return status;
}

/* The two shortest strands of a piece of the surface, by their roots, or MESO_NO_INDEX. */
typedef struct StrandPair {
    uint32_t root[2];
} StrandPair;

/* Cuts of one kind under construction. Each strand may belong to one. */
typedef struct CutBuilder {
    const StrandMap *map;
    const MesoStrandRule *rule;
    uint32_t *cut_of;           /* [joints] cut of the strand with this root, plus 1; 0: none */
    uint32_t count, most;
    bool lasting;               /* more sweeps mend nothing: a cycle, too many of them */
} CutBuilder;

static void number_offenders(CutBuilder *builder)
{
    for (uint32_t i = 0; i < builder->map->joints.count && builder->count < builder->most; i++)
        if (is_strand(builder->map, i) && offence(builder->rule, &builder->map->forest.nodes[i]))
            builder->cut_of[i] = ++builder->count;
}

/*
 * Makes the forest anew without the links at sets that break the rule by a
 * cycle or their length already: short pieces, so that cuts are strong. A
 * link that was left out counts for the piece at its start.
 */
static MesoStatus break_into_pieces(StrandMap *map, const MesoStrandRule *rule, MesoArena *arena, MesoError *error)
{
    if (meso_strand_forest_init(&map->forest, arena, map->joints.count, error))
        return MESO_ERR_MEMORY;
    for (uint32_t slot = 0; slot < map->graph->slot_count; slot++) {
        const MesoTile *tile = &map->set->tiles[map->assignment->tile[slot]];
        for (uint32_t i = 0; i < tile->sweep_count; i++) {
            const MesoSweep *sweep = &map->set->sweeps[tile->sweep_begin + i];
            uint32_t a = joint(map, slot, sweep->from_side, sweep->from_section);
            uint32_t b = joint(map, slot, sweep->to_side, sweep->to_section);
            const MesoStrandNode *nodes = map->forest.nodes;
            if (!offence(rule, &nodes[meso_strand_root(&map->forest, a)]) &&
                !offence(rule, &nodes[meso_strand_root(&map->forest, b)]))
                meso_strand_link(&map->forest, a, b);
        }
    }
    return MESO_OK;
}

/* On each piece the two shortest strands, which one cut keeps from staying both. */
static void number_unconnected(CutBuilder *builder, const uint32_t *component, StrandPair *shortest)
{
    const StrandMap *map = builder->map;
    for (uint32_t slot = 0; slot < map->graph->slot_count; slot++)
        for (uint32_t i = 0; i < sweep_count(map, slot); i++) {
            uint32_t strand = strand_at(map, slot, i);
            uint32_t *two = shortest[component[slot]].root;
            const MesoStrandNode *nodes = map->forest.nodes;
            if (strand == two[0] || strand == two[1])
                continue;
            if (two[0] == MESO_NO_INDEX || nodes[strand].links < nodes[two[0]].links) {
                two[1] = two[0];
                two[0] = strand;
            } else if (two[1] == MESO_NO_INDEX || nodes[strand].links < nodes[two[1]].links)
                two[1] = strand;
        }
    for (uint32_t piece = 0; piece < map->graph->slot_count && builder->count < builder->most; piece++) {
        const uint32_t *two = shortest[piece].root;
        if (two[1] == MESO_NO_INDEX || builder->cut_of[two[0]] || builder->cut_of[two[1]])
            continue;
        builder->cut_of[two[0]] = builder->cut_of[two[1]] = ++builder->count;
    }
}

/* The cut of the strand at the joint of a slot's side and the section at this place of its interface; 0: none. */
static uint32_t cut_at(const CutBuilder *builder, uint32_t slot, uint32_t side, uint32_t place)
{
    uint32_t at = builder->map->joints.base[6 * (size_t)slot + side] + place;
    return builder->cut_of[meso_strand_root(&builder->map->forest, at)];
}

/* Whether the cut at this joint of `slot` was met at one of those before it. */
static bool met_before(const CutBuilder *builder, uint32_t slot, uint32_t side, uint32_t place)
{
    uint32_t cut = cut_at(builder, slot, side, place);
    for (uint32_t k = 0; k <= side; k++)
        for (uint32_t i = 0; i < (k < side ? sections_on(builder->map, slot, k) : place); i++)
            if (cut_at(builder, slot, k, i) == cut)
                return true;
    return false;
}

/* Whether the slot has a sweep of a strand in the cut. */
static bool has_sweep_in(const CutBuilder *builder, uint32_t slot, uint32_t cut)
{
    for (uint32_t i = 0; i < sweep_count(builder->map, slot); i++)
        if (builder->cut_of[strand_at(builder->map, slot, i)] == cut)
            return true;
    return false;
}

/*
 * Lists the slots of each cut: counts where `slots` is NULL, `fill` [count] being where each cut goes on.
 * Those are all slots that a joint of the strand belongs to: where a sweep ends at a slot that goes on with none,
 * another tile there may change the strand as well. Of lasting offences those with a sweep do.
 */
static void go_through_cuts(const CutBuilder *builder, uint32_t *fill, uint32_t *slots)
{
    const StrandMap *map = builder->map;
    for (uint32_t slot = 0; slot < map->graph->slot_count; slot++)
        for (uint32_t side = 0; side < 6; side++)
            for (uint32_t i = 0; i < sections_on(map, slot, side); i++) {
                uint32_t cut = cut_at(builder, slot, side, i);
                if (cut == 0 || met_before(builder, slot, side, i) ||
                    (builder->lasting && !has_sweep_in(builder, slot, cut)))
                    continue;
                if (slots)
                    slots[fill[cut - 1]] = slot;
                fill[cut - 1]++;
            }
}

/* Appends the builder's cuts to `cuts`, whose `begin` has room for them; `slots` is made anew in `arena`. */
static MesoStatus append_cuts(const CutBuilder *builder, MesoStrandCuts *cuts, MesoArena *arena, MesoError *error)
{
    uint32_t *fill = MESO_NEW(arena, uint32_t, builder->count, error);
    uint32_t *begin = cuts->begin + cuts->count, *before = cuts->slots;
    if (!fill)
        return MESO_ERR_MEMORY;
    go_through_cuts(builder, fill, NULL);
    for (uint32_t c = 0; c < builder->count; c++) {
        begin[c + 1] = begin[c] + fill[c];
        fill[c] = begin[c];
    }
    cuts->slots = MESO_NEW(arena, uint32_t, begin[builder->count], error);
    if (!cuts->slots)
        return MESO_ERR_MEMORY;
    if (begin[0])
        memcpy(cuts->slots, before, begin[0] * sizeof *before);
    go_through_cuts(builder, fill, cuts->slots);
    cuts->count += builder->count;
    return MESO_OK;
}

static MesoStatus begin_cuts(CutBuilder *builder, const StrandMap *map, const MesoStrandRule *rule,
                             const MesoStrandCuts *cuts, uint32_t most, MesoArena *arena, MesoError *error)
{
    *builder = (CutBuilder){.map = map, .rule = rule, .most = most - cuts->count};
    builder->cut_of = MESO_NEW(arena, uint32_t, map->joints.count, error);
    return builder->cut_of ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus cut_what_lasts(MesoStrandCuts *cuts, const StrandMap *map, const MesoStrandRule *rule, uint32_t most,
                                 MesoArena *arena, MesoError *error)
{
    /* A piece may close to a ring where its strand has a branch: that breaks no rule. */
    const MesoStrandRule lasting = {.acyclic = rule->acyclic, .max_length = rule->max_length};
    StrandMap pieces = *map;
    CutBuilder builder;
    if (!meso_strand_rule_given(&lasting))
        return MESO_OK;
    if (begin_cuts(&builder, &pieces, &lasting, cuts, most, arena, error) ||
        break_into_pieces(&pieces, &lasting, arena, error))
        return MESO_ERR_MEMORY;
    builder.lasting = true;
    number_offenders(&builder);
    return append_cuts(&builder, cuts, arena, error);
}

static MesoStatus cut_rings(MesoStrandCuts *cuts, const StrandMap *map, const MesoStrandRule *rule, uint32_t most,
                            MesoArena *arena, MesoError *error)
{
    const MesoStrandRule closing = {.no_loops = true};
    CutBuilder builder;
    /* A ring has a cycle: that is cut already where none may be. */
    if (!rule->no_loops || rule->acyclic)
        return MESO_OK;
    if (begin_cuts(&builder, map, &closing, cuts, most, arena, error))
        return MESO_ERR_MEMORY;
    number_offenders(&builder);
    return append_cuts(&builder, cuts, arena, error);
}

static MesoStatus cut_unconnected(MesoStrandCuts *cuts, const StrandMap *map, const MesoStrandRule *rule, uint32_t most,
                                  MesoArena *arena, MesoError *error)
{
    uint32_t slots = map->graph->slot_count;
    CutBuilder builder;
    if (!rule->connected)
        return MESO_OK;
    uint32_t *component = MESO_NEW(arena, uint32_t, slots, error);
    StrandPair *shortest = MESO_NEW(arena, StrandPair, slots, error);
    if (!component || !shortest || begin_cuts(&builder, map, rule, cuts, most, arena, error))
        return MESO_ERR_MEMORY;
    memset(shortest, 0xff, slots * sizeof *shortest);
    meso_slot_graph_components(map->graph, component);
    number_unconnected(&builder, component, shortest);
    return append_cuts(&builder, cuts, arena, error);
}

MesoStatus meso_strands_cuts(MesoStrandCuts *cuts, MesoArena *arena, const MesoStrandRule *rule,
                             const MesoAssignment *assignment, const MesoTileSet *set,
                             const MesoSlotGraph *graph, uint32_t most, MesoError *error)
{
    StrandMap map;
    MesoArena scratch;
    *cuts = (MesoStrandCuts){0};
    meso_arena_init(&scratch);
    MesoStatus status = build(&map, &scratch, assignment, set, graph, error);
    cuts->begin = MESO_NEW(arena, uint32_t, most + (size_t)1, error);
    if (!cuts->begin)
        status = MESO_ERR_MEMORY;
    if (!status)
        status = cut_what_lasts(cuts, &map, rule, most, &scratch, error);
    if (!status)
        status = cut_rings(cuts, &map, rule, most, &scratch, error);
    if (!status)
        status = cut_unconnected(cuts, &map, rule, most, &scratch, error);
    uint32_t *slots = status ? NULL : MESO_NEW(arena, uint32_t, cuts->begin[cuts->count], error);
    if (!status && !slots)
        status = MESO_ERR_MEMORY;
    if (!status && cuts->count)
        memcpy(slots, cuts->slots, cuts->begin[cuts->count] * sizeof *slots);
    cuts->slots = slots;
    meso_arena_release(&scratch);
    return status;
}

const char *meso_strand_rule_name(const MesoStrandRule *rule, char text[64])
{
    int used = 0;
    text[0] = '\0';
    const char *const names[] = {rule->connected ? "connected" : NULL, rule->acyclic ? "acyclic" : NULL,
                                 rule->no_loops ? "no-loops" : NULL};
    for (uint32_t i = 0; i < 3; i++)
        if (names[i])
            used += snprintf(text + used, 64 - (size_t)used, "%s%s", used ? ", " : "", names[i]);
    if (rule->max_length)
        snprintf(text + used, 64 - (size_t)used, "%smax-length %u", used ? ", " : "", rule->max_length);
    return text;
}
