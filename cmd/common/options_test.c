/* The option table: every kind, every mistake, recorded command lines. */
#include "cmd/common/command_line.h"

#include <string.h>

#include "libcore/base/check.h"

typedef struct Values {
    bool flag, other, given;
    uint32_t count, plain, size[2];
    uint64_t seed;
    float number, free_number;
    const char *text, *optional, *choice, *input, *output, *pattern, *folder;
    bool eye_given;
    MesoVec3 point;
    MesoTextList list;
} Values;

static Values v;

static const MesoOption options[] = {
    MESO_GROUP("Things"),
    MESO_FLAG('f', "flag", "a flag", &v.flag, .given = &v.given, .more = MESO_OPTION_SILENT),
    MESO_FLAG('g', "other", "another", &v.other),
    MESO_COUNT('c', "count", "N", "a count", &v.count, 2, 4096),
    MESO_COUNT(0, "plain", "N", "a count without limits", &v.plain, 0, 0, .more = MESO_OPTION_SILENT),
    MESO_SEED('s', "seed", "N", "a seed", &v.seed),
    MESO_NUMBER('n', "number", "X", "a number", &v.number, 1e-4, 1),
    MESO_NUMBER(0, "free", "X", "any number", &v.free_number, 0, 0),
    MESO_TEXT('t', "text", "TEXT", "a text", &v.text),
    MESO_LIST(0, "set", "A=B", "some texts", &v.list),
    MESO_OUTPUT_FILE_OPT('j', "json", "FILE", "perhaps a text", &v.optional, .more = MESO_OPTION_SILENT),
    MESO_CHOICE(0, "choice", "HOW", "one of them", &v.choice, "auto|none|json"),
    MESO_SIZE(0, "size", "WxH", "a size", v.size, 1, 16384),
    MESO_POINT('p', "point", "X,Y,Z", "a point", &v.point, .given = &v.eye_given,
               .more = MESO_OPTION_OVERRIDES),
    MESO_INPUT_FILE(0, "input", "FILE", "is read", &v.input),
    MESO_FOLDER(0, "folder", "DIR", "is looked in", &v.folder),
    MESO_OUTPUT_FILE('o', "output", "FILE", "is written", &v.output),
    MESO_PATTERN(0, "each", "PATTERN", "are written", &v.pattern),
    {0}};

static const char *operands[16];
static uint32_t operand_count;

/* Splits `line` at blanks and parses it. */
static MesoStatus parse(const char *line, MesoError *error)
{
    static char copy[256];
    char *arguments[16];
    int count = 0;
    v = (Values){0};
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        arguments[count++] = word;
    return meso_options_parse(options, count, arguments, operands, &operand_count, error);
}

static void expect_error(const char *line, const char *message)
{
    MesoError error;
    CHECK(parse(line, &error) == MESO_ERR_USAGE);
    if (strcmp(error.message, message) != 0)
        fprintf(stderr, "%s: %s\n", line, error.message);
    CHECK(strcmp(error.message, message) == 0);
}

static void test_good(void)
{
    MesoError error;
    CHECK(parse("x", &error) == MESO_OK && operand_count == 0 && !v.given);
    CHECK(parse("x a -f b - --count 7 c", &error) == MESO_OK);
    CHECK(v.flag && v.given && v.count == 7 && operand_count == 4);
    CHECK(strcmp(operands[0], "a") == 0 && strcmp(operands[2], "-") == 0);
    CHECK(strcmp(operands[3], "c") == 0);
    CHECK(parse("x -fgc9 -n0.5 --text=a=b -s18", &error) == MESO_OK);
    CHECK(v.flag && v.other && v.count == 9 && v.number == 0.5f && v.seed == 18);
    CHECK(strcmp(v.text, "a=b") == 0);
    CHECK(parse("x --free -1.5e3 --text --flag -- -f --", &error) == MESO_OK);
    CHECK(v.free_number == -1500 && strcmp(v.text, "--flag") == 0 && !v.flag);
    CHECK(operand_count == 2 && strcmp(operands[1], "--") == 0);
    CHECK(parse("x --json a --choice none --size 640x480 -p 1,-2,3e1", &error) == MESO_OK);
    CHECK(v.optional && *v.optional == 0 && operand_count == 1 && strcmp(v.choice, "none") == 0);
    CHECK(v.size[0] == 640 && v.size[1] == 480 && v.point.y == -2 && v.point.z == 30);
    CHECK(parse("x --json=a -jf --text=", &error) == MESO_OK && *v.optional == 0 && v.flag);
    CHECK(*v.text == 0);
    CHECK(parse("x --json=a --seed=9223372036854775807 --plain 4294967295", &error) == MESO_OK);
    CHECK(strcmp(v.optional, "a") == 0 && v.seed == INT64_MAX && v.plain == UINT32_MAX);
    CHECK(parse("x --count 2 --count 4096 -n 1e-4 -n 1", &error) == MESO_OK && v.count == 4096);
    CHECK(parse("x --set a=1 --set=b=2,c=3 d", &error) == MESO_OK && v.list.count == 2 && operand_count == 1);
    CHECK(strcmp(v.list.items[0], "a=1") == 0 && strcmp(v.list.items[1], "b=2,c=3") == 0);
}

static void test_bad(void)
{
    expect_error("x --no-such", "unknown option '--no-such'");
    expect_error("x --no-such=1", "unknown option '--no-such'");
    expect_error("x --cou 5", "unknown option '--cou'; did you mean '--count'?");
    expect_error("x --counts 5", "unknown option '--counts'; did you mean '--count'?");
    expect_error("x -fz", "unknown option '-z'");
    expect_error("x -f=1", "unknown option '-='");
    expect_error("x --Things", "unknown option '--Things'");
    expect_error("x --flag=yes", "option '--flag' takes no value");
    expect_error("x --count", "option '--count' needs N");
    expect_error("x -fc", "option '-c' needs N");
    expect_error("x -c 1", "option '--count' needs a whole number from 2 to 4096, not '1'");
    expect_error("x -c 4097", "option '--count' needs a whole number from 2 to 4096, not '4097'");
    expect_error("x -c 12x", "option '--count' needs a whole number from 2 to 4096, not '12x'");
    expect_error("x -c -5", "option '--count' needs a whole number from 2 to 4096, not '-5'");
    expect_error("x -c 3.5", "option '--count' needs a whole number from 2 to 4096, not '3.5'");
    expect_error("x --count=", "option '--count' needs a whole number from 2 to 4096, not ''");
    expect_error("x --plain 4294967296",
                 "option '--plain' needs a whole number from 0 to 4294967295, not '4294967296'");
    expect_error("x -s 9223372036854775808", "option '--seed' needs a whole number from 0 to "
                                             "9223372036854775807, not '9223372036854775808'");
    expect_error("x -s 99999999999999999999", "option '--seed' needs a whole number from 0 to "
                                              "9223372036854775807, not '99999999999999999999'");
    expect_error("x -n 2", "option '--number' needs a number from 0.0001 to 1, not '2'");
    expect_error("x --free nan", "option '--free' needs a number, not 'nan'");
    expect_error("x --free inf", "option '--free' needs a number, not 'inf'");
    expect_error("x --free 1e39", "option '--free' needs a number, not '1e39'");
    expect_error("x --free 0x10", "option '--free' needs a number, not '0x10'");
    expect_error("x --free 1,5", "option '--free' needs a number, not '1,5'");
    expect_error("x --free e", "option '--free' needs a number, not 'e'");
    expect_error("x --choice no", "option '--choice' needs one of auto, none, json, not 'no'");
    expect_error("x --choice auto|none",
                 "option '--choice' needs one of auto, none, json, not 'auto|none'");
    expect_error("x --choice=", "option '--choice' needs one of auto, none, json, not ''");
    for (const char *const *bad = (const char *const[]){"640", "640x", "x480", "0x5", "16385x1",
                                                        "1x2x3", "-1x2", NULL}; *bad; bad++) {
        char line[64], message[128];
        snprintf(line, sizeof line, "x --size %s", *bad);
        snprintf(message, sizeof message,
                 "option '--size' needs WIDTHxHEIGHT, each from 1 to 16384, not '%s'", *bad);
        expect_error(line, message);
    }
    expect_error("x -p 1,2", "option '--point' needs three numbers X,Y,Z, not '1,2'");
    expect_error("x -p 1,2,3,4", "option '--point' needs three numbers X,Y,Z, not '1,2,3,4'");
    expect_error("x -p 1,,3", "option '--point' needs three numbers X,Y,Z, not '1,,3'");
    expect_error("x -p 1,2,nan", "option '--point' needs three numbers X,Y,Z, not '1,2,nan'");

    /* The first error counts, and what stands after it is still read. */
    MesoError error;
    CHECK(parse("x --no-such -c 1 -f a", &error) == MESO_ERR_USAGE && v.flag && operand_count == 1);
    CHECK(strcmp(error.message, "unknown option '--no-such'") == 0);
}

static void test_typed(void)
{
    char *arguments[] = {(char[]){"./bin/x"}, (char[]){"-fgc9"}, (char[]){"--plain"}, (char[]){"7"},
                         (char[]){"--json=a"}, (char[]){"a b"}, (char[]){"--text=it's"},
                         (char[]){"--seed"}, (char[]){"5"}, (char[]){"-t"}, (char[]){""},
                         (char[]){"--"}, (char[]){"-f"}, (char[]){"$HOME"}};
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    const char *line = meso_options_command_typed(options, "x", 14, arguments, NULL, &arena, &error);
    CHECK(strcmp(line, "x -g -c 9 'a b' --text='it'\\''s' --seed 5 -t '' -- -f '$HOME'") == 0);
    CHECK(strcmp(meso_options_command_typed(options, "x", 2, arguments, NULL, &arena, &error), "x -g -c 9") == 0);
    const MesoOptionChange changes[] = {{"seed", "7"}, {"text", NULL}, {NULL, NULL}};
    line = meso_options_command_typed(options, "x", 14, arguments, changes, &arena, &error);
    CHECK(strcmp(line, "x --seed 7 -g -c 9 'a b' -- -f '$HOME'") == 0);
    meso_arena_release(&arena);
}

/* The command by names of `line`. */
static void expect_names(const char *line, const MesoOptionChange *changes, const char *expected)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    v = (Values){0};
    const char **defaults = meso_options_values(options, &arena, &error);
    CHECK(defaults && parse(line, &error) == MESO_OK);
    const char *names = meso_options_command_names(options, "x", defaults, operands, operand_count, changes, &arena,
                                                   &error);
    if (!names || strcmp(names, expected) != 0)
        fprintf(stderr, "%s: %s\n", line, names ? names : "none");
    CHECK(names && strcmp(names, expected) == 0);
    meso_arena_release(&arena);
}

static void test_names(void)
{
    /* What was left out, spelled otherwise, or in another order, is the same. */
    expect_names("bin/x a/b.obj", NULL, "x b.obj");
    expect_names("x --seed 0 -f --json=r -o a/out --each e%d ../b.obj --plain 3", NULL, "x b.obj");
    expect_names("x -s 7 -n 0.50 /b.obj --count 3", NULL, "x --count 3 --seed 7 --number 0.5 b.obj");
    expect_names("x --number=5e-1 -c3 --seed=3 b.obj -s07", NULL, "x --count 3 --seed 7 --number 0.5 b.obj");
    expect_names("x -g --text a/b --choice none --size 4x5 --input c/d --folder e/f/ - ", NULL,
                 "x --other --text a/b --choice none --size 4x5 --input d --folder f -");
    /* A default that overrides is said, where it is given. */
    expect_names("x -p 0,0,0 a", NULL, "x --point 0,0,0 a");
    expect_names("x -p 1,2e-1,-3 -- -a", NULL, "x --point 1,0.2,-3 -- -a");
    const MesoOptionChange changes[] = {{"seed", "9"}, {"count", NULL}, {"output", "z"}, {NULL, NULL}};
    expect_names("x --seed 7 -c 3 a", changes, "x --seed 9 a");
    expect_names("x a", changes, "x --seed 9 a");
    expect_names("x --set a=1 a --set b=2,c=3", NULL, "x --set a=1,b=2,c=3 a");
}

int main(void)
{
    test_good();
    test_bad();
    test_typed();
    test_names();
    return 0;
}
