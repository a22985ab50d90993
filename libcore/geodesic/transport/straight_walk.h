/*
 * Straightest walks over a triangulation ("Straightest Geodesics on Polyhedral
 * Surfaces", Polthier and Schmies 1998): straight on in every triangle and
 * across every side. The triangles on the way are unfolded into the plane of
 * the first, where the walk is the x axis; a crossing asks for the sign of one
 * corner's y. There is no tolerance, so every walk goes somewhere, on any mesh:
 * a corner that is met exactly counts as on the left.
 *
 * A walk carries every direction along with it at the angle that it has to the
 * heading. So the heading of a tip that has come to its end is the direction
 * to go on in, and turned by an angle another one that was carried there.
 */
#ifndef MESO_STRAIGHT_WALK_H
#define MESO_STRAIGHT_WALK_H

#include "libcore/geodesic/transport/walk.h"

/*
 * Walks all of them to their ends; sixteen at a time, so that they wait for memory together. Pieces of one walk come in
 * their order, those of several between one another. From a corner or a side a heading may lead out of the triangle;
 * it goes on in what lies beyond, unfolded. Each walk is the same in whichever company. O(crossings).
 *
 * walks    [count] in place
 * options  NULL: none
 */
void meso_walks(const MesoWalkGround *ground, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options);

/* ---- headings ---- */

/* Turns left by an angle in radians; left as it was where the tip's branch began. */
static inline void meso_tip_turn(MesoTip *tip, double angle)
{
    double sine = sin(angle), cosine = cos(angle);
    MesoComplex turn = {cosine, tip->turned ? -sine : sine};
    tip->heading = meso_complex_unit(meso_complex_times(tip->heading, turn));
}

/*
 * What a direction at the tip `from`, in the frame of its triangle, has become at `to`, to where the tip has walked
 * without a turn, over sides and vertices: it keeps its angle to the heading.
 */
static inline MesoComplex meso_tip_transport(const MesoTip *from, const MesoTip *to, MesoComplex direction)
{
    MesoComplex angle = meso_complex_times(direction, meso_complex_conjugate(from->heading));
    if (from->turned != to->turned)
        angle.im = -angle.im;
    return meso_complex_times(angle, to->heading);
}

/* ---- in space ---- */

void meso_tip_position(const MesoTriangulation *mesh, const MesoTip *tip, double position[3]);

/* A direction in the frame of a triangle, of the length that it has there. O(1). */
void meso_walk_direction(const MesoTriangulation *mesh, uint32_t triangle, MesoComplex direction, double out[3]);

/* Heads along the part of a vector that lies in the triangle's plane; false, and stays, where there is none. */
bool meso_tip_head(MesoTip *tip, const MesoTriangulation *mesh, const double towards[3]);

#endif
