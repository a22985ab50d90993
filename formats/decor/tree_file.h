/* The tree of a finished pattern's regions as JSON, "meso-regions", version 1. */
#ifndef MESO_TREE_FILE_H
#define MESO_TREE_FILE_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"
#include "libcore/decor/decor.h"

enum { MESO_REGIONS_VERSION = 1 };

/*
 * {"format", "version", "provenance", "operations", "regions": [...]}, by number: each with "path", "name", "tag",
 * "number", "depth", "operation" that made it, "area", "perimeter", "borders", "corners", "aspect", and either
 * "children", numbers, or "triangles" and "neighbours", leaves across its borders. O(triangles * depth).
 */
MesoStatus meso_tree_write(const MesoDecor *decor, const MesoProvenance *provenance, MesoOutput *output,
                           MesoError *error);

#endif
