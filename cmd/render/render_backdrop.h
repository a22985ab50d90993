/* What is behind the model in a PNG. */
#ifndef MESO_RENDER_BACKDROP_H
#define MESO_RENDER_BACKDROP_H

#include "cmd/render/render_arguments.h"
#include "formats/image/image_file.h"
#include "libcore/render/environment/environment.h"
#include "libcore/render/raster/raster_view.h"

typedef enum MesoBackdropKind { MESO_BACKDROP_COLOR, MESO_BACKDROP_NONE, MESO_BACKDROP_PICTURE, MESO_BACKDROP_LIGHT }
    MesoBackdropKind;

typedef struct MesoRenderBackdrop {
    MesoBackdropKind kind;
    MesoTone tone;
    float color[3];
    uint32_t width, height;     /* of the picture */
    const float *channels[3];   /* of it, linear, as shown */
    const MesoEnvironment *environment;
    MesoVec3 up;                /* in the world; 0: as the camera's */
} MesoRenderBackdrop;

/*
 * What --background and --tone ask for; a picture is read to the tool's arena. `environment`: that of the light, or
 * NULL. MESO_ERR_USAGE where they do not fit; what readers say of the file.
 */
MesoStatus meso_render_backdrop_init(MesoRenderBackdrop *backdrop, MesoRenderArguments *a,
                                     const MesoEnvironment *environment, MesoError *error);

/* Rows of it, behind a picture of a camera. */
typedef struct MesoBackdropRows {
    const MesoRenderBackdrop *backdrop;
    uint32_t width, height;
    MesoView view;
    MesoRasterView raster;
    MesoVec3 axes[3];           /* of the environment */
} MesoBackdropRows;

/* The look of a PNG before it, which points to `rows`. As meso_view_build(). */
MesoStatus meso_render_backdrop_look(MesoPngLook *look, MesoBackdropRows *rows, const MesoRenderBackdrop *backdrop,
                                     const MesoCamera *camera, uint32_t width, uint32_t height, MesoError *error);

#endif
