#include "formats/camera/gltf_camera.h"

#include <string.h>

#include "formats/json/json_text.h"
#include "formats/json/json_value.h"

enum { MOST_NODES = 1 << 22, HEAD_BYTES = 20 };

static const uint32_t JSON_CHUNK = 0x4e4f534a;

/* ---- the text ---- */

static uint32_t word_at(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* The JSON of a .glb is its first chunk, and all of a .gltf. */
static MesoStatus find_text(MesoInput *text, const MesoInput *input, MesoError *error)
{
    if (input->size < 4 || memcmp(input->data, "glTF", 4) != 0) {
        meso_input_wrap(text, input->path, input->data, input->size);
        return MESO_OK;
    }
    if (input->size < HEAD_BYTES || word_at(input->data + 4) != 2 || word_at(input->data + 16) != JSON_CHUNK ||
        word_at(input->data + 12) > input->size - HEAD_BYTES)
        return meso_fail(error, MESO_ERR_INPUT, "%s: broken GLB: no JSON comes first", input->path);
    meso_input_wrap(text, input->path, input->data + HEAD_BYTES, word_at(input->data + 12));
    return MESO_OK;
}

/* ---- nodes ---- */

/* A node's axes and place in the one above it. */
typedef struct Frame {
    MesoVec3 axes[3], place;
} Frame;

static MesoVec3 turn(const Frame *frame, MesoVec3 d)
{
    MesoVec3 v = meso_vec3_mad(meso_vec3_scale(frame->axes[0], d.x), d.y, frame->axes[1]);
    return meso_vec3_mad(v, d.z, frame->axes[2]);
}

static Frame chain(const Frame *above, const Frame *own)
{
    Frame frame = {.place = meso_vec3_add(above->place, turn(above, own->place))};
    for (int a = 0; a < 3; a++)
        frame.axes[a] = turn(above, own->axes[a]);
    return frame;
}

static Frame frame_of(const MesoJsonField *node)
{
    float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, t[3] = {0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    MesoJsonField matrix = meso_json_key(node, "matrix"), place = meso_json_key(node, "translation");
    MesoJsonField rotation = meso_json_key(node, "rotation"), scale = meso_json_key(node, "scale");
    meso_json_floats(&matrix, 16, m);
    meso_json_floats(&place, 3, t);
    meso_json_floats(&rotation, 4, q);
    meso_json_floats(&scale, 3, s);
    if (matrix.value)
        return (Frame){{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
    float x = q[0], y = q[1], z = q[2], w = q[3];
    const MesoVec3 axes[3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
                              {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
                              {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
    return (Frame){{meso_vec3_scale(axes[0], s[0]), meso_vec3_scale(axes[1], s[1]), meso_vec3_scale(axes[2], s[2])},
                   {t[0], t[1], t[2]}};
}

/* The node above each, or MESO_NO_INDEX. */
static uint32_t *find_parents(const MesoJsonField *nodes, uint32_t count, MesoArena *arena, MesoError *error)
{
    uint32_t *parents = MESO_NEW(arena, uint32_t, count, error);
    if (!parents) {
        nodes->reader->status = MESO_ERR_MEMORY;
        return NULL;
    }
    memset(parents, 0xff, count * sizeof *parents);
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField node = meso_json_item(nodes, i), children = meso_json_key(&node, "children");
        uint32_t child_count = children.value ? meso_json_count(&children, 0, MOST_NODES) : 0;
        for (uint32_t k = 0; k < child_count; k++) {
            MesoJsonField child = meso_json_item(&children, k);
            parents[meso_json_whole(&child, 0, (int64_t)count - 1, 0)] = i;
        }
    }
    return parents;
}

static Frame place_node(const MesoJsonField *nodes, const uint32_t *parents, uint32_t count, uint32_t node)
{
    MesoJsonField item = meso_json_item(nodes, node);
    Frame frame = frame_of(&item);
    uint32_t steps = 0;
    for (uint32_t above = parents[node]; above != MESO_NO_INDEX && meso_json_good(nodes); above = parents[above]) {
        MesoJsonField parent = meso_json_item(nodes, above);
        Frame outer = frame_of(&parent);
        frame = chain(&outer, &frame);
        if (++steps > count)
            meso_json_wrong(&item, "nodes above it go in a circle");
    }
    return frame;
}

/* ---- cameras ---- */

static const char *name_of(const MesoJsonField *item)
{
    const char *name = json_string_value(json_object_get(item->value, "name"));
    return name ? name : "";
}

/* Of a node that has a camera, its number; -1 for others. */
static int64_t camera_of(const MesoJsonField *node, int64_t camera_count)
{
    MesoJsonField camera = meso_json_key(node, "camera");
    return camera.value ? meso_json_whole(&camera, 0, camera_count - 1, -1) : -1;
}

/* The node whose camera it is, or MESO_NO_INDEX; names that there are to `known`. */
static uint32_t find_node(const MesoJsonField *nodes, uint32_t node_count, const MesoJsonField *cameras,
                          int64_t camera_count, const char *name, char *known, size_t size)
{
    size_t length = 0;
    known[0] = 0;
    for (uint32_t i = 0; i < node_count && meso_json_good(nodes); i++) {
        MesoJsonField node = meso_json_item(nodes, i);
        int64_t number = camera_of(&node, camera_count);
        if (number < 0)
            continue;
        MesoJsonField camera = meso_json_item(cameras, (size_t)number);
        const char *own = name_of(&node)[0] ? name_of(&node) : name_of(&camera);
        if (!name || strcmp(name_of(&node), name) == 0 || strcmp(name_of(&camera), name) == 0)
            return i;
        if (length < size)
            length += (size_t)snprintf(known + length, size - length, "%s'%.60s'", length ? ", " : "", own);
    }
    return MESO_NO_INDEX;
}

static void read_lens(const MesoJsonField *camera, MesoCamera *out)
{
    static const char *const kinds[] = {"perspective", "orthographic", NULL};
    MesoJsonField type = meso_json_key(camera, "type");
    meso_json_require(&type);
    if (!meso_json_good(camera))
        return;
    bool parallel = meso_json_word(&type, "kind", kinds, 0) == 1;
    MesoJsonField lens = meso_json_key(camera, kinds[parallel]);
    MesoJsonField number = meso_json_key(&lens, parallel ? "ymag" : "yfov");
    meso_json_require(&number);
    if (parallel)
        out->height = 2 * fabsf(meso_json_float(&number, 1));
    else
        out->fov_degrees = meso_json_float_in(&number, 0, 3.1415926f, true, 1) * (float)(180 / 3.14159265358979323846);
    if (meso_json_good(camera) && parallel && !(out->height > 0))
        meso_json_wrong(&number, "a picture of no height");
}

/* It looks along -z, with y up. */
static void look_along(const Frame *frame, MesoCamera *out)
{
    MesoVec3 forward = meso_vec3_unit(meso_vec3_scale(frame->axes[2], -1), (MesoVec3){0, 0, -1});
    float ahead = fmaxf(meso_vec3_length(frame->place), 1);      /* so that rounding leaves the direction be */
    out->eye = frame->place;
    out->target = meso_vec3_mad(frame->place, ahead, forward);
    out->up = meso_vec3_unit(frame->axes[1], (MesoVec3){0, 1, 0});
}

static void read_camera(MesoCamera *out, const MesoJsonField *root, MesoArena *arena, const char *name,
                        MesoError *error)
{
    MesoJsonField nodes = meso_json_key(root, "nodes"), cameras = meso_json_key(root, "cameras");
    uint32_t node_count = nodes.value ? meso_json_count(&nodes, 0, MOST_NODES) : 0;
    uint32_t camera_count = cameras.value ? meso_json_count(&cameras, 0, MOST_NODES) : 0;
    char known[512];
    uint32_t node = find_node(&nodes, node_count, &cameras, camera_count, name, known, sizeof known);
    if (!meso_json_good(root))
        return;
    if (node == MESO_NO_INDEX) {
        if (known[0])
            meso_json_wrong(root, "no camera '%s'; there are %s", name, known);
        else
            meso_json_wrong(root, "no node has a camera");
        return;
    }
    uint32_t *parents = find_parents(&nodes, node_count, arena, error);
    if (!parents || !meso_json_good(root))
        return;
    MesoJsonField item = meso_json_item(&nodes, node);
    MesoJsonField camera = meso_json_item(&cameras, (size_t)camera_of(&item, camera_count));
    Frame frame = place_node(&nodes, parents, node_count, node);
    *out = (MesoCamera){.fov_degrees = 30};
    read_lens(&camera, out);
    look_along(&frame, out);
    MesoView view;
    MesoError wrong;
    if (meso_json_good(root) && meso_view_build(&view, out, &wrong))
        meso_json_wrong(&item, "%s", wrong.message);
}

MesoStatus meso_gltf_camera_read(MesoCamera *camera, MesoArena *arena, const MesoInput *input, const char *name,
                                 MesoError *error)
{
    MesoInput text;
    json_t *json;
    MesoStatus status = find_text(&text, input, error);
    if (!status)
        status = meso_json_parse(&json, &text, error);
    if (status)
        return status;
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error};
    MesoJsonField root = meso_json_root(&reader, json);
    if (meso_json_object(&root, NULL))
        read_camera(camera, &root, arena, name, error);
    json_decref(json);
    return reader.status;
}
