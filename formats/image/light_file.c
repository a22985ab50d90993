#include "formats/image/light_file.h"

#include <stdlib.h>

#include "formats/image/image_read.h"
#include "formats/product/file_kind.h"

MesoStatus meso_light_read(MesoLatLong *map, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoPicture picture;
    const float *channels[3];
    if (meso_file_kind(input) == MESO_FILE_PNG)
        return meso_fail(error, MESO_ERR_INPUT, "%s: a PNG image does not say how bright light is; OpenEXR and "
                         "Radiance pictures are read as light", input->path);
    MesoStatus status = meso_image_read(&picture, arena, input, error);
    if (status)
        return status;
    if (!meso_picture_colors(&picture, channels))
        return meso_fail(error, MESO_ERR_INPUT, "%s: no channels R, G and B, or Y", input->path);
    if (llabs((long long)picture.width - 2 * (long long)picture.height) > picture.height / 16 + 1)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %u x %u pixels; a picture of all directions by latitude and "
                         "longitude is twice as wide as high", input->path, picture.width, picture.height);
    status = meso_lat_long_init(map, arena, picture.width, picture.height, error);
    if (status)
        return status;
    for (size_t i = 0; i < (size_t)picture.width * picture.height; i++)
        for (size_t c = 0; c < 3; c++)
            map->rgb[3 * i + c] = channels[c][i];
    return MESO_OK;
}
