/* Flaws of surfaces: drawn by hand, and splits against brute force on random meshes. */
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/mesh/surface_check.h"

enum { ROOM = 256 };

static MesoArena arena;
static MesoError error;

typedef struct Drawn {
    uint32_t vertex_count, face_count, normal_count;
    MesoVec3 positions[ROOM], normals[ROOM];
    uint32_t vertices[4 * ROOM], corner_normals[4 * ROOM];
} Drawn;

static MesoSurfaceFlaws look(const Drawn *d)
{
    MesoQuadMesh mesh;
    MesoSlotGraph graph;
    MesoSurfaceFlaws flaws;
    CHECK(meso_quad_mesh_build(&mesh, &arena, d->vertex_count, d->positions, d->normal_count, d->normals,
                               d->face_count, d->vertices, d->normal_count ? d->corner_normals : NULL,
                               &error) == MESO_OK);
    CHECK(meso_slot_graph_build(&graph, &arena, &mesh, &error) == MESO_OK);
    CHECK(meso_surface_check(&flaws, &arena, &mesh, &graph, &error) == MESO_OK);
    CHECK(flaws.reversed_edges == graph.reversed_count);
    return flaws;
}

/* `columns` faces in a row along x, between y 0 and 1: vertex 2 i below vertex 2 i + 1. */
static Drawn draw_row(uint32_t columns)
{
    Drawn d = {.vertex_count = 2 * columns + 2, .face_count = columns};
    for (uint32_t i = 0; i <= columns; i++) {
        d.positions[2 * i] = (MesoVec3){(float)i, 0, 0};
        d.positions[2 * i + 1] = (MesoVec3){(float)i, 1, 0};
    }
    for (uint32_t f = 0; f < columns; f++)
        memcpy(d.vertices + 4 * f, (uint32_t[]){2 * f, 2 * f + 2, 2 * f + 3, 2 * f + 1}, 4 * sizeof(uint32_t));
    return d;
}

/* Joins the last column of a row of 8, bent to a ring, to the first one: a cylinder, or a Moebius band. */
static Drawn draw_ring(bool twisted)
{
    Drawn d = draw_row(8);
    d.vertex_count = 16;
    for (uint32_t i = 0; i < 8; i++) {
        float turn = (float)i * 0.25f * (float)MESO_PI, tilt = twisted ? 0.5f * turn : 0;
        for (uint32_t k = 0; k < 2; k++) {
            float out = 3 + (k ? 1 : -1) * sinf(tilt), up = (k ? 1 : -1) * cosf(tilt);
            d.positions[2 * i + k] = (MesoVec3){out * cosf(turn), out * sinf(turn), up};
        }
    }
    d.vertices[4 * 7 + 1] = twisted ? 1 : 0;
    d.vertices[4 * 7 + 2] = twisted ? 0 : 1;
    return d;
}

static void test_sound(void)
{
    Drawn row = draw_row(5);
    MesoSurfaceFlaws flaws = look(&row);
    CHECK(flaws.pieces == 1);
    flaws.pieces = 0;
    CHECK(memcmp(&flaws, &(MesoSurfaceFlaws){0}, sizeof flaws) == 0);
}

/*
 *   1----3 7----9      two faces that meet at x = 1 with vertices of their own;
 *   | 0  | | 1  |      one zero there is negative
 *   0----2 6----8
 */
static void test_split(void)
{
    Drawn d = {.vertex_count = 8, .face_count = 2,
               .positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, -0.0f, 0}, {1, 1, 0}, {2, 0, 0},
                             {2, 1, 0}},
               .vertices = {0, 2, 3, 1, 4, 6, 7, 5}};
    MesoSurfaceFlaws flaws = look(&d);
    CHECK(flaws.pieces == 2 && flaws.split_edges == 2);
    CHECK(flaws.split_faces[0] == 0 && flaws.split_faces[1] == 1);

    d.positions[4].x = 1.0000001f;      /* the next float after 1: they only touch at one corner */
    flaws = look(&d);
    CHECK(flaws.pieces == 2 && flaws.split_edges == 0);
}

/* A torus cut open along a seam is one piece, and still lies on itself. */
static void test_seam(void)
{
    Drawn ring = draw_ring(false), open = draw_row(8);
    memcpy(open.positions, ring.positions, 16 * sizeof *ring.positions);
    open.positions[16] = ring.positions[0];
    open.positions[17] = ring.positions[1];
    MesoSurfaceFlaws flaws = look(&open);
    CHECK(flaws.pieces == 1 && flaws.split_edges == 2);
    CHECK(flaws.split_faces[0] == 0 && flaws.split_faces[1] == 7);
    CHECK(look(&ring).split_edges == 0);
}

static bool same_place(const Drawn *d, uint32_t h, uint32_t other)
{
    MesoVec3 a[2] = {d->positions[d->vertices[h]], d->positions[d->vertices[h / 4 * 4 + (h + 1) % 4]]};
    MesoVec3 b[2] = {d->positions[d->vertices[other]], d->positions[d->vertices[other / 4 * 4 + (other + 1) % 4]]};
    bool along = a[0].x == b[0].x && a[0].y == b[0].y && a[1].x == b[1].x && a[1].y == b[1].y;
    bool back = a[0].x == b[1].x && a[0].y == b[1].y && a[1].x == b[0].x && a[1].y == b[0].y;
    return along || back;
}

/* Quads on a small grid, each with vertices of its own: every edge is a border. */
static void test_random_splits(void)
{
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (int round = 0; round < 200; round++) {
        Drawn d = {.vertex_count = 4 * 20, .face_count = 20};
        for (uint32_t f = 0; f < 20; f++) {
            float x = (float)meso_random_below(&random, 5) - 2, y = (float)meso_random_below(&random, 5) - 2;
            for (uint32_t i = 0; i < 4; i++) {
                d.positions[4 * f + i] = (MesoVec3){x + (i == 1 || i == 2), y + (i > 1), 0};
                d.vertices[4 * f + i] = 4 * f + i;
            }
        }
        uint32_t expected = 0;
        for (uint32_t h = 0; h < 80; h++) {
            bool met = false;
            for (uint32_t other = 0; other < 80; other++)
                met |= other != h && same_place(&d, h, other);
            expected += met;
        }
        MesoSurfaceFlaws flaws = look(&d);
        CHECK(flaws.pieces == 20 && flaws.split_edges == expected);
        meso_arena_release(&arena);
    }
}

/* One face of a cylinder wound the other way: both its edges disagree, and turning it over mends them. */
static void test_reversed(void)
{
    Drawn d = draw_ring(false);
    CHECK(look(&d).reversed_edges == 0);
    memcpy(d.vertices + 4 * 3, (uint32_t[]){7, 9, 8, 6}, 4 * sizeof(uint32_t));
    MesoSurfaceFlaws flaws = look(&d);
    CHECK(flaws.reversed_edges == 2 && flaws.reversed_faces[0] == 2 && flaws.reversed_faces[1] == 3);
    CHECK(flaws.one_sided_pieces == 0 && flaws.blurred_edges == 0);
}

/* A Moebius band, and a cylinder beside it that is two-sided; normals of its own clear the seam. */
static void test_one_sided(void)
{
    Drawn d = draw_ring(true), ring = draw_ring(false);
    for (uint32_t v = 0; v < 16; v++)
        d.positions[16 + v] = (MesoVec3){ring.positions[v].x + 20, ring.positions[v].y, ring.positions[v].z};
    for (uint32_t c = 0; c < 32; c++)
        d.vertices[32 + c] = ring.vertices[c] + 16;
    d.vertex_count = 32, d.face_count = 16;
    MesoSurfaceFlaws flaws = look(&d);
    CHECK(flaws.pieces == 2 && flaws.one_sided_pieces == 1 && flaws.reversed_edges == 1);
    CHECK(flaws.one_sided_faces[0] == 0 && flaws.one_sided_faces[1] == 7);
    CHECK(flaws.blurred_edges == 1);

    d.normal_count = 1;
    d.normals[0] = (MesoVec3){0, 0.6f, 0.8f};
    flaws = look(&d);
    CHECK(flaws.one_sided_pieces == 1 && flaws.blurred_edges == 0 && flaws.bare_corners == 0);
}

static void test_flat(void)
{
    Drawn d = draw_row(4);
    d.positions[6].x = 2;       /* face 2 narrows to a triangle, which has an area */
    d.positions[7].x = 2;       /* and then to a line */
    MesoSurfaceFlaws flaws = look(&d);
    CHECK(flaws.flat_faces == 1 && flaws.flat_face == 2);
    d.positions[6].x = 2.001f;
    CHECK(look(&d).flat_faces == 0);

    Drawn bow = draw_row(1);
    memcpy(bow.vertices, (uint32_t[]){0, 3, 2, 1}, 4 * sizeof(uint32_t));
    CHECK(look(&bow).flat_faces == 0);
}

/* A file without normals lacks none; one that leaves some out does. */
static void test_normals(void)
{
    Drawn d = draw_row(3);
    CHECK(look(&d).bare_corners == 0);
    d.normal_count = 2;
    d.normals[0] = (MesoVec3){0, 0, 1};
    CHECK(look(&d).bare_corners == 0);
    d.corner_normals[5] = MESO_NO_INDEX;
    d.corner_normals[9] = 1;        /* of no length */
    MesoSurfaceFlaws flaws = look(&d);
    CHECK(flaws.bare_corners == 2 && flaws.bare_face == 1 && flaws.lost_normals == 0);
}

/* Two faces on the same four vertices, back to back: the sums of their normals vanish. */
static void test_lost(void)
{
    Drawn d = draw_row(1);
    d.face_count = 2;
    memcpy(d.vertices + 4, (uint32_t[]){1, 3, 2, 0}, 4 * sizeof(uint32_t));
    CHECK(look(&d).lost_normals == 4);
}

int main(void)
{
    meso_arena_init(&arena);
    test_sound();
    test_split();
    test_seam();
    test_random_splits();
    test_reversed();
    test_one_sided();
    test_flat();
    test_normals();
    test_lost();
    meso_arena_release(&arena);
    return 0;
}
