/* What strands that run through each other are parted by: rings of them, and where these are in contact. */
#ifndef MESO_FINISH_PART_WORK_H
#define MESO_FINISH_PART_WORK_H

#include "libcore/quilt/finish/finish_work.h"

/* How far strands are looked for beside each other, in sums of their half widths; they give way by one at most. */
#define MESO_PART_BESIDE 1.5f

/* Sections need a little more than they have. */
#define MESO_PART_ROOM 1.1f

typedef struct MesoPartRing {
    MesoVec3 foot, axis, normal;        /* its middle on the surface, along the strand, up */
    MesoVec3 side;                      /* to where it reaches farthest along the surface */
    float height, half_width, half_height, step;
    float thickness;                    /* half of it, square to the strand's course */
    uint32_t next[2];                   /* along the strand, or MESO_NO_INDEX */
    uint32_t count, first, links;       /* vertices, the first of them, edges to other rings */
    bool held;                          /* stays where it is on the surface */
    float low, high;                    /* of its heights */
    int32_t cell[3];
    uint32_t next_in_cell;
} MesoPartRing;

/* A place of a ring over or under another strand, or its middle beside one, at the nearest of that strand's rings. */
typedef struct MesoPartContact {
    uint32_t ring, other;
    bool beside;
    bool over;                          /* its middle is over or under the other one, not only next to its edge */
    float gap;                          /* between the middles of such as cross, at the least */
    float sign;                         /* 1: the ring is the higher one, -1 */
} MesoPartContact;

typedef struct MesoParting {
    uint32_t ring_count, contact_count, contact_room;
    MesoPartRing *rings;
    uint32_t *heads, head_mask;         /* of rings by their cell, hashed */
    float cell;
    MesoPartContact *contacts;          /* by ring */
    uint32_t *begin;                    /* [ring_count + 1] into the contacts */
    uint32_t thread_count;
    MesoArena *arena;
} MesoParting;

/*
 * Contacts of rings, which have all but their cells; of those that cross, which one is the higher one: at each place
 * where two strands cross it is the same one, the one whose middle is higher on the whole. O(rings + contacts).
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_part_find_contacts(MesoParting *s, MesoError *error);

#endif
