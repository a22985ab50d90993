/* Claims: which one of several processes, on one machine or on a shared folder, makes a file. */
#ifndef MESO_CLAIM_H
#define MESO_CLAIM_H

#include <stdbool.h>

#include "libcore/base/error.h"

/* Begins zeroed. */
typedef struct MesoClaim {
    int descriptor;             /* + 1; 0: none */
    char *path;                 /* of the file beside the claimed one that holds the lock */
} MesoClaim;

/*
 * Claims `path` until it is released, or the process ends in any way; false in `taken` where another one has. Look after
 * it whether the file has come to be meanwhile. The lock is a file ".NAME.claim" in the same folder, locked by flock(),
 * and goes with the claim. MESO_ERR_OUTPUT where it cannot be made.
 */
MesoStatus meso_claim_take(MesoClaim *claim, const char *path, bool *taken, MesoError *error);
void meso_claim_release(MesoClaim *claim);

#endif
