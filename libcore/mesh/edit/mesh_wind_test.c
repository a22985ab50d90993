/* One side: random turns undone where pieces disagree, and there alone; bands and a bottle of one side cut open. */
#include "libcore/mesh/edit/mesh_wind.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

static MesoPolygonMesh wind(const MesoPolygonMesh *from, MesoWindCounts *counts)
{
    MesoPolygonMesh mesh;
    MesoHalfEdges edges = join(&arena, from);
    uint8_t *over = MESO_NEW(&arena, uint8_t, from->face_count, &error);
    CHECK(meso_mesh_find_windings(over, from, &edges, &error) == MESO_OK);
    CHECK(meso_mesh_wind(&mesh, &arena, from, &edges, over, counts, &error) == MESO_OK && is_checked(&mesh));
    MesoHalfEdges joined = join(&arena, &mesh);
    CHECK(joined.reversed_count == 0 && joined.crowded_count == 0);
    CHECK(joined.edge_count == edges.edge_count + counts->edges_cut &&
          joined.border_count == edges.border_count + 2 * counts->edges_cut);
    CHECK(fabs(area(&mesh) - area(from)) <= 1e-9 * area(from));
    return mesh;
}

static void test_turned(void)
{
    MesoRandom random;
    for (uint32_t seed = 0; seed < 50; seed++) {
        meso_random_init(&random, seed, 0);
        MesoWindCounts counts;
        MesoPolygonMesh torus = make_torus(&arena, 4 + seed % 3, 3 + seed % 4, &random), turned = torus;
        turned.corners = MESO_NEW(&arena, uint32_t, torus.corner_count, &error);
        memcpy(turned.corners, torus.corners, torus.corner_count * sizeof *turned.corners);
        bool all = seed == 0;               /* inside out, but of one mind: it stays */
        uint32_t count = 0;
        for (uint32_t f = 0; f < torus.face_count; f++)
            if (all || meso_random_below(&random, 2)) {
                turn_face(&turned, f);
                count++;
            }
        MesoPolygonMesh mesh = wind(&turned, &counts);
        CHECK(counts.faces_turned == (all ? 0 : count) && counts.edges_cut == 0);
        CHECK(memcmp(mesh.corners, all ? turned.corners : torus.corners, torus.corner_count * sizeof *mesh.corners) == 0);
    }
}

/* Normals have the say: those of a torus that look inward, on faces of any winding, stay and take the faces along. */
static void test_normals(void)
{
    MesoWindCounts counts;
    MesoPolygonMesh torus = make_torus(&arena, 6, 6, NULL);
    float values[36 * 3];
    for (uint32_t v = 0; v < 36; v++) {
        MesoVec3 p = torus.positions[v];
        double r = hypot((double)p.x, (double)p.y), scale = (3 - r) / r;
        values[3 * v] = (float)(p.x * scale);
        values[3 * v + 1] = (float)(p.y * scale);
        values[3 * v + 2] = -p.z;
    }
    MesoAttribute normal = {.name = "normal", .width = 3, .entry_count = 36, .values = values};
    torus.attributes = &normal;
    torus.attribute_count = 1;
    for (uint32_t f = 0; f < 36; f += 3)
        turn_face(&torus, f);
    MesoPolygonMesh mesh = wind(&torus, &counts);
    CHECK(counts.faces_turned == 24 && counts.turned_face == 1 && volume(&mesh) < 0);
    CHECK(memcmp(mesh.attributes[0].values, values, sizeof values) == 0);
}

/* Two faces that share a sharp edge and the normals there, which look along the one and against the other, share them
 * when the other is turned over. */
static void test_sharp_edge(void)
{
    static const MesoVec3 positions[6] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0.1f}, {0, 1, 0.1f}};
    static const uint32_t corners[8] = {0, 1, 2, 3, 1, 2, 5, 4}, entries[8] = {0, 1, 1, 0, 1, 1, 2, 2};
    for (uint32_t i = 0; i < 2; i++) {
        float values[9] = {0, 0, 1, i ? 0.3f : -0.3f, 0, 1, 0, 0, -1};
        MesoWindCounts counts;
        MesoPolygonMesh sharp = {.vertex_count = 6, .positions = MESO_NEW(&arena, MesoVec3, 6, &error), .face_count = 2,
                                 .corner_count = 8, .side_count = 4, .corners = MESO_NEW(&arena, uint32_t, 8, &error)};
        uint32_t *entry_of = MESO_NEW(&arena, uint32_t, 8, &error);
        memcpy(sharp.positions, positions, sizeof positions);
        memcpy(sharp.corners, corners, sizeof corners);
        memcpy(entry_of, entries, sizeof entries);
        MesoAttribute normal = {.name = "normal", .domain = MESO_ON_CORNERS, .width = 3, .entry_count = 3,
                                .values = values, .entry_of = entry_of};
        sharp.attributes = &normal;
        sharp.attribute_count = 1;
        MesoPolygonMesh mesh = wind(&sharp, &counts);
        CHECK(counts.faces_turned == 1);
        const MesoAttribute *turned = &mesh.attributes[0];
        for (uint32_t c = 0; c < 8; c++)
            for (uint32_t d = 0; d < 8; d++)
                CHECK(mesh.corners[c] != mesh.corners[d] ||
                      meso_attribute_entry(turned, c) == meso_attribute_entry(turned, d));
    }
}

/* A strip of `n` quads whose last side is joined to the first the wrong way round. */
static MesoPolygonMesh make_band(uint32_t n)
{
    MesoPolygonMesh band = {.vertex_count = 2 * n, .positions = MESO_NEW(&arena, MesoVec3, 2 * n, &error),
                            .face_count = n, .corner_count = 4 * n, .side_count = 4,
                            .corners = MESO_NEW(&arena, uint32_t, 4 * n, &error)};
    for (uint32_t i = 0; i < n; i++) {
        double a = 2 * MESO_PI * i / n;
        for (uint32_t k = 0; k < 2; k++) {
            double w = k ? 0.5 : -0.5, r = 2 + w * cos(a / 2);
            band.positions[2 * i + k] = (MesoVec3){(float)(r * cos(a)), (float)(r * sin(a)), (float)(w * sin(a / 2))};
        }
        bool last = i + 1 == n;
        uint32_t next = last ? 0 : 2 * i + 2;
        uint32_t v[4] = {2 * i, next + last, next + !last, 2 * i + 1};
        memcpy(&band.corners[4 * i], v, sizeof v);
    }
    return band;
}

static void test_band(void)
{
    for (uint32_t n = 3; n < 40; n++) {
        MesoWindCounts counts;
        MesoPolygonMesh band = make_band(n), mesh = wind(&band, &counts);
        CHECK(counts.faces_turned == 0 && counts.edges_cut == 1 && mesh.vertex_count == band.vertex_count + 2 && euler(&arena, &mesh) == 1);
        for (uint32_t v = band.vertex_count; v < mesh.vertex_count; v++) {
            uint32_t same = 0;
            for (uint32_t u = 0; u < band.vertex_count; u++)
                same += memcmp(&mesh.positions[u], &mesh.positions[v], sizeof *mesh.positions) == 0;
            CHECK(same == 1);
        }
    }
}

/* A torus glued the other way round: closed, of one side. Cut open it is a ring, or more is cut than needs be. */
static void test_bottle(void)
{
    enum { NX = 6, NY = 5 };
    MesoWindCounts counts;
    MesoPolygonMesh bottle = make_torus(&arena, NX, NY, NULL);
    for (uint32_t j = 0; j < NY; j++) {     /* the last column meets the first upside down */
        uint32_t *v = &bottle.corners[4 * (j * NX + NX - 1)];
        v[1] = (NY - j) % NY * NX;
        v[2] = (NY - (j + 1) % NY) % NY * NX;
    }
    MesoPolygonMesh mesh = wind(&bottle, &counts);
    MesoHalfEdges edges = join(&arena, &mesh);
    CHECK(counts.edges_cut >= NY && edges.border_count == 2 * counts.edges_cut && euler(&arena, &mesh) == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_turned();
    test_normals();
    test_sharp_edge();
    test_band();
    test_bottle();
    meso_arena_release(&arena);
    return 0;
}
