/* The camera's options, the same in every tool that looks at something. */
#ifndef MESO_CAMERA_OPTIONS_H
#define MESO_CAMERA_OPTIONS_H

#include "cmd/common/tool.h"
#include "libcore/render/image.h"

typedef struct MesoCameraOptions {
    uint32_t size[2];           /* width, height */
    MesoCamera camera;
    float focal, sensor;        /* mm; the sensor is as wide as the picture */
    float ortho;                /* scene units; 0: what the object takes */
    const char *file;           /* a camera of another program; NULL: none */
    MesoVec3 world_up;          /* 0: as the camera's */
    bool eye_given, target_given, fov_given, ortho_given, focal_given, sensor_given;
} MesoCameraOptions;

#define MESO_CAMERA_DEFAULTS                                                                  \
    {.size = {1280, 720}, .camera = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 30, 0}, .sensor = 36, .ortho = -1}

#define MESO_CAMERA_OPTIONS(c)                                                                \
    MESO_GROUP("Camera"), \
    MESO_SIZE(0, "size", "WxH", "pixels of the image (default 1280x720)", (c).size, 1, 16384), \
    MESO_POINT(0, "eye", "X,Y,Z", "where the camera is (default: so that the object fits)", &(c).camera.eye, \
               .given = &(c).eye_given, .more = MESO_OPTION_OVERRIDES), \
    MESO_POINT(0, "target", "X,Y,Z", "the point in the middle of the image (default: of the object)", \
               &(c).camera.target, .given = &(c).target_given, .more = MESO_OPTION_OVERRIDES), \
    MESO_POINT(0, "up", "X,Y,Z", "the direction that is up in the image (default 0,1,0)", &(c).camera.up), \
    MESO_TEXT(0, "camera", "FILE[:NAME]", "one of a glTF scene, by its name, or of view matrices, by the frame", \
              &(c).file), \
    MESO_NUMBER(0, "fov", "DEGREES", "vertical field of view (default 30)", &(c).camera.fov_degrees, 0.1, \
                170, .given = &(c).fov_given), \
    MESO_NUMBER(0, "focal", "MM", "focal length of the lens, in place of --fov", &(c).focal, 0.01, 1e5, \
                .given = &(c).focal_given), \
    MESO_NUMBER(0, "sensor", "MM", "width of the sensor behind it (default 36)", &(c).sensor, 0.01, 1e5, \
                .given = &(c).sensor_given), \
    MESO_NUMBER(0, "ortho", "HEIGHT", "orthographic, the image so many units high (0: as the object fits)", \
                &(c).ortho, 0, 1e18, .given = &(c).ortho_given)

/*
 * Turns a lens into a field of view, and reads a camera from a file: the first of a .glb or .gltf, or of view matrices,
 * or the one whose name, or frame, follows a colon. What is up in the world is then what the
 * options say. MESO_ERR_USAGE where options do not fit each other.
 */
MesoStatus meso_camera_options_read(MesoCameraOptions *options, MesoTool *tool, MesoError *error);

/*
 * The camera that the options ask for. What is not given frames `scene`:
 * without an eye and a target all of it; with an eye alone the target is the
 * middle of the box; with a target alone the eye looks at it as it would at
 * the whole. An orthographic view without a height is as high as the whole
 * takes.
 */
MesoCamera meso_camera_options_resolve(const MesoCameraOptions *options, const MesoScene *scene);

#endif
