/* What kinds of details look like: bodies of a detail of size 1, and their materials. */
#ifndef MESO_REPLICATE_KINDS_H
#define MESO_REPLICATE_KINDS_H

#include "cmd/replicate/replicate_files.h"
#include "formats/replicate/details_spec.h"
#include "formats/replicate/instance_scene.h"
#include "libcore/scene/scene.h"

typedef struct MesoReplicateKinds {
    uint32_t kind_count;
    const MesoDetailKind *kinds;        /* [kind_count] */
    const char **names;                 /* [kind_count] */
    bool carved;                        /* there are bumps or holes */
    uint32_t *body_begin;               /* [kind_count + 1] none for those that are carved into the surface */
    MesoBody *bodies;                   /* [body_begin[kind_count]] x along the heading, z along the normal */
    uint32_t *body_materials;
    uint32_t material_count;
    MesoMaterial *materials;
    const char **material_names;
    MesoInstanceShape *shapes;          /* [kind_count] all bodies of a kind as one */
} MesoReplicateKinds;

/* Reads the meshes. MESO_ERR_INPUT where one has no length along its heading, or cannot be read. */
MesoStatus meso_replicate_kinds(MesoReplicateKinds *kinds, MesoReplicateFiles *files, const MesoDetailsFile *details);

#endif
