#include "libcore/growth/engine/growth_space.h"

#include <stdlib.h>
#include <string.h>

/* Of the longest side of a triangle: by so much may points on sides be rounded in one of the two triangles there. */
static const double rounding = 4e-15;

MesoStatus meso_growth_space_init(MesoGrowthSpace *space, const MesoGrowthGround *ground, MesoError *error)
{
    *space = (MesoGrowthSpace){.ground = ground};
    size_t size = (size_t)ground->walk.triangle_count * sizeof *space->heads;
    space->heads = malloc(size ? size : 1);
    if (!space->heads)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu bytes", size);
    memset(space->heads, 0xff, size);
    return MESO_OK;
}

void meso_growth_space_release(MesoGrowthSpace *space)
{
    free(space->heads);
    free(space->blocks);
    free(space->kin);
}

void meso_growth_seen_release(MesoGrowthSeen *seen)
{
    free(seen->table);
    free(seen->queue);
    free(seen->ends);
}

static void add_piece(MesoGrowthSpace *space, const MesoGrowthPiece *piece, uint32_t element)
{
    uint32_t *head = &space->heads[piece->triangle];
    if (*head == MESO_NO_INDEX || space->blocks[*head].count == MESO_GROWTH_LANES) {
        space->blocks[space->block_count].count = 0;
        space->blocks[space->block_count].next = *head;
        *head = space->block_count++;
    }
    MesoGrowthBlock *block = &space->blocks[*head];
    uint32_t lane = block->count++;
    block->x0[lane] = piece->ends[0].re;
    block->y0[lane] = piece->ends[0].im;
    block->x1[lane] = piece->ends[1].re;
    block->y1[lane] = piece->ends[1].im;
    block->element[lane] = element;
}

bool meso_growth_space_add(MesoGrowthSpace *space, MesoGrowthKin kin, const MesoGrowthPiece *pieces, uint32_t count)
{
    if (!meso_make_room((void **)&space->kin, &space->kin_room, (uint64_t)space->kin_count + 1, sizeof *space->kin) ||
        !meso_make_room((void **)&space->blocks, &space->block_room, (uint64_t)space->block_count + count,
                        sizeof *space->blocks))
        return false;
    uint32_t element = space->kin_count;
    space->kin[space->kin_count++] = kin;
    for (uint32_t i = 0; i < count; i++)
        add_piece(space, &pieces[i], element);
    return true;
}

static inline void load_lane(const MesoGrowthBlock *block, uint32_t lane, MesoComplex ends[2])
{
    ends[0] = (MesoComplex){block->x0[lane], block->y0[lane]};
    ends[1] = (MesoComplex){block->x1[lane], block->y1[lane]};
}

/* ---- kin ---- */

double meso_growth_way_to(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, uint32_t element, double most)
{
    const MesoGrowthKin *kin = space->kin;
    uint32_t a = asker->node, b = element;
    /* an element's number is above that of the one it begins at: the higher of the two goes down */
    while (a != b) {
        bool a_is_root = a & MESO_GROWTH_ROOT, b_is_root = b & MESO_GROWTH_ROOT;
        if (a_is_root && b_is_root)
            return INFINITY;
        if (!b_is_root && (a_is_root || b > a)) {
            if ((double)kin[element].begin - kin[b].begin > most)
                return INFINITY;
            b = kin[b].node;
        } else {
            if (asker->length - kin[a].end > most)
                return INFINITY;
            a = kin[a].node;
        }
    }
    if (b == element)
        return asker->length - kin[element].end;
    double fork = b & MESO_GROWTH_ROOT ? 0 : kin[b].end;
    return asker->length - fork + (kin[element].begin - fork);
}

/* Whether an element begins or ends at the very place where the asker begins. */
static bool is_joined(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, uint32_t element)
{
    const MesoGrowthKin *kin = &space->kin[element];
    return !asker->moved && (element == asker->node || (kin->node == asker->node && !kin->moved));
}

/* ---- meeting ---- */

typedef struct Segment {
    MesoComplex from, along;    /* from end to end */
    double square, slack;       /* the square of its length; of turns at it */
} Segment;

static inline Segment segment(const MesoComplex ends[2], double size)
{
    MesoComplex along = {ends[1].re - ends[0].re, ends[1].im - ends[0].im};
    return (Segment){ends[0], along, along.re * along.re + along.im * along.im,
                     rounding * size * (fabs(along.re) + fabs(along.im))};
}

/* Left or right of a segment, or perhaps on it. */
static inline int side_of(const Segment *s, MesoComplex p)
{
    double turn = s->along.re * (p.im - s->from.im) - s->along.im * (p.re - s->from.re);
    return (turn > s->slack) - (turn < -s->slack);
}

static inline double share_of(const Segment *s, MesoComplex p)
{
    return s->along.re * (p.re - s->from.re) + s->along.im * (p.im - s->from.im);
}

/* Whether both ends of another surely lie before the segment's begin, or behind its end. */
static inline bool lies_apart(const Segment *s, const MesoComplex ends[2])
{
    double a = share_of(s, ends[0]), b = share_of(s, ends[1]);
    return fmax(a, b) < -s->slack || fmin(a, b) > s->square + s->slack;
}

/* Bit i: both ends of piece i surely lie on one side of a segment. */
static inline uint32_t lanes_apart(const Segment *s, const MesoGrowthBlock *block)
{
    uint32_t apart = 0;
    double from[MESO_GROWTH_LANES], to[MESO_GROWTH_LANES];
    for (uint32_t i = 0; i < MESO_GROWTH_LANES; i++) {
        from[i] = s->along.re * (block->y0[i] - s->from.im) - s->along.im * (block->x0[i] - s->from.re);
        to[i] = s->along.re * (block->y1[i] - s->from.im) - s->along.im * (block->x1[i] - s->from.re);
    }
    for (uint32_t i = 0; i < MESO_GROWTH_LANES; i++) {
        bool left = (from[i] > s->slack) & (to[i] > s->slack), right = (from[i] < -s->slack) & (to[i] < -s->slack);
        apart |= (uint32_t)(left | right) << i;
    }
    return apart;
}

/* Whether two do, of which the other is not on one side of the first. */
static bool segments_meet(const Segment *s, const MesoComplex s_ends[2], const MesoComplex t_ends[2], double size)
{
    Segment t = segment(t_ends, size);
    return side_of(&t, s_ends[0]) * side_of(&t, s_ends[1]) <= 0 && !lies_apart(s, t_ends) && !lies_apart(&t, s_ends);
}

static inline bool is_same(MesoComplex a, MesoComplex b)
{
    return a.re == b.re && a.im == b.im;
}

/* Two that begin in one point lie over each other. */
static bool are_alike(const Segment *s, MesoComplex other_end)
{
    return side_of(s, other_end) == 0 && share_of(s, other_end) > 0;
}

/*
 * Where a segment meets another, along it, and the point there: as near to the other as rounding allows, but not beyond
 * it.
 */
static double place_meeting(const Segment *s, const MesoComplex ends[2], double size, MesoComplex *at)
{
    Segment t = segment(ends, size);
    MesoComplex to = {s->from.re - t.from.re, s->from.im - t.from.im};
    double area = t.along.re * s->along.im - t.along.im * s->along.re;
    double share = area != 0 ? (to.re * s->along.im - to.im * s->along.re) / area : 0;
    double length = sqrt(s->square), side = t.along.re * to.im - t.along.im * to.re;
    share = fmin(fmax(share, 0), 1);
    MesoComplex met = {t.from.re + share * t.along.re, t.from.im + share * t.along.im};
    double along = length > 0 ? fmin(fmax(share_of(s, met) / length, 0), length) : 0;
    *at = met;
    for (double back = rounding * size / 4; back < along; back *= 2) {
        double turn = t.along.re * (at->im - t.from.im) - t.along.im * (at->re - t.from.re);
        if (turn * side > 0 && fabs(turn) > t.slack / 4)
            break;
        at->re = met.re - back / length * s->along.re;
        at->im = met.im - back / length * s->along.im;
    }
    return along;
}

/* A piece of the way that asks. */
typedef struct Probe {
    const MesoGrowthSpace *space;
    const MesoGrowthAsker *asker;
    const MesoGrowthPiece *piece;
    Segment segment;
    double size;                /* of its triangle */
    bool begins;                /* the way begins here */
} Probe;

/* What begins or ends where the way begins does not meet it there. */
static bool is_root_of(const Probe *probe, uint32_t element, const MesoComplex ends[2])
{
    if (!probe->begins || !is_joined(probe->space, probe->asker, element))
        return false;
    bool begins = is_same(ends[0], probe->segment.from);
    return (begins || is_same(ends[1], probe->segment.from)) && !are_alike(&probe->segment, ends[begins]);
}

static bool meets_lane(const Probe *probe, const MesoGrowthBlock *block, uint32_t lane, MesoComplex ends[2])
{
    uint32_t element = block->element[lane];
    load_lane(block, lane, ends);
    return element >= probe->asker->since && segments_meet(&probe->segment, probe->piece->ends, ends, probe->size) &&
           !probe->space->kin[element].placed && !is_root_of(probe, element, ends);
}

/* The nearest meeting in a block, where it is nearer than `first`; where that is NULL, any. */
static bool meets_in_block(const Probe *probe, const MesoGrowthBlock *block, MesoGrowthMeeting *first)
{
    uint32_t left = ((1u << block->count) - 1) & ~lanes_apart(&probe->segment, block);
    bool meets = false;
    for (; left; left &= left - 1) {
        MesoComplex ends[2], at;
        if (!meets_lane(probe, block, (uint32_t)__builtin_ctz(left), ends))
            continue;
        if (!first)
            return true;
        double along = place_meeting(&probe->segment, ends, probe->size, &at);
        if (along < first->along)
            *first = (MesoGrowthMeeting){.at = at, .along = along};
        meets = true;
    }
    return meets;
}

static bool piece_meets(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, const MesoGrowthPiece *piece,
                        bool begins, MesoGrowthMeeting *first)
{
    uint32_t number = space->heads[piece->triangle];
    if (number == MESO_NO_INDEX)
        return false;
    Probe probe = {space, asker, piece, .size = space->ground->walk.lengths[piece->triangle], .begins = begins};
    probe.segment = segment(piece->ends, probe.size);
    bool meets = false;
    while (number != MESO_NO_INDEX) {
        const MesoGrowthBlock *block = &space->blocks[number];
        if (block->element[block->count - 1] < asker->since)
            break;
        if (block->next != MESO_NO_INDEX)
            meso_growth_fetch_block(&space->blocks[block->next]);
        meets |= meets_in_block(&probe, block, first);
        if (meets && !first)
            return true;
        number = block->next;
    }
    return meets;
}

bool meso_growth_meets(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, const MesoGrowthPiece *pieces,
                       uint32_t count, MesoGrowthMeeting *first)
{
    for (uint32_t i = 0; i < count; i++) {
        if (first)
            first->along = INFINITY;
        if (piece_meets(space, asker, &pieces[i], i == 0, first)) {
            if (first)
                first->piece = i;
            return true;
        }
    }
    return false;
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

static bool triangle_is_clear(const Search *search, uint32_t triangle, double corners[3][3])
{
    const MesoGrowthSpace *space = search->space;
    double square = search->clear * search->clear;
    for (uint32_t i = space->heads[triangle]; i != MESO_NO_INDEX; i = space->blocks[i].next) {
        const MesoGrowthBlock *block = &space->blocks[i];
        for (uint32_t lane = block->count; lane-- > 0;) {
            MesoComplex flat[2];
            double ends[6];
            if (block->element[lane] < search->asker->since)
                return true;
            load_lane(block, lane, flat);
            lift_ends(&space->ground->walk, triangle, corners, flat, ends);
            if (is_within(search->seen->ends, search->count, ends, square) && counts(search, block->element[lane]))
                return false;
        }
    }
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

bool meso_growth_is_clear(const MesoGrowthSpace *space, MesoGrowthSeen *seen, const MesoGrowthAsker *asker,
                          const MesoGrowthPiece *pieces, uint32_t count, double clear, bool placed_count)
{
    const MesoTriangulation *mesh = space->ground->mesh;
    const Search search = {space, asker, seen, count, clear, placed_count};
    double corners[3][3];
    bool is_clear = true;
    if (!(clear > 0) || asker->since >= space->kin_count)
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
    for (uint32_t i = 0; i < seen->count && is_clear && !seen->failed; i++) {
        load_corners(mesh, seen->queue[i], corners);
        is_clear = triangle_is_clear(&search, seen->queue[i], corners);
        if (is_clear)
            see_neighbours(&search, seen->queue[i], corners);
    }
    forget(seen);
    return is_clear;
}
