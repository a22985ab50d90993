/* Macros: parameters, nesting, files, limits, and each of the built-in ones. */
#include <math.h>
#include <string.h>

#include "formats/decor/pattern_file.h"
#include "libcore/base/check.h"

typedef struct Case {
    MesoArena arena;
    MesoError error;
    MesoPattern pattern;
} Case;

static Case c;

static const char shared_macros[] =
    "{\"format\": \"meso-macros\", \"version\": 1, \"macros\": {\n"
    "\"ring\": {\"steps\": [{\"macro\": \"outline\", \"width\": 0.125}]},\n"
    "\"outline\": {\"parameters\": {\"width\": 0.75}, \"steps\": [{\"contour\": {\"at\": \"$width\"}}]}}}";
static const char broken_macros[] = "{\"format\": \"meso-macros\", \"version\": 1, \"macros\": {\"a\": {\"steps\": []}}}";
static const char other_format[] = "{\"format\": \"meso-pattern\", \"version\": 1}";

static const MesoInput *open_file(void *context, const char *name, MesoError *error)
{
    static MesoInput input;
    const char *text = strcmp(name, "shared.json") == 0   ? shared_macros
                       : strcmp(name, "broken.json") == 0 ? broken_macros
                       : strcmp(name, "other.json") == 0  ? other_format
                                                          : NULL;
    (*(int *)context)++;
    if (text)
        meso_input_wrap(&input, name, text, strlen(text));
    else
        meso_fail(error, MESO_ERR_INPUT, "cannot open '%s'", name);
    return text ? &input : NULL;
}

static MesoStatus read_with(const char *content, const MesoJsonFiles *files)
{
    const char *text = meso_arena_print(&c.arena, NULL, "{\"format\": \"meso-pattern\", \"version\": 1, \"materials\": "
                                        "{\"white\": \"#fff\", \"blue\": \"#00f\"}, %s}", content);
    MesoInput input;
    meso_input_wrap(&input, "p.json", text, strlen(text));
    return meso_pattern_read(&c.pattern, &c.arena, &input, files, &c.error);
}

static MesoStatus read(const char *content)
{
    int opened = 0;
    const MesoJsonFiles files = {&opened, open_file};
    return read_with(content, &files);
}

/* The steps of a pattern with macros; its only step is a call. */
static const MesoMacro *call(const char *macros, const char *step)
{
    if (read(meso_arena_print(&c.arena, NULL, "\"macros\": {%s}, \"steps\": [%s]", macros, step)) != MESO_OK) {
        fprintf(stderr, "%s\n", c.error.message);
        CHECK(false);
    }
    CHECK(c.pattern.step_count == 1 && c.pattern.steps[0].kind == MESO_STEP_MACRO);
    return &c.pattern.steps[0].macro;
}

static void expect_message(MesoStatus status, const char *message)
{
    if (status != MESO_ERR_INPUT || strcmp(c.error.message, message) != 0) {
        fprintf(stderr, "status %d: %s\nexpected: %s\n", status, status ? c.error.message : "", message);
        CHECK(false);
    }
}

static void refuse(const char *macros, const char *step, const char *message)
{
    expect_message(read(meso_arena_print(&c.arena, NULL, "\"macros\": {%s}, \"steps\": [%s]", macros, step)), message);
}

static bool is(const char *text, const char *expected) { return text && strcmp(text, expected) == 0; }

/* ---- parameters ---- */

static void test_parameters(void)
{
    static const char macros[] =
        "\"m\": {\"comment\": \"$no\", \"parameters\": {\"comment\": 1, \"n\": 8, \"of\": [\"inner\", \"outer\"], \"skin\": null, "
        "\"none\": null, \"name\": \"$$a\"}, \"steps\": [{\"comment\": \"$no\", \"contour\": {\"blend\": \"$of\", \"count\": \"$n\"}, "
        "\"paint\": \"$skin\", \"names\": \"$name\", \"on\": {\"tag\": [\"dot\", \"$none\"]}}]}";
    const MesoMacro *m = call(macros, "{\"macro\": \"m\", \"on\": \"body\", \"comment\": \"a call\"}");
    const MesoStep *s = m->steps;
    CHECK(is(m->name, "m") && m->step_count == 1 && is(c.pattern.steps[0].on.path, "body"));
    CHECK(s->levels.count == 8 && s->field.from.specs->kind == MESO_SEED_INNER && s->on.tag_count == 1);
    /* Values of parameters are values, in which nothing is replaced again. */
    CHECK(s->after_count == 1 && is(s->after->name, "$$a") && !s->after->painted);
    CHECK(is(s->place, "steps[0].macro m.steps[0]"));
    s = call(macros, "{\"macro\": \"m\", \"n\": 3, \"skin\": {\"stripe\": \"blue\"}, \"name\": null}")->steps;
    CHECK(s->levels.count == 3 && s->after_count == 1 && is(s->after->tag, "stripe") && !s->after->name);
    s = call("\"m\": {\"steps\": [{\"contour\": {}, \"names\": \"$$x\"}]}", "{\"macro\": \"m\"}")->steps;
    CHECK(is(s->after->name, "$x"));
}

/* What is left of a step that only a null parameter had to do is no step. */
static void test_optional_steps(void)
{
    static const char macros[] = "\"m\": {\"parameters\": {\"skin\": null, \"high\": null}, \"steps\": [{\"contour\": {}}, "
                                 "{\"on\": \".\", \"paint\": \"$skin\"}, {\"displace\": \"$high\"}]}";
    CHECK(call(macros, "{\"macro\": \"m\"}")->step_count == 1);
    const MesoMacro *m = call(macros, "{\"macro\": \"m\", \"skin\": \"blue\"}");
    CHECK(m->step_count == 2 && m->steps[1].kind == MESO_STEP_PAINT && is(m->steps[1].on.path, "."));
    CHECK(call(macros, "{\"macro\": \"m\", \"high\": 1}")->steps[1].kind == MESO_STEP_DISPLACE);
    refuse("\"m\": {\"parameters\": {\"skin\": null}, \"steps\": [{\"paint\": \"$skin\"}]}", "{\"macro\": \"m\"}",
           "p.json: steps[0].macro m.steps: 0 items; from 1 to 65536 are possible");
}

static void test_wrong_parameters(void)
{
    static const char m[] = "\"m\": {\"parameters\": {\"size\": 0.5}, \"steps\": [{\"contour\": {\"at\": \"$size\"}}]}";
    refuse(m, "{\"macro\": \"m\", \"sice\": 1}", "p.json: steps[0]: macro 'm' has no parameter 'sice'; did you mean 'size'?");
    refuse(m, "{\"macro\": \"m\", \"weight\": 1}", "p.json: steps[0]: \"weight\" is a key of rules of growth");
    refuse(m, "{\"macro\": \"m\", \"count\": 1}", "p.json: steps[0]: macro 'm' has no parameter 'count'");
    refuse(m, "{\"macro\": \"m\", \"size\": 2}", "p.json: steps[0].macro m.steps[0].contour.at: 2; it must be between 0 and 1");
    refuse(m, "{\"macro\": 7}", "p.json: steps[0].macro: the name of a macro is needed here");
    refuse(m, "{\"macro\": \"sunbrust\"}", "p.json: steps[0].macro: no macro 'sunbrust'; did you mean 'sunburst'?");
    refuse(m, "{\"macro\": \"zzzzzz\"}", "p.json: steps[0].macro: no macro 'zzzzzz'");
    refuse("\"m\": {\"parameters\": {\"size\": 1}, \"steps\": [{\"contour\": {\"at\": [0.5, \"$sise\"]}}]}", "{\"macro\": \"m\"}",
           "p.json: steps[0].macro m.steps[0].contour.at[1]: no parameter 'sise'; did you mean '$size'?");
    refuse("\"m\": {\"steps\": [{\"paint\": \"$x\"}]}", "{\"macro\": \"m\"}",
           "p.json: steps[0].macro m.steps[0].paint: no parameter 'x'; \"$$\" begins a text with '$'");
}

static void test_wrong_definitions(void)
{
    static const char paint[] = "{\"paint\": \"blue\"}";
    refuse("\"m\": []", paint, "p.json: macros.m: an object is needed here, not an array");
    refuse("\"m\": {}", paint, "p.json: macros.m.steps: missing");
    refuse("\"m\": {\"steps\": []}", paint, "p.json: macros.m.steps: 0 items; from 1 to 65536 are possible");
    refuse("\"m\": {\"params\": {}, \"steps\": [1]}", paint,
           "p.json: macros.m: unknown key \"params\"; there are \"parameters\", \"steps\"");
    refuse("\"m\": {\"parameters\": [\"n\"], \"steps\": [1]}", paint,
           "p.json: macros.m.parameters: an object is needed here, not an array");
    refuse("\"m\": {\"parameters\": {\"on\": 1}, \"steps\": [1]}", paint,
           "p.json: macros.m.parameters: \"on\" is a key of calls, and cannot be a parameter");
    refuse("\"\": {\"steps\": [1]}", paint, "p.json: macros.: a name of 0 characters; from 1 to 200 are possible");
}

/* ---- nesting ---- */

static void test_nesting(void)
{
    const MesoMacro *m = call("\"a\": {\"parameters\": {\"n\": 2}, \"steps\": [{\"macro\": \"b\", \"k\": \"$n\"}]},"
                              "\"b\": {\"parameters\": {\"k\": 9}, \"steps\": [{\"contour\": {\"count\": \"$k\"}}]}",
                              "{\"macro\": \"a\", \"n\": 5}");
    CHECK(m->step_count == 1 && is(m->steps->macro.name, "b") && m->steps->macro.steps->levels.count == 5);
    CHECK(is(m->steps->macro.steps->place, "steps[0].macro a.steps[0].macro b.steps[0]"));
    m = call("", "{\"on\": {\"tag\": \"cell\"}, \"steps\": [{\"contour\": {}}, {\"on\": {\"tag\": \"inside\"}, \"steps\": "
             "[{\"paint\": \"blue\"}]}]}");
    CHECK(is(m->name, "steps") && m->step_count == 2 && m->steps[1].macro.steps->kind == MESO_STEP_PAINT);
    CHECK(is(m->steps[1].macro.steps->place, "steps[0].steps[1].steps[0]"));
    refuse("\"a\": {\"steps\": [{\"macro\": \"a\"}]}", "{\"macro\": \"a\"}",
           "p.json: steps[0].macro a.steps[0]: macro 'a' calls itself");
    refuse("\"a\": {\"steps\": [{\"macro\": \"b\"}]}, \"b\": {\"steps\": [{\"steps\": [{\"grow\": {\"rules\": [{\"macro\": \"a\"}]}}]}]}",
           "{\"macro\": \"a\"}",
           "p.json: steps[0].macro a.steps[0].macro b.steps[0].steps[0].grow.rules[0]: macro 'a' calls itself");
}

/* A chain of macros, each of which calls the next one `times`. */
static const char *chain(uint32_t length, uint32_t times)
{
    char *text = meso_arena_print(&c.arena, NULL, "\"m0\": {\"steps\": [{\"paint\": \"blue\"}]}");
    for (uint32_t i = 1; i < length; i++) {
        text = meso_arena_print(&c.arena, NULL, "%s, \"m%u\": {\"steps\": [", text, i);
        for (uint32_t k = 0; k < times; k++)
            text = meso_arena_print(&c.arena, NULL, "%s%s{\"macro\": \"m%u\"}", text, k ? ", " : "", i - 1);
        text = meso_arena_print(&c.arena, NULL, "%s]}", text);
    }
    return text;
}

static void expect_end(MesoStatus status, const char *end)
{
    size_t length = strlen(c.error.message), own = strlen(end);
    if (status != MESO_ERR_INPUT || length < own || strcmp(c.error.message + length - own, end) != 0) {
        fprintf(stderr, "status %d: %s\n", status, c.error.message);
        CHECK(false);
    }
}

static void test_limits(void)
{
    call(chain(MESO_PATTERN_NESTING, 1), "{\"macro\": \"m31\"}");
    expect_end(read(meso_arena_print(&c.arena, NULL, "\"macros\": {%s}, \"steps\": [{\"macro\": \"m32\"}]",
                                     chain(MESO_PATTERN_NESTING + 1, 1))), ": macros in more than 32 macros");
    call(chain(15, 2), "{\"macro\": \"m14\"}");
    expect_end(read(meso_arena_print(&c.arena, NULL, "\"macros\": {%s}, \"steps\": [{\"macro\": \"m31\"}]", chain(32, 2))),
               ": more than 65536 steps, with those of macros");
    expect_end(read("\"macros\": {\"m\": {\"parameters\": {\"p\": 0}, \"steps\": [{\"contour\": {\"dist\": {\"points\": [\"$p\", \"$p\"]}}}]},"
                    "\"n\": {\"parameters\": {\"p\": 0}, \"steps\": [{\"macro\": \"m\", \"p\": [[1,1,[\"$p\"]]]}]}},"
                    "\"steps\": [{\"macro\": \"n\", \"p\": [1]}]"), ": 1 items; 3 are needed");
}

/* A parameter is counted each time that it is written out, and deep ones are refused. */
static void test_large_parameters(void)
{
    enum { ITEMS = 3000, CALLS = 400, DEPTH = 300 };
    static char list[2 * ITEMS + 1], uses[6 * CALLS + 1], deep[2 * DEPTH + 1];
    for (uint32_t i = 0; i < ITEMS; i++)
        memcpy(list + 2 * i, i + 1 < ITEMS ? "1," : "1", 3 - (i + 1 == ITEMS));
    for (uint32_t i = 0; i < CALLS; i++)
        memcpy(uses + 5 * i, i + 1 < CALLS ? "\"$p\"," : "\"$p\"", 6 - (i + 1 == CALLS));
    expect_end(read(meso_arena_print(&c.arena, NULL, "\"macros\": {\"m\": {\"parameters\": {\"p\": [%s]}, \"steps\": [{\"paint\": [%s]}]}}, "
                                     "\"steps\": [{\"macro\": \"m\"}]", list, uses)), ": macros write out more than 1048576 values");
    memset(deep, '[', DEPTH);
    memset(deep + DEPTH, ']', DEPTH);
    expect_end(read(meso_arena_print(&c.arena, NULL, "\"macros\": {"
                                     "\"b\": {\"parameters\": {\"p\": 0}, \"steps\": [{\"paint\": [%.*s\"$p\"%.*s]}]}}, "
                                     "\"steps\": [{\"macro\": \"b\", \"p\": %s}]", DEPTH, deep, DEPTH, deep + DEPTH, deep)),
               ": more than 512 levels");
}

/* ---- files ---- */

static void test_files(void)
{
    static const char calls[] = "\"steps\": [{\"macro\": \"ring\"}, {\"macro\": \"outline\"}]";
    int opened = 0;
    const MesoJsonFiles files = {&opened, open_file};
    /* A file's macro goes before a built-in one of its name, and the pattern's own before both. */
    CHECK(read_with(meso_arena_print(&c.arena, NULL, "\"macro_files\": [\"shared.json\"], %s", calls), &files) == MESO_OK);
    CHECK(opened == 1 && c.pattern.steps[0].macro.steps->macro.steps->levels.values[0] == 0.125f);
    CHECK(c.pattern.steps[1].macro.steps->levels.values[0] == 0.75f);
    CHECK(read(meso_arena_print(&c.arena, NULL, "\"macro_files\": [\"shared.json\"], \"macros\": {\"outline\": {\"parameters\": "
                                "{\"width\": 0.25}, \"steps\": [{\"contour\": {\"every\": \"$width\"}}]}}, %s", calls)) == MESO_OK);
    CHECK(c.pattern.steps[0].macro.steps->macro.steps->levels.every == 0.125f);
    CHECK(c.pattern.steps[1].macro.steps->levels.every == 0.25f);
    expect_message(read("\"macro_files\": [\"broken.json\"], \"steps\": [1]"),
                   "broken.json: macros.a.steps: 0 items; from 1 to 65536 are possible");
    expect_message(read("\"macro_files\": [\"other.json\"], \"steps\": [1]"),
                   "other.json: is a 'meso-pattern' file; a 'meso-macros' file is needed here");
    expect_message(read("\"macro_files\": [\"none.json\"], \"steps\": [1]"), "p.json: macro_files[0]: cannot open 'none.json'");
    expect_message(read("\"macro_files\": \"shared.json\", \"steps\": [1]"),
                   "p.json: macro_files: an array is needed here, not a string");
    expect_message(read_with("\"macro_files\": [\"shared.json\"], \"steps\": [1]", NULL),
                   "p.json: macro_files[0]: other files cannot be read here");
}

/* ---- the built-in ones ---- */

static const MesoMacro *builtin(const char *step) { return call("", step); }

static void test_builtin(void)
{
    const MesoStep *s = builtin("{\"macro\": \"sunburst\", \"lines\": 7, \"paint\": [\"white\", \"blue\"]}")->steps;
    CHECK(s->kind == MESO_STEP_STREAM && s->line_count == 7 && s->field.blend && s->after->by == MESO_PAINT_CYCLE);
    s = builtin("{\"macro\": \"polka-dots\", \"size\": 2, \"unit\": \"scene\", \"paint\": {\"dot\": \"blue\"}}")->steps;
    CHECK(s->kind == MESO_STEP_CONTOUR && s->levels.values[0] == 2 && s->levels.unit == MESO_LEVEL_SCENE);
    CHECK(s->field.from.specs->kind == MESO_SEED_POISSON && s->field.from.specs->count == 24);
    s = builtin("{\"macro\": \"frames\", \"count\": 6}")->steps;
    CHECK(s->levels.count == 6 && s->field.from.specs->kind == MESO_SEED_BORDERS);
    s = builtin("{\"macro\": \"flower\", \"noise\": {\"gain\": 0.1}}")->steps;
    CHECK(s->field.blend && s->field.to.specs->kind == MESO_SEED_BORDERS && s->field.noise.gain == 0.1f);
    s = builtin("{\"macro\": \"outline\", \"displace\": {\"band\": 0.1}, \"names\": {\"band\": \"rim\"}}")->steps;
    CHECK(s->after_count == 1 && is(s->after->name, "rim") && s->after->displacement.height == 0.1f);
    s = builtin("{\"macro\": \"lace\", \"along\": \"outer\", \"spacing\": 0.2}")->steps;
    CHECK(s->field.from.specs->kind == MESO_SEED_ALONG && s->field.from.specs->of == MESO_SEED_OUTER);
    s = builtin("{\"macro\": \"cells\", \"count\": 5}")->steps;
    CHECK(s->kind == MESO_STEP_VORONOI && s->field.from.specs->count == 5 && s->after_count == 0);
}

static void test_grid(void)
{
    const MesoMacro *m = builtin("{\"macro\": \"grid\", \"rows\": 3, \"columns\": 9, \"even\": \"white\", \"odd\": \"blue\"}");
    CHECK(m->step_count == 4 && m->steps[0].levels.count == 3 && m->steps[1].line_count == 9);
    CHECK(is(m->steps[1].on.path, ".") && m->steps[1].on.level == MESO_SELECT_NODES);
    CHECK(m->steps[3].on.colors == 2 && m->steps[3].on.color == 1 && m->steps[3].after->materials[0] == 1);
    CHECK(builtin("{\"macro\": \"grid\"}")->step_count == 2);
}

int main(void)
{
    meso_arena_init(&c.arena);
    test_parameters();
    test_optional_steps();
    test_wrong_parameters();
    test_wrong_definitions();
    test_nesting();
    test_limits();
    test_large_parameters();
    test_files();
    test_builtin();
    test_grid();
    meso_arena_release(&c.arena);
}
