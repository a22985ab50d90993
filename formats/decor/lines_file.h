/* The lines of a pattern as drawings: in space, or seen from one side. */
#ifndef MESO_LINES_FILE_H
#define MESO_LINES_FILE_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"
#include "libcore/decor/decor.h"

/*
 * As OBJ: vertices and "l" statements, one a segment, with a group for each operation. O(segments).
 * decor->lines must have been kept.
 */
MesoStatus meso_lines_obj_write(const MesoDecor *decor, const MesoProvenance *provenance, MesoOutput *output,
                                MesoError *error);

/*
 * As SVG, seen along -Z: X to the right, Y upwards, 1000 units wide or high; one path for each operation, what lies
 * behind the middle of the depth paler. O(segments).
 */
MesoStatus meso_lines_svg_write(const MesoDecor *decor, const MesoProvenance *provenance, MesoOutput *output,
                                MesoError *error);

#endif
