/* Numbers of a surface, or of a picture over it, as details ask for them. */
#ifndef MESO_REPLICATE_MAPS_H
#define MESO_REPLICATE_MAPS_H

#include "cmd/replicate/replicate_files.h"
#include "formats/replicate/details_spec.h"
#include "libcore/growth/ground/growth_maps.h"

/* What details stand on. */
typedef struct MesoReplicateGround {
    const MesoPolygonMesh *triangles;   /* of the file, cut */
    MesoGrowthGround ground;
    MesoReplicateFiles *files;
    MesoTool *tool;
} MesoReplicateGround;

/*
 * A map with values in [0,1]: what is not between its ends is cut off. MESO_ERR_INPUT where the surface has no such
 * attribute or no texture coordinates, or values are not finite.
 */
MesoStatus meso_replicate_map(MesoGrowthMap *map, const MesoReplicateGround *ground, const MesoDetailMap *wanted);

/* [triangle_count] vectors of an attribute of three numbers, of faces or vertices. MESO_ERR_INPUT without one. */
MesoStatus meso_replicate_vectors(MesoVec3 **vectors, const MesoReplicateGround *ground, const char *name);

#endif
