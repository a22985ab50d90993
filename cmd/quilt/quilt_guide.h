/* The directions of --guide: where the swatch's x axis is to point. */
#ifndef MESO_QUILT_GUIDE_H
#define MESO_QUILT_GUIDE_H

#include "cmd/quilt/quilt_arguments.h"
#include "libcore/mesh/cut/triangulation.h"

/*
 * Of --guide FILE, its directions as an attribute of faces, before these are cut; of another guide nothing. A text of
 * three numbers for each face, in the order of the surface's file. MESO_ERR_INPUT with the line that is none, or where
 * there are more or fewer.
 */
MesoStatus meso_quilt_guide_add(MesoPolygonMesh *polygons, MesoQuiltArguments *arguments);

/*
 * A direction for each triangle of `base`, whose `faces` are those of `polygons`; NULL for --guide none. Triangles to
 * which a file or an attribute gives none follow their neighbours. How many singularities a field has that was found
 * is said. MESO_ERR_INPUT where the surface lacks what --guide names.
 */
MesoStatus meso_quilt_guide_find(MesoVec3 **guide, const MesoPolygonMesh *polygons, const MesoTriangulation *base,
                                 MesoQuiltArguments *arguments);

/* By how much the swatch may turn away from it, for strands that are woven: not at all where somebody gave it. */
float meso_quilt_guide_turn(const MesoQuiltArguments *arguments);

#endif
