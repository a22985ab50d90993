#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "formats/image/exr_writer.h"
#include "libcore/render/projection.h"

/* ---- channels ---- */

void meso_exr_add_part(MesoExrWriter *writer, const char *name)
{
    if (writer->part_count == 0 || writer->options.multipart)
        writer->parts[writer->part_count++] = (MesoExrPart){
            .name = writer->options.multipart ? name : "image", .channel_begin = writer->channel_count};
}

static void add(MesoExrWriter *writer, const char *name, exr_pixel_type_t stored, exr_pixel_type_t given,
                uint32_t stride, const void *values)
{
    writer->channels[writer->channel_count++] = (MesoExrChannel){name, stored, given, stride, values};
    writer->parts[writer->part_count - 1].channel_count++;
}

void meso_exr_add_channel(MesoExrWriter *writer, const char *name, exr_pixel_type_t stored, uint32_t stride,
                          const float *values)
{
    add(writer, name, stored, EXR_PIXEL_FLOAT, stride, values);
}

/* A part of `count` channels that lie beside each other in an array. */
static void add_layer(MesoExrWriter *writer, const char *part, const char *const *names, uint32_t count,
                      exr_pixel_type_t stored, const float *values)
{
    if (!values)
        return;
    meso_exr_add_part(writer, part);
    for (uint32_t i = 0; i < count; i++)
        meso_exr_add_channel(writer, names[i], stored, count, values + i);
}

static void list_extras(MesoExrWriter *writer)
{
    static const char *const position[3] = {"P.X", "P.Y", "P.Z"}, *const uv[2] = {"uv.U", "uv.V"};
    static const char *const material[2] = {"roughness", "metallic"}, *const openness[1] = {"AO"};
    static const char *const motion[2] = {"forward.u", "forward.v"};
    const MesoImage *m = writer->image;
    add_layer(writer, "P", position, 3, EXR_PIXEL_FLOAT, m->position);
    add_layer(writer, "uv", uv, 2, EXR_PIXEL_FLOAT, m->uv);
    add_layer(writer, "material", material, 2, EXR_PIXEL_HALF, m->material);
    add_layer(writer, "AO", openness, 1, EXR_PIXEL_HALF, m->openness);
    add_layer(writer, "forward", motion, 2, EXR_PIXEL_FLOAT, m->motion);
}

/* Two ranks a layer: number and coverage in R and G, and in B and A. */
static void list_mattes(MesoExrWriter *writer)
{
    enum { CHANNELS = MESO_EXR_MATTE_CHANNELS };
    const MesoImage *m = writer->image;
    for (uint32_t k = 0; k < m->matte_count; k++) {
        snprintf(writer->matte_parts[k], sizeof *writer->matte_parts, "crypto_%s", m->mattes[k].name);
        meso_exr_add_part(writer, writer->matte_parts[k]);
        for (uint32_t i = 0; i < CHANNELS; i++) {
            char *name = writer->matte_names[k * CHANNELS + i];
            snprintf(name, sizeof *writer->matte_names, "crypto_%s%02u.%c", m->mattes[k].name, i / 4, "RGBA"[i % 4]);
            meso_exr_add_channel(writer, name, EXR_PIXEL_FLOAT, CHANNELS, m->mattes[k].ranks + i);
        }
    }
}

static void list_channels(MesoExrWriter *writer)
{
    static const char *const color[4] = {"R", "G", "B", "A"}, *const depth[1] = {"Z"};
    static const char *const normal[3] = {"N.X", "N.Y", "N.Z"}, *const albedo[3] = {"albedo.R", "albedo.G", "albedo.B"};
    const MesoImage *m = writer->image;
    add_layer(writer, "rgba", color, 4, EXR_PIXEL_HALF, m->color);
    add_layer(writer, "depth", depth, 1, EXR_PIXEL_FLOAT, m->depth);
    add_layer(writer, "N", normal, 3, EXR_PIXEL_HALF, m->normal);
    add_layer(writer, "albedo", albedo, 3, EXR_PIXEL_HALF, m->albedo);
    for (uint32_t c = 0; c < m->channel_count; c++) {
        if (c == 0)
            meso_exr_add_part(writer, "id");
        add(writer, m->channels[c].name, EXR_PIXEL_UINT, EXR_PIXEL_UINT, 1, m->ids[c]);
    }
    list_extras(writer);
    list_mattes(writer);
}

/* ---- attributes ---- */

/* {"name": "1a2b3c4d", ...} of the things that are on the picture, by their numbers. */
static char *manifest_of(const MesoMatte *matte)
{
    json_t *object = json_object();
    int failed = !object;
    for (uint32_t i = 0; i < matte->count && !failed; i++) {
        char text[16], hash[16];
        uint32_t bits;
        if (!(matte->seen[i / 64] >> (i % 64) & 1))
            continue;
        memcpy(&bits, &matte->hashes[i], sizeof bits);
        snprintf(hash, sizeof hash, "%08x", bits);
        failed |= json_object_set_new_nocheck(object, meso_matte_name(matte, i, text), json_string(hash)) != 0;
    }
    char *text = failed ? NULL : json_dumps(object, JSON_COMPACT);
    json_decref(object);
    return text;
}

static exr_result_t describe_matte(exr_context_t context, int part, const MesoMatte *matte)
{
    char name[MESO_CHANNEL_NAME + 16], key[64];
    char *manifest = manifest_of(matte);
    if (!manifest)
        return EXR_ERR_OUT_OF_MEMORY;
    snprintf(name, sizeof name, "crypto_%s", matte->name);
    const char *const values[4][2] = {{"name", name}, {"hash", "MurmurHash3_32"}, {"conversion", "uint32_to_float32"},
                                      {"manifest", manifest}};
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int i = 0; i < 4 && !result; i++) {
        snprintf(key, sizeof key, "cryptomatte/%07x/%s", meso_matte_hash(name, strlen(name)) >> 4, values[i][0]);
        result = exr_attr_set_string(context, part, key, values[i][1]);
    }
    free(manifest);
    return result;
}

/* Column-major to the row vectors of EXR, which is a plain copy. */
static exr_result_t set_matrix(exr_context_t context, int part, const char *name, const MesoMatrix *matrix)
{
    exr_attr_m44f_t value;
    memcpy(value.m, matrix->m, sizeof value.m);
    return exr_attr_set_m44f(context, part, name, &value);
}

static exr_result_t set_camera(const MesoExrWriter *writer, int part)
{
    MesoView view;
    const MesoImage *m = writer->image;
    if (meso_view_build(&view, &m->camera, NULL))
        return EXR_ERR_SUCCESS;
    const MesoVec3 axes[3] = {view.right, view.up, view.forward};
    MesoMatrix camera = {{0}};
    for (uint32_t a = 0; a < 3; a++) {
        camera.m[a] = axes[a].x;
        camera.m[4 + a] = axes[a].y;
        camera.m[8 + a] = axes[a].z;
        camera.m[12 + a] = -meso_vec3_dot(axes[a], view.eye);
    }
    camera.m[15] = 1;

    /* OpenEXR's NDC: (0, 0) is the upper left corner of the picture, (1, 1) the lower right one. */
    MesoMatrix ndc = meso_view_clip_from_world(&view, 1, writer->width, writer->height,
                                               (MesoWindow){0, 0, writer->width, writer->height});
    for (uint32_t column = 0; column < 4; column++)
        for (uint32_t row = 0; row < 2; row++)
            ndc.m[4 * column + row] = 0.5f * (ndc.m[4 * column + row] + ndc.m[4 * column + 3]);
    exr_result_t result = set_matrix(writer->context, part, "worldToCamera", &camera);
    if (!result)
        result = set_matrix(writer->context, part, "worldToNDC", &ndc);
    return result ? result : exr_set_screen_window_width(writer->context, part, 2 * view.half_height *
                                                         (float)writer->width / (float)writer->height);
}

/* The names of a channel, one a line. */
static const char *join_names(const MesoIdChannel *channel, MesoArena *arena, MesoError *error)
{
    size_t size = 1;
    for (uint32_t i = 0; i < channel->count; i++)
        size += strlen(channel->names[i]) + 1;
    char *text = MESO_NEW(arena, char, size, error), *out = text;
    for (uint32_t i = 0; out && i < channel->count; i++) {
        size_t length = strlen(channel->names[i]);
        if (i > 0)
            *out++ = '\n';
        memcpy(out, channel->names[i], length);
        out += length;
    }
    return text;
}

static MesoStatus list_names(MesoExrWriter *writer, MesoArena *arena, MesoError *error)
{
    for (uint32_t c = 0; c < writer->image->channel_count; c++) {
        const MesoIdChannel *channel = &writer->image->channels[c];
        if (!channel->names)
            continue;
        writer->names_keys[c] = meso_arena_print(arena, error, "meso:%ss", channel->name);
        writer->names[c] = join_names(channel, arena, error);
        if (!writer->names_keys[c] || !writer->names[c])
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

static exr_attr_box2i_t box_of(const MesoWindow *w)
{
    exr_attr_box2i_t box;
    box.min.x = (int32_t)w->x;
    box.min.y = (int32_t)w->y;
    box.max.x = (int32_t)(w->x + w->width) - 1;
    box.max.y = (int32_t)(w->y + w->height) - 1;
    return box;
}

static exr_result_t begin_part(const MesoExrWriter *writer, const MesoExrPart *part, int *number)
{
    const MesoWindow whole = {0, 0, writer->width, writer->height};
    const exr_attr_box2i_t display = box_of(&whole), data = box_of(&writer->window);
    exr_attr_v2f_t center;
    center.x = center.y = 0;
    exr_context_t context = writer->context;
    exr_result_t result = exr_add_part(context, part->name, EXR_STORAGE_SCANLINE, number);
    if (!result)
        result = exr_initialize_required_attr(context, *number, &display, &data, 1, &center, 1,
                                              EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; i < part->channel_count && !result; i++) {
        const MesoExrChannel *channel = &writer->channels[part->channel_begin + i];
        result = exr_add_channel(context, *number, channel->name, channel->stored, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    return result;
}

/* What all parts say, which have to agree on it. */
static exr_result_t describe_picture(const MesoExrWriter *writer, int part, const char *provenance)
{
    static const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    const MesoExrOptions *options = &writer->options;
    exr_context_t context = writer->context;
    exr_result_t result = EXR_ERR_SUCCESS;
    if (writer->image)
        result = exr_attr_set_chromaticities(context, part, "chromaticities", &rec709);
    if (!result)
        result = exr_attr_set_string(context, part, "meso:provenance", provenance);
    if (!result && options->numbered)
        result = exr_attr_set_int(context, part, "imageCounter", options->frame);
    if (!result && options->numbered) {
        const exr_attr_rational_t rate = {(int32_t)options->rate[0], options->rate[1]};
        result = exr_attr_set_rational(context, part, "framesPerSecond", &rate);
    }
    return result;
}

/* Names and manifests of what a part has, or of all where there is one. */
static exr_result_t describe_channels(const MesoExrWriter *writer, int part)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    bool all = !writer->options.multipart;
    const char *name = writer->parts[part].name;
    for (uint32_t c = 0; c < MESO_ID_CHANNELS && !result; c++)
        if (writer->names[c] && (all || strcmp(name, "id") == 0))
            result = exr_attr_set_string(writer->context, part, writer->names_keys[c], writer->names[c]);
    for (uint32_t k = 0; writer->image && k < writer->image->matte_count && !result; k++)
        if (all || name == writer->matte_parts[k])
            result = describe_matte(writer->context, part, &writer->image->mattes[k]);
    return result;
}

exr_result_t meso_exr_describe(MesoExrWriter *writer, const char *provenance)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    for (uint32_t i = 0; i < writer->part_count && !result; i++) {
        int part;
        result = begin_part(writer, &writer->parts[i], &part);
        if (!result)
            result = describe_picture(writer, part, provenance);
        if (!result)
            result = describe_channels(writer, part);
        if (!result && writer->image)
            result = set_camera(writer, part);
    }
    return result ? result : exr_write_header(writer->context);
}

MesoStatus meso_exr_list(MesoExrWriter *writer, MesoError *error)
{
    list_channels(writer);
    return list_names(writer, &writer->arena, error);
}
