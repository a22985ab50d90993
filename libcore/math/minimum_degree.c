#include "libcore/math/minimum_degree.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

#include "libcore/base/index.h"

/*
 * The quotient graph. What has been eliminated is an element: the set of those variables that its elimination makes
 * neighbours of each other. A variable's list holds elements first, then variables; an element's holds variables.
 * Variables that cannot be told apart are one, of a size.
 */
typedef enum NodeKind { VARIABLE, ELEMENT, GONE } NodeKind;

typedef struct Quotient {
    uint32_t count, left;       /* left: variables not yet eliminated, by size */
    uint32_t *pool, *spare;     /* [room] lists, and where they are packed to */
    size_t used, room;
    size_t *begins;             /* [count] of lists in the pool */
    uint32_t *lengths;          /* [count] */
    uint32_t *element_counts;   /* [count] elements at the front of a variable's list */
    uint32_t *sizes;            /* [count] how many nodes a variable stands for; 0: eliminated, or part of another */
    uint32_t *degrees;          /* [count] bound of a variable's degree; an element's size */
    uint8_t *kinds;             /* [count] */
    uint32_t *nexts, *lasts;    /* [count] the nodes that a variable stands for, as a chain */

    /* Variables by degree, in rings that are open at both ends. */
    uint32_t *heads, *after, *before;   /* [count] each */
    uint32_t least;             /* no variable has a lower degree */

    uint32_t *seen, stamp;      /* [count] */
    uint32_t *outside;          /* [count] size of an element without the pivot's */
    uint32_t *bucket_heads, *bucket_after, *hashes; /* [count] variables with like lists */
} Quotient;

/* ---- variables by degree ---- */

static void list_variable(Quotient *q, uint32_t v)
{
    uint32_t degree = q->degrees[v], head = q->heads[degree];
    q->after[v] = head;
    q->before[v] = MESO_NO_INDEX;
    if (head != MESO_NO_INDEX)
        q->before[head] = v;
    q->heads[degree] = v;
    if (degree < q->least)
        q->least = degree;
}

static void unlist_variable(Quotient *q, uint32_t v)
{
    if (q->before[v] == MESO_NO_INDEX)
        q->heads[q->degrees[v]] = q->after[v];
    else
        q->after[q->before[v]] = q->after[v];
    if (q->after[v] != MESO_NO_INDEX)
        q->before[q->after[v]] = q->before[v];
}

static uint32_t take_least(Quotient *q)
{
    while (q->heads[q->least] == MESO_NO_INDEX)
        q->least++;
    uint32_t v = q->heads[q->least];
    unlist_variable(q, v);
    return v;
}

/* ---- the pool ---- */

static void pack_pool(Quotient *q)
{
    size_t used = 0;
    for (uint32_t v = 0; v < q->count; v++)
        if (q->kinds[v] != GONE) {
            memcpy(q->spare + used, q->pool + q->begins[v], q->lengths[v] * sizeof *q->pool);
            q->begins[v] = used;
            used += q->lengths[v];
        }
    uint32_t *pool = q->pool;
    q->pool = q->spare;
    q->spare = pool;
    q->used = used;
}

/* The lists never become longer in all than they were at first, and an element is no longer than what it takes in. */
static void make_room(Quotient *q, uint32_t pivot)
{
    const uint32_t *list = q->pool + q->begins[pivot];
    size_t need = q->lengths[pivot];
    for (uint32_t k = 0; k < q->element_counts[pivot]; k++)
        need += q->lengths[list[k]];
    if (need > q->room - q->used)
        pack_pool(q);
    assert(need <= q->room - q->used);
}

/* ---- the pivot becomes an element ---- */

static void add_members(Quotient *q, const uint32_t *list, uint32_t length)
{
    for (uint32_t k = 0; k < length; k++) {
        uint32_t v = list[k];
        if (q->kinds[v] == VARIABLE && q->seen[v] != q->stamp) {
            q->seen[v] = q->stamp;
            q->pool[q->used++] = v;
        }
    }
}

/* All that its elimination joins: its variables, and those of its elements, which it takes in. */
static void form_element(Quotient *q, uint32_t pivot)
{
    make_room(q, pivot);
    size_t begin = q->used;
    const uint32_t *list = q->pool + q->begins[pivot];
    uint32_t element_count = q->element_counts[pivot];
    q->seen[pivot] = ++q->stamp;
    for (uint32_t k = 0; k < element_count; k++) {
        uint32_t e = list[k];
        add_members(q, q->pool + q->begins[e], q->lengths[e]);
        q->kinds[e] = GONE;
    }
    add_members(q, list + element_count, q->lengths[pivot] - element_count);

    q->kinds[pivot] = ELEMENT;
    q->left -= q->sizes[pivot];
    q->sizes[pivot] = 0;
    q->begins[pivot] = begin;
    q->lengths[pivot] = (uint32_t)(q->used - begin);
    q->degrees[pivot] = 0;
    for (size_t k = begin; k < q->used; k++) {
        q->degrees[pivot] += q->sizes[q->pool[k]];
        unlist_variable(q, q->pool[k]);
    }
}

/* How much of each element near the pivot lies outside of the pivot's. */
static void measure_outside(Quotient *q, uint32_t pivot)
{
    const uint32_t *members = q->pool + q->begins[pivot];
    q->stamp++;
    for (uint32_t m = 0; m < q->lengths[pivot]; m++) {
        uint32_t v = members[m];
        const uint32_t *list = q->pool + q->begins[v];
        for (uint32_t k = 0; k < q->element_counts[v]; k++) {
            uint32_t e = list[k];
            if (q->kinds[e] != ELEMENT)
                continue;
            if (q->seen[e] != q->stamp) {
                q->seen[e] = q->stamp;
                q->outside[e] = q->degrees[e];
            }
            q->outside[e] -= q->sizes[v];
        }
    }
}

/* Joins the chain of nodes of `v` to that of `to`. */
static void absorb(Quotient *q, uint32_t to, uint32_t v)
{
    q->nexts[q->lasts[to]] = v;
    q->lasts[to] = q->lasts[v];
    q->sizes[v] = 0;
    q->kinds[v] = GONE;
}

/*
 * A member's list without what the pivot's element holds already, and with the pivot. Returns the part of its degree
 * that lies outside the pivot's element. An element that lies wholly within the pivot's is of no more use.
 */
static uint32_t prune_list(Quotient *q, uint32_t pivot, uint32_t v)
{
    uint32_t *list = q->pool + q->begins[v], length = 0, degree = 0, element_count, hash = pivot;
    for (uint32_t k = 0; k < q->element_counts[v]; k++) {
        uint32_t e = list[k];
        if (q->kinds[e] != ELEMENT)
            continue;
        if (q->outside[e] == 0) {
            q->kinds[e] = GONE;
            continue;
        }
        degree += q->outside[e];
        hash += e;
        list[length++] = e;
    }
    element_count = length;
    for (uint32_t k = q->element_counts[v]; k < q->lengths[v]; k++) {
        uint32_t w = list[k];
        /* what the pivot's element joins needs no side of its own: members have kept their stamp one below */
        if (q->kinds[w] != VARIABLE || q->seen[w] == q->stamp - 1)
            continue;
        degree += q->sizes[w];
        hash += w;
        list[length++] = w;
    }
    assert(length < q->lengths[v]);
    list[length] = list[element_count];
    list[element_count] = pivot;
    q->element_counts[v] = element_count + 1;
    q->lengths[v] = length + 1;
    q->hashes[v] = hash % q->count;
    return degree;
}

static uint32_t least_of(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Members that have nothing but the pivot's element go with it; of the others, new bounds of degrees. */
static void update_members(Quotient *q, uint32_t pivot)
{
    const uint32_t *members = q->pool + q->begins[pivot];
    for (uint32_t m = 0; m < q->lengths[pivot]; m++) {
        uint32_t v = members[m], outside = prune_list(q, pivot, v);
        if (outside == 0 && q->lengths[v] == 1) {
            q->left -= q->sizes[v];
            q->degrees[pivot] -= q->sizes[v];
            absorb(q, pivot, v);
            continue;
        }
        q->degrees[v] = least_of(q->degrees[v], outside);
        q->bucket_after[v] = q->bucket_heads[q->hashes[v]];
        q->bucket_heads[q->hashes[v]] = v;
    }
}

/* ---- variables that cannot be told apart ---- */

static bool same_list(const Quotient *q, uint32_t v, uint32_t w)
{
    if (q->lengths[v] != q->lengths[w] || q->element_counts[v] != q->element_counts[w])
        return false;
    const uint32_t *list = q->pool + q->begins[w];
    for (uint32_t k = 0; k < q->lengths[w]; k++)
        if (q->seen[list[k]] != q->stamp)
            return false;
    return true;
}

/* Joins to `v` those behind it in its bucket that are like it. */
static void absorb_like(Quotient *q, uint32_t v)
{
    if (q->bucket_after[v] == MESO_NO_INDEX)
        return;
    const uint32_t *list = q->pool + q->begins[v];
    q->stamp++;
    for (uint32_t k = 0; k < q->lengths[v]; k++)
        q->seen[list[k]] = q->stamp;
    for (uint32_t *link = &q->bucket_after[v]; *link != MESO_NO_INDEX;) {
        uint32_t w = *link;
        if (!same_list(q, v, w)) {
            link = &q->bucket_after[w];
            continue;
        }
        *link = q->bucket_after[w];
        q->sizes[v] += q->sizes[w];
        absorb(q, v, w);
    }
}

static void join_alike(Quotient *q, uint32_t pivot)
{
    const uint32_t *members = q->pool + q->begins[pivot];
    for (uint32_t m = 0; m < q->lengths[pivot]; m++) {
        if (q->kinds[members[m]] != VARIABLE)
            continue;
        uint32_t hash = q->hashes[members[m]];
        for (uint32_t v = q->bucket_heads[hash]; v != MESO_NO_INDEX; v = q->bucket_after[v])
            absorb_like(q, v);
        q->bucket_heads[hash] = MESO_NO_INDEX;
    }
}

/* ---- a step ---- */

/* The element keeps those members that are still there, which are listed by their new degrees. */
static void finish_element(Quotient *q, uint32_t pivot)
{
    uint32_t *members = q->pool + q->begins[pivot], length = 0;
    for (uint32_t m = 0; m < q->lengths[pivot]; m++) {
        uint32_t v = members[m];
        if (q->kinds[v] != VARIABLE)
            continue;
        uint32_t within = q->degrees[pivot] - q->sizes[v];
        q->degrees[v] = least_of(q->left - q->sizes[v], q->degrees[v] + within);
        list_variable(q, v);
        members[length++] = v;
    }
    q->lengths[pivot] = length;
    q->used = q->begins[pivot] + length;
    if (length == 0)
        q->kinds[pivot] = GONE;
}

static uint32_t eliminate_least(Quotient *q, uint32_t *order, uint32_t done)
{
    uint32_t pivot = take_least(q);
    form_element(q, pivot);
    measure_outside(q, pivot);
    update_members(q, pivot);
    join_alike(q, pivot);
    finish_element(q, pivot);
    for (uint32_t v = pivot; v != MESO_NO_INDEX; v = q->nexts[v])
        order[done++] = v;
    return done;
}

/* ---- begin ---- */

static MesoStatus allocate(Quotient *q, MesoArena *scratch, size_t neighbour_count, MesoError *error)
{
    size_t count = q->count;
    uint32_t **arrays[] = {&q->lengths, &q->element_counts, &q->sizes, &q->degrees, &q->nexts,
                           &q->lasts, &q->heads, &q->after, &q->before, &q->seen,
                           &q->outside, &q->bucket_heads, &q->bucket_after, &q->hashes};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        *arrays[k] = MESO_NEW(scratch, uint32_t, count, error);
        if (!*arrays[k])
            return MESO_ERR_MEMORY;
    }
    q->room = 2 * neighbour_count + 1;
    q->pool = MESO_NEW_BARE(scratch, uint32_t, q->room, error);
    q->spare = q->pool ? MESO_NEW_BARE(scratch, uint32_t, q->room, error) : NULL;
    q->begins = q->spare ? MESO_NEW_BARE(scratch, size_t, count, error) : NULL;
    q->kinds = q->begins ? MESO_NEW_BARE(scratch, uint8_t, count, error) : NULL;
    return q->kinds ? MESO_OK : MESO_ERR_MEMORY;
}

static void begin_variables(Quotient *q, const size_t *begins, const uint32_t *neighbours)
{
    q->used = begins[q->count];
    q->left = q->count;
    q->least = q->count - 1;
    memcpy(q->pool, neighbours, q->used * sizeof *neighbours);
    memset(q->heads, 0xff, q->count * sizeof *q->heads);
    memset(q->bucket_heads, 0xff, q->count * sizeof *q->bucket_heads);
    memset(q->nexts, 0xff, q->count * sizeof *q->nexts);
    /* the last comes first in its list: backwards, so that equal ones are taken as they stand */
    for (uint32_t v = q->count; v-- > 0;) {
        q->begins[v] = begins[v];
        q->lengths[v] = q->degrees[v] = (uint32_t)(begins[v + 1] - begins[v]);
        q->sizes[v] = 1;
        q->lasts[v] = v;
        q->kinds[v] = VARIABLE;
        list_variable(q, v);
    }
}

MesoStatus meso_minimum_degree(uint32_t *order, MesoArena *scratch, uint32_t count, const size_t *begins,
                               const uint32_t *neighbours, MesoError *error)
{
    if (count == 0)
        return MESO_OK;
    Quotient q = {.count = count};
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoStatus status = allocate(&q, scratch, begins[count], error);
    if (!status) {
        begin_variables(&q, begins, neighbours);
        for (uint32_t done = 0; done < count;)
            done = eliminate_least(&q, order, done);
    }
    meso_arena_rewind(scratch, mark);
    return status;
}
