/*
 * Windows of the exact solver: the distance functions along a side, and the
 * windows that a side has.
 */
#ifndef MESO_EXACT_WINDOWS_H
#define MESO_EXACT_WINDOWS_H

#include <math.h>
#include <stdbool.h>

#include "libcore/geodesic/exact/event_queue.h"

/*
 * Distance along a straight line, the first axis of a plane. From a point at (x, -y): sigma + |(t,0) - (x,-y)|. From a
 * line far behind, in direction (x, y) of unit length: sigma + t * x. y is not negative.
 */
typedef struct MesoFront {
    double x, y, sigma;
    bool linear;                /* from a line */
    uint8_t skips;              /* sides crossed with the source as good as on them */
} MesoFront;

typedef struct MesoWindow {
    MesoFront front;
    double begin, end;          /* along the edge's first half-edge, the one with the smaller number */
    uint32_t edge;              /* first half-edge */
    uint32_t into;              /* half-edge of the triangle that is entered */
    uint8_t pending, listed;    /* whether the queue, and the edge, still have it */
} MesoWindow;

/* Those of an edge, side by side. */
typedef struct MesoWindowPlace {
    double end;
    uint32_t window;
} MesoWindowPlace;

typedef struct MesoWindowList {
    MesoWindowPlace *places;    /* [count], room for 2^size */
    uint32_t count, size;
} MesoWindowList;

typedef enum MesoEventKind { MESO_EVENT_WINDOW, MESO_EVENT_VERTEX, MESO_EVENT_EDGE } MesoEventKind;

typedef struct MesoWindowStore {
    MesoArena *arena;
    MesoWindow **chunks;
    uint32_t chunk_count, chunk_room;
    uint32_t used, unused;      /* windows ever handed out; first of those given back, which `edge` links */
    MesoWindowPlace *merged;    /* [merged_count] places of the edge in hand, anew */
    uint32_t merged_count, merged_room;
    MesoWindowPlace *rooms[32]; /* by size: first of the places given back, which the first pointer in them links */
    uint32_t count, limit, peak;
    uint64_t made;
    MesoEventQueue queue;
} MesoWindowStore;

enum { MESO_WINDOW_CHUNK = 1 << 12 };

static inline MesoWindow *meso_window(const MesoWindowStore *store, uint32_t w)
{
    return &store->chunks[w / MESO_WINDOW_CHUNK][w % MESO_WINDOW_CHUNK];
}

static inline double meso_front_value(const MesoFront *front, double t)
{
    double dx = t - front->x;
    return front->linear ? front->sigma + t * front->x
                                           : front->sigma + sqrt(dx * dx + front->y * front->y);
}

/* The least value from `begin` to `end`. */
double meso_front_least(const MesoFront *front, double begin, double end);

/*
 * Gives an edge what of a window is nearer than the windows it has, and these lose that part; new ones are put into the
 * queue. Parts shorter than `tiny` are left out.
 *
 * O(windows of the edge), for moving them: it meets only those that overlap. MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_window_insert(MesoWindowStore *store, MesoWindowList *list, const MesoWindow *added, double tiny,
                              MesoError *error);

/* After its event: the window waits no more; the store has it back if its edge has lost it meanwhile. */
void meso_window_settle(MesoWindowStore *store, uint32_t w);

/* The edge has no windows any more. */
void meso_window_clear(MesoWindowStore *store, MesoWindowList *list);

#endif
