/*
 * Bending of terminal shapes from joint to joint (Buron et al., "Dynamic On-Mesh Procedural Generation Control", 2014,
 * figure 2): along a cubic Bezier B between two points with normals, whose inner control points lie on the tangent
 * planes of the ends. A point (t, y, z) of a shape comes to
 *
 *     P = B(t) + w(t) (y L(t) + z N(t)),     T = B' / |B'|,  N = unit((1 - s) N0(t) + s N1(t)),  L = cross(N, T),
 *
 * where N0(t) is the first joint's normal, turned with the tangent the shortest way from there to T(t), N1(t) the
 * second's, and s = t t (3 - 2 t): the frame does not twist at the joints, and as little as it can between. w is a
 * cubic Bezier as B is. Normals follow the derivative of this map.
 *
 * The inner points of B lie at 2 c / (3 (1 + cos f)) along the tangents, for a chord c that they make the angle f with:
 * where the paper has them, at thirds, for f = 0, and farther out than there in turns, as an arc of a circle needs;
 * thirds projected would cut into what bulges. Arcs of 90 degrees are met to 3e-4 of their radius, of 20 to 1e-6.
 *
 * What shares a joint meets there in the same floats, and lines along the shapes go on in one direction: those on
 * surfaces too where the joint has no flare. Where it has one and the curvature changes, they break by flare, width and
 * change of curvature multiplied.
 */
#ifndef MESO_BEND_H
#define MESO_BEND_H

#include "libcore/growth/shape/joint.h"
#include "libcore/growth/shape/terminal_shape.h"
#include "libcore/math/box.h"

/* A shape's place: two of the joints. */
typedef struct MesoSpan {
    uint32_t from, to;
} MesoSpan;

typedef struct MesoBendFrame {
    MesoVec3 origin, tangent, left, normal;
    float width;
} MesoBendFrame;

/* B, T, L, N and w at t in [0,1]. At 0 and 1 these are the joint's own. */
MesoBendFrame meso_bend_frame(const MesoJoint *from, const MesoJoint *to, float t);

/* Control points of B. */
void meso_bend_curve(const MesoJoint *from, const MesoJoint *to, MesoVec3 p[4]);

/* Spans that a thread takes at once, with a box; a multiple of the lanes. */
enum { MESO_BEND_GRAIN = 1024 };

/* One shape, bent as often as there are spans. */
typedef struct MesoBending {
    const MesoTerminalShape *shape;
    const MesoJoint *joints;
    uint32_t span_count;
    const MesoSpan *spans;              /* [span_count] */
    MesoVec3 *positions, *normals;      /* [span_count * shape->body.vertex_count], span by span */
    uint8_t *folds;                     /* [span_count] or NULL; 1: too wide for its curve, and inside out there */
    MesoBox *boxes;                     /* [meso_bend_box_count()] or NULL; of so many spans each */
} MesoBending;

static inline uint32_t meso_bend_box_count(uint32_t span_count)
{
    return span_count / MESO_BEND_GRAIN + (span_count % MESO_BEND_GRAIN != 0);
}

/*
 * Fills positions, normals, folds and boxes. Widths of 0, joints in one place and opposite tangents or normals give something
 * finite, and normals of unit length. The same bytes for any number of threads (0: all cores), and for a span with
 * whatever others. O(vertices + rings).
 */
void meso_bend(const MesoBending *bending, uint32_t thread_count);

/* A body for each span, to `out` [span_count], of what meso_bend() makes; they share uvs, colours and corners. */
void meso_bent_bodies(const MesoBending *bending, MesoBody *out);

/* All spans as one body, with uvs, colours and corners of its own. MESO_ERR_LIMIT from 2^32 - 1 vertices on. */
MesoStatus meso_bent_body(const MesoBending *bending, MesoArena *arena, MesoBody *out, MesoError *error);

#endif
