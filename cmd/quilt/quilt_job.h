/* The work of meso-quilt: a swatch and a surface in, the quilt out, for one seed or many; or a swatch by recipe. */
#ifndef MESO_QUILT_JOB_H
#define MESO_QUILT_JOB_H

#include "cmd/quilt/quilt_arguments.h"

MesoStatus meso_quilt_job_run(MesoQuiltArguments *arguments);

#endif
