/* What is said of wrong grammars: where, and what would be right. */
#include <stdint.h>

#include "libcore/growth/language/grammar_fixture.h"

static MesoArena arena;
static MesoError error;

static MesoStatus read(const char *text, size_t size, const MesoGrammarOptions *options)
{
    MesoGrammar grammar;
    return meso_grammar_read(&grammar, &arena, "g", text, size, options, &error);
}

static void refuse(const char *text, const char *message)
{
    CHECK(read(text, strlen(text), NULL) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

/* A rule's body, behind "rule A(w) -> " in line 5, where w is a length of 2 mm. */
static void refuse_body(const char *body, const char *message)
{
    char text[1024], wanted[512];
    snprintf(text, sizeof text, HEAD "map wall = attribute(\"wall\") map hole = region(\"hole\")\nfield flow = up\n"
             "shape stem = tube seed A(2 mm) on vertices\nrule A(w) -> %s", body);
    snprintf(wanted, sizeof wanted, "g:5:%s", message);
    refuse(text, wanted);
}

/* The declarations behind the first line. */
static void refuse_declaration(const char *declaration, const char *message)
{
    char text[1024], wanted[512];
    snprintf(text, sizeof text, HEAD "%s", declaration);
    snprintf(wanted, sizeof wanted, "g:2:%s", message);
    refuse(text, wanted);
}

static void test_heading(void)
{
    refuse("", "g:1:1: not a grammar: one begins with 'meso-grow 1'");
    refuse("{\"format\":\"meso-pattern\"}", "g:1:1: not a grammar: one begins with 'meso-grow 1'");
    refuse("meso-grow", "g:1:1: not a grammar: one begins with 'meso-grow 1'");
    refuse("meso-grow 2", "g:1:11: a grammar of version 2; this program knows 1");
    refuse("meso-grow 0.5", "g:1:11: there is no version 0.5");
    refuse("\xef\xbb\xbf# only this\r\nmeso-grow 1\r\n", "g:3:1: nothing grows without a 'seed'");
    CHECK(read("meso-grow 1\0", 12, NULL) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "g:1:1: not a text: it holds a zero byte");
    size_t size = MESO_GRAMMAR_TEXT + 1;
    char *text = malloc(size);
    CHECK(text);
    memset(text, ' ', size);
    CHECK(read(text, size, NULL) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "g:1:1: longer than 1048576 bytes");
    free(text);
}

static void test_words_and_signs(void)
{
    refuse_body("{ turn(1 rad) ; }", "28: ';' has no meaning here");
    refuse_body("{ turn(1 rad) \xc3\xa9 }", "28: a character that has no meaning outside texts and comments");
    refuse(HEAD "# \xc3\xa9\xc3\xa9\rmap a = image(\"\xc3\xa9\xc3\xa9\", !", "g:3:21: '!' has no meaning here");
}

static void test_declarations(void)
{
    refuse_declaration("rules A() -> stop", "1: 'rules' is not a declaration; did you mean 'rule'?");
    refuse_declaration("grow", "1: 'grow' is not a declaration; there are unit, param, map, field, shape, limit, seed, rule");
    refuse_declaration("3", "1: a declaration is wanted, instead of '3'");
    refuse_declaration("unit inch", "6: 'inch' is not a unit of the surface; there are um, mm, cm, dm, m, km");
    refuse_declaration("unit deg", "6: 'deg' is not a unit of the surface; there are um, mm, cm, dm, m, km");
    refuse_declaration("param a = 3 mm unit mm", "21: the unit must stand before the first length");
    refuse_declaration("param a = rand(0, 1)", "11: a parameter must not depend on the place or on chance");
    refuse_declaration("param a = 3 param a = 4", "19: 'a' is a name already, at line 2");
    refuse_declaration("param step = 3", "7: 'step' is a word of the language; choose another name");
    refuse_declaration("param 3 = 3", "7: the name of a parameter is wanted, instead of '3'");
    refuse_declaration("param a 3", "9: '=' is wanted behind the name, instead of '3'");
    refuse_declaration("param a = 1 / 0", "13: '/' gives no finite number here");
    refuse_declaration("param a = 1e999", "11: the number is too large");
    refuse_declaration("param aaaaaaaaaabbbbbbbbbbccccccccccddddddddddeeeeeeeeeeffffffffffggggg = 1",
                       "7: the name is longer than 64 letters");
    refuse_declaration("map a = picture(\"a.png\")",
                       "9: 'picture' is not a source of a map; there are image, attribute, region, border, points, curve");
    refuse_declaration("map a = imag(\"a.png\")", "9: 'imag' is not a source of a map; did you mean 'image'?");
    refuse_declaration("map a = image", "9: 'image' wants its 'file'");
    refuse_declaration("map a = image(a)", "15: 'file' must be a text in quotation marks, instead of 'a'");
    refuse_declaration("map a = image(\"\")", "15: 'file' must not be empty");
    refuse_declaration("map a = image(\"a.png)\n", "15: the text does not end on its line: '\"' is missing");
    refuse_declaration("map a = image(\"a\", channel: q)", "29: 'q' is not a channel; there are r, g, b, a");
    refuse_declaration("map a = image(\"a\", chanel: r)", "20: 'chanel' is not an argument of 'image'; did you mean 'channel'?");
    refuse_declaration("map a = image(\"a\", channel: r, linear)", "32: an argument without a name cannot follow one with a name");
    refuse_declaration("map a = image(\"a\", r, channel: r)", "23: 'channel' is given twice");
    refuse_declaration("map a = points(\"a\", \"b\")", "21: 'points' has no argument more");
    refuse_declaration("map a = image(\"a\", uv: 3 mm)", "24: 'uv' must be a number; this is a length");
    refuse_declaration("map a = image(\"a\", uv: height)", "24: 'uv' must not depend on the place or on chance");
    refuse_declaration("field f = gradient(wal)", "20: 'wal' is not a map");
    refuse_declaration("map wall = border field f = gradient(wal)", "38: 'wal' is not a map; did you mean 'wall'?");
    refuse_declaration("field f = world(1, 0)", "11: 'world' wants its 'z'");
    refuse_declaration("field b = -groom",
                       "12: 'groom' is not a source of a field; there are up, world, point, gradient, attribute, "
                       "principal, random");
    refuse_declaration("field groom = up field b = -grom", "29: 'grom' is not a source of a field; did you mean 'groom'?");
    refuse_declaration("field b = b", "11: 'b' is not a source of a field; there are up, world, point, gradient, attribute, "
                       "principal, random");
    refuse_declaration("shape s = cube", "11: 'cube' is not a source of a shape; did you mean 'tube'?");
    refuse_declaration("limit rounds 3", "7: 'rounds' is not a limit; there are generations, elements, length");
    refuse_declaration("limit length 3", "14: the limit must be a length, such as '3 mm'; this is a number");
    refuse_declaration("limit elements -3", "16: a limit must be more than 0");
}

static void test_seeds(void)
{
    refuse_declaration("rule A() -> stop", "17: nothing grows without a 'seed'");
    refuse_declaration("seed A()", "9: 'on' is wanted before the places of seeds, instead of the end");
    refuse_declaration("seed step() on vertices", "6: 'step' is not the name of a rule");
    refuse_declaration("seed A on vertices", "8: '(' is wanted behind the name of a rule, instead of 'on'");
    refuse_declaration("seed A() on vertexes rule A() -> stop", "13: 'vertexes' is not a kind of places; did you mean 'vertices'?");
    refuse_declaration("seed A() on poisson(3)\nrule A() -> stop", "21: 'radius' must be a length, such as '3 mm'; this is a number");
    refuse_declaration("seed A() on poisson(height * height)\nrule A() -> stop",
                       "28: 'radius' must be a length, such as '3 mm'; this is a quantity in length^2");
    refuse_declaration("seed A() on vertices where height\nrule A() -> stop",
                       "28: 'where' must be a condition, such as 'w > 1 mm'; this is a length");
    refuse_declaration("seed A() on vertices where true where true", "33: 'where' is given twice; join them with 'and'");
    refuse_declaration("seed A() on vertices count 0", "22: 'count' must be more than 0");
    refuse_declaration("seed A() on vertices count 1 count 2", "30: 'count' is given twice");
    refuse_declaration("seed A() on vertices face up face up", "30: 'face' is given twice");
    refuse_declaration("seed A() on vertices count height", "28: 'count' must not depend on the place or on chance");
    refuse_declaration("seed A() on vertices face upp", "27: 'upp' is not a direction; did you mean 'up'?");
    refuse_declaration("seed A() on vertices rule B() -> stop", "6: there is no rule 'A'");
    refuse_declaration("seed Shot() on vertices rule Shoot() -> stop", "6: there is no rule 'Shot'; did you mean 'Shoot'?");
    refuse_declaration("seed A(1) on vertices rule A() -> stop", "6: 'A' wants 0 arguments, and 1 are given");
}

static void test_rules(void)
{
    refuse_body("", "14: a command is wanted, instead of the end");
    refuse_body("{ turn(1 rad)", "14: '{' has no '}'");
    refuse_body("grow", "14: 'grow' is not a command; there are step, move, turn, face, place, stop, branch, if, choose, repeat, let");
    refuse_body("trun(1 rad)", "14: there is no rule 'trun'");
    refuse_body("stepp(1 mm)", "14: there is no rule 'stepp'");
    refuse_body("stop rule A(v) -> stop",
                "24: never used: 'A' has no condition at line 5; put this one first");
    refuse_body("stop rule A(v, u) -> stop", "24: 'A' has 1 argument at line 5, and 2 here");
    refuse_body("{ stop stop }", "21: nothing can follow 'stop', with which the rule ends; put that into 'branch { }'?");
    refuse_body("{ step(w) A(w) stop }", "29: nothing can follow 'A', with which the rule ends; put that into 'branch { }'?");
    refuse_body("{ step(w) A(w, w) }", "24: 'A' wants 1 argument, and 2 are given");
    refuse_body("{ step(w) A(30 deg) }", "26: argument 1 of 'A' is an angle here, and a length elsewhere");
    refuse_body("{ step(w) stem(3) }", "24: 'stem' is no rule; it was named at line 4");
    refuse_body("{ else stop }", "16: 'else' belongs behind the block of an 'if' or behind a 'step'");
    refuse_body("{ join }", "16: 'join' belongs behind 'step(...) else'");
    refuse_body("{ if w > 0 stop }", "25: '{' is wanted before the commands, instead of 'stop'");
    refuse_body("{ if w { stop } }", "19: the condition of 'if' must be a condition, such as 'w > 1 mm'; this is a length");
    refuse_body("{ let w = 3 }", "20: 'w' is a name already, at line 5");
    refuse_body("{ branch { let v = 3 } turn(v * 1 rad) }", "42: 'v' is not a known quantity");
    refuse_body("choose { }", "23: a quantity is wanted, instead of '}'");
    refuse_body("choose 1: stop", "21: '{' is wanted behind 'choose', instead of '1'");
    refuse_body("choose { 1 stop }", "25: ':' is wanted behind the weight of a choice, instead of 'stop'");
    refuse_body("choose { w: stop }", "23: a weight must be a number; this is a length");
    refuse_body("repeat w { }", "21: the number of turns must be a number; this is a length");
    refuse_body("repeat 2 { repeat 2 { repeat 2 { repeat 2 { } } } }", "47: more than 3 repetitions in one another");
    refuse_body("A(w", "17: ')' is wanted behind the arguments of a rule, instead of the end");
    refuse(HEAD "seed A(1) on vertices rule A(w -> stop",
           "g:2:32: ')' is wanted behind the arguments of a rule, instead of '->'");
    refuse(HEAD "seed A(1) on vertices rule A(w) stop",
           "g:2:33: '->' is wanted before what a rule becomes, instead of 'stop'");
    refuse_body("A(w)", "14: 'A' comes back to itself without a step (A -> A); put a step before it, or use 'repeat'");
    refuse(HEAD "seed A(1) on vertices rule A(w) -> stop rule B(v) -> turn(w * 1 rad)",
           "g:2:59: 'w' is not a known quantity");
}

static void test_progress(void)
{
    refuse(HEAD "seed A() on vertices rule A() -> { branch { step(1 mm) } B() }\nrule B() -> { turn(1 rad) C() }\n"
           "rule C() -> { step(1 mm) else A() C() }",
           "g:4:31: 'A' comes back to itself without a step (A -> B -> C -> A); put a step before it, or use 'repeat'");
    refuse(HEAD "seed A() on vertices rule A() -> { step(0 mm) A() }",
           "g:2:47: 'A' comes back to itself without a step (A -> A); put a step before it, or use 'repeat'");
    refuse(HEAD "seed A() on vertices rule A() -> { repeat height / 1 m { step(1 mm) } A() }",
           "g:2:71: 'A' comes back to itself without a step (A -> A); put a step before it, or use 'repeat'");
    refuse(HEAD "seed A() on vertices rule A() -> { choose { 1: step(1 mm) 2: turn(1 rad) } A() }",
           "g:2:76: 'A' comes back to itself without a step (A -> A); put a step before it, or use 'repeat'");
    refuse(HEAD "seed A() on vertices rule A() -> { step(1 mm) else { } A() }",
           "g:2:56: 'A' comes back to itself without a step (A -> A); put a step before it, or use 'repeat'");
    const char *right = HEAD "seed A() on vertices rule A() -> { if height > 1 mm { step(1 mm) else stop } else { step(2 mm) }\n"
                        "branch { A() } choose { 1: A() 2: { repeat 3 { B() } } } }\n"
                        "rule B() -> choose { 1: { step(1 mm) B() } 2: { repeat 2 { step(1 mm) else { stop } } A() } }";
    CHECK(read(right, strlen(right), NULL) == MESO_OK);
}

static void test_commands(void)
{
    refuse_body("step", "14: 'step' wants its 'length'");
    refuse_body("step(3)", "19: 'length' must be a length, such as '3 mm'; this is a number");
    refuse_body("turn(0.5)", "19: 'angle' must be an angle, such as '30 deg'; this is a number");
    refuse_body("step(w, shape: leaf)", "29: 'leaf' is not a shape");
    refuse_body("step(w, shape: sten)", "29: 'sten' is not a shape; did you mean 'stem'?");
    refuse_body("step(w, with: stem)", "22: 'with' is not an argument of 'step'; did you mean 'width'?");
    refuse_body("step(w) while w", "28: 'while' must be a condition, such as 'w > 1 mm'; this is a length");
    refuse_body("step(w) else retry 3", "33: '(' is wanted behind 'retry', instead of '3'");
    refuse_body("step(w) else retry(3, 4 deg", "41: ')' is wanted behind the angle of 'retry', instead of the end");
    refuse_body("step(w) else retry(3)", "34: ',' is wanted between the number of tries and their angle, instead of ')'");
    refuse_body("step(w) else retry(3, 4)", "36: the angle of 'retry' must be an angle, such as '30 deg'; this is a number");
    refuse_body("place(stem)", "19: a shape is wanted, instead of '('");
    refuse_body("place stemm(1 mm)", "20: 'stemm' is not a shape; did you mean 'stem'?");
    refuse_body("place stem", "14: 'place' wants its 'size'");
    refuse_body("face(floww)", "19: 'floww' is not a direction; did you mean 'flow'?");
    refuse_body("face(wall)", "19: 'wall' is not a direction; there are up, world, point, gradient, attribute, principal, random");
    refuse_body("turn(1 rad, 2 rad)", "26: 'turn' has no argument more");
    refuse_body("turn(1 rad", "24: ')' is wanted behind the arguments, instead of the end");
}

static void test_expressions(void)
{
    refuse_body("turn(3 degrees)", "21: 'degrees' is not a unit; there are um, mm, cm, dm, m, km, extent, rad, deg, %");
    refuse_body("step(3 mn)", "21: 'mn' is not a unit; did you mean 'mm'?");
    refuse_body("step(1 extent)", "21: the surface's extent is not known here");
    refuse_body("step(ww)", "19: 'ww' is not a known quantity; did you mean 'w'?");
    refuse_body("step(w * wal)", "23: 'wal' is not a known quantity; did you mean 'wall'?");
    refuse_body("step(w + 30 deg)", "21: '+' of a length and an angle: they must be of one kind");
    refuse_body("step(30 deg + w)", "26: '+' of an angle and a length: they must be of one kind");
    refuse_body("step(3 mm - 30 deg)", "24: '-' of a length and an angle: they must be of one kind");
    refuse_body("if w < 3 { stop }", "19: '<' of a length and a number: they must be of one kind");
    refuse_body("if 1 mm < w < 2 mm { stop }", "26: comparisons do not chain; join two with 'and'");
    refuse_body("if w > 0 and w { stop }", "23: 'and' must be a condition, such as 'w > 1 mm'; this is a length");
    refuse_body("step(w * (w > 0))", "21: '*' is for numbers; a condition stands there");
    refuse_body("step(min(w, hole))", "19: 'min' is for numbers; a condition stands there");
    refuse_body("step(sqrt(w))", "19: 'sqrt' of a length: it must be a number or a square");
    refuse_body("step(gradient(hole) * 1 mm)", "19: a region has no gradient: it is a condition");
    refuse_body("step(ahead(w, 1 mm))", "25: 'w' is not a map");
    refuse_body("step(max(w, w", "27: ')' is wanted behind a function's arguments, instead of the end");
    refuse_body("step(ahead(wall))", "29: 'ahead' wants 1 argument behind the map");
    refuse_body("step(min(w))", "24: 'min' wants 2 arguments");
    refuse_body("step(min(w, w, w))", "29: 'min' has no argument more");
    refuse_body("step(min)", "22: '(' is wanted behind a function's name, instead of ')'");
    refuse_body("step((w)", "22: ')' is wanted behind the arguments, instead of the end");
    refuse_body("step((w", "21: ')' is wanted at the end of the parentheses, instead of the end");
    refuse_body("step(stem)", "19: 'stem' is a shape; a quantity is wanted");
    refuse_body("step(w*w*w*w*w*w*w*w*w*w*w*w*w)", "42: '*' gives too high a power of lengths or angles");
    refuse_body("step(noise(3))", "19: 'noise' must be a length, such as '3 mm'; this is a number");
}

/* Repeats a part behind the first line, with its number where it has a place for that. */
static char *repeated(const char *before, const char *part, uint32_t count, const char *after)
{
    size_t size = strlen(HEAD) + strlen(before) + strlen(after) + (strlen(part) + 12) * (size_t)count + 1;
    char *text = malloc(size);
    CHECK(text);
    size_t used = (size_t)snprintf(text, size, HEAD "%s", before);
    for (uint32_t i = 0; i < count; i++)
        used += (size_t)snprintf(text + used, size - used, part, i);
    snprintf(text + used, size - used, "%s", after);
    return text;
}

static void refuse_repeated(const char *before, const char *part, uint32_t count, const char *after,
                            const char *message)
{
    char *text = repeated(before, part, count, after);
    refuse(text, message);
    free(text);
}

/*
 * More values that wait for others than there are registers: names and nested expressions alone are fewer, but what
 * comes behind as many constants as operands can name has these in registers, too.
 */
static void test_registers(void)
{
    enum { LEVELS = 50 };
    char after[2000];
    size_t used = 0;
    for (uint32_t i = 0; i < LEVELS; i++)
        used += (size_t)snprintf(after + used, sizeof after - used, "choose { 1: stop 1: ");
    used += (size_t)snprintf(after + used, sizeof after - used, "stop");
    for (uint32_t i = 0; i < LEVELS; i++)
        used += (size_t)snprintf(after + used, sizeof after - used, " }");
    snprintf(after + used, sizeof after - used, " }");
    refuse_repeated("seed A() on vertices rule A() -> {", "turn(1 rad)\n", 1 << 15, after,
                    "g:32770:881: more than 224 values at hand; make a rule of a part of this one");
}

/* What there may be at most is told by its number. */
static void test_most(void)
{
    const char *rule = "seed A(1) on vertices rule A(w) -> ";
    char before[96];
    refuse_repeated("param a = ", "(", 100, "", "g:2:43: nested more than 64 deep");
    snprintf(before, sizeof before, "%sturn(1 rad * (w", rule);
    refuse_repeated(before, " + w", 250, "))",
                    "g:2:852: an expression of more than 200 operations on one another");
    refuse_repeated("seed A() on vertices rule A() -> stop\n", "rule B%u() -> stop\n", 1 << 14, "",
                    "g:16386:6: more than 16384 rules");
    snprintf(before, sizeof before, "%s{", rule);
    refuse_repeated(before, "face(up)\n", (1 << 12) + 1, "}", "g:4098:8: more than 4096 directions");
    refuse_repeated("", "param a%u = 1\n", (1 << 12) + 1, "", "g:4099:1: more than 4096 parameters");
    refuse_repeated("", "map a%u = border\n", (1 << 12) + 1, "", "g:4099:1: more than 4096 declarations of one kind");
    refuse_repeated("", "seed A() on vertices\n", (1 << 12) + 1, "", "g:4098:6: more than 4096 seeds");
    refuse_repeated("seed A() on vertices rule A(", "a%u, ", 12, "b) -> stop", "g:2:79: a rule has at most 12 arguments");
    refuse_repeated("seed A() on vertices rule A() -> A(", "1, ", 12, "1)", "g:2:72: a rule has at most 12 arguments");
}

/* Nothing is so deep or long that it breaks anything. */
static void test_bounds(void)
{
    size_t size = 200000;
    char *text = malloc(size);
    CHECK(text);
    static const char *const parts[] = {"(", "-", "not ", "1+", "w+", "w*(", "min(w,", "{branch", "{ if w > 0 ", "(1 or (w and ",
                                        "{ step(w) else ", "{ choose { 1: ", "{ let k = 1 ", "step(w) else "};
    for (uint32_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        size_t used = (size_t)snprintf(text, size, HEAD "seed A(1) on vertices rule A(w) -> %s",
                                       i < 7 || i == 9 ? "turn(" : "");
        while (used + 100 < size)
            used += (size_t)snprintf(text + used, size - used, "%s", parts[i]);
        CHECK(read(text, used, NULL) == MESO_ERR_INPUT);
    }
    size_t used = (size_t)snprintf(text, size, HEAD "seed A(1) on vertices rule A(w) -> {");
    for (uint32_t i = 0; i < 97; i++)
        used += (size_t)snprintf(text + used, size - used, "let k%u = w\n", i);
    CHECK(read(text, used, NULL) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "g:98:1: a rule can have 96 names of its own at a time");
    free(text);
}

static void refuse_setting(const char *setting, const char *message)
{
    const char *text = HEAD "param pace = 8 mm param bend = 0 seed A() on vertices rule A() -> stop";
    const MesoGrammarSetting settings[] = {{setting}};
    const MesoGrammarOptions options = {settings, 1, 0};
    CHECK(read(text, strlen(text), &options) == MESO_ERR_USAGE);
    CHECK_TEXT(error.message, message);
}

static void test_settings(void)
{
    refuse_setting("pac=3 mm", "--set:1:1: 'pac' is not a parameter; did you mean 'pace'?");
    refuse_setting("pace", "--set:1:1: 'name=value' is wanted, instead of 'pace'");
    refuse_setting("pace=", "--set pace:1:1: a quantity is wanted, instead of the end");
    refuse_setting("pace=3", "--set pace:1:1: the parameter must be a length, such as '3 mm'; this is a number");
    refuse_setting("pace=3 mm 4", "--set pace:1:6: nothing can follow the value; there is '4'");
    refuse_setting("bend=3 deg", "--set bend:1:1: the parameter must be a number; this is an angle");
}

/* Each part of a right text is an error, told, or right. */
static void test_truncation(void)
{
    for (size_t size = 0; size <= strlen(fixture_ivy); size++) {
        char *copy = malloc(size + 1);
        CHECK(copy);
        memcpy(copy, fixture_ivy, size);
        MesoStatus status = read(copy, size, NULL);
        CHECK(status == MESO_OK || (status == MESO_ERR_INPUT && strncmp(error.message, "g:", 2) == 0));
        free(copy);
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_heading();
    test_words_and_signs();
    test_declarations();
    test_seeds();
    test_rules();
    test_progress();
    test_commands();
    test_expressions();
    test_registers();
    test_most();
    test_bounds();
    test_settings();
    test_truncation();
    meso_arena_release(&arena);
}
