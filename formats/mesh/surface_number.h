/* Numbers on a surface that its file carries: attributes, and names that stand for numbers. */
#ifndef MESO_SURFACE_NUMBER_H
#define MESO_SURFACE_NUMBER_H

#include "libcore/mesh/polygon_mesh.h"

/*
 * A number for each vertex of `mesh`, as `what` says:
 *
 *     NAME                    an attribute or one of its components, of vertices, or of faces or corners, whose mean
 *                             over the corners at a vertex is its number; `otherwise` where none has an entry
 *     NAME:A=1,B=0.5          names ("group", "object", "material", or others) that stand for numbers, those that are
 *                             not listed for `otherwise`
 *
 * MESO_ERR_INPUT, with `path`, where the mesh has no such attribute, or a number is not finite or outside
 * [low, high], with the first vertex; MESO_ERR_USAGE where `what` cannot be read. O(corners).
 */
typedef struct MesoNumberWish {
    const char *what, *option;      /* as given, and by which option */
    float otherwise, low, high;
} MesoNumberWish;

MesoStatus meso_surface_numbers(float **numbers, MesoArena *arena, const MesoPolygonMesh *mesh,
                                const MesoNumberWish *wish, const char *path, MesoError *error);

#endif
