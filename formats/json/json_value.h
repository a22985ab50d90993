/* Fields of parsed JSON that must be within some bounds: words of a list, short texts, ranges of numbers, colours. */
#ifndef MESO_JSON_VALUE_H
#define MESO_JSON_VALUE_H

#include "formats/json/json_field.h"

/* Says that `text` is none of `words`, ended by NULL, and which one it may be meant to be, or which there are. */
void meso_json_refuse(const MesoJsonField *field, const char *what, const char *text, const char *const *words);

/* Number among `words` of the text at `field`; refused where it is none. */
uint32_t meso_json_word(const MesoJsonField *field, const char *what, const char *const *words, uint32_t fallback);

/* Text of 1 to `most` bytes in the arena; "" where that is wrong. */
const char *meso_json_short_text(const MesoJsonField *field, size_t most);

/* A number within [low, high], or, where `open`, between them. */
float meso_json_float_in(const MesoJsonField *field, float low, float high, bool open, float fallback);

/* "#rrggbb" or "#rgb" as of pictures, or three numbers from 0 to 1, linear; where it is missing `color` stays. */
void meso_json_color(const MesoJsonField *field, float color[3]);

#endif
