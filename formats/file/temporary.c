#include "formats/file/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { TEMPORARY_COUNT = 64 };

/* How long a dying process waits for its threads to leave the gate: a file system may hang. */
enum { WAIT_STEP_NANOSECONDS = 1000000, WAIT_STEPS = 2000 };

static struct {
    atomic_bool taken, armed;   /* the name of an armed entry is a file's, or is about to be */
    char name[PATH_MAX];
} temporaries[TEMPORARY_COUNT];

/*
 * The gate. A thread between creating a file and having said so, or amid a
 * rename, must be waited for by whoever cleans up, and must not start once that
 * has begun. Each side first says what it does and then looks at the other, so
 * that at least one of two that meet sees it.
 */
static atomic_int inside;
static atomic_bool closing;

/* Signals wait meanwhile: a handler on this thread would wait for itself. */
static void enter_gate(sigset_t *before)
{
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, before);
    atomic_fetch_add(&inside, 1);
    if (!atomic_load(&closing))
        return;
    atomic_fetch_sub(&inside, 1);
    for (;;)    /* until the process is gone */
        pause();
}

/* errno stays as it is. */
static void leave_gate(const sigset_t *before)
{
    int reason = errno;
    atomic_fetch_sub(&inside, 1);
    pthread_sigmask(SIG_SETMASK, before, NULL);
    errno = reason;
}

void meso_temporary_remove_all(void)
{
    const struct timespec step = {.tv_nsec = WAIT_STEP_NANOSECONDS};
    atomic_store(&closing, true);
    for (int i = 0; atomic_load(&inside) > 0 && i < WAIT_STEPS; i++)
        nanosleep(&step, NULL);
    for (int i = 0; i < TEMPORARY_COUNT; i++)
        if (atomic_load(&temporaries[i].armed))
            unlink(temporaries[i].name);
}

static MesoTemporary take_entry(void)
{
    for (int i = 0; i < TEMPORARY_COUNT; i++) {
        bool expected = false;
        if (atomic_compare_exchange_strong(&temporaries[i].taken, &expected, true))
            return i;
    }
    return MESO_NO_TEMPORARY;
}

static void give_back(MesoTemporary *temporary)
{
    atomic_store(&temporaries[*temporary].armed, false);
    atomic_store(&temporaries[*temporary].taken, false);
    *temporary = MESO_NO_TEMPORARY;
}

static bool make_name(char name[PATH_MAX], const char *near, int length)
{
    static atomic_uint counter;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    int size = snprintf(name, PATH_MAX, "%.*s.meso-%ld-%u-%lx.tmp", length, near, (long)getpid(),
                        atomic_fetch_add(&counter, 1), (unsigned long)now.tv_nsec);
    return size < PATH_MAX;
}

/* -1 with errno. */
static int create_armed(MesoTemporary temporary)
{
    sigset_t before;
    enter_gate(&before);
    int file = open(temporaries[temporary].name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    atomic_store(&temporaries[temporary].armed, file >= 0);
    leave_gate(&before);
    return file;
}

/* Process, counter and clock together keep a name from being someone else's. */
int meso_temporary_create(MesoTemporary *temporary, const char *near, int length)
{
    *temporary = take_entry();
    if (*temporary == MESO_NO_TEMPORARY) {
        errno = EMFILE;
        return -1;
    }
    for (int attempt = 0; attempt < 100; attempt++) {
        if (!make_name(temporaries[*temporary].name, near, length)) {
            errno = ENAMETOOLONG;
            break;
        }
        int file = create_armed(*temporary);
        if (file >= 0)
            return file;
        if (errno != EEXIST)
            break;
    }
    int reason = errno;
    give_back(temporary);
    errno = reason;
    return -1;
}

bool meso_temporary_rename(MesoTemporary *temporary, const char *target)
{
    sigset_t before;
    enter_gate(&before);
    bool renamed = rename(temporaries[*temporary].name, target) == 0;
    if (renamed)
        give_back(temporary);
    leave_gate(&before);
    return renamed;
}

void meso_temporary_remove(MesoTemporary *temporary)
{
    if (*temporary == MESO_NO_TEMPORARY)
        return;
    sigset_t before;
    enter_gate(&before);
    unlink(temporaries[*temporary].name);
    give_back(temporary);
    leave_gate(&before);
}
