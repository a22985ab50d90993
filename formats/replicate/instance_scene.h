/* What files of instances are written from: shapes, a surface that moves, and where each frame has its details. */
#ifndef MESO_INSTANCE_SCENE_H
#define MESO_INSTANCE_SCENE_H

#include "formats/product/provenance.h"
#include "libcore/replicate/detail/surface_detail.h"
#include "libcore/scene/material.h"

typedef struct MesoInstanceShape {
    const char *name;
    const MesoMaterial *material;
    uint32_t vertex_count, triangle_count;
    const MesoVec3 *positions;  /* [vertex_count] of a detail of size 1: x along its heading, z along the normal */
    const MesoVec3 *normals;    /* [vertex_count] unit length; NULL: flat */
    const uint32_t *corners;    /* [3 * triangle_count] */
} MesoInstanceShape;

typedef struct MesoInstanceScene {
    uint32_t shape_count;
    const MesoInstanceShape *shapes;    /* [shape_count] by the details' kind; those without triangles are not shown */
    const MesoInstanceShape *surface;   /* its positions and normals are those of each frame; NULL: not shown */
    const MesoProvenance *provenance;   /* may be NULL */
    bool z_up;                          /* z is up, and not y */
    float unit;                         /* in metres; 0: 1 */
} MesoInstanceScene;

static inline float meso_instance_unit(const MesoInstanceScene *scene)
{
    return scene->unit > 0 ? scene->unit : 1;
}

typedef struct MesoInstanceFrame {
    uint32_t count;                     /* the first so many details: their numbers are the ids of the whole clip */
    const MesoDetail *details;          /* [count] */
    const MesoPlacedDetail *placed;     /* [count] those of size 0 are left out */
    const MesoVec3 *positions, *normals;    /* [vertex_count] of the surface, where it is shown */
} MesoInstanceFrame;

typedef struct MesoInstance {
    MesoVec3 position;
    float rotation[4];      /* x, y, z, w: a quaternion of length 1, w not negative */
    MesoVec3 scale;
} MesoInstance;

/* Whether a frame shows a detail. */
static inline bool meso_instance_shown(const MesoInstanceScene *scene, const MesoInstanceFrame *frame, uint32_t detail)
{
    const MesoPlacedDetail *placed = &frame->placed[detail];
    return placed->size > 0 && placed->width > 0 && scene->shapes[frame->details[detail].kind].triangle_count > 0;
}

/* The frame in which a detail was born; -1 where it was there from the start. */
static inline int32_t meso_instance_birth(const MesoDetail *detail)
{
    return detail->born == MESO_DETAIL_ORIGINAL ? -1 : detail->born;
}

/* Turned so that x is its tangent and z its normal. It is as high as the root of size times width. */
MesoInstance meso_instance_of(const MesoPlacedDetail *placed);

/* A name of letters, digits and '_' that begins with none of the digits, cut at `size`; `number` tells names apart. */
void meso_instance_name(const char *text, uint32_t number, char *name, size_t size);

#endif
