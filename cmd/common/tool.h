/*
 * What every tool does the same: common options, start, progress, JSON report,
 * signals, finish with the one line of error and the exit code.
 *
 *     int main(int argc, char **argv)
 *     {
 *         MyArguments a = {...};
 *         MesoOption options[] = {..., MESO_TOOL_OPTIONS(a.tool), {0}};
 *         MesoTool *tool = &a.tool;
 *         if (!meso_tool_start(tool, &MY_TOOL, options, argc, argv))
 *             return meso_tool_finish(tool);
 *         tool->status = run(&a, &tool->error);
 *         return meso_tool_finish(tool);
 *     }
 */
#ifndef MESO_TOOL_H
#define MESO_TOOL_H

#include <jansson.h>

#include "cmd/common/options.h"
#include "cmd/common/paths.h"
#include "formats/product/provenance.h"
#include "libcore/base/arena.h"

typedef struct MesoToolInfo {
    const char *name;       /* "meso-map" */
    const char *synopsis;   /* lines, without "usage:" */
    const char *purpose;    /* one line */
    const char *examples;   /* lines */
    const char *words;      /* of operands and options, for meso_options_list() */
    uint32_t operands_low, operands_high;   /* each names a file that is read */
    bool to_standard_output;    /* the product goes there without -o, and so no report may */
} MesoToolInfo;

typedef struct MesoTool {
    const MesoToolInfo *info;
    MesoArena arena;
    MesoError error;
    MesoStatus status;

    /* common options */
    const char *output;         /* -o; NULL where not given */
    const char *json;           /* --json[=FILE]; NULL: none, "" or "-": standard output */
    const char *progress_mode;  /* auto, none, json */
    const char *detail;         /* --provenance: names, full, none */
    uint64_t seed;
    uint32_t threads;           /* 0: all cores */
    bool quiet, verbose, help, version;
    bool list_options;          /* --list-options: for programs, and hidden */

    const char **operands;
    uint32_t operand_count;
    MesoPaths paths;            /* of operands, options, and whatever else is opened */

    const MesoOption *options;  /* the table, and what it parsed */
    int argc;
    char **argv;
    const char **defaults;      /* values before parsing, of meso_options_values() */

    MesoProvenance provenance;  /* tool, command line and seed are filled in by the start */
    json_t *report;             /* object; what the tool did. Written by the finish if asked for */
    struct MesoProgress *progress;
    double started;             /* seconds, of the monotonic clock */
} MesoTool;

/* The options that all tools share, for the end of a table. */
#define MESO_TOOL_OPTIONS(tool)                                                               \
    MESO_GROUP("Common options"), \
    MESO_OUTPUT_FILE('o', "output", "FILE", "write the product there; - is standard output", &(tool).output), \
    MESO_OUTPUT_FILE_OPT(0, "json", "FILE", "report what was done as JSON (default: standard output)", \
                         &(tool).json, .more = MESO_OPTION_SILENT), \
    MESO_CHOICE(0, "provenance", "HOW", \
                "in products: names (no folders, default), full (the command as typed) or none", \
                &(tool).detail, "names|full|none", .more = MESO_OPTION_SILENT), \
    MESO_SEED(0, "seed", "N", "seed of every random choice (default 0)", &(tool).seed), \
    MESO_COUNT(0, "threads", "N", "threads; 0 for all cores (default); no effect on the bytes", \
               &(tool).threads, 0, 1024, .more = MESO_OPTION_SILENT), \
    MESO_CHOICE(0, "progress", "HOW", "auto, none or json lines on standard error", &(tool).progress_mode, \
                "auto|none|json", .more = MESO_OPTION_SILENT), \
    MESO_FLAG('q', "quiet", "say nothing but errors", &(tool).quiet, .more = MESO_OPTION_SILENT), \
    MESO_FLAG('v', "verbose", "say more, timings too", &(tool).verbose, .more = MESO_OPTION_SILENT), \
    MESO_FLAG('h', "help", "this text", &(tool).help), \
    MESO_FLAG(0, "version", "name and version", &(tool).version), \
    MESO_FLAG(0, "list-options", 0, &(tool).list_options)

/*
 * Parses, refuses outputs that are inputs or written twice, installs the signal handlers (SIGTERM, SIGINT, SIGHUP,
 * SIGQUIT, SIGXCPU and crashes: remove temporary files, then die of the signal; an input that is cut while
 * it is read: exit code 4), ignores SIGPIPE, and ends the tool with code 33 where a library finds
 * no memory. `tool` must be zeroed, except for option values that are not the default here. Returns
 * false where there is nothing left to run: --help, --version, --list-options, or wrong usage.
 */
bool meso_tool_start(MesoTool *tool, const MesoToolInfo *info, const MesoOption *options,
                     int argc, char **argv);

/*
 * Prints the error as "meso-map: message", and what concerns the job as a whole (no, limit, internal,
 * memory) as "meso-map: FILE: message", where FILE is what meso_tool_say() names; writes the report, frees all;
 * returns the exit code. The report is an object: "format" "meso-report",
 * "version", "tool", "status" (ok, no, usage, limit, input, output, internal,
 * memory), "exit", "message" where the status is not ok, "provenance", then
 * what the tool put into `report`, and with -v the "seconds" that it took.
 */
int meso_tool_finish(MesoTool *tool);

/*
 * Opens a file that is read, and notes it in the provenance as `role`, with its own; behind it, as "buffer", the
 * files that glTF has beside it. The caller closes it where this gives MESO_OK. Errors of meso_input_open(), and
 * MESO_ERR_USAGE where an output would go over it. `path` must outlive the tool.
 */
MesoStatus meso_tool_open_input(MesoTool *tool, MesoInput *input, const char *path, const char *role);

/* Notes a file that is written beside those of the table's options, which are known. MESO_ERR_USAGE
 * where it is an input, or written twice. */
MesoStatus meso_tool_add_output(MesoTool *tool, const char *option, const char *path);

/* The same check of a file that need not be remembered. */
MesoStatus meso_tool_check_output(MesoTool *tool, const char *option, const char *path);

/* The command as --provenance has it recorded, but for `changes` (NULL: none). NULL when memory is out. */
char *meso_tool_command(const MesoTool *tool, const MesoOptionChange *changes, MesoArena *arena, MesoError *error);

/*
 * One line to standard error, unless -q: "meso-map: FILE: text", so that the lines of many jobs can be
 * told apart. FILE is the product's name, or that of the last operand where the product goes to standard
 * output; meso_tool_say_of() names another one.
 */
void meso_tool_say(const MesoTool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
void meso_tool_say_of(const MesoTool *tool, const char *file, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The line of an error, -q or not, after which the work goes on. */
void meso_tool_complain(const MesoTool *tool, const MesoError *error);

/*
 * Progress of long work: a line on a terminal after a second, with rate and
 * time left, or JSON lines. `meso_tool_progress` fits the progress callbacks of
 * the libraries, with the tool as context. Cheap enough to call often.
 */
void meso_tool_progress_begin(MesoTool *tool, const char *what, const char *unit);
void meso_tool_progress(void *tool, uint64_t done, uint64_t total);

#endif
