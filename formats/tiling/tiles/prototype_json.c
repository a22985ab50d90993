#include "formats/tiling/tiles/prototype_json.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "formats/tiling/tiles/tiles_room.h"
#include "libcore/tiling/tile/tile_set_check.h"

enum { DISC, UNION, DIFFERENCE, BOX, NODE_TYPES, DEEPEST_SHAPE = 256 };

typedef struct Importer {
    MesoTileSet *set;
    MesoJsonReader *reader;
    MesoProblemReport *report;
    void *context;
    uint32_t csg_capacity;
} Importer;

bool meso_prototype_recognise(const json_t *root)
{
    return json_object_get(root, "tileTypes") && json_object_get(root, "edgeTypes");
}

__attribute__((format(printf, 3, 4)))
static void warn(const Importer *importer, const MesoJsonField *field, const char *format, ...)
{
    if (!importer->report)
        return;
    char place[160], message[256];
    meso_json_place(field, place, sizeof place);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    importer->report(importer->context, "warning", place, message);
}

/* The prototype skips keys that it does not know; so do we, but not in silence. */
static void expect_keys(const Importer *importer, const MesoJsonField *field, const char *const *keys)
{
    if (!meso_json_object(field, NULL))
        return;
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)field->value, key, value) {
        uint32_t k = 0;
        while (keys[k] && strcmp(keys[k], key) != 0)
            k++;
        if (!keys[k])
            warn(importer, field, "unknown key \"%.40s\" is left out", key);
    }
}

static const char *make_name(const Importer *importer, const char *prefix, uint32_t number)
{
    MesoJsonReader *reader = importer->reader;
    const char *name = meso_arena_print(reader->arena, reader->error, "%s%u", prefix, number);
    if (!name)
        reader->status = MESO_ERR_MEMORY;
    return name ? name : "";
}

/* a to z, then i27, i28, ... */
static const char *make_interface_name(const Importer *importer, uint32_t i)
{
    if (i >= 26)
        return make_name(importer, "i", i + 1);
    char letter[2] = {(char)('a' + i), '\0'};
    MesoJsonReader *reader = importer->reader;
    const char *name = meso_arena_copy_text(reader->arena, letter, reader->error);
    if (!name)
        reader->status = MESO_ERR_MEMORY;
    return name ? name : "";
}

static uint64_t count_below(const json_t *csg, uint32_t depth)
{
    const json_t *left = json_object_get(csg, "lhs"), *right = json_object_get(csg, "rhs");
    if (depth > DEEPEST_SHAPE)
        return 0;
    return 1 + (left ? count_below(left, depth + 1) : 0) + (right ? count_below(right, depth + 1) : 0);
}

static uint64_t count_nodes(const json_t *csg)
{
    return count_below(csg, 1);
}

static bool reserve(Importer *importer, const json_t *root)
{
    const json_t *interfaces = json_object_get(root, "edgeTypes");
    const json_t *tiles = json_object_get(root, "tileTypes");
    const MesoTilesRoom room = {
        .interfaces = json_array_size(interfaces),
        .sections = meso_tiles_count_items(interfaces, "shapes"),
        .csg = meso_tiles_count_nodes(interfaces, "shapes", "csg", count_nodes) +
               meso_tiles_count_items(interfaces, "shapes"),    /* a disc for each that has no tree */
        .tiles = json_array_size(tiles),
        .sweeps = meso_tiles_count_items(tiles, "innerPaths"),
        .inners = meso_tiles_count_items(tiles, "innerGeometry"),
    };
    importer->csg_capacity = (uint32_t)room.csg;
    return meso_tiles_reserve(importer->set, importer->reader, &room);
}

static MesoVec2 read_pair(const MesoJsonField *field, const char *key)
{
    float values[2] = {0};
    MesoJsonField pair = meso_json_key(field, key);
    meso_json_require(&pair);
    meso_json_floats(&pair, 2, values);
    return (MesoVec2){values[0], values[1]};
}

/* Older files give a disc's "radius"; the prototype itself reads it as the size along both axes, and so wrote such
 * files anew. */
static MesoVec2 read_size(const MesoJsonField *field, bool disc)
{
    MesoJsonField radius = meso_json_key(field, "radius");
    if (!disc || !radius.value || json_object_get(field->value, "size"))
        return read_pair(field, "size");
    float size = meso_json_float(&radius, 0);
    return (MesoVec2){size, size};
}

static uint32_t read_shape(Importer *importer, const MesoJsonField *field, uint32_t depth)
{
    static const char *const leaf_keys[] = {"node-type", "center", "size", "angle", NULL};
    static const char *const disc_keys[] = {"node-type", "center", "size", "angle", "radius", NULL};
    static const char *const pair_keys[] = {"node-type", "lhs", "rhs", NULL};
    static const MesoCsgKind kinds[NODE_TYPES] = {
        [DISC] = MESO_CSG_DISC,
        [UNION] = MESO_CSG_UNION,
        [DIFFERENCE] = MESO_CSG_DIFFERENCE,
        [BOX] = MESO_CSG_BOX,
    };
    MesoTileSet *set = importer->set;
    if (!meso_json_object(field, NULL))
        return 0;
    if (depth > DEEPEST_SHAPE || set->csg_count >= importer->csg_capacity) {
        meso_json_wrong(field, "more than %d shapes within each other", DEEPEST_SHAPE);
        return 0;
    }
    MesoJsonField type_field = meso_json_key(field, "node-type");
    meso_json_require(&type_field);
    int64_t type = meso_json_whole(&type_field, 0, NODE_TYPES - 1, DISC);
    MesoCsgNode node = {.kind = kinds[type]};
    if (type == UNION || type == DIFFERENCE) {
        MesoJsonField left = meso_json_key(field, "lhs"), right = meso_json_key(field, "rhs");
        expect_keys(importer, field, pair_keys);
        node.left = read_shape(importer, &left, depth + 1);
        node.right = read_shape(importer, &right, depth + 1);
    } else {
        MesoJsonField angle = meso_json_key(field, "angle");
        expect_keys(importer, field, type == DISC ? disc_keys : leaf_keys);
        node.center = read_pair(field, "center");
        node.size = read_size(field, type == DISC);
        node.angle = meso_json_float(&angle, 0);
    }
    if (!meso_json_good(field))
        return 0;
    set->csg[set->csg_count] = node;
    return set->csg_count++;
}

/* Red, green, blue, and an opacity that we do not have. */
static void read_color(Importer *importer, const MesoJsonField *field, float color[3])
{
    if (!field->value)
        return;
    if (meso_json_count(field, 3, 4) == 4) {
        MesoJsonField alpha = meso_json_item(field, 3);
        if (meso_json_float(&alpha, 1) != 1)
            warn(importer, field, "opacity is left out; everything is opaque");
    }
    for (uint32_t i = 0; i < 3; i++) {
        MesoJsonField item = meso_json_item(field, i);
        color[i] = meso_json_float(&item, color[i]);
    }
}

static MesoMaterial read_material(Importer *importer, const MesoJsonField *field,
                                  const float default_albedo[3])
{
    MesoJsonField color = meso_json_key(field, "color");
    MesoJsonField roughness = meso_json_key(field, "roughness");
    MesoJsonField metallic = meso_json_key(field, "metallic");
    MesoMaterial material;
    memcpy(material.albedo, default_albedo, sizeof material.albedo);
    read_color(importer, &color, material.albedo);
    material.roughness = meso_json_float(&roughness, MESO_DEFAULT_ROUGHNESS);
    material.metallic = meso_json_float(&metallic, 0);
    return material;
}

/*
 * The oldest files are of flat tiles: a shape is the part of the side from
 * "start" to "end", in [0,1]. It becomes a disc as wide, in mid-height.
 */
static uint32_t read_interval(Importer *importer, const MesoJsonField *field)
{
    MesoJsonField start = meso_json_key(field, "start"), end = meso_json_key(field, "end");
    meso_json_require(&start);
    meso_json_require(&end);
    float from = meso_json_float(&start, 0), to = meso_json_float(&end, 0), width = fabsf(to - from);
    MesoTileSet *set = importer->set;
    if (!meso_json_good(field) || set->csg_count >= importer->csg_capacity)
        return 0;
    set->csg[set->csg_count] = (MesoCsgNode){.kind = MESO_CSG_DISC, .center = {from + 0.5f * (to - from), 0.5f},
                                             .size = {width, width}};
    return set->csg_count++;
}

static bool is_interval(const json_t *shape)
{
    return !json_object_get(shape, "csg") && (json_object_get(shape, "start") || json_object_get(shape, "end"));
}

static void read_section(Importer *importer, const MesoJsonField *field, const MesoInterface *interface,
                         uint32_t number)
{
    static const char *const keys[] = {"csg", "color", "roughness", "metallic", NULL};
    static const char *const flat_keys[] = {"start", "end", "color", "roughness", "metallic", NULL};
    MesoTileSet *set = importer->set;
    bool flat = is_interval(field->value);
    expect_keys(importer, field, flat ? flat_keys : keys);
    MesoJsonField csg = meso_json_key(field, "csg");
    MesoSection *section = &set->sections[set->section_count++];
    section->name = make_name(importer, "", number);
    section->interface = set->interface_count;
    section->material = read_material(importer, field, interface->color);
    section->csg_root = flat ? read_interval(importer, field) : read_shape(importer, &csg, 1);
}

static void read_interface(Importer *importer, const MesoJsonField *field)
{
    /* "isExplicit" tells the prototype's window what to list; it has no meaning in a file. */
    static const char *const keys[] = {"shapes", "isExplicit", "borderEdge", "borderOnly", "color", NULL};
    MesoTileSet *set = importer->set;
    expect_keys(importer, field, keys);
    MesoJsonField color = meso_json_key(field, "color"), shapes = meso_json_key(field, "shapes");
    MesoJsonField border = meso_json_key(field, "borderEdge"), only = meso_json_key(field, "borderOnly");
    MesoInterface *interface = &set->interfaces[set->interface_count];
    *interface = (MesoInterface){
        .name = make_interface_name(importer, set->interface_count),
        .section_begin = set->section_count,
        .section_count = meso_json_count(&shapes, 0, MESO_TILES_ITEMS),
        .color = {MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO},
        .border_exempt = !meso_json_bool(&border, true),
        .border_only = meso_json_bool(&only, false),
    };
    read_color(importer, &color, interface->color);
    for (uint32_t k = 0; k < interface->section_count && meso_json_good(field); k++) {
        MesoJsonField shape = meso_json_item(&shapes, k);
        read_section(importer, &shape, interface, k + 1);
    }
    set->interface_count++;
}

static int32_t read_label(Importer *importer, const MesoJsonField *field)
{
    static const char *const keys[] = {"tileEdgeIndex", "transform", NULL};
    static const char *const transform_keys[] = {"flipped", NULL};
    expect_keys(importer, field, keys);
    MesoJsonField index = meso_json_key(field, "tileEdgeIndex");
    MesoJsonField transform = meso_json_key(field, "transform");
    if (transform.value)
        expect_keys(importer, &transform, transform_keys);
    MesoJsonField flipped = meso_json_key(&transform, "flipped");
    meso_json_require(&index);
    int64_t interface = meso_json_whole(&index, -1, (int64_t)importer->set->interface_count - 1, -1);
    int32_t label = (int32_t)interface + 1;
    return meso_json_bool(&flipped, false) ? -label : label;
}

/* The prototype crashes on a cross-section that is not there. */
static void read_end(Importer *importer, const MesoJsonField *sweep, const char *side_key,
                     const char *shape_key, const MesoTile *tile, uint32_t *side, uint32_t *section)
{
    const MesoTileSet *set = importer->set;
    MesoJsonField side_field = meso_json_key(sweep, side_key);
    MesoJsonField shape_field = meso_json_key(sweep, shape_key);
    meso_json_require(&side_field);
    meso_json_require(&shape_field);
    *side = (uint32_t)meso_json_whole(&side_field, 0, (int64_t)tile->side_count - 1, 0);
    int64_t shape = meso_json_whole(&shape_field, 0, INT32_MAX, 0);
    if (!meso_json_good(sweep))
        return;
    int32_t label = tile->labels[*side];
    if (label == 0) {
        meso_json_wrong(&side_field, "side %u of the tile shows no interface", *side);
        return;
    }
    const MesoInterface *interface = &set->interfaces[meso_label_interface(label)];
    if (shape >= interface->section_count)
        meso_json_wrong(&shape_field, "there is no shape %lld; side %u shows edge type %u, which has %u",
                        (long long)shape, *side, meso_label_interface(label), interface->section_count);
    *section = interface->section_begin + (uint32_t)shape;
}

static void read_sweep(Importer *importer, const MesoJsonField *field, const MesoTile *tile)
{
    /* "flipEnd" has no effect in the prototype either. */
    static const char *const keys[] = {"shapeFrom", "shapeTo", "tileEdgeFrom", "tileEdgeTo",
                                       "addHalfTurn", "assignmentOffset", "flipEnd", NULL};
    expect_keys(importer, field, keys);
    MesoJsonField half_turn = meso_json_key(field, "addHalfTurn");
    MesoJsonField offset = meso_json_key(field, "assignmentOffset");
    MesoSweep *sweep = &importer->set->sweeps[importer->set->sweep_count++];
    read_end(importer, field, "tileEdgeFrom", "shapeFrom", tile, &sweep->from_side, &sweep->from_section);
    read_end(importer, field, "tileEdgeTo", "shapeTo", tile, &sweep->to_side, &sweep->to_section);
    sweep->half_turn = meso_json_bool(&half_turn, false);

    /* Hundredths of a turn, of either sign. */
    int64_t hundredths = meso_json_whole(&offset, INT32_MIN, INT32_MAX, 0) % 100;
    sweep->turn = (float)(hundredths < 0 ? hundredths + 100 : hundredths) / 100;
}

static void read_inner(Importer *importer, const MesoJsonField *field)
{
    static const char *const keys[] = {"objFilename", "transform", "color", "roughness", "metallic", NULL};
    static const float grey[3] = {MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO, MESO_DEFAULT_ALBEDO};
    float rows[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    expect_keys(importer, field, keys);
    MesoJsonField file = meso_json_key(field, "objFilename");
    MesoJsonField transform = meso_json_key(field, "transform");
    if (transform.value)
        meso_json_count(&transform, 4, 4);
    for (uint32_t i = 0; i < 4 && transform.value; i++) {
        MesoJsonField row = meso_json_item(&transform, i);
        meso_json_floats(&row, 4, rows[i]);
    }
    if (rows[3][0] != 0 || rows[3][1] != 0 || rows[3][2] != 0 || rows[3][3] != 1)
        warn(importer, &transform, "the last row is left out; only affine transforms are kept");
    MesoInnerMesh *inner = &importer->set->inners[importer->set->inner_count++];
    inner->file = file.value ? meso_json_text(&file) : "";
    inner->material = read_material(importer, field, grey);
    memcpy(inner->transform, rows, sizeof inner->transform);
}

static bool read_flag(const MesoJsonField *field, const char *key)
{
    MesoJsonField flag = meso_json_key(field, key);
    return meso_json_bool(&flag, false);
}

/* Missing permissions forbid. */
static void read_permission(Importer *importer, const MesoJsonField *field,
                            bool *rotation, bool *flip_x, bool *flip_y)
{
    static const char *const keys[] = {"rotation", "flipX", "flipY", NULL};
    if (!field->value)
        return;
    expect_keys(importer, field, keys);
    *rotation = read_flag(field, "rotation");
    *flip_x = read_flag(field, "flipX");
    *flip_y = read_flag(field, "flipY");
}

static void read_sides(Importer *importer, const MesoJsonField *edges, MesoTile *tile)
{
    tile->side_count = meso_json_count(edges, 4, MESO_SIDE_COUNT);
    if (tile->side_count == 5)
        meso_json_wrong(edges, "5 items; 4, or 6 with top and bottom, are possible");
    for (uint32_t side = 0; side < tile->side_count && meso_json_good(edges); side++) {
        MesoJsonField edge = meso_json_item(edges, side);
        tile->labels[side] = read_label(importer, &edge);
    }
}

/* A tile of the editor that is not finished: the solver could place it nowhere. */
static bool has_bare_wall(const MesoTile *tile)
{
    for (uint32_t side = 0; side < 4; side++)
        if (tile->labels[side] == 0)
            return true;
    return false;
}

/* Takes the last tile off the set again. */
static void leave_out(Importer *importer, const MesoJsonField *edges)
{
    MesoTileSet *set = importer->set;
    const MesoTile *tile = &set->tiles[--set->tile_count];
    set->sweep_count = tile->sweep_begin;
    set->inner_count = tile->inner_begin;
    warn(importer, edges, "a wall shows no edge type; the unfinished tile is left out");
}

static void read_tile(Importer *importer, const MesoJsonField *field)
{
    static const char *const keys[] = {"edges", "innerPaths", "innerGeometry", "transformPermission",
                                       "ignore", NULL};
    MesoTileSet *set = importer->set;
    expect_keys(importer, field, keys);
    MesoJsonField edges = meso_json_key(field, "edges");
    MesoJsonField sweeps = meso_json_key(field, "innerPaths");
    MesoJsonField inners = meso_json_key(field, "innerGeometry");
    MesoJsonField permission = meso_json_key(field, "transformPermission");
    MesoTile *tile = &set->tiles[set->tile_count++];
    *tile = (MesoTile){
        .name = make_name(importer, "t", (uint32_t)field->index + 1),
        .sweep_begin = set->sweep_count,
        .sweep_count = meso_json_count(&sweeps, 0, MESO_TILES_ITEMS),
        .inner_begin = set->inner_count,
        .inner_count = meso_json_count(&inners, 0, MESO_TILES_ITEMS),
        .ignored = read_flag(field, "ignore"),
    };
    read_permission(importer, &permission, &tile->rotation, &tile->flip_x, &tile->flip_y);
    read_sides(importer, &edges, tile);
    for (uint32_t i = 0; i < tile->sweep_count && meso_json_good(field); i++) {
        MesoJsonField sweep = meso_json_item(&sweeps, i);
        read_sweep(importer, &sweep, tile);
    }
    for (uint32_t i = 0; i < tile->inner_count && meso_json_good(field); i++) {
        MesoJsonField inner = meso_json_item(&inners, i);
        read_inner(importer, &inner);
    }
    if (meso_json_good(field) && has_bare_wall(tile))
        leave_out(importer, &edges);
}

void meso_prototype_parse(MesoTileSet *set, MesoJsonReader *reader, const json_t *root_value,
                          MesoProblemReport *report, void *context)
{
    static const char *const keys[] = {"tileTypes", "edgeTypes", "defaultTileTransformPermission", NULL};
    Importer importer = {.set = set, .reader = reader, .report = report, .context = context};
    MesoJsonField root = meso_json_root(reader, root_value);
    expect_keys(&importer, &root, keys);
    MesoJsonField interfaces = meso_json_key(&root, "edgeTypes"), tiles = meso_json_key(&root, "tileTypes");
    MesoJsonField permission = meso_json_key(&root, "defaultTileTransformPermission");
    uint32_t interface_count = meso_json_count(&interfaces, 0, MESO_TILES_ITEMS);
    uint32_t tile_count = meso_json_count(&tiles, 0, MESO_TILES_ITEMS);
    if (!meso_json_good(&root) || !reserve(&importer, root_value))
        return;
    read_permission(&importer, &permission, &set->default_rotation, &set->default_flip_x,
                    &set->default_flip_y);
    for (uint32_t i = 0; i < interface_count && meso_json_good(&root); i++) {
        MesoJsonField interface = meso_json_item(&interfaces, i);
        read_interface(&importer, &interface);
    }
    for (uint32_t t = 0; t < tile_count && meso_json_good(&root); t++) {
        MesoJsonField tile = meso_json_item(&tiles, t);
        read_tile(&importer, &tile);
    }
}
