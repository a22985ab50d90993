#include <stdio.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/growth/language/grammar_parser.h"

enum { MOST_SOURCES = 1 << 12 };

static void parse_choice(MesoGrammarParser *parser, const MesoGrammarSlot *slot, MesoArgument *argument)
{
    for (uint32_t i = 0; slot->words[i]; i++)
        if (meso_parse_accept(parser, slot->words[i])) {
            argument->index = i;
            return;
        }
    char what[64];
    snprintf(what, sizeof what, "a %s", slot->name);
    meso_parse_unknown(parser, &parser->token, what, MESO_NAME_LOCAL, slot->words);
}

static void parse_reference(MesoGrammarParser *parser, MesoNameKind kind, const char *what, MesoArgument *argument)
{
    const MesoNamed *named = meso_parse_find(parser, &parser->token);
    if (named && named->kind == kind) {
        argument->index = named->index;
        meso_parse_advance(parser);
    } else
        meso_parse_unknown(parser, &parser->token, what, kind, NULL);
}

static void parse_text(MesoGrammarParser *parser, const MesoGrammarSlot *slot, MesoArgument *argument)
{
    const MesoToken *token = &parser->token;
    char found[64];
    meso_token_text(token, found);
    if (token->kind != MESO_TOKEN_TEXT)
        meso_grammar_wrong(&parser->lexer, token, "'%s' must be a text in quotation marks, instead of %s", slot->name,
                           found);
    else if (token->length == 0)
        meso_grammar_wrong(&parser->lexer, token, "'%s' must not be empty", slot->name);
    argument->text = meso_parse_copy(parser, token);
    meso_parse_advance(parser);
}

static void parse_argument(MesoGrammarParser *parser, const MesoGrammarSlot *slot, MesoArgument *argument)
{
    *argument = (MesoArgument){.at = parser->token, .given = true, .index = MESO_NO_INDEX};
    switch (slot->kind) {
    case MESO_SLOT_QUANTITY: argument->expression = meso_parse_expression(parser); break;
    case MESO_SLOT_TEXT: parse_text(parser, slot, argument); break;
    case MESO_SLOT_WORD: parse_choice(parser, slot, argument); break;
    case MESO_SLOT_MAP: parse_reference(parser, MESO_NAME_MAP, "a map", argument); break;
    case MESO_SLOT_SHAPE: parse_reference(parser, MESO_NAME_SHAPE, "a shape", argument); break;
    case MESO_SLOT_FIELD: argument->index = meso_parse_direction(parser); break;
    }
}

/* The slot that "name:" means. */
static uint32_t named_slot(MesoGrammarParser *parser, const MesoToken *of, const MesoGrammarSlot *slots)
{
    const char *words[MESO_GRAMMAR_ARGUMENTS + 1] = {0};
    char what[96];
    uint32_t i = 0;
    for (; slots[i].name && !meso_token_is(&parser->token, slots[i].name); i++)
        words[i] = slots[i].name;
    snprintf(what, sizeof what, "an argument of '%.*s'", (int)(of->length < 40 ? of->length : 40), of->text);
    if (!slots[i].name)
        meso_parse_unknown(parser, &parser->token, what, MESO_NAME_NONE, words);
    meso_parse_advance(parser);
    meso_parse_advance(parser);
    return i;
}

static void check_required(MesoGrammarParser *parser, const MesoToken *of, const MesoGrammarSlot *slots,
                           const MesoArgument *arguments)
{
    for (uint32_t i = 0; slots[i].name; i++)
        if (slots[i].required && !arguments[i].given)
            meso_grammar_wrong(&parser->lexer, of, "'%.*s' wants its '%s'", (int)(of->length < 40 ? of->length : 40),
                               of->text, slots[i].name);
}

void meso_parse_arguments(MesoGrammarParser *parser, const MesoToken *of, const MesoGrammarSlot *slots,
                          MesoArgument *arguments)
{
    int of_length = (int)(of->length < 40 ? of->length : 40);
    bool named = false;
    for (uint32_t i = 0; slots[i].name; i++)
        arguments[i] = (MesoArgument){.at = *of, .index = MESO_NO_INDEX};
    if (meso_parse_accept(parser, "(") && !meso_parse_accept(parser, ")")) {
        uint32_t place = 0;
        do {
            MesoToken at = parser->token;
            if (at.kind == MESO_TOKEN_NAME && meso_token_is(&parser->next, ":")) {
                place = named_slot(parser, of, slots);
                named = true;
            } else if (named)
                meso_grammar_wrong(&parser->lexer, &at, "an argument without a name cannot follow one with a name");
            else if (!slots[place].name)
                meso_grammar_wrong(&parser->lexer, &at, "'%.*s' has no argument more", of_length, of->text);
            if (!meso_parsing(parser))
                return;
            if (arguments[place].given)
                meso_grammar_wrong(&parser->lexer, &at, "'%s' is given twice", slots[place].name);
            parse_argument(parser, &slots[place], &arguments[place]);
            place++;
        } while (meso_parse_accept(parser, ","));
        meso_parse_expect(parser, ")", "behind the arguments");
    }
    check_required(parser, of, slots, arguments);
}

/* Seeds' numbers may depend on the place where they are looked at: they become code. */
static MesoGrammarValue finish_value(MesoGrammarParser *parser, MesoGrammarFamily family, const MesoGrammarSlot *slot,
                                     const MesoArgument *argument)
{
    const MesoExpression *e = argument->expression;
    MesoGrammarValue value = {argument->given, slot->fallback, argument->text, argument->index};
    if (slot->kind == MESO_SLOT_WORD && !argument->given)
        value.index = 0;
    if (!e || !meso_parsing(parser))
        return value;
    if (e->kind == MESO_EXPRESSION_CONSTANT) {
        meso_type_want_slot(&parser->lexer, &argument->at, e->type, slot);
        value.number = e->value;
    } else if (family != MESO_FAMILY_SEEDS)
        meso_grammar_wrong(&parser->lexer, &argument->at, "'%s' must not depend on the place or on chance", slot->name);
    return value;
}

const MesoGrammarSourceWord *meso_parse_source(MesoGrammarParser *parser, MesoGrammarFamily family, const char *what,
                                               MesoGrammarSource *source, MesoArgument *arguments)
{
    const char *words[32] = {0};
    uint32_t count = 0;
    MesoToken at = parser->token;
    const MesoGrammarSourceWord *word = at.kind == MESO_TOKEN_NAME ? meso_grammar_source(family, at.text, at.length) : NULL;
    for (uint32_t i = 0; meso_grammar_sources[i].name; i++)
        if (meso_grammar_sources[i].family == family)
            words[count++] = meso_grammar_sources[i].name;
    if (!word) {
        meso_parse_unknown(parser, &at, what, family == MESO_FAMILY_FIELD ? MESO_NAME_FIELD : MESO_NAME_NONE, words);
        return NULL;
    }
    meso_parse_advance(parser);
    meso_parse_arguments(parser, &at, word->slots, arguments);
    *source = (MesoGrammarSource){.kind = word->kind, .line = at.line};
    for (uint32_t i = 0; word->slots[i].name; i++)
        source->values[i] = finish_value(parser, family, &word->slots[i], &arguments[i]);
    return meso_parsing(parser) ? word : NULL;
}

static uint32_t add_field(MesoGrammarParser *parser, const MesoGrammarSource *field)
{
    MesoGrammar *grammar = parser->grammar;
    if (grammar->field_count == MOST_SOURCES)
        meso_grammar_wrong(&parser->lexer, &parser->token, "more than %d directions", (int)MOST_SOURCES);
    if (!meso_parsing(parser) || !MESO_PARSE_GROW(parser, grammar->fields, grammar->field_count, parser->field_room))
        return 0;
    grammar->fields[grammar->field_count] = *field;
    return grammar->field_count++;
}

uint32_t meso_parse_direction(MesoGrammarParser *parser)
{
    bool reversed = meso_parse_accept(parser, "-");
    const MesoNamed *named = meso_parse_find(parser, &parser->token);
    MesoArgument arguments[MESO_GRAMMAR_ARGUMENTS];
    MesoGrammarSource field = {0};
    if (!named || named->kind != MESO_NAME_FIELD) {
        meso_parse_source(parser, MESO_FAMILY_FIELD, "a direction", &field, arguments);
        field.reversed = reversed;
        return add_field(parser, &field);
    }
    meso_parse_advance(parser);
    if (!reversed)
        return named->index;
    field = parser->grammar->fields[named->index];
    field.reversed = !field.reversed;
    return add_field(parser, &field);
}
