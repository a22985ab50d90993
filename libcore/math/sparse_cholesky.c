#include "libcore/math/sparse_cholesky.h"

#include <assert.h>
#include <float.h>
#include <stdbool.h>
#include <string.h>

#include "libcore/base/index.h"
#include "libcore/math/minimum_degree.h"

/* ---- the pattern of A ---- */

/* Neighbours by unknown, both ways, each once. */
typedef struct Pattern {
    uint32_t count;
    size_t *begins;         /* [count + 1] */
    uint32_t *neighbours;
} Pattern;

static MesoStatus check_triplets(uint32_t count, const MesoTriplet *triplets, size_t triplet_count, MesoError *error)
{
    if (triplet_count >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "a matrix of %zu entries is beyond what can be counted", triplet_count);
    for (size_t t = 0; t < triplet_count; t++)
        if (triplets[t].row >= count || triplets[t].column > triplets[t].row)
            return meso_fail(error, MESO_ERR_INTERNAL, "entry %zu of a matrix lies at row %u, column %u of %u", t,
                             triplets[t].row, triplets[t].column, count);
    return MESO_OK;
}

/* Entries of one place come several times still. */
static void list_neighbours(Pattern *pattern, const MesoTriplet *triplets, size_t triplet_count)
{
    size_t *begins = pattern->begins;
    for (size_t t = 0; t < triplet_count; t++)
        if (triplets[t].row != triplets[t].column) {
            begins[triplets[t].row]++;
            begins[triplets[t].column]++;
        }
    for (uint32_t v = 0; v < pattern->count; v++)
        begins[v + 1] += begins[v];
    for (size_t t = triplet_count; t-- > 0;) {
        uint32_t a = triplets[t].row, b = triplets[t].column;
        if (a == b)
            continue;
        pattern->neighbours[--begins[a]] = b;
        pattern->neighbours[--begins[b]] = a;
    }
}

static void drop_repeated(Pattern *pattern, uint32_t *marks)
{
    size_t used = 0, begin = 0;
    memset(marks, 0xff, pattern->count * sizeof *marks);
    for (uint32_t v = 0; v < pattern->count; v++) {
        size_t end = pattern->begins[v + 1];
        pattern->begins[v] = used;
        for (size_t k = begin; k < end; k++) {
            uint32_t w = pattern->neighbours[k];
            if (marks[w] != v) {
                marks[w] = v;
                pattern->neighbours[used++] = w;
            }
        }
        begin = end;
    }
    pattern->begins[pattern->count] = used;
}

static MesoStatus read_pattern(Pattern *pattern, MesoArena *arena, uint32_t *marks, const MesoTriplet *triplets,
                               size_t triplet_count, MesoError *error)
{
    pattern->begins = MESO_NEW(arena, size_t, (size_t)pattern->count + 1, error);
    pattern->neighbours = pattern->begins ? MESO_NEW_BARE(arena, uint32_t, 2 * triplet_count, error) : NULL;
    if (!pattern->neighbours)
        return MESO_ERR_MEMORY;
    list_neighbours(pattern, triplets, triplet_count);
    drop_repeated(pattern, marks);
    return MESO_OK;
}

/* ---- the tree of elimination ---- */

static void note_places(MesoCholesky *factor)
{
    for (uint32_t k = 0; k < factor->count; k++)
        factor->places[factor->order[k]] = k;
}

/* The column that a column changes first (Liu 1990), by place; `roots` shortens the ways up. */
static void find_parents(const MesoCholesky *factor, const Pattern *pattern, uint32_t *parents, uint32_t *roots)
{
    for (uint32_t k = 0; k < factor->count; k++) {
        uint32_t v = factor->order[k];
        parents[k] = roots[k] = MESO_NO_INDEX;
        for (size_t n = pattern->begins[v]; n < pattern->begins[v + 1]; n++) {
            uint32_t i = factor->places[pattern->neighbours[n]];
            while (i < k) {
                uint32_t next = roots[i];
                roots[i] = k;
                if (next == MESO_NO_INDEX)
                    parents[i] = k;
                i = next;
            }
        }
    }
}

/* Children before parents, and each subtree in one piece: what is used together lies together. The factor is the same. */
static void sort_by_tree(MesoCholesky *factor, const uint32_t *parents, uint32_t *firsts, uint32_t *nexts,
                         uint32_t *sorted)
{
    uint32_t count = factor->count, done = 0;
    memset(firsts, 0xff, count * sizeof *firsts);
    for (uint32_t k = count; k-- > 0;)
        if (parents[k] != MESO_NO_INDEX) {
            nexts[k] = firsts[parents[k]];
            firsts[parents[k]] = k;
        }
    for (uint32_t root = 0; root < count; root++) {
        if (parents[root] != MESO_NO_INDEX)
            continue;
        for (uint32_t k = root;;) {
            while (firsts[k] != MESO_NO_INDEX) {    /* down, and the way back is cut: each child is met once */
                uint32_t child = firsts[k];
                firsts[k] = nexts[child];
                k = child;
            }
            sorted[done++] = factor->order[k];
            if (k == root)
                break;
            k = parents[k];
        }
    }
    assert(done == count);
    memcpy(factor->order, sorted, count * sizeof *sorted);
    note_places(factor);
}

/* ---- the pattern of L ---- */

/* Calls for each column of row `k` of L: those below the row's entries of A in the tree. Unordered. */
static uint32_t reach_columns(const MesoCholesky *factor, const Pattern *pattern, const uint32_t *parents, uint32_t k,
                              uint32_t *columns)
{
    uint32_t v = factor->order[k], reached = 0;
    factor->marks[k] = k;
    for (size_t n = pattern->begins[v]; n < pattern->begins[v + 1]; n++)
        for (uint32_t i = factor->places[pattern->neighbours[n]]; i < k && factor->marks[i] != k; i = parents[i]) {
            factor->marks[i] = k;
            columns[reached++] = i;
        }
    return reached;
}

/* Writes as well which columns make a bunch. */
static void count_columns(MesoCholesky *factor, const Pattern *pattern, const uint32_t *parents, uint32_t *columns)
{
    size_t total = 0, *counts = factor->column_begins;
    memset(factor->marks, 0xff, factor->count * sizeof *factor->marks);
    for (uint32_t k = 0; k < factor->count; k++) {
        uint32_t reached = reach_columns(factor, pattern, parents, k, columns);
        for (uint32_t c = 0; c < reached; c++)
            counts[columns[c]]++;
    }
    for (uint32_t k = factor->count; k-- > 0;) {
        bool goes_on = parents[k] == k + 1 && counts[k] == counts[k + 1] + 1;
        factor->bunch_ends[k] = goes_on ? factor->bunch_ends[k + 1] : k + 1;
    }
    for (uint32_t k = 0; k <= factor->count; k++) {
        size_t here = k < factor->count ? counts[k] : 0;
        factor->column_begins[k] = total;
        total += here;
    }
}

/* The size of all lists together: of each bunch, that of its first column. */
static size_t place_lists(MesoCholesky *factor)
{
    size_t total = 0;
    for (uint32_t k = 0; k < factor->count;) {
        uint32_t first = k;
        for (; k < factor->bunch_ends[first]; k++)
            factor->column_lists[k] = total + (k - first);
        total += factor->column_begins[first + 1] - factor->column_begins[first];
    }
    return total;
}

static bool is_first(const MesoCholesky *factor, uint32_t k)
{
    return k == 0 || factor->bunch_ends[k - 1] == k;
}

/* Bunches in the order of their rows, then rows in that of their bunches: each sorts the other. */
static void list_entries(MesoCholesky *factor, const Pattern *pattern, const uint32_t *parents, uint32_t *columns)
{
    uint32_t count = factor->count;
    memcpy(factor->column_ends, factor->column_lists, count * sizeof *factor->column_ends);
    memset(factor->marks, 0xff, count * sizeof *factor->marks);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t reached = reach_columns(factor, pattern, parents, k, columns);
        factor->row_begins[k + 1] = factor->row_begins[k];
        for (uint32_t c = 0; c < reached; c++)
            if (is_first(factor, columns[c])) {
                factor->column_rows[factor->column_ends[columns[c]]++] = factor->order[k];
                factor->row_begins[k + 1]++;
            }
    }
    memcpy(factor->column_ends, factor->row_begins, count * sizeof *factor->column_ends);
    for (uint32_t k = 0; k < count; k = factor->bunch_ends[k])
        for (size_t e = 0; e < factor->column_begins[k + 1] - factor->column_begins[k]; e++) {
            uint32_t row = factor->column_rows[factor->column_lists[k] + e];
            factor->row_bunches[factor->column_ends[factor->places[row]]++] = k;
        }
}

/* ---- analysis ---- */

static MesoStatus allocate(MesoCholesky *factor, MesoArena *arena, size_t triplet_count, MesoError *error)
{
    size_t count = factor->count;
    factor->triplet_room = triplet_count;
    if (!(factor->order = MESO_NEW(arena, uint32_t, count, error)) ||
        !(factor->places = MESO_NEW_BARE(arena, uint32_t, count, error)) ||
        !(factor->marks = MESO_NEW(arena, uint32_t, count, error)) ||
        !(factor->column_begins = MESO_NEW(arena, size_t, count + 1, error)) ||
        !(factor->column_ends = MESO_NEW_BARE(arena, size_t, count, error)) ||
        !(factor->column_lists = MESO_NEW_BARE(arena, size_t, count, error)) ||
        !(factor->bunch_ends = MESO_NEW_BARE(arena, uint32_t, count, error)) ||
        !(factor->row_begins = MESO_NEW(arena, size_t, count + 1, error)) ||
        !(factor->triplet_begins = MESO_NEW(arena, size_t, count + 1, error)) ||
        !(factor->triplet_list = MESO_NEW_BARE(arena, uint32_t, triplet_count, error)) ||
        !(factor->pivots = MESO_NEW_BARE(arena, double, count, error)) ||
        !(factor->work = MESO_NEW_BARE(arena, double, count, error)))
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

static MesoStatus allocate_entries(MesoCholesky *factor, MesoArena *arena, MesoError *error)
{
    size_t listed_count = place_lists(factor);
    if (!(factor->column_rows = MESO_NEW_BARE(arena, uint32_t, listed_count, error)) ||
        !(factor->row_bunches = MESO_NEW_BARE(arena, uint32_t, listed_count, error)) ||
        !(factor->values = MESO_NEW_BARE(arena, double, factor->column_begins[factor->count], error)))
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

/* What outlives the analysis goes to `arena`, what does not to `scratch`. */
static MesoStatus analyse(MesoCholesky *factor, MesoArena *arena, MesoArena *scratch, const MesoTriplet *triplets,
                          size_t triplet_count, MesoError *error)
{
    Pattern pattern = {.count = factor->count};
    MesoStatus status = read_pattern(&pattern, scratch, factor->marks, triplets, triplet_count, error);
    if (!status)
        status = meso_minimum_degree(factor->order, scratch, factor->count, pattern.begins, pattern.neighbours, error);
    uint32_t *parents = status ? NULL : MESO_NEW(scratch, uint32_t, factor->count, error);
    uint32_t *first = parents ? MESO_NEW(scratch, uint32_t, factor->count, error) : NULL;
    uint32_t *second = first ? MESO_NEW(scratch, uint32_t, factor->count, error) : NULL;
    if (!second)
        return status ? status : MESO_ERR_MEMORY;
    note_places(factor);
    find_parents(factor, &pattern, parents, first);
    sort_by_tree(factor, parents, first, second, factor->marks);
    find_parents(factor, &pattern, parents, first);
    count_columns(factor, &pattern, parents, first);
    status = allocate_entries(factor, arena, error);
    if (!status)
        list_entries(factor, &pattern, parents, first);
    return status;
}

MesoStatus meso_cholesky_analyse(MesoCholesky *factor, MesoArena *arena, uint32_t count, const MesoTriplet *triplets,
                                 size_t triplet_count, MesoError *error)
{
    *factor = (MesoCholesky){.count = count};
    MesoStatus status = check_triplets(count, triplets, triplet_count, error);
    if (!status)
        status = allocate(factor, arena, triplet_count, error);
    MesoArena scratch;
    meso_arena_init(&scratch);
    if (!status)
        status = analyse(factor, arena, &scratch, triplets, triplet_count, error);
    meso_arena_release(&scratch);
    return status;
}

/* ---- numbers ---- */

static uint32_t later_place(const MesoCholesky *factor, const MesoTriplet *triplet)
{
    uint32_t a = factor->places[triplet->row], b = factor->places[triplet->column];
    return a > b ? a : b;
}

/* Triplets by the row of L that they belong to, in their order within each: sums do not depend on anything else. */
static void sort_triplets(MesoCholesky *factor, const MesoTriplet *triplets, size_t triplet_count)
{
    size_t *begins = factor->triplet_begins;
    memset(begins, 0, ((size_t)factor->count + 1) * sizeof *begins);
    for (size_t t = 0; t < triplet_count; t++)
        begins[later_place(factor, &triplets[t])]++;
    for (uint32_t k = 0; k < factor->count; k++)
        begins[k + 1] += begins[k];
    for (size_t t = triplet_count; t-- > 0;)
        factor->triplet_list[--begins[later_place(factor, &triplets[t])]] = (uint32_t)t;
}

/* Adds the entries of row `k` of A to the work row, and its diagonal to `diagonal`; false where L has no such place. */
static bool add_row(MesoCholesky *factor, const MesoTriplet *triplets, uint32_t k, double *diagonal)
{
    for (size_t e = factor->row_begins[k]; e < factor->row_begins[k + 1]; e++)
        for (uint32_t c = factor->row_bunches[e]; c < factor->bunch_ends[factor->row_bunches[e]] && c < k; c++)
            factor->marks[factor->order[c]] = k;
    for (size_t t = factor->triplet_begins[k]; t < factor->triplet_begins[k + 1]; t++) {
        const MesoTriplet *triplet = &triplets[factor->triplet_list[t]];
        uint32_t other = triplet->row == factor->order[k] ? triplet->column : triplet->row;
        if (triplet->row == triplet->column)
            *diagonal += triplet->value;
        else if (factor->marks[other] != k)
            return false;
        else
            factor->work[other] += triplet->value;
    }
    return true;
}

/*
 * Columns of a bunch are taken together, up to eight: what they are subtracted from is read and written once for all of
 * them, and four rows are done at once. Each number comes by the same operations in the same order as one column at a
 * time.
 */
enum { TOGETHER = 8 };

typedef double Four __attribute__((vector_size(32)));

/* Subtracts columns times numbers from the work row, at `count` rows that all of them have. */
static inline __attribute__((always_inline)) void subtract(double *restrict work, const uint32_t *rows, size_t count,
                                                           const double *const *columns, const double *y,
                                                           const uint32_t width)
{
    size_t e = 0;
    for (; e + 4 <= count; e += 4) {
        Four sums = {work[rows[e]], work[rows[e + 1]], work[rows[e + 2]], work[rows[e + 3]]};
        for (uint32_t c = 0; c < width; c++) {
            Four values;
            memcpy(&values, columns[c] + e, sizeof values);
            sums -= values * y[c];
        }
        for (uint32_t k = 0; k < 4; k++)
            work[rows[e + k]] = sums[k];
    }
    for (; e < count; e++)
        for (uint32_t c = 0; c < width; c++)
            work[rows[e]] -= columns[c][e] * y[c];
}

/* The next `width` columns of row `k`; what is left of the diagonal then. */
static inline __attribute__((always_inline)) double solve_columns(MesoCholesky *factor, uint32_t first, double diagonal,
                                                                  const uint32_t width)
{
    double *restrict work = factor->work, *values = factor->values, y[TOGETHER];
    const double *below[TOGETHER];
    for (uint32_t c = 0; c < width; c++) {
        size_t begin = factor->column_begins[first + c], end = factor->column_ends[first + c]++;
        y[c] = work[factor->order[first + c]];
        work[factor->order[first + c]] = 0;
        for (uint32_t d = c + 1; d < width; d++)
            work[factor->order[first + d]] -= values[begin + d - c - 1] * y[c];
        below[c] = &values[begin + width - c - 1];
        values[end] = y[c] / factor->pivots[first + c];
        diagonal -= values[end] * y[c];
    }
    size_t begin = factor->column_begins[first + width - 1], end = factor->column_ends[first + width - 1] - 1;
    subtract(work, &factor->column_rows[factor->column_lists[first + width - 1]], end - begin, below, y, width);
    return diagonal;
}

/* Row `k` of L solves with the rows above it; returns its pivot. */
static inline __attribute__((always_inline)) double solve_row(MesoCholesky *factor, uint32_t k, double diagonal)
{
    for (size_t e = factor->row_begins[k]; e < factor->row_begins[k + 1]; e++) {
        uint32_t c = factor->row_bunches[e], end = factor->bunch_ends[c] < k ? factor->bunch_ends[c] : k;
        for (; end - c >= TOGETHER; c += TOGETHER)
            diagonal = solve_columns(factor, c, diagonal, TOGETHER);
        if (end - c >= 4) {
            diagonal = solve_columns(factor, c, diagonal, 4);
            c += 4;
        }
        if (end - c >= 2) {
            diagonal = solve_columns(factor, c, diagonal, 2);
            c += 2;
        }
        if (end - c)
            diagonal = solve_columns(factor, c, diagonal, 1);
    }
    return diagonal;
}

/* The same operations, and so the same numbers, on wider registers. */
#ifdef __x86_64__
__attribute__((target("avx2"))) static double solve_row_avx2(MesoCholesky *factor, uint32_t k, double diagonal)
{
    return solve_row(factor, k, diagonal);
}
#endif

static double solve_row_plain(MesoCholesky *factor, uint32_t k, double diagonal)
{
    return solve_row(factor, k, diagonal);
}

typedef double SolveRow(MesoCholesky *factor, uint32_t k, double diagonal);

static SolveRow *choose_solve_row(void)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2"))
        return solve_row_avx2;
#endif
    return solve_row_plain;
}

/*
 * What is left of a diagonal after its column has been eliminated is lost in rounding below this part of it: a few
 * units in the last place.
 */
static const double LEAST_PIVOT = 16 * DBL_EPSILON;

MesoStatus meso_cholesky_factor(MesoCholesky *factor, const MesoTriplet *triplets, size_t triplet_count,
                                MesoError *error)
{
    if (triplet_count > factor->triplet_room)
        return meso_fail(error, MESO_ERR_INTERNAL, "a matrix of %zu entries was analysed with %zu", triplet_count,
                         factor->triplet_room);
    MesoStatus status = check_triplets(factor->count, triplets, triplet_count, error);
    if (status)
        return status;
    sort_triplets(factor, triplets, triplet_count);
    memcpy(factor->column_ends, factor->column_begins, factor->count * sizeof *factor->column_ends);
    memset(factor->work, 0, factor->count * sizeof *factor->work);
    memset(factor->marks, 0xff, factor->count * sizeof *factor->marks);
    SolveRow *solve = choose_solve_row();
    for (uint32_t k = 0; k < factor->count; k++) {
        double diagonal = 0;
        if (!add_row(factor, triplets, k, &diagonal))
            return meso_fail(error, MESO_ERR_INTERNAL, "row %u of a matrix has an entry that was not analysed",
                             factor->order[k]);
        factor->pivots[k] = solve(factor, k, diagonal);
        if (!(factor->pivots[k] > LEAST_PIVOT * diagonal && factor->pivots[k] <= DBL_MAX))
            return meso_fail(error, MESO_ERR_INPUT, "a matrix is not positive definite at row %u of %u",
                             factor->order[k], factor->count);
    }
    return MESO_OK;
}

/* ---- solving ---- */

/* Unknowns keep their places: L's rows are named by unknowns. With a constant `width` the loops over it unroll. */
static inline void solve_width(const MesoCholesky *factor, double *restrict x, const uint32_t width)
{
    const size_t *begins = factor->column_begins;
    for (uint32_t k = 0; k < factor->count; k++) {
        const double *from = x + (size_t)factor->order[k] * width, *values = &factor->values[begins[k]];
        const uint32_t *rows = &factor->column_rows[factor->column_lists[k]];
        for (size_t e = 0; e < begins[k + 1] - begins[k]; e++) {
            double *to = x + (size_t)rows[e] * width;
            for (uint32_t c = 0; c < width; c++)
                to[c] -= values[e] * from[c];
        }
    }
    for (uint32_t k = factor->count; k-- > 0;) {
        double *to = x + (size_t)factor->order[k] * width;
        const double *values = &factor->values[begins[k]];
        const uint32_t *rows = &factor->column_rows[factor->column_lists[k]];
        for (uint32_t c = 0; c < width; c++)
            to[c] /= factor->pivots[k];
        for (size_t e = 0; e < begins[k + 1] - begins[k]; e++) {
            const double *from = x + (size_t)rows[e] * width;
            for (uint32_t c = 0; c < width; c++)
                to[c] -= values[e] * from[c];
        }
    }
}

void meso_cholesky_solve(const MesoCholesky *factor, double *x, uint32_t width)
{
    if (width == 1)
        solve_width(factor, x, 1);
    else if (width == 2)
        solve_width(factor, x, 2);
    else if (width == 3)
        solve_width(factor, x, 3);
    else
        solve_width(factor, x, width);
}
