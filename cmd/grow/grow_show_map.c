#include "cmd/grow/grow_show_map.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "cmd/grow/grow_uvs.h"
#include "formats/image/image_file.h"
#include "libcore/base/nearest.h"
#include "libcore/growth/ground/map_picture.h"

enum { SIZE = 1024 };

static MesoStatus find_map(MesoTool *tool, const char *name, size_t length, const MesoGrammar *grammar, uint32_t *map)
{
    MesoNearest nearest = meso_nearest(name, length);
    for (*map = 0; *map < grammar->map_count; ++*map) {
        const char *other = grammar->maps[*map].name;
        if (other && strlen(other) == length && memcmp(other, name, length) == 0)
            return MESO_OK;
        if (other)
            meso_nearest_try(&nearest, other);
    }
    if (nearest.best)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--show-map: the grammar has no map '%.*s'; is '%s' meant?",
                         (int)length, name, nearest.best);
    return meso_fail(&tool->error, MESO_ERR_USAGE, "--show-map: the grammar has no map '%.*s'", (int)length, name);
}

/* From 0 to 1, or from the least to the most where that is beyond. */
static void find_range(MesoImageValues *picture)
{
    picture->low = 0;
    picture->high = 1;
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        float value = picture->values[i];
        picture->low = value < picture->low ? value : picture->low;
        picture->high = value > picture->high ? value : picture->high;
    }
}

static MesoStatus draw(MesoTool *tool, MesoImageValues *picture, const MesoGrowthContexts *contexts, uint32_t map,
                       const MesoPolygonMesh *polygons)
{
    MesoVec2 *uvs;
    MesoError error;
    MesoStatus status = meso_grow_uvs(&uvs, &tool->arena, polygons, contexts->ground->mesh, &error);
    if (status)
        return meso_fail(&tool->error, status, "%s%s", status == MESO_ERR_INPUT ? "--show-map needs " : "",
                         error.message);
    float *values = MESO_NEW(&tool->arena, float, (size_t)SIZE * SIZE, &tool->error);
    if (!values)
        return MESO_ERR_MEMORY;
    *picture = (MesoImageValues){.width = SIZE, .height = SIZE, .values = values};
    status = meso_map_picture(values, SIZE, SIZE, contexts->ground, &contexts->maps[map], uvs, &tool->arena,
                              &tool->error);
    find_range(picture);
    return status;
}

/* By the suffix; what black and white are is said of a PNG alone. */
static MesoStatus write(MesoTool *tool, const MesoImageValues *picture, const char *path)
{
    const char *dot = strrchr(path, '.');
    bool exr = dot && strcasecmp(dot, ".exr") == 0;
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, path, &tool->error);
    if (status)
        return status;
    status = exr ? meso_exr_write_values(picture, &tool->provenance, tool->threads, output, &tool->error)
                 : meso_png_write_values(picture, &tool->provenance, output, &tool->error);
    status = meso_output_finish(output, status, &tool->error);
    if (!status && !exr && (picture->low < 0 || picture->high > 1))
        meso_tool_say(tool, "%s: black is %g, white is %g", path, (double)picture->low, (double)picture->high);
    return status;
}

MesoStatus meso_grow_show_map(MesoTool *tool, const char *name_and_file, const MesoGrammar *grammar,
                              const MesoGrowthContexts *contexts, const MesoPolygonMesh *polygons)
{
    const char *equals = strchr(name_and_file, '=');
    MesoImageValues picture;
    uint32_t map;
    if (!equals || !equals[1])
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--show-map needs a map and a file, as wall=wall.png, not '%s'",
                         name_and_file);
    MesoStatus status = find_map(tool, name_and_file, (size_t)(equals - name_and_file), grammar, &map);
    if (!status)
        status = draw(tool, &picture, contexts, map, polygons);
    if (!status)
        status = meso_tool_add_output(tool, "--show-map", equals + 1);
    return status ? status : write(tool, &picture, equals + 1);
}
