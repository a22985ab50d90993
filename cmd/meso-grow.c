/* meso-grow: lets a grammar grow over a surface. */
#include "cmd/grow/grow_job.h"
#include "libcore/chart/geometry_image.h"
#include "libcore/growth/shape/terminal_shape.h"

#define OUTPUTS "OUT.meso|MESH|.svg"

static const MesoToolInfo GROW_TOOL = {
    .name = "meso-grow",
    .synopsis = "meso-grow [options] GRAMMAR SURFACE -o " OUTPUTS,
    .purpose = "Let a grammar grow over a surface.",
    .examples = "meso-grow ivy.grammar vase.obj -o ivy.meso\n"
                "meso-grow --set pace=\"4 mm\" --seed 3 ivy.grammar vase.obj -o ivy.glb\n"
                "meso-grow --until 20 --trace steps.jsonl lace.grammar vase.obj -o lace.svg\n"
                "meso-grow --seeds 1-10 cracks.grammar mask.obj -o cracks-%d.meso",
    .words = "1 .grammar\n"
             "2 .obj .ply .off .glb .gltf .drc\n"
             "--output .meso .ply .obj .glb .drc .stl .usda .svg\n"
             "--trace .jsonl\n"
             "--json .json",
    .operands_low = 2,
    .operands_high = 2,
};

int main(int argc, char **argv)
{
    MesoGrowArguments a = {.output = MESO_SCENE_OUTPUT_DEFAULTS, .up = {0, 1, 0}, .detail = MESO_NO_INDEX};
    const MesoOption options[] = {
        MESO_CHOICE(0, "to", "KIND", "kind of the product (default: the extension of the output)", &a.output.to,
                    "meso|ply|obj|glb|drc|stl|usda|svg", .more = MESO_OPTION_OUTWARD),
        MESO_GROUP("Growth"),
        MESO_LIST(0, "set", "NAME=VALUE", "a parameter of the grammar; several with commas between, or given again",
                  &a.set),
        MESO_POINT(0, "up", "X,Y,Z", "which way is up on the surface (default 0,1,0)", &a.up),
        MESO_CHOICE(0, "march", "WAY", "how steps go: straight over the mesh (default), or through a texture, to its "
                    "texels, or by its metric", &a.march, "mesh|texture|texel|metric"),
        MESO_CHOICE(0, "atlas", "WHICH", "charts of the texture: own (default), or uv, the surface's", &a.atlas,
                    "own|uv"),
        MESO_COUNT(0, "texels", "N", "along a side of the texture (default 1024)", &a.texels,
                   MESO_GEOMETRY_IMAGE_LEAST, MESO_GEOMETRY_IMAGE_MOST),
        MESO_COUNT(0, "detail", "N", "how finely built-in shapes are divided, 0 to 8, whatever the grammar says",
                   &a.detail, 0, MESO_SHAPE_DETAIL_MAX),
        MESO_COUNT(0, "until", "N", "end after N generations (default: when nothing grows any more)", &a.until, 1,
                   1 << 30),
        MESO_COUNT(0, "generations", "N", "most generations, beside the grammar's limit (default 1000000)",
                   &a.most_generations, 1, 1 << 30),
        MESO_COUNT(0, "elements", "N", "most elements, beside the grammar's limit (default 50000000)", &a.most_elements,
                   1, 1 << 30),
        MESO_FLAG(0, "partial", "where a limit stops it, write what has grown; the exit code is 3 all the same",
                  &a.partial),
        MESO_OUTPUT_FILE(0, "trace", "FILE", "write what each branch did as lines of JSON", &a.trace,
                         .more = MESO_OPTION_SILENT),
        MESO_TEXT(0, "show-map", "NAME=FILE", "write a map of the grammar as .png or .exr over the texture coordinates",
                  &a.show_map, .more = MESO_OPTION_SILENT),
        MESO_TEXT(0, "surface", "MATERIAL", "show the surface too, made of this: own, \"clay\", \"clay #a8653f 0.7\"",
                  &a.surface),
        MESO_TEXT(0, "seeds", "LIST", "one product for each of these seeds: 1-10,20; -o has %d", &a.seeds),
        MESO_MESH_OPTIONS(a.output),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (!meso_tool_start(&a.tool, &GROW_TOOL, options, argc, argv))
        return meso_tool_finish(&a.tool);
    a.tool.status = meso_grow_job_run(&a);
    return meso_tool_finish(&a.tool);
}
