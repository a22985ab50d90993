/*
 * Phases of stripes over a surface: where the strands of a woven swatch should
 * lie, so that patches which have grown from elsewhere meet strand by strand.
 *
 * In each triangle a phase along the guide and one across it, which grow by
 * 2 pi a pitch; from a triangle to the next as the way between them says, and
 * up to the quarter turns that the guide takes ("Stripe Patterns on Surfaces",
 * Knoeppel et al. 2015, in triangles, two stripes at once). Where the surface
 * has no room for it, stripes end: there phases are of little weight. Guides
 * that turn otherwise than stripes a pitch apart would are turned to these, as
 * far as is allowed: stripes need not stretch for it then. Not so where they fit
 * so badly that it would be of no use.
 */
#ifndef MESO_STRIPE_PHASES_H
#define MESO_STRIPE_PHASES_H

#include "libcore/field/triangle_frames.h"

typedef struct MesoStripePhases {
    const MesoTriangulation *mesh;
    const MesoTriangleFrame *frames;    /* [triangle_count] */
    const MesoComplex *guides;          /* [triangle_count] of length 1, as stripes run; turned by half a right angle
                                           where diagonal */
    MesoVec3 *directions;       /* [triangle_count] the guides that were given, turned to where stripes run */
    uint32_t turn_count;        /* 1, 2 or 4 */
    bool diagonal;              /* stripes run at half a right angle to the guides that were given */
    double pitches[2];          /* along the guide and across, in the surface's units */
    double (*waves)[4];         /* [triangle_count] real and imaginary parts, along and across, in the guide's frame */
    double strain;              /* how far these are from growing by the pitch, RMS, as a share */
} MesoStripePhases;

/* From a triangle over one of its sides. */
typedef struct MesoStripeStep {
    uint32_t quarters;          /* the neighbour's guide and so many quarter turns are this one's */
    double ways[2];             /* between the centroids, along this one's guide and across, in the surface's units */
} MesoStripeStep;

typedef struct MesoStripeOptions {
    uint32_t turn_count;    /* by so many turns the guide is known: 1, 2 or 4 */
    double pitches[2];      /* in the surface's units, > 0; their mean where they can take each other's place */
    bool diagonal;          /* stripes along the diagonals, as far apart as crossings are there: these keep apart
                               what is above and what is below where strands are so by turns, which one strand more
                               or less does not */
    double turn_most;       /* by how much guides may be turned to where stripes run; 0: they stay as they are */
    uint32_t thread_count;  /* 0: all cores */
} MesoStripeOptions;

/*
 * guides      [mesh->triangle_count] of any length; their part along the triangle counts
 *
 * To `arena`. Same arguments, same bytes, for any number of threads. O(triangles), times some thousands of steps of
 * conjugate gradients. MESO_ERR_MEMORY.
 */
MesoStatus meso_stripe_phases(MesoStripePhases *phases, MesoArena *arena, const MesoTriangulation *mesh,
                              const MesoVec3 *guides, const MesoStripeOptions *options, MesoError *error);

MesoStripeStep meso_stripe_step(const MesoStripePhases *phases, uint32_t half_edge, uint32_t across);

/* By how much more the phases grow over a side than its ways say, in the surface's units: by half a pitch at most. */
void meso_stripe_excess(double more[2], const MesoStripePhases *phases, uint32_t half_edge, uint32_t across,
                        const MesoStripeStep *step);

/* Two waves, or two lengths, as they are in a frame of which the one that they are in is so many quarters ahead. */
void meso_stripe_turn_waves(double to[4], const double from[4], uint32_t quarters);
void meso_stripe_turn_ways(double to[2], const double from[2], uint32_t quarters);

#endif
