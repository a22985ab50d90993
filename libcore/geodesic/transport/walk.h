/* What a walk is: from where, how far, and what is told of it. */
#ifndef MESO_WALK_H
#define MESO_WALK_H

#include "libcore/geodesic/transport/walk_ground.h"

/* A point of the surface with a direction. */
typedef struct MesoTip {
    uint32_t triangle;
    bool turned;            /* the triangle is wound against the one in which all began: left is right */
    double weight[3];       /* of its corners, not negative, together 1 */
    MesoComplex heading;    /* in the triangle's frame, of length 1 */
} MesoTip;

typedef enum MesoWalkStop {
    MESO_WALK_DONE,         /* all of the length */
    MESO_WALK_BORDER,       /* on a border, with the heading out of the surface */
    MESO_WALK_LIMIT         /* the limit of crossings, on a side; it can go on */
} MesoWalkStop;

typedef struct MesoWalk {
    MesoTip tip;            /* from where, and then to where */
    double length;          /* to go, not negative; and then what is left of it */
    uint32_t crossings;     /* told: sides that were crossed */
    MesoWalkStop stop;      /* told */
} MesoWalk;

/* What a walk does in one triangle: straight from end to end. */
typedef struct MesoWalkPiece {
    uint32_t walk;          /* number of its walk */
    uint32_t triangle;
    bool turned;            /* as a tip's */
    uint8_t enters, leaves; /* sides that the ends lie on; 3: the walk's own first or last point */
    MesoComplex ends[2];    /* in the triangle's frame */
} MesoWalkPiece;

typedef struct MesoWalkOptions {
    uint32_t crossing_limit;    /* of a walk; 0: MESO_WALK_CROSSINGS; where a mesh has no area, walks may stand still */
    void (*piece)(void *context, const MesoWalkPiece *piece);   /* NULL: pieces are not told */
    void *context;
} MesoWalkOptions;

enum { MESO_WALK_CROSSINGS = 1 << 24 };

#endif
