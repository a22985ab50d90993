/*
 * A carved mesh in a frame: where the surface has gone, with bumps as high and holes as wide as details are there.
 *
 * A hole pushes aside what is around it: what lies at a distance d from its middle goes to
 *
 *     r + (R - r) (d - e) / (R - e)
 *
 * from its rim, at e, which goes to its radius r, to R, where all stays; borders do, and other holes have their own. So
 * a hole of size 0 is a point of the surface.
 */
#ifndef MESO_CARVED_SHAPE_H
#define MESO_CARVED_SHAPE_H

#include "libcore/replicate/shape/carved_mesh.h"

typedef enum MesoBumpForm {
    MESO_BUMP_AS_GAUSS, MESO_BUMP_AS_RING, MESO_BUMP_AS_PICTURE
} MesoBumpForm;

/* What details of a kind do to the surface. */
typedef struct MesoCarvedKind {
    MesoCarving carving;
    MesoBumpForm form;
    float height;               /* over the size; below 0: down */
    uint32_t width, rows;       /* of the picture */
    const float *pixels;        /* [width * rows] rows from the top: shares of the height */
} MesoCarvedKind;

typedef struct MesoCarvedFrame {
    const MesoCarvedKind *kinds;        /* by the details' kind */
    const MesoDetail *details;          /* [count] those that were carved */
    const MesoPlacedDetail *placed;     /* [count] */
    uint32_t count;
    const MesoVec3 *positions, *normals;    /* [mesh->vertex_count] of the frame */
    uint32_t thread_count;              /* 0: all cores; the same for any */
} MesoCarvedFrame;

/*
 * positions  [carved->vertex_count]
 * under      [carved->vertex_count] the bump that a vertex lies under, of several the last; MESO_NO_INDEX: none
 *
 * O(vertices + details near them). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_carved_place(MesoVec3 *positions, uint32_t *under, const MesoCarvedMesh *carved,
                             const MesoCarvedFrame *frame, MesoError *error);

/* The height of a bump at x along its heading and y across, both in shares of its radius; 0 from 1 on. */
float meso_bump_height(const MesoCarvedKind *kind, float x, float y);

#endif
