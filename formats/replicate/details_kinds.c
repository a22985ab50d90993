/* Kinds of details: what they are made of. */
#include "formats/replicate/details_parser.h"

static const char *const geometries[] = {"mesh", "bump", "hole", NULL};
static const char *const profiles[] = {"gauss", "ring", "image", NULL};

static void read_mesh(const MesoJsonField *field, MesoDetailKind *kind)
{
    static const char *const keys[] = {"mesh", "length", "lift", "upright", "material", NULL};
    MesoJsonField mesh = meso_json_key(field, "mesh"), length = meso_json_key(field, "length");
    MesoJsonField lift = meso_json_key(field, "lift"), upright = meso_json_key(field, "upright");
    if (!meso_json_object(field, keys))
        return;
    kind->geometry = MESO_DETAIL_MESH;
    kind->file = meso_details_name(&mesh);
    kind->length = meso_json_float_in(&length, 0, 1e18f, true, 0);
    kind->lift = meso_json_float_in(&lift, -100, 100, false, 0);
    kind->upright = meso_json_bool(&upright, false);
}

static void read_bump(const MesoJsonField *field, MesoDetailKind *kind)
{
    static const char *const outer[] = {"bump", "material", NULL};
    static const char *const keys[] = {"profile", "height", "image", NULL};
    MesoJsonField bump = meso_json_key(field, "bump");
    if (!meso_json_object(field, outer) || !meso_json_object(&bump, keys))
        return;
    MesoJsonField profile = meso_json_key(&bump, "profile"), height = meso_json_key(&bump, "height");
    MesoJsonField image = meso_json_key(&bump, "image");
    kind->geometry = MESO_DETAIL_BUMP;
    kind->profile = (MesoBumpProfile)meso_json_word(&profile, "profile", profiles,
                                                    image.value ? MESO_BUMP_IMAGE : MESO_BUMP_GAUSS);
    kind->height = meso_json_float_in(&height, -10, 10, false, 0.25f);
    if (kind->profile == MESO_BUMP_IMAGE)
        kind->file = meso_details_name(&image);
    else if (image.value)
        meso_json_wrong(&image, "it goes with \"profile\": \"image\"");
}

static void read_hole(const MesoJsonField *field, MesoDetailKind *kind)
{
    static const char *const outer[] = {"hole", NULL}, *const keys[] = {NULL};
    MesoJsonField hole = meso_json_key(field, "hole");
    kind->geometry = MESO_DETAIL_HOLE;
    if (meso_json_object(field, outer))
        meso_json_object(&hole, keys);
}

static void read_material(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailKind *kind)
{
    MesoJsonField material = meso_json_key(field, "material");
    kind->own_material = material.value != NULL;
    if (!material.value)
        return;
    if (parser->material_count == 0)
        meso_json_wrong(&material, "there are no \"materials\"");
    else
        kind->material = meso_json_word(&material, "material", parser->material_names, 0);
}

static void read_kind(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailKind *kind)
{
    static void (*const readers[])(const MesoJsonField *, MesoDetailKind *) = {read_mesh, read_bump, read_hole};
    uint32_t found = 0, which = 0;
    if (!meso_json_object(field, NULL))
        return;
    for (uint32_t i = 0; geometries[i]; i++)
        if (json_object_get(field->value, geometries[i])) {
            which = i;
            found++;
        }
    if (found != 1) {
        meso_json_wrong(field, "one of \"mesh\", \"bump\" and \"hole\" is needed");
        return;
    }
    kind->file = "";
    readers[which](field, kind);
    if (meso_json_good(field))
        read_material(parser, field, kind);
}

void meso_details_kinds(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailsFile *details)
{
    uint32_t count = 0;
    const char **names = meso_details_keys(parser, field, 1, MESO_DETAILS_KINDS, &count);
    MesoDetailKind *kinds = names ? MESO_DETAILS_NEW(parser, MesoDetailKind, count) : NULL;
    for (uint32_t i = 0; kinds && i < count && meso_json_good(field); i++) {
        MesoJsonField item = meso_json_key(field, names[i]);
        kinds[i].name = names[i];
        read_kind(parser, &item, &kinds[i]);
    }
    parser->kind_names = names;
    parser->kind_count = kinds ? count : 0;
    details->kinds = kinds;
    details->kind_count = parser->kind_count;
}
