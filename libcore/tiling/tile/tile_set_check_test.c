/* The check of tile sets: a sound set, and what each single change to it is answered with. */
#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/tiling/tile/tile_set_check.h"

/*
 * Interface "a" with a disc and a disc plus box less disc; "edge", empty, for
 * borders. Tile "flat" has a, a, a', a' and a sweep from 0 to 2; "rim" has six
 * sides and a loop on its top.
 */
typedef struct Fixture {
    MesoTileSet set;
    MesoInterface interfaces[2];
    MesoSection sections[2];
    MesoCsgNode csg[6];
    MesoTile tiles[2];
    MesoSweep sweeps[2];
    MesoInnerMesh inners[1];
} Fixture;

static MesoCsgNode leaf(MesoCsgKind kind)
{
    return (MesoCsgNode){.kind = kind, .center = {0.5f, 0.5f}, .size = {0.25f, 0.25f}};
}

static void make(Fixture *f)
{
    *f = (Fixture){
        .interfaces = {{.name = "a", .section_count = 2, .border_exempt = true},
                       {.name = "edge", .section_begin = 2, .border_only = true}},
        .sections = {{.name = "1", .interface = 0, .csg_root = 0},
                     {.name = "2", .interface = 0, .csg_root = 5}},
        .csg = {leaf(MESO_CSG_DISC), leaf(MESO_CSG_DISC), leaf(MESO_CSG_BOX),
                {.kind = MESO_CSG_UNION, .left = 1, .right = 2}, leaf(MESO_CSG_DISC),
                {.kind = MESO_CSG_DIFFERENCE, .left = 3, .right = 4}},
        .tiles = {{.name = "flat", .side_count = 4, .labels = {1, 1, -1, -1}, .sweep_count = 1},
                  {.name = "rim", .side_count = 6, .labels = {2, 1, -1, -1, 1, 0}, .rotation = true,
                   .sweep_begin = 1, .sweep_count = 1, .inner_count = 1}},
        .sweeps = {{.from_side = 0, .to_side = 2, .to_section = 1, .turn = 0.5f},
                   {.from_side = 4, .to_side = 4, .from_section = 1, .to_section = 1}},
        .inners = {{.file = "", .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}},
    };
    f->set = (MesoTileSet){
        .interface_count = 2, .section_count = 2, .csg_count = 6,
        .tile_count = 2, .sweep_count = 2, .inner_count = 1,
        .interfaces = f->interfaces, .sections = f->sections, .csg = f->csg,
        .tiles = f->tiles, .sweeps = f->sweeps, .inners = f->inners,
    };
}

typedef struct Heard {
    char text[4000];
    uint32_t errors, warnings;
} Heard;

static void hear(void *context, const char *severity, const char *where, const char *message)
{
    Heard *heard = context;
    bool is_error = strcmp(severity, "error") == 0;
    CHECK(is_error || strcmp(severity, "warning") == 0);
    heard->errors += is_error;
    heard->warnings += !is_error;
    size_t used = strlen(heard->text);
    snprintf(heard->text + used, sizeof heard->text - used, "%s: %s\n", where, message);
}

static Heard check_set(const MesoTileSet *set)
{
    Heard heard = {.errors = 0};
    uint32_t errors, again;
    CHECK(meso_tile_set_check(&errors, set, hear, &heard, NULL) == MESO_OK && errors == heard.errors);
    CHECK(meso_tile_set_check(&again, set, NULL, NULL, NULL) == MESO_OK && again == errors);
    return heard;
}

/* Exactly these lines. */
static void expect(const Fixture *f, uint32_t errors, const char *text)
{
    Heard heard = check_set(&f->set);
    if (strcmp(heard.text, text) != 0)
        fprintf(stderr, "heard:    %sexpected: %s", heard.text, text);
    CHECK(strcmp(heard.text, text) == 0);
    CHECK(heard.errors == errors);
}

/* Makes the fixture, changes one thing, expects one error. */
#define EXPECT_ERROR(change, text) \
    do {                           \
        Fixture f;                 \
        make(&f);                  \
        change;                    \
        expect(&f, 1, text "\n");  \
    } while (0)

#define EXPECT_WARNINGS(change, text) \
    do {                              \
        Fixture f;                    \
        make(&f);                     \
        change;                       \
        expect(&f, 0, text);          \
    } while (0)

static void test_names(void)
{
    char endless[300];
    memset(endless, 'x', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';

    EXPECT_ERROR(f.interfaces[1].name = "a", "interfaces[1] 'a': the name appears twice; names must differ");
    EXPECT_ERROR(f.sections[1].name = "1",
                 "interfaces[0] 'a', section '1': the name appears twice; names must differ");
    EXPECT_ERROR(f.tiles[1].name = "flat", "tiles[1] 'flat': the name appears twice; names must differ");
    EXPECT_ERROR(f.tiles[1].name = "", "tiles[1] '': the name is missing");
    EXPECT_ERROR(f.tiles[1].name = NULL, "tiles[1] '': the name is missing");
    EXPECT_ERROR(f.sections[0].name = NULL, "interfaces[0] 'a', section '': the name is missing");
    EXPECT_ERROR(f.tiles[0].name = "a\nb", "tiles[0] 'a\nb': the name holds a control character");
    EXPECT_ERROR(f.interfaces[0].name = "a'",
                 "interfaces[0] 'a'': the name ends in ', which marks a flipped interface on a side");
    Fixture f;
    make(&f);
    f.tiles[0].name = endless;
    CHECK(strstr(check_set(&f.set).text, "the name has 299 bytes; at most 200"));
}

static void test_values(void)
{
    EXPECT_ERROR(f.interfaces[0].color[1] = 2, "interfaces[0] 'a': color is 2; it must be from 0 to 1");
    EXPECT_ERROR(f.sections[0].material.albedo[2] = -1,
                 "interfaces[0] 'a', section '1': albedo is -1; it must be from 0 to 1");
    EXPECT_ERROR(f.sections[0].material.roughness = NAN,
                 "interfaces[0] 'a', section '1': roughness is nan; it must be from 0 to 1");
    EXPECT_ERROR(f.inners[0].material.metallic = 1.5f,
                 "tiles[1] 'rim', inner mesh 0: metallic is 1.5; it must be from 0 to 1");
    EXPECT_ERROR(f.inners[0].transform[11] = INFINITY,
                 "tiles[1] 'rim', inner mesh 0: transform is inf; it must be from -1e+06 to 1e+06");
    EXPECT_ERROR(f.inners[0].file = NULL, "tiles[1] 'rim', inner mesh 0: the file name is missing");
    EXPECT_ERROR(f.csg[4].center.y = 3,
                 "interfaces[0] 'a', section '2': center is 3; it must be from -1 to 2");
    EXPECT_ERROR(f.csg[2].size.x = -0.25f,
                 "interfaces[0] 'a', section '2': size is -0.25; it must be from 0 to 4");
    EXPECT_ERROR(f.csg[0].angle = NAN,
                 "interfaces[0] 'a', section '1': angle is nan; it must be from -100 to 100");
    EXPECT_ERROR(f.sweeps[0].turn = 1, "tiles[0] 'flat', sweep 0: turn is 1; it must be from 0 to less than 1");
    EXPECT_ERROR(f.sweeps[0].turns = -65, "tiles[0] 'flat', sweep 0: turns is -65; it must be from -64 to 64");
    EXPECT_ERROR(f.sweeps[0].tangent_scale = -1,
                 "tiles[0] 'flat', sweep 0: tangent_scale is -1; it must be from 0.001 to 1000");
    EXPECT_ERROR(f.interfaces[0].border_only = true,
                 "interfaces[0] 'a': border exempt and border only exclude each other");
}

static void test_tiles(void)
{
    EXPECT_ERROR(f.tiles[0].labels[1] = 0,
                 "tiles[0] 'flat', side 1: no interface; sides 0 to 3 must show one");
    EXPECT_ERROR(f.tiles[0].labels[1] = 3, "tiles[0] 'flat', side 1: label 3; the set has 2 interfaces");
    EXPECT_ERROR(f.tiles[0].labels[1] = INT32_MIN,
                 "tiles[0] 'flat', side 1: label -2147483648; the set has 2 interfaces");
    EXPECT_ERROR(f.tiles[0].labels[4] = 1,
                 "tiles[0] 'flat', side 4: shows an interface, but the tile has 4 sides");
    EXPECT_ERROR(f.tiles[0].side_count = 5,
                 "tiles[0] 'flat': has 5 sides; it must have 4, or 6 with top and bottom");
    EXPECT_ERROR(f.sweeps[0].to_side = 4, "tiles[0] 'flat', sweep 0: leads to side 4; the tile has 4 sides");
    EXPECT_ERROR(f.sweeps[1].to_side = 5,
                 "tiles[1] 'rim', sweep 0: leads to side 5, which shows no interface");
    EXPECT_ERROR(f.sweeps[1].from_side = 0,
                 "tiles[1] 'rim', sweep 0: leads from a cross-section that side 0 does not show");
    EXPECT_ERROR(f.sweeps[0].from_section = 7,
                 "tiles[0] 'flat', sweep 0: leads from a cross-section that side 0 does not show");
    EXPECT_ERROR(f.tiles[0].ignored = f.tiles[1].ignored = true,
                 "tile set: there is no tile that is not ignored");
}

static void test_structure(void)
{
    EXPECT_ERROR(f.tiles[1].sweep_begin = 0, "tile set: sweeps or inner meshes of tile 1 out of range");
    EXPECT_ERROR(f.tiles[1].sweep_count = UINT32_MAX,
                 "tile set: sweeps or inner meshes of tile 1 out of range");
    EXPECT_ERROR(f.tiles[1].inner_count = 2, "tile set: sweeps or inner meshes of tile 1 out of range");
    EXPECT_ERROR(f.tiles[1].inner_count = 0,
                 "tile set: cross-sections, sweeps or inner meshes that belong to nothing");
    EXPECT_ERROR(f.interfaces[1].section_count = 1,
                 "tile set: cross-sections of interface 1 out of range");
    EXPECT_ERROR(f.sections[1].interface = 1,
                 "tile set: cross-section 1 belongs to another interface than 0");
    EXPECT_ERROR(f.csg[3].right = 3, "drawings: the drawing is not a tree (node 3)");
    EXPECT_ERROR(f.csg[3].right = 1, "drawings: the drawing is not a tree (node 3)");
    EXPECT_ERROR(f.csg[5].right = 2, "drawings: the drawing is not a tree (node 5)");
    EXPECT_ERROR(f.csg[0].kind = (MesoCsgKind)9, "drawings: node 0 of the drawings has the unknown kind 9");
    EXPECT_ERROR(f.sections[1].csg_root = 6,
                 "interfaces[0] 'a', section '2': the cross-section has no drawing of its own");
    EXPECT_ERROR(f.sections[1].csg_root = 0,
                 "interfaces[0] 'a', section '2': the cross-section has no drawing of its own");
    EXPECT_ERROR(f.sections[1].csg_root = 4,
                 "interfaces[0] 'a', section '2': the cross-section has no drawing of its own");
}

static void test_warnings(void)
{
    EXPECT_WARNINGS(, "");
    EXPECT_WARNINGS(f.csg[0].size.y = 0,
                    "interfaces[0] 'a', section '1': the drawing has no area; nothing will be seen of it\n");
    EXPECT_WARNINGS(f.csg[1].size.y = f.csg[2].size.x = 0,
                    "interfaces[0] 'a', section '2': the drawing has no area; nothing will be seen of it\n");
    EXPECT_WARNINGS(f.csg[1].size.y = 0, "");
    EXPECT_WARNINGS(f.tiles[1].ignored = true, "interfaces[1] 'edge': no tile uses the interface\n");

    /* One that shows "a" on every side matches nothing, unless it may be flipped. */
    EXPECT_WARNINGS(f.tiles[1].ignored = true; f.tiles[0].flip_y = true, 
                    "interfaces[1] 'edge': no tile uses the interface\n");
    EXPECT_WARNINGS(f.tiles[1].ignored = true; f.tiles[0].labels[2] = f.tiles[0].labels[3] = 1,
                    "interfaces[0] 'a': nothing can match it: a tile that shows \"a'\", or that may be "
                    "flipped, is needed\n"
                    "interfaces[1] 'edge': no tile uses the interface\n"
                    "tiles[0] 'flat', side 0: can neither match a side nor lie on the border, so the tile "
                    "can never be used\n"
                    "tiles[0] 'flat', side 1: can neither match a side nor lie on the border, so the tile "
                    "can never be used\n"
                    "tiles[0] 'flat', side 2: can neither match a side nor lie on the border, so the tile "
                    "can never be used\n"
                    "tiles[0] 'flat', side 3: can neither match a side nor lie on the border, so the tile "
                    "can never be used\n"
                    "tiles[0] 'flat': the tile can never have a neighbour\n");
    EXPECT_WARNINGS(f.tiles[1].sweep_begin = 0; f.tiles[1].sweep_count = 0; f.tiles[0].sweep_count = 0;
                    f.set.sweep_count = 0; f.tiles[1].labels[1] = f.tiles[1].labels[2] =
                    f.tiles[1].labels[3] = 2,
                    "tiles[1] 'rim': the tile can never have a neighbour\n");
}

/* A chain to the left is one level, however long; to the right each node is one more. */
static void test_nesting(void)
{
    enum { LEAVES = 200, NODES = 2 * LEAVES - 1 };
    for (uint32_t rights = MESO_CSG_NESTING - 1; rights <= MESO_CSG_NESTING; rights++) {
        Fixture f;
        make(&f);
        MesoCsgNode csg[NODES];
        uint32_t count = 0;
        for (uint32_t i = 0; i < LEAVES; i++)
            csg[count++] = leaf(MESO_CSG_DISC);
        uint32_t root = LEAVES - 1;
        for (uint32_t i = 1; i < LEAVES; i++) {
            bool right = i <= rights;
            csg[count] = (MesoCsgNode){.kind = MESO_CSG_UNION, .left = right ? i - 1 : root,
                                       .right = right ? root : i - 1};
            root = count++;
        }
        f.sections[0].csg_root = root;
        f.interfaces[0].section_count = 1;
        f.interfaces[1].section_begin = 1;
        f.set.section_count = 1;
        f.set.csg = csg;
        f.set.csg_count = count;
        f.sweeps[0].to_section = f.sweeps[1].from_section = f.sweeps[1].to_section = 0;
        expect(&f, rights >= MESO_CSG_NESTING,
               rights < MESO_CSG_NESTING ? "" : "drawings: the drawing has more than 64 levels\n");
    }
}

static void test_empty(void)
{
    MesoTileSet set = {0};
    Heard heard = check_set(&set);
    CHECK(heard.errors == 1 && strcmp(heard.text, "tile set: there is no tile\n") == 0);
    set.section_count = 1;
    CHECK(check_set(&set).errors == 1);
    set.section_count = 0;
    set.interface_count = UINT32_MAX;
    CHECK(check_set(&set).errors == 1);
}

int main(void)
{
    test_names();
    test_values();
    test_tiles();
    test_structure();
    test_warnings();
    test_nesting();
    test_empty();
    return 0;
}
