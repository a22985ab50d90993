/* Grammars for tests, and an engine that walks a plane and writes down what it is told. */
#ifndef MESO_GRAMMAR_FIXTURE_H
#define MESO_GRAMMAR_FIXTURE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "libcore/base/check.h"
#include "libcore/growth/language/grammar_read.h"
#include "libcore/growth/language/grammar_run.h"

#define HEAD "meso-grow 1\n"

static const char fixture_ivy[] =
    HEAD "unit m\n"
    "param pace = 8 mm\n"
    "map wall = image(\"paint/allowed.png\", channel: r)   # what the artist painted\n"
    "map damp = attribute(\"damp\")\n"
    "shape stem = tube(sides: 6)\n"
    "shape blade = mesh(\"parts/leaf.glb\", along: z)\n"
    "limit generations 400\n"
    "seed Shoot(4 mm) on poisson(20 cm) where wall > 0.5 and height < 10 cm count 18 face up\n"
    "rule Shoot(w) : w < 0.5 mm or wall < 0.5 -> stop\n"
    "rule Shoot(w) -> {\n"
    "  turn(normal(0, 12 deg) + 8 deg * noise(5 cm))\n"
    "  face(up, 0.25 * (1 - damp))\n"
    "  step(pace, shape: stem, width: w, end: 0.995*w, clear: 2*w) else retry(3, 70 deg)\n"
    "  if chance(0.4) {\n"
    "    branch { move(1.5*w, 90 deg) turn(60 deg) Leaf(w) }\n"
    "    branch { move(1.5*w, -90 deg) turn(-60 deg) Leaf(w) }\n"
    "  }\n"
    "  choose {\n"
    "    84%: Shoot(0.995*w)\n"
    "    16%: { branch { turn(normal(45 deg, 8 deg)) Shoot(0.8*w) }  Shoot(0.99*w) }\n"
    "  }\n"
    "}\n"
    "rule Leaf(w) : clear(6*w) -> place blade(size: 14*w, roll: normal(0, 15 deg), lift: 2*w)\n";

static const char fixture_lace[] =
    HEAD "unit mm\n"
    "map edge = border\n"
    "shape cord = tube(sides: 8)\n"
    "shape dot = bead\n"
    "seed Scroll(1, 0) on border(5 mm) count 40 face gradient(edge)\n"
    "rule Scroll(hand, n) -> {\n"
    "  step(3 mm, hand * (0.12 + 0.06*n) * 1 rad, shape: cord, width: 1.2 mm, clear: 1.5 mm)\n"
    "    else { place dot(3 mm) stop }\n"
    "  if n == 6 { branch { turn(-hand * 70 deg) Scroll(-hand, 0) } }\n"
    "  if n > 40 { place dot(3 mm) stop }\n"
    "  Scroll(hand, n + 1)\n"
    "}\n";

static const char fixture_cracks[] =
    HEAD "map stress = attribute(\"stress\")\n"
    "field across = principal(max)\n"
    "shape split = section(\"crack.svg\")\n"
    "seed Crack(1 mm) on poisson(5 cm) where stress > 0.7 face across\n"
    "rule Crack(w) : w > 0.1 mm -> {\n"
    "  turn(normal(0, 18 deg))\n"
    "  face(across, 0.3)\n"
    "  step(2 mm, shape: split, width: w, end: 0.98*w) while stress > 0.2 else join\n"
    "  if chance(0.02 * stress) {\n"
    "    branch { turn(90 deg) Crack(0.7*w) }\n"
    "    branch { turn(-90 deg) Crack(0.7*w) }\n"
    "  }\n"
    "  Crack(0.98*w)\n"
    "}\n";

static const char fixture_feathers[] =
    HEAD "map size = image(\"paint/size.exr\")\n"
    "field down = attribute(\"groom\")\n"
    "shape feather = leaf\n"
    "seed Row(0) on poisson(12 mm * size) face down\n"
    "rule Row(i) : i < 60 -> {\n"
    "  face(down)\n"
    "  step(9 mm * size, clear: 4 mm * size)\n"
    "  place feather(size: 9 mm * size, roll: 4 deg * noise(3 cm), lift: 0.2 mm * i)\n"
    "  Row(i + 1)\n"
    "}\n";

/* What happened, as a text. */
typedef struct FixtureLog {
    char *text;
    size_t size, used;
    uint64_t hash;
    uint32_t count;
} FixtureLog;

static inline void fixture_log(FixtureLog *log, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    if (log->text && log->used < log->size)
        log->used += (size_t)vsnprintf(log->text + log->used, log->size - log->used, format, list);
    va_end(list);
}

/* The ways of commands that are refused, and what maps hold. */
typedef struct FixtureHost {
    FixtureLog *log;
    uint32_t refuse_every;      /* of all steps, every so many one; 0: none */
    uint32_t steps;
    double map;                 /* the value of all maps */
    double state[MESO_STATE_COUNT];
} FixtureHost;

static inline double fixture_look(void *context, MesoGrowthLook look, uint32_t map, double a, double b)
{
    FixtureHost *host = context;
    static const char *const names[] = {"map", "ahead", "side", "gradient", "noise", "height", "slope", "curvature",
                                        "clear", "meets"};
    fixture_log(host->log, "%s(%d %g %g)\n", names[look], (int)map, a, b);
    return look == MESO_LOOK_CLEAR ? 1 : look >= MESO_LOOK_NOISE ? 0 : host->map;
}

/* A branch that waits for its turn. */
typedef struct FixtureTip {
    MesoGrowthRun run;
    double registers[MESO_GRAMMAR_REGISTERS];
    uint32_t generation;
} FixtureTip;

typedef struct FixtureQueue {
    FixtureTip *tips;
    uint32_t first, count, room;
} FixtureQueue;

static inline FixtureTip *fixture_push(FixtureQueue *queue)
{
    if (queue->count == queue->room) {
        queue->room = queue->room ? 2 * queue->room : 64;
        queue->tips = realloc(queue->tips, queue->room * sizeof *queue->tips);
        CHECK(queue->tips);
    }
    memset(&queue->tips[queue->count], 0, sizeof *queue->tips);
    return &queue->tips[queue->count++];
}

static inline void fixture_note(FixtureHost *host, const MesoGrammar *grammar, const MesoGrowthCommand *command)
{
    static const char *const names[] = {"step", "move", "turn", "face", "place", "branch", "rule", "end", "fault"};
    fixture_log(host->log, "%s", names[command->order]);
    if (command->rule != MESO_NO_INDEX)
        fixture_log(host->log, " %s", grammar->rules[command->rule].name);
    if (command->field != MESO_NO_INDEX)
        fixture_log(host->log, " field %u", command->field);
    if (command->shape != MESO_NO_INDEX)
        fixture_log(host->log, " %s", grammar->shapes[command->shape].name);
    for (uint32_t i = 0; i < MESO_GROWTH_VALUES; i++)
        if (command->given >> i & 1)
            fixture_log(host->log, " %u=%.6g", i, command->values[i]);
    fixture_log(host->log, "%s%s%s\n", command->join ? " join" : "", command->fault ? ": " : "",
                command->fault ? command->fault : "");
}

/* Runs a tip until its rule is done; what comes of it is queued. */
static inline void fixture_run(const MesoGrammar *grammar, FixtureHost *host, FixtureQueue *queue, uint32_t index)
{
    const MesoGrowthHost look = {.context = host, .state = host->state, .look = fixture_look};
    FixtureTip tip = queue->tips[index];
    MesoGrowthCommand command = {0};
    bool done = true;
    do {
        meso_growth_resume(&command, grammar, &tip.run, tip.registers, &look, done);
        fixture_note(host, grammar, &command);
        done = true;
        if (command.order == MESO_GROWTH_STEP) {
            done = !(host->refuse_every && ++host->steps % host->refuse_every == 0);
            host->state[MESO_STATE_LENGTH] += done ? command.values[MESO_GROWTH_AMOUNT] : 0;
            if (command.condition != MESO_NO_INDEX)
                done &= meso_growth_value(grammar, &tip.run, command.condition, tip.registers, &look) != 0;
        }
        if (command.order == MESO_GROWTH_BRANCH) {
            FixtureTip *child = fixture_push(queue);
            *child = tip;
            child->run = meso_growth_begin(command.entry, command.key);
        }
        if (command.order == MESO_GROWTH_RULE) {
            FixtureTip *next = fixture_push(queue);
            memcpy(next->registers, command.values, sizeof command.values);
            next->run = meso_growth_begin(grammar->rules[command.rule].entry, command.key);
            next->generation = tip.generation + 1;
        }
    } while (command.order < MESO_GROWTH_RULE);
    host->log->hash = host->log->hash * 31 + tip.run.key;
}

/* Grows each seed once; stops after `most` rules. Returns how many were run. */
static inline uint32_t fixture_grow(const MesoGrammar *grammar, FixtureHost *host, uint32_t most)
{
    FixtureQueue queue = {0};
    for (uint32_t i = 0; i < grammar->seed_count; i++) {
        FixtureTip *tip = fixture_push(&queue);
        tip->run = meso_growth_begin(grammar->seeds[i].entry, meso_growth_seed_key(1, grammar->seeds[i].site, 0));
    }
    while (queue.first < queue.count && queue.first < most)
        fixture_run(grammar, host, &queue, queue.first++);
    free(queue.tips);
    return queue.first;
}

#endif
