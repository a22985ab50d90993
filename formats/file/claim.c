#define _DEFAULT_SOURCE     /* flock */
#include "formats/file/claim.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static char *lock_path(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    size_t room = strlen(path) + sizeof "..claim";
    char *lock = malloc(room);
    if (lock)
        snprintf(lock, room, "%.*s.%s.claim", (int)(name - path), path, name);
    return lock;
}

/* Whether the open file is still the one of that name: whoever had it may have taken it away before we locked it. */
static bool is_current(int descriptor, const char *path)
{
    struct stat open_file, named;
    return fstat(descriptor, &open_file) == 0 && stat(path, &named) == 0 && open_file.st_ino == named.st_ino &&
           open_file.st_dev == named.st_dev;
}

MesoStatus meso_claim_take(MesoClaim *claim, const char *path, bool *taken, MesoError *error)
{
    *taken = false;
    claim->path = lock_path(path);
    if (!claim->path)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for a claim");
    for (;;) {
        int descriptor = open(claim->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) {
            MesoStatus status = meso_fail(error, MESO_ERR_OUTPUT, "cannot claim '%s': %s", path, strerror(errno));
            meso_claim_release(claim);
            return status;
        }
        bool locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
        if (locked && is_current(descriptor, claim->path)) {
            claim->descriptor = descriptor + 1;
            *taken = true;
            return MESO_OK;
        }
        close(descriptor);
        if (!locked) {
            free(claim->path);
            claim->path = NULL;
            return MESO_OK;
        }
    }
}

void meso_claim_release(MesoClaim *claim)
{
    if (claim->descriptor) {
        unlink(claim->path);
        close(claim->descriptor - 1);
    }
    free(claim->path);
    *claim = (MesoClaim){0};
}
