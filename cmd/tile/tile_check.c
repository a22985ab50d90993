/* meso-tile check: every problem of a tile set. */
#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/tile/tile_command.h"
#include "formats/json/json_text.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/tiling/tile/contour.h"
#include "libcore/tiling/tile/tile_set_check.h"

/* Sampling step of the drawings, in edge lengths: coarse is enough to see whether any area is left. */
static const float AREA_STEP = 0.01f;

static const MesoToolInfo info = {
    .name = "meso-tile check",
    .synopsis = "meso-tile check [--strict] FILE",
    .purpose = "Prints every problem of a tile set, one a line. Exit status 1 if there is an error.",
    .examples = "meso-tile check vase.tiles.json\nmeso-tile check --strict --json=check.json vase.tiles.json",
    .words = "1 .json\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = 1,
};

typedef struct Findings {
    MesoTool *tool;
    bool strict;
    MesoTileText text;
    uint32_t errors, warnings;
    json_t *list;       /* the report's */
    bool failed;        /* memory for it was out */
} Findings;

/* Names may hold anything while they are not checked; a finding stays on its line. */
static void print_plain(FILE *stream, const char *text)
{
    for (; *text; text++)
        fputc((unsigned char)*text < 0x20 || *text == 0x7f ? '?' : *text, stream);
}

static void add_finding(void *context, const char *severity, const char *where, const char *message)
{
    Findings *findings = context;
    bool is_error = strcmp(severity, "error") == 0;
    findings->errors += is_error;
    findings->warnings += !is_error;
    json_t *item = json_object();
    int failed = json_object_set_new(item, "severity", json_string(severity));
    failed |= json_object_set_new(item, "where", meso_json_string(where));
    failed |= json_object_set_new(item, "message", meso_json_string(message));
    failed |= json_array_append_new(findings->list, item);
    findings->failed |= failed != 0;
    bool wanted = is_error || findings->strict || !findings->tool->quiet;
    if (!wanted || meso_tile_streams_clash(findings->tool))
        return;     /* the report on standard output holds it, or nobody asks */
    FILE *stream = findings->text.stream;
    print_plain(stream, findings->tool->operands[0]);
    fprintf(stream, ": %s: ", severity);
    print_plain(stream, where);
    fputs(": ", stream);
    print_plain(stream, message);
    fputc('\n', stream);
}

/* Differences may take all of a drawing away, which only its outline tells. */
static MesoStatus find_empty_drawings(const MesoTileSet *set, Findings *findings)
{
    MesoTool *tool = findings->tool;
    MesoContourSet contours;
    MesoStatus status = meso_contour_set_build(&contours, &tool->arena, set, AREA_STEP, &tool->error);
    for (uint32_t s = 0; !status && s < set->section_count; s++) {
        const MesoSection *section = &set->sections[s];
        if (contours.section_begin[s + 1] > contours.section_begin[s])
            continue;
        const char *where = meso_arena_print(&tool->arena, &tool->error, "interfaces[%u] '%s', section '%s'",
                                             section->interface, set->interfaces[section->interface].name,
                                             section->name);
        if (!where)
            return MESO_ERR_MEMORY;
        add_finding(findings, "warning", where, "the drawing has no area; nothing will be seen of it");
    }
    return status;
}

static MesoStatus look(Findings *findings)
{
    MesoTool *tool = findings->tool;
    MesoError *error = &tool->error;
    MesoTileSet set;
    MesoInput input;
    MesoStatus status = meso_tool_open_place(tool, &input, tool->operands[0], &MESO_PLACE_TILE_FILE);
    if (status)
        return status;
    status = meso_tiles_survey(&set, &tool->arena, &input, add_finding, findings, error);
    meso_input_close(&input);
    if (status)  /* of a file that can be read at all, the findings are the answer */
        return status == MESO_ERR_INPUT && findings->errors ? MESO_OK : status;
    status = meso_tile_report_counts(tool, &set, NULL);
    uint32_t error_count = 0;
    if (!status)
        status = meso_tile_set_check(&error_count, &set, add_finding, findings, error);
    if (status || error_count > 0)
        return status;
    status = find_empty_drawings(&set, findings);
    if (!status)
        status = meso_tile_find_meshes(&set, input.path, &tool->arena, add_finding, findings, error);
    return status;
}

static MesoStatus run(Findings *findings)
{
    MesoTool *tool = findings->tool;
    MesoStatus status = meso_tile_text_init(&findings->text, &tool->error);
    findings->list = json_array();
    findings->failed = json_object_set_new(tool->report, "findings", findings->list) != 0;
    if (!status)
        status = look(findings);
    if (!status && findings->failed)
        status = meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report");
    status = meso_tile_text_finish(&findings->text, tool->output, status, &tool->error);
    if (status)
        return status;
    if (findings->errors + (findings->strict ? findings->warnings : 0) == 0)
        return MESO_OK;
    return meso_fail(&tool->error, MESO_ERR_NO, "%s: %u error%s, %u warning%s", tool->operands[0],
                     findings->errors, findings->errors == 1 ? "" : "s", findings->warnings,
                     findings->warnings == 1 ? "" : "s");
}

int meso_tile_check(int argc, char **argv)
{
    MesoTool tool = {0};
    Findings findings = {.tool = &tool};
    MesoOption options[] = {
        MESO_GROUP("Check"),
        MESO_FLAG(0, "strict", "warnings count as errors", &findings.strict),
        MESO_TOOL_OPTIONS(tool),
        {0},
    };
    if (meso_tile_start(&tool, &info, options, argc, argv))
        tool.status = run(&findings);
    return meso_tool_finish(&tool);
}
