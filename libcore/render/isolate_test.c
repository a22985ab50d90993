/* Work in a child: what comes back, every way to die, and that it does not stay behind. */
#define _DEFAULT_SOURCE     /* mincore() */
#include "libcore/render/isolate.h"

#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libcore/base/check.h"

enum { NEED = 1 << 20 };

static volatile sig_atomic_t term_count;

static void count_term(int number)
{
    (void)number;
    term_count++;
}

static MesoStatus add_one(void *context, MesoError *error)
{
    (void)error;
    int *shared = context;
    *shared += 1;
    return MESO_OK;
}

static MesoStatus refuse(void *context, MesoError *error)
{
    return meso_fail(error, MESO_ERR_LIMIT, "no more of '%s'", (const char *)context);
}

static MesoStatus die(void *context, MesoError *error)
{
    (void)error;
    fputs("driver: lost its way\nand more\n", stderr);
    fflush(stderr);
    raise(*(const int *)context);
    return MESO_OK;
}

static MesoStatus leave(void *context, MesoError *error)
{
    (void)error;
    fputs(context, stderr);
    fflush(stderr);
    _exit(7);
}

static MesoStatus die_without_memory(void *context, MesoError *error)
{
    struct rlimit limit = {4096, 4096};
    CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
    return die(context, error);
}

/* Holds the pipe's end until it is killed. */
static MesoStatus stay(void *context, MesoError *error)
{
    (void)error;
    CHECK(write(*(const int *)context, "!", 1) == 1);
    for (;;)
        pause();
}

static void test_results(void)
{
    MesoError error;
    char name[] = "this";
    int *shared = meso_shared_new(sizeof *shared, &error);
    CHECK(shared && *shared == 0);
    CHECK(meso_isolate("counting", add_one, shared, NEED, &error) == MESO_OK && *shared == 1);
    CHECK(meso_isolate("counting", add_one, shared, 0, NULL) == MESO_OK && *shared == 2);
    CHECK(meso_isolate("counting", refuse, name, NEED, &error) == MESO_ERR_LIMIT);
    CHECK(error.status == MESO_ERR_LIMIT && strcmp(error.message, "no more of 'this'") == 0);

    CHECK(meso_isolate("counting", add_one, shared, SIZE_MAX / 4, &error) == MESO_ERR_MEMORY && *shared == 2);
    CHECK(strstr(error.message, "counting takes at least"));
    CHECK(!meso_shared_new(SIZE_MAX / 4, &error) && error.status == MESO_ERR_MEMORY);
    meso_shared_free(shared, sizeof *shared);
    meso_shared_free(NULL, 0);
}

static void test_deaths(void)
{
    static int crashes[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};
    MesoError error;
    char words[60];
    for (size_t i = 0; i < sizeof crashes / sizeof *crashes; i++) {
        CHECK(meso_isolate("drawing", die, &crashes[i], NEED, &error) == MESO_ERR_INTERNAL);
        snprintf(words, sizeof words, "drawing died of signal %d (", crashes[i]);
        CHECK(strstr(error.message, words) && strstr(error.message, "): driver: lost its way"));
        CHECK(!strstr(error.message, "more"));
        CHECK(meso_isolate("drawing", die_without_memory, &crashes[i], NEED, &error) == MESO_ERR_MEMORY);
        CHECK(strcmp(error.message, "out of memory: drawing") == 0);
    }
    int number = SIGKILL;
    CHECK(meso_isolate("drawing", die, &number, NEED, &error) == MESO_ERR_MEMORY);

    char silent[] = "", llvm[] = "LLVM ERROR: out of memory\nAllocation failed\n";
    CHECK(meso_isolate("drawing", leave, silent, NEED, &error) == MESO_ERR_INTERNAL);
    CHECK(strcmp(error.message, "drawing ended early") == 0);
    CHECK(meso_isolate("drawing", leave, llvm, NEED, &error) == MESO_ERR_MEMORY);
}

/* A request to end reaches the caller's handler; and the child has none of these. */
static void test_requests(void)
{
    int number = SIGTERM;
    MesoError error;
    signal(SIGTERM, count_term);
    CHECK(meso_isolate("drawing", die, &number, NEED, &error) == MESO_ERR_INTERNAL && term_count == 1);
    signal(SIGTERM, SIG_DFL);

    int *shared = meso_shared_new(sizeof *shared, &error);
    signal(SIGCHLD, SIG_IGN);       /* no status is kept of children then */
    CHECK(meso_isolate("counting", add_one, shared, NEED, &error) == MESO_OK && *shared == 1);
    CHECK(meso_isolate("drawing", leave, (char[]){""}, NEED, &error) == MESO_ERR_INTERNAL);
    signal(SIGCHLD, SIG_DFL);
    meso_shared_free(shared, sizeof *shared);
}

/* The child of a process that is killed is killed too: nobody holds the pipe's end any more. */
static void test_orphan(void)
{
    int ends[2];
    char byte;
    CHECK(pipe(ends) == 0);
    pid_t parent = fork();
    if (parent == 0) {
        meso_isolate("drawing", stay, &ends[1], NEED, NULL);
        _exit(1);
    }
    close(ends[1]);
    CHECK(read(ends[0], &byte, 1) == 1);
    CHECK(kill(parent, SIGKILL) == 0 && waitpid(parent, NULL, 0) == parent);
    CHECK(read(ends[0], &byte, 1) == 0);
    close(ends[0]);
}

/* All pages are there, and what has been in them. */
static void test_fill(void)
{
    enum { PAGE = 4096, PAGES = 100 };
    unsigned char there[PAGES], *memory = meso_shared_new(PAGES * PAGE, NULL);
    memory[5 * PAGE] = 7;
    meso_shared_fill(memory, PAGES * PAGE);
    CHECK(mincore(memory, PAGES * PAGE, there) == 0);
    for (uint32_t i = 0; i < PAGES; i++)
        CHECK(there[i] & 1 && memory[i * PAGE] == (i == 5 ? 7 : 0));
    meso_shared_free(memory, PAGES * PAGE);
}

int main(void)
{
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    test_results();
    test_deaths();
    test_requests();
    test_orphan();
    test_fill();
    return 0;
}
