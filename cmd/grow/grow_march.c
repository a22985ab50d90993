#include "cmd/grow/grow_march.h"

#include <string.h>

#include "cmd/grow/grow_uvs.h"
#include "libcore/chart/atlas.h"

enum { TEXELS = 1024 };

static bool is(const char *given, const char *word)
{
    return given && strcmp(given, word) == 0;
}

/* Coordinates by corner. */
static MesoStatus choose_atlas(const MesoVec2 **uvs, MesoGrowArguments *a, const MesoGrowSurface *surface)
{
    MesoTool *tool = &a->tool;
    MesoVec2 *own = NULL;
    MesoAtlas atlas;
    MesoError error = {0};
    if (is(a->atlas, "uv")) {
        MesoStatus status = meso_grow_uvs(&own, &tool->arena, &surface->polygons, &surface->mesh, &error);
        *uvs = own;
        if (status == MESO_ERR_INPUT)
            return meso_fail(&tool->error, status, "--atlas uv needs %s", error.message);
        tool->error = status ? error : tool->error;
        return status;
    }
    MesoStatus status = meso_atlas_build(&atlas, &tool->arena, &surface->mesh,
                                         &(MesoChartOptions){.largest_ratio = 4, .relaxations = 4}, &tool->error);
    *uvs = atlas.corner_uv;
    return status;
}

MesoStatus meso_grow_march_init(MesoGrowMarch *m, MesoGrowArguments *a, const MesoGrowSurface *surface)
{
    MesoTool *tool = &a->tool;
    const MesoVec2 *uvs;
    *m = (MesoGrowMarch){0};
    bool straight = !a->march || is(a->march, "mesh");
    if (straight && (a->atlas || a->texels))
        return meso_fail(&tool->error, MESO_ERR_USAGE, "%s is for marches through textures: give --march, too",
                         a->atlas ? "--atlas" : "--texels");
    if (straight)
        return MESO_OK;
    MesoStatus status = choose_atlas(&uvs, a, surface);
    if (!status)
        status = meso_geometry_image_build(&m->image, &tool->arena, &surface->mesh, uvs, surface->ground.normals,
                                           a->texels ? a->texels : TEXELS, &tool->error);
    if (status == MESO_ERR_INPUT)
        meso_fail_prefix(&tool->error, tool->operands[1]);
    m->texture = (MesoTextureMarch){.mesh = &surface->mesh, .ground = &surface->ground.walk, .image = &m->image,
                                    .snaps = is(a->march, "texel"), .metric = is(a->march, "metric")};
    m->march = (MesoGrowthMarch){meso_texture_walks, &m->texture};
    return status;
}
