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
    MESO_OPTION_LIST,       /* MesoTextList; texts with commas between, and given again, more of them */
    MESO_OPTION_CHOICE,     /* const char *, one of `choices` "a|b|c" */
    MESO_OPTION_SIZE,       /* uint32_t[2], WxH */
    MESO_OPTION_POINT,      /* MesoVec3, X,Y,Z */
    MESO_OPTION_INPUT,      /* const char *, a file that is read */
    MESO_OPTION_FOLDER,     /* const char *, a folder */
    MESO_OPTION_OUTPUT,     /* const char *, a file that is written */
    MESO_OPTION_OUTPUT_OPT, /* const char *, the same; --name or --name=FILE; "" without */
    MESO_OPTION_PATTERN     /* const char *, of the names of files that are written */
} MesoOptionKind;

enum { MESO_LIST_MOST = 64 };

typedef struct MesoTextList {
    uint32_t count;
    const char *items[MESO_LIST_MOST];  /* [count] as they were given, each one or several with commas between */
} MesoTextList;

/* What a row may add to its kind, for the record of the command. */
enum {
    MESO_OPTION_SILENT = 1,         /* no byte of a product depends on it: never recorded */
    MESO_OPTION_OUTWARD = 2,        /* about places, as OUTPUT and PATTERN are, not about what is made */
    MESO_OPTION_OVERRIDES = 4       /* says something though its value is the default; `given` tells */
};

typedef struct MesoOption {
    MesoOptionKind kind;
    uint32_t more;          /* any of the above */
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
 * Rows of a table, each with a pointer of the type that its kind wants: another is a compiler's warning. Behind the
 * last argument `.given = &flag` and `.more = MESO_OPTION_SILENT` and the like may follow. `letter` is 0 for none.
 */
#define MESO_OPTION_ROW(kind_, letter_, name_, argument_, help_, type, pointer, ...)              \
    {.kind = (kind_), .letter = (letter_), .name = (name_), .argument = (argument_), .help = (help_), \
     .value = (1 ? (pointer) : (type *)0), __VA_ARGS__}
#define MESO_GROUP(heading) {.kind = MESO_OPTION_GROUP, .name = (heading)}
#define MESO_FLAG(letter, name, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_FLAG, letter, name, 0, help, bool, pointer, __VA_ARGS__)
#define MESO_COUNT(letter, name, argument, help, pointer, low_, high_, ...)                       \
    MESO_OPTION_ROW(MESO_OPTION_COUNT, letter, name, argument, help, uint32_t, pointer, .low = (low_), .high = (high_), \
                    __VA_ARGS__)
#define MESO_SEED(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_SEED, letter, name, argument, help, uint64_t, pointer, __VA_ARGS__)
#define MESO_NUMBER(letter, name, argument, help, pointer, low_, high_, ...)                      \
    MESO_OPTION_ROW(MESO_OPTION_NUMBER, letter, name, argument, help, float, pointer, .low = (low_), .high = (high_), \
                    __VA_ARGS__)
#define MESO_TEXT(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_TEXT, letter, name, argument, help, const char *, pointer, __VA_ARGS__)
#define MESO_LIST(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_LIST, letter, name, argument, help, MesoTextList, pointer, __VA_ARGS__)
#define MESO_CHOICE(letter, name, argument, help, pointer, choices_, ...)                         \
    MESO_OPTION_ROW(MESO_OPTION_CHOICE, letter, name, argument, help, const char *, pointer, .choices = (choices_), \
                    __VA_ARGS__)
#define MESO_SIZE(letter, name, argument, help, pointer, low_, high_, ...)                        \
    MESO_OPTION_ROW(MESO_OPTION_SIZE, letter, name, argument, help, uint32_t, pointer, .low = (low_), .high = (high_), \
                    __VA_ARGS__)
#define MESO_POINT(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_POINT, letter, name, argument, help, MesoVec3, pointer, __VA_ARGS__)
#define MESO_INPUT_FILE(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_INPUT, letter, name, argument, help, const char *, pointer, __VA_ARGS__)
#define MESO_FOLDER(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_FOLDER, letter, name, argument, help, const char *, pointer, __VA_ARGS__)
#define MESO_OUTPUT_FILE(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_OUTPUT, letter, name, argument, help, const char *, pointer, __VA_ARGS__)
#define MESO_OUTPUT_FILE_OPT(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_OUTPUT_OPT, letter, name, argument, help, const char *, pointer, __VA_ARGS__)
#define MESO_PATTERN(letter, name, argument, help, pointer, ...) \
    MESO_OPTION_ROW(MESO_OPTION_PATTERN, letter, name, argument, help, const char *, pointer, __VA_ARGS__)

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
