/* Materials as grammars and options say them: "leaf #3f7a26 0.5". */
#ifndef MESO_GROW_MATERIAL_H
#define MESO_GROW_MATERIAL_H

#include "libcore/base/error.h"
#include "libcore/scene/material.h"

enum { MESO_GROW_NAME = 64 };

/*
 * Reads NAME, or NAME #rrggbb, and behind that roughness and metallic, from 0 to 1; the colour is as in pictures (sRGB).
 * `look` keeps what is not said. MESO_ERR_INPUT.
 */
MesoStatus meso_grow_material(MesoMaterial *look, char name[MESO_GROW_NAME], const char *text, MesoError *error);

#endif
