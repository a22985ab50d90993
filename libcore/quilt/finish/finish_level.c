/*
 * Strands brought back to the heights that the swatch has them at. Where patches meet, a strand is pulled up or down a
 * little; from patch to patch this adds up, until strands lie under the surface, or far above. What is off slowly along
 * a strand is taken away: with d the difference in height of a vertex from its origin's, the solution s of
 *
 *     (T + w L) s = T d,    L the graph's Laplacian,
 *
 * is d without what changes over few edges; heights lose s. Joins stay joined. T trusts vertices that the border has
 * made less: their origins only lie next to them. Whole elements between strands come back to their heights as a whole.
 */
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_work.h"

/*
 * What is kept changes over less than this share of the swatch's shorter side, in mean edges within these bounds: joins
 * need a few edges, and strands that are off their heights for longer are what one sees, and what others run into.
 */
#define REACH 0.045
#define EDGES_LEAST 2
#define EDGES_MOST 24

/* Trust in vertices that the border has made. */
#define TRUST_LEAST 1e-3

/* Of conjugate gradients: steps at most, and the error that is small against heights. */
enum { STEPS = 60, BLOCK = 8192 };
#define SMALL 3e-3

typedef struct Level {
    uint32_t count;
    const uint32_t *begin;      /* [count + 1] into `near` */
    const uint32_t *near;       /* vertices beside each, one for each half-edge from it */
    const uint8_t *at_border;   /* [count] */
    double weight;
} Level;

/* Conjugate gradients, scaled by the diagonal. */
typedef struct Gradients {
    const Level *level;
    double *s, *d;              /* the solution so far, and what is left of the right side */
    double *p, *q;
    double alpha, beta;
    double *sums[2];            /* [blocks] of a pass, so that sums do not depend on threads */
    uint32_t thread_count;
} Gradients;

static double trust_in(const Level *level, uint64_t v)
{
    return level->at_border[v] ? TRUST_LEAST : 1;
}

/* What is left at a vertex, scaled. */
static double scaled(const Gradients *g, uint64_t v)
{
    const Level *level = g->level;
    return g->d[v] / (trust_in(level, v) + level->weight * (level->begin[v + 1] - level->begin[v]));
}

/* The diagonal's share of what is left, and what is left itself. */
static void scale_range(void *context, uint64_t begin, uint64_t end)
{
    const Gradients *g = context;
    double along = 0, left = 0;
    for (uint64_t v = begin; v < end; v++) {
        along += g->d[v] * scaled(g, v);
        left += g->d[v] * g->d[v];
    }
    g->sums[0][begin / BLOCK] = along;
    g->sums[1][begin / BLOCK] = left;
}

static void turn_range(void *context, uint64_t begin, uint64_t end)
{
    Gradients *g = context;
    for (uint64_t v = begin; v < end; v++)
        g->p[v] = scaled(g, v) + g->beta * g->p[v];
}

/* q = T p + w L p */
static void apply_range(void *context, uint64_t begin, uint64_t end)
{
    Gradients *g = context;
    const Level *level = g->level;
    double along = 0;
    for (uint64_t v = begin; v < end; v++) {
        double sum = 0;
        for (uint32_t i = level->begin[v]; i < level->begin[v + 1]; i++)
            sum += g->p[v] - g->p[level->near[i]];
        g->q[v] = trust_in(level, v) * g->p[v] + level->weight * sum;
        along += g->p[v] * g->q[v];
    }
    g->sums[0][begin / BLOCK] = along;
}

static void move_range(void *context, uint64_t begin, uint64_t end)
{
    Gradients *g = context;
    for (uint64_t v = begin; v < end; v++) {
        g->s[v] += g->alpha * g->p[v];
        g->d[v] -= g->alpha * g->q[v];
    }
}

static void pass(Gradients *g, void (*range)(void *, uint64_t, uint64_t))
{
    meso_parallel_for(g->thread_count, g->level->count, BLOCK, range, g);
}

static double total(const Gradients *g, int which)
{
    double sum = 0;
    for (uint32_t block = 0; block * BLOCK < g->level->count; block++)
        sum += g->sums[which][block];
    return sum;
}

/* `d` becomes what is left of it. */
static MesoStatus solve(double *s, double *d, const Level *level, const MesoFinishWork *work, MesoError *error)
{
    uint32_t n = level->count, blocks = n / BLOCK + 1;
    MesoArena *arena = work->arena;
    Gradients g = {.level = level, .s = s, .d = d,
                   .p = MESO_NEW(arena, double, n, error), .q = MESO_NEW(arena, double, n, error),
                   .sums = {MESO_NEW(arena, double, blocks, error), MESO_NEW(arena, double, blocks, error)},
                   .thread_count = work->options->thread_count};
    if (!g.p || !g.q || !g.sums[0] || !g.sums[1])
        return MESO_ERR_MEMORY;
    double before = 0, first = 0;
    for (int step = 0; step < STEPS; step++) {
        pass(&g, scale_range);
        double now = total(&g, 0), left = total(&g, 1);
        first = step ? first : left;
        if (left <= SMALL * SMALL * first)
            break;
        g.beta = step ? now / before : 0;
        pass(&g, turn_range);
        pass(&g, apply_range);
        g.alpha = now / total(&g, 0);
        pass(&g, move_range);
        before = now;
    }
    return MESO_OK;
}

/* ---- strands ---- */

static bool is_strand(const MesoFinishWork *work, const MesoQuilt *quilt, uint32_t triangle)
{
    return work->swatch->kinds[quilt->element_origins[work->elements[triangle]]] == MESO_ELEMENT_STRAND;
}

/* Vertices beside each vertex of strands. */
static MesoStatus connect(Level *level, const MesoQuilt *quilt, const MesoFinishWork *work, MesoError *error)
{
    uint32_t *begin = MESO_NEW(work->arena, uint32_t, (size_t)work->vertex_count + 2, error);
    uint32_t *near = NULL;
    if (!begin)
        return MESO_ERR_MEMORY;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t c = 0; c < 3 * work->triangle_count; c++) {
            uint32_t from = work->corners[c], to = work->corners[c % 3 == 2 ? c - 2 : c + 1];
            if (!is_strand(work, quilt, c / 3))
                continue;
            if (pass)
                near[begin[from + 1]++] = to;
            else
                begin[from + 2]++;
        }
        for (uint32_t v = 0; v < work->vertex_count && !pass; v++)
            begin[v + 2] += begin[v + 1];
        if (!pass && !(near = MESO_NEW(work->arena, uint32_t, begin[work->vertex_count + 1], error)))
            return MESO_ERR_MEMORY;
    }
    level->count = work->vertex_count;
    level->begin = begin;
    level->near = near;
    return MESO_OK;
}

/* How far a vertex is from the height of its origin. */
static double rise_of(const MesoFinishWork *work, uint32_t v)
{
    const MesoFinishOptions *options = work->options;
    double scale = options->height_scale > 0 ? options->height_scale : options->scale;
    return work->vertices[v].height - options->offset - scale * work->swatch->positions[work->origins[v]].z;
}

/* T d, of vertices of strands. */
static void find_differences(double *d, const Level *level, const MesoFinishWork *work)
{
    for (uint32_t v = 0; v < work->vertex_count; v++)
        if (level->begin[v + 1] > level->begin[v])
            d[v] = trust_in(level, v) * rise_of(work, v);
}

static MesoStatus level_strands(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    Level level = {.at_border = work->at_border};
    double *d = MESO_NEW(work->arena, double, work->vertex_count, error);
    double *s = MESO_NEW(work->arena, double, work->vertex_count, error);
    if (!d || !s)
        return MESO_ERR_MEMORY;
    double edges = REACH * fmin(swatch->size.x, swatch->size.y) / swatch->mean_edge;
    edges = fmin(fmax(edges, EDGES_LEAST), EDGES_MOST);
    level.weight = 0.5 * edges * edges;
    MesoStatus status = connect(&level, quilt, work, error);
    if (status)
        return status;
    find_differences(d, &level, work);
    status = solve(s, d, &level, work, error);
    for (uint32_t v = 0; v < work->vertex_count && !status; v++)
        work->vertices[v].height -= (float)s[v];
    return status;
}

/* ---- whole elements ---- */

static MesoStatus level_wholes(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error)
{
    uint32_t *element_of = MESO_NEW(work->arena, uint32_t, work->vertex_count, error);
    uint32_t *counts = MESO_NEW(work->arena, uint32_t, quilt->element_count, error);
    double *rises = MESO_NEW(work->arena, double, quilt->element_count, error);
    if (!element_of || !counts || !rises)
        return MESO_ERR_MEMORY;
    memset(element_of, 0xff, work->vertex_count * sizeof *element_of);
    for (uint32_t c = 0; c < 3 * work->triangle_count; c++)
        if (!is_strand(work, quilt, c / 3))
            element_of[work->corners[c]] = work->elements[c / 3];
    for (uint32_t v = 0; v < work->vertex_count; v++)
        if (element_of[v] != MESO_NO_INDEX) {
            rises[element_of[v]] += rise_of(work, v);
            counts[element_of[v]]++;
        }
    for (uint32_t v = 0; v < work->vertex_count; v++)
        if (element_of[v] != MESO_NO_INDEX)
            work->vertices[v].height -= (float)(rises[element_of[v]] / counts[element_of[v]]);
    return MESO_OK;
}

MesoStatus meso_finish_level(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->arena);
    MesoStatus status = work->levelled ? MESO_OK : level_strands(work, quilt, error);
    if (!status)
        status = level_wholes(work, quilt, error);
    meso_arena_rewind(work->arena, mark);
    return status;
}
