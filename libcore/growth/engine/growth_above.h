/* Elements that are surely not below the surface: found in a tenth of the time that their depths take. */
#ifndef MESO_GROWTH_ABOVE_H
#define MESO_GROWTH_ABOVE_H

#include "libcore/growth/engine/growth.h"

/*
 * Whether each of twelve points of an element's curve lies over a triangle at its ends, or near those, and below that
 * by no more than `tolerance`, a share of the element's length. False where that cannot be told as quickly: beyond
 * borders, where the ends' normals are far apart, where triangles are wound both ways or lie against their normals.
 * O(1).
 */
bool meso_growth_is_above(const MesoGrown *grown, const MesoGrowthGround *ground, const MesoGrowthElement *element,
                          float tolerance);

/* Asks for the memory that it reads of an element. */
void meso_growth_fetch_ends(const MesoGrown *grown, const MesoGrowthGround *ground, const MesoGrowthElement *element);

#endif
