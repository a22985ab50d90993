#define _DEFAULT_SOURCE     /* MAP_ANONYMOUS, NSIG, strsignal() */
#include "libcore/render/isolate.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SAID_SIZE = 256, STACK_SIZE = 1 << 16 };

/* What parent and child share. */
typedef struct Outcome {
    MesoStatus status;
    MesoError error;
    bool ended;             /* the work returned */
    bool short_of_memory;   /* when it died */
} Outcome;

/* Of the child, for its handler. */
static Outcome *dying_outcome;
static size_t dying_need;

void *meso_shared_new(size_t size, MesoError *error)
{
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory != MAP_FAILED)
        return memory;
    meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu bytes to share", size);
    return NULL;
}

void meso_shared_free(void *memory, size_t size)
{
    if (memory)
        munmap(memory, size);
}

void meso_shared_fill(void *memory, size_t size)
{
#ifdef MADV_POPULATE_WRITE
    madvise(memory, size, MADV_POPULATE_WRITE);
#else
    (void)memory;
    (void)size;
#endif
}

/* Nothing is touched: only a limit, or a system that promises no more than it has, refuses. */
static bool is_to_be_had(size_t size)
{
    const int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
    if (size == 0)
        return true;
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, flags, -1, 0);
    if (memory == MAP_FAILED)
        return false;
    munmap(memory, size);
    return true;
}

/* ---- the child ---- */

static void tell_shortage(int number)
{
    dying_outcome->short_of_memory = !is_to_be_had(dying_need);
    signal(number, SIG_DFL);
    raise(number);
}

/* Handlers are the parent's, and would clear away its files; what is ignored stays so. */
static void drop_handlers(void)
{
    for (int number = 1; number < NSIG; number++) {
        struct sigaction action;
        if (sigaction(number, NULL, &action) == 0 && action.sa_handler != SIG_IGN)
            signal(number, SIG_DFL);
    }
}

static void watch_crashes(Outcome *outcome, size_t need)
{
    static const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGFPE};
    static char stack[STACK_SIZE];      /* where the work's own has overflowed */
    sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
    dying_outcome = outcome;
    dying_need = need;
    for (size_t i = 0; i < sizeof crashes / sizeof *crashes; i++) {
        struct sigaction action = {.sa_handler = tell_shortage, .sa_flags = SA_ONSTACK};
        sigfillset(&action.sa_mask);
        sigaction(crashes[i], &action, NULL);
    }
}

static _Noreturn void run_child(pid_t parent, int said, Outcome *outcome, MesoWork *work, void *context,
                                size_t need)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(0);
    drop_handlers();
    watch_crashes(outcome, need);
    dup2(said, STDERR_FILENO);
    outcome->status = work(context, &outcome->error);
    outcome->ended = true;
    _exit(0);
}

/* ---- the parent ---- */

/* Its beginning, up to the end of the child. */
static void read_said(int from, char said[SAID_SIZE])
{
    char rest[SAID_SIZE];
    size_t length = 0;
    for (;;) {
        size_t room = SAID_SIZE - 1 - length;
        ssize_t got = read(from, room ? said + length : rest, room ? room : sizeof rest);
        if (got > 0 && room)
            length += (size_t)got;
        else if (got == 0 || (got < 0 && errno != EINTR))
            break;
    }
    said[length] = 0;
    said[strcspn(said, "\n")] = 0;
}

/* The status of `child`, or 0 where the system keeps none (SIGCHLD is ignored). */
static int reap(pid_t child)
{
    int how = 0;
    pid_t ended;
    do
        ended = waitpid(child, &how, 0);
    while (ended < 0 && errno == EINTR);
    return ended == child ? how : 0;
}

static bool tells_of_memory(const char *said)
{
    static const char *const words[] = {"out of memory", "bad_alloc", "Unable to allocate", "Cannot allocate"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strstr(said, words[i]))
            return true;
    return false;
}

/* Who asks the work to end means all of it; the caller may have files to clear away first. */
static void pass_on(int number)
{
    static const int requests[] = {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGXCPU};
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++)
        if (number == requests[i])
            raise(number);
}

static MesoStatus judge(const char *what, const Outcome *outcome, int how, const char *said, MesoError *error)
{
    if (outcome->ended) {
        if (error)
            *error = outcome->error;
        return outcome->status;
    }
    if (WIFSIGNALED(how))
        pass_on(WTERMSIG(how));
    if (outcome->short_of_memory || tells_of_memory(said))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %s", what);
    if (WIFSIGNALED(how) && WTERMSIG(how) == SIGKILL)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %s was killed", what);
    const char *colon = *said ? ": " : "";
    if (WIFSIGNALED(how))
        return meso_fail(error, MESO_ERR_INTERNAL, "%s died of signal %d (%s)%s%s", what, WTERMSIG(how),
                         strsignal(WTERMSIG(how)), colon, said);
    return meso_fail(error, MESO_ERR_INTERNAL, "%s ended early%s%s", what, colon, said);
}

static MesoStatus run_apart(Outcome *outcome, const char *what, MesoWork *work, void *context, size_t need,
                            MesoError *error)
{
    int ends[2];
    if (pipe(ends) != 0)
        return meso_fail(error, MESO_ERR_MEMORY, "cannot start a process for %s: %s", what, strerror(errno));
    pid_t self = getpid(), child = fork();
    if (child == 0) {
        close(ends[0]);
        run_child(self, ends[1], outcome, work, context, need);
    }
    int number = errno;
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        return meso_fail(error, MESO_ERR_MEMORY, "cannot start a process for %s: %s", what, strerror(number));
    }
    char said[SAID_SIZE];
    read_said(ends[0], said);
    close(ends[0]);
    return judge(what, outcome, reap(child), said, error);
}

MesoStatus meso_isolate(const char *what, MesoWork *work, void *context, size_t need, MesoError *error)
{
    if (!is_to_be_had(need))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %s takes at least %zu MB", what, need >> 20);
    Outcome *outcome = meso_shared_new(sizeof *outcome, error);
    if (!outcome)
        return MESO_ERR_MEMORY;
    MesoStatus status = run_apart(outcome, what, work, context, need, error);
    meso_shared_free(outcome, sizeof *outcome);
    return status;
}
