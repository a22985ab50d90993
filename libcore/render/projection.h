/*
 * From the world to pixels: the basis of a camera, and matrices for a window
 * of its image. Depth is reversed and
 * infinite: 1 at the near plane, 0 at infinity, which keeps floats exact where
 * the picture needs them.
 */
#ifndef MESO_PROJECTION_H
#define MESO_PROJECTION_H

#include <stdbool.h>

#include "libcore/base/error.h"
#include "libcore/math/box.h"

typedef struct MesoCamera {
    MesoVec3 eye, target, up;
    float fov_degrees;      /* vertical */
    float height;           /* of an orthographic view, in scene units; 0: perspective */
} MesoCamera;

/* Column-major, as GL takes it. */
typedef struct MesoMatrix {
    float m[16];
} MesoMatrix;

/*
 * A camera's orthonormal basis; `forward` runs from the eye into the picture.
 * What is drawn is given relative to `anchor`: single precision is finest there.
 */
typedef struct MesoView {
    MesoVec3 eye, right, up, forward;
    MesoVec3 anchor;        /* in the world, as the eye; 0 unless set */
    bool parallel;          /* orthographic: shows what is before the eye's plane */
    float half_height;      /* of the picture: at depth 1, or anywhere where it is parallel */
} MesoView;

/* A rectangle of the image's pixels, rows from the top. */
typedef struct MesoWindow {
    uint32_t x, y, width, height;
} MesoWindow;

/*
 * `up` is turned perpendicular to the view; where it is parallel to it,
 * another axis takes its place. MESO_ERR_USAGE for numbers that are not
 * finite, an eye at its target, a field of view outside (0, 180), or a height below 0.
 */
MesoStatus meso_view_build(MesoView *view, const MesoCamera *camera, MesoError *error);

/*
 * Where to anchor what lies in the box, so that differences from there are
 * exact: on each axis at the world's origin, or, where the box's middle lies
 * more than eight of its diagonals from that, at a coarse step near the
 * middle. At the origin for an empty box.
 */
MesoVec3 meso_box_anchor(MesoVec3 low, MesoVec3 high);

/*
 * Relative to the anchor, to clip space of `window` in an image of `width` x `height`; row 0 of GL is the top.
 * `end_depth` is that of the near plane; of a parallel view that of the far one, where z is 0, and 1 at the eye.
 */
MesoMatrix meso_view_clip_from_world(const MesoView *view, float end_depth, uint32_t width,
                                     uint32_t height, MesoWindow window);

#endif
