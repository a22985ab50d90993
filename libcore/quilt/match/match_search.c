#include "libcore/quilt/match/match_search.h"

#include <assert.h>

/* ---- turns ---- */

/* Whole and quarter turns are exact. */
static void turn_of(uint32_t turn, uint32_t turn_count, float *cosine, float *sine)
{
    static const float quarters[4][2] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}};
    uint64_t quarter = 4 * (uint64_t)(turn % turn_count);
    if (quarter % turn_count == 0) {
        *cosine = quarters[quarter / turn_count][0];
        *sine = quarters[quarter / turn_count][1];
        return;
    }
    double angle = -2 * MESO_PI * (turn % turn_count) / turn_count;
    *cosine = (float)cos(angle);
    *sine = (float)sin(angle);
}

static MesoVec2 turned(MesoVec2 p, float cosine, float sine)
{
    return (MesoVec2){cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
}

static MesoMatchPoint moved(MesoMatchPoint point, float cosine, float sine, MesoVec2 shift)
{
    MesoVec2 p = turned((MesoVec2){point.position.x, point.position.y}, cosine, sine);
    MesoVec2 n = turned((MesoVec2){point.normal.x, point.normal.y}, cosine, sine);
    return (MesoMatchPoint){{p.x + shift.x, p.y + shift.y, point.position.z}, {n.x, n.y, point.normal.z}};
}

MesoMatchPoint meso_match_placed(MesoMatchPoint point, MesoVec2 shift, uint32_t turn, uint32_t turn_count)
{
    float cosine, sine;
    turn_of(turn, turn_count, &cosine, &sine);
    return moved(point, cosine, sine, shift);
}

/* ---- costs by the tables ---- */

typedef struct Search {
    const MesoMatchField *field;
    const MesoMatchPoint *points;
    const float *weights;
    uint32_t point_count, turn_count;
    MesoVec2 low, high;
    float margin, total;    /* of the weights */
} Search;

/* The shifts of one turn: from (first_x, first_y) on, in voxels, and the sum of D - 1 at each. */
typedef struct Sheet {
    int32_t first_x, first_y;
    uint32_t columns, rows;
    float *sums;            /* [columns * rows] INFINITY where it is taken */
} Sheet;

static float weight_of(const Search *search, uint32_t i)
{
    return search->weights ? search->weights[i] : 1;
}

/* Whole numbers of voxels that keep [low, high] in [margin, size - margin]. A thousandth of a voxel is rounding. */
static void shift_range(double low, double high, double margin, double size, double voxel, int32_t *first,
                        uint32_t *count)
{
    double from = ceil((margin - low) / voxel - 1e-3), to = floor((size - margin - high) / voxel + 1e-3);
    bool any = to >= from && fabs(from) < 1e9 && fabs(to) < 1e9;
    *first = any ? (int32_t)from : 0;
    *count = any ? (uint32_t)(to - from) + 1 : 0;
}

/* The box around the turned window. */
static Sheet place_sheet(const Search *search, float cosine, float sine)
{
    Sheet sheet = {0};
    MesoVec2 low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
    for (int k = 0; k < 4; k++) {
        MesoVec2 corner = {k & 1 ? search->high.x : search->low.x, k & 2 ? search->high.y : search->low.y};
        corner = turned(corner, cosine, sine);
        low = (MesoVec2){corner.x < low.x ? corner.x : low.x, corner.y < low.y ? corner.y : low.y};
        high = (MesoVec2){corner.x > high.x ? corner.x : high.x, corner.y > high.y ? corner.y : high.y};
    }
    const MesoMatchField *field = search->field;
    MesoVec3 size = field->swatch->size;
    shift_range(low.x, high.x, search->margin, size.x, field->voxel, &sheet.first_x, &sheet.columns);
    shift_range(low.y, high.y, search->margin, size.y, field->voxel, &sheet.first_y, &sheet.rows);
    if (sheet.columns > field->count[0])
        sheet.columns = field->count[0];
    if (sheet.rows > field->count[1])
        sheet.rows = field->count[1];
    return sheet;
}

/* The voxel of `x`, no higher than `last`. */
static size_t voxel_at(float x, uint32_t last)
{
    return x > 0 ? x < (float)last ? (size_t)x : last : 0;
}

/*
 * Adds three tables, each times a weight, to all shifts. This is where the time goes: rows are contiguous, and nothing
 * overlaps.
 */
static inline __attribute__((always_inline)) void add_tables(const Sheet *sheet, const uint16_t *const tables[3],
                                                             const float weights[3], size_t stride)
{
    const float u = weights[0], v = weights[1], w = weights[2];
    for (uint32_t y = 0; y < sheet->rows; y++) {
        float *restrict sums = sheet->sums + (size_t)y * sheet->columns;
        const uint16_t *restrict a = tables[0] + y * stride, *restrict b = tables[1] + y * stride;
        const uint16_t *restrict c = tables[2] + y * stride;
        for (uint32_t x = 0; x < sheet->columns; x++)
            sums[x] += u * meso_match_excess(a[x]) + v * meso_match_excess(b[x]) + w * meso_match_excess(c[x]);
    }
}

static inline __attribute__((always_inline)) void add_point(const Sheet *sheet, const MesoMatchField *field,
                                                            MesoMatchPoint point, float weight)
{
    MesoVec3 p = meso_vec3_scale(meso_vec3_sub(point.position, field->low), 1 / field->voxel);
    size_t x = voxel_at(p.x + (float)sheet->first_x, field->count[0] - sheet->columns);
    size_t y = voxel_at(p.y + (float)sheet->first_y, field->count[1] - sheet->rows);
    size_t z = voxel_at(p.z, field->count[2] - 1);
    MesoMatchBlend blend = meso_match_blend(point.normal);
    const uint16_t *tables[3];
    for (int k = 0; k < 3; k++) {
        tables[k] = &field->costs[((blend.bins[k] * (size_t)field->count[2] + z) * field->count[1] + y) *
                                      field->count[0] + x];
        blend.weights[k] *= weight;
    }
    add_tables(sheet, tables, blend.weights, field->count[0]);
}

static inline __attribute__((always_inline)) void add_all(const Sheet *sheet, const Search *search, float cosine,
                                                          float sine)
{
    for (uint32_t i = 0; i < search->point_count; i++)
        if (weight_of(search, i) > 0)
            add_point(sheet, search->field, moved(search->points[i], cosine, sine, (MesoVec2){0, 0}),
                      weight_of(search, i));
}

/* The same operations, and so the same sums, on wider registers. */
#ifdef __x86_64__
__attribute__((target("avx2"))) static void add_all_avx2(const Sheet *sheet, const Search *search, float cosine,
                                                         float sine)
{
    add_all(sheet, search, cosine, sine);
}
#endif

static void add_points(const Sheet *sheet, const Search *search, float cosine, float sine)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) {
        add_all_avx2(sheet, search, cosine, sine);
        return;
    }
#endif
    add_all(sheet, search, cosine, sine);
}

static MesoStatus fill_sheet(Sheet *sheet, const Search *search, uint32_t turn, MesoArena *scratch, MesoError *error)
{
    float cosine, sine;
    turn_of(turn, search->turn_count, &cosine, &sine);
    *sheet = place_sheet(search, cosine, sine);
    sheet->sums = MESO_NEW(scratch, float, (size_t)sheet->columns * sheet->rows, error);
    if (!sheet->sums)
        return MESO_ERR_MEMORY;
    if (sheet->columns > 0 && sheet->rows > 0)
        add_points(sheet, search, cosine, sine);
    return MESO_OK;
}

/* ---- the best of them ---- */

static MesoVec2 shift_at(const Sheet *sheet, const MesoMatchField *field, size_t at)
{
    return (MesoVec2){field->voxel * (float)(sheet->first_x + (int32_t)(at % sheet->columns)),
                      field->voxel * (float)(sheet->first_y + (int32_t)(at / sheet->columns))};
}

/* Takes the shifts within `apart` of one, itself among them. */
static void take_around(Sheet *sheet, size_t at, float apart)
{
    float x = (float)(at % sheet->columns), y = (float)(at / sheet->columns), square = apart > 0 ? apart * apart : 0;
    for (size_t i = 0; i < (size_t)sheet->columns * sheet->rows; i++) {
        float off_x = (float)(i % sheet->columns) - x, off_y = (float)(i / sheet->columns) - y;
        if (off_x * off_x + off_y * off_y <= square)
            sheet->sums[i] = INFINITY;
    }
}

/* Moves the best shift of all sheets to `match`; false where none is left. */
static bool take_best(MesoMatch *match, Sheet *sheets, const Search *search, float apart)
{
    float least = INFINITY;
    size_t best = 0;
    uint32_t turn = 0;
    for (uint32_t t = 0; t < search->turn_count; t++)
        for (size_t i = 0; i < (size_t)sheets[t].columns * sheets[t].rows; i++)
            if (sheets[t].sums[i] < least) {
                least = sheets[t].sums[i];
                best = i;
                turn = t;
            }
    if (!(least < INFINITY))
        return false;
    *match = (MesoMatch){shift_at(&sheets[turn], search->field, best), turn, 0};
    match->cost = search->total > 0 ? least / search->total : 0;
    take_around(&sheets[turn], best, apart / search->field->voxel);
    return true;
}

/* ---- costs by faces ---- */

/* The sum of all weights times D - 1; a larger number than `limit` once it is beyond it. */
static double sum_costs(const Search *search, MesoVec2 shift, uint32_t turn, double limit)
{
    float cosine, sine;
    double sum = 0;
    turn_of(turn, search->turn_count, &cosine, &sine);
    for (uint32_t i = 0; i < search->point_count && sum <= limit; i++)
        if (weight_of(search, i) > 0)
            sum += (double)weight_of(search, i) *
                   (double)(meso_match_at(search->field, moved(search->points[i], cosine, sine, shift), NULL) - 1);
    return sum;
}

static Search search_of(const MesoMatchField *field, const MesoMatchPoint *points, const float *weights,
                        uint32_t point_count, uint32_t turn_count)
{
    Search search = {.field = field, .points = points, .weights = weights, .point_count = point_count,
                     .turn_count = turn_count};
    for (uint32_t i = 0; i < point_count; i++)
        search.total += weight_of(&search, i) > 0 ? weight_of(&search, i) : 0;
    return search;
}

float meso_match_cost(const MesoMatchField *field, const MesoMatchPoint *points, const float *weights,
                      uint32_t point_count, MesoVec2 shift, uint32_t turn, uint32_t turn_count)
{
    Search search = search_of(field, points, weights, point_count, turn_count);
    return search.total > 0 ? (float)(sum_costs(&search, shift, turn, INFINITY) / (double)search.total) : 0;
}

uint32_t meso_match_refine(MesoMatch *matches, uint32_t count, uint32_t keep, const MesoMatchField *field,
                           const MesoMatchPoint *points, const float *weights, uint32_t point_count,
                           uint32_t turn_count)
{
    Search search = search_of(field, points, weights, point_count, turn_count);
    uint32_t kept = 0;
    double total = search.total > 0 ? (double)search.total : 1;
    for (uint32_t i = 0; i < count && keep > 0; i++) {
        MesoMatch match = matches[i];
        double limit = kept < keep ? INFINITY : (double)matches[kept - 1].cost * total;
        match.cost = (float)(sum_costs(&search, match.shift, match.turn, limit) / total);
        if (kept == keep && !(match.cost < matches[kept - 1].cost))
            continue;
        uint32_t at = kept < keep ? kept++ : kept - 1;
        for (; at > 0 && matches[at - 1].cost > match.cost; at--)
            matches[at] = matches[at - 1];
        matches[at] = match;
    }
    return kept;
}

MesoStatus meso_match_search(MesoMatch *matches, uint32_t *found, uint32_t wanted, float apart,
                             const MesoMatchField *field, MesoArena *scratch, const MesoMatchPoint *points,
                             const float *weights, uint32_t point_count, MesoVec2 low, MesoVec2 high, float margin,
                             uint32_t turn_count, MesoError *error)
{
    assert(turn_count > 0);
    MesoArenaMark mark = meso_arena_mark(scratch);
    Search search = search_of(field, points, weights, point_count, turn_count);
    search.low = low;
    search.high = high;
    search.margin = margin;
    Sheet *sheets = MESO_NEW(scratch, Sheet, turn_count, error);
    if (!sheets)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    for (uint32_t turn = 0; turn < turn_count && status == MESO_OK; turn++)
        status = fill_sheet(&sheets[turn], &search, turn, scratch, error);
    *found = 0;
    while (status == MESO_OK && *found < wanted && take_best(&matches[*found], sheets, &search, apart))
        ++*found;
    meso_arena_rewind(scratch, mark);
    return status;
}
