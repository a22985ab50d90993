/*
 * Triangulation: a triangle mesh that is cut again and again. Unlike a surface
 * it grows, and so it owns its arrays: what is cut keeps its place, and new
 * vertices and triangles come behind. Triangles carry the label of their
 * region, sides that are walls between regions say so.
 *
 * Half-edge h runs along its triangle h / 3 from corner h to that triangle's
 * next corner, as in half_edges.h. Neighbours may be wound against each other
 * (a Moebius band has no other way): a fan, below, walks around a vertex
 * whatever the windings.
 */
#ifndef MESO_TRIANGULATION_H
#define MESO_TRIANGULATION_H

#include "libcore/mesh/surface.h"

typedef struct MesoTriangulation {
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_room, triangle_room;    /* what the arrays have room for */
    MesoVec3 *positions;        /* [vertex_count] */
    uint32_t *vertex_corner;    /* [vertex_count] a corner at the vertex; MESO_NO_INDEX where no triangle has it */
    uint32_t *origins;          /* [vertex_count] vertex of the surface that it is; MESO_NO_INDEX: a cut has made it */
    uint32_t *corners;          /* [3 * triangle_count] vertices */
    uint32_t *twins;            /* [3 * triangle_count] half-edge across, or MESO_NO_INDEX at a border */
    uint32_t *labels;           /* [triangle_count] region */
    uint32_t *faces;            /* [triangle_count] face of the surface that it is, or is part of */
    uint8_t *walls;             /* [triangle_count] bit k: side k is part of a line, or of a border */

    /* What is carried along, interpolated linearly where a cut makes new vertices. */
    uint32_t vertex_width, corner_width;    /* numbers a vertex, and a corner; may be 0 */
    float *vertex_values;       /* [vertex_width * vertex_count] */
    float *corner_values;       /* [3 * corner_width * triangle_count] */
} MesoTriangulation;

/*
 * From a surface of triangles in which each edge has at most two; all labels 0, borders are walls. Vertices at which
 * several fans of triangles touch become several vertices, behind the others. Values are zero. Large meshes are numbered
 * again (locality.h); `origins` and `faces` say what was what. O(corners). MESO_ERR_INPUT by place, MESO_ERR_LIMIT,
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_triangulation_init(MesoTriangulation *mesh, const MesoSurface *surface, uint32_t vertex_width,
                                   uint32_t corner_width, MesoError *error);

void meso_triangulation_release(MesoTriangulation *mesh);

/*
 * Makes room for so many vertices and triangles in all; half as much again where arrays must move. New elements are not
 * set, but for `origins`. MESO_ERR_LIMIT beyond what half-edges can count, MESO_ERR_MEMORY; the mesh is as before then.
 */
MesoStatus meso_triangulation_reserve(MesoTriangulation *mesh, uint64_t vertex_count, uint64_t triangle_count,
                                      MesoError *error);

/*
 * Checks all that is promised: twins are mutual and join the same two vertices, vertex_corner is a corner there, each
 * vertex has one fan, borders and changes of label are walls on both sides, no triangle has a vertex twice.
 * MESO_ERR_INTERNAL with the first place that fails. For tests. O(corners).
 */
MesoStatus meso_triangulation_check(const MesoTriangulation *mesh, MesoError *error);

/* ---- walking ---- */

static inline uint32_t meso_next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static inline uint32_t meso_previous_corner(uint32_t corner)
{
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

static inline bool meso_side_is_wall(const MesoTriangulation *mesh, uint32_t half_edge)
{
    return mesh->walls[half_edge / 3] >> half_edge % 3 & 1;
}

/* A place in the fan of triangles around a vertex. Turned fans run through triangles that are wound the other way. */
typedef struct MesoFan {
    uint32_t corner;    /* at the vertex */
    bool turned;
} MesoFan;

/* The side by which the walk leaves the triangle: with the vertex and the spoke that comes next. */
static inline uint32_t meso_fan_exit(MesoFan fan)
{
    return fan.turned ? fan.corner : meso_previous_corner(fan.corner);
}

/* The side by which it has come in. */
static inline uint32_t meso_fan_entry(MesoFan fan)
{
    return fan.turned ? meso_previous_corner(fan.corner) : fan.corner;
}

/* Goes on to the next triangle, counter-clockwise where not turned; false, and stays, at a border. */
static inline bool meso_fan_next(const MesoTriangulation *mesh, MesoFan *fan)
{
    uint32_t vertex = mesh->corners[fan->corner];
    uint32_t across = mesh->twins[meso_fan_exit(*fan)];
    if (across == MESO_NO_INDEX)
        return false;
    /* wound alike, the half-edge across begins at the vertex if ours ends there */
    fan->turned = mesh->corners[across] != vertex;
    fan->corner = fan->turned ? meso_next_corner(across) : across;
    return true;
}

/*
 * The first place of the fan around a vertex that has triangles: where the vertex lies on a border, the one whose entry
 * is the border, so that meso_fan_next() meets all. O(triangles at the vertex).
 */
MesoFan meso_fan_first(const MesoTriangulation *mesh, uint32_t vertex);

/* ---- parts of a mesh ---- */

/* Triangles by the labels of their regions: where a field is asked for, and lines are drawn. */
typedef struct MesoDomain {
    const uint8_t *member;          /* by label: 1 where it belongs; NULL: all do */
    uint32_t triangle_count;
    const uint32_t *triangles;      /* [triangle_count] those whose label belongs, ascending; NULL: all of the mesh */
} MesoDomain;

static inline bool meso_domain_has(const MesoDomain *domain, const MesoTriangulation *mesh, uint32_t triangle)
{
    return !domain->member || domain->member[mesh->labels[triangle]];
}

/* A point of the surface: weights of the corners of a triangle, not negative, that add up to 1. */
typedef struct MesoMeshPoint {
    uint32_t triangle;
    float weight[3];
} MesoMeshPoint;

#endif
