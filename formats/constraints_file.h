/* Constraints of meso-solve from files (.json, "meso-constraints", version 1): meso-constraints(5). */
#ifndef MESO_CONSTRAINTS_FILE_H
#define MESO_CONSTRAINTS_FILE_H

#include "formats/input.h"
#include "formats/surface_groups.h"
#include "libcore/solve/constraints.h"
#include "libcore/surface/boundary.h"

enum { MESO_CONSTRAINTS_VERSION = 1, MESO_CONSTRAINTS_ITEMS = 1 << 20 };    /* the most items of a list */

/* What the names and numbers of a file refer to. */
typedef struct MesoConstraintScope {
    const MesoTileSet *set;
    const MesoVariantSet *variants;
    const MesoSlotGraph *graph;
    const MesoBoundary *boundary;
    const MesoSurfaceGroups *groups;
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

/*
 * Rules on strands from text: "connected", "acyclic", "no-loops",
 * "max-length=N", or several with commas between. Adds to `rule`.
 * MESO_ERR_USAGE says what is possible.
 */
MesoStatus meso_strand_rule_parse(MesoStrandRule *rule, const char *text, MesoError *error);

#endif
