/* meso-quilt: grows a swatch of geometry over a surface, patch by patch. */
#include "cmd/quilt/quilt_job.h"
#include "libcore/base/lean_memory.h"

#define OUTPUTS "OUT.meso|.quilt|MESH"

static const MesoToolInfo QUILT_TOOL = {
    .name = "meso-quilt",
    .synopsis = "meso-quilt [options] SWATCH SURFACE -o " OUTPUTS "\n"
                "meso-quilt [options] SWATCH --plane LxW -o " OUTPUTS "\n"
                "meso-quilt [options] --swatch NAME [SURFACE | --plane LxW] -o OUT",
    .purpose = "Grow a swatch of geometry over a surface: mesh quilting.",
    .examples = "meso-quilt --swatch mail torso.obj -o mail.meso\n"
                "meso-quilt --swatch weave --plane 12x8 -o cloth.ply\n"
                "meso-quilt --guide auto --turns 6 nuts.ply bust.ply -o nuts.quilt\n"
                "meso-quilt --swatch ivy --jitter 0.1 -o ivy.ply",
    .words = "1 .obj .ply .off .glb .gltf .drc\n"
             "2 .obj .ply .off .glb .gltf .drc\n"
             "--output .meso .quilt .ply .obj .glb .drc .stl .usda\n"
             "--guide *\n"
             "--swatch weave wire mail rings nuts apples ivy scales armour\n"
             "--json .json",
    .operands_low = 0,
    .operands_high = 2,
};

int main(int argc, char **argv)
{
    MesoQuiltArguments a = {.output = MESO_SCENE_OUTPUT_DEFAULTS, .up = "auto", .periodic = "auto", .turns = 1,
                            .guide = "smooth", .embedding = "prisms"};
    const MesoOption options[] = {
        MESO_CHOICE(0, "to", "KIND", "kind of the product (default: the extension of the output)", &a.output.to,
                    "meso|quilt|ply|obj|glb|drc|stl|usda", .more = MESO_OPTION_OUTWARD),
        MESO_GROUP("Swatch"),
        MESO_TEXT(0, "swatch", "NAME", "a recipe in place of SWATCH: weave, wire, mail, rings, nuts, apples, ivy, "
                  "scales or armour", &a.swatch),
        MESO_COUNT(0, "columns", "N", "of a recipe: elements, or strands, along x", &a.columns, 1, 4096,
                   .given = &a.given.columns),
        MESO_COUNT(0, "rows", "N", "of a recipe: the same along y", &a.rows, 1, 4096, .given = &a.given.rows),
        MESO_NUMBER(0, "jitter", "J", "of a recipe: irregularity, in pitches (default 0: periodic)", &a.jitter, 0, 0.25,
                    .given = &a.given.jitter),
        MESO_COUNT(0, "sides", "N", "of a recipe: sides of a strand", &a.sides, 3, 256, .given = &a.given.sides),
        MESO_NUMBER(0, "thickness", "T", "of a recipe: across a strand, in pitches", &a.thickness, 1e-3, 1,
                    .given = &a.given.thickness),
        MESO_CHOICE(0, "swatch-up", "AXIS", "axis of SWATCH that is up (default auto: its thinnest side)", &a.up,
                    "auto|x|y|z"),
        MESO_CHOICE(0, "periodic", "HOW", "where the swatch is periodic: auto finds out (default), none, or x, y, xy",
                    &a.periodic, "auto|none|x|y|xy"),
        MESO_GROUP("Surface, lengths in its units"),
        MESO_TEXT(0, "plane", "LxW", "a rectangle in place of SURFACE", &a.plane),
        MESO_NUMBER(0, "scale", "S", "length of one unit of the swatch (default: so that the swatch is a fifth of the "
                    "surface; on a plane 1)", &a.scale, 1e-12, 1e12),
        MESO_NUMBER(0, "height", "H", "of the layer (default: as the swatch has it, by --scale)", &a.height, 1e-12,
                    1e12),
        MESO_NUMBER(0, "offset", "O", "of the layer's bottom from the surface (default 0)", &a.offset, -1e12, 1e12),
        MESO_TEXT(0, "guide", "HOW", "where the swatch's x axis points: smooth (default), auto (along curvature), u, "
                  "v, none, field=ATTRIBUTE, or a file of directions", &a.guide),
        MESO_COUNT(0, "turns", "N", "rotations that the swatch may take: 1 (default), 2, 4, ...", &a.turns, 1, 64),
        MESO_CHOICE(0, "embed", "HOW", "how the layer lies over the surface: along directions of least stretch "
                    "(prisms, default), along normals, or by charts with a shell map", &a.embedding,
                    MESO_QUILT_EMBEDDING_NAMES),
        MESO_GROUP("Growth"),
        MESO_NUMBER(0, "patch", "P", "what of a patch must match, as a share of the swatch (default 0.55)", &a.patch,
                    0.05, 0.95),
        MESO_NUMBER(0, "lambda", "L", "weight of normals in matching (default 1)", &a.lambda, 1e-6, 1e6),
        MESO_NUMBER(0, "mu", "M", "how strongly ends are pulled together (default 1)", &a.mu, 1e-6, 1e6),
        MESO_COUNT(0, "until", "N", "end after N patches (default: all)", &a.until, 1, 1 << 30),
        MESO_TEXT(0, "seeds", "LIST", "one product for each of these seeds: 1-10,20; -o has %d", &a.seeds),
        MESO_FLAG(0, "check", "measure how good the quilt is, and say it", &a.check),
        MESO_TEXT(0, "surface", "MATERIAL", "show the surface too, made of this: own, \"clay\", \"clay #a8653f 0.7\"",
                  &a.under),
        MESO_MESH_OPTIONS(a.output),
        MESO_UP_OPTION(a.output),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    meso_lean_memory();
    if (!meso_tool_start(&a.tool, &QUILT_TOOL, options, argc, argv))
        return meso_tool_finish(&a.tool);
    a.tool.status = meso_quilt_job_run(&a);
    return meso_tool_finish(&a.tool);
}
