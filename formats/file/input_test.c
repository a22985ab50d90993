/* Input: files, pipes, and each thing that is neither. */
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "formats/file/input.h"
#include "libcore/base/check.h"

static char folder[] = "/tmp/meso-input-test-XXXXXX";
static char path[64];

static void make_file(const void *data, size_t size)
{
    snprintf(path, sizeof path, "%s/file", folder);
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(data, 1, size, file) == size && fclose(file) == 0);
}

static void check_fails(const char *name, const char *part)
{
    MesoInput input;
    MesoError error;
    CHECK(meso_input_open(&input, name, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, part) && strstr(error.message, name));
    CHECK(input.data && input.size == 0);
    meso_input_close(&input);
}

static void test_file(void)
{
    static uint8_t bytes[5000];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)(i * 7);
    make_file(bytes, sizeof bytes);

    MesoInput input, wrapped;
    MesoError error;
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(input.size == sizeof bytes && memcmp(input.data, bytes, sizeof bytes) == 0);
    CHECK((uintptr_t)input.data % 4096 == 0 && input.path == path);
    CHECK(meso_input_mapped_at(input.data) == path && meso_input_mapped_at(input.data + 4999) == path);
    CHECK(!meso_input_mapped_at(input.data + sizeof bytes) && !meso_input_mapped_at(bytes));
    meso_input_wrap(&wrapped, "x", bytes, sizeof bytes);
    CHECK(wrapped.hash[0] == input.hash[0] && wrapped.hash[1] == input.hash[1]);
    const uint8_t *gone = input.data;
    meso_input_close(&input);
    CHECK(input.data && input.size == 0 && !meso_input_mapped_at(gone));
    meso_input_close(&wrapped);
}

/* XXH3-128 of nothing, from the algorithm's published test vectors. */
static void test_hash(void)
{
    MesoInput input;
    meso_input_wrap(&input, "x", NULL, 0);
    CHECK(input.data && input.size == 0);
    CHECK(input.hash[0] == 0x99aa06d3014798d8u && input.hash[1] == 0x6001c324468d497fu);
}

static void test_refusals(void)
{
    make_file("", 0);
    check_fails(path, "empty");
    unlink(path);
    check_fails(path, "no such file");
    check_fails(folder, "directory");
    check_fails("/dev/null", "device");
    make_file("x", 1);
    char below[80];
    snprintf(below, sizeof below, "%s/below", path);
    check_fails(below, "cannot open");
    if (geteuid() != 0) {
        CHECK(chmod(path, 0) == 0);
        check_fails(path, "permission");
    }
    unlink(path);
}

/* Starts a child that writes `size` bytes to `to`, or to the named pipe `name` where that is given. */
static pid_t feed(int to, const char *name, size_t size)
{
    pid_t child = fork();
    CHECK(child >= 0);
    if (child > 0)
        return child;
    if (name)
        to = open(name, O_WRONLY);
    uint8_t bytes[1000];
    for (size_t done = 0; done < size; done += sizeof bytes) {
        memset(bytes, (int)(done / sizeof bytes), sizeof bytes);
        if (write(to, bytes, sizeof bytes) != (ssize_t)sizeof bytes)
            _exit(1);
    }
    _exit(0);
}

static void check_fed(const char *name, size_t size, pid_t child)
{
    MesoInput input;
    MesoError error;
    CHECK(meso_input_open(&input, name, &error) == MESO_OK);
    CHECK(input.size == size && (uintptr_t)input.data % 4096 == 0);
    for (size_t i = 0; i < size; i++)
        CHECK(input.data[i] == (uint8_t)(i / 1000));
    meso_input_close(&input);
    int status;
    CHECK(waitpid(child, &status, 0) == child && status == 0);
}

static void test_pipes(void)
{
    int ends[2];
    CHECK(pipe(ends) == 0);
    pid_t child = feed(ends[1], NULL, 300000);
    close(ends[1]);
    CHECK(dup2(ends[0], STDIN_FILENO) == STDIN_FILENO);
    close(ends[0]);
    check_fed("-", 300000, child);

    MesoInput input;
    MesoError error;
    CHECK(meso_input_open(&input, "-", &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "empty file 'standard input'") == 0);

    snprintf(path, sizeof path, "%s/pipe", folder);
    CHECK(mkfifo(path, 0600) == 0);
    check_fed(path, 3000, feed(-1, path, 3000));
    unlink(path);
}

int main(void)
{
    CHECK(mkdtemp(folder));
    test_file();
    test_hash();
    test_refusals();
    test_pipes();
    CHECK(rmdir(folder) == 0);
    return 0;
}
