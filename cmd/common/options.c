#include "cmd/common/options.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HELP_COLUMN = 26, HELP_WIDTH = 80, NUMBER_LENGTH = 63 };

typedef enum ItemKind { ITEM_END, ITEM_OPERAND, ITEM_OPTION, ITEM_BAD } ItemKind;

/* One option or operand of a command line. */
typedef struct Item {
    ItemKind kind;
    const MesoOption *option;
    const char *text;       /* the operand, or the option's value; NULL for none */
    bool letter;            /* given as -x */
    bool attached;          /* --name=value */
} Item;

typedef struct Cursor {
    const MesoOption *options;
    int argc, next;
    char **argv;
    const char *letters;    /* rest of -abc; NULL or "" for none */
    bool operands_only;     /* after -- */
} Cursor;

static const MesoOption *find_name(const MesoOption *options, const char *name, size_t length)
{
    for (; !meso_option_is_last(options); options++)
        if (options->kind != MESO_OPTION_GROUP && options->name &&
            strlen(options->name) == length && memcmp(options->name, name, length) == 0)
            return options;
    return NULL;
}

static const MesoOption *find_letter(const MesoOption *options, char letter)
{
    for (; !meso_option_is_last(options); options++)
        if (options->kind != MESO_OPTION_GROUP && options->letter == letter)
            return options;
    return NULL;
}

/* An option that `name` is the beginning of, or that differs in one or two
 * characters at the end; for the hint only. */
static const MesoOption *find_similar(const MesoOption *options, const char *name, size_t length)
{
    for (; length > 2 && !meso_option_is_last(options); options++) {
        if (options->kind == MESO_OPTION_GROUP || !options->name || !options->help)
            continue;
        size_t own = strlen(options->name), same = 0;
        while (same < own && same < length && options->name[same] == name[same])
            same++;
        if (same == length || (same >= 3 && same + 2 >= length && same + 2 >= own))
            return options;
    }
    return NULL;
}

static ItemKind unknown_name(const Cursor *cursor, const char *name, size_t length, MesoError *error)
{
    const MesoOption *similar = find_similar(cursor->options, name, length);
    if (similar)
        meso_fail(error, MESO_ERR_USAGE, "unknown option '--%.*s'; did you mean '--%s'?",
                  (int)length, name, similar->name);
    else
        meso_fail(error, MESO_ERR_USAGE, "unknown option '--%.*s'", (int)length, name);
    return ITEM_BAD;
}

static bool takes_value(const MesoOption *option)
{
    return option->kind != MESO_OPTION_FLAG && option->kind != MESO_OPTION_OUTPUT_OPT;
}

static ItemKind take_next_as_value(Cursor *cursor, Item *item, MesoError *error)
{
    if (cursor->next < cursor->argc) {
        item->text = cursor->argv[cursor->next++];
        return ITEM_OPTION;
    }
    const MesoOption *option = item->option;
    if (item->letter)
        meso_fail(error, MESO_ERR_USAGE, "option '-%c' needs %s", option->letter, option->argument);
    else
        meso_fail(error, MESO_ERR_USAGE, "option '--%s' needs %s", option->name, option->argument);
    return ITEM_BAD;
}

static ItemKind read_name(Cursor *cursor, const char *name, Item *item, MesoError *error)
{
    const char *equals = strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    item->option = find_name(cursor->options, name, length);
    if (!item->option)
        return unknown_name(cursor, name, length, error);
    if (equals && item->option->kind == MESO_OPTION_FLAG) {
        meso_fail(error, MESO_ERR_USAGE, "option '--%s' takes no value", item->option->name);
        return ITEM_BAD;
    }
    item->attached = equals != NULL;
    item->text = equals ? equals + 1 : NULL;
    return equals || !takes_value(item->option) ? ITEM_OPTION
                                                : take_next_as_value(cursor, item, error);
}

static ItemKind read_letter(Cursor *cursor, Item *item, MesoError *error)
{
    char letter = *cursor->letters++;
    item->letter = true;
    item->option = find_letter(cursor->options, letter);
    if (!item->option) {
        meso_fail(error, MESO_ERR_USAGE, "unknown option '-%c'", letter);
        cursor->letters = NULL;
        return ITEM_BAD;
    }
    if (!takes_value(item->option))
        return ITEM_OPTION;
    const char *rest = cursor->letters;
    cursor->letters = NULL;
    if (*rest == 0)
        return take_next_as_value(cursor, item, error);
    item->text = rest;
    return ITEM_OPTION;
}

static ItemKind next_item(Cursor *cursor, Item *item, MesoError *error)
{
    *item = (Item){0};
    if (cursor->letters && *cursor->letters)
        return item->kind = read_letter(cursor, item, error);
    if (cursor->next >= cursor->argc)
        return item->kind = ITEM_END;

    char *argument = cursor->argv[cursor->next++];
    if (cursor->operands_only || argument[0] != '-' || argument[1] == 0) {
        item->text = argument;
        return item->kind = ITEM_OPERAND;
    }
    if (argument[1] != '-') {
        cursor->letters = argument + 1;
        return item->kind = read_letter(cursor, item, error);
    }
    if (argument[2] == 0) {
        cursor->operands_only = true;
        return next_item(cursor, item, error);
    }
    return item->kind = read_name(cursor, argument + 2, item, error);
}

/* The whole of `text` as a finite number; strtod alone would take nan, inf,
 * hexadecimal and leading blanks too. */
static bool parse_number(const char *text, double *value)
{
    size_t length = strlen(text);
    if (length == 0 || length > NUMBER_LENGTH || strspn(text, "0123456789+-.eE") != length)
        return false;
    char *end;
    *value = strtod(text, &end);
    return *end == 0 && isfinite(*value);
}

static bool parse_whole(const char *text, uint64_t *value)
{
    size_t length = strlen(text);
    if (length == 0 || strspn(text, "0123456789") != length)
        return false;
    errno = 0;
    *value = strtoull(text, NULL, 10);
    return errno == 0;
}

static MesoStatus wrong_value(const MesoOption *option, const char *text, const char *needed,
                              MesoError *error)
{
    return meso_fail(error, MESO_ERR_USAGE, "option '--%s' needs %s, not '%s'", option->name, needed,
                     text);
}

/* "a whole number from 2 to 4096" */
static MesoStatus wrong_number(const MesoOption *option, const char *text, const char *what,
                               double low, double high, MesoError *error)
{
    char needed[128];
    if (low == 0 && high == 0)
        snprintf(needed, sizeof needed, "%s", what);
    else
        snprintf(needed, sizeof needed, "%s from %.15g to %.15g", what, low, high);
    return wrong_value(option, text, needed, error);
}

static MesoStatus set_count(const MesoOption *option, const char *text, MesoError *error)
{
    uint64_t value;
    double high = option->high == 0 && option->low == 0 ? (double)UINT32_MAX : option->high;
    if (!parse_whole(text, &value) || (double)value < option->low || (double)value > high)
        return wrong_number(option, text, "a whole number", option->low, high, error);
    *(uint32_t *)option->value = (uint32_t)value;
    return MESO_OK;
}

/* Up to what JSON readers take for an integer, so that reports can say it. */
static MesoStatus set_seed(const MesoOption *option, const char *text, MesoError *error)
{
    uint64_t value;
    if (!parse_whole(text, &value) || value > INT64_MAX)
        return wrong_value(option, text, "a whole number from 0 to 9223372036854775807", error);
    *(uint64_t *)option->value = value;
    return MESO_OK;
}

static MesoStatus set_number(const MesoOption *option, const char *text, MesoError *error)
{
    double value;
    bool limited = option->low != 0 || option->high != 0;
    if (!parse_number(text, &value) || !isfinite((float)value) ||
        (limited && (value < option->low || value > option->high)))
        return wrong_number(option, text, "a number", option->low, option->high, error);
    *(float *)option->value = (float)value;
    return MESO_OK;
}

static MesoStatus add_text(const MesoOption *option, const char *text, MesoError *error)
{
    MesoTextList *list = option->value;
    if (list->count == MESO_LIST_MOST)
        return meso_fail(error, MESO_ERR_USAGE, "option '--%s' is given over %d times", option->name, MESO_LIST_MOST);
    list->items[list->count++] = text;
    return MESO_OK;
}

static MesoStatus set_choice(const MesoOption *option, const char *text, MesoError *error)
{
    size_t length = strlen(text);
    for (const char *choice = option->choices; *choice;) {
        size_t size = strcspn(choice, "|");
        if (size == length && memcmp(choice, text, size) == 0) {
            *(const char **)option->value = text;
            return MESO_OK;
        }
        choice += size + (choice[size] == '|');
    }
    char needed[160];
    size_t used = (size_t)snprintf(needed, sizeof needed, "one of ");
    for (const char *c = option->choices; *c && used + 3 < sizeof needed; c++) {
        needed[used++] = *c == '|' ? ',' : *c;
        if (*c == '|')
            needed[used++] = ' ';
    }
    needed[used] = 0;
    return wrong_value(option, text, needed, error);
}

static MesoStatus set_size(const MesoOption *option, const char *text, MesoError *error)
{
    double low = option->high > 0 ? option->low : 1;
    double high = option->high > 0 ? option->high : (double)UINT32_MAX;
    const char *cross = strchr(text, 'x');
    char width[16] = "";
    uint64_t value[2];
    if (cross && cross - text < (long)sizeof width)
        memcpy(width, text, (size_t)(cross - text));
    if (!cross || !parse_whole(width, &value[0]) || !parse_whole(cross + 1, &value[1]) ||
        (double)value[0] < low || (double)value[1] < low || (double)value[0] > high ||
        (double)value[1] > high)
        return wrong_number(option, text, "WIDTHxHEIGHT, each", low, high, error);
    uint32_t *out = option->value;
    out[0] = (uint32_t)value[0];
    out[1] = (uint32_t)value[1];
    return MESO_OK;
}

static MesoStatus set_point(const MesoOption *option, const char *text, MesoError *error)
{
    float value[3];
    const char *part = text;
    for (int i = 0; i < 3; i++) {
        char number[NUMBER_LENGTH + 1] = "";
        size_t length = strcspn(part, ",");
        double parsed;
        if (length < sizeof number)
            memcpy(number, part, length);
        if (!parse_number(number, &parsed) || !isfinite((float)parsed) ||
            part[length] != (i < 2 ? ',' : 0))
            return wrong_value(option, text, "three numbers X,Y,Z", error);
        value[i] = (float)parsed;
        part += length + 1;
    }
    *(MesoVec3 *)option->value = (MesoVec3){value[0], value[1], value[2]};
    return MESO_OK;
}

static MesoStatus set_value(const MesoOption *option, const char *text, MesoError *error)
{
    switch (option->kind) {
    case MESO_OPTION_FLAG:
        *(bool *)option->value = true;
        return MESO_OK;
    case MESO_OPTION_COUNT:
        return set_count(option, text, error);
    case MESO_OPTION_SEED:
        return set_seed(option, text, error);
    case MESO_OPTION_NUMBER:
        return set_number(option, text, error);
    case MESO_OPTION_TEXT:
    case MESO_OPTION_INPUT:
    case MESO_OPTION_FOLDER:
    case MESO_OPTION_OUTPUT:
    case MESO_OPTION_OUTPUT_OPT:
    case MESO_OPTION_PATTERN:
        *(const char **)option->value = text ? text : "";
        return MESO_OK;
    case MESO_OPTION_LIST:
        return add_text(option, text, error);
    case MESO_OPTION_CHOICE:
        return set_choice(option, text, error);
    case MESO_OPTION_SIZE:
        return set_size(option, text, error);
    case MESO_OPTION_POINT:
        return set_point(option, text, error);
    case MESO_OPTION_GROUP:
        break;
    }
    assert(false);  /* a group is no option, and never found */
    return MESO_ERR_INTERNAL;
}

/* Goes on after an error, so that --help works on any line; the first error counts. */
MesoStatus meso_options_parse(const MesoOption *options, int argc, char **argv,
                              const char **operands, uint32_t *operand_count, MesoError *error)
{
    Cursor cursor = {.options = options, .argc = argc, .next = 1, .argv = argv};
    Item item;
    MesoError first = {0}, failure = {0};
    *operand_count = 0;
    while (next_item(&cursor, &item, &failure) != ITEM_END) {
        if (item.kind == ITEM_OPERAND)
            operands[(*operand_count)++] = item.text;
        else if (item.kind == ITEM_OPTION && set_value(item.option, item.text, &failure) == MESO_OK &&
                 item.option->given)
            *item.option->given = true;
        if (failure.status && !first.status)
            first = failure;
    }
    return first.status ? meso_fail(error, first.status, "%s", first.message) : MESO_OK;
}

char *meso_options_quote(MesoArena *arena, const char *text, MesoError *error)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_@%+=:,./-";
    size_t length = strlen(text);
    if (length > 0 && strspn(text, plain) == length)
        return meso_arena_copy_text(arena, text, error);
    char *quoted = MESO_NEW(arena, char, 4 * length + 3, error);
    if (!quoted)
        return NULL;
    char *out = quoted;
    *out++ = '\'';
    for (; *text; text++) {
        if (*text == '\'') {
            memcpy(out, "'\\''", 4);
            out += 4;
        } else
            *out++ = *text;
    }
    *out = '\'';
    return quoted;
}

char *meso_options_append(const char *line, const char *name, const char *value, MesoArena *arena, MesoError *error)
{
    const char *quoted = meso_options_quote(arena, value, error);
    return quoted ? meso_arena_print(arena, error, "%s --%s %s", line, name, quoted) : NULL;
}

static char *append_item(char *line, const Item *item, MesoArena *arena, MesoError *error)
{
    char *value = item->text ? meso_options_quote(arena, item->text, error) : NULL;
    if (item->text && !value)
        return NULL;
    if (item->kind == ITEM_OPERAND)
        return meso_arena_print(arena, error, "%s %s", line, value);
    if (item->letter)
        return meso_arena_print(arena, error, "%s -%c%s%s", line, item->option->letter,
                                value ? " " : "", value ? value : "");
    return meso_arena_print(arena, error, "%s --%s%s%s", line, item->option->name,
                            !value ? "" : item->attached ? "=" : " ", value ? value : "");
}

char *meso_options_command_typed(const MesoOption *options, const char *program, int argc, char **argv,
                                 const MesoOptionChange *changes, MesoArena *arena, MesoError *error)
{
    Cursor cursor = {.options = options, .argc = argc, .next = 1, .argv = argv};
    Item item;
    char *line = meso_arena_copy_text(arena, program, error);
    bool dashes = false;
    for (const MesoOptionChange *change = changes; line && change && change->name; change++)
        if (change->value)
            line = meso_options_append(line, change->name, change->value, arena, error);
    while (line && next_item(&cursor, &item, NULL) != ITEM_END) {
        if (item.kind == ITEM_BAD)
            continue;
        if (item.option && (item.option->more & MESO_OPTION_SILENT || meso_option_change(changes, item.option)))
            continue;
        if (cursor.operands_only && !dashes) {
            line = meso_arena_print(arena, error, "%s --", line);
            dashes = true;
        }
        if (line)
            line = append_item(line, &item, arena, error);
    }
    return line;
}

/* Words of `text` from column `column` on, broken before column 80. */
static void print_wrapped(const char *text, int column)
{
    int at = column;
    while (*text) {
        int length = (int)strcspn(text, " ");
        if (at > column && at + 1 + length > HELP_WIDTH - 1) {
            printf("\n%*s", column, "");
            at = column;
        } else if (at > column) {
            putchar(' ');
            at++;
        }
        printf("%.*s", length, text);
        at += length;
        text += length;
        text += strspn(text, " ");
    }
    putchar('\n');
}

void meso_options_print(const MesoOption *options)
{
    for (; !meso_option_is_last(options); options++) {
        if (options->kind != MESO_OPTION_GROUP && !options->help)
            continue;
        if (options->kind == MESO_OPTION_GROUP) {
            printf("\n%s:\n", options->name);
            continue;
        }
        char left[80];
        const char *argument = options->kind == MESO_OPTION_CHOICE && !options->argument
                                   ? options->choices : options->argument;
        int length = options->letter ? snprintf(left, sizeof left, "  -%c, ", options->letter)
                                     : snprintf(left, sizeof left, "      ");
        length += snprintf(left + length, sizeof left - (size_t)length,
                           options->kind == MESO_OPTION_FLAG       ? "--%s"
                           : options->kind == MESO_OPTION_OUTPUT_OPT ? "--%s[=%s]"
                                                                   : "--%s %s",
                           options->name, argument);
        if (length > HELP_COLUMN - 2)
            printf("%s\n%*s", left, HELP_COLUMN, "");
        else
            printf("%-*s", HELP_COLUMN, left);
        print_wrapped(options->help, HELP_COLUMN);
    }
}

/* The rest of the line of `words` that begins with `name`, of `length` bytes; NULL where there is none. */
static const char *find_words(const char *words, const char *name, int *length)
{
    size_t size = strlen(name);
    for (; words && *words; words += *words == '\n') {
        size_t end = strcspn(words, "\n");
        if (end > size && strncmp(words, name, size) == 0 && words[size] == ' ') {
            *length = (int)(end - size - 1);
            return words + size + 1;
        }
        words += end;
    }
    return NULL;
}

static bool takes_file(const MesoOption *option)
{
    MesoOptionKind kind = option->kind;
    return kind == MESO_OPTION_INPUT || kind == MESO_OPTION_OUTPUT || kind == MESO_OPTION_OUTPUT_OPT ||
           kind == MESO_OPTION_PATTERN;
}

static void list_words(const MesoOption *option, const char *words)
{
    char name[64];
    int length;
    snprintf(name, sizeof name, "--%s", option->name);
    const char *found = find_words(words, name, &length);
    if (option->kind == MESO_OPTION_CHOICE) {
        for (const char *c = option->choices; *c; c++)
            putchar(*c == '|' ? ' ' : *c);
    } else if (found) {
        printf("%.*s", length, found);
    } else if (takes_file(option)) {
        putchar('*');
    } else if (option->kind == MESO_OPTION_FOLDER) {
        putchar('/');
    }
}

void meso_options_list(const MesoOption *options, const char *words)
{
    for (; !meso_option_is_last(options); options++) {
        if (options->kind == MESO_OPTION_GROUP || !options->help)
            continue;
        char letter[2] = {options->letter, 0};
        printf("option\t%s\t%s\t%s\t", options->name, letter,
               takes_value(options) ? "value" : options->kind == MESO_OPTION_FLAG ? "flag" : "optional");
        list_words(options, words);
        printf("\t%s\n", options->help);
    }
    for (int number = 1;; number++) {
        char name[16];
        int length;
        snprintf(name, sizeof name, "%d", number);
        const char *found = find_words(words, name, &length);
        if (!found)
            break;
        printf("operand\t%d\t%.*s\n", number, length, found);
    }
}
