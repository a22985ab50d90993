/* The options by which meso-solve takes constraints, and their reading. */
#ifndef MESO_SOLVE_CONSTRAINTS_H
#define MESO_SOLVE_CONSTRAINTS_H

#include "cmd/solve/solve_inputs.h"
#include "cmd/solve/solve_surface.h"

typedef struct MesoControlArguments {
    const char *constraints;    /* file, or NULL */
    const char *strands;        /* rules in words, or NULL */
    const char *keep;           /* assignment file, or NULL */
} MesoControlArguments;

#define MESO_CONTROL_OPTIONS(control)                                                             \
    MESO_INPUT_FILE(0, "constraints", "FILE", "pins, regions, weights, border rules and quotas (JSON)", \
                    &(control).constraints), \
    MESO_TEXT(0, "strands", "RULES", "connected, acyclic, no-loops, max-length=N, or several", \
              &(control).strands), \
    MESO_INPUT_FILE(0, "keep", "OLD.slots", "change as few slots of this assignment as possible", \
                    &(control).keep)

/*
 * Reads what the arguments name, and notes the files in the provenance.
 * `*constraints` becomes NULL where the arguments ask for nothing. Constraints
 * name sides by direction, as the surface is oriented.
 */
MesoStatus meso_tool_read_control(MesoTool *tool, const MesoControlArguments *arguments, const MesoTileSet *set,
                                  const MesoVariantSet *variants, const MesoSolveSurface *surface,
                                  const MesoConstraints **constraints);

#endif
