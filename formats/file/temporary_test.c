/* Temporary files: whatever they are at when the process is told to die, none stays. */
#include "formats/file/temporary.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#include "formats/file/test_folder.h"

enum { THREADS = 4, ROUNDS = 150 };

static TestFolder folder;

static void die(int number)
{
    meso_temporary_remove_all();
    signal(number, SIG_DFL);
    raise(number);
}

/* Creates, renames and removes without end. */
static void *work(void *target)
{
    const char *near = target;
    for (;;) {
        MesoTemporary first, second;
        int length = (int)(strrchr(near, '/') - near) + 1;
        int file = meso_temporary_create(&first, near, length);
        CHECK(file >= 0);
        close(file);
        file = meso_temporary_create(&second, near, length);
        CHECK(file >= 0);
        close(file);
        CHECK(meso_temporary_rename(&first, near));
        meso_temporary_remove(&second);
    }
    return NULL;
}

static void run_child(void)
{
    static char targets[THREADS][128];
    pthread_t thread;
    struct sigaction action = {.sa_handler = die};
    sigfillset(&action.sa_mask);
    sigaction(SIGTERM, &action, NULL);
    for (int i = 0; i < THREADS; i++) {
        snprintf(targets[i], sizeof targets[i], "%s/product%d", folder.path, i);
        CHECK(pthread_create(&thread, NULL, work, targets[i]) == 0);
    }
    for (;;)
        pause();
}

static int count_temporaries(void)
{
    int count = 0;
    DIR *list = opendir(folder.path);
    CHECK(list != NULL);
    for (struct dirent *entry; (entry = readdir(list));)
        count += strncmp(entry->d_name, ".meso", 5) == 0;
    closedir(list);
    return count;
}

static void test_signals(void)
{
    for (int round = 0; round < ROUNDS; round++) {
        pid_t child = fork();
        if (child == 0)
            run_child();
        while (access(test_path(&folder, "product0"), F_OK) != 0)
            nanosleep(&(struct timespec){0, 100000}, NULL);
        nanosleep(&(struct timespec){0, round * 20000}, NULL);
        int status;
        CHECK(kill(child, SIGTERM) == 0 && waitpid(child, &status, 0) == child);
        CHECK(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
        CHECK(count_temporaries() == 0);
        unlink(test_path(&folder, "product0"));
    }
}

static void test_names(void)
{
    MesoTemporary temporary;
    CHECK(meso_temporary_create(&temporary, "/nowhere/", 9) == -1 && errno == ENOENT);
    CHECK(temporary == MESO_NO_TEMPORARY);
    meso_temporary_remove(&temporary);

    int file = meso_temporary_create(&temporary, folder.path, 0);   /* in the current folder */
    CHECK(file >= 0);
    errno = 0;
    CHECK(!meso_temporary_rename(&temporary, "/nowhere/file") && errno == ENOENT);
    CHECK(temporary != MESO_NO_TEMPORARY);
    meso_temporary_remove(&temporary);
    CHECK(temporary == MESO_NO_TEMPORARY && close(file) == 0);
}

int main(void)
{
    folder = test_folder_make();
    test_names();
    test_signals();
    test_folder_remove(&folder);
    return 0;
}
