/* JSON text in and out, by Jansson, with errors that say where. */
#ifndef MESO_JSON_TEXT_H
#define MESO_JSON_TEXT_H

#include <jansson.h>

#include "formats/file/input.h"
#include "formats/file/output.h"

/*
 * Parses `input`; the caller owns the result. MESO_ERR_INPUT with file, line
 * and column; duplicate keys, more than 512 levels and bytes that are not text are refused. A byte order mark
 * is passed over.
 */
MesoStatus meso_json_parse(json_t **root, const MesoInput *input, MesoError *error);

/* The same for line `number` of a file of lines: `size` bytes at `text`. */
MesoStatus meso_json_parse_line(json_t **root, const char *path, uint64_t number, const char *text, size_t size,
                                MesoError *error);

/* String value of `text`; what is not UTF-8 (file names, cut messages) keeps its ASCII and gets
 * '?' for the rest. NULL when memory is out. */
json_t *meso_json_string(const char *text);

/* Real value of `value` as people write it: 0.1 and not 0.10000000149011612, 0 and not -0. NULL where it is not finite,
 * or memory is out. */
json_t *meso_json_shortest(float value);

/*
 * Appends `value` as text: two spaces of indent, keys in the order of insertion, the shortest
 * numbers that read back to the same double, a final newline. Arrays of scalars, and objects of
 * scalars and such arrays, stand on one line where they fit in 100 columns.
 */
MesoStatus meso_json_write(const json_t *value, MesoOutput *output, MesoError *error);

/* The same as a whole file; NULL is standard output. */
MesoStatus meso_json_write_file(const json_t *value, const char *path, MesoError *error);

/* "format" and "version" of one of our files: refuses another format and a newer version. */
MesoStatus meso_json_check_format(const json_t *root, const char *path, const char *format,
                                  int newest_version, MesoError *error);

#endif
