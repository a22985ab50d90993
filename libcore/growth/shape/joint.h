/* Joints: where terminal shapes that are bent begin, end and meet. */
#ifndef MESO_JOINT_H
#define MESO_JOINT_H

#include "libcore/math/vec.h"

typedef struct MesoJoint {
    MesoVec3 position;
    MesoVec3 tangent;   /* unit length, the way that growth goes */
    MesoVec3 normal;    /* unit length, across the tangent; away from the surface */
    float width;        /* of the shape's sections, >= 0 */
    float flare;        /* change of the width with the length along; 0: shapes level off here */
} MesoJoint;

/*
 * A joint over the point `position` of a surface, `lift` above it along `normal`, unit length. Its tangent halves the
 * angle between `in`, how growth arrives, and `out`, how it goes on, both laid into the tangent plane, of any length:
 * two headings, or the chords before and behind it. Either may be 0 where strands begin and end. Where the normal lies
 * in the plane of both chords this is the paper's condition for G1 (Buron et al., figure 2; see bend.h).
 */
MesoJoint meso_joint(MesoVec3 position, MesoVec3 normal, MesoVec3 in, MesoVec3 out, float width, float lift);

/* The joint turned about its tangent, by an angle to the right as growth sees it, in radians. */
MesoJoint meso_joint_roll(MesoJoint joint, float angle);

#endif
