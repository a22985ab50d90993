/* What rules tell an engine to do, and that chance is where it should be. */
#include <math.h>

#include "libcore/growth/language/grammar_draw.h"
#include "libcore/growth/language/grammar_fixture.h"
#include "libcore/growth/language/grammar_operation.h"

static MesoArena arena;
static MesoGrammar grammar;
static MesoError error;

static void read_with(const char *text, const MesoGrammarOptions *options)
{
    MesoStatus status = meso_grammar_read(&grammar, &arena, "g", text, strlen(text), options, &error);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(status == MESO_OK);
}

static void read(const char *text)
{
    read_with(text, NULL);
}

static char told[1 << 16];

static const char *grow(const char *text, uint32_t refuse_every, double map, uint32_t most)
{
    FixtureLog log = {told, sizeof told, 0, 0, 0};
    FixtureHost host = {.log = &log, .refuse_every = refuse_every, .map = map};
    read(text);
    *told = '\0';
    fixture_grow(&grammar, &host, most);
    CHECK(log.used < sizeof told);
    return told;
}

/* What `expression` is, by way of a turn of `unit`. */
static double value(const char *expression, const char *unit)
{
    char text[512];
    FixtureLog log = {0};
    FixtureHost host = {.log = &log, .map = 0.25, .state = {3, 2, 0.5, 0.1, 1, 2, 3}};
    const MesoGrowthHost look = {.context = &host, .state = host.state, .look = fixture_look};
    double registers[MESO_GRAMMAR_REGISTERS];
    MesoGrowthCommand command = {0};
    snprintf(text, sizeof text, HEAD "unit m map m1 = attribute(\"a\") seed A(2) on vertices\n"
             "rule A(two) -> turn((%s) * 1 %s)", expression, unit);
    read(text);
    MesoGrowthRun run = meso_growth_begin(grammar.rules[0].entry, 7);
    registers[0] = 2;
    meso_growth_resume(&command, &grammar, &run, registers, &look, true);
    CHECK(command.order == MESO_GROWTH_TURN);
    return command.values[0];
}

static void test_expressions(void)
{
    CHECK(value("1 + 2 * 3 - 4 / 8", "rad") == 6.5 && value("-(1 - 3) - -1", "rad") == 3);
    CHECK(value("two * two + two", "rad") == 6 && value("-two / 4", "rad") == -0.5 && value("1 - two - two", "rad") == -3);
    CHECK(value("50%", "rad") == 0.5 && value("3 mm / 1 um", "rad") == 3000 && value("2 km / (4 m)", "rad") == 500);
    CHECK(fabs(value("1", "deg") - 0.017453292519943295) < 1e-17);
    CHECK(value("min(two, 1) + max(two, 5) + abs(-two)", "rad") == 8 && value("mod(-1, two) + mod(7, 4)", "rad") == 4);
    CHECK(value("pow(two, 10) + pow(two, -1)", "rad") == 1024.5 && value("floor(2.5) + ceil(two + 0.5) + round(2.5)", "rad") == 8);
    CHECK(value("sign(-two) + sign(0 * two)", "rad") == -1 && value("sqrt(two * 8)", "rad") == 4);
    CHECK(value("sqrt(4 m * 9 m) / 1 m", "rad") == 6 && value("clamp(two, 3, 5) + clamp(two, 0, 1)", "rad") == 4);
    CHECK(value("lerp(two, 4, 25%) + smooth(0, two, 1)", "rad") == 3 && value("smooth(2, 2, two)", "rad") == 1);
    CHECK(value("m1 + ahead(m1, 1 mm) + side(m1, -1 mm) + gradient(m1) * 1 m", "rad") == 1);
    CHECK(value("generation + depth + (length + width + x + y + z) / 1 m", "rad") == 11.6);
    CHECK(value(".5e1 + 1E+1 + 1e-1", "rad") == 15.1 && value("0.1 + 123456789012345678901234567890e-29", "rad") == 0.1 + 1.2345678901234568);
}

/* Truths, by what happens. */
static void test_conditions(void)
{
    static const char *const right[] = {"1 < 2", "two > 1", "two <= 2 and two >= 2", "two == 2", "two != 3", "not two > 2",
                                        "two > 5 or two > 1", "true", "not (two > 1 and false)", "clear(1 mm)",
                                        "not meets(1 mm, 3 deg)", "0 < two and 1 mm > 0", "1 > 2 or not 1 > 2 and true"};
    for (uint32_t i = 0; i < sizeof right / sizeof *right; i++) {
        char text[256];
        snprintf(text, sizeof text, HEAD "seed A(2) on vertices rule A(two) : %s -> turn(1 rad)", right[i]);
        CHECK(strstr(grow(text, 0, 1, 10), "turn 0=1\n"));
        snprintf(text, sizeof text, HEAD "seed A(2) on vertices rule A(two) : not (%s) -> turn(1 rad)", right[i]);
        CHECK(!strstr(grow(text, 0, 1, 10), "turn 0=1\n"));
    }
    /* The map is not looked at where it does not matter. */
    CHECK_TEXT(grow(HEAD "map m1 = attribute(\"a\") seed A(2) on vertices\n"
                    "rule A(two) : two < 1 and m1 > 0 or two > 1 or m1 > 2 -> stop", 0, 1, 10), "rule A 0=2\nend\n");
}

static void test_sine(void)
{
    for (int i = -5000; i < 5000; i++) {
        double x = 0.0123 * i;
        CHECK(fabs(meso_grammar_apply(MESO_OP_SINE, x, 0, 0) - sin(x)) < 3e-16);
        CHECK(fabs(meso_grammar_apply(MESO_OP_COSINE, x, 0, 0) - cos(x)) < 3e-16);
    }
}

static void test_commands(void)
{
    CHECK_TEXT(grow(HEAD "unit mm shape tube1 = tube shape dot = bead field f = world(1, 0, 0)\n"
                    "seed A(2 mm, 5) on vertices\n"
                    "rule A(w, n) -> { turn(1 rad) face(f) face(-f, 50%) move(w, angle: 2 rad)\n"
                    "  step(n * w, 0.5 rad, shape: tube1, cross: true, clear: w) place dot(w, lift: 1 cm) }", 0, 1, 10),
               "rule A 0=2 1=5\nturn 0=1\nface field 0 0=1\nface field 1 0=0.5\nmove 0=2 1=2\n"
               "step tube1 0=10 1=0.5 7=2 8=1\nplace dot 0=2 4=10\nend\n");
    CHECK(grammar.fields[1].reversed && !grammar.fields[0].reversed && grammar.fields[1].values[0].number == 1);
    read(HEAD "field a = world(1, 0, 0) field b = -a field c = -b seed A() on vertices face c rule A() -> stop");
    CHECK(grammar.field_count == 3 && grammar.fields[1].reversed && !grammar.fields[2].reversed);
    CHECK(grammar.fields[2].values[0].number == 1 && strcmp(grammar.fields[1].name, "b") == 0);
}

static void test_refused_steps(void)
{
    CHECK_TEXT(grow(HEAD "seed A() on vertices rule A() -> { step(1 m) turn(1 rad) }", 1, 1, 10),
               "rule A\nstep 0=1\nend\n");
    CHECK_TEXT(grow(HEAD "seed A() on vertices rule A() -> { step(1 m) else turn(2 rad) turn(1 rad) }", 1, 1, 10),
               "rule A\nstep 0=1\nturn 0=2\nturn 0=1\nend\n");
    CHECK_TEXT(grow(HEAD "seed A() on vertices rule A() -> { step(1 m) else { } turn(1 rad) }", 1, 1, 10),
               "rule A\nstep 0=1\nturn 0=1\nend\n");
    CHECK_TEXT(grow(HEAD "seed A() on vertices rule A() -> { step(1 m) else { stop } turn(1 rad) }", 0, 1, 10),
               "rule A\nstep 0=1\nturn 0=1\nend\n");
    CHECK_TEXT(grow(HEAD "seed A() on vertices rule A() -> { step(1 m) else retry(3, 2 rad) else stop }", 1, 1, 10),
               "rule A\nstep 0=1 9=3 10=2\nend\n");
    CHECK_TEXT(grow(HEAD "seed A() on vertices rule A() -> { step(1 m) else retry(3, 2 rad) else join }", 0, 1, 10),
               "rule A\nstep 0=1 9=3 10=2 join\nend\n");
    CHECK_TEXT(grow(HEAD "map m1 = attribute(\"a\") seed A(1) on vertices\n"
                    "rule A(n) -> { step(1 m) while m1 > n else turn(1 rad) }", 0, 0, 10),
               "rule A 0=1\nstep 0=1\nmap(0 0 0)\nturn 0=1\nend\n");
}

static void test_branches(void)
{
    CHECK_TEXT(grow(HEAD "seed A(1) on vertices\n"
                    "rule A(n) -> { let t = 2 * n  branch { let k = t + n  turn(k * 1 rad) B(k) }  if n > 0 { B(t) } }\n"
                    "rule B(k) : k > 2 -> turn(k * 1 deg)\n"
                    "rule B(k) -> { step(1 m) else stop }", 0, 1, 10),
               "rule A 0=1\nbranch\nrule B 0=2\nturn 0=3\nrule B 0=3\nstep 0=1\nend\nturn 0=0.0523599\nend\n");
    CHECK_TEXT(grow(HEAD "seed A(2) on vertices\n"
                    "rule A(n) -> { repeat n as i { repeat n + 0.9 as j { turn((10 * i + j) * 1 rad) } }\n"
                    "               repeat -1 { stop } if n < 0 { stop } else if n == 2 { turn(7 rad) } else { stop } }", 0, 1, 10),
               "rule A 0=2\nturn 0=0\nturn 0=1\nturn 0=10\nturn 0=11\nturn 0=7\nend\n");
}

static void test_faults(void)
{
    CHECK_TEXT(grow(HEAD "seed A(0) on vertices rule A(n) -> { turn(1 rad) turn(1 rad / n) }", 0, 1, 10),
               "rule A 0=0\nturn 0=1\nfault 0=inf: a value is not finite\n");
    CHECK(strstr(grow(HEAD "seed A(1e200) on vertices rule A(n) -> turn(n * n * 1 rad)", 0, 1, 10),
                 "fault 0=inf: a value is not finite\n"));
    CHECK(strstr(grow(HEAD "seed A(0) on vertices rule A(n) -> repeat 1e9 { let k = 1 }", 0, 1, 10),
                 "fault: too many repetitions"));
}

/* What one command was told the next one does not know. */
static void test_forgetting(void)
{
    FixtureLog log = {0};
    FixtureHost host = {.log = &log};
    const MesoGrowthHost look = {.context = &host, .state = host.state, .look = fixture_look};
    double registers[MESO_GRAMMAR_REGISTERS];
    MesoGrowthCommand command = {0};
    read(HEAD "seed A(2) on vertices rule A(n) -> { step(n * 1 cm, width: n * 2 cm, cross: true) turn(3 rad) A(n) }");
    MesoGrowthRun run = meso_growth_begin(grammar.rules[0].entry, 7);
    registers[0] = 2;
    meso_growth_resume(&command, &grammar, &run, registers, &look, true);
    CHECK(command.order == MESO_GROWTH_STEP && command.values[MESO_GROWTH_WIDTH] > 0);
    CHECK(command.values[MESO_GROWTH_CROSS] == 1);
    for (uint32_t i = 0; i < 2; i++) {
        meso_growth_resume(&command, &grammar, &run, registers, &look, true);
        CHECK(command.order == (i ? MESO_GROWTH_RULE : MESO_GROWTH_TURN) && command.values[0] == (i ? 2 : 3));
        for (uint32_t k = 1; k < MESO_GROWTH_VALUES; k++)
            CHECK(command.values[k] == 0);
    }
}

static void test_examples(void)
{
    CHECK(strstr(grow(fixture_ivy, 0, 0.7, 40), "face field 1 0=0.075\nstep stem 0=0.008 2=0.004 3=0.00398 7=0.008 9=3 10=1.22173\n"));
    CHECK(grammar.limits.generations == 400 && grammar.seeds[0].count == 18 && grammar.seeds[0].field == 0);
    CHECK(grammar.fields[0].kind == MESO_FIELD_UP && grammar.shapes[0].values[2].number == 6);
    CHECK(strcmp(grammar.maps[0].values[0].text, "paint/allowed.png") == 0 && grammar.maps[0].values[1].index == 0);
    CHECK(strstr(grow(fixture_lace, 9, 1, 60), "step cord 0=3 1=0.12 2=1.2 7=1.5\nrule Scroll 0=1 1=1\n"));
    CHECK(strstr(told, "rule Scroll 0=-1 1=0\n") && strstr(told, "place dot 0=3\nend\n"));
    CHECK(strstr(grow(fixture_cracks, 9, 0.9, 60), "step split 0=0.002 2=0.001 3=0.00098 join\nmap(0 0 0)\n"));
    CHECK(strstr(grow(fixture_feathers, 0, 1, 300), "place feather 0=0.009 4=0.0118 5=0\nrule Row 0=60\nend\n"));
    CHECK(grammar.seeds[0].places.values[0].index != MESO_NO_INDEX);
}

static void test_seed_code(void)
{
    FixtureLog log = {0};
    FixtureHost host = {.log = &log, .map = 0.5};
    const MesoGrowthHost look = {.context = &host, .state = host.state, .look = fixture_look};
    double registers[MESO_GRAMMAR_REGISTERS];
    MesoGrowthRun run = meso_growth_begin(0, 1);
    read(HEAD "unit mm map m1 = attribute(\"a\") seed A() on poisson(12 mm * m1) where m1 > 0.4 count 3\n"
         "seed A() on at(1 mm, 2 mm, 3 cm) rule A() -> stop");
    CHECK(meso_growth_value(&grammar, &run, grammar.seeds[0].places.values[0].index, registers, &look) == 6);
    CHECK(meso_growth_value(&grammar, &run, grammar.seeds[0].where, registers, &look) == 1);
    CHECK(grammar.seeds[1].where == MESO_NO_INDEX && grammar.seeds[1].places.kind == MESO_SEEDS_AT);
    CHECK(grammar.seeds[1].places.values[2].number == 30 && grammar.seeds[1].places.values[2].index == MESO_NO_INDEX);
    CHECK(isinf(grammar.seeds[1].count) && grammar.seeds[0].count == 3);
}

static void add_turn(void *context, double angle)
{
    double *turned = context;
    *turned += angle;
}

static double no_look(void *context, MesoGrowthLook look, uint32_t map, double a, double b)
{
    (void)context, (void)look, (void)map, (void)a, (void)b;
    return 0;
}

/* A host that turns itself gets all turns on the way to the next command, which is none the wiser. */
static void test_turning_host(void)
{
    double turned = 0, state[MESO_STATE_COUNT] = {0}, registers[MESO_GRAMMAR_REGISTERS];
    const MesoGrowthHost host = {&turned, state, no_look, add_turn};
    MesoGrowthCommand command = {0};
    read(HEAD "unit m seed A() on vertices rule A() -> { turn(2 rad) repeat 3 { turn(0.25 rad) } move(3 m) turn(1 rad) "
         "branch { turn(9 rad) } stop }");
    MesoGrowthRun run = meso_growth_begin(grammar.rules[0].entry, 7);
    meso_growth_resume(&command, &grammar, &run, registers, &host, true);
    CHECK(command.order == MESO_GROWTH_MOVE && command.values[MESO_GROWTH_AMOUNT] == 3 && command.given == 1);
    CHECK(turned == 2.75);
    meso_growth_resume(&command, &grammar, &run, registers, &host, true);
    CHECK(command.order == MESO_GROWTH_BRANCH && command.given == 0 && command.values[MESO_GROWTH_AMOUNT] == 0);
    CHECK(turned == 3.75);
    meso_growth_resume(&command, &grammar, &run, registers, &host, true);
    CHECK(command.order == MESO_GROWTH_END && turned == 3.75);
}

/* All that the rule A makes, for many keys: a turn for each. */
static void draws(const char *text, double *turns, uint32_t count)
{
    FixtureLog log = {0};
    FixtureHost host = {.log = &log, .map = 0.5};
    const MesoGrowthHost look = {.context = &host, .state = host.state, .look = fixture_look};
    double registers[MESO_GRAMMAR_REGISTERS];
    read(text);
    for (uint32_t i = 0; i < count; i++) {
        MesoGrowthCommand command = {0};
        MesoGrowthRun run = meso_growth_begin(grammar.rules[0].entry, meso_growth_seed_key(5, grammar.seeds[0].site, i));
        do
            meso_growth_resume(&command, &grammar, &run, registers, &look, true);
        while (command.order != MESO_GROWTH_TURN && command.order < MESO_GROWTH_RULE);
        turns[i] = command.values[0];
    }
}

enum { MANY = 100000 };
static double turns[MANY], others[MANY];

/* Frequencies within four standard deviations. */
static void test_statistics(void)
{
    double sum = 0, squares = 0, counts[3] = {0}, chances[3] = {0.5, 0.2, 0.3};
    draws(HEAD "seed A() on vertices rule A() -> choose { 5: turn(0 rad) 2: turn(1 rad) -9: stop 3: turn(2 rad) 0: stop }",
          turns, MANY);
    for (uint32_t i = 0; i < MANY; i++)
        counts[(int)turns[i]]++;
    for (uint32_t i = 0; i < 3; i++)
        CHECK(fabs(counts[i] - chances[i] * MANY) < 4 * sqrt(chances[i] * (1 - chances[i]) * MANY));
    /* The same where weights are known only when it runs. */
    draws(HEAD "seed A() on vertices rule A() -> choose {\n"
          "5 + generation: turn(0 rad) 2: turn(1 rad) generation - 9: stop 3: turn(2 rad) 0 * depth: stop }", others, MANY);
    CHECK(memcmp(turns, others, sizeof turns) == 0);
    draws(HEAD "seed A() on vertices rule A() -> turn(normal(1 rad, 2 rad))", turns, MANY);
    for (uint32_t i = 0; i < MANY; i++) {
        sum += turns[i];
        squares += (turns[i] - 1) * (turns[i] - 1);
    }
    CHECK(fabs(sum / MANY - 1) < 4 * 2 / sqrt(MANY) && fabs(squares / MANY / 4 - 1) < 4 * sqrt(2.0 / MANY));
    sum = 0;
    draws(HEAD "seed A() on vertices rule A() -> turn(rand(2 rad, 4 rad))", turns, MANY);
    for (uint32_t i = 0; i < MANY; i++) {
        CHECK(turns[i] >= 2 && turns[i] < 4);
        sum += turns[i];
    }
    CHECK(fabs(sum / MANY - 3) < 4 * 2 / sqrt(12.0 * MANY));
    draws(HEAD "seed A() on vertices rule A() -> { if chance(0.3) { turn(1 rad) } turn(0 rad) }", turns, MANY);
    sum = 0;
    for (uint32_t i = 0; i < MANY; i++)
        sum += turns[i];
    CHECK(fabs(sum - 0.3 * MANY) < 4 * sqrt(0.21 * MANY));
    draws(HEAD "seed A() on vertices rule A() -> choose { 0: turn(0 rad) 0: turn(1 rad) }", turns, 10);
    CHECK(turns[0] == 1 && turns[9] == 1);
}

/* Draws depend on the branch and on their place in their rule, on nothing else. */
static void test_streams(void)
{
    static const char plain[] = HEAD "seed A() on vertices rule A() -> turn(rand(0 rad, 1 rad))";
    draws(plain, turns, 1000);
    draws(HEAD "param p = 3 seed A() on vertices seed B() on vertices rule A() -> { turn(rand(0 rad, 1 rad)) turn(rand(0 rad, 1 rad))\n"
          "branch { B() } } rule B() -> { turn(normal(0, 1 rad)) choose { 1: stop 2: stop } }", others, 1000);
    CHECK(memcmp(turns, others, 1000 * sizeof *turns) == 0);
    draws(HEAD "seed A() on vertices rule A() -> { let k = rand(0, 1) turn(rand(0 rad, 1 rad)) }", others, 1000);
    CHECK(memcmp(turns, others, 1000 * sizeof *turns) != 0);

    /* In loops, each turn draws anew; the same way again where it is run again. */
    draws(HEAD "seed A() on vertices rule A() -> { repeat 2 { repeat 2 { turn(rand(0 rad, 1 rad)) } } }", turns, 1);
    FixtureLog log = {0};
    FixtureHost host = {.log = &log};
    const MesoGrowthHost look = {.context = &host, .state = host.state, .look = fixture_look};
    for (uint32_t round = 0; round < 2; round++) {
        double registers[MESO_GRAMMAR_REGISTERS], seen[4];
        MesoGrowthRun run = meso_growth_begin(grammar.rules[0].entry, meso_growth_seed_key(5, grammar.seeds[0].site, 0));
        MesoGrowthCommand command = {0};
        for (uint32_t i = 0; i < 4; i++) {
            meso_growth_resume(&command, &grammar, &run, registers, &look, true);
            seen[i] = command.values[0];
            for (uint32_t j = 0; j < i; j++)
                CHECK(seen[j] != seen[i]);
        }
        CHECK(seen[0] == turns[0]);
    }
}

static void test_settings(void)
{
    const MesoGrammarSetting settings[] = {{"pace=1 cm"}, {"pace=2 mm + 1 mm"}};
    const MesoGrammarOptions options = {settings, 2, 40};
    read_with(HEAD "unit mm param pace = 8 mm param far = 2 * pace param wide = 1% * 1 extent\n"
              "seed A() on vertices rule A() -> { step(far) }", &options);
    CHECK(grammar.parameter_count == 3 && grammar.parameters[0].value == 3 && grammar.parameters[1].value == 6);
    CHECK(grammar.parameters[2].value == 0.4 && grammar.parameters[1].type.length == 1);
    CHECK(strcmp(grammar.parameters[1].name, "far") == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_expressions();
    test_conditions();
    test_sine();
    test_commands();
    test_refused_steps();
    test_branches();
    test_faults();
    test_forgetting();
    test_examples();
    test_seed_code();
    test_turning_host();
    test_statistics();
    test_streams();
    test_settings();
    meso_arena_release(&arena);
}
