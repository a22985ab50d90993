/*
 * Checks proofs of the exact engine, for tests: forward, by code that shares nothing
 * with CaDiCaL. A line of a DRAT proof adds a clause or, after a 'd', deletes one. An added
 * clause must follow by unit propagation from its negation (RUP), or else have on
 * its first literal only resolvents that do (RAT). Deletions of clauses that are units under what
 * holds already are passed over, as drat-trim does: Wetzler, Heule, Hunt,
 * "DRAT-trim: Efficient Checking and Trimming Using Expressive Clausal Proofs" (2014).
 */
#ifndef MESO_DRAT_CHECKER_H
#define MESO_DRAT_CHECKER_H

#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"

#include <stdbool.h>
#include <stdint.h>

enum { DRAT_NONE = -1, DRAT_BUCKETS = 1 << 16 };

typedef struct DratClause {
    uint32_t begin, size;       /* in `literals`; the first two are watched */
    int32_t next;               /* of the same bucket */
    bool deleted;
} DratClause;

typedef struct DratList {
    int32_t *items;
    uint32_t count, room;
} DratList;

typedef struct DratChecker {
    DratList literals, trail;
    DratClause *clauses;
    uint32_t clause_count, clause_room;
    uint32_t variable_count;
    DratList *watches;          /* [2 * variable_count] clauses that watch a literal, by code */
    int8_t *value;              /* [2 * variable_count] of a literal: 1 true, -1 false, 0 open */
    int32_t *reason;            /* [variable_count] clause that made it hold, or DRAT_NONE */
    uint32_t propagated;        /* of the trail */
    int32_t bucket[DRAT_BUCKETS];
    bool refuted;               /* the empty clause was added, and follows */
    bool conflict;              /* what holds already contradicts a clause */
    uint64_t rup_count, rat_count, deletion_count;
    const char *finding;        /* what is wrong, or NULL */
    uint64_t line;              /* of the proof, where it is */
} DratChecker;

static inline void drat_push(DratList *list, int32_t item)
{
    if (list->count == list->room) {
        list->room = list->room ? 2 * list->room : 4;
        list->items = realloc(list->items, list->room * sizeof *list->items);
        CHECK(list->items);
    }
    list->items[list->count++] = item;
}

static inline uint32_t drat_code(int32_t literal)
{
    return literal > 0 ? 2 * (uint32_t)(literal - 1) : 2 * (uint32_t)(-literal - 1) + 1;
}

static inline void drat_init(DratChecker *checker)
{
    memset(checker, 0, sizeof *checker);
    memset(checker->bucket, DRAT_NONE, sizeof checker->bucket);
}

static inline void drat_release(DratChecker *checker)
{
    for (uint32_t i = 0; i < 2 * checker->variable_count; i++)
        free(checker->watches[i].items);
    free(checker->literals.items);
    free(checker->trail.items);
    free(checker->clauses);
    free(checker->watches);
    free(checker->value);
    free(checker->reason);
}

static inline void drat_make_room(DratChecker *checker, uint32_t variable)
{
    uint32_t old = checker->variable_count, new = variable < 2 * old ? 2 * old : variable;
    if (variable <= old)
        return;
    checker->watches = realloc(checker->watches, 2 * (size_t)new * sizeof *checker->watches);
    checker->value = realloc(checker->value, 2 * (size_t)new * sizeof *checker->value);
    checker->reason = realloc(checker->reason, new * sizeof *checker->reason);
    CHECK(checker->watches && checker->value && checker->reason);
    memset(checker->watches + 2 * (size_t)old, 0, 2 * (size_t)(new - old) * sizeof *checker->watches);
    memset(checker->value + 2 * (size_t)old, 0, 2 * (size_t)(new - old) * sizeof *checker->value);
    for (uint32_t v = old; v < new; v++)
        checker->reason[v] = DRAT_NONE;
    checker->variable_count = new;
}

static inline int8_t drat_value(const DratChecker *checker, int32_t literal)
{
    return checker->value[drat_code(literal)];
}

static inline void drat_assign(DratChecker *checker, int32_t literal, int32_t reason)
{
    checker->value[drat_code(literal)] = 1;
    checker->value[drat_code(-literal)] = -1;
    checker->reason[drat_code(literal) / 2] = reason;
    drat_push(&checker->trail, literal);
}

/* Takes back what was assigned after the first `count` of the trail. */
static inline void drat_undo(DratChecker *checker, uint32_t count)
{
    while (checker->trail.count > count) {
        int32_t literal = checker->trail.items[--checker->trail.count];
        checker->value[drat_code(literal)] = checker->value[drat_code(-literal)] = 0;
        checker->reason[drat_code(literal) / 2] = DRAT_NONE;
    }
    checker->propagated = count;
}

/* Puts a literal that is not false in place `to` of the clause, from there on; false where there is none. */
static inline bool drat_find_watch(const DratChecker *checker, const DratClause *clause, uint32_t to)
{
    int32_t *literals = checker->literals.items + clause->begin;
    for (uint32_t i = to; i < clause->size; i++)
        if (drat_value(checker, literals[i]) >= 0) {
            int32_t swap = literals[to];
            literals[to] = literals[i];
            literals[i] = swap;
            return true;
        }
    return false;
}

/* `watched` of clause `number` became false: true where it still watches. *conflict where all of the clause is
 * false. */
static inline bool drat_visit(DratChecker *checker, int32_t number, int32_t watched, bool *conflict)
{
    const DratClause *clause = &checker->clauses[number];
    int32_t *literals = checker->literals.items + clause->begin;
    if (clause->deleted)
        return false;
    if (literals[0] == watched) {
        literals[0] = literals[1];
        literals[1] = watched;
    }
    if (drat_value(checker, literals[0]) > 0)
        return true;
    if (drat_find_watch(checker, clause, 1)) {
        drat_push(&checker->watches[drat_code(literals[1])], number);
        return false;
    }
    if (drat_value(checker, literals[0]) < 0)
        *conflict = true;
    else
        drat_assign(checker, literals[0], number);
    return true;
}

/* Unit propagation; true at a conflict. */
static inline bool drat_propagate(DratChecker *checker)
{
    bool conflict = false;
    while (!conflict && checker->propagated < checker->trail.count) {
        int32_t watched = -checker->trail.items[checker->propagated++];
        DratList *list = &checker->watches[drat_code(watched)];
        uint32_t kept = 0;
        for (uint32_t i = 0; i < list->count; i++) {
            int32_t number = list->items[i];
            if (conflict || drat_visit(checker, number, watched, &conflict))
                list->items[kept++] = number;
        }
        list->count = kept;
    }
    return conflict;
}

static inline uint32_t drat_bucket(const int32_t *literals, uint32_t count)
{
    uint64_t sum = count;
    for (uint32_t i = 0; i < count; i++)
        sum += (uint64_t)(drat_code(literals[i]) + 1) * 0x9e3779b97f4a7c15u;
    return (uint32_t)(sum >> 32) % DRAT_BUCKETS;
}

/* Appends the clause, which is taken to hold, and what follows from it by propagation. */
static inline void drat_append(DratChecker *checker, const int32_t *literals, uint32_t count)
{
    int32_t number = (int32_t)checker->clause_count, *bucket = &checker->bucket[drat_bucket(literals, count)];
    if (checker->clause_count == checker->clause_room) {
        checker->clause_room = checker->clause_room ? 2 * checker->clause_room : 64;
        checker->clauses = realloc(checker->clauses, checker->clause_room * sizeof *checker->clauses);
        CHECK(checker->clauses);
    }
    DratClause *clause = &checker->clauses[checker->clause_count++];
    *clause = (DratClause){.begin = checker->literals.count, .size = count, .next = *bucket};
    *bucket = number;
    for (uint32_t i = 0; i < count; i++)
        drat_push(&checker->literals, literals[i]);
    bool open = drat_find_watch(checker, clause, 0), wide = count > 1 && drat_find_watch(checker, clause, 1);
    const int32_t *own = checker->literals.items + clause->begin;
    for (uint32_t i = 0; i < 2 && count > 1; i++)
        drat_push(&checker->watches[drat_code(own[i])], number);
    if (!open)
        checker->conflict = true;
    else if (!wide && drat_value(checker, own[0]) == 0)
        drat_assign(checker, own[0], number);
    if (!checker->conflict && drat_propagate(checker))
        checker->conflict = true;
}

/* Assigns the negations of the literals but `but`; true where that meets a conflict. */
static inline bool drat_deny(DratChecker *checker, const int32_t *literals, uint32_t count, int32_t but)
{
    for (uint32_t i = 0; i < count; i++) {
        if (literals[i] == but)
            continue;
        if (drat_value(checker, literals[i]) > 0)
            return true;
        if (drat_value(checker, literals[i]) == 0)
            drat_assign(checker, -literals[i], DRAT_NONE);
    }
    return drat_propagate(checker);
}

/* With the clause denied already: all its resolvents on `pivot` follow. */
static inline bool drat_resolvents_follow(DratChecker *checker, int32_t pivot)
{
    uint32_t level = checker->trail.count;
    for (uint32_t c = 0; c < checker->clause_count; c++) {
        const DratClause *clause = &checker->clauses[c];
        bool touched = false;
        for (uint32_t i = 0; i < clause->size && !clause->deleted; i++)
            touched |= checker->literals.items[clause->begin + i] == -pivot;
        if (!touched)
            continue;
        bool follows = drat_deny(checker, checker->literals.items + clause->begin, clause->size, -pivot);
        drat_undo(checker, level);
        if (!follows)
            return false;
    }
    return true;
}

/* Whether the clause may be added to what there is. */
static inline bool drat_follows(DratChecker *checker, const int32_t *literals, uint32_t count)
{
    if (checker->conflict) {
        checker->rup_count++;
        return true;
    }
    uint32_t level = checker->trail.count;
    bool rup = drat_deny(checker, literals, count, 0);
    bool rat = !rup && count > 0 && drat_resolvents_follow(checker, literals[0]);
    drat_undo(checker, level);
    checker->rup_count += rup;
    checker->rat_count += rat;
    return rup || rat;
}

static inline bool drat_same(const DratChecker *checker, const DratClause *clause, const int32_t *literals,
                             uint32_t count)
{
    bool same = clause->size == count && !clause->deleted;
    for (uint32_t i = 0; i < count && same; i++) {
        bool found = false;
        for (uint32_t j = 0; j < count; j++)
            found |= checker->literals.items[clause->begin + j] == literals[i];
        same = found;
    }
    return same;
}

/* Deletes one such clause; false where there is none. */
static inline bool drat_delete(DratChecker *checker, const int32_t *literals, uint32_t count)
{
    int32_t number = checker->bucket[drat_bucket(literals, count)];
    while (number != DRAT_NONE && !drat_same(checker, &checker->clauses[number], literals, count))
        number = checker->clauses[number].next;
    if (number == DRAT_NONE)
        return false;
    checker->deletion_count++;
    for (uint32_t i = 0; i < count; i++)
        if (drat_value(checker, literals[i]) > 0 && checker->reason[drat_code(literals[i]) / 2] == number)
            return true;
    checker->clauses[number].deleted = true;
    return true;
}

/* Each literal once; the first stays first. */
static inline uint32_t drat_drop_doubles(int32_t *literals, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool known = false;
        for (uint32_t j = 0; j < kept; j++)
            known |= literals[j] == literals[i];
        if (!known)
            literals[kept++] = literals[i];
    }
    return kept;
}

/* Reads numbers up to a 0 and makes room for their variables; the text after them, or NULL where they are none. */
static inline const char *drat_read_clause(DratChecker *checker, const char *text, DratList *literals)
{
    literals->count = 0;
    for (;;) {
        char *end;
        long number = strtol(text, &end, 10);
        if (end == text || number > INT32_MAX / 2 || number < -INT32_MAX / 2)
            return NULL;
        text = end;
        if (number == 0)
            break;
        drat_push(literals, (int32_t)number);
        drat_make_room(checker, (uint32_t)labs(number));
    }
    literals->count = drat_drop_doubles(literals->items, literals->count);
    return text;
}

static inline const char *drat_skip_blanks(const char *text)
{
    return text + strspn(text, " \t\r\n");
}

/* A formula in DIMACS, or its clauses alone. */
static inline void drat_read_formula(DratChecker *checker, const char *text)
{
    DratList literals = {0};
    for (text = drat_skip_blanks(text); text && *text; text = text ? drat_skip_blanks(text) : NULL) {
        if (*text == 'c' || *text == 'p') {
            text += strcspn(text, "\n");
            continue;
        }
        text = drat_read_clause(checker, text, &literals);
        if (text)
            drat_append(checker, literals.items, literals.count);
        checker->refuted |= text && literals.count == 0;
    }
    if (!text)
        checker->finding = "not a formula in DIMACS";
    free(literals.items);
}

static inline const char *drat_check_line(DratChecker *checker, const char *text, DratList *literals)
{
    bool deletes = *text == 'd';
    text = drat_read_clause(checker, text + deletes, literals);
    checker->line++;
    if (!text)
        checker->finding = "not a line of a proof";
    else if (deletes && !drat_delete(checker, literals->items, literals->count))
        checker->finding = "deletes a clause that is not there";
    else if (!deletes && !drat_follows(checker, literals->items, literals->count))
        checker->finding = "adds a clause that does not follow";
    else if (!deletes && literals->count > 0)
        drat_append(checker, literals->items, literals->count);
    else if (!deletes)
        checker->refuted = true;
    return text;
}

/* True where the proof shows that the formula read before has no solution; else `finding` says why not. */
static inline bool drat_check(DratChecker *checker, const char *proof)
{
    DratList literals = {0};
    const char *text = drat_skip_blanks(proof);
    while (!checker->finding && !checker->refuted && *text) {
        text = drat_check_line(checker, text, &literals);
        text = text ? drat_skip_blanks(text) : "";
    }
    free(literals.items);
    if (!checker->finding && !checker->refuted)
        checker->finding = "ends without the empty clause";
    return !checker->finding;
}

#endif
