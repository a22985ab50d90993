/*
 * Directions at vertices, whose triangles do not lie in one plane. They are
 * told by their angle around the vertex, scaled so that all of it is a full
 * turn, and half a turn at a vertex of a border: on a smooth surface it would
 * be so. Straight on is where both sides have the same angle.
 */
#ifndef MESO_VERTEX_TIP_H
#define MESO_VERTEX_TIP_H

#include "libcore/geodesic/transport/straight_walk.h"

typedef struct MesoVertexTurn {
    double angle;       /* of all triangles at the vertex that walks can get to from the corner, in radians */
    double before;      /* of those clockwise of the corner, where there is a border; else 0 */
    bool closed;        /* no border */
} MesoVertexTurn;

/* Around the vertex of a corner; clockwise as its triangle is wound. O(triangles at the vertex). */
MesoVertexTurn meso_vertex_turn(const MesoWalkGround *ground, uint32_t corner);

/*
 * A tip at the vertex of a corner.
 *
 * corner  in the triangle by whose winding left and right are told; of a vertex of a triangulation, its vertex_corner
 * angle   scaled, in radians, counter-clockwise from the side that begins at the corner
 *
 * False, and no tip, where that leads out of the surface, or nothing has an angle there. O(triangles at the vertex).
 */
bool meso_vertex_tip(const MesoWalkGround *ground, uint32_t corner, double angle, MesoTip *tip);

/*
 * The scaled angle of a direction, in the frame of the corner's triangle, from the side that begins at the corner: what
 * meso_vertex_tip() asks for. O(triangles at the vertex).
 */
double meso_vertex_angle(const MesoWalkGround *ground, uint32_t corner, MesoComplex direction);

/*
 * Takes a tip that has come to corner `k` of its triangle over the vertex, straight on. False, and stays, where that
 * leads out of the surface. O(triangles at the vertex).
 */
bool meso_tip_pass_vertex(const MesoWalkGround *ground, MesoTip *tip, uint32_t k);

#endif
