/* Clipper (polygon clipping on integers) behind a C interface. */
#ifndef MESO_CLIPPER_ADAPTER_H
#define MESO_CLIPPER_ADAPTER_H

#include <stdint.h>

#include "libcore/base/arena.h"

typedef struct MesoIntPoint {
    int64_t x, y;
} MesoIntPoint;

typedef enum MesoClipOp { MESO_CLIP_PATH, MESO_CLIP_UNION, MESO_CLIP_DIFFERENCE } MesoClipOp;

/* One step of a program: a closed path, or an operation on the results of two earlier steps. */
typedef struct MesoClipStep {
    MesoClipOp op;
    uint32_t left, right;                   /* steps, both before this one */
    uint32_t point_begin, point_count;      /* of a path */
} MesoClipStep;

/* Closed polygons; outlines counter-clockwise, holes clockwise, none of them crossing. */
typedef struct MesoIntPolygons {
    uint32_t path_count;
    uint32_t *path_begin;   /* [path_count + 1] into points */
    MesoIntPoint *points;
} MesoIntPolygons;

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Runs `steps` and returns the value of the last one. Coordinates must lie
 * within +-2^29. MESO_ERR_INTERNAL with Clipper's words where it throws.
 */
MesoStatus meso_clip(MesoIntPolygons *result, MesoArena *arena, const MesoClipStep *steps,
                     uint32_t step_count, const MesoIntPoint *points, MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
