#include "libcore/growth/language/grammar_run.h"

#include <math.h>

#include "libcore/growth/language/grammar_draw.h"
#include "libcore/growth/language/grammar_operation.h"

uint64_t meso_growth_seed_key(uint64_t job, uint64_t site, uint64_t number)
{
    return meso_draw_key(meso_draw_mix(job), site, number);
}

static inline void clear_command(MesoGrowthCommand *command)
{
    enum { FEW = MESO_GROWTH_VALUES / 2 };
    command->given = 0;
    memset(command->values, 0, FEW * sizeof(double));   /* in halves, which compilers write without a call or a loop */
    memset(command->values + FEW, 0, sizeof command->values - FEW * sizeof(double));
    command->shape = command->field = command->rule = command->entry = command->condition = MESO_NO_INDEX;
    command->join = false;
    command->key = 0;
    command->fault = NULL;
}

static void end_with(MesoGrowthCommand *command, MesoGrowthOrder order, const char *fault)
{
    command->order = order;
    command->fault = fault;
}

/* Whole numbers, far apart for the turns of loops within one another: MESO_GROWTH_TURNS to the third is below 2^53. */
static double salt_within(const double *r, uint16_t outer)
{
    return outer == MESO_NO_REGISTER ? 0 : r[outer] * MESO_GROWTH_TURNS;
}

static uint64_t turn_of(const double *r, uint16_t salt)
{
    return salt == MESO_NO_REGISTER ? 0 : (uint64_t)r[salt];
}

/* Operands: the upper bit says whether of the registers or of the constants, so that no branch is needed. */
#define OPERAND(x) (banks[(x) >> 15 & 1][(x) & (MESO_CONSTANT_OPERAND - 1)])
#define A OPERAND(i->a)
#define B OPERAND(i->b)
#define THIRD OPERAND(i->target)

/* Runs until a command is complete. `r` are the registers. */
static inline __attribute__((always_inline)) void execute(MesoGrowthCommand *command, const MesoGrammar *grammar,
                                                          MesoGrowthRun *run, double *r, const MesoGrowthHost *host)
{
    const MesoGrammarInstruction *code = grammar->code, *i = code + run->at;
    const double *const banks[2] = {r, grammar->constants};
    uint32_t given = 0;
    for (;; i++) {
        switch ((MesoGrammarOperation)i->operation) {
        case MESO_OP_CONSTANT: r[i->to] = grammar->constants[i->target]; continue;
        case MESO_OP_COPY: r[i->to] = A; continue;
        case MESO_OP_STATE: r[i->to] = host->state[i->target]; continue;
        case MESO_OP_LOOK:
            r[i->to] = host->look(host->context, (MesoGrowthLook)i->target, i->more,
                                  i->a == MESO_NO_REGISTER ? 0 : A, i->b == MESO_NO_REGISTER ? 0 : B);
            continue;
        case MESO_OP_ADD: r[i->to] = A + B; continue;
        case MESO_OP_SUBTRACT: r[i->to] = A - B; continue;
        case MESO_OP_MULTIPLY: r[i->to] = A * B; continue;
        case MESO_OP_LESS: r[i->to] = A < B; continue;
        case MESO_OP_DIVIDE: case MESO_OP_MINIMUM: case MESO_OP_MAXIMUM: case MESO_OP_MODULO: case MESO_OP_POWER:
        case MESO_OP_LESS_EQUAL: case MESO_OP_EQUAL: case MESO_OP_NOT_EQUAL:
            r[i->to] = meso_grammar_apply(i->operation, A, B, 0);
            continue;
        case MESO_OP_NEGATE: case MESO_OP_NOT: case MESO_OP_ABSOLUTE: case MESO_OP_FLOOR: case MESO_OP_CEILING:
        case MESO_OP_ROUND: case MESO_OP_SIGN: case MESO_OP_ROOT: case MESO_OP_SINE: case MESO_OP_COSINE:
            r[i->to] = meso_grammar_apply(i->operation, A, 0, 0);
            continue;
        case MESO_OP_CLAMP: case MESO_OP_LERP: case MESO_OP_SMOOTH:
            r[i->to] = meso_grammar_apply(i->operation, A, B, THIRD);
            continue;
        case MESO_OP_DRAW:
            r[i->to] = meso_draw_share(meso_draw_key(run->key, grammar->sites[i->target], turn_of(r, i->a)));
            continue;
        case MESO_OP_NORMAL:
            r[i->to] = A + meso_draw_normal(meso_draw_key(run->key, grammar->sites[i->target],
                                                          turn_of(r, (uint16_t)i->more))) * B;
            continue;
        case MESO_OP_JUMP: i = code + i->target - 1; continue;
        case MESO_OP_JUMP_UNLESS:
            if (A == 0)
                i = code + i->target - 1;
            continue;
        case MESO_OP_JUMP_UNLESS_LESS:
            if (!(A < B))
                i = code + i->target - 1;
            continue;
        case MESO_OP_JUMP_IF:
            if (A != 0)
                i = code + i->target - 1;
            continue;
        case MESO_OP_SALT: r[i->to] = salt_within(r, i->a); continue;
        case MESO_OP_LOOP:
            r[i->to] += 1;
            r[i->b] += 1;
            if (!(r[i->to] < floor(A))) {
                i = code + i->target - 1;
                continue;
            }
            if (++run->turns < MESO_GROWTH_TURNS)
                continue;
            end_with(command, MESO_GROWTH_FAULT, "too many repetitions");
            break;
        case MESO_OP_RESULT:
            command->values[0] = A;
            end_with(command, MESO_GROWTH_END, NULL);
            break;
        case MESO_OP_VALUE_CONSTANT:
            command->values[i->to] = grammar->constants[i->target];
            given |= 1u << i->to;
            continue;
        case MESO_OP_VALUE:
        case MESO_OP_VALUE_PRODUCT: {
            double value = i->operation == MESO_OP_VALUE ? r[i->a] : A * B;
            command->values[i->to] = value;
            given |= 1u << i->to;
            if (isfinite(value))
                continue;
            end_with(command, MESO_GROWTH_FAULT, "a value is not finite");
            break;
        }
        case MESO_OP_WHILE: command->condition = i->target; continue;
        case MESO_OP_STEP:
            command->order = MESO_GROWTH_STEP;
            command->shape = i->more;
            command->join = i->a;
            run->refused = i->target;
            break;
        case MESO_OP_MOVE: command->order = MESO_GROWTH_MOVE; break;
        case MESO_OP_TURN:
            if (host->turn) {
                host->turn(host->context, command->values[MESO_GROWTH_AMOUNT]);
                command->values[MESO_GROWTH_AMOUNT] = 0;
                given = 0;
                continue;
            }
            command->order = MESO_GROWTH_TURN;
            break;
        case MESO_OP_FACE:
            command->order = MESO_GROWTH_FACE;
            command->field = i->more;
            break;
        case MESO_OP_PLACE:
            command->order = MESO_GROWTH_PLACE;
            command->shape = i->more;
            break;
        case MESO_OP_BRANCH:
            command->order = MESO_GROWTH_BRANCH;
            command->entry = (uint32_t)(i - code) + 1;
            command->key = meso_draw_key(run->key, grammar->sites[i->more], turn_of(r, i->b));
            break;
        case MESO_OP_RULE:
            command->order = MESO_GROWTH_RULE;
            command->rule = i->more;
            command->key = meso_draw_key(run->key, grammar->sites[i->target], turn_of(r, i->a));
            break;
        case MESO_OP_AND: case MESO_OP_OR: case MESO_OP_RANDOM: case MESO_OP_CHANCE:
        case MESO_OP_END: command->order = MESO_GROWTH_END; break;
        default: __builtin_unreachable();
        }
        break;
    }
    command->given = given;
    command->line = grammar->lines[i - code];
    run->at = command->order == MESO_GROWTH_BRANCH ? i->target : (uint32_t)(i - code) + 1;
}

void meso_growth_resume(MesoGrowthCommand *command, const MesoGrammar *grammar, MesoGrowthRun *run, double *registers,
                        const MesoGrowthHost *host, bool done)
{
    uint32_t refused = run->refused;
    bool stepped = run->stepped;
    run->stepped = false;
    run->refused = MESO_NO_INDEX;
    clear_command(command);
    if (stepped && !done && refused == MESO_NO_INDEX) {
        command->order = MESO_GROWTH_END;
        command->line = run->at ? grammar->lines[run->at - 1] : 0;
        return;
    }
    if (stepped && !done)
        run->at = refused;
    execute(command, grammar, run, registers, host);
    run->stepped = command->order == MESO_GROWTH_STEP;
}

double meso_growth_value(const MesoGrammar *grammar, const MesoGrowthRun *run, uint32_t entry, double *registers,
                         const MesoGrowthHost *host)
{
    MesoGrowthCommand command;
    MesoGrowthRun apart = *run;
    apart.at = entry;
    execute(&command, grammar, &apart, registers, host);
    return command.values[0];
}
