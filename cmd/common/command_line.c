#include "cmd/common/command_line.h"

#include <inttypes.h>
#include <string.h>

#include "formats/file/float_text.h"
#include "formats/product/provenance.h"

static const char *float_text(float value, MesoArena *arena, MesoError *error)
{
    char text[MESO_FLOAT_TEXT];
    return meso_arena_print(arena, error, "%.*s", (int)(meso_float_text(value, text) - text), text);
}

static const char *point_text(const MesoVec3 *point, MesoArena *arena, MesoError *error)
{
    const char *x = float_text(point->x, arena, error), *y = float_text(point->y, arena, error);
    const char *z = float_text(point->z, arena, error);
    return x && y && z ? meso_arena_print(arena, error, "%s,%s,%s", x, y, z) : NULL;
}

/* NULL too where the list is empty. */
static const char *list_text(const MesoTextList *list, MesoArena *arena, MesoError *error)
{
    const char *text = list->count ? list->items[0] : NULL;
    for (uint32_t i = 1; text && i < list->count; i++)
        text = meso_arena_print(arena, error, "%s,%s", text, list->items[i]);
    return text;
}

/* Numbers by their value and not as they were spelled. False when memory is out. */
static bool value_text(const char **text, const MesoOption *option, MesoArena *arena, MesoError *error)
{
    const uint32_t *count = option->value;
    *text = NULL;
    switch (option->kind) {
    case MESO_OPTION_GROUP:
        return true;
    case MESO_OPTION_FLAG:
        *text = *(const bool *)option->value ? "" : NULL;
        return true;
    case MESO_OPTION_TEXT:
    case MESO_OPTION_CHOICE:
    case MESO_OPTION_INPUT:
    case MESO_OPTION_FOLDER:
    case MESO_OPTION_OUTPUT:
    case MESO_OPTION_OUTPUT_OPT:
    case MESO_OPTION_PATTERN:
        *text = *(const char *const *)option->value;
        return true;
    case MESO_OPTION_LIST:
        *text = list_text(option->value, arena, error);
        return *text || ((const MesoTextList *)option->value)->count == 0;
    case MESO_OPTION_COUNT:
        *text = meso_arena_print(arena, error, "%" PRIu32, *count);
        break;
    case MESO_OPTION_SEED:
        *text = meso_arena_print(arena, error, "%" PRIu64, *(const uint64_t *)option->value);
        break;
    case MESO_OPTION_NUMBER:
        *text = float_text(*(const float *)option->value, arena, error);
        break;
    case MESO_OPTION_SIZE:
        *text = meso_arena_print(arena, error, "%" PRIu32 "x%" PRIu32, count[0], count[1]);
        break;
    case MESO_OPTION_POINT:
        *text = point_text(option->value, arena, error);
        break;
    }
    return *text != NULL;
}

const char **meso_options_values(const MesoOption *options, MesoArena *arena, MesoError *error)
{
    size_t count = 0;
    while (!meso_option_is_last(&options[count]))
        count++;
    const char **values = MESO_NEW(arena, const char *, count + 1, error);
    for (size_t i = 0; values && i < count; i++)
        if (!value_text(&values[i], &options[i], arena, error))
            return NULL;
    return values;
}

static bool is_outward(const MesoOption *option)
{
    MesoOptionKind kind = option->kind;
    return kind == MESO_OPTION_GROUP || kind == MESO_OPTION_OUTPUT || kind == MESO_OPTION_OUTPUT_OPT ||
           kind == MESO_OPTION_PATTERN || option->more & (MESO_OPTION_SILENT | MESO_OPTION_OUTWARD);
}

static bool is_default(const MesoOption *option, const char *value, const char *by_default)
{
    if (option->more & MESO_OPTION_OVERRIDES)
        return !*option->given;
    return !value || (by_default && strcmp(value, by_default) == 0);
}

static char *append_meaning(char *line, const MesoOption *option, const char *value, MesoArena *arena, MesoError *error)
{
    MesoOptionKind kind = option->kind;
    if (kind == MESO_OPTION_FLAG)
        return meso_arena_print(arena, error, "%s --%s", line, option->name);
    if (kind == MESO_OPTION_INPUT || kind == MESO_OPTION_FOLDER)
        value = meso_provenance_name(value, arena, error);
    return value ? meso_options_append(line, option->name, value, arena, error) : NULL;
}

static char *append_operands(char *line, const char *const *operands, uint32_t count, MesoArena *arena,
                             MesoError *error)
{
    bool dashes = false;
    for (uint32_t i = 0; line && i < count; i++) {
        const char *name = meso_provenance_name(operands[i], arena, error);
        const char *quoted = name ? meso_options_quote(arena, name, error) : NULL;
        bool needed = quoted && !dashes && name[0] == '-' && name[1];
        dashes |= needed;
        line = quoted ? meso_arena_print(arena, error, "%s%s %s", line, needed ? " --" : "", quoted) : NULL;
    }
    return line;
}

char *meso_options_command_names(const MesoOption *options, const char *program, const char *const *defaults,
                                 const char *const *operands, uint32_t operand_count,
                                 const MesoOptionChange *changes, MesoArena *arena, MesoError *error)
{
    const char **values = meso_options_values(options, arena, error);
    char *line = values ? meso_arena_copy_text(arena, program, error) : NULL;
    for (size_t i = 0; line && !meso_option_is_last(&options[i]); i++) {
        if (is_outward(&options[i]))
            continue;
        const MesoOptionChange *change = meso_option_change(changes, &options[i]);
        const char *value = change ? change->value : values[i];
        if (!is_default(&options[i], value, defaults[i]))
            line = append_meaning(line, &options[i], value, arena, error);
    }
    return line ? append_operands(line, operands, operand_count, arena, error) : NULL;
}
