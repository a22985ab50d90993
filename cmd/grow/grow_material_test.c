/* Materials as texts have them, cross-sections as shapes, and the surface below. */
#include <math.h>

#include "cmd/grow/grow_backdrop.h"
#include "cmd/grow/grow_material.h"
#include "cmd/grow/grow_section.h"
#include "formats/mesh/mesh_read.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

/* ---- materials ---- */

static MesoMaterial look_of(const char *text, const char *wanted)
{
    MesoMaterial look = {{0.5f, 0.25f, 0.125f}, 0.75f, 0.5f};
    char name[MESO_GROW_NAME];
    CHECK(meso_grow_material(&look, name, text, &error) == MESO_OK);
    CHECK_TEXT(name, wanted);
    return look;
}

static bool is_near(float a, double b)
{
    return fabs((double)a - b) < 1e-5;
}

static void test_materials(void)
{
    MesoMaterial look = look_of("clay", "clay");
    CHECK(look.albedo[0] == 0.5f && look.roughness == 0.75f && look.metallic == 0.5f);
    /* sRGB: 0 and 255 are 0 and 1, and 0x80 is (0.50196 + 0.055) / 1.055 to the power of 2.4 */
    look = look_of("leaf #ff0080", "leaf");
    CHECK(look.albedo[0] == 1 && look.albedo[1] == 0 && is_near(look.albedo[2], 0.2158605));
    CHECK(look.roughness == 0.75f && look.metallic == 0.5f);
    look = look_of("leaf #0A0a0a 0.5", "leaf");
    CHECK(is_near(look.albedo[1], 10 / 255.0 / 12.92) && look.roughness == 0.5f && look.metallic == 0.5f);
    look = look_of("steel #9a9a98 0 1", "steel");
    CHECK(look.roughness == 0 && look.metallic == 1);
    static const char *const wrong[] = {"", "#ffffff", "leaf green", "leaf #fff", "leaf #fffffff", "leaf #ggffff",
                                        "leaf #ffffff rough", "leaf #ffffff 2", "leaf #ffffff -1",
                                        "leaf #ffffff 0.5 1.5", "leaf #ffffff nan", "leaf #ffffff 0.5 0 0",
                                        "leaf #ffffff 0.5.5", "leaf #ffffff 0x1"};
    for (uint32_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char name[MESO_GROW_NAME];
        look = (MesoMaterial){{0.5f, 0.25f, 0.125f}, 0.75f, 0.5f};
        if (meso_grow_material(&look, name, wrong[i], &error) != MESO_ERR_INPUT) {
            fprintf(stderr, "taken: '%s'\n", wrong[i]);
            exit(1);
        }
        CHECK(look.albedo[0] == 0.5f && strstr(error.message, "a name is wanted, or NAME #rrggbb"));
    }
    char name[MESO_GROW_NAME], text[100];
    memset(text, 'x', sizeof text);
    text[99] = '\0';
    CHECK(meso_grow_material(&look, name, text, &error) == MESO_ERR_INPUT);
}

/* ---- cross-sections ---- */

static const char tiles[] =
    "{\"format\": \"meso-tiles\", \"version\": 1, \"defaults\": {\"flip_x\": true}, \"interfaces\": ["
    "{\"name\": \"a\", \"sections\": ["
    "{\"name\": \"box\", \"shape\": {\"box\": {\"center\": [0.5, 0.25], \"size\": [0.5, 0.2]}}},"
    "{\"name\": \"pipe\", \"shape\": {\"difference\": [{\"disc\": {\"center\": [0.5, 0.5], \"size\": [0.6, 0.6]}},"
    "{\"disc\": {\"center\": [0.5, 0.5], \"size\": [0.4, 0.4]}}]}}]},"
    "{\"name\": \"b\", \"sections\": ["
    "{\"name\": \"box\", \"shape\": {\"box\": {\"center\": [0.5, 0.5], \"size\": [0.2, 0.2]}}}]}],"
    "\"tiles\": [{\"name\": \"t\", \"sides\": [\"a\", \"b\", \"a'\", \"b\"],"
    "\"sweeps\": [{\"from\": \"0/box\", \"to\": \"2/box\"}, {\"from\": \"0/pipe\", \"to\": \"2/pipe\"},"
    "{\"from\": \"1/box\", \"to\": \"3/box\"}]}]}";

/* Twice the area of the outline of a ring, by the sum over the sides that close it: holes count against it. */
static double area_of(const MesoTerminalShape *shape)
{
    const MesoBody *body = &shape->body;
    double area = 0;
    for (uint32_t f = 0; f < body->face_count; f++)
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3 a = body->positions[body->corners[3 * f + k]];
            MesoVec3 b = body->positions[body->corners[3 * f + (k + 1) % 3]];
            if (a.x == 0 && b.x == 0)
                area += (double)a.z * (double)b.y - (double)a.y * (double)b.z;
        }
    return fabs(area);
}

/* Sides in the plane x = 0 that end where no other begins. */
static uint32_t open_ends(const MesoTerminalShape *shape)
{
    const MesoBody *body = &shape->body;
    uint32_t open = 0;
    for (uint32_t v = 0; v < body->vertex_count; v++) {
        int balance = 0;
        MesoVec3 p = body->positions[v];
        for (uint32_t c = 0; c < 3 * body->face_count; c++) {
            MesoVec3 a = body->positions[body->corners[c]];
            MesoVec3 b = body->positions[body->corners[c % 3 == 2 ? c - 2 : c + 1]];
            if (a.x != 0 || b.x != 0 || p.x != 0)
                continue;
            balance += memcmp(&a, &p, sizeof a) == 0;
            balance -= memcmp(&b, &p, sizeof b) == 0;
        }
        open += balance != 0;
    }
    return open;
}

/* Triangles are wound as their normals look, and these look out of what is filled. */
static void check_outward(const MesoTerminalShape *shape)
{
    const MesoBody *body = &shape->body;
    for (uint32_t f = 0; f < body->face_count; f++) {
        MesoVec3 p[3], sum = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            p[k] = body->positions[body->corners[3 * f + k]];
            sum = meso_vec3_add(sum, body->normals[body->corners[3 * f + k]]);
            CHECK(fabsf(meso_vec3_length(body->normals[body->corners[3 * f + k]]) - 1) < 1e-5f);
        }
        CHECK(meso_vec3_dot(meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0])), sum) > 0);
    }
}

/* By the divergence theorem: what normals that look outward give is the area. */
static double area_by_normals(const MesoTerminalShape *shape)
{
    const MesoBody *body = &shape->body;
    double area = 0;
    for (uint32_t f = 0; f < body->face_count; f++) {
        MesoVec3 p[3], middle = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            p[k] = body->positions[body->corners[3 * f + k]];
            middle = meso_vec3_mad(middle, 1 / 3.0f, p[k]);
        }
        MesoVec3 flat = meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0]));
        area += 0.25 * ((double)flat.y * (double)middle.y + (double)flat.z * (double)middle.z);
    }
    return area;
}

static MesoTerminalShape section_of(const MesoTileSet *set, const char *name, const char *wanted)
{
    MesoTerminalShape shape;
    uint32_t section;
    MesoStatus status = meso_grow_section(&shape, &section, &arena, set, name, &error);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(!status);
    CHECK_TEXT(set->sections[section].name, wanted);
    CHECK(open_ends(&shape) == 0);
    check_outward(&shape);
    CHECK(fabs(2 * area_by_normals(&shape) - area_of(&shape)) < 1e-4);
    return shape;
}

static void refuse_section(const MesoTileSet *set, const char *name, const char *message)
{
    MesoTerminalShape shape;
    uint32_t section;
    CHECK(meso_grow_section(&shape, &section, &arena, set, name, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

static void test_sections(void)
{
    MesoInput input;
    MesoTileSet set;
    meso_input_wrap(&input, "s.tiles.json", tiles, strlen(tiles));
    MesoStatus status = meso_tiles_read(&set, &arena, &input, &error);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(!status);
    /* a box of 5 to 2, as wide as 1: four sharp sides of two points each */
    MesoTerminalShape box = section_of(&set, NULL, "box");
    CHECK(fabs(area_of(&box) - 2 * 0.4) < 1e-4);
    section_of(&set, "a/box", "box");
    MesoTerminalShape other = section_of(&set, "b/box", "box");
    CHECK(fabs(area_of(&other) - 2) < 1e-4);
    /* a disk of width 1 with a hole of two thirds: the hole's normals look into it */
    MesoTerminalShape pipe = section_of(&set, "pipe", "pipe");
    CHECK(fabs(area_of(&pipe) - 2 * acos(-1) / 4 * (1 - 4 / 9.0)) < 2e-2);
    refuse_section(&set, "box",
                   "cross-sections of several interfaces have the name 'box': give INTERFACE/SECTION");
    refuse_section(&set, "pip", "no cross-section 'pip'; did you mean 'pipe'?");
    refuse_section(&set, "a/pip", "no cross-section 'a/pip'; did you mean 'a/pipe'?");
    refuse_section(&set, "zzz", "no cross-section 'zzz'; there is 'a/box'");
}

/* ---- the surface below ---- */

static const char quads[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n";

static void test_backdrop(void)
{
    MesoTool tool = {.quiet = true, .threads = 1};
    MesoInput input;
    MesoPolygonMesh mesh;
    meso_arena_init(&tool.arena);
    meso_input_wrap(&input, "q.obj", quads, strlen(quads));
    CHECK(!meso_polygon_mesh_read(&mesh, &tool.arena, &input, 1, &tool.error));
    /* a scene of one body with ids of two channels, of which one has names */
    const char *names[1] = {"only"}, *materials[1] = {"red"};
    MesoMaterial looks[1] = {{{1, 0, 0}, 0.5f, 0}};
    MesoVec3 corner[3] = {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
    uint32_t triangle[3] = {0, 1, 2}, ids[2] = {3, 0};
    MesoBody body = {.vertex_count = 3, .face_count = 1, .face_width = 3, .positions = corner, .normals = corner,
                     .corners = triangle};
    MesoPlacedBody placed = {.place = MESO_PLACED_HERE};
    MesoScene scene = {.channel_count = 2, .material_count = 1, .materials = looks, .material_names = materials,
                       .id_row_count = 1, .ids = ids, .body_count = 1, .placed_count = 1, .bodies = &body,
                       .placed = &placed};
    scene.channels[0] = (MesoIdChannel){"branch", 4, NULL};
    scene.channels[1] = (MesoIdChannel){"rule", 1, names};
    CHECK(meso_grow_backdrop(&scene, &tool, &mesh, "clay #") == MESO_ERR_USAGE);
    CHECK(strncmp(tool.error.message, "--surface: material 'clay #'", 28) == 0 && scene.body_count == 1);
    CHECK(!meso_grow_backdrop(&scene, &tool, &mesh, "clay #ffffff 0.25"));
    CHECK(scene.material_count == 2 && strcmp(scene.material_names[1], "clay") == 0);
    CHECK(scene.materials[1].albedo[2] == 1 && scene.materials[1].roughness == 0.25f);
    CHECK(scene.materials[0].albedo[0] == 1 && strcmp(scene.material_names[0], "red") == 0);
    CHECK(scene.id_row_count == 2 && scene.ids[0] == 3 && scene.ids[2] == 4 && scene.ids[3] == 1);
    CHECK(scene.channels[0].count == 5 && scene.channels[1].count == 2);
    CHECK(strcmp(scene.channels[1].names[0], "only") == 0 && strcmp(scene.channels[1].names[1], "surface") == 0);
    CHECK(scene.body_count >= 2 && scene.placed_count == scene.body_count && scene.bodies[0].positions == corner);
    uint32_t faces = 0;
    for (uint32_t i = 1; i < scene.placed_count; i++) {
        CHECK(scene.placed[i].body == i && scene.placed[i].material == 1 && scene.placed[i].ids == 1);
        faces += scene.bodies[i].face_count;
    }
    CHECK(faces == 2 && scene.box.low.x == 0 && scene.box.high.y == 6);
    meso_arena_release(&tool.arena);
}

int main(void)
{
    meso_arena_init(&arena);
    test_materials();
    test_sections();
    test_backdrop();
    meso_arena_release(&arena);
    return 0;
}
