#include "formats/clip/frame_list.h"

#include <stdio.h>
#include <string.h>

#include "libcore/base/grow.h"

/* ---- lists ---- */

/* A whole number of up to nine digits; false, and stays, where there is none. */
static bool take_number(const char **text, int32_t *number)
{
    size_t digits = strspn(*text, "0123456789");
    if (digits == 0 || digits > 9)
        return false;
    *number = 0;
    for (; digits > 0; digits--, (*text)++)
        *number = 10 * *number + (**text - '0');
    return true;
}

static MesoStatus add(MesoFrameList *list, size_t *room, MesoArena *arena, int32_t frame, MesoError *error)
{
    if (list->count == MESO_MOST_FRAMES)
        return meso_fail(error, MESO_ERR_LIMIT, "over %d frames", MESO_MOST_FRAMES);
    list->frames = MESO_GROW(arena, list->frames, list->count, *room, 64, error);
    if (!list->frames)
        return MESO_ERR_MEMORY;
    list->frames[list->count++] = frame;
    return MESO_OK;
}

static MesoStatus add_range(MesoFrameList *list, size_t *room, MesoArena *arena, int32_t first, int32_t last,
                            int32_t step, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (int64_t frame = first; !status && (first <= last ? frame <= last : frame >= last);
         frame += first <= last ? step : -step)
        status = add(list, room, arena, (int32_t)frame, error);
    return status;
}

MesoStatus meso_frame_list_parse(MesoFrameList *list, MesoArena *arena, const char *text, MesoError *error)
{
    size_t room = 0;
    *list = (MesoFrameList){0};
    for (;;) {
        const char *part = text;
        int32_t first, last, step = 1;
        bool good = take_number(&text, &first);
        last = first;
        if (good && *text == '-') {
            text++;
            good = take_number(&text, &last);
        }
        if (good && *text == 'x') {
            text++;
            good = take_number(&text, &step) && step > 0;
        }
        if (!good || (*text && *text != ','))
            return meso_fail(error, MESO_ERR_USAGE, "'%.*s' is no frame, and no range of frames: 12, 1-100 or 1-100x2 "
                             "is wanted", (int)strcspn(part, ","), part);
        MesoStatus status = add_range(list, &room, arena, first, last, step, error);
        if (status || !*text)
            return status;
        text++;
    }
}

/* ---- names ---- */

/* The place for the number: its length, and its width; 0 where `text` does not begin with one. */
static size_t place_at(const char *text, int *width)
{
    size_t length = 1;
    *width = 0;
    if (*text != '%')
        return 0;
    if (text[1] == '0' && text[2] >= '1' && text[2] <= '9') {
        *width = text[2] - '0';
        length = 3;
    }
    return text[length] == 'd' ? length + 1 : 0;
}

bool meso_frame_path_is_pattern(const char *text)
{
    uint32_t places = 0;
    int width;
    while (*text) {
        size_t place = place_at(text, &width);
        if (*text == '%' && !place && text[1] != '%')
            return false;
        places += place > 0;
        text += place ? place : *text == '%' ? 2 : 1;
    }
    return places == 1;
}

char *meso_frame_path(const char *pattern, int32_t frame, MesoArena *arena, MesoError *error)
{
    char *path = MESO_NEW(arena, char, strlen(pattern) + 16, error), *out = path;
    while (path && *pattern) {
        int width;
        size_t place = place_at(pattern, &width);
        if (place)
            out += sprintf(out, "%0*d", width, frame);
        else
            *out++ = *pattern;
        pattern += place ? place : *pattern == '%' ? 2 : 1;
    }
    return path;
}
