/*
 * Cause log: the changes of the last steps of a search with their causes, and which of its decisions a
 * dead end hangs on: for conflict-directed backjumping (Prosser, Hybrid algorithms for the constraint
 * satisfaction problem, 1993). It is a window: where it is full, the older half is forgotten.
 */
#ifndef MESO_CAUSE_LOG_H
#define MESO_CAUSE_LOG_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/math/vec.h"

/* The window: half a mebibyte in all. */
enum { MESO_CAUSE_LOG_CHANGES = 1 << 14, MESO_CAUSE_LOG_STEPS = 1 << 12, MESO_CAUSE_LOG_REASONS = 1 << 15 };

typedef struct MesoChange {
    uint32_t slot, before;      /* state that it had */
    uint32_t cause;             /* slot whose news it follows from; MESO_NO_INDEX for a step's first change */
} MesoChange;

typedef struct MesoStep {
    uint32_t first;             /* of its changes: of the slot that the search chose */
    uint32_t variant;           /* that the slot was reduced to, or lost */
    bool decision;              /* the former; else a conclusion from other steps: its reason */
    bool reason_known;          /* in full */
    uint32_t reason_begin, reason_count;    /* in `reasons` */
} MesoStep;

typedef struct MesoCauseLog {
    MesoChange changes[MESO_CAUSE_LOG_CHANGES];
    MesoStep steps[MESO_CAUSE_LOG_STEPS];
    uint64_t reasons[MESO_CAUSE_LOG_REASONS];     /* serial numbers of decisions */
    uint32_t change_count, step_count, reason_count;
    uint64_t first_serial;      /* of steps[0]; serial numbers are not used twice, but for steps taken back */
    bool partial;               /* there are steps that were forgotten, or never told */
    bool muted;                 /* no step is at hand, or one with too many changes */
} MesoCauseLog;

/* The decisions that a dead end hangs on. */
typedef struct MesoConflict {
    uint64_t decisions[MESO_CAUSE_LOG_STEPS];     /* serial numbers, the latest first */
    uint32_t count;
    bool whole;                 /* and no others, that the log has forgotten */
} MesoConflict;

/* Forgets all steps, and is told none until one begins. `partial`: they are not taken back, or there were others. */
void meso_cause_log_clear(MesoCauseLog *causes, bool partial);

/* Begins a step; its changes follow, that of the chosen slot first. */
void meso_cause_log_begin(MesoCauseLog *causes, uint32_t variant, bool decision);

/* Makes room in a full log. */
void meso_cause_log_forget(MesoCauseLog *causes);

static inline void meso_cause_log_change(MesoCauseLog *causes, uint32_t slot, uint32_t before, uint32_t cause)
{
    if (causes->change_count == MESO_CAUSE_LOG_CHANGES)
        meso_cause_log_forget(causes);
    if (!causes->muted)
        causes->changes[causes->change_count++] = (MesoChange){slot, before, cause};
}

/* Takes the last step out, if it is here. */
void meso_cause_log_pop(MesoCauseLog *causes);

/* Says what the last step, which is no decision, is concluded from. */
void meso_cause_log_conclude(MesoCauseLog *causes, const uint64_t *decisions, uint32_t count, bool whole);

/*
 * The decisions without which slot `dead` would have a variant left: those that its changes, and the
 * changes they follow from, lead back to. `teller` is the neighbour whose news left it none; `dead` is
 * MESO_NO_INDEX where it has not changed. Slots had the states initial[slot] before all decisions. `bit` is a mask
 * of marks[slot] that is free for use, and 0 before and after. O(changes from the first of these decisions on).
 */
void meso_cause_log_explain(const MesoCauseLog *causes, uint32_t dead, uint32_t teller, const uint32_t *initial,
                          uint8_t *marks, uint8_t bit, MesoConflict *conflict);

/* Place in `steps` of the step with a serial number, or MESO_NO_INDEX where it was forgotten. */
static inline uint32_t meso_cause_log_find(const MesoCauseLog *causes, uint64_t serial)
{
    return serial < causes->first_serial ? MESO_NO_INDEX : (uint32_t)(serial - causes->first_serial);
}

#endif
