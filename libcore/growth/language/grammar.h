/*
 * Grammars that grow over a surface: rules, and what they ask of it. A text becomes maps, fields, shapes, seeds and
 * code (grammar_read.h); grammar_run.h runs the code, one branch at a time, for an engine that walks. The language is
 * described in README.md; its words are tables in grammar_words.c.
 */
#ifndef MESO_GRAMMAR_H
#define MESO_GRAMMAR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcore/base/arena.h"
#include "libcore/base/index.h"

enum {
    MESO_GRAMMAR_VERSION = 1,
    MESO_GRAMMAR_TEXT = 1 << 20,        /* most bytes of a grammar */
    MESO_GRAMMAR_ARGUMENTS = 12,        /* most of a rule, a command, a source */
    MESO_GRAMMAR_REGISTERS = 224        /* most values at hand in a rule */
};

/* A quantity's type: a number of length^`length` * angle^`angle`, or whether something is so. */
typedef enum MesoGrammarTypeKind {
    MESO_TYPE_NUMBER,
    MESO_TYPE_TRUTH,
    MESO_TYPE_ZERO,             /* 0 is a length as well as an angle */
    MESO_TYPE_UNKNOWN
} MesoGrammarTypeKind;

typedef struct MesoGrammarType {
    MesoGrammarTypeKind kind;
    int8_t length, angle;
} MesoGrammarType;

/* What maps, fields, shapes and places of seeds are made of: with the arguments that grammar_words.c lists. */
typedef enum MesoGrammarSourceKind {
    MESO_MAP_IMAGE, MESO_MAP_ATTRIBUTE, MESO_MAP_REGION, MESO_MAP_BORDER, MESO_MAP_POINTS, MESO_MAP_CURVE,
    MESO_FIELD_UP, MESO_FIELD_WORLD, MESO_FIELD_POINT, MESO_FIELD_GRADIENT, MESO_FIELD_ATTRIBUTE,
    MESO_FIELD_PRINCIPAL, MESO_FIELD_RANDOM,
    MESO_SHAPE_LEAF, MESO_SHAPE_SCALE, MESO_SHAPE_BEAD, MESO_SHAPE_LINK, MESO_SHAPE_TUBE, MESO_SHAPE_MESH,
    MESO_SHAPE_SECTION,
    MESO_SEEDS_POISSON, MESO_SEEDS_DENSITY, MESO_SEEDS_POINTS, MESO_SEEDS_AT, MESO_SEEDS_VERTICES,
    MESO_SEEDS_BORDER, MESO_SEEDS_CURVE
} MesoGrammarSourceKind;

typedef struct MesoGrammarValue {
    bool given;
    double number;              /* its default where it was not given; lengths in units of the surface, angles in radians */
    const char *text;           /* NULL where there is none */
    uint32_t index;             /* of a word among those possible, of a map; of seeds' numbers the code, or MESO_NO_INDEX */
} MesoGrammarValue;

typedef struct MesoGrammarSource {
    const char *name;           /* NULL where it was written where it is used */
    MesoGrammarSourceKind kind;
    bool reversed;              /* a field the other way round */
    uint32_t line;              /* of the text */
    MesoGrammarValue values[MESO_GRAMMAR_ARGUMENTS];
} MesoGrammarSource;

typedef struct MesoGrammarParameter {
    const char *name;
    double value;
    MesoGrammarType type;
} MesoGrammarParameter;

typedef struct MesoGrammarRule {
    const char *name;
    uint32_t argument_count;
    uint32_t entry;             /* of its code; its arguments are the first registers */
    bool reached;               /* from some seed */
} MesoGrammarRule;

/* Seeds are tried in order of the file. Codes are MESO_NO_INDEX where nothing was said. */
typedef struct MesoGrammarSeed {
    MesoGrammarSource places;
    uint32_t rule;
    uint32_t entry;             /* of code that ends with the order to run the rule */
    uint32_t where;             /* of code that gives whether a seed may be at a place */
    uint32_t field;             /* that it faces, or MESO_NO_INDEX */
    double count;               /* most; infinite where nothing was said */
    uint64_t site;              /* for the keys of its branches */
} MesoGrammarSeed;

typedef struct MesoGrammarInstruction {
    uint16_t operation, to, a, b;
    uint32_t target, more;
} MesoGrammarInstruction;

typedef struct MesoGrammarLimits {
    double generations, elements, length;   /* infinite where nothing was said */
} MesoGrammarLimits;

typedef struct MesoGrammar {
    uint32_t parameter_count, map_count, field_count, shape_count, seed_count, rule_count;
    MesoGrammarParameter *parameters;
    MesoGrammarSource *maps, *fields, *shapes;
    MesoGrammarSeed *seeds;
    MesoGrammarRule *rules;
    MesoGrammarLimits limits;
    uint32_t code_count, constant_count, site_count;
    MesoGrammarInstruction *code;
    uint32_t *lines;            /* [code_count] of the text, for what goes wrong while it runs */
    double *constants;
    uint64_t *sites;            /* one a draw, a branch and a successor in the text */
    uint32_t local_count;       /* registers that live from one command to the next: the most of any rule */
    uint32_t register_count;
} MesoGrammar;

/* "name=value" of a parameter, as the command line has it. */
typedef struct MesoGrammarSetting {
    const char *text;
} MesoGrammarSetting;

typedef struct MesoGrammarOptions {
    const MesoGrammarSetting *settings;
    uint32_t setting_count;
    double extent;              /* diagonal of the surface's box in its own units; the unit "extent" of the text */
} MesoGrammarOptions;

#endif
