/* Constraints of meso-solve from files (.json, "meso-constraints", version 1): meso-constraints(5). */
#ifndef MESO_CONSTRAINTS_FILE_H
#define MESO_CONSTRAINTS_FILE_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/mesh/boundary.h"
#include "libcore/mesh/polygon_mesh.h"
#include "libcore/tiling/problem/constraints.h"

enum { MESO_CONSTRAINTS_VERSION = 1, MESO_CONSTRAINTS_ITEMS = 1 << 20 };    /* the most items of a list */

/* What the names and numbers of a file refer to. */
typedef struct MesoConstraintScope {
    const MesoTileSet *set;
    const MesoVariantSet *variants;
    const MesoSlotGraph *graph;
    const MesoBoundary *boundary;
    const MesoPolygonMesh *mesh;    /* of the surface, with its attributes */
} MesoConstraintScope;

/*
 * Reads a file into `arena`. MESO_ERR_INPUT names the file and the place
 * ("pins[3].tile: unknown tile 'x'"), the line and column where the JSON
 * itself is broken, and a newer version; a place that selects no slot is an
 * error too. MESO_ERR_LIMIT where all places, or all tables of weights,
 * would take over 2 GiB. O(size of the file * slots) at most.
 */
MesoStatus meso_constraints_read(MesoConstraints *constraints, MesoArena *arena, const MesoInput *input,
                                 const MesoConstraintScope *scope, MesoError *error);

/* How many entries a file has of each kind. */
typedef struct MesoConstraintOutline {
    uint32_t weight_count;      /* tiles with a weight, of regions not */
    uint32_t pin_count, region_count, border_count, quota_count;
} MesoConstraintOutline;

/*
 * Format, version, keys and lists of `root`, without what names and numbers in them refer to; texts go
 * to `arena`. MESO_ERR_INPUT names `path` and the place.
 */
MesoStatus meso_constraints_outline(MesoConstraintOutline *outline, MesoArena *arena, const json_t *root,
                                    const char *path, MesoError *error);

/*
 * Rules on strands from text: "connected", "acyclic", "no-loops",
 * "max-length=N", or several with commas between. Adds to `rule`.
 * MESO_ERR_USAGE says what is possible.
 */
MesoStatus meso_strand_rule_parse(MesoStrandRule *rule, const char *text, MesoError *error);

#endif
