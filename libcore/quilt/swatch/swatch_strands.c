/* Woven strands: weave, wire, armour. */
#include <math.h>

#include "libcore/quilt/swatch/swatch_maker.h"

/* How strands of a cloth look, in pitches. */
typedef struct Cloth {
    double width, height;       /* halves of a strand's cross-section */
    double rise;                /* how far strands go up and down from the middle */
    double spare;               /* by which the rise is larger, a pitch that strands stray */
    double corners;             /* 1: an ellipse; below: more of a box */
    uint32_t floats;            /* crossings that a strand stays on one side */
    uint32_t bands_per_pitch;
} Cloth;

/* One strand: along x at y = offset, or along y at x = offset; its crossings with the others. */
typedef struct Strand {
    const Cloth *cloth;
    uint32_t number, crossing_count;
    bool along_y;
    double length, offset, wander, wave, phase, rise;
    const struct Strand *others;    /* [crossing_count] */
} Strand;

/* How far sideways it is. Whole waves, so that both ends are alike. */
static double sideways(const Strand *strand, double along)
{
    return strand->offset + strand->wander * sin(2 * MESO_PI * strand->wave * along / strand->length + strand->phase);
}

static int64_t mod(int64_t a, int64_t n)
{
    return (a % n + n) % n;
}

/* Whether it lies over the other strand at a crossing, which may lie before the first and after the last. */
static double height_at(const Strand *strand, int64_t crossing)
{
    int64_t floats = strand->cloth->floats;
    bool over = mod(crossing + strand->number, 2 * floats) < floats;
    return over != strand->along_y ? strand->rise : -strand->rise;
}

static double crossing_at(const Strand *strand, int64_t crossing)
{
    int64_t last = (int64_t)strand->crossing_count - 1, inside = crossing < 0 ? 0 : crossing > last ? last : crossing;
    const Strand *other = &strand->others[inside];
    return sideways(other, strand->offset) + (double)(crossing - inside);
}

/* From crossing to crossing by half a wave of the cosine, which is smooth at both. */
static double height(const Strand *strand, double along)
{
    int64_t i = (int64_t)floor(along - 0.5);
    while (crossing_at(strand, i) > along)
        i--;
    while (crossing_at(strand, i + 1) <= along)
        i++;
    double from = crossing_at(strand, i), t = (along - from) / (crossing_at(strand, i + 1) - from);
    double a = height_at(strand, i), b = height_at(strand, i + 1);
    return a + (b - a) * (1 - cos(MESO_PI * t)) / 2;
}

static double power(double x, double exponent)
{
    return exponent == 1 ? x : copysign(pow(fabs(x), exponent), x);
}

/*
 * A ring across the strand, in the upright plane across its course as seen from above; at the ends across the axis,
 * so that ends are plane.
 */
static void add_ring(MesoSwatchMaker *maker, const Strand *strand, double along, bool at_end)
{
    double step = 1e-3, slope = (height(strand, along + step) - height(strand, along - step)) / (2 * step);
    double drift = (sideways(strand, along + step) - sideways(strand, along - step)) / (2 * step);
    double z = height(strand, along), side = sideways(strand, along), back = at_end ? 0 : 1;
    double flat = sqrt(1 + drift * drift), steep = sqrt(1 + slope * slope);
    for (uint32_t s = 0; s < maker->recipe.sides; s++) {
        double angle = 2 * MESO_PI * (s + 0.5) / maker->recipe.sides;
        double w = strand->cloth->width * power(cos(angle), strand->cloth->corners) * (strand->along_y ? -1 : 1);
        double h = strand->cloth->height * power(sin(angle), strand->cloth->corners);
        /* across: (-drift, 1, 0) / flat; up: (-slope, 0, 1) / steep */
        double x = along - back * (w * drift / flat + h * slope / steep);
        double y = side + w * (at_end ? flat : 1 / flat), up = z + h * (at_end ? steep : 1 / steep);
        if (strand->along_y)
            meso_maker_vertex(maker, y, x, up);
        else
            meso_maker_vertex(maker, x, y, up);
    }
}

/* The last ring is the first, a length further. */
static void repeat_ring(MesoSwatchMaker *maker, const Strand *strand, uint32_t first)
{
    for (uint32_t s = 0; s < maker->recipe.sides && !maker->status; s++) {
        MesoVec3 p = maker->positions[first + s];
        meso_maker_vertex(maker, (double)p.x + (strand->along_y ? 0 : strand->length),
                          (double)p.y + (strand->along_y ? strand->length : 0), (double)p.z);
    }
}

static void add_strand(MesoSwatchMaker *maker, const Strand *strand)
{
    uint32_t sides = maker->recipe.sides, first = maker->vertex_count;
    uint32_t bands = (uint32_t)strand->length * strand->cloth->bands_per_pitch;
    for (uint32_t i = 0; i < bands; i++)
        add_ring(maker, strand, strand->length * i / bands, i == 0);
    if (maker->recipe.jitter > 0)
        add_ring(maker, strand, strand->length, true);
    else
        repeat_ring(maker, strand, first);
    meso_maker_tube(maker, first, bands + 1, sides, false, strand->along_y);
}

static void init_strands(MesoSwatchMaker *maker, Strand *strands, uint32_t count, const Cloth *cloth, bool along_y,
                         double length)
{
    /* Neighbours keep most of their gap; where crossings come nearer to each other, strands rise higher between. */
    double most = (1 - 2 * cloth->width) / 10, room = 1 + cloth->spare * fmin(most, (double)maker->recipe.jitter);
    for (uint32_t i = 0; i < count; i++) {
        Strand *strand = &strands[i];
        *strand = (Strand){.cloth = cloth, .number = i, .along_y = along_y, .length = length};
        strand->offset = i + 0.5 + meso_maker_stray(maker, most);
        strand->wander = meso_maker_stray(maker, most);
        strand->wave = floor(length / 3 + 1);
        strand->phase = 100 * meso_maker_jitter(maker);
        strand->rise = cloth->rise * (room + fabs(meso_maker_jitter(maker)));
    }
}

static void make_cloth(MesoSwatchMaker *maker, const Cloth *cloth)
{
    uint32_t columns = maker->recipe.columns, rows = maker->recipe.rows;
    Strand *strands = MESO_NEW(maker->scratch, Strand, (size_t)columns + rows, maker->error);
    if (!strands) {
        maker->status = MESO_ERR_MEMORY;
        return;
    }
    Strand *across = strands + rows;
    init_strands(maker, strands, rows, cloth, false, columns);
    init_strands(maker, across, columns, cloth, true, rows);
    for (uint32_t i = 0; i < rows + columns; i++) {
        strands[i].others = i < rows ? across : strands;
        strands[i].crossing_count = i < rows ? columns : rows;
        add_strand(maker, &strands[i]);
    }
}

static void make_weave(MesoSwatchMaker *maker)
{
    double width = (double)maker->recipe.thickness / 2;
    Cloth cloth = {width, 0.4 * width, 0.5 * width, 12, 1, 1, 9};
    make_cloth(maker, &cloth);
}

static void make_wire(MesoSwatchMaker *maker)
{
    double width = (double)maker->recipe.thickness / 2;
    Cloth cloth = {width, width, 1.12 * width, 4, 1, 1, 9};
    make_cloth(maker, &cloth);
}

static void make_armour(MesoSwatchMaker *maker)
{
    double width = (double)maker->recipe.thickness / 2;
    Cloth cloth = {width, 0.2 * width, 0.38 * width, 28, 0.6, 2, 8};
    make_cloth(maker, &cloth);
}

static const MesoMakerMaterial WEAVE[2] = {{"weft", {{0.72f, 0.52f, 0.30f}, 0.6f, 0}},
                                           {"warp", {{0.45f, 0.24f, 0.10f}, 0.6f, 0}}};
static const MesoMakerMaterial WIRE[2] = {{"wire", {{0.77f, 0.78f, 0.78f}, 0.3f, 1}},
                                          {"copper", {{0.93f, 0.62f, 0.52f}, 0.3f, 1}}};
static const MesoMakerMaterial ARMOUR[2] = {{"steel", {{0.56f, 0.57f, 0.58f}, 0.35f, 1}},
                                            {"bronze", {{0.71f, 0.50f, 0.28f}, 0.35f, 1}}};

const MesoSwatchMethod meso_swatch_strand_methods[3] = {
    {{.name = "weave", .columns = 6, .rows = 6, .sides = 12, .thickness = 0.7f}, 2, 2, 1, WEAVE, 2, make_weave},
    {{.name = "wire", .columns = 6, .rows = 6, .sides = 12, .thickness = 0.2f}, 2, 2, 1, WIRE, 2, make_wire},
    {{.name = "armour", .columns = 8, .rows = 8, .sides = 18, .thickness = 0.8f}, 4, 4, 1, ARMOUR, 2, make_armour},
};
