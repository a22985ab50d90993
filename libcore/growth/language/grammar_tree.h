/* A grammar between its text and its code: what the parser gives to the checker and the compiler. */
#ifndef MESO_GRAMMAR_TREE_H
#define MESO_GRAMMAR_TREE_H

#include "libcore/base/names.h"
#include "libcore/growth/language/grammar_lexer.h"
#include "libcore/growth/language/grammar_words.h"

typedef enum MesoExpressionKind {
    MESO_EXPRESSION_CONSTANT,
    MESO_EXPRESSION_LOCAL,      /* of the register `index` */
    MESO_EXPRESSION_QUANTITY,   /* of the branch or the place */
    MESO_EXPRESSION_MAP,        /* its value here */
    MESO_EXPRESSION_CALL        /* functions and operators */
} MesoExpressionKind;

typedef struct MesoExpression {
    MesoExpressionKind kind;
    MesoToken at;
    MesoGrammarTyping typing;   /* of calls */
    uint16_t operation, look;   /* of calls and quantities */
    bool of_map;
    uint8_t argument_count;
    uint32_t depth;             /* of the tree below */
    uint32_t index;             /* of a register, a map, a state or look-up; site of a draw */
    uint32_t salt;              /* register of the loop that a draw stands in, or MESO_NO_REGISTER */
    MesoGrammarType type;       /* of constants, quantities and maps */
    double value;
    struct MesoExpression *arguments[3];
} MesoExpression;

typedef struct MesoArgument {
    MesoToken at;
    bool given;
    MesoExpression *expression;
    const char *text;
    uint32_t index;             /* of a word, a map, a field, a shape */
} MesoArgument;

typedef enum MesoStatementKind {
    MESO_STATEMENT_LET, MESO_STATEMENT_IF, MESO_STATEMENT_CHOOSE, MESO_STATEMENT_REPEAT, MESO_STATEMENT_BRANCH,
    MESO_STATEMENT_COMMAND, MESO_STATEMENT_RULE
} MesoStatementKind;

typedef struct MesoStatement MesoStatement;

typedef struct MesoBlock {
    MesoStatement *first, *last;
} MesoBlock;

/* One way of choose. */
typedef struct MesoArm {
    MesoExpression *weight;
    MesoBlock block;
    struct MesoArm *next;
} MesoArm;

struct MesoStatement {
    MesoStatementKind kind;
    MesoToken at;
    MesoStatement *next;
    uint32_t local;             /* register of let; of the counter of repeat, whose salt is the next and number of turns
                                 * the one after */
    uint32_t salt;              /* of the loop around it, or MESO_NO_REGISTER */
    uint32_t site;              /* of a choice, a branch, a rule */
    MesoExpression *expression; /* of let, if, repeat; of a step, what must hold all along it */
    MesoBlock block, otherwise; /* of if, repeat, branch; what is done when a step is refused */
    MesoArm *arms;
    const MesoGrammarCommandWord *command;
    MesoArgument arguments[MESO_GRAMMAR_ARGUMENTS];     /* of a command, by slot; of a rule */
    uint32_t argument_count;    /* of a rule */
    uint32_t shape;             /* that is placed, or MESO_NO_INDEX */
    bool join, caught;          /* of a step: what is done when it is refused; `otherwise`, which may be nothing */
    MesoExpression *retries, *retry_angle;
    uint32_t rule;              /* number of a rule's name; known when all is read */
};

/* One way to write a rule's successors: "rule Name(arguments) : condition -> block". */
typedef struct MesoProduction {
    MesoToken at;
    MesoExpression *condition;
    MesoBlock block;
    uint32_t local_count;
    MesoGrammarType *types;     /* [local_count] while it is checked */
    struct MesoProduction *next;
} MesoProduction;

typedef struct MesoRuleTree {
    MesoToken at;               /* where it is first called or written */
    uint32_t argument_count;
    bool written, reached, waiting;
    MesoProduction *first, *last;
    MesoGrammarType types[MESO_GRAMMAR_ARGUMENTS];
    uint32_t draws, children, seeds;    /* so far: their numbers make sites */
    uint32_t *calls;            /* [call_count] rules that it comes to without a step */
    const MesoStatement **call_places;
    uint32_t call_count, call_room, state;
} MesoRuleTree;

typedef struct MesoSeedTree {
    const MesoGrammarSourceWord *places;
    MesoArgument place_arguments[MESO_GRAMMAR_ARGUMENTS];
    MesoStatement *start;       /* the call of its rule */
    MesoExpression *where;
    MesoToken where_at;
} MesoSeedTree;

typedef enum MesoNameKind {
    MESO_NAME_PARAMETER, MESO_NAME_MAP, MESO_NAME_FIELD, MESO_NAME_SHAPE, MESO_NAME_RULE, MESO_NAME_LOCAL,
    MESO_NAME_NONE              /* no names are meant, words alone */
} MesoNameKind;

typedef struct MesoNamed {
    MesoNameKind kind;
    uint32_t index;             /* of its kind; of a local, its register */
    MesoToken at;
} MesoNamed;

typedef struct MesoGrammarParser {
    MesoGrammarLexer lexer;
    MesoToken token, next;      /* the one that is read next, and the one behind it */
    MesoArena *arena;
    MesoGrammar *grammar;
    const MesoGrammarOptions *options;
    double unit;                /* in metres */
    bool length_seen;           /* a length was written; the unit cannot change then */
    MesoNames names;            /* numbers in `named` */
    MesoNamed *named;
    uint32_t named_count, named_room;
    MesoNamed *locals;          /* [scope_count] those that can be seen, the newest last */
    uint32_t scope_count, scope_room;
    uint32_t local_count, most_locals;
    uint32_t salt, loop_depth;  /* of the loop that is being read */
    uint32_t depth;             /* of blocks, parentheses */
    MesoRuleTree *rules;        /* [grammar->rule_count] */
    MesoSeedTree *seeds;        /* [grammar->seed_count] */
    uint32_t rule;              /* that is being read, whose sites are its; or MESO_NO_INDEX */
    MesoToken owner;            /* its name, or that of the rule of the seed that is being read */
    uint32_t seed_draws;
    MesoExpression nothing;     /* stands for what could not be read */
    MesoStatement no_statement;
    const MesoGrammarSourceWord **map_words;    /* [map_count] */
    bool *set;                  /* [setting_count] which of the settings were used */
    uint32_t parameter_room, map_room, map_word_room, field_room, shape_room, rule_room, rule_tree_room, seed_room,
        seed_tree_room, site_room;
} MesoGrammarParser;

static inline bool meso_parsing(const MesoGrammarParser *parser)
{
    return !parser->lexer.status;
}

#endif
