#include "formats/tiling/tiles/tiles_file.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "formats/tiling/tiles/prototype_json.h"
#include "formats/tiling/tiles/tiles_room.h"
#include "libcore/tiling/tile/tile_set_check.h"

/* What a tile set of ours is read with. The maps go from names to numbers. */
typedef struct Parser {
    MesoTileSet *set;
    MesoJsonReader *reader;
    uint32_t csg_capacity;
    json_t *interfaces;     /* name */
    json_t *sections;       /* "interface number/name" */
} Parser;

static const char *const shape_names[] = {
    [MESO_CSG_DISC] = "disc",
    [MESO_CSG_UNION] = "union",
    [MESO_CSG_DIFFERENCE] = "difference",
    [MESO_CSG_BOX] = "box",
    NULL,
};

static void out_of_memory(MesoJsonReader *reader)
{
    if (!reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
}

/* Nodes that a shape needs: a list of n operands takes n - 1 nodes beside theirs. */
static uint64_t count_below(const json_t *shape, uint32_t nesting)
{
    const char *key;
    json_t *value;
    uint64_t count = 0;
    if (nesting > MESO_CSG_NESTING)
        return 0;
    json_object_foreach((json_t *)shape, key, value) {
        if (meso_json_is_note(key))
            continue;
        size_t operands = json_array_size(value);
        count += operands > 0 ? operands - 1 : 1;
        for (size_t i = 0; i < operands; i++)
            count += count_below(json_array_get(value, i), nesting + 1);
    }
    return count;
}

static uint64_t count_nodes(const json_t *shape)
{
    return count_below(shape, 1);
}

static bool reserve(Parser *parser, const json_t *root)
{
    const json_t *interfaces = json_object_get(root, "interfaces");
    const json_t *tiles = json_object_get(root, "tiles");
    const MesoTilesRoom room = {
        .interfaces = json_array_size(interfaces),
        .sections = meso_tiles_count_items(interfaces, "sections"),
        .csg = meso_tiles_count_nodes(interfaces, "sections", "shape", count_nodes),
        .tiles = json_array_size(tiles),
        .sweeps = meso_tiles_count_items(tiles, "sweeps"),
        .inners = meso_tiles_count_items(tiles, "inner"),
    };
    parser->csg_capacity = (uint32_t)room.csg;
    return meso_tiles_reserve(parser->set, parser->reader, &room);
}

static uint32_t add_node(Parser *parser, const MesoJsonField *field, MesoCsgNode node)
{
    if (parser->set->csg_count >= parser->csg_capacity) {
        meso_json_wrong(field, "not a shape");
        return 0;
    }
    parser->set->csg[parser->set->csg_count] = node;
    return parser->set->csg_count++;
}

static MesoCsgNode read_leaf(const MesoJsonField *field, MesoCsgKind kind)
{
    static const char *const keys[] = {"center", "size", "angle", NULL};
    float center[2] = {0}, size[2] = {0};
    meso_json_object(field, keys);
    MesoJsonField center_field = meso_json_key(field, "center"), size_field = meso_json_key(field, "size");
    MesoJsonField angle_field = meso_json_key(field, "angle");
    meso_json_require(&center_field);
    meso_json_require(&size_field);
    meso_json_floats(&center_field, 2, center);
    meso_json_floats(&size_field, 2, size);
    return (MesoCsgNode){
        .kind = kind,
        .center = {center[0], center[1]},
        .size = {size[0], size[1]},
        .angle = meso_json_float(&angle_field, 0),
    };
}

/* Keys but for notes. */
static size_t count_keys(const json_t *object)
{
    const char *key;
    json_t *value;
    size_t count = 0;
    json_object_foreach((json_t *)object, key, value)
        count += !meso_json_is_note(key);
    return count;
}

static uint32_t read_shape(Parser *parser, const MesoJsonField *field, uint32_t nesting)
{
    if (!meso_json_object(field, shape_names))
        return 0;
    if (count_keys(field->value) != 1) {
        meso_json_wrong(field, "exactly one of \"disc\", \"box\", \"union\", \"difference\" is needed");
        return 0;
    }
    if (nesting > MESO_CSG_NESTING) {
        meso_json_wrong(field, "more than %d shapes within each other", MESO_CSG_NESTING);
        return 0;
    }
    MesoCsgKind kind = MESO_CSG_DISC;
    while (shape_names[kind] && !json_object_get(field->value, shape_names[kind]))
        kind++;
    if (!shape_names[kind])     /* another key, which has been reported */
        return 0;
    MesoJsonField content = meso_json_key(field, shape_names[kind]);
    if (kind == MESO_CSG_DISC || kind == MESO_CSG_BOX)
        return add_node(parser, &content, read_leaf(&content, kind));

    uint32_t count = meso_json_count(&content, 2, MESO_TILES_ITEMS);
    uint32_t node = 0;
    for (uint32_t i = 0; i < count && meso_json_good(field); i++) {
        MesoJsonField operand = meso_json_item(&content, i);
        uint32_t right = read_shape(parser, &operand, nesting + 1);
        node = i == 0 ? right
                      : add_node(parser, &operand,
                                 (MesoCsgNode){.kind = kind, .left = node, .right = right});
    }
    return node;
}

static MesoMaterial read_material(const MesoJsonField *field, const float default_albedo[3])
{
    MesoJsonField albedo = meso_json_key(field, "albedo");
    MesoJsonField roughness = meso_json_key(field, "roughness");
    MesoJsonField metallic = meso_json_key(field, "metallic");
    MesoMaterial material;
    memcpy(material.albedo, default_albedo, sizeof material.albedo);
    meso_json_floats(&albedo, 3, material.albedo);
    material.roughness = meso_json_float(&roughness, MESO_DEFAULT_ROUGHNESS);
    material.metallic = meso_json_float(&metallic, 0);
    return material;
}

/* The first of that name counts; the check reports the others. */
static void remember(Parser *parser, json_t *map, const char *name, uint32_t number)
{
    if (!json_object_get(map, name) && json_object_set_new(map, name, json_integer(number)) != 0)
        out_of_memory(parser->reader);
}

static uint32_t look_up(const json_t *map, const char *name)
{
    const json_t *number = json_object_get(map, name);
    return number ? (uint32_t)json_integer_value(number) : MESO_NO_INDEX;
}

/* Key of a cross-section in the map, in the arena for a moment. */
static char *section_key(Parser *parser, uint32_t interface, const char *name)
{
    char *key = meso_arena_print(parser->reader->arena, parser->reader->error, "%u/%s", interface, name);
    if (!key)
        out_of_memory(parser->reader);
    return key;
}

static void read_section(Parser *parser, const MesoJsonField *field, const MesoInterface *interface)
{
    static const char *const keys[] = {"name", "albedo", "roughness", "metallic", "shape", NULL};
    MesoTileSet *set = parser->set;
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField name = meso_json_key(field, "name"), shape = meso_json_key(field, "shape");
    uint32_t s = set->section_count++;
    set->sections[s] = (MesoSection){
        .name = meso_json_text(&name),
        .interface = set->interface_count,
        .material = read_material(field, interface->color),
        .csg_root = read_shape(parser, &shape, 1),
    };
    MesoArenaMark mark = meso_arena_mark(parser->reader->arena);
    char *key = section_key(parser, set->interface_count, set->sections[s].name);
    if (key)
        remember(parser, parser->sections, key, s);
    meso_arena_rewind(parser->reader->arena, mark);
}

static void read_border(MesoInterface *interface, const MesoJsonField *field)
{
    if (!field->value)
        return;
    const char *border = meso_json_text(field);
    interface->border_exempt = strcmp(border, "exempt") == 0;
    interface->border_only = strcmp(border, "only") == 0;
    if (!interface->border_exempt && !interface->border_only && strcmp(border, "any") != 0)
        meso_json_wrong(field, "\"%.40s\"; \"any\", \"exempt\" and \"only\" are possible", border);
}

static void read_interface(Parser *parser, const MesoJsonField *field)
{
    static const char *const keys[] = {"name", "color", "border", "sections", NULL};
    MesoTileSet *set = parser->set;
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField name = meso_json_key(field, "name"), color = meso_json_key(field, "color");
    MesoJsonField border = meso_json_key(field, "border"), sections = meso_json_key(field, "sections");
    MesoInterface *interface = &set->interfaces[set->interface_count];
    *interface = (MesoInterface){
        .name = meso_json_text(&name),
        .section_begin = set->section_count,
        .section_count = meso_json_count(&sections, 0, MESO_TILES_ITEMS),
        .color = {MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO},
    };
    meso_json_floats(&color, 3, interface->color);
    read_border(interface, &border);
    for (uint32_t k = 0; k < interface->section_count && meso_json_good(field); k++) {
        MesoJsonField section = meso_json_item(&sections, k);
        read_section(parser, &section, interface);
    }
    remember(parser, parser->interfaces, interface->name, set->interface_count++);
}

/* "a", or "a'" flipped; null for none. */
static int32_t read_label(const Parser *parser, const MesoJsonField *field)
{
    if (!field->value || json_is_null(field->value))
        return 0;
    MesoJsonReader *reader = parser->reader;
    MesoArenaMark mark = meso_arena_mark(reader->arena);
    const char *text = meso_json_text(field);
    size_t length = strlen(text);
    bool flipped = length > 0 && text[length - 1] == '\'';
    char *name = meso_arena_print(reader->arena, reader->error, "%.*s",
                                  (int)(length < INT_MAX ? length - flipped : 0), text);
    uint32_t interface = name ? look_up(parser->interfaces, name) : 0;
    if (!name)
        out_of_memory(reader);
    else if (interface == MESO_NO_INDEX)
        meso_json_wrong(field, "unknown interface '%.80s'; its name must be among \"interfaces\"", name);
    meso_arena_rewind(reader->arena, mark);
    int32_t label = meso_json_good(field) ? (int32_t)interface + 1 : 0;
    return flipped ? -label : label;
}

/* "side/cross-section" */
static void read_end(Parser *parser, const MesoJsonField *field, const MesoTile *tile,
                     uint32_t *side, uint32_t *section)
{
    MesoArena *arena = parser->reader->arena;
    MesoArenaMark mark = meso_arena_mark(arena);
    const char *text = meso_json_text(field);
    if (!meso_json_good(field))
        return;
    if (text[0] < '0' || text[0] > '5' || text[1] != '/') {
        meso_json_wrong(field, "\"%.80s\"; a side from 0 to 5, a slash and the name of a "
                        "cross-section are needed, like \"0/1\"", text);
        return;
    }
    *side = (uint32_t)(text[0] - '0');
    int32_t label = *side < tile->side_count ? tile->labels[*side] : 0;
    if (label == 0) {
        meso_json_wrong(field, "side %u of the tile shows no interface", *side);
        return;
    }
    uint32_t interface = meso_label_interface(label);
    char *key = section_key(parser, interface, text + 2);
    *section = key ? look_up(parser->sections, key) : 0;
    if (*section == MESO_NO_INDEX)
        meso_json_wrong(field, "unknown cross-section '%.80s'; side %u shows interface '%.80s'",
                        text + 2, *side, parser->set->interfaces[interface].name);
    meso_arena_rewind(arena, mark);
}

static float read_number(const MesoJsonField *object, const char *key)
{
    MesoJsonField field = meso_json_key(object, key);
    return meso_json_float(&field, 0);
}

static void read_sweep(Parser *parser, const MesoJsonField *field, const MesoTile *tile)
{
    static const char *const keys[] = {"from", "to", "half_turn", "turn", "turns", "tangent_scale", NULL};
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField from = meso_json_key(field, "from"), to = meso_json_key(field, "to");
    MesoJsonField half_turn = meso_json_key(field, "half_turn"), turn = meso_json_key(field, "turn");
    MesoJsonField turns = meso_json_key(field, "turns");
    MesoSweep *sweep = &parser->set->sweeps[parser->set->sweep_count++];
    read_end(parser, &from, tile, &sweep->from_side, &sweep->from_section);
    read_end(parser, &to, tile, &sweep->to_side, &sweep->to_section);
    sweep->half_turn = meso_json_bool(&half_turn, false);
    sweep->turn = meso_json_float(&turn, 0);
    sweep->turns = (int32_t)meso_json_whole(&turns, INT32_MIN, INT32_MAX, 0);
    sweep->tangent_scale = read_number(field, "tangent_scale");
}

static void read_inner(Parser *parser, const MesoJsonField *field)
{
    static const char *const keys[] = {"mesh", "transform", "albedo", "roughness", "metallic", NULL};
    static const float grey[3] = {MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO};
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField mesh = meso_json_key(field, "mesh"), transform = meso_json_key(field, "transform");
    MesoInnerMesh *inner = &parser->set->inners[parser->set->inner_count++];
    *inner = (MesoInnerMesh){
        .file = meso_json_text(&mesh),
        .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
        .material = read_material(field, grey),
    };
    meso_json_floats(&transform, 12, inner->transform);
}

static bool read_flag(const MesoJsonField *field, const char *key, bool fallback)
{
    MesoJsonField flag = meso_json_key(field, key);
    return meso_json_bool(&flag, fallback);
}

static void read_sides(Parser *parser, const MesoJsonField *field, MesoTile *tile)
{
    MesoJsonField sides = meso_json_key(field, "sides");
    tile->side_count = meso_json_count(&sides, 4, MESO_SIDE_COUNT);
    if (tile->side_count == 5)
        meso_json_wrong(&sides, "5 items; 4, or 6 with top and bottom, are possible");
    for (uint32_t side = 0; side < tile->side_count && meso_json_good(field); side++) {
        MesoJsonField label = meso_json_item(&sides, side);
        tile->labels[side] = read_label(parser, &label);
    }
}

static void read_tile(Parser *parser, const MesoJsonField *field)
{
    static const char *const keys[] = {"name", "sides", "rotation", "flip_x", "flip_y", "ignored",
                                       "tangent_scale", "sweeps", "inner", NULL};
    MesoTileSet *set = parser->set;
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField name = meso_json_key(field, "name");
    MesoJsonField sweeps = meso_json_key(field, "sweeps"), inners = meso_json_key(field, "inner");
    MesoTile *tile = &set->tiles[set->tile_count++];
    *tile = (MesoTile){
        .name = meso_json_text(&name),
        .sweep_begin = set->sweep_count,
        .sweep_count = meso_json_count(&sweeps, 0, MESO_TILES_ITEMS),
        .inner_begin = set->inner_count,
        .inner_count = meso_json_count(&inners, 0, MESO_TILES_ITEMS),
        .rotation = read_flag(field, "rotation", set->default_rotation),
        .flip_x = read_flag(field, "flip_x", set->default_flip_x),
        .flip_y = read_flag(field, "flip_y", set->default_flip_y),
        .ignored = read_flag(field, "ignored", false),
        .tangent_scale = read_number(field, "tangent_scale"),
    };
    read_sides(parser, field, tile);
    for (uint32_t i = 0; i < tile->sweep_count && meso_json_good(field); i++) {
        MesoJsonField sweep = meso_json_item(&sweeps, i);
        read_sweep(parser, &sweep, tile);
    }
    for (uint32_t i = 0; i < tile->inner_count && meso_json_good(field); i++) {
        MesoJsonField inner = meso_json_item(&inners, i);
        read_inner(parser, &inner);
    }
}

static void read_defaults(MesoTileSet *set, const MesoJsonField *root)
{
    static const char *const keys[] = {"rotation", "flip_x", "flip_y", NULL};
    MesoJsonField defaults = meso_json_key(root, "defaults");
    if (!defaults.value || !meso_json_object(&defaults, keys))
        return;
    set->default_rotation = read_flag(&defaults, "rotation", false);
    set->default_flip_x = read_flag(&defaults, "flip_x", false);
    set->default_flip_y = read_flag(&defaults, "flip_y", false);
}

static void read_set(Parser *parser, const MesoJsonField *root)
{
    static const char *const keys[] = {"format", "version", "provenance", "defaults", "interfaces",
                                       "tiles", NULL};
    if (!meso_json_object(root, keys))
        return;
    MesoJsonField interfaces = meso_json_key(root, "interfaces"), tiles = meso_json_key(root, "tiles");
    uint32_t interface_count = meso_json_count(&interfaces, 1, MESO_TILES_ITEMS);
    uint32_t tile_count = meso_json_count(&tiles, 1, MESO_TILES_ITEMS);
    if (!meso_json_good(root) || !reserve(parser, root->value))
        return;
    read_defaults(parser->set, root);
    for (uint32_t i = 0; i < interface_count && meso_json_good(root); i++) {
        MesoJsonField interface = meso_json_item(&interfaces, i);
        read_interface(parser, &interface);
    }
    for (uint32_t t = 0; t < tile_count && meso_json_good(root); t++) {
        MesoJsonField tile = meso_json_item(&tiles, t);
        read_tile(parser, &tile);
    }
}

static void parse_ours(MesoTileSet *set, MesoJsonReader *reader, const json_t *root)
{
    reader->status = meso_json_check_format(root, reader->path, "meso-tiles", MESO_TILES_VERSION,
                                            reader->error);
    if (reader->status)
        return;
    Parser parser = {
        .set = set,
        .reader = reader,
        .interfaces = json_object(),
        .sections = json_object(),
    };
    MesoJsonField field = meso_json_root(reader, root);
    if (parser.interfaces && parser.sections)
        read_set(&parser, &field);
    else
        out_of_memory(reader);
    json_decref(parser.interfaces);
    json_decref(parser.sections);
}

/* Of either kind; `warn` hears of what the prototype's files have and we have not. */
static MesoStatus read_any(MesoTileSet *set, MesoJsonReader *reader, const json_t *root,
                           MesoProblemReport *warn, void *context)
{
    *set = (MesoTileSet){0};
    if (json_object_get(root, "format"))
        parse_ours(set, reader, root);
    else if (meso_prototype_recognise(root))
        meso_prototype_parse(set, reader, root, warn, context);
    else
        return meso_fail(reader->error, MESO_ERR_INPUT, "%s: not a tile set: neither \"format\": "
                         "\"meso-tiles\" nor the prototype's \"tileTypes\" and \"edgeTypes\"", reader->path);
    return reader->status;
}

MesoStatus meso_tiles_import(MesoTileSet *set, MesoArena *arena, const json_t *root, const char *path,
                             MesoProblemReport *report, void *context, MesoError *error)
{
    MesoJsonReader reader = {.path = path, .arena = arena, .error = error};
    return read_any(set, &reader, root, report, context);
}

MesoStatus meso_tiles_from_json(MesoTileSet *set, MesoArena *arena, const json_t *root,
                                const char *path, MesoError *error)
{
    return meso_tiles_import(set, arena, root, path, NULL, NULL, error);
}

MesoStatus meso_tiles_parse(MesoTileSet *set, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    json_t *root;
    MesoStatus status = meso_json_parse(&root, input, error);
    if (!status)
        status = meso_tiles_from_json(set, arena, root, input->path, error);
    json_decref(root);
    return status;
}

MesoStatus meso_tiles_survey(MesoTileSet *set, MesoArena *arena, const MesoInput *input,
                             MesoProblemReport *report, void *context, MesoError *error)
{
    json_t *root;
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error,
                             .report = report, .report_context = context};
    MesoStatus status = meso_json_parse(&root, input, error);
    if (!status)
        status = read_any(set, &reader, root, report, context);
    if (!status && reader.reported)
        status = meso_fail(error, MESO_ERR_INPUT, "%s", "");
    json_decref(root);
    return status;
}

/* Keeps the first error of the check. */
typedef struct FirstError {
    const char *path;
    MesoError *error;
    bool found;
} FirstError;

static void keep_first(void *context, const char *severity, const char *where, const char *message)
{
    FirstError *first = context;
    if (first->found || strcmp(severity, "error") != 0)
        return;
    first->found = true;
    meso_fail(first->error, MESO_ERR_INPUT, "%s: %s: %s", first->path, where, message);
}

MesoStatus meso_tiles_read(MesoTileSet *set, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoStatus status = meso_tiles_parse(set, arena, input, error);
    if (status)
        return status;
    uint32_t error_count;
    FirstError first = {.path = input->path, .error = error};
    status = meso_tile_set_check(&error_count, set, keep_first, &first, error);
    return !status && error_count > 0 ? MESO_ERR_INPUT : status;
}
