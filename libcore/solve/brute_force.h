/* All assignments of a small graph, by trying everything: for the tests of this folder. */
#ifndef MESO_BRUTE_FORCE_H
#define MESO_BRUTE_FORCE_H

#include "libcore/solve/solve_fixture.h"

enum { BRUTE_FORCE_SLOTS = 16 };

typedef struct BruteForce {
    const MesoTileSet *set;
    const MesoSlotGraph *graph;
    MesoVariantSet variants;
    uint32_t chosen[BRUTE_FORCE_SLOTS];
    uint64_t count;             /* assignments found */
    uint64_t most;              /* stops there */
    uint64_t *numbers;          /* [most] see brute_force_number(); NULL for none */
} BruteForce;

/* An assignment as a number, by its variants. */
static inline uint64_t brute_force_number(const BruteForce *force, const uint32_t *variant)
{
    uint64_t number = 0;
    for (uint32_t s = force->graph->slot_count; s-- > 0;)
        number = number * force->variants.count + variant[s];
    return number;
}

static inline bool brute_force_fits(const BruteForce *force, uint32_t slot)
{
    bool fits = true;
    for (uint32_t k = 0; k < 4; k++) {
        int32_t label = force->variants.labels[4 * force->chosen[slot] + k];
        const MesoInterface *interface = &force->set->interfaces[meso_label_interface(label)];
        uint32_t twin = force->graph->twin[4 * slot + k];
        if (twin == MESO_NO_INDEX)
            fits &= !interface->border_exempt;
        else
            fits &= !interface->border_only &&
                    (twin / 4 > slot ||
                     label == -force->variants.labels[4 * force->chosen[twin / 4] + twin % 4]);
    }
    return fits;
}

/* Tries everything from `slot` on, looking at labels alone. */
static inline void brute_force_from(BruteForce *force, uint32_t slot)
{
    if (slot == force->graph->slot_count) {
        if (force->numbers)
            force->numbers[force->count] = brute_force_number(force, force->chosen);
        force->count++;
        return;
    }
    for (uint32_t v = 0; v < force->variants.count && force->count < force->most; v++) {
        force->chosen[slot] = v;
        if (brute_force_fits(force, slot))
            brute_force_from(force, slot + 1);
    }
}

/* Finds up to `most` assignments; their numbers go to the arena where `numbers` is true. */
static inline BruteForce brute_force(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph,
                                     uint64_t most, bool numbers)
{
    BruteForce force = {.set = set, .graph = graph, .most = most};
    CHECK(graph->slot_count <= BRUTE_FORCE_SLOTS);
    CHECK(meso_variant_set_build(&force.variants, arena, set, NULL) == MESO_OK);
    force.numbers = numbers ? MESO_NEW(arena, uint64_t, most, NULL) : NULL;
    brute_force_from(&force, 0);
    return force;
}

/* The number of an assignment that a solver found. */
static inline uint64_t brute_force_find(const BruteForce *force, const MesoAssignment *assignment)
{
    uint32_t variant[BRUTE_FORCE_SLOTS];
    for (uint32_t s = 0; s < assignment->slot_count; s++) {
        variant[s] = 0;
        while (force->variants.tile[variant[s]] != assignment->tile[s] ||
               force->variants.transform[variant[s]] != assignment->transform[s])
            variant[s]++;
    }
    return brute_force_number(force, variant);
}

#endif
