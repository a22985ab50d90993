#include "libcore/quilt/seam/band_deform.h"

#include <string.h>

#include "libcore/math/envelope.h"
#include "libcore/math/sparse_cholesky.h"

/* Rows of a system that goes by its envelope have a length of no more than this, as the root of the mean of squares. */
#define LENGTH_MOST 96.0

/* The system is of displacements: what does not move is 0 there, and what it was costs no digits. */
typedef struct Band {
    uint32_t vertex_count;
    size_t *begins;             /* [vertex_count + 1] */
    uint32_t *neighbours;       /* each once; ends[v] where those of a vertex end */
    size_t *ends;               /* [vertex_count] */
    uint32_t *places;           /* [vertex_count] its unknown; MESO_NO_INDEX: does not move */
    uint32_t free_count;
    uint32_t *vertices;         /* [free_count] vertices that move, by their places */
    bool in_envelope;           /* rows are short: no triplets then */
    MesoEnvelope envelope;
    size_t triplet_count;
    MesoTriplet *triplets;
    double *moves;              /* [3 * free_count] */
} Band;

/* Beyond this the rest of the system would be lost in the pulls' rounding. */
static const double LARGEST_MU = 1e8;

/* ---- input ---- */

static MesoStatus check_pulls(uint32_t vertex_count, const MesoBandPull *pulls, uint32_t pull_count, MesoError *error)
{
    for (uint32_t p = 0; p < pull_count; p++) {
        const MesoBandPull *pull = &pulls[p];
        float sum = pull->weight[0] + pull->weight[1] + pull->weight[2];
        for (int k = 0; k < 3; k++)
            if (pull->weight[k] != 0 && pull->v[k] >= vertex_count)
                return meso_fail(error, MESO_ERR_INTERNAL, "pull %u is at vertex %u of %u", p, pull->v[k], vertex_count);
        if (!(isfinite(sum) && fabsf(sum) > 1e-3f && meso_vec3_finite(pull->target)))
            return meso_fail(error, MESO_ERR_INPUT, "pull %u has weights of sum %g, or a target that is not finite", p,
                             (double)sum);
    }
    return MESO_OK;
}

static MesoStatus check_input(uint32_t vertex_count, const uint32_t *corners, uint32_t triangle_count,
                              const MesoBandPull *pulls, uint32_t pull_count, double mu, MesoError *error)
{
    if (!(mu >= 0))
        return meso_fail(error, MESO_ERR_INPUT, "pulls of strength %g", mu);
    for (size_t c = 0; c < 3 * (size_t)triangle_count; c++)
        if (corners[c] >= vertex_count)
            return meso_fail(error, MESO_ERR_INTERNAL, "triangle %zu has vertex %u of %u", c / 3, corners[c],
                             vertex_count);
    return check_pulls(vertex_count, pulls, pull_count, error);
}

/* ---- neighbours ---- */

static MesoStatus allocate(Band *band, MesoArena *scratch, uint32_t triangle_count, MesoError *error)
{
    size_t count = band->vertex_count;
    if (!(band->begins = MESO_NEW(scratch, size_t, count + 1, error)) ||
        !(band->ends = MESO_NEW(scratch, size_t, count, error)) ||
        !(band->neighbours = MESO_NEW(scratch, uint32_t, 6 * (size_t)triangle_count, error)) ||
        !(band->places = MESO_NEW(scratch, uint32_t, count, error)) ||
        !(band->vertices = MESO_NEW(scratch, uint32_t, count, error)))
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

static void add_neighbour(Band *band, uint32_t v, uint32_t neighbour)
{
    for (size_t n = band->begins[v]; n < band->ends[v]; n++)
        if (band->neighbours[n] == neighbour)
            return;
    if (neighbour != v)
        band->neighbours[band->ends[v]++] = neighbour;
}

static void find_neighbours(Band *band, const uint32_t *corners, uint32_t triangle_count)
{
    size_t corner_count = 3 * (size_t)triangle_count;
    for (size_t c = 0; c < corner_count; c++)
        band->begins[corners[c] + 1] += 2;
    for (uint32_t v = 0; v < band->vertex_count; v++)
        band->begins[v + 1] += band->begins[v];
    memcpy(band->ends, band->begins, band->vertex_count * sizeof *band->ends);
    for (size_t t = 0; t < corner_count; t += 3)
        for (uint32_t k = 0; k < 3; k++) {
            add_neighbour(band, corners[t + k], corners[t + (k + 1) % 3]);
            add_neighbour(band, corners[t + k], corners[t + (k + 2) % 3]);
        }
}

/* ---- what moves ---- */

static void free_vertex(Band *band, uint32_t v)
{
    if (band->places[v] != MESO_NO_INDEX)
        return;
    band->places[v] = band->free_count;
    band->vertices[band->free_count++] = v;
}

/* By breadth; a pull's own vertices are ring 0. */
static void find_free(Band *band, const MesoBandPull *pulls, uint32_t pull_count, uint32_t rings)
{
    memset(band->places, 0xff, band->vertex_count * sizeof *band->places);
    for (uint32_t p = 0; p < pull_count; p++)
        for (int k = 0; k < 3; k++)
            if (pulls[p].weight[k] != 0)
                free_vertex(band, pulls[p].v[k]);
    uint32_t begin = 0;
    for (uint32_t ring = 0; ring < rings && begin < band->free_count; ring++) {
        uint32_t end = band->free_count;
        for (; begin < end; begin++) {
            uint32_t v = band->vertices[begin];
            for (size_t n = band->begins[v]; n < band->ends[v]; n++)
                free_vertex(band, band->neighbours[n]);
        }
    }
}

static MesoStatus check_free(const Band *band, const MesoVec3 *positions, MesoError *error)
{
    for (uint32_t f = 0; f < band->free_count; f++)
        if (!meso_vec3_finite(positions[band->vertices[f]]))
            return meso_fail(error, MESO_ERR_INPUT, "vertex %u of a band is not finite", band->vertices[f]);
    return MESO_OK;
}

/* ---- their order ---- */

typedef struct Order {
    uint32_t *list, count;      /* [free_count] */
    uint32_t *rounds, round;    /* [vertex_count] the last walk that came by, plus 1 */
} Order;

/* What hangs together with a vertex, by breadth. */
static void walk(const Band *band, Order *order, uint32_t begin, uint32_t first)
{
    order->count = begin;
    order->round++;
    order->list[order->count++] = first;
    order->rounds[first] = order->round;
    for (uint32_t i = begin; i < order->count; i++)
        for (size_t n = band->begins[order->list[i]]; n < band->ends[order->list[i]]; n++) {
            uint32_t v = band->neighbours[n];
            if (band->places[v] == MESO_NO_INDEX || order->rounds[v] == order->round)
                continue;
            order->rounds[v] = order->round;
            order->list[order->count++] = v;
        }
}

/*
 * One part after the other, each by breadth from the vertex where such a walk ends: neighbours have places near to each
 * other (Cuthill and McKee, "Reducing the bandwidth of sparse symmetric matrices", 1969).
 */
static MesoStatus order_free(Band *band, MesoArena *scratch, MesoError *error)
{
    Order order = {.list = MESO_NEW(scratch, uint32_t, band->free_count, error),
                   .rounds = MESO_NEW(scratch, uint32_t, band->vertex_count, error)};
    if (!order.list || !order.rounds)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0, done = 0; f < band->free_count; f++) {
        if (order.rounds[band->vertices[f]])
            continue;
        walk(band, &order, done, band->vertices[f]);
        walk(band, &order, done, order.list[order.count - 1]);
        done = order.count;
    }
    band->vertices = order.list;
    for (uint32_t f = 0; f < band->free_count; f++)
        band->places[order.list[f]] = f;
    return MESO_OK;
}

static void lower(uint32_t *least, uint32_t place)
{
    *least = place < *least ? place : *least;
}

/* The first unknown that the rows which have a vertex have as well. */
static uint32_t first_seen(const Band *band, uint32_t v)
{
    uint32_t least = band->places[v];
    for (size_t n = band->begins[v]; n < band->ends[v]; n++) {
        uint32_t row = band->neighbours[n];
        lower(&least, band->places[row]);
        for (size_t m = band->begins[row]; m < band->ends[row]; m++)
            lower(&least, band->places[band->neighbours[m]]);
    }
    return least;
}

/* Plans the envelope; whether it is worth it. */
static MesoStatus plan_envelope(Band *band, MesoArena *scratch, const MesoBandPull *pulls, uint32_t pull_count,
                                MesoError *error)
{
    uint32_t *firsts = MESO_NEW(scratch, uint32_t, band->free_count, error);
    if (!firsts)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < band->free_count; f++)
        firsts[f] = first_seen(band, band->vertices[f]);
    for (uint32_t p = 0; p < pull_count; p++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3 && pulls[p].weight[a] != 0; b++)
                if (pulls[p].weight[b] != 0)
                    lower(&firsts[band->places[pulls[p].v[a]]], band->places[pulls[p].v[b]]);
    double squares = 0;
    for (uint32_t f = 0; f < band->free_count; f++)
        squares += (double)(f - firsts[f] + 1) * (double)(f - firsts[f] + 1);
    band->in_envelope = squares <= LENGTH_MOST * LENGTH_MOST * (double)band->free_count;
    return band->in_envelope ? meso_envelope_new(&band->envelope, scratch, band->free_count, firsts, error) : MESO_OK;
}

/* ---- the system ---- */

/* The entry of L at `row` for the vertex itself, and for each of its neighbours. */
static double own_entry(const Band *band, uint32_t row)
{
    return band->ends[row] > band->begins[row] ? 1 : 0;
}

static double ring_entry(const Band *band, uint32_t row)
{
    return -1 / (double)(band->ends[row] - band->begins[row]);
}

/* To a place of the lower triangle. */
static void add_value(Band *band, uint32_t row, uint32_t column, double value)
{
    if (band->in_envelope)
        *meso_envelope_at(&band->envelope, row, column) += value;
    else
        band->triplets[band->triplet_count++] = (MesoTriplet){row, column, value};
}

/* Row `row` of L, times its entry at the vertex of column `own`: what is not above the diagonal. */
static void add_row(Band *band, uint32_t own, uint32_t row, double entry)
{
    double ring = entry * ring_entry(band, row);
    if (band->places[row] != MESO_NO_INDEX && band->places[row] >= own)
        add_value(band, band->places[row], own, entry * own_entry(band, row));
    for (size_t n = band->begins[row]; n < band->ends[row]; n++) {
        uint32_t place = band->places[band->neighbours[n]];
        if (place != MESO_NO_INDEX && place >= own)
            add_value(band, place, own, ring);
    }
}

/*
 * L'L of all vertices that see one that moves. Being a neighbour is mutual, so the rows that have a vertex are its own
 * and those of its neighbours.
 */
static void add_laplacian(Band *band)
{
    for (uint32_t own = 0; own < band->free_count; own++) {
        uint32_t v = band->vertices[own];
        add_row(band, own, v, own_entry(band, v));
        for (size_t n = band->begins[v]; n < band->ends[v]; n++)
            add_row(band, own, band->neighbours[n], ring_entry(band, band->neighbours[n]));
    }
}

/* At most as many as add_laplacian() meets, nine a pull, and one of the ridge. */
static size_t bound_triplets(const Band *band, uint32_t pull_count)
{
    size_t bound = 9 * (size_t)pull_count + band->free_count;
    for (uint32_t f = 0; f < band->free_count; f++) {
        uint32_t v = band->vertices[f];
        bound += 1 + 2 * (band->ends[v] - band->begins[v]);
        for (size_t n = band->begins[v]; n < band->ends[v]; n++)
            bound += band->ends[band->neighbours[n]] - band->begins[band->neighbours[n]];
    }
    return bound;
}

/* From where a pull's point is to its target. */
static void measure_pull(const MesoBandPull *pull, const MesoVec3 *positions, double gap[3])
{
    gap[0] = pull->target.x;
    gap[1] = pull->target.y;
    gap[2] = pull->target.z;
    for (int k = 0; k < 3; k++)
        if (pull->weight[k] != 0) {
            MesoVec3 p = positions[pull->v[k]];
            gap[0] -= (double)pull->weight[k] * p.x;
            gap[1] -= (double)pull->weight[k] * p.y;
            gap[2] -= (double)pull->weight[k] * p.z;
        }
}

static void add_pull(Band *band, const MesoBandPull *pull, const MesoVec3 *positions, double mu)
{
    double gap[3];
    measure_pull(pull, positions, gap);
    for (int a = 0; a < 3; a++) {
        if (pull->weight[a] == 0)
            continue;
        uint32_t row = band->places[pull->v[a]];
        double strength = mu * pull->weight[a];
        for (int b = 0; b < 3; b++) {
            uint32_t other = pull->weight[b] != 0 ? band->places[pull->v[b]] : MESO_NO_INDEX;
            if (other <= row)   /* a vertex that is named twice counts with the sum of its weights */
                add_value(band, row, other, strength * pull->weight[b]);
        }
        for (size_t c = 0; c < 3; c++)
            band->moves[3 * (size_t)row + c] += strength * gap[c];
    }
}

/*
 * What nothing else tells stays: parts of the whole that what is told does not feel. Of vertices without triangles a
 * pull tells only the weighted sum, and they are measured by it.
 */
static const double RIDGE = 1e-12, LONE_RIDGE = 1e-9;

static void add_ridge(Band *band, double mu)
{
    for (uint32_t f = 0; f < band->free_count; f++) {
        uint32_t v = band->vertices[f];
        add_value(band, f, f, band->ends[v] > band->begins[v] ? RIDGE : LONE_RIDGE * mu);
    }
}

static MesoStatus fill_system(Band *band, MesoArena *scratch, const MesoVec3 *positions, const MesoBandPull *pulls,
                              uint32_t pull_count, double mu, MesoError *error)
{
    size_t triplets = band->in_envelope ? 0 : bound_triplets(band, pull_count);
    if (!(band->triplets = MESO_NEW(scratch, MesoTriplet, triplets, error)) ||
        !(band->moves = MESO_NEW(scratch, double, 3 * (size_t)band->free_count, error)))
        return MESO_ERR_MEMORY;
    add_laplacian(band);
    for (uint32_t p = 0; p < pull_count; p++)
        add_pull(band, &pulls[p], positions, mu);
    add_ridge(band, mu);
    return MESO_OK;
}

static MesoStatus solve(Band *band, MesoArena *scratch, MesoError *error)
{
    MesoStatus status;
    if (band->in_envelope) {
        status = meso_envelope_factor(&band->envelope, error);
        if (!status)
            meso_envelope_solve(&band->envelope, band->moves);
        return status;
    }
    MesoCholesky factor;
    status = meso_cholesky_analyse(&factor, scratch, band->free_count, band->triplets, band->triplet_count,
                                              error);
    if (!status)
        status = meso_cholesky_factor(&factor, band->triplets, band->triplet_count, error);
    if (!status)
        meso_cholesky_solve(&factor, band->moves, 3);
    return status;
}

/* ---- result ---- */

static void move_vertices(const Band *band, MesoVec3 *positions)
{
    for (uint32_t f = 0; f < band->free_count; f++) {
        MesoVec3 *p = &positions[band->vertices[f]];
        const double *move = band->moves + 3 * (size_t)f;
        *p = (MesoVec3){(float)(p->x + move[0]), (float)(p->y + move[1]), (float)(p->z + move[2])};
    }
}

static void report(const MesoVec3 *positions, const MesoBandPull *pulls, uint32_t pull_count, double *rms,
                   double *largest)
{
    double sum = 0, most = 0;
    for (uint32_t p = 0; p < pull_count; p++) {
        double gap[3];
        measure_pull(&pulls[p], positions, gap);
        double square = gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
        sum += square;
        most = square > most ? square : most;
    }
    if (rms)
        *rms = pull_count ? sqrt(sum / pull_count) : 0;
    if (largest)
        *largest = sqrt(most);
}

static MesoStatus deform(Band *band, MesoVec3 *positions, MesoArena *scratch, const uint32_t *corners,
                         uint32_t triangle_count, const MesoBandPull *pulls, uint32_t pull_count, uint32_t rings,
                         double mu, MesoError *error)
{
    MesoStatus status = allocate(band, scratch, triangle_count, error);
    if (status)
        return status;
    find_neighbours(band, corners, triangle_count);
    find_free(band, pulls, pull_count, rings);
    status = check_free(band, positions, error);
    if (!status)
        status = order_free(band, scratch, error);
    if (!status)
        status = plan_envelope(band, scratch, pulls, pull_count, error);
    if (!status)
        status = fill_system(band, scratch, positions, pulls, pull_count, mu, error);
    if (!status)
        status = solve(band, scratch, error);
    if (!status)
        move_vertices(band, positions);
    return status;
}

MesoStatus meso_band_deform(MesoVec3 *positions, MesoArena *scratch, uint32_t vertex_count, const uint32_t *corners,
                            uint32_t triangle_count, const MesoBandPull *pulls, uint32_t pull_count, uint32_t rings,
                            double mu, double *rms, double *largest, MesoError *error)
{
    MesoStatus status = check_input(vertex_count, corners, triangle_count, pulls, pull_count, mu, error);
    if (!status && pull_count && mu > 0) {
        Band band = {.vertex_count = vertex_count};
        MesoArenaMark mark = meso_arena_mark(scratch);
        status = deform(&band, positions, scratch, corners, triangle_count, pulls, pull_count, rings,
                        mu < LARGEST_MU ? mu : LARGEST_MU, error);
        meso_arena_rewind(scratch, mark);
    }
    if (!status)
        report(positions, pulls, pull_count, rms, largest);
    return status;
}
