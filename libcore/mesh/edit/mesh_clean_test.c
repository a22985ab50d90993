/* Cleaning and separating. */
#include "libcore/mesh/edit/mesh_clean.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

/*
 * Vertices 0 to 3 are a square, 4 lies on its lower side, 5 is nobody's. Faces: the square; a flat one; the square from
 * behind; one with a corner twice; one of two corners; a spur; a square that is the first one from another corner on.
 */
static void test_clean(void)
{
    MesoVec3 positions[6] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5f, 0, 0}, {9, 9, 9}};
    uint32_t corners[] = {0, 1, 2, 3, /**/ 0, 4, 1, /**/ 3, 2, 1, 0, /**/ 4, 1, 1, 2, /**/ 0, 1, /**/ 0, 1, 0, 2, /**/ 2, 3, 0, 1};
    uint32_t face_begin[] = {0, 4, 7, 11, 15, 17, 21, 25};
    int32_t number[] = {10, 11, 12, 13, 14, 15, 16};
    MesoAttribute attribute = {.name = "number", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT32, .width = 1,
                               .entry_count = 7, .values = number};
    MesoPolygonMesh mesh, from = {.vertex_count = 6, .face_count = 7, .corner_count = 25, .positions = positions,
                                  .face_begin = face_begin, .corners = corners, .attribute_count = 1, .attributes = &attribute};
    MesoCleanCounts counts;
    CHECK(meso_mesh_clean(&mesh, &arena, &from, &counts, &error) == MESO_OK && is_checked(&mesh));
    CHECK(counts.faces_looped == 3 && counts.faces_flat == 1 && counts.faces_double == 2 &&
          counts.vertices_unused == 1);
    CHECK(mesh.vertex_count == 5 && mesh.face_count == 2 && meso_polygon_sides(&mesh, 1) == 3);
    CHECK(((const int32_t *)mesh.attributes[0].values)[0] == 10 &&
          ((const int32_t *)mesh.attributes[0].values)[1] == 13);
}

/* What is clean stays as it is. */
static void test_clean_already(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    MesoPolygonMesh mesh, torus = make_torus(&arena, 9, 7, &random);
    MesoCleanCounts counts;
    add_attributes(&torus, &arena);
    CHECK(meso_mesh_clean(&mesh, &arena, &torus, &counts, &error) == MESO_OK);
    CHECK(counts.faces_looped + counts.faces_flat + counts.faces_double + counts.vertices_unused == 0);
    CHECK(memcmp(mesh.corners, torus.corners, torus.corner_count * sizeof *mesh.corners) == 0);
    check_attributes(&mesh, torus.face_count);
}

static MesoPolygonMesh separate(const MesoPolygonMesh *from, uint32_t *added)
{
    MesoPolygonMesh mesh;
    MesoHalfEdges edges = join(&arena, from);
    CHECK(meso_mesh_separate(&mesh, &arena, from, &edges, added, &error) == MESO_OK && is_checked(&mesh));
    return mesh;
}

/* A fin on an edge of a torus comes off, and the torus is whole again; so do two triangles that meet in a point. */
static void test_separate(void)
{
    uint32_t added;
    MesoPolygonMesh torus = make_torus(&arena, 5, 5, NULL), fin = torus;
    fin.corners = MESO_NEW(&arena, uint32_t, torus.corner_count + 6, &error);
    memcpy(fin.corners, torus.corners, torus.corner_count * sizeof *fin.corners);
    memcpy(fin.corners + torus.corner_count, (uint32_t[]){0, 1, 7, 12, 13, 9}, 6 * sizeof *fin.corners);
    fin.face_begin[26] = 103;
    fin.face_begin[27] = 106;
    fin.face_count = 27;
    fin.corner_count = 106;
    CHECK(join(&arena, &fin).crowded_count == 2);
    MesoPolygonMesh mesh = separate(&fin, &added);
    MesoHalfEdges edges = join(&arena, &mesh);
    CHECK(added == 6 && edges.crowded_count == 0 && edges.border_count == 6 && edges.reversed_count == 0);
    MesoPolygonMesh again = separate(&mesh, &added);
    CHECK(added == 0 && again.vertex_count == mesh.vertex_count);

    MesoVec3 positions[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    uint32_t corners[6] = {0, 1, 2, 0, 3, 4};
    MesoPolygonMesh bow = {.vertex_count = 5, .face_count = 2, .corner_count = 6, .side_count = 3,
                           .positions = positions, .corners = corners};
    mesh = separate(&bow, &added);
    CHECK(added == 1 && mesh.vertex_count == 6 && mesh.corners[0] == 0 && mesh.corners[3] == 5 &&
          mesh.positions[5].x == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_clean();
    test_clean_already();
    test_separate();
    meso_arena_release(&arena);
    return 0;
}
