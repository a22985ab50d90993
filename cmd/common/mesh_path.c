#define _XOPEN_SOURCE 700       /* realpath() */
#include "cmd/common/mesh_path.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/mesh/surface_read.h"

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

/* ---- read ---- */

typedef struct Reading {
    MesoTool *tool;
    const MesoTileSet *set;
    const char *tiles, *mesh_path;
} Reading;

static const char *tile_of_inner(const MesoTileSet *set, uint32_t inner)
{
    for (uint32_t t = 0; t < set->tile_count; t++)
        if (inner - set->tiles[t].inner_begin < set->tiles[t].inner_count)
            return set->tiles[t].name;
    return "?";
}

/* Beside the tile set first, then in --mesh-path; NULL with `error` filled where it is in neither. */
static const char *find_inner(const Reading *a, uint32_t inner)
{
    bool found = false;
    MesoArena *arena = &a->tool->arena;
    MesoError *error = &a->tool->error;
    const MesoTileSet *set = a->set;
    const char *file = set->inners[inner].file, *tiles = a->tiles, *elsewhere = NULL;
    const char *beside = meso_mesh_path(tiles, meso_folder_length(tiles), file, &found, arena, error);
    if (!beside || found)
        return beside;
    if (a->mesh_path) {
        elsewhere = meso_mesh_path(a->mesh_path, (int)strlen(a->mesh_path), file, &found, arena, error);
        if (!elsewhere || found)
            return elsewhere;
    }
    meso_fail(error, MESO_ERR_INPUT,
              "tile '%s': its mesh '%s' is not there: looked for '%s'%s%s%s; give its folder with --mesh-path",
              tile_of_inner(set, inner), file, beside, elsewhere ? " and '" : "", elsewhere ? elsewhere : "",
              elsewhere ? "'" : "");
    return NULL;
}

static MesoStatus read_inner(const Reading *a, uint32_t inner, MesoTriangleMesh *mesh)
{
    MesoTool *tool = a->tool;
    MesoError *error = &tool->error;
    MesoInput input;
    const char *path = find_inner(a, inner);
    if (!path)
        return error->status;
    if (tool->provenance.input_count == MESO_PROVENANCE_INPUTS)
        return meso_fail(error, MESO_ERR_LIMIT, "too many meshes in tiles: at most %d different files",
                         MESO_PROVENANCE_INPUTS - 3);
    MesoStatus status = meso_tool_open_input(tool, &input, path, "mesh");
    if (status)
        return status;
    status = meso_triangle_mesh_read(mesh, &tool->arena, &input, tool->threads, error);
    meso_input_close(&input);
    return status;
}

MesoStatus meso_tool_read_tile_meshes(MesoTool *tool, MesoTriangleMesh **meshes, const MesoTileSet *set,
                                      const char *tiles, const char *mesh_path)
{
    const Reading reading = {tool, set, tiles, mesh_path};
    MesoTriangleMesh *read = *meshes = MESO_NEW(&tool->arena, MesoTriangleMesh, set->inner_count, &tool->error);
    if (!read)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < set->inner_count; i++) {
        uint32_t same = 0;
        while (strcmp(set->inners[same].file, set->inners[i].file) != 0)
            same++;
        if (set->inners[i].file[0] == 0)
            continue;
        if (same < i) {
            read[i] = read[same];
            continue;
        }
        MesoStatus status = read_inner(&reading, i, &read[i]);
        if (status)
            return status;
    }
    return MESO_OK;
}
