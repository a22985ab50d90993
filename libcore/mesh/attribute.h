/* Attributes: what a mesh carries beside its shape, by name. */
#ifndef MESO_ATTRIBUTE_H
#define MESO_ATTRIBUTE_H

#include "libcore/base/arena.h"
#include "libcore/base/index.h"
#include "libcore/math/vec.h"

typedef enum MesoAttributeDomain { MESO_ON_VERTICES, MESO_ON_FACES, MESO_ON_CORNERS } MesoAttributeDomain;

/* How numbers lie in memory: as in the file, so that nothing is lost on the way through. */
typedef enum MesoScalar {
    MESO_SCALAR_FLOAT, MESO_SCALAR_DOUBLE,
    MESO_SCALAR_INT8, MESO_SCALAR_UINT8, MESO_SCALAR_INT16, MESO_SCALAR_UINT16,
    MESO_SCALAR_INT32, MESO_SCALAR_UINT32,
    MESO_SCALAR_KINDS
} MesoScalar;

/*
 * The names that readers and writers of all formats agree on:
 *
 *     "normal"    3 numbers, of any length        vn; nx ny nz; NORMAL
 *     "uv"        2 (or 3)                        vt; s t, u v, texture_u texture_v; TEXCOORD_0
 *     "color"     3 or 4, linear where a file says so     red green blue alpha; COLOR_0
 *     "group", "object", "material"               names: g, o, usemtl; materials of glTF
 *     "albedo", "roughness", "metallic"           3, 1 and 1 numbers of faces, as in material.h: what materials look like
 *
 * Everything else keeps the name that the file gives it.
 */
typedef struct MesoAttribute {
    const char *name;
    const char **components;    /* [width] the file's own names: "red", "fieldx"; NULL where it has none */
    MesoAttributeDomain domain;
    MesoScalar scalar;
    bool normalized;            /* integers stand for [0, 1], signed ones for [-1, 1] */
    uint32_t width;             /* numbers an entry; 0: entries are names */
    uint32_t entry_count;
    void *values;               /* [width * entry_count] of `scalar` */
    const char **names;         /* [entry_count] where width is 0 */
    uint32_t *entry_of;         /* [elements of the domain], or MESO_NO_INDEX for none; NULL: element i has entry i */
} MesoAttribute;

/* Bytes of one number. */
uint32_t meso_scalar_size(MesoScalar scalar);

/* Entry of an element, or MESO_NO_INDEX. */
static inline uint32_t meso_attribute_entry(const MesoAttribute *attribute, uint32_t element)
{
    return attribute->entry_of ? attribute->entry_of[element] : element;
}

/* A number of an entry, scaled where it is normalized. Component below width. */
double meso_attribute_number(const MesoAttribute *attribute, uint32_t entry, uint32_t component);

/* Place of the number that the file calls `name`, or that is the only one of an attribute `name`; or MESO_NO_INDEX. */
uint32_t meso_attribute_component(const MesoAttribute *attribute, const char *name);

/* The first two or three numbers of an entry as floats; what is missing is 0. */
MesoVec2 meso_attribute_vec2(const MesoAttribute *attribute, uint32_t entry);
MesoVec3 meso_attribute_vec3(const MesoAttribute *attribute, uint32_t entry);

#endif
