#include "formats/tiling/tiles/tiles_file.h"

#include <math.h>
#include <string.h>

#include "formats/json/json_text.h"
#include "formats/tiling/tiles/tiles_room.h"

/* JSON that grows key by key; `failed` when memory is out. */
typedef struct Writer {
    const MesoTileSet *set;
    bool failed;
} Writer;

static void put(Writer *writer, json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) != 0)
        writer->failed = true;
}

static void append(Writer *writer, json_t *array, json_t *value)
{
    if (json_array_append_new(array, value) != 0)
        writer->failed = true;
}

/* Whole numbers stay whole. */
static json_t *number(float value)
{
    if (value == truncf(value) && fabsf(value) < 1e6f)
        return json_integer((json_int_t)value);
    return meso_json_shortest(value);
}

static json_t *numbers(Writer *writer, const float *values, uint32_t count)
{
    json_t *array = json_array();
    for (uint32_t i = 0; i < count; i++)
        append(writer, array, number(values[i]));
    return array;
}

static json_t *pair(Writer *writer, MesoVec2 v)
{
    const float values[2] = {v.x, v.y};
    return numbers(writer, values, 2);
}

static json_t *write_leaf(Writer *writer, const MesoCsgNode *node)
{
    json_t *leaf = json_object();
    put(writer, leaf, "center", pair(writer, node->center));
    put(writer, leaf, "size", pair(writer, node->size));
    if (node->angle != 0)
        put(writer, leaf, "angle", number(node->angle));
    return leaf;
}

/* A chain (a + b) + c becomes one list; `nesting` guards the stack. */
static json_t *write_shape(Writer *writer, uint32_t n, uint32_t nesting)
{
    static const char *const names[] = {
        [MESO_CSG_DISC] = "disc",
        [MESO_CSG_UNION] = "union",
        [MESO_CSG_DIFFERENCE] = "difference",
        [MESO_CSG_BOX] = "box",
    };
    const MesoCsgNode *csg = writer->set->csg;
    MesoCsgKind kind = csg[n].kind;
    json_t *shape = json_object();
    if (nesting > MESO_CSG_NESTING) {
        writer->failed = true;
        return shape;
    }
    if (kind == MESO_CSG_DISC || kind == MESO_CSG_BOX) {
        put(writer, shape, names[kind], write_leaf(writer, &csg[n]));
        return shape;
    }

    json_t *operands = json_array();
    size_t count = 1;
    for (uint32_t left = n; csg[left].kind == kind; left = csg[left].left)
        count++;
    for (size_t i = 0; i < count; i++)
        append(writer, operands, json_null());
    for (size_t i = count; i-- > 0; n = csg[n].left) {
        json_t *operand = write_shape(writer, i > 0 ? csg[n].right : n, nesting + 1);
        if (json_array_set_new(operands, i, operand) != 0)
            writer->failed = true;
    }
    put(writer, shape, names[kind], operands);
    return shape;
}

static void put_material(Writer *writer, json_t *object, const MesoMaterial *material,
                         const float default_albedo[3])
{
    if (memcmp(material->albedo, default_albedo, sizeof material->albedo) != 0)
        put(writer, object, "albedo", numbers(writer, material->albedo, 3));
    if (material->roughness != MESO_DEFAULT_ROUGHNESS)
        put(writer, object, "roughness", number(material->roughness));
    if (material->metallic != 0)
        put(writer, object, "metallic", number(material->metallic));
}

static json_t *write_interface(Writer *writer, const MesoInterface *interface)
{
    json_t *object = json_object(), *sections = json_array();
    put(writer, object, "name", json_string(interface->name));
    put(writer, object, "color", numbers(writer, interface->color, 3));
    if (interface->border_exempt || interface->border_only)
        put(writer, object, "border", json_string(interface->border_exempt ? "exempt" : "only"));
    for (uint32_t k = 0; k < interface->section_count; k++) {
        const MesoSection *section = &writer->set->sections[interface->section_begin + k];
        json_t *item = json_object();
        put(writer, item, "name", json_string(section->name));
        put_material(writer, item, &section->material, interface->color);
        put(writer, item, "shape", write_shape(writer, section->csg_root, 1));
        append(writer, sections, item);
    }
    put(writer, object, "sections", sections);
    return object;
}

static json_t *write_side(const MesoTileSet *set, int32_t label)
{
    if (label == 0)
        return json_null();
    const char *name = set->interfaces[meso_label_interface(label)].name;
    return json_sprintf("%s%s", name, meso_label_mark(label));
}

static json_t *write_sweep(Writer *writer, const MesoSweep *sweep)
{
    const MesoSection *sections = writer->set->sections;
    json_t *object = json_object();
    put(writer, object, "from", json_sprintf("%u/%s", sweep->from_side, sections[sweep->from_section].name));
    put(writer, object, "to", json_sprintf("%u/%s", sweep->to_side, sections[sweep->to_section].name));
    if (sweep->half_turn)
        put(writer, object, "half_turn", json_true());
    if (sweep->turn != 0)
        put(writer, object, "turn", number(sweep->turn));
    if (sweep->turns != 0)
        put(writer, object, "turns", json_integer(sweep->turns));
    if (sweep->tangent_scale != 0)
        put(writer, object, "tangent_scale", number(sweep->tangent_scale));
    return object;
}

static json_t *write_inner(Writer *writer, const MesoInnerMesh *inner)
{
    static const float albedo[3] = {MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO};
    json_t *object = json_object();
    put(writer, object, "mesh", json_string(inner->file));
    put(writer, object, "transform", numbers(writer, inner->transform, 12));
    put_material(writer, object, &inner->material, albedo);
    return object;
}

static void put_flag(Writer *writer, json_t *object, const char *key, bool value, bool default_value)
{
    if (value != default_value)
        put(writer, object, key, json_boolean(value));
}

static json_t *write_tile(Writer *writer, const MesoTile *tile)
{
    const MesoTileSet *set = writer->set;
    json_t *object = json_object(), *sides = json_array();
    put(writer, object, "name", json_string(tile->name));
    for (uint32_t side = 0; side < tile->side_count; side++)
        append(writer, sides, write_side(set, tile->labels[side]));
    put(writer, object, "sides", sides);
    put_flag(writer, object, "rotation", tile->rotation, set->default_rotation);
    put_flag(writer, object, "flip_x", tile->flip_x, set->default_flip_x);
    put_flag(writer, object, "flip_y", tile->flip_y, set->default_flip_y);
    put_flag(writer, object, "ignored", tile->ignored, false);
    if (tile->tangent_scale != 0)
        put(writer, object, "tangent_scale", number(tile->tangent_scale));

    json_t *sweeps = json_array();
    for (uint32_t i = 0; i < tile->sweep_count; i++)
        append(writer, sweeps, write_sweep(writer, &set->sweeps[tile->sweep_begin + i]));
    put(writer, object, "sweeps", sweeps);
    if (tile->inner_count == 0)
        return object;
    json_t *inners = json_array();
    for (uint32_t i = 0; i < tile->inner_count; i++)
        append(writer, inners, write_inner(writer, &set->inners[tile->inner_begin + i]));
    put(writer, object, "inner", inners);
    return object;
}

json_t *meso_tiles_to_json(const MesoTileSet *set)
{
    Writer writer = {.set = set};
    json_t *root = json_object(), *defaults = json_object();
    json_t *interfaces = json_array(), *tiles = json_array();

    put(&writer, root, "format", json_string("meso-tiles"));
    put(&writer, root, "version", json_integer(MESO_TILES_VERSION));
    put(&writer, defaults, "rotation", json_boolean(set->default_rotation));
    put(&writer, defaults, "flip_x", json_boolean(set->default_flip_x));
    put(&writer, defaults, "flip_y", json_boolean(set->default_flip_y));
    put(&writer, root, "defaults", defaults);
    for (uint32_t i = 0; i < set->interface_count; i++)
        append(&writer, interfaces, write_interface(&writer, &set->interfaces[i]));
    put(&writer, root, "interfaces", interfaces);
    for (uint32_t t = 0; t < set->tile_count; t++)
        append(&writer, tiles, write_tile(&writer, &set->tiles[t]));
    put(&writer, root, "tiles", tiles);

    if (!writer.failed)
        return root;
    json_decref(root);
    return NULL;
}
