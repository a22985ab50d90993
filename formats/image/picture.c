#include "formats/image/picture.h"

#include <string.h>

MesoStatus meso_picture_alloc(MesoPicture *out, MesoArena *arena, const MesoInput *input, uint64_t width,
                              uint64_t height, uint32_t channel_count, MesoError *error)
{
    if (width == 0 || height == 0 || channel_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: the picture is empty", input->path);
    /* one factor after the other, so that no product overflows */
    if (width > MESO_PICTURE_VALUES || height > MESO_PICTURE_VALUES / width ||
        channel_count > MESO_PICTURE_VALUES / (width * height))
        return meso_fail(error, MESO_ERR_LIMIT, "%s: %llu x %llu pixels of %u channels are more than %u values",
                         input->path, (unsigned long long)width, (unsigned long long)height, channel_count,
                         MESO_PICTURE_VALUES);
    *out = (MesoPicture){(uint32_t)width, (uint32_t)height, channel_count, NULL, NULL};
    out->channel_names = MESO_NEW(arena, const char *, channel_count, error);
    out->values = MESO_NEW(arena, float, width * height * channel_count, error);
    return out->channel_names && out->values ? MESO_OK : MESO_ERR_MEMORY;
}

static const float *find_channel(const MesoPicture *picture, const char *name)
{
    for (uint32_t c = 0; c < picture->channel_count; c++)
        if (strcmp(picture->channel_names[c], name) == 0)
            return picture->values + (size_t)c * picture->width * picture->height;
    return NULL;
}

bool meso_picture_colors(const MesoPicture *picture, const float *channels[3])
{
    static const char *const names[3] = {"R", "G", "B"};
    const float *grey = find_channel(picture, "Y");
    for (int c = 0; c < 3; c++) {
        channels[c] = find_channel(picture, names[c]);
        channels[c] = channels[c] ? channels[c] : grey;
    }
    return channels[0] && channels[1] && channels[2];
}
