/*
 * Strips of triangles, unfolded into the plane, and the shortest path in them
 * from a point of the first triangle to one of the last ("Euclidean Shortest
 * Paths in the Presence of Rectilinear Barriers", Lee and Preparata 1984, by
 * a funnel). Where that path bends around a vertex that has less than half a
 * turn on its other side, the strip is led around that side instead, until
 * there is none ("Efficiently Determining a Locally Exact Shortest Path on
 * Polyhedral Surfaces", Xin and Wang 2007): a geodesic, shorter each time.
 */
#ifndef MESO_STRIP_H
#define MESO_STRIP_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/cut_lines.h"

typedef struct MesoStripPoint {
    double x, y;
} MesoStripPoint;

/* A side between two triangles of the strip, as seen by who walks through. */
typedef struct MesoPortal {
    MesoStripPoint left, right, behind, beyond;     /* the third corners of the triangles before and after it */
    uint32_t left_vertex, right_vertex;
} MesoPortal;

typedef struct MesoStripBend {
    MesoStripPoint at;
    uint32_t vertex;
    uint32_t portal;        /* one that has the vertex, and */
    bool left;              /* whether on its left */
} MesoStripBend;

typedef struct MesoStrip {
    const MesoTriangulation *mesh;
    const MesoDomain *domain;   /* NULL: everywhere */
    MesoArena *arena;
    MesoCutNode from, to;
    uint32_t first;             /* triangle */
    uint32_t *sides;            /* [side_count] half-edges by which triangles are left */
    uint32_t side_count, side_room;
    MesoPortal *portals;        /* [side_count] */
    uint32_t portal_room;
    MesoStripPoint begin, end;  /* where `from` and `to` lie */
    MesoStripBend *bends;       /* [bend_count] of the shortest path */
    uint32_t bend_count, bend_room;
    double length;
} MesoStrip;

/* Whether a triangle has a node at or on one of its corners or sides, or in itself. */
bool meso_strip_touches(const MesoTriangulation *mesh, uint32_t triangle, const MesoCutNode *node);

/* Adds a side to the end; where it leads straight back, the last one goes. MESO_ERR_MEMORY alone. */
MesoStatus meso_strip_add(MesoStrip *strip, uint32_t side, MesoError *error);

/*
 * Adds sides around a vertex of `triangle`, the strip's last, until a triangle has `node`; the shorter way that is
 * inside the domain. Says that triangle. O(triangles at the vertex). MESO_ERR_NO where there is none.
 */
MesoStatus meso_strip_turn(MesoStrip *strip, uint32_t triangle, uint32_t vertex, const MesoCutNode *node,
                           uint32_t *reached, MesoError *error);

/*
 * Makes the path in the strip a geodesic between its ends: `bends` and `length`. O(sides) for each round; says whether
 * it has come to an end within `rounds` of them. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_strip_straighten(MesoStrip *strip, uint32_t rounds, bool *straight, MesoError *error);

/* How far along portal i, from its half-edge's origin, the path crosses it between two of its points; 0 to 1. */
double meso_strip_crossing(const MesoStrip *strip, uint32_t portal, MesoStripPoint begin, MesoStripPoint end);

#endif
