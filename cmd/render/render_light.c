#include "cmd/render/render_light.h"

#include <string.h>

#include "formats/image/light_file.h"
#include "libcore/render/environment/built_in.h"

static MesoStatus read_map(MesoLatLong *map, MesoRenderArguments *a, MesoError *error)
{
    MesoArena *arena = &a->tool.arena;
    if (strcmp(a->light, "sky") == 0)
        return meso_built_in_draw(map, arena, MESO_BUILT_IN_SKY, error);
    if (strcmp(a->light, "studio") == 0)
        return meso_built_in_draw(map, arena, MESO_BUILT_IN_STUDIO, error);
    MesoInput input;
    MesoStatus status = meso_tool_open_input(&a->tool, &input, a->light, "light");
    if (status)
        return status;
    status = meso_light_read(map, arena, &input, error);
    meso_input_close(&input);
    return status;
}

MesoStatus meso_render_light_init(const MesoEnvironment **environment, MesoRenderArguments *a, MesoError *error)
{
    MesoLatLong map;
    const MesoEnvironmentOptions options = {a->light_turn, a->light_strength};
    *environment = NULL;
    if (strcmp(a->light, "camera") == 0)
        return a->light_turn_given || a->light_strength_given
                   ? meso_fail(error, MESO_ERR_USAGE, "--light-turn and --light-strength are for --light studio, sky "
                                                      "or FILE")
                   : MESO_OK;
    MesoStatus status = read_map(&map, a, error);
    MesoEnvironment *made = status ? NULL : MESO_NEW(&a->tool.arena, MesoEnvironment, 1, error);
    if (!made)
        return status ? status : MESO_ERR_MEMORY;
    *environment = made;
    return meso_environment_init(made, &a->tool.arena, &map, &options, a->tool.threads, error);
}
