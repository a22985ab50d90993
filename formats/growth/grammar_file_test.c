/* Grammars from files. */
#include "formats/growth/grammar_file.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/growth/language/grammar_fixture.h"

static MesoArena arena;
static MesoGrammar grammar;
static MesoError error;

static MesoStatus read(const char *text, size_t size)
{
    MesoInput input;
    meso_input_wrap(&input, "a.grammar", text, size);
    return meso_grammar_file_read(&grammar, &arena, &input, NULL, &error);
}

static void test_examples(void)
{
    static const char *const texts[] = {fixture_ivy, fixture_lace, fixture_cracks, fixture_feathers};
    for (uint32_t i = 0; i < 4; i++) {
        MesoStatus status = read(texts[i], strlen(texts[i]));
        if (status)
            fprintf(stderr, "%s\n", error.message);
        CHECK(status == MESO_OK && grammar.seed_count == 1);
        for (uint32_t rule = 0; rule < grammar.rule_count; rule++)
            CHECK(grammar.rules[rule].reached);
    }
}

static void test_wrong_files(void)
{
    static const char nothing[] = "", text[] = "meso-grow 1\nseed A() on vertices\n\nrule A() -> {\n  step(3)\n}\n";
    CHECK(read(nothing, 0) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.grammar:1:1: not a grammar: one begins with 'meso-grow 1'");
    CHECK(read(text, strlen(text)) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.grammar:5:8: 'length' must be a length, such as '3 mm'; this is a number");
    CHECK(read("meso-grow 1\0", 12) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.grammar: not a text");
}

int main(void)
{
    meso_arena_init(&arena);
    test_examples();
    test_wrong_files();
    meso_arena_release(&arena);
}
