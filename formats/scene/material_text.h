/* Materials as grammars and options say them: "leaf #3f7a26 0.5". */
#ifndef MESO_MATERIAL_TEXT_H
#define MESO_MATERIAL_TEXT_H

#include "libcore/base/error.h"
#include "libcore/scene/material.h"

enum { MESO_MATERIAL_NAME = 64 };

/*
 * Reads NAME, or NAME #rrggbb, and behind that roughness and metallic, from 0 to 1; the colour is as in pictures (sRGB).
 * `look` keeps what is not said. MESO_ERR_INPUT.
 */
MesoStatus meso_material_of_text(MesoMaterial *look, char name[MESO_MATERIAL_NAME], const char *text, MesoError *error);

#endif
