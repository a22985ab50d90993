/* Swatches of meshes: windings, fans, axes, materials, open ends, periods found and refused, and repetition. */
#include "libcore/quilt/swatch/swatch.h"

#include "libcore/quilt/swatch/swatch_fixture.h"

static MesoArena arena;
static MesoError error;

static const MesoSwatchOptions UP = {.up = 2, .periodic = -1};

/* ---- meshes of triangles, by hand ---- */

typedef struct Sketch {
    MesoVec3 positions[512];
    uint32_t corners[3 * 1024];
    MesoPolygonMesh mesh;
} Sketch;

static void begin(Sketch *sketch)
{
    sketch->mesh = (MesoPolygonMesh){.side_count = 3, .positions = sketch->positions, .corners = sketch->corners};
}

static void triangle(Sketch *sketch, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *corners = sketch->corners + sketch->mesh.corner_count;
    corners[0] = a;
    corners[1] = b;
    corners[2] = c;
    sketch->mesh.corner_count += 3;
    sketch->mesh.face_count++;
}

/* A tetrahedron with a right angle at (x, y, z), wound outward. */
static void tetrahedron(Sketch *sketch, float x, float y, float z, float side)
{
    uint32_t v = sketch->mesh.vertex_count;
    MesoVec3 at[4] = {{x, y, z}, {x + side, y, z}, {x, y + side, z}, {x, y, z + side}};
    memcpy(sketch->positions + v, at, sizeof at);
    sketch->mesh.vertex_count += 4;
    triangle(sketch, v, v + 2, v + 1);
    triangle(sketch, v, v + 1, v + 3);
    triangle(sketch, v, v + 3, v + 2);
    triangle(sketch, v + 1, v + 2, v + 3);
}

/* A square tube along x from `from` to `to`, open at both ends; `inside_out`: wound inward. */
static void tube(Sketch *sketch, float from, float to, float y, float z, uint32_t rings, bool inside_out)
{
    static const float square[4][2] = {{0, 0}, {0.2f, 0}, {0.2f, 0.2f}, {0, 0.2f}};
    uint32_t first = sketch->mesh.vertex_count;
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t k = 0; k < 4; k++) {
            float t = (float)r / (float)(rings - 1);
            sketch->positions[sketch->mesh.vertex_count++] =
                (MesoVec3){from + (to - from) * t, y + square[k][0], z + square[k][1] + (r % 2 ? 0.02f : 0)};
        }
    for (uint32_t r = 0; r + 1 < rings; r++)
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t a = first + 4 * r + k, b = first + 4 * r + (k + 1) % 4;
            triangle(sketch, a, inside_out ? b + 4 : b, inside_out ? b : b + 4);
            triangle(sketch, a, inside_out ? a + 4 : b + 4, inside_out ? b + 4 : a + 4);
        }
}

static MesoSwatch build(const Sketch *sketch, MesoSwatchOptions options)
{
    MesoSwatch swatch;
    CHECK(meso_polygon_mesh_check(&sketch->mesh, 1, NULL, &error) == MESO_OK);
    CHECK(meso_swatch_build(&swatch, &arena, &sketch->mesh, &options, &error) == MESO_OK);
    check_swatch(&swatch);
    return swatch;
}

/* ---- tests ---- */

/* One element each, whatever the order of faces; a vertex that two of them share becomes two. */
static void test_elements(void)
{
    static Sketch sketch;
    begin(&sketch);
    tetrahedron(&sketch, 0, 0, 0, 1);
    tetrahedron(&sketch, 3, 0, 0, 1);
    for (uint32_t c = 12; c < 24; c++)      /* the second one's corner is the first one's */
        sketch.corners[c] = sketch.corners[c] == 4 ? 1 : sketch.corners[c];
    MesoSwatch s = build(&sketch, UP);
    CHECK(s.element_count == 2 && s.vertex_count == 8 && s.open_edge_count == 0 && s.loop_count == 0);
    CHECK(s.vertex_begin[1] == 4 && s.triangle_begin[1] == 4 && element_euler(&s, 0) == 2 && element_euler(&s, 1) == 2);
    CHECK(s.size.z == 1 && s.material_count == 1 && strcmp(s.material_names[0], "none") == 0);
}

/* Inside out, closed or open: turned, and what they are told of normals with them. */
static void test_outward(void)
{
    static Sketch sketch;
    begin(&sketch);
    tube(&sketch, 0, 4, 0, 0, 6, true);
    MesoVec3 normals[24];
    for (uint32_t v = 0; v < 24; v++)
        normals[v] = (MesoVec3){0, 0, v % 4 < 2 ? 3.0f : -3.0f};    /* up where the tube looks down */
    MesoAttribute given = {.name = "normal", .domain = MESO_ON_VERTICES, .width = 3, .entry_count = 24,
                           .values = normals};
    sketch.mesh.attributes = &given;
    sketch.mesh.attribute_count = 1;
    MesoSwatch s = build(&sketch, UP);
    CHECK(s.element_count == 1 && s.open_edge_count == 8 && s.loop_count == 2 && s.kinds[0] == MESO_ELEMENT_STRAND);
    for (uint32_t v = 0; v < s.vertex_count; v++)
        CHECK(s.normals[v].z == (v % 4 < 2 ? -1 : 1));
    double volume = 0;
    for (uint32_t t = 0; t < s.triangle_count; t++) {
        MesoVec3 p = s.positions[s.corners[3 * t]], q = s.positions[s.corners[3 * t + 1]];
        MesoVec3 centre = s.centres[0], r = s.positions[s.corners[3 * t + 2]];
        MesoVec3 area = meso_vec3_cross(meso_vec3_sub(q, p), meso_vec3_sub(r, p));
        volume += (double)meso_vec3_dot(meso_vec3_sub(p, centre), area);
    }
    CHECK(volume > 0);
}

/* What is up is turned to z; the thinnest side by itself. */
static void test_up(void)
{
    static Sketch sketch;
    for (int up = 0; up < 3; up++) {
        begin(&sketch);
        tube(&sketch, 0, 4, 0, 0, 6, false);
        tube(&sketch, 0, 4, 1, 0, 6, false);
        for (uint32_t v = 0; v < sketch.mesh.vertex_count; v++) {
            MesoVec3 p = sketch.positions[v];
            sketch.positions[v] = up == 2 ? p : up == 1 ? (MesoVec3){p.x, p.z, -p.y} : (MesoVec3){p.z, p.x, p.y};
        }
        MesoSwatch given = build(&sketch, (MesoSwatchOptions){.up = up, .periodic = -1});
        MesoSwatch found = build(&sketch, (MesoSwatchOptions){.up = -1, .periodic = -1});
        CHECK(given.size.x == 4 && fabsf(given.size.y - 2) < 1e-5f && fabsf(given.size.z - 0.22f) < 1e-5f);
        CHECK(memcmp(found.positions, given.positions, given.vertex_count * sizeof *given.positions) == 0);
    }
}

/*
 * Tubes along x, side by side. By their ends they are periodic along x, by being equal along y: with `shift`, by which
 * the last one stands off, they are not along y; with `bent`, by which an end does, not along x.
 */
static MesoSwatch tubes(float shift, float bent, MesoSwatchOptions options, MesoStatus expected)
{
    static Sketch sketch;
    MesoSwatch swatch;
    begin(&sketch);
    for (uint32_t i = 0; i < 3; i++)
        tube(&sketch, 0, 4, (float)i + (i == 2 ? shift : 0), 0, 9, false);
    sketch.positions[sketch.mesh.vertex_count - 1].z += bent;
    CHECK(meso_swatch_build(&swatch, &arena, &sketch.mesh, &options, &error) == expected);
    if (!expected)
        check_swatch(&swatch);
    return swatch;
}

static void test_periods(void)
{
    MesoSwatch s = tubes(0, 0, UP, MESO_OK);
    CHECK(s.periodic_x && s.periodic_y && s.size.x == 4 && fabsf(s.size.y - 3) < 1e-5f);
    CHECK(s.period.x == 1 && fabsf(s.period.y - 1) < 1e-5f);     /* of two rings, and from tube to tube */
    s = tubes(0, 1e-4f, UP, MESO_OK);       /* within a hundredth of an edge */
    CHECK(s.periodic_x);
    s = tubes(0.1f, 0, UP, MESO_OK);
    CHECK(s.periodic_x && !s.periodic_y && s.period.y == 0 && fabsf(s.size.y - 3.2f) < 1e-5f);
    s = tubes(0, 0.1f, UP, MESO_OK);
    CHECK(!s.periodic_x && !s.periodic_y && s.size.x == 4 && s.period.x == 0);
    for (uint32_t v = 0; v < s.vertex_count; v++)
        CHECK(s.mates[v] == MESO_NO_INDEX);
    tubes(0.1f, 0, (MesoSwatchOptions){.up = 2, .periodic = 3}, MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "the swatch is not periodic along y");
    tubes(0, 0.1f, (MesoSwatchOptions){.up = 2, .periodic = 1}, MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "the swatch is not periodic along x");
    s = tubes(0.1f, 0, (MesoSwatchOptions){.up = 2, .periodic = 1}, MESO_OK);
    CHECK(s.periodic_x && !s.periodic_y);
    s = tubes(0, 0, (MesoSwatchOptions){.up = 2}, MESO_OK);
    CHECK(!s.periodic_x && !s.periodic_y);
    s = tubes(0.1f, 0, (MesoSwatchOptions){.up = 2, .periodic = -1, .period = {0, 5}}, MESO_OK);
    CHECK(s.periodic_y && s.size.y == 5);
}

/* In rows of equals: elements alone have a period, but not where one is missing, or different. */
static void test_rows(void)
{
    static Sketch sketch;
    for (int kind = 0; kind < 3; kind++) {
        begin(&sketch);
        for (uint32_t i = 0; i < 12; i++)
            if (kind != 1 || i != 5)
                tetrahedron(&sketch, (float)(i % 4), 2 * (float)(i / 4), 0, kind == 2 && i == 5 ? 0.5f : 0.4f);
        MesoSwatch s = build(&sketch, UP);
        CHECK(s.periodic_x == (kind == 0) && s.periodic_y == (kind == 0));
        CHECK(fabsf(s.size.x - 4) < 0.1f && fabsf(s.size.y - 6) < 0.1f);
        CHECK(fabsf(s.period.x - (kind == 0 ? 1 : 0)) < 1e-5f && fabsf(s.period.y - (kind == 0 ? 2 : 0)) < 1e-5f);
    }
}

/* The tile is the same; its period is what maps triangles onto such of the same material, and of the same shape. */
static void test_finest_period(void)
{
    static Sketch sketch;
    static const float periods[] = {1, 2, 4, 8};
    for (uint32_t kind = 0; kind < 4; kind++) {
        uint32_t materials[4 * 16];
        const char *names[2] = {"even", "odd"};
        begin(&sketch);
        for (uint32_t i = 0; i < 16; i++) {
            tetrahedron(&sketch, (float)(i % 8), (float)(i / 8), kind == 3 && i == 5 ? 0.002f : 0, 0.4f);
            for (uint32_t t = 0; t < 4; t++)
                materials[4 * i + t] = kind == 1 ? i % 2 : kind == 2 ? i % 4 == 3 : 0;
        }
        MesoAttribute attribute = {.name = "material", .domain = MESO_ON_FACES, .entry_count = 2, .names = names,
                                   .entry_of = materials};
        sketch.mesh.attribute_count = 1;
        sketch.mesh.attributes = &attribute;
        MesoSwatch s = build(&sketch, UP);
        CHECK(s.periodic_x && s.periodic_y && fabsf(s.size.x - 8) < 1e-4f && fabsf(s.size.y - 2) < 1e-4f);
        CHECK(fabsf(s.period.x - (kind == 3 ? 1 : periods[kind])) < 1e-4f && fabsf(s.period.y - 1) < 1e-4f);
        sketch.mesh.attribute_count = 0;
    }
}

/* Strands go on through the copies, and meet at the far ends as before; again and again comes to the same. */
static void test_repeat(void)
{
    MesoSwatch s = tubes(0, 0, UP, MESO_OK), larger, again, at_once;
    CHECK(meso_swatch_repeat(&larger, &arena, &s, (MesoVec2){7.9f, 3.1f}, &error) == MESO_OK);
    check_swatch(&larger);
    CHECK(larger.size.x == 2 * s.size.x && larger.size.y == 2 * s.size.y && larger.period.x == s.period.x);
    CHECK(larger.element_count == 6 && larger.triangle_count == 4 * s.triangle_count && larger.loop_count == 12);
    CHECK(larger.vertex_count == 4 * s.vertex_count - 6 * 4 && larger.material_count == s.material_count);
    CHECK(meso_swatch_repeat(&again, &arena, &larger, (MesoVec2){2 * larger.size.x, 0}, &error) == MESO_OK);
    CHECK(meso_swatch_repeat(&at_once, &arena, &s, (MesoVec2){4 * s.size.x, 2 * s.size.y}, &error) == MESO_OK);
    check_swatch(&again);
    CHECK(again.element_count == at_once.element_count && again.vertex_count == at_once.vertex_count &&
          again.size.x == at_once.size.x && again.open_edge_count == at_once.open_edge_count);
    s = tubes(0.1f, 0, UP, MESO_OK);        /* along x alone */
    CHECK(meso_swatch_repeat(&larger, &arena, &s, (MesoVec2){16, 16}, &error) == MESO_OK);
    CHECK(larger.size.x == 16 && larger.size.y == s.size.y && larger.element_count == 3);
    CHECK(meso_swatch_repeat(&larger, &arena, &s, (MesoVec2){1e30f, 1}, &error) == MESO_ERR_LIMIT);
    CHECK(meso_swatch_repeat(&larger, &arena, &s, (MesoVec2){NAN, 1}, &error) == MESO_OK && larger.size.x == 4);
    s = tubes(0.1f, 0.1f, UP, MESO_OK);
    CHECK(meso_swatch_repeat(&larger, &arena, &s, (MesoVec2){16, 16}, &error) == MESO_ERR_INTERNAL);
}

/* By name, with what the first face of each says of it; texture coordinates with a seam, and without. */
static void test_attributes(void)
{
    static Sketch sketch;
    begin(&sketch);
    tetrahedron(&sketch, 0, 0, 0, 1);
    const char *names[3] = {"unused", "tin", "oak"};
    uint32_t material_of[4] = {2, 1, MESO_NO_INDEX, 2}, corner_of[12] = {0};
    float rough[4] = {0.25f, 2, 0.5f, 1}, albedo[12] = {1, 0.5f, 0};
    MesoVec2 uvs[12] = {{0.25f, 0.75f}, {1, 1}};
    MesoAttribute attributes[4] = {
        {.name = "material", .domain = MESO_ON_FACES, .entry_count = 3, .names = names, .entry_of = material_of},
        {.name = "roughness", .domain = MESO_ON_FACES, .width = 1, .entry_count = 4, .values = rough},
        {.name = "albedo", .domain = MESO_ON_FACES, .width = 3, .entry_count = 4, .values = albedo},
        {.name = "uv", .domain = MESO_ON_CORNERS, .width = 2, .entry_count = 12, .values = uvs, .entry_of = corner_of}};
    sketch.mesh.attributes = attributes;
    sketch.mesh.attribute_count = 4;
    MesoSwatch s = build(&sketch, UP);
    uint32_t expected[4] = {0, 1, 2, 0};
    CHECK(s.material_count == 3 && memcmp(s.materials, expected, sizeof expected) == 0);
    CHECK_TEXT(s.material_names[0], "oak");
    CHECK_TEXT(s.material_names[2], "none");
    CHECK(s.looks[0].roughness == 0.25f && s.looks[1].roughness == 1 && s.looks[0].albedo[1] == 0.5f);
    CHECK(s.uvs && !s.corner_uvs && s.uvs[3].y == 0.75f);
    corner_of[11] = 1;
    s = build(&sketch, UP);
    CHECK(s.uvs && s.corner_uvs && s.corner_uvs[11].x == 1 && s.corner_uvs[10].x == 0.25f);
}

/* No faces; an edge of three faces; one side only. */
static void test_refused(void)
{
    static Sketch sketch;
    MesoSwatch s;
    begin(&sketch);
    CHECK(meso_swatch_build(&s, &arena, &sketch.mesh, &UP, &error) == MESO_ERR_INPUT);
    tetrahedron(&sketch, 0, 0, 0, 1);
    sketch.positions[sketch.mesh.vertex_count++] = (MesoVec3){-1, -1, -1};
    triangle(&sketch, 0, 1, 4);
    CHECK(meso_swatch_build(&s, &arena, &sketch.mesh, &UP, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "joins more than two faces"));
    uint32_t band[15] = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 0, 4, 0, 1};
    begin(&sketch);
    for (uint32_t i = 0; i < 5; i++) {
        sketch.positions[sketch.mesh.vertex_count++] = (MesoVec3){(float)i, (float)(i * i), (float)(i % 2)};
        triangle(&sketch, band[3 * i], band[3 * i + 1], band[3 * i + 2]);
    }
    CHECK(meso_swatch_build(&s, &arena, &sketch.mesh, &UP, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "face 1: its surface has one side only");
}

int main(void)
{
    meso_arena_init(&arena);
    test_elements();
    test_outward();
    test_up();
    test_periods();
    test_rows();
    test_finest_period();
    test_repeat();
    test_attributes();
    test_refused();
    meso_arena_release(&arena);
    return 0;
}
