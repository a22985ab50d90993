/* Images with their arbitrary output variables (AOVs), and what they are asked for: picture/painter.h draws them. */
#ifndef MESO_IMAGE_H
#define MESO_IMAGE_H

#include <stddef.h>

#include "libcore/render/camera.h"
#include "libcore/base/arena.h"
#include "libcore/render/matte.h"

/* Variables that are made where they are asked for. */
typedef enum MesoImageExtra {
    MESO_EXTRA_POSITION = 1, MESO_EXTRA_UV = 2, MESO_EXTRA_OCCLUSION = 4, MESO_EXTRA_MATERIAL = 8,
    MESO_EXTRA_MATTES = 16, MESO_EXTRA_MOTION = 32
} MesoImageExtra;

/* Rows from top to bottom. Of the arrays none is NULL but those of extras, which are where they were asked for. */
typedef struct MesoImage {
    uint32_t width, height;
    MesoCamera camera;
    float *color;       /* [4 * width * height] linear, premultiplied */
    float *depth;       /* [width * height] along the view axis, scene units; +inf where empty */
    float *normal;      /* [3 * width * height] world space; 0 where empty */
    float *albedo;      /* [3 * width * height] */
    uint32_t channel_count;
    MesoIdChannel channels[MESO_ID_CHANNELS];
    uint32_t *ids[MESO_ID_CHANNELS];    /* [width * height] id + 1 in each channel; 0 where empty */
    float *position;    /* [3 * width * height] world space; 0 where empty */
    float *uv;          /* [2 * width * height] */
    float *openness;    /* [width * height] share of the sky that is seen; 1 where empty */
    float *material;    /* [2 * width * height] roughness and metallic */
    float *motion;      /* [2 * width * height] pixels to its place in the next frame, right and up; 0 where empty */
    uint32_t matte_count;
    MesoMatte mattes[MESO_ID_CHANNELS + 1];     /* of the channels, and of materials */
    MesoWindow covered; /* box of what is not clear in the whole picture, where it was asked for; empty: nothing is */
} MesoImage;

typedef struct MesoRenderOptions {
    uint32_t width, height;     /* up to 16384 each */
    MesoCamera camera;
    uint32_t samples;           /* for antialiasing of color; 1, 4 or 16 */
    MesoVec3 up;                /* in the world, of the ground and an environment; 0: the camera's */
    bool ground;                /* shadow where nothing is, on the ground under the scene */
    unsigned extras;            /* MesoImageExtra, or-ed */
    const struct MesoEnvironment *environment;      /* the light (environment.h); NULL: one that comes with the
                                                     * camera */
    float vary;                 /* how much colours differ from thing to thing (light/vary.h) */
    uint32_t color_ids;         /* channel + 1 whose ids give the colours (id_color.h); 0: materials do */
    uint32_t band_rows;         /* of a picture that is painted in bands (picture/painter.h); 0: by their memory */
    MesoCamera next_camera;     /* of the next frame, for motion */
    const MesoScene *next_scene;    /* alike (picture/motion.h); NULL: the same */
    bool find_covered;          /* fill in `covered` of the image */
    bool full_detail;           /* every column and ring of the kinds, however small, to the eye and the light */
} MesoRenderOptions;

/* MESO_ERR_LIMIT or MESO_ERR_USAGE for options that no picture has. */
MesoStatus meso_render_check(const MesoRenderOptions *options, MesoError *error);

/* What the image's arrays take, a pixel, and all of them. */
size_t meso_image_pixel_bytes(const MesoScene *scene, const MesoRenderOptions *options);
size_t meso_image_bytes(const MesoScene *scene, const MesoRenderOptions *options);

/*
 * Places the arrays that `options` ask for in `memory`, aligned to 64, zeroed, which the image may outlive no more than
 * the scene, whose names it has. O(things that mattes are of).
 */
void meso_image_place(MesoImage *image, void *memory, const MesoScene *scene, const MesoRenderOptions *options);

#endif
