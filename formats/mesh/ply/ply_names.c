#include "formats/mesh/ply/ply_names.h"

#include <string.h>

static bool is_nameable(const MesoAttribute *attribute)
{
    return attribute->domain == MESO_ON_FACES && attribute->width == 1 && !attribute->normalized && !attribute->entry_of &&
           attribute->scalar != MESO_SCALAR_FLOAT && attribute->scalar != MESO_SCALAR_DOUBLE;
}

/* How many from 0 on are named; their names go to `names` where there is room. */
static uint32_t find_names(const MesoPly *ply, const char *property, const char **names)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < ply->name_count; i++) {
        const MesoPlyName *name = &ply->names[i];
        if (name->number != count || strcmp(name->property, property) != 0)
            continue;
        if (names)
            names[count] = name->name;
        count++;
    }
    return count;
}

static bool all_have_names(const MesoAttribute *attribute, uint32_t count)
{
    for (uint32_t e = 0; e < attribute->entry_count; e++) {
        double number = meso_attribute_number(attribute, e, 0);
        if (number != -1 && !(number >= 0 && number < count))
            return false;
    }
    return true;
}

static MesoStatus name_attribute(MesoAttribute *attribute, const MesoPly *ply, uint32_t count, MesoArena *arena,
                                 MesoError *error)
{
    MesoAttribute named = {.name = attribute->name, .domain = attribute->domain, .entry_count = count};
    named.names = MESO_NEW(arena, const char *, count, error);
    named.entry_of = MESO_NEW(arena, uint32_t, attribute->entry_count, error);
    if (!named.names || !named.entry_of)
        return MESO_ERR_MEMORY;
    find_names(ply, attribute->name, named.names);
    for (uint32_t e = 0; e < attribute->entry_count; e++) {
        double number = meso_attribute_number(attribute, e, 0);
        named.entry_of[e] = number < 0 ? MESO_NO_INDEX : (uint32_t)number;
    }
    *attribute = named;
    return MESO_OK;
}

MesoStatus meso_ply_name_numbers(const MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < mesh->attribute_count && ply->name_count && !status; i++) {
        MesoAttribute *attribute = &mesh->attributes[i];
        uint32_t count = is_nameable(attribute) ? find_names(ply, attribute->name, NULL) : 0;
        if (count && all_have_names(attribute, count))
            status = name_attribute(attribute, ply, count, arena, error);
    }
    return status;
}
