/*
 * Scenes out: what every tool does whose work ends in a scene. The kinds of its product, with --to and the extension of
 * -o, the options of the writers, the file that appears whole or not at all, and the report.
 *
 *     MyArguments a = {.output = MESO_SCENE_OUTPUT_DEFAULTS};
 *     MesoOption options[] = {MESO_SCENE_KIND_OPTION(a.output), ..., MESO_MESH_OPTIONS(a.output),
 *                             MESO_TOOL_OPTIONS(a.tool), {0}};
 *     ...
 *     status = meso_tool_choose_scene_kind(tool, &a.output);      before the work
 *     ...
 *     status = meso_tool_write_scene(tool, &a.output, &(MesoSceneProduct){.scene = &scene});
 */
#ifndef MESO_SCENE_OUTPUT_H
#define MESO_SCENE_OUTPUT_H

#include "cmd/common/tool.h"
#include "formats/scene/mesh_file.h"

/* For the synopsis, and for the words of MesoToolInfo. */
#define MESO_SCENE_OUTPUT_NAMES "OUT.meso|MESH"
#define MESO_SCENE_OUTPUT_WORDS "--output .meso .ply .obj .glb .drc .stl .usda\n"

typedef struct MesoSceneKind {
    const char *name;           /* and extension */
    MesoStatus (*write)(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                        MesoError *error);      /* NULL: a model */
    enum { MESO_SCENE_NO_DRACO, MESO_SCENE_MAY_DRACO, MESO_SCENE_DRACO } draco;
    bool placed;                /* says which axis is up, and the unit */
    const char *instead;        /* what helps where the product is too large for the kind; NULL: nothing */
} MesoSceneKind;

typedef struct MesoSceneOutput {
    const MesoSceneKind *kind;  /* found by meso_tool_choose_scene_kind() */
    const char *to;             /* --to */
    const char *compress, *up;  /* --compress, --up */
    float unit;                 /* --unit */
    const char *slots, *shard;  /* --slots, --shard; NULL: all of it */
    bool lengths, tangents, instances;  /* --lengths, --tangents, --instances */
    bool weld, cap_borders;     /* --weld, --cap-borders */
    MesoSelectionRule rule;     /* what they say, from meso_tool_choose_scene_kind() */
    uint32_t position_bits, normal_bits, speed;
    struct {
        bool compress, up, unit, position_bits, normal_bits, speed;
    } given;
} MesoSceneOutput;

#define MESO_SCENE_OUTPUT_DEFAULTS \
    {.compress = "none", .up = "y", .unit = 1, .position_bits = 14, .normal_bits = 10, .speed = 7}

#define MESO_SCENE_KIND_OPTION(o)                                                             \
    MESO_CHOICE(0, "to", "KIND", "kind of the product (default: the extension of the output)", &(o).to, \
                "meso|ply|obj|glb|drc|stl|usda", .more = MESO_OPTION_OUTWARD)

/* Which axis of the scene is up: for the tools that have no --up of their own. */
#define MESO_UP_OPTION(o)                                                                     \
    MESO_CHOICE(0, "up", "AXIS", "that is up in the product's coordinates, y (default) or z, for .glb and .usda", \
                &(o).up, "y|z", .given = &(o).given.up)

#define MESO_MESH_OPTIONS(o)                                                                  \
    MESO_GROUP("Meshes (.glb, .drc, .usda)"), \
    MESO_CHOICE(0, "compress", "HOW", "of .glb: none (default), which everything opens, draco or meshopt", \
                &(o).compress, "none|draco|meshopt", .given = &(o).given.compress), \
    MESO_NUMBER(0, "unit", "M", "metres of one unit, for .glb and .usda (default 1)", &(o).unit, 1e-9, 1e9, \
                .given = &(o).given.unit), \
    MESO_FLAG(0, "lengths", "of .glb: lengths around and along as second texture coordinates", &(o).lengths), \
    MESO_FLAG(0, "tangents", "of .glb: tangents", &(o).tangents), \
    MESO_FLAG(0, "instances", "of .glb: bodies that lie rigidly at several places are written once", \
              &(o).instances), \
    MESO_COUNT(0, "position-bits", "N", "compressed: precision of positions (default 14)", &(o).position_bits, 4, 24, \
               .given = &(o).given.position_bits), \
    MESO_COUNT(0, "normal-bits", "N", "compressed: precision of normals (default 10)", &(o).normal_bits, 4, 16, \
               .given = &(o).given.normal_bits), \
    MESO_COUNT(0, "speed", "N", "Draco: 0 smallest to 10 fastest (default 7)", &(o).speed, 0, 10, \
               .given = &(o).given.speed)

#define MESO_STRAND_OPTIONS(o)                                                                \
    MESO_GROUP("Strands of meshes"), \
    MESO_FLAG(0, "weld", "each strand as one mesh", &(o).weld), \
    MESO_FLAG(0, "cap-borders", "close the ends of strands that borders cut", &(o).cap_borders)

/* A part of the product, of which --provenance says nothing: put together, the parts are the whole. */
#define MESO_PART_OPTIONS(o)                                                                  \
    MESO_GROUP("Parts"), \
    MESO_TEXT(0, "slots", "A-B", "write these slots alone", &(o).slots, .more = MESO_OPTION_OUTWARD), \
    MESO_TEXT(0, "shard", "I/N", "write share I of N, from 1 on", &(o).shard, .more = MESO_OPTION_OUTWARD)

/* The kind by its name, "glb", in either case; NULL for others. */
const MesoSceneKind *meso_scene_kind_named(const char *name);

/*
 * The kind that --to or else the extension of -o names; without -o the product goes to standard output, which then
 * tool->output says. MESO_ERR_USAGE where neither names one, and where an option is given that its writer has not.
 */
MesoStatus meso_tool_choose_scene_kind(MesoTool *tool, MesoSceneOutput *output);

enum { MESO_SCENE_BESIDE = 2 };

typedef struct MesoSceneProduct {
    const MesoScene *scene;
    /* Writes the scene as a model (.meso) of the tool's own method; NULL: as bodies, and the scene has no sweeps. */
    MesoStatus (*write_model)(const void *model, const MesoProvenance *provenance, MesoOutput *output,
                              MesoError *error);
    const void *model;          /* for `write_model` */
    MesoOutput *beside[MESO_SCENE_BESIDE];  /* more files of the same run, written but not committed; NULL: none */
    const char *smaller;        /* options of the tool that make less of it, for messages; NULL: it has none */
} MesoSceneProduct;

/*
 * Writes a scene to tool->output, with progress, and puts into the report: the kind, how many ids there are, parts,
 * vertices, faces, triangles, and bytes. What is beside it appears with it, or not at all; ends all of these files,
 * whatever happens. Errors as those of the writers.
 */
MesoStatus meso_tool_write_scene(MesoTool *tool, const MesoSceneOutput *output, const MesoSceneProduct *product);

#endif
