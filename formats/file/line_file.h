/*
 * Files that grow by whole lines while long work goes on, so that what is done
 * is not lost when the work is cut short: unlike MesoOutput, which appears
 * whole or not at all.
 */
#ifndef MESO_LINE_FILE_H
#define MESO_LINE_FILE_H

#include "libcore/base/error.h"

typedef struct MesoLineFile {
    int file;
    const char *path;       /* "-": standard output */
} MesoLineFile;

/* Appends to `path`, which must outlive the file; "-" is standard output. MESO_ERR_OUTPUT. */
MesoStatus meso_line_file_open(MesoLineFile *lines, const char *path, MesoError *error);

/* Appends `text` and its line end, in one write where the system does. MESO_ERR_OUTPUT, or MESO_ERR_MEMORY. */
MesoStatus meso_line_file_append(MesoLineFile *lines, const char *text, MesoError *error);

MesoStatus meso_line_file_close(MesoLineFile *lines, MesoError *error);

#endif
