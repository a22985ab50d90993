/* meso-check: what is wrong with a mesh, a model or an assignment, and where. The work is in libcore/check. */
#include <stdio.h>
#include <string.h>

#include "cmd/check/check_input.h"
#include "cmd/check/check_mark.h"
#include "cmd/check/check_report.h"
#include "cmd/common/input_kind.h"
#include "formats/json/json_text.h"
#include "formats/mesh/surface_read.h"
#include "formats/tiling/result/slots_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/mesh/orientation.h"

static const MesoToolInfo CHECK_TOOL = {
    .name = "meso-check",
    .synopsis = "meso-check [options] MODEL\n"
                "meso-check [options] MESH\n"
                "meso-check [options] SLOTS [--tiles TILES --surface SURFACE]",
    .purpose = "Find what is wrong with a mesh, a model, a quilt or an assignment, and say\n"
               "where. Exits with 1 where more is wrong than the bounds allow.",
    .examples = "meso-check vase.meso\n"
                "meso-check --max-gap 0 --max-angle 0.01 --max-crossings 0 vase.meso\n"
                "meso-check --fast --mark faults.ply vase.glb -o vase.check.json\n"
                "meso-check vase.slots --tiles vase.tiles.json --surface vase.obj",
    .words = "1 .meso .quilt .obj .ply .off .glb .gltf .drc .slots .csv .json\n"
             "--output .json\n"
             "--mark .ply\n"
             "--tiles .json\n"
             "--surface .obj .ply .off .glb\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = 1,
    .to_standard_output = true,
};

enum {
    ASSIGNMENTS = MESO_FILE_SLOTS | MESO_FILE_LISTING | MESO_FILE_CSV,
    SHAPES = MESO_FILE_MODEL | MESO_FILE_QUILT | MESO_FILE_OBJ | MESO_FILE_PLY | MESO_FILE_OFF | MESO_FILE_GLB |
             MESO_FILE_GLTF | MESO_FILE_DRC
};

static const MesoInputPlace PLACE = {
    "MODEL", "a mesh (OBJ, PLY, OFF, glTF or Draco), a model (.meso), a quilt or an assignment (.slots)", "checked",
    SHAPES | ASSIGNMENTS};

typedef struct Arguments {
    MesoTool tool;
    MesoCheckBounds bounds;
    const char *mark, *tiles, *surface;
} Arguments;

static MesoStatus check_arguments(const Arguments *a, MesoError *error)
{
    const MesoCheckBounds *b = &a->bounds;
    if (b->fast && (b->given.crossings || b->given.depth || b->given.thickness))
        return meso_fail(error, MESO_ERR_USAGE, "--fast looks for no crossings and no thin sections, "
                         "which a bound asks for");
    if (!a->tiles != !a->surface)
        return meso_fail(error, MESO_ERR_USAGE, "--tiles and --surface go together: an assignment is "
                         "checked against both");
    if (a->mark && strcmp(a->mark, "-") == 0 && (!a->tool.output || strcmp(a->tool.output, "-") == 0))
        return meso_fail(error, MESO_ERR_USAGE, "what is marked and what was found cannot both go to standard output");
    return MESO_OK;
}

/* What was found, as JSON, where -o wants it, and in the report. */
static MesoStatus write_json(MesoTool *tool, json_t *found)
{
    if (!found || json_object_set(tool->report, "check", found))
        return meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for what was found");
    if (!tool->output)
        return MESO_OK;
    json_t *root = json_pack("{sssi}", "format", "meso-check", "version", 1);
    json_t *provenance = root ? meso_provenance_json(&tool->provenance) : NULL;
    bool failed = !root || json_object_set_new(root, "provenance", provenance) || json_object_update(root, found);
    MesoStatus status = failed ? meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for what was found")
                               : meso_json_write_file(root, tool->output, &tool->error);
    json_decref(root);
    return status;
}

/* Lines go to standard output unless something else does. */
static bool wants_lines(const MesoTool *tool)
{
    bool json = tool->json && (*tool->json == 0 || strcmp(tool->json, "-") == 0);
    return !tool->quiet && !json && !(tool->output && strcmp(tool->output, "-") == 0);
}

/* ---- meshes, models, quilts ---- */

static MesoStatus write_marks(Arguments *a, const MesoCheckFindings *findings)
{
    MesoOutput *output = NULL;
    if (!a->mark)
        return MESO_OK;
    MesoStatus status = meso_output_open(&output, a->mark, &a->tool.error);
    if (!status)
        status = meso_check_mark(findings, &a->tool, output);
    return meso_output_finish(output, status, &a->tool.error);
}

static MesoStatus check_shape(Arguments *a, const MesoInput *file)
{
    MesoTool *tool = &a->tool;
    MesoCheckInput input;
    MesoInspection inspection;
    const MesoInspectionOptions options = {.thread_count = tool->threads, .crossings = !a->bounds.fast,
                                           .thickness = !a->bounds.fast,
                                           .thinnest = (double)a->bounds.thickness};
    MesoStatus status = meso_check_read(&input, tool, file);
    if (!status)
        status = meso_inspect(&inspection, &tool->arena, &input.mesh, &options, &tool->error);
    if (status)
        return status;
    const MesoCheckFindings findings = {&input, &inspection, &a->bounds};
    json_t *found = meso_check_json(&findings);
    status = write_json(tool, found);
    json_decref(found);
    if (!status)
        status = write_marks(a, &findings);
    if (!status && wants_lines(tool))
        status = meso_check_print(&findings, &tool->error);
    if (!status)
        status = meso_check_judge(&findings, &tool->error);
    return status == MESO_ERR_INPUT ? meso_fail_prefix(&tool->error, file->path) : status;
}

/* ---- assignments ---- */

/* Against the tile set and the surface: every side shows what its neighbour wants, and borders what they may. */
static MesoStatus compare_slots(Arguments *a, MesoSlotsFile *slots)
{
    MesoTool *tool = &a->tool;
    MesoInput tiles = {0}, surface = {0};
    MesoTileSet set;
    MesoQuadSurface quads;
    MesoStatus status = meso_tool_open_place(tool, &tiles, a->tiles, &MESO_PLACE_TILES);
    if (status)
        return status;
    status = meso_tiles_read(&set, &tool->arena, &tiles, &tool->error);
    meso_input_close(&tiles);
    if (!status)
        status = meso_tool_open_place(tool, &surface, a->surface, &MESO_PLACE_SURFACE);
    if (status)
        return status;
    status = meso_quad_surface_read(&quads, &tool->arena, &surface, tool->threads, &tool->error);
    meso_input_close(&surface);
    if (!status && slots->quarters && slots->assignment.slot_count == quads.graph.slot_count)
        status = meso_orientation_turn_graph(&quads.graph, &tool->arena, slots->quarters, &tool->error);
    if (status)
        return status;
    status = meso_slots_bind(slots, &set, &tool->error);
    if (!status)
        status = meso_assignment_check(&slots->assignment, &set, &quads.graph, &tool->error);
    return status == MESO_ERR_INPUT ? tool->error.status = MESO_ERR_NO : status;
}

static MesoStatus check_slots(Arguments *a, const MesoInput *file)
{
    MesoTool *tool = &a->tool;
    MesoSlotsFile slots;
    MesoStatus status = meso_slots_read(&slots, &tool->arena, file, &tool->error);
    if (!status && a->mark)
        status = meso_fail(&tool->error, MESO_ERR_USAGE, "--mark is for meshes and models; '%s' is an assignment",
                           file->path);
    if (status)
        return status;
    MesoStatus fits = a->tiles ? compare_slots(a, &slots) : MESO_OK;
    if (fits != MESO_OK && fits != MESO_ERR_NO)
        return fits;
    json_t *found = json_pack("{sIso}", "slots", (json_int_t)slots.assignment.slot_count, "fits",
                              a->tiles ? json_boolean(fits == MESO_OK) : json_null());
    status = write_json(tool, found);
    json_decref(found);
    if (!status && wants_lines(tool)) {
        printf("%-14s %u\n", "slots", slots.assignment.slot_count);
        printf("%-14s %s\n", "fits", !a->tiles ? "not looked for" : fits ? "no" : "yes");
        if (fflush(stdout) != 0 || ferror(stdout))
            return meso_fail(&tool->error, MESO_ERR_OUTPUT, "cannot write to standard output");
    }
    return status ? status : fits;
}

static MesoStatus run(Arguments *a)
{
    MesoInput input;
    MesoStatus status = check_arguments(a, &a->tool.error);
    if (!status)
        status = meso_tool_open_place(&a->tool, &input, a->tool.operands[0], &PLACE);
    if (status)
        return status;
    bool assignment = meso_file_kind(&input) & ASSIGNMENTS;
    if (a->tiles && !assignment)
        status = meso_fail(&a->tool.error, MESO_ERR_USAGE, "--tiles and --surface are for assignments; '%s' is none",
                           input.path);
    else
        status = assignment ? check_slots(a, &input) : check_shape(a, &input);
    meso_input_close(&input);
    return status;
}

int main(int argc, char **argv)
{
    Arguments a = {.mark = NULL};
    MesoCheckBounds *b = &a.bounds;
    const MesoOption options[] = {
        MESO_GROUP("Bounds"),
        MESO_NUMBER(0, "max-gap", "X", "between rings of two slots that should meet, in scene units", &b->gap, 0, 1e30,
                    .given = &b->given.gap, .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "max-angle", "DEGREES", "between the normals on both sides of a slot's edge", &b->angle, 0, 180,
                    .given = &b->given.angle, .more = MESO_OPTION_OVERRIDES),
        MESO_COUNT(0, "max-open", "N", "open rings", &b->open, 0, 4294967295, .given = &b->given.open,
                   .more = MESO_OPTION_OVERRIDES),
        MESO_COUNT(0, "max-crossings", "N", "pairs of strands or elements, or of triangles of one, that cross",
                   &b->crossings, 0, 4294967295, .given = &b->given.crossings, .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "max-depth", "X", "of what crosses", &b->depth, 0, 1e30, .given = &b->given.depth,
                    .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "min-thickness", "X", "of the thinnest section", &b->thickness, 0, 1e30,
                    .given = &b->given.thickness, .more = MESO_OPTION_OVERRIDES),
        MESO_COUNT(0, "max-floating", "N", "pieces apart from the others", &b->floating, 0, 4294967295,
                   .given = &b->given.floating, .more = MESO_OPTION_OVERRIDES),
        MESO_COUNT(0, "max-faults", "N", "of everything that is wrong wherever it is: what is no number or no "
                   "area, doubled, wound or folded the wrong way, in T-joints, or touches itself (default 0)",
                   &b->faults, 0, 4294967295),
        MESO_GROUP("Checking"),
        MESO_FLAG(0, "fast", "look for no crossings and no thin sections", &b->fast),
        MESO_OUTPUT_FILE(0, "mark", "OUT.ply", "write the triangles with their faults as colours and a channel",
                         &a.mark),
        MESO_INPUT_FILE(0, "tiles", "TILES", "the tile set of an assignment, with --surface", &a.tiles),
        MESO_INPUT_FILE(0, "surface", "SURFACE", "the surface of an assignment, with --tiles", &a.surface),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (meso_tool_start(&a.tool, &CHECK_TOOL, options, argc, argv))
        a.tool.status = run(&a);
    return meso_tool_finish(&a.tool);
}
