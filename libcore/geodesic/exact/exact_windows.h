/*
 * Windows of the exact solver: the distance functions along a side, and the
 * windows that a side has.
 */
#ifndef MESO_EXACT_WINDOWS_H
#define MESO_EXACT_WINDOWS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/arena.h"

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
    uint32_t into;              /* half-edge of the triangle that is entered */
    bool waits;                 /* has not been through it yet */
} MesoWindow;

/* Those of an edge, side by side and in its order: they are met together. */
typedef struct MesoWindowList {
    MesoWindow *windows;        /* [count], room for 2^size */
    uint32_t count, size;
} MesoWindowList;

typedef struct MesoWindowStore {
    MesoArena *arena;
    MesoWindow *merged;         /* [merged_count] windows of the edge in hand, anew */
    uint32_t merged_count, merged_room;
    MesoWindow *rooms[32];      /* by size: first of the arrays given back, which the first pointer in them links */
    uint32_t count, limit, peak;
    uint64_t made;
} MesoWindowStore;

static inline double meso_front_value(const MesoFront *front, double t)
{
    double dx = t - front->x;
    return front->linear ? front->sigma + t * front->x
                                           : front->sigma + sqrt(dx * dx + front->y * front->y);
}

/* The same window along the other direction of its edge. */
static inline void meso_window_reverse(MesoWindow *window, double length)
{
    double begin = window->begin;
    window->begin = length - window->end;
    window->end = length - begin;
    if (window->front.linear) {
        window->front.sigma += window->front.x * length;
        window->front.x = -window->front.x;
    } else {
        window->front.x = length - window->front.x;
    }
}

/* The least value from `begin` to `end`. */
double meso_front_least(const MesoFront *front, double begin, double end);

/*
 * Gives an edge what of a window is nearer than the windows it has, and these lose that part. Parts shorter than `tiny`
 * are left out.
 *
 * least      the least value of what the edge has been given; INFINITY where that is nothing
 *
 * O(windows of the edge), for moving them: it meets only those that overlap. MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_window_insert(MesoWindowStore *store, MesoWindowList *list, const MesoWindow *added, double tiny,
                              double *least, MesoError *error);

/* The edge has no windows any more. */
void meso_window_clear(MesoWindowStore *store, MesoWindowList *list);

#endif
