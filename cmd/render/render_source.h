/* What a picture is of: a model or a mesh, a sheet of tiles, or what is shown of a surface and its assignment. */
#ifndef MESO_RENDER_SOURCE_H
#define MESO_RENDER_SOURCE_H

#include "cmd/render/render_arguments.h"
#include "cmd/render/rendered_scene.h"

/* MESO_ERR_USAGE where the operands are not those of what is to be shown. `model` in `a` gets the one that may be a
 * pattern; NULL where there is none. */
MesoStatus meso_render_source_check(MesoRenderArguments *a, MesoError *error);

/* Reads it to the tool's arena. `model` is the operand of this frame. Errors as those of the readers. */
MesoStatus meso_render_source_read(MesoRenderSource *source, MesoRenderArguments *a, const char *model,
                                   MesoError *error);

/* The camera that the options ask for; a sheet is looked at from its front. */
MesoCamera meso_render_source_camera(const MesoRenderArguments *a, const MesoScene *scene);
void meso_render_source_close(MesoRenderSource *source);

#endif
