/* What drawings (SVG) say of how they came to be. */
#ifndef MESO_SVG_METADATA_H
#define MESO_SVG_METADATA_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"

/* The provenance as an element `metadata`. MESO_ERR_MEMORY, and what the output gives. */
MesoStatus meso_svg_metadata(const MesoProvenance *provenance, MesoOutput *output, MesoError *error);

#endif
