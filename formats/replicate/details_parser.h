/* What the parts of the reader of details share. */
#ifndef MESO_DETAILS_PARSER_H
#define MESO_DETAILS_PARSER_H

#include "formats/json/json_field.h"
#include "formats/json/json_files.h"
#include "formats/json/json_value.h"
#include "formats/replicate/details_spec.h"

typedef struct MesoDetailsParser {
    MesoJsonReader *reader;
    const MesoJsonFiles *files;
    const char **material_names;    /* [material_count], and NULL */
    const char **kind_names;        /* [kind_count], and NULL */
    uint32_t material_count, kind_count;
    uint32_t point_count;           /* so far */
} MesoDetailsParser;

/* `count` zeroed elements, or NULL with the reader's status set. */
void *meso_details_allocate(MesoDetailsParser *parser, uint64_t count, size_t size);

#define MESO_DETAILS_NEW(parser, type, count) ((type *)meso_details_allocate((parser), (count), sizeof(type)))

/* The name of a file, attribute or channel; "" where it is wrong. */
const char *meso_details_name(const MesoJsonField *field);

/* Three numbers within the largest coordinate; the origin where it is missing or wrong. */
MesoVec3 meso_details_vector(const MesoJsonField *field);

/* The same, but not zero. */
MesoVec3 meso_details_direction(const MesoJsonField *field);

/* {name: value}: the names, copied, and a NULL behind; at most `most`, and `least` or more. NULL where it is wrong. */
const char **meso_details_keys(MesoDetailsParser *parser, const MesoJsonField *field, uint32_t least, uint32_t most,
                               uint32_t *count);

void meso_details_kinds(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailsFile *details);
void meso_details_distribution(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out);

/* A list of points, or {"file": NAME}. */
void meso_details_points(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out);

#endif
