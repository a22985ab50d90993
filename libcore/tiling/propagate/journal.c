#include "libcore/tiling/propagate/journal.h"

#include <assert.h>
#include <string.h>

void meso_journal_clear(MesoJournal *journal, bool partial)
{
    journal->first_serial += journal->step_count;
    journal->change_count = journal->step_count = journal->reason_count = 0;
    journal->partial = partial;
    journal->muted = true;
}

/* Forgets the first `count` steps. */
static void forget_steps(MesoJournal *journal, uint32_t count)
{
    if (count == journal->step_count) {
        meso_journal_clear(journal, true);
        return;
    }
    uint32_t change = journal->steps[count].first, reason = journal->steps[count].reason_begin;
    journal->step_count -= count;
    journal->change_count -= change;
    journal->reason_count -= reason;
    journal->first_serial += count;
    journal->partial = true;
    memmove(journal->steps, journal->steps + count, journal->step_count * sizeof *journal->steps);
    memmove(journal->changes, journal->changes + change, journal->change_count * sizeof *journal->changes);
    memmove(journal->reasons, journal->reasons + reason, journal->reason_count * sizeof *journal->reasons);
    for (uint32_t i = 0; i < journal->step_count; i++) {
        journal->steps[i].first -= change;
        journal->steps[i].reason_begin -= reason;
    }
}

void meso_journal_forget(MesoJournal *journal)
{
    if (journal->muted)
        return;
    uint32_t count = 1;
    while (count < journal->step_count && journal->steps[count].first < MESO_JOURNAL_CHANGES / 2)
        count++;
    forget_steps(journal, count);
}

void meso_journal_begin(MesoJournal *journal, uint32_t variant, bool decision)
{
    journal->muted = false;
    if (journal->step_count == MESO_JOURNAL_STEPS)
        forget_steps(journal, MESO_JOURNAL_STEPS / 2);
    journal->steps[journal->step_count++] = (MesoStep){.first = journal->change_count, .variant = variant,
                                                       .decision = decision, .reason_begin = journal->reason_count};
}

void meso_journal_pop(MesoJournal *journal)
{
    if (journal->step_count == 0)
        return;
    const MesoStep *step = &journal->steps[--journal->step_count];
    journal->change_count = step->first;
    journal->reason_count = step->reason_begin;
}

void meso_journal_conclude(MesoJournal *journal, const uint64_t *decisions, uint32_t count, bool whole)
{
    if (journal->muted)
        return;
    MesoStep *step = &journal->steps[journal->step_count - 1];
    assert(!step->decision);
    if (count > MESO_JOURNAL_REASONS - journal->reason_count)
        return;
    memcpy(journal->reasons + journal->reason_count, decisions, count * sizeof *decisions);
    step->reason_count = count;
    step->reason_known = whole;
    journal->reason_count += count;
}

typedef struct Tracer {
    const MesoJournal *journal;
    const uint32_t *initial;
    uint8_t *marks, bit;        /* marked are slots whose state at the time at hand matters */
    uint32_t marked_count, wanted_count;
    uint32_t list[MESO_JOURNAL_CHANGES + 2], list_count;    /* of slots that were marked */
    bool wanted[MESO_JOURNAL_STEPS];    /* decisions that a conclusion was drawn from */
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
        uint32_t place = meso_journal_find(tracer->journal, tracer->journal->reasons[step->reason_begin + i]);
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
    const MesoStep *step = &tracer->journal->steps[s];
    bool chosen = tracer->wanted[s];
    tracer->wanted_count -= chosen;
    for (uint32_t i = end; i-- > step->first;) {
        const MesoChange *change = &tracer->journal->changes[i];
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

void meso_journal_explain(const MesoJournal *journal, uint32_t dead, uint32_t teller, const uint32_t *initial,
                          uint8_t *marks, uint8_t bit, MesoConflict *conflict)
{
    Tracer tracer;
    tracer.journal = journal;
    tracer.initial = initial;
    tracer.marks = marks;
    tracer.bit = bit;
    tracer.marked_count = tracer.wanted_count = tracer.list_count = 0;
    tracer.whole = !journal->muted;
    memset(tracer.wanted, 0, journal->step_count * sizeof *tracer.wanted);
    uint32_t end = journal->change_count;
    conflict->count = 0;
    mark_slot(&tracer, dead);
    mark_slot(&tracer, teller);
    for (uint32_t s = journal->step_count; s-- > 0 && tracer.marked_count + tracer.wanted_count > 0;) {
        const MesoStep *step = &journal->steps[s];
        bool chosen = trace_step(&tracer, s, end);
        if (chosen && step->decision)
            conflict->decisions[conflict->count++] = journal->first_serial + s;
        else if (chosen)
            want_reason(&tracer, step);
        end = step->first;
    }
    /* A slot that keeps its mark may never have changed, or have done so in a step that was forgotten. */
    conflict->whole = tracer.whole && (tracer.marked_count == 0 || !journal->partial);
    for (uint32_t i = 0; i < tracer.list_count; i++)
        marks[tracer.list[i]] &= (uint8_t)~bit;
}
