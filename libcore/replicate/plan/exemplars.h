/*
 * Exemplars: triangles of original details with others inside, which say how details lie that are born in a triangle
 * that has grown as large. Not all O(n^3) that there are, but those of details near each other, by area and smallest
 * angle in bins of limited size; which of them stay, chance decides ("Random Sampling with a Reservoir", Vitter 1985).
 */
#ifndef MESO_EXEMPLARS_H
#define MESO_EXEMPLARS_H

#include "libcore/replicate/detail/surface_detail.h"
#include "libcore/replicate/web/detail_web.h"

enum { MESO_EXEMPLAR_INSIDE = 6, MESO_EXEMPLAR_BINS = 24, MESO_EXEMPLAR_BIN_ROOM = 48, MESO_ORIGINAL_NEAR = 3 };

typedef struct MesoExemplar {
    float area, angle;          /* the smallest */
    uint32_t corners[3];        /* originals, counter-clockwise */
    uint32_t inside_count;
    uint32_t inside[MESO_EXEMPLAR_INSIDE];
    float weights[MESO_EXEMPLAR_INSIDE][3];     /* of the corners */
} MesoExemplar;

/* What exemplars are found by. */
typedef struct MesoExemplarKey {
    float area, angle;
    uint32_t inside_count;
} MesoExemplarKey;

/* What is known of an original at rest. */
typedef struct MesoOriginal {
    float area;                         /* of its cell: a third of the triangles around it */
    float log_area, log_size;
    float near[MESO_ORIGINAL_NEAR];     /* distances of the nearest others, ascending; INFINITY: no more */
    float aspect;                       /* of its ellipse, in whose norm distances are */
    uint32_t nearest;                   /* of those that it is joined to; MESO_NO_INDEX: none */
    float turn;                         /* its heading from that of the nearest */
    uint32_t kind;
} MesoOriginal;

typedef struct MesoExemplars {
    uint32_t original_count;
    MesoOriginal *originals;    /* [original_count] */
    double area, angle;         /* mean of the triangles; errors are relative to them */
    double most;                /* area of the largest bins */
    uint32_t *bin_counts;       /* [BINS * BINS] by area, then angle */
    MesoExemplarKey *keys;      /* [BINS * BINS * BIN_ROOM] of `bins` */
    MesoExemplar *bins;         /* [BINS * BINS * BIN_ROOM] */
} MesoExemplars;

/*
 * Of the details of a web at rest. Arrays are in the arena: 4 MB and what originals take. O(originals), and for the
 * exemplars themselves O(1). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_exemplars_build(MesoExemplars *out, MesoArena *arena, const MesoTriangulation *rest, const MesoWeb *web,
                                const MesoDetail *details, uint64_t seed, MesoError *error);

/*
 * The exemplars most similar to a triangle: max(|area - area'| / mean area, |angle - angle'| / mean angle), equation 3.
 * At most `room`, those with at most `inside_limit` inside; returns how many.
 */
uint32_t meso_exemplars_near(const MesoExemplars *exemplars, double area, double angle, uint32_t inside_limit,
                             const MesoExemplar **out, uint32_t room);

/* Smallest angle of a triangle with these squared sides. */
double meso_smallest_angle(double a2, double b2, double c2);

#endif
