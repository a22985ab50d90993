/* The assignments that meso-solve --seeds writes: each what its seed alone would give. */
#ifndef MESO_SOLVE_EACH_H
#define MESO_SOLVE_EACH_H

#include "cmd/common/seed_list.h"
#include "cmd/solve/seed_problem.h"
#include "formats/tiling/result/seed_lines.h"

typedef struct MesoSeedEach {
    MesoTool *tool;
    const MesoSeedProblem *problem;
    const char *pattern;        /* of --each; NULL: not given */
    const MesoSeedList *list;   /* of --seeds */
} MesoSeedEach;

/* Refuses names that are those of inputs, of other outputs, or of two seeds. MESO_ERR_USAGE. */
MesoStatus meso_each_check_paths(const MesoSeedEach *each, MesoError *error);

/* Writes the assignment of `seed` to the file of the pattern, or to `path`. Any thread may. */
MesoStatus meso_each_write(const MesoSeedEach *each, uint64_t seed, const MesoAssignment *assignment, MesoError *error);
MesoStatus meso_each_write_to(const MesoSeedEach *each, uint64_t seed, const MesoAssignment *assignment,
                              const char *path, MesoArena *arena, MesoError *error);

/* Whether the file of the pattern is there, and what the seed of `line`, of this problem, gives. */
MesoStatus meso_each_find(bool *there, const MesoSeedEach *each, const MesoSeedLine *line, MesoArena *arena,
                          MesoError *error);

#endif
