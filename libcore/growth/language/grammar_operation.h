/* What the code of a grammar is made of, and the numbers that operations give. */
#ifndef MESO_GRAMMAR_OPERATION_H
#define MESO_GRAMMAR_OPERATION_H

#include <stdint.h>

/*
 * Registers are doubles. `to` is the one where the result goes; `a` and `b` are registers or, from
 * MESO_CONSTANT_OPERAND, constants, and so is `target` as the third operand. A truth is 1 or 0.
 */
typedef enum MesoGrammarOperation {
    MESO_OP_CONSTANT,       /* constants[target] */
    MESO_OP_COPY,
    MESO_OP_STATE,          /* the branch's state[target] */
    MESO_OP_LOOK,           /* the host's look-up `target` of the map `more`, of a and b */
    MESO_OP_ADD, MESO_OP_SUBTRACT, MESO_OP_MULTIPLY, MESO_OP_DIVIDE, MESO_OP_MINIMUM, MESO_OP_MAXIMUM, MESO_OP_MODULO,
    MESO_OP_POWER, MESO_OP_LESS, MESO_OP_LESS_EQUAL, MESO_OP_EQUAL, MESO_OP_NOT_EQUAL,
    MESO_OP_NEGATE, MESO_OP_NOT, MESO_OP_ABSOLUTE, MESO_OP_FLOOR, MESO_OP_CEILING, MESO_OP_ROUND, MESO_OP_SIGN,
    MESO_OP_ROOT, MESO_OP_SINE, MESO_OP_COSINE,
    MESO_OP_CLAMP, MESO_OP_LERP, MESO_OP_SMOOTH,
    MESO_OP_AND, MESO_OP_OR,            /* of the tree only: they become jumps */
    MESO_OP_RANDOM, MESO_OP_CHANCE,     /* of the tree only: they become MESO_OP_DRAW */
    MESO_OP_DRAW,           /* in [0, 1), at sites[target], in the turn of a loop that register `a` counts */
    MESO_OP_NORMAL,         /* likewise, of mean a and deviation b; `more` counts */
    MESO_OP_JUMP,           /* to `target` */
    MESO_OP_JUMP_UNLESS,    /* where not a */
    MESO_OP_JUMP_UNLESS_LESS,   /* where not a < b */
    MESO_OP_JUMP_IF,
    MESO_OP_LOOP,           /* register `to` counts turns from -1, `a` is how many, `b` the salt; out to `target` */
    MESO_OP_SALT,           /* that with which the turns of a loop begin, within one with the salt a */
    MESO_OP_RESULT,         /* a is the value of this code */
    MESO_OP_VALUE,          /* register a is value `to` of the next command */
    MESO_OP_VALUE_CONSTANT, /* so is constants[target], which is finite */
    MESO_OP_VALUE_PRODUCT,  /* so is a times b */
    MESO_OP_WHILE,          /* the code at `target` is the next command's condition */
    MESO_OP_STEP,           /* on to `target` where it was refused; `a`: what to do before that */
    MESO_OP_MOVE, MESO_OP_TURN,
    MESO_OP_FACE,           /* the field `more` */
    MESO_OP_PLACE,          /* the shape `more` */
    MESO_OP_BRANCH,         /* the code that follows, at sites[more] in the turn b; the branch itself goes on at `target` */
    MESO_OP_RULE,           /* `more` with the next command's values, at sites[target] in the turn a */
    MESO_OP_END             /* of the branch */
} MesoGrammarOperation;

enum { MESO_CONSTANT_OPERAND = 1 << 15, MESO_NO_REGISTER = UINT16_MAX };

/* What `operation`, from MESO_OP_ADD to MESO_OP_SMOOTH, gives. The same bits on every machine: no library's
 * functions are called but those that IEEE 754 defines. */
double meso_grammar_apply(uint16_t operation, double a, double b, double c);

#endif
