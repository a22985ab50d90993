#include "formats/replicate/deform_file.h"

#include <math.h>
#include <string.h>

#include "formats/json/json_text.h"
#include "formats/json/json_value.h"
#include "libcore/mesh/polygon_mesh.h"

enum { MOST_KEYS = 1 << 16 };

static const float degree = 0.017453292519943295f;

static MesoVec3 read_vector(const MesoJsonField *field, MesoVec3 fallback)
{
    float x[3] = {fallback.x, fallback.y, fallback.z};
    uint32_t count = field->value ? meso_json_count(field, 3, 3) : 0;
    for (uint32_t k = 0; k < count; k++) {
        MesoJsonField item = meso_json_item(field, k);
        x[k] = meso_json_float_in(&item, -MESO_COORDINATE_LIMIT, MESO_COORDINATE_LIMIT, false, x[k]);
    }
    return (MesoVec3){x[0], x[1], x[2]};
}

/* "x", "y", "z", or a vector, made unit length. */
static MesoVec3 read_axis(const MesoJsonField *field, MesoVec3 fallback)
{
    static const char *const words[] = {"x", "y", "z", NULL};
    if (json_is_string(field->value)) {
        uint32_t word = meso_json_word(field, "axis", words, 0);
        return (MesoVec3){word == 0 ? 1.0f : 0, word == 1 ? 1.0f : 0, word == 2 ? 1.0f : 0};
    }
    MesoVec3 v = read_vector(field, fallback);
    if (v.x == 0 && v.y == 0 && v.z == 0)
        meso_json_wrong(field, "[0, 0, 0] is no direction");
    return meso_vec3_direction(v, fallback);
}

/* What is left of it at right angles to the axis; where it was not given, any other will do as well. */
static MesoVec3 read_up(const MesoJsonField *field, MesoVec3 axis, MesoVec3 usual)
{
    static const MesoVec3 all[] = {{0, 0, 1}, {0, 1, 0}};
    MesoVec3 up = read_axis(field, usual);
    for (uint32_t i = 0; i < 3; i++) {
        MesoVec3 flat = meso_vec3_mad(up, -meso_vec3_dot(up, axis), axis);
        if (meso_vec3_length(flat) > 1e-3f)
            return meso_vec3_direction(flat, up);
        if (field->value || i == 2)
            break;
        up = all[i];
    }
    meso_json_wrong(field, "it runs along the axis");
    return up;
}

/* [[time, share], ...] */
static void read_keys(const MesoJsonField *list, MesoDeformStep *step)
{
    MesoJsonReader *reader = list->reader;
    uint32_t count = list->value ? meso_json_count(list, 1, MOST_KEYS) : 0;
    MesoDeformKey *keys = MESO_NEW(reader->arena, MesoDeformKey, count, reader->error);
    if (!keys)
        reader->status = MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        if (meso_json_count(&item, 2, 2) != 2)
            return;
        MesoJsonField time = meso_json_item(&item, 0), share = meso_json_item(&item, 1);
        keys[i] = (MesoDeformKey){meso_json_float_in(&time, 0, 1, false, 0),
                                  meso_json_float_in(&share, -1e6f, 1e6f, false, 0)};
        if (i > 0 && !(keys[i].time > keys[i - 1].time))
            meso_json_wrong(&time, "%g does not come after %g", (double)keys[i].time, (double)keys[i - 1].time);
    }
    step->keys = keys;
    step->key_count = meso_json_good(list) ? count : 0;
}

static void read_amount(const MesoJsonField *object, MesoDeformStep *step)
{
    MesoJsonField factor = meso_json_key(object, "factor"), degrees = meso_json_key(object, "degrees");
    MesoJsonField by = meso_json_key(object, "by"), radius = meso_json_key(object, "radius");
    step->amount = meso_json_float_in(&factor, 0, 1e6f, true, step->amount);
    if (degrees.value)
        step->amount = degree * meso_json_float_in(&degrees, -1e6f, 1e6f, false, 0);
    step->amount = meso_json_float_in(&by, -MESO_COORDINATE_LIMIT, MESO_COORDINATE_LIMIT, false, step->amount);
    step->radius = meso_json_float_in(&radius, 0, MESO_COORDINATE_LIMIT, true, step->radius);
}

/* One key says which deformation it is. */
static uint32_t kind_of(const MesoJsonField *field)
{
    const char *key = "", *found = NULL;
    json_t *value;
    if (!meso_json_object(field, NULL))
        return 0;
    json_object_foreach((json_t *)field->value, key, value) {
        if (meso_json_is_note(key))
            continue;
        if (found)
            meso_json_wrong(field, "\"%.40s\" and \"%.40s\": a step has one deformation", found, key);
        found = key;
    }
    for (uint32_t i = 0; found && meso_deform_names[i]; i++)
        if (strcmp(found, meso_deform_names[i]) == 0)
            return i;
    if (found)
        meso_json_refuse(field, "deformation", found, meso_deform_names);
    else
        meso_json_wrong(field, "a deformation is needed here");
    return 0;
}

static void read_step(const MesoJsonField *field, MesoDeformStep *step, const MesoVec3 *positions, uint32_t count)
{
    static const char *const keys[MESO_DEFORM_KINDS][6] = {
        {"axis", "factor", "center", "keys"},
        {"factor", "center", "keys"},
        {"axis", "degrees", "center", "keys"},
        {"axis", "up", "degrees", "center", "keys"},
        {"by", "radius", "center", "keys"},
    };
    uint32_t kind = kind_of(field);
    if (!meso_json_good(field))
        return;
    MesoJsonField object = meso_json_key(field, meso_deform_names[kind]);
    if (!meso_json_object(&object, keys[kind]))
        return;
    MesoJsonField axis = meso_json_key(&object, "axis"), up = meso_json_key(&object, "up");
    MesoJsonField center = meso_json_key(&object, "center"), times = meso_json_key(&object, "keys");
    *step = meso_deform_usual((MesoDeformKind)kind, positions, count);
    step->axis = read_axis(&axis, step->axis);
    step->up = read_up(&up, step->axis, step->up);
    step->centered = center.value != NULL;
    step->center = read_vector(&center, step->center);
    read_amount(&object, step);
    read_keys(&times, step);
}

MesoStatus meso_deform_read(MesoDeformFile *file, MesoArena *arena, const MesoInput *input, const MesoVec3 *positions,
                            uint32_t count, MesoError *error)
{
    static const char *const keys[] = {"format", "version", "provenance", "steps", NULL};
    json_t *json;
    *file = (MesoDeformFile){0};
    MesoStatus status = meso_json_parse(&json, input, error);
    if (status)
        return status;
    status = meso_json_check_format(json, input->path, "meso-deform", MESO_DEFORM_VERSION, error);
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error, .status = status};
    MesoJsonField root = meso_json_root(&reader, json), list = meso_json_key(&root, "steps");
    if (!status && meso_json_object(&root, keys)) {
        meso_json_require(&list);
        file->step_count = meso_json_count(&list, 1, MESO_DEFORM_STEPS);
        MesoDeformStep *steps = MESO_NEW(arena, MesoDeformStep, file->step_count, error);
        if (!steps)
            reader.status = MESO_ERR_MEMORY;
        for (uint32_t i = 0; i < file->step_count && meso_json_good(&list); i++) {
            MesoJsonField item = meso_json_item(&list, i);
            read_step(&item, &steps[i], positions, count);
        }
        file->steps = steps;
    }
    json_decref(json);
    return reader.status;
}
