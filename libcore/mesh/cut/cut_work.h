/* What lines have to do with each triangle of a mesh: nodes on its sides and in it, segments. */
#ifndef MESO_CUT_WORK_H
#define MESO_CUT_WORK_H

#include "libcore/mesh/cut/cut_keys.h"
#include "libcore/mesh/cut/cut_nodes.h"

/* A sorted list of keys, and how far it is done. */
typedef struct MesoCutQueue {
    uint64_t *keys;
    uint32_t count, done;
} MesoCutQueue;

typedef struct MesoCutWork {
    MesoCutQueue sides;     /* by half-edge: edge that has nodes */
    MesoCutQueue segments;  /* by triangle: segment, but for those whose ends have become one */
    MesoCutQueue inner;     /* by triangle: node; or MESO_NO_INDEX where nothing but a wall on a side comes to it */
} MesoCutWork;

/* MESO_ERR_INTERNAL where a segment has no triangle or no ends, MESO_ERR_MEMORY. */
MesoStatus meso_cut_work_list(MesoCutWork *work, const MesoTriangulation *mesh, const MesoCutLines *lines,
                              const MesoCutNodes *nodes, MesoArena *arena, MesoError *error);

/* The next triangle that there is work for; false at the end. */
bool meso_cut_work_next(const MesoCutWork *work, uint32_t *triangle);

/* How many triangles there is work for. Leaves the queues as they are. O(work). */
uint32_t meso_cut_work_count(const MesoCutWork *work);

/* What a queue's next entry is sorted by; MESO_NO_INDEX at the end. */
static inline uint32_t meso_cut_next(const MesoCutQueue *queue)
{
    return queue->done < queue->count ? (uint32_t)(queue->keys[queue->done] >> 32) : MESO_NO_INDEX;
}

/* The value of a queue's next entry, where that is for `upper`. */
static inline bool meso_cut_take(MesoCutQueue *queue, uint32_t upper, uint32_t *value)
{
    if (meso_cut_next(queue) != upper)
        return false;
    *value = (uint32_t)queue->keys[queue->done++];
    return true;
}

#endif
