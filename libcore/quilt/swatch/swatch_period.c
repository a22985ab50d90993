#include "libcore/quilt/swatch/swatch_period.h"

#include <stdlib.h>

/* Ends and elements are the same within this part of the mean edge. */
#define ALIKE 0.01

/* Elements at one height and place across a direction that are all different, beyond which it has no period. */
enum { MOST_SORTS = 64 };

/* ---- open ends ---- */

typedef struct Point {
    double at[3];
} Point;

static Point loop_centre(const MesoSwatch *swatch, uint32_t loop)
{
    Point sum = {{0, 0, 0}};
    uint32_t begin = swatch->loop_begin[loop], end = swatch->loop_begin[loop + 1];
    for (uint32_t i = begin; i < end; i++)
        for (int k = 0; k < 3; k++)
            sum.at[k] += meso_along(swatch->positions[swatch->loop_vertices[i]], k);
    for (int k = 0; k < 3; k++)
        sum.at[k] /= end - begin;
    return sum;
}

/* The axis along which a cap over the loop would look, and whether it looks up it. */
static int facing(const MesoSwatch *swatch, uint32_t loop, bool *up)
{
    Point area = {{0, 0, 0}}, o = loop_centre(swatch, loop);
    uint32_t begin = swatch->loop_begin[loop], end = swatch->loop_begin[loop + 1];
    for (uint32_t i = begin; i < end; i++) {
        MesoVec3 a = swatch->positions[swatch->loop_vertices[i + 1 < end ? i + 1 : begin]];
        MesoVec3 b = swatch->positions[swatch->loop_vertices[i]];   /* a cap runs against the border */
        for (int k = 0; k < 3; k++) {
            int l = (k + 1) % 3, m = (k + 2) % 3;
            area.at[k] += (meso_along(a, l) - o.at[l]) * (meso_along(b, m) - o.at[m]) -
                          (meso_along(a, m) - o.at[m]) * (meso_along(b, l) - o.at[l]);
        }
    }
    int best = 0;
    for (int k = 1; k < 3; k++)
        best = fabs(area.at[k]) > fabs(area.at[best]) ? k : best;
    *up = area.at[best] > 0;
    return best;
}

static double mean_along(const MesoSwatch *swatch, const uint32_t *loops, uint32_t count, int along)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += loop_centre(swatch, loops[i]).at[along];
    return count ? sum / count : 0;
}

MesoStatus meso_swatch_find_ends(MesoSwatchAxis axes[2], MesoArena *scratch, const MesoSwatch *swatch, MesoError *error)
{
    for (int k = 0; k < 2; k++) {
        axes[k] = (MesoSwatchAxis){.along = k};
        axes[k].low = MESO_NEW(scratch, uint32_t, swatch->loop_count, error);
        axes[k].high = MESO_NEW(scratch, uint32_t, swatch->loop_count, error);
        if (!axes[k].low || !axes[k].high)
            return MESO_ERR_MEMORY;
    }
    for (uint32_t l = 0; l < swatch->loop_count; l++) {
        bool up;
        int along = facing(swatch, l, &up);
        if (along == 2)
            continue;
        if (up)
            axes[along].high[axes[along].high_count++] = l;
        else
            axes[along].low[axes[along].low_count++] = l;
    }
    for (int k = 0; k < 2; k++) {
        axes[k].low_end = mean_along(swatch, axes[k].low, axes[k].low_count, k);
        axes[k].high_end = mean_along(swatch, axes[k].high, axes[k].high_count, k);
    }
    return MESO_OK;
}

/* An open end, sorted by its place across the direction. */
typedef struct End {
    Point centre;
    double across;
    uint32_t loop;
    bool taken;
} End;

static int compare_ends(const void *a, const void *b)
{
    const End *p = a, *q = b;
    if (p->across != q->across)
        return p->across < q->across ? -1 : 1;
    return (p->loop > q->loop) - (p->loop < q->loop);
}

/* Whether a vertex comes to another when it is moved by `period` along the direction. */
static bool meets(const MesoSwatch *swatch, const MesoSwatchAxis *axis, uint32_t low, uint32_t high, double tolerance)
{
    for (int k = 0; k < 3; k++) {
        double moved = meso_along(swatch->positions[low], k) + (k == axis->along ? axis->period : 0);
        if (fabs(meso_along(swatch->positions[high], k) - moved) > tolerance)
            return false;
    }
    return true;
}

/* Makes the vertices of two loops mates, which run against each other; false where one does not meet its own. */
static bool join_loops(MesoSwatch *swatch, const MesoSwatchAxis *axis, uint32_t low, uint32_t high, double tolerance)
{
    const uint32_t *a = swatch->loop_vertices + swatch->loop_begin[low];
    const uint32_t *b = swatch->loop_vertices + swatch->loop_begin[high];
    uint32_t count = swatch->loop_begin[low + 1] - swatch->loop_begin[low], first = 0;
    if (swatch->loop_begin[high + 1] - swatch->loop_begin[high] != count)
        return false;
    while (first < count && !meets(swatch, axis, a[0], b[first], tolerance))
        first++;
    for (uint32_t i = 0; i < count && first < count; i++)
        if (!meets(swatch, axis, a[i], b[(first + count - i) % count], tolerance))
            return false;
    for (uint32_t i = 0; i < count && first < count; i++)
        swatch->mates[b[(first + count - i) % count]] = a[i];
    return first < count;
}

/* The end that `low` goes on as; ends are sorted. */
static bool join_end(MesoSwatch *swatch, const MesoSwatchAxis *axis, uint32_t low, End *ends, double tolerance)
{
    Point c = loop_centre(swatch, low);
    double across = c.at[1 - axis->along];
    uint32_t begin = 0, end = axis->high_count;
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if (ends[middle].across < across - tolerance)
            begin = middle + 1;
        else
            end = middle;
    }
    for (uint32_t i = begin; i < axis->high_count && ends[i].across <= across + tolerance; i++)
        if (!ends[i].taken && fabs(ends[i].centre.at[2] - c.at[2]) <= tolerance &&
            join_loops(swatch, axis, low, ends[i].loop, tolerance))
            return ends[i].taken = true;
    return false;
}

static void forget_mates(MesoSwatch *swatch, uint32_t loop)
{
    for (uint32_t i = swatch->loop_begin[loop]; i < swatch->loop_begin[loop + 1]; i++)
        swatch->mates[swatch->loop_vertices[i]] = MESO_NO_INDEX;
}

static MesoStatus join_ends(MesoSwatch *swatch, MesoSwatchAxis *axis, MesoArena *scratch, MesoError *error)
{
    double tolerance = ALIKE * (double)swatch->mean_edge;
    if (axis->low_count != axis->high_count)
        return MESO_OK;
    End *ends = MESO_NEW(scratch, End, axis->high_count, error);
    if (!ends)
        return MESO_ERR_MEMORY;
    if (axis->period <= 0)
        axis->period = axis->high_end - axis->low_end;
    if (axis->period <= tolerance)
        return MESO_OK;
    for (uint32_t i = 0; i < axis->high_count; i++) {
        Point c = loop_centre(swatch, axis->high[i]);
        ends[i] = (End){c, c.at[1 - axis->along], axis->high[i], false};
    }
    qsort(ends, axis->high_count, sizeof *ends, compare_ends);
    axis->periodic = true;
    for (uint32_t i = 0; i < axis->low_count && axis->periodic; i++)
        axis->periodic = join_end(swatch, axis, axis->low[i], ends, tolerance);
    for (uint32_t i = 0; i < axis->high_count && !axis->periodic; i++)
        forget_mates(swatch, axis->high[i]);
    return MESO_OK;
}

/* ---- rows of equal elements ---- */

/* An element, by what rows are sorted by. */
typedef struct Member {
    uint32_t vertices, triangles, element;
    double across, height, along;
    bool taken;
} Member;

static int compare(double a, double b, const Member *p, const Member *q)
{
    if (a != b)
        return a < b ? -1 : 1;
    return (p->element > q->element) - (p->element < q->element);
}

static int compare_across(const void *a, const void *b)
{
    const Member *p = a, *q = b;
    if (p->vertices != q->vertices)
        return p->vertices < q->vertices ? -1 : 1;
    if (p->triangles != q->triangles)
        return p->triangles < q->triangles ? -1 : 1;
    return compare(p->across, q->across, p, q);
}

static int compare_height(const void *a, const void *b)
{
    return compare(((const Member *)a)->height, ((const Member *)b)->height, a, b);
}

static int compare_along(const void *a, const void *b)
{
    return compare(((const Member *)a)->along, ((const Member *)b)->along, a, b);
}

/* Whether two elements of as many vertices and triangles are the same but for where they stand. */
static bool are_equal(const MesoSwatch *swatch, uint32_t a, uint32_t b, double tolerance)
{
    uint32_t v = swatch->vertex_begin[a], w = swatch->vertex_begin[b], count = swatch->vertex_begin[a + 1] - v;
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 p = meso_vec3_sub(swatch->positions[v + i], swatch->centres[a]);
        MesoVec3 q = meso_vec3_sub(swatch->positions[w + i], swatch->centres[b]);
        for (int k = 0; k < 3; k++)
            if (fabs(meso_along(p, k) - meso_along(q, k)) > tolerance)
                return false;
    }
    return true;
}

typedef struct Rows {
    const MesoSwatch *swatch;
    double tolerance, period;   /* 0: not known yet */
    bool failed;
} Rows;

/* The equals of members[0] among `count`, sorted along: they stand equally spaced, over the same length as others. */
static void follow_row(Rows *rows, Member *members, uint32_t count)
{
    uint32_t found = 1;
    double first = members[0].along, last = first, step = 0;
    for (uint32_t i = 1; i < count; i++) {
        if (members[i].taken ||
            !are_equal(rows->swatch, members[0].element, members[i].element, rows->tolerance))
            continue;
        members[i].taken = true;
        double by = members[i].along - last;
        if (found > 1 && fabs(by - step) > 2 * rows->tolerance)
            rows->failed = true;
        step = (members[i].along - first) / found++;
        last = members[i].along;
    }
    double period = step * found;
    if (period <= rows->tolerance || (rows->period > 0 && fabs(period - rows->period) > found * rows->tolerance))
        rows->failed = true;
    rows->period = rows->period > 0 ? rows->period : period;
}

static void follow_rows(Rows *rows, Member *members, uint32_t count)
{
    uint32_t sorts = 0;
    qsort(members, count, sizeof *members, compare_along);
    for (uint32_t i = 0; i < count && !rows->failed; i++) {
        if (members[i].taken)
            continue;
        follow_row(rows, members + i, count - i);
        if (++sorts > MOST_SORTS)
            rows->failed = true;
    }
}

/* Of members with the same place across: those at one height each. */
static void split_by_height(Rows *rows, Member *members, uint32_t count)
{
    qsort(members, count, sizeof *members, compare_height);
    for (uint32_t begin = 0, i = 1; i <= count && !rows->failed; i++)
        if (i == count || members[i].height - members[i - 1].height > rows->tolerance) {
            follow_rows(rows, members + begin, i - begin);
            begin = i;
        }
}

static bool is_next_across(const Member *a, const Member *b, double tolerance)
{
    return b->vertices != a->vertices || b->triangles != a->triangles || b->across - a->across > tolerance;
}

static MesoStatus find_rows(const MesoSwatch *swatch, MesoSwatchAxis *axis, MesoArena *scratch, MesoError *error)
{
    Rows rows = {.swatch = swatch, .tolerance = ALIKE * (double)swatch->mean_edge};
    uint32_t count = swatch->element_count;
    Member *members = MESO_NEW(scratch, Member, count, error);
    if (!members)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < count; e++)
        members[e] = (Member){swatch->vertex_begin[e + 1] - swatch->vertex_begin[e],
                              swatch->triangle_begin[e + 1] - swatch->triangle_begin[e], e,
                              meso_along(swatch->centres[e], 1 - axis->along), meso_along(swatch->centres[e], 2),
                              meso_along(swatch->centres[e], axis->along), false};
    qsort(members, count, sizeof *members, compare_across);
    for (uint32_t begin = 0, i = 1; i <= count && !rows.failed; i++)
        if (i == count || is_next_across(&members[i - 1], &members[i], rows.tolerance)) {
            split_by_height(&rows, members + begin, i - begin);
            begin = i;
        }
    axis->periodic = !rows.failed;
    axis->period = rows.failed ? 0 : rows.period;
    return MESO_OK;
}

MesoStatus meso_swatch_find_period(MesoSwatch *swatch, MesoSwatchAxis *axis, MesoArena *scratch, MesoError *error)
{
    if (axis->low_count || axis->high_count)
        return join_ends(swatch, axis, scratch, error);
    if (axis->period > 0) {
        axis->periodic = true;
        return MESO_OK;
    }
    return find_rows(swatch, axis, scratch, error);
}
