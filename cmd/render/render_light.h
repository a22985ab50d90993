/* The light of pictures, where it does not come with the camera. */
#ifndef MESO_RENDER_LIGHT_H
#define MESO_RENDER_LIGHT_H

#include "cmd/render/render_arguments.h"
#include "libcore/render/environment/environment.h"

/*
 * What --light, --light-turn and --light-strength ask for, in the tool's arena; NULL: the light that comes with the
 * camera. MESO_ERR_USAGE where they do not fit; what readers say of the file.
 */
MesoStatus meso_render_light_init(const MesoEnvironment **environment, MesoRenderArguments *a, MesoError *error);

#endif
