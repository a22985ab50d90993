/*
 * Where rings of strands are in contact. Of strands that cross, not only middles meet: what lies to the side of one,
 * where the other one rises or falls, is as near to it. So each ring is looked at in several places across its strand,
 * and what is as thick there as its section, all around, is to stay outside of the other strand's section: its middle
 * outside of an ellipse that is larger by so much.
 */
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_part_work.h"

/* Strands cross where the cosine between them is at most this; normals of one side of the surface have at least
 * that. */
#define CROSS_MOST 0.7f
#define SIDE_LEAST 0.5f

/* Of a ring's step: how far along a strand it stands for it. */
#define ALONG_MOST 0.55f

/* What edges say of which strand is higher, against middles: where there are none of these. */
#define EDGE_SHARE 0.01f

/* ---- rings by place ---- */

static uint32_t *head_of(const MesoParting *s, const int32_t cell[3])
{
    uint32_t key = (uint32_t)cell[0] * 73856093u ^ (uint32_t)cell[1] * 19349663u ^ (uint32_t)cell[2] * 83492791u;
    return &s->heads[(key ^ key >> 15) & s->head_mask];
}

static MesoStatus sort_rings(MesoParting *s, MesoError *error)
{
    uint32_t size = 16;
    while (size < 2 * s->ring_count)
        size *= 2;
    s->heads = MESO_NEW(s->arena, uint32_t, size, error);
    if (!s->heads)
        return MESO_ERR_MEMORY;
    memset(s->heads, 0xff, size * sizeof *s->heads);
    s->head_mask = size - 1;
    for (uint32_t r = 0; r < s->ring_count; r++)
        s->cell = fmaxf(s->cell, 2 * MESO_PART_BESIDE * s->rings[r].half_width + s->rings[r].step);
    for (uint32_t r = 0; r < s->ring_count && s->cell > 0; r++) {
        MesoPartRing *ring = &s->rings[r];
        const float place[3] = {ring->foot.x, ring->foot.y, ring->foot.z};
        for (int k = 0; k < 3; k++)
            ring->cell[k] = (int32_t)fmaxf(fminf(floorf(place[k] / s->cell), 1e9f), -1e9f);
        uint32_t *head = head_of(s, ring->cell);
        ring->next_in_cell = *head;
        *head = r;
    }
    return MESO_OK;
}

/* ---- contacts ---- */

/* Of a ring: its middle, and places towards both of its sides, as shares of the way there. */
static const float SAMPLES[] = {0, -0.5f, 0.5f, -0.9f, 0.9f};
enum { SAMPLE_COUNT = sizeof SAMPLES / sizeof *SAMPLES };

static bool is_beside(MesoPartContact *contact, const MesoPartRing *ring, const MesoPartRing *other)
{
    MesoVec3 d = meso_vec3_sub(other->foot, ring->foot);
    float along = meso_vec3_dot(d, other->axis), side = meso_vec3_dot(d, d) - along * along;
    float widths = MESO_PART_BESIDE * (ring->half_width + other->half_width);
    contact->beside = true;
    return fabsf(along) <= ALONG_MOST * other->step && side < widths * widths &&
           meso_vec3_dot(ring->normal, other->normal) >= SIDE_LEAST;
}

/* A section there is as thick as an ellipse is; what is so thick all around must not come into the other one. */
static bool is_over(MesoPartContact *contact, const MesoPartRing *ring, const MesoPartRing *other, float sample)
{
    MesoVec3 d = meso_vec3_sub(meso_vec3_mad(other->foot, -sample, ring->side), ring->foot);
    float along = meso_vec3_dot(d, other->axis), side = meso_vec3_dot(d, d) - along * along;
    float thickness = ring->thickness * sqrtf(1 - sample * sample), width = other->half_width + thickness;
    if (fabsf(along) > ALONG_MOST * other->step || !(side < width * width) ||
        meso_vec3_dot(ring->normal, other->normal) < SIDE_LEAST)
        return false;
    contact->beside = false;
    contact->over = sample == 0 && side < other->half_width * other->half_width;
    contact->gap = MESO_PART_ROOM * (thickness + other->thickness) * sqrtf(1 - fmaxf(side, 0) / (width * width));
    return true;
}

/* Rings that are looked at side by side: a batch of blocks, whose contacts are put one after the other. */
enum { BLOCK_RINGS = 256, BLOCKS = 8 };

typedef struct Block {
    uint32_t count, room;
    MesoPartContact *contacts;          /* [count] of its rings */
    MesoArena arena;
    MesoStatus status;
    MesoError error;
} Block;

typedef struct Batch {
    MesoParting *s;
    uint32_t first, end;                /* rings */
    Block blocks[BLOCKS];
} Batch;

static MesoStatus add_contact(Block *block, MesoPartContact contact)
{
    block->contacts = MESO_GROW(&block->arena, block->contacts, block->count, block->room, 1024, &block->error);
    if (!block->contacts)
        return MESO_ERR_MEMORY;
    block->contacts[block->count++] = contact;
    return MESO_OK;
}

static MesoStatus meet(Block *block, const MesoParting *s, uint32_t r)
{
    const MesoPartRing *ring = &s->rings[r];
    for (int32_t i = 0; i < 27; i++) {
        const int32_t cell[3] = {ring->cell[0] + i % 3 - 1, ring->cell[1] + i / 3 % 3 - 1, ring->cell[2] + i / 9 - 1};
        for (uint32_t q = *head_of(s, cell); q != MESO_NO_INDEX; q = s->rings[q].next_in_cell) {
            MesoPartContact contact = {.ring = r, .other = q};
            const MesoPartRing *other = &s->rings[q];
            if (q == r || q == ring->next[0] || q == ring->next[1] || memcmp(other->cell, cell, sizeof cell) != 0)
                continue;
            bool beside = fabsf(meso_vec3_dot(ring->axis, other->axis)) > CROSS_MOST;
            for (int k = 0; k < (beside ? 1 : SAMPLE_COUNT); k++)
                if ((beside ? is_beside(&contact, ring, other) : is_over(&contact, ring, other, SAMPLES[k])) &&
                    add_contact(block, contact))
                    return MESO_ERR_MEMORY;
        }
    }
    return MESO_OK;
}

/* Ends of what each ring has, from the block's first contact on. */
static void meet_blocks(void *context, uint64_t begin, uint64_t end)
{
    Batch *batch = context;
    for (uint64_t i = begin; i < end; i++) {
        Block *block = &batch->blocks[i];
        uint32_t first = batch->first + (uint32_t)i * BLOCK_RINGS;
        block->status = MESO_OK;
        block->count = 0;
        for (uint32_t r = first; r < batch->end && r < first + BLOCK_RINGS && !block->status; r++) {
            block->status = meet(block, batch->s, r);
            batch->s->begin[r + 1] = block->count;
        }
    }
}

static MesoStatus make_room(MesoParting *s, uint32_t count, MesoError *error)
{
    uint64_t wanted = (uint64_t)s->contact_count + count, room = s->contact_room ? s->contact_room : 1024;
    while (room < wanted)
        room *= 2;
    if (room > UINT32_MAX)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %llu contacts", (unsigned long long)wanted);
    if (room == s->contact_room)
        return MESO_OK;
    s->contacts = meso_arena_enlarge(s->arena, s->contacts, s->contact_count, room, sizeof *s->contacts, error);
    s->contact_room = (uint32_t)room;
    return s->contacts ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus take_block(Batch *batch, uint32_t i, MesoError *error)
{
    MesoParting *s = batch->s;
    const Block *block = &batch->blocks[i];
    if (block->status && error)
        *error = block->error;
    MesoStatus status = block->status ? block->status : make_room(s, block->count, error);
    if (status)
        return status;
    if (block->count)
        memcpy(&s->contacts[s->contact_count], block->contacts, block->count * sizeof *s->contacts);
    uint32_t first = batch->first + i * BLOCK_RINGS;
    for (uint32_t r = first; r < batch->end && r < first + BLOCK_RINGS; r++)
        s->begin[r + 1] += s->contact_count;
    s->contact_count += block->count;
    return MESO_OK;
}

static MesoStatus meet_all(MesoParting *s, MesoError *error)
{
    Batch batch = {.s = s};
    MesoStatus status = MESO_OK;
    for (; batch.first < s->ring_count && !status; batch.first = batch.end) {
        uint32_t rest = s->ring_count - batch.first, count = rest < BLOCKS * BLOCK_RINGS ? rest : BLOCKS * BLOCK_RINGS;
        batch.end = batch.first + count;
        uint32_t blocks = (count + BLOCK_RINGS - 1) / BLOCK_RINGS;
        meso_parallel_for(s->thread_count, blocks, 1, meet_blocks, &batch);
        for (uint32_t i = 0; i < blocks && !status; i++)
            status = take_block(&batch, i, error);
    }
    for (uint32_t i = 0; i < BLOCKS; i++)
        meso_arena_release(&batch.blocks[i].arena);
    return status;
}

/* ---- which one is higher ---- */

/* Contacts of one strand with another where they cross: rings of the first, and next to each other. */
typedef struct Places {
    uint32_t *sets;                     /* [contact_count] */
    uint32_t *across;                   /* [contact_count] by root, one of the other strand with the first there */
    float *heights;                     /* [contact_count] by root, how much higher the first one is */
} Places;

static void join_contacts(const MesoParting *s, uint32_t *sets, uint32_t contact, uint32_t ring)
{
    uint32_t other = s->contacts[contact].other;
    const uint32_t *next = s->rings[other].next;
    for (uint32_t k = s->begin[ring]; k < s->begin[ring + 1]; k++) {
        uint32_t at = s->contacts[k].other;
        if (!s->contacts[k].beside && (at == other || at == next[0] || at == next[1]))
            meso_sets_join(sets, contact, k);
    }
}

/* The same two rings the other way, or MESO_NO_INDEX. */
static uint32_t reverse_of(const MesoParting *s, const MesoPartContact *contact)
{
    for (uint32_t k = s->begin[contact->other]; k < s->begin[contact->other + 1]; k++)
        if (!s->contacts[k].beside && s->contacts[k].other == contact->ring)
            return k;
    return MESO_NO_INDEX;
}

static void join_places(Places *places, const MesoParting *s)
{
    meso_sets_init(places->sets, s->contact_count);
    for (uint32_t k = 0; k < s->contact_count; k++) {
        const MesoPartRing *ring = &s->rings[s->contacts[k].ring];
        if (s->contacts[k].beside)
            continue;
        join_contacts(s, places->sets, k, s->contacts[k].ring);
        for (int i = 0; i < 2; i++)
            if (ring->next[i] != MESO_NO_INDEX)
                join_contacts(s, places->sets, k, ring->next[i]);
    }
    memset(places->across, 0xff, s->contact_count * sizeof *places->across);
    for (uint32_t k = 0; k < s->contact_count; k++) {
        const MesoPartContact *contact = &s->contacts[k];
        uint32_t root = meso_sets_root(places->sets, k);
        if (contact->beside)
            continue;
        if (places->across[root] == MESO_NO_INDEX)
            places->across[root] = reverse_of(s, contact);
        float higher = s->rings[contact->ring].height - s->rings[contact->other].height;
        places->heights[root] += contact->over ? higher : EDGE_SHARE * higher;
    }
}

/* Where two strands cross, one is the higher one all over: the one whose middle is, on the whole. */
static MesoStatus find_signs(MesoParting *s, MesoError *error)
{
    uint32_t n = s->contact_count;
    Places places = {MESO_NEW(s->arena, uint32_t, n, error), MESO_NEW(s->arena, uint32_t, n, error),
                     MESO_NEW(s->arena, float, n, error)};
    if (!places.sets || !places.across || !places.heights)
        return MESO_ERR_MEMORY;
    join_places(&places, s);
    for (uint32_t k = 0; k < n; k++) {
        MesoPartContact *contact = &s->contacts[k];
        uint32_t root = meso_sets_root(places.sets, k), across = places.across[root];
        if (contact->beside)
            continue;
        float higher = places.heights[root];
        if (across != MESO_NO_INDEX)
            higher -= places.heights[meso_sets_root(places.sets, across)];
        bool first = s->contacts[root].ring < s->contacts[root].other;
        contact->sign = higher > 0 || (!(higher < 0) && first) ? 1 : -1;
    }
    return MESO_OK;
}

MesoStatus meso_part_find_contacts(MesoParting *s, MesoError *error)
{
    s->begin = MESO_NEW(s->arena, uint32_t, (size_t)s->ring_count + 1, error);
    MesoStatus status = s->begin ? sort_rings(s, error) : MESO_ERR_MEMORY;
    if (!status && s->cell > 0)
        status = meet_all(s, error);
    return status ? status : find_signs(s, error);
}
