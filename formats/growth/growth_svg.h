/* What has grown as a drawing (SVG), seen from one side. */
#ifndef MESO_GROWTH_SVG_H
#define MESO_GROWTH_SVG_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"
#include "libcore/growth/engine/growth.h"

/*
 * Every element as the cubic curve that it is bent along, as wide as its joints, seen from the front (+Z, up is +Y)
 * and a thousand units large. What looks away lies behind, paler. Classes are the grammar's shapes.
 * O(elements).
 */
MesoStatus meso_growth_svg_write(const MesoGrown *grown, const MesoGrammar *grammar, const MesoProvenance *provenance,
                                 MesoOutput *output, MesoError *error);

#endif
