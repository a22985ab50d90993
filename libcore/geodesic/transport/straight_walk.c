#include "libcore/geodesic/transport/straight_walk.h"

#include "libcore/geodesic/transport/walk_lanes.h"

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* As many as keep memory busy. */
enum { LANE_COUNT = 16 };

/* What lies ahead in the triangle that a lane is in. */
typedef struct Passage {
    MesoComplex apex;       /* the far corner over the side from left to right, where that goes from 0 to 1 */
    MesoComplex left, side; /* the side by which the walk's line leaves, as a lane's */
    uint32_t entry, exit;   /* sides, 0 to 2 */
    bool far_left;          /* the far corner is on the left, and so the left end of the exit */
    bool ends;              /* the walk ends before the exit */
} Passage;

/* ---- beginnings ---- */

/* Of two corners the one nearer to the walk's line, both being on one side of it, or the one farther along. */
static bool is_nearer(MesoComplex a, MesoComplex b)
{
    return fabs(a.im) < fabs(b.im) || (fabs(a.im) == fabs(b.im) && a.re > b.re);
}

/*
 * The side that the line of the walk enters the triangle by: from a corner on its left to one on its right. Where
 * rounding, a line along a side, or a heading out of the triangle puts all on one side, the nearest one counts as on
 * the other.
 */
static uint32_t entry_side(const MesoComplex corners[3])
{
    uint32_t nearest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        if (corners[k].im >= 0 && !(corners[meso_next_side(k)].im >= 0))
            return k;
        nearest = is_nearer(corners[k], corners[nearest]) ? k : nearest;
    }
    return corners[nearest].im >= 0 ? meso_previous_side(nearest) : nearest;
}

static void begin(const MesoWalkGround *ground, MesoWalkLane *lane, const MesoWalk *walk)
{
    const MesoTip *tip = &walk->tip;
    MesoComplex back = meso_complex_conjugate(tip->heading), corners[3], seen[3];
    meso_walk_corners(ground, tip->triangle, corners);
    MesoComplex origin = meso_walk_point(corners, tip->weight);
    for (uint32_t k = 0; k < 3; k++) {
        MesoComplex from = {corners[k].re - origin.re, corners[k].im - origin.im};
        seen[k] = meso_complex_times(from, back);
    }
    uint32_t k = entry_side(seen), next = meso_next_side(k);
    MesoComplex side = {corners[next].re - corners[k].re, corners[next].im - corners[k].im};
    *lane = (MesoWalkLane){.left = seen[k], .side = meso_complex_times(side, back), .length = walk->length,
                   .half_edge = 3 * tip->triangle + k, .walk = lane->walk, .begun = true};
}

/* ---- ends ---- */

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

/* The corner that a side's left end is, for a walk that comes in by it; right for one that leaves. */
static uint32_t begin_corner(const MesoWalkLane *lane, uint32_t side)
{
    return lane->turned ? meso_next_side(side) : side;
}

/* The other one. */
static uint32_t end_corner(const MesoWalkLane *lane, uint32_t side)
{
    return lane->turned ? side : meso_next_side(side);
}

/* Of the walk's last point, where that is inside. */
static void weigh_inside(const MesoWalkLane *lane, const Passage *passage, double weight[3])
{
    MesoComplex side = lane->side, to = {lane->length - lane->left.re, -lane->left.im};
    double square = side.re * side.re + side.im * side.im;
    double along = (to.re * side.re + to.im * side.im) / square;
    double above = (side.re * to.im - side.im * to.re) / square;
    /* the share of the far corner first: what is wrong with it in a flat triangle, the others make good */
    double far = passage->apex.im > 0 ? clamp(above / passage->apex.im, 0, 1) : 0;
    double right = clamp(along - far * passage->apex.re, 0, 1 - far);
    weight[meso_previous_side(passage->entry)] = far;
    weight[end_corner(lane, passage->entry)] = right;
    weight[begin_corner(lane, passage->entry)] = 1 - far - right;
}

/* Of a point between two corners. */
static void weigh_between(uint32_t from, uint32_t to, double share, double weight[3])
{
    weight[0] = weight[1] = weight[2] = 0;
    weight[from] = 1 - share;
    weight[to] = share;
}

/* The heading in the frame of the triangle, from that over the side. */
static MesoComplex heading_in(const MesoWalkGround *ground, const MesoWalkLane *lane)
{
    MesoComplex unit = meso_complex_unit(lane->side);
    MesoComplex over = {lane->turned ? -unit.re : unit.re, -unit.im};
    MesoComplex along = meso_walk_side(&ground->faces[lane->half_edge / 3], lane->half_edge % 3);
    return meso_complex_unit(meso_complex_times(over, along));
}

static void finish(const MesoWalkGround *ground, const MesoWalkLane *lane, MesoWalk *walk, const double weight[3],
                   MesoWalkStop stop, double rest)
{
    walk->tip = (MesoTip){lane->half_edge / 3, walk->tip.turned != lane->turned, {weight[0], weight[1], weight[2]},
                          heading_in(ground, lane)};
    walk->length = rest;
    walk->crossings = lane->crossings;
    walk->stop = stop;
}

/* ---- walking ---- */

static void tell_piece(const MesoWalkGround *ground, const MesoWalkOptions *options, const MesoWalkLane *lane,
                       const MesoWalk *walk, uint32_t leaves, const double weight[3])
{
    uint32_t triangle = lane->half_edge / 3, side = lane->half_edge % 3;
    bool first = lane->crossings == 0;
    MesoWalkPiece piece = {lane->walk, triangle, walk->tip.turned != lane->turned, first ? 3 : (uint8_t)side,
                           (uint8_t)leaves, {{0, 0}, {0, 0}}};
    MesoComplex corners[3];
    double entered[3];
    meso_walk_corners(ground, triangle, corners);
    weigh_between(begin_corner(lane, side), end_corner(lane, side), lane->share, entered);
    piece.ends[0] = meso_walk_point(corners, first ? walk->tip.weight : entered);
    piece.ends[1] = meso_walk_point(corners, weight);
    options->piece(options->context, &piece);
}

ALWAYS_INLINE Passage look_ahead(const MesoWalkFace *face, const MesoWalkLane *lane)
{
    Passage passage = {.entry = lane->half_edge % 3};
    passage.apex = face->apexes[passage.entry];
    passage.apex.re = lane->turned ? 1 - passage.apex.re : passage.apex.re;
    MesoComplex to_far = meso_complex_times(passage.apex, lane->side);
    MesoComplex far = {lane->left.re + to_far.re, lane->left.im + to_far.im};
    MesoComplex from_far = {lane->side.re - to_far.re, lane->side.im - to_far.im};
    passage.far_left = far.im >= 0;
    passage.left = passage.far_left ? far : lane->left;
    passage.side = passage.far_left ? from_far : to_far;
    passage.exit = passage.far_left != lane->turned ? meso_next_side(passage.entry) : meso_previous_side(passage.entry);
    MesoComplex end = {lane->length - passage.left.re, -passage.left.im};
    passage.ends = !(passage.side.re * end.im - passage.side.im * end.re > 0);
    return passage;
}

static void end_inside(const MesoWalkGround *ground, const MesoWalkLane *lane, const Passage *passage, MesoWalk *walk,
                       const MesoWalkOptions *options)
{
    double weight[3];
    weigh_inside(lane, passage, weight);
    if (options->piece)
        tell_piece(ground, options, lane, walk, 3, weight);
    finish(ground, lane, walk, weight, MESO_WALK_DONE, 0);
}

/* Where the walk meets the exit, as a share of it; along a side, where rounding tells nothing, as early as can be. */
static double share_at_exit(const MesoWalkLane *lane, const Passage *passage)
{
    double share = -passage->left.im / passage->side.im, x = passage->left.re + share * passage->side.re;
    if (fabs(passage->side.im) < fabs(passage->side.re) && !(x >= 0 && x <= lane->length))
        share = ((x > lane->length ? lane->length : 0) - passage->left.re) / passage->side.re;
    return clamp(share, 0, 1);
}

/* Tells the piece up to the exit, and says where on it that ends. */
static double reach_exit(const MesoWalkGround *ground, const MesoWalkLane *lane, const Passage *passage,
                         const MesoWalk *walk, const MesoWalkOptions *options, double weight[3])
{
    double share = share_at_exit(lane, passage);
    weigh_between(end_corner(lane, passage->exit), begin_corner(lane, passage->exit), share, weight);
    if (options->piece)
        tell_piece(ground, options, lane, walk, passage->exit, weight);
    return share;
}

static void end_on_side(const MesoWalkGround *ground, const MesoWalkLane *lane, const Passage *passage, MesoWalk *walk,
                        const MesoWalkOptions *options)
{
    double weight[3];
    double share = reach_exit(ground, lane, passage, walk, options, weight);
    double rest = clamp(lane->length - (passage->left.re + share * passage->side.re), 0, lane->length);
    bool border = ground->faces[lane->half_edge / 3].twins[passage->exit] == MESO_NO_INDEX;
    finish(ground, lane, walk, weight, border ? MESO_WALK_BORDER : MESO_WALK_LIMIT, rest);
}

/* Through one triangle; false where the walk ends in it. */
ALWAYS_INLINE bool step(const MesoWalkGround *ground, MesoWalkLane *lane, MesoWalk *walks,
                        const MesoWalkOptions *options)
{
    const MesoWalkFace *face = &ground->faces[lane->half_edge / 3];
    Passage passage = look_ahead(face, lane);
    if (passage.ends) {
        end_inside(ground, lane, &passage, &walks[lane->walk], options);
        return false;
    }
    uint32_t twin = face->twins[passage.exit];
    if (twin == MESO_NO_INDEX || lane->crossings >= options->crossing_limit) {
        end_on_side(ground, lane, &passage, &walks[lane->walk], options);
        return false;
    }
    if (options->piece) {
        double weight[3];
        lane->share = reach_exit(ground, lane, &passage, &walks[lane->walk], options, weight);
    }
    __builtin_prefetch(&ground->faces[twin / 3]);
    lane->left = passage.left;
    lane->side = passage.side;
    lane->half_edge = twin;
    lane->turned ^= meso_walk_turns(face, passage.exit);
    lane->crossings++;
    return true;
}

/* Gives a lane the next walk, which begins at the lane's next turn, when memory has come. */
static void take(const MesoWalkGround *ground, MesoWalkLane *lane, const MesoWalk *walks, uint32_t walk)
{
    uint32_t triangle = walks[walk].tip.triangle;
    *lane = (MesoWalkLane){.walk = walk};
    __builtin_prefetch(&ground->faces[triangle]);
    __builtin_prefetch(&ground->lengths[triangle]);
}

/* Walks those in the first `live` lanes to their ends, and then those from `taken` on. */
static void walk_all(const MesoWalkGround *ground, MesoWalk *walks, MesoWalkLane lanes[LANE_COUNT], uint32_t live,
                     uint32_t taken, uint32_t count, const MesoWalkOptions *options)
{
    while (live < LANE_COUNT && taken < count)
        take(ground, &lanes[live++], walks, taken++);
    while (live)
        for (uint32_t i = 0; i < live;) {
            MesoWalkLane *lane = &lanes[i];
            if (!lane->begun) {
                begin(ground, lane, &walks[lane->walk]);
                i++;
            } else if (step(ground, lane, walks, options)) {
                i++;
            } else if (taken < count) {
                take(ground, lane, walks, taken++);
                i++;
            } else {
                *lane = lanes[--live];
            }
        }
}

/* Memory that walks begin in. */
static void fetch(const MesoWalkGround *ground, const MesoWalk *walks, uint32_t begin_at, uint32_t end)
{
    for (uint32_t i = begin_at; i < end; i++) {
        __builtin_prefetch(&ground->faces[walks[i].tip.triangle]);
        __builtin_prefetch(&ground->lengths[walks[i].tip.triangle]);
    }
}

/* Most steps are short, and pieces are what takes time: walks begin in groups. */
static void walk_in_groups(const MesoWalkGround *ground, MesoWalk *walks, uint32_t count,
                           const MesoWalkOptions *options)
{
    MesoWalkLane lanes[LANE_COUNT];
    uint32_t taken = 0, fetched = 0, live = 0;
    for (; count - taken >= MESO_WALK_GROUP; taken += MESO_WALK_GROUP) {
        MesoWalkLane group[MESO_WALK_GROUP];
        uint32_t ahead = count - taken < LANE_COUNT ? count : taken + LANE_COUNT;
        fetch(ground, walks, fetched, ahead);
        fetched = ahead;
        uint32_t left = meso_walk_group(ground, walks, taken, options, group);
        for (; left; left &= left - 1)
            lanes[live++] = group[__builtin_ctz(left)];
        if (live > LANE_COUNT - MESO_WALK_GROUP) {
            walk_all(ground, walks, lanes, live, count, count, options);
            live = 0;
        }
    }
    walk_all(ground, walks, lanes, live, taken, count, options);
}

void meso_walks(const MesoWalkGround *ground, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options)
{
    MesoWalkOptions all = options ? *options : (MesoWalkOptions){0};
    MesoWalkLane lanes[LANE_COUNT];
    if (!all.crossing_limit)
        all.crossing_limit = MESO_WALK_CROSSINGS;
    if (all.piece)
        walk_in_groups(ground, walks, count, &all);
    else
        walk_all(ground, walks, lanes, 0, 0, count, &all);
}

/* ---- in space ---- */

void meso_tip_position(const MesoTriangulation *mesh, const MesoTip *tip, double position[3])
{
    const uint32_t *c = &mesh->corners[3 * (size_t)tip->triangle];
    position[0] = position[1] = position[2] = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 p = mesh->positions[c[k]];
        position[0] += tip->weight[k] * p.x;
        position[1] += tip->weight[k] * p.y;
        position[2] += tip->weight[k] * p.z;
    }
}

void meso_walk_direction(const MesoTriangulation *mesh, uint32_t triangle, MesoComplex direction, double out[3])
{
    MesoTriangleFrame frame = meso_frame(mesh, triangle);
    for (uint32_t i = 0; i < 3; i++)
        out[i] = direction.re * frame.x[i] + direction.im * frame.y[i];
}

bool meso_tip_head(MesoTip *tip, const MesoTriangulation *mesh, const double towards[3])
{
    MesoTriangleFrame frame = meso_frame(mesh, tip->triangle);
    MesoComplex part = {0, 0};
    for (uint32_t i = 0; i < 3; i++) {
        part.re += frame.x[i] * towards[i];
        part.im += frame.y[i] * towards[i];
    }
    double square = part.re * part.re + part.im * part.im;
    if (!(square > 0 && square < INFINITY))
        return false;
    tip->heading = meso_complex_unit(part);
    return true;
}
