#include "libcore/solve/bucket_queue.h"

#include <assert.h>
#include <string.h>

static uint32_t *entry(const MesoBucketQueue *queue, const MesoBucket *bucket, uint32_t i)
{
    return queue->pieces + (size_t)bucket->directory[i / MESO_BUCKET_PIECE] * MESO_BUCKET_PIECE +
           i % MESO_BUCKET_PIECE;
}

static MesoStatus grow_directory(MesoBucketQueue *queue, MesoBucket *bucket, MesoError *error)
{
    uint32_t capacity = bucket->directory_capacity ? 2 * bucket->directory_capacity : 16;
    uint32_t *directory = MESO_NEW(queue->arena, uint32_t, capacity, error);
    if (!directory)
        return MESO_ERR_MEMORY;
    if (bucket->directory_capacity)
        memcpy(directory, bucket->directory, bucket->directory_capacity * sizeof *directory);
    bucket->directory = directory;
    bucket->directory_capacity = capacity;
    return MESO_OK;
}

MesoStatus meso_bucket_queue_init(MesoBucketQueue *queue, MesoArena *arena, uint32_t slot_count,
                                  uint32_t largest_size, MesoError *error)
{
    *queue = (MesoBucketQueue){.arena = arena, .bucket_count = largest_size + 1};
    queue->lowest = queue->bucket_count;

    /* Full pieces, and one that is not for each bucket that has a slot. */
    uint32_t partial = queue->bucket_count < slot_count ? queue->bucket_count : slot_count;
    uint32_t piece_count = slot_count / MESO_BUCKET_PIECE + partial;
    queue->buckets = MESO_NEW(arena, MesoBucket, queue->bucket_count, error);
    queue->position = MESO_NEW(arena, uint32_t, slot_count, error);
    queue->pieces = MESO_NEW(arena, uint32_t, (size_t)piece_count * MESO_BUCKET_PIECE, error);
    queue->free_pieces = MESO_NEW(arena, uint32_t, piece_count, error);
    if (!queue->buckets || !queue->position || !queue->pieces || !queue->free_pieces)
        return MESO_ERR_MEMORY;
    for (uint32_t i = piece_count; i-- > 0;)
        queue->free_pieces[queue->free_count++] = i;
    return MESO_OK;
}

MesoStatus meso_bucket_queue_insert(MesoBucketQueue *queue, uint32_t slot, uint32_t size,
                                    MesoError *error)
{
    assert(size < queue->bucket_count);
    MesoBucket *bucket = &queue->buckets[size];
    if (bucket->count % MESO_BUCKET_PIECE == 0) {
        uint32_t piece = bucket->count / MESO_BUCKET_PIECE;
        if (piece == bucket->directory_capacity && grow_directory(queue, bucket, error))
            return MESO_ERR_MEMORY;
        assert(queue->free_count > 0);
        bucket->directory[piece] = queue->free_pieces[--queue->free_count];
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
    MesoBucket *bucket = &queue->buckets[size];
    uint32_t position = queue->position[slot];
    assert(position < bucket->count && *entry(queue, bucket, position) == slot);

    uint32_t last = *entry(queue, bucket, --bucket->count);
    *entry(queue, bucket, position) = last;
    queue->position[last] = position;
    if (bucket->count % MESO_BUCKET_PIECE == 0)
        queue->free_pieces[queue->free_count++] = bucket->directory[bucket->count / MESO_BUCKET_PIECE];
    queue->count--;
}

uint32_t meso_bucket_queue_draw(MesoBucketQueue *queue, MesoRandom *random)
{
    assert(queue->count > 0);
    while (queue->buckets[queue->lowest].count == 0)
        queue->lowest++;
    const MesoBucket *bucket = &queue->buckets[queue->lowest];
    return *entry(queue, bucket, meso_random_below(random, bucket->count));
}
