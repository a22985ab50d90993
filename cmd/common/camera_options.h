/* The camera's options, the same in every tool that looks at something. */
#ifndef MESO_CAMERA_OPTIONS_H
#define MESO_CAMERA_OPTIONS_H

#include "cmd/common/options.h"
#include "libcore/render/render.h"

typedef struct MesoCameraOptions {
    uint32_t size[2];           /* width, height */
    MesoCamera camera;
    bool eye_given, target_given;
} MesoCameraOptions;

#define MESO_CAMERA_DEFAULTS {{1280, 720}, {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 30}, false, false}

#define MESO_CAMERA_OPTIONS(c)                                                                \
    MESO_GROUP("Camera"), \
    MESO_SIZE(0, "size", "WxH", "pixels of the image (default 1280x720)", (c).size, 1, 16384), \
    MESO_POINT(0, "eye", "X,Y,Z", "where the camera is (default: so that the object fits)", &(c).camera.eye, \
               .given = &(c).eye_given, .more = MESO_OPTION_OVERRIDES), \
    MESO_POINT(0, "target", "X,Y,Z", "the point in the middle of the image (default: of the object)", \
               &(c).camera.target, .given = &(c).target_given, .more = MESO_OPTION_OVERRIDES), \
    MESO_POINT(0, "up", "X,Y,Z", "the direction that is up in the image (default 0,1,0)", &(c).camera.up), \
    MESO_NUMBER(0, "fov", "DEGREES", "vertical field of view (default 30)", &(c).camera.fov_degrees, 0.1, \
                170)

/*
 * The camera that the options ask for. What is not given frames `scene`:
 * without an eye and a target all of it; with an eye alone the target is the
 * middle of the box; with a target alone the eye looks at it as it would at
 * the whole.
 */
MesoCamera meso_camera_options_resolve(const MesoCameraOptions *options, const MesoScene *scene);

#endif
