#include "formats/file/input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

enum { PAGE = 4096, FIRST_READ = 1 << 16, MAPPING_COUNT = 64 };

/* What the handler of SIGBUS looks at: an entry with a path is complete. More files than it holds
 * are read as well, but not named when they are cut. */
static struct {
    atomic_bool taken;
    _Atomic(const char *) path;
    const uint8_t *data;
    size_t size;
} mappings[MAPPING_COUNT];

static void remember_mapping(const MesoInput *input)
{
    for (int i = 0; i < MAPPING_COUNT; i++) {
        bool expected = false;
        if (!atomic_compare_exchange_strong(&mappings[i].taken, &expected, true))
            continue;
        mappings[i].data = input->data;
        mappings[i].size = input->mapping_size;
        atomic_store(&mappings[i].path, input->path);
        return;
    }
}

static void forget_mapping(const MesoInput *input)
{
    for (int i = 0; i < MAPPING_COUNT; i++)
        if (atomic_load(&mappings[i].path) && mappings[i].data == input->data) {
            atomic_store(&mappings[i].path, NULL);
            atomic_store(&mappings[i].taken, false);
            return;
        }
}

const char *meso_input_mapped_at(const void *address)
{
    for (int i = 0; i < MAPPING_COUNT; i++) {
        const char *path = atomic_load(&mappings[i].path);
        if (path && (uintptr_t)address - (uintptr_t)mappings[i].data < mappings[i].size)
            return path;
    }
    return NULL;
}

static void hash_bytes(MesoInput *input)
{
    XXH128_hash_t hash = XXH3_128bits(input->data, input->size);
    input->hash[0] = hash.high64;
    input->hash[1] = hash.low64;
}

static MesoStatus fail_errno(MesoError *error, const char *what, const char *path, int number)
{
    char reason[128] = "unknown error";
    strerror_r(number, reason, sizeof reason);
    MesoStatus status = number == ENOMEM ? MESO_ERR_MEMORY : MESO_ERR_INPUT;
    return meso_fail(error, status, "%s '%s': %s", what, path, reason);
}

static MesoStatus open_file(int *file, const char *path, MesoError *error)
{
    *file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (*file >= 0)
        return MESO_OK;
    if (errno == ENOENT)
        return meso_fail(error, MESO_ERR_INPUT, "no such file '%s'", path);
    if (errno == EACCES)
        return meso_fail(error, MESO_ERR_INPUT, "no permission to read '%s'", path);
    return fail_errno(error, "cannot open", path, errno);
}

/* Doubles the room at `*bytes`, page-aligned, keeping the first `used` bytes. */
static bool grow(uint8_t **bytes, size_t *room, size_t used)
{
    size_t wanted = *room ? *room * 2 : FIRST_READ;
    void *larger;
    if (wanted <= *room || posix_memalign(&larger, PAGE, wanted) != 0)
        return false;
    if (used)
        memcpy(larger, *bytes, used);
    free(*bytes);
    *bytes = larger;
    *room = wanted;
    return true;
}

/* Reads to the end: pipes, standard input, and files that do not say their size (/proc). */
static MesoStatus read_all(MesoInput *input, int file, const char *path, MesoError *error)
{
    uint8_t *bytes = NULL;
    size_t used = 0, room = 0;
    for (;;) {
        if (used == room && !grow(&bytes, &room, used)) {
            free(bytes);
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory: reading '%s' after %zu bytes",
                             path, used);
        }
        ssize_t got = read(file, bytes + used, room - used);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            int number = errno;
            free(bytes);
            return fail_errno(error, "cannot read", path, number);
        }
        if (got == 0)
            break;
        used += (size_t)got;
    }
    if (used == 0) {
        free(bytes);
        return meso_fail(error, MESO_ERR_INPUT, "empty file '%s'", path);
    }
    *input = (MesoInput){.path = path, .data = bytes, .size = used, .mapping = bytes};
    return MESO_OK;
}

static MesoStatus map_file(MesoInput *input, int file, size_t size, const char *path,
                           MesoError *error)
{
    void *mapping = mmap(NULL, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (mapping == MAP_FAILED)
        return fail_errno(error, "cannot map", path, errno);
    posix_madvise(mapping, size, POSIX_MADV_WILLNEED);
    *input = (MesoInput){.path = path, .data = mapping, .size = size,
                         .mapping = mapping, .mapping_size = size};
    remember_mapping(input);
    return MESO_OK;
}

static MesoStatus take_bytes(MesoInput *input, int file, bool standard, const char *path,
                             MesoError *error)
{
    struct stat about;
    if (fstat(file, &about) != 0)
        return fail_errno(error, "cannot read", path, errno);
    if (S_ISDIR(about.st_mode))
        return meso_fail(error, MESO_ERR_INPUT, "'%s' is a directory, not a file", path);
    if (standard || S_ISFIFO(about.st_mode) || (S_ISREG(about.st_mode) && about.st_size == 0))
        return read_all(input, file, path, error);
    if (!S_ISREG(about.st_mode))
        return meso_fail(error, MESO_ERR_INPUT, "'%s' is a device, neither a file nor a pipe", path);
    if ((uintmax_t)about.st_size > SIZE_MAX / 2)
        return meso_fail(error, MESO_ERR_INPUT, "file '%s' is too large to map", path);
    return map_file(input, file, (size_t)about.st_size, path, error);
}

MesoStatus meso_input_open(MesoInput *input, const char *path, MesoError *error)
{
    *input = (MesoInput){.path = path, .data = (const uint8_t *)""};
    bool standard = strcmp(path, "-") == 0;
    int file = STDIN_FILENO;
    if (!standard) {
        MesoStatus status = open_file(&file, path, error);
        if (status)
            return status;
    }
    MesoStatus status = take_bytes(input, file, standard, standard ? "standard input" : path, error);
    if (!standard)
        close(file);
    if (!status) {
        input->path = path;
        hash_bytes(input);
    }
    return status;
}

void meso_input_wrap(MesoInput *input, const char *path, const void *data, size_t size)
{
    *input = (MesoInput){.path = path, .data = size ? data : (const uint8_t *)"", .size = size};
    hash_bytes(input);
}

size_t meso_input_mark(const MesoInput *input)
{
    return input->size >= 3 && memcmp(input->data, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

void meso_input_close(MesoInput *input)
{
    if (input->mapping_size) {
        forget_mapping(input);
        munmap(input->mapping, input->mapping_size);
    } else {
        free(input->mapping);
    }
    *input = (MesoInput){.path = input->path, .data = (const uint8_t *)""};
}
