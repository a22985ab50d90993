/* meso-replicate: lets details replicate while a surface deforms. */
#include "cmd/replicate/replicate_job.h"

#define OUTPUTS "OUT-%04d.meso|.ply|.obj|.glb|.drc"

static const MesoToolInfo REPLICATE_TOOL = {
    .name = "meso-replicate",
    .synopsis = "meso-replicate [options] DETAILS FRAMES -o " OUTPUTS "\n"
                "meso-replicate [options] DETAILS FRAMES -o OUT.usda|.glb\n"
                "meso-replicate --deform HOW SURFACE -o body-%04d.ply",
    .purpose = "Let details replicate while a surface deforms.",
    .examples = "meso-replicate scales.details.json body-%04d.ply -o scales-%04d.meso\n"
                "meso-replicate --state s --frames 11-20 a.details.json b-%d.ply -o c-%d.ply\n"
                "meso-replicate --mode play --frames 17 a.details.json b.glb -o seventeen.ply\n"
                "meso-replicate --deform twist body.obj -o body-%04d.ply",
    .words = "1 .details.json .obj .ply .off .glb .gltf .drc\n"
             "2 .obj .ply .off .glb .gltf .drc .pc2 .mdd\n"
             "--output .meso .ply .obj .glb .drc .usda\n"
             "--mesh .obj .ply .off .glb .gltf .drc\n"
             "--state .state\n"
             "--plan .plan\n"
             "--deform stretch scale twist bend inflate .json\n"
             "--report .json\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = 2,
};

int main(int argc, char **argv)
{
    MesoReplicateArguments a = {.output = MESO_SCENE_OUTPUT_DEFAULTS, .mode = "plan", .births = "usual",
                                .substeps = 1, .count = 24,
                                .frames_per_second = 24, .fineness = 14};
    const MesoOption options[] = {
        MESO_CHOICE(0, "to", "KIND", "kind of the product (default: the extension of the output)", &a.output.to,
                    "meso|ply|obj|glb|drc|usda", .more = MESO_OPTION_OUTWARD),
        MESO_GROUP("Frames"),
        MESO_TEXT(0, "frames", "LIST", "which of them: 1-20,30, 1-99x2 (default: all)", &a.frames),
        MESO_NUMBER(0, "fps", "N", "frames a second, of an animation that is read or written (default 24)",
                    &a.frames_per_second, 0.001, 10000),
        MESO_INPUT_FILE(0, "mesh", "FILE", "the surface at rest (default: the first frame); a cache needs one",
                        &a.mesh),
        MESO_COUNT(0, "substeps", "N", "steps from a frame to the next (default 1)", &a.substeps, 1, 1000),
        MESO_GROUP("Details"),
        MESO_CHOICE(0, "mode", "HOW", "frame by frame (plan, default); by the shape alone, from a plan of the whole "
                    "clip (play); or by the paper's own rule (paper)", &a.mode, "plan|play|paper"),
        MESO_NUMBER(0, "mu", "S", "share of its size by which a detail grows or shrinks a frame (default 0.1)", &a.mu,
                    1e-6, 1, .given = &a.given.mu),
        MESO_CHOICE(0, "births", "HOW", "where details are born: as originals lie around each other (exemplars), by "
                    "how many there are at which distance (statistics), or as suits them (usual, default)", &a.births,
                    "usual|exemplars|statistics"),
        MESO_NUMBER(0, "ramp", "W", "share of a length over which a detail comes and goes (default 0.06)", &a.ramp,
                    1e-3, 0.9),
        MESO_NUMBER(0, "alpha", "A", "of --mode paper: area, over the largest at rest, at which triangles are split "
                    "(default 1.1)", &a.alpha, 1, 100, .given = &a.given.alpha),
        MESO_NUMBER(0, "beta", "B", "and, over the smallest, at which two details merge (default 0.9)", &a.beta, 0.01,
                    1, .given = &a.given.beta),
        MESO_NUMBER(0, "gamma", "G", "share of their distance by which these come nearer a frame (default 0.1)",
                    &a.gamma, 1e-3, 0.5, .given = &a.given.gamma),
        MESO_OUTPUT_FILE(0, "state", "FILE", "kept each frame, and gone on from where it is there", &a.state,
                         .more = MESO_OPTION_SILENT),
        MESO_OUTPUT_FILE(0, "plan", "FILE", "of --mode play: kept, and taken where it is there", &a.plan,
                         .more = MESO_OPTION_SILENT),
        MESO_OUTPUT_FILE(0, "report", "FILE", "write what became of each detail, and statistics of the frames",
                         &a.report, .more = MESO_OPTION_SILENT),
        MESO_GROUP("Products"),
        MESO_TEXT(0, "surface", "MATERIAL", "show the surface too, made of this: own, \"clay\", \"clay #a8653f 0.7\"",
                  &a.surface),
        MESO_COUNT(0, "fineness", "N", "edges of the surface across a bump, at least (default 14)", &a.fineness, 2,
                   1000),
        MESO_FLAG(0, "instances", "a .glb has each kind once, and where it stands (EXT_mesh_gpu_instancing)",
                  &a.instances),
        MESO_CHOICE(0, "up", "AXIS", "that is up on the surface, y (default) or z: for upright kinds, and in .glb and "
                    ".usda", &a.output.up, "y|z"),
        MESO_GROUP("Test sequences"),
        MESO_TEXT(0, "deform", "HOW", "deform SURFACE: stretch, scale, twist, bend, inflate, or as FILE.json says",
                  &a.deform),
        MESO_NUMBER(0, "amount", "A", "how much: times as long, degrees of twist and bend, or how far inflate goes",
                    &a.amount, -1e6, 1e6, .given = &a.given.amount),
        MESO_COUNT(0, "count", "N", "how many frames (default 24)", &a.count, 1, 1000000),
        MESO_MESH_OPTIONS(a.output),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (!meso_tool_start(&a.tool, &REPLICATE_TOOL, options, argc, argv))
        return meso_tool_finish(&a.tool);
    a.tool.status = meso_replicate_job_run(&a);
    return meso_tool_finish(&a.tool);
}
