#include "formats/decor/pattern_materials.h"

#include <string.h>

#include "formats/scene/material_json.h"

enum { MOST_MATERIALS = 1 << 16, NAME_LENGTH = 200 };

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
        meso_material_of_json(&item, &materials[i]);
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
    materials[0] = meso_plain_material;
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
