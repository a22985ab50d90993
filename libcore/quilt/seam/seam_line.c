#include "libcore/quilt/seam/seam_line.h"

/* A point stays this far from the centres on both sides of it, in cells: signs are certain and no two points meet. */
static const float CLEARANCE = 0.05f;

/* Rounds of pulling the line taut, which takes the steps out of it, then of taking the bends out. Steps up to 15 cells
 * long go; a round on 200 points costs 2 and 6 microseconds. */
enum { TAUT_ROUNDS = 30, BEND_ROUNDS = 60 };

/* Centres so many cells around a segment have their distance from it; others hear of it from their neighbours. */
#define NEAR 2.5f

/* ---- tracing ---- */

typedef struct Tracer {
    const uint8_t *sides;
    uint32_t columns, rows;
    MesoSeamLine *line;
    uint32_t *along;    /* [columns * rows] the point between a cell and its right neighbour, or MESO_NO_INDEX */
    uint32_t *up;       /* [columns * rows] and its upper one */
} Tracer;

static uint32_t add_point(MesoSeamLine *line, MesoVec2 point)
{
    line->points[line->count] = point;
    line->next[line->count] = line->previous[line->count] = MESO_NO_INDEX;
    return line->count++;
}

static void add_points(Tracer *tracer)
{
    const uint8_t *sides = tracer->sides;
    uint32_t columns = tracer->columns;
    for (uint32_t j = 0; j < tracer->rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            size_t c = (size_t)j * columns + i;
            float x = (float)i, y = (float)j;
            tracer->along[c] = tracer->up[c] = MESO_NO_INDEX;
            if (i + 1 < columns && sides[c] != sides[c + 1])
                tracer->along[c] = add_point(tracer->line, (MesoVec2){x + 0.5f, y});
            if (j + 1 < tracer->rows && sides[c] != sides[c + columns])
                tracer->up[c] = add_point(tracer->line, (MesoVec2){x, y + 0.5f});
        }
}

/*
 * The square between four centres, its sides numbered 0 below, 1 right, 2 above, 3 left: a piece of the line enters by
 * one side and leaves by another. By the bits of corners on side 1 (1 lower left, 2 lower right, 4 upper right, 8 upper
 * left), side and side; -1 for no more. Side 1 lies to the left.
 */
static const int8_t PIECES[16][4] = {
    {-1, -1, -1, -1}, {0, 3, -1, -1}, {1, 0, -1, -1}, {1, 3, -1, -1}, {2, 1, -1, -1}, {0, 3, 2, 1}, {2, 0, -1, -1},
    {2, 3, -1, -1},   {3, 2, -1, -1}, {0, 2, -1, -1}, {1, 0, 3, 2},   {1, 2, -1, -1}, {3, 1, -1, -1}, {0, 1, -1, -1},
    {3, 0, -1, -1},   {-1, -1, -1, -1},
};

static void join_points(Tracer *tracer)
{
    const uint8_t *sides = tracer->sides;
    uint32_t columns = tracer->columns;
    for (uint32_t j = 0; j + 1 < tracer->rows; j++)
        for (uint32_t i = 0; i + 1 < columns; i++) {
            size_t c = (size_t)j * columns + i;
            const int8_t *pieces =
                PIECES[sides[c] | sides[c + 1] << 1 | sides[c + columns + 1] << 2 | sides[c + columns] << 3];
            uint32_t points[4] = {tracer->along[c], tracer->up[c + 1], tracer->along[c + columns], tracer->up[c]};
            for (uint32_t k = 0; k < 4 && pieces[k] >= 0; k += 2) {
                uint32_t from = points[pieces[k]], to = points[pieces[k + 1]];
                tracer->line->next[from] = to;
                tracer->line->previous[to] = from;
            }
        }
}

/* ---- smoothing ---- */

/* A point slides along x where its y is whole: between two centres of one row. */
typedef struct Slide {
    bool along_x;
    float low, high;
} Slide;

static float clamped(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static Slide *slides_of(const MesoSeamLine *line, MesoArena *scratch, MesoError *error)
{
    Slide *slides = MESO_NEW(scratch, Slide, line->count, error);
    for (uint32_t i = 0; slides && i < line->count; i++) {
        MesoVec2 p = line->points[i];
        bool along_x = p.x != floorf(p.x);
        float middle = along_x ? p.x : p.y;
        slides[i] = (Slide){along_x, middle - 0.5f + CLEARANCE, middle + 0.5f - CLEARANCE};
    }
    return slides;
}

static void slide_to(MesoSeamLine *line, const Slide *slides, uint32_t i, float place)
{
    place = clamped(place, slides[i].low, slides[i].high);
    *(slides[i].along_x ? &line->points[i].x : &line->points[i].y) = place;
}

/* Each point to where the line between its neighbours crosses the way it slides on: they lie on either side of it. An
 * end follows its neighbour. */
static void pull_taut(MesoSeamLine *line, const Slide *slides)
{
    for (uint32_t i = 0; i < line->count; i++) {
        uint32_t before = line->previous[i], after = line->next[i];
        if (before == MESO_NO_INDEX)
            before = after;
        if (after == MESO_NO_INDEX)
            after = before;
        if (before == MESO_NO_INDEX)
            continue;
        MesoVec2 a = line->points[before], b = line->points[after], p = line->points[i];
        bool along_x = slides[i].along_x;
        float across = along_x ? b.y - a.y : b.x - a.x;
        float t = across != 0 ? ((along_x ? p.y - a.y : p.x - a.x)) / across : 0;
        slide_to(line, slides, i, along_x ? a.x + t * (b.x - a.x) : a.y + t * (b.y - a.y));
    }
}

/*
 * The bend at a point q between p and r is (r - q) / |r - q| - (q - p) / |q - p|, linear in all three while lengths
 * stand still: `factors` of p, q and r. Its energy is its square over the length that it is spread over: `weight`.
 */
typedef struct Bend {
    float factors[3], weight;
} Bend;

static float inverse_length(MesoVec2 a, MesoVec2 b)
{
    float length = meso_vec2_length(meso_vec2_sub(a, b));
    return length > 0.1f ? 1 / length : 10;
}

/* No bend at an end. */
static void measure_bends(Bend *bends, const MesoSeamLine *line)
{
    for (uint32_t i = 0; i < line->count; i++) {
        uint32_t before = line->previous[i], after = line->next[i];
        bends[i] = (Bend){0};
        if (before == MESO_NO_INDEX || after == MESO_NO_INDEX)
            continue;
        float p = inverse_length(line->points[before], line->points[i]);
        float r = inverse_length(line->points[i], line->points[after]);
        bends[i] = (Bend){{p, -(p + r), r}, p * r / (p + r)};
    }
}

/* What the bend at a point adds to the sums whose quotient is the move of one of its three points: 0, 1, 2. */
static void add_bend(const MesoSeamLine *line, const Bend *bends, uint32_t at, int which, bool along_x, float *pull,
                     float *stiffness)
{
    if (at == MESO_NO_INDEX || !(bends[at].weight > 0))
        return;
    const uint32_t chain[3] = {line->previous[at], at, line->next[at]};
    float bend = 0;
    for (int k = 0; k < 3; k++)
        bend += bends[at].factors[k] * (along_x ? line->points[chain[k]].x : line->points[chain[k]].y);
    float factor = bends[at].weight * bends[at].factors[which];
    *pull += factor * bend;
    *stiffness += factor * bends[at].factors[which];
}

/* Each point to where the three bends that it is part of are least. */
static void unbend(MesoSeamLine *line, const Slide *slides, Bend *bends)
{
    measure_bends(bends, line);
    for (uint32_t i = 0; i < line->count; i++) {
        bool along_x = slides[i].along_x;
        float pull = 0, stiffness = 0;
        add_bend(line, bends, line->previous[i], 2, along_x, &pull, &stiffness);
        add_bend(line, bends, i, 1, along_x, &pull, &stiffness);
        add_bend(line, bends, line->next[i], 0, along_x, &pull, &stiffness);
        if (stiffness > 0) {
            MesoVec2 p = line->points[i];
            slide_to(line, slides, i, (along_x ? p.x : p.y) - pull / stiffness);
        }
    }
}

MesoStatus meso_seam_line_trace(MesoSeamLine *line, MesoArena *arena, const uint8_t *sides, uint32_t columns,
                                uint32_t rows, MesoError *error)
{
    size_t cells = (size_t)columns * rows;
    *line = (MesoSeamLine){.points = MESO_NEW_BARE(arena, MesoVec2, 2 * cells, error),
                           .next = MESO_NEW_BARE(arena, uint32_t, 2 * cells, error),
                           .previous = MESO_NEW_BARE(arena, uint32_t, 2 * cells, error)};
    MesoArenaMark mark = meso_arena_mark(arena);
    Tracer tracer = {sides, columns, rows, line, MESO_NEW_BARE(arena, uint32_t, cells, error),
                     MESO_NEW_BARE(arena, uint32_t, cells, error)};
    if (!line->points || !line->next || !line->previous || !tracer.along || !tracer.up)
        return MESO_ERR_MEMORY;
    add_points(&tracer);
    join_points(&tracer);
    meso_arena_rewind(arena, mark);

    Slide *slides = slides_of(line, arena, error);
    Bend *bends = MESO_NEW(arena, Bend, line->count, error);
    if (!slides || !bends)
        return MESO_ERR_MEMORY;
    for (int round = 0; round < TAUT_ROUNDS; round++)
        pull_taut(line, slides);
    for (int round = 0; round < BEND_ROUNDS; round++)
        unbend(line, slides, bends);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* ---- distances ---- */

/* For each centre the nearest point of the line that it has heard of, and the square of the distance to it. */
typedef struct Feet {
    uint32_t columns, rows;
    MesoVec2 *feet;
    float *squares;
} Feet;

static MesoVec2 foot_on_segment(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    MesoVec2 along = meso_vec2_sub(b, a), off = meso_vec2_sub(p, a);
    float square = along.x * along.x + along.y * along.y;
    float t = square > 0 ? clamped((off.x * along.x + off.y * along.y) / square, 0, 1) : 0;
    return (MesoVec2){a.x + t * along.x, a.y + t * along.y};
}

static void hear_of(Feet *feet, size_t cell, MesoVec2 centre, MesoVec2 foot)
{
    float x = centre.x - foot.x, y = centre.y - foot.y, square = x * x + y * y;
    if (square < feet->squares[cell]) {
        feet->squares[cell] = square;
        feet->feet[cell] = foot;
    }
}

/* Centres from `low` - NEAR on; to below `high` + NEAR. */
static void near_range(float low, float high, uint32_t count, uint32_t range[2])
{
    range[0] = low > NEAR ? (uint32_t)(low - NEAR) : 0;
    range[1] = (uint32_t)(high + NEAR) + 1;
    range[1] = range[1] < count ? range[1] : count;
}

/* Centres around a segment have their distance from it. */
static void tell_around(Feet *feet, MesoVec2 a, MesoVec2 b)
{
    uint32_t i[2], j[2];
    near_range(a.x < b.x ? a.x : b.x, a.x < b.x ? b.x : a.x, feet->columns, i);
    near_range(a.y < b.y ? a.y : b.y, a.y < b.y ? b.y : a.y, feet->rows, j);
    for (uint32_t y = j[0]; y < j[1]; y++)
        for (uint32_t x = i[0]; x < i[1]; x++) {
            MesoVec2 centre = {(float)x, (float)y};
            hear_of(feet, (size_t)y * feet->columns + x, centre, foot_on_segment(centre, a, b));
        }
}

/* What the neighbours in `y` + `dy` and beside know, from side to side and back. */
static void sweep_row(Feet *feet, uint32_t y, int dy)
{
    uint32_t columns = feet->columns;
    size_t row = (size_t)y * columns;
    bool is_first = dy < 0 ? y == 0 : y + 1 == feet->rows;
    const MesoVec2 *from = is_first ? NULL : &feet->feet[dy < 0 ? row - columns : row + columns];
    for (uint32_t x = 0; x < columns; x++) {
        MesoVec2 centre = {(float)x, (float)y};
        for (uint32_t k = x > 0 ? x - 1 : 0; from && k <= x + 1 && k < columns; k++)
            hear_of(feet, row + x, centre, from[k]);
        if (x > 0)
            hear_of(feet, row + x, centre, feet->feet[row + x - 1]);
    }
    for (uint32_t x = columns - 1; x-- > 0;)
        hear_of(feet, row + x, (MesoVec2){(float)x, (float)y}, feet->feet[row + x + 1]);
}

/* By two sweeps (Danielsson, "Euclidean distance mapping", 1980). */
static void spread_feet(Feet *feet)
{
    for (uint32_t y = 0; y < feet->rows; y++)
        sweep_row(feet, y, -1);
    for (uint32_t y = feet->rows; y-- > 0;)
        sweep_row(feet, y, 1);
}

MesoStatus meso_seam_line_distances(float *values, MesoArena *scratch, const MesoSeamLine *line, const uint8_t *sides,
                                    uint32_t columns, uint32_t rows, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    size_t count = (size_t)columns * rows;
    Feet feet = {columns, rows, MESO_NEW_BARE(scratch, MesoVec2, count, error), values};
    if (!feet.feet)
        return MESO_ERR_MEMORY;
    for (size_t c = 0; c < count; c++) {
        feet.feet[c] = (MesoVec2){INFINITY, INFINITY};
        values[c] = INFINITY;
    }
    for (uint32_t i = 0; i < line->count; i++)
        tell_around(&feet, line->points[i], line->points[line->next[i] == MESO_NO_INDEX ? i : line->next[i]]);
    spread_feet(&feet);
    for (size_t c = 0; c < count; c++)
        values[c] = sides[c] ? sqrtf(values[c]) : -sqrtf(values[c]);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
