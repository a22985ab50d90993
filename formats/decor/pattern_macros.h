/* Macros of patterns: steps with a name and parameters, written out on the level of JSON where they are called. */
#ifndef MESO_PATTERN_MACROS_H
#define MESO_PATTERN_MACROS_H

#include "formats/decor/pattern_parser.h"

/* Adds a table of macros; of two with one name the one that is added later counts. Its JSON must outlive the parser. */
void meso_macros_add(MesoPatternParser *parser, const MesoJsonField *table);

/* Adds those of a file of macros, whose JSON the parser keeps. */
void meso_macros_add_file(MesoPatternParser *parser, const MesoInput *input);

/* Gives back the JSON of files. */
void meso_macros_release(MesoPatternParser *parser);

/* Keys that stand beside the parameters of a call, and are none: "macro", "on", "weight", "most", and notes. */
bool meso_macro_is_own_key(const char *key);

/* A call that is being written out. */
typedef struct MesoMacroCall {
    const char *name;
    json_t *steps;          /* new; NULL where something is wrong, which has been told */
    MesoJsonField scope;    /* "macro NAME" in the call, for messages */
    MesoJsonField list;     /* its "steps" */
} MesoMacroCall;

/*
 * Writes out the steps of the macro that `field` calls: a text "$name" that stands for a whole value becomes the
 * parameter of that name, as the call or else the macro has it; one that is null leaves out its key or item. "$$"
 * begins a text with one '$'. Every begin that gives steps has its end; between them, the macro cannot be called again.
 */
void meso_macro_begin(MesoMacroCall *call, MesoPatternParser *parser, const MesoJsonField *field);
void meso_macro_end(MesoMacroCall *call, MesoPatternParser *parser);

#endif
