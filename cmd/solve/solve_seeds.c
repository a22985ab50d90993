#include "cmd/solve/solve_seeds.h"

#include <inttypes.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <threads.h>
#include <unistd.h>

#include "cmd/common/seed_list.h"
#include "cmd/solve/solve_each.h"
#include "formats/file/line_file.h"
#include "formats/file/output.h"
#include "formats/tiling/result/seed_lines.h"
#include "libcore/tiling/solve/many_seeds.h"

/* ---- options ---- */

/* Less is better; ties go to the next number, then to the smaller seed. */
typedef struct Metric {
    const char *name;
    void (*rate)(const MesoSeedLine *line, uint64_t rating[2]);
} Metric;

static void rate_attempts(const MesoSeedLine *line, uint64_t rating[2])
{
    rating[0] = line->attempts;
    rating[1] = line->observations;
}

static void rate_balance(const MesoSeedLine *line, uint64_t rating[2])
{
    rating[0] = line->tile_squares;
    rating[1] = 0;
}

static void rate_loops(const MesoSeedLine *line, uint64_t rating[2])
{
    rating[0] = line->loop_count;
    rating[1] = line->strand_count;
}

static const Metric metrics[] = {{"attempts", rate_attempts}, {"balance", rate_balance}, {"loops", rate_loops}};
enum { METRIC_COUNT = sizeof metrics / sizeof *metrics };

static MesoStatus parse_best(const Metric **metric, const char **file, const char *text, MesoError *error)
{
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : strlen(text);
    *file = equals ? equals + 1 : NULL;
    for (uint32_t i = 0; i < METRIC_COUNT; i++)
        if (strlen(metrics[i].name) == length && strncmp(metrics[i].name, text, length) == 0 && (!*file || **file)) {
            *metric = &metrics[i];
            return MESO_OK;
        }
    return meso_fail(error, MESO_ERR_USAGE, "--best: '%s' is not attempts, balance or loops, with or without =FILE",
                     text);
}

static MesoStatus check_companions(const MesoSeedOptions *o, const MesoTool *tool, MesoError *error)
{
    const char *alone = o->each ? "--each" : o->resume ? "--resume" : o->best ? "--best" : NULL;
    if (!o->seeds && alone)
        return meso_fail(error, MESO_ERR_USAGE, "%s needs --seeds", alone);
    if (o->seeds && tool->seed)
        return meso_fail(error, MESO_ERR_USAGE, "--seed and --seeds are both given; one is needed");
    if (o->seeds && tool->json && (!*tool->json || strcmp(tool->json, "-") == 0) &&
        (!tool->output || strcmp(tool->output, "-") == 0))
        return meso_fail(error, MESO_ERR_USAGE, "the seeds' lines and the JSON report cannot both go to standard "
                         "output; use -o FILE or --json=FILE");
    return MESO_OK;
}

static MesoStatus check_list(const char *text, bool attempts_given, MesoError *error)
{
    MesoSeedList list;
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = meso_seed_list_parse(&list, &arena, text, error);
    for (uint32_t i = 0; !status && i < list.range_count; i++)
        if (list.ranges[i].attempts && attempts_given)
            status = meso_fail(error, MESO_ERR_USAGE, "--attempts and the x%u of --seeds are both given; one is needed",
                               list.ranges[i].attempts);
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_seed_options_check(const MesoSeedOptions *o, const MesoTool *tool, bool attempts_given,
                                   MesoError *error)
{
    const Metric *metric;
    const char *file;
    MesoStatus status = check_companions(o, tool, error);
    if (status || !o->seeds)
        return status;
    status = check_list(o->seeds, attempts_given, error);
    if (!status && o->each && !meso_seed_path_is_pattern(o->each))
        return meso_fail(error, MESO_ERR_USAGE, "--each: '%s' must have one %%d, for the seed; %%%% stands for %%",
                         o->each);
    return status || !o->best ? status : parse_best(&metric, &file, o->best, error);
}

/* ---- one seed ---- */

typedef struct Seeds {
    MesoTool *tool;
    const MesoSeedOptions *options;
    const MesoSeedProblem *problem;
    MesoSeedList list;
    MesoSeedEach each;
    MesoSolveOptions solve;     /* but for the attempts that the list gives */
    uint64_t (*hashes)[2];      /* [list.range_count] of the problem, which the attempts are part of */
    uint64_t *todo;             /* [todo_count] seeds to solve */
    uint32_t todo_count, todo_begin;    /* of those, in the sweep that runs */
    const char *partial;        /* NULL: none is kept */

    mtx_t lock;                 /* of all below, and of the tool's arena */
    MesoSeedLine *lines;        /* [list.seed_count] by seed; without text where it is not known yet */
    uint32_t done, told;        /* lines known; lines that went to standard output */
    MesoLineFile journal, stream;
} Seeds;

static MesoSeedLine *line_of(const Seeds *seeds, uint64_t seed)
{
    return &seeds->lines[meso_seed_list_index(&seeds->list, seed)];
}

static const uint64_t *hash_of(const Seeds *seeds, uint64_t seed)
{
    return seeds->hashes[meso_seed_list_find(&seeds->list, seed) - seeds->list.ranges];
}

static MesoSolveOptions options_of(const Seeds *seeds, const MesoSeedRange *range)
{
    MesoSolveOptions options = seeds->solve;
    if (range->attempts)
        options.max_attempts = range->attempts;
    return options;
}

static MesoStatus fail_differs(const Seeds *seeds, uint64_t seed, MesoError *error)
{
    return meso_fail(error, MESO_ERR_INPUT, "%s: the line of seed %" PRIu64 " is not what this version solves it to",
                     seeds->options->resume, seed);
}

/* Lines to standard output as far as they follow each other. */
static MesoStatus tell_lines(Seeds *seeds, MesoError *error)
{
    MesoStatus status = MESO_OK;
    bool streams = seeds->stream.path != NULL;
    for (; !status && streams && seeds->told < seeds->list.seed_count && seeds->lines[seeds->told].text; seeds->told++)
        status = meso_line_file_append(&seeds->stream, seeds->lines[seeds->told].text, error);
    return status;
}

/* Copies the line's text to the tool's arena. */
static MesoStatus add_line(Seeds *seeds, const MesoSeedLine *made, MesoError *error)
{
    MesoSeedLine *line = line_of(seeds, made->seed);
    if (line->text)     /* taken over, but its assignment was not there */
        return strcmp(line->text, made->text) == 0 ? MESO_OK : fail_differs(seeds, made->seed, error);
    const char *text = meso_arena_copy_text(&seeds->tool->arena, made->text, error);
    if (!text)
        return MESO_ERR_MEMORY;
    *line = *made;
    line->text = text;
    MesoStatus status = seeds->partial ? meso_line_file_append(&seeds->journal, text, error) : MESO_OK;
    meso_tool_progress(seeds->tool, ++seeds->done, seeds->list.seed_count);
    return status ? status : tell_lines(seeds, error);
}

/* The assignment before the line: what has a line has all. */
static MesoStatus take_result(void *context, uint32_t index, const MesoSolveResult *result, MesoError *error)
{
    Seeds *seeds = context;
    const MesoSeedProblem *p = seeds->problem;
    uint64_t seed = seeds->todo[seeds->todo_begin + index];
    MesoSeedLine line;
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = MESO_OK;
    if (seeds->options->each && result->verdict == MESO_VERDICT_SOLVED)
        status = meso_each_write(&seeds->each, seed, &result->assignment, error);
    if (!status)
        status = meso_seed_line_make(&line, &arena, seed, hash_of(seeds, seed), result, p->tiling->set,
                                     p->tiling->graph, error);
    if (!status) {
        mtx_lock(&seeds->lock);
        status = add_line(seeds, &line, error);
        mtx_unlock(&seeds->lock);
    }
    meso_arena_release(&arena);
    return status;
}

/* ---- what is there ---- */

static bool is_empty_file(const char *path)
{
    struct stat file;
    return stat(path, &file) == 0 && S_ISREG(file.st_mode) && file.st_size == 0;
}

/* The line may be of this problem with the attempts of another part of the list. */
static MesoStatus take_line(Seeds *seeds, const MesoSeedLine *line, MesoError *error)
{
    if (memcmp(line->problem, hash_of(seeds, line->seed), sizeof line->problem) != 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: the line of seed %" PRIu64 " was made with other attempts",
                         seeds->options->resume, line->seed);
    *line_of(seeds, line->seed) = *line;
    seeds->done++;
    return MESO_OK;
}

static MesoStatus read_lines(Seeds *seeds, MesoError *error)
{
    const char *path = seeds->options->resume;
    MesoSeedLine *lines;
    MesoInput input;
    uint32_t count;
    if (!path || is_empty_file(path))
        return MESO_OK;
    MesoStatus status = meso_input_open(&input, path, error);
    if (status)
        return status;
    status = meso_seed_lines_read(&lines, &count, &seeds->tool->arena, &input, seeds->hashes, seeds->list.range_count,
                                  error);
    meso_input_close(&input);
    for (uint32_t i = 0; !status && i < count; i++)
        if (meso_seed_list_find(&seeds->list, lines[i].seed))
            status = take_line(seeds, &lines[i], error);
    return status;
}

/* Seeds of a range without a line, or without the assignment that --each asks for. */
static MesoStatus list_range(Seeds *seeds, const MesoSeedRange *range, MesoError *error)
{
    MesoArena *arena = &seeds->tool->arena;
    for (uint32_t i = 0; i < range->count; i++) {
        const MesoSeedLine *line = &seeds->lines[range->begin + i];
        uint64_t seed = range->first + i;
        bool complete = line->text != NULL;
        if (complete && seeds->options->each && line->verdict == MESO_VERDICT_SOLVED) {
            MesoArenaMark mark = meso_arena_mark(arena);
            MesoStatus status = meso_each_find(&complete, &seeds->each, line, arena, error);
            meso_arena_rewind(arena, mark);
            if (status)
                return status;
        }
        if (!complete)
            seeds->todo[seeds->todo_count++] = seed;
    }
    return MESO_OK;
}

static MesoStatus list_todo(Seeds *seeds, MesoError *error)
{
    seeds->todo = MESO_NEW(&seeds->tool->arena, uint64_t, seeds->list.seed_count, error);
    MesoStatus status = seeds->todo ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t r = 0; !status && r < seeds->list.range_count; r++)
        status = list_range(seeds, &seeds->list.ranges[r], error);
    return status;
}

static bool is_same_file(const char *a, const char *b)
{
    struct stat first, second;
    return a && b && stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

/* Those that are there. */
static MesoStatus write_lines(const Seeds *seeds, MesoOutput *output, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < seeds->list.seed_count && !status; i++) {
        const char *text = seeds->lines[i].text;
        if (text)
            status = meso_output_write(output, text, strlen(text), error);
        if (text && !status)
            status = meso_output_write(output, "\n", 1, error);
    }
    return status;
}

/* Begins FILE.partial with the lines that are there; none is kept for devices and pipes. */
static MesoStatus open_journal(Seeds *seeds, MesoError *error)
{
    MesoTool *tool = seeds->tool;
    struct stat file;
    if (stat(tool->output, &file) == 0 && !S_ISREG(file.st_mode))
        return MESO_OK;
    const char *path = meso_arena_print(&tool->arena, error, "%s.partial", tool->output);
    if (!path)
        return MESO_ERR_MEMORY;
    if (access(path, F_OK) == 0 && !is_same_file(path, seeds->options->resume))
        return meso_fail(error, MESO_ERR_OUTPUT, "'%s' is there, of a sweep that was cut short: go on with --resume "
                         "'%s', or remove it", path, path);
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, path, error);
    if (!status)
        status = write_lines(seeds, output, error);
    status = meso_output_finish(output, status, error);
    if (!status)
        status = meso_line_file_open(&seeds->journal, path, error);
    seeds->partial = status ? NULL : path;
    return status;
}

/* ---- all seeds ---- */

/*
 * Every seed needs the same memory again: given back to the system between two,
 * threads would spend a tenth of their time waiting for each other to get it.
 */
static void keep_memory(void)
{
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

/* How many seeds, from `begin` on, have as many attempts each. */
static uint32_t count_alike(const Seeds *seeds, uint32_t begin)
{
    uint32_t end = begin, attempts = meso_seed_list_find(&seeds->list, seeds->todo[begin])->attempts;
    while (end < seeds->todo_count && meso_seed_list_find(&seeds->list, seeds->todo[end])->attempts == attempts)
        end++;
    return end - begin;
}

static MesoStatus sweep_alike(Seeds *seeds, uint32_t count, MesoError *error)
{
    const uint64_t *todo = seeds->todo + seeds->todo_begin;
    const MesoManySeeds alike = {
        .problem = seeds->problem->tiling,
        .options = options_of(seeds, meso_seed_list_find(&seeds->list, *todo)), .thread_count = seeds->tool->threads,
        .seeds = todo, .seed_count = count, .take = take_result, .context = seeds,
    };
    return meso_many_seeds(&alike, error);
}

static MesoStatus sweep(Seeds *seeds, MesoError *error)
{
    MesoTool *tool = seeds->tool;
    keep_memory();
    meso_tool_progress_begin(tool, "solving", "seeds");
    meso_tool_progress(tool, seeds->done, seeds->list.seed_count);
    MesoStatus status = tell_lines(seeds, error);
    for (uint32_t count; !status && seeds->todo_begin < seeds->todo_count; seeds->todo_begin += count) {
        count = count_alike(seeds, seeds->todo_begin);
        status = sweep_alike(seeds, count, error);
    }
    if (seeds->partial) {
        MesoError ignored;
        MesoStatus closed = meso_line_file_close(&seeds->journal, status ? &ignored : error);
        status = status ? status : closed;
    }
    return status;
}

/* -o FILE: all lines, whole or not at all. */
static MesoStatus write_product(const Seeds *seeds, MesoError *error)
{
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, seeds->tool->output, error);
    if (!status)
        status = write_lines(seeds, output, error);
    status = meso_output_finish(output, status, error);
    if (!status && seeds->partial)
        unlink(seeds->partial);
    return status;
}

static const MesoSeedLine *find_best(const Seeds *seeds, const Metric *metric)
{
    const MesoSeedLine *best = NULL;
    uint64_t least[2] = {0}, rating[2];
    for (uint32_t i = 0; i < seeds->list.seed_count; i++) {
        const MesoSeedLine *line = &seeds->lines[i];
        if (line->verdict != MESO_VERDICT_SOLVED)
            continue;
        metric->rate(line, rating);
        if (!best || rating[0] < least[0] || (rating[0] == least[0] && rating[1] < least[1])) {
            best = line;
            memcpy(least, rating, sizeof least);
        }
    }
    return best;
}

/* Solves the best seed once more, for lines may have been taken over, and assignments are not kept. */
static MesoStatus write_best(const Seeds *seeds, const MesoSeedLine *best, const char *path, MesoError *error)
{
    MesoTool *tool = seeds->tool;
    MesoSolveOptions options = options_of(seeds, meso_seed_list_find(&seeds->list, best->seed));
    MesoSolveResult result;
    uint64_t hash[2] = {0};
    options.seed = best->seed;
    MesoStatus status = meso_solve(&result, &tool->arena, seeds->problem->tiling, &options, error);
    if (status)
        return status;
    if (result.verdict == MESO_VERDICT_SOLVED)
        meso_assignment_hash(hash, &result.assignment);
    if (memcmp(hash, best->assignment, sizeof hash) != 0)
        return fail_differs(seeds, best->seed, error);
    return meso_each_write_to(&seeds->each, best->seed, &result.assignment, path, &tool->arena, error);
}

static MesoStatus keep_best(const Seeds *seeds, MesoError *error)
{
    const Metric *metric;
    const char *file;
    MesoStatus status = parse_best(&metric, &file, seeds->options->best, error);
    const MesoSeedLine *best = status ? NULL : find_best(seeds, metric);
    if (!best)
        return status;
    meso_tool_say(seeds->tool, "best by %s: seed %" PRIu64, metric->name, best->seed);
    if (json_object_set_new(seeds->tool->report, "best", json_pack("{sssI}", "metric", metric->name, "seed",
                                                                   (json_int_t)best->seed)))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the report");
    return file ? write_best(seeds, best, file, error) : MESO_OK;
}

static MesoStatus tell_verdicts(const Seeds *seeds, MesoError *error)
{
    uint32_t counts[MESO_VERDICT_GAVE_UP + 1] = {0}, count = seeds->list.seed_count;
    for (uint32_t i = 0; i < count; i++)
        counts[seeds->lines[i].verdict]++;
    uint32_t solved = counts[MESO_VERDICT_SOLVED], unsolvable = counts[MESO_VERDICT_UNSOLVABLE];
    json_t *report = seeds->tool->report;
    int failed = json_object_set_new(report, "seeds", json_integer(count));
    failed |= json_object_set_new(report, "solved", json_integer(solved));
    failed |= json_object_set_new(report, "unsolvable", json_integer(unsolvable));
    failed |= json_object_set_new(report, "gave_up", json_integer(counts[MESO_VERDICT_GAVE_UP]));
    if (failed)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the report");
    if (solved) {
        meso_tool_say(seeds->tool, "solved for %u of %u seed%s", solved, count, count == 1 ? "" : "s");
        return MESO_OK;
    }
    if (unsolvable)
        return meso_fail(error, MESO_ERR_NO, "unsolvable, whatever the seed");
    return meso_fail(error, MESO_ERR_LIMIT, "gave up for all of %u seed%s; try more attempts, or meso-suggest", count,
                     count == 1 ? "" : "s");
}

/* What results depend on beside the inputs and the seed. */
static char *describe_options(const MesoSolveOptions *solve, const char *others, MesoArena *arena, MesoError *error)
{
    return meso_arena_print(arena, error, "engine %d, %u attempts, %" PRIu64 " observations, %" PRIu64 " conflicts, %s",
                            (int)solve->engine, solve->max_attempts, solve->max_observations, solve->max_conflicts,
                            others);
}

/* FILE.partial goes over a file of its own making alone, which is also what a sweep goes on with. */
static MesoStatus add_paths(const Seeds *seeds, MesoError *error)
{
    MesoTool *tool = seeds->tool;
    const Metric *metric;
    const char *file = NULL, *output = tool->output;
    MesoStatus status = seeds->options->best ? parse_best(&metric, &file, seeds->options->best, error) : MESO_OK;
    if (!status && file)
        status = meso_tool_add_output(tool, "--best", file);
    if (!status && output && strcmp(output, "-") != 0) {
        const char *partial = meso_arena_print(&tool->arena, error, "%s.partial", output);
        if (!partial)
            return MESO_ERR_MEMORY;
        if (!is_same_file(partial, seeds->options->resume))
            status = meso_tool_add_output(tool, "-o", partial);
    }
    return status || !seeds->each.pattern ? status : meso_each_check_paths(&seeds->each, error);
}

/* Of the problem with the attempts of each range. */
static MesoStatus hash_problem(Seeds *seeds, MesoError *error)
{
    MesoTool *tool = seeds->tool;
    const MesoSeedProblem *p = seeds->problem;
    seeds->hashes = meso_arena_alloc(&tool->arena, seeds->list.range_count, sizeof *seeds->hashes, error);
    if (!seeds->hashes)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < seeds->list.range_count; r++) {
        const MesoSolveOptions solve = options_of(seeds, &seeds->list.ranges[r]);
        const char *options = describe_options(&solve, p->others, &tool->arena, error);
        if (options && p->surface->over)    /* the same file was another problem before it was given one side */
            options = meso_arena_print(&tool->arena, error, "%s one-side", options);
        if (!options)
            return MESO_ERR_MEMORY;
        meso_seed_problem(seeds->hashes[r], &tool->provenance, p->surface->quarters, p->surface->graph.slot_count,
                          options);
    }
    return MESO_OK;
}

static MesoStatus prepare(Seeds *seeds, MesoError *error)
{
    MesoTool *tool = seeds->tool;
    const MesoSeedProblem *p = seeds->problem;
    MesoStatus status = meso_seed_list_parse(&seeds->list, &tool->arena, seeds->options->seeds, error);
    if (status)
        return status;
    seeds->each = (MesoSeedEach){.tool = tool, .problem = p, .pattern = seeds->options->each, .list = &seeds->list};
    status = add_paths(seeds, error);
    if (status)
        return status;
    seeds->solve = p->solve;
    seeds->solve.max_dead_ends = 1;
    seeds->lines = MESO_NEW(&tool->arena, MesoSeedLine, seeds->list.seed_count, error);
    status = seeds->lines ? hash_problem(seeds, error) : MESO_ERR_MEMORY;
    if (!status)
        status = read_lines(seeds, error);
    return status ? status : list_todo(seeds, error);
}

MesoStatus meso_solve_seeds(MesoTool *tool, const MesoSeedOptions *options, const MesoSeedProblem *problem)
{
    MesoError *error = &tool->error;
    Seeds seeds = {.tool = tool, .options = options, .problem = problem};
    bool streams = !tool->output || strcmp(tool->output, "-") == 0;
    if (mtx_init(&seeds.lock, mtx_plain) != thrd_success)
        return meso_fail(error, MESO_ERR_INTERNAL, "no lock for the threads");
    MesoStatus status = prepare(&seeds, error);
    if (!status)
        status = streams ? meso_line_file_open(&seeds.stream, "-", error) : open_journal(&seeds, error);
    if (!status)
        status = sweep(&seeds, error);
    if (!status && !streams)
        status = write_product(&seeds, error);
    if (!status && options->best)
        status = keep_best(&seeds, error);
    mtx_destroy(&seeds.lock);
    return status ? status : tell_verdicts(&seeds, error);
}
