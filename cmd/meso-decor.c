/* meso-decor: splits a surface along lines of geodesic fields, again and again, as a pattern says. */
#include "cmd/common/scene_output.h"
#include "cmd/decor/decor_job.h"

static const MesoToolInfo DECOR_TOOL = {
    .name = "meso-decor",
    .synopsis = "meso-decor [options] PATTERN SURFACE -o " MESO_SCENE_OUTPUT_NAMES,
    .purpose = "Decorate a surface with a recursive geodesic pattern.",
    .examples = "meso-decor rings.pattern.json vase.obj -o vase.meso\n"
                "meso-decor --tree t.json --lines t.svg rings.pattern.json vase.obj -o v.glb\n"
                "meso-decor --until 3 rings.pattern.json vase.obj -o step3.meso\n"
                "meso-decor --seeds 1-10 wild.pattern.json vase.obj -o vase-%d.meso",
    .words = "1 .json\n"
             "2 .obj .ply .off .glb .gltf .drc\n"
             MESO_SCENE_OUTPUT_WORDS
             "--tree .json\n"
             "--lines .svg .obj\n"
             "--json .json",
    .operands_low = 2,
    .operands_high = 2,
};

int main(int argc, char **argv)
{
    MesoDecorArguments a = {.output = MESO_SCENE_OUTPUT_DEFAULTS, .engine = "fronts"};
    const MesoOption options[] = {
        MESO_SCENE_KIND_OPTION(a.output),
        MESO_OUTPUT_FILE(0, "tree", "FILE", "write the tree of regions there as JSON", &a.tree),
        MESO_OUTPUT_FILE(0, "lines", "FILE", "write the lines there: .svg, seen along -Z, or .obj", &a.lines),
        MESO_GROUP("Pattern"),
        MESO_COUNT(0, "until", "N", "end after N operations (default: all of them)", &a.until, 1, 1 << 30),
        MESO_TEXT(0, "seeds", "LIST", "one product for each of these seeds: 1-10,20; -o has %d", &a.seeds),
        MESO_CHOICE(0, "geodesics", "HOW",
                    "distances by fronts (default), by the graph of the paper, or exact, which is slow", &a.engine,
                    "fronts|graph|exact"),
        MESO_MESH_OPTIONS(a.output),
        MESO_UP_OPTION(a.output),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (!meso_tool_start(&a.tool, &DECOR_TOOL, options, argc, argv))
        return meso_tool_finish(&a.tool);
    a.tool.status = meso_decor_job_run(&a);
    return meso_tool_finish(&a.tool);
}
