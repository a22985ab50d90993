/* Claims: one at a time, also between processes; free again after release, and after any end of who had it. */
#include "formats/file/claim.h"

#include <signal.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "formats/file/test_folder.h"
#include "libcore/base/check.h"

static TestFolder folder;
static MesoError error;

static bool take(MesoClaim *claim, const char *path)
{
    bool taken;
    CHECK(meso_claim_take(claim, path, &taken, &error) == MESO_OK);
    return taken;
}

static void test_one(const char *path)
{
    MesoClaim one = {0}, two = {0}, other = {0};
    char beside[4096];
    snprintf(beside, sizeof beside, "%s-2", path);
    CHECK(take(&one, path) && !take(&two, path) && take(&other, beside));
    meso_claim_release(&one);
    CHECK(take(&two, path) && !take(&one, path));
    meso_claim_release(&two);
    meso_claim_release(&other);
    snprintf(beside, sizeof beside, "%s/.a.exr.claim", folder.path);
    CHECK(access(beside, F_OK) != 0);
}

/* A process that is killed leaves its file, and no claim. */
static void test_killed(const char *path)
{
    int ready[2];
    char byte = 1;
    CHECK(pipe(ready) == 0);
    pid_t child = fork();
    if (child == 0) {
        MesoClaim claim = {0};
        byte = (char)take(&claim, path);
        if (write(ready[1], &byte, 1) == 1)
            pause();
        _exit(1);
    }
    CHECK(read(ready[0], &byte, 1) == 1 && byte == 1);
    MesoClaim claim = {0};
    CHECK(!take(&claim, path));
    kill(child, SIGKILL);
    CHECK(waitpid(child, NULL, 0) == child);
    CHECK(take(&claim, path));
    meso_claim_release(&claim);
    close(ready[0]);
    close(ready[1]);
}

/* Many at once: at no time have two the same claim, which a count in a file would show. */
static void test_many(const char *path)
{
    enum { PROCESSES = 6, TURNS = 200 };
    int pipes[2];
    CHECK(pipe(pipes) == 0);
    for (int p = 0; p < PROCESSES; p++)
        if (fork() == 0) {
            uint32_t had = 0;
            for (int turn = 0; turn < TURNS; turn++) {
                MesoClaim claim = {0};
                if (!take(&claim, path))
                    continue;
                char inside[4096];
                snprintf(inside, sizeof inside, "%s.inside", path);
                FILE *file = fopen(inside, "wx");   /* fails where another one is in */
                if (!file)
                    _exit(2);
                fclose(file);
                unlink(inside);
                meso_claim_release(&claim);
                had++;
            }
            _exit(had > 0 ? 0 : 3);
        }
    for (int p = 0; p < PROCESSES; p++) {
        int status;
        CHECK(wait(&status) > 0 && WIFEXITED(status) && WEXITSTATUS(status) != 2);
    }
    close(pipes[0]);
    close(pipes[1]);
}

int main(void)
{
    folder = test_folder_make();
    const char *path = test_path(&folder, "a.exr");
    test_one(path);
    test_killed(path);
    test_many(path);
    MesoClaim claim = {0};
    bool taken;
    CHECK(meso_claim_take(&claim, "/nowhere/at/all/x.exr", &taken, &error) == MESO_ERR_OUTPUT);
    test_folder_remove(&folder);
    return 0;
}
