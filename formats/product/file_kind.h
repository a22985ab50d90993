/* What kind of file it is, by its content alone: for words about files that came to the wrong place. */
#ifndef MESO_FILE_KIND_H
#define MESO_FILE_KIND_H

#include "formats/file/input.h"

/* Bits, so that a set of kinds is a mask. */
typedef enum MesoFileKind {
    MESO_FILE_UNKNOWN = 0,
    MESO_FILE_TILES = 1 << 0,
    MESO_FILE_PROTOTYPE = 1 << 1,       /* a tile set of the prototype */
    MESO_FILE_CONSTRAINTS = 1 << 2,
    MESO_FILE_REPORT = 1 << 3,
    MESO_FILE_SEED_LINES = 1 << 4,
    MESO_FILE_GLTF = 1 << 5,
    MESO_FILE_JSON = 1 << 6,            /* any other */
    MESO_FILE_SLOTS = 1 << 7,
    MESO_FILE_MODEL = 1 << 8,
    MESO_FILE_OBJ = 1 << 9,
    MESO_FILE_PLY = 1 << 10,
    MESO_FILE_OFF = 1 << 11,
    MESO_FILE_GLB = 1 << 12,
    MESO_FILE_DRC = 1 << 13,
    MESO_FILE_EXR = 1 << 14,
    MESO_FILE_PNG = 1 << 15,
    MESO_FILE_LISTING = 1 << 16,        /* of slots, in JSON */
    MESO_FILE_CSV = 1 << 17,            /* the same, in CSV; with its columns in their usual order */
    MESO_FILE_PATTERN = 1 << 18,
    MESO_FILE_MACROS = 1 << 19,         /* of patterns */
    MESO_FILE_REGIONS = 1 << 20,        /* of a finished pattern */
    MESO_FILE_QUILT = 1 << 21,
    MESO_FILE_GRAMMAR = 1 << 22,
    MESO_FILE_DETAILS = 1 << 23,
    MESO_FILE_DEFORM = 1 << 24,
    MESO_FILE_STATE = 1 << 25,          /* of details that replicate */
    MESO_FILE_PLAN = 1 << 26,           /* likewise */
    MESO_FILE_HDR = 1 << 27
} MesoFileKind;

/* All that begin as JSON text. */
enum { MESO_FILES_OF_JSON = MESO_FILE_SEED_LINES * 2 - 1 + MESO_FILE_GLTF + MESO_FILE_JSON +
                          MESO_FILE_LISTING + MESO_FILE_PATTERN + MESO_FILE_MACROS + MESO_FILE_REGIONS +
                          MESO_FILE_DETAILS + MESO_FILE_DEFORM };

/*
 * Goes by the first bytes, by the keys of the outermost object of JSON, and by
 * the first statement of an OBJ. The rest may be broken. O(size) for JSON, which is not
 * parsed, and for comments before an OBJ's first statement.
 */
MesoFileKind meso_file_kind(const MesoInput *input);

/* "a tile set", "an OBJ mesh", ... */
const char *meso_file_kind_phrase(MesoFileKind kind);

#endif
