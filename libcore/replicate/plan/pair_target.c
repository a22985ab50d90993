#include "libcore/replicate/plan/pair_target.h"

#include <float.h>
#include <stdlib.h>

#include "libcore/base/random.h"
#include "libcore/replicate/plan/detail_cells.h"
#include "libcore/replicate/plan/surface_foot.h"
#include "libcore/replicate/statistics/pair_correlation.h"
#include "libcore/replicate/web/web_edit.h"

enum { BINS = MESO_TARGET_BINS, SAMPLE = 4096, COPIES = 12, NEAREST = MESO_ORIGINAL_NEAR };

/* Places that are tried for a birth; of few details more, so many for all of them together. */
enum { TRIED = 12, TRIED_LEAST = 64, TRIED_MOST = 160, TRIED_FOR_ALL = 32000 };

/* Share of them that lie beside the best of the others, and from how far on, in mean spacings. */
static const double BESIDE = 0.4, BESIDE_REACH = 0.4;

/* Distances are counted up to so many mean spacings. */
static const double REACH = 4;

/* Of pairs nearer than half a spacing, over those of details strewn freely: groups. */
static const double GROUPED = 1.5;

/* A share of details that may have others nearer than the core; and what it costs that one is. Births come so near. */
static const double IN_CORE = 0.005, WALL = 1000, BIRTH_CORE = 0.92;

/* What it costs that edges are not as at rest, beside pairs; and how far a birth can change them, at most. */
static const double EDGE_COST = 8, SPREAD_COST = 1, MOST_EXCESS = 4, MOST_SPREAD = 8;

/* Of edges that are as good as all alike, what else would be a deviation that cannot be. */
static const double LEAST_VARIANCE = 0.01;

/* Of what stands beside what is copied: how unlike it may be, beside distances. */
static const double UNLIKE = 0.5;

/* What it costs that an original dies. */
static const double ORIGINAL_LAST = 1e9;

/* ---- at rest ---- */

static double ring_area(double radius, uint32_t bin)
{
    double width = radius / BINS;
    return MESO_PI * width * width * (2 * bin + 1);
}

/*
 * Share of what is around a point, at a distance, that lies beyond the border, in the mean, for that distance: of a set
 * of any shape, for distances that are short beside it ("Stochastic Geometry and its Applications", Stoyan 1987).
 */
static double border_share(const MesoTriangulation *mesh)
{
    double area = meso_surface_area(mesh, mesh->positions), length = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX)
            length += (double)meso_vec3_length(meso_vec3_sub(mesh->positions[mesh->corners[meso_next_corner(h)]],
                                                             mesh->positions[mesh->corners[h]]));
    return area > 0 ? length / (MESO_PI * area) : 0;
}

/* Of what is around it, of which at most half is beyond: more is not told by that. */
static double inner_share(double border_share, double distance)
{
    return fmax(0.5, 1 - border_share * distance);
}

/* Of the pairs at rest, beside those of details strewn freely: whether there are groups. */
static void know_pattern(MesoPairTarget *target, double density)
{
    double near = 0, free_near = 0;
    for (uint32_t b = 0; b < BINS; b++) {
        double expected = ring_area(target->radius, b) * density;
        target->weights.of[b] = 1 / expected;
        near += b < BINS / (2 * REACH) ? target->rest.of[b] : 0;
        free_near += b < BINS / (2 * REACH) ? expected : 0;
    }
    target->grouped = near > GROUPED * free_near;
}

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* From some of the details. */
static MesoStatus know_core(MesoPairTarget *target, MesoReplication *r, const MesoDetailCells *cells, MesoError *error)
{
    uint32_t stride = 1 + r->detail_count / SAMPLE, count = 0;
    float *nearest2 = MESO_NEW(&r->scratch, float, SAMPLE, error);
    if (!nearest2)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < r->detail_count; i += stride) {
        MesoVicinity v;
        uint32_t node = r->web.fixed_count + i;
        meso_cells_look(&v, cells, r->web.positions[node], r->web.normals[node], i);
        nearest2[count++] = v.near[0];
    }
    qsort(nearest2, count, sizeof *nearest2, by_size);
    float core2 = count ? nearest2[(uint32_t)(IN_CORE * count)] : 0;
    target->core2 = core2 < INFINITY ? (double)core2 : 0;
    return MESO_OK;
}

MesoStatus meso_pair_target_build(MesoPairTarget *target, MesoReplication *r, MesoError *error)
{
    double area = 0;
    uint32_t counted;
    for (uint32_t t = 0; t < r->rest->triangle_count; t++)
        area += (double)r->rest_areas[t];
    *target = (MesoPairTarget){.radius = REACH * sqrt(area / (r->detail_count ? r->detail_count : 1)),
                               .edges = meso_edge_rest(&r->web), .border_share = border_share(r->rest)};
    if (!(target->radius > 0 && target->radius < (double)FLT_MAX))
        return MESO_OK;
    MesoDetailCells cells;
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = meso_cells_build(&cells, r, target->radius, 0, error);
    if (status == MESO_OK)
        target->rest = meso_cells_mean(&cells, 1 + r->detail_count / (2 * SAMPLE), NULL, &counted);
    if (status == MESO_OK)
        status = know_core(target, r, &cells, error);
    meso_arena_rewind(&r->scratch, mark);
    know_pattern(target, r->detail_count / area);
    return status;
}

/* ---- what is wanted ---- */

typedef struct Bearing {
    MesoReplication *r;
    MesoDetailCells cells;
    MesoRandom random;
    MesoPairCounts wanted;      /* a birth's, or a death's */
    MesoEdgeBalance edges_wanted;
    double sums[BINS + 1];      /* of what is wanted, where it is */
    uint32_t *begin, *members;  /* details that live, by block */
} Bearing;

static double share(Bearing *b)
{
    return (double)(meso_random_next(&b->random) >> 11) * 0x1p-53;
}

/* By which differences of deviation are told. */
static double variance_of(const MesoPairTarget *target)
{
    return fmax(target->edges.variance, LEAST_VARIANCE);
}

static double within(double x, double most)
{
    return fmin(most, fmax(-most, x));
}

/*
 * What births, or deaths, have to bring, so that all together are as at rest then; no more than they can. Less than 0:
 * so many deaths. Where there are more than are due, and none dies, how they lie says nothing of births.
 */
static MesoStatus know_wanted(Bearing *b, double births, MesoError *error)
{
    MesoReplication *r = b->r;
    const MesoPairTarget *target = &r->pairs;
    uint32_t fixed = r->web.fixed_count, counted;
    uint8_t *left_out = births > 0 ? MESO_NEW(&r->scratch, uint8_t, r->web.node_count, error) : NULL;
    if (births > 0 && !left_out)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < r->detail_count && left_out; i++)
        left_out[fixed + i] = r->due[r->blocks[i]] <= -MESO_SURPLUS;
    MesoPairCounts now = meso_cells_mean(&b->cells, 1 + r->detail_count / SAMPLE, left_out ? left_out + fixed : NULL,
                                         &counted);
    double before = r->detail_count < SAMPLE ? counted : b->begin[r->block_count];
    double beyond = border_share(&r->now);
    for (uint32_t i = 0; i < BINS; i++) {
        double distance = (i + 0.5) * target->radius / BINS;
        double inner = inner_share(beyond, distance) / inner_share(target->border_share, distance);
        double rest = inner * target->rest.of[i], most = 2 * rest + 0.5;
        double wanted = (rest * (before + births) - now.of[i] * before) / (2 * births);
        b->wanted.of[i] = fmin(rest + most, fmax(rest - most, wanted));
        b->sums[i + 1] = b->sums[i] + fmax(0, b->wanted.of[i]);
    }
    MesoEdgeBalance edges = meso_edge_balance(&r->web, &target->edges, left_out);
    b->edges_wanted = (MesoEdgeBalance){within(-edges.excess / fabs(births), MOST_EXCESS),
                                        within(-edges.spread / fabs(births), MOST_SPREAD * variance_of(target))};
    return MESO_OK;
}

static MesoStatus sort_members(Bearing *b, MesoError *error)
{
    MesoReplication *r = b->r;
    b->begin = MESO_NEW(&r->scratch, uint32_t, (size_t)r->block_count + 2, error);
    b->members = MESO_NEW(&r->scratch, uint32_t, r->detail_count, error);
    if (!b->begin || !b->members)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < r->detail_count; i++)
        b->begin[r->blocks[i] + 2] += meso_lives(r, i);
    for (uint32_t k = 2; k < r->block_count + 2; k++)
        b->begin[k] += b->begin[k - 1];
    for (uint32_t i = 0; i < r->detail_count; i++)
        if (meso_lives(r, i))
            b->members[b->begin[r->blocks[i] + 1]++] = i;
    return MESO_OK;
}

/* `sign`: 1 of a birth, -1 of a death. */
static double cost_of(const Bearing *b, const MesoVicinity *around, double sign)
{
    const MesoPairTarget *target = &b->r->pairs;
    double cost = 0, core2 = sign > 0 ? BIRTH_CORE * BIRTH_CORE * target->core2 : target->core2;
    for (uint32_t i = 0; i < BINS; i++) {
        double left = target->debt.of[i] + sign * (b->wanted.of[i] - around->counts.of[i]);
        cost += target->weights.of[i] * left * left;
    }
    for (uint32_t k = 0; k < NEAREST; k++)
        cost += (double)around->near[k] < core2 ? sign * WALL : 0;
    return cost;
}

static double edge_cost_of(const Bearing *b, const MesoEdgeBalance *change)
{
    const MesoPairTarget *target = &b->r->pairs;
    double excess = target->edge_debt.excess + b->edges_wanted.excess - change->excess;
    double spread = (target->edge_debt.spread + b->edges_wanted.spread - change->spread) / variance_of(target);
    return EDGE_COST * excess * excess + SPREAD_COST * spread * spread;
}

/* What is left over of what was wanted goes on to the next birth, or death. */
static void owe(Bearing *b, const MesoPairCounts *counts, const MesoEdgeBalance *change, double sign)
{
    MesoPairTarget *target = &b->r->pairs;
    MesoEdgeBalance *edges = &target->edge_debt;
    for (uint32_t i = 0; i < BINS; i++)
        target->debt.of[i] = within(target->debt.of[i] + sign * (b->wanted.of[i] - counts->of[i]),
                                    4 * target->rest.of[i] + 4);
    edges->excess = within(edges->excess + b->edges_wanted.excess - change->excess, 4 * MOST_EXCESS);
    edges->spread = within(edges->spread + b->edges_wanted.spread - change->spread,
                           4 * MOST_SPREAD * variance_of(target));
}

/* ---- places ---- */

/* In a triangle beside a detail. */
static MesoVec3 place_inside(Bearing *b, uint32_t detail)
{
    const MesoWeb *web = &b->r->web;
    uint32_t node = web->fixed_count + detail, turns = meso_random_below(&b->random, 8);
    MesoSpokes s = meso_spokes(web, node);
    for (uint32_t i = 0; i < turns; i++)
        if (!meso_spokes_next(web, &s))
            s = meso_spokes(web, node);
    const uint32_t *c = web->corners + 3 * (size_t)(s.now / 3);
    double u = share(b), v = share(b);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    MesoVec3 p = meso_vec3_scale(web->positions[c[0]], (float)(1 - u - v));
    p = meso_vec3_mad(p, (float)u, web->positions[c[1]]);
    return meso_vec3_mad(p, (float)v, web->positions[c[2]]);
}

/* In any direction. */
static MesoVec3 place_around(Bearing *b, MesoVec3 from, MesoVec3 n, double distance)
{
    double angle = 2 * MESO_PI * share(b);
    MesoVec3 axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(axis, n), axis), y = meso_vec3_cross(n, x);
    return meso_vec3_mad(meso_vec3_mad(from, (float)(distance * cos(angle)), x), (float)(distance * sin(angle)), y);
}

/* The middle of the circle around a triangle, and its squared radius; 0 where that is none. */
static double circle_around(const MesoWeb *web, uint32_t triangle, MesoVec3 *middle)
{
    const uint32_t *c = web->corners + 3 * (size_t)triangle;
    MesoVec3 a = web->positions[c[0]];
    MesoVec3 u = meso_vec3_sub(web->positions[c[1]], a), v = meso_vec3_sub(web->positions[c[2]], a);
    double uu = meso_vec3_dot(u, u), vv = meso_vec3_dot(v, v), uv = meso_vec3_dot(u, v), det = uu * vv - uv * uv;
    *middle = a;
    if (!(det > 1e-6 * uu * vv))
        return 0;
    float s = (float)(vv * (uu - uv) / (2 * det)), t = (float)(uu * (vv - uv) / (2 * det));
    MesoVec3 from = meso_vec3_mad(meso_vec3_scale(u, s), t, v);
    *middle = meso_vec3_add(a, from);
    return (double)meso_vec3_dot(from, from);
}

/* In the widest circle beside a detail, which is empty, as far from what is on it as others are from each other. */
static MesoVec3 place_in_gap(Bearing *b, uint32_t detail)
{
    const MesoWeb *web = &b->r->web;
    MesoSpokes s = meso_spokes(web, web->fixed_count + detail);
    MesoVec3 best = web->positions[web->fixed_count + detail], middle;
    double widest2 = 0;
    do {
        double radius2 = circle_around(web, s.now / 3, &middle);
        if (radius2 > widest2) {
            widest2 = radius2;
            best = middle;
        }
    } while (meso_spokes_next(web, &s));
    double room = fmax(0, sqrt(widest2) - BIRTH_CORE * sqrt(b->r->pairs.core2));
    return place_around(b, best, web->normals[web->fixed_count + detail], room * sqrt(share(b)));
}

/* Of which there are too few. */
static double wanted_distance(Bearing *b)
{
    double at = share(b) * b->sums[BINS];
    uint32_t bin = 0;
    while (bin + 1 < BINS && b->sums[bin + 1] <= at)
        bin++;
    return (bin + share(b)) * b->r->pairs.radius / BINS;
}

/* ---- births ---- */

/* A place for a birth, and what it would bring. */
typedef struct Choice {
    MesoVec3 place, normal;
    uint32_t beside;            /* detail */
    uint32_t triangle;          /* of the web */
    MesoVicinity around;
    double cost;
} Choice;

/* From a place to its foot in a triangle, which is nearer to the surface. */
static void go_down(Choice *tried, const MesoWeb *web)
{
    const uint32_t *c = web->corners + 3 * (size_t)tried->triangle;
    MesoVec3 a = web->positions[c[0]];
    MesoVec3 u = meso_vec3_sub(web->positions[c[1]], a), v = meso_vec3_sub(web->positions[c[2]], a);
    MesoVec3 n = meso_vec3_unit(meso_vec3_cross(u, v), (MesoVec3){0, 0, 0});
    tried->place = meso_vec3_mad(tried->place, -meso_vec3_dot(meso_vec3_sub(tried->place, a), n), n);
    MesoVec3 sum = meso_vec3_add(meso_vec3_add(web->normals[c[0]], web->normals[c[1]]), web->normals[c[2]]);
    tried->normal = meso_vec3_unit(sum, tried->normal);
}

/* Not beyond a border: there many places would have the same foot. */
static void try_place(const Bearing *b, Choice *best, uint32_t beside, uint32_t from, MesoVec3 place, MesoVec3 normal)
{
    const MesoPairTarget *target = &b->r->pairs;
    const MesoWeb *web = &b->r->web;
    Choice tried = {.place = place, .normal = normal, .beside = beside};
    bool beyond;
    double nearest2;
    tried.triangle = meso_web_triangle(web, from, place, &beyond);
    if (beyond && best->cost < INFINITY)
        return;
    go_down(&tried, web);
    MesoEdgeBalance change = meso_edge_balance_with(web, &target->edges, tried.triangle, tried.place, tried.normal,
                                                    &nearest2);
    tried.cost = edge_cost_of(b, &change);
    if (tried.cost + (nearest2 < BIRTH_CORE * BIRTH_CORE * target->core2 ? WALL : 0) >= best->cost)
        return;
    meso_cells_look(&tried.around, &b->cells, tried.place, tried.normal, MESO_NO_INDEX);
    tried.cost += cost_of(b, &tried.around, 1);
    if (tried.cost < best->cost)
        *best = tried;
}

static uint32_t tries_for(const Bearing *b)
{
    uint32_t living = b->begin[b->r->block_count], each = TRIED_FOR_ALL / (living ? living : 1);
    uint32_t few = each < TRIED_LEAST ? TRIED_LEAST : each > TRIED_MOST ? TRIED_MOST : each;
    return living > 2 * MESO_FEW_DETAILS ? TRIED : few;
}

static Choice choose_place(Bearing *b, const uint32_t *members, uint32_t count)
{
    MesoReplication *r = b->r;
    const MesoVec3 *normals = r->web.normals + r->web.fixed_count;
    const MesoVec3 *places = r->web.positions + r->web.fixed_count;
    uint32_t first = r->web.fixed_count + members[0];
    Choice best = {.place = places[members[0]], .normal = normals[members[0]], .beside = members[0],
                   .triangle = r->web.node_corner[first] / 3, .around = {.nearest = members[0]}, .cost = INFINITY};
    uint32_t tries = tries_for(b), last = (uint32_t)(BESIDE * tries);
    for (uint32_t n = 0; n < tries - last; n++) {
        uint32_t beside = members[meso_random_below(&b->random, count)];
        MesoVec3 place = n % 3 == 0 ? place_inside(b, beside) : n % 3 == 1 ? place_in_gap(b, beside)
                         : place_around(b, places[beside], normals[beside], wanted_distance(b));
        try_place(b, &best, beside, r->web.node_corner[r->web.fixed_count + beside] / 3, place, normals[beside]);
    }
    for (uint32_t n = last; n > 0; n--) {
        double distance = BESIDE_REACH * r->pairs.radius / REACH * n / last;
        try_place(b, &best, best.beside, best.triangle, place_around(b, best.place, best.normal, distance),
                  best.normal);
    }
    return best;
}

/* Of what stands nearest to an original, and of what would to what is copied from it. */
static double unlike_beside(const MesoReplication *r, const MesoOriginal *as, uint32_t nearest)
{
    if (as->nearest == MESO_NO_INDEX || nearest == MESO_NO_INDEX)
        return 0;
    const MesoOriginal *there = &r->exemplars.originals[as->nearest];
    const MesoOriginal *here = &r->exemplars.originals[r->details[nearest].copied];
    return (there->kind != here->kind) + fabs((double)there->log_size - (double)here->log_size);
}

/* Of some originals the one whose nearest are about as near, and alike: so what stands alone is as what does so. */
static uint32_t copied_at(Bearing *b, const MesoVicinity *v)
{
    const MesoReplication *r = b->r;
    uint32_t best = v->nearest == MESO_NO_INDEX ? 0 : r->details[v->nearest].copied;
    double least = INFINITY;
    for (uint32_t n = 0; n < COPIES; n++) {
        uint32_t i = meso_random_below(&b->random, r->options.original_count);
        const MesoOriginal *as = &r->exemplars.originals[i];
        double sum = MESO_COPY_COST * r->copies[i] + UNLIKE * unlike_beside(r, as, v->nearest);
        for (uint32_t k = 0; k < NEAREST; k++) {
            if (!(as->near[k] > 0 && as->near[k] < INFINITY && v->near[k] < INFINITY))
                continue;
            double unlike = log(fmax(sqrt((double)v->near[k]) / (double)as->near[k], 1e-3));
            sum += unlike * unlike;
        }
        if (sum < least) {
            least = sum;
            best = i;
        }
    }
    return best;
}

static MesoStatus bear_one(Bearing *b, uint32_t block, int32_t frame, MesoError *error)
{
    MesoReplication *r = b->r;
    MesoVicinity v;
    double nearest2;
    Choice best = choose_place(b, b->members + b->begin[block], b->begin[block + 1] - b->begin[block]);
    MesoBirth birth = {copied_at(b, &best.around), best.place, best.beside, block};
    MesoEdgeBalance change = meso_edge_balance_with(&r->web, &r->pairs.edges, best.triangle, best.place, best.normal,
                                                    &nearest2);
    MesoStatus status = meso_give_birth(r, best.triangle, &birth, frame, error);
    if (status != MESO_OK)
        return status;
    uint32_t born = r->detail_count - 1, node = r->web.fixed_count + born;
    meso_cells_look(&v, &b->cells, r->web.positions[node], r->web.normals[node], born);
    meso_cells_put(&b->cells, born, r->web.positions[node], r->web.normals[node]);
    owe(b, &v.counts, &change, 1);
    return MESO_OK;
}

/* In each block one, and so on until none is due: so none is behind others. */
static MesoStatus bear_all(Bearing *b, int32_t frame, MesoError *error)
{
    MesoReplication *r = b->r;
    for (bool any = true; any;) {
        any = false;
        for (uint32_t block = 0; block < r->block_count; block++) {
            if (r->due[block] < 0.5 || b->begin[block + 1] == b->begin[block])
                continue;
            MesoStatus status = bear_one(b, block, frame, error);
            if (status != MESO_OK)
                return status;
            any = true;
        }
    }
    return MESO_OK;
}

static MesoStatus prepare(Bearing *b, MesoReplication *r, double births, uint64_t stream, MesoError *error)
{
    *b = (Bearing){.r = r};
    r->pairs.debt = (MesoPairCounts){{0}};      /* what is left over is seen in the next step */
    r->pairs.edge_debt = (MesoEdgeBalance){0, 0};
    meso_random_init(&b->random, r->options.seed, 16 + 2 * (uint64_t)r->step_count + stream);
    MesoStatus status = meso_cells_build(&b->cells, r, r->pairs.radius, births > 0 ? (uint32_t)births : 0, error);
    if (status == MESO_OK)
        status = sort_members(b, error);
    if (status == MESO_OK)
        status = know_wanted(b, births, error);
    return status;
}

MesoStatus meso_bear_by_pairs(MesoReplication *r, uint32_t due, int32_t frame, MesoError *error)
{
    Bearing b;
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = prepare(&b, r, due, 0, error);
    if (status == MESO_OK)
        status = bear_all(&b, frame, error);
    meso_arena_rewind(&r->scratch, mark);
    return status;
}

/* ---- deaths ---- */

static bool let_die(Bearing *b, uint32_t detail, int32_t frame)
{
    MesoReplication *r = b->r;
    uint32_t node = r->web.fixed_count + detail;
    MesoVicinity v;
    MesoEdgeBalance change = meso_edge_balance_without(&r->web, &r->pairs.edges, node);
    if (!meso_let_die(r, detail, frame))
        return false;
    meso_cells_take(&b->cells, detail, r->web.positions[node]);
    meso_cells_look(&v, &b->cells, r->web.positions[node], r->web.normals[node], detail);
    owe(b, &v.counts, &change, -1);
    return true;
}

/* Of all of a block, or of some that are drawn. False where none could be taken out. */
static bool let_one_die(Bearing *b, uint32_t block, bool all, int32_t frame)
{
    MesoReplication *r = b->r;
    uint32_t first = b->begin[block], count = b->begin[block + 1] - first, best = MESO_NO_INDEX;
    double least = INFINITY;
    MesoVicinity v;
    for (uint32_t n = 0; n < (all ? count : TRIED); n++) {
        uint32_t detail = b->members[first + (all ? n : meso_random_below(&b->random, count))];
        uint32_t node = r->web.fixed_count + detail;
        if (!meso_lives(r, detail))
            continue;
        meso_cells_look(&v, &b->cells, r->web.positions[node], r->web.normals[node], detail);
        MesoEdgeBalance change = meso_edge_balance_without(&r->web, &r->pairs.edges, node);
        /* copies before originals: what has come with a stretch goes with it */
        double cost = cost_of(b, &v, -1) + edge_cost_of(b, &change)
                      + (detail < r->options.original_count ? ORIGINAL_LAST : 0);
        if (best != MESO_NO_INDEX && !(cost < least))
            continue;
        least = cost;
        best = detail;
    }
    return best != MESO_NO_INDEX && let_die(b, best, frame);
}

MesoStatus meso_thin_by_pairs(MesoReplication *r, uint32_t due, int32_t frame, MesoError *error)
{
    Bearing b;
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    MesoStatus status = prepare(&b, r, -(double)due, 1, error);
    bool few = status == MESO_OK && b.begin[r->block_count] <= MESO_FEW_DETAILS;
    for (uint32_t block = 0; block < r->block_count && status == MESO_OK; block++) {
        uint32_t left = b.begin[block + 1] - b.begin[block], misses = 0;
        while (r->due[block] <= -MESO_SURPLUS && left > 1 && misses < TRIED)
            if (let_one_die(&b, block, few && misses == 0, frame))
                left--;
            else
                misses++;
    }
    meso_arena_rewind(&r->scratch, mark);
    return status;
}
