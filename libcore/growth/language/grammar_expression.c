#include <math.h>
#include <string.h>

#include "libcore/growth/language/grammar_parser.h"
#include "libcore/growth/language/grammar_run.h"

enum { DEEPEST_TREE = 200 };

static MesoExpression *new_expression(MesoGrammarParser *parser, MesoExpression value)
{
    MesoExpression *e = meso_parse_allocate(parser, 1, sizeof *e);
    if (!e)
        return &parser->nothing;
    *e = value;
    return e;
}

static MesoExpression *constant(MesoGrammarParser *parser, const MesoToken *at, MesoGrammarType type, double value)
{
    return new_expression(parser, (MesoExpression){.kind = MESO_EXPRESSION_CONSTANT, .at = *at, .type = type,
                                                   .value = value, .index = MESO_NO_INDEX, .salt = MESO_NO_REGISTER});
}

static bool is_draw(uint16_t operation)
{
    return operation == MESO_OP_RANDOM || operation == MESO_OP_NORMAL || operation == MESO_OP_CHANCE;
}

static bool is_constant(const MesoExpression *call)
{
    for (uint32_t i = 0; i < call->argument_count; i++)
        if (call->arguments[i]->kind != MESO_EXPRESSION_CONSTANT)
            return false;
    return !is_draw(call->operation) && call->operation != MESO_OP_LOOK;
}

static double fold(const MesoExpression *call)
{
    double x[3] = {0};
    for (uint32_t i = 0; i < call->argument_count; i++)
        x[i] = call->arguments[i]->value;
    if (call->operation == MESO_OP_AND)
        return x[0] != 0 && x[1] != 0;
    if (call->operation == MESO_OP_OR)
        return x[0] != 0 || x[1] != 0;
    return meso_grammar_apply(call->operation, x[0], x[1], x[2]);
}

/* The call as a node of the tree, or as a constant where it is one. */
static MesoExpression *finish_call(MesoGrammarParser *parser, MesoExpression *call)
{
    char text[64];
    for (uint32_t i = 0; i < call->argument_count; i++)
        if (call->depth <= call->arguments[i]->depth)
            call->depth = call->arguments[i]->depth + 1;
    meso_token_text(&call->at, text);
    if (call->depth > DEEPEST_TREE)
        meso_grammar_wrong(&parser->lexer, &call->at, "an expression of more than %d operations on one another",
                           (int)DEEPEST_TREE);
    if (!meso_parsing(parser))
        return &parser->nothing;
    if (is_draw(call->operation)) {
        call->index = meso_parse_site(parser, false);
        call->salt = parser->salt;
    }
    if (!is_constant(call))
        return new_expression(parser, *call);
    MesoGrammarType type = meso_type_of(&parser->lexer, call, NULL);
    double value = fold(call);
    if (!isfinite(value))
        meso_grammar_wrong(&parser->lexer, &call->at, "%s gives no finite number here", text);
    return constant(parser, &call->at, type, value);
}

static MesoExpression *operation(MesoGrammarParser *parser, const MesoToken *at, uint16_t code, MesoGrammarTyping typing,
                                 MesoExpression *a, MesoExpression *b)
{
    MesoExpression call = {.kind = MESO_EXPRESSION_CALL, .at = *at, .typing = typing, .operation = code,
                           .index = MESO_NO_INDEX, .argument_count = b ? 2 : 1, .arguments = {a, b}};
    return finish_call(parser, &call);
}

/* A name behind a number that nothing else may begin with is a unit that there is not. */
static bool must_be_unit(const MesoGrammarParser *parser)
{
    const MesoToken *token = &parser->token;
    return token->kind == MESO_TOKEN_NAME && !meso_token_is(&parser->next, "(") &&
           !meso_grammar_is_reserved(token->text, token->length) && !meso_parse_find(parser, token);
}

static MesoExpression *parse_number(MesoGrammarParser *parser)
{
    static const char *const names[] = {"um", "mm", "cm", "dm", "m", "km", "extent", "rad", "deg", "%", NULL};
    MesoToken number = parser->token;
    MesoGrammarType type = {number.number == 0 ? MESO_TYPE_ZERO : MESO_TYPE_NUMBER, 0, 0};
    double value = number.number;
    meso_parse_advance(parser);
    const MesoGrammarUnit *unit = parser->token.kind == MESO_TOKEN_TEXT
                                      ? NULL : meso_grammar_unit(parser->token.text, parser->token.length);
    if (unit && meso_parsing(parser)) {
        double extent = parser->options ? parser->options->extent : 0;
        bool length = unit->type.length == 1;
        if (unit->factor == 0 && !(extent > 0))
            meso_grammar_wrong(&parser->lexer, &parser->token, "the surface's extent is not known here");
        parser->length_seen |= length;
        value *= unit->factor == 0 ? extent : length ? unit->factor / parser->unit : unit->factor;
        type = unit->type;
        if (!isfinite(value))
            meso_grammar_wrong(&parser->lexer, &number, "the number is too large");
        meso_parse_advance(parser);
    } else if (must_be_unit(parser))
        meso_parse_unknown(parser, &parser->token, "a unit", MESO_NAME_LOCAL, names);
    return constant(parser, &number, type, value);
}

static void parse_map_argument(MesoGrammarParser *parser, MesoExpression *call)
{
    const MesoNamed *named = meso_parse_find(parser, &parser->token);
    if (!named || named->kind != MESO_NAME_MAP) {
        meso_parse_unknown(parser, &parser->token, "a map", MESO_NAME_MAP, NULL);
        return;
    }
    call->index = named->index;
    call->type = parser->map_words[named->index]->type;
    meso_parse_advance(parser);
}

static MesoExpression *parse_call(MesoGrammarParser *parser, const MesoGrammarFunction *function)
{
    MesoExpression call = {.kind = MESO_EXPRESSION_CALL, .at = parser->token, .typing = function->typing,
                           .operation = function->operation, .look = function->look, .of_map = function->of_map,
                           .index = MESO_NO_INDEX, .salt = MESO_NO_REGISTER};
    uint32_t count = 0;
    meso_parse_advance(parser);
    meso_parse_expect(parser, "(", "behind a function's name");
    if (function->of_map)
        parse_map_argument(parser, &call);
    bool more = function->of_map ? meso_parse_accept(parser, ",") : !meso_parse_at(parser, ")");
    while (more && meso_parsing(parser)) {
        if (count == function->most) {
            meso_grammar_wrong(&parser->lexer, &parser->token, "'%s' has no argument more", function->name);
            break;
        }
        call.arguments[count++] = meso_parse_expression(parser);
        more = meso_parse_accept(parser, ",");
    }
    if (count < function->least)
        meso_grammar_wrong(&parser->lexer, &parser->token, "'%s' wants %u argument%s%s", function->name,
                           function->least, function->least == 1 ? "" : "s", function->of_map ? " behind the map" : "");
    meso_parse_expect(parser, ")", "behind a function's arguments");
    call.argument_count = (uint8_t)count;
    return finish_call(parser, &call);
}

static MesoExpression *parse_named(MesoGrammarParser *parser, const MesoNamed *named)
{
    MesoExpression e = {.at = parser->token, .index = named->index, .salt = MESO_NO_REGISTER};
    const char *const kinds[] = {[MESO_NAME_FIELD] = "a field", [MESO_NAME_SHAPE] = "a shape", [MESO_NAME_RULE] = "a rule"};
    switch (named->kind) {
    case MESO_NAME_LOCAL:
        e.kind = MESO_EXPRESSION_LOCAL;
        break;
    case MESO_NAME_PARAMETER:
        e.kind = MESO_EXPRESSION_CONSTANT;
        e.type = parser->grammar->parameters[named->index].type;
        e.value = parser->grammar->parameters[named->index].value;
        break;
    case MESO_NAME_MAP:
        e.kind = MESO_EXPRESSION_MAP;
        e.operation = MESO_OP_LOOK;
        e.look = MESO_LOOK_MAP;
        e.type = parser->map_words[named->index]->type;
        break;
    default:
        meso_grammar_wrong(&parser->lexer, &parser->token, "'%.*s' is %s; a quantity is wanted", (int)e.at.length,
                           e.at.text, kinds[named->kind]);
    }
    meso_parse_advance(parser);
    return new_expression(parser, e);
}

static void unknown_quantity(MesoGrammarParser *parser)
{
    const char *words[128] = {0};
    uint32_t count = 0;
    for (uint32_t i = 0; meso_grammar_functions[i].name && count < 100; i++)
        words[count++] = meso_grammar_functions[i].name;
    for (uint32_t i = 0; meso_grammar_quantities[i].name && count < 120; i++)
        words[count++] = meso_grammar_quantities[i].name;
    for (uint32_t i = 0; i < parser->named_count; i++) {
        const MesoNamed *named = &parser->named[i];
        if (named->kind == MESO_NAME_MAP && count < 126)
            words[count++] = parser->grammar->maps[named->index].name;
        if (named->kind == MESO_NAME_PARAMETER && count < 126)
            words[count++] = parser->grammar->parameters[named->index].name;
    }
    meso_parse_unknown(parser, &parser->token, "a known quantity", MESO_NAME_LOCAL, words);
}

static MesoExpression *parse_word(MesoGrammarParser *parser)
{
    MesoToken at = parser->token;
    const MesoGrammarFunction *function = meso_grammar_function(at.text, at.length);
    const MesoGrammarQuantity *quantity = meso_grammar_quantity(at.text, at.length);
    const MesoNamed *named = meso_parse_find(parser, &at);
    if (function)
        return parse_call(parser, function);
    if (quantity) {
        meso_parse_advance(parser);
        return new_expression(parser, (MesoExpression){.kind = MESO_EXPRESSION_QUANTITY, .at = at, .type = quantity->type,
                                                       .operation = quantity->operation, .look = quantity->index,
                                                       .index = MESO_NO_INDEX});
    }
    if (meso_token_is(&at, "true") || meso_token_is(&at, "false")) {
        meso_parse_advance(parser);
        return constant(parser, &at, (MesoGrammarType){MESO_TYPE_TRUTH, 0, 0}, meso_token_is(&at, "true"));
    }
    if (named)
        return parse_named(parser, named);
    unknown_quantity(parser);
    return &parser->nothing;
}

static MesoExpression *parse_primary(MesoGrammarParser *parser)
{
    MesoExpression *e = &parser->nothing;
    char found[64];
    if (!meso_parse_enter(parser))
        return e;
    meso_token_text(&parser->token, found);
    if (parser->token.kind == MESO_TOKEN_NUMBER)
        e = parse_number(parser);
    else if (parser->token.kind == MESO_TOKEN_NAME)
        e = parse_word(parser);
    else if (meso_parse_accept(parser, "(")) {
        e = meso_parse_expression(parser);
        meso_parse_expect(parser, ")", "at the end of the parentheses");
    } else
        meso_grammar_wrong(&parser->lexer, &parser->token, "a quantity is wanted, instead of %s", found);
    parser->depth--;
    return e;
}

static MesoExpression *parse_unary(MesoGrammarParser *parser)
{
    MesoToken at = parser->token;
    if (!meso_parse_accept(parser, "-"))
        return parse_primary(parser);
    if (!meso_parse_enter(parser))
        return &parser->nothing;
    MesoExpression *e = operation(parser, &at, MESO_OP_NEGATE, MESO_TYPING_SAME, parse_unary(parser), NULL);
    parser->depth--;
    return e;
}

typedef struct Operator {
    const char *sign;
    uint16_t operation;
    MesoGrammarTyping typing;
    bool swapped;               /* a > b is b < a */
} Operator;

static const Operator products[] = {{"*", MESO_OP_MULTIPLY, MESO_TYPING_PRODUCT, false},
                                    {"/", MESO_OP_DIVIDE, MESO_TYPING_QUOTIENT, false}, {NULL, 0, 0, false}};
static const Operator sums[] = {{"+", MESO_OP_ADD, MESO_TYPING_SAME, false},
                                {"-", MESO_OP_SUBTRACT, MESO_TYPING_SAME, false}, {NULL, 0, 0, false}};
static const Operator comparisons[] = {{"<", MESO_OP_LESS, MESO_TYPING_COMPARE, false},
                                       {">", MESO_OP_LESS, MESO_TYPING_COMPARE, true},
                                       {"<=", MESO_OP_LESS_EQUAL, MESO_TYPING_COMPARE, false},
                                       {">=", MESO_OP_LESS_EQUAL, MESO_TYPING_COMPARE, true},
                                       {"==", MESO_OP_EQUAL, MESO_TYPING_COMPARE, false},
                                       {"!=", MESO_OP_NOT_EQUAL, MESO_TYPING_COMPARE, false}, {NULL, 0, 0, false}};
static const Operator both[] = {{"and", MESO_OP_AND, MESO_TYPING_TRUTH, false}, {NULL, 0, 0, false}};
static const Operator either[] = {{"or", MESO_OP_OR, MESO_TYPING_TRUTH, false}, {NULL, 0, 0, false}};

static const Operator *operator_at(const MesoGrammarParser *parser, const Operator *list)
{
    for (; list->sign; list++)
        if (meso_parse_at(parser, list->sign))
            return list;
    return NULL;
}

/* a op b op c ..., where `part` reads what binds more closely. */
static MesoExpression *parse_chain(MesoGrammarParser *parser, const Operator *list, bool once,
                                   MesoExpression *(*part)(MesoGrammarParser *parser))
{
    MesoExpression *a = part(parser);
    for (const Operator *found; (found = operator_at(parser, list)) != NULL;) {
        MesoToken at = parser->token;
        meso_parse_advance(parser);
        MesoExpression *b = part(parser);
        a = operation(parser, &at, found->operation, found->typing, found->swapped ? b : a, found->swapped ? a : b);
        if (once && operator_at(parser, list))
            meso_grammar_wrong(&parser->lexer, &parser->token, "comparisons do not chain; join two with 'and'");
    }
    return a;
}

static MesoExpression *parse_product(MesoGrammarParser *parser) { return parse_chain(parser, products, false, parse_unary); }
static MesoExpression *parse_sum(MesoGrammarParser *parser) { return parse_chain(parser, sums, false, parse_product); }
static MesoExpression *parse_comparison(MesoGrammarParser *parser) { return parse_chain(parser, comparisons, true, parse_sum); }

static MesoExpression *parse_not(MesoGrammarParser *parser)
{
    MesoToken at = parser->token;
    if (!meso_parse_accept(parser, "not"))
        return parse_comparison(parser);
    if (!meso_parse_enter(parser))
        return &parser->nothing;
    MesoExpression *e = operation(parser, &at, MESO_OP_NOT, MESO_TYPING_TRUTH, parse_not(parser), NULL);
    parser->depth--;
    return e;
}

static MesoExpression *parse_both(MesoGrammarParser *parser) { return parse_chain(parser, both, false, parse_not); }

MesoExpression *meso_parse_expression(MesoGrammarParser *parser)
{
    MesoExpression *e = meso_parse_enter(parser) ? parse_chain(parser, either, false, parse_both) : &parser->nothing;
    parser->depth--;
    return meso_parsing(parser) ? e : &parser->nothing;
}

double meso_parse_constant(MesoGrammarParser *parser, MesoGrammarType wanted, const char *what)
{
    MesoToken at = parser->token;
    const MesoExpression *e = meso_parse_expression(parser);
    if (!meso_parsing(parser))
        return 0;
    if (e->kind != MESO_EXPRESSION_CONSTANT)
        meso_grammar_wrong(&parser->lexer, &at, "%s must not depend on the place or on chance", what);
    else
        meso_type_want(&parser->lexer, &at, e->type, wanted, what);
    return e->value;
}
