#define _XOPEN_SOURCE 700       /* realpath() */
#include "cmd/common/mesh_path.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int meso_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

const char *meso_mesh_path(const char *folder, int length, const char *file, bool *found, MesoArena *arena,
                           MesoError *error)
{
    size_t trimmed = strlen(file);
    if (file[0] == '/')
        length = 0;
    bool slash = length > 0 && folder[length - 1] != '/';
    char *path = meso_arena_print(arena, error, "%.*s%s%s", length, folder, slash ? "/" : "", file);
    if (!path)
        return NULL;
    *found = access(path, F_OK) == 0;
    while (trimmed > 0 && strchr(" \t\r\n", file[trimmed - 1]))
        trimmed--;
    if (*found || !file[trimmed] || trimmed == 0)
        return path;
    char *shorter = meso_arena_print(arena, error, "%.*s", (int)(strlen(path) - strlen(file + trimmed)), path);
    if (!shorter)
        return NULL;
    *found = access(shorter, F_OK) == 0;
    return *found ? shorter : path;
}

/* Without links and dots; NULL where there is no such folder. The caller frees it. */
static char *real_folder(const char *path, MesoArena *arena, MesoError *error)
{
    char *folder = meso_arena_print(arena, error, "%.*s.", meso_folder_length(path), path);
    return folder ? realpath(folder, NULL) : NULL;
}

/* "../../data/" for the way from folder `from` to folder `to`, both real; "" for none. */
static const char *way_between(const char *from, const char *to, MesoArena *arena, MesoError *error)
{
    size_t common = 0;
    for (size_t i = 0;; i++) {
        bool ends = (from[i] == '/' || !from[i]) && (to[i] == '/' || !to[i]);
        common = ends ? i : common;
        if (from[i] != to[i] || !from[i])
            break;
    }
    const char *rest = to + common + (to[common] == '/'), *up = "";
    for (const char *c = from + common; *c && up; c++)
        if (*c == '/' && c[1])
            up = meso_arena_print(arena, error, "../%s", up);
    return up ? meso_arena_print(arena, error, "%s%s%s", up, rest, *rest ? "/" : "") : NULL;
}

static MesoStatus move_names(MesoTileSet *set, const char *from, const char *way, MesoArena *arena, MesoError *error)
{
    for (uint32_t i = 0; i < set->inner_count; i++) {
        bool found;
        const char *file = set->inners[i].file;
        if (*file == 0 || *file == '/')
            continue;
        if (!meso_mesh_path(from, meso_folder_length(from), file, &found, arena, error))
            return MESO_ERR_MEMORY;
        if (found)
            set->inners[i].file = meso_arena_print(arena, error, "%s%s", way, file);
        if (!set->inners[i].file)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

MesoStatus meso_mesh_paths_move(MesoTileSet *set, const char *from, const char *to, MesoArena *arena,
                                MesoError *error)
{
    if (strcmp(from, "-") == 0 || strcmp(to, "-") == 0)
        return MESO_OK;
    char *old = real_folder(from, arena, error), *new = real_folder(to, arena, error);
    MesoStatus status = MESO_OK;
    if (old && new && strcmp(old, new) != 0) {
        const char *way = way_between(new, old, arena, error);
        status = way ? move_names(set, from, way, arena, error) : MESO_ERR_MEMORY;
    }
    free(old);
    free(new);
    return status;
}
