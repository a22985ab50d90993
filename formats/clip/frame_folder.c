#include "formats/clip/frame_folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"

/* What stands before and behind the number in a file's name. */
typedef struct NamePattern {
    const char *folder;     /* "." where the pattern has none */
    const char *before, *behind;
} NamePattern;

/* Digits that the pattern itself asks for; it is one. */
static size_t width_of(const char *pattern)
{
    const char *place = strchr(pattern, '%');
    while (place[1] == '%')
        place = strchr(place + 2, '%');
    return place[1] == '0' ? (size_t)(place[2] - '0') : 1;
}

/* The names of frames 0 and 1 differ in the last digit of the number. */
static MesoStatus split_pattern(NamePattern *name, MesoArena *arena, const char *pattern, MesoError *error)
{
    char *zero = meso_frame_path(pattern, 0, arena, error), *one = meso_frame_path(pattern, 1, arena, error);
    if (!zero || !one)
        return MESO_ERR_MEMORY;
    size_t last = 0;
    while (zero[last] == one[last])
        last++;
    char *slash = strrchr(zero, '/'), *own = slash ? slash + 1 : zero;
    if (zero + last < own)
        return meso_fail(error, MESO_ERR_USAGE, "'%s': the number of a frame must stand in the name of the file for "
                         "frames to be found; say which there are", pattern);
    name->before = own;
    name->behind = one + last + 1;
    zero[last + 1 - width_of(pattern)] = '\0';
    if (slash)
        *slash = '\0';
    name->folder = !slash ? "." : slash == zero ? "/" : zero;
    return MESO_OK;
}

/* The number in a file's name; -1 where it is no frame's. */
static int32_t number_of(const NamePattern *name, const char *file)
{
    size_t before = strlen(name->before), behind = strlen(name->behind), length = strlen(file);
    if (length <= before + behind || strncmp(file, name->before, before) != 0 ||
        strcmp(file + length - behind, name->behind) != 0)
        return -1;
    size_t digits = strspn(file + before, "0123456789");
    if (digits > 9 || digits != length - before - behind)
        return -1;
    return (int32_t)strtol(file + before, NULL, 10);
}

/* Whether the pattern writes the number as the file's name has it: "a-1" is not of "a-%04d". */
static bool is_written_so(const char *pattern, int32_t number, const char *file, MesoArena *arena, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    const char *path = meso_frame_path(pattern, number, arena, error);
    const char *slash = path ? strrchr(path, '/') : NULL;
    bool same = path && strcmp(slash ? slash + 1 : path, file) == 0;
    meso_arena_rewind(arena, mark);
    return same;
}

static MesoStatus read_folder(MesoFrameList *list, MesoArena *arena, const NamePattern *name, const char *pattern,
                              DIR *folder, MesoError *error)
{
    size_t room = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        int32_t number = number_of(name, entry->d_name);
        if (number < 0 || !is_written_so(pattern, number, entry->d_name, arena, error))
            continue;
        if (list->count == MESO_MOST_FRAMES)
            return meso_fail(error, MESO_ERR_LIMIT, "%s: over %d frames", pattern, MESO_MOST_FRAMES);
        list->frames = MESO_GROW(arena, list->frames, list->count, room, 64, error);
        if (!list->frames)
            return MESO_ERR_MEMORY;
        list->frames[list->count++] = number;
    }
    return MESO_OK;
}

static int by_value(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static MesoStatus check_spacing(const MesoFrameList *list, MesoArena *arena, const char *pattern, MesoError *error)
{
    int32_t step = INT32_MAX;
    for (uint32_t i = 1; i < list->count; i++)
        if (list->frames[i] - list->frames[i - 1] < step)
            step = list->frames[i] - list->frames[i - 1];
    for (uint32_t i = 1; i < list->count; i++)
        if (list->frames[i] - list->frames[i - 1] != step) {
            const char *path = meso_frame_path(pattern, list->frames[i - 1] + step, arena, error);
            return path ? meso_fail(error, MESO_ERR_INPUT, "%s: missing, between frames %d and %d", path,
                                    list->frames[i - 1], list->frames[i])
                        : MESO_ERR_MEMORY;
        }
    return MESO_OK;
}

MesoStatus meso_frame_folder_list(MesoFrameList *list, MesoArena *arena, const char *pattern, MesoError *error)
{
    NamePattern name = {0};
    *list = (MesoFrameList){0};
    MesoStatus status = split_pattern(&name, arena, pattern, error);
    if (status)
        return status;
    DIR *folder = opendir(name.folder);
    if (!folder) {
        char reason[128] = "";
        strerror_r(errno, reason, sizeof reason);
        return meso_fail(error, MESO_ERR_INPUT, "%s: cannot be read: %s", name.folder, reason);
    }
    status = read_folder(list, arena, &name, pattern, folder, error);
    closedir(folder);
    if (status)
        return status;
    if (list->count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: there are no such files", pattern);
    qsort(list->frames, list->count, sizeof *list->frames, by_value);
    return check_spacing(list, arena, pattern, error);
}
