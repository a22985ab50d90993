/* Test sequences: a surface that is deformed. */
#ifndef MESO_REPLICATE_DEFORM_H
#define MESO_REPLICATE_DEFORM_H

#include "cmd/replicate/replicate_arguments.h"

/* --deform: writes --count frames of SURFACE, from 1. */
MesoStatus meso_replicate_deform(MesoReplicateArguments *arguments);

#endif
