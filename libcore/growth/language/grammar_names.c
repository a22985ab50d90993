#include <stdio.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/base/nearest.h"
#include "libcore/growth/language/grammar_draw.h"
#include "libcore/growth/language/grammar_parser.h"

enum { DEEPEST = 64, LONGEST_NAME = 64, MOST_RULES = 1 << 14 };

void meso_parse_advance(MesoGrammarParser *parser)
{
    parser->token = parser->next;
    parser->next = meso_grammar_lexer_next(&parser->lexer);
}

bool meso_parse_at(const MesoGrammarParser *parser, const char *text)
{
    return meso_parsing(parser) && meso_token_is(&parser->token, text);
}

bool meso_parse_accept(MesoGrammarParser *parser, const char *text)
{
    if (!meso_parse_at(parser, text))
        return false;
    meso_parse_advance(parser);
    return true;
}

void meso_parse_expect(MesoGrammarParser *parser, const char *text, const char *where)
{
    char found[64];
    meso_token_text(&parser->token, found);
    if (!meso_parse_accept(parser, text))
        meso_grammar_wrong(&parser->lexer, &parser->token, "'%s' is wanted %s, instead of %s", text, where, found);
}

void *meso_parse_allocate(MesoGrammarParser *parser, size_t count, size_t size)
{
    void *memory = meso_parsing(parser) ? meso_arena_alloc(parser->arena, count, size, parser->lexer.error) : NULL;
    if (!memory && meso_parsing(parser)) {
        parser->lexer.status = MESO_ERR_MEMORY;
        parser->lexer.at = parser->lexer.end;
    }
    return memory;
}

const char *meso_parse_copy(MesoGrammarParser *parser, const MesoToken *token)
{
    char *text = meso_parse_allocate(parser, (size_t)token->length + 1, 1);
    return text ? memcpy(text, token->text, token->length) : "";
}

bool meso_parse_enter(MesoGrammarParser *parser)
{
    if (++parser->depth > DEEPEST)
        meso_grammar_wrong(&parser->lexer, &parser->token, "nested more than %d deep", (int)DEEPEST);
    return meso_parsing(parser);
}

static bool is_name(const MesoToken *token, const MesoToken *other)
{
    return token->length == other->length && memcmp(token->text, other->text, token->length) == 0;
}

const MesoNamed *meso_parse_find(const MesoGrammarParser *parser, const MesoToken *token)
{
    if (token->kind != MESO_TOKEN_NAME)
        return NULL;
    for (uint32_t i = parser->scope_count; i-- > 0;)
        if (is_name(&parser->locals[i].at, token))
            return &parser->locals[i];
    uint32_t number = meso_names_find(&parser->names, token->text, token->length);
    return number == MESO_NO_INDEX ? NULL : &parser->named[number];
}

MesoToken meso_parse_new_name(MesoGrammarParser *parser, const char *what)
{
    MesoToken token = parser->token;
    char found[64];
    meso_token_text(&token, found);
    const MesoNamed *known = meso_parse_find(parser, &token);
    if (token.kind != MESO_TOKEN_NAME)
        meso_grammar_wrong(&parser->lexer, &token, "the name of %s is wanted, instead of %s", what, found);
    else if (token.length > LONGEST_NAME)
        meso_grammar_wrong(&parser->lexer, &token, "the name is longer than %d letters", (int)LONGEST_NAME);
    else if (meso_grammar_is_reserved(token.text, token.length))
        meso_grammar_wrong(&parser->lexer, &token, "%s is a word of the language; choose another name", found);
    else if (known)
        meso_grammar_wrong(&parser->lexer, &token, "%s is a name already, at line %u", found, known->at.line);
    else
        meso_parse_advance(parser);
    return token;
}

void meso_parse_add_name(MesoGrammarParser *parser, const MesoToken *token, MesoNameKind kind, uint32_t index)
{
    if (!meso_parsing(parser) ||
        !MESO_PARSE_GROW(parser, parser->named, parser->named_count, parser->named_room))
        return;
    uint32_t number = meso_names_add(&parser->names, parser->arena, token->text, token->length, parser->named_count,
                                     parser->lexer.error);
    if (number == MESO_NO_INDEX) {
        parser->lexer.status = MESO_ERR_MEMORY;
        return;
    }
    parser->named[parser->named_count++] = (MesoNamed){kind, index, *token};
}

uint32_t meso_parse_add_local(MesoGrammarParser *parser, const MesoToken *token)
{
    enum { MOST_LOCALS = 96 };
    uint32_t local = parser->local_count;
    if (local == MOST_LOCALS)
        meso_grammar_wrong(&parser->lexer, &parser->token, "a rule can have %d names of its own at a time",
                           (int)MOST_LOCALS);
    if (!meso_parsing(parser))
        return 0;
    if (token && MESO_PARSE_GROW(parser, parser->locals, parser->scope_count, parser->scope_room))
        parser->locals[parser->scope_count++] = (MesoNamed){MESO_NAME_LOCAL, local, *token};
    parser->local_count++;
    if (parser->most_locals < parser->local_count)
        parser->most_locals = parser->local_count;
    return local;
}

static void try_named(MesoNearest *nearest, char *best, const MesoToken *name)
{
    char word[LONGEST_NAME + 1];
    snprintf(word, sizeof word, "%.*s", (int)name->length, name->text);
    const char *before = nearest->best;
    meso_nearest_try(nearest, word);
    if (nearest->best == word) {
        strcpy(best, word);
        nearest->best = best;
    } else
        nearest->best = before;
}

void meso_parse_unknown(MesoGrammarParser *parser, const MesoToken *token, const char *what, MesoNameKind kind,
                        const char *const *words)
{
    char found[64], best[LONGEST_NAME + 1], all[200] = "";
    MesoNearest nearest = meso_nearest(token->text, token->kind == MESO_TOKEN_NAME ? token->length : 0);
    meso_token_text(token, found);
    for (uint32_t i = 0; i < parser->named_count; i++)
        if (parser->named[i].kind == kind)
            try_named(&nearest, best, &parser->named[i].at);
    if (kind == MESO_NAME_LOCAL)
        for (uint32_t i = 0; i < parser->scope_count; i++)
            try_named(&nearest, best, &parser->locals[i].at);
    size_t used = 0;
    for (uint32_t i = 0; words && words[i]; i++) {
        meso_nearest_try(&nearest, words[i]);
        if (used < sizeof all)
            used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", words[i]);
    }
    if (token->kind != MESO_TOKEN_NAME)
        meso_grammar_wrong(&parser->lexer, token, "%s is wanted, instead of %s", what, found);
    else if (nearest.best)
        meso_grammar_wrong(&parser->lexer, token, "%s is not %s; did you mean '%s'?", found, what, nearest.best);
    else if (*all && used < sizeof all)
        meso_grammar_wrong(&parser->lexer, token, "%s is not %s; there are %s", found, what, all);
    else
        meso_grammar_wrong(&parser->lexer, token, "%s is not %s", found, what);
}

uint32_t meso_parse_rule_number(MesoGrammarParser *parser, const MesoToken *token)
{
    MesoGrammar *grammar = parser->grammar;
    const MesoNamed *known = meso_parse_find(parser, token);
    uint32_t count = grammar->rule_count;
    if (known && known->kind == MESO_NAME_RULE)
        return known->index;
    if (known)
        meso_grammar_wrong(&parser->lexer, token, "'%.*s' is no rule; it was named at line %u", (int)token->length,
                           token->text, known->at.line);
    else if (count == MOST_RULES)
        meso_grammar_wrong(&parser->lexer, token, "more than %d rules", (int)MOST_RULES);
    if (!meso_parsing(parser) || !MESO_PARSE_GROW(parser, grammar->rules, count, parser->rule_room) ||
        !MESO_PARSE_GROW(parser, parser->rules, count, parser->rule_tree_room))
        return 0;
    grammar->rules[count] = (MesoGrammarRule){.name = meso_parse_copy(parser, token)};
    parser->rules[count] = (MesoRuleTree){.at = *token};
    meso_parse_add_name(parser, token, MESO_NAME_RULE, count);
    return grammar->rule_count++;
}

uint32_t meso_parse_site(MesoGrammarParser *parser, bool child)
{
    MesoGrammar *grammar = parser->grammar;
    const MesoToken *owner = &parser->owner;
    uint64_t number = 0;
    enum { KIND_DRAW, KIND_CHILD, KIND_SEED };
    if (!meso_parsing(parser) || !MESO_PARSE_GROW(parser, grammar->sites, grammar->site_count, parser->site_room))
        return 0;
    if (parser->rule == MESO_NO_INDEX)
        number = parser->seed_draws++;
    else
        number = child ? parser->rules[parser->rule].children++ : parser->rules[parser->rule].draws++;
    uint64_t kind = parser->rule == MESO_NO_INDEX ? KIND_SEED : child ? KIND_CHILD : KIND_DRAW;
    grammar->sites[grammar->site_count] = meso_draw_site(owner->text, owner->length, kind, number);
    return grammar->site_count++;
}
