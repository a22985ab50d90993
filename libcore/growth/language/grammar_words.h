/* The words of the language, as tables: units, functions, commands, sources and their arguments. */
#ifndef MESO_GRAMMAR_WORDS_H
#define MESO_GRAMMAR_WORDS_H

#include "libcore/growth/language/grammar.h"
#include "libcore/growth/language/grammar_operation.h"

typedef enum MesoGrammarSlotKind {
    MESO_SLOT_QUANTITY, MESO_SLOT_TEXT, MESO_SLOT_WORD, MESO_SLOT_MAP, MESO_SLOT_FIELD, MESO_SLOT_SHAPE
} MesoGrammarSlotKind;

/* An argument: by place, or as "name: value". */
typedef struct MesoGrammarSlot {
    const char *name;           /* NULL ends the list */
    MesoGrammarSlotKind kind;
    MesoGrammarType type;
    bool required;
    double fallback;
    const char *const *words;   /* of MESO_SLOT_WORD; the first is the default */
} MesoGrammarSlot;

typedef struct MesoGrammarUnit {
    const char *name;
    MesoGrammarType type;
    double factor;              /* to metres and radians; 0: the surface's extent */
} MesoGrammarUnit;

typedef enum MesoGrammarFamily {
    MESO_FAMILY_MAP, MESO_FAMILY_FIELD, MESO_FAMILY_SHAPE, MESO_FAMILY_SEEDS
} MesoGrammarFamily;

typedef struct MesoGrammarSourceWord {
    const char *name;
    MesoGrammarFamily family;
    MesoGrammarSourceKind kind;
    MesoGrammarType type;       /* of a map's values */
    const MesoGrammarSlot *slots;
} MesoGrammarSourceWord;

/* How a function's type comes from its arguments'. */
typedef enum MesoGrammarTyping {
    MESO_TYPING_SAME,           /* all alike, and so is the result */
    MESO_TYPING_COMPARE,        /* all alike; a truth */
    MESO_TYPING_RATIO,          /* all alike; a number */
    MESO_TYPING_TRUTH,          /* truths; a truth */
    MESO_TYPING_PRODUCT, MESO_TYPING_QUOTIENT, MESO_TYPING_ROOT,
    MESO_TYPING_NUMBERS,        /* numbers; a number */
    MESO_TYPING_CHANCE,         /* a number; a truth */
    MESO_TYPING_SIGN,           /* anything; a number */
    MESO_TYPING_ANGLE,          /* an angle; a number */
    MESO_TYPING_LERP,           /* two alike and a number */
    MESO_TYPING_AVERAGE,        /* a map and a length; as the map */
    MESO_TYPING_GRADIENT,       /* a map; a length's share of it */
    MESO_TYPING_NOISE,          /* a length, and a number */
    MESO_TYPING_LENGTH,         /* a length and an angle; a truth */
    MESO_TYPING_NONE            /* no arguments: what the look-up's word says */
} MesoGrammarTyping;

typedef struct MesoGrammarFunction {
    const char *name;
    uint16_t operation;
    uint16_t look;              /* of MESO_OP_LOOK */
    uint8_t least, most;        /* arguments, the map not among them */
    bool of_map;                /* the first is a map */
    MesoGrammarTyping typing;
} MesoGrammarFunction;

/* A value that needs no arguments: of the branch, or of the place. */
typedef struct MesoGrammarQuantity {
    const char *name;
    uint16_t operation;
    uint16_t index;             /* of MESO_OP_STATE or MESO_OP_LOOK */
    MesoGrammarType type;
} MesoGrammarQuantity;

typedef struct MesoGrammarCommandWord {
    const char *name;
    uint16_t operation;
    const MesoGrammarSlot *slots;
} MesoGrammarCommandWord;

/* Each list ends with a name that is NULL. */
extern const MesoGrammarUnit meso_grammar_units[];
extern const MesoGrammarSourceWord meso_grammar_sources[];
extern const MesoGrammarFunction meso_grammar_functions[];
extern const MesoGrammarQuantity meso_grammar_quantities[];
extern const MesoGrammarCommandWord meso_grammar_commands[];
extern const char *const meso_grammar_keywords[];

/* Each returns NULL where there is no such word. O(words). */
const MesoGrammarUnit *meso_grammar_unit(const char *text, size_t length);
const MesoGrammarSourceWord *meso_grammar_source(MesoGrammarFamily family, const char *text, size_t length);
const MesoGrammarFunction *meso_grammar_function(const char *text, size_t length);
const MesoGrammarQuantity *meso_grammar_quantity(const char *text, size_t length);
const MesoGrammarCommandWord *meso_grammar_command(const char *text, size_t length);

/* Whether no name of the text may be this. */
bool meso_grammar_is_reserved(const char *text, size_t length);

static inline MesoGrammarType meso_number_type(int length, int angle)
{
    return (MesoGrammarType){MESO_TYPE_NUMBER, (int8_t)length, (int8_t)angle};
}

#endif
