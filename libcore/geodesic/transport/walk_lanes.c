/*
 * What straight_walk.c does in a walk's first triangles, by the same operations in the same order, in lanes. Corners
 * are counted from the side that the frame's x axis lies along: sums over corners are the same then, since the corner
 * at the origin adds zeros. What is rare is left to straight_walk.c.
 */
#include "libcore/geodesic/transport/walk_lanes.h"

#ifdef __GNUC__

enum { LANES = MESO_WALK_GROUP, ALL = (1 << LANES) - 1, MOST_CROSSINGS = 3 };


typedef double Lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t Bits __attribute__((vector_size(8 * LANES)));

#define INLINE static inline __attribute__((always_inline))

/* A vector of what an expression gives for each lane. */
#define EACH(type, of) ((type){of(0), of(1), of(2), of(3)})

typedef struct Plane {
    Lanes re, im;
} Plane;

/* Triangles, in their frames. */
typedef struct Places {
    const MesoWalkFace *faces[LANES];
    uint32_t bases[LANES], sides[LANES];    /* sides: by which walks have come in */
    Lanes size;             /* the longest side's */
    Plane apex;             /* over it */
    Bits second, third;     /* walks have come in by the side after it, or by the one before it */
} Places;

typedef struct Walkers {
    Plane left, side;       /* as a lane's */
    Lanes length;
    Plane from;             /* where their pieces begin, in the frames */
} Walkers;

/* What lies ahead, and where pieces end: weights of the left end of the entry, of the right one, and across. */
typedef struct Ahead {
    Plane left, side;       /* of the exit */
    Bits far_left;
    Lanes share;            /* of the exit */
    Bits ends, plain;       /* the walk ends inside; otherwise rounding tells where it leaves */
    Lanes weights[3];
} Ahead;

/* ---- lanes ---- */

INLINE Lanes all(double a)
{
    return (Lanes){a, a, a, a};
}

INLINE Lanes choose(Bits which, Lanes a, Lanes b)
{
    return (Lanes)((which & (Bits)a) | (~which & (Bits)b));
}

INLINE Plane choose_plane(Bits which, Plane a, Plane b)
{
    return (Plane){choose(which, a.re, b.re), choose(which, a.im, b.im)};
}

INLINE Lanes clamp(Lanes x, Lanes low, Lanes high)
{
    Lanes above = choose(x > low, x, low);
    return choose(above < high, above, high);
}

INLINE Lanes absolute(Lanes a)
{
    return (Lanes)((Bits)a & INT64_MAX);
}

INLINE Lanes root(Lanes a)
{
#define ROOT(lane) __builtin_sqrt(a[lane])
    return EACH(Lanes, ROOT);
}

INLINE Plane minus(Plane a, Plane b)
{
    return (Plane){a.re - b.re, a.im - b.im};
}

INLINE Plane times(Plane a, Plane b)
{
    return (Plane){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

INLINE Plane unit(Plane a)
{
    Lanes length = root(a.re * a.re + a.im * a.im);
    Bits has = (length > 0) & (length < INFINITY);
    return choose_plane(has, (Plane){a.re / length, a.im / length}, (Plane){all(1), all(0)});
}

INLINE uint32_t bits_of(Bits a)
{
    return (uint32_t)((a[0] & 1) | (a[1] & 2) | (a[2] & 4) | (a[3] & 8));
}

/* ---- triangles ---- */

INLINE void stand(Places *places, const MesoWalkGround *ground, const uint32_t triangles[LANES])
{
    for (uint32_t lane = 0; lane < LANES; lane++) {
        places->faces[lane] = &ground->faces[triangles[lane]];
        places->bases[lane] = meso_walk_base(places->faces[lane]);
    }
#define SIZE(lane) ground->lengths[triangles[lane]]
#define APEX_RE(lane) places->faces[lane]->apexes[places->bases[lane]].re
#define APEX_IM(lane) places->faces[lane]->apexes[places->bases[lane]].im
    places->size = EACH(Lanes, SIZE);
    places->apex = (Plane){EACH(Lanes, APEX_RE), EACH(Lanes, APEX_IM)};
}

/* Where the side's number is known. */
INLINE void set_entry(Places *places)
{
#define FROM_BASE(lane) (int64_t)((places->sides[lane] + 3 - places->bases[lane]) % 3)
    Bits from_base = EACH(Bits, FROM_BASE);
    places->second = from_base == 1;
    places->third = from_base == 2;
}

INLINE Plane point_at(const Places *places, Lanes second, Lanes third)
{
    return (Plane){second * places->size + third * (places->size * places->apex.re) + 0,
                   third * (places->size * places->apex.im) + 0};
}

/* Of weights by the side that walks have come in by. */
INLINE Plane point_of(const Places *places, Lanes left, Lanes right, Lanes far)
{
    return point_at(places, choose(places->second, left, choose(places->third, far, right)),
                    choose(places->second, right, choose(places->third, left, far)));
}

/* ---- walks ---- */

/* Begins walks; those lanes that rounding does not decide. */
INLINE Bits begin(Walkers *walkers, Places *places, const MesoWalk *walks)
{
#define HEADING_RE(lane) walks[lane].tip.heading.re
#define HEADING_IM(lane) walks[lane].tip.heading.im
#define SECOND(lane) walks[lane].tip.weight[meso_next_side(places->bases[lane])]
#define THIRD(lane) walks[lane].tip.weight[meso_previous_side(places->bases[lane])]
    Plane back = {EACH(Lanes, HEADING_RE), -EACH(Lanes, HEADING_IM)}, seen[3];
    Plane origin = point_at(places, EACH(Lanes, SECOND), EACH(Lanes, THIRD));
    const Plane corners[3] = {{all(0), all(0)}, {places->size, all(0)},
                              {places->size * places->apex.re, places->size * places->apex.im}};
    for (uint32_t k = 0; k < 3; k++)
        seen[k] = times(minus(corners[k], origin), back);
    Bits left[3] = {seen[0].im >= 0, seen[1].im >= 0, seen[2].im >= 0};
    Bits first = left[0] & ~left[1], second = left[1] & ~left[2], third = left[2] & ~left[0];
    Plane from = choose_plane(second, corners[1], choose_plane(third, corners[2], corners[0]));
    Plane to = choose_plane(second, corners[2], choose_plane(third, corners[0], corners[1]));
    walkers->left = choose_plane(second, seen[1], choose_plane(third, seen[2], seen[0]));
    walkers->side = times(minus(to, from), back);
    walkers->from = origin;
    places->second = second;
    places->third = third;
    Bits from_base = (second & 1) | (third & 2);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t side = places->bases[lane] + (uint32_t)from_base[lane];
        places->sides[lane] = side >= 3 ? side - 3 : side;
    }
    return ~(first | second | third);
}

/* Over the sides that walks have come in by. */
INLINE Plane far_apex(const Places *places)
{
#define FAR_RE(lane) places->faces[lane]->apexes[places->sides[lane]].re
#define FAR_IM(lane) places->faces[lane]->apexes[places->sides[lane]].im
    return (Plane){EACH(Lanes, FAR_RE), EACH(Lanes, FAR_IM)};
}

INLINE Ahead look_ahead(const Walkers *walkers, const Places *places)
{
    Ahead ahead;
    Plane side = walkers->side, left = walkers->left, apex = far_apex(places);
    Plane to_far = times(apex, side), from_far = minus(side, to_far);
    Plane far = {left.re + to_far.re, left.im + to_far.im};
    ahead.far_left = far.im >= 0;
    ahead.left = choose_plane(ahead.far_left, far, left);
    ahead.side = choose_plane(ahead.far_left, from_far, to_far);
    Plane end = {walkers->length - ahead.left.re, -ahead.left.im};
    ahead.ends = ~(ahead.side.re * end.im - ahead.side.im * end.re > 0);

    /* inside */
    Plane to = {walkers->length - left.re, -left.im};
    Lanes square = side.re * side.re + side.im * side.im;
    Lanes along = (to.re * side.re + to.im * side.im) / square, above = (side.re * to.im - side.im * to.re) / square;
    Lanes across = choose(apex.im > 0, clamp(above / apex.im, all(0), all(1)), all(0));
    Lanes right = clamp(along - across * apex.re, all(0), 1 - across);

    /* on the exit */
    Lanes share = -ahead.left.im / ahead.side.im, x = ahead.left.re + share * ahead.side.re;
    ahead.plain = ~(absolute(ahead.side.im) < absolute(ahead.side.re)) | ((x >= 0) & (x <= walkers->length));
    ahead.share = clamp(share, all(0), all(1));
    ahead.weights[0] = choose(ahead.ends, 1 - across - right, choose(ahead.far_left, all(0), 1 - ahead.share));
    ahead.weights[1] = choose(ahead.ends, right, choose(ahead.far_left, ahead.share, all(0)));
    ahead.weights[2] = choose(ahead.ends, across, choose(ahead.far_left, 1 - ahead.share, ahead.share));
    return ahead;
}

/* Directions where walks end, in the frames. */
INLINE Plane heading_in(const Walkers *walkers, const Places *places)
{
    Plane over = unit(walkers->side), apex = places->apex;
    Plane along = choose_plane(places->second, (Plane){apex.re - 1, apex.im},
                               choose_plane(places->third, (Plane){-apex.re, -apex.im}, (Plane){all(1), all(0)}));
    return unit(times((Plane){over.re, -over.im}, unit(along)));
}

INLINE void finish(MesoWalk *walk, uint32_t triangle, uint32_t side, double left, double right, double far,
                   MesoComplex heading, uint32_t crossings)
{
    walk->tip.triangle = triangle;
    walk->tip.weight[side] = left;
    walk->tip.weight[meso_next_side(side)] = right;
    walk->tip.weight[meso_previous_side(side)] = far;
    walk->tip.heading = heading;
    walk->length = 0;
    walk->crossings = crossings;
    walk->stop = MESO_WALK_DONE;
}

INLINE void finish_some(MesoWalk *walks, uint32_t which, const uint32_t triangles[LANES], const Walkers *walkers,
                        const Places *places, const Ahead *ahead, uint32_t crossings)
{
    Plane heading = heading_in(walkers, places);
    for (uint32_t lane = 0; lane < LANES; lane++)
        if (which >> lane & 1)
            finish(&walks[lane], triangles[lane], places->sides[lane], ahead->weights[0][lane],
                   ahead->weights[1][lane], ahead->weights[2][lane],
                   (MesoComplex){heading.re[lane], heading.im[lane]}, crossings);
}

/* Of the lanes that leave those that go to where all is as in the first triangle; half-edges by which they come in. */
INLINE uint32_t cross(uint32_t which, const Places *places, const Ahead *ahead, uint32_t entries[LANES])
{
    uint32_t crossing = which & bits_of(ahead->plain), far_left = bits_of(ahead->far_left);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t side = places->sides[lane];
        uint32_t exit = far_left >> lane & 1 ? meso_next_side(side) : meso_previous_side(side);
        entries[lane] = places->faces[lane]->twins[exit];
        if (entries[lane] == MESO_NO_INDEX || meso_walk_turns(places->faces[lane], exit))
            crossing &= ~(1u << lane);
    }
    return crossing;
}

INLINE void tell(const MesoWalkOptions *options, const MesoWalk *walks, uint32_t first, uint32_t which, uint32_t ended,
                 const uint32_t triangles[LANES], const Walkers *walkers, const Places *places, const Ahead *ahead,
                 bool begins)
{
    Plane to = point_of(places, ahead->weights[0], ahead->weights[1], ahead->weights[2]);
    uint32_t far_left = bits_of(ahead->far_left);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        if (!(which >> lane & 1))
            continue;
        uint32_t side = places->sides[lane];
        uint32_t exit = far_left >> lane & 1 ? meso_next_side(side) : meso_previous_side(side);
        const MesoWalkPiece piece = {first + lane, triangles[lane], walks[lane].tip.turned,
                                     begins ? 3 : (uint8_t)side, ended >> lane & 1 ? 3 : (uint8_t)exit,
                                     {{walkers->from.re[lane], walkers->from.im[lane]}, {to.re[lane], to.im[lane]}}};
        options->piece(options->context, &piece);
    }
}

INLINE void hand_over(MesoWalkLane *lanes, uint32_t which, uint32_t first, const uint32_t triangles[LANES],
                      const Walkers *walkers, const Places *places, const Lanes *share, uint32_t crossings)
{
    for (uint32_t lane = 0; lane < LANES; lane++)
        if (which >> lane & 1)
            lanes[lane] = (MesoWalkLane){{walkers->left.re[lane], walkers->left.im[lane]},
                                         {walkers->side.re[lane], walkers->side.im[lane]},
                                         walkers->length[lane], (*share)[lane],
                                         3 * triangles[lane] + places->sides[lane], crossings, first + lane, true,
                                         false};
}

INLINE uint32_t walk_group(const MesoWalkGround *ground, MesoWalk *all_walks, uint32_t first,
                           const MesoWalkOptions *options, MesoWalkLane lanes[LANES])
{
    MesoWalk *walks = &all_walks[first];
    uint32_t triangles[LANES], entries[LANES], left = 0;
    Places places;
    Walkers walkers;
    Lanes share = all(0);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        triangles[lane] = walks[lane].tip.triangle;
        lanes[lane] = (MesoWalkLane){.walk = first + lane};
    }
#define LENGTH(lane) walks[lane].length
    walkers.length = EACH(Lanes, LENGTH);
    stand(&places, ground, triangles);
    /* as a rule they cross more sides than are gone through here */
    if (bits_of(walkers.length > places.size) == ALL)
        return ALL;
    left = bits_of(begin(&walkers, &places, walks));
    for (uint32_t under_way = ALL & ~left, crossings = 0;; crossings++) {
        Ahead ahead = look_ahead(&walkers, &places);
        uint32_t ended = under_way & bits_of(ahead.ends), crossing = 0;
        if (under_way != ended && crossings < MOST_CROSSINGS && crossings < options->crossing_limit)
            crossing = cross(under_way & ~ended, &places, &ahead, entries);
        uint32_t stays = under_way & ~(ended | crossing);
        hand_over(lanes, stays, first, triangles, &walkers, &places, &share, crossings);
        left |= stays;
        if (ended)
            finish_some(walks, ended, triangles, &walkers, &places, &ahead, crossings);
        tell(options, walks, first, ended | crossing, ended, triangles, &walkers, &places, &ahead, crossings == 0);
        if (!crossing)
            return left;
        under_way = crossing;
        walkers.left = ahead.left;
        walkers.side = ahead.side;
        share = ahead.share;
        for (uint32_t lane = 0; lane < LANES; lane++) {
            bool goes = crossing >> lane & 1;
            triangles[lane] = goes ? entries[lane] / 3 : triangles[lane];
            places.sides[lane] = goes ? entries[lane] % 3 : places.sides[lane];
        }
        stand(&places, ground, triangles);
        set_entry(&places);
        walkers.from = point_of(&places, 1 - share, share, all(0));
    }
}

/* The same operations, and so the same bytes, on wider registers. */
#ifdef __x86_64__
__attribute__((target("avx2"))) static uint32_t walk_group_avx2(const MesoWalkGround *ground, MesoWalk *walks,
                                                                uint32_t first, const MesoWalkOptions *options,
                                                                MesoWalkLane lanes[LANES])
{
    return walk_group(ground, walks, first, options, lanes);
}
#endif

uint32_t meso_walk_group(const MesoWalkGround *ground, MesoWalk *walks, uint32_t first, const MesoWalkOptions *options,
                         MesoWalkLane lanes[LANES])
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2"))
        return walk_group_avx2(ground, walks, first, options, lanes);
#endif
    return walk_group(ground, walks, first, options, lanes);
}

#else

uint32_t meso_walk_group(const MesoWalkGround *ground, MesoWalk *walks, uint32_t first, const MesoWalkOptions *options,
                         MesoWalkLane lanes[MESO_WALK_GROUP])
{
    (void)ground, (void)walks, (void)options;
    for (uint32_t lane = 0; lane < MESO_WALK_GROUP; lane++)
        lanes[lane] = (MesoWalkLane){.walk = first + lane};
    return (1u << MESO_WALK_GROUP) - 1;
}

#endif
