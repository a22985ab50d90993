/* What a file of details says: kinds of details, and how each distribution of them comes about. */
#ifndef MESO_DETAILS_SPEC_H
#define MESO_DETAILS_SPEC_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/math/vec.h"
#include "libcore/scene/material.h"

enum {
    MESO_DETAILS_VERSION = 1,
    MESO_DETAILS_KINDS = 1 << 10,       /* the most kinds, and the most distributions */
    MESO_DETAILS_POINTS = 1 << 24       /* the most points of all distributions */
};

typedef enum MesoDetailGeometry {
    MESO_DETAIL_MESH,       /* a mesh on top: its x axis along the heading, its z axis along the normal */
    MESO_DETAIL_BUMP,       /* the surface goes up, or down */
    MESO_DETAIL_HOLE        /* the surface has a hole */
} MesoDetailGeometry;

/* Height over the distance r from the middle in shares of the detail's radius; 0 at 1. */
typedef enum MesoBumpProfile {
    MESO_BUMP_GAUSS,        /* highest in the middle */
    MESO_BUMP_RING,         /* highest at a half */
    MESO_BUMP_IMAGE         /* as bright as a picture, which lies over the detail, its width along the heading */
} MesoBumpProfile;

typedef struct MesoDetailKind {
    const char *name;
    MesoDetailGeometry geometry;
    const char *file;       /* of the mesh or the picture, as it is written; "" for others */
    float length;           /* what is so long in the mesh becomes a detail's size; 0: all of it along x */
    float lift;             /* of a mesh over the surface, in shares of the size */
    bool upright;           /* a mesh stands up straight, whatever the slope */
    MesoBumpProfile profile;
    float height;           /* of a bump, in shares of the size; not positive goes down */
    uint32_t material;
    bool own_material;      /* `material` was given; else a mesh may bring its own, and a bump is as the surface */
} MesoDetailKind;

typedef enum MesoDetailSource {
    MESO_DETAILS_AT_POINTS, MESO_DETAILS_POISSON, MESO_DETAILS_SCATTERED, MESO_DETAILS_OF_SCENE
} MesoDetailSource;

/* A number of the surface, or of a picture over its texture coordinates, brought to [0,1]. */
typedef struct MesoDetailMap {
    bool given;
    const char *attribute;  /* of the surface; NULL: the picture's */
    const char *image;      /* as it is written */
    uint32_t channel;       /* of either, from 0 */
    float low, high;        /* what becomes 0, and what 1; may be in any order, not equal */
} MesoDetailMap;

typedef enum MesoHeadingSource {
    MESO_HEADING_RANDOM,
    MESO_HEADING_DIRECTION, /* of space, laid into the surface */
    MESO_HEADING_ATTRIBUTE, /* vectors that the surface brings */
    MESO_HEADING_SCENE      /* as the scene has it */
} MesoHeadingSource;

typedef struct MesoDetailHeading {
    MesoHeadingSource source;
    MesoVec3 direction;     /* not zero */
    const char *attribute;
    float spread;           /* radians to either side, evenly */
} MesoDetailHeading;

/* A point that says more than where it is. */
typedef struct MesoDetailPoint {
    MesoVec3 position;
    float size, aspect;             /* NAN: as its distribution says */
    uint32_t kind;                  /* MESO_NO_INDEX: likewise */
    bool headed;
    MesoVec3 direction;             /* not zero, where it is headed */
} MesoDetailPoint;

typedef struct MesoDetailDistribution {
    MesoDetailSource source;
    uint32_t point_count;
    const MesoDetailPoint *points;  /* [point_count] of points */
    float radius;                   /* of Poisson; 0: by count */
    uint32_t count;                 /* of Poisson, and of what is scattered */
    const char *scene;              /* its file, as it is written */
    const char *channel;            /* of the ids that tell instances apart; NULL: its first one */
    MesoDetailMap density;          /* share of points that stay; of Poisson, scattered: how densely they stand */
    float size[2], aspect[2];       /* of each detail between these, evenly; the aspect is width over size */
    bool sized;                     /* `size` was given: a scene has sizes of its own */
    MesoDetailMap size_map;         /* from size[0] to size[1]; evenly where it is not given */
    MesoDetailHeading heading;
    const float *shares;            /* [kind_count] of the kinds, adding up to 1 */
} MesoDetailDistribution;

typedef struct MesoDetailsFile {
    uint32_t material_count;        /* at least one */
    const MesoMaterial *materials;
    const char *const *material_names;
    uint32_t kind_count;            /* at least one */
    const MesoDetailKind *kinds;
    uint32_t distribution_count;    /* at least one */
    const MesoDetailDistribution *distributions;
} MesoDetailsFile;

#endif
