/*
 * Shapes: a scene in pieces that a raster draws one by one, each made anew wherever it is wanted, as fine as that needs:
 * sweeps, and runs of the faces of placed bodies.
 */
#ifndef MESO_SHAPES_H
#define MESO_SHAPES_H

#include "libcore/base/arena.h"
#include "libcore/render/raster/raster_view.h"
#include "libcore/render/raster/shape_bodies.h"
#include "libcore/render/raster/shape_levels.h"
#include "libcore/scene/detail.h"
#include "libcore/scene/sweep_maker.h"

enum { MESO_SHAPE_FACES = 128 };        /* of a body, at most */

/* Consecutive faces of a placed body. */
typedef struct MesoShapeRun {
    uint32_t placed, face_begin, face_count;
    MesoBox box;
} MesoShapeRun;

typedef struct MesoShapes {
    const MesoScene *scene;
    MesoVec3 anchor;            /* in the world; what is drawn is relative to it */
    MesoScene near;             /* the scene, with cages relative to it where sections deform */
    uint32_t count;             /* sweeps first, by their numbers in the scene, then runs */
    MesoShapeRun *runs;         /* [count - sweep_count] */
    MesoShapeBodies bodies;
    uint32_t made;              /* sweeps that the scene's maker makes: all, or none */
    uint32_t *kind_of;          /* [sweep_count], where they are stored */
    MesoKindDetail *details;    /* [kind_count] */
    float *scales;              /* [kind_count] scene units to a unit of the profiles, at most */
    MesoSweepBend *bends;       /* [sweep_count], where they are stored */
    MesoBox *bounds;            /* [count - made] of the rest, relative to the anchor */
    uint32_t bundle_count;      /* those of the maker, then others, of shapes one after the other */
    MesoBox *bundle_bounds;     /* [bundle_count], where sweeps are made */
    float finest;
    MesoShapeColumns *columns;  /* [kind_count * MESO_SHAPE_LEVELS * MESO_SHAPE_USES] those that are ready */
} MesoShapes;

/*
 * What is there lives in `arena`; of sweeps that the scene has a maker of, nothing does. Bodies that are placed by a
 * frame or in a cage are moved there once: 24 bytes a vertex. All of it is ready to be made with any tolerance.
 * O(sweeps + columns * levels + vertices + faces). MESO_ERR_MEMORY, or MESO_ERR_LIMIT for more than 2^32 - 2 shapes.
 */
MesoStatus meso_shapes_init(MesoShapes *shapes, MesoArena *arena, const MesoScene *scene, MesoVec3 anchor,
                            uint32_t thread_count, MesoError *error);

/*
 * The same in two steps: after the first, nothing is ready; the second gets `use` ready for tolerances from `low` to
 * `high`, scene units, of which pictures need few.
 */
MesoStatus meso_shapes_begin(MesoShapes *shapes, MesoArena *arena, const MesoScene *scene, MesoVec3 anchor,
                             uint32_t thread_count, MesoError *error);
MesoStatus meso_shapes_ready(MesoShapes *shapes, MesoArena *arena, MesoShapeUse use, float low, float high,
                             MesoError *error);

/* The box around a shape, relative to the anchor. */
MesoBox meso_shape_bounds(const MesoShapes *shapes, uint32_t shape);

/* The box around all of them; empty where there are none. */
MesoBox meso_shapes_box(const MesoShapes *shapes);

/* Shapes that are looked at together; each is in one bundle. */
enum { MESO_SHAPE_BUNDLE = MESO_BUNDLE_SWEEPS };
typedef struct MesoShapeBundle {
    uint32_t count;
    uint32_t shapes[MESO_SHAPE_BUNDLE];
    MesoBox bounds[MESO_SHAPE_BUNDLE];
    bool made;
    MesoMadeSweep sweeps[MESO_SHAPE_BUNDLE];    /* where they are made: their hulls; most are soon out of sight */
} MesoShapeBundle;
void meso_shape_bundle(const MesoShapes *shapes, uint32_t bundle, MesoShapeBundle *out);

/* Where shape `i` of a bundle is in a view, as narrow as is known. */
MesoRasterRect meso_shape_rect(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i,
                               const MesoRasterView *view);

/* Corners of sweeps of the same columns: those of fewer rings come first. */
typedef struct MesoShapeCorners {
    const MesoShapeColumns *columns;
    uint32_t *corners;
    uint32_t ring_count, quad_room;
} MesoShapeCorners;
enum { MESO_SHAPE_CORNERS = 61 };       /* that are kept: sweeps of a few kinds take turns */

/* A shape as triangles; t = 2 face + half. */
typedef struct MesoShapeMesh {
    uint32_t vertex_count, triangle_count;
    MesoMeshVertex *vertices;   /* [vertex_count] relative to the anchor; uv.y is how far along a sweep */
    MesoMeshColor *colors;      /* [vertex_count] of a body that has some; NULL: white */
    const uint32_t *corners;    /* [3 * triangle_count] counter-clockwise from outside */
    bool closed;                /* nothing of its inside is seen, but for its ends */
    const MesoShapeColumns *columns;    /* of a sweep: its vertices are rings of these; NULL: of a run */
    uint32_t ring_count;
    float reach;                /* of the surface before what was made for its shadow */
    bool placed;                /* there are points, and neither vertices nor corners, which are left as they were */
    float *points;              /* x, then y, then z [3 * point_room] of the places of one ring after the other */
    uint32_t point_room;
    uint32_t vertex_room, run_room;
    uint8_t *wanted;            /* [vertex_room] */
    MesoMeshColor *color_room;
    uint32_t *run_corners;      /* [6 * run_room] of a run */
    MesoShapeCorners sets[MESO_SHAPE_CORNERS];
} MesoShapeMesh;

/*
 * Makes a shape within `tolerance` of its own surface (0: all of it): the same triangles to be seen and to be looked
 * at. The mesh begins zeroed, and is used again for the next; its arrays grow by realloc(). False where memory is out.
 */
bool meso_shape_make(const MesoShapes *shapes, uint32_t shape, float tolerance, MesoShapeUse use, MesoShapeMesh *mesh);
bool meso_shape_make_bundled(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i, float tolerance,
                             MesoShapeUse use, MesoShapeMesh *mesh);

/*
 * The same for meso_shape_points() alone (shape_points.h), the same numbers, which is quicker: a sweep whose section
 * keeps its shape is placed, others are made.
 */
bool meso_shape_place(const MesoShapes *shapes, uint32_t shape, float tolerance, MesoShapeUse use, MesoShapeMesh *mesh);
bool meso_shape_place_bundled(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i, float tolerance,
                              MesoShapeUse use, MesoShapeMesh *mesh);

/* Makes it to be looked at; vertices of no triangle of which `seen` [triangles] is not 0 are anything. */
bool meso_shape_make_seen(const MesoShapes *shapes, uint32_t shape, float tolerance, const uint8_t *seen,
                          MesoShapeMesh *mesh);
void meso_shape_mesh_release(MesoShapeMesh *mesh);

/* A corner of a shape's triangle: a place that a shape of another scene, of the same structure, has too. */
typedef struct MesoShapeCorner {
    uint32_t column, ring, ring_count;  /* of a sweep */
    uint32_t vertex;                    /* of a body */
} MesoShapeCorner;

/* The corners of a triangle of what meso_shape_make() makes to be seen; O(1). */
void meso_shape_corners(const MesoShapes *shapes, uint32_t shape, float tolerance, uint32_t triangle,
                        MesoShapeCorner corners[3]);

/* Where it lies, relative to the anchor. */
MesoVec3 meso_shape_corner_at(const MesoShapes *shapes, uint32_t shape, const MesoShapeCorner *corner);

/* Row of the scene's ids, and material of a shape: blended from the first to the second along a sweep. */
typedef struct MesoShapeLook {
    uint32_t ids, start_material, end_material;
} MesoShapeLook;
MesoShapeLook meso_shape_look(const MesoShapes *shapes, uint32_t shape);

#endif
