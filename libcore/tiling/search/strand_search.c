#include "libcore/tiling/search/strand_search.h"

#include <string.h>

enum { UNDO_LINK, UNDO_SLOT, UNDO_OPEN, UNDO_CLOSE, UNDO_FINISH };

static uint32_t local_section(const MesoTileSet *set, uint32_t section)
{
    return section - set->interfaces[set->sections[section].interface].section_begin;
}

/* The sweeps of every variant as they lie in the slot. */
static MesoStatus place_links(MesoStrandSearch *search, bool *shell, MesoError *error)
{
    const MesoVariantSet *variants = search->variants;
    const MesoTileSet *set = search->set;
    uint64_t count = 0;
    for (uint32_t v = 0; v < variants->count; v++)
        count += set->tiles[variants->tile[v]].sweep_count;
    if (count >= MESO_NO_INDEX)
        return meso_fail(error, MESO_ERR_LIMIT, "too many sweeps for strands");
    search->link_begin = MESO_NEW(search->arena, uint32_t, variants->count + (size_t)1, error);
    search->links = MESO_NEW(search->arena, MesoVariantLink, count, error);
    if (!search->link_begin || !search->links)
        return MESO_ERR_MEMORY;

    uint32_t at = 0;
    for (uint32_t v = 0; v < variants->count; v++) {
        const MesoTile *tile = &set->tiles[variants->tile[v]];
        search->link_begin[v] = at;
        for (uint32_t i = 0; i < tile->sweep_count; i++) {
            const MesoSweep *sweep = &set->sweeps[tile->sweep_begin + i];
            search->links[at++] = (MesoVariantLink){
                .side = {(uint8_t)meso_transform_side(variants->transform[v], sweep->from_side),
                         (uint8_t)meso_transform_side(variants->transform[v], sweep->to_side)},
                .section = {local_section(set, sweep->from_section), local_section(set, sweep->to_section)}};
            *shell |= sweep->from_side >= 4 || sweep->to_side >= 4;
        }
    }
    search->link_begin[variants->count] = at;
    return MESO_OK;
}

static uint32_t number_edges(MesoStrandSearch *search)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 4 * search->graph->slot_count; h++) {
        uint32_t twin = search->graph->twin[h];
        search->edge[h] = twin != MESO_NO_INDEX && twin < h ? search->edge[twin] : count++;
    }
    return count;
}

MesoStatus meso_strand_search_init(MesoStrandSearch *search, MesoArena *arena, const MesoStrandRule *rule,
                                   const MesoTileSet *set, const MesoVariantSet *variants,
                                   const MesoSlotGraph *graph, MesoError *error)
{
    bool shell = false;
    *search = (MesoStrandSearch){.rule = *rule, .graph = graph, .variants = variants, .set = set,
                                 .arena = arena};
    for (uint32_t i = 0; i < set->interface_count; i++)
        if (set->interfaces[i].section_count > search->stride)
            search->stride = set->interfaces[i].section_count;
    uint32_t slots = graph->slot_count;
    search->edge = MESO_NEW(arena, uint32_t, 4 * (size_t)slots, error);
    search->added = MESO_NEW(arena, uint8_t, slots, error);
    search->component = MESO_NEW(arena, uint32_t, slots, error);
    search->strand_count = MESO_NEW(arena, uint32_t, slots, error);
    search->finished_count = MESO_NEW(arena, uint32_t, slots, error);
    if (!search->edge || !search->added || !search->component || !search->strand_count ||
        !search->finished_count)
        return MESO_ERR_MEMORY;
    MesoStatus status = place_links(search, &shell, error);
    if (status)
        return status;
    meso_slot_graph_components(graph, search->component);
    uint64_t edges = number_edges(search);
    uint64_t joints = (edges + (shell ? 2 * (uint64_t)slots : 0)) * search->stride;
    if (joints >= MESO_NO_INDEX)
        return meso_fail(error, MESO_ERR_LIMIT, "too many cross-sections for a rule on strands: room for %llu is "
                         "needed", (unsigned long long)joints);
    search->shell_begin = (uint32_t)(edges * search->stride);
    search->finished = MESO_NEW(arena, uint8_t, joints, error);
    return search->finished ? meso_strand_forest_init(&search->forest, arena, (uint32_t)joints, error)
                            : MESO_ERR_MEMORY;
}

static MesoStatus remember(MesoStrandSearch *search, MesoStrandUndo undo, MesoError *error)
{
    if (search->trail_count == search->trail_capacity) {
        size_t capacity = search->trail_capacity ? 2 * search->trail_capacity : 1024;
        MesoStrandUndo *trail = MESO_NEW(search->arena, MesoStrandUndo, capacity, error);
        if (!trail)
            return MESO_ERR_MEMORY;
        if (search->trail_count)
            memcpy(trail, search->trail, search->trail_count * sizeof *trail);
        search->trail = trail;
        search->trail_capacity = capacity;
    }
    search->trail[search->trail_count++] = undo;
    return MESO_OK;
}

static MesoStatus remember_value(MesoStrandSearch *search, uint8_t kind, uint32_t value, MesoError *error)
{
    return remember(search, (MesoStrandUndo){.kind = kind, .value = value}, error);
}

static uint32_t joint_at(const MesoStrandSearch *search, uint32_t slot, uint32_t side, uint32_t section)
{
    if (side >= 4)
        return search->shell_begin + (2 * slot + side - 4) * search->stride + section;
    return search->edge[4 * (size_t)slot + side] * search->stride + section;
}

static MesoStrandNode *root_of(const MesoStrandSearch *search, uint32_t joint)
{
    return &search->forest.nodes[meso_strand_root(&search->forest, joint)];
}

/* The slot's joints wait for the slot across, or no longer wait for this one. */
static MesoStatus open_joints(MesoStrandSearch *search, uint32_t slot, uint32_t variant, MesoError *error)
{
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t twin = search->graph->twin[4 * (size_t)slot + k];
        if (twin == MESO_NO_INDEX || twin / 4 == slot)
            continue;
        uint32_t interface = meso_label_interface(search->variants->labels[4 * (size_t)variant + k]);
        bool closes = search->added[twin / 4];
        for (uint32_t i = 0; i < search->set->interfaces[interface].section_count; i++) {
            uint32_t joint = joint_at(search, slot, k, i);
            root_of(search, joint)->open += closes ? UINT32_MAX : 1;
            if (remember_value(search, closes ? UNDO_CLOSE : UNDO_OPEN, joint, error))
                return MESO_ERR_MEMORY;
        }
    }
    return MESO_OK;
}

/* Strands that a link joins, or the one that it begins. */
static uint32_t strands_gained(const MesoStrandNode *a, const MesoStrandNode *b)
{
    if (a == b)
        return a->links == 0;
    return 1u - (a->links > 0) - (b->links > 0);    /* modulo 2^32: -1 where two become one */
}

static MesoStatus add_links(MesoStrandSearch *search, uint32_t slot, uint32_t variant, bool *kept,
                            MesoError *error)
{
    for (uint32_t i = search->link_begin[variant]; i < search->link_begin[variant + 1]; i++) {
        const MesoVariantLink *link = &search->links[i];
        uint32_t a = joint_at(search, slot, link->side[0], link->section[0]);
        uint32_t b = joint_at(search, slot, link->side[1], link->section[1]);
        uint32_t gained = strands_gained(root_of(search, a), root_of(search, b));
        search->strand_count[search->component[slot]] += gained;
        MesoStrandUndo undo = {.kind = UNDO_LINK, .value = search->component[slot]};
        undo.step = meso_strand_link(&search->forest, a, b);
        if (remember(search, undo, error))
            return MESO_ERR_MEMORY;
        const MesoStrandNode *root = root_of(search, a);
        if ((search->rule.acyclic && meso_strand_cyclic(root)) ||
            (search->rule.max_length && root->links > search->rule.max_length))
            *kept = false;
    }
    return MESO_OK;
}

/* Judges the strand at `joint`, where it can grow no more. */
static MesoStatus judge_finished(MesoStrandSearch *search, uint32_t slot, uint32_t joint, bool *kept,
                                 MesoError *error)
{
    uint32_t root = meso_strand_root(&search->forest, joint);
    const MesoStrandNode *node = &search->forest.nodes[root];
    if (node->links == 0 || node->open || search->finished[root])
        return MESO_OK;
    if (search->rule.no_loops && meso_strand_ring(node))
        *kept = false;
    search->finished[root] = 1;
    search->finished_count[search->component[slot]]++;
    return remember(search, (MesoStrandUndo){.kind = UNDO_FINISH, .value = root,
                                             .step = {.a = search->component[slot]}}, error);
}

static MesoStatus judge(MesoStrandSearch *search, uint32_t slot, uint32_t variant, bool *kept, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 4 && !status; k++) {
        uint32_t interface = meso_label_interface(search->variants->labels[4 * (size_t)variant + k]);
        for (uint32_t i = 0; i < search->set->interfaces[interface].section_count && !status; i++)
            status = judge_finished(search, slot, joint_at(search, slot, k, i), kept, error);
    }
    for (uint32_t i = search->link_begin[variant]; i < search->link_begin[variant + 1] && !status; i++)
        status = judge_finished(search, slot, joint_at(search, slot, search->links[i].side[0],
                                                       search->links[i].section[0]), kept, error);
    uint32_t piece = search->component[slot];
    if (search->rule.connected && search->finished_count[piece] && search->strand_count[piece] > 1)
        *kept = false;
    return status;
}

MesoStatus meso_strand_search_add(MesoStrandSearch *search, uint32_t slot, uint32_t variant,
                                  bool *kept, MesoError *error)
{
    MesoStatus status = open_joints(search, slot, variant, error);
    search->added[slot] = 1;
    if (!status)
        status = remember_value(search, UNDO_SLOT, slot, error);
    if (!status)
        status = add_links(search, slot, variant, kept, error);
    return status ? status : judge(search, slot, variant, kept, error);
}

static void undo_link(MesoStrandSearch *search, const MesoStrandUndo *undo)
{
    meso_strand_unlink(&search->forest, undo->step);
    search->strand_count[undo->value] -= strands_gained(root_of(search, undo->step.a), root_of(search, undo->step.b));
}

void meso_strand_search_undo(MesoStrandSearch *search, size_t mark)
{
    while (search->trail_count > mark) {
        const MesoStrandUndo *undo = &search->trail[--search->trail_count];
        switch (undo->kind) {
        case UNDO_LINK:
            undo_link(search, undo);
            break;
        case UNDO_SLOT:
            search->added[undo->value] = 0;
            break;
        case UNDO_OPEN:
            root_of(search, undo->value)->open--;
            break;
        case UNDO_CLOSE:
            root_of(search, undo->value)->open++;
            break;
        default:
            search->finished[undo->value] = 0;
            search->finished_count[undo->step.a]--;
            break;
        }
    }
}

MesoStatus meso_strand_search_add_initial(MesoStrandSearch *search, const MesoPropagation *propagation,
                                          bool *kept, MesoError *error)
{
    const MesoDomainTable *domains = &propagation->domains;
    MesoStatus status = MESO_OK;
    for (uint32_t s = 0; s < propagation->graph->slot_count && !status; s++) {
        uint32_t state = propagation->initial[s];
        if (domains->domains[state].size == 1)
            status = meso_strand_search_add(search, s, meso_domain_variant(domains, state, 0), kept, error);
    }
    return status;
}

MesoStatus meso_strand_search_disproves(bool *disproved, MesoArena *arena, const MesoPropagation *propagation,
                                        const MesoVariantSet *variants,
                                        const MesoConstraints *constraints, MesoError *error)
{
    MesoStrandSearch search;
    bool kept = true;
    MesoStatus status = MESO_OK;
    if (meso_strand_rule_given(&constraints->strands)) {
        status = meso_strand_search_init(&search, arena, &constraints->strands, propagation->set, variants,
                                         propagation->graph, error);
        if (!status)
            status = meso_strand_search_add_initial(&search, propagation, &kept, error);
    }
    *disproved = !kept;
    return status;
}
