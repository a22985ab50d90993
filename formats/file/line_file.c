#include "formats/file/line_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_standard_output(const MesoLineFile *lines)
{
    return strcmp(lines->path, "-") == 0;
}

static MesoStatus fail(const MesoLineFile *lines, MesoError *error)
{
    if (is_standard_output(lines))
        return meso_fail(error, MESO_ERR_OUTPUT, "cannot write standard output: %s", strerror(errno));
    return meso_fail(error, MESO_ERR_OUTPUT, "cannot write '%s': %s", lines->path, strerror(errno));
}

MesoStatus meso_line_file_open(MesoLineFile *lines, const char *path, MesoError *error)
{
    *lines = (MesoLineFile){.file = STDOUT_FILENO, .path = path};
    if (!is_standard_output(lines))
        lines->file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    return lines->file >= 0 ? MESO_OK : fail(lines, error);
}

MesoStatus meso_line_file_append(MesoLineFile *lines, const char *text, MesoError *error)
{
    size_t size = strlen(text) + 1, done = 0;
    char *line = malloc(size);
    if (!line)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for a line");
    memcpy(line, text, size - 1);
    line[size - 1] = '\n';
    while (done < size) {
        ssize_t written = write(lines->file, line + done, size - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            break;
        done += (size_t)written;
    }
    free(line);
    return done == size ? MESO_OK : fail(lines, error);
}

MesoStatus meso_line_file_close(MesoLineFile *lines, MesoError *error)
{
    int file = lines->file;
    lines->file = -1;
    if (file < 0 || file == STDOUT_FILENO)
        return MESO_OK;
    return close(file) == 0 ? MESO_OK : fail(lines, error);
}
