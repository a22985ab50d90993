#include "libcore/tiling/strand/column_sample.h"

#include <math.h>
#include <string.h>

#include "libcore/scene/inner_column.h"

/* Pairs of columns: the outermost, and all around where the shape changes. */
enum { OUTER_PAIRS = 5, FEW_PAIRS = 8, MORE_PAIRS = MESO_MOST_PAIRS - OUTER_PAIRS };

/* Of a shape's size: less is none. */
static const float SMALL_CHANGE = 0.02f;

/* How far a column reaches in one of four directions, or how far it is to the next one. */
static float worth(const MesoSweepColumn *column, const MesoSweepColumn *next, uint32_t what)
{
    if (what == 4)
        return fmaxf(meso_vec2_length(meso_vec2_sub(next->start, column->start)),
                     meso_vec2_length(meso_vec2_sub(next->end, column->end)));
    float sign = what & 1 ? -1 : 1;
    return sign * (what & 2 ? column->start.y + column->end.y : column->start.x + column->end.x);
}

static bool changes(const MesoSweptKind *kind, const MesoSweepColumn *columns)
{
    float change = 0, size = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        change = fmaxf(change, meso_vec2_length(meso_vec2_sub(columns[c].end, columns[c].start)));
        size = fmaxf(size, meso_vec2_length(columns[c].start));
    }
    return kind->turn != 0 || change > SMALL_CHANGE * size;
}

/* Of the two columns at a corner, one does not join the other; at the seam it takes their normals to tell. */
static bool is_sharp(const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t c)
{
    const MesoSweepColumn *first = columns, *last = columns + kind->column_count - 1;
    if (c > 0 && c + 1 < kind->column_count)
        return !columns[c].joins_next || !columns[c - 1].joins_next;
    float cross = meso_vec2_cross(first->start_normal, last->start_normal);
    float dot = first->start_normal.x * last->start_normal.x + first->start_normal.y * last->start_normal.y;
    return !(fabsf(cross) < SMALL_CHANGE * dot);
}

static uint32_t add_column(MesoColumnSample *sample, const MesoSweptKind *kind, const MesoSweepColumn *columns,
                           uint32_t c)
{
    for (uint32_t i = 0; i < sample->kind.column_count; i++)
        if (sample->numbers[i] == c)
            return i;
    uint32_t to = sample->kind.column_count++;
    sample->numbers[to] = c;
    sample->columns[to] = columns[c];
    sample->columns[to].absent = 0;
    sample->sharp[to] = is_sharp(kind, columns, c);
    return to;
}

static void add_pair(MesoColumnSample *sample, const MesoSweptKind *kind, const MesoSweepColumn *columns,
                     uint32_t first, uint32_t second)
{
    for (uint32_t p = 0; p < sample->pair_count; p++)
        if (sample->numbers[sample->pairs[p].columns[0]] == first)
            return;     /* it is there */
    uint32_t joint = 0;
    for (uint32_t c = 0; c < first; c++)
        joint += meso_next_inner_column(kind, columns, c) != MESO_NO_INDEX;
    MesoColumnPair pair = {.joint = joint};
    pair.columns[0] = add_column(sample, kind, columns, first);
    pair.columns[1] = add_column(sample, kind, columns, second);
    sample->pairs[sample->pair_count++] = pair;
}

static void add_outermost(MesoColumnSample *sample, const MesoSweptKind *kind, const MesoSweepColumn *columns,
                          uint32_t what)
{
    uint32_t best = MESO_NO_INDEX, best_next = MESO_NO_INDEX;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        uint32_t next = meso_next_inner_column(kind, columns, c);
        if (next != MESO_NO_INDEX && (best == MESO_NO_INDEX || worth(&columns[c], &columns[next], what) >
                                                                   worth(&columns[best], &columns[best_next], what))) {
            best = c;
            best_next = next;
        }
    }
    if (best != MESO_NO_INDEX)
        add_pair(sample, kind, columns, best, best_next);
}

MesoColumnSample meso_column_sample(const MesoScene *scene, const MesoSweptKind *kind)
{
    MesoColumnSample sample = {.kind = *kind};
    sample.scene = (MesoScene){.section_scale = scene->section_scale, .frame_rule = scene->frame_rule,
                               .deform = scene->deform, .cages = scene->cages};
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    sample.kind.column_begin = sample.kind.column_count = 0;
    memset(sample.kind.absent, 0, sizeof sample.kind.absent);
    for (uint32_t what = 0; what < OUTER_PAIRS; what++)
        add_outermost(&sample, kind, columns, what);
    bool more = scene->deform == MESO_SWEEP_SHAPE || changes(kind, columns);
    uint32_t most = more ? MORE_PAIRS : FEW_PAIRS, stride = (kind->joint_count + most - 1) / most, passed = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        uint32_t next = meso_next_inner_column(kind, columns, c);
        if (next != MESO_NO_INDEX && passed++ % stride == 0)
            add_pair(&sample, kind, columns, c, next);
    }
    for (uint32_t c = 0; c < kind->column_count; c++)
        sample.radius = fmaxf(sample.radius, meso_vec2_length(columns[c].start));
    return sample;
}
