/*
 * Slots by the size of their domain: O(1) to move a slot to another size and
 * to draw one at random among those of the smallest size.
 */
#ifndef MESO_BUCKET_QUEUE_H
#define MESO_BUCKET_QUEUE_H

#include "libcore/base/arena.h"
#include "libcore/base/random.h"

/*
 * A bucket is an array in pieces of MESO_BUCKET_PIECE slots, so that all
 * buckets together hold no more than the slots, however these spread over
 * them while the search runs.
 */
enum { MESO_BUCKET_PIECE = 16 };

typedef struct MesoBucket {
    uint32_t count;
    uint32_t directory_capacity;
    uint32_t *directory;        /* [directory_capacity] pieces */
} MesoBucket;

typedef struct MesoBucketQueue {
    MesoArena *arena;
    uint32_t bucket_count;
    MesoBucket *buckets;        /* [bucket_count] by size */
    uint32_t *position;         /* [slot_count] in its bucket */
    uint32_t *pieces;           /* [MESO_BUCKET_PIECE * pieces] */
    uint32_t *free_pieces;      /* stack */
    uint32_t free_count;
    uint32_t lowest;            /* no bucket below has a slot */
    uint32_t count;             /* slots in all buckets */
} MesoBucketQueue;

/* An empty queue for slots below `slot_count` and sizes up to `largest_size`; lives in `arena`. */
MesoStatus meso_bucket_queue_init(MesoBucketQueue *queue, MesoArena *arena, uint32_t slot_count,
                                  uint32_t largest_size, MesoError *error);

/* Puts in a slot that is not in the queue. MESO_ERR_MEMORY alone. */
MesoStatus meso_bucket_queue_insert(MesoBucketQueue *queue, uint32_t slot, uint32_t size,
                                    MesoError *error);

/* Takes out a slot that is in the queue with `size`. */
void meso_bucket_queue_remove(MesoBucketQueue *queue, uint32_t slot, uint32_t size);

/* A slot of the smallest size, each with the same probability; the queue must not be empty. */
uint32_t meso_bucket_queue_draw(MesoBucketQueue *queue, MesoRandom *random);

#endif
