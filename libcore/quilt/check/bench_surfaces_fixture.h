/* Surfaces for the benchmark of quilts: made up, with the shapes and the numbers of triangles of the paper's. */
#ifndef MESO_BENCH_SURFACES_FIXTURE_H
#define MESO_BENCH_SURFACES_FIXTURE_H

#include "libcore/math/noise.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

enum { BENCH_ROOM = 1 << 17 };

/* A surface while it is put together. */
typedef struct BenchShape {
    uint32_t vertex_count, triangle_count;
    MesoVec3 positions[BENCH_ROOM];
    uint32_t corners[3 * BENCH_ROOM];
} BenchShape;

typedef MesoVec3 (*BenchPlace)(MesoVec3 p);

/* Adds a mesh, each vertex where `place` has it, and lets go of the mesh. */
static inline void bench_add(BenchShape *shape, MesoTriangulation mesh, BenchPlace place, MesoVec3 move)
{
    CHECK(shape->vertex_count + mesh.vertex_count <= BENCH_ROOM);
    CHECK(shape->triangle_count + mesh.triangle_count <= BENCH_ROOM);
    for (uint32_t c = 0; c < 3 * mesh.triangle_count; c++)
        shape->corners[3 * shape->triangle_count + c] = mesh.corners[c] + shape->vertex_count;
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        shape->positions[shape->vertex_count + v] = meso_vec3_add(place(mesh.positions[v]), move);
    shape->vertex_count += mesh.vertex_count;
    shape->triangle_count += mesh.triangle_count;
    meso_triangulation_release(&mesh);
}

static inline bool bench_has_edge(const BenchShape *shape, uint32_t half_edge, uint32_t a, uint32_t b)
{
    uint32_t c = shape->corners[half_edge], d = shape->corners[meso_next_corner(half_edge)];
    return (c == a && d == b) || (c == b && d == a);
}

/* The longest edge is cut in the middle, until there are so many triangles. */
static inline void bench_split_to(BenchShape *shape, uint32_t triangle_count)
{
    while (shape->triangle_count < triangle_count) {
        uint32_t longest = 0, old_count = shape->triangle_count, middle = shape->vertex_count++;
        float most = 0;
        for (uint32_t h = 0; h < 3 * old_count; h++) {
            float length = meso_vec3_length(meso_vec3_sub(shape->positions[shape->corners[h]],
                                                          shape->positions[shape->corners[meso_next_corner(h)]]));
            longest = length > most ? h : longest;
            most = fmaxf(length, most);
        }
        uint32_t a = shape->corners[longest], b = shape->corners[meso_next_corner(longest)];
        shape->positions[middle] = meso_vec3_lerp(shape->positions[a], shape->positions[b], 0.5f);
        for (uint32_t h = 0; h < 3 * old_count; h++) {
            if (!bench_has_edge(shape, h, a, b))
                continue;
            uint32_t *part = &shape->corners[3 * shape->triangle_count++], next = meso_next_corner(h);
            part[0] = middle;
            part[1] = shape->corners[next];
            part[2] = shape->corners[meso_previous_corner(h)];
            shape->corners[next] = middle;
        }
    }
}

static inline MesoVec3 bench_as_it_is(MesoVec3 p)
{
    return p;
}

/* ---- places ---- */

/* An animal that sits: a body, a head, two ears. */
static inline MesoVec3 bench_on_bunny(MesoVec3 p)
{
    float ears = expf(-12 * ((p.x - 0.45f) * (p.x - 0.45f) + p.y * p.y * 0.3f)) * fmaxf(p.z, 0);
    float r = 1 + 0.18f * meso_noise(meso_vec3_scale(p, 1.6f), 5) + 0.06f * meso_noise(meso_vec3_scale(p, 4), 6);
    return meso_vec3_scale((MesoVec3){1.1f * p.x, 0.85f * p.y, p.z * (1 + 0.6f * ears)}, r);
}

/* A head on a neck. */
static inline MesoVec3 bench_on_bust(MesoVec3 p)
{
    float neck = expf(-9 * (p.z + 0.25f) * (p.z + 0.25f)), r = 1 + 0.12f * meso_noise(meso_vec3_scale(p, 2.5f), 8);
    return meso_vec3_scale((MesoVec3){p.x * (1 - 0.35f * neck), 0.85f * p.y * (1 - 0.35f * neck), 1.6f * p.z}, r);
}

/* One who stands, on one leg. */
static inline MesoVec3 bench_on_figure(MesoVec3 p)
{
    float r = 1 + 0.15f * meso_noise((MesoVec3){2 * p.x, 2 * p.y, 5 * p.z}, 11) +
              0.04f * meso_noise(meso_vec3_scale(p, 9), 12);
    return (MesoVec3){0.5f * r * p.x + 0.15f * sinf(3 * p.z), 0.4f * r * p.y, 2 * p.z};
}

static inline MesoVec3 bench_on_cushion(MesoVec3 p)
{
    float most = fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z))), r = 0.45f + 0.55f / most;
    return (MesoVec3){0.8f * r * p.x, 0.8f * r * p.y, 0.25f * r * p.z};
}

static inline MesoVec3 bench_on_back(MesoVec3 p)
{
    MesoVec3 q = bench_on_cushion((MesoVec3){p.x, p.z, -p.y});
    return (MesoVec3){q.x, -q.z, q.y};
}

static inline MesoVec3 bench_on_leg(MesoVec3 p)
{
    return (MesoVec3){0.14f * p.x, 0.14f * p.y, 0.6f * p.z};
}

static inline MesoVec3 bench_on_arm(MesoVec3 p)
{
    return (MesoVec3){0.12f * p.x, 0.7f * p.y, 0.12f * p.z};
}

/* A tube of height 1 becomes a torso, open at the waist and at the neck. */
static inline MesoVec3 bench_on_torso(MesoVec3 p)
{
    float h = p.z, shoulders = expf(-20 * (h - 0.8f) * (h - 0.8f)), neck = fmaxf(0, h - 0.85f) / 0.15f;
    float r = (0.75f + 0.15f * cosf(6.2831853f * h) * (1 - h) + 0.25f * shoulders) * (1 - 0.55f * neck);
    float chest = 1 + 0.1f * meso_noise((MesoVec3){2 * p.x, 2 * p.y, 3 * h}, 15);
    return (MesoVec3){1.1f * r * chest * p.x, 0.65f * r * chest * p.y, 2.2f * h};
}

/* A tube of height 1 becomes a cup: the lowest third is its bottom. */
static inline MesoVec3 bench_on_cup(MesoVec3 p)
{
    float t = p.z, bottom = fminf(t / 0.3f, 1), wall = fmaxf(0, (t - 0.3f) / 0.7f);
    float r = bottom < 1 ? 0.02f + 0.63f * bottom : 0.65f + 0.25f * wall + 0.1f * wall * (1 - wall);
    return (MesoVec3){r * p.x, r * p.y, 1.6f * wall + 0.1f * bottom * bottom};
}

static inline MesoVec3 bench_on_wall(MesoVec3 p)
{
    return (MesoVec3){p.x, p.y, 0.8f * meso_noise((MesoVec3){0.13f * p.x, 0.13f * p.y, 0.4f}, 17)};
}

/* ---- surfaces ---- */

static inline void bench_plane(BenchShape *shape)
{
    bench_add(shape, meso_fixture_sheet(1, 1, 10), bench_as_it_is, (MesoVec3){0, 0, 0});
}

static inline void bench_bunny(BenchShape *shape)
{
    bench_add(shape, meso_fixture_ball(25), bench_on_bunny, (MesoVec3){0, 0, 0});
    bench_split_to(shape, 5242);
}

static inline void bench_cup(BenchShape *shape)
{
    bench_add(shape, meso_fixture_tube(34, 33, 1), bench_on_cup, (MesoVec3){0, 0, 0});
    bench_split_to(shape, 2248);
}

static inline void bench_venus(BenchShape *shape)
{
    bench_add(shape, meso_fixture_ball(26), bench_on_bust, (MesoVec3){0, 0, 0});
    bench_split_to(shape, 5560);
}

static inline void bench_armour(BenchShape *shape)
{
    bench_add(shape, meso_fixture_tube(48, 44, 1), bench_on_torso, (MesoVec3){0, 0, 0});
}

static inline void bench_chair_seat(BenchShape *shape)
{
    bench_add(shape, meso_fixture_ball(22), bench_on_cushion, (MesoVec3){0, 0, 0});
    bench_add(shape, meso_fixture_ball(22), bench_on_back, (MesoVec3){0, 1.1f, 1.15f});
}

static inline void bench_chair_frame(BenchShape *shape)
{
    for (uint32_t i = 0; i < 4; i++)
        bench_add(shape, meso_fixture_ball(11), bench_on_leg,
                  (MesoVec3){i & 1 ? 0.65f : -0.65f, i & 2 ? 0.65f : -0.65f, -0.95f});
    bench_add(shape, meso_fixture_ball(6), bench_on_arm, (MesoVec3){1.1f, 0.1f, 0.5f});
    bench_add(shape, meso_fixture_ball(6), bench_on_arm, (MesoVec3){-1.1f, 0.1f, 0.5f});
    bench_split_to(shape, 12224 - 2 * 8 * 22 * 22);
}

static inline void bench_david(BenchShape *shape)
{
    bench_add(shape, meso_fixture_ball(79), bench_on_figure, (MesoVec3){0, 0, 0});
    bench_split_to(shape, 49988);
}

static inline void bench_wall(BenchShape *shape)
{
    bench_add(shape, meso_fixture_sheet(36, 34, 1), bench_on_wall, (MesoVec3){0, 0, 0});
}

static inline MesoTriangulation bench_finish(const BenchShape *shape)
{
    return meso_fixture_triangulation(shape->positions, shape->vertex_count, shape->corners, shape->triangle_count);
}

#endif
