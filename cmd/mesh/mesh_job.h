/* The work of meso-mesh: a surface is read, steps are done, the result is written. */
#ifndef MESO_MESH_JOB_H
#define MESO_MESH_JOB_H

#include "cmd/common/tool.h"

typedef struct MesoMeshArguments {
    MesoTool tool;
    float crease;               /* degrees */
} MesoMeshArguments;

/*
 * Operands are steps, and then the surface. All of them are checked before it is read. Memory is that of the meshes
 * before and after a step, and of what the step needs: the largest of these sums.
 */
MesoStatus meso_mesh_job_run(MesoMeshArguments *arguments);

#endif
