/* Products: a file a frame, or one for all. */
#ifndef MESO_REPLICATE_OUTPUT_H
#define MESO_REPLICATE_OUTPUT_H

#include "cmd/replicate/replicate_carve.h"
#include "formats/replicate/animation_glb.h"
#include "formats/replicate/instance_glb.h"
#include "formats/replicate/usda_file.h"

typedef enum MesoReplicateProduct {
    MESO_PRODUCT_SCENES,        /* a mesh or model a frame */
    MESO_PRODUCT_INSTANCES,     /* a GLB with instances a frame */
    MESO_PRODUCT_USDA,          /* one for all */
    MESO_PRODUCT_ANIMATION      /* one GLB for all */
} MesoReplicateProduct;

typedef struct MesoReplicateOutput {
    MesoReplicateArguments *arguments;
    MesoTool *tool;
    const MesoReplicateKinds *kinds;
    MesoReplicateCarve *carve;
    const char *material;       /* of the surface; NULL: it is not shown */
    MesoReplicateProduct product;
    const char *path;           /* -o */
    bool numbered;              /* which has a frame's number */
    MesoInstanceScene scene;
    MesoInstanceShape surface;
    MesoMaterial look;          /* of the surface */
    MesoUsda *usda;
    MesoAnimation *animation;
    MesoPlacedDetail *placed;   /* [placed_room] */
    uint32_t placed_room;
} MesoReplicateOutput;

/* Whether one file has all frames. */
static inline bool meso_replicate_output_is_one(const MesoReplicateOutput *output)
{
    return output->product == MESO_PRODUCT_USDA || output->product == MESO_PRODUCT_ANIMATION;
}

/* Goes by -o, --to and --instances. MESO_ERR_USAGE where they do not fit together. */
MesoStatus meso_replicate_output_choose(MesoReplicateOutput *output, MesoReplicateArguments *arguments);

/*
 * Begins what is one for all, of a run that has looked ahead where there are bumps or holes. MESO_ERR_USAGE where these
 * would move over the surface. All that is given must outlive it.
 */
MesoStatus meso_replicate_output_begin(MesoReplicateOutput *output, const MesoReplicateRun *run,
                                       const MesoReplicateKinds *kinds, MesoReplicateCarve *carve);

/* Writes or adds the frame that a run is at, with its state where that is kept; all of it appears, or nothing. */
MesoStatus meso_replicate_output_frame(MesoReplicateOutput *output, const MesoReplicateRun *run);

/* Writes what is one for all, and releases everything, whatever `status` is. */
MesoStatus meso_replicate_output_end(MesoReplicateOutput *output, MesoStatus status);

#endif
