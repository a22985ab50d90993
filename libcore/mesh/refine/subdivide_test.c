/* Subdivision: against OpenMesh's, what is conserved, borders, creases, attributes. */
#include "libcore/mesh/refine/subdivide.h"

#include "libcore/mesh/edit/ear_clip.h"
#include "libcore/mesh/edit/mesh_fixture.h"
#include "libcore/mesh/refine/openmesh_subdivide_adapter.h"

static MesoArena arena;
static MesoError error;

static MesoPolygonMesh subdivide(const MesoPolygonMesh *from, MesoScheme scheme, uint32_t levels, double crease)
{
    MesoPolygonMesh mesh;
    CHECK(meso_mesh_subdivide(&mesh, &arena, from, scheme, levels, crease, 1, &error) == MESO_OK && is_checked(&mesh));
    return mesh;
}

static MesoPolygonMesh triangles_of(const MesoPolygonMesh *from)
{
    MesoPolygonMesh mesh;
    CHECK(meso_mesh_cut_faces(&mesh, &arena, from, &error) == MESO_OK);
    return mesh;
}

static double distance_to_nearest(MesoVec3 p, const MesoVec3 *positions, uint32_t count)
{
    double best = INFINITY;
    for (uint32_t i = 0; i < count; i++)
        best = fmin(best, (double)meso_vec3_length(meso_vec3_sub(p, positions[i])));
    return best;
}

static uint32_t *begins_of(const MesoPolygonMesh *mesh)
{
    uint32_t *begin = MESO_NEW(&arena, uint32_t, mesh->face_count + 1, &error);
    for (uint32_t f = 0; f < mesh->face_count; f++)
        begin[f + 1] = meso_polygon_begin(mesh, f) + meso_polygon_sides(mesh, f);
    return begin;
}

/* OpenMesh numbers vertices in another way: as sets of points they are the same. */
static void compare(const MesoPolygonMesh *from, MesoScheme scheme, uint32_t levels)
{
    static MesoVec3 theirs[8192];
    uint32_t count;
    MesoPolygonMesh mesh = subdivide(from, scheme, levels, MESO_NO_CREASE);
    MesoOpenMeshPolygons polygons = {from->vertex_count, from->face_count, from->positions, begins_of(from),
                                     from->corners};
    CHECK(meso_openmesh_subdivide(theirs, 8192, &count, &polygons, scheme == MESO_LOOP, levels, &error) == MESO_OK);
    CHECK(count == mesh.vertex_count);
    for (uint32_t v = 0; v < count; v++) {
        CHECK(distance_to_nearest(mesh.positions[v], theirs, count) < 2e-6);
        CHECK(distance_to_nearest(theirs[v], mesh.positions, count) < 2e-6);
    }
}

static void test_against_openmesh(void)
{
    for (uint32_t seed = 0; seed < 12; seed++) {
        MesoRandom random;
        meso_random_init(&random, seed, 0);
        MesoPolygonMesh mixed = make_torus(&arena, 4 + seed % 3, 3 + seed % 4, &random);
        move_randomly(&mixed, &random, 0.5);
        compare(&mixed, MESO_CATMULL_CLARK, 1 + seed % 2);
        MesoPolygonMesh triangles = triangles_of(&mixed), open = take_faces(triangles, triangles.face_count / 2);
        compare(&triangles, MESO_LOOP, 1 + seed % 2);
        open.vertex_count = 0;      /* without those that no face uses */
        for (uint32_t c = 0; c < open.corner_count; c++)
            open.vertex_count = open.corners[c] >= open.vertex_count ? open.corners[c] + 1 : open.vertex_count;
        compare(&open, MESO_LOOP, 1);
    }
}

static void test_counts(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    MesoPolygonMesh mixed = make_torus(&arena, 6, 5, &random), triangles = triangles_of(&mixed), mesh;
    for (int scheme = 0; scheme < 3; scheme++) {
        const MesoPolygonMesh *from = scheme == MESO_LOOP ? &triangles : &mixed;
        mesh = subdivide(from, (MesoScheme)scheme, 2, MESO_NO_CREASE);
        MesoHalfEdges edges = join(&arena, &mesh);
        CHECK(euler(&arena, &mesh) == 0 && edges.reversed_count == 0 && edges.border_count == 0 && volume(&mesh) > 0);
        CHECK(mesh.side_count == (scheme == MESO_LOOP ? 3 : 4));
    }
    mesh = subdivide(&triangles, MESO_LINEAR, 1, MESO_NO_CREASE);
    CHECK(mesh.side_count == 3 && mesh.face_count == 4 * triangles.face_count);
    CHECK(fabs(area(&mesh) - area(&triangles)) < 1e-4 && fabs(volume(&mesh) - volume(&triangles)) < 1e-4);
    mesh = subdivide(&triangles, MESO_LINEAR_QUADS, 1, MESO_NO_CREASE);
    CHECK(mesh.side_count == 4 && mesh.face_count == triangles.corner_count &&
          fabs(volume(&mesh) - volume(&triangles)) < 1e-4);
    mesh = subdivide(&triangles, MESO_LINEAR, 0, MESO_NO_CREASE);
    CHECK(mesh.corners == triangles.corners);
}

/* A plane stays one, and linear functions on it linear, under every scheme; corners have the entry of their
 * neighbours still. */
static void test_attributes(void)
{
    for (int scheme = 0; scheme < 3; scheme++) {
        MesoRandom random;
        meso_random_init(&random, 7, 0);
        MesoPolygonMesh torus = make_torus(&arena, 6, 6, &random);
        MesoPolygonMesh from = scheme == MESO_LOOP ? triangles_of(&torus) : torus;
        if (scheme != MESO_LINEAR)  /* corners are linear in faces, vertices are not */
            for (uint32_t v = 0; v < 36; v++)
                from.positions[v] = (MesoVec3){1, 2, 3};
        add_attributes(&from, &arena);
        MesoPolygonMesh mesh = subdivide(&from, (MesoScheme)scheme, 2, MESO_NO_CREASE);
        check_attributes(&mesh, from.face_count);
    }
    MesoPolygonMesh torus = make_torus(&arena, 6, 6, NULL);
    add_attributes(&torus, &arena);
    MesoPolygonMesh mesh = subdivide(&torus, MESO_LINEAR, 1, MESO_NO_CREASE);
    CHECK(mesh.attributes[1].entry_count == mesh.vertex_count);     /* no seam: one entry a vertex */
    for (uint32_t f = 0; f < mesh.face_count; f++)
        CHECK(((const int32_t *)mesh.attributes[2].values)[f] == (int32_t)(f / 4) &&
              mesh.corners[4 * f] == torus.corners[f]);
}

/* A cube: its limit is round without creases, and the cube itself with them; at an angle that it has not, round
 * again. */
static void test_creases(void)
{
    MesoVec3 positions[8];
    uint32_t corners[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    for (uint32_t v = 0; v < 8; v++)
        positions[v] = (MesoVec3){v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1};
    MesoPolygonMesh cube = {.vertex_count = 8, .face_count = 6, .corner_count = 24, .side_count = 4,
                            .positions = positions, .corners = corners};
    MesoPolygonMesh round = subdivide(&cube, MESO_CATMULL_CLARK, 3, MESO_NO_CREASE);
    MesoPolygonMesh sharp = subdivide(&cube, MESO_CATMULL_CLARK, 3, 60);
    MesoPolygonMesh blunt = subdivide(&cube, MESO_CATMULL_CLARK, 3, 120);
    CHECK(volume(&round) < 5 && fabs(volume(&sharp) - 8) < 1e-5 && fabs(area(&sharp) - 24) < 1e-5);
    CHECK(memcmp(blunt.positions, round.positions, round.vertex_count * sizeof *round.positions) == 0);
}

/* The border of a square is a cubic B-spline: 1/8 3/4 1/8, and middles. */
static void test_border(void)
{
    MesoVec3 positions[4] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
    uint32_t corners[4] = {0, 1, 2, 3};
    MesoPolygonMesh quad = {.vertex_count = 4, .face_count = 1, .corner_count = 4, .side_count = 4,
                            .positions = positions, .corners = corners};
    MesoPolygonMesh mesh = subdivide(&quad, MESO_CATMULL_CLARK, 1, MESO_NO_CREASE);
    CHECK(mesh.vertex_count == 9 && mesh.positions[0].x == 1 && mesh.positions[0].y == 1 && mesh.positions[4].x == 4);
    CHECK(mesh.positions[4].y == 0 && mesh.positions[8].x == 4 && mesh.positions[8].y == 4);
}

static void test_refusals(void)
{
    MesoPolygonMesh mesh, torus = make_torus(&arena, 4, 4, NULL);
    CHECK(meso_mesh_subdivide(&mesh, &arena, &torus, MESO_LOOP, 1, 181, 1, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "face 1 has 4 sides"));
    CHECK(meso_mesh_subdivide(&mesh, &arena, &torus, MESO_LINEAR, 14, 181, 1, &error) == MESO_ERR_LIMIT);
    CHECK(meso_mesh_subdivide(&mesh, &arena, &torus, MESO_LINEAR, 4000000000, 181, 1, &error) == MESO_ERR_LIMIT);
    turn_face(&torus, 1);       /* windings that disagree are no hindrance */
    CHECK(meso_mesh_subdivide(&mesh, &arena, &torus, MESO_CATMULL_CLARK, 1, 181, 1, &error) == MESO_OK &&
          mesh.side_count == 4);
}

int main(void)
{
    meso_arena_init(&arena);
    test_against_openmesh();
    test_counts();
    test_attributes();
    test_creases();
    test_border();
    test_refusals();
    meso_arena_release(&arena);
    return 0;
}
