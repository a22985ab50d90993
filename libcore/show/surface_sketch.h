/* Surfaces as scenes to look at: faces in colours, edges as bars, directions of quads, and singular corners. */
#ifndef MESO_SURFACE_SKETCH_H
#define MESO_SURFACE_SKETCH_H

#include "libcore/mesh/polygon_mesh.h"
#include "libcore/scene/scene.h"

/* What a class of faces looks like. */
typedef struct MesoFaceClass {
    const char *name;           /* must outlive the scene */
    float color[3];
} MesoFaceClass;

typedef struct MesoSurfaceSketch {
    const MesoPolygonMesh *mesh;
    const uint32_t *twin;       /* [corner_count] half-edge across, or MESO_NO_INDEX (half_edges.h) */
    uint32_t class_count;
    const MesoFaceClass *classes;
    const uint32_t *face_class; /* [face_count], or NULL: all of the first */
    bool directions;            /* an arrow in each quad, from side 2 to side 0, which is the tile's +X */
    bool corners;               /* a ball where another number of quads than four meets within the surface */
} MesoSurfaceSketch;

/* Numbers of what was marked. */
typedef struct MesoSurfaceMarks {
    uint32_t three, five, others;   /* corners of so many quads */
} MesoSurfaceMarks;

/*
 * Makes the scene. Its channel is "part": the classes, then "edges", "borders", "directions", and "corners of 3",
 * "corners of 5" and "other corners". Faces are flat. `marks` may be NULL. O(corners). MESO_ERR_MEMORY, or
 * MESO_ERR_LIMIT for more than 2^16 - 8 classes.
 */
MesoStatus meso_surface_sketch(MesoScene *scene, MesoSurfaceMarks *marks, MesoArena *arena,
                               const MesoSurfaceSketch *look, MesoError *error);

#endif
