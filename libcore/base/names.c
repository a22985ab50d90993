#include "libcore/base/names.h"

#include <string.h>

enum { FIRST_ROOM = 16 };

/* FNV-1a. */
static uint64_t hash_text(const char *text, size_t length)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 0x100000001b3u;
    return hash ^ (hash >> 32);
}

/* Where the name stands, or the free place where it belongs. */
static MesoName *find_place(const MesoNames *names, const char *text, size_t length)
{
    uint32_t mask = 2 * names->room - 1;
    for (uint32_t i = (uint32_t)hash_text(text, length);; i++) {
        MesoName *place = &names->places[i & mask];
        if (!place->text || (place->length == length && memcmp(place->text, text, length) == 0))
            return place;
    }
}

static MesoStatus enlarge(MesoNames *names, MesoArena *arena, MesoError *error)
{
    MesoNames larger = {.count = names->count, .room = names->room ? 2 * names->room : FIRST_ROOM};
    if (larger.room > UINT32_MAX / 4)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: more than %u names", names->count);
    larger.places = MESO_NEW(arena, MesoName, 2 * (size_t)larger.room, error);
    if (!larger.places)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < 2 * names->room; i++)
        if (names->places[i].text)
            *find_place(&larger, names->places[i].text, names->places[i].length) = names->places[i];
    *names = larger;
    return MESO_OK;
}

uint32_t meso_names_add(MesoNames *names, MesoArena *arena, const char *text, size_t length, uint32_t number,
                        MesoError *error)
{
    if (names->count == names->room && enlarge(names, arena, error))
        return MESO_NO_INDEX;
    MesoName *place = find_place(names, text, length);
    if (place->text)
        return place->number;
    *place = (MesoName){text, length, number};
    names->count++;
    return number;
}

uint32_t meso_names_find(const MesoNames *names, const char *text, size_t length)
{
    if (names->room == 0)
        return MESO_NO_INDEX;
    const MesoName *place = find_place(names, text, length);
    return place->text ? place->number : MESO_NO_INDEX;
}
