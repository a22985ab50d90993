#include "libcore/growth/language/grammar_parser.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "libcore/base/grow.h"

enum { MOST_DECLARATIONS = 1 << 12 };

static const MesoGrammarType number = {MESO_TYPE_NUMBER, 0, 0}, a_length = {MESO_TYPE_NUMBER, 1, 0};

static bool is_full(MesoGrammarParser *parser, uint32_t count, const char *what)
{
    if (count == MOST_DECLARATIONS)
        meso_grammar_wrong(&parser->lexer, &parser->token, "more than %d %s", (int)MOST_DECLARATIONS, what);
    return !meso_parsing(parser);
}

static void parse_unit(MesoGrammarParser *parser)
{
    static const char *const names[] = {"um", "mm", "cm", "dm", "m", "km", NULL};
    MesoToken at = parser->token;
    const MesoGrammarUnit *unit = at.kind == MESO_TOKEN_NAME ? meso_grammar_unit(at.text, at.length) : NULL;
    if (!unit || unit->type.length != 1 || unit->factor == 0)
        meso_parse_unknown(parser, &at, "a unit of the surface", MESO_NAME_NONE, names);
    else if (parser->length_seen)
        meso_grammar_wrong(&parser->lexer, &at, "the unit must stand before the first length");
    else
        parser->unit = unit->factor;
    meso_parse_advance(parser);
}

/* The last of the settings of a parameter, or NULL; all of them count as used. */
static const char *setting_of(MesoGrammarParser *parser, const MesoToken *name)
{
    const MesoGrammarOptions *options = parser->options;
    const char *found = NULL;
    for (uint32_t i = 0; options && i < options->setting_count; i++) {
        const char *text = options->settings[i].text;
        if (strncmp(text, name->text, name->length) == 0 && text[name->length] == '=') {
            parser->set[i] = true;
            found = text + name->length + 1;
        }
    }
    return found;
}

/* The value of "--set name=value", as a text of its own. */
static double parse_setting(MesoGrammarParser *parser, const MesoToken *name, const char *text, MesoGrammarType type)
{
    MesoGrammarLexer lexer = parser->lexer;
    MesoToken token = parser->token, next = parser->next;
    char path[80], found[64];
    snprintf(path, sizeof path, "--set %.*s", (int)name->length, name->text);
    meso_grammar_lexer_begin(&parser->lexer, path, text, strlen(text), lexer.error);
    parser->lexer.wrong = MESO_ERR_USAGE;
    meso_parse_advance(parser);
    meso_parse_advance(parser);
    double value = meso_parse_constant(parser, type, "the parameter");
    meso_token_text(&parser->token, found);
    if (parser->token.kind != MESO_TOKEN_END)
        meso_grammar_wrong(&parser->lexer, &parser->token, "nothing can follow the value; there is %s", found);
    lexer.status = parser->lexer.status;
    if (lexer.status)
        lexer.at = lexer.end;
    parser->lexer = lexer;
    parser->token = token;
    parser->next = next;
    return value;
}

static void parse_parameter(MesoGrammarParser *parser)
{
    MesoGrammar *grammar = parser->grammar;
    MesoToken name = meso_parse_new_name(parser, "a parameter");
    meso_parse_expect(parser, "=", "behind the name");
    MesoToken at = parser->token;
    const MesoExpression *e = meso_parse_expression(parser);
    const char *setting = meso_parsing(parser) ? setting_of(parser, &name) : NULL;
    if (e->kind != MESO_EXPRESSION_CONSTANT)
        meso_grammar_wrong(&parser->lexer, &at, "a parameter must not depend on the place or on chance");
    if (is_full(parser, grammar->parameter_count, "parameters"))
        return;
    /* 0 without a unit is a number: what is set need not be 0. */
    MesoGrammarParameter parameter = {meso_parse_copy(parser, &name), e->value,
                                      e->type.kind == MESO_TYPE_ZERO ? number : e->type};
    if (setting)
        parameter.value = parse_setting(parser, &name, setting, parameter.type);
    if (!meso_parsing(parser) ||
        !MESO_PARSE_GROW(parser, grammar->parameters, grammar->parameter_count, parser->parameter_room))
        return;
    grammar->parameters[grammar->parameter_count] = parameter;
    meso_parse_add_name(parser, &name, MESO_NAME_PARAMETER, grammar->parameter_count++);
}

/* Of a field: the source of one that has a name already. */
static bool parse_known_field(MesoGrammarParser *parser, MesoGrammarSource *source)
{
    const MesoNamed *known = meso_parse_find(parser, &parser->token);
    if (!known || known->kind != MESO_NAME_FIELD)
        return false;
    *source = parser->grammar->fields[known->index];
    meso_parse_advance(parser);
    return true;
}

static void parse_named_source(MesoGrammarParser *parser, MesoGrammarFamily family, MesoNameKind kind, const char *what,
                               MesoGrammarSource **list, uint32_t *count, uint32_t *room)
{
    MesoArgument arguments[MESO_GRAMMAR_ARGUMENTS];
    MesoGrammarSource source = {0};
    MesoToken name = meso_parse_new_name(parser, what);
    meso_parse_expect(parser, "=", "behind the name");
    char wanted[64];
    snprintf(wanted, sizeof wanted, "a source of %s", what);
    bool reversed = family == MESO_FAMILY_FIELD && meso_parse_accept(parser, "-");
    bool is_known = family == MESO_FAMILY_FIELD && parse_known_field(parser, &source);
    const MesoGrammarSourceWord *word = is_known ? NULL : meso_parse_source(parser, family, wanted, &source, arguments);
    if (!(word || is_known) || is_full(parser, *count, "declarations of one kind") ||
        !MESO_PARSE_GROW(parser, *list, *count, *room))
        return;
    source.name = meso_parse_copy(parser, &name);
    source.reversed = source.reversed != reversed;
    if (family == MESO_FAMILY_MAP) {
        if (!MESO_PARSE_GROW(parser, parser->map_words, *count, parser->map_word_room))
            return;
        parser->map_words[*count] = word;
    }
    (*list)[*count] = source;
    meso_parse_add_name(parser, &name, kind, (*count)++);
}

static void parse_limit(MesoGrammarParser *parser)
{
    static const char *const names[] = {"generations", "elements", "length", NULL};
    MesoGrammarLimits *limits = &parser->grammar->limits;
    double *const values[] = {&limits->generations, &limits->elements, &limits->length};
    MesoToken at = parser->token;
    for (uint32_t i = 0; names[i]; i++)
        if (meso_parse_accept(parser, names[i])) {
            MesoToken value = parser->token;
            *values[i] = meso_parse_constant(parser, i == 2 ? a_length : number, "the limit");
            if (!(*values[i] > 0))
                meso_grammar_wrong(&parser->lexer, &value, "a limit must be more than 0");
            return;
        }
    meso_parse_unknown(parser, &at, "a limit", MESO_NAME_NONE, names);
}

static void parse_seed_clauses(MesoGrammarParser *parser, MesoGrammarSeed *seed, MesoSeedTree *tree)
{
    while (meso_parsing(parser)) {
        MesoToken at = parser->token;
        if (meso_parse_accept(parser, "where")) {
            if (tree->where)
                meso_grammar_wrong(&parser->lexer, &at, "'where' is given twice; join them with 'and'");
            tree->where_at = parser->token;
            tree->where = meso_parse_expression(parser);
        } else if (meso_parse_accept(parser, "count")) {
            if (!isinf(seed->count))
                meso_grammar_wrong(&parser->lexer, &at, "'count' is given twice");
            seed->count = meso_parse_constant(parser, number, "'count'");
            if (!(seed->count > 0))
                meso_grammar_wrong(&parser->lexer, &at, "'count' must be more than 0");
        } else if (meso_parse_accept(parser, "face")) {
            if (seed->field != MESO_NO_INDEX)
                meso_grammar_wrong(&parser->lexer, &at, "'face' is given twice");
            seed->field = meso_parse_direction(parser);
        } else
            return;
    }
}

static void parse_seed(MesoGrammarParser *parser)
{
    MesoGrammar *grammar = parser->grammar;
    MesoGrammarSeed seed = {.entry = MESO_NO_INDEX, .where = MESO_NO_INDEX, .field = MESO_NO_INDEX, .count = INFINITY};
    MesoSeedTree tree = {0};
    if (is_full(parser, grammar->seed_count, "seeds"))
        return;
    if (parser->token.kind != MESO_TOKEN_NAME || meso_grammar_is_reserved(parser->token.text, parser->token.length)) {
        meso_parse_unknown(parser, &parser->token, "the name of a rule", MESO_NAME_RULE, NULL);
        return;
    }
    parser->owner = parser->token;
    seed.rule = meso_parse_rule_number(parser, &parser->token);
    if (!meso_parsing(parser))
        return;
    parser->seed_draws = parser->rules[seed.rule].seeds++ << 16;
    uint32_t site = meso_parse_site(parser, false);
    tree.start = meso_parse_rule_call(parser);
    meso_parse_expect(parser, "on", "before the places of seeds");
    tree.places = meso_parse_source(parser, MESO_FAMILY_SEEDS, "a kind of places", &seed.places, tree.place_arguments);
    parse_seed_clauses(parser, &seed, &tree);
    if (!meso_parsing(parser) || !MESO_PARSE_GROW(parser, grammar->seeds, grammar->seed_count, parser->seed_room) ||
        !MESO_PARSE_GROW(parser, parser->seeds, grammar->seed_count, parser->seed_tree_room))
        return;
    seed.site = grammar->sites[site];
    grammar->seeds[grammar->seed_count] = seed;
    parser->seeds[grammar->seed_count++] = tree;
}

static uint32_t parse_rule_parameters(MesoGrammarParser *parser)
{
    uint32_t count = 0;
    meso_parse_expect(parser, "(", "behind the name of a rule");
    bool more = !meso_parse_at(parser, ")");
    for (; more && meso_parsing(parser); count++) {
        if (count == MESO_GRAMMAR_ARGUMENTS)
            meso_grammar_wrong(&parser->lexer, &parser->token, "a rule has at most %d arguments",
                               (int)MESO_GRAMMAR_ARGUMENTS);
        MesoToken name = meso_parse_new_name(parser, "an argument");
        meso_parse_add_local(parser, &name);
        more = meso_parse_accept(parser, ",");
    }
    meso_parse_expect(parser, ")", "behind the arguments of a rule");
    return count;
}

/* A rule may be written several times: the first whose condition holds is taken. */
static void add_production(MesoGrammarParser *parser, uint32_t rule, MesoProduction *production, uint32_t arguments)
{
    MesoRuleTree *tree = &parser->rules[rule];
    const MesoToken *at = &production->at;
    if (tree->written && tree->argument_count != arguments)
        meso_grammar_wrong(&parser->lexer, at, "'%.*s' has %u argument%s at line %u, and %u here", (int)at->length,
                           at->text, tree->argument_count, tree->argument_count == 1 ? "" : "s", tree->first->at.line,
                           arguments);
    else if (tree->last && !tree->last->condition)
        meso_grammar_wrong(&parser->lexer, at, "never used: '%.*s' has no condition at line %u; put this one first",
                           (int)at->length, at->text, tree->last->at.line);
    if (!meso_parsing(parser))
        return;
    tree->argument_count = arguments;
    tree->written = true;
    if (tree->last)
        tree->last->next = production;
    else
        tree->first = production;
    tree->last = production;
}

static void parse_rule(MesoGrammarParser *parser)
{
    MesoProduction *production = meso_parse_allocate(parser, 1, sizeof *production);
    MesoToken name = parser->token;
    const MesoNamed *known = meso_parse_find(parser, &name);
    if (!production)
        return;
    if (known && known->kind == MESO_NAME_RULE)
        meso_parse_advance(parser);
    else
        meso_parse_new_name(parser, "a rule");
    if (!meso_parsing(parser))
        return;
    production->at = parser->owner = name;
    parser->rule = meso_parse_rule_number(parser, &name);
    parser->most_locals = parser->local_count = 0;
    uint32_t arguments = parse_rule_parameters(parser);
    if (meso_parse_accept(parser, ":"))
        production->condition = meso_parse_expression(parser);
    meso_parse_expect(parser, "->", "before what a rule becomes");
    production->block = meso_parse_body(parser);
    production->local_count = parser->most_locals;
    if (meso_parsing(parser))
        add_production(parser, parser->rule, production, arguments);
    parser->rule = MESO_NO_INDEX;
    parser->scope_count = parser->local_count = 0;
}

static void parse_map(MesoGrammarParser *p)
{
    parse_named_source(p, MESO_FAMILY_MAP, MESO_NAME_MAP, "a map", &p->grammar->maps, &p->grammar->map_count, &p->map_room);
}

static void parse_field(MesoGrammarParser *p)
{
    parse_named_source(p, MESO_FAMILY_FIELD, MESO_NAME_FIELD, "a field", &p->grammar->fields, &p->grammar->field_count,
                       &p->field_room);
}

static void parse_shape(MesoGrammarParser *p)
{
    parse_named_source(p, MESO_FAMILY_SHAPE, MESO_NAME_SHAPE, "a shape", &p->grammar->shapes, &p->grammar->shape_count,
                       &p->shape_room);
}

static void parse_declaration(MesoGrammarParser *parser)
{
    static void (*const parse[])(MesoGrammarParser *) = {parse_unit, parse_parameter, parse_map,  parse_field,
                                                         parse_shape, parse_limit,    parse_seed, parse_rule};
    static const char *const words[] = {"unit", "param", "map", "field", "shape", "limit", "seed", "rule", NULL};
    for (uint32_t i = 0; words[i]; i++)
        if (meso_parse_accept(parser, words[i])) {
            parse[i](parser);
            return;
        }
    meso_parse_unknown(parser, &parser->token, "a declaration", MESO_NAME_NONE, words);
}

/* "meso-grow 1" */
static void parse_heading(MesoGrammarParser *parser)
{
    MesoToken at = parser->token;
    bool right = meso_parse_accept(parser, "meso") && meso_parse_accept(parser, "-") && meso_parse_accept(parser, "grow");
    double version = parser->token.number;
    if (!right || parser->token.kind != MESO_TOKEN_NUMBER)
        meso_grammar_wrong(&parser->lexer, &at, "not a grammar: one begins with 'meso-grow %d'", MESO_GRAMMAR_VERSION);
    else if (version > MESO_GRAMMAR_VERSION)
        meso_grammar_wrong(&parser->lexer, &parser->token, "a grammar of version %g; this program knows %d", version,
                           MESO_GRAMMAR_VERSION);
    else if (version != MESO_GRAMMAR_VERSION)
        meso_grammar_wrong(&parser->lexer, &parser->token, "there is no version %g", version);
    meso_parse_advance(parser);
}

static void check_settings(MesoGrammarParser *parser)
{
    const MesoGrammarOptions *options = parser->options;
    for (uint32_t i = 0; options && i < options->setting_count && meso_parsing(parser); i++) {
        const char *text = options->settings[i].text;
        MesoToken token = {.kind = MESO_TOKEN_NAME, .text = text, .length = (uint32_t)strcspn(text, "="), .line = 1,
                           .column = 1};
        if (parser->set[i])
            continue;
        parser->lexer.wrong = MESO_ERR_USAGE;
        parser->lexer.path = "--set";
        if (text[token.length] != '=')
            meso_grammar_wrong(&parser->lexer, &token, "'name=value' is wanted, instead of '%.40s'", text);
        else
            meso_parse_unknown(parser, &token, "a parameter", MESO_NAME_PARAMETER, NULL);
    }
}

void meso_parse_grammar(MesoGrammarParser *parser, const char *text, size_t size)
{
    MesoGrammar *grammar = parser->grammar;
    MesoToken begin = {.line = 1, .column = 1};
    parser->unit = 1;
    parser->rule = MESO_NO_INDEX;
    parser->salt = MESO_NO_REGISTER;
    parser->nothing = (MesoExpression){.kind = MESO_EXPRESSION_CONSTANT};
    grammar->limits = (MesoGrammarLimits){INFINITY, INFINITY, INFINITY};
    parser->set = meso_parse_allocate(parser, parser->options ? parser->options->setting_count : 0, sizeof *parser->set);
    if (size > MESO_GRAMMAR_TEXT)
        meso_grammar_wrong(&parser->lexer, &begin, "longer than %d bytes", (int)MESO_GRAMMAR_TEXT);
    else if (size && memchr(text, '\0', size))
        meso_grammar_wrong(&parser->lexer, &begin, "not a text: it holds a zero byte");
    meso_parse_advance(parser);
    meso_parse_advance(parser);
    parse_heading(parser);
    while (meso_parsing(parser) && parser->token.kind != MESO_TOKEN_END)
        parse_declaration(parser);
    check_settings(parser);
    if (meso_parsing(parser) && grammar->seed_count == 0)
        meso_grammar_wrong(&parser->lexer, &parser->token, "nothing grows without a 'seed'");
}
