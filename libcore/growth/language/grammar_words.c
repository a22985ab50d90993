#include "libcore/growth/language/grammar_words.h"

#include <string.h>

#include "libcore/growth/language/grammar_run.h"

#define PLAIN {MESO_TYPE_NUMBER, 0, 0}
#define LENGTH {MESO_TYPE_NUMBER, 1, 0}
#define ANGLE {MESO_TYPE_NUMBER, 0, 1}
#define TRUTH {MESO_TYPE_TRUTH, 0, 0}
#define QUANTITY(name, type, required, fallback) {name, MESO_SLOT_QUANTITY, type, required, fallback, NULL}
#define TEXT(name, required) {name, MESO_SLOT_TEXT, PLAIN, required, 0, NULL}
#define WORD(name, words) {name, MESO_SLOT_WORD, PLAIN, false, 0, words}
#define REFERENCE(name, kind, required) {name, kind, PLAIN, required, 0, NULL}
#define LAST {NULL, MESO_SLOT_TEXT, PLAIN, false, 0, NULL}

const MesoGrammarUnit meso_grammar_units[] = {
    {"um", LENGTH, 1e-6}, {"mm", LENGTH, 1e-3}, {"cm", LENGTH, 1e-2}, {"dm", LENGTH, 1e-1}, {"m", LENGTH, 1},
    {"km", LENGTH, 1e3}, {"extent", LENGTH, 0}, {"rad", ANGLE, 1}, {"deg", ANGLE, 3.14159265358979323846 / 180},
    {"%", PLAIN, 0.01}, {NULL, PLAIN, 0},
};

static const char *const channels[] = {"r", "g", "b", "a", NULL};
static const char *const filters[] = {"linear", "nearest", NULL};
static const char *const wraps[] = {"repeat", "clamp", "mirror", NULL};
static const char *const curvatures[] = {"max", "min", NULL};
static const char *const axes[] = {"z", "x", NULL};

static const MesoGrammarSlot nothing[] = {LAST};
static const MesoGrammarSlot image[] = {TEXT("file", true), WORD("channel", channels), WORD("filter", filters),
                                        WORD("wrap", wraps), QUANTITY("uv", PLAIN, false, 0), LAST};
static const MesoGrammarSlot attribute[] = {TEXT("name", true), QUANTITY("component", PLAIN, false, 0), LAST};
static const MesoGrammarSlot named[] = {TEXT("name", true), LAST};
static const MesoGrammarSlot region[] = {TEXT("name", true), TEXT("file", false), LAST};
static const MesoGrammarSlot file[] = {TEXT("file", true), LAST};
static const MesoGrammarSlot world[] = {QUANTITY("x", PLAIN, true, 0), QUANTITY("y", PLAIN, true, 0),
                                        QUANTITY("z", PLAIN, true, 0), LAST};
static const MesoGrammarSlot point[] = {QUANTITY("x", LENGTH, true, 0), QUANTITY("y", LENGTH, true, 0),
                                        QUANTITY("z", LENGTH, true, 0), LAST};
static const MesoGrammarSlot of_map[] = {REFERENCE("map", MESO_SLOT_MAP, true), LAST};
static const MesoGrammarSlot principal[] = {WORD("which", curvatures), LAST};
static const MesoGrammarSlot built_in[] = {TEXT("material", false), QUANTITY("detail", PLAIN, false, 1), LAST};
static const MesoGrammarSlot tube[] = {TEXT("material", false), QUANTITY("detail", PLAIN, false, 1),
                                       QUANTITY("sides", PLAIN, false, 8), LAST};
static const MesoGrammarSlot mesh[] = {TEXT("file", true), WORD("along", axes), TEXT("material", false), LAST};
static const MesoGrammarSlot section[] = {TEXT("file", true), TEXT("section", false), TEXT("material", false), LAST};
static const MesoGrammarSlot poisson[] = {QUANTITY("radius", LENGTH, true, 0), LAST};
static const MesoGrammarSlot density[] = {REFERENCE("map", MESO_SLOT_MAP, true), QUANTITY("count", PLAIN, true, 0), LAST};
static const MesoGrammarSlot vertices[] = {QUANTITY("share", PLAIN, false, 1), LAST};
static const MesoGrammarSlot along_border[] = {QUANTITY("spacing", LENGTH, true, 0), LAST};
static const MesoGrammarSlot along_curve[] = {TEXT("file", true), QUANTITY("spacing", LENGTH, true, 0), LAST};

const MesoGrammarSourceWord meso_grammar_sources[] = {
    {"image", MESO_FAMILY_MAP, MESO_MAP_IMAGE, PLAIN, image},
    {"attribute", MESO_FAMILY_MAP, MESO_MAP_ATTRIBUTE, PLAIN, attribute},
    {"region", MESO_FAMILY_MAP, MESO_MAP_REGION, TRUTH, region},
    {"border", MESO_FAMILY_MAP, MESO_MAP_BORDER, LENGTH, nothing},
    {"points", MESO_FAMILY_MAP, MESO_MAP_POINTS, LENGTH, file},
    {"curve", MESO_FAMILY_MAP, MESO_MAP_CURVE, LENGTH, file},
    {"up", MESO_FAMILY_FIELD, MESO_FIELD_UP, PLAIN, nothing},
    {"world", MESO_FAMILY_FIELD, MESO_FIELD_WORLD, PLAIN, world},
    {"point", MESO_FAMILY_FIELD, MESO_FIELD_POINT, PLAIN, point},
    {"gradient", MESO_FAMILY_FIELD, MESO_FIELD_GRADIENT, PLAIN, of_map},
    {"attribute", MESO_FAMILY_FIELD, MESO_FIELD_ATTRIBUTE, PLAIN, named},
    {"principal", MESO_FAMILY_FIELD, MESO_FIELD_PRINCIPAL, PLAIN, principal},
    {"random", MESO_FAMILY_FIELD, MESO_FIELD_RANDOM, PLAIN, nothing},
    {"leaf", MESO_FAMILY_SHAPE, MESO_SHAPE_LEAF, PLAIN, built_in},
    {"scale", MESO_FAMILY_SHAPE, MESO_SHAPE_SCALE, PLAIN, built_in},
    {"bead", MESO_FAMILY_SHAPE, MESO_SHAPE_BEAD, PLAIN, built_in},
    {"link", MESO_FAMILY_SHAPE, MESO_SHAPE_LINK, PLAIN, built_in},
    {"tube", MESO_FAMILY_SHAPE, MESO_SHAPE_TUBE, PLAIN, tube},
    {"mesh", MESO_FAMILY_SHAPE, MESO_SHAPE_MESH, PLAIN, mesh},
    {"section", MESO_FAMILY_SHAPE, MESO_SHAPE_SECTION, PLAIN, section},
    {"poisson", MESO_FAMILY_SEEDS, MESO_SEEDS_POISSON, PLAIN, poisson},
    {"density", MESO_FAMILY_SEEDS, MESO_SEEDS_DENSITY, PLAIN, density},
    {"points", MESO_FAMILY_SEEDS, MESO_SEEDS_POINTS, PLAIN, file},
    {"at", MESO_FAMILY_SEEDS, MESO_SEEDS_AT, PLAIN, point},
    {"vertices", MESO_FAMILY_SEEDS, MESO_SEEDS_VERTICES, PLAIN, vertices},
    {"border", MESO_FAMILY_SEEDS, MESO_SEEDS_BORDER, PLAIN, along_border},
    {"curve", MESO_FAMILY_SEEDS, MESO_SEEDS_CURVE, PLAIN, along_curve},
    {NULL, MESO_FAMILY_MAP, MESO_MAP_IMAGE, PLAIN, NULL},
};

const MesoGrammarFunction meso_grammar_functions[] = {
    {"min", MESO_OP_MINIMUM, 0, 2, 2, false, MESO_TYPING_SAME},
    {"max", MESO_OP_MAXIMUM, 0, 2, 2, false, MESO_TYPING_SAME},
    {"mod", MESO_OP_MODULO, 0, 2, 2, false, MESO_TYPING_SAME},
    {"pow", MESO_OP_POWER, 0, 2, 2, false, MESO_TYPING_NUMBERS},
    {"abs", MESO_OP_ABSOLUTE, 0, 1, 1, false, MESO_TYPING_SAME},
    {"floor", MESO_OP_FLOOR, 0, 1, 1, false, MESO_TYPING_NUMBERS},
    {"ceil", MESO_OP_CEILING, 0, 1, 1, false, MESO_TYPING_NUMBERS},
    {"round", MESO_OP_ROUND, 0, 1, 1, false, MESO_TYPING_NUMBERS},
    {"sign", MESO_OP_SIGN, 0, 1, 1, false, MESO_TYPING_SIGN},
    {"sqrt", MESO_OP_ROOT, 0, 1, 1, false, MESO_TYPING_ROOT},
    {"sin", MESO_OP_SINE, 0, 1, 1, false, MESO_TYPING_ANGLE},
    {"cos", MESO_OP_COSINE, 0, 1, 1, false, MESO_TYPING_ANGLE},
    {"clamp", MESO_OP_CLAMP, 0, 3, 3, false, MESO_TYPING_SAME},
    {"lerp", MESO_OP_LERP, 0, 3, 3, false, MESO_TYPING_LERP},
    {"smooth", MESO_OP_SMOOTH, 0, 3, 3, false, MESO_TYPING_RATIO},
    {"rand", MESO_OP_RANDOM, 0, 2, 2, false, MESO_TYPING_SAME},
    {"normal", MESO_OP_NORMAL, 0, 2, 2, false, MESO_TYPING_SAME},
    {"chance", MESO_OP_CHANCE, 0, 1, 1, false, MESO_TYPING_CHANCE},
    {"noise", MESO_OP_LOOK, MESO_LOOK_NOISE, 1, 2, false, MESO_TYPING_NOISE},
    {"ahead", MESO_OP_LOOK, MESO_LOOK_AHEAD, 1, 1, true, MESO_TYPING_AVERAGE},
    {"side", MESO_OP_LOOK, MESO_LOOK_SIDE, 1, 1, true, MESO_TYPING_AVERAGE},
    {"gradient", MESO_OP_LOOK, MESO_LOOK_GRADIENT, 0, 0, true, MESO_TYPING_GRADIENT},
    {"clear", MESO_OP_LOOK, MESO_LOOK_CLEAR, 1, 1, false, MESO_TYPING_LENGTH},
    {"meets", MESO_OP_LOOK, MESO_LOOK_MEETS, 1, 2, false, MESO_TYPING_LENGTH},
    {NULL, 0, 0, 0, 0, false, MESO_TYPING_NONE},
};

const MesoGrammarQuantity meso_grammar_quantities[] = {
    {"generation", MESO_OP_STATE, MESO_STATE_GENERATION, PLAIN},
    {"depth", MESO_OP_STATE, MESO_STATE_DEPTH, PLAIN},
    {"length", MESO_OP_STATE, MESO_STATE_LENGTH, LENGTH},
    {"width", MESO_OP_STATE, MESO_STATE_WIDTH, LENGTH},
    {"x", MESO_OP_STATE, MESO_STATE_X, LENGTH},
    {"y", MESO_OP_STATE, MESO_STATE_Y, LENGTH},
    {"z", MESO_OP_STATE, MESO_STATE_Z, LENGTH},
    {"height", MESO_OP_LOOK, MESO_LOOK_HEIGHT, LENGTH},
    {"slope", MESO_OP_LOOK, MESO_LOOK_SLOPE, ANGLE},
    {"curvature", MESO_OP_LOOK, MESO_LOOK_CURVATURE, {MESO_TYPE_NUMBER, -1, 1}},
    {NULL, 0, 0, PLAIN},
};

/* Quantities, counted from the first, are those of MesoGrowthValue. */
static const MesoGrammarSlot step[] = {
    QUANTITY("length", LENGTH, true, 0), QUANTITY("angle", ANGLE, false, 0), QUANTITY("width", LENGTH, false, 0),
    QUANTITY("end", LENGTH, false, 0), QUANTITY("lift", LENGTH, false, 0), QUANTITY("roll", ANGLE, false, 0),
    QUANTITY("tint", PLAIN, false, 0), QUANTITY("clear", LENGTH, false, 0), QUANTITY("cross", TRUTH, false, 0),
    REFERENCE("shape", MESO_SLOT_SHAPE, false), LAST};
static const MesoGrammarSlot place[] = {
    QUANTITY("size", LENGTH, true, 0), QUANTITY("tilt", ANGLE, false, 0), QUANTITY("width", LENGTH, false, 0),
    QUANTITY("end", LENGTH, false, 0), QUANTITY("lift", LENGTH, false, 0), QUANTITY("roll", ANGLE, false, 0),
    QUANTITY("tint", PLAIN, false, 0), LAST};
static const MesoGrammarSlot move[] = {QUANTITY("length", LENGTH, true, 0), QUANTITY("angle", ANGLE, false, 0), LAST};
static const MesoGrammarSlot turn[] = {QUANTITY("angle", ANGLE, true, 0), LAST};
static const MesoGrammarSlot face[] = {REFERENCE("direction", MESO_SLOT_FIELD, true), QUANTITY("share", PLAIN, false, 1),
                                       LAST};

const MesoGrammarCommandWord meso_grammar_commands[] = {
    {"step", MESO_OP_STEP, step}, {"move", MESO_OP_MOVE, move}, {"turn", MESO_OP_TURN, turn},
    {"face", MESO_OP_FACE, face}, {"place", MESO_OP_PLACE, place}, {"stop", MESO_OP_END, nothing}, {NULL, 0, NULL},
};

const char *const meso_grammar_keywords[] = {
    "unit", "param", "map", "field", "shape", "limit", "seed", "rule", "on", "where", "count", "let", "if", "else",
    "choose", "repeat", "as", "branch", "while", "join", "retry", "and", "or", "not", "true", "false", NULL,
};

static bool is(const char *word, const char *text, size_t length)
{
    return strlen(word) == length && memcmp(word, text, length) == 0;
}

#define FIND(table, condition)                                              \
    for (size_t i = 0; table[i].name; i++)                                  \
        if ((condition) && is(table[i].name, text, length))                 \
            return &table[i];                                               \
    return NULL

const MesoGrammarUnit *meso_grammar_unit(const char *text, size_t length)
{
    FIND(meso_grammar_units, true);
}

const MesoGrammarSourceWord *meso_grammar_source(MesoGrammarFamily family, const char *text, size_t length)
{
    FIND(meso_grammar_sources, meso_grammar_sources[i].family == family);
}

const MesoGrammarFunction *meso_grammar_function(const char *text, size_t length)
{
    FIND(meso_grammar_functions, true);
}

const MesoGrammarQuantity *meso_grammar_quantity(const char *text, size_t length)
{
    FIND(meso_grammar_quantities, true);
}

const MesoGrammarCommandWord *meso_grammar_command(const char *text, size_t length)
{
    FIND(meso_grammar_commands, true);
}

/* Names of sources are not: they stand only where nothing else can. But for fields, which may be written in place. */
bool meso_grammar_is_reserved(const char *text, size_t length)
{
    for (size_t i = 0; meso_grammar_keywords[i]; i++)
        if (is(meso_grammar_keywords[i], text, length))
            return true;
    return meso_grammar_unit(text, length) || meso_grammar_function(text, length) ||
           meso_grammar_quantity(text, length) || meso_grammar_command(text, length) ||
           meso_grammar_source(MESO_FAMILY_FIELD, text, length);
}
