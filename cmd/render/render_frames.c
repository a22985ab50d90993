#include "cmd/render/render_frames.h"

#include <stdio.h>
#include <string.h>

#include "cmd/render/render_source.h"
#include "formats/camera/camera_file.h"
#include "formats/camera/view_matrices.h"
#include "formats/clip/frame_folder.h"
#include "formats/product/file_kind.h"

static MesoStatus read_keys(MesoRenderFrames *frames, MesoRenderArguments *a, MesoError *error)
{
    MesoInput input;
    MesoStatus status = meso_tool_open_input(&a->tool, &input, a->keys, "cameras");
    if (status)
        return status;
    float aspect = (float)a->camera.size[0] / (float)a->camera.size[1];
    if (meso_file_kind(&input) == MESO_FILE_UNKNOWN && input.size % 64 == 0) {
        a->camera.world_up = a->camera.camera.up;
        status = meso_view_matrices_read(&frames->keys, &frames->key_count, &a->tool.arena, &input, &a->camera.camera,
                                         error);
    } else {
        status = meso_camera_read(&frames->keys, &frames->key_count, &a->tool.arena, &input, &a->camera.camera, aspect,
                                  error);
    }
    meso_input_close(&input);
    return status;
}

/* Those that were asked for; or a full turn, the models that there are, or all from the first key to the last. */
static MesoStatus list_frames(MesoRenderFrames *frames, MesoError *error)
{
    const MesoRenderArguments *a = frames->a;
    MesoArena *arena = (MesoArena *)&a->tool.arena;
    char all[64];
    if (a->frames)
        return meso_frame_list_parse(&frames->list, arena, a->frames, error);
    if (frames->many_models)
        return meso_frame_folder_list(&frames->list, arena, a->model, error);
    if (a->turntable)
        snprintf(all, sizeof all, "1-%u", a->turntable);
    else
        snprintf(all, sizeof all, "%d-%d", frames->keys[0].frame, frames->keys[frames->key_count - 1].frame);
    return meso_frame_list_parse(&frames->list, arena, all, error);
}

static MesoStatus check_names(const MesoRenderFrames *frames, MesoError *error)
{
    const MesoRenderArguments *a = frames->a;
    const char *const names[2] = {a->tool.output, a->png};
    for (int i = 0; i < 2; i++)
        if (names[i] && frames->numbered && !meso_frame_path_is_pattern(names[i]))
            return meso_fail(error, MESO_ERR_USAGE, "'%s' has no place for the number of a frame: give one as in %%04d",
                             names[i]);
    return MESO_OK;
}

MesoStatus meso_render_frames_init(MesoRenderFrames *frames, MesoRenderArguments *a, MesoError *error)
{
    static int32_t none = 0;
    *frames = (MesoRenderFrames){.a = a, .many_models = a->model && meso_frame_path_is_pattern(a->model)};
    frames->numbered = a->frames || a->turntable || a->keys || frames->many_models;
    frames->list = (MesoFrameList){1, &none};
    if (a->turntable && a->keys)
        return meso_fail(error, MESO_ERR_USAGE, "--turntable and --keys both move the camera: give one of them");
    if (a->keys && (a->camera.eye_given || a->camera.target_given || a->camera.file))
        return meso_fail(error, MESO_ERR_USAGE, "--keys says where the camera is, and --eye, --target and --camera, "
                                                "too");
    if (a->frames && !a->turntable && !a->keys && !frames->many_models)
        return meso_fail(error, MESO_ERR_USAGE, "--frames is for --turntable, --keys or a MODEL with a frame's number in its "
                         "name, as in model-%%04d.meso: here all frames are the same");
    if (a->keys && a->camera.ortho_given && a->camera.ortho == 0)
        return meso_fail(error, MESO_ERR_USAGE, "--ortho 0 fits the object, and --keys says where the camera is");
    MesoStatus status = meso_camera_options_read(&a->camera, &a->tool, error);
    if (!status)
        status = check_names(frames, error);
    if (!status && a->keys)
        status = read_keys(frames, a, error);
    return status || !frames->numbered ? status : list_frames(frames, error);
}

/* The command for this frame, which is what its pictures say, whichever run made them. */
static char *command_of(const MesoRenderFrames *frames, const MesoRenderFrame *frame, bool by_gpu, MesoArena *arena,
                        MesoError *error)
{
    char number[16];
    MesoOptionChange changes[5] = {{"resume", NULL}}, *change = changes + 1;
    snprintf(number, sizeof number, "%d", frame->number);
    if (frames->numbered)
        *change++ = (MesoOptionChange){"frames", number};
    if (by_gpu) {
        *change++ = (MesoOptionChange){"visibility", "gl"};
        *change++ = (MesoOptionChange){"context", "auto"};
    }
    return meso_tool_command(&frames->a->tool, changes, arena, error);
}

char *meso_render_frame_gpu_command(const MesoRenderFrames *frames, const MesoRenderFrame *frame, MesoArena *arena,
                                    MesoError *error)
{
    return command_of(frames, frame, true, arena, error);
}

static const char *path_of(const MesoRenderFrames *frames, const char *name, int32_t number, MesoArena *arena,
                           MesoError *error)
{
    return name && frames->numbered && meso_frame_path_is_pattern(name) ? meso_frame_path(name, number, arena, error)
                                                                        : name;
}

MesoStatus meso_render_frame(MesoRenderFrame *frame, const MesoRenderFrames *frames, uint32_t i, MesoArena *arena,
                             MesoError *error)
{
    const MesoRenderArguments *a = frames->a;
    *frame = (MesoRenderFrame){.number = frames->list.frames[i]};
    frame->model = path_of(frames, a->model, frame->number, arena, error);
    frame->output = path_of(frames, a->tool.output, frame->number, arena, error);
    frame->png = path_of(frames, a->png, frame->number, arena, error);
    frame->command = command_of(frames, frame, false, arena, error);
    bool made = !a->model == !frame->model && frame->output && frame->command && !a->png == !frame->png;
    return made ? MESO_OK : MESO_ERR_MEMORY;
}

MesoCamera meso_render_frame_camera(const MesoRenderFrames *frames, const MesoRenderFrame *frame, const MesoScene *scene)
{
    if (frames->keys)
        return meso_camera_at(frames->keys, frames->key_count, frame->number);
    MesoCamera camera = meso_render_source_camera(frames->a, scene);
    uint32_t turn = frames->a->turntable;
    if (turn && frames->a->camera.file)
        camera.up = frames->a->camera.world_up;     /* which is gone about, and not what a tilted camera has above it */
    return turn ? meso_camera_turn(&camera, (float)(frame->number - 1) / (float)turn) : camera;
}

/* A picture that is not there, or is none of ours, says nothing. */
static MesoStatus says_so(bool *same, const char *path, const json_t *expected, MesoError *error)
{
    MesoInput input;
    json_t *found = NULL;
    *same = false;
    if (meso_input_open(&input, path, NULL))
        return MESO_OK;
    MesoStatus status = meso_provenance_find(&found, &input, error);
    meso_input_close(&input);
    *same = !status && found && json_equal(found, (json_t *)expected);
    json_decref(found);
    return status;
}

MesoStatus meso_render_frame_is_done(bool *done, const MesoRenderFrame *frame, const MesoProvenance *provenance,
                                     MesoError *error)
{
    json_t *expected = meso_provenance_json(provenance);
    bool png = true;
    if (!expected)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for a provenance");
    MesoStatus status = says_so(done, frame->output, expected, error);
    if (!status && *done && frame->png)
        status = says_so(&png, frame->png, expected, error);
    *done = *done && png;
    json_decref(expected);
    return status;
}
