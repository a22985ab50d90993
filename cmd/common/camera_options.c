#include "cmd/common/camera_options.h"

MesoStatus meso_camera_options_check(MesoCameraOptions *options, MesoError *error)
{
    if (options->sensor_given && !options->focal_given)
        return meso_fail(error, MESO_ERR_USAGE, "--sensor is for --focal, which is not given");
    if (options->fov_given + options->focal_given + options->ortho_given > 1)
        return meso_fail(error, MESO_ERR_USAGE, "--fov, --focal and --ortho each say how much the image shows: give one");
    if (options->ortho_given)
        options->camera.height = options->ortho;
    if (!options->focal_given)
        return MESO_OK;
    float aspect = (float)options->size[0] / (float)options->size[1];
    options->camera.fov_degrees = meso_camera_fov(options->focal, options->sensor, aspect);
    if (!(options->camera.fov_degrees >= 0.001f && options->camera.fov_degrees <= 179))
        return meso_fail(error, MESO_ERR_USAGE, "--focal %g and --sensor %g make a field of view of %g degrees",
                         (double)options->focal, (double)options->sensor, (double)options->camera.fov_degrees);
    return MESO_OK;
}

MesoCamera meso_camera_options_resolve(const MesoCameraOptions *options, const MesoScene *scene)
{
    MesoCamera camera = options->camera;
    float aspect = (float)options->size[0] / (float)options->size[1];
    bool fit = options->ortho_given && options->ortho == 0;
    if (options->eye_given && options->target_given && !fit)
        return camera;
    MesoCamera frame = options->ortho_given ? meso_camera_frame_scene_parallel(scene, camera.up, aspect)
                                            : meso_camera_frame_scene(scene, camera.up, camera.fov_degrees, aspect);
    if (fit)
        camera.height = frame.height;
    if (options->eye_given) {
        if (!options->target_given)
            camera.target = meso_vec3_lerp(scene->box.low, scene->box.high, 0.5f);
        return camera;
    }
    camera.eye = frame.eye;
    if (options->target_given)
        camera.eye = meso_vec3_add(camera.target, meso_vec3_sub(frame.eye, frame.target));
    else
        camera.target = frame.target;
    return camera;
}
