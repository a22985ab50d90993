/* Which sections of both sides of a seam are one strand's, and how they come together. */
#include "libcore/quilt/quilt_work.h"

#include <stdlib.h>

/* Sections are one where their lengths differ by less than this factor. */
#define LENGTH_RATIO 2.0f

/* Thin strands reach as far as others: so many steps from ring to ring. */
#define THIN_STEPS 2.5f

/* What a strand less costs, in squares of a quarter of a section's usual length. */
#define NO_PARTNER 40.0f

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The middle one of all sections' lengths: that of a strand cut across. `lengths` has room for them. */
static float usual_length(float *lengths, const MesoStrandSide *old_side, const MesoStrandSide *new_side)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < old_side->section_count; i++)
        lengths[count++] = old_side->sections[i].length;
    for (uint32_t j = 0; j < new_side->section_count; j++)
        lengths[count++] = new_side->sections[j].length;
    qsort(lengths, count, sizeof *lengths, compare_floats);
    return count ? lengths[count / 2] : 0;
}

/*
 * How far a section lies beside the other one's way; INFINITY where they cannot be one. Strands that are cut along have
 * long sections, which must not reach further for that.
 */
static float distance_beside(const MesoSection *a, MesoVec3 a_axis, const MesoSection *b, MesoVec3 b_axis, float reach,
                             float usual, float least)
{
    float larger = a->reach > b->reach ? a->reach : b->reach, most = 0.25f * usual;
    larger = larger < most ? larger : most;
    larger = larger > least ? larger : least;
    if (a->length > LENGTH_RATIO * b->length || b->length > LENGTH_RATIO * a->length)
        return INFINITY;
    MesoVec3 apart = meso_vec3_sub(b->centre, a->centre);
    if (meso_vec3_length(apart) > 2 * reach * larger + a->reach)
        return INFINITY;
    if (meso_vec3_dot(a_axis, b_axis) > -0.3f)
        return INFINITY;    /* they run past each other */
    MesoVec3 axis = meso_vec3_unit(meso_vec3_sub(a_axis, b_axis), a_axis);
    MesoVec3 beside = meso_vec3_mad(apart, -meso_vec3_dot(apart, axis), axis);
    float distance = meso_vec3_length(beside);
    return distance <= reach * larger ? distance : INFINITY;
}

/* What ends or is cut along, in strands: sections without partner, and how much longer than usual the others are. */
static float count_flaws(const MesoStrandSide *side, float usual)
{
    float flaws = 0;
    for (uint32_t s = 0; s < side->section_count; s++) {
        float length = usual > 0 ? side->sections[s].length / usual : 1;
        if (side->partners[s] == MESO_NO_INDEX)
            flaws += length;
        else
            flaws += length > 1.5f ? length - 1.5f : 0;
    }
    return flaws;
}

typedef struct Pairing {
    MesoStrandSide *old_side, *new_side;
    const MesoRingShares *shares;
    const MesoStrandRings *old_rings, *new_rings;
} Pairing;

/*
 * What both sections of a pair are to move by, so that strands meet. Beside their way as their rings say, each of which
 * knows where the other side has its strand; else each goes on along its axis to the middle between both. And along it,
 * so that it is a step from one to the other.
 */
static void find_moves(const Pairing *p, uint32_t i, uint32_t j)
{
    MesoVec3 a = p->old_side->axes[i], b = p->new_side->axes[j];
    MesoVec3 axis = meso_vec3_unit(meso_vec3_sub(a, b), a);
    MesoVec3 apart = meso_vec3_sub(p->new_side->sections[j].centre, p->old_side->sections[i].centre);
    uint32_t old_ring = p->old_side->rings[i], new_ring = p->new_side->rings[j];
    float along = meso_vec3_dot(apart, axis), step = 0.5f * (p->old_rings->steps[old_ring] + p->new_rings->steps[new_ring]);
    MesoVec3 beside = meso_vec3_mad(apart, -0.5f * along, meso_vec3_sub(a, b));
    if (p->shares->old_has[old_ring] && p->shares->new_has[new_ring])
        beside = meso_vec3_scale(meso_vec3_sub(p->shares->old_ways[old_ring], p->shares->new_ways[new_ring]), 0.5f);
    beside = meso_vec3_mad(beside, -meso_vec3_dot(beside, axis), axis);
    MesoVec3 nearer = meso_vec3_scale(axis, 0.5f * (along - step));
    p->old_side->moves[i] = meso_vec3_mad(nearer, 0.5f, beside);
    p->new_side->moves[j] = meso_vec3_scale(p->old_side->moves[i], -1);
    p->old_side->turns[i] = axis;
    p->new_side->turns[j] = meso_vec3_scale(axis, -1);
    p->old_side->besides[i] = beside;
    p->new_side->besides[j] = meso_vec3_scale(beside, -1);
}

/* ---- assignment ---- */

/* Two sections that may be a pair, and what that costs. */
typedef struct Link {
    uint32_t old_section, new_section;
    float cost;
} Link;

typedef struct Assignment {
    MesoStrandSide *old_side, *new_side;
    Link *links;
    size_t link_count;
    float *costs;               /* [new sections] of the cheapest way there from a free old one */
    uint32_t *before;           /* [new sections] the last link of that way */
    float *pair_costs;          /* [old sections] of the link to the partner */
} Assignment;

/* Cheapest alternating ways from free old sections to all new ones (Bellman and Ford). */
static void find_ways(Assignment *a)
{
    for (uint32_t j = 0; j < a->new_side->section_count; j++)
        a->costs[j] = INFINITY;
    bool changed = true;
    for (uint32_t round = 0; changed && round <= a->old_side->section_count; round++) {
        changed = false;
        for (size_t l = 0; l < a->link_count; l++) {
            uint32_t i = a->links[l].old_section, j = a->links[l].new_section, partner = a->old_side->partners[i];
            float to_old = partner == MESO_NO_INDEX ? 0 : a->costs[partner] - a->pair_costs[i];
            if (partner != j && to_old + a->links[l].cost < a->costs[j] - 1e-5f) {
                a->costs[j] = to_old + a->links[l].cost;
                a->before[j] = (uint32_t)l;
                changed = true;
            }
        }
    }
}

/* Pairs along the way to a new section. */
static void take_way(Assignment *a, uint32_t j)
{
    for (uint32_t guard = 0; j != MESO_NO_INDEX && guard <= a->old_side->section_count; guard++) {
        const Link *link = &a->links[a->before[j]];
        uint32_t i = link->old_section, other = a->old_side->partners[i];
        a->old_side->partners[i] = j;
        a->new_side->partners[j] = i;
        a->pair_costs[i] = link->cost;
        j = other;
    }
}

/*
 * The pairs for which the sum of costs, and of NO_PARTNER for each pair less, is least. Costs are squares of distances:
 * so neighbours rather all give way a little than that one strand ends and another begins, and pairs do not change order.
 */
static void assign(Assignment *a)
{
    for (;;) {
        uint32_t best = MESO_NO_INDEX;
        find_ways(a);
        for (uint32_t j = 0; j < a->new_side->section_count; j++)
            if (a->new_side->partners[j] == MESO_NO_INDEX && a->costs[j] < NO_PARTNER &&
                (best == MESO_NO_INDEX || a->costs[j] < a->costs[best]))
                best = j;
        if (best == MESO_NO_INDEX)
            return;
        take_way(a, best);
    }
}

MesoStatus meso_strands_pair(MesoStrandSide *old_side, MesoStrandSide *new_side, float *flaws, float reach,
                             const MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                             MesoArena *scratch, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    size_t most = (size_t)old_side->section_count * new_side->section_count;
    Assignment a = {.old_side = old_side, .new_side = new_side,
                    .links = MESO_NEW(scratch, Link, most, error),
                    .costs = MESO_NEW(scratch, float, new_side->section_count, error),
                    .before = MESO_NEW(scratch, uint32_t, new_side->section_count, error),
                    .pair_costs = MESO_NEW(scratch, float, old_side->section_count, error)};
    float *lengths = MESO_NEW(scratch, float, (size_t)old_side->section_count + new_side->section_count, error);
    if (!a.links || !a.costs || !a.before || !a.pair_costs || !lengths)
        return MESO_ERR_MEMORY;
    float usual = usual_length(lengths, old_side, new_side);
    for (uint32_t j = 0; j < new_side->section_count; j++)
        new_side->partners[j] = MESO_NO_INDEX;
    for (uint32_t i = 0; i < old_side->section_count; i++) {
        old_side->partners[i] = MESO_NO_INDEX;
        for (uint32_t j = 0; j < new_side->section_count; j++) {
            float distance = distance_beside(&old_side->sections[i], old_side->axes[i], &new_side->sections[j],
                                             new_side->axes[j], reach, usual,
                                             THIN_STEPS * work->rings.steps[new_side->rings[j]]) / (0.25f * usual);
            if (distance < INFINITY)
                a.links[a.link_count++] = (Link){i, j, distance * distance};
        }
    }
    assign(&a);
    const Pairing pairing = {old_side, new_side, shares, &step->old_rings, &work->rings};
    for (uint32_t i = 0; i < old_side->section_count; i++)
        if (old_side->partners[i] != MESO_NO_INDEX)
            find_moves(&pairing, i, old_side->partners[i]);
    *flaws = count_flaws(old_side, usual) + count_flaws(new_side, usual);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
