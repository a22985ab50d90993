#include "cmd/render/render_source.h"

#include <math.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/scene_input.h"
#include "cmd/render/render_show.h"
#include "cmd/common/mesh_path.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/index.h"
#include "libcore/tiling/strand/tile_sheet.h"

/* ---- operands ---- */

static MesoStatus need_operands(const MesoRenderArguments *a, uint32_t count, const char *what, MesoError *error)
{
    uint32_t given = a->tool.operand_count;
    if (given == count)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "%u operand%s given, %u needed%s", given, given == 1 ? "" : "s", count,
                     what);
}

MesoStatus meso_render_source_check(MesoRenderArguments *a, MesoError *error)
{
    if (a->mesh_path && !a->tiles)
        return meso_fail(error, MESO_ERR_USAGE, "--mesh-path is for --tiles; a model holds its meshes");
    if (a->tiles && a->show)
        return meso_fail(error, MESO_ERR_USAGE, "--tiles and --show both say what is drawn: give one of them");
    if (a->tiles) {
        MesoCameraOptions *camera = &a->camera;
        bool placed = camera->fov_given || camera->focal_given || camera->ortho_given || camera->file || a->keys;
        if (!placed) {              /* of cells beside each other none looks larger */
            camera->ortho_given = true;
            camera->ortho = 0;
        }
        return need_operands(a, 0, ": --tiles is what is drawn", error);
    }
    a->model = a->tool.operand_count ? a->tool.operands[0] : NULL;
    if (a->show) {
        MesoStatus status = meso_render_show_check(a, error);
        if (!status)
            a->model = a->tool.operands[meso_render_show_surface(a)];
        return status;
    }
    if (a->report)
        return meso_fail(error, MESO_ERR_USAGE, "--report is for --show failures");
    return need_operands(a, 1, "", error);
}

/* ---- sheets of tiles ---- */

static MesoStatus read_sheet(MesoRenderSource *source, MesoRenderArguments *a, MesoError *error)
{
    static const MesoInputPlace place = {"--tiles", "a tile set", "tiles",
                                         MESO_FILE_TILES | MESO_FILE_PROTOTYPE | MESO_FILE_JSON};
    MesoTool *tool = &a->tool;
    MesoModel *model = MESO_NEW(&tool->arena, MesoModel, 1, error);
    MesoStatus status = model ? meso_tool_open_place(tool, &source->input, a->tiles, &place) : MESO_ERR_MEMORY;
    source->open = status == MESO_OK;
    if (!status)
        status = meso_tiles_read(&model->tile_set, &tool->arena, &source->input, error);
    if (!status)
        status = meso_tool_read_tile_meshes(tool, &model->inner_meshes, &model->tile_set, a->tiles, a->mesh_path);
    if (!status && meso_tile_sheet(&source->scene, &tool->arena, model, 0, tool->threads, error))
        status = meso_fail_prefix(error, a->tiles);
    return status;
}

/* ---- all of them ---- */

MesoStatus meso_render_source_read(MesoRenderSource *source, MesoRenderArguments *a, const char *model,
                                   MesoError *error)
{
    MesoSceneReading reading = {.thread_count = a->tool.threads, .stored_sweeps = a->stored_sweeps};
    *source = (MesoRenderSource){.color_channel = MESO_NO_INDEX};
    if (a->tiles)
        return read_sheet(source, a, error);
    if (a->show)
        return meso_render_show_read(source, a, model, error);
    MesoStatus status = meso_tool_read_scene(&a->tool, &source->scene, &source->input, model, &reading);
    source->open = status == MESO_OK;
    return status;
}

/* A sheet is looked at from its front: from there its box fits with a margin. */
static void look_from_front(MesoCamera *camera, const MesoBox *box, float aspect, bool fit)
{
    static const MesoVec3 front = {0.16f, 0.24f, 1};
    const float margin = 0.05f;
    MesoView view;
    float distance = 0, half = 0;
    camera->target = meso_vec3_lerp(box->low, box->high, 0.5f);
    camera->eye = meso_vec3_add(camera->target, front);
    if (meso_view_build(&view, camera, NULL))
        return;
    float tan_y = view.half_height * (1 - 2 * margin), tan_x = aspect * tan_y;
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 p = meso_vec3_sub(meso_box_corner(box->low, box->high, i), camera->target);
        float nearer = -meso_vec3_dot(p, view.forward), across = fabsf(meso_vec3_dot(p, view.right));
        float up = fabsf(meso_vec3_dot(p, view.up));
        half = fmaxf(half, fmaxf(up, across / aspect) / (1 - 2 * margin));
        distance = fmaxf(distance, view.parallel ? 2 * nearer : nearer + fmaxf(across / tan_x, up / tan_y));
    }
    camera->eye = meso_vec3_mad(camera->target, -distance, view.forward);
    if (fit)
        camera->height = 2 * half;
}

MesoCamera meso_render_source_camera(const MesoRenderArguments *a, const MesoScene *scene)
{
    MesoCamera camera = meso_camera_options_resolve(&a->camera, scene);
    if (a->tiles && !a->camera.eye_given && !a->camera.target_given)
        look_from_front(&camera, &scene->box, (float)a->camera.size[0] / (float)a->camera.size[1],
                        a->camera.ortho_given && a->camera.ortho == 0);
    return camera;
}

void meso_render_source_close(MesoRenderSource *source)
{
    if (source->open)
        meso_input_close(&source->input);
    source->open = false;
}
