/* The work of meso-grow: a grammar and a surface in, what grows out, for one seed or many. */
#ifndef MESO_GROW_JOB_H
#define MESO_GROW_JOB_H

#include "cmd/grow/grow_arguments.h"

MesoStatus meso_grow_job_run(MesoGrowArguments *arguments);

#endif
