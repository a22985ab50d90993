#include "libcore/quilt/seam/seam_line.h"

/* A point stays this far from the centres on both sides of it, in cells: signs are certain and no two points meet. */
static const float CLEARANCE = 0.05f;

/* Rounds of pulling the line taut, which takes the steps out of it, then of taking the bends out. Steps up to 15 cells
 * long go; a round on 200 points costs 2 and 6 microseconds. */
enum { TAUT_ROUNDS = 30, BEND_ROUNDS = 60 };

/* Segments of a line that one box is kept for. */
enum { RUN = 8 };

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

static float length_between(MesoVec2 a, MesoVec2 b)
{
    float length = meso_vec2_length(meso_vec2_sub(a, b));
    return length > 0.1f ? length : 0.1f;
}

/*
 * What one bend adds to the sums whose quotient is the move of a point that makes the bends around it least. The bend
 * at q between p and r is (r - q) / |r - q| - (q - p) / |q - p|, its energy its square over the length that it is
 * spread over; lengths stand still meanwhile. `which` of the three is the one that moves: 0, 1, 2.
 */
static void add_bend(const MesoVec2 p[3], int which, bool along_x, float *pull, float *stiffness)
{
    float before = 1 / length_between(p[0], p[1]), after = 1 / length_between(p[1], p[2]);
    const float factors[3] = {before, -(before + after), after};
    float bend = 0;
    for (int k = 0; k < 3; k++)
        bend += factors[k] * (along_x ? p[k].x : p[k].y);
    float weight = before * after / (before + after);
    *pull += weight * bend * factors[which];
    *stiffness += weight * factors[which] * factors[which];
}

static void unbend(MesoSeamLine *line, const Slide *slides)
{
    for (uint32_t i = 0; i < line->count; i++) {
        uint32_t chain[5] = {MESO_NO_INDEX, line->previous[i], i, line->next[i], MESO_NO_INDEX};
        if (chain[1] != MESO_NO_INDEX)
            chain[0] = line->previous[chain[1]];
        if (chain[3] != MESO_NO_INDEX)
            chain[4] = line->next[chain[3]];
        float pull = 0, stiffness = 0;
        for (int k = 0; k < 3; k++) {
            if (chain[k] == MESO_NO_INDEX || chain[k + 1] == MESO_NO_INDEX || chain[k + 2] == MESO_NO_INDEX)
                continue;
            MesoVec2 p[3] = {line->points[chain[k]], line->points[chain[k + 1]], line->points[chain[k + 2]]};
            add_bend(p, 2 - k, slides[i].along_x, &pull, &stiffness);
        }
        if (stiffness > 0) {
            MesoVec2 p = line->points[i];
            slide_to(line, slides, i, (slides[i].along_x ? p.x : p.y) - pull / stiffness);
        }
    }
}

MesoStatus meso_seam_line_trace(MesoSeamLine *line, MesoArena *arena, const uint8_t *sides, uint32_t columns,
                                uint32_t rows, MesoError *error)
{
    size_t cells = (size_t)columns * rows;
    *line = (MesoSeamLine){.points = MESO_NEW(arena, MesoVec2, 2 * cells, error),
                           .next = MESO_NEW(arena, uint32_t, 2 * cells, error),
                           .previous = MESO_NEW(arena, uint32_t, 2 * cells, error)};
    MesoArenaMark mark = meso_arena_mark(arena);
    Tracer tracer = {sides, columns, rows, line, MESO_NEW(arena, uint32_t, cells, error),
                     MESO_NEW(arena, uint32_t, cells, error)};
    if (!line->points || !line->next || !line->previous || !tracer.along || !tracer.up)
        return MESO_ERR_MEMORY;
    add_points(&tracer);
    join_points(&tracer);
    meso_arena_rewind(arena, mark);

    Slide *slides = slides_of(line, arena, error);
    if (!slides)
        return MESO_ERR_MEMORY;
    for (int round = 0; round < TAUT_ROUNDS; round++)
        pull_taut(line, slides);
    for (int round = 0; round < BEND_ROUNDS; round++)
        unbend(line, slides);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* ---- distances ---- */

/* Segments in the order of the line, in runs that are near each other, and the box of each run. */
typedef struct Runs {
    uint32_t segment_count, run_count;
    MesoVec2 *from, *to;        /* [segment_count] */
    MesoVec2 *low, *high;       /* [run_count] */
} Runs;

static void add_to_box(Runs *runs, uint32_t run, MesoVec2 p)
{
    runs->low[run].x = p.x < runs->low[run].x ? p.x : runs->low[run].x;
    runs->low[run].y = p.y < runs->low[run].y ? p.y : runs->low[run].y;
    runs->high[run].x = p.x > runs->high[run].x ? p.x : runs->high[run].x;
    runs->high[run].y = p.y > runs->high[run].y ? p.y : runs->high[run].y;
}

static void add_segment(Runs *runs, MesoVec2 from, MesoVec2 to)
{
    uint32_t s = runs->segment_count++, run = s / RUN;
    runs->from[s] = from;
    runs->to[s] = to;
    if (s % RUN == 0) {
        runs->low[run] = runs->high[run] = from;
        runs->run_count++;
    }
    add_to_box(runs, run, from);
    add_to_box(runs, run, to);
}

static void add_chain(Runs *runs, uint8_t *seen, const MesoSeamLine *line, uint32_t first)
{
    if (line->previous[first] == MESO_NO_INDEX && line->next[first] == MESO_NO_INDEX)
        add_segment(runs, line->points[first], line->points[first]);
    for (uint32_t i = first; line->next[i] != MESO_NO_INDEX && !seen[i]; i = line->next[i]) {
        seen[i] = 1;
        add_segment(runs, line->points[i], line->points[line->next[i]]);
    }
}

static MesoStatus gather_runs(Runs *runs, MesoArena *scratch, const MesoSeamLine *line, MesoError *error)
{
    uint32_t most = line->count / RUN + 1;
    uint8_t *seen = MESO_NEW(scratch, uint8_t, line->count, error);
    *runs = (Runs){.from = MESO_NEW(scratch, MesoVec2, line->count, error),
                   .to = MESO_NEW(scratch, MesoVec2, line->count, error),
                   .low = MESO_NEW(scratch, MesoVec2, most, error),
                   .high = MESO_NEW(scratch, MesoVec2, most, error)};
    if (!seen || !runs->from || !runs->to || !runs->low || !runs->high)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < line->count; i++)
        if (line->previous[i] == MESO_NO_INDEX)
            add_chain(runs, seen, line, i);
    for (uint32_t i = 0; i < line->count; i++)
        if (line->previous[i] != MESO_NO_INDEX)
            add_chain(runs, seen, line, i);
    return MESO_OK;
}

static float square_to_box(MesoVec2 p, MesoVec2 low, MesoVec2 high)
{
    float x = p.x < low.x ? low.x - p.x : p.x > high.x ? p.x - high.x : 0;
    float y = p.y < low.y ? low.y - p.y : p.y > high.y ? p.y - high.y : 0;
    return x * x + y * y;
}

static float square_to_segment(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    MesoVec2 along = meso_vec2_sub(b, a), off = meso_vec2_sub(p, a);
    float square = along.x * along.x + along.y * along.y;
    float t = square > 0 ? clamped((off.x * along.x + off.y * along.y) / square, 0, 1) : 0;
    float x = off.x - t * along.x, y = off.y - t * along.y;
    return x * x + y * y;
}

/* The square of the distance; runs farther than `limit` are not looked into. */
static float least_square(const Runs *runs, MesoVec2 p, float limit)
{
    float least = limit * limit;
    for (uint32_t run = 0; run < runs->run_count; run++) {
        if (square_to_box(p, runs->low[run], runs->high[run]) >= least)
            continue;
        uint32_t end = (run + 1) * RUN < runs->segment_count ? (run + 1) * RUN : runs->segment_count;
        for (uint32_t s = run * RUN; s < end; s++) {
            float square = square_to_segment(p, runs->from[s], runs->to[s]);
            least = square < least ? square : least;
        }
    }
    return least;
}

MesoStatus meso_seam_line_distances(float *values, MesoArena *scratch, const MesoSeamLine *line, const uint8_t *sides,
                                    uint32_t columns, uint32_t rows, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    Runs runs;
    if (gather_runs(&runs, scratch, line, error) != MESO_OK)
        return MESO_ERR_MEMORY;
    for (uint32_t j = 0; j < rows; j++) {
        /* No two neighbours differ by more than what is between them; a little more makes up for rounding. */
        float limit = j > 0 ? fabsf(values[(size_t)(j - 1) * columns]) + 1.01f : 2 * (float)(columns + rows);
        for (uint32_t i = 0; i < columns; i++) {
            size_t c = (size_t)j * columns + i;
            float distance = sqrtf(least_square(&runs, (MesoVec2){(float)i, (float)j}, limit));
            values[c] = sides[c] ? distance : -distance;
            limit = distance + 1.01f;
        }
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
