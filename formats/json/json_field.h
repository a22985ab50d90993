/*
 * Reading fields of parsed JSON, with errors that name the place:
 * "vase.tiles.json: tiles[3].sides[1]: ...". The first problem is kept in the
 * reader; after it every call returns its fallback at once, so that a caller
 * may read on and ask once at the end. A reader with a `report` hears of every
 * problem instead and reads on with the fallbacks; what was read is then worth
 * nothing if any was reported, but must not be out of bounds.
 */
#ifndef MESO_JSON_FIELD_H
#define MESO_JSON_FIELD_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/arena.h"
#include "libcore/base/error.h"

typedef struct MesoJsonReader {
    const char *path;       /* of the file, for messages */
    MesoArena *arena;       /* texts are copied there */
    MesoError *error;
    MesoStatus status;      /* MESO_OK until something is wrong; with `report`, until memory is out */
    void (*report)(void *context, const char *severity, const char *where, const char *message);
    void *report_context;
    uint32_t reported;      /* problems that `report` has heard of */
} MesoJsonReader;

/* A place in the JSON. Its parents must outlive it: they are what the message names. */
typedef struct MesoJsonField {
    MesoJsonReader *reader;
    const struct MesoJsonField *parent;     /* NULL for the root */
    const char *key;        /* in an object */
    size_t index;           /* in an array, where `key` is NULL */
    const json_t *value;    /* NULL where it is missing */
} MesoJsonField;

MesoJsonField meso_json_root(MesoJsonReader *reader, const json_t *root);
MesoJsonField meso_json_key(const MesoJsonField *object, const char *key);
MesoJsonField meso_json_item(const MesoJsonField *array, size_t index);

/* Says what is wrong at `field`, unless something was wrong before and nobody wants to hear more. */
void meso_json_wrong(const MesoJsonField *field, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Words, up to a NULL, quoted and with commas between them, in `list` [size]: those that there are, for messages. */
void meso_json_list_words(const char *const *words, char *list, size_t size);

/* "tiles[3].sides[1]"; "" for the root. Cut off at `size`. */
void meso_json_place(const MesoJsonField *field, char *place, size_t size);

static inline bool meso_json_good(const MesoJsonField *field)
{
    return !field->reader->status;
}

/* "$schema", "comment", "extras": may stand in every object, hold anything, and mean nothing to us. */
bool meso_json_is_note(const char *key);

/*
 * True if it is an object; `keys` (NULL: any) lists the ones that it may have beside notes, ended by NULL.
 * Others are wrong, but an object with them is read on where `report` is set.
 */
bool meso_json_object(const MesoJsonField *field, const char *const *keys);

/* Length of an array in [low, high]; a missing one has length 0. 0 where that is wrong. */
uint32_t meso_json_count(const MesoJsonField *field, uint32_t low, uint32_t high);

/* Each returns `fallback` where the field is missing. */
bool meso_json_bool(const MesoJsonField *field, bool fallback);
float meso_json_float(const MesoJsonField *field, float fallback);
int64_t meso_json_whole(const MesoJsonField *field, int64_t low, int64_t high, int64_t fallback);

/* Exactly `count` numbers; where the field is missing, `values` stays as it is. */
void meso_json_floats(const MesoJsonField *field, uint32_t count, float *values);

/* Text, copied to the arena; "" where that is wrong. It must not be missing. */
const char *meso_json_text(const MesoJsonField *field);

/* Says so where the field is missing. */
void meso_json_require(const MesoJsonField *field);

#endif
