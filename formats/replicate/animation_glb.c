#include "formats/replicate/animation_glb.h"

#include <stdlib.h>
#include <string.h>

#include "formats/replicate/instance_glb_parts.h"
#include "libcore/base/grow.h"

typedef struct Kept {
    float time;
    uint32_t count;             /* of details */
    MesoInstance *instances;    /* [count] of scale 0 where they are not there */
    MesoVec3 *positions, *normals;  /* of the surface */
} Kept;

struct MesoAnimation {
    const MesoInstanceScene *scene;
    double rate;
    MesoArena arena;
    Kept *frames;               /* [frame_count] */
    uint32_t frame_count, frame_room;
    int32_t first;              /* number of the first frame */
    uint32_t kinds[MESO_ANIMATION_DETAILS];     /* of the details */
    bool shown[MESO_ANIMATION_DETAILS];         /* at some frame */
};

MesoStatus meso_animation_begin(MesoAnimation **out, const MesoInstanceScene *scene, double frames_per_second,
                                MesoError *error)
{
    MesoAnimation *a = *out = calloc(1, sizeof *a);
    if (!a)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    a->scene = scene;
    a->rate = frames_per_second;
    meso_arena_init(&a->arena);
    return MESO_OK;
}

void meso_animation_release(MesoAnimation *a)
{
    if (!a)
        return;
    meso_arena_release(&a->arena);
    free(a);
}

/* ---- frames ---- */

/* Turned the short way from the frame before; what is not there stays where it was. */
static void take_instance(MesoAnimation *a, Kept *kept, const MesoInstanceFrame *frame, uint32_t d)
{
    const Kept *before = a->frame_count ? &a->frames[a->frame_count - 1] : NULL;
    MesoInstance *now = &kept->instances[d];
    const MesoInstance *last = before && d < before->count ? &before->instances[d] : NULL;
    float dot = 0;
    if (meso_instance_shown(a->scene, frame, d)) {
        *now = meso_instance_of(&frame->placed[d]);
        a->shown[d] = true;
    } else {
        *now = last ? *last : (MesoInstance){.position = frame->placed[d].position, .rotation = {0, 0, 0, 1}};
        now->scale = (MesoVec3){0, 0, 0};
    }
    for (int k = 0; last && k < 4; k++)
        dot += now->rotation[k] * last->rotation[k];
    for (int k = 0; dot < 0 && k < 4; k++)
        now->rotation[k] = -now->rotation[k];
}

static MesoStatus take_surface(MesoAnimation *a, Kept *kept, const MesoInstanceFrame *frame, MesoError *error)
{
    const MesoInstanceShape *surface = a->scene->surface;
    if (!surface)
        return MESO_OK;
    size_t bytes = surface->vertex_count * sizeof(MesoVec3);
    kept->positions = MESO_NEW(&a->arena, MesoVec3, surface->vertex_count, error);
    kept->normals = MESO_NEW(&a->arena, MesoVec3, surface->vertex_count, error);
    if (!kept->positions || !kept->normals)
        return MESO_ERR_MEMORY;
    memcpy(kept->positions, frame->positions, bytes);
    memcpy(kept->normals, frame->normals, bytes);
    return MESO_OK;
}

MesoStatus meso_animation_frame(MesoAnimation *a, int32_t number, const MesoInstanceFrame *frame, MesoError *error)
{
    if (frame->count > MESO_ANIMATION_DETAILS)
        return meso_fail(error, MESO_ERR_LIMIT, "an animated .glb takes %d details at most, and there are %u: write a "
                         ".usda, or a file a frame", MESO_ANIMATION_DETAILS, frame->count);
    if (a->scene->surface && a->frame_count == MESO_ANIMATION_SHAPES)
        return meso_fail(error, MESO_ERR_LIMIT, "an animated .glb takes %d frames of a surface at most: write a .usda, "
                         "or a file a frame", MESO_ANIMATION_SHAPES);
    if (a->frame_count == 0)
        a->first = number;
    Kept kept = {.time = (float)((number - a->first) / a->rate), .count = frame->count,
                 .instances = MESO_NEW(&a->arena, MesoInstance, frame->count, error)};
    a->frames = MESO_GROW(&a->arena, a->frames, a->frame_count, a->frame_room, 64, error);
    if (!kept.instances || !a->frames)
        return MESO_ERR_MEMORY;
    for (uint32_t d = 0; d < frame->count; d++) {
        a->kinds[d] = frame->details[d].kind;
        take_instance(a, &kept, frame, d);
    }
    MesoStatus status = take_surface(a, &kept, frame, error);
    a->frames[a->frame_count++] = kept;
    return status;
}

/* ---- the JSON part ---- */

static uint32_t detail_count(const MesoAnimation *a)
{
    return a->frames[a->frame_count - 1].count;
}

/* Where a detail is at a frame: before its birth as at that, of size 0. */
static MesoInstance instance_at(const MesoAnimation *a, uint32_t detail, uint32_t frame)
{
    uint32_t f = frame;
    while (detail >= a->frames[f].count)
        f++;
    MesoInstance instance = a->frames[f].instances[detail];
    if (f > frame)
        instance.scale = (MesoVec3){0, 0, 0};
    return instance;
}

static void add_channel(MesoGlbParts *glb, json_t *samplers, json_t *channels, uint32_t times, uint32_t values,
                        json_int_t node, const char *path)
{
    json_int_t sampler = (json_int_t)json_array_size(samplers);
    glb->failed |= json_array_append_new(samplers, json_pack("{s:I, s:I, s:s}", "input", (json_int_t)times, "output",
                                                             (json_int_t)values, "interpolation", "LINEAR"));
    glb->failed |= json_array_append_new(channels, json_pack("{s:I, s:{s:I, s:s}}", "sampler", sampler, "target",
                                                             "node", node, "path", path));
}

/* Differences from the first frame, and the weights of them. */
static void add_targets(const MesoAnimation *a, MesoGlbParts *glb, MesoVec3 *differences, json_t *samplers,
                        json_t *channels, uint32_t times)
{
    uint32_t count = a->scene->surface->vertex_count;
    json_t *targets = json_array();
    for (uint32_t f = 1; f < a->frame_count; f++) {
        uint32_t position = meso_glb_accessor(glb, "VEC3", MESO_GLB_FLOAT, count, 3, 0);
        uint32_t normal = meso_glb_accessor(glb, "VEC3", MESO_GLB_FLOAT, count, 3, 0);
        for (uint32_t v = 0; v < count; v++)
            differences[v] = meso_vec3_sub(a->frames[f].positions[v], a->frames[0].positions[v]);
        meso_glb_bounds(glb, position, differences, count);
        glb->failed |= json_array_append_new(targets, json_pack("{s:I, s:I}", "POSITION", (json_int_t)position,
                                                                "NORMAL", (json_int_t)normal));
    }
    json_t *primitive = json_array_get(json_object_get(json_array_get(glb->meshes, 0), "primitives"), 0);
    glb->failed |= json_object_set_new(primitive, "targets", targets);
    uint32_t weights = meso_glb_accessor(glb, "SCALAR", MESO_GLB_FLOAT, a->frame_count * (a->frame_count - 1), 1, 0);
    add_channel(glb, samplers, channels, times, weights, 0, "weights");
}

/* One mesh for each kind, which its details share. */
static void add_kinds(const MesoAnimation *a, MesoGlbParts *glb, json_int_t *meshes)
{
    for (uint32_t k = 0; k < a->scene->shape_count; k++) {
        bool shown = false;
        for (uint32_t d = 0; d < detail_count(a); d++)
            shown = shown || (a->shown[d] && a->kinds[d] == k);
        meshes[k] = -1;
        if (!shown)
            continue;
        const MesoInstanceShape *shape = &a->scene->shapes[k];
        meshes[k] = (json_int_t)json_array_size(glb->meshes);
        meso_glb_mesh(glb, shape, shape->positions, shape->normals);
        glb->failed |= json_array_remove(glb->nodes, json_array_size(glb->nodes) - 1);
    }
}

static void add_details(const MesoAnimation *a, MesoGlbParts *glb, const json_int_t *meshes, json_t *samplers,
                        json_t *channels, uint32_t times)
{
    static const struct { const char *path, *type; uint32_t width; } tracks[] = {
        {"translation", "VEC3", 3}, {"rotation", "VEC4", 4}, {"scale", "VEC3", 3}};
    for (uint32_t d = 0; d < detail_count(a); d++) {
        char name[32];
        json_int_t node = (json_int_t)json_array_size(glb->nodes);
        if (!a->shown[d])
            continue;
        snprintf(name, sizeof name, "detail_%u", d);
        MesoInstance at = instance_at(a, d, 0);
        glb->failed |= json_array_append_new(
            glb->nodes, json_pack("{s:s, s:I, s:[f, f, f], s:[f, f, f, f], s:[f, f, f]}", "name", name, "mesh",
                                  meshes[a->kinds[d]], "translation", (double)at.position.x, (double)at.position.y,
                                  (double)at.position.z, "rotation", (double)at.rotation[0], (double)at.rotation[1],
                                  (double)at.rotation[2], (double)at.rotation[3], "scale", (double)at.scale.x,
                                  (double)at.scale.y, (double)at.scale.z));
        for (int t = 0; t < 3; t++)
            add_channel(glb, samplers, channels, times,
                        meso_glb_accessor(glb, tracks[t].type, MESO_GLB_FLOAT, a->frame_count, tracks[t].width, 0),
                        node, tracks[t].path);
    }
}

static void describe(const MesoAnimation *a, MesoGlbParts *glb, json_int_t *meshes, MesoVec3 *differences)
{
    json_t *samplers = json_array(), *channels = json_array();
    meso_glb_begin(glb);
    if (a->scene->surface)
        meso_glb_mesh(glb, a->scene->surface, a->frames[0].positions, a->frames[0].normals);
    add_kinds(a, glb, meshes);
    uint32_t times = meso_glb_accessor(glb, "SCALAR", MESO_GLB_FLOAT, a->frame_count, 1, 0);
    json_t *object = json_array_get(glb->accessors, times);
    glb->failed |= json_object_set_new(object, "min", json_pack("[f]", (double)a->frames[0].time));
    glb->failed |= json_object_set_new(object, "max", json_pack("[f]", (double)a->frames[a->frame_count - 1].time));
    if (a->scene->surface && a->frame_count > 1)
        add_targets(a, glb, differences, samplers, channels, times);
    add_details(a, glb, meshes, samplers, channels, times);
    if (json_array_size(channels) > 0)
        glb->failed |= json_object_set_new(glb->root, "animations", json_pack("[{s:O, s:O}]", "channels", channels,
                                                                              "samplers", samplers));
    json_decref(samplers);
    json_decref(channels);
}

/* ---- the binary part: the pieces in the same order ---- */

static MesoStatus write_targets(const MesoAnimation *a, MesoVec3 *differences, MesoOutput *output, MesoError *error)
{
    uint32_t count = a->scene->surface->vertex_count;
    MesoStatus status = MESO_OK;
    for (uint32_t f = 1; f < a->frame_count && !status; f++)
        for (int k = 0; k < 2 && !status; k++) {
            const MesoVec3 *now = k ? a->frames[f].normals : a->frames[f].positions;
            const MesoVec3 *then = k ? a->frames[0].normals : a->frames[0].positions;
            for (uint32_t v = 0; v < count; v++)
                differences[v] = meso_vec3_sub(now[v], then[v]);
            status = meso_output_write(output, differences, count * sizeof *differences, error);
        }
    for (uint32_t f = 0; f < a->frame_count && !status; f++)
        for (uint32_t target = 1; target < a->frame_count && !status; target++) {
            const float weight = f == target;
            status = meso_output_write(output, &weight, sizeof weight, error);
        }
    return status;
}

static MesoStatus write_details(const MesoAnimation *a, MesoOutput *output, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t d = 0; d < detail_count(a); d++)
        for (int track = 0; track < 3 && a->shown[d]; track++)
            for (uint32_t f = 0; f < a->frame_count && !status; f++) {
                MesoInstance at = instance_at(a, d, f);
                const void *const values[] = {&at.position, at.rotation, &at.scale};
                status = meso_output_write(output, values[track], (track == 1 ? 4 : 3) * sizeof(float), error);
            }
    return status;
}

static MesoStatus write_pieces(const MesoAnimation *a, const json_int_t *meshes, MesoVec3 *differences,
                               MesoOutput *output, MesoError *error)
{
    const MesoInstanceScene *scene = a->scene;
    MesoStatus status = MESO_OK;
    if (scene->surface)
        status = meso_glb_write_mesh(scene->surface, a->frames[0].positions, a->frames[0].normals, output, error);
    for (uint32_t k = 0; k < scene->shape_count && !status; k++)
        if (meshes[k] >= 0)
            status = meso_glb_write_mesh(&scene->shapes[k], scene->shapes[k].positions, scene->shapes[k].normals,
                                         output, error);
    for (uint32_t f = 0; f < a->frame_count && !status; f++)
        status = meso_output_write(output, &a->frames[f].time, sizeof(float), error);
    if (!status && scene->surface && a->frame_count > 1)
        status = write_targets(a, differences, output, error);
    return status ? status : write_details(a, output, error);
}

MesoStatus meso_animation_write(MesoAnimation *a, MesoOutput *output, MesoError *error)
{
    MesoGlbParts glb;
    json_int_t *meshes = MESO_NEW(&a->arena, json_int_t, a->scene->shape_count, error);
    MesoVec3 *differences = MESO_NEW(&a->arena, MesoVec3, a->scene->surface ? a->scene->surface->vertex_count : 1,
                                     error);
    if (!meshes || !differences)
        return MESO_ERR_MEMORY;
    describe(a, &glb, meshes, differences);
    MesoStatus status = meso_glb_finish(&glb, a->scene, output, error);
    if (!status)
        status = write_pieces(a, meshes, differences, output, error);
    meso_glb_release(&glb);
    return status;
}
