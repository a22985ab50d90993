#include "cmd/render/picture_files.h"

#include <math.h>
#include <string.h>

/* Where nothing is, one pixel is the data: a window may not be empty. */
static MesoExrOptions options_of(const MesoRenderArguments *a, const MesoRenderFrame *frame, bool numbered,
                                 const MesoImage *band)
{
    MesoExrOptions options = {.multipart = a->multipart, .numbered = numbered, .frame = frame->number,
                              .rate = {a->rate[0], a->rate[1]}};
    if (strcmp(a->data_window, "tight") == 0)
        options.window = band->covered.width ? band->covered : (MesoWindow){0, 0, 1, 1};
    return options;
}

MesoStatus meso_picture_files_begin(MesoPictureFiles *files, const MesoRenderArguments *a, const MesoRenderFrame *frame,
                                    bool numbered, const MesoRenderBackdrop *backdrop, const MesoImage *band,
                                    uint32_t height, MesoError *error)
{
    const char *const paths[2] = {frame->output, frame->png};
    const MesoProvenance *provenance = &a->tool.provenance;
    const MesoExrOptions options = options_of(a, frame, numbered, band);
    *files = (MesoPictureFiles){.band = band};
    MesoStatus status = meso_render_backdrop_look(&files->look, &files->behind, backdrop, &band->camera, band->width,
                                                  height, error);
    for (int i = 0; i < 2 && !status; i++) {
        if (!paths[i])
            continue;
        status = meso_output_open(&files->outputs[i], paths[i], error);
        if (!status)
            status = i == 0 && a->exr_product
                         ? meso_exr_begin(&files->exr, band, height, &options, provenance, a->tool.threads,
                                          files->outputs[i], error)
                         : meso_png_begin(&files->pngs[i], band, height, &files->look,
                                          provenance, files->outputs[i], error);
    }
    return status;
}

MesoStatus meso_picture_files_band(MesoPictureFiles *files, MesoError *error)
{
    const MesoImage *band = files->band;
    uint64_t count = (uint64_t)band->width * band->height;
    for (uint64_t i = 0; i < count; i++)
        files->covered += isfinite(band->depth[i]) != 0;
    MesoStatus status = files->exr ? meso_exr_band(files->exr, band->height, error) : MESO_OK;
    for (int i = 0; i < 2 && !status; i++)
        if (files->pngs[i])
            status = meso_png_band(files->pngs[i], band->height, error);
    return status;
}

MesoStatus meso_picture_files_end(MesoPictureFiles *files, MesoStatus status, MesoError *error)
{
    status = meso_exr_end(files->exr, status, error);
    for (int i = 0; i < 2; i++)
        status = meso_png_end(files->pngs[i], status, error);
    return meso_output_finish_all(files->outputs, 2, status, error);
}
