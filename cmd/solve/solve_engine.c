#include "cmd/solve/solve_engine.h"

#include <inttypes.h>
#include <string.h>

#include "formats/tiling/result/report_file.h"
#include "libcore/base/clock.h"

/* Bytes of a formula's first line, whose numbers are known last. */
enum { HEADER_SIZE = 64 };

static bool past_deadline(void *context)
{
    const MesoEngineRun *run = context;
    return run->status || meso_seconds() > run->deadline;
}

static bool write_proof(void *context, const char *data, size_t size)
{
    MesoEngineRun *run = context;
    if (!run->status)
        run->status = meso_output_write(run->proof, data, size, run->error);
    return !run->status;
}

static void flush(MesoEngineRun *run)
{
    if (!run->status)
        run->status = meso_output_write(run->formula, run->buffer, run->used, run->error);
    run->used = 0;
}

static void write_clause(void *context, const int32_t *literals, uint32_t count)
{
    MesoEngineRun *run = context;
    for (uint32_t i = 0; i <= count; i++) {
        int32_t literal = i < count ? literals[i] : 0;
        uint32_t variable = (uint32_t)(literal < 0 ? -literal : literal);
        if (sizeof run->buffer - run->used < 16)
            flush(run);
        run->used += (uint32_t)snprintf(run->buffer + run->used, 16, "%" PRId32 "%c", literal,
                                        i < count ? ' ' : '\n');
        run->variable_count = variable > run->variable_count ? variable : run->variable_count;
    }
    run->clause_count++;
}

static void make_header(char header[HEADER_SIZE + 1], const MesoEngineRun *run)
{
    int size = snprintf(header, HEADER_SIZE, "p cnf %" PRIu32 " %" PRIu64, run->variable_count, run->clause_count);
    memset(header + size, ' ', HEADER_SIZE - (size_t)size);
    header[HEADER_SIZE - 1] = '\n';
    header[HEADER_SIZE] = 0;
}

static void open_files(MesoEngineRun *run)
{
    char header[HEADER_SIZE + 1];
    run->clause_count = 0;
    run->variable_count = run->used = 0;
    run->status = meso_output_open(&run->proof, run->proof_path, run->error);
    if (!run->status)
        run->status = meso_output_open(&run->formula, run->formula_path, run->error);
    make_header(header, run);
    if (!run->status)
        run->status = meso_output_write(run->formula, header, HEADER_SIZE, run->error);
}

static void discard_files(MesoEngineRun *run)
{
    meso_output_discard(run->proof);
    meso_output_discard(run->formula);
    run->proof = run->formula = NULL;
}

/* The engine may be asked several times, the last time about what probing has left: the files are about that alone. */
static void begin_formula(void *context)
{
    MesoEngineRun *run = context;
    if (run->status || run->clause_count == 0)
        return;
    discard_files(run);
    open_files(run);
}

static MesoStatus open_proof(MesoEngineRun *run, MesoTool *tool, const char *path)
{
    if (!*path || strcmp(path, "-") == 0)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--proof writes two files and needs a name");
    run->proof_path = path;
    run->formula_path = meso_arena_print(&tool->arena, &tool->error, "%s.cnf", path);
    if (!run->formula_path)
        return MESO_ERR_MEMORY;
    open_files(run);
    return run->status;
}

void meso_engine_choose(const MesoEngineArguments *arguments, MesoSolveOptions *options)
{
    options->engine = MESO_ENGINE_AUTO;
    if (strcmp(arguments->engine, "auto") != 0)
        options->engine = strcmp(arguments->engine, "wfc") == 0 ? MESO_ENGINE_WFC : MESO_ENGINE_EXACT;
    options->max_observations = arguments->observations;
    options->max_conflicts = arguments->conflicts == MESO_SOLVE_CONFLICTS ? 0 : arguments->conflicts;
}

MesoStatus meso_engine_start(MesoEngineRun *run, MesoTool *tool, const MesoEngineArguments *arguments,
                             MesoSolveOptions *options)
{
    memset(run, 0, offsetof(MesoEngineRun, buffer));
    run->error = &tool->error;
    run->deadline = meso_seconds() + (double)arguments->budget;
    meso_engine_choose(arguments, options);
    if (arguments->budget > 0) {
        options->stop = past_deadline;
        options->stop_context = run;
    }
    if (!arguments->proof)
        return MESO_OK;
    options->proof = write_proof;
    options->clause = write_clause;
    options->formula = begin_formula;
    options->proof_context = run;
    return open_proof(run, tool, arguments->proof);
}

static MesoStatus commit_proof(MesoEngineRun *run, MesoTool *tool)
{
    char header[HEADER_SIZE + 1];
    make_header(header, run);
    flush(run);
    if (!run->status)
        run->status = meso_output_write_at(run->formula, 0, header, HEADER_SIZE, &tool->error);
    if (!run->status) {
        run->status = meso_output_commit(run->formula, &tool->error);
        run->formula = NULL;
    }
    if (!run->status) {
        run->status = meso_output_commit(run->proof, &tool->error);
        run->proof = NULL;
    }
    return run->status;
}

MesoStatus meso_engine_finish(MesoEngineRun *run, MesoTool *tool, const MesoSolveResult *result)
{
    bool asked = result && run->proof_path;
    if (asked && result->verdict == MESO_VERDICT_UNSOLVABLE && result->decider == MESO_DECIDER_EXACT)
        commit_proof(run, tool);
    else if (asked && result->verdict == MESO_VERDICT_UNSOLVABLE)
        meso_tool_say(tool, "proved by %s, not by the exact engine: no proof is written",
                      meso_decider_name(result->decider));
    else if (asked && result->verdict == MESO_VERDICT_GAVE_UP)
        meso_tool_say(tool, "nothing is proved: no proof is written");
    discard_files(run);
    return run->status;
}
