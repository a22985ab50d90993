/*
 * How good a quilt is, apart from how it was made: its mesh, its elements, what
 * cuts through what, and how much it looks like its swatch. It is measured
 * where it lies, on the positions of its vertices in space.
 */
#ifndef MESO_QUILT_CHECK_H
#define MESO_QUILT_CHECK_H

#include "libcore/quilt/check/check_cover.h"
#include "libcore/quilt/check/check_crossings.h"
#include "libcore/quilt/check/check_likeness.h"
#include "libcore/quilt/check/check_seams.h"
#include "libcore/quilt/check/check_sections.h"

typedef struct MesoQuiltCheckOptions {
    float scale;                /* as of MesoQuiltOptions, > 0 */
    float height_scale;         /* 0: as `scale` */
    float offset;
    uint32_t window_count;      /* of likeness, at most; 0: 32 */
    uint32_t thread_count;      /* 0: all cores */
} MesoQuiltCheckOptions;

typedef struct MesoQuiltCheck {
    MesoMeshFaults faults;      /* places that are not finite: nothing that follows is measured then */

    /* Its elements, against those of the swatch that they come from. */
    uint32_t whole_count;       /* elements that are placed whole */
    uint32_t changed_count;     /* of these, such with another number of triangles, another genus or open edges */
    uint32_t squeezed_count;    /* of the others, such whose volume is off by more than a tenth */
    double least_volume, largest_volume;    /* of those not changed, as shares; 1 where there are none */
    double expected_whole_count;            /* by area */
    uint32_t strand_count;
    uint32_t merged_count;      /* elements with triangles of several elements of the swatch */
    uint32_t apart_count;       /* elements that do not hang together */
    double expected_triangle_count;         /* by area */
    double area_share;          /* of all triangles, against what the swatch has on that area */

    MesoSections sections;      /* of strands */

    MesoCrossings crossings, swatch_crossings;
    double expected_crossings;  /* as many as the swatch has on that area */

    MesoSeams seams;
    MesoCover cover;
    MesoLikeness likeness;

    double seconds[5];          /* mesh and elements, crossings, seams, cover, likeness */
} MesoQuiltCheck;

/*
 * Measures a quilt as meso_quilt_grow() or meso_quilt_finish() leaves it.
 *
 * arena        for scratch, given back
 * positions    [quilt->vertex_count] in space
 * base         the surface that it covers: its area is what counts by area refer to
 *
 * The same for any number of threads, but for the seconds. O(n log n). MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_check(MesoQuiltCheck *check, MesoArena *arena, const MesoQuilt *quilt, const MesoSwatch *swatch,
                            const MesoVec3 *positions, const MesoTriangulation *base,
                            const MesoQuiltCheckOptions *options, MesoError *error);

#endif
