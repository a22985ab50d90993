#include "cmd/replicate/replicate_output.h"

#include <string.h>
#include <strings.h>

#include "cmd/replicate/replicate_scene.h"
#include "formats/clip/frame_list.h"
#include "formats/scene/material_json.h"
#include "formats/scene/material_text.h"

/* ---- what goes together ---- */

static bool is_kind(const MesoReplicateArguments *a, const char *path, const char *kind)
{
    const char *dot = strrchr(path, '.');
    return a->output.to ? strcmp(a->output.to, kind) == 0 : dot && strcasecmp(dot + 1, kind) == 0;
}

/* Of the options of meshes, what files of instances and clips have not. */
static MesoStatus check_plain(const MesoReplicateOutput *o)
{
    const MesoSceneOutput *given = &o->arguments->output;
    const char *other = given->given.compress ? "compress" : given->given.position_bits ? "position-bits"
        : given->given.normal_bits ? "normal-bits" : given->given.speed ? "speed" : given->lengths ? "lengths"
        : given->tangents ? "tangents" : NULL;
    return other ? meso_fail(&o->tool->error, MESO_ERR_USAGE, "--%s is for a mesh a frame", other) : MESO_OK;
}

static MesoStatus check_scene_kind(const MesoReplicateOutput *o)
{
    const char *dot = strrchr(o->path, '.');
    if (o->arguments->output.to || (dot && meso_scene_kind_named(dot + 1)))
        return meso_tool_choose_scene_kind(o->tool, &o->arguments->output);
    return meso_fail(&o->tool->error, MESO_ERR_USAGE, "no kind of file is known by the name '%s': end it in .meso, "
                     ".ply, .obj, .glb, .drc, .stl or .usda, or give --to", o->path);
}

MesoStatus meso_replicate_output_choose(MesoReplicateOutput *o, MesoReplicateArguments *a)
{
    MesoTool *tool = &a->tool;
    *o = (MesoReplicateOutput){.arguments = a, .tool = tool, .path = tool->output ? tool->output : "-"};
    o->numbered = meso_frame_path_is_pattern(o->path);
    tool->output = o->path;
    bool glb = is_kind(a, o->path, "glb");
    o->product = is_kind(a, o->path, "usda") ? MESO_PRODUCT_USDA : a->instances ? MESO_PRODUCT_INSTANCES
        : glb && !o->numbered ? MESO_PRODUCT_ANIMATION : MESO_PRODUCT_SCENES;
    if (a->instances && !glb)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--instances is for .glb; a .usda has instances anyway");
    bool one = meso_replicate_output_is_one(o);
    if (one && o->numbered)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "-o '%s': a .usda holds all frames; leave out the number",
                         o->path);
    if (one && a->state)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--state goes with a file a frame: -o OUT-%%04d.glb");
    return o->product == MESO_PRODUCT_SCENES ? check_scene_kind(o) : check_plain(o);
}

/* ---- what is one for all ---- */

/* The surface's triangles, which are the same in all frames but those in which bumps or holes are born. */
static void take_surface(MesoReplicateOutput *o, const MesoReplicateRun *r)
{
    const MesoReplicateClip *clip = r->clip;
    const MesoReplicateCarve *carve = o->carve;
    o->surface = (MesoInstanceShape){
        .name = "surface", .material = &o->look, .vertex_count = clip->rest.vertex_count,
        .triangle_count = clip->rest.triangle_count, .positions = clip->positions, .normals = clip->normals,
        .corners = clip->rest.corners};
    if (!carve->kinds)
        return;
    o->surface.vertex_count = carve->mesh.vertex_count;
    o->surface.triangle_count = carve->triangle_count;
    o->surface.positions = carve->positions;
    o->surface.normals = carve->normals;
    o->surface.corners = carve->corners;
}

static MesoStatus show_surface(MesoReplicateOutput *o, const MesoReplicateRun *r)
{
    char name[MESO_MATERIAL_NAME];
    MesoStatus status = MESO_OK;
    o->look = meso_plain_material;
    if (!o->material)
        return MESO_OK;
    if (strcmp(o->material, "own") != 0)
        status = meso_material_of_text(&o->look, name, o->material, &o->tool->error);
    if (!status && (r->way == MESO_WAY_PLAY || r->ahead))
        status = meso_replicate_carve_details(o->carve, r);
    take_surface(o, r);
    o->scene.surface = &o->surface;
    return status;
}

MesoStatus meso_replicate_output_begin(MesoReplicateOutput *o, const MesoReplicateRun *r,
                                       const MesoReplicateKinds *kinds, MesoReplicateCarve *carve)
{
    MesoTool *tool = o->tool;
    double rate = (double)o->arguments->frames_per_second;
    o->kinds = kinds;
    o->carve = carve;
    o->material = o->arguments->surface ? o->arguments->surface : carve->kinds ? "own" : NULL;
    o->scene = (MesoInstanceScene){kinds->kind_count, kinds->shapes, NULL, &tool->provenance,
                                   meso_replicate_z_up(o->arguments), o->arguments->output.unit};
    if (carve->kinds && r->way == MESO_WAY_PAPER)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--mode paper moves its details over the surface, and bumps and "
                         "holes stay where they were born");
    MesoStatus status = show_surface(o, r);
    if (!status && o->product == MESO_PRODUCT_USDA)
        status = meso_usda_begin(&o->usda, &o->scene, rate, o->path, &tool->error);
    if (!status && o->product == MESO_PRODUCT_ANIMATION)
        status = meso_animation_begin(&o->animation, &o->scene, rate, &tool->error);
    return status;
}

MesoStatus meso_replicate_output_end(MesoReplicateOutput *o, MesoStatus status)
{
    MesoTool *tool = o->tool;
    if (!status && (o->usda || o->animation)) {
        MesoOutput *output = NULL;
        status = meso_output_open(&output, o->path, &tool->error);
        if (!status)
            status = o->usda ? meso_usda_write(o->usda, output, &tool->error)
                             : meso_animation_write(o->animation, output, &tool->error);
        status = meso_output_finish(output, status, &tool->error);
    }
    meso_usda_release(o->usda);
    meso_animation_release(o->animation);
    o->usda = NULL;
    o->animation = NULL;
    return status;
}

/* ---- a frame ---- */

/* Up, whatever the slope, with its heading laid across. */
static void set_upright(MesoPlacedDetail *placed, MesoVec3 up)
{
    MesoVec3 heading = meso_vec3_mad(placed->tangent, -meso_vec3_dot(placed->tangent, up), up);
    MesoVec3 across = meso_vec3_cross(placed->normal, placed->tangent);
    if (!(meso_vec3_length(heading) > 1e-3f))   /* it heads up or down: what was its left stays */
        heading = meso_vec3_cross(across, up);
    placed->tangent = meso_vec3_unit(heading, placed->tangent);
    placed->normal = up;
}

static MesoStatus place(MesoReplicateOutput *o, const MesoReplicateRun *r)
{
    if (r->count > o->placed_room) {
        o->placed_room = r->count + r->count / 2;
        o->placed = MESO_NEW(&o->tool->arena, MesoPlacedDetail, o->placed_room, &o->tool->error);
    }
    if (!o->placed)
        return MESO_ERR_MEMORY;
    meso_details_place(o->placed, &r->clip->rest, r->clip->positions, r->clip->normals, r->details, r->grown, r->count,
                       o->tool->threads);
    for (uint32_t i = 0; i < r->count; i++)
        if (o->kinds->kinds[r->details[i].kind].upright)
            set_upright(&o->placed[i], meso_replicate_up(o->arguments));
    return MESO_OK;
}

/* What it is a frame of: all that a plan has gone through, or itself alone. */
static MesoStatus record(MesoReplicateOutput *o, const MesoReplicateRun *r)
{
    MesoTool *tool = o->tool;
    const char *frames = r->way == MESO_WAY_PLAY
        ? meso_arena_print(&tool->arena, &tool->error, "%d", r->clip->number) : meso_replicate_run_history(r);
    const MesoOptionChange changes[] = {{"frames", frames}, {"output", tool->output}, {NULL, NULL}};
    tool->provenance.command_line = frames ? meso_tool_command(tool, changes, &tool->arena, &tool->error) : NULL;
    return tool->provenance.command_line ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus write_instances(MesoReplicateOutput *o, const MesoInstanceFrame *frame, MesoOutput *state)
{
    MesoOutput *outputs[] = {NULL, state};
    MesoStatus status = meso_output_open(&outputs[0], o->tool->output, &o->tool->error);
    if (!status)
        status = meso_instance_glb_write(&o->scene, frame, outputs[0], &o->tool->error);
    return meso_output_finish_all(outputs, 2, status, &o->tool->error);
}

static MesoStatus write_scene(MesoReplicateOutput *o, const MesoReplicateRun *r, MesoOutput *state)
{
    MesoScene scene;
    MesoPolygonMesh carved;
    const MesoPolygonMesh *surface = o->material ? &r->clip->polygons : NULL;
    const char *material = o->material;
    MesoStatus status = MESO_OK;
    if (o->carve->kinds) {      /* which brings its looks along */
        status = meso_replicate_carve_mesh(&carved, o->carve, r, o->material);
        surface = &carved;
        material = "own";
    }
    if (!status)
        status = meso_replicate_scene(&scene, r, o->kinds, o->placed, surface, material);
    if (!status)
        return meso_tool_write_scene(o->tool, &o->arguments->output,
                                     &(MesoSceneProduct){.scene = &scene, .beside = {state}});
    meso_output_discard(state);
    return status;
}

static MesoStatus write_file(MesoReplicateOutput *o, const MesoReplicateRun *r, const MesoInstanceFrame *frame)
{
    MesoTool *tool = o->tool;
    MesoOutput *state = NULL;
    tool->output = o->numbered ? meso_frame_path(o->path, r->clip->number, &tool->arena, &tool->error) : o->path;
    MesoStatus status = !tool->output ? MESO_ERR_MEMORY
                      : o->numbered ? meso_tool_check_output(tool, "-o", tool->output) : MESO_OK;
    if (!status)
        status = record(o, r);
    if (!status && o->arguments->state)
        status = meso_output_open(&state, o->arguments->state, &tool->error);
    if (!status && state)
        status = meso_replicate_run_store(r, state);
    if (status) {
        meso_output_discard(state);
        return status;
    }
    return o->product == MESO_PRODUCT_INSTANCES ? write_instances(o, frame, state) : write_scene(o, r, state);
}

MesoStatus meso_replicate_output_frame(MesoReplicateOutput *o, const MesoReplicateRun *r)
{
    MesoTool *tool = o->tool;
    MesoStatus status = place(o, r);
    if (!status)
        status = meso_replicate_carve_frame(o->carve, r, o->placed);
    if (status)
        return status;
    take_surface(o, r);
    const MesoInstanceFrame frame = {r->count, r->details, o->placed, o->surface.positions, o->surface.normals};
    if (o->usda)
        return meso_usda_frame(o->usda, r->clip->number, &frame, &tool->error);
    if (o->animation)
        return meso_animation_frame(o->animation, r->clip->number, &frame, &tool->error);
    MesoArenaMark mark = meso_arena_mark(&tool->arena);
    const MesoProvenance provenance = tool->provenance;
    status = write_file(o, r, &frame);
    tool->provenance = provenance;
    tool->output = o->path;
    meso_arena_rewind(&tool->arena, mark);
    return status;
}
