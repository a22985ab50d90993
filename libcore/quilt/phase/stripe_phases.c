#include "libcore/quilt/phase/stripe_phases.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/team.h"

/*
 * Waves of one height are smoothed and made even again, so often, held the less the more often ("Diffusion generated
 * motion", Merriman, Bence and Osher 1992, for angles): each time by so many conjugate gradients at most, and until the
 * error is small against the first. What is found already is held more from the beginning, and less often.
 */
static const double HOLDS[] = {1e-4, 1e-3, 0.01, 0.05};
enum { ROUNDS = 8, GRADIENTS = 300, SURE_HOLD = 2, FEWER_ROUNDS = 4 };
#define SMALL 1e-2

/* What a triangle without area is held by, as a share of the mean. */
#define LEAST 1e-3

/*
 * Guides are turned to where stripes run, so often, and stripes found anew: by means of the angles over some triangles
 * around, and by no more than that in all. A guide that is off by a makes phases rotate by -a / 2 alone, the other half
 * being stretch, and so it is turned by somewhat less than twice of what they rotate. Triangles whose neighbours are in
 * line tell nothing; and where phases are off by more than that, turning does not make them fit, and is left out.
 */
enum { TURNINGS = 2, SWEEPS = 6 };
#define TURNING_STRAIN_MOST 0.12
#define FURTHER 1.8
#define FLAT_LEAST 1e-3

/* Triangles of a loop's range. */
enum { RANGE = 1024 };

/* Parts of two waves after quarter turns: where each comes from, and its sign. */
static const uint32_t SOURCES[4][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {0, 1, 2, 3}, {2, 3, 0, 1}};
static const double SIGNS[4][4] = {{1, 1, 1, 1}, {1, 1, 1, -1}, {1, -1, 1, -1}, {1, -1, 1, 1}};

void meso_stripe_turn_waves(double to[4], const double from[4], uint32_t quarters)
{
    for (int c = 0; c < 4; c++)
        to[c] = SIGNS[quarters][c] * from[SOURCES[quarters][c]];
}

void meso_stripe_turn_ways(double to[2], const double from[2], uint32_t quarters)
{
    static const double turns[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const double c = turns[quarters][0], s = turns[quarters][1];
    to[0] = c * from[0] + s * from[1];
    to[1] = c * from[1] - s * from[0];
}

static MesoVec3 centroid(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 sum = meso_vec3_add(meso_vec3_add(mesh->positions[v[0]], mesh->positions[v[1]]), mesh->positions[v[2]]);
    return meso_vec3_scale(sum, 1.0f / 3);
}

MesoStripeStep meso_stripe_step(const MesoStripePhases *p, uint32_t half_edge, uint32_t across)
{
    const MesoTriangulation *mesh = p->mesh;
    uint32_t t = half_edge / 3, s = across / 3;
    MesoComplex here = meso_complex_times(meso_frame_turn(mesh, p->frames, half_edge, across), p->guides[t]);
    MesoComplex apart = meso_complex_times(here, meso_complex_conjugate(p->guides[s]));
    int64_t unit = 4 / p->turn_count, turn = llround(atan2(apart.im, apart.re) / (0.5 * MESO_PI * (double)unit));
    MesoStripeStep step = {.quarters = (uint32_t)(((turn * unit) % 4 + 4) % 4)};
    MesoVec3 middle = meso_vec3_lerp(mesh->positions[mesh->corners[half_edge]],
                                     mesh->positions[mesh->corners[meso_next_corner(half_edge)]], 0.5f);
    MesoComplex out = meso_frame_in(&p->frames[t], meso_vec3_sub(middle, centroid(mesh, t)));
    MesoComplex in = meso_frame_in(&p->frames[s], meso_vec3_sub(centroid(mesh, s), middle));
    out = meso_complex_times(out, meso_complex_conjugate(p->guides[t]));
    in = meso_complex_times(in, meso_complex_conjugate(p->guides[s]));
    double turned[2];
    meso_stripe_turn_ways(turned, (const double[2]){in.re, in.im}, step.quarters);
    step.ways[0] = out.re + turned[0];
    step.ways[1] = out.im + turned[1];
    return step;
}

/* Of a triangle s and one before it, t: |S z_s - e^(i w) z_t|^2 times a weight, S the quarter turns. */
typedef struct Side {
    uint32_t quarters;
    double cosines[2], sines[2];
} Side;

typedef double Two __attribute__((vector_size(16)));

/*
 * What a neighbour's waves are in a triangle, times the side's weight: of each part two by two numbers, those on the
 * diagonal and those beside it.
 */
typedef struct Link {
    Two straight[2], crossed[2];
    uint32_t from;          /* the neighbour; the triangle itself, and numbers 0, where there is none */
    uint32_t swapped;       /* 1 if the neighbour's part across is the part along */
} Link;

void meso_stripe_excess(double more[2], const MesoStripePhases *p, uint32_t half_edge, uint32_t across,
                        const MesoStripeStep *step)
{
    const double *here = p->waves[half_edge / 3];
    double there[4];
    meso_stripe_turn_waves(there, p->waves[across / 3], step->quarters);
    for (int k = 0; k < 2; k++) {
        double turn = 2 * MESO_PI / p->pitches[k], phase = atan2(there[2 * k + 1], there[2 * k]);
        phase -= atan2(here[2 * k + 1], here[2 * k]) + turn * step->ways[k];
        more[k] = remainder(phase, 2 * MESO_PI) / turn;
    }
}

/* Waves as numbers [4 * triangle_count], and what conjugate gradients are in need of. */
typedef struct System {
    const MesoStripePhases *phases;
    Link *links;            /* [3 * triangle_count] by half-edge */
    double *areas;          /* [triangle_count] of the mean, times the mean weight of a triangle's sides */
    double *sums;           /* [triangle_count] weights of sides */
    double *shares;         /* [triangle_count] 1 over the diagonal */
    double *left, *way, *pull;
    MesoTeam *team;
    size_t range_count;
    double *range_sums;     /* [range_count] */
    const double *from;     /* of loops that run: what apply() is to; */
    double *z, held, length, again;
} System;

static double side_weight(const MesoStripePhases *p, uint32_t half_edge, uint32_t across)
{
    const double thinnest = 1e-3;   /* of the side's square: the area that two triangles have at least */
    MesoVec3 a = p->mesh->positions[p->mesh->corners[half_edge]];
    MesoVec3 b = meso_vec3_sub(p->mesh->positions[p->mesh->corners[meso_next_corner(half_edge)]], a);
    double square = (double)meso_vec3_dot(b, b), area = p->frames[half_edge / 3].area + p->frames[across / 3].area;
    return square > 0 ? 1.5 * square / fmax(area, thinnest * square) : thinnest;
}

/* With waves z of t and s on both sides of a side, it pulls by w (Q s - R t): R carries t over, and Q turns s. */
static void link_both(Link *to_t, Link *to_s, const Side *side, double weight)
{
    const uint32_t back = (4 - side->quarters) % 4;
    for (int k = 0; k < 2; k++) {
        double c = weight * side->cosines[k], s = weight * side->sines[k];
        const double *signs = &SIGNS[side->quarters][2 * k];
        to_t->straight[k] = (Two){c * signs[0], c * signs[1]};
        to_t->crossed[k] = (Two){s * signs[1], -s * signs[0]};
        uint32_t from = SOURCES[back][2 * k] / 2;
        c = weight * side->cosines[from];
        s = weight * side->sines[from];
        signs = &SIGNS[back][2 * k];
        to_s->straight[k] = (Two){signs[0] * c, signs[1] * c};
        to_s->crossed[k] = (Two){-signs[0] * s, signs[1] * s};
    }
    to_t->swapped = to_s->swapped = side->quarters % 2;
}

/* Over a half-edge, from its triangle to the next. */
static Side side_over(const MesoStripePhases *p, uint32_t half_edge, uint32_t across)
{
    MesoStripeStep step = meso_stripe_step(p, half_edge, across);
    Side side = {.quarters = step.quarters};
    for (int k = 0; k < 2; k++) {
        double angle = 2 * MESO_PI * step.ways[k] / p->pitches[k];
        side.cosines[k] = cos(angle);
        side.sines[k] = sin(angle);
    }
    return side;
}

static void list_links(System *system)
{
    const MesoStripePhases *p = system->phases;
    for (uint32_t t = 0; t < p->mesh->triangle_count; t++)
        system->sums[t] = 0;
    for (uint32_t h = 0; h < 3 * p->mesh->triangle_count; h++) {
        uint32_t across = meso_frame_across(p->mesh, h);
        if (across == MESO_NO_INDEX)
            system->links[h] = (Link){.from = h / 3};
        if (across == MESO_NO_INDEX || across / 3 <= h / 3)
            continue;
        double weight = side_weight(p, h, across);
        Side side = side_over(p, h, across);
        system->links[h].from = across / 3;
        system->links[across].from = h / 3;
        link_both(&system->links[h], &system->links[across], &side, weight);
        system->sums[h / 3] += weight;
        system->sums[across / 3] += weight;
    }
}

/* Waves carried over a side. */
static void carry(double to[4], const double *from, const Side *side)
{
    for (int k = 0; k < 2; k++) {
        to[2 * k] = side->cosines[k] * from[2 * k] - side->sines[k] * from[2 * k + 1];
        to[2 * k + 1] = side->sines[k] * from[2 * k] + side->cosines[k] * from[2 * k + 1];
    }
}

/* ---- loops over triangles, by ranges that are the same for any number of threads ---- */

/* Of the ranges, in their order. */
static double sum_of(const System *system)
{
    double sum = 0;
    for (size_t i = 0; i < system->range_count; i++)
        sum += system->range_sums[i];
    return sum;
}

static void apply_range(void *context, uint64_t begin, uint64_t end)
{
    System *system = context;
    const Two *waves = (const Two *)(const void *)system->from;
    Two *to = (Two *)(void *)system->pull, along[2] = {{0, 0}, {0, 0}};
    for (uint64_t t = begin; t < end; t++) {
        double hold = system->sums[t] + system->held * system->areas[t];
        Two sum[2] = {hold * waves[2 * t], hold * waves[2 * t + 1]};
        for (const Link *link = &system->links[3 * t]; link < &system->links[3 * t + 3]; link++)
            for (uint32_t k = 0; k < 2; k++) {
                Two from = waves[2 * (size_t)link->from + (k ^ link->swapped)], turned = {from[1], from[0]};
                sum[k] -= link->straight[k] * from + link->crossed[k] * turned;
            }
        for (uint32_t k = 0; k < 2; k++) {
            along[k] += waves[2 * t + k] * sum[k];
            to[2 * t + k] = sum[k];
        }
    }
    along[0] += along[1];
    system->range_sums[begin / RANGE] = along[0][0] + along[0][1];
}

/* pull = (L + held M) z: what sides pull at waves, and what holds them. Returns z pull. */
static double apply(const double *z, System *system)
{
    system->from = z;
    meso_team_for(system->team, system->phases->mesh->triangle_count, RANGE, apply_range, system);
    return sum_of(system);
}

static void advance_range(void *context, uint64_t begin, uint64_t end)
{
    System *system = context;
    double now[4] = {0, 0, 0, 0};
    for (uint64_t t = begin; t < end; t++)
        for (uint64_t i = 4 * t, c = 0; c < 4; i++, c++) {
            system->z[i] += system->length * system->way[i];
            system->left[i] -= system->length * system->pull[i];
            now[c] += system->left[i] * system->left[i] * system->shares[t];
        }
    system->range_sums[begin / RANGE] = (now[0] + now[1]) + (now[2] + now[3]);
}

/* Goes by `length` along the way. Returns what is left, squared, over the diagonal. */
static double advance(double *z, System *system, double length)
{
    system->z = z;
    system->length = length;
    meso_team_for(system->team, system->phases->mesh->triangle_count, RANGE, advance_range, system);
    return sum_of(system);
}

static void turn_range(void *context, uint64_t begin, uint64_t end)
{
    System *system = context;
    for (uint64_t t = begin; t < end; t++)
        for (uint64_t i = 4 * t; i < 4 * t + 4; i++)
            system->way[i] = system->left[i] * system->shares[t] + system->again * system->way[i];
}

/* The next way: down what is left, and `again` of the last one. */
static void turn_way(System *system, double again)
{
    system->again = again;
    meso_team_for(system->team, system->phases->mesh->triangle_count, RANGE, turn_range, system);
}

/* Waves of one height: where they begin. */
static void make_even(double *z, size_t count)
{
    for (size_t i = 0; i < 2 * count; i++) {
        double height = sqrt(z[2 * i] * z[2 * i] + z[2 * i + 1] * z[2 * i + 1]);
        for (int c = 0; c < 2 && height > 0; c++)
            z[2 * i + (size_t)c] /= height;
    }
}

/* One step: (L + held M) z = held M z_even, by conjugate gradients from there. */
static void step(double *z, System *system, double held)
{
    size_t count = system->phases->mesh->triangle_count;
    make_even(z, count);
    system->held = held;
    apply(z, system);
    for (size_t t = 0; t < count; t++) {
        system->shares[t] = 1 / (system->sums[t] + held * system->areas[t]);
        for (size_t i = 4 * t; i < 4 * t + 4; i++) {
            system->left[i] = held * system->areas[t] * z[i] - system->pull[i];
            system->way[i] = 0;
        }
    }
    double first = advance(z, system, 0), now = first, again = 0;
    for (int round = 0; round < GRADIENTS && now > SMALL * SMALL * first; round++) {
        turn_way(system, again);
        double along = apply(system->way, system);
        if (!(along > 0))
            break;
        double next = advance(z, system, now / along);
        again = next / now;
        now = next;
    }
}

/* From triangle to triangle over sides, each part from its first one. */
static MesoStatus set_start(double *z, const System *system, MesoArena *scratch, MesoError *error)
{
    const MesoTriangulation *mesh = system->phases->mesh;
    uint32_t *queue = MESO_NEW(scratch, uint32_t, mesh->triangle_count, error);
    uint8_t *seen = MESO_NEW(scratch, uint8_t, mesh->triangle_count, error);
    if (!queue || !seen)
        return MESO_ERR_MEMORY;
    for (uint32_t first = 0; first < mesh->triangle_count; first++) {
        uint32_t count = 0;
        if (seen[first])
            continue;
        seen[first] = 1;
        queue[count++] = first;
        z[4 * (size_t)first] = z[4 * (size_t)first + 2] = 1;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t h = 3 * queue[i]; h < 3 * queue[i] + 3; h++) {
                uint32_t across = meso_frame_across(mesh, h);
                if (across == MESO_NO_INDEX || seen[across / 3])
                    continue;
                Side side = side_over(system->phases, h, across);
                double carried[4];
                carry(carried, &z[4 * (size_t)queue[i]], &side);
                meso_stripe_turn_waves(&z[4 * (size_t)(across / 3)], carried, (4 - side.quarters) % 4);
                seen[across / 3] = 1;
                queue[count++] = across / 3;
            }
    }
    return MESO_OK;
}

/* How far phases are from growing as they should, from triangle to triangle: of that, as a share, RMS. */
static double strain_of(const MesoStripePhases *p)
{
    double off = 0, all = 0;
    for (uint32_t h = 0; h < 3 * p->mesh->triangle_count; h++) {
        uint32_t across = meso_frame_across(p->mesh, h);
        if (across == MESO_NO_INDEX || across / 3 <= h / 3)
            continue;
        MesoStripeStep way = meso_stripe_step(p, h, across);
        double more[2];
        meso_stripe_excess(more, p, h, across, &way);
        off += more[0] * more[0] + more[1] * more[1];
        all += way.ways[0] * way.ways[0] + way.ways[1] * way.ways[1];
    }
    return all > 0 ? sqrt(off / all) : 0;
}

/* ---- guides turned ---- */

/* By how much stripes are turned in a triangle against its guide: half of what their phases rotate; by three sides. */
static double turn_at(const MesoStripePhases *p, uint32_t triangle)
{
    double a = 0, b = 0, d = 0, e[2][2] = {{0, 0}, {0, 0}};     /* sum of w w' and of more w', w ways */
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        uint32_t across = meso_frame_across(p->mesh, h);
        if (across == MESO_NO_INDEX)
            return 0;
        MesoStripeStep way = meso_stripe_step(p, h, across);
        double more[2];
        meso_stripe_excess(more, p, h, across, &way);
        a += way.ways[0] * way.ways[0];
        b += way.ways[0] * way.ways[1];
        d += way.ways[1] * way.ways[1];
        for (int i = 0; i < 2; i++)
            for (int k = 0; k < 2; k++)
                e[i][k] += more[i] * way.ways[k];
    }
    double determinant = a * d - b * b;
    if (!(determinant > FLAT_LEAST * (a + d) * (a + d)))
        return 0;
    /* of the gradient E = e (w w')^-1 that part which is a rotation */
    return 0.5 * ((e[0][1] * a - e[0][0] * b) - (e[1][0] * d - e[1][1] * b)) / determinant;
}

/* How sure phases are of themselves in a triangle: nothing where a stripe ends. */
static double surety(const MesoStripePhases *p, uint32_t triangle)
{
    const double *z = p->waves[triangle];
    return fmin(z[0] * z[0] + z[1] * z[1], z[2] * z[2] + z[3] * z[3]) * p->frames[triangle].area;
}

/* Turns guides to where stripes run, on the mean around each triangle, but by no more than is allowed in all. */
static MesoStatus turn_guides(MesoComplex *guides, double *turned, double most, const MesoStripePhases *p,
                              MesoArena *scratch, MesoError *error)
{
    const uint32_t count = p->mesh->triangle_count;
    MesoArenaMark mark = meso_arena_mark(scratch);
    double *turns = MESO_NEW(scratch, double, count, error), *sure = MESO_NEW(scratch, double, count, error);
    double *means = MESO_NEW(scratch, double, count, error);
    if (!turns || !sure || !means)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < count; t++) {
        turns[t] = turn_at(p, t);
        sure[t] = surety(p, t);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t t = 0; t < count; t++) {
            double sum = sure[t] * turns[t], all = sure[t];
            for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
                uint32_t across = meso_frame_across(p->mesh, h);
                sum += across == MESO_NO_INDEX ? 0 : sure[across / 3] * turns[across / 3];
                all += across == MESO_NO_INDEX ? 0 : sure[across / 3];
            }
            means[t] = all > 0 ? sum / all : 0;
        }
        double *next = turns;
        turns = means;
        means = next;
    }
    for (uint32_t t = 0; t < count; t++) {
        double turn = fmax(-most, fmin(most, turned[t] + FURTHER * turns[t])) - turned[t];
        turned[t] += turn;
        guides[t] = meso_complex_times(guides[t], (MesoComplex){cos(turn), sin(turn)});
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

static MesoStatus solve(MesoStripePhases *p, MesoComplex *guides, const MesoStripeOptions *options, MesoArena *scratch,
                        MesoError *error)
{
    const MesoTriangulation *mesh = p->mesh;
    size_t count = mesh->triangle_count;
    System system = {.phases = p, .links = MESO_NEW(scratch, Link, 3 * count, error),
                     .sums = MESO_NEW(scratch, double, count, error), .areas = MESO_NEW(scratch, double, count, error),
                     .shares = MESO_NEW(scratch, double, count, error),
                     .left = MESO_NEW(scratch, double, 4 * count, error),
                     .way = MESO_NEW(scratch, double, 4 * count, error),
                     .pull = MESO_NEW(scratch, double, 4 * count, error),
                     .range_count = (count + RANGE - 1) / RANGE};
    system.range_sums = MESO_NEW(scratch, double, system.range_count, error);
    if (!system.range_sums || !system.links || !system.sums || !system.areas || !system.shares || !system.left ||
        !system.way || !system.pull)
        return MESO_ERR_MEMORY;
    double *turned = MESO_NEW(scratch, double, count, error);
    if (!turned)
        return MESO_ERR_MEMORY;
    list_links(&system);
    double area = 0, weight = 0;
    for (size_t t = 0; t < count; t++) {
        area += p->frames[t].area;
        weight += system.sums[t];
    }
    for (size_t t = 0; t < count; t++)
        system.areas[t] = area > 0 ? p->frames[t].area / area * weight + LEAST * weight / (double)count : 1;
    double *z = p->waves[0];
    MesoStatus status = set_start(z, &system, scratch, error);
    system.team = meso_team_begin(options->thread_count);
    for (int turning = 0; turning <= TURNINGS && !status; turning++) {
        for (size_t i = turning ? SURE_HOLD : 0; i < sizeof HOLDS / sizeof *HOLDS; i++)
            for (int round = 0; round < (turning ? FEWER_ROUNDS : ROUNDS); round++)
                step(z, &system, HOLDS[i]);
        if (turning == TURNINGS || options->turn_most <= 0 || strain_of(p) > TURNING_STRAIN_MOST)
            break;
        status = turn_guides(guides, turned, options->turn_most, p, scratch, error);
        list_links(&system);
    }
    meso_team_end(system.team);
    return status;
}

MesoStatus meso_stripe_phases(MesoStripePhases *phases, MesoArena *arena, const MesoTriangulation *mesh,
                              const MesoVec3 *guides, const MesoStripeOptions *options, MesoError *error)
{
    const uint32_t turn_count = options->turn_count;
    const double *pitches = options->pitches;
    const bool diagonal = options->diagonal;
    assert(turn_count == 1 || turn_count == 2 || turn_count == 4);
    *phases = (MesoStripePhases){.mesh = mesh, .turn_count = turn_count, .diagonal = diagonal,
                                  .pitches = {pitches[0], pitches[1]}};
    MesoTriangleFrame *frames = MESO_NEW(arena, MesoTriangleFrame, mesh->triangle_count, error);
    MesoComplex *along = MESO_NEW(arena, MesoComplex, mesh->triangle_count, error);
    phases->waves = meso_arena_alloc(arena, mesh->triangle_count, sizeof *phases->waves, error);
    phases->directions = MESO_NEW(arena, MesoVec3, mesh->triangle_count, error);
    if (!frames || !along || !phases->waves || !phases->directions)
        return MESO_ERR_MEMORY;
    if (turn_count == 4 || diagonal)
        phases->pitches[0] = phases->pitches[1] = (diagonal ? sqrt(0.5) : 0.5) * (pitches[0] + pitches[1]);
    const MesoComplex turn = {diagonal ? sqrt(0.5) : 1, diagonal ? sqrt(0.5) : 0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        frames[t] = meso_frame(mesh, t);
        along[t] = meso_complex_times(meso_complex_unit(meso_frame_in(&frames[t], guides[t])), turn);
    }
    phases->frames = frames;
    phases->guides = along;
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = solve(phases, along, options, &scratch, error);
    for (uint32_t t = 0; t < mesh->triangle_count && !status; t++)
        phases->directions[t] = meso_frame_out(&frames[t], meso_complex_times(along[t], meso_complex_conjugate(turn)));
    if (!status)
        phases->strain = strain_of(phases);
    meso_arena_release(&scratch);
    return status;
}
