#include "formats/camera/camera_file.h"

#include "formats/json/json_text.h"
#include "formats/json/json_value.h"
#include "libcore/render/camera.h"

enum { VERSION = 1, MOST_KEYS = 1 << 20 };

static const float FARTHEST = 1e18f;

static MesoVec3 read_point(const MesoJsonField *field, MesoVec3 usual)
{
    float x[3] = {usual.x, usual.y, usual.z};
    uint32_t count = field->value ? meso_json_count(field, 3, 3) : 0;
    for (uint32_t k = 0; k < count; k++) {
        MesoJsonField item = meso_json_item(field, k);
        x[k] = meso_json_float_in(&item, -FARTHEST, FARTHEST, false, x[k]);
    }
    return (MesoVec3){x[0], x[1], x[2]};
}

/* The lens of a key, and of those after it that leave it out. */
typedef struct Lens {
    float focal, sensor;        /* mm; no focal length: 0 */
} Lens;

/* Field of view, lens or height: one of them. */
static void read_lens(const MesoJsonField *item, MesoCamera *camera, Lens *lens, float aspect)
{
    MesoJsonField fov = meso_json_key(item, "fov"), focal = meso_json_key(item, "focal");
    MesoJsonField sensor = meso_json_key(item, "sensor"), ortho = meso_json_key(item, "ortho");
    const MesoJsonField *extra = focal.value && fov.value ? &focal
                               : ortho.value && (fov.value || focal.value) ? &ortho : NULL;
    if (extra)
        meso_json_wrong(extra, "one of fov, focal and ortho says how much is shown");
    camera->fov_degrees = meso_json_float_in(&fov, 0.1f, 170, false, camera->fov_degrees);
    camera->height = meso_json_float_in(&ortho, 0, FARTHEST, true, fov.value || focal.value ? 0 : camera->height);
    lens->focal = meso_json_float_in(&focal, 0.01f, 1e5f, false, fov.value ? 0 : lens->focal);
    lens->sensor = meso_json_float_in(&sensor, 0.01f, 1e5f, false, lens->sensor);
    if (sensor.value && lens->focal == 0)
        meso_json_wrong(&sensor, "a sensor without a focal length");
    if (lens->focal > 0 && (focal.value || sensor.value))
        camera->fov_degrees = meso_camera_fov(lens->focal, lens->sensor, aspect);
}

static void read_key(const MesoJsonField *item, MesoCameraKey *key, const MesoCameraKey *before,
                     const MesoCamera *usual, Lens *lens, float aspect)
{
    static const char *const keys[] = {"frame", "eye", "target", "up", "fov", "focal", "sensor", "ortho", NULL};
    if (!meso_json_object(item, keys))
        return;
    const MesoCamera *then = before ? &before->camera : usual;
    MesoJsonField frame = meso_json_key(item, "frame"), eye = meso_json_key(item, "eye");
    MesoJsonField target = meso_json_key(item, "target"), up = meso_json_key(item, "up");
    meso_json_require(&frame);
    if (!before) {
        meso_json_require(&eye);
        meso_json_require(&target);
    }
    key->frame = (int32_t)meso_json_whole(&frame, 0, INT32_MAX, 0);
    key->camera = (MesoCamera){read_point(&eye, then->eye), read_point(&target, then->target),
                               read_point(&up, then->up), then->fov_degrees, then->height};
    read_lens(item, &key->camera, lens, aspect);
    if (meso_json_good(item) && before && key->frame <= before->frame)
        meso_json_wrong(&frame, "%d does not come after %d", key->frame, before->frame);
    if (meso_json_good(item) && before && (key->camera.height > 0) != (then->height > 0))
        meso_json_wrong(item, "orthographic and perspective keys do not go together");
    MesoView view;
    MesoError error;
    if (meso_json_good(item) && meso_view_build(&view, &key->camera, &error))
        meso_json_wrong(item, "%s", error.message);
}

MesoStatus meso_camera_read(MesoCameraKey **keys, uint32_t *count, MesoArena *arena, const MesoInput *input,
                            const MesoCamera *usual, float aspect, MesoError *error)
{
    static const char *const top_keys[] = {"format", "version", "keys", NULL};
    json_t *json;
    MesoStatus status = meso_json_parse(&json, input, error);
    if (status)
        return status;
    status = meso_json_check_format(json, input->path, "meso-camera", VERSION, error);
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error, .status = status};
    Lens lens = {0, 36};
    MesoJsonField root = meso_json_root(&reader, json);
    if (!status && meso_json_object(&root, top_keys)) {
        MesoJsonField list = meso_json_key(&root, "keys");
        *count = meso_json_count(&list, 1, MOST_KEYS);
        *keys = MESO_NEW(arena, MesoCameraKey, *count, error);
        if (!*keys)
            reader.status = MESO_ERR_MEMORY;
        for (uint32_t i = 0; i < *count && meso_json_good(&root); i++) {
            MesoJsonField item = meso_json_item(&list, i);
            read_key(&item, &(*keys)[i], i > 0 ? &(*keys)[i - 1] : NULL, usual, &lens, aspect);
        }
    }
    json_decref(json);
    return reader.status;
}
