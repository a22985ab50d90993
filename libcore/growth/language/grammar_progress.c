#include <stdio.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/growth/language/grammar_check.h"
#include "libcore/growth/language/grammar_parser.h"

/* What is certain behind a block: that no way leads there, or that all ways there have made a step. */
typedef struct Way {
    bool ends, moved;
} Way;

typedef struct Walk {
    MesoGrammarParser *parser;
    MesoRuleTree *rule;
} Walk;

static Way walk_block(Walk *walk, const MesoBlock *block, bool moved);

static Way either(Way a, Way b)
{
    return (Way){a.ends && b.ends, (a.ends || a.moved) && (b.ends || b.moved)};
}

static void add_call(Walk *walk, const MesoStatement *call)
{
    MesoGrammarParser *parser = walk->parser;
    MesoRuleTree *rule = walk->rule;
    uint32_t room = rule->call_room;
    if (!MESO_PARSE_GROW(parser, rule->calls, rule->call_count, rule->call_room) ||
        !MESO_PARSE_GROW(parser, rule->call_places, rule->call_count, room))
        return;
    rule->calls[rule->call_count] = call->rule;
    rule->call_places[rule->call_count++] = call;
}

/* A refused step without an else ends the branch. */
static Way walk_step(Walk *walk, const MesoStatement *step, bool moved)
{
    const MesoExpression *length = step->arguments[0].expression;
    bool moves = length->kind != MESO_EXPRESSION_CONSTANT || length->value > 0;
    Way accepted = {false, moved || moves}, refused = {true, moved};
    if (step->caught)
        refused = walk_block(walk, &step->otherwise, moved);
    return either(accepted, refused);
}

static Way walk_command(Walk *walk, const MesoStatement *command, bool moved)
{
    if (command->command->operation == MESO_OP_STEP)
        return walk_step(walk, command, moved);
    return (Way){command->command->operation == MESO_OP_END, moved};
}

static Way walk_choice(Walk *walk, const MesoStatement *choice, bool moved)
{
    Way way = walk_block(walk, &choice->arms->block, moved);
    for (const MesoArm *arm = choice->arms->next; arm; arm = arm->next)
        way = either(way, walk_block(walk, &arm->block, moved));
    return way;
}

static Way walk_repeat(Walk *walk, const MesoStatement *loop, bool moved)
{
    const MesoExpression *turns = loop->expression;
    Way body = walk_block(walk, &loop->block, moved);
    return turns->kind == MESO_EXPRESSION_CONSTANT && turns->value >= 1 ? body : either(body, (Way){false, moved});
}

static Way walk_statement(Walk *walk, const MesoStatement *s, bool moved)
{
    switch (s->kind) {
    case MESO_STATEMENT_IF: return either(walk_block(walk, &s->block, moved), walk_block(walk, &s->otherwise, moved));
    case MESO_STATEMENT_CHOOSE: return walk_choice(walk, s, moved);
    case MESO_STATEMENT_REPEAT: return walk_repeat(walk, s, moved);
    case MESO_STATEMENT_COMMAND: return walk_command(walk, s, moved);
    case MESO_STATEMENT_BRANCH: walk_block(walk, &s->block, moved); break;
    case MESO_STATEMENT_RULE:
        if (!moved)
            add_call(walk, s);
        return (Way){true, moved};
    case MESO_STATEMENT_LET: break;
    }
    return (Way){false, moved};
}

static Way walk_block(Walk *walk, const MesoBlock *block, bool moved)
{
    Way way = {false, moved};
    for (const MesoStatement *s = block->first; s && !way.ends && meso_parsing(walk->parser); s = s->next)
        way = walk_statement(walk, s, way.moved);
    return way;
}

/* Depth first; a rule that is met on the way down to itself closes a circle. */
enum { NEW, ON_THE_WAY, DONE };

typedef struct Circle {
    MesoGrammarParser *parser;
    uint32_t *way;              /* [count] rules on the way down */
    uint32_t *next;             /* [count] of their calls, which is looked at next */
    uint32_t count;
} Circle;

static void tell_circle(Circle *circle, uint32_t rule, const MesoStatement *call)
{
    const MesoGrammarRule *rules = circle->parser->grammar->rules;
    char text[200];
    size_t used = 0;
    uint32_t begin = circle->count;
    while (circle->way[--begin] != rule)
        continue;
    for (uint32_t i = begin; i < circle->count && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s -> ", rules[circle->way[i]].name);
    meso_grammar_wrong(&circle->parser->lexer, &call->at,
                       "'%s' comes back to itself without a step (%s%s); put a step before it, or use 'repeat'",
                       rules[rule].name, text, used < sizeof text ? rules[rule].name : "...");
}

static void find_circle(Circle *circle, uint32_t start)
{
    MesoRuleTree *rules = circle->parser->rules;
    circle->way[0] = start;
    circle->next[0] = 0;
    circle->count = 1;
    rules[start].state = ON_THE_WAY;
    while (circle->count && meso_parsing(circle->parser)) {
        MesoRuleTree *rule = &rules[circle->way[circle->count - 1]];
        uint32_t i = circle->next[circle->count - 1]++;
        if (i == rule->call_count) {
            rule->state = DONE;
            circle->count--;
            continue;
        }
        MesoRuleTree *called = &rules[rule->calls[i]];
        if (called->state == ON_THE_WAY)
            tell_circle(circle, rule->calls[i], rule->call_places[i]);
        if (called->state != NEW)
            continue;
        called->state = ON_THE_WAY;
        circle->way[circle->count] = rule->calls[i];
        circle->next[circle->count++] = 0;
    }
}

void meso_grammar_check_progress(MesoGrammarParser *parser)
{
    uint32_t count = parser->grammar->rule_count;
    Circle circle = {parser, meso_parse_allocate(parser, count, sizeof *circle.way),
                     meso_parse_allocate(parser, count, sizeof *circle.next), 0};
    for (uint32_t i = 0; i < count; i++) {
        Walk walk = {parser, &parser->rules[i]};
        for (const MesoProduction *p = parser->rules[i].first; p && meso_parsing(parser); p = p->next)
            walk_block(&walk, &p->block, false);
    }
    for (uint32_t i = 0; i < count && meso_parsing(parser); i++)
        if (parser->rules[i].state == NEW)
            find_circle(&circle, i);
}
