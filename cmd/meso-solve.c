/* meso-solve: assigns a tile to every slot of a surface. */
#include <string.h>

#include "cmd/solve/solve_constraints.h"
#include "cmd/solve/solve_seeds.h"
#include "formats/tiling/result/report_file.h"
#include "formats/tiling/result/slots_file.h"

typedef struct Arguments {
    MesoTool tool;
    uint32_t attempts;
    bool attempts_given, strict, pairs;
    const char *report;
    MesoOrientArguments orient;
    MesoControlArguments control;
    MesoEngineArguments engine;
    MesoSeedOptions seeds;
} Arguments;

typedef struct Problem {
    MesoTileSet set;
    MesoSolveSurface surface;
    uint64_t tiles_hash[2];
    MesoVariantSet variants;
    const MesoConstraints *constraints;     /* NULL: none */
    MesoSolveResult result;
} Problem;

static MesoTilingProblem tiling_of(const Problem *p)
{
    return (MesoTilingProblem){&p->set, &p->variants, &p->surface.graph, p->constraints};
}

static const MesoToolInfo info = {
    .name = "meso-solve",
    .synopsis = "meso-solve [options] TILES SURFACE -o OUT.slots [--report OUT.json]\n"
                "meso-solve [options] --seeds LIST TILES SURFACE [-o OUT.jsonl]",
    .purpose = "Assigns a tile to every quad of SURFACE so that all sides match.",
    .examples = "meso-solve vase.tiles.json vase.obj -o vase.slots\n"
                "meso-solve --seed 7 --report vase.json vase.tiles.json vase.obj -o vase.slots\n"
                "meso-solve --constraints knobs.json vase.tiles.json vase.obj -o vase.slots\n"
                "meso-solve --seeds 1-100 --best balance=v.slots vase.tiles.json vase.obj",
    .words = "1 .json\n"
             "2 .obj .ply .off\n"
             "--output .slots .jsonl\n"
             "--report .json\n"
             "--json .json\n"
             "--orient file comb u,v field=\n"
             "--constraints .json\n"
             "--strands connected acyclic no-loops max-length=\n"
             "--keep .slots .csv .json\n"
             "--resume .jsonl\n"
             "--best attempts balance loops",
    .operands_low = 2,
    .operands_high = 2,
};

static bool is_standard_output(const char *path)
{
    return path && (strcmp(path, "-") == 0 || *path == 0);
}

static MesoStatus check_arguments(Arguments *a)
{
    MesoTool *tool = &a->tool;
    MesoStatus status = meso_seed_options_check(&a->seeds, tool, a->attempts_given, &tool->error);
    if (!status)
        status = meso_orient_check(&a->orient, &tool->error);
    if (status)
        return status;
    if (a->seeds.seeds && (a->engine.proof || a->engine.budget > 0))
        return meso_fail(&tool->error, MESO_ERR_USAGE, a->engine.proof ? "--proof is of one seed"
                         : "--budget goes by the clock, which the lines of --seeds must not depend on; use "
                           "--observations and --conflicts");
    if (a->seeds.seeds && a->report)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--report is of one seed; --seeds writes a line each");
    if (a->seeds.seeds)
        return MESO_OK;
    if (a->engine.proof) {
        const char *formula = meso_arena_print(&tool->arena, &tool->error, "%s.cnf", a->engine.proof);
        status = formula ? meso_tool_add_output(tool, "--proof", formula) : MESO_ERR_MEMORY;
    }
    if (status)
        return status;
    if (!tool->output)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "no place for the assignment; use -o OUT.slots");
    int streams = is_standard_output(tool->output) + is_standard_output(a->report) +
                  is_standard_output(tool->json);
    if (streams > 1)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "only one of -o, --report and --json can go "
                         "to standard output");
    return MESO_OK;
}

static MesoStatus read_inputs(Arguments *a, Problem *p)
{
    const MesoSurfaceWish wish = {.path = a->tool.operands[1], .orient = a->orient, .set = &p->set,
                                  .strict = a->strict, .pairs = a->pairs};
    MesoStatus status = meso_tool_read_tiles(&a->tool, a->tool.operands[0], &p->set, p->tiles_hash);
    if (!status)
        status = meso_tool_read_surface(&a->tool, &wish, &p->surface);
    if (!status)
        status = meso_variant_set_build(&p->variants, &a->tool.arena, &p->set, &a->tool.error);
    if (!status)
        status = meso_tool_read_control(&a->tool, &a->control, &p->set, &p->variants, &p->surface, &p->constraints);
    return status;
}

/* Writes the assignment, where there is one, and the report, where it was asked for. */
static MesoStatus write_outputs(Arguments *a, const Problem *p, MesoOutput **slots, MesoOutput **report)
{
    MesoTool *tool = &a->tool;
    bool solved = p->result.verdict == MESO_VERDICT_SOLVED;
    MesoStatus status = MESO_OK;
    if (solved)
        status = meso_slots_write(&p->result.assignment, &p->set, p->surface.quarters, p->surface.over,
                                  p->tiles_hash, p->surface.hash, &tool->provenance, *slots, &tool->error);
    if (!status && *report)
        status = meso_tool_write_json(meso_report_to_json(tool->report, &tool->provenance), *report,
                                      &tool->error);
    if (!status && solved) {
        status = meso_output_commit(*slots, &tool->error);
        *slots = NULL;
    }
    if (!status && *report) {
        status = meso_output_commit(*report, &tool->error);
        *report = NULL;
    }
    return status;
}

static MesoStatus say_limit(Arguments *a, const MesoSolveResult *result)
{
    static const char *const more[] = {
        [MESO_BUDGET_ATTEMPTS] = "--attempts, --engine auto",
        [MESO_BUDGET_OBSERVATIONS] = "--observations, --engine auto",
        [MESO_BUDGET_CONFLICTS] = "--conflicts",
        [MESO_BUDGET_CUTS] = "--attempts",
        [MESO_BUDGET_COUNTED] = "--attempts",
        [MESO_BUDGET_FORMULA] = "--attempts",
        [MESO_BUDGET_TIME] = "--budget",
    };
    return meso_fail(&a->tool.error, MESO_ERR_LIMIT, "gave up: %s; try %s, --seed or meso-suggest", result->reason,
                     more[result->budget]);
}

static void say_changes(Arguments *a, const Problem *p)
{
    uint32_t changed = meso_constraints_changed(p->constraints, &p->result.assignment, &p->variants);
    meso_tool_say(&a->tool, "%u of the slots to keep changed%s", changed,
                  changed > 0 && p->result.changes_fewest ? ", no assignment changes fewer" : "");
}

static MesoStatus say_verdict(Arguments *a, const Problem *p)
{
    const MesoSolveResult *result = &p->result;
    switch (result->verdict) {
    case MESO_VERDICT_SOLVED:
        meso_tool_say(&a->tool, "solved %u slot%s in %u attempt%s", p->surface.graph.slot_count,
                      p->surface.graph.slot_count == 1 ? "" : "s", result->attempts,
                      result->attempts == 1 ? "" : "s");
        if (a->control.keep)
            say_changes(a, p);
        return MESO_OK;
    case MESO_VERDICT_UNSOLVABLE:
        if (*result->reason && result->decider == MESO_DECIDER_PROPAGATION && result->dead_end_total > 1)
            return meso_fail(&a->tool.error, MESO_ERR_NO, "unsolvable: %s (in all, %llu of %u slots have no tile, "
                             "whatever the others hold)", result->reason, (unsigned long long)result->dead_end_total,
                             p->surface.graph.slot_count);
        if (*result->reason)
            return meso_fail(&a->tool.error, MESO_ERR_NO, "unsolvable: %s", result->reason);
        return meso_fail(&a->tool.error, MESO_ERR_NO, "unsolvable: no tile fits %llu of %u slots, "
                         "whatever the others hold; the first is slot %u",
                         (unsigned long long)result->dead_end_total, p->surface.graph.slot_count,
                         result->dead_ends[0].slot);
    case MESO_VERDICT_GAVE_UP:
        break;
    }
    return say_limit(a, result);
}

static MesoStatus solve_and_write(Arguments *a, Problem *p, MesoOutput **slots, MesoOutput **report)
{
    MesoTool *tool = &a->tool;
    const MesoTilingProblem tiling = tiling_of(p);
    MesoStatus status = meso_tool_solve(tool, &tiling, &a->engine, a->attempts, &p->result);
    if (!status)
        status = meso_report_fill(tool->report, &p->result, &tiling, &tool->error);
    if (!status && (a->report || tool->json))
        status = meso_report_fill_control(tool->report, &p->result, &tiling, &tool->error);
    if (!status)
        status = write_outputs(a, p, slots, report);
    return status ? status : say_verdict(a, p);
}

static MesoStatus solve_seeds(Arguments *a, const Problem *p)
{
    const MesoTilingProblem tiling = tiling_of(p);
    MesoSeedProblem problem = {
        .tiling = &tiling, .surface = &p->surface, .tiles_hash = p->tiles_hash,
        .solve = {.max_attempts = a->attempts},
        .others = a->control.strands ? a->control.strands : "",
    };
    meso_engine_choose(&a->engine, &problem.solve);
    return meso_solve_seeds(&a->tool, &a->seeds, &problem);
}

/* Opens the outputs before the work, so that a place that cannot be written to is known at once. */
static MesoStatus run(Arguments *a)
{
    MesoTool *tool = &a->tool;
    Problem problem = {0};
    MesoOutput *slots = NULL, *report = NULL;
    MesoStatus status = check_arguments(a);
    if (!status)
        status = read_inputs(a, &problem);
    if (!status && a->seeds.seeds)
        return solve_seeds(a, &problem);
    if (!status)
        status = meso_output_open(&slots, tool->output, &tool->error);
    if (!status && a->report)
        status = meso_output_open(&report, a->report, &tool->error);
    if (!status)
        status = solve_and_write(a, &problem, &slots, &report);
    meso_output_discard(slots);
    meso_output_discard(report);
    return status;
}

int main(int argc, char **argv)
{
    Arguments a = {.attempts = 20, .orient = MESO_ORIENT_DEFAULTS, .engine = MESO_ENGINE_DEFAULTS};
    const MesoOption options[] = {
        MESO_GROUP("Solving"),
        MESO_COUNT(0, "attempts", "N", "attempts of the search (default 20)", &a.attempts, 1, 1e9,
                   .given = &a.attempts_given),
        MESO_ORIENT_OPTION(a.orient),
        MESO_STRICT_OPTION(a.strict),
        MESO_PAIRS_OPTION(a.pairs),
        MESO_OUTPUT_FILE(0, "report", "FILE", "write verdict, statistics and dead ends as JSON", &a.report),
        MESO_ENGINE_OPTIONS(a.engine),
        MESO_CONTROL_OPTIONS(a.control),
        MESO_SEED_OPTIONS(a.seeds),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (meso_tool_start(&a.tool, &info, options, argc, argv))
        a.tool.status = run(&a);
    return meso_tool_finish(&a.tool);
}
