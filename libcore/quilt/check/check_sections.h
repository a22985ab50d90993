/* Whether strands are as thick as they are in the swatch. */
#ifndef MESO_CHECK_SECTIONS_H
#define MESO_CHECK_SECTIONS_H

#include "libcore/quilt/check/check_mesh.h"

/* Areas of cross-sections, as shares of those at the same triangle of the swatch. */
typedef struct MesoSections {
    uint32_t count;             /* that were compared */
    uint32_t changed_count;     /* of these, less than three quarters or more than four thirds */
    double least, largest;      /* 1 where there are none */
    double rms;                 /* of the differences from 1 */
} MesoSections;

/*
 * Some thousands of triangles of strands are cut along their normal, in twelve directions; the smallest closed section
 * is the one across. Not where the swatch has no closed section, at its ends, nor where an edge of the triangle is
 * sharper than there: on a cap.
 *
 * mesh, sample     of the quilt and of the swatch
 * area_scale       how much larger sections are in the quilt
 *
 * O(sections * edges around them) and a pass over the elements.
 */
void meso_check_sections(MesoSections *sections, const MesoCheckMesh *mesh, const MesoCheckMesh *sample,
                         const MesoQuilt *quilt, const MesoSwatch *swatch, double area_scale);

#endif
