/* Any bytes as a grammar; what is accepted is run, and stays within its bounds. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/growth/grammar_file.h"
#include "libcore/growth/language/grammar_run.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(bool right)
{
    if (!right)
        abort();
}

/* Look-ups of all sorts of numbers, by a hash of what was asked before. */
typedef struct Nowhere {
    const MesoGrammar *grammar;
    uint64_t hash;
} Nowhere;

static double look_nowhere(void *context, MesoGrowthLook look, uint32_t map, double a, double b)
{
    static const double values[] = {0, 1, 0.5, -1, 1e-300, 1e300, INFINITY, NAN};
    Nowhere *nowhere = context;
    bool of_map = look <= MESO_LOOK_GRADIENT;
    (void)a, (void)b;
    check(of_map ? map < nowhere->grammar->map_count : map == MESO_NO_INDEX);
    nowhere->hash = (nowhere->hash + look + 1) * 0x9e3779b97f4a7c15u;
    return values[nowhere->hash >> 61];
}

static void check_command(const MesoGrammar *grammar, const MesoGrowthCommand *command)
{
    check(command->order <= MESO_GROWTH_FAULT && (command->fault != NULL) == (command->order == MESO_GROWTH_FAULT));
    check((command->order == MESO_GROWTH_RULE) == (command->rule != MESO_NO_INDEX));
    check(command->rule == MESO_NO_INDEX || command->rule < grammar->rule_count);
    check((command->order == MESO_GROWTH_FACE) == (command->field != MESO_NO_INDEX));
    check(command->field == MESO_NO_INDEX || command->field < grammar->field_count);
    check(command->shape == MESO_NO_INDEX || command->shape < grammar->shape_count);
    check(command->order != MESO_GROWTH_PLACE || command->shape != MESO_NO_INDEX);
    for (uint32_t i = 0; i < MESO_GROWTH_VALUES && command->order != MESO_GROWTH_FAULT; i++)
        check(isfinite(command->values[i]));
}

enum { MOST_RUNS = 64, MOST_COMMANDS = 4096 };

/* Runs as many rules as it may, one way through the branches. */
static void run_all(const MesoGrammar *grammar, MesoGrowthRun run, double *registers, const MesoGrowthHost *host)
{
    MesoGrowthCommand command = {0};
    bool done = true;
    for (uint32_t i = 0, runs = 0; i < MOST_COMMANDS; i++) {
        meso_growth_resume(&command, grammar, &run, registers, host, done);
        check_command(grammar, &command);
        if (command.order == MESO_GROWTH_STEP && command.condition != MESO_NO_INDEX)
            meso_growth_value(grammar, &run, command.condition, registers, host);
        done = i % 3 != 0;
        if (command.order == MESO_GROWTH_BRANCH && i % 2)
            run = meso_growth_begin(command.entry, command.key);
        if (command.order == MESO_GROWTH_RULE) {
            memset(registers, 0xff, grammar->register_count * sizeof *registers);
            memcpy(registers, command.values, grammar->rules[command.rule].argument_count * sizeof *registers);
            run = meso_growth_begin(grammar->rules[command.rule].entry, command.key);
            if (++runs == MOST_RUNS)
                return;
        } else if (command.order > MESO_GROWTH_RULE)
            return;
    }
}

static void grow(const MesoGrammar *grammar)
{
    double state[MESO_STATE_COUNT] = {0};
    Nowhere nowhere = {grammar, 0};
    const MesoGrowthHost host = {.context = &nowhere, .state = state, .look = look_nowhere};
    double *registers = malloc(grammar->register_count * sizeof *registers);
    check(registers && grammar->seed_count > 0);
    memset(registers, 0xff, grammar->register_count * sizeof *registers);
    for (uint32_t i = 0; i < grammar->seed_count && i < 16; i++) {
        const MesoGrammarSeed *seed = &grammar->seeds[i];
        MesoGrowthRun run = meso_growth_begin(seed->entry, meso_growth_seed_key(0, seed->site, 0));
        check(seed->rule < grammar->rule_count && (seed->field == MESO_NO_INDEX || seed->field < grammar->field_count));
        if (seed->where != MESO_NO_INDEX)
            meso_growth_value(grammar, &run, seed->where, registers, &host);
        run_all(grammar, run, registers, &host);
    }
    free(registers);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const MesoGrammarSetting settings[] = {{"pace=1 mm"}};
    /* The first byte of some texts asks for a setting. */
    bool set = size && *data == '!';
    const MesoGrammarOptions options = {settings, set, 10};
    MesoArena arena;
    MesoError error;
    MesoInput input;
    MesoGrammar grammar;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", size ? data + set : (const uint8_t *)"", size - set);
    MesoStatus status = meso_grammar_file_read(&grammar, &arena, &input, &options, &error);
    check(status == MESO_OK || status == MESO_ERR_INPUT || (set && status == MESO_ERR_USAGE));
    if (status == MESO_OK)
        grow(&grammar);
    meso_arena_release(&arena);
    return 0;
}
