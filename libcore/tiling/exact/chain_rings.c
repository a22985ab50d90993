#include "libcore/tiling/exact/chain_rings.h"

#include <string.h>

/* Bits of one side that wires may run from; others are left out. */
enum { MOST_SIDE_BITS = 6 };

/* Together some 300 MB with the joints, most of it while rings are built. */
enum { MOST_SETTINGS = 1 << 17, MOST_CASES = 1 << 22 };

/* What one side shows under a setting: ranks of labels as in MesoChainLink, and the wires that tell of them. */
typedef struct Side {
    uint64_t shown;
    uint32_t bit_count;
    uint32_t wire[MOST_SIDE_BITS];      /* that tells whether the label is one of `ranks`; 2 * number, or + 1 */
    uint64_t ranks[MOST_SIDE_BITS];     /* without the lowest one shown */
} Side;

typedef struct Setting {
    uint32_t wire_count;
    Side sides[4];
} Setting;

/* Ranks that a pattern shows, one bit a side; 1 on borders. */
typedef struct Pattern {
    uint64_t shown[4];
} Pattern;

typedef struct Builder {
    MesoChainRings *rings;
    const MesoPropagation *propagation;
    MesoLabelPatternTable *table;
    const MesoEdgeChains *chains;
    MesoArena scratch;
    uint32_t *link_begin;       /* [4 * slot_count + 1] into links, by edge */
    const MesoChainLink **links;
    Pattern *patterns, *left;   /* [variants] of the slot at hand, and under a setting */
    uint32_t pattern_count;
    Setting **settings;         /* [slot_count] */
    uint32_t *first_wire;       /* [slot_count] */
} Builder;

/* The lower half-edge of a side's edge, or MESO_NO_INDEX on a border. */
static uint32_t edge_of(const Builder *builder, uint32_t half_edge)
{
    uint32_t twin = builder->propagation->graph->twin[half_edge];
    return twin == MESO_NO_INDEX || twin < half_edge ? twin : half_edge;
}

static MesoStatus sort_links(Builder *builder, MesoError *error)
{
    const MesoEdgeChains *chains = builder->chains;
    uint32_t edges = 4 * builder->propagation->graph->slot_count;
    builder->link_begin = MESO_NEW(&builder->scratch, uint32_t, (size_t)edges + 2, error);
    builder->links = MESO_NEW(&builder->scratch, const MesoChainLink *, chains->link_count, error);
    if (!builder->link_begin || !builder->links)
        return MESO_ERR_MEMORY;
    uint32_t *next = builder->link_begin + 1;
    for (uint32_t i = 0; i < chains->link_count; i++)
        next[chains->links[i].edge + 1]++;
    for (uint32_t e = 0; e < edges; e++)
        next[e + 1] += next[e];
    for (uint32_t i = 0; i < chains->link_count; i++)
        builder->links[next[chains->links[i].edge]++] = &chains->links[i];
    return MESO_OK;
}

/* Number of `chain` among those that meet the slot; it is one of them from here on. False: there is no room. */
static bool meet_chain(MesoRingSlot *slot, uint32_t chain, uint32_t *number)
{
    for (*number = 0; *number < slot->chain_count; ++*number)
        if (slot->chain[*number] == chain)
            return true;
    if (slot->chain_count == MESO_CHAIN_RINGS_SLOT_CHAINS)
        return false;
    slot->chain[slot->chain_count++] = chain;
    return true;
}

static bool find_chains(Builder *builder, uint32_t slot)
{
    bool room = true;
    uint32_t number;
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t edge = edge_of(builder, 4 * slot + k);
        if (edge == MESO_NO_INDEX)
            continue;
        for (uint32_t i = builder->link_begin[edge]; i < builder->link_begin[edge + 1] && room; i++)
            room = meet_chain(&builder->rings->slots[slot], builder->links[i]->chain, &number);
    }
    return room;
}

/* The ranks of what `code` on a side is at its edge: one bit; all patterns are alike where there are too many. */
static uint64_t rank_bit(const Builder *builder, uint32_t half_edge, uint32_t code)
{
    uint32_t edge = edge_of(builder, half_edge);
    if (edge == MESO_NO_INDEX)
        return 1;
    uint32_t rank = meso_bits_rank(meso_propagation_labels(builder->propagation, edge),
                                   edge == half_edge ? code ^ 1 : code);
    return meso_propagation_label_count(builder->propagation, edge) > 64 ? 1 : (uint64_t)1 << rank;
}

static MesoStatus read_patterns(Builder *builder, uint32_t slot, MesoError *error)
{
    const MesoLabelPatternList *list = meso_label_pattern_list(builder->table, slot, error);
    if (!list)
        return MESO_ERR_MEMORY;
    builder->pattern_count = list->count;
    for (uint32_t p = 0; p < list->count; p++)
        for (uint32_t k = 0; k < 4; k++)
            builder->patterns[p].shown[k] = rank_bit(builder, 4 * slot + k, list->codes[4 * (size_t)p + k]);
    return MESO_OK;
}

/* The ranks that the chains of a side's edge leave there. */
static uint64_t ranks_left(const Builder *builder, uint32_t slot, uint32_t side, uint32_t setting)
{
    MesoRingSlot *ring_slot = &builder->rings->slots[slot];
    uint32_t edge = edge_of(builder, 4 * slot + side), number = 0;
    uint64_t ranks = UINT64_MAX;
    if (edge == MESO_NO_INDEX)
        return ranks;
    for (uint32_t i = builder->link_begin[edge]; i < builder->link_begin[edge + 1]; i++) {
        const MesoChainLink *link = builder->links[i];
        meet_chain(ring_slot, link->chain, &number);
        ranks &= (bool)(setting >> number & 1) != link->negated ? link->ranks : ~link->ranks;
    }
    return ranks;
}

/* Patterns under a setting go to `left`, and what they show to `sides`. Returns their number. */
static uint32_t filter_patterns(Builder *builder, uint32_t slot, uint32_t number, Setting *setting)
{
    uint64_t ranks[4];
    uint32_t count = 0;
    for (uint32_t k = 0; k < 4; k++)
        ranks[k] = ranks_left(builder, slot, k, number);
    for (uint32_t p = 0; p < builder->pattern_count; p++) {
        const uint64_t *shown = builder->patterns[p].shown;
        if (!(shown[0] & ranks[0]) || !(shown[1] & ranks[1]) || !(shown[2] & ranks[2]) || !(shown[3] & ranks[3]))
            continue;
        builder->left[count++] = builder->patterns[p];
        for (uint32_t k = 0; k < 4; k++)
            setting->sides[k].shown |= shown[k];
    }
    return count;
}

/* Ranks of two sides, joined where a pattern shows both: pieces[..][0] tells pieces[..][1]. Returns their number. */
static uint32_t find_pieces(const Pattern *patterns, uint32_t count, uint32_t from, uint32_t to, uint64_t (*pieces)[2])
{
    uint32_t piece_count = 0;
    for (uint32_t p = 0; p < count; p++) {
        uint64_t a = patterns[p].shown[from], b = patterns[p].shown[to];
        for (uint32_t i = piece_count; i-- > 0;)
            if ((pieces[i][0] & a) || (pieces[i][1] & b)) {
                a |= pieces[i][0];
                b |= pieces[i][1];
                piece_count--;
                pieces[i][0] = pieces[piece_count][0];
                pieces[i][1] = pieces[piece_count][1];
            }
        pieces[piece_count][0] = a;
        pieces[piece_count++][1] = b;
    }
    return piece_count;
}

/* The wire of the bit "one of `ranks`", which has one from here on; MESO_NO_INDEX where there is no room. */
static uint32_t get_wire(Setting *setting, Side *side, uint64_t ranks)
{
    uint32_t negated = (ranks & side->shown & -side->shown) != 0;
    if (negated)
        ranks = side->shown & ~ranks;
    for (uint32_t i = 0; i < side->bit_count; i++)
        if (side->ranks[i] == ranks)
            return side->wire[i] ^ negated;
    if (side->bit_count == MOST_SIDE_BITS)
        return MESO_NO_INDEX;
    side->ranks[side->bit_count] = ranks;
    side->wire[side->bit_count] = 2 * setting->wire_count++;
    return side->wire[side->bit_count++] ^ negated;
}

/* Calls wire `old` by the other name `name`. */
static void rename_wire(Setting *setting, uint32_t old, uint32_t name)
{
    for (uint32_t k = 0; k < 4; k++)
        for (uint32_t i = 0; i < setting->sides[k].bit_count; i++) {
            uint32_t *wire = &setting->sides[k].wire[i];
            if (*wire / 2 == old / 2)
                *wire = name ^ ((*wire ^ old) & 1);
        }
}

/* Makes two wires one; false where they are opposites. */
static bool merge_wires(Setting *setting, uint32_t a, uint32_t b)
{
    if (a == MESO_NO_INDEX || b == MESO_NO_INDEX || a == b)
        return true;
    if (a / 2 == b / 2)
        return false;
    uint32_t last = 2 * --setting->wire_count;
    rename_wire(setting, b, a);
    if (b / 2 != last / 2)
        rename_wire(setting, last, b & ~1u);
    return true;
}

/* Wires between two sides: of the pieces, all sums but for opposites, or each alone where there are many. */
static bool join_sides(Setting *setting, const Pattern *patterns, uint32_t count, uint32_t from, uint32_t to)
{
    uint64_t pieces[64][2];
    uint32_t piece_count = find_pieces(patterns, count, from, to, pieces);
    bool all_sums = piece_count <= MESO_EDGE_CHAINS_SUMMED, fits = true;
    if (piece_count == 1)
        return true;
    uint64_t end = all_sums ? (uint64_t)1 << (piece_count - 1) : piece_count;
    for (uint64_t sum = all_sums; sum < end && fits; sum++) {
        uint64_t a = 0, b = 0;
        for (uint32_t i = 0; i < piece_count; i++)
            if (all_sums ? sum >> i & 1 : sum == i) {
                a |= pieces[i][0];
                b |= pieces[i][1];
            }
        uint32_t wire = get_wire(setting, &setting->sides[from], a);
        fits = merge_wires(setting, wire, get_wire(setting, &setting->sides[to], b));
    }
    return fits;
}

/* False where no pattern is left, or they contradict themselves. */
static bool build_setting(Builder *builder, uint32_t slot, uint32_t number, Setting *setting)
{
    uint32_t count = filter_patterns(builder, slot, number, setting);
    bool fits = count > 0;
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = i + 1; j < 4 && fits; j++)
            fits = join_sides(setting, builder->left, count, i, j);
    return fits;
}

static MesoStatus build_settings(Builder *builder, uint32_t slot, MesoError *error)
{
    MesoChainRings *rings = builder->rings;
    MesoRingSlot *ring_slot = &rings->slots[slot];
    uint32_t count = 1u << ring_slot->chain_count, most = 0;
    Setting *settings = MESO_NEW(&builder->scratch, Setting, count, error);
    if (!settings || read_patterns(builder, slot, error))
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        if (!build_setting(builder, slot, i, &settings[i]))
            ring_slot->dead |= (uint64_t)1 << i;
        most = settings[i].wire_count > most ? settings[i].wire_count : most;
    }
    builder->settings[slot] = settings;
    builder->first_wire[slot] = rings->wire_count;
    rings->wire_count += most;
    return MESO_OK;
}

/* Wires of two sides of one edge that tell the same of its label, or the opposite. Returns how many there are. */
static uint32_t join_edge(const Side *a, uint32_t first_a, const Side *b, uint32_t first_b, MesoRingJoint *joints)
{
    uint64_t both = a->shown & b->shown;
    uint32_t count = 0;
    for (uint32_t i = 0; i < a->bit_count; i++)
        for (uint32_t j = 0; j < b->bit_count; j++) {
            uint64_t ranks = a->ranks[i] & both, other = b->ranks[j] & both;
            bool same = ranks == other, opposite = ranks == (both & ~other);
            if (ranks == 0 || ranks == both || !(same || opposite))
                continue;
            if (joints)
                joints[count] = (MesoRingJoint){{2 * first_a + a->wire[i], (2 * first_b + b->wire[j]) ^ opposite}};
            count++;
        }
    return count;
}

/* Joints of all cases of an edge; they go to `joints`, unless that is NULL. Returns how many there are. */
static uint32_t join_cases(const Builder *builder, uint32_t half_edge, uint32_t *case_begin, uint32_t count,
                           MesoRingJoint *joints)
{
    uint32_t twin = builder->propagation->graph->twin[half_edge], a = half_edge / 4, b = twin / 4;
    const MesoRingSlot *slots = builder->rings->slots;
    for (uint32_t i = 0; i < 1u << slots[a].chain_count; i++)
        for (uint32_t j = 0; j < 1u << slots[b].chain_count; j++) {
            *case_begin++ = count;
            if ((slots[a].dead >> i & 1) == 0 && (slots[b].dead >> j & 1) == 0)
                count += join_edge(&builder->settings[a][i].sides[half_edge % 4], builder->first_wire[a],
                                   &builder->settings[b][j].sides[twin % 4], builder->first_wire[b],
                                   joints ? joints + count : NULL);
        }
    *case_begin = count;
    return count;
}

static uint32_t join_all(const Builder *builder, MesoRingJoint *joints)
{
    MesoChainRings *rings = builder->rings;
    uint32_t count = 0;
    for (uint32_t e = 0, h = 0; e < rings->edge_count; h++)
        if (edge_of(builder, h) == h) {
            count = join_cases(builder, h, rings->case_begin + rings->edges[e].first_case, count, joints);
            e++;
        }
    return count;
}

/* Numbers edges and their cases. */
static MesoStatus number_edges(Builder *builder, MesoArena *arena, MesoError *error)
{
    MesoChainRings *rings = builder->rings;
    uint32_t half_edges = 4 * rings->slot_count, count = 0;
    uint64_t cases = 0;
    rings->edges = MESO_NEW(arena, MesoRingEdge, half_edges / 2, error);
    if (!rings->edges)
        return MESO_ERR_MEMORY;
    for (uint32_t h = 0; h < half_edges && rings->possible; h++) {
        if (edge_of(builder, h) != h)
            continue;
        uint32_t a = h / 4, b = builder->propagation->graph->twin[h] / 4;
        rings->edges[count++] = (MesoRingEdge){{a, b}, (uint32_t)cases};
        cases += (uint64_t)1 << (rings->slots[a].chain_count + rings->slots[b].chain_count);
        rings->possible = cases <= MOST_CASES;
    }
    rings->edge_count = count;
    rings->case_begin = MESO_NEW(arena, uint32_t, rings->possible ? (size_t)cases + 1 : 0, error);
    return rings->case_begin ? MESO_OK : MESO_ERR_MEMORY;
}

static void count_chains(Builder *builder)
{
    MesoChainRings *rings = builder->rings;
    uint64_t settings = 0;
    for (uint32_t s = 0; s < rings->slot_count && rings->possible; s++) {
        rings->possible = find_chains(builder, s);
        settings += (uint64_t)1 << rings->slots[s].chain_count;
        rings->possible &= settings <= MOST_SETTINGS;
    }
}

static MesoStatus allocate(Builder *builder, MesoArena *arena, MesoError *error)
{
    MesoChainRings *rings = builder->rings;
    uint32_t variants = builder->propagation->domains.variant_count;
    rings->slots = MESO_NEW(arena, MesoRingSlot, rings->slot_count, error);
    rings->setting = MESO_NEW(arena, uint32_t, rings->slot_count, error);
    builder->patterns = MESO_NEW(&builder->scratch, Pattern, variants, error);
    builder->left = MESO_NEW(&builder->scratch, Pattern, variants, error);
    builder->settings = MESO_NEW(&builder->scratch, Setting *, rings->slot_count, error);
    builder->first_wire = MESO_NEW(&builder->scratch, uint32_t, rings->slot_count, error);
    bool allocated = rings->slots && rings->setting && builder->patterns && builder->left && builder->settings &&
                     builder->first_wire;
    return allocated ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus build(Builder *builder, MesoArena *arena, MesoError *error)
{
    MesoChainRings *rings = builder->rings;
    if (allocate(builder, arena, error) || sort_links(builder, error))
        return MESO_ERR_MEMORY;
    count_chains(builder);
    if (!rings->possible)
        return MESO_OK;
    for (uint32_t s = 0; s < rings->slot_count; s++)
        if (build_settings(builder, s, error))
            return MESO_ERR_MEMORY;
    if (number_edges(builder, arena, error))
        return MESO_ERR_MEMORY;
    if (!rings->possible)
        return MESO_OK;
    rings->joints = MESO_NEW(arena, MesoRingJoint, join_all(builder, NULL), error);
    rings->parent = MESO_NEW(arena, uint32_t, rings->wire_count, error);
    if (!rings->joints || !rings->parent)
        return MESO_ERR_MEMORY;
    join_all(builder, rings->joints);
    return MESO_OK;
}

MesoStatus meso_chain_rings_build(MesoChainRings *rings, MesoArena *arena, MesoLabelPatternTable *table,
                                  const MesoEdgeChains *chains, MesoError *error)
{
    *rings = (MesoChainRings){.possible = chains->chain_count > 0, .chain_count = chains->chain_count,
                              .slot_count = table->propagation->graph->slot_count};
    Builder builder = {.rings = rings, .propagation = table->propagation, .table = table, .chains = chains};
    if (!rings->possible)
        return MESO_OK;
    meso_arena_init(&builder.scratch);
    MesoStatus status = build(&builder, arena, error);
    meso_arena_release(&builder.scratch);
    return status;
}

/* The wire that stands for `wire`, or its opposite; halves the way there. */
static uint32_t find_wire(uint32_t *parent, uint32_t wire)
{
    for (;;) {
        uint32_t next = parent[wire / 2] ^ (wire & 1);
        if (next / 2 == wire / 2)
            return wire;
        uint32_t after = parent[next / 2] ^ (next & 1);
        parent[wire / 2] = after ^ (wire & 1);
        wire = after;
    }
}

MesoRingCount meso_chain_rings_count(MesoChainRings *rings, const bool *values)
{
    MesoRingCount count = {0};
    for (uint32_t w = 0; w < rings->wire_count; w++)
        rings->parent[w] = 2 * w;
    for (uint32_t s = 0; s < rings->slot_count; s++) {
        const MesoRingSlot *slot = &rings->slots[s];
        uint32_t setting = 0;
        for (uint32_t i = 0; i < slot->chain_count; i++)
            setting |= (uint32_t)values[slot->chain[i]] << i;
        rings->setting[s] = setting;
        count.contradictions += (uint32_t)(slot->dead >> setting & 1);
    }
    for (uint32_t e = 0; e < rings->edge_count; e++) {
        const MesoRingEdge *edge = &rings->edges[e];
        uint32_t low = rings->slots[edge->slot[1]].chain_count;
        const uint32_t *begin = rings->case_begin + edge->first_case +
                                (rings->setting[edge->slot[0]] << low | rings->setting[edge->slot[1]]);
        for (uint32_t j = begin[0]; j < begin[1]; j++) {
            uint32_t a = find_wire(rings->parent, rings->joints[j].wire[0]);
            uint32_t b = find_wire(rings->parent, rings->joints[j].wire[1]);
            if (a / 2 != b / 2) {
                rings->parent[a / 2] = b ^ (a & 1);
                continue;
            }
            count.rings++;
            count.contradictions += a != b;
        }
    }
    return count;
}
