/*
 * Every connected way to glue the sides of up to six slots, with one another or not
 * at all, once: up to the numbers of the slots and up to which of its sides is a
 * slot's first. For the tests of this folder.
 *
 * A breadth-first walk from a side (the root) numbers the slots in the order in which
 * it meets them, and the sides of each from the one by which it comes in; so the
 * twins of all sides in that order, a border being its own twin, say all of the
 * gluing and of the root. Of the codes from its 4 n roots a gluing is listed under
 * the least. As many roots have that code as the gluing has symmetries, so that
 *
 *     sum over the gluings of  n! 4^n / symmetries
 *
 * is the number of connected involutions of n times four points.
 */
#ifndef MESO_SMALL_GRAPHS_H
#define MESO_SMALL_GRAPHS_H

#include "libcore/solve/solve_fixture.h"

enum { SMALL_SLOTS = 6, SMALL_SIDES = 4 * SMALL_SLOTS };

typedef struct SmallGraphs {
    uint32_t slot_count;
    void (*visit)(void *context, const uint32_t *twin, uint32_t symmetries);   /* twin [4 * slot_count] */
    void *context;
    uint32_t met;               /* slots met so far */
    uint32_t twin[SMALL_SIDES]; /* [4 * met] MESO_NO_INDEX where not yet said */
} SmallGraphs;

/* The code from `root`, compared with `twin` itself: as strcmp() would. */
static inline int small_graphs_compare(const uint32_t *twin, uint32_t slot_count, uint32_t root)
{
    uint32_t slot[SMALL_SLOTS] = {root / 4}, entry[SMALL_SLOTS], number[SMALL_SLOTS], met = 1;
    for (uint32_t s = 0; s < slot_count; s++)
        number[s] = MESO_NO_INDEX;
    number[root / 4] = 0;
    entry[0] = root % 4;
    for (uint32_t side = 0; side < 4 * slot_count; side++) {
        uint32_t from = 4 * slot[side / 4] + ((entry[side / 4] + side) & 3), to = twin[from], code = side;
        if (number[to / 4] == MESO_NO_INDEX) {
            number[to / 4] = met;
            slot[met] = to / 4;
            entry[met++] = to % 4;
        }
        if (to != from)
            code = 4 * number[to / 4] + ((to - entry[number[to / 4]]) & 3);
        if (code != twin[side])
            return code < twin[side] ? -1 : 1;
    }
    return 0;
}

/* Roots with the same code as the first; 0 where one has a lesser code. */
static inline uint32_t small_graphs_symmetries(const uint32_t *twin, uint32_t slot_count)
{
    uint32_t symmetries = 0;
    for (uint32_t root = 0; root < 4 * slot_count; root++) {
        int order = small_graphs_compare(twin, slot_count, root);
        if (order < 0)
            return 0;
        symmetries += order == 0;
    }
    return symmetries;
}

static inline void small_graphs_from(SmallGraphs *graphs, uint32_t side);

static inline void small_graphs_join(SmallGraphs *graphs, uint32_t side, uint32_t other)
{
    graphs->twin[side] = other;
    graphs->twin[other] = side;
    small_graphs_from(graphs, side + 1);
    graphs->twin[side] = graphs->twin[other] = MESO_NO_INDEX;
}

/* All codes that go on like this from `side` on. */
static inline void small_graphs_from(SmallGraphs *graphs, uint32_t side)
{
    while (side < 4 * graphs->met && graphs->twin[side] != MESO_NO_INDEX)
        side++;
    if (side == 4 * graphs->met) {
        uint32_t symmetries = graphs->met == graphs->slot_count
                                  ? small_graphs_symmetries(graphs->twin, graphs->slot_count) : 0;
        if (symmetries > 0)
            graphs->visit(graphs->context, graphs->twin, symmetries);
        return;
    }
    for (uint32_t other = side; other < 4 * graphs->met; other++)
        if (graphs->twin[other] == MESO_NO_INDEX)
            small_graphs_join(graphs, side, other);
    if (graphs->met < graphs->slot_count) {
        graphs->met++;
        small_graphs_join(graphs, side, 4 * graphs->met - 4);
        graphs->met--;
    }
}

/* Calls `visit` for each gluing of `slot_count` slots, in the order of their codes. */
static inline void small_graphs_list(uint32_t slot_count,
                                     void (*visit)(void *context, const uint32_t *twin, uint32_t symmetries),
                                     void *context)
{
    SmallGraphs graphs = {.slot_count = slot_count, .visit = visit, .context = context, .met = 1};
    for (uint32_t side = 0; side < SMALL_SIDES; side++)
        graphs.twin[side] = MESO_NO_INDEX;
    small_graphs_from(&graphs, 0);
}

/* The gluing as a slot graph in which slot s has its side k where the code has k + digit s of `turns` to the base 4. */
static inline MesoSlotGraph small_graph(MesoArena *arena, const uint32_t *twin, uint32_t slot_count, uint32_t turns)
{
    MesoSlotGraph graph = fixture_graph(arena, slot_count);
    for (uint32_t side = 0; side < 4 * slot_count; side++) {
        uint32_t other = twin[side], s = side / 4, t = other / 4;
        if (other > side)
            fixture_glue(&graph, s, (side - (turns >> 2 * s)) & 3, t, (other - (turns >> 2 * t)) & 3);
    }
    return graph;
}

static inline uint64_t small_graphs_involutions(uint32_t points)
{
    uint64_t last = 1, number = 1;
    for (uint32_t i = 2; i <= points; i++) {
        uint64_t next = number + (i - 1) * last;
        last = number;
        number = next;
    }
    return number;
}

/* Connected involutions of the sides of `slot_count` slots: all, less those in which fewer hang together
 * with the first. */
static inline uint64_t small_graphs_connected(uint32_t slot_count)
{
    uint64_t number = small_graphs_involutions(4 * slot_count), ways = 1;
    for (uint32_t k = 1; k < slot_count; k++) {
        number -= ways * small_graphs_connected(k) * small_graphs_involutions(4 * (slot_count - k));
        ways = ways * (slot_count - k) / k;     /* to choose k of the others */
    }
    return number;
}

#endif
