/* Colours that tell things apart by their numbers. */
#ifndef MESO_ID_COLOR_H
#define MESO_ID_COLOR_H

#include <stdint.h>

/* Linear, for the material's albedo: hues and values that are spread evenly, so that
 * things of near numbers differ most. The same for the same id. */
void meso_id_color(float albedo[3], uint32_t id);

#endif
