#include "formats/replicate/details_file.h"

#include "formats/json/json_text.h"
#include "formats/replicate/details_parser.h"
#include "formats/scene/material_json.h"

/* Without any, details are grey. */
static void read_materials(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailsFile *details)
{
    static const char *const none[] = {"plain", NULL};
    uint32_t count = 0;
    const char **names = field->value ? meso_details_keys(parser, field, 1, MESO_DETAILS_KINDS, &count) : NULL;
    MesoMaterial *materials = MESO_DETAILS_NEW(parser, MesoMaterial, count ? count : 1);
    if (!materials || !meso_json_good(field))
        return;
    materials[0] = meso_plain_material;
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField item = meso_json_key(field, names[i]);
        meso_material_of_json(&item, &materials[i]);
    }
    parser->material_names = names;
    parser->material_count = count;
    details->materials = materials;
    details->material_names = names ? names : (const char *const *)none;
    details->material_count = count ? count : 1;
}

static void read_distributions(MesoDetailsParser *parser, const MesoJsonField *list, MesoDetailsFile *details)
{
    meso_json_require(list);
    uint32_t count = meso_json_count(list, 1, MESO_DETAILS_KINDS);
    MesoDetailDistribution *distributions = MESO_DETAILS_NEW(parser, MesoDetailDistribution, count);
    for (uint32_t i = 0; distributions && i < count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        meso_details_distribution(parser, &item, &distributions[i]);
    }
    details->distributions = distributions;
    details->distribution_count = count;
}

static void read_root(MesoDetailsParser *parser, const MesoJsonField *root, MesoDetailsFile *details)
{
    static const char *const keys[] = {"format", "version", "provenance", "materials", "kinds", "details", NULL};
    MesoJsonField materials = meso_json_key(root, "materials"), kinds = meso_json_key(root, "kinds");
    MesoJsonField list = meso_json_key(root, "details");
    if (!meso_json_object(root, keys))
        return;
    read_materials(parser, &materials, details);
    if (meso_json_good(root))
        meso_details_kinds(parser, &kinds, details);
    if (meso_json_good(root))
        read_distributions(parser, &list, details);
}

MesoStatus meso_details_read(MesoDetailsFile *details, MesoArena *arena, const MesoInput *input,
                             const MesoJsonFiles *files, MesoError *error)
{
    json_t *root;
    *details = (MesoDetailsFile){0};
    MesoStatus status = meso_json_parse(&root, input, error);
    if (status)
        return status;
    status = meso_json_check_format(root, input->path, "meso-details", MESO_DETAILS_VERSION, error);
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error, .status = status};
    MesoDetailsParser parser = {.reader = &reader, .files = files};
    MesoJsonField field = meso_json_root(&reader, root);
    if (!status)
        read_root(&parser, &field, details);
    json_decref(root);
    return reader.status;
}
