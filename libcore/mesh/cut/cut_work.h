/* What lines have to do with each triangle of a mesh: nodes on its sides and in it, segments. */
#ifndef MESO_CUT_WORK_H
#define MESO_CUT_WORK_H

#include "libcore/mesh/cut/cut_keys.h"
#include "libcore/mesh/cut/cut_nodes.h"

/* A sorted list, and how far it is done. */
typedef struct MesoCutQueue {
    MesoCutKey *keys;
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

/* The value of a queue's next entry, if that has this key. */
static inline bool meso_cut_take(MesoCutQueue *queue, uint64_t key, uint32_t *value)
{
    if (queue->done == queue->count || queue->keys[queue->done].key != key)
        return false;
    *value = queue->keys[queue->done++].value;
    return true;
}

#endif
