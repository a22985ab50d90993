#include "libcore/growth/space/growth_space.h"

#include <stdlib.h>

/* Of the longest side of a triangle: by so much may points on sides be rounded in one of the two triangles there. */
static const double rounding = 4e-15;

MesoStatus meso_growth_space_init(MesoGrowthSpace *space, const MesoGrowthGround *ground, MesoError *error)
{
    *space = (MesoGrowthSpace){.ground = ground};
    return meso_growth_cells_init(&space->cells, &ground->walk, error);
}

void meso_growth_space_release(MesoGrowthSpace *space)
{
    meso_growth_cells_release(&space->cells);
    free(space->kin);
}

bool meso_growth_space_add(MesoGrowthSpace *space, MesoGrowthKin kin, const MesoGrowthPiece *pieces, uint32_t count)
{
    if (!meso_make_room((void **)&space->kin, &space->kin_room, (uint64_t)space->kin_count + 1, sizeof *space->kin))
        return false;
    uint32_t element = space->kin_count;
    space->kin[space->kin_count++] = kin;
    for (uint32_t i = 0; i < count; i++)
        if (!meso_growth_cells_add(&space->cells, &pieces[i], element, kin.placed))
            return false;
    return true;
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
    double a = share_of(s, ends[0]), b = share_of(s, ends[1]), end = s->square + s->slack;
    return (a < -s->slack && b < -s->slack) || (a > end && b > end);
}

/* Whether both ends of another surely lie on one side of a segment. */
static inline bool lies_aside(const Segment *s, const MesoComplex ends[2])
{
    return side_of(s, ends[0]) * side_of(s, ends[1]) > 0;
}

static bool segments_meet(const Segment *s, const MesoComplex s_ends[2], const MesoComplex t_ends[2], double size)
{
    Segment t = segment(t_ends, size);
    return !lies_aside(s, t_ends) && !lies_aside(&t, s_ends) && !lies_apart(s, t_ends) && !lies_apart(&t, s_ends);
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

/* ---- roughly ---- */

/* A segment on the grid of its triangle. */
typedef struct Rough {
    MesoFour x, y, along_x, along_y;    /* alike in all lanes: where it begins, and to its end */
    MesoFour slack, end;                /* of turns and shares; its square, and slack */
    MesoFour size;                      /* by x and y, and 1 */
} Rough;

/* Of turns at a segment, whose ends are exact or on the grid: at that a point may lie by half of its unit beside where
 * it is, and floats add little. */
static const float slack_of_exact = 0.75f, slack_of_rough = 1.5f;

static Rough rough_of(const MesoComplex ends[2], double triangle)
{
    double scale = MESO_GROWTH_GRID / triangle;
    float x = (float)((ends[1].re - ends[0].re) * scale), y = (float)((ends[1].im - ends[0].im) * scale);
    float size = fabsf(x) + fabsf(y), slack = slack_of_exact * size;
    return (Rough){meso_four_all((float)(ends[0].re * scale)), meso_four_all((float)(ends[0].im * scale)),
                   meso_four_all(x), meso_four_all(y), meso_four_all(slack), meso_four_all(x * x + y * y + slack),
                   meso_four_all(size + 1)};
}

static inline MesoFour column_of(MesoFourBits points)
{
    return __builtin_convertvector(points & MESO_GROWTH_GRID, MesoFour);
}

static inline MesoFour row_of(MesoFourBits points)
{
    return __builtin_convertvector((points >> 16) & MESO_GROWTH_GRID, MesoFour);
}

/* Lanes of two numbers that are both above a limit, or both below. */
static inline MesoFourBits both_beyond(MesoFour a, MesoFour b, MesoFour low, MesoFour high)
{
    return ((a > high) & (b > high)) | ((a < low) & (b < low));
}

/* Lanes of two numbers of which one is above a limit, and the other below another. */
static inline MesoFourBits parted(MesoFour a, MesoFour b, MesoFour low, MesoFour high)
{
    return ((a > high) & (b < low)) | ((a < low) & (b > high));
}

/* What is told of the pieces of a block, a bit each. */
typedef struct Lanes {
    uint32_t near;              /* they may meet a segment: no line along or across one of the two has the other aside */
    uint32_t across;            /* they do so surely: each has the other's ends on both sides, and far enough from it */
} Lanes;

static inline Lanes look_at(const Rough *s, const MesoGrowthBlock *block)
{
    MesoFour x0 = column_of(block->from) - s->x, y0 = row_of(block->from) - s->y;
    MesoFour x1 = column_of(block->to) - s->x, y1 = row_of(block->to) - s->y;
    MesoFour from = s->along_x * y0 - s->along_y * x0, to = s->along_x * y1 - s->along_y * x1;
    MesoFour x = x1 - x0, y = y1 - y0;
    MesoFour slack = meso_four_all(slack_of_rough) * (meso_four_absolute(x) + meso_four_absolute(y) +
                                                      meso_four_absolute(x0) + meso_four_absolute(y0) + s->size);
    MesoFour begin = y * x0 - x * y0, end = x * (s->along_y - y0) - y * (s->along_x - x0);
    MesoFourBits apart = both_beyond(from, to, -s->slack, s->slack) | both_beyond(begin, end, -slack, slack) |
                         both_beyond(s->along_x * x0 + s->along_y * y0, s->along_x * x1 + s->along_y * y1, -s->slack,
                                     s->end);
    MesoFourBits across = parted(from, to, -s->slack, s->slack) & parted(begin, end, -slack, slack);
    uint32_t all = (1u << block->count) - 1;
    return (Lanes){~meso_four_mask(apart) & all, meso_four_mask(across) & all};
}

/* ---- pieces ---- */

/* A piece of the way that asks. */
typedef struct Probe {
    const MesoGrowthSpace *space;
    const MesoGrowthAsker *asker;
    const MesoGrowthPiece *piece;
    Segment segment;
    Rough rough;
    double size;                /* of its triangle */
    bool begins;                /* the way begins here */
} Probe;

/* What begins or ends where the way begins does not meet it there. Whose it is lies elsewhere, and is asked last. */
static bool is_root_of(const Probe *probe, uint32_t number, const MesoComplex ends[2])
{
    bool begins = is_same(ends[0], probe->segment.from);
    return probe->begins && (begins || is_same(ends[1], probe->segment.from)) &&
           !are_alike(&probe->segment, ends[begins]) &&
           is_joined(probe->space, probe->asker, probe->space->cells.elements[number]);
}

static bool meets_piece(const Probe *probe, uint32_t number)
{
    const MesoGrowthCells *cells = &probe->space->cells;
    const MesoComplex *ends = cells->ends[number];
    return !is_root_of(probe, number, ends) &&
           segments_meet(&probe->segment, probe->piece->ends, ends, probe->size) &&
           !probe->space->kin[cells->elements[number]].placed;
}

/* Of those in one place, the newer, so that it does not matter in which order they are found. */
static void take_nearer(const Probe *probe, uint32_t number, MesoGrowthMeeting *first)
{
    MesoComplex at;
    double along = place_meeting(&probe->segment, probe->space->cells.ends[number], probe->size, &at);
    if (along < first->along || (along == first->along && number > first->met))
        *first = (MesoGrowthMeeting){.met = number, .at = at, .along = along};
}

/* The nearest meeting in a block, where it is nearer than `first`; where that is NULL, any. */
static bool meets_in_block(const Probe *probe, const MesoGrowthBlock *block, MesoGrowthMeeting *first)
{
    Lanes lanes = look_at(&probe->rough, block);
    uint32_t across = lanes.across & ~(uint32_t)block->placed;
    bool meets = false;
    if (across && !first && block->piece[31 - __builtin_clz(across)] >= probe->asker->since)
        return true;
    for (uint32_t left = lanes.near; left; left &= left - 1) {
        uint32_t number = block->piece[__builtin_ctz(left)];
        if (number < probe->asker->since || !meets_piece(probe, number))
            continue;
        if (!first)
            return true;
        take_nearer(probe, number, first);
        meets = true;
    }
    return meets;
}

/* Of one cell, from its newest block on. */
static bool meets_in_cell(const Probe *probe, uint32_t number, MesoGrowthMeeting *first)
{
    const MesoGrowthBlock *blocks = probe->space->cells.blocks;
    bool meets = false;
    while (number != MESO_NO_INDEX) {
        const MesoGrowthBlock *block = &blocks[number];
        if (meso_growth_newest(block) < probe->asker->since)
            break;
        if (block->next != MESO_NO_INDEX)
            meso_growth_fetch_block(&blocks[block->next]);
        meets |= meets_in_block(probe, block, first);
        if (meets && !first)
            return true;
        number = block->next;
    }
    return meets;
}

static bool meets_in_cells(const Probe *probe, MesoGrowthMeeting *first)
{
    MesoGrowthSight sight;
    uint32_t number;
    bool meets = false;
    meso_growth_sight(&sight, &probe->space->cells, probe->piece->triangle, probe->piece->ends);
    while (!(meets && !first) && (number = meso_growth_next_cell(&sight)) != MESO_NO_INDEX)
        meets |= meets_in_cell(probe, number, first);
    return meets;
}

static bool piece_meets(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, const MesoGrowthPiece *piece,
                        bool begins, MesoGrowthMeeting *first)
{
    const MesoGrowthCells *cells = &space->cells;
    uint32_t head = cells->heads[piece->triangle];
    bool quartered = meso_growth_is_quartered(head);
    if (head == MESO_NO_INDEX || (!quartered && meso_growth_newest(&cells->blocks[head]) < asker->since))
        return false;
    Probe probe;
    probe.space = space;
    probe.asker = asker;
    probe.piece = piece;
    probe.size = space->ground->walk.lengths[piece->triangle];
    probe.begins = begins;
    probe.segment = segment(piece->ends, probe.size);
    probe.rough = rough_of(piece->ends, probe.size);
    return quartered ? meets_in_cells(&probe, first) : meets_in_cell(&probe, head, first);
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
