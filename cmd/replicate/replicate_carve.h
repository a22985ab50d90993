/* The surface of a frame with bumps and holes. */
#ifndef MESO_REPLICATE_CARVE_H
#define MESO_REPLICATE_CARVE_H

#include "cmd/replicate/replicate_kinds.h"
#include "cmd/replicate/replicate_modes.h"
#include "libcore/replicate/shape/carved_shape.h"

typedef struct MesoReplicateCarve {
    const MesoReplicateKinds *kinds;    /* NULL: nothing is carved */
    MesoCarvedKind *carvings;           /* [kind_count] */
    MesoMaterial *looks;                /* [kind_count] of bumps that have their own */
    const char **look_names;            /* [kind_count] NULL: as the surface is */
    float fineness;
    MesoCarvedMesh mesh;                /* owned */
    MesoVec3 *positions, *normals;      /* [mesh.vertex_count] of the frame */
    uint32_t *corners;                  /* [3 * triangle_count] without holes */
    uint32_t *roots;                    /* [triangle_count] its triangle at rest */
    uint32_t *under;                    /* [mesh.vertex_count] the bump that it is under, or MESO_NO_INDEX */
    uint32_t vertex_room, triangle_room, triangle_count;
} MesoReplicateCarve;

/* Reads the pictures of bumps. Nothing is carved where there are neither bumps nor holes. */
MesoStatus meso_replicate_carve_begin(MesoReplicateCarve *carve, const MesoReplicateKinds *kinds,
                                      MesoReplicateFiles *files, const MesoDetailsFile *details,
                                      const MesoTriangulation *rest, uint32_t fineness);
void meso_replicate_carve_end(MesoReplicateCarve *carve);

/* Carves the details that are new. */
MesoStatus meso_replicate_carve_details(MesoReplicateCarve *carve, const MesoReplicateRun *run);

/* The same, and goes to the frame that a run is at. */
MesoStatus meso_replicate_carve_frame(MesoReplicateCarve *carve, const MesoReplicateRun *run,
                                      const MesoPlacedDetail *placed);

/* The surface as a mesh with its own looks, in the tool's arena; `surface` as --surface has it. */
MesoStatus meso_replicate_carve_mesh(MesoPolygonMesh *mesh, const MesoReplicateCarve *carve,
                                     const MesoReplicateRun *run, const char *surface);

#endif
