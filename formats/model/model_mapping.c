#include "formats/model/model_mapping.h"

#include <stddef.h>
#include <stdlib.h>

#include "formats/json/json_text.h"
#include "formats/json/json_value.h"

enum { MOST_KEYS = 32 };

typedef enum MappingType {
    WORD,       /* uint32_t, a number among `words`, ended by NULL; the first is the default */
    WHOLE,      /* uint32_t within [low, high] */
    NUMBER      /* float within [low, high] */
} MappingType;

/* One option, at `offset` in MesoMapOptions. */
typedef struct MappingRow {
    const char *key;
    size_t offset;
    MappingType type;
    const char *const *words;
    float low, high;
} MappingRow;

#define WORD_ROW(name, words) {#name, offsetof(MesoMapOptions, name), WORD, words, 0, 0}

static const MappingRow ROWS[] = {
    WORD_ROW(frame, meso_frame_rule_names),
    WORD_ROW(deform, meso_sweep_deform_names),
    WORD_ROW(normals, meso_shell_normals_names),
    WORD_ROW(side, meso_shell_side_names),
    {"limit_folds", offsetof(MesoMapOptions, limit_folds), WHOLE, NULL, 0, 1},
    WORD_ROW(section_size, meso_section_size_names),
    {"tolerance", offsetof(MesoMapOptions, tolerance), NUMBER, NULL, 0, 4 * MESO_COORDINATE_LIMIT},
    WORD_ROW(tolerance_in, meso_tolerance_unit_names),
    WORD_ROW(bends, meso_bends_names),
    {"relax", offsetof(MesoMapOptions, relax), WHOLE, NULL, 0, MESO_RELAX_MOST},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

_Static_assert((int)ROW_COUNT < (int)MOST_KEYS, "the keys fit");

static uint32_t *whole_at(const MappingRow *row, MesoMapOptions *options)
{
    return (uint32_t *)(void *)((char *)options + row->offset);
}

static float *number_at(const MappingRow *row, MesoMapOptions *options)
{
    return (float *)(void *)((char *)options + row->offset);
}

/* ---- writing ---- */

/* False where it is at its default. */
static bool row_to_json(const MappingRow *row, MesoMapOptions *options, json_t **value)
{
    uint32_t whole = row->type == NUMBER ? 0 : *whole_at(row, options);
    float number = row->type == NUMBER ? *number_at(row, options) : 0;
    if (whole == 0 && number == 0)
        return false;
    *value = row->type == NUMBER ? meso_json_shortest(number)
           : row->type == WORD ? json_string(row->words[whole]) : json_integer(whole);
    return true;
}

int meso_mapping_to_json(json_t *object, const MesoMapOptions *options)
{
    MesoMapOptions all = *options;
    int failed = 0;
    for (uint32_t i = 0; i < ROW_COUNT; i++) {
        json_t *value;
        if (row_to_json(&ROWS[i], &all, &value))
            failed |= json_object_set_new(object, ROWS[i].key, value);
    }
    return failed;
}

MesoStatus meso_mapping_text(char **text, const MesoMapOptions *options, MesoError *error)
{
    json_t *object = json_object();
    int failed = meso_mapping_to_json(object, options);
    bool empty = json_object_size(object) == 0;
    *text = failed || empty ? NULL : json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(9));
    json_decref(object);
    return !failed && (*text || empty) ? MESO_OK
                                       : meso_fail(error, MESO_ERR_MEMORY, "out of memory for the mapping options");
}

/* ---- reading ---- */

static void read_row(const MesoJsonField *top, const MappingRow *row, MesoMapOptions *options)
{
    MesoJsonField field = meso_json_key(top, row->key);
    if (row->type == WORD)
        *whole_at(row, options) = meso_json_word(&field, row->key, row->words, 0);
    else if (row->type == WHOLE)
        *whole_at(row, options) = (uint32_t)meso_json_whole(&field, (int64_t)row->low, (int64_t)row->high, 0);
    else
        *number_at(row, options) = meso_json_float_in(&field, row->low, row->high, false, 0);
}

MesoStatus meso_mapping_read(MesoMapOptions *options, const MesoInput *text, MesoArena *arena, MesoError *error)
{
    const char *keys[MOST_KEYS] = {NULL};
    json_t *root = NULL;
    MesoStatus status = meso_json_parse(&root, text, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < ROW_COUNT; i++)
        keys[i] = ROWS[i].key;
    MesoJsonReader reader = {.path = text->path, .arena = arena, .error = error};
    MesoJsonField top = meso_json_root(&reader, root);
    meso_json_object(&top, keys);
    for (uint32_t i = 0; i < ROW_COUNT && meso_json_good(&top); i++)
        read_row(&top, &ROWS[i], options);
    json_decref(root);
    return reader.status;
}
