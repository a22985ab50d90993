/* Whether a swatch is periodic, and where its tile is. */
#ifndef MESO_SWATCH_PERIOD_H
#define MESO_SWATCH_PERIOD_H

#include "libcore/quilt/swatch/swatch.h"

/* What is known of one direction of the plane. */
typedef struct MesoSwatchAxis {
    int along;              /* 0 or 1 */
    uint32_t low_count, high_count;     /* open ends that face down it, and up */
    uint32_t *low, *high;   /* [loop_count] those */
    double low_end, high_end;           /* where they lie, on the mean */
    bool periodic;
    double period;
} MesoSwatchAxis;

/* The component of a point along axis 0, 1 or 2. */
static inline double meso_along(MesoVec3 p, int axis)
{
    return (double)(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
}

/* The open ends of each direction. `swatch` has its loops. MESO_ERR_MEMORY alone. */
MesoStatus meso_swatch_find_ends(MesoSwatchAxis axes[2], MesoArena *scratch, const MesoSwatch *swatch,
                                 MesoError *error);

/*
 * Finds out whether a sorted and measured swatch repeats along `axis`, and after how much, where `axis->period` is not
 * given (0); ends that meet become mates. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_swatch_find_period(MesoSwatch *swatch, MesoSwatchAxis *axis, MesoArena *scratch, MesoError *error);

#endif
