#include "cmd/common/tool.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cmd/common/command_line.h"
#include "cmd/common/progress.h"
#include "formats/file/memory_watch.h"
#include "formats/file/temporary.h"
#include "formats/json/json_text.h"
#include "formats/mesh/mesh_kinds.h"
#include "formats/product/file_kind.h"
#include "libcore/base/clock.h"

static const char *tool_name;      /* for those who die on the spot */
static struct sigaction other_bus_error;

static void die_of_signal(int number)
{
    meso_temporary_remove_all();
    signal(number, SIG_DFL);
    raise(number);
}

/* Appends what fits of `text`, on one line. */
static size_t add_text(char *line, size_t size, size_t used, const char *text)
{
    for (; *text && used < size; text++)
        line[used++] = (unsigned char)*text < 0x20 || *text == 0x7f ? '?' : *text;
    return used;
}

/* Ends the process with the line of error "tool: begin name end" and nothing but what a signal handler may do. */
static void die(MesoStatus status, const char *begin, const char *name, const char *end)
{
    char line[PATH_MAX + 128];
    const char *const parts[] = {tool_name, ": ", begin, name, end};
    size_t used = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        used = add_text(line, sizeof line - 1, used, parts[i]);
    line[used++] = '\n';
    meso_temporary_remove_all();
    (void)!write(STDERR_FILENO, line, used);
    _exit((int)status);
}

static void die_of_memory(void)
{
    die(MESO_ERR_MEMORY, "out of memory in a library", "", "");
}

/* An input that is cut while it is mapped is a bad input; its pages are gone in whatever code reads
 * them. Any other bus error is left to whoever had it before: a sanitizer, or death. */
static void die_of_bus_error(int number, siginfo_t *about, void *context)
{
    (void)context;
    const char *path = meso_input_mapped_at(about->si_addr);
    if (path)
        die(MESO_ERR_INPUT, "'", path, "' became shorter while it was read");
    meso_temporary_remove_all();
    sigaction(number, &other_bus_error, NULL);
    raise(number);
}

/* What the caller chose to ignore (nohup) stays ignored. Crashes of libraries leave no temporary
 * file either. Writes to a closed pipe and past the size limit become errors that are reported. */
static void install_handlers(void)
{
    static const int deadly[] = {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGXCPU, SIGSEGV, SIGABRT};
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) {
        struct sigaction old, action = {.sa_handler = die_of_signal};
        sigfillset(&action.sa_mask);
        if (sigaction(deadly[i], NULL, &old) == 0 && old.sa_handler == SIG_DFL)
            sigaction(deadly[i], &action, NULL);
    }
    struct sigaction bus_error = {.sa_sigaction = die_of_bus_error, .sa_flags = SA_SIGINFO};
    sigfillset(&bus_error.sa_mask);
    if (sigaction(SIGBUS, NULL, &other_bus_error) == 0 && other_bus_error.sa_handler != SIG_IGN)
        sigaction(SIGBUS, &bus_error, NULL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

/* A closed standard descriptor must not become one of our files by accident:
 * it is held by one that fails in the direction it is used in. */
static void hold_standard_descriptors(void)
{
    for (int file = 0; file < 3; file++)
        if (fcntl(file, F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", file == 0 ? O_WRONLY : O_RDONLY);
}

/* "1 operand given, 3 needed" */
static MesoStatus check_operands(const MesoToolInfo *info, uint32_t count, MesoError *error)
{
    uint32_t low = info->operands_low, high = info->operands_high;
    if (count >= low && count <= high)
        return MESO_OK;
    const char *plural = count == 1 ? "" : "s";
    if (low == high)
        return meso_fail(error, MESO_ERR_USAGE, "%u operand%s given, %u needed", count, plural, low);
    return meso_fail(error, MESO_ERR_USAGE, "%u operand%s given, at %s %u needed", count, plural,
                     count < low ? "least" : "most", count < low ? low : high);
}

/* Two products in one stream would be neither. */
static MesoStatus check_streams(MesoTool *tool, MesoError *error)
{
    bool report = tool->json && (*tool->json == 0 || strcmp(tool->json, "-") == 0);
    bool product = tool->output ? strcmp(tool->output, "-") == 0 : tool->info->to_standard_output;
    if (report && product)
        return meso_fail(error, MESO_ERR_USAGE,
                         "the product and the report cannot both go to standard output; use "
                         "--json=FILE");
    return MESO_OK;
}

/* A report must not be written where that is what is refused. */
static MesoStatus keep_report_off(MesoTool *tool, MesoStatus status)
{
    const char *json = !tool->json || *tool->json ? tool->json : "-";
    for (int i = 0; i < 2; i++)
        if (status == MESO_ERR_USAGE && json && strcmp(tool->paths.clash[i], json) == 0)
            tool->json = NULL;
    return status;
}

MesoStatus meso_tool_add_output(MesoTool *tool, const char *option, const char *path)
{
    return keep_report_off(tool, meso_paths_add_output(&tool->paths, option, path, &tool->arena, &tool->error));
}

MesoStatus meso_tool_check_output(MesoTool *tool, const char *option, const char *path)
{
    return keep_report_off(tool, meso_paths_check_output(&tool->paths, option, path, &tool->error));
}

static MesoStatus add_input(MesoTool *tool, const char *path)
{
    return keep_report_off(tool, meso_paths_add_input(&tool->paths, path, &tool->arena, &tool->error));
}

static MesoStatus note_input(MesoTool *tool, MesoInput *input, const char *path, const char *role)
{
    MesoStatus status = add_input(tool, path);
    if (!status)
        status = meso_input_open(input, path, &tool->error);
    if (status)
        return status;
    status = meso_provenance_add(&tool->provenance, role, input, &tool->arena, &tool->error);
    if (status)
        meso_input_close(input);
    return status;
}

/* Whether one is missing is left to who reads the file. */
static MesoStatus note_buffers(MesoTool *tool, const MesoInput *input)
{
    const char *const *paths;
    uint32_t count = 0;
    if (!(meso_file_kind(input) & (MESO_FILE_GLTF | MESO_FILE_GLB)))
        return MESO_OK;
    MesoStatus status = meso_gltf_buffers(&paths, &count, &tool->arena, input, &tool->error);
    for (uint32_t i = 0; i < count && !status; i++) {
        MesoInput buffer;
        if (tool->provenance.input_count == MESO_PROVENANCE_INPUTS)
            return meso_fail(&tool->error, MESO_ERR_LIMIT, "%s: more than %d files are read", input->path,
                             MESO_PROVENANCE_INPUTS);
        status = note_input(tool, &buffer, paths[i], "buffer");
        if (!status)
            meso_input_close(&buffer);
        status = status == MESO_ERR_INPUT ? MESO_OK : status;
    }
    return status;
}

MesoStatus meso_tool_open_input(MesoTool *tool, MesoInput *input, const char *path, const char *role)
{
    MesoStatus status = note_input(tool, input, path, role);
    if (!status && note_buffers(tool, input)) {
        status = tool->error.status;
        meso_input_close(input);
    }
    return status;
}

static MesoStatus add_option_path(MesoTool *tool, const MesoOption *option)
{
    MesoOptionKind kind = option->kind;
    bool output = kind == MESO_OPTION_OUTPUT || kind == MESO_OPTION_OUTPUT_OPT;
    const char *path = output || kind == MESO_OPTION_INPUT ? *(const char *const *)option->value : NULL;
    if (!path)
        return MESO_OK;
    if (!output)
        return add_input(tool, path);
    const char *name = option->letter ? meso_arena_print(&tool->arena, &tool->error, "-%c", option->letter)
                                      : meso_arena_print(&tool->arena, &tool->error, "--%s", option->name);
    bool stream = kind == MESO_OPTION_OUTPUT_OPT && *path == 0;
    return name ? meso_tool_add_output(tool, name, stream ? "-" : path) : MESO_ERR_MEMORY;
}

/* All of them, whatever is wrong with one: the report may have to be kept off. */
static MesoStatus add_paths(MesoTool *tool, MesoError *error)
{
    MesoStatus status = MESO_OK;
    MesoError first;
    for (uint32_t i = 0; i < tool->operand_count; i++)
        if (add_input(tool, tool->operands[i]) == MESO_ERR_MEMORY)
            return MESO_ERR_MEMORY;
    for (const MesoOption *option = tool->options; !meso_option_is_last(option); option++) {
        MesoStatus added = add_option_path(tool, option);
        if (added && !status) {
            status = added;
            first = *error;
        }
    }
    if (status)
        *error = first;
    return status;
}

/* What is asked, but for the paths. */
static MesoStatus parse_words(MesoTool *tool)
{
    MesoError *error = &tool->error;
    MesoStatus status = meso_options_parse(tool->options, tool->argc, tool->argv, tool->operands,
                                           &tool->operand_count, error);
    if (tool->help || tool->version || tool->list_options)
        return MESO_OK;
    if (!status)
        status = check_operands(tool->info, tool->operand_count, error);
    return status ? status : check_streams(tool, error);
}

char *meso_tool_command(const MesoTool *tool, const MesoOptionChange *changes, MesoArena *arena, MesoError *error)
{
    const char *name = tool->info->name;
    return tool->provenance.detail == MESO_PROVENANCE_FULL
               ? meso_options_command_typed(tool->options, name, tool->argc, tool->argv, changes, arena, error)
               : meso_options_command_names(tool->options, name, tool->defaults, tool->operands, tool->operand_count,
                                            changes, arena, error);
}

static MesoStatus record(MesoTool *tool)
{
    const char *detail = tool->detail ? tool->detail : "names";
    tool->provenance.detail = strcmp(detail, "full") == 0   ? MESO_PROVENANCE_FULL
                              : strcmp(detail, "none") == 0 ? MESO_PROVENANCE_NONE
                                                            : MESO_PROVENANCE_NAMES;
    tool->provenance.seed = tool->seed;
    tool->provenance.command_line = meso_tool_command(tool, NULL, &tool->arena, &tool->error);
    return tool->provenance.command_line ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus parse(MesoTool *tool)
{
    MesoError *error = &tool->error;
    tool->operands = MESO_NEW(&tool->arena, const char *, (size_t)tool->argc + 1, error);
    tool->defaults = tool->operands ? meso_options_values(tool->options, &tool->arena, error) : NULL;
    if (!tool->defaults)
        return MESO_ERR_MEMORY;
    MesoStatus status = parse_words(tool);
    if (tool->help || tool->version)
        return MESO_OK;
    MesoError first = *error;
    MesoStatus paths = add_paths(tool, error);
    if (status) {
        *error = first;
        return status;
    }
    return paths == MESO_OK ? record(tool) : paths;
}

/* `text` indented by two, line by line. */
static void print_block(const char *heading, const char *text)
{
    if (!text || !*text)
        return;
    printf("%s", heading);
    while (*text) {
        int length = (int)strcspn(text, "\n");
        printf("  %.*s\n", length, text);
        text += length;
        text += *text == '\n';
    }
}

static void print_help(const MesoTool *tool, const MesoOption *options)
{
    const MesoToolInfo *info = tool->info;
    print_block("Usage:\n", info->synopsis);
    printf("\n%s\n", info->purpose);
    meso_options_print(options);
    print_block("\nExamples:\n", info->examples);
    printf("\nExit status: 0 done, 1 the answer is no, 2 usage, 3 gave up at a limit,\n"
           "4 bad input, 5 cannot write, 6 internal error, 33 out of memory.\n");
}

static MesoStatus flush_standard_output(MesoError *error)
{
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_OUTPUT, "cannot write standard output: %s",
                     errno ? strerror(errno) : "write error");
}

bool meso_tool_start(MesoTool *tool, const MesoToolInfo *info, const MesoOption *options,
                     int argc, char **argv)
{
    static char *no_arguments[2];
    hold_standard_descriptors();
    tool_name = info->name;
    meso_memory_watch(die_of_memory);
    install_handlers();
    if (argc < 1) {
        no_arguments[0] = (char *)(uintptr_t)info->name;
        argc = 1;
        argv = no_arguments;
    }

    tool->info = info;
    meso_arena_init(&tool->arena);
    tool->error = (MesoError){0};
    tool->provenance = (MesoProvenance){.tool = info->name, .command_line = info->name};
    tool->report = json_object();
    tool->progress = MESO_NEW(&tool->arena, MesoProgress, 1, &tool->error);
    if (!tool->report || !tool->progress) {
        tool->status = meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory");
        return false;
    }
    tool->started = meso_seconds();

    tool->options = options;
    tool->argc = argc;
    tool->argv = argv;
    tool->status = parse(tool);
    meso_progress_init(tool->progress, tool->progress_mode, tool->quiet);
    if (tool->status)
        return false;
    if (!tool->help && !tool->version && !tool->list_options)
        return true;
    tool->json = NULL;
    if (tool->help)
        print_help(tool, options);
    else if (tool->list_options)
        meso_options_list(options, info->words);
    else
        printf("%s %s\n", info->name, MESO_VERSION);
    tool->status = flush_standard_output(&tool->error);
    return false;
}

static const char *status_name(MesoStatus status)
{
    switch (status) {
    case MESO_OK: return "ok";
    case MESO_ERR_NO: return "no";
    case MESO_ERR_USAGE: return "usage";
    case MESO_ERR_LIMIT: return "limit";
    case MESO_ERR_INPUT: return "input";
    case MESO_ERR_OUTPUT: return "output";
    case MESO_ERR_INTERNAL: return "internal";
    case MESO_ERR_MEMORY: return "memory";
    }
    return "internal";
}

static json_t *make_report(const MesoTool *tool)
{
    json_t *root = json_object();
    int failed = json_object_set_new(root, "format", json_string("meso-report"));
    failed |= json_object_set_new(root, "version", json_integer(1));
    failed |= json_object_set_new(root, "tool", json_string(tool->info->name));
    failed |= json_object_set_new(root, "status", json_string(status_name(tool->status)));
    failed |= json_object_set_new(root, "exit", json_integer(tool->status));
    if (tool->status)
        failed |= json_object_set_new(root, "message", meso_json_string(tool->error.message));
    failed |= json_object_set_new(root, "provenance", meso_provenance_json(&tool->provenance));
    failed |= json_object_update(root, tool->report);
    if (tool->verbose)
        failed |= json_object_set_new(root, "seconds", json_real(meso_seconds() - tool->started));
    if (failed) {
        json_decref(root);
        return NULL;
    }
    return root;
}

static MesoStatus write_report(const MesoTool *tool, MesoError *error)
{
    json_t *root = make_report(tool);
    MesoStatus status = meso_json_write_file(root, *tool->json ? tool->json : NULL, error);
    json_decref(root);
    return status;
}

/* What the run is about; "" where nothing is named. */
static const char *subject(const MesoTool *tool)
{
    if (tool->output && strcmp(tool->output, "-") != 0)
        return tool->output;
    return tool->operand_count ? tool->operands[tool->operand_count - 1] : "";
}

static bool begins_with_name(const char *message, const char *name)
{
    size_t length = strlen(name);
    return strncmp(message, name, length) == 0 && message[length] == ':';
}

/* Whether the job as a whole failed, and the message does not say which. */
static bool lacks_subject(const MesoTool *tool, const MesoError *error)
{
    bool whole = error->status == MESO_ERR_NO || error->status == MESO_ERR_LIMIT ||
                 error->status == MESO_ERR_INTERNAL || error->status == MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < tool->operand_count && whole; i++)
        whole = !begins_with_name(error->message, tool->operands[i]);
    return whole && *subject(tool);
}

static void print_line(const MesoTool *tool, const char *file, const char *text)
{
    MesoError line;     /* for its rule that a message stays on one line */
    meso_fail(&line, MESO_OK, "%s", file);
    fprintf(stderr, "%s: %s%s%s\n", tool->info->name, line.message, *file ? ": " : "", text);
}

static void print_error(const MesoTool *tool, const MesoError *error)
{
    print_line(tool, lacks_subject(tool, error) ? subject(tool) : "", error->message);
    if (error->status == MESO_ERR_USAGE)
        fprintf(stderr, "try '%s --help'\n", tool->info->name);
}

void meso_tool_complain(const MesoTool *tool, const MesoError *error)
{
    meso_progress_hide(tool->progress);
    print_error(tool, error);
}

int meso_tool_finish(MesoTool *tool)
{
    if (tool->progress)
        meso_progress_end(tool->progress);
    if (tool->status) {
        tool->error.status = tool->status;
        print_error(tool, &tool->error);
    }
    if (tool->json && tool->report) {
        MesoError error = {0};
        MesoStatus status = write_report(tool, &error);
        if (status)
            print_error(tool, &error);
        if (!tool->status)
            tool->status = status;
    }
    json_decref(tool->report);
    tool->report = NULL;
    tool->progress = NULL;
    meso_arena_release(&tool->arena);
    return (int)tool->status;
}

static void say(const MesoTool *tool, const char *file, const char *format, va_list arguments)
{
    if (tool->quiet)
        return;
    MesoError line;
    char text[sizeof line.message];
    vsnprintf(text, sizeof text, format, arguments);
    meso_fail(&line, MESO_OK, "%s", text);
    meso_progress_hide(tool->progress);
    print_line(tool, file, line.message);
}

void meso_tool_say(const MesoTool *tool, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(tool, subject(tool), format, arguments);
    va_end(arguments);
}

void meso_tool_say_of(const MesoTool *tool, const char *file, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(tool, file, format, arguments);
    va_end(arguments);
}

void meso_tool_progress_begin(MesoTool *tool, const char *what, const char *unit)
{
    meso_progress_begin(tool->progress, what, unit);
}

void meso_tool_progress(void *tool, uint64_t done, uint64_t total)
{
    meso_progress_update(((MesoTool *)tool)->progress, done, total);
}
