#include "libcore/growth/language/grammar_check.h"

#include <stdio.h>

#include "libcore/base/nearest.h"
#include "libcore/growth/language/grammar_parser.h"

static const MesoGrammarType number = {MESO_TYPE_NUMBER, 0, 0}, truth = {MESO_TYPE_TRUTH, 0, 0};
static const MesoGrammarType an_angle = {MESO_TYPE_NUMBER, 0, 1};

/* Rules whose arguments' types have changed since they were checked. */
typedef struct Checker {
    MesoGrammarParser *parser;
    uint32_t *waiting;          /* [waiting_count] */
    uint32_t waiting_count;
    const MesoGrammarType *types;       /* of the locals of what is being checked */
} Checker;

static void want(Checker *c, const MesoExpression *e, MesoGrammarType wanted, const char *what)
{
    if (e)
        meso_type_want(&c->parser->lexer, &e->at, meso_type_of(&c->parser->lexer, e, c->types), wanted, what);
}

static void want_arguments(Checker *c, const MesoGrammarSlot *slots, const MesoArgument *arguments)
{
    MesoGrammarLexer *lexer = &c->parser->lexer;
    for (uint32_t i = 0; slots[i].name; i++) {
        const MesoExpression *e = arguments[i].expression;
        if (slots[i].kind == MESO_SLOT_QUANTITY && e)
            meso_type_want_slot(lexer, &e->at, meso_type_of(lexer, e, c->types), &slots[i]);
    }
}

static void check_argument_count(Checker *c, const MesoStatement *call, const MesoRuleTree *rule)
{
    if (call->argument_count != rule->argument_count)
        meso_grammar_wrong(&c->parser->lexer, &call->at, "'%.*s' wants %u argument%s, and %u are given",
                           (int)rule->at.length, rule->at.text, rule->argument_count,
                           rule->argument_count == 1 ? "" : "s", call->argument_count);
}

/* The rule's arguments get the types that they are called with. */
static void check_call(Checker *c, const MesoStatement *call)
{
    MesoGrammarLexer *lexer = &c->parser->lexer;
    MesoRuleTree *rule = &c->parser->rules[call->rule];
    bool changed = !rule->reached;
    check_argument_count(c, call, rule);
    for (uint32_t i = 0; i < rule->argument_count && !lexer->status; i++) {
        const MesoExpression *e = call->arguments[i].expression;
        MesoGrammarType type = meso_type_of(lexer, e, c->types), before = rule->types[i];
        char is[64], was[64];
        if (!rule->reached)
            before.kind = rule->types[i].kind = MESO_TYPE_UNKNOWN;
        meso_grammar_type_text(type, is);
        meso_grammar_type_text(before, was);
        if (!meso_type_join(&rule->types[i], type))
            meso_grammar_wrong(lexer, &call->arguments[i].at, "argument %u of '%.*s' is %s here, and %s elsewhere", i + 1,
                               (int)rule->at.length, rule->at.text, is, was);
        changed |= rule->types[i].kind != before.kind;
    }
    rule->reached = true;
    if (changed && !rule->waiting) {
        rule->waiting = true;
        c->waiting[c->waiting_count++] = call->rule;
    }
}

static void check_command(Checker *c, const MesoStatement *command)
{
    want_arguments(c, command->command->slots, command->arguments);
    want(c, command->expression, truth, "'while'");
    want(c, command->retries, number, "the number of tries");
    want(c, command->retry_angle, an_angle, "the angle of 'retry'");
}

static void check_block(Checker *c, MesoGrammarType *types, const MesoBlock *block)
{
    for (const MesoStatement *s = block->first; s && meso_parsing(c->parser); s = s->next) {
        if (s->kind == MESO_STATEMENT_LET)
            types[s->local] = meso_type_of(&c->parser->lexer, s->expression, types);
        else if (s->kind == MESO_STATEMENT_IF)
            want(c, s->expression, truth, "the condition of 'if'");
        else if (s->kind == MESO_STATEMENT_REPEAT) {
            want(c, s->expression, number, "the number of turns");
            types[s->local] = number;
        } else if (s->kind == MESO_STATEMENT_COMMAND)
            check_command(c, s);
        else if (s->kind == MESO_STATEMENT_RULE)
            check_call(c, s);
        for (const MesoArm *arm = s->arms; arm; arm = arm->next) {
            want(c, arm->weight, number, "a weight");
            check_block(c, types, &arm->block);
        }
        check_block(c, types, &s->block);
        check_block(c, types, &s->otherwise);
    }
}

static void check_rule(Checker *c, const MesoRuleTree *rule)
{
    for (MesoProduction *p = rule->first; p && meso_parsing(c->parser); p = p->next) {
        if (!p->types)
            p->types = meso_parse_allocate(c->parser, p->local_count, sizeof *p->types);
        for (uint32_t i = 0; p->types && i < rule->argument_count; i++)
            p->types[i] = rule->types[i];
        c->types = p->types;
        want(c, p->condition, truth, "the condition of a rule");
        check_block(c, p->types, &p->block);
    }
}

static void check_seed(Checker *c, const MesoSeedTree *seed)
{
    c->types = NULL;
    want(c, seed->where, truth, "'where'");
    want_arguments(c, seed->places->slots, seed->place_arguments);
    check_call(c, seed->start);
}

static void refuse_unwritten(MesoGrammarParser *parser, const MesoRuleTree *rule)
{
    MesoNearest nearest = meso_nearest(rule->at.text, rule->at.length);
    for (uint32_t i = 0; i < parser->grammar->rule_count; i++)
        if (parser->rules[i].written)
            meso_nearest_try(&nearest, parser->grammar->rules[i].name);
    if (nearest.best)
        meso_grammar_wrong(&parser->lexer, &rule->at, "there is no rule '%.*s'; did you mean '%s'?",
                           (int)rule->at.length, rule->at.text, nearest.best);
    else
        meso_grammar_wrong(&parser->lexer, &rule->at, "there is no rule '%.*s'", (int)rule->at.length, rule->at.text);
}

void meso_grammar_check_types(MesoGrammarParser *parser)
{
    MesoGrammar *grammar = parser->grammar;
    Checker c = {.parser = parser};
    for (uint32_t i = 0; i < grammar->rule_count && meso_parsing(parser); i++)
        if (!parser->rules[i].written)
            refuse_unwritten(parser, &parser->rules[i]);
    c.waiting = meso_parse_allocate(parser, grammar->rule_count, sizeof *c.waiting);
    for (uint32_t i = 0; i < grammar->seed_count && meso_parsing(parser); i++)
        check_seed(&c, &parser->seeds[i]);
    while (c.waiting_count && meso_parsing(parser)) {
        MesoRuleTree *rule = &parser->rules[c.waiting[--c.waiting_count]];
        rule->waiting = false;
        check_rule(&c, rule);
    }
    for (uint32_t i = 0; i < grammar->rule_count && meso_parsing(parser); i++) {
        grammar->rules[i].argument_count = parser->rules[i].argument_count;
        grammar->rules[i].reached = parser->rules[i].reached;
    }
}
