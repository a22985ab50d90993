#include "libcore/quilt/phase/phase_plane.h"

/* Conjugate gradients: steps at most, and the error that is small against the first. */
enum { STEPS = 200 };
#define SMALL 1e-4

/* Of its area a triangle keeps so much: rounds of easing where one does not, then halvings of all bending. */
#define AREA_LEAST 0.25f
enum { EASINGS = 32, HALVINGS = 5 };

/* Sides where stripes may end count, but little. */
#define WEIGHT_LEAST 1e-3

typedef struct Side {
    uint32_t from, to;      /* triangles of the chart */
    double weight, ways[2];
} Side;

typedef struct Bending {
    MesoVec2 *vertices;     /* [chart->vertex_count] places of the chart */
    const MesoChart *chart;
    const uint32_t *chart_triangles;
    const MesoStripePhases *phases;
    double unit;            /* of the plane, in the phases' */
    uint32_t count, side_count;
    uint32_t *quarters;     /* [count] the guide is x of the plane and so many */
    MesoVec2 *middles;      /* [count] as the plane is, along the axes of the stripes */
    double *areas;          /* [count] */
    Side *sides;
    double *places;         /* [2 * count] as it is to be, but for where it begins */
    double *left, *way, *pull, *weights;
} Bending;

/* From the plane's axes to those of the stripes. */
static MesoVec2 to_stripes(const MesoStripePhases *phases, MesoVec2 p)
{
    const float half = sqrtf(0.5f);
    return phases->diagonal ? (MesoVec2){half * (p.x + p.y), half * (p.y - p.x)} : p;
}

static MesoVec2 from_stripes(const MesoStripePhases *phases, MesoVec2 p)
{
    const float half = sqrtf(0.5f);
    return phases->diagonal ? (MesoVec2){half * (p.x - p.y), half * (p.x + p.y)} : p;
}

static MesoVec2 corner_place(const Bending *b, uint32_t triangle, uint32_t k)
{
    return b->vertices[b->chart->corners[3 * (size_t)triangle + k]];
}

static float area_of(MesoVec2 a, MesoVec2 b, MesoVec2 c)
{
    return 0.5f * meso_vec2_cross(meso_vec2_sub(b, a), meso_vec2_sub(c, a));
}

static void look(Bending *b, const MesoVec3 *guides, float angle)
{
    const MesoChart *chart = b->chart;
    uint32_t unit = 4 / b->phases->turn_count;
    for (uint32_t t = 0; t < b->count; t++) {
        MesoVec2 p = corner_place(b, t, 0), q = corner_place(b, t, 1), r = corner_place(b, t, 2);
        b->middles[t] = to_stripes(b->phases, (MesoVec2){(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
        b->areas[t] = (double)area_of(p, q, r);
        MesoVec2 guide = meso_chart_direction(chart, b->phases->mesh, t, guides[chart->triangles[t]]);
        double turned = (atan2(guide.y, guide.x) - (double)angle) / (0.5 * MESO_PI * unit);
        b->quarters[t] = (uint32_t)(((llround(turned) * unit) % 4 + 4) % 4);
    }
}

static double height_of(const double wave[2])
{
    return sqrt(wave[0] * wave[0] + wave[1] * wave[1]);
}

/* The advance of both phases over a side, as lengths along the plane's axes. */
static void list_sides(Bending *b)
{
    const MesoStripePhases *p = b->phases;
    for (uint32_t h = 0; h < 3 * b->count; h++) {
        uint32_t t = h / 3, half_edge = 3 * b->chart->triangles[t] + h % 3;
        uint32_t across = meso_frame_across(p->mesh, half_edge);
        uint32_t s = across == MESO_NO_INDEX ? MESO_NO_INDEX : b->chart_triangles[across / 3];
        if (s == MESO_NO_INDEX || s <= t)
            continue;
        MesoStripeStep step = meso_stripe_step(p, half_edge, across);
        Side *side = &b->sides[b->side_count++];
        MesoVec2 apart = meso_vec2_sub(b->middles[s], b->middles[t]);
        *side = (Side){t, s, WEIGHT_LEAST, {apart.x, apart.y}};
        if ((b->quarters[s] + step.quarters) % 4 != b->quarters[t])
            continue;   /* the guide turns around something here */
        const double *here = p->waves[half_edge / 3], *there = p->waves[across / 3];
        double ways[2], least = INFINITY;
        meso_stripe_excess(ways, p, half_edge, across, &step);
        for (int k = 0; k < 2; k++) {
            ways[k] = (ways[k] + step.ways[k]) * b->unit;
            least = fmin(least, fmin(height_of(&here[2 * k]), height_of(&there[2 * k])));
        }
        meso_stripe_turn_ways(side->ways, ways, (4 - b->quarters[t]) % 4);
        side->weight = fmax(least * least, WEIGHT_LEAST);
    }
}

/* pull = L p, L the Laplacian of sides. */
static void apply(double *pull, const double *p, const Bending *b)
{
    for (size_t i = 0; i < 2 * (size_t)b->count; i++)
        pull[i] = 0;
    for (uint32_t i = 0; i < b->side_count; i++) {
        const Side *side = &b->sides[i];
        for (size_t k = 0; k < 2; k++) {
            size_t from = 2 * (size_t)side->from + k, to = 2 * (size_t)side->to + k;
            double part = side->weight * (p[to] - p[from]);
            pull[to] += part;
            pull[from] -= part;
        }
    }
}

static void solve(Bending *b)
{
    size_t size = 2 * (size_t)b->count;
    double before = 0, first = 0;
    for (uint32_t t = 0; t < b->count; t++) {
        b->places[2 * (size_t)t] = b->middles[t].x;
        b->places[2 * (size_t)t + 1] = b->middles[t].y;
    }
    apply(b->pull, b->places, b);
    for (size_t i = 0; i < size; i++) {
        b->left[i] = -b->pull[i];
        b->weights[i] = 0;
    }
    for (uint32_t i = 0; i < b->side_count; i++) {
        const Side *side = &b->sides[i];
        for (size_t k = 0; k < 2; k++) {
            size_t from = 2 * (size_t)side->from + k, to = 2 * (size_t)side->to + k;
            b->left[to] += side->weight * side->ways[k];
            b->left[from] -= side->weight * side->ways[k];
            b->weights[to] += side->weight;
            b->weights[from] += side->weight;
        }
    }
    for (int step = 0; step < STEPS; step++) {
        double now = 0, along = 0;
        for (size_t i = 0; i < size; i++)
            now += b->weights[i] > 0 ? b->left[i] * b->left[i] / b->weights[i] : 0;
        first = step ? first : now;
        if (!(now > SMALL * SMALL * first))
            break;
        for (size_t i = 0; i < size; i++)
            b->way[i] = (b->weights[i] > 0 ? b->left[i] / b->weights[i] : 0) + (step ? now / before * b->way[i] : 0);
        apply(b->pull, b->way, b);
        for (size_t i = 0; i < size; i++)
            along += b->way[i] * b->pull[i];
        for (size_t i = 0; i < size && along > 0; i++) {
            b->places[i] += now / along * b->way[i];
            b->left[i] -= now / along * b->pull[i];
        }
        before = now;
    }
}

/* Where the plane begins: so that phases there are those of the stripes, on the mean. */
static void settle(Bending *b)
{
    const MesoStripePhases *p = b->phases;
    for (size_t k = 0; k < 2; k++) {
        double re = 0, im = 0, turn = 2 * MESO_PI / (p->pitches[k] * b->unit), x = 0, y = 0, area = 0;
        for (uint32_t t = 0; t < b->count; t++) {
            double waves[4], angle = turn * b->places[2 * (size_t)t + k];
            meso_stripe_turn_waves(waves, p->waves[b->chart->triangles[t]], (4 - b->quarters[t]) % 4);
            double c = cos(angle), s = sin(angle), a = b->areas[t];
            re += a * (waves[2 * k] * c + waves[2 * k + 1] * s);
            im += a * (waves[2 * k + 1] * c - waves[2 * k] * s);
            x += a * (k ? b->middles[t].y : b->middles[t].x);
            y += a * b->places[2 * (size_t)t + k];
            area += a;
        }
        double more = atan2(im, re) / turn, off = (x - y) / area, period = 2 * MESO_PI / turn;
        more += period * floor((off - more) / period + 0.5);    /* as near to where it is as whole pitches allow */
        for (uint32_t t = 0; t < b->count; t++)
            b->places[2 * (size_t)t + k] += more;
    }
}

/* Moves of vertices: the mean of those of triangles around, by area. */
static void find_moves(MesoVec2 *moves, float *shares, const Bending *b)
{
    const MesoChart *chart = b->chart;
    for (uint32_t t = 0; t < b->count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = chart->corners[3 * (size_t)t + k];
            float area = (float)b->areas[t];
            moves[v].x += area * ((float)b->places[2 * (size_t)t] - b->middles[t].x);
            moves[v].y += area * ((float)b->places[2 * (size_t)t + 1] - b->middles[t].y);
            shares[v] += area;
        }
    for (uint32_t v = 0; v < chart->vertex_count; v++)
        moves[v] = shares[v] > 0 ? from_stripes(b->phases, (MesoVec2){moves[v].x / shares[v], moves[v].y / shares[v]})
                                 : (MesoVec2){0, 0};
}

/* Whether a triangle is large enough where its corners move by that share, but for the mean. */
static bool keeps_area(const Bending *b, const MesoVec2 *moves, MesoVec2 mean, float share, uint32_t triangle)
{
    MesoVec2 places[3];
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec2 bend = meso_vec2_sub(moves[b->chart->corners[3 * (size_t)triangle + k]], mean);
        places[k] = meso_vec2_add(corner_place(b, triangle, k), meso_vec2_scale(bend, share));
    }
    return area_of(places[0], places[1], places[2]) >= AREA_LEAST * (float)b->areas[triangle];
}

static bool keeps_areas(const Bending *b, const MesoVec2 *moves, MesoVec2 mean, float share)
{
    for (uint32_t t = 0; t < b->count; t++)
        if (!keeps_area(b, moves, mean, share, t))
            return false;
    return true;
}

/*
 * Where a stripe ends, the few triangles around would be turned over: there moves are smoothed, again and again, so
 * that all else is bent as it should be. Corners of such triangles take the mean of the moves around them.
 */
static void ease(MesoVec2 *moves, MesoVec2 *sums, float *shares, const Bending *b)
{
    const MesoChart *chart = b->chart;
    for (int round = 0; round < EASINGS; round++) {
        bool eased = false;
        for (uint32_t v = 0; v < chart->vertex_count; v++) {
            sums[v] = (MesoVec2){0, 0};
            shares[v] = -1;         /* it stays */
        }
        for (uint32_t t = 0; t < b->count; t++) {
            const uint32_t *v = &chart->corners[3 * (size_t)t];
            if (keeps_area(b, moves, moves[v[0]], 1, t))
                continue;
            eased = true;
            shares[v[0]] = shares[v[1]] = shares[v[2]] = 0;
        }
        if (!eased)
            return;
        for (uint32_t h = 0; h < 3 * b->count; h++) {
            uint32_t v = chart->corners[h];
            if (shares[v] < 0)
                continue;
            MesoVec2 p = moves[chart->corners[meso_next_corner(h)]];
            MesoVec2 q = moves[chart->corners[meso_next_corner(meso_next_corner(h))]];
            sums[v] = meso_vec2_add(sums[v], meso_vec2_add(p, q));
            shares[v] += 2;
        }
        for (uint32_t v = 0; v < chart->vertex_count; v++)
            if (shares[v] > 0)
                moves[v] = meso_vec2_scale(sums[v], 1 / shares[v]);
    }
}

static void move(const Bending *b, const MesoVec2 *moves)
{
    float share = 1;
    MesoVec2 mean = moves[b->chart->corners[0]];
    for (int i = 0; i < HALVINGS && !keeps_areas(b, moves, mean, share); i++)
        share = i + 1 < HALVINGS ? 0.5f * share : 0;
    for (uint32_t v = 0; v < b->chart->vertex_count; v++) {
        MesoVec2 bend = meso_vec2_scale(meso_vec2_sub(moves[v], mean), share);
        b->vertices[v] = meso_vec2_add(b->vertices[v], meso_vec2_add(mean, bend));
    }
}

MesoStatus meso_phase_plane(MesoVec2 *places, MesoArena *scratch, const MesoChart *chart,
                            const uint32_t *chart_triangles, const MesoStripePhases *phases, const MesoVec3 *guides,
                            float angle, float scale, MesoError *error)
{
    size_t size = 2 * (size_t)chart->triangle_count;
    MesoArenaMark mark = meso_arena_mark(scratch);
    Bending b = {.vertices = places, .chart = chart, .chart_triangles = chart_triangles,
                 .phases = phases, .unit = 1 / (double)scale, .count = chart->triangle_count,
                 .quarters = MESO_NEW(scratch, uint32_t, chart->triangle_count, error),
                 .middles = MESO_NEW(scratch, MesoVec2, chart->triangle_count, error),
                 .areas = MESO_NEW(scratch, double, chart->triangle_count, error),
                 .sides = MESO_NEW(scratch, Side, 3 * (size_t)chart->triangle_count, error),
                 .places = MESO_NEW(scratch, double, size, error), .left = MESO_NEW(scratch, double, size, error),
                 .way = MESO_NEW(scratch, double, size, error), .pull = MESO_NEW(scratch, double, size, error),
                 .weights = MESO_NEW(scratch, double, size, error)};
    MesoVec2 *moves = MESO_NEW(scratch, MesoVec2, chart->vertex_count, error);
    MesoVec2 *sums = MESO_NEW(scratch, MesoVec2, chart->vertex_count, error);
    float *shares = MESO_NEW(scratch, float, chart->vertex_count, error);
    if (!b.quarters || !b.middles || !b.areas || !b.sides || !b.places || !b.left || !b.way || !b.pull ||
        !b.weights || !moves || !sums || !shares)
        return MESO_ERR_MEMORY;
    look(&b, guides, angle);
    list_sides(&b);
    solve(&b);
    settle(&b);
    find_moves(moves, shares, &b);
    ease(moves, sums, shares, &b);
    move(&b, moves);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
