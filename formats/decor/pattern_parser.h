/* What the parts of the reader of patterns share: the state of one reading, and fields that all of them have. */
#ifndef MESO_PATTERN_PARSER_H
#define MESO_PATTERN_PARSER_H

#include "formats/decor/pattern_source.h"
#include "formats/json/json_field.h"
#include "formats/json/json_value.h"
#include "libcore/base/names.h"
#include "libcore/base/nearest.h"
#include "libcore/decor/pattern.h"

/* Points of a file that was named; read once. */
typedef struct MesoPatternPoints {
    const char *name;
    const MesoVec3 *points;     /* [count] */
    uint32_t count;
} MesoPatternPoints;

/* Macros by name; of two with one name the later counts. */
typedef struct MesoMacroTable {
    MesoNames numbers;
    const char **names;         /* [count] */
    const json_t **values;      /* [count] {"parameters", "steps"} */
    uint32_t count, room;
    json_t **roots;             /* [root_count] of the files that they are from; owned */
    uint32_t root_count, root_room;
} MesoMacroTable;

typedef struct MesoPatternParser {
    MesoJsonReader *reader;
    const MesoJsonFiles *files;
    MesoMacroTable macros;
    const char *calls[MESO_PATTERN_NESTING];    /* [call_count] macros that are being written out */
    uint32_t call_count;
    uint32_t step_count, value_count, seed_count;   /* so far */
    const char **material_names;    /* [material_count], and NULL */
    MesoNames material_numbers;
    uint32_t material_count;
    MesoPatternPoints *points;      /* [point_file_count] */
    uint32_t point_file_count, point_file_room;
} MesoPatternParser;

/* `count` zeroed elements, or NULL with the reader's status set. */
void *meso_pattern_allocate(MesoPatternParser *parser, uint64_t count, size_t size);

#define MESO_PATTERN_NEW(parser, type, count) ((type *)meso_pattern_allocate((parser), (count), sizeof(type)))

/* The file behind the name at `field`, or NULL, told there. */
const MesoInput *meso_pattern_open(MesoPatternParser *parser, const MesoJsonField *field);

/* [x, y, z]; the origin where that is missing or wrong. */
MesoVec3 meso_pattern_point(const MesoJsonField *field);

static inline bool meso_pattern_has(const MesoJsonField *object, const char *key)
{
    return json_object_get(object->value, key) != NULL;
}

#endif
