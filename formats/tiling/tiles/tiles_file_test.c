/* Tile sets of both kinds: read, refused, written and read again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/tiling/tile/tile_set_check.h"

/* Everything that the format has. */
static const char everything[] =
    "{\"format\": \"meso-tiles\", \"version\": 1, \"provenance\": {\"any\": [1]},\n"
    " \"defaults\": {\"rotation\": true, \"flip_x\": true},\n"
    " \"interfaces\": [\n"
    "  {\"name\": \"a\", \"color\": [0.9, 0.4, 0.1], \"border\": \"exempt\", \"sections\": [\n"
    "   {\"name\": \"rod\", \"shape\": {\"disc\": {\"center\": [0.25, 0.5], \"size\": [0.1, 0.2], \"angle\": 0.5}}},\n"
    "   {\"name\": \"x/y\", \"albedo\": [0, 0.5, 1], \"roughness\": 0.25, \"metallic\": 1, \"shape\":\n"
    "    {\"difference\": [{\"union\": [{\"box\": {\"center\": [0.5, 0.5], \"size\": [0.3, 0.3]}},\n"
    "                              {\"disc\": {\"center\": [0.6, 0.5], \"size\": [0.3, 0.3]}},\n"
    "                              {\"disc\": {\"center\": [0.7, 0.5], \"size\": [0.3, 0.3]}}]},\n"
    "                   {\"disc\": {\"center\": [0.5, 0.5], \"size\": [0.1, 0.1]}}]}}]},\n"
    "  {\"name\": \"rand\", \"border\": \"only\"},\n"
    "  {\"name\": \"free\", \"border\": \"any\", \"sections\": []}],\n"
    " \"tiles\": [\n"
    "  {\"name\": \"t1\", \"sides\": [\"a\", \"a'\", \"free\", \"rand'\"], \"flip_x\": false, \"sweeps\": [\n"
    "    {\"from\": \"0/rod\", \"to\": \"1/x/y\", \"half_turn\": true, \"turn\": 0.375, \"turns\": -2, "
    "\"tangent_scale\": 1.5}]},\n"
    "  {\"name\": \"t2\", \"sides\": [\"a\", \"a\", \"a\", \"a\", null, \"a'\"], \"rotation\": false, \"flip_y\": true,\n"
    "   \"ignored\": true, \"sweeps\": [{\"from\": \"5/rod\", \"to\": \"5/rod\"}],\n"
    "   \"inner\": [{\"mesh\": \"b.obj\", \"transform\": [1,2,3,4,5,6,7,8,9,10,11,12], \"roughness\": 1},\n"
    "             {\"mesh\": \"\"}]}]}\n";

static MesoStatus parse_bytes(MesoTileSet *set, MesoArena *arena, const char *text, size_t size,
                              MesoError *error)
{
    MesoInput input;
    meso_input_wrap(&input, "x.json", text, size);
    return meso_tiles_parse(set, arena, &input, error);
}

static MesoTileSet parse(MesoArena *arena, const char *text)
{
    MesoTileSet set;
    MesoError error;
    if (parse_bytes(&set, arena, text, strlen(text), &error) != MESO_OK)
        fprintf(stderr, "%s\n", error.message);
    CHECK(parse_bytes(&set, arena, text, strlen(text), &error) == MESO_OK);
    return set;
}

static bool is_leaf(MesoCsgNode node, MesoCsgKind kind, float x, float w)
{
    return node.kind == kind && node.center.x == x && node.size.x == w;
}

static void test_everything(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = parse(&arena, everything);
    CHECK(set.interface_count == 3 && set.section_count == 2 && set.csg_count == 8);
    CHECK(set.tile_count == 2 && set.sweep_count == 2 && set.inner_count == 2);
    CHECK(set.default_rotation && set.default_flip_x && !set.default_flip_y);

    const MesoInterface *a = &set.interfaces[0];
    CHECK(strcmp(a->name, "a") == 0 && a->border_exempt && !a->border_only && a->section_count == 2);
    CHECK(set.interfaces[1].border_only && !set.interfaces[1].border_exempt);
    CHECK(!set.interfaces[2].border_only && !set.interfaces[2].border_exempt);
    CHECK(set.interfaces[1].color[0] == 0.8f);

    const MesoMaterial *rod = &set.sections[0].material, *other = &set.sections[1].material;
    CHECK(rod->albedo[0] == 0.9f && rod->roughness == 0.5f && rod->metallic == 0);
    CHECK(other->albedo[2] == 1 && other->roughness == 0.25f && other->metallic == 1);
    CHECK(strcmp(set.sections[1].name, "x/y") == 0);

    CHECK(set.sections[0].csg_root == 0 && set.sections[1].csg_root == 7);
    CHECK(is_leaf(set.csg[0], MESO_CSG_DISC, 0.25f, 0.1f) && set.csg[0].angle == 0.5f);
    CHECK(is_leaf(set.csg[1], MESO_CSG_BOX, 0.5f, 0.3f));
    CHECK(is_leaf(set.csg[2], MESO_CSG_DISC, 0.6f, 0.3f));
    CHECK(set.csg[3].kind == MESO_CSG_UNION && set.csg[3].left == 1 && set.csg[3].right == 2);
    CHECK(is_leaf(set.csg[4], MESO_CSG_DISC, 0.7f, 0.3f));
    CHECK(set.csg[5].kind == MESO_CSG_UNION && set.csg[5].left == 3 && set.csg[5].right == 4);
    CHECK(set.csg[7].kind == MESO_CSG_DIFFERENCE && set.csg[7].left == 5 && set.csg[7].right == 6);

    const int32_t flat[6] = {1, -1, 3, -2, 0, 0}, tall[6] = {1, 1, 1, 1, 0, -1};
    const MesoTile *t1 = &set.tiles[0], *t2 = &set.tiles[1];
    CHECK(t1->side_count == 4 && memcmp(t1->labels, flat, sizeof flat) == 0);
    CHECK(t1->rotation && !t1->flip_x && !t1->flip_y && !t1->ignored);
    CHECK(t2->side_count == 6 && memcmp(t2->labels, tall, sizeof tall) == 0);
    CHECK(!t2->rotation && t2->flip_x && t2->flip_y && t2->ignored);

    const MesoSweep *sweep = &set.sweeps[0];
    CHECK(sweep->from_side == 0 && sweep->to_side == 1 && sweep->half_turn && sweep->turn == 0.375f);
    CHECK(sweep->turns == -2 && sweep->tangent_scale == 1.5f && t1->tangent_scale == 0);
    CHECK(sweep->from_section == 0 && sweep->to_section == 1);
    CHECK(set.inners[0].transform[11] == 12 && set.inners[0].material.roughness == 1);
    CHECK(set.inners[1].transform[0] == 1 && set.inners[1].transform[3] == 0);
    CHECK(*set.inners[1].file == '\0' && set.inners[1].material.albedo[1] == 0.8f);
    meso_arena_release(&arena);
}

static bool is_sound(const MesoTileSet *set)
{
    uint32_t errors;
    CHECK(meso_tile_set_check(&errors, set, NULL, NULL, NULL) == MESO_OK);
    return errors == 0;
}

/* Through JSON and back: the same JSON, hence the same set, as the writer tells all apart. */
static void check_round_trip(const MesoTileSet *set)
{
    MesoArena arena;
    MesoError error;
    MesoTileSet again;
    meso_arena_init(&arena);
    json_t *json = meso_tiles_to_json(set);
    CHECK(json);

    /* As text, for it is text that files hold. */
    char *text = json_dumps(json, 0);
    CHECK(text && parse_bytes(&again, &arena, text, strlen(text), &error) == MESO_OK);
    json_t *json_again = meso_tiles_to_json(&again);
    CHECK(json_equal(json, json_again));

    CHECK(again.csg_count == set->csg_count && again.section_count == set->section_count);
    for (uint32_t n = 0; n < set->csg_count; n++) {
        const MesoCsgNode *x = &set->csg[n], *y = &again.csg[n];
        CHECK(x->kind == y->kind && x->left == y->left && x->right == y->right);
        CHECK(memcmp(&x->center, &y->center, sizeof x->center) == 0);
        CHECK(memcmp(&x->size, &y->size, sizeof x->size) == 0 && x->angle == y->angle);
    }
    for (uint32_t s = 0; s < set->section_count; s++) {
        CHECK(memcmp(&set->sections[s].material, &again.sections[s].material, sizeof(MesoMaterial)) == 0);
        CHECK(set->sections[s].csg_root == again.sections[s].csg_root);
        CHECK(set->sections[s].interface == again.sections[s].interface);
    }
    for (uint32_t i = 0; i < set->sweep_count; i++) {
        const MesoSweep *x = &set->sweeps[i], *y = &again.sweeps[i];
        CHECK(x->from_side == y->from_side && x->from_section == y->from_section);
        CHECK(x->to_side == y->to_side && x->to_section == y->to_section);
        CHECK(x->half_turn == y->half_turn && x->turn == y->turn);
        CHECK(x->turns == y->turns && x->tangent_scale == y->tangent_scale);
    }
    for (uint32_t i = 0; i < set->inner_count; i++)
        CHECK(memcmp(set->inners[i].transform, again.inners[i].transform, 12 * sizeof(float)) == 0);
    free(text);
    json_decref(json_again);
    json_decref(json);
    meso_arena_release(&arena);
}

static void test_round_trip(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = parse(&arena, everything);
    check_round_trip(&set);

    /* Every float comes back, not only those with few digits. */
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    for (int round = 0; round < 2000; round++) {
        for (int i = 0; i < 12; i++) {
            uint32_t bits = (uint32_t)meso_random_next(&random);
            memcpy(&set.inners[0].transform[i], &bits, sizeof bits);
            if (!isfinite(set.inners[0].transform[i]) || set.inners[0].transform[i] == 0)
                set.inners[0].transform[i] = 0.1f;
        }
        check_round_trip(&set);
    }
    meso_arena_release(&arena);
}

static void test_digits(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = parse(&arena, everything);
    json_t *json = meso_tiles_to_json(&set);
    const json_t *color = json_object_get(json_array_get(json_object_get(json, "interfaces"), 0), "color");
    CHECK(json_real_value(json_array_get(color, 0)) == 0.9);   /* not 0.89999997615814209 */
    const json_t *tile = json_array_get(json_object_get(json, "tiles"), 0);
    CHECK(!json_object_get(tile, "rotation") && json_is_false(json_object_get(tile, "flip_x")));
    json_decref(json);
    meso_arena_release(&arena);
}

/* `text` with the first `what` replaced, freed by the caller. */
static char *replaced(const char *text, const char *what, const char *with)
{
    const char *at = strstr(text, what);
    CHECK(at);
    size_t before = (size_t)(at - text);
    char *result = malloc(strlen(text) + strlen(with) + 1);
    CHECK(result);
    memcpy(result, text, before);
    strcpy(result + before, with);
    strcat(result, at + strlen(what));
    return result;
}

typedef struct Case {
    const char *what, *with;    /* replaced in a good file */
    const char *message;
} Case;

static void check_refused(const char *text, const char *message)
{
    MesoArena arena;
    MesoTileSet set;
    MesoInput input;
    MesoError error = {0};
    meso_arena_init(&arena);
    meso_input_wrap(&input, "x.json", text, strlen(text));
    CHECK(meso_tiles_read(&set, &arena, &input, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
    meso_arena_release(&arena);
}

static void check_cases(const char *good, const Case *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *text = replaced(good, cases[i].what, cases[i].with);
        check_refused(text, cases[i].message);
        free(text);
    }
}

static void test_refused(void)
{
    static const Case cases[] = {
        {"\"version\": 1", "\"version\": 2", "x.json: version 2 is newer than this program reads (1)"},
        {"\"meso-tiles\"", "\"meso-report\"",
         "x.json: is a 'meso-report' file; a 'meso-tiles' file is needed here"},
        {"\"defaults\"", "\"default\"",
         "x.json: unknown key \"default\"; there are \"format\", \"version\", \"provenance\", \"defaults\", "
         "\"interfaces\", \"tiles\""},
        {"\"rotation\"", "\"rotations\"",
         "x.json: defaults: unknown key \"rotations\"; there are \"rotation\", \"flip_x\", \"flip_y\""},
        {"\"half_turn\"", "\"halfturn\"",
         "x.json: tiles[0].sweeps[0]: unknown key \"halfturn\"; there are \"from\", \"to\", \"half_turn\", "
         "\"turn\", \"turns\", \"tangent_scale\""},
        {"\"free\", \"rand'\"", "\"fee\", \"rand'\"",
         "x.json: tiles[0].sides[2]: unknown interface 'fee'; its name must be among \"interfaces\""},
        {"\"free\", \"rand'\"", "3, \"rand'\"",
         "x.json: tiles[0].sides[2]: a string is needed here, not a number"},
        {"\"free\", \"rand'\"", "null, \"rand'\"",
         "x.json: tiles[0] 't1', side 2: no interface; sides 0 to 3 must show one"},
        {", \"free\", \"rand'\"", "", "x.json: tiles[0].sides: 2 items; from 4 to 6 are possible"},
        {"\"free\", \"rand'\"", "\"free\", \"rand'\", null",
         "x.json: tiles[0].sides: 5 items; 4, or 6 with top and bottom, are possible"},
        {"0/rod", "4/rod", "x.json: tiles[0].sweeps[0].from: side 4 of the tile shows no interface"},
        {"0/rod", "0/rad", "x.json: tiles[0].sweeps[0].from: unknown cross-section 'rad'; side 0 shows "
                           "interface 'a'"},
        {"0/rod", "rod", "x.json: tiles[0].sweeps[0].from: \"rod\"; a side from 0 to 5, a slash and the name "
                         "of a cross-section are needed, like \"0/1\""},
        {"0.375", "1", "x.json: tiles[0] 't1', sweep 0: turn is 1; it must be from 0 to less than 1"},
        {"0.375", "\"1\"", "x.json: tiles[0].sweeps[0].turn: a number is needed here, not a string"},
        {"0.375", "1e39", "x.json: tiles[0].sweeps[0].turn: 1e+39 is too large a number"},
        {"true, \"turn\"", "1, \"turn\"",
         "x.json: tiles[0].sweeps[0].half_turn: true or false is needed here, not a number"},
        {"\"name\": \"t1\", ", "", "x.json: tiles[0].name: missing"},
        {"\"t2\"", "\"t1\"", "x.json: tiles[1] 't1': the name appears twice; names must differ"},
        {"[0.25, 0.5]", "[0.25]",
         "x.json: interfaces[0].sections[0].shape.disc.center: 1 items; 2 are needed"},
        {"\"center\": [0.25, 0.5], ", "",
         "x.json: interfaces[0].sections[0].shape.disc.center: missing"},
        {"[0.25, 0.5]", "[0.25, 5]",
         "x.json: interfaces[0] 'a', section 'rod': center is 5; it must be from -1 to 2"},
        {"\"disc\"", "\"disk\"", "x.json: interfaces[0].sections[0].shape: unknown key \"disk\"; there are "
                                 "\"disc\", \"union\", \"difference\", \"box\""},
        {"{\"disc\": {\"center\": [0.25, 0.5], \"size\": [0.1, 0.2], \"angle\": 0.5}}", "{}",
         "x.json: interfaces[0].sections[0].shape: exactly one of \"disc\", \"box\", \"union\", "
         "\"difference\" is needed"},
        {"\"exempt\"", "\"none\"", "x.json: interfaces[0].border: \"none\"; \"any\", \"exempt\" and \"only\" "
                                   "are possible"},
        {"[1,2,3,", "[1,2,", "x.json: tiles[1].inner[0].transform: 11 items; 12 are needed"},
        {"{\"mesh\": \"\"}", "{}", "x.json: tiles[1].inner[1].mesh: missing"},
        {"{\"mesh\": \"\"}", "7", "x.json: tiles[1].inner[1]: an object is needed here, not a number"},
    };
    check_cases(everything, cases, sizeof cases / sizeof *cases);
    check_refused("{}", "x.json: not a tile set: neither \"format\": \"meso-tiles\" nor the prototype's "
                        "\"tileTypes\" and \"edgeTypes\"");
    check_refused("[]", "x.json: not a tile set: neither \"format\": \"meso-tiles\" nor the prototype's "
                        "\"tileTypes\" and \"edgeTypes\"");
    check_refused("{\"format\": \"meso-tiles\", \"version\": 1, \"interfaces\": [], \"tiles\": []}",
                  "x.json: interfaces: 0 items; from 1 to 1048576 are possible");
    check_refused("{\"format\": \"meso-tiles\", \"version\": 1}", "x.json: interfaces: missing");
}

/* Notes may stand in every object; a set with them is the set without. */
static void test_notes(void)
{
    static const char *const notes[] = {"\"comment\": \"x\", ", "\"extras\": [[1, {\"disc\": [2, 3, 4]}], {}], ",
                                        "\"$schema\": \"meso-tiles.schema.json\", "};
    MesoArena arena;
    meso_arena_init(&arena);
    char *text = malloc(20 * sizeof everything), *end = text;
    CHECK(text);
    unsigned count = 0;
    for (const char *c = everything; *c; c++) {
        *end++ = *c;
        if (*c == '{')
            end += sprintf(end, "%s", notes[count++ % 3]);
    }
    *end = 0;
    MesoTileSet set = parse(&arena, everything), noted = parse(&arena, text);
    json_t *a = meso_tiles_to_json(&set), *b = meso_tiles_to_json(&noted);
    CHECK(count > 20 && json_equal(a, b));
    json_decref(a);
    json_decref(b);
    free(text);
    meso_arena_release(&arena);
}

/* No prefix of a file is a file. */
static void test_truncated(void)
{
    for (size_t size = 1; size + 2 < sizeof everything; size++) {
        MesoArena arena;
        MesoTileSet set;
        MesoError error = {0};
        meso_arena_init(&arena);
        CHECK(parse_bytes(&set, &arena, everything, size, &error) == MESO_ERR_INPUT);
        CHECK(strncmp(error.message, "x.json:", 7) == 0);
        meso_arena_release(&arena);
    }
}

/* A set whose only shape has `unions` within each other, each with `width` operands. */
static char *make_deep(uint32_t unions, uint32_t width)
{
    static const char leaf[] = "{\"disc\": {\"center\": [0, 0], \"size\": [1, 1]}}";
    char *text = malloc(1000 + unions * 20 + (unions + 1) * (width + 1) * sizeof leaf), *end = text;
    CHECK(text);
    end += sprintf(end, "{\"format\": \"meso-tiles\", \"version\": 1, \"interfaces\": [{\"name\": \"a\", "
                        "\"sections\": [{\"name\": \"1\", \"shape\": ");
    for (uint32_t i = 0; i < unions; i++) {
        end += sprintf(end, "{\"union\": [");
        for (uint32_t k = 1; k < width; k++)
            end += sprintf(end, "%s, ", leaf);
    }
    end += sprintf(end, "%s", leaf);
    for (uint32_t i = 0; i < unions; i++)
        end += sprintf(end, "]}");
    sprintf(end, "}]}], \"tiles\": [{\"name\": \"t\", \"sides\": [\"a\", \"a\", \"a'\", \"a'\"]}]}");
    return text;
}

static void test_nesting(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    char *text = make_deep(63, 2);
    MesoTileSet set = parse(&arena, text);
    CHECK(is_sound(&set));
    check_round_trip(&set);
    free(text);

    text = make_deep(64, 2);
    MesoError error;
    CHECK(parse_bytes(&set, &arena, text, strlen(text), &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "more than 64 shapes within each other"));
    free(text);

    text = make_deep(1, 5000);
    set = parse(&arena, text);
    CHECK(set.csg_count == 9999 && is_sound(&set));
    check_round_trip(&set);
    free(text);
    meso_arena_release(&arena);
}

/* A file of the folder that the environment's `testdata` names, or of the one beside us. */
static char *read_testdata(const char *name)
{
    MesoInput input;
    MesoError error;
    char path[4096];
    const char *folder = getenv("testdata");
    snprintf(path, sizeof path, "%s/%s", folder ? folder : "testdata", name);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    char *text = malloc(input.size + 1);
    CHECK(text);
    memcpy(text, input.data, input.size);
    text[input.size] = '\0';
    meso_input_close(&input);
    return text;
}

static void test_prototype(const char *text)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = parse(&arena, text);
    CHECK(is_sound(&set));
    CHECK(set.interface_count == 2 && set.section_count == 3 && set.csg_count == 7);
    CHECK(set.tile_count == 3 && set.sweep_count == 6 && set.inner_count == 1);
    CHECK(strcmp(set.interfaces[1].name, "b") == 0 && strcmp(set.sections[2].name, "3") == 0);
    CHECK(strcmp(set.tiles[2].name, "t3") == 0);
    CHECK(set.interfaces[0].border_exempt && !set.interfaces[0].border_only);
    CHECK(!set.interfaces[1].border_exempt && set.interfaces[1].border_only);

    const int32_t labels[6] = {1, 1, -1, -1, 0, 0};
    CHECK(set.tiles[0].side_count == 6 && memcmp(set.tiles[0].labels, labels, sizeof labels) == 0);
    CHECK(set.tiles[1].side_count == 4 && set.tiles[1].labels[0] == 2);
    CHECK(set.tiles[1].rotation && set.tiles[1].flip_x && !set.tiles[1].flip_y);

    CHECK(set.csg[3].kind == MESO_CSG_UNION && set.csg[2].kind == MESO_CSG_BOX);
    CHECK(set.csg[6].kind == MESO_CSG_DIFFERENCE && set.csg[6].left == 4 && set.csg[6].right == 5);
    CHECK(set.sections[0].material.albedo[0] == 0.75f && set.sections[0].material.roughness == 0.25f);
    CHECK(set.sections[1].material.albedo[0] == 0.9f && set.sections[1].material.roughness == 0.5f);

    CHECK(set.sweeps[1].half_turn && set.sweeps[1].turn == 0.9f);   /* -10 hundredths */
    CHECK(set.sweeps[2].turn == 0 && set.sweeps[3].turn == 0.25f);  /* 100 and 25 */
    CHECK(set.inners[0].transform[0] == 0.2f && set.inners[0].transform[11] == 0.25f);
    CHECK(*set.inners[0].file == '\0');
    check_round_trip(&set);
    meso_arena_release(&arena);
}

static void test_prototype_refused(const char *text)
{
    static const Case cases[] = {
        {"\"shapeFrom\": 2", "\"shapeFrom\": 3",
         "x.json: tileTypes[0].innerPaths[2].shapeFrom: there is no shape 3; side 0 shows edge type 0, "
         "which has 3"},
        {"\"tileEdgeFrom\": 0", "\"tileEdgeFrom\": 5",
         "x.json: tileTypes[0].innerPaths[0].tileEdgeFrom: side 5 of the tile shows no interface"},
        {"\"tileEdgeFrom\": 0", "\"tileEdgeFrom\": 6",
         "x.json: tileTypes[0].innerPaths[0].tileEdgeFrom: 6; it must be from 0 to 5"},
        {"\"tileEdgeIndex\": 0", "\"tileEdgeIndex\": 2",
         "x.json: tileTypes[0].edges[0].tileEdgeIndex: 2; it must be from -1 to 1"},
        {"\"tileEdgeIndex\": 0", "\"tileEdgeIndex\": -1",
         "x.json: tileTypes[0].innerPaths[0].tileEdgeFrom: side 0 of the tile shows no interface"},
        {"\"node-type\": 1", "\"node-type\": 4",
         "x.json: edgeTypes[0].shapes[1].csg.node-type: 4; it must be from 0 to 3"},
        {"\"node-type\": 1", "\"node-type\": 0",
         "x.json: edgeTypes[0].shapes[1].csg.center: missing"},
        {"\"node-type\": 1", "\"node-kind\": 1",
         "x.json: edgeTypes[0].shapes[1].csg.node-type: missing"},
        {"[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 1.0]",
         "x.json: tileTypes[0].innerGeometry[0].transform[3]: 3 items; 4 are needed"},
        {"\"borderEdge\": false", "\"borderEdge\": 0",
         "x.json: edgeTypes[0].borderEdge: true or false is needed here, not a number"},
        {"\"borderOnly\": false", "\"borderOnly\": true",
         "x.json: interfaces[0] 'a': border exempt and border only exclude each other"},
    };
    check_cases(text, cases, sizeof cases / sizeof *cases);
}

static void hear(void *context, const char *severity, const char *where, const char *message)
{
    char *heard = context;
    sprintf(heard + strlen(heard), "%s: %s: %s\n", severity, where, message);
}

static void test_prototype_warnings(const char *text)
{
    static const Case cases[] = {
        {"\"edgeTypes\"", "\"edgeTypes\"", ""},
        {"\"isExplicit\"", "\"is\"", "warning: edgeTypes[0]: unknown key \"is\" is left out\n"},
        {"0.25, 1.0]", "0.25, 0.5]",
         "warning: edgeTypes[0].shapes[0].color: opacity is left out; everything is opaque\n"},
        {"[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.5, 0.0, 1.0]",
         "warning: tileTypes[0].innerGeometry[0].transform: the last row is left out; only affine "
         "transforms are kept\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *changed = replaced(text, cases[i].what, cases[i].with), heard[1000] = "";
        MesoArena arena;
        MesoTileSet set;
        MesoError error;
        meso_arena_init(&arena);
        json_t *root = json_loads(changed, 0, NULL);
        CHECK(meso_tiles_import(&set, &arena, root, "x.json", hear, heard, &error) == MESO_OK);
        CHECK(strcmp(heard, cases[i].message) == 0);
        json_decref(root);
        free(changed);
        meso_arena_release(&arena);
    }
}

/* Older layouts: a radius for a size, parts of sides for drawings, no permissions, a tile that is not finished. */
static void test_prototype_of_old(void)
{
    static const char text[] =
        "{\"tileTypes\": ["
        "{\"innerPaths\": [{\"shapeFrom\": 0, \"shapeTo\": 0, \"tileEdgeFrom\": 0, \"tileEdgeTo\": 0}], \"edges\": ["
        "{\"tileEdgeIndex\": 0}, {\"tileEdgeIndex\": -1}, {\"tileEdgeIndex\": -1}, {\"tileEdgeIndex\": -1}]},"
        "{\"innerPaths\": [{\"shapeFrom\": 1, \"shapeTo\": 0, \"tileEdgeFrom\": 0, \"tileEdgeTo\": 1}], \"edges\": ["
        "{\"tileEdgeIndex\": 0}, {\"tileEdgeIndex\": 1}, {\"tileEdgeIndex\": 0}, {\"tileEdgeIndex\": 1}]}],"
        "\"edgeTypes\": ["
        "{\"shapes\": [{\"csg\": {\"center\": [0.25, 0.5], \"radius\": 0.125, \"node-type\": 0}},"
        "{\"csg\": {\"node-type\": 1, \"lhs\": {\"center\": [0.5, 0.5], \"radius\": 0.25, \"node-type\": 0},"
        "\"rhs\": {\"center\": [0.5, 0.5], \"size\": [0.5, 0.125], \"angle\": 0.5, \"node-type\": 0}}}], \"isExplicit\": true},"
        "{\"shapes\": [{\"start\": 0.25, \"end\": 0.375}, {\"start\": 1, \"end\": 0.5}], \"isExplicit\": true}]}";
    static const Case refused[] = {
        {"0.375}", "\"x\"}", "x.json: edgeTypes[1].shapes[0].end: a number is needed here, not a string"},
        {", \"end\": 0.5", "", "x.json: edgeTypes[1].shapes[1].end: missing"},
        {"\"start\": 0.25, \"end\": 0.375", "", "x.json: edgeTypes[1].shapes[0].csg: missing"},
        {"\"radius\": 0.125", "\"diameter\": 0.125", "x.json: edgeTypes[0].shapes[0].csg.size: missing"},
        {"\"radius\": 0.125, \"node-type\": 0", "\"radius\": 0.125, \"node-type\": 3",
         "x.json: edgeTypes[0].shapes[0].csg.size: missing"},
    };
    char heard[1000] = "";
    MesoArena arena;
    MesoTileSet set;
    MesoError error;
    meso_arena_init(&arena);
    json_t *root = json_loads(text, 0, NULL);
    CHECK(meso_tiles_import(&set, &arena, root, "x.json", hear, heard, &error) == MESO_OK);
    json_decref(root);
    CHECK(strcmp(heard, "warning: tileTypes[0].edges: a wall shows no edge type; the unfinished tile is left out\n") == 0);
    uint32_t wrong;
    CHECK(meso_tile_set_check(&wrong, &set, NULL, NULL, &error) == MESO_OK && wrong == 0);
    CHECK(set.tile_count == 1 && strcmp(set.tiles[0].name, "t2") == 0 && !set.tiles[0].rotation);
    CHECK(set.sweep_count == 1 && set.tiles[0].sweep_begin == 0 && set.sweeps[0].to_side == 1);
    CHECK(set.section_count == 4 && set.csg_count == 6);
    CHECK(is_leaf(set.csg[0], MESO_CSG_DISC, 0.25f, 0.125f) && set.csg[0].size.y == 0.125f && set.csg[0].angle == 0);
    CHECK(is_leaf(set.csg[2], MESO_CSG_DISC, 0.5f, 0.5f) && set.csg[2].size.y == 0.125f);
    CHECK(is_leaf(set.csg[4], MESO_CSG_DISC, 0.3125f, 0.125f) && set.csg[4].size.y == 0.125f);
    CHECK(is_leaf(set.csg[5], MESO_CSG_DISC, 0.75f, 0.5f) && set.csg[5].center.y == 0.5f);
    check_round_trip(&set);
    check_cases(text, refused, sizeof refused / sizeof *refused);
    meso_arena_release(&arena);
}

/* More interfaces than letters, and numbers in their names' place. */
static void test_prototype_names(void)
{
    char text[8000] = "{\"tileTypes\": [], \"edgeTypes\": [";
    for (int i = 0; i < 28; i++)
        sprintf(text + strlen(text), "%s{\"shapes\": []}", i ? "," : "");
    strcat(text, "]}");
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = parse(&arena, text);
    CHECK(set.interface_count == 28);
    CHECK(strcmp(set.interfaces[25].name, "z") == 0 && strcmp(set.interfaces[26].name, "i27") == 0);
    meso_arena_release(&arena);
}

static void count_place(void *context, const char *severity, const char *where, const char *message)
{
    static const char *const places[] = {"interfaces[0]", "interfaces[0].sections[0].shape.disc.size[1]",
                                         "interfaces[1].sections[0].shape", "tiles[0].sides[1]",
                                         "tiles[0].sweeps[0].to", "tiles[1].sides"};
    uint32_t *count = context;
    CHECK(strcmp(severity, "error") == 0 && *message);
    CHECK(*count < sizeof places / sizeof *places && strcmp(where, places[*count]) == 0);
    ++*count;
}

/* A survey goes on after a problem. */
static void test_survey(void)
{
    static const char text[] =
        "{\"format\":\"meso-tiles\",\"version\":1,\"interfaces\":[{\"name\":\"a\",\"colour\":[1,1,1],"
        "\"sections\":[{\"name\":\"1\",\"shape\":{\"disc\":{\"center\":[0,0],\"size\":[0.2,\"x\"]}}}]},"
        "{\"name\":\"b\",\"sections\":[{\"name\":\"1\",\"shape\":{\"disk\":{}}}]}],"
        "\"tiles\":[{\"name\":\"t\",\"sides\":[\"a\",\"c\",\"a\",\"a'\"],\"sweeps\":[{\"from\":\"0/1\",\"to\":\"7\"}]},"
        "{\"name\":\"u\",\"sides\":[\"a\",\"a\"]}]}";
    MesoArena arena;
    MesoInput input;
    MesoTileSet set;
    MesoError error;
    uint32_t count = 0;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "survey", text, sizeof text - 1);
    CHECK(meso_tiles_survey(&set, &arena, &input, count_place, &count, &error) == MESO_ERR_INPUT);
    CHECK(count == 6);
    CHECK(meso_tiles_parse(&set, &arena, &input, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "interfaces[0]: unknown key"));
    meso_arena_release(&arena);
}

int main(void)
{
    test_everything();
    test_round_trip();
    test_digits();
    test_refused();
    test_notes();
    test_truncated();
    test_nesting();
    char *prototype = read_testdata("prototype-basket.json");
    test_prototype(prototype);
    test_prototype_refused(prototype);
    test_prototype_warnings(prototype);
    test_prototype_of_old();
    test_prototype_names();
    free(prototype);
    test_survey();
    return 0;
}
