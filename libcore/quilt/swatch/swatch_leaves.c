/* Leaves: ivy, whose leaves stand by its stems, and scales. */
#include <math.h>

#include "libcore/quilt/swatch/swatch_maker.h"

/* ---- ivy ---- */

enum { IVY_STATIONS = 6 };

/* A leaf of five lobes, from its stalk: how far the rib is, the edges are, these are apart, and half its thickness. */
static const double IVY[IVY_STATIONS][4] = {{0.10, 0.10, 0.014, 0.014}, {0.15, 0.09, 0.13, 0.012},
                                            {0.22, 0.13, 0.19, 0.012},  {0.29, 0.28, 0.12, 0.012},
                                            {0.36, 0.40, 0.17, 0.010},  {0.46, 0.46, 0.07, 0.008}};
#define IVY_TIP 0.58

/* Pitches that a leaf of length 1 above takes, and that stems and leaves stray without touching each other. */
#define IVY_SIZE 1.15
#define IVY_STRAY 0.04

/* A stalk ends so far from the stem. */
#define IVY_GAP 0.006

typedef struct Stem {
    double length, offset, drift, swing, phase, radius;
    uint32_t sides;             /* even: it is alike to both sides, where leaves begin */
} Stem;

/* A leaf begins at the stem, to the side and a little ahead; all alike, so that those of neighbours mesh. */
typedef struct Leaf {
    double x, y, z;             /* where it begins, in the middle of the stem */
    double ahead_x, ahead_y;    /* its way, of length 1 */
    double size, rise;
    double begin;               /* where its stalk begins, as a part of the size */
} Leaf;

static double stem_y(const Stem *stem, double x)
{
    return stem->offset + stem->drift * (x / stem->length - 0.5) + stem->swing * sin(MESO_PI * x + stem->phase);
}

static double stem_slope(const Stem *stem, double x)
{
    return stem->drift / stem->length + stem->swing * MESO_PI * cos(MESO_PI * x + stem->phase);
}

/* Across the course, but for the ends, which are plane. */
static void add_stem_ring(MesoSwatchMaker *maker, const Stem *stem, double x, bool at_end)
{
    double slope = stem_slope(stem, x), flat = sqrt(1 + slope * slope);
    for (uint32_t s = 0; s < stem->sides; s++) {
        double angle = 2 * MESO_PI * (s - 0.5) / stem->sides;
        double out = stem->radius * cos(angle), up = stem->radius * sin(angle);
        if (at_end)
            meso_maker_vertex(maker, x, stem_y(stem, x) + out * flat, up);
        else
            meso_maker_vertex(maker, x - out * slope / flat, stem_y(stem, x) + out / flat, up);
    }
}

static uint32_t add_leaf_point(MesoSwatchMaker *maker, const Leaf *leaf, double along, double across, double up)
{
    double s = leaf->size, bend = leaf->rise * along - 0.5 * along * along;
    return meso_maker_vertex(maker, leaf->x + s * (along * leaf->ahead_x - across * leaf->ahead_y),
                             leaf->y + s * (along * leaf->ahead_y + across * leaf->ahead_x), leaf->z + s * (bend + up));
}

/*
 * Rings of four, the rib below, an edge, the rib above, the other edge; the blade is folded along the rib. It is an element
 * of its own, whose stalk ends where the stem's side is, without touching it: it stays whole wherever the stem is cut.
 */
static void add_leaf(MesoSwatchMaker *maker, const Leaf *leaf)
{
    uint32_t ring = maker->vertex_count;
    for (uint32_t i = 0; i <= IVY_STATIONS; i++) {
        const double *at = IVY[i ? i - 1 : 0];
        double along = i ? at[0] : leaf->begin, edge = i ? at[1] : leaf->begin, lift = 0.3 * at[2];
        add_leaf_point(maker, leaf, along, 0, -at[3]);
        add_leaf_point(maker, leaf, edge, at[2], lift);
        add_leaf_point(maker, leaf, along, 0, at[3]);
        add_leaf_point(maker, leaf, edge, -at[2], lift);
    }
    meso_maker_tube(maker, ring, IVY_STATIONS + 1, 4, false, 1);
    meso_maker_fan(maker, ring, 4, add_leaf_point(maker, leaf, leaf->begin, 0, 0), false, 1);
    uint32_t tip = add_leaf_point(maker, leaf, IVY_TIP, 0, 0.02);
    meso_maker_fan(maker, ring + 4 * IVY_STATIONS, 4, tip, true, 1);
}

/* A leaf beside the stem at `x`, to the left of its way or to the right. */
static void add_leaf_at(MesoSwatchMaker *maker, const Stem *stem, double x, bool right)
{
    double turn = 0.35 + 2 * meso_maker_stray(maker, IVY_STRAY), length = hypot(turn, 1);
    Leaf leaf = {.x = x, .y = stem_y(stem, x), .ahead_x = turn / length, .ahead_y = (right ? -1 : 1) / length};
    leaf.size = IVY_SIZE + 2 * meso_maker_stray(maker, IVY_STRAY);
    leaf.rise = 0.6 + 2 * meso_maker_stray(maker, IVY_STRAY);
    double across = fabs(leaf.ahead_y - stem_slope(stem, x) * leaf.ahead_x) / hypot(1, stem_slope(stem, x));
    leaf.begin = (stem->radius / across + IVY_GAP) / leaf.size;
    add_leaf(maker, &leaf);
}

static void add_stem_faces(MesoSwatchMaker *maker, const Stem *stem, uint32_t first, uint32_t bands)
{
    for (uint32_t r = 0; r < bands; r++)
        for (uint32_t s = 0; s < stem->sides; s++) {
            uint32_t a = first + r * stem->sides, b = a + stem->sides, t = (s + 1) % stem->sides;
            float u0 = (float)s / (float)stem->sides, u1 = (float)(s + 1) / (float)stem->sides;
            float v0 = (float)r / (float)bands, v1 = (float)(r + 1) / (float)bands;
            uint32_t v[4] = {a + s, a + t, b + t, b + s};
            MesoVec2 uv[4] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
            meso_maker_face(maker, v, uv, 0);
        }
}

/* Three bands for half a pitch: before a leaf, the leaf's own, which is narrow, and behind it. */
static double band_begin(uint32_t band)
{
    static const double at[3] = {0, 0.21, 0.29};
    return 0.5 * (band / 3) + at[band % 3];
}

static void add_ivy(MesoSwatchMaker *maker, const Stem *stem)
{
    uint32_t first = maker->vertex_count, bands = 6 * maker->recipe.columns;
    for (uint32_t r = 0; r <= bands; r++) {
        bool repeats = r == bands && maker->recipe.jitter <= 0;
        if (!repeats)
            add_stem_ring(maker, stem, band_begin(r), r == 0 || r == bands);
        for (uint32_t s = 0; s < stem->sides && repeats && !maker->status; s++) {
            MesoVec3 p = maker->positions[first + s];
            meso_maker_vertex(maker, (double)p.x + stem->length, (double)p.y, (double)p.z);
        }
    }
    add_stem_faces(maker, stem, first, bands);
    for (uint32_t r = 1; r < bands; r += 3)
        add_leaf_at(maker, stem, 0.25 + 0.5 * (r / 3), r / 3 % 2);
}

static void make_ivy(MesoSwatchMaker *maker)
{
    for (uint32_t j = 0; j < maker->recipe.rows; j++) {
        Stem stem = {.length = maker->recipe.columns, .sides = (maker->recipe.sides + 1) / 2 * 2};
        stem.offset = j + 0.5 + meso_maker_stray(maker, IVY_STRAY);
        stem.drift = meso_maker_stray(maker, IVY_STRAY);
        stem.swing = 0.14 + meso_maker_stray(maker, IVY_STRAY) / 2;
        stem.phase = 3 * meso_maker_stray(maker, IVY_STRAY);
        stem.radius = (double)maker->recipe.thickness / 2;
        add_ivy(maker, &stem);
    }
}

/* ---- scales ---- */

#define SCALE_ROW 0.5       /* rows stand so far apart, and lie over each other by as much */
#define SCALE_SLOPE 0.32
#define SCALE_CROWN 0.25

enum { SCALE_RINGS = 5 };

/* Rings from the middle of the lower side to that of the upper one: how far out, and how far up, in parts. */
static const double SCALE[SCALE_RINGS][2] = {{0.45, -0.9}, {0.85, -0.6}, {1, 0}, {0.85, 0.6}, {0.45, 0.9}};

typedef struct Scale {
    double x, y, size, roll, half_height;
} Scale;

/* A scale leans down towards its tip, at low y, and is crowned. */
static uint32_t add_scale_point(MesoSwatchMaker *maker, const Scale *scale, double x, double y, double up)
{
    double base = -SCALE_SLOPE * y - SCALE_CROWN * x * x + scale->roll * x;
    return meso_maker_vertex(maker, scale->x + x, scale->y + y, base + up * scale->half_height);
}

static void add_scale(MesoSwatchMaker *maker, const Scale *scale)
{
    uint32_t sides = maker->recipe.sides, first = maker->vertex_count;
    for (uint32_t r = 0; r < SCALE_RINGS; r++)
        for (uint32_t s = 0; s < sides; s++) {
            double angle = 2 * MESO_PI * s / sides, c = cos(angle), d = sin(angle);
            double narrow = d < 0 ? 1 - 0.25 * d * d * d * d : 1, out = SCALE[r][0] * scale->size;
            add_scale_point(maker, scale, 0.47 * out * c * narrow, (d < 0 ? 0.56 : 0.46) * out * d, SCALE[r][1]);
        }
    meso_maker_tube(maker, first, SCALE_RINGS, sides, false, 0);
    meso_maker_fan(maker, first, sides, add_scale_point(maker, scale, 0, 0, -1), false, 0);
    meso_maker_fan(maker, first + (SCALE_RINGS - 1) * sides, sides, add_scale_point(maker, scale, 0, 0, 1), true, 0);
}

/* Rows that lie over the ones before, each half a pitch further. */
static void make_scales(MesoSwatchMaker *maker)
{
    for (uint32_t j = 0; j < maker->recipe.rows; j++)
        for (uint32_t i = 0; i < maker->recipe.columns; i++) {
            Scale scale = {.x = i + 0.25 + 0.5 * (j % 2), .y = (j + 0.5) * SCALE_ROW};
            scale.x += meso_maker_stray(maker, 0.015);
            scale.y += meso_maker_stray(maker, 0.03);
            scale.size = 1 - fmin(0.1, fabs(meso_maker_jitter(maker)));
            scale.roll = meso_maker_stray(maker, 0.05);
            scale.half_height = (double)maker->recipe.thickness / 2;
            add_scale(maker, &scale);
        }
}

static const MesoMakerMaterial IVIES[2] = {{"stem", {{0.20f, 0.13f, 0.06f}, 0.8f, 0}},
                                         {"leaf", {{0.07f, 0.26f, 0.05f}, 0.5f, 0}}};
static const MesoMakerMaterial SCALES[1] = {{"scale", {{0.16f, 0.36f, 0.32f}, 0.3f, 0}}};

const MesoSwatchMethod meso_swatch_leaf_methods[2] = {
    {{.name = "ivy", .columns = 2, .rows = 2, .sides = 6, .thickness = 0.09f}, 2, 2, 1, IVIES, 2, make_ivy},
    {{.name = "scales", .columns = 4, .rows = 8, .sides = 20, .thickness = 0.07f}, 1, 2, 2, SCALES, 1, make_scales},
};
