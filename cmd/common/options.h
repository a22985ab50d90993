/* Option table: binds each option to a typed variable and its help. */
#ifndef MESO_OPTIONS_H
#define MESO_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef enum MesoOptionKind {
    MESO_OPTION_GROUP,      /* a heading in the help; no option */
    MESO_OPTION_FLAG,       /* bool */
    MESO_OPTION_COUNT,      /* uint32_t, in [low, high] */
    MESO_OPTION_SEED,       /* uint64_t */
    MESO_OPTION_NUMBER,     /* float, in [low, high] */
    MESO_OPTION_TEXT,       /* const char *, and no path */
    MESO_OPTION_CHOICE,     /* const char *, one of `choices` "a|b|c" */
    MESO_OPTION_SIZE,       /* uint32_t[2], WxH */
    MESO_OPTION_POINT,      /* MesoVec3, X,Y,Z */
    MESO_OPTION_INPUT,      /* const char *, a file that is read */
    MESO_OPTION_FOLDER,     /* const char *, a folder */
    MESO_OPTION_OUTPUT,     /* const char *, a file that is written */
    MESO_OPTION_OUTPUT_OPT, /* const char *, the same; --name or --name=FILE; "" without */
    MESO_OPTION_PATTERN     /* const char *, of the names of files that are written */
} MesoOptionKind;

/* What a row may add to its kind, for the record of the command. */
enum {
    MESO_OPTION_SILENT = 0x100,     /* no byte of a product depends on it: never recorded */
    MESO_OPTION_OUTWARD = 0x200,    /* about places, as OUTPUT and PATTERN are, not about what is made */
    MESO_OPTION_OVERRIDES = 0x400   /* says something though its value is the default; `given` tells */
};

typedef struct MesoOption {
    uint32_t kind;          /* MesoOptionKind, with any of the above */
    char letter;            /* 0 for none */
    const char *name;       /* without the dashes; a group's heading */
    const char *argument;   /* its name in the help, "FILE" */
    const char *help;
    void *value;
    bool *given;            /* set where the option was given; may be NULL */
    double low, high;       /* both 0: no limits */
    const char *choices;
} MesoOption;

static inline MesoOptionKind meso_option_kind(const MesoOption *option)
{
    return (MesoOptionKind)(option->kind & 0xff);
}

/* The zeroed entry at the end of a table. */
static inline bool meso_option_is_last(const MesoOption *option)
{
    return option->kind == MESO_OPTION_GROUP && !option->name;
}

/*
 * Parses `argv[1..]`: --name value, --name=value, -x value, -xvalue, and `--`
 * to end the options. Operands are moved to the front of `operands`
 * [argc], their number to `operand_count`. Numbers parse in the C locale,
 * completely. MESO_ERR_USAGE names the option and what would be right.
 * `options` ends with a zeroed entry; an unambiguous prefix is not enough.
 */
MesoStatus meso_options_parse(const MesoOption *options, int argc, char **argv,
                              const char **operands, uint32_t *operand_count, MesoError *error);

/* A command that differs from the one given. */
typedef struct MesoOptionChange {
    const char *name;       /* of the option; NULL ends a list */
    const char *value;      /* as it is to be recorded; NULL: as if it was not given */
} MesoOptionChange;

/* The change of this option in a list (NULL: an empty one), or NULL. */
static inline const MesoOptionChange *meso_option_change(const MesoOptionChange *changes, const MesoOption *option)
{
    for (; changes && changes->name; changes++)
        if (strcmp(option->name, changes->name) == 0)
            return changes;
    return NULL;
}

/* `text` in quotes of a POSIX shell where it needs them; NULL when memory is out. */
char *meso_options_quote(MesoArena *arena, const char *text, MesoError *error);

/* `line` with " --name value" at its end; NULL when memory is out. */
char *meso_options_append(const char *line, const char *name, const char *value, MesoArena *arena, MesoError *error);

/*
 * The command as typed, as one line that a shell takes back, in `arena`: `program`,
 * the values of `changes` (NULL: none), then options and operands as given, but for silent
 * and changed options. NULL when memory is out.
 */
char *meso_options_command_typed(const MesoOption *options, const char *program, int argc, char **argv,
                                 const MesoOptionChange *changes, MesoArena *arena, MesoError *error);

/* Help text of the table to standard output, wrapped at 80 columns. A row without help is hidden. */
void meso_options_print(const MesoOption *options);

/*
 * The table for programs, which make shell completions of it, to standard output, lines of
 *
 *     option TAB name TAB letter TAB kind TAB words TAB help
 *     operand TAB number TAB words
 *
 * kind is flag, value or optional (--name or --name=VALUE). Words, with blanks between, are what may
 * stand there: .x for files that end so, * for any, / for folders. Beyond what the kinds of options tell, `words`
 * says so in lines "--name WORDS", and "NUMBER WORDS" for operands, the last of which may be repeated.
 */
void meso_options_list(const MesoOption *options, const char *words);

#endif
