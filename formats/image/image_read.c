#include "formats/image/image_read.h"

#include "formats/image/image_kinds.h"
#include "formats/product/file_kind.h"

MesoStatus meso_image_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoFileKind kind = meso_file_kind(input);
    *out = (MesoPicture){0};
    if (kind == MESO_FILE_EXR)
        return meso_exr_read(out, arena, input, error);
    if (kind == MESO_FILE_PNG)
        return meso_png_read(out, arena, input, error);
    if (kind == MESO_FILE_HDR)
        return meso_hdr_read(out, arena, input, error);
    if (kind != MESO_FILE_UNKNOWN)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %s, not a picture; PNG, OpenEXR and Radiance are read",
                         input->path,
                         meso_file_kind_phrase(kind));
    return meso_fail(error, MESO_ERR_INPUT, "%s: not a picture; PNG, OpenEXR and Radiance are read", input->path);
}
