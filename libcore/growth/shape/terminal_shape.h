/*
 * Terminal shapes: what the last symbols of a grammar stand for, ready to be bent. A shape lies along its x axis, from
 * 0 to 1, with y to the left and z up, away from the surface; its cross-sections are in units of a width.
 */
#ifndef MESO_TERMINAL_SHAPE_H
#define MESO_TERMINAL_SHAPE_H

#include "libcore/scene/scene.h"

/* Vertices nearer to each other than this along the shape lie in one ring. */
#define MESO_RING_TOLERANCE 1e-6f

typedef struct MesoTerminalShape {
    MesoBody body;          /* straight, and one wide; its vertices lie ring by ring */
    uint32_t ring_count;
    float *along;           /* [ring_count] ascending, from exactly 0 to exactly 1: x of the ring's vertices */
    uint32_t *ring_begin;   /* [ring_count + 1] vertices */
} MesoTerminalShape;

typedef enum MesoShapeAxis {
    MESO_SHAPE_ALONG_X,     /* y to the left, z up */
    MESO_SHAPE_ALONG_Z      /* x to the left, y up */
} MesoShapeAxis;

/*
 * Makes a shape of a mesh: turned from `axis`, moved and scaled along it to [0,1], and scaled across it, in both
 * directions alike, so that the larger of its extents is 1. The axis is the mesh's own, not its middle. Corners,
 * normals, uvs and colours follow; the mesh may go then. O(n log n).
 *
 * MESO_ERR_INPUT where the mesh has no vertex, no length along the axis or no extent across it, or positions or normals
 * that are not finite; MESO_ERR_MEMORY.
 */
MesoStatus meso_terminal_shape_build(MesoTerminalShape *out, MesoArena *arena, const MesoBody *mesh,
                                     MesoShapeAxis axis, MesoError *error);

/* ---- shapes that come with the library ---- */

typedef enum MesoBuiltinShape {
    MESO_BUILTIN_LEAF,    /* two sheets, widest towards its root; folded along its middle, its tip hanging */
    MESO_BUILTIN_SCALE,   /* a shield: thick at its root, with a round, thin end */
    MESO_BUILTIN_BEAD,    /* a ball that ends in points at 0 and 1 */
    MESO_BUILTIN_LINK,    /* of a chain: a rod bent to an oval, flat on the surface */
    MESO_BUILTIN_TUBE,    /* round, open at both ends; those of a strand join */
    MESO_BUILTIN_SHAPES
} MesoBuiltinShape;

/* Details beyond it are as it. */
enum { MESO_SHAPE_DETAIL_MAX = 8, MESO_SHAPE_SIDES_MAX = 256 };

/* Names, by number. */
extern const char *const meso_builtin_shape_names[MESO_BUILTIN_SHAPES];

/*
 * A shape of `detail` from 0, for thousands of small ones, to MESO_SHAPE_DETAIL_MAX; divisions grow with 1 + detail.
 * All but the tube are closed. It has triangles, unit normals outward, and uvs with u around or across from 0 to 1, v
 * along. MESO_ERR_MEMORY.
 */
MesoStatus meso_builtin_shape(MesoTerminalShape *out, MesoArena *arena, MesoBuiltinShape kind, uint32_t detail,
                              MesoError *error);

/* A tube of so many sides, from 3 to MESO_SHAPE_SIDES_MAX; its detail is along it. MESO_ERR_MEMORY. */
MesoStatus meso_tube_shape(MesoTerminalShape *out, MesoArena *arena, uint32_t sides, uint32_t detail, MesoError *error);

#endif
