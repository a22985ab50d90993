/* Outputs appear whole or not at all. */
#include "formats/file/output.h"
#include "formats/file/temporary.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "formats/file/test_folder.h"
#include "libcore/base/parallel.h"
#include "libcore/base/random.h"

static void write_whole(const char *path, const char *text)
{
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_output_write(output, text, strlen(text), &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
}

/* Opens, writes and commits; the status of the first that fails. */
static MesoStatus try_write(const char *path, size_t size, MesoError *error)
{
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, path, error);
    if (status) {
        CHECK(output == NULL);
        return status;
    }
    char *zeros = calloc(1, size);
    CHECK(zeros != NULL);
    status = meso_output_write(output, zeros, size, error);
    if (status) {    /* it stays failed */
        CHECK(meso_output_write(output, zeros, 1, NULL) == status);
        CHECK(meso_output_write_at(output, 0, zeros, 1, NULL) == status);
    }
    free(zeros);
    MesoStatus end = meso_output_commit(output, error);
    CHECK(status == MESO_OK || end == status);
    return end;
}

static void test_appears_on_commit(const TestFolder *folder)
{
    const char *path = test_path(folder, "whole");
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_output_write(output, "abc", 3, &error) == MESO_OK);
    CHECK(access(path, F_OK) != 0 && test_folder_count(folder) == 1);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(test_file_is(path, "abc", 3) && test_folder_count(folder) == 1);

    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_output_write(output, "xyz", 3, &error) == MESO_OK);
    meso_output_discard(output);
    meso_output_discard(NULL);
    CHECK(test_file_is(path, "abc", 3) && test_folder_count(folder) == 1);

    /* In a child: what is removed for good is so for all of a process. */
    pid_t child = fork();
    if (child == 0) {
        CHECK(meso_output_open(&output, test_path(folder, "gone"), &error) == MESO_OK);
        CHECK(test_folder_count(folder) == 2);
        meso_temporary_remove_all();
        CHECK(test_folder_count(folder) == 1);
        _exit(0);
    }
    int result;
    CHECK(waitpid(child, &result, 0) == child && result == 0 && test_folder_count(folder) == 1);
    unlink(path);
}

static void test_finish(const TestFolder *folder)
{
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, test_path(folder, "finished"), &error) == MESO_OK);
    CHECK(meso_output_write(output, "abc", 3, &error) == MESO_OK);
    CHECK(meso_output_finish(output, MESO_OK, &error) == MESO_OK);
    CHECK(test_file_is(test_path(folder, "finished"), "abc", 3) && test_folder_count(folder) == 1);

    CHECK(meso_output_open(&output, test_path(folder, "finished"), &error) == MESO_OK);
    CHECK(meso_output_write(output, "xyz", 3, &error) == MESO_OK);
    CHECK(meso_output_finish(output, MESO_ERR_LIMIT, &error) == MESO_ERR_LIMIT);
    CHECK(test_file_is(test_path(folder, "finished"), "abc", 3) && test_folder_count(folder) == 1);

    MesoStatus status = meso_output_open(&output, test_path(folder, "none/such"), &error);
    CHECK(status == MESO_ERR_OUTPUT && meso_output_finish(output, status, &error) == MESO_ERR_OUTPUT);
    unlink(test_path(folder, "finished"));
}

/* None appears where one cannot: of three files, one that failed before, a disk that is full, and none of these. */
static void test_finish_all(const TestFolder *folder)
{
    static const char *const names[] = {"one", "two", "three"};
    for (int round = 0; round < 4; round++) {
        MesoOutput *outputs[4] = {NULL};
        MesoError error;
        for (int i = 0; i < 3; i++) {
            const char *path = round == 1 && i == 2 ? "/dev/full" : test_path(folder, names[i]);
            CHECK(meso_output_open(&outputs[i + (i > 0)], path, &error) == MESO_OK);
            CHECK(meso_output_write(outputs[i + (i > 0)], names[i], 3, &error) == MESO_OK);
        }
        if (round == 0)
            CHECK(meso_output_write_at(outputs[2], UINT64_MAX - 1, "ab", 2, &error) == MESO_ERR_OUTPUT);
        MesoStatus given = round == 2 ? MESO_ERR_LIMIT : MESO_OK, wanted = round < 2 ? MESO_ERR_OUTPUT : given;
        CHECK(meso_output_finish_all(outputs, 4, given, &error) == wanted);
        CHECK(test_folder_count(folder) == (round < 3 ? 0 : 3));
    }
    for (int i = 0; i < 3; i++) {
        CHECK(test_file_is(test_path(folder, names[i]), names[i], 3));
        unlink(test_path(folder, names[i]));
    }
}

static void test_modes_and_links(const TestFolder *folder)
{
    struct stat status;
    mode_t mask = umask(027);
    const char *path = test_path(folder, "mode");
    write_whole(path, "a");
    CHECK(stat(path, &status) == 0 && (status.st_mode & 07777) == 0640);
    CHECK(chmod(path, 0604) == 0);
    write_whole(path, "b");
    CHECK(stat(path, &status) == 0 && (status.st_mode & 07777) == 0604);
    umask(mask);

    /* link -> through -> mode, and link to what is not there yet */
    const char *link = test_path(folder, "link");
    CHECK(symlink("through", link) == 0);
    CHECK(symlink(path, test_path(folder, "through")) == 0);
    write_whole(link, "c");
    CHECK(lstat(link, &status) == 0 && S_ISLNK(status.st_mode) && test_file_is(path, "c", 1));
    CHECK(unlink(path) == 0);
    write_whole(link, "d");
    CHECK(lstat(link, &status) == 0 && S_ISLNK(status.st_mode) && test_file_is(path, "d", 1));

    MesoError error;
    CHECK(unlink(link) == 0 && symlink("link", link) == 0);
    CHECK(try_write(link, 1, &error) == MESO_ERR_OUTPUT);
}

static void test_bad_targets(const TestFolder *folder)
{
    MesoError error;
    CHECK(try_write(folder->path, 1, &error) == MESO_ERR_OUTPUT);
    CHECK(strstr(error.message, "it is a folder"));
    CHECK(try_write(test_path(folder, "none/file"), 1, &error) == MESO_ERR_OUTPUT);
    CHECK(strstr(error.message, "none/': No such file or directory"));
    CHECK(try_write(test_path(folder, "mode/file"), 1, &error) == MESO_ERR_OUTPUT);
    CHECK(try_write(test_path(folder, "new/"), 1, &error) == MESO_ERR_OUTPUT);
    CHECK(try_write("", 1, &error) == MESO_ERR_OUTPUT);
    char long_name[400];
    memset(long_name, 'x', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = 0;
    CHECK(try_write(test_path(folder, long_name), 1, &error) == MESO_ERR_OUTPUT);
    CHECK(strstr(error.message, "File name too long"));

    MesoOutput *outputs[65];
    int count = 0;
    while (count < 65 && meso_output_open(&outputs[count], test_path(folder, "many"), &error) == MESO_OK)
        count++;
    CHECK(count == 64 && error.status == MESO_ERR_OUTPUT);
    while (count > 0)
        meso_output_discard(outputs[--count]);
}

/* In a child, as the user nobody where we are root, who may write everywhere. */
static void test_permissions(const TestFolder *folder)
{
    CHECK(chmod(folder->path, 0755) == 0);
    write_whole(test_path(folder, "mine"), "a");
    CHECK(chmod(test_path(folder, "mine"), 0444) == 0);
    pid_t child = fork();
    if (child == 0) {
        MesoError error;
        if (geteuid() == 0)
            CHECK(seteuid(65534) == 0);
        else
            CHECK(chmod(folder->path, 0555) == 0);
        CHECK(try_write(test_path(folder, "theirs"), 1, &error) == MESO_ERR_OUTPUT);
        CHECK(strstr(error.message, "Permission denied"));
        CHECK(try_write(test_path(folder, "mine"), 1, &error) == MESO_ERR_OUTPUT);
        CHECK(strstr(error.message, "Permission denied"));
        _exit(0);
    }
    int result;
    CHECK(waitpid(child, &result, 0) == child && result == 0);
    CHECK(chmod(folder->path, 0755) == 0 && test_file_is(test_path(folder, "mine"), "a", 1));
}

static void test_devices(const TestFolder *folder)
{
    MesoError error;
    struct stat status;
    CHECK(try_write("/dev/null", 10, &error) == MESO_OK);
    CHECK(try_write("/dev/full", 10, &error) == MESO_ERR_OUTPUT);
    CHECK(strcmp(error.message, "cannot write '/dev/full': No space left on device") == 0);
    CHECK(stat("/dev/full", &status) == 0 && S_ISCHR(status.st_mode));

    const char *fifo = test_path(folder, "fifo");
    CHECK(mkfifo(fifo, 0600) == 0);
    int reader = open(fifo, O_RDONLY | O_NONBLOCK);
    CHECK(reader >= 0);
    write_whole(fifo, "through");
    char text[16];
    CHECK(read(reader, text, sizeof text) == 7 && memcmp(text, "through", 7) == 0);
    close(reader);
    CHECK(stat(fifo, &status) == 0 && S_ISFIFO(status.st_mode));

    CHECK(setenv("TMPDIR", "/nowhere", 1) == 0);
    CHECK(try_write("-", 1, &error) == MESO_ERR_OUTPUT && strstr(error.message, "/nowhere"));
    CHECK(setenv("TMPDIR", folder->path, 1) == 0);
}

static void test_standard_output(const TestFolder *folder)
{
    MesoError error;
    const char *path = test_path(folder, "standard");
    int saved = dup(STDOUT_FILENO), ends[2];
    int file = open(path, O_RDWR | O_CREAT, 0600);
    CHECK(saved >= 0 && file >= 0 && dup2(file, STDOUT_FILENO) == STDOUT_FILENO);
    write_whole("-", "one ");
    write_whole("/dev/stdout", "two ");
    write_whole("/dev/fd/1", "three");
    CHECK(test_file_is(path, "one two three", 13));
    close(file);

    CHECK(pipe(ends) == 0 && dup2(ends[1], STDOUT_FILENO) == STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    CHECK(try_write("-", 100, &error) == MESO_ERR_OUTPUT);
    CHECK(strcmp(error.message, "cannot write standard output: Broken pipe") == 0);
    CHECK(dup2(saved, STDOUT_FILENO) == STDOUT_FILENO);
    close(saved);
}

/* Stands for a full disk: the kernel refuses what goes over the limit. */
static void test_no_space(const TestFolder *folder)
{
    struct rlimit old, limit;
    CHECK(getrlimit(RLIMIT_FSIZE, &old) == 0);
    limit = old;
    limit.rlim_cur = 3 << 20;
    int before = test_folder_count(folder);
    MesoError error;
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    CHECK(try_write(test_path(folder, "full"), 5 << 20, &error) == MESO_ERR_OUTPUT);
    CHECK(strstr(error.message, "full': File too large"));
    CHECK(setrlimit(RLIMIT_FSIZE, &old) == 0);
    CHECK(test_folder_count(folder) == before);
}

/* Random appends and patches against the same in memory. */
static void test_against_memory(const TestFolder *folder)
{
    enum { MOST = 12 << 20 };
    uint8_t *expected = calloc(1, MOST), *piece = malloc(3 << 20);
    size_t size = 0;
    MesoRandom random;
    MesoOutput *output;
    MesoError error;
    CHECK(expected && piece);
    meso_random_init(&random, 7, 0);
    CHECK(meso_output_open(&output, test_path(folder, "random"), &error) == MESO_OK);
    for (int step = 0; step < 400; step++) {
        size_t length = meso_random_below(&random, step % 40 == 0 ? 3 << 20 : 5000);
        bool append = meso_random_below(&random, 3) > 0;
        size_t offset = append ? size : meso_random_below(&random, (uint32_t)size + 1000);
        if (offset + length > MOST)
            continue;
        memset(piece, step, length);
        memcpy(expected + offset, piece, length);
        if (offset + length > size && (append || length > 0))
            size = offset + length;
        CHECK((append ? meso_output_write(output, piece, length, &error)
                      : meso_output_write_at(output, offset, piece, length, &error)) == MESO_OK);
    }
    CHECK(size > 5 << 20);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(test_file_is(test_path(folder, "random"), expected, size));

    CHECK(meso_output_open(&output, test_path(folder, "random"), &error) == MESO_OK);
    CHECK(meso_output_write_at(output, UINT64_MAX - 1, "ab", 2, &error) == MESO_ERR_OUTPUT);
    CHECK(meso_output_commit(output, &error) == MESO_ERR_OUTPUT);
    free(expected);
    free(piece);
}

typedef struct Pieces {
    MesoOutput *output;
    const uint8_t *bytes;
    MesoStatus status[64];
} Pieces;

static void write_piece(void *context, uint64_t begin, uint64_t end)
{
    Pieces *pieces = context;
    pieces->status[begin] = meso_output_write_at(pieces->output, 100 + 4096 * begin, pieces->bytes + 4096 * begin,
                                                 4096 * (end - begin), NULL);
}

/* Threads write at places of their own, behind what is buffered; the last of them says where the file ends. */
static void test_threads(const TestFolder *folder)
{
    uint8_t *expected = malloc(100 + 64 * 4096);
    Pieces pieces = {0};
    MesoError error;
    CHECK(expected);
    for (size_t i = 0; i < 100 + 64 * 4096; i++)
        expected[i] = (uint8_t)(i * 7 + i / 4096);
    pieces.bytes = expected + 100;
    CHECK(meso_output_open(&pieces.output, test_path(folder, "threads"), &error) == MESO_OK);
    CHECK(meso_output_write(pieces.output, expected, 100, &error) == MESO_OK);
    meso_parallel_for(4, 64, 1, write_piece, &pieces);
    for (uint32_t i = 0; i < 64; i++)
        CHECK(pieces.status[i] == MESO_OK);
    CHECK(meso_output_commit(pieces.output, &error) == MESO_OK);
    CHECK(test_file_is(test_path(folder, "threads"), expected, 100 + 64 * 4096));
    free(expected);
}

int main(void)
{
    TestFolder folder = test_folder_make();
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    test_appears_on_commit(&folder);
    test_finish(&folder);
    test_finish_all(&folder);
    test_modes_and_links(&folder);
    test_bad_targets(&folder);
    test_permissions(&folder);
    test_devices(&folder);
    test_standard_output(&folder);
    test_no_space(&folder);
    test_against_memory(&folder);
    test_threads(&folder);
    test_folder_remove(&folder);
    return 0;
}
