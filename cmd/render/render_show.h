/* What --show draws: the surface below a structure, its assignment, where a solver failed; and models by their ids. */
#ifndef MESO_RENDER_SHOW_H
#define MESO_RENDER_SHOW_H

#include "cmd/render/render_arguments.h"
#include "cmd/render/rendered_scene.h"

/* MESO_ERR_USAGE where the word is none of those that there are, or operands and --report are not what it takes. */
MesoStatus meso_render_show_check(const MesoRenderArguments *a, MesoError *error);

/* Which operand is the surface or the model: the second where a tile set stands before it. */
uint32_t meso_render_show_surface(const MesoRenderArguments *a);

/* As meso_render_source_read() (render_source.h), of what --show says. */
MesoStatus meso_render_show_read(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error);

#endif
