#include "formats/file/output.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "formats/file/temporary.h"

enum { BUFFER_SIZE = 1 << 20 };

struct MesoOutput {
    int file;                   /* what is written to: the temporary, or the spool */
    MesoTemporary temporary;    /* the name of `file`; none for a spool */
    char *shown;                /* in messages: 'name', or standard output */
    char *target;               /* rename goes here; NULL for a copy */
    char *copy_path;            /* opened on commit; NULL: `copy_file` */
    int copy_file;
    uint8_t *buffer;            /* [BUFFER_SIZE] the last `buffered` bytes before `end` */
    size_t buffered;
    uint64_t end;               /* size of the file */
    MesoError failure;          /* status MESO_OK while all is well */
    pthread_mutex_t lock;       /* of all that changes, while threads write at places of their own */
};

/* What failed once fails for good: the file has a hole where the bytes should be. */
static MesoStatus refuse_after_failure(const MesoOutput *output, MesoError *error)
{
    if (!output->failure.status)
        return MESO_OK;
    return meso_fail(error, output->failure.status, "%s", output->failure.message);
}

static MesoStatus fail(MesoOutput *output, const char *why, MesoError *error)
{
    meso_fail(&output->failure, MESO_ERR_OUTPUT, "cannot write %s: %s", output->shown, why);
    return refuse_after_failure(output, error);
}

static MesoStatus fail_errno(MesoOutput *output, int number, MesoError *error)
{
    fail(output, strerror(number), error);
    if (number == ENOMEM)
        output->failure.status = MESO_ERR_MEMORY;
    return refuse_after_failure(output, error);
}

/* Folder of `path` with its final slash, "" for the current one. */
static int folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path + 1) : 0;
}

/* The descriptor that names like /dev/stdout and /dev/fd/3 stand for; -1 for any other name. */
static int descriptor_of(const char *path)
{
    static const char *const prefixes[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
        size_t length = strlen(prefixes[i]);
        if (strncmp(path, prefixes[i], length) == 0) {
            char *end;
            long number = strtol(path + length, &end, 10);
            if (end != path + length && *end == 0 && number >= 0 && number <= INT_MAX)
                return (int)number;
        }
    }
    return -1;
}

char *meso_output_target(const char *path)
{
    char *current = strdup(path);
    for (int links = 0; current; links++) {
        char text[PATH_MAX];
        ssize_t size = readlink(current, text, sizeof text - 1);
        if (size < 0)
            return current;     /* not a link; open() will say what else is wrong */
        text[size] = 0;
        if (links == 40) {
            free(current);
            errno = ELOOP;
            return NULL;
        }
        int folder = text[0] == '/' ? 0 : folder_length(current);
        char *next = malloc((size_t)folder + (size_t)size + 1);
        if (next) {
            memcpy(next, current, (size_t)folder);
            memcpy(next + folder, text, (size_t)size + 1);
        }
        free(current);
        current = next;
    }
    return current;
}

/* Devices and pipes cannot be renamed over, and standard output must not get
 * half a product: both get a copy of a nameless file in TMPDIR. */
static MesoStatus open_spool(MesoOutput *output, MesoError *error)
{
    const char *folder = getenv("TMPDIR");
    if (!folder || !*folder)
        folder = "/tmp";
    char near[PATH_MAX];
    int length = snprintf(near, sizeof near, "%s/", folder);
    errno = ENAMETOOLONG;
    if (length < PATH_MAX)
        output->file = meso_temporary_create(&output->temporary, near, length);
    if (output->file < 0) {
        char why[PATH_MAX + 64];
        snprintf(why, sizeof why, "no temporary file in '%s': %s", folder, strerror(errno));
        return fail(output, why, error);
    }
    meso_temporary_remove(&output->temporary);
    return MESO_OK;
}

static MesoStatus open_beside(MesoOutput *output, const char *path, const struct stat *existing,
                              MesoError *error)
{
    output->target = meso_output_target(path);
    if (!output->target)
        return fail_errno(output, errno, error);
    int folder = folder_length(output->target);
    if (output->target[folder] == 0)
        return fail(output, "the name is that of a folder", error);
    if (strlen(output->target + folder) > NAME_MAX)
        return fail_errno(output, ENAMETOOLONG, error);
    if (existing && access(output->target, W_OK) != 0)
        return fail_errno(output, errno, error);

    output->file = meso_temporary_create(&output->temporary, output->target, folder);
    if (output->file < 0) {
        char why[PATH_MAX + 64];
        snprintf(why, sizeof why, "folder '%.*s': %s", folder ? folder : 1,
                 folder ? output->target : ".", strerror(errno));
        return fail(output, why, error);
    }
    if (existing)   /* best effort: the file is ours, the mode may not be */
        (void)!fchmod(output->file, existing->st_mode & 07777);
    return MESO_OK;
}

static MesoStatus open_target(MesoOutput *output, const char *path, MesoError *error)
{
    struct stat status;
    output->copy_file = descriptor_of(path);
    if (output->copy_file >= 0)
        return open_spool(output, error);
    if (*path == 0)
        return fail(output, "the name is empty", error);

    bool exists = stat(path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        return fail(output, "it is a folder", error);
    if (!exists || S_ISREG(status.st_mode))
        return open_beside(output, path, exists ? &status : NULL, error);
    output->copy_path = strdup(path);
    if (!output->copy_path)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    return open_spool(output, error);
}

static void release(MesoOutput *output)
{
    meso_temporary_remove(&output->temporary);
    if (output->file >= 0)
        close(output->file);
    pthread_mutex_destroy(&output->lock);
    free(output->shown);
    free(output->target);
    free(output->copy_path);
    free(output->buffer);
    free(output);
}

MesoStatus meso_output_open(MesoOutput **result, const char *path, MesoError *error)
{
    *result = NULL;
    MesoOutput *output = calloc(1, sizeof *output);
    if (!output)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    output->file = output->copy_file = -1;
    output->temporary = MESO_NO_TEMPORARY;
    pthread_mutex_init(&output->lock, NULL);    /* of the default kind: it does not fail */
    output->buffer = malloc(BUFFER_SIZE);
    size_t size = strlen(path) + 32;
    output->shown = malloc(size);
    if (!output->buffer || !output->shown) {
        release(output);
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    }
    bool standard = descriptor_of(path) == STDOUT_FILENO;
    snprintf(output->shown, size, standard ? "standard output" : "'%s'", path);

    MesoStatus status = open_target(output, path, error);
    if (status) {
        release(output);
        return status;
    }
    *result = output;
    return MESO_OK;
}

static bool write_fully(int file, const uint8_t *data, size_t size, uint64_t offset)
{
    while (size > 0) {
        ssize_t done = pwrite(file, data, size, (off_t)offset);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return false;
        data += done;
        offset += (uint64_t)done;
        size -= (size_t)done;
    }
    return true;
}

static MesoStatus flush(MesoOutput *output, MesoError *error)
{
    uint64_t begin = output->end - output->buffered;
    if (!write_fully(output->file, output->buffer, output->buffered, begin))
        return fail_errno(output, errno, error);
    output->buffered = 0;
    return MESO_OK;
}

MesoStatus meso_output_write(MesoOutput *output, const void *data, size_t size, MesoError *error)
{
    MesoStatus status = refuse_after_failure(output, error);
    if (!status && size > BUFFER_SIZE - output->buffered)
        status = flush(output, error);
    if (status)
        return status;

    if (size >= BUFFER_SIZE) {
        if (!write_fully(output->file, data, size, output->end))
            return fail_errno(output, errno, error);
    } else if (size > 0) {
        memcpy(output->buffer + output->buffered, data, size);
        output->buffered += size;
    }
    output->end += size;
    return MESO_OK;
}

MesoStatus meso_output_print(MesoOutput *output, MesoError *error, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    int size = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return meso_output_write(output, text, size < (int)sizeof text ? (size_t)size : sizeof text - 1, error);
}

/* Everything buffered is in the file, and nothing has failed. */
static MesoStatus begin_write_at(MesoOutput *output, uint64_t offset, size_t size, MesoError *error)
{
    pthread_mutex_lock(&output->lock);
    MesoStatus status = refuse_after_failure(output, error);
    if (!status)
        status = flush(output, error);
    if (!status && offset > INT64_MAX - size)
        status = fail_errno(output, EFBIG, error);
    pthread_mutex_unlock(&output->lock);
    return status;
}

MesoStatus meso_output_write_at(MesoOutput *output, uint64_t offset, const void *data, size_t size,
                                MesoError *error)
{
    MesoStatus status = begin_write_at(output, offset, size, error);
    if (status)
        return status;
    int reason = write_fully(output->file, data, size, offset) ? 0 : errno;
    pthread_mutex_lock(&output->lock);
    if (reason)
        status = fail_errno(output, reason, error);
    else if (offset + size > output->end)
        output->end = offset + size;
    pthread_mutex_unlock(&output->lock);
    return status;
}

/* Everything is in the file; one that is to be renamed is closed. */
static MesoStatus settle(MesoOutput *output, MesoError *error)
{
    MesoStatus status = refuse_after_failure(output, error);
    if (!status)
        status = flush(output, error);
    if (status || !output->target)
        return status;
    if (fsync(output->file) != 0 && errno != EINVAL && errno != ENOTSUP)
        return fail_errno(output, errno, error);
    int closed = close(output->file);
    output->file = -1;
    return closed == 0 ? MESO_OK : fail_errno(output, errno, error);
}

static MesoStatus commit_rename(MesoOutput *output, MesoError *error)
{
    if (!meso_temporary_rename(&output->temporary, output->target))
        return fail_errno(output, errno, error);

    /* So that the name survives a crash too; not every file system can. */
    int length = folder_length(output->target);
    output->target[length] = 0;
    int folder = open(length ? output->target : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
        (void)!fsync(folder);
        close(folder);
    }
    return MESO_OK;
}

static bool write_stream(int file, const uint8_t *data, size_t size)
{
    while (size > 0) {
        ssize_t done = write(file, data, size);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return false;
        data += done;
        size -= (size_t)done;
    }
    return true;
}

static MesoStatus commit_copy(MesoOutput *output, MesoError *error)
{
    int to = output->copy_file;
    if (output->copy_path)
        to = open(output->copy_path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    bool good = to >= 0;
    for (uint64_t offset = 0; good && offset < output->end;) {
        uint64_t rest = output->end - offset;
        size_t size = rest < BUFFER_SIZE ? (size_t)rest : BUFFER_SIZE;
        ssize_t got = pread(output->file, output->buffer, size, (off_t)offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got == 0)
            errno = EIO;
        good = got > 0 && write_stream(to, output->buffer, (size_t)got);
        offset += got > 0 ? (uint64_t)got : 0;
    }
    int reason = errno;
    if (output->copy_path && to >= 0 && close(to) != 0 && good) {
        reason = errno;
        good = false;
    }
    return good ? MESO_OK : fail_errno(output, reason, error);
}

void meso_output_discard(MesoOutput *output)
{
    if (output)
        release(output);
}

/* What can fail comes first: a device or a pipe may refuse its copy, a file beside its target is all but there. */
static MesoStatus commit_all(MesoOutput *const *outputs, uint32_t count, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = outputs[i] ? settle(outputs[i], error) : MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = outputs[i] && !outputs[i]->target ? commit_copy(outputs[i], error) : MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = outputs[i] && outputs[i]->target ? commit_rename(outputs[i], error) : MESO_OK;
    return status;
}

MesoStatus meso_output_finish_all(MesoOutput *const *outputs, uint32_t count, MesoStatus status, MesoError *error)
{
    if (!status)
        status = commit_all(outputs, count, error);
    for (uint32_t i = 0; i < count; i++)
        meso_output_discard(outputs[i]);
    return status;
}

MesoStatus meso_output_finish(MesoOutput *output, MesoStatus status, MesoError *error)
{
    return meso_output_finish_all(&output, 1, status, error);
}

MesoStatus meso_output_commit(MesoOutput *output, MesoError *error)
{
    return meso_output_finish(output, MESO_OK, error);
}
