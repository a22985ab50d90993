#include "libcore/chart/simple_border.h"

#include <stdlib.h>

typedef struct Side {
    MesoVec2 a, b;
    uint32_t from, to;
    float low, high;        /* in x */
} Side;

static int compare_sides(const void *left, const void *right)
{
    const Side *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    return a->from < b->from ? -1 : a->from > b->from;
}

/* Sides that follow each other: whether the second runs back over the first. */
static bool fold_back(MesoVec2 before, MesoVec2 shared, MesoVec2 after)
{
    double ax = (double)before.x - shared.x, ay = (double)before.y - shared.y;
    double bx = (double)after.x - shared.x, by = (double)after.y - shared.y;
    return meso_turn(before, shared, after) == 0 && ax * bx + ay * by >= 0;
}

static bool on_both_sides(double a, double b)
{
    return (a <= 0 && b >= 0) || (a >= 0 && b <= 0);
}

static bool sides_meet(const Side *s, const Side *t)
{
    if (s->to == t->from && s->from == t->to)
        return true;
    if (s->to == t->from)
        return fold_back(s->a, s->b, t->b);
    if (t->to == s->from)
        return fold_back(t->a, t->b, s->b);
    if (fmaxf(s->a.y, s->b.y) < fminf(t->a.y, t->b.y) || fmaxf(t->a.y, t->b.y) < fminf(s->a.y, s->b.y))
        return false;
    return on_both_sides(meso_turn(s->a, s->b, t->a), meso_turn(s->a, s->b, t->b)) &&
           on_both_sides(meso_turn(t->a, t->b, s->a), meso_turn(t->a, t->b, s->b));
}

MesoStatus meso_border_is_simple(bool *simple, MesoArena *scratch, const MesoVec2 *places, const uint32_t *border,
                                 uint32_t count, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    Side *sides = MESO_NEW(scratch, Side, count, error);
    if (!sides)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        MesoVec2 a = places[border[2 * i]], b = places[border[2 * i + 1]];
        sides[i] = (Side){a, b, border[2 * i], border[2 * i + 1], fminf(a.x, b.x), fmaxf(a.x, b.x)};
    }
    qsort(sides, count, sizeof *sides, compare_sides);
    *simple = true;
    for (uint32_t i = 0; i < count && *simple; i++)
        for (uint32_t j = i + 1; j < count && sides[j].low <= sides[i].high && *simple; j++)
            *simple = !sides_meet(&sides[i], &sides[j]);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
