/* Option table: binds each option to a typed variable and its help. */
#ifndef MESO_OPTIONS_H
#define MESO_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/arena.h"
#include "libcore/base/vec.h"

typedef enum MesoOptionKind {
    MESO_OPTION_GROUP,      /* a heading in the help; no option */
    MESO_OPTION_FLAG,       /* bool */
    MESO_OPTION_COUNT,      /* uint32_t, in [low, high] */
    MESO_OPTION_SEED,       /* uint64_t */
    MESO_OPTION_NUMBER,     /* float, in [low, high] */
    MESO_OPTION_TEXT,       /* const char * */
    MESO_OPTION_TEXT_OPT,   /* const char *; --name or --name=TEXT; "" without */
    MESO_OPTION_CHOICE,     /* const char *, one of `choices` "a|b|c" */
    MESO_OPTION_SIZE,       /* uint32_t[2], WxH */
    MESO_OPTION_POINT       /* MesoVec3, X,Y,Z */
} MesoOptionKind;

typedef struct MesoOption {
    MesoOptionKind kind;
    char letter;            /* 0 for none */
    const char *name;       /* without the dashes; a group's heading */
    const char *argument;   /* its name in the help, "FILE" */
    const char *help;
    void *value;
    bool *given;            /* set where the option was given; may be NULL */
    double low, high;       /* both 0: no limits */
    const char *choices;
} MesoOption;

/*
 * Parses `argv[1..]`: --name value, --name=value, -x value, -xvalue, and `--`
 * to end the options. Operands are moved to the front of `operands`
 * [argc], their number to `operand_count`. Numbers parse in the C locale,
 * completely. MESO_ERR_USAGE names the option and what would be right.
 * `options` ends with a zeroed entry; an unambiguous prefix is not enough.
 */
MesoStatus meso_options_parse(const MesoOption *options, int argc, char **argv,
                              const char **operands, uint32_t *operand_count, MesoError *error);

/*
 * The command line as one line that a shell takes back, in `arena`: the
 * program's base name, then options and operands as given, without the options
 * whose names `left_out` (ended by NULL) lists. NULL when memory is out.
 */
char *meso_options_command_line(const MesoOption *options, int argc, char **argv,
                                const char *const *left_out, MesoArena *arena, MesoError *error);

/* Help text of the table to standard output, wrapped at 80 columns. */
void meso_options_print(const MesoOption *options);

#endif
