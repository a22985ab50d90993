#include "libcore/mesh/cut/border_loops.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

enum { SHEET = 8 };

static MesoArena arena;

static MesoBorderLoops find(const MesoTriangulation *mesh, const MesoDomain *domain, bool slits)
{
    MesoBorderLoops loops;
    CHECK(meso_border_loops_find(&loops, &arena, mesh, domain, slits, NULL) == MESO_OK);
    return loops;
}

/* Each side begins at its vertex and ends at the next one's. */
static void check_chains(const MesoTriangulation *mesh, const MesoBorderLoops *loops)
{
    uint32_t sides = 0;
    for (uint32_t l = 0; l < loops->loop_count; l++) {
        const MesoBorderLoop *loop = &loops->loops[l];
        CHECK(loop->first == sides);
        sides += loop->count;
        for (uint32_t i = 0; i < loop->count; i++) {
            uint32_t h = loops->half_edges[loop->first + i], begin = loops->vertices[loop->first + i];
            uint32_t end = loops->vertices[loop->first + (i + 1) % loop->count];
            uint32_t a = mesh->corners[h], b = mesh->corners[meso_next_corner(h)];
            CHECK((a == begin && b == end) || (a == end && b == begin));
        }
    }
    CHECK(sides == loops->side_count);
}

/* Walls where labels differ. */
static void raise_walls(MesoTriangulation *mesh)
{
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX || mesh->labels[h / 3] != mesh->labels[mesh->twins[h] / 3])
            mesh->walls[h / 3] |= (uint8_t)(1u << h % 3);
    CHECK(meso_triangulation_check(mesh, NULL) == MESO_OK);
}

/* Labels of the quads of a sheet, by column and row. */
static MesoTriangulation labelled_sheet(uint32_t (*label)(uint32_t column, uint32_t row))
{
    MesoTriangulation mesh = meso_fixture_sheet(SHEET, SHEET, 0.5f);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        mesh.labels[t] = label(t / 2 % SHEET, t / 2 / SHEET);
    raise_walls(&mesh);
    return mesh;
}

static MesoDomain domain_of(const MesoTriangulation *mesh, const uint8_t *member)
{
    MesoDomain domain = {.member = member};
    uint32_t *triangles = MESO_NEW(&arena, uint32_t, mesh->triangle_count, NULL);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (member[mesh->labels[t]])
            triangles[domain.triangle_count++] = t;
    domain.triangles = triangles;
    return domain;
}

/* 0 around 1 1 2 2, in rows 2 to 3. */
static uint32_t three_regions(uint32_t column, uint32_t row)
{
    return row < 2 || row > 3 || column < 2 || column > 5 ? 0 : column < 4 ? 1 : 2;
}

static void test_three_regions(void)
{
    const uint8_t members[5][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    const uint32_t loop_count[5] = {2, 1, 1, 1, 1}, longest[5] = {32, 8, 8, 12, 32}, corners[5] = {2, 2, 2, 0, 0};
    const double area[5] = {14, 1, 1, 2, 16};
    MesoTriangulation mesh = labelled_sheet(three_regions);
    for (uint32_t i = 0; i < 5; i++) {
        MesoDomain domain = domain_of(&mesh, members[i]);
        MesoBorderLoops loops = find(&mesh, &domain, true);
        check_chains(&mesh, &loops);
        CHECK(loops.loop_count == loop_count[i] && loops.loops[loops.longest].count == longest[i]);
        CHECK(loops.loops[loops.longest].length == 0.5f * (float)longest[i] && loops.area == area[i]);
        uint32_t found = 0;
        for (uint32_t l = 0; l < loops.loop_count; l++)
            found += loops.loops[l].corner_count;
        CHECK(found == corners[i]);
        /* region to the left: the area by the turning of positions around the loops */
        double turned = 0;
        for (uint32_t l = 0; l < loops.loop_count; l++)
            for (uint32_t s = 0; s < loops.loops[l].count; s++) {
                const uint32_t *vertices = loops.vertices + loops.loops[l].first;
                MesoVec3 a = mesh.positions[vertices[s]], b = mesh.positions[vertices[(s + 1) % loops.loops[l].count]];
                turned += 0.5 * (a.x * b.y - a.y * b.x);
            }
        CHECK(turned == area[i]);
    }
    CHECK(find(&mesh, NULL, true).side_count == 32);
    meso_triangulation_release(&mesh);
}

/* The corners of a region come where it meets two others. */
static void test_corner_places(void)
{
    const uint8_t member[3] = {0, 1, 0};
    MesoTriangulation mesh = labelled_sheet(three_regions);
    MesoDomain domain = domain_of(&mesh, member);
    MesoBorderLoops loops = find(&mesh, &domain, true);
    for (uint32_t s = 0; s < loops.side_count; s++)
        CHECK(loops.corners[s] == (loops.vertices[s] == 2 * 9 + 4 || loops.vertices[s] == 4 * 9 + 4));
    meso_triangulation_release(&mesh);
}

/* A wall from vertex to vertex along row `y`, in one region. */
static void raise_slit(MesoTriangulation *mesh, uint32_t y, uint32_t from, uint32_t to)
{
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t a = mesh->corners[h], b = mesh->corners[meso_next_corner(h)];
        if (a / 9 == y && b / 9 == y && a % 9 >= from && a % 9 <= to && b % 9 >= from && b % 9 <= to)
            mesh->walls[h / 3] |= (uint8_t)(1u << h % 3);
    }
    CHECK(meso_triangulation_check(mesh, NULL) == MESO_OK);
}

/* A slit inside is a loop of its own, once along each side; one from the border is part of that loop. */
static void test_slits(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(SHEET, SHEET, 1);
    raise_slit(&mesh, 4, 2, 5);
    MesoBorderLoops loops = find(&mesh, NULL, true);
    check_chains(&mesh, &loops);
    CHECK(loops.loop_count == 2 && loops.longest == 0 && loops.side_count == 38);
    CHECK(loops.loops[1].count == 6 && loops.loops[1].length == 6 && loops.loops[1].corner_count == 2);
    loops = find(&mesh, NULL, false);
    CHECK(loops.loop_count == 1 && loops.side_count == 32);
    raise_slit(&mesh, 4, 0, 2);
    loops = find(&mesh, NULL, true);
    check_chains(&mesh, &loops);
    /* its place on the border is passed twice */
    CHECK(loops.loop_count == 1 && loops.side_count == 42 && loops.loops[0].corner_count == 3);
    meso_triangulation_release(&mesh);
}

/* Two squares that touch in a vertex: a loop around each. */
static uint32_t touching(uint32_t column, uint32_t row)
{
    return (column >= 2 && column < 4 && row >= 2 && row < 4) || (column >= 4 && column < 6 && row >= 4 && row < 6);
}

static void test_touching(void)
{
    const uint8_t member[2] = {0, 1};
    MesoTriangulation mesh = labelled_sheet(touching);
    MesoDomain domain = domain_of(&mesh, member);
    MesoBorderLoops loops = find(&mesh, &domain, true);
    check_chains(&mesh, &loops);
    CHECK(loops.loop_count == 2 && loops.side_count == 16 && loops.loops[0].corner_count == 1);
    CHECK(loops.longest == 0 && loops.area == 2);
    meso_triangulation_release(&mesh);
}

/* No border; one border of a band with a half turn, across reversed edges. */
static void test_torus_and_moebius(void)
{
    MesoVec3 positions[5];
    uint32_t corners[15];
    MesoTriangulation torus = meso_fixture_torus(5, 4, 0.3f);
    MesoBorderLoops loops = find(&torus, NULL, true);
    CHECK(loops.loop_count == 0 && loops.longest == MESO_NO_INDEX && loops.area > 0);
    meso_triangulation_release(&torus);
    for (uint32_t v = 0; v < 5; v++) {
        float a = 6.2831853f * (float)v / 5;
        positions[v] = (MesoVec3){cosf(2 * a), sinf(2 * a), 0.3f * (float)v};
        for (uint32_t k = 0; k < 3; k++)
            corners[3 * v + k] = (v + k) % 5;
    }
    MesoTriangulation band = meso_fixture_triangulation(positions, 5, corners, 5);
    loops = find(&band, NULL, true);
    check_chains(&band, &loops);
    CHECK(loops.loop_count == 1 && loops.side_count == 5 && loops.loops[0].corner_count == 0);
    meso_triangulation_release(&band);
}

/* Areas of sizes whose squares single precision does not hold. */
static void test_sizes(void)
{
    const float sizes[] = {1e-12f, 1, 1e12f, 1e17f};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        MesoTriangulation mesh = meso_fixture_sheet(2, 3, sizes[i]);
        MesoBorderLoops loops = find(&mesh, NULL, true);
        CHECK(fabs(loops.area / (6 * (double)sizes[i] * (double)sizes[i]) - 1) < 1e-6);
        meso_triangulation_release(&mesh);
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_three_regions();
    test_corner_places();
    test_slits();
    test_touching();
    test_torus_and_moebius();
    test_sizes();
    meso_arena_release(&arena);
    return 0;
}
