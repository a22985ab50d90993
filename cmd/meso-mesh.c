/* meso-mesh: surfaces made ready. The work is in cmd/mesh. */
#include <string.h>

#include "cmd/mesh/mesh_job.h"
#include "cmd/mesh/mesh_steps.h"

static const MesoToolInfo info = {
    .name = "meso-mesh",
    .synopsis = "meso-mesh [options] STEP... SURFACE -o OUT\n"
                "meso-mesh info SURFACE\n"
                "meso-mesh help [STEP]",
    .purpose = "Makes surfaces ready: finds and mends what is wrong with them, and brings their\n"
               "faces into the form that is wanted. Steps are done in the order given: info,\n"
               "weld, clean, separate, orient, triangulate, pair, quads, subdivide, decimate,\n"
               "convert; `meso-mesh help` says what each does.",
    .examples = "meso-mesh info vase.obj\n"
                "meso-mesh weld orient subdivide=catmull-clark,2 vase.obj -o fine.ply\n"
                "meso-mesh help subdivide",
    .words = "1 help info weld weld= clean separate orient triangulate pair quads quads=linear subdivide "
             "subdivide=catmull-clark, subdivide=loop, subdivide=linear, decimate= convert .obj .ply .off\n"
             "--output .ply .obj .off .glb .drc\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = UINT32_MAX,
};

static const MesoToolInfo help_info = {
    .name = "meso-mesh help",
    .synopsis = "meso-mesh help [STEP]",
    .purpose = "Says what the steps do.",
    .examples = "meso-mesh help weld",
    .words = "1 info weld clean separate orient triangulate pair quads subdivide decimate convert",
    .operands_low = 0,
    .operands_high = 1,
};

static int help(int argc, char **argv)
{
    MesoTool tool = {0};
    MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    if (meso_tool_start(&tool, &help_info, options, argc, argv))
        tool.status = meso_mesh_steps_help(tool.operand_count ? tool.operands[0] : NULL, &tool.error);
    return meso_tool_finish(&tool);
}

int main(int argc, char **argv)
{
    MesoMeshArguments a = {.crease = (float)MESO_NO_CREASE};
    MesoTool *tool = &a.tool;
    MesoOption options[] = {
        MESO_GROUP("Steps"),
        MESO_NUMBER(0, "crease", "DEGREES", "subdivide and quads keep edges sharp whose faces' normals enclose more",
                    &a.crease, 0, 180),
        MESO_TOOL_OPTIONS(*tool),
        {0},
    };
    if (argc > 1 && strcmp(argv[1], "help") == 0)
        return help(argc - 1, argv + 1);
    if (meso_tool_start(tool, &info, options, argc, argv))
        tool->status = meso_mesh_job_run(&a);
    return meso_tool_finish(tool);
}
