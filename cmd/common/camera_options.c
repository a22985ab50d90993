#include "cmd/common/camera_options.h"

MesoCamera meso_camera_options_resolve(const MesoCameraOptions *options, const MesoScene *scene)
{
    MesoCamera camera = options->camera;
    float aspect = (float)options->size[0] / (float)options->size[1];
    if (options->eye_given && options->target_given)
        return camera;
    if (options->eye_given) {
        camera.target = meso_vec3_lerp(scene->box.low, scene->box.high, 0.5f);
        return camera;
    }
    MesoCamera frame = meso_camera_frame_scene(scene, camera.up, camera.fov_degrees, aspect);
    camera.eye = frame.eye;
    if (options->target_given)
        camera.eye = meso_vec3_add(camera.target, meso_vec3_sub(frame.eye, frame.target));
    else
        camera.target = frame.target;
    return camera;
}
