/* The options by which meso-solve chooses engines, budgets and proofs. */
#ifndef MESO_SOLVE_ENGINE_H
#define MESO_SOLVE_ENGINE_H

#include "cmd/common/tool.h"
#include "formats/file/output.h"
#include "libcore/tiling/solve/solve.h"

typedef struct MesoEngineArguments {
    const char *engine;         /* auto, wfc, exact */
    uint32_t observations;      /* 0: not given */
    uint32_t conflicts;
    float budget;               /* seconds; 0: not given */
    const char *proof;          /* file, or NULL */
} MesoEngineArguments;

#define MESO_ENGINE_DEFAULTS {"auto", 0, MESO_SOLVE_CONFLICTS, 0, NULL}

#define MESO_ENGINE_OPTIONS(arguments)                                                            \
    MESO_CHOICE(0, "engine", "NAME", "auto, wfc (search alone) or exact (no search)", &(arguments).engine, \
                "auto|wfc|exact"), \
    MESO_COUNT(0, "observations", "N", "choices of the search before giving up (default: no limit)", \
               &(arguments).observations, 1, 4294967295.0), \
    MESO_COUNT(0, "conflicts", "N", "conflicts of the exact engine before giving up (default 2000000)", \
               &(arguments).conflicts, 1, 4294967295.0), \
    MESO_NUMBER(0, "budget", "SECONDS", "time before giving up (default: no limit)", &(arguments).budget, \
                0.001, 1e9), \
    MESO_OUTPUT_FILE(0, "proof", "FILE", \
                     "write the exact engine's proof (DRAT), and its formula to FILE.cnf", \
                     &(arguments).proof)

/* Sets engine and budgets but that of time, which is no part of what a result depends on. */
void meso_engine_choose(const MesoEngineArguments *arguments, MesoSolveOptions *options);

/* What the arguments mean while a solve runs. */
typedef struct MesoEngineRun {
    double deadline;            /* of the monotonic clock */
    MesoOutput *proof, *formula;    /* NULL: none asked for */
    const char *proof_path, *formula_path;
    MesoError *error;           /* of the tool */
    MesoStatus status;          /* of writing proof and formula */
    uint64_t clause_count;
    uint32_t variable_count, used;
    char buffer[1 << 16];       /* [used] clauses not yet written */
} MesoEngineRun;

/*
 * Starts the clock, opens the files of the proof, and sets engine, budgets and callbacks in
 * `options`. `run` must outlive the solve; meso_engine_finish() is due in any case.
 */
MesoStatus meso_engine_start(MesoEngineRun *run, MesoTool *tool, const MesoEngineArguments *arguments,
                             MesoSolveOptions *options);

/*
 * Makes the files of the proof appear where `result` (NULL after a failure) is the
 * exact engine's, and a no; where there is no such proof, says so.
 */
MesoStatus meso_engine_finish(MesoEngineRun *run, MesoTool *tool, const MesoSolveResult *result);

#endif
