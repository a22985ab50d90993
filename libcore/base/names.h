/* Names and the numbers that they stand for: a hash table. */
#ifndef MESO_NAMES_H
#define MESO_NAMES_H

#include "libcore/base/arena.h"
#include "libcore/base/index.h"

typedef struct MesoName {
    const char *text;           /* NULL: a free place */
    size_t length;
    uint32_t number;
} MesoName;

/* Starts zeroed. What `text` of a name points to must outlive the table. */
typedef struct MesoNames {
    uint32_t count, room;       /* at most half of the places are taken */
    MesoName *places;           /* [2 * room] */
} MesoNames;

/* `number` under the name of `length` bytes, unless it has one already. Returns that which it has then;
 * MESO_NO_INDEX where memory is out. O(length). */
uint32_t meso_names_add(MesoNames *names, MesoArena *arena, const char *text, size_t length, uint32_t number,
                        MesoError *error);

/* Number of a name, or MESO_NO_INDEX. O(length). */
uint32_t meso_names_find(const MesoNames *names, const char *text, size_t length);

#endif
