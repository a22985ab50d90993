/* Against brute force: random polygons with short lists and long ones, crowded edges, threads. */
#include "libcore/mesh/half_edges.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { MOST_FACES = 60, MOST_SIDES = 6, MOST_CORNERS = MOST_FACES * MOST_SIDES };

static MesoArena arena;
static MesoError error;

static uint32_t face_begin[MOST_FACES + 1], corners[MOST_CORNERS];

static MesoPolygonMesh random_mesh(MesoRandom *random, uint32_t vertex_count, uint32_t sides)
{
    uint32_t count = 0, face_count = 1 + meso_random_below(random, MOST_FACES);
    for (uint32_t f = 0; f < face_count; f++) {
        uint32_t begin = count, end = begin + (sides ? sides : 3 + meso_random_below(random, MOST_SIDES - 2));
        face_begin[f] = begin;
        while (count < end) {
            uint32_t v = meso_random_below(random, vertex_count);
            bool fresh = true;
            for (uint32_t c = begin; c < count; c++)
                fresh &= corners[c] != v;
            if (fresh)
                corners[count++] = v;
        }
    }
    face_begin[face_count] = count;
    return (MesoPolygonMesh){.vertex_count = vertex_count, .face_count = face_count, .corner_count = count,
                             .side_count = sides, .face_begin = sides ? NULL : face_begin, .corners = corners};
}

static void ends(const MesoPolygonMesh *mesh, uint32_t h, uint32_t *from, uint32_t *to)
{
    uint32_t f = meso_polygon_face(mesh, h), begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
    *from = mesh->corners[h];
    *to = mesh->corners[begin + (h - begin + 1) % sides];
}

static bool same_edge(const MesoPolygonMesh *mesh, uint32_t g, uint32_t h)
{
    uint32_t a, b, c, d;
    ends(mesh, g, &a, &b);
    ends(mesh, h, &c, &d);
    return (a == c && b == d) || (a == d && b == c);
}

static MesoHalfEdges brute_force(const MesoPolygonMesh *mesh, uint32_t *twin)
{
    MesoHalfEdges all = {.twin = twin};
    uint32_t best[2] = {MESO_NO_INDEX, MESO_NO_INDEX};
    for (uint32_t h = 0; h < mesh->corner_count; h++) {
        uint32_t same[MOST_CORNERS], count = 0, from, to;
        for (uint32_t g = 0; g < mesh->corner_count; g++)
            if (same_edge(mesh, g, h))
                same[count++] = g;
        twin[h] = count == 2 ? same[same[0] == h] : MESO_NO_INDEX;
        if (same[0] != h)
            continue;
        ends(mesh, h, &from, &to);
        all.edge_count++;
        all.border_count += count == 1;
        all.reversed_count += count == 2 && mesh->corners[same[1]] == from;
        all.crowded_count += count > 2;
        uint32_t lower = from < to ? from : to;
        if (count > 2 && (lower < best[0] || (lower == best[0] && same[2] < best[1]))) {
            best[0] = lower;
            best[1] = same[2];
            memcpy(all.crowded, same, sizeof all.crowded);
        }
    }
    return all;
}

static void compare(const MesoPolygonMesh *mesh)
{
    static uint32_t twin[MOST_CORNERS];
    MesoHalfEdges expected = brute_force(mesh, twin), joined;
    for (uint32_t threads = 1; threads <= 2; threads++) {
        CHECK(meso_half_edges_join(&joined, &arena, mesh, threads, &error) == MESO_OK);
        CHECK(memcmp(joined.twin, twin, mesh->corner_count * sizeof *twin) == 0);
        CHECK(joined.edge_count == expected.edge_count && joined.border_count == expected.border_count);
        CHECK(joined.reversed_count == expected.reversed_count && joined.crowded_count == expected.crowded_count);
        CHECK(memcmp(joined.crowded, expected.crowded, sizeof joined.crowded) == 0);
        CHECK((meso_half_edges_require_manifold(&joined, mesh, &error) == MESO_OK) == (joined.crowded_count == 0));
    }
}

static void test_random(void)
{
    MesoRandom random;
    uint32_t crowded = 0;
    meso_random_init(&random, 3, 0);
    for (uint32_t round = 0; round < 600; round++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        uint32_t sides = round % 4 == 0 ? 0 : 2 + round % 4;
        MesoPolygonMesh mesh = random_mesh(&random, 7 + meso_random_below(&random, round % 3 ? 200 : 8), sides);
        compare(&mesh);
        meso_arena_rewind(&arena, mark);
        crowded += error.status == MESO_ERR_INPUT;
    }
    CHECK(crowded > 0);
}

/* A fan of triangles around vertex 0: its list is longer than any that is compared each with each. */
static void test_fan(void)
{
    MesoPolygonMesh mesh = {.vertex_count = MOST_FACES + 1, .face_count = MOST_FACES, .corner_count = 3 * MOST_FACES,
                            .side_count = 3, .corners = corners};
    for (uint32_t f = 0; f < MOST_FACES; f++) {
        corners[3 * f] = 0;
        corners[3 * f + 1] = 1 + f;
        corners[3 * f + 2] = 1 + (f + 1) % MOST_FACES;
    }
    compare(&mesh);
    corners[3 * 40 + 1] = 7;
    corners[3 * 50 + 2] = 7;
    compare(&mesh);
    CHECK(strcmp(error.message, "edge between vertices 1 and 8 joins more than two faces (6, 7, 41)") == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_random();
    test_fan();
    meso_arena_release(&arena);
    return 0;
}
