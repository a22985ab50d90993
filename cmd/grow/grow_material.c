#include "cmd/grow/grow_material.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static float linear_of(uint32_t byte)
{
    float x = (float)byte / 255;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

static bool read_material(const char *text, MesoMaterial *look, char name[MESO_GROW_NAME])
{
    unsigned red, green, blue;
    float roughness = look->roughness, metallic = look->metallic;
    int end = 0, count = sscanf(text, "%63[^# ] #%2x%2x%2x%n %f %f", name, &red, &green, &blue, &end, &roughness,
                                &metallic);
    if (count == 1 && strlen(name) == strlen(text))
        return true;
    const char *digits = strchr(text, '#');
    if (count < 4 || !digits || strspn(digits + 1, "0123456789abcdefABCDEF") != 6 || strspn(text + end, " 0123456789.") != strlen(text + end) || roughness > 1 || metallic > 1)
        return false;
    *look = (MesoMaterial){{linear_of(red), linear_of(green), linear_of(blue)}, roughness, metallic};
    return true;
}

MesoStatus meso_grow_material(MesoMaterial *look, char name[MESO_GROW_NAME], const char *text, MesoError *error)
{
    if (read_material(text, look, name))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "material '%s': a name is wanted, or NAME #rrggbb, and behind it "
                     "roughness and metallic from 0 to 1", text);
}
