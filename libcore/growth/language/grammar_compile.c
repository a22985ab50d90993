#include "libcore/growth/language/grammar_compile.h"

#include <math.h>

#include "libcore/base/grow.h"
#include "libcore/growth/language/grammar_parser.h"
#include "libcore/growth/language/grammar_run.h"

/* Values in between take the registers behind the locals, as a stack. */
typedef struct Compiler {
    MesoGrammarParser *parser;
    MesoGrammar *grammar;
    uint32_t code_room, line_room, constant_room;
    uint32_t top;               /* the first free register */
    MesoToken at;               /* the statement whose code it is */
} Compiler;

static uint16_t value_of(Compiler *c, const MesoExpression *e);
static void compile_block(Compiler *c, const MesoBlock *block);

static uint32_t emit(Compiler *c, MesoGrammarInstruction instruction)
{
    MesoGrammar *grammar = c->grammar;
    if (!meso_parsing(c->parser) || !MESO_PARSE_GROW(c->parser, grammar->code, grammar->code_count, c->code_room) ||
        !MESO_PARSE_GROW(c->parser, grammar->lines, grammar->code_count, c->line_room))
        return 0;
    grammar->code[grammar->code_count] = instruction;
    grammar->lines[grammar->code_count] = c->at.line;
    return grammar->code_count++;
}

/* The jump at `from` leads to what comes next. */
static void land(Compiler *c, uint32_t from)
{
    if (meso_parsing(c->parser))
        c->grammar->code[from].target = c->grammar->code_count;
}

static uint16_t push(Compiler *c)
{
    if (c->top >= MESO_GRAMMAR_REGISTERS)
        meso_grammar_wrong(&c->parser->lexer, &c->at, "more than %d values at hand; make a rule of a part of this one",
                           (int)MESO_GRAMMAR_REGISTERS);
    if (!meso_parsing(c->parser))
        return 0;
    if (c->grammar->register_count <= c->top)
        c->grammar->register_count = c->top + 1;
    return (uint16_t)c->top++;
}

/* The operand that is this constant: as many as operands can name, then registers into which they are loaded. */
static uint16_t constant_operand(Compiler *c, double value)
{
    MesoGrammar *grammar = c->grammar;
    if (!meso_parsing(c->parser) ||
        !MESO_PARSE_GROW(c->parser, grammar->constants, grammar->constant_count, c->constant_room))
        return 0;
    uint32_t number = grammar->constant_count++;
    grammar->constants[number] = value;
    if (number < MESO_NO_REGISTER - MESO_CONSTANT_OPERAND)
        return (uint16_t)(MESO_CONSTANT_OPERAND + number);
    uint16_t to = push(c);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_CONSTANT, .to = to, .target = number});
    return to;
}

/* The second operand is looked at only where the first does not decide. */
static uint16_t compile_junction(Compiler *c, const MesoExpression *e)
{
    uint32_t mark = c->top;
    uint16_t a = value_of(c, e->arguments[0]);
    c->top = mark;
    uint16_t to = push(c);
    if (a != to)
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = to, .a = a});
    uint32_t jump = emit(c, (MesoGrammarInstruction){
        .operation = e->operation == MESO_OP_AND ? MESO_OP_JUMP_UNLESS : MESO_OP_JUMP_IF, .a = to});
    uint16_t b = value_of(c, e->arguments[1]);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = to, .a = b});
    c->top = (uint32_t)to + 1;
    land(c, jump);
    return to;
}

/* Draws as operations on a plain one, in register `u`. */
static void compile_draw(Compiler *c, const MesoExpression *e, uint16_t to, uint16_t u, const uint16_t x[3])
{
    if (e->operation == MESO_OP_NORMAL) {
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_NORMAL, .to = to, .a = x[0], .b = x[1],
                                         .target = e->index, .more = e->salt});
        return;
    }
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_DRAW, .to = u, .a = (uint16_t)e->salt, .target = e->index});
    if (e->operation == MESO_OP_CHANCE)
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_LESS, .to = to, .a = u, .b = x[0]});
    else
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_LERP, .to = to, .a = x[0], .b = x[1], .target = u});
}

static uint16_t compile_call(Compiler *c, const MesoExpression *e)
{
    uint32_t mark = c->top;
    uint16_t x[3] = {MESO_NO_REGISTER, MESO_NO_REGISTER, MESO_NO_REGISTER};
    if (e->operation == MESO_OP_AND || e->operation == MESO_OP_OR)
        return compile_junction(c, e);
    for (uint32_t i = 0; i < e->argument_count; i++)
        x[i] = value_of(c, e->arguments[i]);
    bool draws = e->operation == MESO_OP_RANDOM || e->operation == MESO_OP_NORMAL || e->operation == MESO_OP_CHANCE;
    bool look = e->operation == MESO_OP_LOOK;
    uint16_t drawn = draws ? push(c) : 0;
    /* Operands are read before the result is written: it may take their place. */
    c->top = mark;
    uint16_t to = push(c);
    if (draws)
        compile_draw(c, e, to, drawn, x);
    else
        emit(c, (MesoGrammarInstruction){.operation = e->operation, .to = to, .a = x[0], .b = x[1],
                                         .target = look ? e->look : x[2], .more = e->index});
    return to;
}

/* The register that holds the value: a local's own, or a new one. */
static uint16_t value_of(Compiler *c, const MesoExpression *e)
{
    uint16_t to = 0;
    switch (e->kind) {
    case MESO_EXPRESSION_LOCAL: return (uint16_t)e->index;
    case MESO_EXPRESSION_CONSTANT: return constant_operand(c, e->value);
    case MESO_EXPRESSION_CALL: return compile_call(c, e);
    case MESO_EXPRESSION_QUANTITY:
    case MESO_EXPRESSION_MAP:
        to = push(c);
        emit(c, (MesoGrammarInstruction){.operation = e->operation, .to = to, .a = MESO_NO_REGISTER,
                                         .b = MESO_NO_REGISTER, .target = e->look, .more = e->index});
        break;
    }
    return to;
}

static bool is_constant(uint16_t operand)
{
    return operand & MESO_CONSTANT_OPERAND && operand != MESO_NO_REGISTER;
}

/* What is not finite is found when it is run. */
static void emit_value(Compiler *c, uint32_t value, uint16_t a)
{
    MesoGrammarInstruction set = {.operation = MESO_OP_VALUE, .to = (uint16_t)value, .a = a};
    uint32_t number = a & (MESO_CONSTANT_OPERAND - 1);
    if (is_constant(a) && meso_parsing(c->parser)) {
        if (isfinite(c->grammar->constants[number])) {
            set = (MesoGrammarInstruction){
                .operation = MESO_OP_VALUE_CONSTANT, .to = (uint16_t)value, .target = number};
        } else {
            set.a = push(c);
            emit(c, (MesoGrammarInstruction){.operation = MESO_OP_CONSTANT, .to = set.a, .target = number});
        }
    }
    emit(c, set);
}

static void compile_value(Compiler *c, uint32_t value, const MesoExpression *e)
{
    uint32_t mark = c->top;
    if (e->kind == MESO_EXPRESSION_CALL && e->operation == MESO_OP_MULTIPLY) {
        uint16_t a = value_of(c, e->arguments[0]), b = value_of(c, e->arguments[1]);
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_VALUE_PRODUCT, .to = (uint16_t)value, .a = a, .b = b});
    } else {
        emit_value(c, value, value_of(c, e));
    }
    c->top = mark;
}

/* Code apart, for meso_growth_value(). */
static uint32_t compile_result(Compiler *c, const MesoExpression *e)
{
    uint32_t entry = c->grammar->code_count, mark = c->top;
    uint16_t a = value_of(c, e);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_RESULT, .a = a});
    c->top = mark;
    return entry;
}

static void compile_rule_call(Compiler *c, const MesoStatement *call)
{
    for (uint32_t i = 0; i < call->argument_count; i++)
        compile_value(c, i, call->arguments[i].expression);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_RULE, .a = (uint16_t)call->salt, .target = call->site,
                                     .more = call->rule});
}

/* Values are numbered by the quantities among the slots. Returns the field or shape among them. */
static uint32_t compile_arguments(Compiler *c, const MesoStatement *s)
{
    const MesoGrammarSlot *slots = s->command->slots;
    uint32_t value = 0, reference = s->shape;
    for (uint32_t i = 0; slots[i].name; i++) {
        const MesoArgument *argument = &s->arguments[i];
        if (slots[i].kind != MESO_SLOT_QUANTITY) {
            reference = argument->index;
            continue;
        }
        uint32_t mark = c->top;
        if (argument->given)
            compile_value(c, value, argument->expression);
        else if (slots[i].fallback != 0)
            emit_value(c, value, constant_operand(c, slots[i].fallback));
        c->top = mark;
        value++;
    }
    return reference;
}

static void compile_step(Compiler *c, const MesoStatement *s)
{
    if (s->expression) {
        uint32_t over = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_JUMP});
        uint32_t condition = compile_result(c, s->expression);
        land(c, over);
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_WHILE, .target = condition});
    }
    if (s->retries) {
        compile_value(c, MESO_GROWTH_RETRIES, s->retries);
        compile_value(c, MESO_GROWTH_RETRY_ANGLE, s->retry_angle);
    }
    uint32_t shape = compile_arguments(c, s);
    uint32_t step = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_STEP, .a = s->join, .target = MESO_NO_INDEX,
                                                     .more = shape});
    if (!s->caught)
        return;
    uint32_t over = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_JUMP});
    land(c, step);
    compile_block(c, &s->otherwise);
    land(c, over);
}

static void compile_command(Compiler *c, const MesoStatement *s)
{
    if (s->command->operation == MESO_OP_STEP) {
        compile_step(c, s);
        return;
    }
    uint32_t reference = compile_arguments(c, s);
    emit(c, (MesoGrammarInstruction){.operation = s->command->operation, .more = reference});
}

/* A jump, to land() later, where `e` does not hold. */
static uint32_t jump_unless(Compiler *c, const MesoExpression *e)
{
    uint32_t mark = c->top;
    MesoGrammarInstruction jump = {.operation = MESO_OP_JUMP_UNLESS};
    if (e->kind == MESO_EXPRESSION_CALL && e->operation == MESO_OP_LESS) {
        jump.operation = MESO_OP_JUMP_UNLESS_LESS;
        jump.a = value_of(c, e->arguments[0]);
        jump.b = value_of(c, e->arguments[1]);
    } else
        jump.a = value_of(c, e);
    c->top = mark;
    return emit(c, jump);
}

static void compile_if(Compiler *c, const MesoStatement *s)
{
    uint32_t other = jump_unless(c, s->expression);
    compile_block(c, &s->block);
    if (s->otherwise.first) {
        uint32_t over = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_JUMP});
        land(c, other);
        compile_block(c, &s->otherwise);
        land(c, over);
    } else
        land(c, other);
}

/* Adds the arm's weight to the sum in register `sum`. */
static void add_weight(Compiler *c, const MesoArm *arm, uint16_t sum)
{
    uint32_t mark = c->top;
    uint16_t weight = value_of(c, arm->weight);
    c->top = mark;
    uint16_t positive = push(c);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_MAXIMUM, .to = positive, .a = weight,
                                     .b = constant_operand(c, 0)});
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_ADD, .to = sum, .a = sum, .b = positive});
    c->top = mark;
}

static bool are_constant(const MesoArm *arm)
{
    for (; arm; arm = arm->next)
        if (arm->weight->kind != MESO_EXPRESSION_CONSTANT)
            return false;
    return true;
}

static double constant_sum(const MesoArm *first, const MesoArm *end)
{
    double sum = 0;
    for (const MesoArm *arm = first; arm != end; arm = arm->next)
        sum += arm->weight->value > 0 ? arm->weight->value : 0;
    return sum;
}

/*
 * The first arm whose weights so far exceed a share of all. The sums are the same floats each time, so that the share,
 * less than the whole, lies below the last of them; the last arm is also that of weights that are all 0.
 */
static void compile_choice(Compiler *c, const MesoStatement *s)
{
    bool constant = are_constant(s->arms);
    uint32_t begin = c->top, out = MESO_NO_INDEX;
    uint16_t share = push(c), sum = push(c), zero = constant_operand(c, 0);
    double whole = constant ? constant_sum(s->arms, NULL) : 0;
    uint16_t all = constant ? constant_operand(c, whole) : sum;
    if (!constant)
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = sum, .a = zero});
    for (const MesoArm *arm = s->arms; arm && !constant; arm = arm->next)
        add_weight(c, arm, sum);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_DRAW, .to = share, .a = (uint16_t)s->salt, .target = s->site});
    if (whole != 1)
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_MULTIPLY, .to = share, .a = share, .b = all});
    if (!constant)
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = sum, .a = zero});
    for (const MesoArm *arm = s->arms; arm->next; arm = arm->next) {
        if (!constant)
            add_weight(c, arm, sum);
        uint16_t reached = constant ? constant_operand(c, constant_sum(s->arms, arm->next)) : sum;
        uint32_t next = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_JUMP_UNLESS_LESS, .a = share, .b = reached});
        compile_block(c, &arm->block);
        /* Jumps out are a list through their targets until the end is known. */
        out = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_JUMP, .target = out});
        land(c, next);
        if (!meso_parsing(c->parser))
            return;
    }
    const MesoArm *last = s->arms;
    while (last->next)
        last = last->next;
    compile_block(c, &last->block);
    while (out != MESO_NO_INDEX && meso_parsing(c->parser)) {
        uint32_t before = c->grammar->code[out].target;
        land(c, out);
        out = before;
    }
    c->top = begin;
}

static void compile_repeat(Compiler *c, const MesoStatement *s)
{
    uint16_t counter = (uint16_t)s->local, salt = (uint16_t)(s->local + 1), turns = (uint16_t)(s->local + 2);
    uint32_t mark = c->top;
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = turns, .a = value_of(c, s->expression)});
    c->top = mark;
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = counter, .a = constant_operand(c, -1)});
    c->top = mark;
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_SALT, .to = salt, .a = (uint16_t)s->salt});
    uint32_t loop = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_LOOP, .to = counter, .a = turns, .b = salt});
    compile_block(c, &s->block);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_JUMP, .target = loop});
    land(c, loop);
}

static void compile_branch(Compiler *c, const MesoStatement *s)
{
    uint32_t branch = emit(c, (MesoGrammarInstruction){.operation = MESO_OP_BRANCH, .b = (uint16_t)s->salt,
                                                       .more = s->site});
    compile_block(c, &s->block);
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_END});
    land(c, branch);
}

static void compile_let(Compiler *c, const MesoStatement *s)
{
    uint32_t mark = c->top;
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_COPY, .to = (uint16_t)s->local, .a = value_of(c, s->expression)});
    c->top = mark;
}

static void compile_block(Compiler *c, const MesoBlock *block)
{
    static void (*const compile[])(Compiler *, const MesoStatement *) = {
        [MESO_STATEMENT_LET] = compile_let,         [MESO_STATEMENT_IF] = compile_if,
        [MESO_STATEMENT_CHOOSE] = compile_choice,   [MESO_STATEMENT_REPEAT] = compile_repeat,
        [MESO_STATEMENT_BRANCH] = compile_branch,   [MESO_STATEMENT_COMMAND] = compile_command,
        [MESO_STATEMENT_RULE] = compile_rule_call};
    for (const MesoStatement *s = block->first; s && meso_parsing(c->parser); s = s->next) {
        c->at = s->at;
        compile[s->kind](c, s);
    }
}

static void compile_rule(Compiler *c, uint32_t index)
{
    c->grammar->rules[index].entry = c->grammar->code_count;
    for (const MesoProduction *p = c->parser->rules[index].first; p; p = p->next) {
        uint32_t next = MESO_NO_INDEX;
        c->at = p->at;
        c->top = p->local_count;
        if (c->grammar->local_count < p->local_count)
            c->grammar->local_count = p->local_count;
        if (p->condition)
            next = jump_unless(c, p->condition);
        compile_block(c, &p->block);
        emit(c, (MesoGrammarInstruction){.operation = MESO_OP_END});
        if (next != MESO_NO_INDEX)
            land(c, next);
    }
    emit(c, (MesoGrammarInstruction){.operation = MESO_OP_END});
}

static void compile_seed(Compiler *c, uint32_t index)
{
    MesoGrammarSeed *seed = &c->grammar->seeds[index];
    const MesoSeedTree *tree = &c->parser->seeds[index];
    const MesoGrammarSlot *slots = tree->places->slots;
    c->at = tree->start->at;
    c->top = 0;
    seed->entry = c->grammar->code_count;
    compile_rule_call(c, tree->start);
    if (tree->where)
        seed->where = compile_result(c, tree->where);
    for (uint32_t i = 0; slots[i].name; i++) {
        const MesoExpression *e = tree->place_arguments[i].expression;
        if (e && e->kind != MESO_EXPRESSION_CONSTANT)
            seed->places.values[i].index = compile_result(c, e);
    }
}

void meso_grammar_compile(MesoGrammarParser *parser)
{
    Compiler c = {.parser = parser, .grammar = parser->grammar};
    for (uint32_t i = 0; i < parser->grammar->rule_count && meso_parsing(parser); i++)
        compile_rule(&c, i);
    for (uint32_t i = 0; i < parser->grammar->seed_count && meso_parsing(parser); i++)
        compile_seed(&c, i);
    if (parser->grammar->register_count < parser->grammar->local_count)
        parser->grammar->register_count = parser->grammar->local_count;
    if (parser->grammar->register_count < MESO_GRAMMAR_ARGUMENTS)
        parser->grammar->register_count = MESO_GRAMMAR_ARGUMENTS;
}
