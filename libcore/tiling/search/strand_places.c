#include "libcore/tiling/search/strand_places.h"

#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grow.h"
#include "libcore/tiling/search/strand_search.h"

/*
 * Where strands end follows from the cross-sections alone. Sections that a sweep may join are one class: a strand has
 * joints of one class. On an edge the two sides show opposite signs of one interface; how many ends of sweeps come to
 * a joint there is a sum of what a side with + and one with - may bring, elsewhere what one side does. If all sums are
 * two (or none), every strand of the class is a ring, and has a cycle if none is one: a finite graph without loose
 * ends.
 */
enum { SIDE_PLUS, SIDE_MINUS, SIDE_ALONE, SIDE_KINDS };

typedef struct SectionUse {
    uint8_t ends[SIDE_KINDS];   /* bit n: a side may bring n ends of sweeps; bit 3: three or more */
    bool open;                  /* at a root: a strand of the class may end, or fork where that matters */
} SectionUse;

/* Slots that are alike here: one state, borders on the same sides. */
typedef struct PlaceKind {
    uint32_t slot;              /* one of them */
    uint32_t borders;           /* bit k: side k has no neighbour */
    uint64_t *allowed;          /* [words] variants of the state, less the forbidden */
    uint32_t mask;              /* number of `allowed` */
} PlaceKind;

typedef struct Places {
    const MesoPropagation *propagation;
    const MesoVariantSet *variants;
    MesoArena *arena;           /* of a round */
    MesoStrandSearch alone;     /* with one slot at a time */
    bool closing;               /* the rule minds rings or cycles */
    SectionUse *uses;           /* [section_count] on the piece at hand */
    uint32_t *classes;          /* [section_count] of them, as disjoint sets */
    uint32_t *kind_of;          /* [slot_count] */
    uint32_t *known;            /* [16 * states] kind plus 1 of the piece at hand, or an earlier one */
    PlaceKind *kinds;
    uint32_t kind_count, kind_capacity, piece_begin;    /* of the kinds: the first of the piece at hand */
    MesoInterner masks;
    bool found;
} Places;

static const MesoTile *tile_of(const Places *places, uint32_t variant)
{
    return &places->propagation->set->tiles[places->variants->tile[variant]];
}

static uint32_t count_ends(const MesoTileSet *set, const MesoTile *tile, uint32_t side, uint32_t section)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        const MesoSweep *sweep = &set->sweeps[tile->sweep_begin + i];
        count += sweep->from_side == side && sweep->from_section == section;
        count += sweep->to_side == side && sweep->to_section == section;
    }
    return count;
}

/* Adds what a variant may bring to joints, `side` being the tile's. */
static void use_side(const Places *places, const PlaceKind *kind, uint32_t variant, uint32_t side)
{
    const MesoTileSet *set = places->propagation->set;
    const MesoTile *tile = tile_of(places, variant);
    MesoTransform transform = places->variants->transform[variant];
    if (tile->labels[side] == 0)
        return;
    uint32_t place = meso_transform_side(transform, side);
    bool minus = (tile->labels[side] < 0) != meso_transform_flips(transform);
    bool alone = side >= 4 || kind->borders >> place & 1;
    const MesoInterface *interface = &set->interfaces[meso_label_interface(tile->labels[side])];
    for (uint32_t i = 0; i < interface->section_count; i++) {
        uint32_t section = interface->section_begin + i, ends = count_ends(set, tile, side, section);
        places->uses[section].ends[alone ? SIDE_ALONE : minus ? SIDE_MINUS : SIDE_PLUS] |=
            (uint8_t)(1u << (ends < 3 ? ends : 3));
    }
}

static void use_variant(const Places *places, const PlaceKind *kind, uint32_t variant)
{
    const MesoTile *tile = tile_of(places, variant);
    for (uint32_t side = 0; side < MESO_SIDE_COUNT; side++)
        use_side(places, kind, variant, side);
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        const MesoSweep *sweep = &places->propagation->set->sweeps[tile->sweep_begin + i];
        meso_sets_join(places->classes, sweep->from_section, sweep->to_section);
    }
}

/* Whether so many ends of sweeps at a joint leave a strand that is no ring, or has no cycle where none may be. */
static bool opens(const Places *places, uint32_t ends)
{
    return ends == 1 || (ends > 2 && !places->alone.rule.acyclic);
}

static bool section_opens(const Places *places, const SectionUse *use)
{
    bool open = false;
    for (uint32_t a = 0; a < 4; a++) {
        open |= use->ends[SIDE_ALONE] >> a & 1 && opens(places, a);
        for (uint32_t b = 0; b < 4; b++)
            open |= use->ends[SIDE_PLUS] >> a & use->ends[SIDE_MINUS] >> b & 1 && opens(places, a + b);
    }
    return open;
}

/* Whether the variant has a part of a strand that can but close. */
static bool closes(const Places *places, uint32_t variant)
{
    const MesoTile *tile = tile_of(places, variant);
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        uint32_t section = places->propagation->set->sweeps[tile->sweep_begin + i].from_section;
        if (!places->uses[meso_sets_root(places->classes, section)].open)
            return true;
    }
    return false;
}

static void forbid_closing(Places *places)
{
    uint32_t count = places->propagation->set->section_count, variant_count = places->variants->count;
    memset(places->uses, 0, count * sizeof *places->uses);
    meso_sets_init(places->classes, count);
    for (uint32_t k = places->piece_begin; k < places->kind_count; k++)
        for (uint32_t v = 0; v < variant_count; v++)
            if (meso_bits_test(places->kinds[k].allowed, v))
                use_variant(places, &places->kinds[k], v);
    for (uint32_t i = 0; i < count; i++)
        places->uses[meso_sets_root(places->classes, i)].open |= section_opens(places, &places->uses[i]);
    for (uint32_t k = places->piece_begin; k < places->kind_count; k++)
        for (uint32_t v = 0; v < variant_count; v++)
            if (meso_bits_test(places->kinds[k].allowed, v) && closes(places, v))
                meso_bits_clear(places->kinds[k].allowed, v);
}

/* Forbids what breaks the rule with no other slot added. */
static MesoStatus forbid_alone(Places *places, const PlaceKind *kind, MesoError *error)
{
    for (uint32_t v = 0; v < places->variants->count; v++) {
        bool kept = true;
        if (!meso_bits_test(kind->allowed, v))
            continue;
        if (meso_strand_search_add(&places->alone, kind->slot, v, &kept, error))
            return MESO_ERR_MEMORY;
        meso_strand_search_undo(&places->alone, 0);
        if (!kept)
            meso_bits_clear(kind->allowed, v);
    }
    return MESO_OK;
}

static MesoStatus add_kind(Places *places, uint32_t slot, uint32_t borders, MesoError *error)
{
    const MesoDomainTable *domains = &places->propagation->domains;
    uint32_t words = domains->states.word_count;
    places->kinds = MESO_GROW(places->arena, places->kinds, places->kind_count, places->kind_capacity, 64, error);
    if (!places->kinds)
        return MESO_ERR_MEMORY;
    PlaceKind *kind = &places->kinds[places->kind_count++];
    *kind = (PlaceKind){.slot = slot, .borders = borders, .allowed = MESO_NEW(places->arena, uint64_t, words, error)};
    if (!kind->allowed)
        return MESO_ERR_MEMORY;
    memcpy(kind->allowed, meso_domain_bits(domains, places->propagation->initial[slot]), words * sizeof *kind->allowed);
    return forbid_alone(places, kind, error);
}

/* A slot that is glued to itself is of a kind of its own. */
static MesoStatus place_slot(Places *places, uint32_t slot, MesoError *error)
{
    const uint32_t *twin = places->propagation->graph->twin + 4 * (size_t)slot;
    uint32_t borders = 0, unknown = 0;
    bool glued = false;
    for (uint32_t k = 0; k < 4; k++) {
        borders |= (uint32_t)(twin[k] == MESO_NO_INDEX) << k;
        glued |= twin[k] != MESO_NO_INDEX && twin[k] / 4 == slot;
    }
    uint32_t *known = glued ? &unknown : &places->known[16 * (size_t)places->propagation->initial[slot] + borders];
    if (*known <= places->piece_begin) {
        if (add_kind(places, slot, borders, error))
            return MESO_ERR_MEMORY;
        *known = places->kind_count;
    }
    places->kind_of[slot] = *known - 1;
    return MESO_OK;
}

/* The slots of a piece, begun where the last one ended. */
static MesoStatus go_through_piece(Places *places, const uint32_t *slots, uint32_t count, MesoError *error)
{
    const MesoDomainTable *domains = &places->propagation->domains;
    places->piece_begin = places->kind_count;
    for (uint32_t i = 0; i < count; i++)
        if (place_slot(places, slots[i], error))
            return MESO_ERR_MEMORY;
    if (places->closing)
        forbid_closing(places);
    for (uint32_t k = places->piece_begin; k < places->kind_count; k++) {
        PlaceKind *kind = &places->kinds[k];
        uint32_t left = meso_bits_count(kind->allowed, domains->states.word_count);
        places->found |= left < domains->domains[places->propagation->initial[kind->slot]].size;
        kind->mask = meso_interner_add(&places->masks, places->arena, kind->allowed, error);
        if (kind->mask == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/* Slots by number of their group, which is below `group_count`; begin[group_count + 1] says where each begins. */
static void sort_slots(const uint32_t *group, uint32_t slot_count, uint32_t group_count, uint32_t *begin,
                       uint32_t *slots)
{
    for (uint32_t s = 0; s < slot_count; s++)
        begin[group[s]]++;
    for (uint32_t g = 1; g <= group_count; g++)
        begin[g] += begin[g - 1];
    for (uint32_t s = slot_count; s-- > 0;)
        slots[--begin[group[s]]] = s;
}

/* What is left in each slot, as restrictions: one for each set of variants. */
static MesoStatus restrict_slots(Places *places, MesoConstraints *constraints, MesoArena *arena, MesoError *error)
{
    uint32_t slots = places->propagation->graph->slot_count, sets = places->masks.count;
    uint32_t words = places->masks.word_count, old = constraints->restriction_count;
    MesoRestriction *restrictions = MESO_NEW(arena, MesoRestriction, old + (size_t)sets, error);
    uint64_t *allowed = MESO_NEW(arena, uint64_t, (size_t)sets * words, error);
    uint32_t *sorted = MESO_NEW(arena, uint32_t, slots, error);
    uint32_t *begin = MESO_NEW(arena, uint32_t, sets + (size_t)1, error);
    if (!restrictions || !allowed || !sorted || !begin)
        return MESO_ERR_MEMORY;
    if (old)
        memcpy(restrictions, constraints->restrictions, old * sizeof *restrictions);
    memcpy(allowed, places->masks.bits, (size_t)sets * words * sizeof *allowed);
    for (uint32_t s = 0; s < slots; s++)
        places->kind_of[s] = places->kinds[places->kind_of[s]].mask;
    sort_slots(places->kind_of, slots, sets, begin, sorted);
    for (uint32_t i = 0; i < sets; i++)
        restrictions[old + i] = (MesoRestriction){.place_count = begin[i + 1] - begin[i], .places = sorted + begin[i],
                                                  .allowed = allowed + (size_t)i * words};
    constraints->restrictions = restrictions;
    constraints->restriction_count = old + sets;
    return MESO_OK;
}

static MesoStatus go_through_pieces(Places *places, MesoError *error)
{
    const MesoSlotGraph *graph = places->propagation->graph;
    uint32_t *component = MESO_NEW(places->arena, uint32_t, graph->slot_count, error);
    uint32_t *slots = MESO_NEW(places->arena, uint32_t, graph->slot_count, error);
    uint32_t *begin = MESO_NEW(places->arena, uint32_t, graph->slot_count + (size_t)1, error);
    if (!component || !slots || !begin)
        return MESO_ERR_MEMORY;
    uint32_t pieces = meso_slot_graph_components(graph, component);
    sort_slots(component, graph->slot_count, pieces, begin, slots);
    MesoStatus status = MESO_OK;
    for (uint32_t p = 0; p < pieces && !status; p++)
        status = go_through_piece(places, slots + begin[p], begin[p + 1] - begin[p], error);
    return status;
}

/* Adds to `constraints`, in `arena`, what the rule forbids beyond the initial states of `propagation`. */
static MesoStatus forbid(MesoConstraints *constraints, bool *found, const MesoPropagation *propagation,
                         const MesoVariantSet *variants, MesoArena *arena, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    const MesoStrandRule *rule = &constraints->strands;
    Places places = {.propagation = propagation, .variants = variants, .arena = &scratch,
                     .closing = rule->acyclic || rule->no_loops,
                     .masks = {.word_count = propagation->domains.states.word_count}};
    places.uses = MESO_NEW(&scratch, SectionUse, propagation->set->section_count, error);
    places.classes = MESO_NEW(&scratch, uint32_t, propagation->set->section_count, error);
    places.kind_of = MESO_NEW(&scratch, uint32_t, propagation->graph->slot_count, error);
    places.known = MESO_NEW(&scratch, uint32_t, 16 * (size_t)propagation->domains.states.count, error);
    bool room = places.uses && places.classes && places.kind_of && places.known;
    MesoStatus status = room ? MESO_OK : MESO_ERR_MEMORY;
    if (!status)
        status = meso_strand_search_init(&places.alone, &scratch, rule, propagation->set, variants,
                                         propagation->graph, error);
    if (!status)
        status = go_through_pieces(&places, error);
    if (!status && places.found)
        status = restrict_slots(&places, constraints, arena, error);
    *found = places.found;
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_strand_places_init(MesoPropagation *propagation, MesoArena *arena,
                                   const MesoTilingProblem *problem, MesoError *error)
{
    const MesoConstraints *constraints = problem->constraints;
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoStatus status = meso_propagation_init(propagation, arena, problem, error);
    if (status || !constraints || !meso_strand_rule_given(&constraints->strands))
        return status;
    MesoConstraints more = *constraints;
    MesoTilingProblem narrowed = *problem;
    narrowed.constraints = &more;
    MesoArena kept;
    bool found = true;
    meso_arena_init(&kept);
    while (!status && propagation->initial_dead_count == 0 && propagation->broken_quota == MESO_NO_INDEX) {
        status = forbid(&more, &found, propagation, problem->variants, &kept, error);
        if (status || !found)
            break;
        meso_propagation_release(propagation);
        meso_arena_rewind(arena, mark);
        status = meso_propagation_init(propagation, arena, &narrowed, error);
    }
    meso_arena_release(&kept);
    return status;
}
