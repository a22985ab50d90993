#include "libcore/replicate/plan/replicate.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/base/random.h"
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/replicate/plan/pair_target.h"
#include "libcore/replicate/plan/paper_rule.h"
#include "libcore/replicate/plan/replicate_work.h"
#include "libcore/replicate/plan/split_order.h"

enum { BLOCK = 48, RING = 32, PARTS = 8 };

/* Of more details, births by statistics take several times as long as by exemplars; and of more triangles it takes as
   long to look at all. */
enum { MANY = 1 << 15 };

/* What a birth may cost before a better place is looked for. */
static const double CROWDED = 1, CROWDED_OF_FEW = 0.2;

/* ---- beginning ---- */

static MesoStatus check_originals(const MesoReplicateOptions *options, MesoError *error)
{
    for (uint32_t i = 0; i < options->original_count; i++) {
        const MesoMeshPoint *p = &options->originals[i].point;
        float sum = p->weight[0] + p->weight[1] + p->weight[2];
        bool inside = p->weight[0] >= 0 && p->weight[1] >= 0 && p->weight[2] >= 0 && fabsf(sum - 1) < 1e-3f;
        if (p->triangle >= options->clip->rest->triangle_count || !inside)
            return meso_fail(error, MESO_ERR_INPUT, "detail %u has no place on the surface", i);
    }
    return MESO_OK;
}

typedef struct Ticket {
    uint64_t number;
    uint32_t detail;
} Ticket;

static int by_ticket(const void *a, const void *b)
{
    const Ticket *x = a, *y = b;
    if (x->number != y->number)
        return x->number < y->number ? -1 : 1;
    return x->detail < y->detail ? -1 : x->detail > y->detail;
}

/* Which give way first where the surface shrinks, chance decides: so groups stay groups. */
static MesoStatus rank_originals(MesoReplication *r, MesoArena *arena, MesoError *error)
{
    Ticket *tickets = MESO_NEW(arena, Ticket, r->detail_count, error);
    if (!tickets)
        return MESO_ERR_MEMORY;
    MesoRandom random;
    meso_random_init(&random, r->options.seed, 7);
    for (uint32_t i = 0; i < r->detail_count; i++)
        tickets[i] = (Ticket){meso_random_next(&random), i};
    qsort(tickets, r->detail_count, sizeof *tickets, by_ticket);
    for (uint32_t i = 0; i < r->detail_count; i++)
        r->details[tickets[i].detail].rank = i;
    return MESO_OK;
}

static MesoStatus take_originals(MesoReplication *r, MesoError *error)
{
    uint32_t n = r->detail_count = r->detail_room = r->options.original_count;
    r->details = MESO_NEW(&r->arena, MesoDetail, n, error);
    r->blocks = MESO_NEW(&r->arena, uint32_t, n, error);
    r->areas = MESO_NEW(&r->arena, float, n, error);
    r->near_begin = MESO_NEW(&r->arena, uint32_t, (size_t)n + 1, error);
    r->grown = MESO_NEW(&r->arena, float, n, error);
    r->fates = MESO_NEW(&r->arena, MesoDetailFate, n, error);
    r->copies = MESO_NEW(&r->arena, uint32_t, n, error);
    MesoMeshPoint *points = MESO_NEW(&r->arena, MesoMeshPoint, n, error);
    if (!r->details || !r->blocks || !r->areas || !r->near_begin || !r->grown || !r->fates || !r->copies
        || !points)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++) {
        r->details[i] = r->options.originals[i];
        r->details[i].copied = i;
        r->details[i].radius = INFINITY;
        r->details[i].born = MESO_DETAIL_ORIGINAL;
        r->grown[i] = 1;
        r->fates[i] = (MesoDetailFate){MESO_DETAIL_LIVES, MESO_NO_INDEX};
        points[i] = r->details[i].point;
    }
    MesoStatus status = rank_originals(r, &r->arena, error);
    if (status == MESO_OK)
        status = meso_web_build(&r->web, &r->arena, r->rest, r->normals, points, n, error);
    return status;
}

/* A block beside some details of one; that itself where there is none. */
static uint32_t block_beside(const MesoReplication *r, const uint32_t *members, uint32_t count)
{
    uint32_t ring[RING], own = r->blocks[members[0]];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t around = meso_web_ring(&r->web, r->web.fixed_count + members[i], ring, RING);
        for (uint32_t k = 0; k < around && k < RING; k++)
            if (ring[k] >= r->web.fixed_count && r->blocks[ring[k] - r->web.fixed_count] != own)
                return r->blocks[ring[k] - r->web.fixed_count];
    }
    return own;
}

/* From a detail on, of those that have none; returns how many `members` [BLOCK] there are. */
static uint32_t grow_block(MesoReplication *r, uint32_t first, uint32_t *members)
{
    uint32_t begin = 0, end = 0, ring[RING];
    members[end++] = first;
    r->blocks[first] = r->block_count;
    while (begin < end) {
        uint32_t count = meso_web_ring(&r->web, r->web.fixed_count + members[begin++], ring, RING);
        for (uint32_t k = 0; k < count && k < RING && end < BLOCK; k++) {
            uint32_t other = ring[k] - r->web.fixed_count;
            if (ring[k] < r->web.fixed_count || r->blocks[other] != MESO_NO_INDEX)
                continue;
            r->blocks[other] = r->block_count;
            members[end++] = other;
        }
    }
    return end;
}

/* Parts of the web of about BLOCK details; what is left between them is part of one beside it. */
static MesoStatus make_blocks(MesoReplication *r, MesoError *error)
{
    uint32_t members[BLOCK];
    for (uint32_t i = 0; i < r->detail_count; i++)
        r->blocks[i] = MESO_NO_INDEX;
    for (uint32_t i = 0; i < r->detail_count; i++) {
        if (r->blocks[i] != MESO_NO_INDEX)
            continue;
        uint32_t count = grow_block(r, i, members);
        uint32_t block = count < BLOCK / 2 ? block_beside(r, members, count) : r->block_count;
        for (uint32_t k = 0; k < count; k++)
            r->blocks[members[k]] = block;
        r->block_count += block == r->block_count;
    }
    r->due = MESO_NEW(&r->arena, double, r->block_count, error);
    return r->due ? MESO_OK : MESO_ERR_MEMORY;
}

static float area_now(const MesoTriangulation *mesh, const MesoVec3 *positions, uint32_t triangle)
{
    const uint32_t *c = mesh->corners + 3 * (size_t)triangle;
    MesoVec3 u = meso_vec3_sub(positions[c[1]], positions[c[0]]), v = meso_vec3_sub(positions[c[2]], positions[c[0]]);
    return 0.5f * meso_vec3_length(meso_vec3_cross(u, v));
}

/* Pairs do not tell directions apart. */
static bool are_few_and_round(const MesoReplication *r)
{
    bool so = r->detail_count <= MANY;
    for (uint32_t i = 0; i < r->detail_count && so; i++)
        so = meso_detail_aspect(&r->details[i]) == 1;
    return so;
}

static MesoStatus begin(MesoReplication *r, MesoError *error)
{
    r->rest = r->options.clip->rest;
    r->now = *r->rest;
    r->normals = MESO_NEW(&r->arena, MesoVec3, r->rest->vertex_count, error);
    r->rest_areas = MESO_NEW(&r->arena, float, r->rest->triangle_count, error);
    if (!r->normals || !r->rest_areas)
        return MESO_ERR_MEMORY;
    meso_vertex_normals(r->normals, r->rest);
    for (uint32_t t = 0; t < r->rest->triangle_count; t++)
        r->rest_areas[t] = area_now(r->rest, r->rest->positions, t);
    MesoStatus status = take_originals(r, error);
    if (status == MESO_OK)
        status = meso_exemplars_build(&r->exemplars, &r->arena, r->rest, &r->web, r->details, r->options.seed, error);
    for (uint32_t i = 0; i < r->detail_count && status == MESO_OK; i++)
        r->areas[i] = r->exemplars.originals[i].area;
    if (status == MESO_OK)
        status = meso_tolerance_build(&r->tolerance, r, error);
    if (status == MESO_OK)
        status = make_blocks(r, error);
    if (status == MESO_OK)
        status = meso_pair_target_build(&r->pairs, r, error);
    if (status == MESO_OK && r->options.mode == MESO_REPLICATE_PLAN && !r->pairs.grouped)
        status = meso_rank_by_crowd(r, error);
    if (status == MESO_OK)
        status = meso_find_above(r, error);
    r->by_pairs = r->options.births == MESO_BIRTHS_STATISTICS
                  || (r->options.births == MESO_BIRTHS_USUAL && (r->pairs.grouped || are_few_and_round(r)));
    if (status != MESO_OK || r->options.mode != MESO_REPLICATE_PAPER)
        return status;
    r->paper = MESO_NEW(&r->arena, MesoPaperRule, 1, error);
    return r->paper ? meso_paper_build(r->paper, r, error) : MESO_ERR_MEMORY;
}

static void take_default(double *value, double usual)
{
    *value = *value > 0 ? *value : usual;
}

static void take_defaults(MesoReplicateOptions *options)
{
    take_default(&options->ramp, 0.06);
    take_default(&options->alpha, 1.1);
    take_default(&options->beta, 0.9);
    take_default(&options->gamma, 0.1);
    take_default(&options->mu, 0.1);
    options->gamma = fmin(options->gamma, 0.5);
    options->substeps = options->substeps ? options->substeps : 1;
}

MesoStatus meso_replicate_begin(MesoReplication **out, const MesoReplicateOptions *options, MesoError *error)
{
    MesoStatus status = check_originals(options, error);
    if (status != MESO_OK)
        return status;
    MesoReplication *r = *out = calloc(1, sizeof *r);
    if (!r)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu bytes", sizeof *r);
    meso_arena_init(&r->arena);
    meso_arena_init(&r->scratch);
    r->options = *options;
    r->last_frame = -1;
    take_defaults(&r->options);
    status = begin(r, error);
    if (status != MESO_OK) {
        meso_replicate_release(r);
        *out = NULL;
    }
    return status;
}

void meso_replicate_release(MesoReplication *r)
{
    if (!r)
        return;
    meso_arena_release(&r->arena);
    meso_arena_release(&r->scratch);
    free(r);
}

const MesoDetail *meso_replicate_details(const MesoReplication *r, uint32_t *count)
{
    *count = r->detail_count;
    return r->details;
}

const float *meso_replicate_grown(const MesoReplication *r)
{
    return r->grown;
}

const MesoDetailFate *meso_replicate_fates(const MesoReplication *r)
{
    return r->fates;
}

size_t meso_replicate_bytes(const MesoReplication *r)
{
    return r->arena.used + r->scratch.used;
}

const MesoWeb *meso_replicate_web(const MesoReplication *r)
{
    return &r->web;
}

/* ---- births and deaths of a step ---- */

/* Details due by the stretch of the surface at each original, less those there are. Returns how many will be born. */
static double count_due(MesoReplication *r)
{
    double all = 0;
    for (uint32_t b = 0; b < r->block_count; b++)
        r->due[b] = meso_phase_of(b);
    for (uint32_t i = 0; i < r->detail_count; i++) {
        double due = meso_lives(r, i) ? -1 : 0;
        uint32_t t = r->details[i].point.triangle;
        if (r->details[i].born == MESO_DETAIL_ORIGINAL)
            due += r->rest_areas[t] > 0 ? (double)(area_now(r->rest, r->now.positions, t) / r->rest_areas[t]) : 1;
        r->due[r->blocks[i]] += due;
    }
    for (uint32_t b = 0; b < r->block_count; b++)
        all += fmax(0, floor(r->due[b] + 0.5));
    return all;
}

/* Triangles that had no good place, and the births of a step. */
typedef struct Bearing {
    MesoSplitOrder order;
    int32_t frame;
    uint32_t late_count, late_room;
    uint32_t *late;         /* [late_count] */
} Bearing;

/* As far as its corners are from the place that is farthest from them all: nearer than there is anything at rest. */
static bool is_narrow(const MesoReplication *r, uint32_t triangle)
{
    const uint32_t *c = r->web.corners + 3 * (size_t)triangle;
    double a2 = meso_web_length2(&r->web, c[0], c[1]), b2 = meso_web_length2(&r->web, c[1], c[2]);
    double c2 = meso_web_length2(&r->web, c[2], c[0]);
    return r->detail_count >= MESO_FEW_DETAILS
           && a2 * b2 * c2 < r->tolerance.edges.least2 * meso_heron(a2, b2, c2);
}

static MesoStatus split(Bearing *b, uint32_t triangle, double most, bool *done, MesoError *error)
{
    MesoReplication *r = b->order.r;
    MesoBirth births[MESO_EXEMPLAR_INSIDE];
    uint32_t block = meso_block_of(r, triangle);
    uint32_t limit = (uint32_t)fmin(r->due[block] + 0.5, MESO_EXEMPLAR_INSIDE);
    double cost;
    *done = most == INFINITY || !is_narrow(r, triangle);
    uint32_t count = *done ? meso_choose_births(r, triangle, limit, births, &cost) : 0;
    *done = *done && cost <= most;
    for (uint32_t i = 0; i < count && *done; i++) {
        births[i].block = block;
        MesoStatus status = meso_give_birth(r, triangle, &births[i], b->frame, error);
        if (status != MESO_OK)
            return status;
        uint32_t node = r->web.node_count - 1, h = r->web.node_corner[node], first = h;
        do {    /* the details that are joined to it: their triangles are new */
            meso_split_push(&b->order, h / 3);
            h = r->web.twins[meso_previous_corner(h)];
        } while (h != first && h != MESO_NO_INDEX);
    }
    return MESO_OK;
}

/* What is born where it stands too near to others is born when there is no better place in its block. */
static MesoStatus bear(Bearing *b, MesoError *error)
{
    MesoReplication *r = b->order.r;
    double most = r->detail_count < MESO_FEW_DETAILS ? CROWDED_OF_FEW : CROWDED;
    uint32_t triangle;
    bool done;
    while (meso_split_pop(&b->order, &triangle)) {
        MesoStatus status = split(b, triangle, most, &done, error);
        if (status == MESO_OK && !done) {
            b->late = MESO_GROW(&r->scratch, b->late, b->late_count, b->late_room, 256, error);
            if (!b->late)
                return MESO_ERR_MEMORY;
            b->late[b->late_count++] = triangle;
        }
        if (status != MESO_OK)
            return status;
    }
    for (uint32_t i = 0; i < b->late_count; i++) {
        if (r->due[meso_block_of(r, b->late[i])] < 0.5)
            continue;
        MesoStatus status = split(b, b->late[i], INFINITY, &done, error);
        if (status != MESO_OK)
            return status;
    }
    return MESO_OK;
}

static MesoStatus replicate(MesoReplication *r, int32_t frame, MesoError *error)
{
    double due = count_due(r);
    MesoStatus status = r->options.mode == MESO_REPLICATE_LIVE ? meso_thin_out(r, frame, error) : MESO_OK;
    if (due < 0.5 || status != MESO_OK)
        return status;
    if (!(r->detail_count + due < MESO_REPLICA_MOST))
        return meso_fail(error, MESO_ERR_LIMIT, "frame %d: too many details are due: %g", frame,
                         r->detail_count + due);
    if (r->by_pairs)
        return meso_bear_by_pairs(r, (uint32_t)due, frame, error);
    Bearing b = {.frame = frame};
    MesoArenaMark mark = meso_arena_mark(&r->scratch);
    meso_tolerance_adapt(&r->tolerance, &r->web);
    status = meso_split_order(&b.order, &r->scratch, r, (uint32_t)due, error);
    if (status == MESO_OK)
        status = bear(&b, error);
    meso_arena_rewind(&r->scratch, mark);
    return status;
}

/* ---- a step ---- */

/*
 * Each step looks at a part of the triangles. Where of those more than a few were no longer Delaunay it looks at all; or
 * of many, at part after part, while they are so.
 */
static void settle(MesoReplication *r)
{
    uint32_t first = r->step_count++, many = r->web.triangle_count / PARTS / 32;
    uint32_t flips = meso_web_settle(&r->web, first % PARTS, PARTS);
    if (flips > many && r->web.triangle_count < MANY)
        meso_web_settle(&r->web, 0, 1);
    for (uint32_t part = 1; part < PARTS && flips > many && r->web.triangle_count >= MANY; part++)
        flips = meso_web_settle(&r->web, (first + part) % PARTS, PARTS);
}

static void grow(MesoReplication *r)
{
    float most = (float)(r->options.mu * r->passing);
    for (uint32_t i = 0; i < r->detail_count; i++)
        r->grown[i] = meso_lives(r, i) ? fminf(1, r->grown[i] + most) : fmaxf(0, r->grown[i] - most);
}

static MesoStatus step_to(MesoReplication *r, const MesoVec3 *positions, int32_t frame, MesoError *error)
{
    r->now.positions = (MesoVec3 *)(uintptr_t)positions;    /* read alone */
    meso_vertex_normals(r->normals, &r->now);
    meso_web_place(&r->web, r->rest, positions, r->normals, r->options.thread_count);
    settle(r);
    grow(r);
    return r->paper ? meso_paper_step(r, frame, error) : replicate(r, frame, error);
}

/* ---- a frame ---- */

static MesoStatus positions_of(const MesoReplication *r, uint32_t frame, const MesoVec3 **positions, MesoError *error)
{
    const MesoClip *clip = r->options.clip;
    const MesoVec3 *p = *positions = clip->positions(clip->context, frame, error);
    if (!p)
        return error ? error->status : MESO_ERR_INPUT;
    for (uint32_t v = 0; v < r->rest->vertex_count; v++)
        if (!isfinite(p[v].x) || !isfinite(p[v].y) || !isfinite(p[v].z))
            return meso_fail(error, MESO_ERR_INPUT, "frame %u: vertex %u has no place", frame, v);
    return MESO_OK;
}

/* The last frame: kept, or that of a state that has been gone on from. */
static MesoStatus know_before(MesoReplication *r, MesoError *error)
{
    const MesoVec3 *positions;
    if (r->options.substeps == 1 || r->before)
        return MESO_OK;
    MesoVec3 *before = MESO_NEW(&r->arena, MesoVec3, r->rest->vertex_count, error);
    r->between = MESO_NEW(&r->arena, MesoVec3, r->rest->vertex_count, error);
    if (!before || !r->between)
        return MESO_ERR_MEMORY;
    if (r->last_frame >= 0) {
        MesoStatus status = positions_of(r, (uint32_t)r->last_frame, &positions, error);
        if (status != MESO_OK)
            return status;
        memcpy(before, positions, r->rest->vertex_count * sizeof *before);
    }
    r->before = before;
    return MESO_OK;
}

static MesoStatus step_between(MesoReplication *r, const MesoVec3 *positions, double share, int32_t frame,
                               MesoError *error)
{
    for (uint32_t v = 0; v < r->rest->vertex_count; v++)
        r->between[v] = meso_vec3_mad(meso_vec3_scale(r->before[v], (float)(1 - share)), (float)share, positions[v]);
    return step_to(r, r->between, frame, error);
}

MesoStatus meso_replicate_step(MesoReplication *r, uint32_t frame, MesoError *error)
{
    const MesoVec3 *positions;
    uint32_t substeps = r->last_frame < 0 ? 1 : r->options.substeps;
    MesoStatus status = know_before(r, error);
    if (status == MESO_OK)
        status = positions_of(r, frame, &positions, error);
    if (status != MESO_OK)
        return status;
    r->passing = r->last_frame < 0 ? 0 : fabs((double)frame - (double)r->last_frame) / substeps;
    for (uint32_t s = 1; s < substeps && status == MESO_OK; s++)
        status = step_between(r, positions, (double)s / substeps, (int32_t)frame, error);
    if (status == MESO_OK)
        status = step_to(r, positions, (int32_t)frame, error);
    if (r->before)
        memcpy(r->before, positions, r->rest->vertex_count * sizeof *r->before);
    r->last_frame = frame;
    return status;
}
