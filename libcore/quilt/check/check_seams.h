/* Whether seams can be told from what is elsewhere. */
#ifndef MESO_CHECK_SEAMS_H
#define MESO_CHECK_SEAMS_H

#include "libcore/quilt/check/check_mesh.h"

/*
 * Edges that leave vertices between triangles of different patches, against all others of those elements that have such.
 * Each edge leaves both of its ends: so seams have edges of each direction in the same shares as all else.
 */
typedef struct MesoSeams {
    uint64_t seam_edge_count, other_edge_count;
    /* statistics of Kolmogorov and Smirnov, 0 to 1: lengths of edges, and angles between the normals on both sides */
    double length_distance, angle_distance;
    /*
     * The same against the same places of the swatch elsewhere. Strands are not alike everywhere, and are cut at some
     * of their places rather than at others, say where they run straight: copies of a strand without any fault differ
     * at their seams from the rest of themselves. Here others count as often as edges from their origin are at seams,
     * shared out among all that are elsewhere; what is nowhere else is left out. As above where origins are not known.
     */
    double placed_length_distance, placed_angle_distance;
} MesoSeams;

/* Distributions are told by 4096 bins: lengths by a factor of 1.004, angles by 0.044 degrees. O(triangles). */
MesoStatus meso_check_seams(MesoSeams *seams, MesoArena *scratch, const MesoCheckMesh *mesh, MesoError *error);

#endif
