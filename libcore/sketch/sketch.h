/*
 * Sketches: bars, balls, faces and names that are put into a scene, to show what it does not draw itself. They come
 * part by part, each of one material.
 */
#ifndef MESO_SKETCH_H
#define MESO_SKETCH_H

#include "libcore/scene/scene.h"

/* Where a part begins in what the sketch has. */
typedef struct MesoSketchPart {
    const char *name;
    MesoMaterial material;
    uint32_t bar_begin, vertex_begin, face_begin;
} MesoSketchPart;

typedef struct MesoSketchBar {
    MesoVec3 a, b;
    float radius[2];            /* at both ends */
} MesoSketchBar;

/* Zeroed, it is an empty one. */
typedef struct MesoSketch {
    uint32_t part_count, part_room;
    MesoSketchPart *parts;
    uint32_t bar_count, bar_room;
    MesoSketchBar *bars;
    uint32_t vertex_count, vertex_room;
    MesoVec3 *positions, *normals;
    uint32_t face_count, face_room;
    MesoMeshFace *faces;
    bool failed;                /* memory is out */
} MesoSketch;

/* What follows is of this part; the name must outlive the scene. */
void meso_sketch_part(MesoSketch *sketch, const char *name, const float albedo[3]);

/* Round, open at its ends, and a little longer, so that bars which meet leave no gap; none where it has no length. */
void meso_sketch_bar(MesoSketch *sketch, MesoVec3 a, MesoVec3 b, float radius);
/* A cone from `a` to its point `b`. */
void meso_sketch_point(MesoSketch *sketch, MesoVec3 a, MesoVec3 b, float radius);
void meso_sketch_ball(MesoSketch *sketch, MesoVec3 middle, float radius);

/* A polygon with `count` corners, as a fan of triangles, or one quad. */
void meso_sketch_face(MesoSketch *sketch, uint32_t count, const MesoVec3 *positions, const MesoVec3 *normals);

/* A line of text: its letters stand on the line from `start` along `right`, `unit` a step of their grid
 * (stroke_font.h); seen from where cross(right, up) points. Both are unit. */
void meso_sketch_text(MesoSketch *sketch, MesoVec3 start, MesoVec3 right, MesoVec3 up, float unit, const char *text);

/*
 * Puts the parts into a scene whose sections do not deform, behind what is there; or makes one of a zeroed `scene`,
 * whose channel is "part"; so is that of a scene which has none. In each channel a part has an id of its own, by its
 * name where ids have names. The scene's arrays come to lie in `arena`; the sketch is empty then. MESO_ERR_MEMORY, or
 * MESO_ERR_LIMIT for over 2^16 - 1 materials.
 */
MesoStatus meso_sketch_finish(MesoSketch *sketch, MesoScene *scene, MesoArena *arena, MesoError *error);

#endif
