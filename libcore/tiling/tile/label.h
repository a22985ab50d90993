/*
 * Labels: what a side shows, a signed interface number (MesoGen, section 3.2): +(interface + 1),
 * negative if flipped, 0 for none. Two sides match when their labels are opposite.
 */
#ifndef MESO_LABEL_H
#define MESO_LABEL_H

#include <stdint.h>

/* Interface of a label, which must not be 0. */
static inline uint32_t meso_label_interface(int32_t label)
{
    return (uint32_t)(label < 0 ? -label : label) - 1;
}

/* Its number in bit sets: 2 * interface for +, 2 * interface + 1 for -. */
static inline uint32_t meso_label_code(int32_t label)
{
    return 2 * meso_label_interface(label) + (label < 0);
}

/* What stands behind the interface's name in texts: "a" and "a'". */
static inline const char *meso_label_mark(int32_t label)
{
    return label < 0 ? "'" : "";
}

static inline const char *meso_code_mark(uint32_t code)
{
    return code % 2 ? "'" : "";
}

#endif
