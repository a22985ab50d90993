#include "formats/scene/strand/sweep_strands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/scene/cell.h"

/* Chords of a trajectory; its length is short by a few parts in ten thousand where it bends most. */
enum { CHORDS = 32 };

/* One end of a sweep: 2 * sweep, + 1 for the end at v = 1. */
typedef struct End {
    MesoVec3 at;
    uint32_t material;
    float radius;
    uint32_t number;
} End;

typedef struct Finder {
    const MesoScene *scene;
    MesoStrands *strands;
    uint32_t *mate;         /* [2 * sweeps] the end that each goes on into, or MESO_NO_INDEX */
    bool *is_cap;           /* [sweeps] */
} Finder;

float meso_strand_radius(const MesoScene *scene, const MesoSweptKind *kind, bool at_end)
{
    double sum = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        const MesoSweepColumn *column = &scene->columns[kind->column_begin + c];
        MesoVec2 p = at_end ? column->end : column->start;
        sum += sqrt((double)p.x * p.x + (double)p.y * p.y);
    }
    return kind->column_count ? scene->section_scale * (float)(sum / kind->column_count) : 0;
}

/* ---- pairs of ends ---- */

static int compare_floats(float a, float b)
{
    return (a > b) - (a < b);
}

static int compare_places(const End *a, const End *b)
{
    int order = compare_floats(a->at.x, b->at.x);
    if (!order)
        order = compare_floats(a->at.y, b->at.y);
    if (!order)
        order = compare_floats(a->at.z, b->at.z);
    return order ? order : (a->material > b->material) - (a->material < b->material);
}

static int compare_ends(const void *x, const void *y)
{
    const End *a = x, *b = y;
    int order = compare_places(a, b);
    if (!order)
        order = compare_floats(a->radius, b->radius);
    return order ? order : (a->number > b->number) - (a->number < b->number);
}

static uint32_t list_ends(const Finder *f, End *ends)
{
    const MesoScene *scene = f->scene;
    uint32_t count = 0;
    for (uint32_t k = 0; k < scene->kind_count; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        const float radius[2] = {meso_strand_radius(scene, kind, false), meso_strand_radius(scene, kind, true)};
        const uint32_t material[2] = {kind->start_material, kind->end_material};
        for (uint32_t i = 0; i < kind->instance_count; i++) {
            uint32_t sweep = kind->instance_begin + i;
            f->is_cap[sweep] = kind->cap;
            MesoVec3 p[4];
            meso_sweep_trajectory(scene, &scene->sweeps[sweep], p);
            for (uint32_t e = 0; e < (kind->cap ? 1u : 2u); e++)
                ends[count++] = (End){p[e ? 3 : 0], material[e],
                                      radius[e] * scene->sweeps[sweep].size[e], 2 * sweep + e};
        }
    }
    return count;
}

static void join(Finder *f, const End *a, const End *b)
{
    f->mate[a->number] = b->number;
    f->mate[b->number] = a->number;
}

/* Whether two ends may go on into each other; in one slot, only a cap and what it closes. */
static bool may_join(const Finder *f, const End *a, const End *b, bool same_slot)
{
    uint32_t x = a->number / 2, y = b->number / 2;
    if (f->mate[a->number] != MESO_NO_INDEX || f->mate[b->number] != MESO_NO_INDEX)
        return false;
    if (!same_slot)
        return f->scene->sweeps[x].ids != f->scene->sweeps[y].ids;
    return f->is_cap[x] != f->is_cap[y];
}

/*
 * Ends at one place, narrow ones first. Where a section is used twice in a tile, each of the two goes on into
 * another slot if it can; alone with each other, they are the two ends of a loop within one.
 */
static void pair_group(Finder *f, const End *ends, uint32_t count)
{
    if (count == 2)
        join(f, &ends[0], &ends[1]);
    for (int same_slot = 0; same_slot < 2; same_slot++)
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t k = i + 1; k < count; k++)
                if (may_join(f, &ends[i], &ends[k], same_slot))
                    join(f, &ends[i], &ends[k]);
}

static MesoStatus pair_ends(Finder *f, MesoArena *arena, MesoError *error)
{
    size_t room = 2 * (size_t)f->scene->sweep_count;
    MesoArenaMark mark = meso_arena_mark(arena);
    End *ends = MESO_NEW(arena, End, room, error);
    if (!ends)
        return MESO_ERR_MEMORY;
    memset(f->mate, 0xff, room * sizeof *f->mate);
    uint32_t count = list_ends(f, ends);
    qsort(ends, count, sizeof *ends, compare_ends);
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && compare_places(&ends[begin], &ends[end]) == 0;)
            end++;
        pair_group(f, ends + begin, end - begin);
    }
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* ---- along strands ---- */

/* The end through which a strand that came in through `end` leaves the sweep; MESO_NO_INDEX from a cap. */
static uint32_t across(const Finder *f, uint32_t end)
{
    return f->is_cap[end / 2] ? MESO_NO_INDEX : end ^ 1;
}

/* The end through which the strand of `sweep` begins; its own start where it goes round. */
static uint32_t first_end(const Finder *f, uint32_t sweep, bool *closed)
{
    uint32_t end = 2 * sweep;
    *closed = false;
    if (f->is_cap[sweep])
        return end ^ 1;     /* from the tip */
    while (f->mate[end] != MESO_NO_INDEX) {
        uint32_t next = across(f, f->mate[end]);
        if (next == MESO_NO_INDEX)
            return f->mate[end] ^ 1;
        if (next == 2 * sweep) {
            *closed = true;
            return next;
        }
        end = next;
    }
    return end;
}

static float length_of(const Finder *f, uint32_t sweep)
{
    const MesoSweepInstance *instance = &f->scene->sweeps[sweep];
    MesoVec3 before = meso_sweep_middle(f->scene, instance, 0);
    double length = 0;
    for (uint32_t i = 1; i <= CHORDS && !f->is_cap[sweep]; i++) {
        MesoVec3 at = meso_sweep_middle(f->scene, instance, (float)i / CHORDS);
        length += (double)meso_vec3_length(meso_vec3_sub(at, before));
        before = at;
    }
    return (float)length;
}

static void follow(const Finder *f, uint32_t first, uint32_t *used)
{
    MesoStrands *s = f->strands;
    for (uint32_t end = first;;) {
        uint32_t sweep = end / 2, out = end ^ 1;
        s->of_sweep[sweep] = s->count;
        s->length[s->count] += length_of(f, sweep);
        s->pieces[(*used)++] = (MesoStrandPiece){sweep, (end & 1) != 0};
        if ((f->is_cap[sweep] && out % 2 == 1) || f->mate[out] == MESO_NO_INDEX)
            break;
        end = f->mate[out];
        if (end == first)
            break;
    }
}

static void follow_all(const Finder *f)
{
    MesoStrands *s = f->strands;
    uint32_t used = 0;
    for (uint32_t sweep = 0; sweep < f->scene->sweep_count; sweep++) {
        if (s->of_sweep[sweep] != MESO_NO_INDEX)
            continue;
        s->begin[s->count] = used;
        follow(f, first_end(f, sweep, &s->closed[s->count]), &used);
        s->count++;
    }
    s->begin[s->count] = used;
}

MesoStatus meso_strands_find(MesoStrands *strands, MesoArena *arena, const MesoScene *scene, MesoError *error)
{
    size_t n = scene->sweep_count;
    *strands = (MesoStrands){
        .begin = MESO_NEW(arena, uint32_t, n + 1, error),
        .pieces = MESO_NEW(arena, MesoStrandPiece, n, error),
        .of_sweep = MESO_NEW(arena, uint32_t, n, error),
        .closed = MESO_NEW(arena, bool, n, error),
        .length = MESO_NEW(arena, float, n, error),
    };
    if (!strands->begin || !strands->pieces || !strands->of_sweep || !strands->closed || !strands->length)
        return MESO_ERR_MEMORY;
    memset(strands->of_sweep, 0xff, n * sizeof *strands->of_sweep);
    MesoArenaMark mark = meso_arena_mark(arena);
    Finder f = {scene, strands, MESO_NEW(arena, uint32_t, 2 * n, error), MESO_NEW(arena, bool, n, error)};
    MesoStatus status = f.mate && f.is_cap ? pair_ends(&f, arena, error) : MESO_ERR_MEMORY;
    if (!status)
        follow_all(&f);
    meso_arena_rewind(arena, mark);
    return status;
}
