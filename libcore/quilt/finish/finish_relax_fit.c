/* Moves of rings, by turns of the swatch at each of them and one system for all. */
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_relax_work.h"

/* Rings that are off by a larger share of their distance, or of that length, are meant to be elsewhere. */
#define FAR 0.6f

/* What holds rings where they are, against all that moves them. */
#define HOLD 1e-3

/*
 * Rounds of fitting, the first of them without guesses; of each so many conjugate gradients at most, and the error that
 * is small against the first.
 */
enum { FITS = 4, SURE_FITS = 2, STEPS = 20 };
#define SMALL 1e-3

/* Nothing moves where no ring is off by that share of the swatch's shorter side. */
#define MISS_LEAST 1e-4

/* From one node to another, as they have moved. */
static MesoVec3 way_between(const MesoRelaxing *r, uint32_t from, uint32_t to)
{
    const double *a = &r->moves[3 * (size_t)from], *b = &r->moves[3 * (size_t)to];
    MesoVec3 apart = meso_vec3_sub(r->nodes[to].foot, r->nodes[from].foot);
    return meso_vec3_add(apart, (MesoVec3){(float)(b[0] - a[0]), (float)(b[1] - a[1]), (float)(b[2] - a[2])});
}

/* How the swatch is turned at each node: as suits its pairs best. */
static void fit_range(void *context, uint64_t begin, uint64_t end)
{
    const MesoRelaxing *r = context;
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        double cosine = 0, sine = 0;
        for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++) {
            const MesoRelaxPair *pair = &r->pairs[k];
            MesoVec3 way = way_between(r, i, pair->to);
            double x = (double)meso_vec3_dot(way, r->nodes[i].x), y = (double)meso_vec3_dot(way, r->nodes[i].y);
            cosine += (double)pair->weight * (x * (double)pair->x + y * (double)pair->y);
            sine += (double)pair->weight * (y * (double)pair->x - x * (double)pair->y);
        }
        double length = sqrt(cosine * cosine + sine * sine);
        r->cosines[i] = length > 0 ? cosine / length : 1;
        r->sines[i] = length > 0 ? sine / length : 0;
    }
}

static void by_nodes(const MesoRelaxing *r, void (*range)(void *, uint64_t, uint64_t), void *context)
{
    meso_parallel_for(r->thread_count, r->node_count, MESO_RELAX_BLOCK, range, context);
}

static void fit_turns(MesoRelaxing *r)
{
    by_nodes(r, fit_range, r);
}

/* What is missing on the way of a pair as nodes were at first, along the surface as it is between both. */
static MesoVec3 miss_of(const MesoRelaxing *r, uint32_t from, const MesoRelaxPair *pair)
{
    const MesoRelaxNode *a = &r->nodes[from], *b = &r->nodes[pair->to];
    MesoVec3 wanted = meso_relax_turned(r, from, pair->x, pair->y);
    MesoVec3 normal = meso_vec3_direction(meso_vec3_add(a->normal, b->normal), a->normal);
    MesoVec3 flat = meso_relax_along(wanted, normal);
    wanted = meso_vec3_scale(meso_vec3_direction(flat, wanted), meso_vec3_length(wanted));
    return meso_vec3_sub(wanted, meso_relax_along(meso_vec3_sub(b->foot, a->foot), normal));
}

/* Pairs that are too far off are given up; false where all is as it should be. */
static bool judge_pairs(MesoRelaxing *r)
{
    bool any = false;
    for (uint32_t i = 0; i < r->node_count; i++)
        for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++) {
            MesoRelaxPair *pair = &r->pairs[k];
            float miss = meso_vec3_length(miss_of(r, i, pair));
            any |= miss > MISS_LEAST * r->side;
            if (!(miss < FAR * (meso_vec2_length((MesoVec2){pair->x, pair->y}) + MESO_RELAX_SOFT * r->side)))
                pair->weight = 0;
        }
    return any;
}

/* Guesses weigh half, as each holds one of two directions. */
static void sum_weights(MesoRelaxing *r)
{
    memset(r->weights, 0, r->node_count * sizeof *r->weights);
    for (uint32_t i = 0; i < r->node_count; i++)
        for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++) {
            r->weights[i] += (double)r->pairs[k].weight;
            r->weights[r->pairs[k].to] += (double)r->pairs[k].weight;
        }
    for (uint32_t g = 0; g < r->guess_count; g++) {
        r->weights[r->guesses[g].from] += 0.5 * (double)r->guesses[g].pair.weight;
        r->weights[r->guesses[g].pair.to] += 0.5 * (double)r->guesses[g].pair.weight;
    }
}

/* Of conjugate gradients, scaled by the diagonal: [3 * node_count] each. */
typedef struct Gradients {
    double *left, *scaled, *way, *pull;
    MesoVec3 *misses;           /* [the most pairs of a batch of nodes] */
} Gradients;

typedef struct Product {
    const MesoRelaxing *r;
    const double *p;
    double *pull;
} Product;

static void add_into(double pull[3], const MesoRelaxInto *into, const double *all, const double *p)
{
    const double *q = &all[3 * (size_t)into->from];
    for (size_t c = 0; c < 3; c++)
        pull[c] -= (double)into->weight * (q[c] - p[c]);
}

/* All pairs of each node in the order of their numbers, whoever has them. */
static void pull_range(void *context, uint64_t begin, uint64_t end)
{
    const Product *product = context;
    const MesoRelaxing *r = product->r;
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        const double *p = &product->p[3 * (size_t)i];
        double pull[3] = {HOLD * r->weights[i] * p[0], HOLD * r->weights[i] * p[1], HOLD * r->weights[i] * p[2]};
        const MesoRelaxInto *into = &r->into[r->into_begin[i]], *into_end = &r->into[r->into_begin[i + 1]];
        for (; into < into_end && into->from < i; into++)
            add_into(pull, into, product->p, p);
        for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++) {
            const double *q = &product->p[3 * (size_t)r->pairs[k].to];
            for (size_t c = 0; c < 3; c++)
                pull[c] += (double)r->pairs[k].weight * (p[c] - q[c]);
        }
        for (; into < into_end; into++)
            add_into(pull, into, product->p, p);
        memcpy(&product->pull[3 * (size_t)i], pull, sizeof pull);
    }
}

/* pull = (L + hold) p, L the graph's Laplacian by the weights of pairs. */
static void apply(double *pull, const double *p, const MesoRelaxing *r)
{
    by_nodes(r, pull_range, &(Product){r, p, pull});
    for (uint32_t g = 0; g < r->guess_count; g++) {
        const MesoRelaxGuess *guess = &r->guesses[g];
        const double *a = &p[3 * (size_t)guess->from], *b = &p[3 * (size_t)guess->pair.to];
        const double n[3] = {(double)guess->across.x, (double)guess->across.y, (double)guess->across.z};
        double part = (double)guess->pair.weight * ((a[0] - b[0]) * n[0] + (a[1] - b[1]) * n[1] + (a[2] - b[2]) * n[2]);
        for (size_t c = 0; c < 3; c++) {
            pull[3 * (size_t)guess->from + c] += part * n[c];
            pull[3 * (size_t)guess->pair.to + c] -= part * n[c];
        }
    }
}

static void add_left(Gradients *g, uint32_t from, const MesoRelaxPair *pair, MesoVec3 miss)
{
    const float parts[3] = {miss.x, miss.y, miss.z};
    for (size_t c = 0; c < 3; c++) {
        double part = (double)(pair->weight * parts[c]);
        g->left[3 * (size_t)pair->to + c] += part;
        g->left[3 * (size_t)from + c] -= part;
    }
}

/* What pairs miss, of nodes from `first` on. */
typedef struct Misses {
    const MesoRelaxing *r;
    uint32_t first;
    MesoVec3 *of;               /* [pairs of these] */
} Misses;

static void miss_range(void *context, uint64_t begin, uint64_t end)
{
    const Misses *m = context;
    const MesoRelaxing *r = m->r;
    for (uint32_t i = m->first + (uint32_t)begin; i < m->first + (uint32_t)end; i++)
        for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++)
            m->of[k - r->begin[m->first]] = miss_of(r, i, &r->pairs[k]);
}

/* What pulls at nodes where they are. */
static void find_left(Gradients *g, const MesoRelaxing *r)
{
    size_t size = 3 * (size_t)r->node_count;
    apply(g->pull, r->moves, r);
    for (size_t i = 0; i < size; i++)
        g->left[i] = -g->pull[i];
    Misses misses = {r, 0, g->misses};
    for (; misses.first < r->node_count; misses.first += MESO_RELAX_BATCH) {
        uint32_t rest = r->node_count - misses.first, count = rest < MESO_RELAX_BATCH ? rest : MESO_RELAX_BATCH;
        meso_parallel_for(r->thread_count, count, MESO_RELAX_BLOCK, miss_range, &misses);
        for (uint32_t i = misses.first; i < misses.first + count; i++)
            for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++)
                add_left(g, i, &r->pairs[k], misses.of[k - r->begin[misses.first]]);
    }
    for (uint32_t k = 0; k < r->guess_count; k++) {
        const MesoRelaxGuess *guess = &r->guesses[k];
        MesoVec3 miss = miss_of(r, guess->from, &guess->pair);
        add_left(g, guess->from, &guess->pair, meso_vec3_scale(guess->across, meso_vec3_dot(miss, guess->across)));
    }
}

static double product(const double *a, const double *b, size_t size)
{
    double sum = 0;
    for (size_t i = 0; i < size; i++)
        sum += a[i] * b[i];
    return sum;
}

static void solve(MesoRelaxing *r, Gradients *g)
{
    size_t size = 3 * (size_t)r->node_count;
    double before = 0, first = 0;
    find_left(g, r);
    for (int step = 0; step < STEPS; step++) {
        for (size_t i = 0; i < size; i++)
            g->scaled[i] = r->weights[i / 3] > 0 ? g->left[i] / r->weights[i / 3] : 0;
        double now = product(g->left, g->scaled, size);
        first = step ? first : now;
        if (!(now > SMALL * SMALL * first))
            break;
        for (size_t i = 0; i < size; i++)
            g->way[i] = g->scaled[i] + (step ? now / before * g->way[i] : 0);
        apply(g->pull, g->way, r);
        double share = now / product(g->way, g->pull, size);
        for (size_t i = 0; i < size; i++) {
            r->moves[i] += share * g->way[i];
            g->left[i] -= share * g->pull[i];
        }
        before = now;
    }
}

/* The most pairs of a batch of nodes. */
static uint32_t most_pairs(const MesoRelaxing *r)
{
    uint32_t most = 0;
    for (uint32_t first = 0; first < r->node_count; first += MESO_RELAX_BATCH) {
        uint32_t rest = r->node_count - first, end = first + (rest < MESO_RELAX_BATCH ? rest : MESO_RELAX_BATCH);
        most = r->begin[end] - r->begin[first] > most ? r->begin[end] - r->begin[first] : most;
    }
    return most;
}

/* Pairs by the node that they lead to, once they have been judged. */
static MesoStatus turn_pairs(MesoRelaxing *r, MesoError *error)
{
    uint32_t count = r->begin[r->node_count];
    r->into_begin = MESO_NEW(r->arena, uint32_t, (size_t)r->node_count + 2, error);
    r->into = MESO_NEW(r->arena, MesoRelaxInto, count, error);
    if (!r->into_begin || !r->into)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < count; k++)
        r->into_begin[r->pairs[k].to + 2]++;
    for (uint32_t i = 0; i < r->node_count; i++)
        r->into_begin[i + 2] += r->into_begin[i + 1];
    for (uint32_t i = 0; i < r->node_count; i++)
        for (uint32_t k = r->begin[i]; k < r->begin[i + 1]; k++)
            r->into[r->into_begin[r->pairs[k].to + 1]++] = (MesoRelaxInto){i, r->pairs[k].weight};
    return MESO_OK;
}

MesoStatus meso_relax_fit(bool *any, MesoRelaxing *r, bool may_move, MesoError *error)
{
    size_t size = 3 * (size_t)r->node_count;
    r->cosines = MESO_NEW(r->arena, double, r->node_count, error);
    r->sines = MESO_NEW(r->arena, double, r->node_count, error);
    r->weights = MESO_NEW(r->arena, double, r->node_count, error);
    r->moves = MESO_NEW(r->arena, double, size, error);
    Gradients g = {MESO_NEW(r->arena, double, size, error), MESO_NEW(r->arena, double, size, error),
                   MESO_NEW(r->arena, double, size, error), MESO_NEW(r->arena, double, size, error),
                   MESO_NEW(r->arena, MesoVec3, most_pairs(r), error)};
    r->heads = MESO_NEW(r->arena, uint32_t, (size_t)r->mask + 1, error);
    r->next_in_cell = MESO_NEW(r->arena, uint32_t, r->node_count, error);
    if (!r->heads || !r->next_in_cell || !r->cosines || !r->sines || !r->weights || !r->moves || !g.left ||
        !g.scaled || !g.way || !g.pull || !g.misses)
        return MESO_ERR_MEMORY;
    fit_turns(r);
    *any = judge_pairs(r);
    MesoStatus status = may_move && *any ? turn_pairs(r, error) : MESO_OK;
    for (int i = 0; i < FITS && may_move && *any && !status; i++) {
        if (i >= SURE_FITS)
            status = meso_relax_guess(r, error);
        if (status)
            break;
        sum_weights(r);
        solve(r, &g);
        fit_turns(r);
    }
    return status;
}

