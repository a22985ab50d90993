#include "cmd/common/camera_options.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/camera/gltf_camera.h"
#include "formats/camera/view_matrices.h"
#include "formats/product/file_kind.h"

static MesoStatus check(const MesoCameraOptions *options, MesoError *error)
{
    if (options->sensor_given && !options->focal_given)
        return meso_fail(error, MESO_ERR_USAGE, "--sensor is for --focal, which is not given");
    if (options->fov_given + options->focal_given + options->ortho_given > 1)
        return meso_fail(error, MESO_ERR_USAGE, "--fov, --focal and --ortho each say how much the image shows: give "
                                                "one");
    if (options->file && (options->eye_given || options->target_given))
        return meso_fail(error, MESO_ERR_USAGE, "--camera says where the camera is, and --eye and --target, too");
    return MESO_OK;
}

/* ---- a camera from a file ---- */

/* Where the name begins, behind the extension and a colon; the length of the path otherwise. */
static size_t path_length(const char *text)
{
    static const char *const extensions[] = {".glb:", ".gltf:", ".bin:"};
    for (const char *colon = strchr(text, ':'); colon; colon = strchr(colon + 1, ':'))
        for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++) {
            size_t length = strlen(extensions[i]), end = (size_t)(colon - text) + 1;
            if (end > length && strncasecmp(text + end - length, extensions[i], length) == 0)
                return end - 1;
        }
    return strlen(text);
}

static MesoStatus read_matrix(MesoCamera *camera, MesoArena *arena, const MesoInput *input, const char *name,
                              MesoError *error)
{
    MesoCameraKey *keys;
    uint32_t count;
    char *end = NULL;
    MesoStatus status = meso_view_matrices_read(&keys, &count, arena, input, camera, error);
    if (status)
        return status;
    unsigned long frame = name ? strtoul(name, &end, 10) : 1;
    if ((name && (*end || end == name)) || frame < 1 || frame > count)
        return meso_fail(error, MESO_ERR_USAGE, "--camera: %s has frames 1 to %u, and no '%s'", input->path, count,
                         name);
    *camera = keys[frame - 1].camera;
    return MESO_OK;
}

static MesoStatus read_file(MesoCameraOptions *options, MesoTool *tool, MesoError *error)
{
    size_t length = path_length(options->file);
    const char *name = options->file[length] ? options->file + length + 1 : NULL;
    const char *path = meso_arena_print(&tool->arena, error, "%.*s", (int)length, options->file);
    MesoCamera camera = options->camera;
    MesoInput input;
    options->world_up = options->camera.up;
    if (!path)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_tool_open_input(tool, &input, path, "camera");
    if (status)
        return status;
    bool matrices = length > 4 && strcasecmp(path + length - 4, ".bin") == 0;
    MesoFileKind kind = matrices ? MESO_FILE_UNKNOWN : meso_file_kind(&input);
    if (!matrices && kind != MESO_FILE_GLB && !(kind & MESO_FILES_OF_JSON))
        status = meso_fail(error, MESO_ERR_INPUT, "%s: %s, not a camera; glTF scenes and view matrices (.bin) are "
                                                  "read", path,
                           meso_file_kind_phrase(kind));
    else
        status = matrices ? read_matrix(&camera, &tool->arena, &input, name, error)
                          : meso_gltf_camera_read(&camera, &tool->arena, &input, name, error);
    meso_input_close(&input);
    if (options->fov_given || options->focal_given || options->ortho_given) {
        camera.fov_degrees = options->camera.fov_degrees;
        camera.height = options->camera.height;
    }
    if (!status)
        options->camera = camera;
    return status;
}

MesoStatus meso_camera_options_read(MesoCameraOptions *options, MesoTool *tool, MesoError *error)
{
    MesoStatus status = check(options, error);
    if (status)
        return status;
    if (options->ortho_given)
        options->camera.height = options->ortho;
    if (options->focal_given) {
        float aspect = (float)options->size[0] / (float)options->size[1], fov;
        options->camera.fov_degrees = fov = meso_camera_fov(options->focal, options->sensor, aspect);
        if (!(fov >= 0.001f && fov <= 179))
            return meso_fail(error, MESO_ERR_USAGE, "--focal %g and --sensor %g make a field of view of %g degrees",
                             (double)options->focal, (double)options->sensor, (double)fov);
    }
    return options->file ? read_file(options, tool, error) : MESO_OK;
}

/* ---- with a scene ---- */

/* Its target is where it is nearest to the middle of the scene, so that a turntable goes around that. */
static void aim(MesoCamera *camera, const MesoScene *scene)
{
    MesoView view;
    if (meso_view_build(&view, camera, NULL))
        return;
    MesoVec3 middle = meso_vec3_lerp(scene->box.low, scene->box.high, 0.5f);
    float ahead = meso_vec3_dot(meso_vec3_sub(middle, camera->eye), view.forward);
    if (ahead > 0 && isfinite(ahead))
        camera->target = meso_vec3_mad(camera->eye, ahead, view.forward);
}

static void place(MesoCamera *camera, const MesoCameraOptions *options, const MesoScene *scene, float aspect)
{
    if (options->file)
        aim(camera, scene);
    if (options->file || (options->eye_given && options->target_given))
        return;
    if (options->eye_given) {
        camera->target = meso_vec3_lerp(scene->box.low, scene->box.high, 0.5f);
        return;
    }
    MesoCamera frame = options->ortho_given ? meso_camera_frame_scene_parallel(scene, camera->up, aspect)
                                            : meso_camera_frame_scene(scene, camera->up, camera->fov_degrees, aspect);
    camera->eye = frame.eye;
    if (options->target_given)
        camera->eye = meso_vec3_add(camera->target, meso_vec3_sub(frame.eye, frame.target));
    else
        camera->target = frame.target;
}

MesoCamera meso_camera_options_resolve(const MesoCameraOptions *options, const MesoScene *scene)
{
    MesoCamera camera = options->camera;
    float aspect = (float)options->size[0] / (float)options->size[1];
    place(&camera, options, scene, aspect);
    if (options->ortho_given && options->ortho == 0)
        camera.height = meso_camera_fit_height(scene, &camera, aspect);
    return camera;
}
