#include "formats/replicate/instance_scene.h"

#include <math.h>
#include <stdio.h>

#include "libcore/math/quaternion.h"

MesoInstance meso_instance_of(const MesoPlacedDetail *placed)
{
    MesoInstance instance = {.position = placed->position};
    const MesoVec3 columns[] = {placed->tangent, meso_vec3_cross(placed->normal, placed->tangent), placed->normal};
    meso_quaternion_of(columns, instance.rotation);
    instance.scale = (MesoVec3){placed->size, placed->width, 0};
    instance.scale.z = (float)sqrt((double)placed->size * (double)placed->width);
    return instance;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

void meso_instance_name(const char *text, uint32_t number, char *name, size_t size)
{
    char ending[16];
    size_t ending_size = (size_t)snprintf(ending, sizeof ending, "_%u", number) + 1, used = 0;
    if (!is_letter(*text))
        name[used++] = '_';
    for (; *text && used + ending_size < size; text++)
        name[used++] = is_letter(*text) || (*text >= '0' && *text <= '9') ? *text : '_';
    snprintf(name + used, size - used, "%s", ending);
}
