/*
 * Which samples of a part of a picture may see each triangle that a driver draws: it rounds corners otherwise, so that
 * neither which samples a triangle holds nor how far away it is there is known exactly, but between bounds.
 */
#ifndef MESO_SIFT_TRIANGLES_H
#define MESO_SIFT_TRIANGLES_H

#include "libcore/render/raster/raster_view.h"

/* Pixels of the picture, and the nearest of what is drawn at each of their samples for certain. */
typedef struct MesoSiftPart {
    const MesoRasterLanes *lanes;
    int32_t wide, high;         /* pixels; up to MESO_SIFT_SIDE of them */
    bool parallel;
    float focal;                /* of the view */
    float cut;                  /* what is nearer may be cut off; +inf: whoever asks has looked */
    int32_t slack;              /* units by which corners may be drawn elsewhere */
    float *nearness;            /* [MESO_SIFT_PLACES] of cells row by row, 16 each */
} MesoSiftPart;
enum { MESO_SIFT_SIDE = 128, MESO_SIFT_CELLS = 64, MESO_SIFT_PLACES = 64 * 64 * MESO_RASTER_LANES };

/* Pixels that a part has a side, at most. */
uint32_t meso_sift_side(uint32_t samples);

/* The slack of a driver that rounds corners to 2^-bits of a pixel or less. */
int32_t meso_sift_slack(uint32_t bits);

/* Nothing is drawn. */
void meso_sift_clear(const MesoSiftPart *part);

/*
 * Whether no sample sees what is in such a rectangle (meso_raster_rect()), relative to the part.
 * True only where that is certain.
 */
bool meso_sift_hides(const MesoSiftPart *part, const MesoRasterRect *rect);

/*
 * Bits of the samples that may see each triangle, one after the other, of points relative to the part: those that it
 * may hold, but where one that came before is nearer for certain. Those that are seen hide what comes later. Returns
 * whether any is seen.
 */
bool meso_sift_triangles(const MesoSiftPart *part, const MesoRasterPoints *points, const uint32_t *corners,
                         uint32_t count, uint16_t *samples);

#endif
