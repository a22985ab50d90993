#include "cmd/common/paths.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "formats/file/output.h"
#include "libcore/base/grow.h"

static bool key_of_file(MesoFileKey *key, const struct stat *file)
{
    *key = (MesoFileKey){.device = file->st_dev, .inode = file->st_ino};
    return S_ISREG(file->st_mode);
}

/* A file that is not there yet: its folder is, and its name is its own. */
static bool key_of_name(MesoFileKey *key, char *path)
{
    struct stat folder;
    char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    XXH128_hash_t hash = XXH3_128bits(name, strlen(name));
    if (slash)
        slash[slash == path] = 0;   /* the root keeps its slash */
    if (stat(slash ? path : ".", &folder) != 0)
        return false;
    *key = (MesoFileKey){folder.st_dev, folder.st_ino, {hash.high64, hash.low64 | 1}};
    return true;
}

bool meso_path_key(MesoFileKey *key, const char *path, bool output)
{
    struct stat file;
    int descriptor = strcmp(path, "-") != 0 ? -1 : output ? STDOUT_FILENO : STDIN_FILENO;
    if (descriptor >= 0)
        return fstat(descriptor, &file) == 0 && key_of_file(key, &file);
    if (stat(path, &file) == 0)
        return key_of_file(key, &file);
    char *target = meso_output_target(path);
    bool named = target && key_of_name(key, target);
    free(target);
    return named;
}

static bool is_same(const MesoFileKey *a, const MesoFileKey *b)
{
    return a->device == b->device && a->inode == b->inode && a->name[0] == b->name[0] && a->name[1] == b->name[1];
}

static bool is_stream(const char *path)
{
    return strcmp(path, "-") == 0;
}

static MesoStatus refuse(MesoPaths *paths, const MesoPath *one, const MesoPath *other, MesoError *error)
{
    const MesoPath *output = other->option ? other : one, *input = other->option ? one : other;
    paths->clash[0] = one->path;
    paths->clash[1] = other->path;
    const char *name = is_stream(output->path) ? "standard output" : output->path;
    if (one->option && other->option)
        return meso_fail(error, MESO_ERR_USAGE, "%s and %s would both write '%s', and one be lost: name another file",
                         one->option, other->option, name);
    return meso_fail(error, MESO_ERR_USAGE, "%s '%s' would write over the input '%s': name another file",
                     output->option, name, input->path);
}

/* `added` against those before it. */
static MesoStatus check(MesoPaths *paths, const MesoPath *added, MesoError *error)
{
    for (uint32_t i = 0; i < paths->count; i++) {
        const MesoPath *path = &paths->paths[i];
        bool matters = added->option || path->option;
        bool streams = added->option && path->option && is_stream(added->path) && is_stream(path->path);
        if (matters && !streams && is_same(&path->key, &added->key))
            return refuse(paths, path, added, error);
    }
    return MESO_OK;
}

static MesoStatus keep(MesoPaths *paths, MesoPath added, MesoArena *arena, MesoError *error)
{
    MesoPath *more = MESO_GROW(arena, paths->paths, paths->count, paths->room, 16, error);
    if (!more)
        return MESO_ERR_MEMORY;
    paths->paths = more;
    paths->paths[paths->count++] = added;
    return MESO_OK;
}

MesoStatus meso_paths_add_input(MesoPaths *paths, const char *path, MesoArena *arena, MesoError *error)
{
    MesoPath added = {.path = path};
    if (!meso_path_key(&added.key, path, false))
        return MESO_OK;
    MesoStatus status = check(paths, &added, error);
    return status ? status : keep(paths, added, arena, error);
}

MesoStatus meso_paths_check_output(MesoPaths *paths, const char *option, const char *path, MesoError *error)
{
    MesoPath added = {.path = path, .option = option};
    return meso_path_key(&added.key, path, true) ? check(paths, &added, error) : MESO_OK;
}

MesoStatus meso_paths_add_output(MesoPaths *paths, const char *option, const char *path, MesoArena *arena,
                                 MesoError *error)
{
    MesoPath added = {.path = path, .option = option};
    if (!meso_path_key(&added.key, path, true))
        return MESO_OK;
    MesoStatus status = check(paths, &added, error);
    return status ? status : keep(paths, added, arena, error);
}
