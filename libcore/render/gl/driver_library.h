/* Libraries of drivers, loaded when they are wanted: Mesa's brings LLVM with it, which takes longer than a small picture. */
#ifndef MESO_DRIVER_LIBRARY_H
#define MESO_DRIVER_LIBRARY_H

#include <stdint.h>

#include "libcore/base/error.h"

/* A function of the library, and where its address goes, whatever its type. */
typedef struct MesoDriverFunction {
    const char *name;
    void *pointer;              /* to a pointer to a function */
} MesoDriverFunction;

/* Loads a library for the rest of the process, and finds functions in it. MESO_ERR_INTERNAL with the loader's words. */
MesoStatus meso_driver_library(const char *library, const MesoDriverFunction *functions, uint32_t count,
                               MesoError *error);

#endif
