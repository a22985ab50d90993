/* Drawings (SVG): what stands around their paths. */
#ifndef MESO_SVG_FRAME_H
#define MESO_SVG_FRAME_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"

/*
 * Begins a drawing of a size, with a margin of 10 around it: the provenance as an element `metadata`, and a style sheet.
 * MESO_ERR_MEMORY, and what the output gives.
 */
MesoStatus meso_svg_begin(double width, double height, const MesoProvenance *provenance, const char *style,
                          MesoOutput *output, MesoError *error);

MesoStatus meso_svg_end(MesoOutput *output, MesoError *error);

#endif
