/* Floats as text, by std::to_chars: shortest digits, no locale. */
#ifndef MESO_FLOAT_TEXT_H
#define MESO_FLOAT_TEXT_H

#ifdef __cplusplus
extern "C" {
#endif

/* The most characters that a float takes: "-1.17549435e-38". */
enum { MESO_FLOAT_TEXT = 15 };

/*
 * Writes the shortest decimal that reads back as the same float to `out`
 * [MESO_FLOAT_TEXT], without a terminating zero; returns its end. "0" for
 * what is not finite, which text formats of meshes cannot say.
 */
char *meso_float_text(float value, char *out);

#ifdef __cplusplus
}
#endif

#endif
