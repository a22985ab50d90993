/* Meshes for the tests, and what is conserved on them. */
#ifndef MESO_MESH_FIXTURE_H
#define MESO_MESH_FIXTURE_H

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/half_edges.h"

static MesoError fixture_error;

static inline double random_unit(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) * 0x1p-53;
}

/* A torus of nx by ny quads; with `cut`, some become two triangles. */
static inline MesoPolygonMesh make_torus(MesoArena *arena, uint32_t nx, uint32_t ny, MesoRandom *cut)
{
    uint32_t n = nx * ny, c = 0;
    MesoPolygonMesh mesh = {.vertex_count = n, .positions = MESO_NEW(arena, MesoVec3, n, NULL),
                            .face_begin = MESO_NEW(arena, uint32_t, 2 * n + 1, NULL),
                            .corners = MESO_NEW(arena, uint32_t, 6 * n, NULL)};
    for (uint32_t j = 0; j < ny; j++)
        for (uint32_t i = 0; i < nx; i++) {
            double a = 2 * MESO_PI * i / nx, b = 2 * MESO_PI * j / ny, r = 3 + cos(b);
            mesh.positions[j * nx + i] = (MesoVec3){(float)(r * cos(a)), (float)(r * sin(a)), (float)sin(b)};
        }
    for (uint32_t j = 0; j < ny; j++)
        for (uint32_t i = 0; i < nx; i++) {
            uint32_t i1 = (i + 1) % nx, j1 = (j + 1) % ny;
            uint32_t v[4] = {j * nx + i, j * nx + i1, j1 * nx + i1, j1 * nx + i};
            bool two = cut && meso_random_below(cut, 2);
            for (uint32_t k = 0; k < (two ? 3 : 4); k++)
                mesh.corners[c++] = v[k];
            mesh.face_begin[++mesh.face_count] = c;
            if (!two)
                continue;
            mesh.corners[c++] = v[0];
            mesh.corners[c++] = v[2];
            mesh.corners[c++] = v[3];
            mesh.face_begin[++mesh.face_count] = c;
        }
    mesh.corner_count = c;
    return mesh;
}

/* The first `count` faces. */
static inline MesoPolygonMesh take_faces(MesoPolygonMesh mesh, uint32_t count)
{
    mesh.face_count = count;
    mesh.corner_count = meso_polygon_begin(&mesh, count);
    return mesh;
}

static inline void move_randomly(MesoPolygonMesh *mesh, MesoRandom *random, double by)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 *p = &mesh->positions[v];
        p->x += (float)(by * (random_unit(random) - 0.5));
        p->y += (float)(by * (random_unit(random) - 0.5));
        p->z += (float)(by * (random_unit(random) - 0.5));
    }
}

/* Reverses a face in place; the first corner stays. */
static inline void turn_face(MesoPolygonMesh *mesh, uint32_t face)
{
    uint32_t *low = mesh->corners + meso_polygon_begin(mesh, face) + 1;
    uint32_t *high = low + meso_polygon_sides(mesh, face) - 2;
    for (; low < high; low++, high--) {
        uint32_t kept = *low;
        *low = *high;
        *high = kept;
    }
}

static inline MesoHalfEdges join(MesoArena *arena, const MesoPolygonMesh *mesh)
{
    MesoHalfEdges edges;
    CHECK(meso_half_edges_join(&edges, arena, mesh, 1, &fixture_error) == MESO_OK);
    return edges;
}

static inline int64_t euler(MesoArena *arena, const MesoPolygonMesh *mesh)
{
    return (int64_t)mesh->vertex_count - join(arena, mesh).edge_count + mesh->face_count;
}

static inline double volume(const MesoPolygonMesh *mesh)
{
    double sum = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++)
        sum += meso_face_volume(mesh, f, (MesoVec3){0, 0, 0}) / 6;
    return sum;
}

static inline double area(const MesoPolygonMesh *mesh)
{
    double sum = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        MesoAreaVector a = meso_face_area(mesh, f);
        sum += sqrt(meso_area_dot(a, a)) / 2;
    }
    return sum;
}

static inline bool is_checked(const MesoPolygonMesh *mesh)
{
    return meso_polygon_mesh_check(mesh, 1, NULL, &fixture_error) == MESO_OK;
}

/* 2 x - y + z / 2 + 1 */
static inline double linear(MesoVec3 p)
{
    return 2 * (double)p.x - (double)p.y + (double)p.z / 2 + 1;
}

/* That number on vertices; the same on corners, whose entries are the vertices; and the number of each face. */
static inline void add_attributes(MesoPolygonMesh *mesh, MesoArena *arena)
{
    uint32_t n = mesh->vertex_count;
    float *heat = MESO_NEW(arena, float, n, NULL);
    double *wide = MESO_NEW(arena, double, 2 * n, NULL);
    uint32_t *entry_of = MESO_NEW(arena, uint32_t, mesh->corner_count, NULL);
    int32_t *number = MESO_NEW(arena, int32_t, mesh->face_count, NULL);
    for (uint32_t v = 0; v < n; v++) {
        heat[v] = (float)linear(mesh->positions[v]);
        wide[2 * v] = linear(mesh->positions[v]);
        wide[2 * v + 1] = v;
    }
    memcpy(entry_of, mesh->corners, mesh->corner_count * sizeof *entry_of);
    for (uint32_t f = 0; f < mesh->face_count; f++)
        number[f] = (int32_t)f;
    MesoAttribute made[3] = {
        {.name = "heat", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_FLOAT, .width = 1, .entry_count = n,
         .values = heat},
        {.name = "uv", .domain = MESO_ON_CORNERS, .scalar = MESO_SCALAR_DOUBLE, .width = 2, .entry_count = n,
         .values = wide, .entry_of = entry_of},
        {.name = "number", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT32, .width = 1,
         .entry_count = mesh->face_count, .values = number},
    };
    mesh->attribute_count = 3;
    mesh->attributes = MESO_NEW(arena, MesoAttribute, 3, NULL);
    memcpy(mesh->attributes, made, sizeof made);
}

/* Both are the linear function still, and each face's number is below `face_count`. */
static inline void check_attributes(const MesoPolygonMesh *mesh, uint32_t face_count)
{
    CHECK(mesh->attribute_count == 3);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        CHECK(fabs(meso_attribute_number(&mesh->attributes[0], meso_attribute_entry(&mesh->attributes[0], v), 0) -
                   linear(mesh->positions[v])) < 1e-5);
    for (uint32_t c = 0; c < mesh->corner_count; c++)
        CHECK(fabs(meso_attribute_number(&mesh->attributes[1], mesh->attributes[1].entry_of[c], 0) -
                   linear(mesh->positions[mesh->corners[c]])) < 1e-5);
    for (uint32_t f = 0; f < mesh->face_count; f++)
        CHECK(((const int32_t *)mesh->attributes[2].values)[f] < (int32_t)face_count);
}

#endif
