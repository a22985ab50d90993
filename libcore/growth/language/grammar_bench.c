/* Rates: of texts read, and of rules run without a surface. */
#include <math.h>

#include "libcore/base/clock.h"
#include "libcore/growth/language/grammar_fixture.h"

enum { ROUNDS = 7, RULES = 1 << 20 };

static double look_nowhere(void *context, MesoGrowthLook look, uint32_t map, double a, double b)
{
    (void)context, (void)map, (void)a, (void)b;
    return look == MESO_LOOK_CLEAR || look < MESO_LOOK_NOISE ? 1 : 0;
}

/* One branch after another, each to its end; branches on the way are left. */
static void time_rules(const char *name, const char *text)
{
    MesoArena arena;
    MesoGrammar grammar;
    MesoError error;
    double best = INFINITY, state[MESO_STATE_COUNT] = {0}, registers[MESO_GRAMMAR_REGISTERS];
    const MesoGrowthHost host = {.state = state, .look = look_nowhere};
    uint32_t commands = 0, rules = 0;
    meso_arena_init(&arena);
    CHECK(meso_grammar_read(&grammar, &arena, name, text, strlen(text), NULL, &error) == MESO_OK);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        double start = meso_seconds();
        commands = rules = 0;
        for (uint32_t seed = 0; rules < RULES; seed++) {
            MesoGrowthRun run = meso_growth_begin(grammar.seeds[0].entry,
                                                  meso_growth_seed_key(1, grammar.seeds[0].site, seed));
            MesoGrowthCommand command = {0};
            do {
                meso_growth_resume(&command, &grammar, &run, registers, &host, true);
                commands++;
                if (command.order == MESO_GROWTH_RULE) {
                    memcpy(registers, command.values, sizeof command.values);
                    run = meso_growth_begin(grammar.rules[command.rule].entry, command.key);
                    rules++;
                }
            } while (command.order <= MESO_GROWTH_RULE);
        }
        best = fmin(best, meso_seconds() - start);
    }
    printf("%-8s %.1f M rules/s, %.1f M commands/s, %.0f ns a rule\n", name, 1e-6 * rules / best, 1e-6 * commands / best,
           1e9 * best / rules);
    meso_arena_release(&arena);
}

static void time_reading(void)
{
    enum { COPIES = 500 };
    size_t used = 0, size = 1 << 20;
    char *text = malloc(size);
    double best = INFINITY;
    CHECK(text);
    used += (size_t)snprintf(text, size, HEAD "seed R0(4 mm) on vertices\n");
    for (uint32_t i = 0; i < COPIES; i++)
        used += (size_t)snprintf(text + used, size - used,
                                 "rule R%u(w) : w < 0.5 mm or height < 0.5 m -> stop\nrule R%u(w) -> {\n"
                                 "  turn(normal(0, 12 deg) + 8 deg * noise(5 cm)) face(up, 0.25 * (1 - height / 1 m))\n"
                                 "  step(8 mm, width: w, end: 0.995*w, clear: 2*w) else retry(3, 70 deg)\n"
                                 "  choose { 84%%: R%u(0.995*w) 16%%: { branch { turn(normal(45 deg, 8 deg)) R%u(0.8*w) } } } }\n",
                                 i, i, (i + 1) % COPIES, (i + 7) % COPIES);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        MesoArena arena;
        MesoGrammar grammar;
        MesoError error;
        meso_arena_init(&arena);
        double start = meso_seconds();
        CHECK(meso_grammar_read(&grammar, &arena, "text", text, used, NULL, &error) == MESO_OK);
        best = fmin(best, meso_seconds() - start);
        meso_arena_release(&arena);
    }
    printf("reading  %.1f MB/s, %.2f ms for %zu bytes\n", 1e-6 * (double)used / best, 1e3 * best, used);
    free(text);
}

int main(void)
{
    time_rules("ivy", fixture_ivy);
    time_rules("lace", fixture_lace);
    time_rules("cracks", fixture_cracks);
    time_rules("feathers", fixture_feathers);
    time_reading();
    return 0;
}
