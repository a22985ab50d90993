#include "libcore/quilt/base/quilt_base.h"

#include "libcore/mesh/cut/border_loops.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

static MesoVec3 position_in(const MesoTriangulation *original, uint32_t triangle, MesoVec2 weights)
{
    const uint32_t *corner = &original->corners[3 * (size_t)triangle];
    MesoVec3 p = meso_vec3_scale(original->positions[corner[0]], 1 - weights.x - weights.y);
    p = meso_vec3_mad(p, weights.x, original->positions[corner[1]]);
    return meso_vec3_mad(p, weights.y, original->positions[corner[2]]);
}

static bool is_beyond(const MesoQuiltBase *base, uint32_t t)
{
    for (uint32_t k = 0; k < 3; k++)
        if (base->inside && base->inside[base->mesh.corners[3 * t + k]] < 0)
            return true;
    return false;
}

static double area_of(const MesoQuiltBase *base, bool beyond)
{
    double sum = 0;
    for (uint32_t t = 0; t < base->mesh.triangle_count; t++) {
        const uint32_t *c = &base->mesh.corners[3 * (size_t)t];
        MesoVec3 a = base->mesh.positions[c[0]];
        MesoVec3 area = meso_vec3_cross(meso_vec3_sub(base->mesh.positions[c[1]], a),
                                        meso_vec3_sub(base->mesh.positions[c[2]], a));
        if (is_beyond(base, t) == beyond)
            sum += 0.5 * meso_vec3_length(area);
    }
    return sum;
}

/* Triangles of flat meshes whose normal does not point up. */
static uint32_t count_turned(const MesoQuiltBase *base)
{
    uint32_t turned = 0;
    for (uint32_t t = 0; t < base->mesh.triangle_count; t++) {
        const uint32_t *c = &base->mesh.corners[3 * (size_t)t];
        MesoVec3 a = base->mesh.positions[c[0]];
        turned += meso_vec3_cross(meso_vec3_sub(base->mesh.positions[c[1]], a),
                                  meso_vec3_sub(base->mesh.positions[c[2]], a)).z <= 0;
    }
    return turned;
}

static float largest_edge(const MesoQuiltBase *base)
{
    float largest = 0;
    for (uint32_t h = 0; h < 3 * base->mesh.triangle_count; h++) {
        MesoVec3 a = base->mesh.positions[base->mesh.corners[h]];
        MesoVec3 b = base->mesh.positions[base->mesh.corners[meso_next_corner(h)]];
        largest = fmaxf(largest, meso_vec3_length(meso_vec3_sub(a, b)));
    }
    return largest;
}

static int euler(const MesoTriangulation *mesh)
{
    uint32_t sides = 0, used = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        sides += mesh->twins[h] == MESO_NO_INDEX || h < mesh->twins[h];
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        used += mesh->vertex_corner[v] != MESO_NO_INDEX;
    return (int)used - (int)sides + (int)mesh->triangle_count;
}

static uint32_t border_count(const MesoTriangulation *mesh)
{
    MesoArena arena;
    MesoError error;
    MesoBorderLoops loops;
    meso_arena_init(&arena);
    CHECK(meso_border_loops_find(&loops, &arena, mesh, NULL, false, &error) == MESO_OK);
    meso_arena_release(&arena);
    return loops.loop_count;
}

/* Builds, and checks what holds for all: a manifold, wound alike, places in the original, its inside told apart. */
static MesoQuiltBase build(MesoArena *arena, const MesoTriangulation *original, float edge, float reach)
{
    MesoQuiltBase base;
    MesoError error = {0};
    CHECK(meso_quilt_base_build(&base, arena, original, NULL, edge, reach, &error) == MESO_OK);
    CHECK(meso_triangulation_check(&base.mesh, &error) == MESO_OK);
    for (uint32_t h = 0; h < 3 * base.mesh.triangle_count; h++)
        if (base.mesh.twins[h] != MESO_NO_INDEX)
            CHECK(base.mesh.corners[base.mesh.twins[h]] == base.mesh.corners[meso_next_corner(h)]);
    for (uint32_t c = 0; c < 3 * base.mesh.triangle_count; c++) {
        MesoVec2 w = base.corner_weights[c];
        CHECK(base.triangles[c / 3] < original->triangle_count);
        if (is_beyond(&base, c / 3))
            continue;
        CHECK(w.x >= 0 && w.y >= 0 && w.x + w.y <= 1.000001f);
        MesoVec3 p = position_in(original, base.triangles[c / 3], w);
        CHECK(meso_vec3_length(meso_vec3_sub(p, base.mesh.positions[base.mesh.corners[c]])) < 2e-6f);
    }
    for (uint32_t t = 0; base.inside && t < base.mesh.triangle_count; t++) {
        float most = 0;
        for (uint32_t k = 0; k < 3; k++)
            most = fmaxf(most, base.inside[base.mesh.corners[3 * t + k]]);
        CHECK(is_beyond(&base, t) ? most == 0 : most > 0);
    }
    return base;
}

static void test_sheet(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTriangulation sheet = meso_fixture_sheet(1, 1, 4);
    MesoQuiltBase base = build(&arena, &sheet, 0.5f, 1.5f);
    CHECK(largest_edge(&base) < 1.7f * 0.5f);
    CHECK(fabs(area_of(&base, false) - 16) < 1e-4);
    /* around a square: four strips, and four quarters of a circle or a little more or less */
    CHECK(fabs(area_of(&base, true) - (4 * 4 * 1.5 + MESO_PI * 1.5 * 1.5)) < 1.5);
    CHECK(count_turned(&base) == 0);
    CHECK(border_count(&base.mesh) == 1 && euler(&base.mesh) == 1);
    meso_quilt_base_release(&base);

    /* not extended, and one triangle alone */
    base = build(&arena, &sheet, 10, 0);
    CHECK(base.mesh.triangle_count == 4 && base.mesh.vertex_count == 5 && base.inside[4] > 0);
    meso_quilt_base_release(&base);
    MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    MesoTriangulation alone = meso_fixture_triangulation(positions, 3, (uint32_t[]){0, 1, 2}, 1);
    base = build(&arena, &alone, 10, 0);
    CHECK(base.mesh.triangle_count == 3 && base.mesh.vertex_count == 4);
    meso_quilt_base_release(&base);
    base = build(&arena, &alone, 0.2f, 0.7f);
    CHECK(count_turned(&base) == 0 && fabs(area_of(&base, false) - 0.5) < 1e-6);
    meso_quilt_base_release(&base);
    meso_triangulation_release(&alone);
    meso_triangulation_release(&sheet);
    meso_arena_release(&arena);
}

/* A ring between two regular polygons, flat or as a cylinder's wall (outer = inner, height). */
static MesoTriangulation ring(uint32_t sides, float inner, float outer, float height)
{
    MesoVec3 positions[256];
    uint32_t corners[6 * 128];
    for (uint32_t i = 0; i < sides; i++) {
        float a = 6.2831853f * (float)i / (float)sides;
        positions[2 * i] = (MesoVec3){outer * cosf(a), outer * sinf(a), 0};
        positions[2 * i + 1] = (MesoVec3){inner * cosf(a), inner * sinf(a), height};
        uint32_t p = 2 * i, q = 2 * ((i + 1) % sides), quad[6] = {p, q, q + 1, p, q + 1, p + 1};
        memcpy(&corners[6 * i], quad, sizeof quad);
    }
    return meso_fixture_triangulation(positions, 2 * sides, corners, 2 * sides);
}

static void test_hole(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    /* the hole is filled */
    MesoTriangulation disk = ring(32, 1, 3, 0);
    MesoQuiltBase base = build(&arena, &disk, 0.3f, 1.5f);
    CHECK(count_turned(&base) == 0);
    CHECK(border_count(&base.mesh) == 1 && euler(&base.mesh) == 1);
    meso_quilt_base_release(&base);
    /* it stays open */
    base = build(&arena, &disk, 0.3f, 0.5f);
    CHECK(count_turned(&base) == 0);
    CHECK(border_count(&base.mesh) == 2 && euler(&base.mesh) == 0);
    CHECK(fabs(area_of(&base, true) - MESO_PI * (3.5 * 3.5 - 9 + 1 - 0.25)) < 0.4);
    meso_quilt_base_release(&base);
    meso_triangulation_release(&disk);
    /* corners of 60, 90 and 120 degrees, in and out */
    for (uint32_t sides = 3; sides <= 6; sides++) {
        disk = ring(sides, 1, 2.5f, 0);
        for (float reach = 0.1f; reach < 1.2f; reach += 0.1f) {
            base = build(&arena, &disk, 0.2f, reach);
            /* in corners as sharp as those of the triangle a few points are pulled back in vain */
            CHECK(count_turned(&base) <= (sides == 3 ? 3 : 0));
            CHECK(border_count(&base.mesh) + (uint32_t)euler(&base.mesh) == 2);
            meso_quilt_base_release(&base);
        }
        meso_triangulation_release(&disk);
    }
    meso_arena_release(&arena);
}

static void test_cylinder(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTriangulation wall = ring(40, 1, 1, 2);
    MesoQuiltBase base = build(&arena, &wall, 0.2f, 1);
    CHECK(border_count(&base.mesh) == 2 && euler(&base.mesh) == 0);
    CHECK(fabs(area_of(&base, true) / area_of(&base, false) - 1) < 0.01);
    for (uint32_t v = 0; v < base.mesh.vertex_count; v++) {
        MesoVec3 p = base.mesh.positions[v];
        CHECK(fabsf(sqrtf(p.x * p.x + p.y * p.y) - 1) < 0.02f);
        float beyond = fmaxf(p.z - 2, -p.z);
        CHECK(base.inside[v] >= 0 || fabsf(beyond + base.inside[v]) < 1e-4f);
    }
    meso_quilt_base_release(&base);
    meso_triangulation_release(&wall);
    meso_arena_release(&arena);
}

/* A closed surface: refined or copied, and its guide carried over. */
static void test_torus(void)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    MesoTriangulation torus = meso_fixture_torus(24, 12, 0.4f);
    MesoQuiltBase base = build(&arena, &torus, 10, 1);
    CHECK(base.mesh.triangle_count == torus.triangle_count && !base.inside);
    CHECK(memcmp(base.mesh.corners, torus.corners, 3 * sizeof(uint32_t) * torus.triangle_count) == 0);
    double area = area_of(&base, false);
    meso_quilt_base_release(&base);
    for (float edge = 0.35f; edge > 0.04f; edge *= 0.8f) {
        base = build(&arena, &torus, edge, 1);
        CHECK(largest_edge(&base) <= 1.0001f * edge && euler(&base.mesh) == 0 && !base.inside);
        CHECK(fabs(area_of(&base, false) - area) < 1e-4 * area);
        meso_quilt_base_release(&base);
    }
    MesoVec3 *guide = MESO_NEW(&arena, MesoVec3, torus.triangle_count, &error);
    for (uint32_t t = 0; t < torus.triangle_count; t++)
        guide[t] = t % 5 == 0 ? (MesoVec3){0, 0, 0} : (MesoVec3){0, 0, 1};
    CHECK(meso_quilt_base_build(&base, &arena, &torus, guide, 0.1f, 1, &error) == MESO_OK);
    for (uint32_t t = 0; t < base.mesh.triangle_count; t++) {
        float length = meso_vec3_length(base.guide[t]);
        CHECK(base.triangles[t] % 5 == 0 ? length == 0 : fabsf(length - 1) < 1e-5f);
    }
    meso_quilt_base_release(&base);
    meso_triangulation_release(&torus);
    meso_arena_release(&arena);
}

/* Slits, spikes and fine borders: whatever the outline, the result is a manifold of the same kind. */
static void test_outlines(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    uint32_t state = 1;
    for (int round = 0; round < 60; round++) {
        /* a fan around a middle, with random radii */
        MesoVec3 positions[65] = {{0, 0, 0}};
        uint32_t corners[3 * 64], count = 5 + (uint32_t)round;
        for (uint32_t i = 0; i < count; i++) {
            state = state * 1664525 + 1013904223;
            float a = 6.2831853f * (float)i / (float)count, r = 0.5f + (float)(state >> 16) / 65536;
            positions[i + 1] = (MesoVec3){r * cosf(a), r * sinf(a), 0.2f * r * r};
            corners[3 * i] = 0;
            corners[3 * i + 1] = i + 1;
            corners[3 * i + 2] = (i + 1) % count + 1;
        }
        MesoTriangulation star = meso_fixture_triangulation(positions, count + 1, corners, count);
        MesoQuiltBase base = build(&arena, &star, 0.15f, 0.6f);
        CHECK(border_count(&base.mesh) == 1 && euler(&base.mesh) == 1);
        meso_quilt_base_release(&base);
        meso_triangulation_release(&star);
    }
    meso_arena_release(&arena);
}

static void test_errors(void)
{
    MesoArena arena;
    MesoError error;
    MesoQuiltBase base;
    meso_arena_init(&arena);
    MesoVec3 positions[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    MesoTriangulation turned = meso_fixture_triangulation(positions, 4, (uint32_t[]){0, 1, 2, 1, 2, 3}, 2);
    CHECK(meso_quilt_base_build(&base, &arena, &turned, NULL, 1, 1, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "faces 0 and 1 are wound against each other");
    meso_triangulation_release(&turned);
    meso_arena_release(&arena);
}

int main(void)
{
    test_sheet();
    test_hole();
    test_cylinder();
    test_torus();
    test_outlines();
    test_errors();
    return 0;
}
