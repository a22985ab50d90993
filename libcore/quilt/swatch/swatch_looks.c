#include "libcore/quilt/swatch/swatch_looks.h"

#include "libcore/base/grow.h"
#include "libcore/base/index_map.h"

/* As meshes are drawn that do not say what they look like. */
static const MesoMaterial PLAIN = {{0.8f, 0.8f, 0.8f}, 0.5f, 0};

static const MesoAttribute *find(const MesoPolygonMesh *mesh, const char *name, uint32_t width)
{
    const MesoAttribute *attribute = meso_polygon_attribute_on(mesh, name, MESO_ON_FACES);
    return attribute && attribute->width == width ? attribute : NULL;
}

/* A number in [0, 1] that a face has; `otherwise` where it has none. */
static float number_of(const MesoAttribute *attribute, uint32_t face, uint32_t component, float otherwise)
{
    uint32_t entry = attribute ? meso_attribute_entry(attribute, face) : MESO_NO_INDEX;
    if (entry == MESO_NO_INDEX)
        return otherwise;
    double x = meso_attribute_number(attribute, entry, component);
    return x > 0 ? (float)fmin(x, 1) : 0;
}

static MesoMaterial look_of(const MesoPolygonMesh *mesh, uint32_t face)
{
    const MesoAttribute *albedo = find(mesh, "albedo", 3);
    MesoMaterial look = PLAIN;
    for (uint32_t c = 0; c < 3; c++)
        look.albedo[c] = number_of(albedo, face, c, look.albedo[c]);
    look.roughness = number_of(find(mesh, "roughness", 1), face, 0, look.roughness);
    look.metallic = number_of(find(mesh, "metallic", 1), face, 0, look.metallic);
    return look;
}

/* What tells materials apart: the number of the name, or a whole number; MESO_NO_INDEX for none. */
static uint32_t key_of(const MesoAttribute *material, uint32_t face)
{
    uint32_t entry = material ? meso_attribute_entry(material, face) : MESO_NO_INDEX;
    if (entry == MESO_NO_INDEX || material->width == 0)
        return entry;
    double value = meso_attribute_number(material, entry, 0);
    return value >= 0 && value < (double)MESO_NO_INDEX ? (uint32_t)value : MESO_NO_INDEX;
}

static const char *name_of(const MesoAttribute *material, uint32_t key, MesoArena *arena, MesoError *error)
{
    if (key == MESO_NO_INDEX)
        return "none";
    return material->width == 0 ? meso_arena_copy_text(arena, material->names[key], error)
                                : meso_arena_print(arena, error, "material %u", key);
}

static MesoStatus add_look(MesoSwatch *swatch, size_t *room, MesoArena *arena, MesoMaterial look, const char *name,
                           MesoError *error)
{
    size_t looks_room = *room;
    swatch->looks = MESO_GROW(arena, swatch->looks, swatch->material_count, looks_room, 8, error);
    swatch->material_names = MESO_GROW(arena, swatch->material_names, swatch->material_count, *room, 8, error);
    if (!swatch->looks || !swatch->material_names || !name)
        return MESO_ERR_MEMORY;
    swatch->looks[swatch->material_count] = look;
    swatch->material_names[swatch->material_count++] = name;
    return MESO_OK;
}

MesoStatus meso_swatch_find_looks(MesoSwatch *swatch, uint32_t *material_of, MesoArena *arena,
                                  const MesoPolygonMesh *mesh, MesoError *error)
{
    const MesoAttribute *material = meso_polygon_attribute_on(mesh, "material", MESO_ON_FACES);
    if (material && material->width > 1)
        material = NULL;
    MesoArena scratch;
    MesoIndexMap numbers = {0};
    MesoStatus status = MESO_OK;
    uint32_t none = MESO_NO_INDEX;
    size_t room = 0;
    meso_arena_init(&scratch);
    swatch->material_count = 0;
    swatch->looks = NULL;
    swatch->material_names = NULL;
    for (uint32_t f = 0; f < mesh->face_count && !status; f++) {
        uint32_t key = key_of(material, f);
        uint32_t *number = key == MESO_NO_INDEX ? &none : meso_index_map_at(&numbers, &scratch, key, error);
        if (!number) {
            status = MESO_ERR_MEMORY;
            break;
        }
        if (*number == MESO_NO_INDEX) {
            *number = swatch->material_count;
            status = add_look(swatch, &room, arena, look_of(mesh, f), name_of(material, key, arena, error), error);
        }
        material_of[f] = *number;
    }
    meso_arena_release(&scratch);
    return status;
}
