#include "libcore/mesh/attribute.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Size, and what a normalized number is multiplied by. */
static const struct {
    uint32_t size;
    double scale;
    bool has_sign;
} scalars[MESO_SCALAR_KINDS] = {
    [MESO_SCALAR_FLOAT] = {4, 1, false},
    [MESO_SCALAR_DOUBLE] = {8, 1, false},
    [MESO_SCALAR_INT8] = {1, 1.0 / INT8_MAX, true},
    [MESO_SCALAR_UINT8] = {1, 1.0 / UINT8_MAX, false},
    [MESO_SCALAR_INT16] = {2, 1.0 / INT16_MAX, true},
    [MESO_SCALAR_UINT16] = {2, 1.0 / UINT16_MAX, false},
    [MESO_SCALAR_INT32] = {4, 1.0 / INT32_MAX, true},
    [MESO_SCALAR_UINT32] = {4, 1.0 / UINT32_MAX, false},
};

uint32_t meso_scalar_size(MesoScalar scalar)
{
    return scalars[scalar].size;
}

static double load(MesoScalar scalar, const void *values, size_t i)
{
    switch (scalar) {
    case MESO_SCALAR_DOUBLE: return ((const double *)values)[i];
    case MESO_SCALAR_INT8: return ((const int8_t *)values)[i];
    case MESO_SCALAR_UINT8: return ((const uint8_t *)values)[i];
    case MESO_SCALAR_INT16: return ((const int16_t *)values)[i];
    case MESO_SCALAR_UINT16: return ((const uint16_t *)values)[i];
    case MESO_SCALAR_INT32: return ((const int32_t *)values)[i];
    case MESO_SCALAR_UINT32: return ((const uint32_t *)values)[i];
    default: return (double)((const float *)values)[i];
    }
}

double meso_attribute_number(const MesoAttribute *attribute, uint32_t entry, uint32_t component)
{
    assert(entry < attribute->entry_count && component < attribute->width);
    double number = load(attribute->scalar, attribute->values, (size_t)entry * attribute->width + component);
    if (!attribute->normalized)
        return number;
    number *= scalars[attribute->scalar].scale;
    return scalars[attribute->scalar].has_sign ? fmax(number, -1) : number;
}

static float component_or_zero(const MesoAttribute *attribute, uint32_t entry, uint32_t component)
{
    return component < attribute->width ? (float)meso_attribute_number(attribute, entry, component) : 0;
}

MesoVec2 meso_attribute_vec2(const MesoAttribute *attribute, uint32_t entry)
{
    return (MesoVec2){component_or_zero(attribute, entry, 0), component_or_zero(attribute, entry, 1)};
}

MesoVec3 meso_attribute_vec3(const MesoAttribute *attribute, uint32_t entry)
{
    return (MesoVec3){component_or_zero(attribute, entry, 0), component_or_zero(attribute, entry, 1),
                      component_or_zero(attribute, entry, 2)};
}

uint32_t meso_attribute_component(const MesoAttribute *attribute, const char *name)
{
    for (uint32_t c = 0; attribute->components && c < attribute->width; c++)
        if (attribute->components[c] && strcmp(attribute->components[c], name) == 0)
            return c;
    return attribute->width == 1 && strcmp(attribute->name, name) == 0 ? 0 : MESO_NO_INDEX;
}
