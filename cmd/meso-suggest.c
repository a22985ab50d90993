/* meso-suggest: adds the tile that would have helped at the most dead ends. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/mesh_path.h"
#include "cmd/solve/solve_inputs.h"
#include "cmd/solve/solve_surface.h"
#include "formats/json/json_text.h"
#include "formats/tiling/result/report_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/tiling/solve/suggest.h"

typedef struct Arguments {
    MesoTool tool;
    uint32_t attempts, until_solved;
    bool until_given, strict, pairs;
    const char *surface;
    MesoOrientArguments orient;
} Arguments;

static const MesoToolInfo info = {
    .name = "meso-suggest",
    .synopsis = "meso-suggest [options] TILES REPORT -o OUT.tiles.json\n"
                "meso-suggest [options] TILES --surface SURFACE -o OUT.tiles.json",
    .purpose = "Adds to TILES the tile that the dead ends of a solve ask for most.",
    .examples = "meso-suggest gap.tiles.json gap.json -o mended.tiles.json\n"
                "meso-suggest --surface vase.obj gap.tiles.json -o mended.tiles.json",
    .words = "1 .json\n"
             "2 .json\n"
             "--output .tiles.json\n"
             "--json .json\n"
             "--surface .obj .ply .off\n"
             "--orient file comb u,v field=",
    .operands_low = 1,
    .operands_high = 2,
};

static MesoStatus check_arguments(Arguments *a)
{
    MesoError *error = &a->tool.error;
    if (a->tool.operand_count == 2 && a->surface)
        return meso_fail(error, MESO_ERR_USAGE, "a report and --surface are both given; one is needed");
    if (a->tool.operand_count == 1 && !a->surface)
        return meso_fail(error, MESO_ERR_USAGE, "neither a report nor --surface is given");
    if (a->until_given && !a->surface)
        return meso_fail(error, MESO_ERR_USAGE, "--until-solved needs --surface");
    if (a->strict && !a->surface)
        return meso_fail(error, MESO_ERR_USAGE, "--strict is about a surface; it needs --surface");
    if (a->orient.given && !a->surface)
        return meso_fail(error, MESO_ERR_USAGE, "--orient needs --surface; a report is of slots as they were oriented");
    if (!a->tool.output && a->tool.json && (*a->tool.json == 0 || strcmp(a->tool.json, "-") == 0))
        return meso_fail(error, MESO_ERR_USAGE, "the tile set and the JSON report cannot both go to "
                         "standard output; use -o FILE or --json=FILE");
    return meso_orient_check(&a->orient, error);
}

/* "a b' a c" */
static const char *print_sides(const MesoTileSet *set, const int32_t labels[4], MesoArena *arena,
                               MesoError *error)
{
    const char *name[4], *mark[4];
    for (uint32_t k = 0; k < 4; k++) {
        name[k] = set->interfaces[meso_label_interface(labels[k])].name;
        mark[k] = meso_label_mark(labels[k]);
    }
    return meso_arena_print(arena, error, "%s%s %s%s %s%s %s%s", name[0], mark[0], name[1], mark[1],
                            name[2], mark[2], name[3], mark[3]);
}

/* One line, and one item of "suggestions" in the JSON report. */
static MesoStatus tell_suggestion(MesoTool *tool, const MesoTileSet *set, const MesoSuggestion *suggestion)
{
    const char *name = set->tiles[set->tile_count - 1].name;
    const char *sides = print_sides(set, suggestion->labels, &tool->arena, &tool->error);
    if (!sides)
        return MESO_ERR_MEMORY;
    meso_tool_say(tool, "%s: %s, with %llu votes; %llu candidates", name, sides,
                  (unsigned long long)suggestion->votes,
                  (unsigned long long)suggestion->candidate_count);

    json_t *list = json_object_get(tool->report, "suggestions");
    if (!list && json_object_set_new(tool->report, "suggestions", list = json_array()))
        return meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory");
    json_t *labels = json_array();
    int failed = 0;
    for (uint32_t k = 0; k < 4; k++) {
        int32_t label = suggestion->labels[k];
        failed |= json_array_append_new(labels, json_sprintf(
            "%s%s", set->interfaces[meso_label_interface(label)].name, meso_label_mark(label)));
    }
    failed |= json_array_append_new(list, json_pack(
        "{sssosIsIsI}", "name", name, "sides", labels, "votes", (json_int_t)suggestion->votes,
        "identity_votes", (json_int_t)suggestion->identity_votes,
        "candidates", (json_int_t)suggestion->candidate_count));
    return failed ? meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory") : MESO_OK;
}

static MesoStatus extend(MesoTool *tool, MesoTileSet *set, uint32_t dead_end_count,
                         const MesoDeadEnd *dead_ends)
{
    MesoSuggestion suggestion;
    MesoStatus status = meso_suggest(&suggestion, &tool->arena, set, dead_end_count, dead_ends,
                                     &tool->error);
    if (!status)
        status = meso_suggestion_append(set, &tool->arena, set, &suggestion, &tool->error);
    return status ? status : tell_suggestion(tool, set, &suggestion);
}

/*
 * Dead ends are of the tiles that there were: after any change of the tile set, which may
 * have mended them or made others, the tile that they ask for is not the one that is missing.
 */
static MesoStatus check_report(MesoTool *tool, const MesoReport *report, const char *path)
{
    char hash[33];
    const uint64_t *of = tool->provenance.inputs[0].hash;
    snprintf(hash, sizeof hash, "%016" PRIx64 "%016" PRIx64, of[0], of[1]);
    if (!*report->tiles_hash)
        meso_tool_say(tool, "warning: '%s' does not say which tile set it was made with", path);
    if (!*report->tiles_hash || strcmp(report->tiles_hash, hash) == 0)
        return MESO_OK;
    return meso_fail(&tool->error, MESO_ERR_INPUT, "'%s' was made with another tile set than '%s', or with another "
                     "version of it: solve again with this one and --report, or give --surface", path,
                     tool->operands[0]);
}

/* An interface that the report names and the set lacks is a sign of the same. */
static MesoStatus extend_by_report(MesoTool *tool, MesoTileSet *set, const char *path)
{
    MesoInput input;
    MesoReport report;
    MesoStatus status = meso_tool_open_place(tool, &input, path, &MESO_PLACE_REPORT);
    if (status)
        return status;
    status = meso_report_read(&report, &tool->arena, &input, set, &tool->error);
    meso_input_close(&input);
    if (!status || (status == MESO_ERR_INPUT && *report.tiles_hash)) {
        MesoStatus fits = check_report(tool, &report, path);
        status = fits ? fits : status;
    }
    if (status)
        return status;
    if (report.verdict == MESO_VERDICT_SOLVED)
        return meso_fail(&tool->error, MESO_ERR_NO, "nothing to suggest: the report's verdict is solved");
    return extend(tool, set, report.dead_end_count, report.dead_ends);
}

/* Solves and suggests in turn: once, or until the surface is solved. */
static MesoStatus extend_by_surface(Arguments *a, MesoTileSet *set)
{
    MesoTool *tool = &a->tool;
    MesoSolveSurface surface;
    MesoVariantSet variants;
    MesoSolveResult result;
    const MesoSurfaceWish wish = {.path = a->surface, .orient = a->orient, .set = set,
                                  .strict = a->strict, .pairs = a->pairs};
    MesoStatus status = meso_tool_read_surface(tool, &wish, &surface);
    for (uint32_t added = 0; !status; added++) {
        if (added == 1 && !a->until_given)
            return MESO_OK;
        status = meso_variant_set_build(&variants, &tool->arena, set, &tool->error);
        if (!status)
            status = meso_tool_solve(tool, &(MesoTilingProblem){set, &variants, &surface.graph, NULL},
                                     NULL, a->attempts,
                                     &result);
        if (status)
            return status;
        if (result.verdict == MESO_VERDICT_SOLVED && added == 0)
            return meso_fail(&tool->error, MESO_ERR_NO, "nothing to suggest: the tile set solves the "
                             "surface");
        if (result.verdict == MESO_VERDICT_SOLVED) {
            meso_tool_say(tool, "solved %u slots with %u new tile%s", surface.graph.slot_count, added,
                          added == 1 ? "" : "s");
            return MESO_OK;
        }
        if (a->until_given && added == a->until_solved)
            return meso_fail(&tool->error, MESO_ERR_LIMIT, "not solved with %u new tile%s", added,
                             added == 1 ? "" : "s");
        status = extend(tool, set, result.dead_end_count, result.dead_ends);
    }
    return status;
}

static MesoStatus write_set(MesoTool *tool, const MesoTileSet *set)
{
    json_t *root = meso_tiles_to_json(set);
    if (root && json_object_set_new(root, "provenance", meso_provenance_json(&tool->provenance))) {
        json_decref(root);
        root = NULL;
    }
    MesoStatus status = meso_json_write_file(root, tool->output, &tool->error);
    json_decref(root);
    return status;
}

static MesoStatus run(Arguments *a)
{
    MesoTool *tool = &a->tool;
    MesoTileSet set;
    MesoStatus status = check_arguments(a);
    if (!status)
        status = meso_tool_read_tiles(tool, tool->operands[0], &set, NULL);
    if (!status)
        status = a->surface ? extend_by_surface(a, &set) : extend_by_report(tool, &set, tool->operands[1]);
    if (!status && tool->output)
        status = meso_mesh_paths_move(&set, tool->operands[0], tool->output, &tool->arena, &tool->error);
    return status ? status : write_set(tool, &set);
}

int main(int argc, char **argv)
{
    Arguments a = {.attempts = 20, .orient = MESO_ORIENT_DEFAULTS};
    const MesoOption options[] = {
        MESO_GROUP("Suggesting"),
        MESO_INPUT_FILE(0, "surface", "FILE", "solve this surface for dead ends, without a report",
                        &a.surface),
        MESO_ORIENT_OPTION(a.orient),
        MESO_STRICT_OPTION(a.strict),
        MESO_PAIRS_OPTION(a.pairs),
        MESO_COUNT(0, "attempts", "N", "restarts of each solve (default 20)", &a.attempts, 1, 1e9),
        MESO_COUNT(0, "until-solved", "N", "add up to N tiles, until the surface is solved",
                   &a.until_solved, 1, 1000, .given = &a.until_given),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (meso_tool_start(&a.tool, &info, options, argc, argv))
        a.tool.status = run(&a);
    return meso_tool_finish(&a.tool);
}
