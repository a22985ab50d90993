#include "formats/scene/material_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static float linear_of(uint32_t byte)
{
    float x = (float)byte / 255;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

/* "0.5 1", or less of it: numbers from 0 to 1 between spaces. */
static bool read_shares(const char *text, float *shares[2])
{
    for (uint32_t i = 0; i < 2; i++) {
        text += strspn(text, " ");
        size_t length = strspn(text, "0123456789.");
        char *end;
        if (*text == '\0')
            return true;
        *shares[i] = strtof(text, &end);
        if (length == 0 || end != text + length || (*end != ' ' && *end != '\0') || *shares[i] > 1)
            return false;
        text = end;
    }
    return text[strspn(text, " ")] == '\0';
}

static bool read_material(const char *text, MesoMaterial *look, char name[MESO_MATERIAL_NAME])
{
    unsigned red, green, blue;
    int end = 0, count = sscanf(text, "%63[^# ] #%2x%2x%2x%n", name, &red, &green, &blue, &end);
    float roughness = look->roughness, metallic = look->metallic;
    float *shares[2] = {&roughness, &metallic};
    if (count == 1 && strlen(name) == strlen(text))
        return true;
    const char *digits = strchr(text, '#');
    if (count < 4 || !digits || strspn(digits + 1, "0123456789abcdefABCDEF") != 6 || !read_shares(text + end, shares))
        return false;
    *look = (MesoMaterial){{linear_of(red), linear_of(green), linear_of(blue)}, roughness, metallic};
    return true;
}

MesoStatus meso_material_of_text(MesoMaterial *look, char name[MESO_MATERIAL_NAME], const char *text, MesoError *error)
{
    if (read_material(text, look, name))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "material '%s': a name is wanted, or NAME #rrggbb, and behind it "
                     "roughness and metallic from 0 to 1", text);
}
