/* Windings: random turns are undone; inside out; a strip with one side; normals follow. */
#include "libcore/mesh/edit/mesh_orient.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

static MesoPolygonMesh orient(const MesoPolygonMesh *from, MesoOrientCounts *counts)
{
    MesoPolygonMesh mesh;
    MesoHalfEdges edges = join(&arena, from);
    CHECK(meso_mesh_orient(&mesh, &arena, from, &edges, counts, &error) == MESO_OK && is_checked(&mesh));
    return mesh;
}

static void test_closed(void)
{
    MesoRandom random;
    for (uint32_t seed = 0; seed < 50; seed++) {
        meso_random_init(&random, seed, 0);
        MesoOrientCounts counts;
        MesoPolygonMesh torus = make_torus(&arena, 4 + seed % 3, 3 + seed % 4, &random), turned = torus;
        turned.corners = MESO_NEW(&arena, uint32_t, torus.corner_count, &error);
        memcpy(turned.corners, torus.corners, torus.corner_count * sizeof *turned.corners);
        uint32_t count = 0;
        for (uint32_t f = 0; f < torus.face_count; f++)
            if (seed == 0 || meso_random_below(&random, 2)) {
                turn_face(&turned, f);
                count++;
            }
        MesoPolygonMesh mesh = orient(&turned, &counts);
        CHECK(counts.faces_turned == count && counts.disagreeing == 0 &&
              counts.pieces_turned == (count == torus.face_count));
        CHECK(memcmp(mesh.corners, torus.corners, torus.corner_count * sizeof *mesh.corners) == 0);
    }
}

/* The most faces of an open piece decide; of as many, the first. */
static void test_open(void)
{
    MesoOrientCounts counts;
    MesoPolygonMesh torus = make_torus(&arena, 5, 5, NULL), piece = take_faces(torus, 4);
    turn_face(&piece, 0);
    MesoPolygonMesh mesh = orient(&piece, &counts);
    CHECK(counts.faces_turned == 1 && join(&arena, &mesh).reversed_count == 0 && mesh.corners[1] == 1);
    turn_face(&piece, 1);
    mesh = orient(&piece, &counts);
    CHECK(counts.faces_turned == 2 && mesh.corners[1] == 5);
}

/* A ring of three quads whose last side is joined the wrong way round. */
static void test_one_sided(void)
{
    MesoVec3 positions[6] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    uint32_t corners[12] = {0, 1, 4, 3, 1, 2, 5, 4, 2, 3, 0, 5};
    MesoOrientCounts counts;
    MesoPolygonMesh strip = {.vertex_count = 6, .face_count = 3, .corner_count = 12, .side_count = 4,
                             .positions = positions, .corners = corners};
    orient(&strip, &counts);
    CHECK(counts.disagreeing == 1 && counts.one_sided == 0);
}

/* Normals of a torus turned inside out, on vertices and on corners: they look out in the end, whether they did
 * before or not. */
static void test_normals(void)
{
    for (int side = -1; side <= 1; side += 2) {
        MesoOrientCounts counts;
        MesoPolygonMesh torus = make_torus(&arena, 8, 8, NULL);
        float values[64 * 3];
        uint32_t entry_of[256];
        for (uint32_t f = 0; f < torus.face_count; f++)
            turn_face(&torus, f);
        for (uint32_t v = 0; v < 64; v++) {
            MesoVec3 p = torus.positions[v];
            double r = hypot((double)p.x, (double)p.y), scale = side * (r - 3) / r;
            values[3 * v] = (float)(p.x * scale);
            values[3 * v + 1] = (float)(p.y * scale);
            values[3 * v + 2] = (float)side * p.z;
        }
        memcpy(entry_of, torus.corners, sizeof entry_of);
        MesoAttribute attributes[2] = {{.name = "normal", .width = 3, .entry_count = 64, .values = values},
                                       {.name = "normal", .domain = MESO_ON_CORNERS, .width = 3, .entry_count = 64,
                                        .values = values, .entry_of = entry_of}};
        torus.attributes = attributes;
        torus.attribute_count = 2;
        MesoPolygonMesh mesh = orient(&torus, &counts);
        CHECK(counts.pieces_turned == 1 && volume(&mesh) > 0);
        for (uint32_t c = 0; c < 256; c++) {
            uint32_t v = mesh.corners[c];
            CHECK(mesh.attributes[0].entry_of == NULL);
            MesoVec3 a = meso_attribute_vec3(&mesh.attributes[0], v);
            MesoVec3 b = meso_attribute_vec3(&mesh.attributes[1], mesh.attributes[1].entry_of[c]);
            CHECK(memcmp(&a, &b, sizeof a) == 0 && (a.z == 0 || (a.z > 0) == (mesh.positions[v].z > 0)));
        }
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_closed();
    test_open();
    test_one_sided();
    test_normals();
    meso_arena_release(&arena);
    return 0;
}
