/* Cross-sections as shapes. */
#include <math.h>
#include <string.h>

#include "cmd/grow/grow_section.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

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

int main(void)
{
    meso_arena_init(&arena);
    test_sections();
    meso_arena_release(&arena);
    return 0;
}
