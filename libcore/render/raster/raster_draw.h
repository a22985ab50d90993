/*
 * Triangles drawn to targets. Edges are whole numbers, so that neighbours leave no gap and share no place, and the
 * nearest triangle, of equals the first, wins whatever the machine.
 */
#ifndef MESO_RASTER_DRAW_H
#define MESO_RASTER_DRAW_H

#include "libcore/render/raster/raster_queue.h"

enum { MESO_RASTER_SPARE = 32 };    /* points behind the last that are read, whatever they are */

/* The widest that this one has. */
MesoRasterMachine meso_raster_machine(void);

/* Begins an empty queue. */
void meso_raster_begin(MesoRasterQueue *queue, const MesoRasterTarget *target);

/*
 * Triangles by three points each; triangle t has the id first_id + t. `one_sided`: those that are clockwise in the
 * target, whose rows run down, are left out. O(triangles + cells of their boxes).
 */
void meso_raster_add(MesoRasterQueue *queue, const MesoRasterPoints *points, const uint32_t *corners,
                     uint32_t triangle_count, uint32_t first_id, bool one_sided);

/* Points in rings of `width`, one ring after the other. */
typedef struct MesoRasterRings {
    uint32_t count, width;      /* points that have a ring behind theirs */
    const uint8_t *joined;      /* [count] 1: to the next point, and both to those behind them; else 0 */
    const uint32_t *sides;      /* [width] the number of the side from there to the next point, where there is one */
    uint32_t side_count;        /* of a ring */
} MesoRasterRings;

/*
 * Its triangles: side s from a to b on ring r, with c and d behind them on the next, are (a, c, d) and (a, d, b), with
 * the ids first_id + 2 (r side_count + s) and one more. Most of many small ones are left out without a look at each.
 * `sides` may be NULL where the target has no ids: then it may be many meshes after each other. As many as
 * MESO_RASTER_SPARE behind the last of `points` [count + width] and of `joined` can be read. O(count).
 */
void meso_raster_add_rings(MesoRasterQueue *queue, const MesoRasterPoints *points, const MesoRasterRings *rings,
                           uint32_t first_id, bool one_sided);

/* Draws what is left. */
void meso_raster_flush(MesoRasterQueue *queue);

#endif
