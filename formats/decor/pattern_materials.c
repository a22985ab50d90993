#include "formats/decor/pattern_materials.h"

#include <string.h>

enum { MOST_MATERIALS = 1 << 16, NAME_LENGTH = 200 };

static const MesoMaterial plain = {.albedo = {0.6f, 0.6f, 0.6f}, .roughness = 0.5f};

/* The inverse of the curve of sRGB (IEC 61966-2-1). */
static float decode_srgb(uint32_t byte)
{
    float x = (float)byte / 255;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

static uint32_t hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? (uint32_t)(c - '0')
           : c >= 'a' && c <= 'f' ? (uint32_t)(c - 'a' + 10)
           : c >= 'A' && c <= 'F' ? (uint32_t)(c - 'A' + 10)
                                  : 16;
}

/* "#rrggbb" or "#rgb", as of pictures. */
static bool read_hex(const char *text, float color[3])
{
    size_t digits = strlen(text) - (*text != 0);
    if (*text != '#' || (digits != 3 && digits != 6))
        return false;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t high = hex_digit(text[digits == 3 ? 1 + i : 1 + 2 * i]);
        uint32_t low = hex_digit(text[digits == 3 ? 1 + i : 2 + 2 * i]);
        if (high > 15 || low > 15)
            return false;
        color[i] = decode_srgb(16 * high + low);
    }
    return true;
}

static void read_color(const MesoJsonField *field, float color[3])
{
    if (json_is_string(field->value)) {
        if (!read_hex(json_string_value(field->value), color))
            meso_json_wrong(field, "'%.40s' is no colour; \"#rrggbb\" is", json_string_value(field->value));
        return;
    }
    if (field->value && !json_is_array(field->value))
        meso_json_wrong(field, "a colour is needed here, \"#rrggbb\" or three numbers from 0 to 1");
    uint32_t count = meso_json_count(field, 3, 3);
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField item = meso_json_item(field, i);
        color[i] = meso_pattern_float(&item, 0, 1, false, color[i]);
    }
}

static void read_material(const MesoJsonField *field, MesoMaterial *material)
{
    static const char *const keys[] = {"color", "roughness", "metallic", NULL};
    MesoJsonField color = meso_json_key(field, "color");
    MesoJsonField roughness = meso_json_key(field, "roughness"), metallic = meso_json_key(field, "metallic");
    *material = plain;
    if (!json_is_object(field->value)) {
        read_color(field, material->albedo);
    } else if (meso_json_object(field, keys)) {
        if (color.value)
            read_color(&color, material->albedo);
        material->roughness = meso_pattern_float(&roughness, 0, 1, false, plain.roughness);
        material->metallic = meso_pattern_float(&metallic, 0, 1, false, plain.metallic);
    }
}

static const char *copy_name(MesoPatternParser *parser, const MesoJsonField *field)
{
    MesoJsonReader *reader = parser->reader;
    size_t length = strlen(field->key);
    if (length == 0 || length > NAME_LENGTH)
        meso_json_wrong(field, "a name of %zu characters; from 1 to %d are possible", length, NAME_LENGTH);
    const char *name = meso_json_good(field) ? meso_arena_copy_text(reader->arena, field->key, reader->error) : "";
    if (!name)
        reader->status = MESO_ERR_MEMORY;
    return name ? name : "";
}

static void read_table(MesoPatternParser *parser, const MesoJsonField *field, MesoMaterial *materials)
{
    MesoJsonReader *reader = parser->reader;
    const char *key;
    json_t *value;
    uint32_t i = 0;
    json_object_foreach((json_t *)field->value, key, value) {
        MesoJsonField item = meso_json_key(field, key);
        const char *name = copy_name(parser, &item);
        read_material(&item, &materials[i]);
        parser->material_names[i] = name;
        if (meso_json_good(field) && meso_names_add(&parser->material_numbers, reader->arena, name, strlen(name), i,
                                                    reader->error) == MESO_NO_INDEX)
            reader->status = MESO_ERR_MEMORY;
        if (!meso_json_good(field))
            return;
        i++;
    }
}

void meso_pattern_materials(MesoPatternParser *parser, const MesoJsonField *field, MesoPattern *pattern)
{
    size_t size = json_object_size(field->value);
    if (field->value && !meso_json_object(field, NULL))
        return;
    if (size > MOST_MATERIALS)
        meso_json_wrong(field, "%zu materials; at most %d are possible", size, MOST_MATERIALS);
    uint32_t count = size && meso_json_good(field) ? (uint32_t)size : 1;
    MesoMaterial *materials = MESO_PATTERN_NEW(parser, MesoMaterial, count);
    parser->material_names = MESO_PATTERN_NEW(parser, const char *, (uint64_t)count + 1);
    if (!materials || !parser->material_names)
        return;
    materials[0] = plain;
    parser->material_names[0] = "plain";
    parser->material_count = count;
    if (size && meso_json_good(field))
        read_table(parser, field, materials);
    else if (meso_names_add(&parser->material_numbers, parser->reader->arena, "plain", 5, 0, parser->reader->error) ==
             MESO_NO_INDEX)
        parser->reader->status = MESO_ERR_MEMORY;
    pattern->materials = materials;
    pattern->material_names = parser->material_names;
    pattern->material_count = count;
}
