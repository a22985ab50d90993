/* A small model in which nothing is wrong: two rings, linked as in a chain, of sweeps as meso-map writes them. */
#ifndef MESO_LINKED_RINGS_FIXTURE_H
#define MESO_LINKED_RINGS_FIXTURE_H

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/check/inspection.h"

enum {
    AROUND = 12, ALONG = 7, SLOTS = 8, RINGS = 2, SWEEPS = SLOTS * RINGS,
    SWEEP_VERTICES = AROUND * ALONG, SWEEP_TRIANGLES = 2 * AROUND * (ALONG - 1),
    ROOM = 8000
};

#define BIG_RADIUS 2.0
#define SMALL_RADIUS 0.4

typedef struct Model {
    uint32_t vertex_count, triangle_count, cage_count;
    MesoVec3 positions[ROOM], normals[ROOM], cages[8 * SLOTS];
    uint32_t corners[3 * ROOM], slots[ROOM], things[ROOM], across[4 * SLOTS];
} Model;

static inline uint32_t model_vertex(Model *m, MesoVec3 position, MesoVec3 normal)
{
    m->positions[m->vertex_count] = position;
    m->normals[m->vertex_count] = normal;
    return m->vertex_count++;
}

static inline uint32_t model_triangle(Model *m, uint32_t a, uint32_t b, uint32_t c, uint32_t slot, uint32_t thing)
{
    uint32_t t = m->triangle_count++;
    m->corners[3 * t] = a;
    m->corners[3 * t + 1] = b;
    m->corners[3 * t + 2] = c;
    m->slots[t] = slot;
    m->things[t] = thing;
    return t;
}

/* Vertex of a ring of sweep `slot` of a ring of the chain. */
static inline uint32_t sweep_vertex(uint32_t ring, uint32_t slot, uint32_t along, uint32_t around)
{
    return (ring * SLOTS + slot) * SWEEP_VERTICES + along * AROUND + around % AROUND;
}

/* The first of the two triangles of a quad of a sweep. */
static inline uint32_t sweep_triangle(uint32_t ring, uint32_t slot, uint32_t along, uint32_t around)
{
    return (ring * SLOTS + slot) * SWEEP_TRIANGLES + 2 * (along * AROUND + around);
}

/* The first ring lies in the plane of x and y, the second stands on it and goes through its middle. */
static inline void put_ring_vertex(Model *m, uint32_t ring, uint32_t step, uint32_t around)
{
    double u = 2 * MESO_PI * (step % (SLOTS * (ALONG - 1))) / (SLOTS * (ALONG - 1)), v = 2 * MESO_PI * around / AROUND;
    double x = cos(u), y = sin(u), out = cos(v), up = sin(v), far = BIG_RADIUS + SMALL_RADIUS * out;
    MesoVec3 p = {(float)(far * x), (float)(far * y), (float)(SMALL_RADIUS * up)};
    MesoVec3 n = {(float)(out * x), (float)(out * y), (float)up};
    if (ring == 1) {
        p = (MesoVec3){(float)((double)p.x + BIG_RADIUS), -p.z, p.y};
        n = (MesoVec3){n.x, -n.z, n.y};
    }
    model_vertex(m, p, n);
}

static inline void put_sweep(Model *m, uint32_t ring, uint32_t slot)
{
    for (uint32_t i = 0; i < ALONG; i++)
        for (uint32_t k = 0; k < AROUND; k++)
            put_ring_vertex(m, ring, slot * (ALONG - 1) + i, k);
    for (uint32_t i = 0; i + 1 < ALONG; i++)
        for (uint32_t k = 0; k < AROUND; k++) {
            uint32_t a = sweep_vertex(ring, slot, i, k), b = sweep_vertex(ring, slot, i, k + 1);
            uint32_t c = sweep_vertex(ring, slot, i + 1, k + 1), d = sweep_vertex(ring, slot, i + 1, k);
            model_triangle(m, a, d, c, slot, ring);
            model_triangle(m, a, c, b, slot, ring);
        }
}

/* Boxes of a wheel around the first ring. */
static inline void put_cage(Model *m, uint32_t slot)
{
    static const int out[4] = {0, 1, 1, 0}, on[4] = {0, 0, 1, 1};
    for (uint32_t k = 0; k < 8; k++) {
        double angle = 2 * MESO_PI * (slot + (uint32_t)on[k & 3]) / SLOTS, radius = out[k & 3] ? 3 : 1;
        m->cages[8 * slot + k] = (MesoVec3){(float)(radius * cos(angle)), (float)(radius * sin(angle)),
                                            k < 4 ? -0.5f : 0.5f};
    }
    m->across[4 * slot] = (slot + SLOTS - 1) % SLOTS;
    m->across[4 * slot + 2] = (slot + 1) % SLOTS;
    m->across[4 * slot + 1] = m->across[4 * slot + 3] = MESO_NO_INDEX;
}

static inline void model_make(Model *m)
{
    memset(m, 0, sizeof *m);
    for (uint32_t ring = 0; ring < RINGS; ring++)
        for (uint32_t slot = 0; slot < SLOTS; slot++)
            put_sweep(m, ring, slot);
    for (uint32_t slot = 0; slot < SLOTS; slot++)
        put_cage(m, slot);
    m->cage_count = SLOTS;
    CHECK(m->vertex_count == SWEEPS * SWEEP_VERTICES && m->triangle_count == SWEEPS * SWEEP_TRIANGLES);
}

/* A closed tetrahedron with its lowest corner at `p`, pointing outwards. */
static inline void put_tetrahedron(Model *m, MesoVec3 p, float size, uint32_t slot, uint32_t thing)
{
    static const float at[4][3] = {{0, 0, 0}, {1, 0, 1}, {-0.5f, 0.9f, 1}, {-0.5f, -0.9f, 1}};
    static const uint32_t faces[4][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
    uint32_t first = m->vertex_count;
    for (int i = 0; i < 4; i++) {
        MesoVec3 normal = meso_vec3_unit((MesoVec3){at[i][0], at[i][1], at[i][2] - 0.75f}, (MesoVec3){0, 0, 1});
        model_vertex(m, meso_vec3_mad(p, size, (MesoVec3){at[i][0], at[i][1], at[i][2]}), normal);
    }
    for (int i = 0; i < 4; i++)
        model_triangle(m, first + faces[i][0], first + faces[i][1], first + faces[i][2], slot, thing);
}

static inline MesoInspectedMesh model_mesh(const Model *m)
{
    return (MesoInspectedMesh){.vertex_count = m->vertex_count, .normal_count = m->vertex_count,
                               .triangle_count = m->triangle_count, .positions = m->positions, .normals = m->normals,
                               .corners = m->corners, .slots = m->slots, .things = m->things,
                               .cage_count = m->cage_count, .cages = m->cages, .across = m->across};
}

#endif
