#include <stdlib.h>
#include <string.h>

#include "libcore/growth/space/growth_space.h"

void meso_growth_seen_release(MesoGrowthSeen *seen)
{
    free(seen->table);
    free(seen->queue);
    free(seen->ends);
}

/* ---- points and segments in space ---- */

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

void meso_growth_weigh(const MesoWalkGround *ground, uint32_t triangle, MesoComplex point, double weight[3])
{
    const MesoWalkFace *face = &ground->faces[triangle];
    uint32_t base = meso_walk_base(face);
    MesoComplex apex = face->apexes[base];
    double length = ground->lengths[triangle];
    double far = apex.im > 0 && length > 0 ? clamp(point.im / (length * apex.im), 0, 1) : 0;
    double next = length > 0 ? clamp(point.re / length - far * apex.re, 0, 1 - far) : 0;
    weight[base] = 1 - far - next;
    weight[meso_next_side(base)] = next;
    weight[meso_previous_side(base)] = far;
}

static void load_corners(const MesoTriangulation *mesh, uint32_t triangle, double corners[3][3])
{
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 p = mesh->positions[mesh->corners[3 * (size_t)triangle + k]];
        corners[k][0] = p.x;
        corners[k][1] = p.y;
        corners[k][2] = p.z;
    }
}

static void lift_ends(const MesoWalkGround *ground, uint32_t triangle, double corners[3][3],
                      const MesoComplex ends[2], double out[6])
{
    for (uint32_t end = 0; end < 2; end++) {
        double weight[3];
        meso_growth_weigh(ground, triangle, ends[end], weight);
        for (uint32_t i = 0; i < 3; i++)
            out[3 * end + i] = weight[0] * corners[0][i] + weight[1] * corners[1][i] + weight[2] * corners[2][i];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Square of the distance of two segments, each its two ends ("Real-Time Collision Detection", Ericson 2005, 5.1.9). */
static double square_between(const double p[6], const double q[6])
{
    double u[3], v[3], w[3];
    for (uint32_t i = 0; i < 3; i++) {
        u[i] = p[3 + i] - p[i];
        v[i] = q[3 + i] - q[i];
        w[i] = p[i] - q[i];
    }
    double a = dot(u, u), e = dot(v, v), f = dot(v, w), b = dot(u, v), c = dot(u, w), s = 0, t = 0;
    double area = a * e - b * b;
    if (a > 0 && e > 0) {
        s = area > 1e-14 * a * e ? clamp((b * f - c * e) / area, 0, 1) : 0;
        t = (b * s + f) / e;
        if (t < 0 || t > 1) {
            t = clamp(t, 0, 1);
            s = clamp((b * t - c) / a, 0, 1);
        }
    } else if (a > 0) {
        s = clamp(-c / a, 0, 1);
    } else if (e > 0) {
        t = clamp(f / e, 0, 1);
    }
    double square = 0;
    for (uint32_t i = 0; i < 3; i++) {
        double d = w[i] + s * u[i] - t * v[i];
        square += d * d;
    }
    return square;
}

/* ---- clearance ---- */

static bool is_within(const double *ends, uint32_t count, const double other[6], double square)
{
    for (uint32_t i = 0; i < count; i++)
        if (square_between(ends + 6 * (size_t)i, other) < square)
            return true;
    return false;
}

static uint32_t hash_of(uint32_t triangle, uint32_t room)
{
    return (triangle * 2654435769u) & (room - 1);
}

static bool enlarge_seen(MesoGrowthSeen *seen)
{
    uint32_t room = seen->room ? 2 * seen->room : 256;
    uint32_t *queue = realloc(seen->queue, room * sizeof *queue);
    if (queue)
        seen->queue = queue;
    uint32_t *table = realloc(seen->table, room * sizeof *table);
    if (table)
        seen->table = table;
    if (!queue || !table)
        return false;
    seen->room = room;
    memset(table, 0xff, room * sizeof *table);
    for (uint32_t i = 0; i < seen->count; i++) {
        uint32_t at = hash_of(queue[i], room);
        while (table[at] != MESO_NO_INDEX)
            at = (at + 1) & (room - 1);
        table[at] = queue[i];
    }
    return true;
}

/* Queues a triangle that has not been seen. */
static void see(MesoGrowthSeen *seen, uint32_t triangle)
{
    if (2 * (seen->count + 1) > seen->room && !enlarge_seen(seen)) {
        seen->failed = true;
        return;
    }
    uint32_t at = hash_of(triangle, seen->room);
    for (; seen->table[at] != MESO_NO_INDEX; at = (at + 1) & (seen->room - 1))
        if (seen->table[at] == triangle)
            return;
    seen->table[at] = triangle;
    seen->queue[seen->count++] = triangle;
}

static void forget(MesoGrowthSeen *seen)
{
    if (seen->room > 4096 && seen->count < seen->room / 8) {
        for (uint32_t i = 0; i < seen->count; i++) {
            uint32_t at = hash_of(seen->queue[i], seen->room);
            for (; seen->table[at] != MESO_NO_INDEX; at = (at + 1) & (seen->room - 1))
                seen->table[at] = MESO_NO_INDEX;
        }
    } else if (seen->room) {
        memset(seen->table, 0xff, seen->room * sizeof *seen->table);
    }
    seen->count = 0;
}

typedef struct Search {
    const MesoGrowthSpace *space;
    const MesoGrowthAsker *asker;
    MesoGrowthSeen *seen;
    uint32_t count;             /* pieces of the way */
    double center[3], radius;   /* of a ball around it */
    double clear;
    bool placed_count;
} Search;

/* Whether a piece that is too near counts. */
static bool counts(const Search *search, uint32_t element)
{
    double kin = MESO_GROWTH_KIN * search->clear;
    return (search->placed_count && search->space->kin[element].placed) ||
           !(meso_growth_way_to(search->space, search->asker, element, kin) < kin);
}

static bool cell_is_clear(const Search *search, uint32_t triangle, double corners[3][3], uint32_t number)
{
    const MesoGrowthSpace *space = search->space;
    const MesoGrowthCells *cells = &space->cells;
    double square = search->clear * search->clear;
    for (; number != MESO_NO_INDEX; number = cells->blocks[number].next) {
        const MesoGrowthBlock *block = &cells->blocks[number];
        for (uint32_t lane = block->count; lane-- > 0;) {
            uint32_t piece = block->piece[lane];
            double ends[6];
            if (piece < search->asker->since)
                return true;
            lift_ends(&space->ground->walk, triangle, corners, cells->ends[piece], ends);
            if (is_within(search->seen->ends, search->count, ends, square) && counts(search, cells->elements[piece]))
                return false;
        }
    }
    return true;
}

static double length_of(const double v[3])
{
    return sqrt(dot(v, v));
}

/* Where a point lies over the frame of a triangle; false where that has no area. */
static bool lay_down(const MesoWalkGround *ground, uint32_t triangle, double corners[3][3], const double point[3],
                     MesoComplex *at)
{
    uint32_t base = meso_walk_base(&ground->faces[triangle]);
    double x[3], y[3], to[3];
    for (uint32_t i = 0; i < 3; i++) {
        x[i] = corners[meso_next_side(base)][i] - corners[base][i];
        y[i] = corners[meso_previous_side(base)][i] - corners[base][i];
        to[i] = point[i] - corners[base][i];
    }
    double along = dot(x, x), share = along > 0 ? dot(x, y) / along : 0;
    for (uint32_t i = 0; i < 3; i++)
        y[i] -= share * x[i];
    double height = length_of(y);
    if (!(height * height > 1e-12 * along))
        return false;
    *at = (MesoComplex){dot(to, x) / sqrt(along), dot(to, y) / height};
    return true;
}

/* Of cells those that a ball reaches, which is as far around the way as must be clear. */
static void look_around(const Search *search, uint32_t triangle, double corners[3][3], MesoGrowthSight *sight)
{
    const MesoWalkGround *ground = &search->space->ground->walk;
    const MesoGrowthCells *cells = &search->space->cells;
    MesoComplex center;
    if (lay_down(ground, triangle, corners, search->center, &center))
        meso_growth_sight_around(sight, cells, triangle, center,
                                 search->radius + search->clear + 1e-5 * ground->lengths[triangle]);
    else
        meso_growth_sight(sight, cells, triangle, NULL);
}

static bool triangle_is_clear(const Search *search, uint32_t triangle, double corners[3][3])
{
    const MesoGrowthCells *cells = &search->space->cells;
    uint32_t head = cells->heads[triangle];
    MesoGrowthSight sight;
    if (!meso_growth_is_quartered(head))
        return cell_is_clear(search, triangle, corners, head);
    look_around(search, triangle, corners, &sight);
    while ((head = meso_growth_next_cell(&sight)) != MESO_NO_INDEX)
        if (!cell_is_clear(search, triangle, corners, head))
            return false;
    return true;
}

static void see_neighbours(const Search *search, uint32_t triangle, double corners[3][3])
{
    const MesoWalkFace *face = &search->space->ground->walk.faces[triangle];
    for (uint32_t k = 0; k < 3; k++) {
        double side[6];
        memcpy(side, corners[k], sizeof corners[k]);
        memcpy(side + 3, corners[meso_next_side(k)], sizeof corners[k]);
        if (face->twins[k] != MESO_NO_INDEX &&
            is_within(search->seen->ends, search->count, side, search->clear * search->clear))
            see(search->seen, face->twins[k] / 3);
    }
}

static void set_ball(Search *search)
{
    const double *ends = search->seen->ends;
    uint32_t last = 2 * search->count - 1;
    for (uint32_t i = 0; i < 3; i++)
        search->center[i] = 0.5 * (ends[i] + ends[3 * (size_t)last + i]);
    for (uint32_t end = 0; end <= last; end++) {
        double by[3];
        for (uint32_t i = 0; i < 3; i++)
            by[i] = ends[3 * (size_t)end + i] - search->center[i];
        search->radius = fmax(search->radius, length_of(by));
    }
}

bool meso_growth_is_clear(const MesoGrowthSpace *space, MesoGrowthSeen *seen, const MesoGrowthAsker *asker,
                          const MesoGrowthPiece *pieces, uint32_t count, double clear, bool placed_count)
{
    const MesoTriangulation *mesh = space->ground->mesh;
    Search search = {space, asker, seen, count, {0, 0, 0}, 0, clear, placed_count};
    double corners[3][3];
    bool is_clear = true;
    if (!(clear > 0) || asker->since >= space->cells.piece_count)
        return true;
    if (!meso_make_room((void **)&seen->ends, &seen->piece_room, count, 6 * sizeof *seen->ends)) {
        seen->failed = true;
        return true;
    }
    for (uint32_t i = 0; i < count; i++) {
        load_corners(mesh, pieces[i].triangle, corners);
        lift_ends(&space->ground->walk, pieces[i].triangle, corners, pieces[i].ends, seen->ends + 6 * (size_t)i);
        see(seen, pieces[i].triangle);
    }
    if (count)
        set_ball(&search);
    for (uint32_t i = 0; i < seen->count && is_clear && !seen->failed; i++) {
        load_corners(mesh, seen->queue[i], corners);
        is_clear = triangle_is_clear(&search, seen->queue[i], corners);
        if (is_clear)
            see_neighbours(&search, seen->queue[i], corners);
    }
    forget(seen);
    return is_clear;
}
