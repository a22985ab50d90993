#include "libcore/tiling/tile/tile_set_check.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/tiling/tile/variant.h"

enum { NAME_LENGTH = 200, PLACE_LENGTH = 640, MOST_TURNS = 64 };

/* Drawings may leave the unit square a little: strokes end where they end. */
static const float CENTER_LOW = -1, CENTER_HIGH = 2, SIZE_HIGH = 4, ANGLE_HIGH = 100;

/* Inner meshes come in any unit; far beyond this a float cannot place them in the tile. */
static const float TRANSFORM_HIGH = 1e6f;

typedef struct Check {
    const MesoTileSet *set;
    MesoProblemReport *report;
    void *context;
    uint32_t errors;
    char place[PLACE_LENGTH];   /* what is being looked at */
} Check;

static void report_problem(Check *check, bool is_error, const char *format, va_list arguments)
{
    check->errors += is_error;
    if (!check->report)
        return;
    char message[512];
    vsnprintf(message, sizeof message, format, arguments);
    check->report(check->context, is_error ? "error" : "warning", check->place, message);
}

__attribute__((format(printf, 2, 3))) static void wrong(Check *check, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report_problem(check, true, format, arguments);
    va_end(arguments);
}

__attribute__((format(printf, 2, 3))) static void doubtful(Check *check, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report_problem(check, false, format, arguments);
    va_end(arguments);
}

__attribute__((format(printf, 2, 3))) static void look_at(Check *check, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(check->place, sizeof check->place, format, arguments);
    va_end(arguments);
}

static const char *shown_name(const char *name)
{
    return name ? name : "";
}

static void look_at_interface(Check *check, uint32_t i)
{
    look_at(check, "interfaces[%u] '%.*s'", i, NAME_LENGTH, shown_name(check->set->interfaces[i].name));
}

static void look_at_section(Check *check, uint32_t s)
{
    const MesoSection *section = &check->set->sections[s];
    const MesoInterface *interface = &check->set->interfaces[section->interface];
    look_at(check, "interfaces[%u] '%.*s', section '%.*s'", section->interface, NAME_LENGTH,
            shown_name(interface->name), NAME_LENGTH, shown_name(section->name));
}

/* `part` "side", "sweep" or "inner mesh", or NULL for the whole tile. */
static void look_at_tile(Check *check, uint32_t t, const char *part, uint32_t index)
{
    const char *name = shown_name(check->set->tiles[t].name);
    if (part)
        look_at(check, "tiles[%u] '%.*s', %s %u", t, NAME_LENGTH, name, part, index);
    else
        look_at(check, "tiles[%u] '%.*s'", t, NAME_LENGTH, name);
}

static bool in_range(float value, float low, float high)
{
    return isfinite(value) && value >= low && value <= high;
}

static void check_range(Check *check, const char *what, const float *values, uint32_t count,
                        float low, float high)
{
    for (uint32_t i = 0; i < count; i++)
        if (!in_range(values[i], low, high)) {
            wrong(check, "%s is %g; it must be from %g to %g", what, (double)values[i], (double)low,
                  (double)high);
            return;
        }
}

static void check_material(Check *check, const MesoMaterial *material)
{
    check_range(check, "albedo", material->albedo, 3, 0, 1);
    check_range(check, "roughness", &material->roughness, 1, 0, 1);
    check_range(check, "metallic", &material->metallic, 1, 0, 1);
}

/* Names reach mesh attributes, manifests and terminals: no control characters, no endless ones. */
static void check_name(Check *check, const char *name)
{
    if (!name || !*name) {
        wrong(check, "the name is missing");
        return;
    }
    if (strlen(name) > NAME_LENGTH)
        wrong(check, "the name has %zu bytes; at most %d", strlen(name), NAME_LENGTH);
    for (const unsigned char *c = (const unsigned char *)name; *c; c++)
        if (*c < 0x20 || *c == 0x7f) {
            wrong(check, "the name holds a control character");
            break;
        }
}

typedef struct Named {
    const char *name;
    uint32_t index;
} Named;

static int compare_named(const void *a, const void *b)
{
    const Named *left = a, *right = b;
    int order = strcmp(left->name, right->name);
    return order ? order : (left->index > right->index) - (left->index < right->index);
}

/* After sorting, every entry whose name stood there before is a repetition. */
static void check_unique(Check *check, Named *named, uint32_t count,
                         void (*look)(Check *check, uint32_t index))
{
    if (count > 1)
        qsort(named, count, sizeof *named, compare_named);
    for (uint32_t i = 1; i < count; i++)
        if (*named[i].name && strcmp(named[i].name, named[i - 1].name) == 0) {
            look(check, named[i].index);
            wrong(check, "the name appears twice; names must differ");
        }
}

static void look_at_whole_tile(Check *check, uint32_t t)
{
    look_at_tile(check, t, NULL, 0);
}

/* Interfaces, tiles, and the cross-sections of each interface have names of their own. */
static void check_names(Check *check, Named *named)
{
    const MesoTileSet *set = check->set;
    for (uint32_t i = 0; i < set->interface_count; i++) {
        const char *name = set->interfaces[i].name;
        look_at_interface(check, i);
        check_name(check, name);
        if (name && *name && name[strlen(name) - 1] == '\'')
            wrong(check, "the name ends in ', which marks a flipped interface on a side");
        named[i] = (Named){shown_name(name), i};
    }
    check_unique(check, named, set->interface_count, look_at_interface);

    for (uint32_t i = 0; i < set->interface_count; i++) {
        const MesoInterface *interface = &set->interfaces[i];
        for (uint32_t k = 0; k < interface->section_count; k++) {
            uint32_t s = interface->section_begin + k;
            look_at_section(check, s);
            check_name(check, set->sections[s].name);
            named[k] = (Named){shown_name(set->sections[s].name), s};
        }
        check_unique(check, named, interface->section_count, look_at_section);
    }

    for (uint32_t t = 0; t < set->tile_count; t++) {
        look_at_whole_tile(check, t);
        check_name(check, set->tiles[t].name);
        named[t] = (Named){shown_name(set->tiles[t].name), t};
    }
    check_unique(check, named, set->tile_count, look_at_whole_tile);
}

/* What is known of a node of a drawing. */
typedef struct NodeFacts {
    uint32_t nesting;       /* levels, where a chain a + b + c + ... counts as one */
    bool has_area;          /* as far as the sizes tell */
    bool used;              /* by a parent or a cross-section */
    uint32_t owner;         /* cross-section, or MESO_NO_INDEX */
} NodeFacts;

static bool is_leaf(const MesoCsgNode *node)
{
    return node->kind == MESO_CSG_DISC || node->kind == MESO_CSG_BOX;
}

static void check_leaf(Check *check, const MesoCsgNode *node)
{
    const float center[2] = {node->center.x, node->center.y}, size[2] = {node->size.x, node->size.y};
    check_range(check, "center", center, 2, CENTER_LOW, CENTER_HIGH);
    check_range(check, "size", size, 2, 0, SIZE_HIGH);
    check_range(check, "angle", &node->angle, 1, -ANGLE_HIGH, ANGLE_HIGH);
}

/* False where the drawing is no tree, so that nobody may walk it. */
static bool check_operands(Check *check, NodeFacts *facts, uint32_t n)
{
    const MesoCsgNode *node = &check->set->csg[n];
    if (node->left >= n || node->right >= n || node->left == node->right ||
        facts[node->left].used || facts[node->right].used) {
        wrong(check, "the drawing is not a tree (node %u)", n);
        return false;
    }
    facts[node->left].used = facts[node->right].used = true;

    uint32_t left = facts[node->left].nesting + (check->set->csg[node->left].kind != node->kind);
    uint32_t right = facts[node->right].nesting + 1;
    facts[n].nesting = left > right ? left : right;
    facts[n].has_area = facts[node->left].has_area ||
                        (node->kind == MESO_CSG_UNION && facts[node->right].has_area);
    if (facts[n].nesting > MESO_CSG_NESTING) {
        wrong(check, "the drawing has more than %d levels", MESO_CSG_NESTING);
        return false;
    }
    return true;
}

/* Nodes follow their operands, so one pass suffices. True if every node is part of a sound tree. */
static bool check_nodes(Check *check, NodeFacts *facts)
{
    for (uint32_t n = 0; n < check->set->csg_count; n++) {
        const MesoCsgNode *node = &check->set->csg[n];
        look_at(check, "drawings");
        facts[n] = (NodeFacts){.nesting = 1, .owner = MESO_NO_INDEX};
        if (is_leaf(node)) {
            facts[n].has_area = node->size.x > 0 && node->size.y > 0;
        } else if (node->kind != MESO_CSG_UNION && node->kind != MESO_CSG_DIFFERENCE) {
            wrong(check, "node %u of the drawings has the unknown kind %d", n, (int)node->kind);
            return false;
        } else if (!check_operands(check, facts, n)) {
            return false;
        }
    }
    return true;
}

/* From the roots down: a parent comes after its operands. */
static void spread_owners(const MesoTileSet *set, NodeFacts *facts)
{
    for (uint32_t n = set->csg_count; n-- > 0;)
        if (!is_leaf(&set->csg[n])) {
            facts[set->csg[n].left].owner = facts[n].owner;
            facts[set->csg[n].right].owner = facts[n].owner;
        }
}

static void check_sections(Check *check, NodeFacts *facts)
{
    const MesoTileSet *set = check->set;
    for (uint32_t s = 0; s < set->section_count; s++) {
        uint32_t root = set->sections[s].csg_root;
        look_at_section(check, s);
        check_material(check, &set->sections[s].material);
        if (root >= set->csg_count || facts[root].used) {
            wrong(check, "the cross-section has no drawing of its own");
            continue;
        }
        facts[root].used = true;
        facts[root].owner = s;
        if (!facts[root].has_area)
            doubtful(check, "the drawing has no area; nothing will be seen of it");
    }
    spread_owners(set, facts);
    for (uint32_t n = 0; n < set->csg_count; n++)
        if (is_leaf(&set->csg[n]) && facts[n].owner != MESO_NO_INDEX) {
            look_at_section(check, facts[n].owner);
            check_leaf(check, &set->csg[n]);
        }
}

static void check_interfaces(Check *check)
{
    for (uint32_t i = 0; i < check->set->interface_count; i++) {
        const MesoInterface *interface = &check->set->interfaces[i];
        look_at_interface(check, i);
        check_range(check, "color", interface->color, 3, 0, 1);
        if (interface->border_exempt && interface->border_only)
            wrong(check, "border exempt and border only exclude each other");
    }
}

static void check_label(Check *check, const MesoTile *tile, uint32_t side)
{
    int32_t label = tile->labels[side];
    if (label == 0) {
        if (side < 4)
            wrong(check, "no interface; sides 0 to 3 must show one");
    } else if (side >= tile->side_count) {
        wrong(check, "shows an interface, but the tile has %u sides", tile->side_count);
    } else if (label == INT32_MIN || meso_label_interface(label) >= check->set->interface_count) {
        wrong(check, "label %d; the set has %u interfaces", label, check->set->interface_count);
    }
}

static bool shows_section(const MesoTileSet *set, const MesoTile *tile, uint32_t side, uint32_t section)
{
    int32_t label = tile->labels[side];
    return label != 0 && label != INT32_MIN && section < set->section_count &&
           set->sections[section].interface == meso_label_interface(label);
}

/* 0 stands for 1. */
static void check_tangent_scale(Check *check, float scale)
{
    if (scale != 0 && !(scale >= 1e-3f && scale <= 1e3f))
        wrong(check, "tangent_scale is %g; it must be from 0.001 to 1000", (double)scale);
}

static void check_sweep(Check *check, const MesoTile *tile, const MesoSweep *sweep)
{
    const uint32_t sides[2] = {sweep->from_side, sweep->to_side};
    const uint32_t sections[2] = {sweep->from_section, sweep->to_section};
    static const char *const ends[2] = {"from", "to"};
    for (uint32_t end = 0; end < 2; end++) {
        if (sides[end] >= tile->side_count)
            wrong(check, "leads %s side %u; the tile has %u sides", ends[end], sides[end],
                  tile->side_count);
        else if (tile->labels[sides[end]] == 0)
            wrong(check, "leads %s side %u, which shows no interface", ends[end], sides[end]);
        else if (!shows_section(check->set, tile, sides[end], sections[end]))
            wrong(check, "leads %s a cross-section that side %u does not show", ends[end], sides[end]);
    }
    if (!(isfinite(sweep->turn) && sweep->turn >= 0 && sweep->turn < 1))
        wrong(check, "turn is %g; it must be from 0 to less than 1", (double)sweep->turn);
    if (sweep->turns < -MOST_TURNS || sweep->turns > MOST_TURNS)
        wrong(check, "turns is %d; it must be from -%d to %d", sweep->turns, MOST_TURNS, MOST_TURNS);
    check_tangent_scale(check, sweep->tangent_scale);
}

static void check_tile(Check *check, uint32_t t)
{
    const MesoTileSet *set = check->set;
    const MesoTile *tile = &set->tiles[t];
    look_at_tile(check, t, NULL, 0);
    check_tangent_scale(check, tile->tangent_scale);
    if (tile->side_count != 4 && tile->side_count != 6) {
        wrong(check, "has %u sides; it must have 4, or 6 with top and bottom", tile->side_count);
        return;
    }
    for (uint32_t side = 0; side < MESO_SIDE_COUNT; side++) {
        look_at_tile(check, t, "side", side);
        check_label(check, tile, side);
    }
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        look_at_tile(check, t, "sweep", i);
        check_sweep(check, tile, &set->sweeps[tile->sweep_begin + i]);
    }
    for (uint32_t i = 0; i < tile->inner_count; i++) {
        const MesoInnerMesh *inner = &set->inners[tile->inner_begin + i];
        look_at_tile(check, t, "inner mesh", i);
        if (!inner->file)
            wrong(check, "the file name is missing");
        check_range(check, "transform", inner->transform, 12, -TRANSFORM_HIGH, TRANSFORM_HIGH);
        check_material(check, &inner->material);
    }
}

/* Lists within lists must follow each other and fill their arrays: nothing lies outside, nothing is
 * shared. */
static bool check_extents(Check *check)
{
    const MesoTileSet *set = check->set;
    uint32_t sections = 0, sweeps = 0, inners = 0;
    look_at(check, "tile set");
    if (set->interface_count >= INT32_MAX) {
        wrong(check, "too many interfaces");
        return false;
    }
    for (uint32_t i = 0; i < set->interface_count; i++) {
        const MesoInterface *interface = &set->interfaces[i];
        if (interface->section_begin != sections ||
            interface->section_count > set->section_count - sections) {
            wrong(check, "cross-sections of interface %u out of range", i);
            return false;
        }
        for (uint32_t k = 0; k < interface->section_count; k++)
            if (set->sections[sections + k].interface != i) {
                wrong(check, "cross-section %u belongs to another interface than %u", sections + k, i);
                return false;
            }
        sections += interface->section_count;
    }
    for (uint32_t t = 0; t < set->tile_count; t++) {
        const MesoTile *tile = &set->tiles[t];
        if (tile->sweep_begin != sweeps || tile->sweep_count > set->sweep_count - sweeps ||
            tile->inner_begin != inners || tile->inner_count > set->inner_count - inners) {
            wrong(check, "sweeps or inner meshes of tile %u out of range", t);
            return false;
        }
        sweeps += tile->sweep_count;
        inners += tile->inner_count;
    }
    if (sections != set->section_count || sweeps != set->sweep_count || inners != set->inner_count) {
        wrong(check, "cross-sections, sweeps or inner meshes that belong to nothing");
        return false;
    }
    return true;
}

/* How an interface is seen on sides 0 to 3 of all variants. */
enum { SHOWN_PLAIN = 1, SHOWN_FLIPPED = 2, SHOWN_ON_TOP = 4 };

static uint8_t shown_sign(int32_t label)
{
    return label > 0 ? SHOWN_PLAIN : SHOWN_FLIPPED;
}

static void collect_shown(const MesoTileSet *set, uint8_t *shown)
{
    for (uint32_t t = 0; t < set->tile_count; t++) {
        const MesoTile *tile = &set->tiles[t];
        for (uint32_t side = 0; side < MESO_SIDE_COUNT && !tile->ignored; side++) {
            int32_t label = tile->labels[side];
            if (label == 0)
                continue;
            uint8_t *bits = &shown[meso_label_interface(label)];
            if (side >= 4)
                *bits |= SHOWN_ON_TOP;
            else
                *bits |= tile->flip_x || tile->flip_y ? SHOWN_PLAIN | SHOWN_FLIPPED
                                                      : shown_sign(label);
        }
    }
}

/* Could another slot show the opposite of `label`? */
static bool has_partner(const MesoTileSet *set, const uint8_t *shown, int32_t label)
{
    uint32_t interface = meso_label_interface(label);
    return !set->interfaces[interface].border_only && (shown[interface] & shown_sign(-label));
}

static void doubt_interfaces(Check *check, const uint8_t *shown)
{
    for (uint32_t i = 0; i < check->set->interface_count; i++) {
        const MesoInterface *interface = &check->set->interfaces[i];
        uint8_t signs = shown[i] & (SHOWN_PLAIN | SHOWN_FLIPPED);
        look_at_interface(check, i);
        if (shown[i] == 0)
            doubtful(check, "no tile uses the interface");
        else if ((signs == SHOWN_PLAIN || signs == SHOWN_FLIPPED) && !interface->border_only)
            doubtful(check, "nothing can match it: a tile that shows \"%.*s%s\", or that may be "
                     "flipped, is needed", NAME_LENGTH, interface->name,
                     signs == SHOWN_PLAIN ? "'" : "");
    }
}

static void doubt_tiles(Check *check, const uint8_t *shown)
{
    const MesoTileSet *set = check->set;
    for (uint32_t t = 0; t < set->tile_count; t++) {
        const MesoTile *tile = &set->tiles[t];
        uint32_t partners = 0;
        for (uint32_t side = 0; side < 4 && !tile->ignored; side++) {
            bool partner = has_partner(set, shown, tile->labels[side]);
            partners += partner;
            look_at_tile(check, t, "side", side);
            if (!partner && set->interfaces[meso_label_interface(tile->labels[side])].border_exempt)
                doubtful(check, "can neither match a side nor lie on the border, so the tile can "
                         "never be used");
        }
        look_at_tile(check, t, NULL, 0);
        if (partners == 0 && !tile->ignored)
            doubtful(check, "the tile can never have a neighbour");
    }
}

static void check_all(Check *check, Named *named, NodeFacts *facts, uint8_t *shown)
{
    const MesoTileSet *set = check->set;
    uint32_t usable = 0;
    for (uint32_t t = 0; t < set->tile_count; t++)
        usable += !set->tiles[t].ignored;
    look_at(check, "tile set");
    if (usable == 0)
        wrong(check, "there is no tile%s", set->tile_count ? " that is not ignored" : "");

    check_names(check, named);
    check_interfaces(check);
    if (check_nodes(check, facts))
        check_sections(check, facts);
    for (uint32_t t = 0; t < set->tile_count; t++)
        check_tile(check, t);
    if (check->errors == 0) {
        collect_shown(set, shown);
        doubt_interfaces(check, shown);
        doubt_tiles(check, shown);
    }
}

MesoStatus meso_tile_set_check(uint32_t *error_count, const MesoTileSet *set, MesoProblemReport *report, void *context,
                               MesoError *error)
{
    Check check = {.set = set, .report = report, .context = context};
    bool in_order = check_extents(&check);
    *error_count = check.errors;
    if (!in_order)
        return MESO_OK;

    MesoArena arena;
    meso_arena_init(&arena);
    uint32_t most_names = set->interface_count > set->tile_count ? set->interface_count : set->tile_count;
    if (set->section_count > most_names)
        most_names = set->section_count;
    Named *named = MESO_NEW(&arena, Named, most_names, error);
    NodeFacts *facts = MESO_NEW(&arena, NodeFacts, set->csg_count, error);
    uint8_t *shown = MESO_NEW(&arena, uint8_t, set->interface_count, error);
    bool room = named && facts && shown;
    if (room)
        check_all(&check, named, facts, shown);
    meso_arena_release(&arena);
    *error_count = check.errors;
    return room ? MESO_OK : MESO_ERR_MEMORY;
}
