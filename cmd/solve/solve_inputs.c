#include "cmd/solve/solve_inputs.h"

#include <string.h>

#include "cmd/common/input_kind.h"
#include "formats/json/json_text.h"
#include "formats/tiling/result/report_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/clock.h"
#include "libcore/tiling/solve/explain.h"

MesoStatus meso_tool_read_tiles(MesoTool *tool, const char *path, MesoTileSet *set,
                                uint64_t hash[2])
{
    MesoInput input;
    MesoStatus status = meso_tool_open_place(tool, &input, path, &MESO_PLACE_TILES);
    if (status)
        return status;
    if (hash)
        memcpy(hash, input.hash, sizeof input.hash);
    status = meso_tiles_read(set, &tool->arena, &input, &tool->error);
    meso_input_close(&input);
    return status;
}

static MesoStatus solve_by_engine(MesoTool *tool, const MesoTilingProblem *problem, const MesoEngineArguments *engine,
                                  MesoSolveOptions *options, MesoSolveResult *result)
{
    MesoEngineRun *run = MESO_NEW(&tool->arena, MesoEngineRun, 1, &tool->error);
    if (!run)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_engine_start(run, tool, engine, options);
    if (!status)
        status = meso_solve(result, &tool->arena, problem, options, &tool->error);
    if (!status)
        status = meso_explain(result, &tool->arena, problem, options->seed, &tool->error);
    MesoStatus written = meso_engine_finish(run, tool, status ? NULL : result);
    return status ? status : written;
}

MesoStatus meso_tool_solve(MesoTool *tool, const MesoTilingProblem *problem, const MesoEngineArguments *engine,
                           uint32_t max_attempts, MesoSolveResult *result)
{
    MesoSolveOptions options = {
        .seed = tool->seed,
        .engine = MESO_ENGINE_WFC,
        .max_attempts = max_attempts,
        .max_dead_ends = MESO_REPORT_DEAD_ENDS,
        .progress = meso_tool_progress,
        .progress_context = tool,
    };
    meso_tool_progress_begin(tool, "solving", "slots");
    double start = 1e3 * meso_seconds();
    MesoStatus status = engine ? solve_by_engine(tool, problem, engine, &options, result)
                               : meso_solve(result, &tool->arena, problem, &options, &tool->error);
    double duration = 1e3 * meso_seconds() - start;
    if (!status && tool->verbose)
        meso_tool_say(tool, "%u slots, %u variants: %.2f ms, %llu observations, %llu jumps and %llu repairs in %u "
                      "attempt%s, decided by %s", problem->graph->slot_count, problem->variants->count, duration,
                      (unsigned long long)result->observations, (unsigned long long)result->jumps,
                      (unsigned long long)result->repairs, result->attempts, result->attempts == 1 ? "" : "s",
                      meso_decider_name(result->decider));
    return status;
}

MesoStatus meso_tool_write_json(json_t *value, MesoOutput *output, MesoError *error)
{
    MesoStatus status = value ? meso_json_write(value, output, error)
                              : meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    json_decref(value);
    return status;
}
