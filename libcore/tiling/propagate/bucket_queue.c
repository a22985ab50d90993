#include "libcore/tiling/propagate/bucket_queue.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/base/index.h"

/* Pieces are large where there are many slots: the directories of them all fit into a core's caches. */
enum { LEAST_PIECE_BITS = 4, MOST_PIECES = 4096 };

static uint32_t *entry(const MesoBucketQueue *queue, const MesoBucket *bucket, uint32_t i)
{
    uint32_t bits = queue->piece_bits;
    return queue->pieces + ((size_t)bucket->directory[i >> bits] << bits) + (i & ((1u << bits) - 1));
}

static bool ends_piece(const MesoBucketQueue *queue, const MesoBucket *bucket)
{
    return (bucket->count & ((1u << queue->piece_bits) - 1)) == 0;
}

MesoStatus meso_bucket_queue_init(MesoBucketQueue *queue, MesoArena *arena, uint32_t slot_count,
                                  uint32_t largest_size, MesoError *error)
{
    *queue = (MesoBucketQueue){.arena = arena, .bucket_count = largest_size + 1, .slot_count = slot_count};
    queue->piece_bits = LEAST_PIECE_BITS;
    while (slot_count >> queue->piece_bits > MOST_PIECES)
        queue->piece_bits++;
    /* Full pieces, and one that is not for each bucket that has a slot. */
    uint32_t partial = queue->bucket_count < slot_count ? queue->bucket_count : slot_count;
    uint32_t piece_count = (slot_count >> queue->piece_bits) + partial;
    queue->buckets = MESO_NEW(arena, MesoBucket, queue->bucket_count, error);
    queue->position = MESO_NEW(arena, uint32_t, slot_count, error);
    queue->stock = MESO_NEW(arena, uint32_t, slot_count, error);
    queue->pieces = MESO_NEW(arena, uint32_t, (size_t)piece_count << queue->piece_bits, error);
    queue->free_pieces = MESO_NEW(arena, uint32_t, piece_count, error);
    return queue->buckets && queue->position && queue->stock && queue->pieces && queue->free_pieces
               ? MESO_OK : MESO_ERR_MEMORY;
}

void meso_bucket_queue_stock(MesoBucketQueue *queue, uint32_t (*size)(const void *context, uint32_t slot),
                             const void *context)
{
    MesoBucket *buckets = queue->buckets;
    for (uint32_t i = 0; i < queue->bucket_count; i++)
        buckets[i].count = buckets[i].stock_end = 0;
    queue->free_count = queue->unused_piece = 0;
    for (uint32_t s = 0; s < queue->slot_count; s++)
        buckets[size(context, s)].stock_end++;
    uint32_t end = 0;
    for (uint32_t i = 2; i < queue->bucket_count; i++) {
        buckets[i].stock_begin = end;
        end += buckets[i].stock_end;
        buckets[i].stock_end = buckets[i].stock_begin;
    }
    queue->count = end;
    for (uint32_t s = 0; s < queue->slot_count; s++) {
        uint32_t i = size(context, s);
        if (i > 1)
            queue->stock[buckets[i].stock_end++] = s;
    }
    memset(queue->position, 0xff, queue->slot_count * sizeof *queue->position);
    meso_bucket_queue_refill(queue);
}

void meso_bucket_queue_refill(MesoBucketQueue *queue)
{
    for (uint32_t i = 2; i < queue->bucket_count; i++)
        queue->buckets[i].stock_count = queue->buckets[i].stock_end - queue->buckets[i].stock_begin;
    queue->lowest = 2;
}

void meso_bucket_queue_restock(MesoBucketQueue *queue, uint32_t slot, uint32_t size, uint32_t stock_size)
{
    if (size > 1)
        meso_bucket_queue_remove(queue, slot, size);
    queue->position[slot] = MESO_NO_INDEX;
    queue->count += stock_size > 1;
}

MesoStatus meso_bucket_queue_insert(MesoBucketQueue *queue, uint32_t slot, uint32_t size,
                                    MesoError *error)
{
    assert(size < queue->bucket_count);
    MesoBucket *bucket = &queue->buckets[size];
    if (ends_piece(queue, bucket)) {
        uint32_t piece = bucket->count >> queue->piece_bits;
        bucket->directory = MESO_GROW(queue->arena, bucket->directory, piece, bucket->directory_capacity, 16, error);
        if (!bucket->directory)
            return MESO_ERR_MEMORY;
        bucket->directory[piece] =
            queue->free_count ? queue->free_pieces[--queue->free_count] : queue->unused_piece++;
    }
    queue->position[slot] = bucket->count;
    *entry(queue, bucket, bucket->count++) = slot;
    queue->count++;
    if (size < queue->lowest)
        queue->lowest = size;
    return MESO_OK;
}

void meso_bucket_queue_remove(MesoBucketQueue *queue, uint32_t slot, uint32_t size)
{
    uint32_t position = queue->position[slot];
    queue->count--;
    queue->position[slot] = 0;      /* any, for it is not in the stock now */
    if (position == MESO_NO_INDEX)
        return;

    MesoBucket *bucket = &queue->buckets[size];
    uint32_t last = *entry(queue, bucket, --bucket->count);
    *entry(queue, bucket, position) = last;
    queue->position[last] = position;
    if (ends_piece(queue, bucket))
        queue->free_pieces[queue->free_count++] = bucket->directory[bucket->count >> queue->piece_bits];
}

uint32_t meso_bucket_queue_draw(MesoBucketQueue *queue, MesoRandom *random)
{
    assert(queue->count > 0);
    for (;;) {
        MesoBucket *bucket = &queue->buckets[queue->lowest];
        uint32_t count = bucket->count + bucket->stock_count;
        if (count == 0) {
            queue->lowest++;
            continue;
        }
        uint32_t i = meso_random_below(random, count);
        if (i < bucket->count)
            return *entry(queue, bucket, i);
        uint32_t *stock = queue->stock + bucket->stock_begin, slot = stock[i -= bucket->count];
        if (queue->position[slot] == MESO_NO_INDEX)
            return slot;
        stock[i] = stock[--bucket->stock_count];
        stock[bucket->stock_count] = slot;
    }
}
