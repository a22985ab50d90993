/* The work of meso-decor: pattern and surface in; regions, scene, tree and lines out, for one seed or many. */
#ifndef MESO_DECOR_JOB_H
#define MESO_DECOR_JOB_H

#include "cmd/common/scene_output.h"

typedef struct MesoDecorArguments {
    MesoTool tool;
    MesoSceneOutput output;
    const char *tree, *lines;   /* --tree, --lines */
    const char *seeds;          /* --seeds */
    const char *engine;         /* --geodesics */
    uint32_t until;             /* --until; 0: all */
} MesoDecorArguments;

MesoStatus meso_decor_job_run(MesoDecorArguments *arguments);

#endif
