/*
 * Runs rules, one branch at a time. The code is left at every command, and the engine goes on with it when that is
 * done: so that steps of all branches can be tried together and accepted in order. What a rule asks of the place is
 * answered by the host. Random numbers depend on the branch's key and the place in the rule's text alone: a draw more
 * in one rule, another rule or another seed changes no other branch.
 */
#ifndef MESO_GRAMMAR_RUN_H
#define MESO_GRAMMAR_RUN_H

#include <string.h>

#include "libcore/growth/language/grammar.h"

/* Of a branch; lengths in units of the surface. */
typedef enum MesoGrowthState {
    MESO_STATE_GENERATION,      /* rules run since its seed */
    MESO_STATE_DEPTH,           /* branchings since its seed */
    MESO_STATE_LENGTH,          /* along the way from its seed */
    MESO_STATE_WIDTH,           /* at the end of its last step */
    MESO_STATE_X, MESO_STATE_Y, MESO_STATE_Z,
    MESO_STATE_COUNT
} MesoGrowthState;

typedef enum MesoGrowthLook {
    MESO_LOOK_MAP,              /* the map's value here */
    MESO_LOOK_AHEAD,            /* its average from here to the distance a ahead */
    MESO_LOOK_SIDE,             /* its value at the distance a to the left; to the right where that is negative */
    MESO_LOOK_GRADIENT,         /* the length of its gradient */
    MESO_LOOK_NOISE,            /* in [-1, 1], of features of size a; b chooses among noises */
    MESO_LOOK_HEIGHT, MESO_LOOK_SLOPE, MESO_LOOK_CURVATURE,
    MESO_LOOK_CLEAR,            /* whether nothing has grown within a */
    MESO_LOOK_MEETS             /* whether a step of length a, turned by b, would meet what has grown */
} MesoGrowthLook;

typedef struct MesoGrowthHost {
    void *context;
    const double *state;        /* [MESO_STATE_COUNT] */
    /* `map` is MESO_NO_INDEX where the look-up is not of a map. A truth is 1 or 0. */
    double (*look)(void *context, MesoGrowthLook look, uint32_t map, double a, double b);
    void (*turn)(void *context, double angle);  /* turns the branch, and its rule goes on; NULL: turns are commands */
} MesoGrowthHost;

/* Values of steps and placed shapes, in this order; a rule's arguments begin at 0. */
typedef enum MesoGrowthValue {
    MESO_GROWTH_AMOUNT,         /* length of a step or move, size of a shape, angle of a turn, share of facing */
    MESO_GROWTH_ANGLE,          /* by which a step turns; of a move's way to the heading; a shape's tilt */
    MESO_GROWTH_WIDTH, MESO_GROWTH_END_WIDTH, MESO_GROWTH_LIFT, MESO_GROWTH_ROLL, MESO_GROWTH_TINT, MESO_GROWTH_CLEAR,
    MESO_GROWTH_CROSS,          /* 1: the step may cross what has grown */
    MESO_GROWTH_RETRIES,        /* how often to try other ways when a step is refused */
    MESO_GROWTH_RETRY_ANGLE,    /* within this to both sides of the first */
    MESO_GROWTH_VALUES = MESO_GRAMMAR_ARGUMENTS
} MesoGrowthValue;

typedef enum MesoGrowthOrder {
    MESO_GROWTH_STEP, MESO_GROWTH_MOVE, MESO_GROWTH_TURN, MESO_GROWTH_FACE, MESO_GROWTH_PLACE,
    MESO_GROWTH_BRANCH,         /* a new branch here, which runs from `entry` with a copy of the registers */
    MESO_GROWTH_RULE,           /* the branch goes on as `rule`, in the next generation */
    MESO_GROWTH_END,
    MESO_GROWTH_FAULT           /* the branch cannot go on: see `fault` */
} MesoGrowthOrder;

typedef struct MesoGrowthCommand {
    MesoGrowthOrder order;
    uint32_t given;             /* bit i: values[i] was written */
    double values[MESO_GROWTH_VALUES];  /* finite; 0 where nothing was written, but for facing, where it is 1 */
    uint32_t shape, field, rule;        /* MESO_NO_INDEX: none */
    uint32_t entry;             /* of a branch */
    uint32_t condition;         /* that must hold all along a step: for meso_growth_value(); or MESO_NO_INDEX */
    bool join;                  /* cut a step that is refused at the strand that it meets, and end there */
    uint64_t key;               /* of the new branch, or of the one that goes on as a rule; for draws of the engine's */
    const char *fault;          /* "a value is not finite" */
    uint32_t line;              /* of the text */
} MesoGrowthCommand;

/* Where a branch is in the code. Its registers [grammar->register_count] are the caller's; the first
 * grammar->local_count of them must stay from one command to the next. */
typedef struct MesoGrowthRun {
    uint64_t key;
    uint32_t at;                /* in the code */
    uint32_t refused;           /* where to go on after a step that was refused */
    uint32_t turns;             /* of loops, so far */
    bool stepped;               /* the last command was a step */
} MesoGrowthRun;

/* Registers of a branch, which are few as a rule. */
static inline void meso_copy_registers(double *to, const double *from, uint32_t count)
{
    if (count == 1)
        *to = *from;
    else if (count)
        memcpy(to, from, count * sizeof *to);
}

/* Most turns of a rule's loops, for all of them together. */
enum { MESO_GROWTH_TURNS = 1 << 17 };

/* Member by member: it is run, and so read, at once. */
static inline void meso_growth_restart(MesoGrowthRun *run, uint32_t entry, uint64_t key)
{
    run->key = key;
    run->at = entry;
    run->refused = MESO_NO_INDEX;
    run->turns = 0;
    run->stepped = false;
}

static inline MesoGrowthRun meso_growth_begin(uint32_t entry, uint64_t key)
{
    return (MesoGrowthRun){.key = key, .at = entry, .refused = MESO_NO_INDEX};
}

/*
 * Runs to the next command. `done`: whether the last one could be done; it matters after steps alone. `command` is the
 * last one, of whichever branch; before the first it is all 0.
 */
void meso_growth_resume(MesoGrowthCommand *command, const MesoGrammar *grammar, MesoGrowthRun *run, double *registers,
                        const MesoGrowthHost *host, bool done);

/* The value of the code at `entry`: a step's condition, a seed's, or a number of its places. */
double meso_growth_value(const MesoGrammar *grammar, const MesoGrowthRun *run, uint32_t entry, double *registers,
                         const MesoGrowthHost *host);

/* Key of a seed's branch: of the job's seed, the seed's site and its number there. */
uint64_t meso_growth_seed_key(uint64_t job, uint64_t site, uint64_t number);

#endif
