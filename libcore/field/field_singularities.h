/* Vertices around which a direction field turns. */
#ifndef MESO_FIELD_SINGULARITIES_H
#define MESO_FIELD_SINGULARITIES_H

#include "libcore/field/triangle_frames.h"

/*
 * How often the powers turn around each vertex, into `turns` [vertex_count]; 0 at borders, and where triangles are
 * wound against each other. O(corners).
 */
void meso_field_turns(int *turns, const MesoFieldPowers *powers);

#endif
