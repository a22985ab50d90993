/* A run of meso-replicate. */
#ifndef MESO_REPLICATE_JOB_H
#define MESO_REPLICATE_JOB_H

#include "cmd/replicate/replicate_arguments.h"

MesoStatus meso_replicate_job_run(MesoReplicateArguments *arguments);

#endif
