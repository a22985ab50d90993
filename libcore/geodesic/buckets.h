/*
 * A queue of vertices by their distance: buckets of equal width, of which a
 * turning window is open; what lies beyond waits apart. Vertices within one
 * bucket come in the order in which they were put. A vertex may lie in it
 * several times: whoever takes it out knows whether it is still due.
 */
#ifndef MESO_BUCKETS_H
#define MESO_BUCKETS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "libcore/base/bits.h"

enum { MESO_BUCKET_COUNT = 512, MESO_BUCKET_LAST = 1 << 30 };

typedef struct MesoBucket {
    uint32_t count, room;
    uint32_t *vertices;
} MesoBucket;

typedef struct MesoBuckets {
    float inverse_width;
    int32_t current;            /* number of the bucket that is being emptied */
    int32_t nearest_beyond;     /* none of those beyond the window has a smaller number */
    bool out_of_memory;         /* something could not be put */
    MesoBucket beyond;
    MesoBucket open[MESO_BUCKET_COUNT];
    uint64_t filled[MESO_BUCKET_COUNT / 64];
} MesoBuckets;

static inline void meso_buckets_clear(MesoBuckets *buckets)
{
    for (uint32_t w = 0; w < MESO_BUCKET_COUNT / 64; w++)
        for (; buckets->filled[w]; buckets->filled[w] &= buckets->filled[w] - 1)
            buckets->open[64 * w + (uint32_t)__builtin_ctzll(buckets->filled[w])].count = 0;
    buckets->beyond.count = 0;
    buckets->current = 0;
    buckets->nearest_beyond = MESO_BUCKET_LAST;
    buckets->out_of_memory = false;
}

static inline void meso_buckets_release(MesoBuckets *buckets)
{
    for (uint32_t b = 0; b < MESO_BUCKET_COUNT; b++)
        free(buckets->open[b].vertices);
    free(buckets->beyond.vertices);
}

/* Number of the bucket of a distance, not below the current one; those beyond the window count as one. */
static inline int32_t meso_bucket_place(const MesoBuckets *buckets, float distance)
{
    float scaled = distance * buckets->inverse_width;
    int32_t number = scaled < (float)MESO_BUCKET_LAST ? (int32_t)scaled : MESO_BUCKET_LAST;
    int32_t end = buckets->current + MESO_BUCKET_COUNT;
    number = number < buckets->current ? buckets->current : number;
    return number < end ? number : end;
}

static inline bool meso_bucket_grow(MesoBucket *bucket)
{
    uint32_t room = bucket->room ? 2 * bucket->room : 64;
    uint32_t *vertices = realloc(bucket->vertices, room * sizeof *vertices);
    if (!vertices)
        return false;
    bucket->vertices = vertices;
    bucket->room = room;
    return true;
}

/* Puts a vertex where meso_bucket_place() says; its distance is only looked at where that is beyond the window. */
static inline void meso_buckets_put(MesoBuckets *buckets, int32_t place, uint32_t vertex, float distance)
{
    MesoBucket *bucket = &buckets->open[place % MESO_BUCKET_COUNT];
    if (place == buckets->current + MESO_BUCKET_COUNT) {
        bucket = &buckets->beyond;
        float scaled = distance * buckets->inverse_width;
        int32_t number = scaled < (float)MESO_BUCKET_LAST ? (int32_t)scaled : MESO_BUCKET_LAST;
        buckets->nearest_beyond = number < buckets->nearest_beyond ? number : buckets->nearest_beyond;
    } else {
        meso_bits_set(buckets->filled, (uint32_t)place % MESO_BUCKET_COUNT);
    }
    if (bucket->count == bucket->room && !meso_bucket_grow(bucket)) {
        buckets->out_of_memory = true;
        return;
    }
    bucket->vertices[bucket->count++] = vertex;
}

/* Turns the window to the first bucket from the current one on that is filled; false where none is. */
static inline bool meso_buckets_turn(MesoBuckets *buckets)
{
    uint32_t from = (uint32_t)buckets->current % MESO_BUCKET_COUNT, words = MESO_BUCKET_COUNT / 64;
    for (uint32_t k = 0; k <= words; k++) {
        uint32_t w = (from / 64 + k) % words;
        uint64_t bits = buckets->filled[w];
        if (k == 0)
            bits &= ~(uint64_t)0 << from % 64;
        else if (k == words)
            bits &= ((uint64_t)1 << from % 64) - 1;
        if (bits) {
            uint32_t slot = 64 * w + (uint32_t)__builtin_ctzll(bits);
            buckets->current += (int32_t)((slot + MESO_BUCKET_COUNT - from) % MESO_BUCKET_COUNT);
            return true;
        }
    }
    return false;
}

#endif
