/* The steps of meso-mesh: words with an optional argument, checked before anything is read. */
#ifndef MESO_MESH_STEPS_H
#define MESO_MESH_STEPS_H

#include "cmd/common/tool.h"
#include "libcore/mesh/refine/subdivide.h"

/* Counts that a step gives, in words as the report has them: "vertices_gone". */
enum { MESO_STEP_COUNTS = 4 };

typedef struct MesoStepCount {
    const char *name;
    uint32_t count;
} MesoStepCount;

typedef struct MesoMeshStep MesoMeshStep;

/* What steps work on. */
typedef struct MesoMeshWork {
    MesoTool *tool;
    MesoPolygonMesh mesh;       /* as the last step left it */
    MesoArena arena;            /* of `mesh` and nothing else */
    MesoArena next;             /* for the result of the step under way */
    uint32_t looped;            /* faces that were read as their loops, until clean has counted them */
    double crease;              /* --crease */
    json_t *infos;              /* array, for the report */
    MesoStepCount counts[MESO_STEP_COUNTS];     /* of the last step */
    uint32_t count_count;
} MesoMeshWork;

typedef struct MesoMeshStepKind {
    const char *word;
    const char *argument;       /* "DISTANCE", "[=SCHEME][,N]"; NULL: takes none */
    const char *help;           /* a line or more, each of at most 76 characters */
    MesoStatus (*parse)(MesoMeshStep *step, const char *argument,
                        MesoError *error);  /* `argument` is NULL without "=" */
    MesoStatus (*run)(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
} MesoMeshStepKind;

struct MesoMeshStep {
    const MesoMeshStepKind *kind;
    const char *text;           /* as given */
    double number;              /* distance; faces, or percent */
    bool percent;
    MesoScheme scheme;
    uint32_t level_count;
};

/* Ends with a zeroed entry. */
extern const MesoMeshStepKind meso_mesh_step_kinds[];

/* MESO_ERR_USAGE names the word, the nearest one that there is, or what its argument should be. */
MesoStatus meso_mesh_step_parse(MesoMeshStep *step, const char *text, MesoError *error);

/* Prints what all steps do, or what the one called `word` does; MESO_ERR_USAGE where there is none. */
MesoStatus meso_mesh_steps_help(const char *word, MesoError *error);

/*
 * Does a step on work->mesh, which its result takes the place of: what was there goes, but for steps that change
 * nothing. The error is the tool's.
 */
MesoStatus meso_mesh_step_run(const MesoMeshStep *step, MesoMeshWork *work);

/* Frees the mesh, and what a failed step left. */
void meso_mesh_work_release(MesoMeshWork *work);

/* What each step does; results go to work->next, or are work->mesh. */
MesoStatus meso_mesh_run_info(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_weld(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_clean(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_separate(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_orient(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_triangulate(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_pair(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_subdivide(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_decimate(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);
MesoStatus meso_mesh_run_convert(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result);

#endif
