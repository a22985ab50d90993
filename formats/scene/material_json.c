#include "formats/scene/material_json.h"

#include "formats/json/json_text.h"
#include "formats/json/json_value.h"

/* 0, or -1 where memory is out, as Jansson has it. */
static int put_material(json_t *materials, const char *name, const MesoMaterial *m)
{
    json_t *object = json_object();
    json_t *albedo = json_pack("[f, f, f]", (double)m->albedo[0], (double)m->albedo[1], (double)m->albedo[2]);
    int failed = json_object_set_new(object, "name", meso_json_string(name));
    failed |= json_object_set_new(object, "albedo", albedo);
    failed |= json_object_set_new(object, "roughness", json_real((double)m->roughness));
    failed |= json_object_set_new(object, "metallic", json_real((double)m->metallic));
    return failed | json_array_append_new(materials, object);
}

json_t *meso_materials_to_json(uint32_t count, const MesoMaterial *materials, const char *const *names)
{
    json_t *list = json_array();
    int failed = list ? 0 : -1;
    for (uint32_t m = 0; m < count; m++)
        failed |= put_material(list, names[m], &materials[m]);
    if (!failed)
        return list;
    json_decref(list);
    return NULL;
}

static void read_material(MesoMaterial *out, const char **name, const MesoJsonField *field)
{
    static const char *const keys[] = {"name", "albedo", "roughness", "metallic", NULL};
    meso_json_object(field, keys);
    MesoJsonField text = meso_json_key(field, "name"), albedo = meso_json_key(field, "albedo");
    MesoJsonField roughness = meso_json_key(field, "roughness"), metallic = meso_json_key(field, "metallic");
    *name = meso_json_text(&text);
    meso_json_floats(&albedo, 3, out->albedo);
    out->roughness = meso_json_float(&roughness, 0.5f);
    out->metallic = meso_json_float(&metallic, 0);
}

void meso_materials_of_json(const MesoJsonField *list, uint32_t *count, MesoMaterial **materials, const char ***names)
{
    MesoJsonReader *reader = list->reader;
    uint32_t number = meso_json_count(list, 0, UINT16_MAX);
    *count = 0;
    *materials = MESO_NEW(reader->arena, MesoMaterial, number, reader->error);
    *names = MESO_NEW(reader->arena, const char *, number, reader->error);
    if (!*materials || !*names) {
        reader->status = MESO_ERR_MEMORY;
        return;
    }
    *count = number;
    for (uint32_t m = 0; m < number && meso_json_good(list); m++) {
        MesoJsonField item = meso_json_item(list, m);
        read_material(&(*materials)[m], &(*names)[m], &item);
    }
}

/* ---- as people write them ---- */

const MesoMaterial meso_plain_material = {.albedo = {0.6f, 0.6f, 0.6f}, .roughness = 0.5f};

void meso_material_of_json(const MesoJsonField *field, MesoMaterial *material)
{
    static const char *const keys[] = {"color", "roughness", "metallic", NULL};
    MesoJsonField color = meso_json_key(field, "color");
    MesoJsonField roughness = meso_json_key(field, "roughness"), metallic = meso_json_key(field, "metallic");
    *material = meso_plain_material;
    if (!json_is_object(field->value)) {
        meso_json_color(field, material->albedo);
    } else if (meso_json_object(field, keys)) {
        if (color.value)
            meso_json_color(&color, material->albedo);
        material->roughness = meso_json_float_in(&roughness, 0, 1, false, meso_plain_material.roughness);
        material->metallic = meso_json_float_in(&metallic, 0, 1, false, meso_plain_material.metallic);
    }
}
