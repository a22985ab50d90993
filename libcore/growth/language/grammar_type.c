#include "libcore/growth/language/grammar_type.h"

#include <stdio.h>

enum { MOST_POWER = 12 };

static const MesoGrammarType number = {MESO_TYPE_NUMBER, 0, 0}, truth = {MESO_TYPE_TRUTH, 0, 0};
static const MesoGrammarType a_length = {MESO_TYPE_NUMBER, 1, 0}, an_angle = {MESO_TYPE_NUMBER, 0, 1};

static bool is_same(MesoGrammarType a, MesoGrammarType b)
{
    return a.kind == b.kind && a.length == b.length && a.angle == b.angle;
}

static void power_text(char *text, size_t size, const char *name, int power)
{
    if (power == 0)
        *text = '\0';
    else if (power == 1)
        snprintf(text, size, " %s", name);
    else
        snprintf(text, size, " %s^%d", name, power);
}

void meso_grammar_type_text(MesoGrammarType type, char text[64])
{
    char length[24], angle[24];
    power_text(length, sizeof length, "length", type.length);
    power_text(angle, sizeof angle, "angle", type.angle);
    if (type.kind == MESO_TYPE_TRUTH)
        snprintf(text, 64, "a condition");
    else if (type.kind != MESO_TYPE_NUMBER || is_same(type, number))
        snprintf(text, 64, "a number");
    else if (is_same(type, an_angle))
        snprintf(text, 64, "an angle");
    else if (is_same(type, a_length))
        snprintf(text, 64, "a length");
    else
        snprintf(text, 64, "a quantity in%s%s", length, angle);
}

bool meso_type_join(MesoGrammarType *type, MesoGrammarType other)
{
    if (type->kind == MESO_TYPE_UNKNOWN || (type->kind == MESO_TYPE_ZERO && other.kind == MESO_TYPE_NUMBER))
        *type = other;
    if (other.kind == MESO_TYPE_UNKNOWN || (other.kind == MESO_TYPE_ZERO && type->kind == MESO_TYPE_NUMBER))
        return true;
    return is_same(*type, other);
}

/* How a user would write what is wanted. */
static const char *example(MesoGrammarType wanted)
{
    return wanted.kind == MESO_TYPE_TRUTH ? ", such as 'w > 1 mm'"
           : is_same(wanted, a_length)    ? ", such as '3 mm'"
           : is_same(wanted, an_angle)    ? ", such as '30 deg'"
                                          : "";
}

void meso_type_want(MesoGrammarLexer *lexer, const MesoToken *at, MesoGrammarType type, MesoGrammarType wanted,
                    const char *what)
{
    char is[64], must[64];
    meso_grammar_type_text(type, is);
    meso_grammar_type_text(wanted, must);
    if (!meso_type_join(&type, wanted))
        meso_grammar_wrong(lexer, at, "%s must be %s%s; this is %s", what, must, example(wanted), is);
}

void meso_type_want_slot(MesoGrammarLexer *lexer, const MesoToken *at, MesoGrammarType type,
                         const MesoGrammarSlot *slot)
{
    char what[64];
    snprintf(what, sizeof what, "'%s'", slot->name);
    meso_type_want(lexer, at, type, slot->type, what);
}

typedef struct Typing {
    MesoGrammarLexer *lexer;
    const MesoExpression *call;
    const char *name;           /* of the call, in quotation marks */
} Typing;

static void want(const Typing *t, MesoGrammarType type, MesoGrammarType wanted)
{
    meso_type_want(t->lexer, &t->call->at, type, wanted, t->name);
}

/* Those that an operation takes as one. */
static MesoGrammarType join(const Typing *t, const MesoGrammarType *types, uint32_t count)
{
    MesoGrammarType all = types[0];
    char a[64], b[64];
    for (uint32_t i = 0; i < count; i++) {
        meso_grammar_type_text(all, a);
        meso_grammar_type_text(types[i], b);
        if (types[i].kind == MESO_TYPE_TRUTH)
            meso_grammar_wrong(t->lexer, &t->call->at, "%s is for numbers; a condition stands there", t->name);
        else if (!meso_type_join(&all, types[i]))
            meso_grammar_wrong(t->lexer, &t->call->at, "%s of %s and %s: they must be of one kind", t->name, a, b);
    }
    return all;
}

/* a * b^sign */
static MesoGrammarType product(const Typing *t, const MesoGrammarType types[2], int sign)
{
    int length = types[0].length + sign * types[1].length, angle = types[0].angle + sign * types[1].angle;
    if (types[0].kind == MESO_TYPE_TRUTH || types[1].kind == MESO_TYPE_TRUTH)
        meso_grammar_wrong(t->lexer, &t->call->at, "%s is for numbers; a condition stands there", t->name);
    if (types[0].kind == MESO_TYPE_ZERO || types[1].kind == MESO_TYPE_ZERO)
        return (MesoGrammarType){MESO_TYPE_ZERO, 0, 0};
    if (length < -MOST_POWER || length > MOST_POWER || angle < -MOST_POWER || angle > MOST_POWER) {
        meso_grammar_wrong(t->lexer, &t->call->at, "%s gives too high a power of lengths or angles", t->name);
        return number;
    }
    return meso_number_type(length, angle);
}

static MesoGrammarType root(const Typing *t, MesoGrammarType type)
{
    char text[64];
    meso_grammar_type_text(type, text);
    if (type.kind == MESO_TYPE_TRUTH || type.length % 2 || type.angle % 2)
        meso_grammar_wrong(t->lexer, &t->call->at, "%s of %s: it must be a number or a square", t->name, text);
    return type.kind == MESO_TYPE_ZERO ? type : meso_number_type(type.length / 2, type.angle / 2);
}

/* `map` is the type of the map's values. */
static MesoGrammarType map_type(const Typing *t, MesoGrammarType map, const MesoGrammarType *types)
{
    if (t->call->typing == MESO_TYPING_AVERAGE) {
        want(t, types[0], a_length);
        return map.kind == MESO_TYPE_TRUTH ? number : map;
    }
    if (map.kind == MESO_TYPE_TRUTH)
        meso_grammar_wrong(t->lexer, &t->call->at, "a region has no gradient: it is a condition");
    return meso_number_type(map.length - 1, map.angle);
}

static MesoGrammarType call_type(const Typing *t, const MesoGrammarType *types)
{
    const MesoExpression *call = t->call;
    switch (call->typing) {
    case MESO_TYPING_SAME: return join(t, types, call->argument_count);
    case MESO_TYPING_COMPARE: join(t, types, call->argument_count); return truth;
    case MESO_TYPING_RATIO: join(t, types, call->argument_count); return number;
    case MESO_TYPING_PRODUCT: return product(t, types, 1);
    case MESO_TYPING_QUOTIENT: return product(t, types, -1);
    case MESO_TYPING_ROOT: return root(t, types[0]);
    case MESO_TYPING_SIGN: join(t, types, 1); return number;
    case MESO_TYPING_ANGLE: want(t, types[0], an_angle); return number;
    case MESO_TYPING_LERP: want(t, types[2], number); return join(t, types, 2);
    case MESO_TYPING_CHANCE: want(t, types[0], number); return truth;
    case MESO_TYPING_AVERAGE:
    case MESO_TYPING_GRADIENT: return map_type(t, call->type, types);
    case MESO_TYPING_NOISE:
    case MESO_TYPING_LENGTH:
        want(t, types[0], a_length);
        if (call->argument_count == 2)
            want(t, types[1], call->typing == MESO_TYPING_NOISE ? number : an_angle);
        return call->typing == MESO_TYPING_NOISE ? number : truth;
    case MESO_TYPING_TRUTH:
    case MESO_TYPING_NUMBERS:
        for (uint32_t i = 0; i < call->argument_count; i++)
            want(t, types[i], call->typing == MESO_TYPING_TRUTH ? truth : number);
        return call->typing == MESO_TYPING_TRUTH ? truth : number;
    case MESO_TYPING_NONE: break;
    }
    return call->type;
}

MesoGrammarType meso_type_of(MesoGrammarLexer *lexer, const MesoExpression *expression, const MesoGrammarType *types)
{
    MesoGrammarType of[3] = {number, number, number};
    char name[64];
    if (expression->kind == MESO_EXPRESSION_LOCAL)
        return types[expression->index];
    if (expression->kind != MESO_EXPRESSION_CALL)
        return expression->type;
    for (uint32_t i = 0; i < expression->argument_count; i++)
        of[i] = meso_type_of(lexer, expression->arguments[i], types);
    meso_token_text(&expression->at, name);
    const Typing typing = {lexer, expression, name};
    return call_type(&typing, of);
}
