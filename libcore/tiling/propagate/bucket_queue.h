/*
 * Slots by the size of their domain: O(1) to move a slot to another size and
 * to draw one at random among those of the smallest size.
 *
 * Most slots of a large surface wait with their first size until the search comes
 * to them. These are the stock: a permutation of the slots, by size, in which one
 * that has left is found out when it is drawn. A slot on the move costs one look at its
 * own position, and none at the far ends of arrays.
 */
#ifndef MESO_BUCKET_QUEUE_H
#define MESO_BUCKET_QUEUE_H

#include "libcore/base/arena.h"
#include "libcore/base/random.h"

/*
 * A bucket is an array in pieces, so that all buckets together hold no more than the slots, and a piece
 * for each size, however the slots spread over them while the search runs.
 */
typedef struct MesoBucket {
    uint32_t count;
    uint32_t directory_capacity;
    uint32_t *directory;        /* [directory_capacity] pieces */
    uint32_t stock_begin, stock_end;    /* in `stock`, of the slots of this size at first */
    uint32_t stock_count;       /* of these from `stock_begin` on, that may be there still */
} MesoBucket;

typedef struct MesoBucketQueue {
    MesoArena *arena;
    uint32_t bucket_count, slot_count, piece_bits;
    MesoBucket *buckets;        /* [bucket_count] by size */
    uint32_t *position;         /* [slot_count] in its bucket, or MESO_NO_INDEX in the stock */
    uint32_t *stock;            /* [slot_count] */
    uint32_t *pieces;           /* [pieces << piece_bits] */
    uint32_t *free_pieces;      /* [free_count] stack of pieces that were given back */
    uint32_t free_count;
    uint32_t unused_piece;      /* from it on, pieces were never in use */
    uint32_t lowest;            /* no bucket below has a slot */
    uint32_t count;             /* slots in all buckets and the stock */
} MesoBucketQueue;

/* For slots below `slot_count` and sizes up to `largest_size`; lives in `arena`. To be stocked before it is used. */
MesoStatus meso_bucket_queue_init(MesoBucketQueue *queue, MesoArena *arena, uint32_t slot_count,
                                  uint32_t largest_size, MesoError *error);

/*
 * Empties the queue and puts all slots of a size above 1 into the stock: size(context, slot) is
 * below the number of buckets. O(slots + buckets).
 */
void meso_bucket_queue_stock(MesoBucketQueue *queue, uint32_t (*size)(const void *context, uint32_t slot),
                             const void *context);

/*
 * Puts `slot` back where meso_bucket_queue_stock() put it, with size `stock_size`, from its bucket where its
 * size is `size` > 1 now. Draws are right again once meso_bucket_queue_refill() has been called.
 */
void meso_bucket_queue_restock(MesoBucketQueue *queue, uint32_t slot, uint32_t size, uint32_t stock_size);
void meso_bucket_queue_refill(MesoBucketQueue *queue);

/* Puts in a slot that is not in the queue. MESO_ERR_MEMORY alone. */
MesoStatus meso_bucket_queue_insert(MesoBucketQueue *queue, uint32_t slot, uint32_t size,
                                    MesoError *error);

/* Takes out a slot that is in the queue with `size`. */
void meso_bucket_queue_remove(MesoBucketQueue *queue, uint32_t slot, uint32_t size);

/*
 * A slot of the smallest size, each with the same probability; the queue must not be empty. O(1), but for
 * what leaves the stock, each time once.
 */
uint32_t meso_bucket_queue_draw(MesoBucketQueue *queue, MesoRandom *random);

#endif
