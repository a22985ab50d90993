#include "formats/decor/pattern_file.h"

#include <string.h>

#include "formats/decor/pattern_macros.h"
#include "formats/decor/pattern_materials.h"
#include "formats/decor/pattern_parser.h"
#include "formats/decor/pattern_steps.h"
#include "formats/json/json_text.h"

enum { MOST_MACRO_FILES = 1 << 10 };

static void add_builtin_macros(MesoPatternParser *parser)
{
    MesoInput input;
    meso_input_wrap(&input, "built-in macros", meso_builtin_macros, strlen(meso_builtin_macros));
    meso_macros_add_file(parser, &input);
}

static void add_macro_files(MesoPatternParser *parser, const MesoJsonField *list)
{
    uint32_t count = meso_json_count(list, 0, MOST_MACRO_FILES);
    for (uint32_t i = 0; i < count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        const MesoInput *input = meso_pattern_open(parser, &item);
        if (input)
            meso_macros_add_file(parser, input);
    }
}

/* The pattern's own macros go before those of its files, and those before the built-in ones. */
static void read_root(MesoPatternParser *parser, const MesoJsonField *root, MesoPattern *pattern)
{
    static const char *const keys[] = {"format", "version", "provenance", "materials", "macros", "macro_files", "steps",
                                       NULL};
    MesoJsonField materials = meso_json_key(root, "materials"), macros = meso_json_key(root, "macros");
    MesoJsonField files = meso_json_key(root, "macro_files"), steps = meso_json_key(root, "steps");
    if (!meso_json_object(root, keys))
        return;
    meso_pattern_materials(parser, &materials, pattern);
    add_builtin_macros(parser);
    add_macro_files(parser, &files);
    meso_macros_add(parser, &macros);
    meso_pattern_steps(parser, &steps, &pattern->steps, &pattern->step_count);
}

MesoStatus meso_pattern_read(MesoPattern *pattern, MesoArena *arena, const MesoInput *input,
                             const MesoJsonFiles *files, MesoError *error)
{
    json_t *root;
    *pattern = (MesoPattern){0};
    MesoStatus status = meso_json_parse(&root, input, error);
    if (status)
        return status;
    status = meso_json_check_format(root, input->path, "meso-pattern", MESO_PATTERN_VERSION, error);
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error, .status = status};
    MesoPatternParser parser = {.reader = &reader, .files = files};
    MesoJsonField field = meso_json_root(&reader, root);
    if (!status)
        read_root(&parser, &field, pattern);
    meso_macros_release(&parser);
    json_decref(root);
    return reader.status;
}
