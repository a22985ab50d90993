#include "libcore/tiling/propagate/cause_log.h"

#include <assert.h>
#include <string.h>

void meso_cause_log_clear(MesoCauseLog *causes, bool partial)
{
    causes->first_serial += causes->step_count;
    causes->change_count = causes->step_count = causes->reason_count = 0;
    causes->partial = partial;
    causes->muted = true;
}

/* Forgets the first `count` steps. */
static void forget_steps(MesoCauseLog *causes, uint32_t count)
{
    if (count == causes->step_count) {
        meso_cause_log_clear(causes, true);
        return;
    }
    uint32_t change = causes->steps[count].first, reason = causes->steps[count].reason_begin;
    causes->step_count -= count;
    causes->change_count -= change;
    causes->reason_count -= reason;
    causes->first_serial += count;
    causes->partial = true;
    memmove(causes->steps, causes->steps + count, causes->step_count * sizeof *causes->steps);
    memmove(causes->changes, causes->changes + change, causes->change_count * sizeof *causes->changes);
    memmove(causes->reasons, causes->reasons + reason, causes->reason_count * sizeof *causes->reasons);
    for (uint32_t i = 0; i < causes->step_count; i++) {
        causes->steps[i].first -= change;
        causes->steps[i].reason_begin -= reason;
    }
}

void meso_cause_log_forget(MesoCauseLog *causes)
{
    if (causes->muted)
        return;
    uint32_t count = 1;
    while (count < causes->step_count && causes->steps[count].first < MESO_CAUSE_LOG_CHANGES / 2)
        count++;
    forget_steps(causes, count);
}

void meso_cause_log_begin(MesoCauseLog *causes, uint32_t variant, bool decision)
{
    causes->muted = false;
    if (causes->step_count == MESO_CAUSE_LOG_STEPS)
        forget_steps(causes, MESO_CAUSE_LOG_STEPS / 2);
    causes->steps[causes->step_count++] = (MesoStep){.first = causes->change_count, .variant = variant,
                                                       .decision = decision, .reason_begin = causes->reason_count};
}

void meso_cause_log_pop(MesoCauseLog *causes)
{
    if (causes->step_count == 0)
        return;
    const MesoStep *step = &causes->steps[--causes->step_count];
    causes->change_count = step->first;
    causes->reason_count = step->reason_begin;
}

void meso_cause_log_conclude(MesoCauseLog *causes, const uint64_t *decisions, uint32_t count, bool whole)
{
    if (causes->muted)
        return;
    MesoStep *step = &causes->steps[causes->step_count - 1];
    assert(!step->decision);
    if (count > MESO_CAUSE_LOG_REASONS - causes->reason_count)
        return;
    memcpy(causes->reasons + causes->reason_count, decisions, count * sizeof *decisions);
    step->reason_count = count;
    step->reason_known = whole;
    causes->reason_count += count;
}

typedef struct Tracer {
    const MesoCauseLog *causes;
    const uint32_t *initial;
    uint8_t *marks, bit;        /* marked are slots whose state at the time at hand matters */
    uint32_t marked_count, wanted_count;
    uint32_t list[MESO_CAUSE_LOG_CHANGES + 2], list_count;    /* of slots that were marked */
    bool wanted[MESO_CAUSE_LOG_STEPS];    /* decisions that a conclusion was drawn from */
    bool whole;
} Tracer;

static bool is_marked(const Tracer *tracer, uint32_t slot)
{
    return tracer->marks[slot] & tracer->bit;
}

static void mark_slot(Tracer *tracer, uint32_t slot)
{
    if (slot == MESO_NO_INDEX || is_marked(tracer, slot))
        return;
    tracer->marks[slot] |= tracer->bit;
    tracer->list[tracer->list_count++] = slot;
    tracer->marked_count++;
}

static void unmark_slot(Tracer *tracer, uint32_t slot)
{
    tracer->marks[slot] &= (uint8_t)~tracer->bit;
    tracer->marked_count--;
}

static void want_reason(Tracer *tracer, const MesoStep *step)
{
    tracer->whole &= step->reason_known;
    for (uint32_t i = 0; i < step->reason_count; i++) {
        uint32_t place = meso_cause_log_find(tracer->causes, tracer->causes->reasons[step->reason_begin + i]);
        if (place == MESO_NO_INDEX) {
            tracer->whole = false;
        } else if (!tracer->wanted[place]) {
            tracer->wanted[place] = true;
            tracer->wanted_count++;
        }
    }
}

/*
 * Back through the changes of step `s`, before `end`; whether the dead end hangs on its choice. What befell a
 * slot before the search decided it does not matter for what followed from that, nor is there more
 * to a slot than its first change.
 */
static bool trace_step(Tracer *tracer, uint32_t s, uint32_t end)
{
    const MesoStep *step = &tracer->causes->steps[s];
    bool chosen = tracer->wanted[s];
    tracer->wanted_count -= chosen;
    for (uint32_t i = end; i-- > step->first;) {
        const MesoChange *change = &tracer->causes->changes[i];
        if (!is_marked(tracer, change->slot))
            continue;
        chosen |= i == step->first;
        if ((i == step->first && step->decision) || change->before == tracer->initial[change->slot])
            unmark_slot(tracer, change->slot);
        if (i > step->first)
            mark_slot(tracer, change->cause);
    }
    return chosen;
}

void meso_cause_log_explain(const MesoCauseLog *causes, uint32_t dead, uint32_t teller, const uint32_t *initial,
                          uint8_t *marks, uint8_t bit, MesoConflict *conflict)
{
    Tracer tracer;
    tracer.causes = causes;
    tracer.initial = initial;
    tracer.marks = marks;
    tracer.bit = bit;
    tracer.marked_count = tracer.wanted_count = tracer.list_count = 0;
    tracer.whole = !causes->muted;
    memset(tracer.wanted, 0, causes->step_count * sizeof *tracer.wanted);
    uint32_t end = causes->change_count;
    conflict->count = 0;
    mark_slot(&tracer, dead);
    mark_slot(&tracer, teller);
    for (uint32_t s = causes->step_count; s-- > 0 && tracer.marked_count + tracer.wanted_count > 0;) {
        const MesoStep *step = &causes->steps[s];
        bool chosen = trace_step(&tracer, s, end);
        if (chosen && step->decision)
            conflict->decisions[conflict->count++] = causes->first_serial + s;
        else if (chosen)
            want_reason(&tracer, step);
        end = step->first;
    }
    /* A slot that keeps its mark may never have changed, or have done so in a step that was forgotten. */
    conflict->whole = tracer.whole && (tracer.marked_count == 0 || !causes->partial);
    for (uint32_t i = 0; i < tracer.list_count; i++)
        marks[tracer.list[i]] &= (uint8_t)~bit;
}
