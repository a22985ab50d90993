/* Rings: mail, rings, nuts. */
#include <math.h>

#include "libcore/quilt/swatch/swatch_maker.h"

/* Pitches of mail at which wires that are bent to circles keep furthest apart: 0.197 from middle to middle. */
#define MAIL_RADIUS 0.40
#define MAIL_ROW 0.26
#define MAIL_LEAN 0.55

/* Part of its room that a nut takes. */
#define NUT_RADIUS 0.48

typedef struct Vec {
    double x, y, z;
} Vec;

/* A frame: where its x, y and z come to lie. */
typedef struct Frame {
    Vec centre, x, y, z;
} Frame;

static Vec place(const Frame *frame, double x, double y, double z)
{
    return (Vec){frame->centre.x + x * frame->x.x + y * frame->y.x + z * frame->z.x,
                 frame->centre.y + x * frame->x.y + y * frame->y.y + z * frame->z.y,
                 frame->centre.z + x * frame->x.z + y * frame->y.z + z * frame->z.z};
}

/* Turned by `spin` about z, then leant about x. */
static Frame lean(Vec centre, double spin, double angle)
{
    double c = cos(spin), s = sin(spin), d = cos(angle), t = sin(angle);
    return (Frame){centre, {c, s * d, s * t}, {-s, c * d, c * t}, {0, -t, d}};
}

/* A torus around the frame's z. */
static void add_ring(MesoSwatchMaker *maker, const Frame *frame, double radius, double wire, uint32_t material)
{
    uint32_t sides = maker->recipe.sides, rings = 2 * sides, first = maker->vertex_count;
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t s = 0; s < sides; s++) {
            double a = 2 * MESO_PI * r / rings, b = 2 * MESO_PI * s / sides, out = radius - wire * cos(b);
            Vec p = place(frame, out * cos(a), out * sin(a), wire * sin(b));
            meso_maker_vertex(maker, p.x, p.y, p.z);
        }
    meso_maker_tube(maker, first, rings, sides, true, material);
}

/*
 * European 4-in-1: rows of rings that lean to the one side and to the other, each half a pitch further; each ring goes
 * through two of the row before and two of the row behind.
 */
static void make_mail(MesoSwatchMaker *maker)
{
    double wire = fmin((double)maker->recipe.thickness / 2, 0.09);
    double free = (0.197 - 2 * wire) / 6;       /* what each of two may stray without touching the other, and some */
    for (uint32_t j = 0; j < maker->recipe.rows; j++)
        for (uint32_t i = 0; i < maker->recipe.columns; i++) {
            double x = meso_maker_stray(maker, free);
            double y = meso_maker_stray(maker, free);
            double turn = meso_maker_stray(maker, free);
            Vec centre = {i + 0.25 + 0.5 * (j % 2) + x, (j + 0.5) * MAIL_ROW + y, 0};
            Frame frame = lean(centre, meso_maker_jitter(maker), (j % 2 ? -MAIL_LEAN : MAIL_LEAN) + turn);
            add_ring(maker, &frame, MAIL_RADIUS, wire, j % 2);
        }
}

/* Japanese 4-in-1: rings that lie flat, and between neighbours one that stands upright and goes through both. */
static void make_rings(MesoSwatchMaker *maker)
{
    double wire = fmin((double)maker->recipe.thickness / 2, 0.07), free = 0.3 * (0.1 - wire);
    for (uint32_t j = 0; j < maker->recipe.rows; j++)
        for (uint32_t i = 0; i < maker->recipe.columns; i++) {
            double x = i + 0.5 + meso_maker_stray(maker, free);
            double y = j + 0.5 + meso_maker_stray(maker, free);
            Frame flat = lean((Vec){x, y, 0}, 0, meso_maker_jitter(maker) / 8);
            Frame along_x = {{i + 1.0, y, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
            Frame along_y = {{x, j + 1.0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
            add_ring(maker, &flat, 0.46 - wire, wire, 0);
            add_ring(maker, &along_x, 0.22 + wire, wire, 1);
            add_ring(maker, &along_y, 0.22 + wire, wire, 1);
        }
}

/* ---- nuts ---- */

/* From the hole's middle up, over the top, down the outside and back: parts of the radius, and of half the height. */
static const double NUT[18][2] = {
    {0.50, -0.30}, {0.50, 0.30}, {0.50, 0.76}, {0.52, 0.84}, {0.60, 0.98}, {0.63, 1.0},  {0.80, 1.0},  {0.84, 0.99},
    {1.0, 0.80},   {1.0, 0.72},  {1.0, -0.72}, {1.0, -0.80}, {0.84, -0.99}, {0.80, -1.0}, {0.63, -1.0}, {0.60, -0.98},
    {0.52, -0.84}, {0.50, -0.76},
};

/* Six sides with six steps each, which stand close at the edges. */
static double hexagon_angle(uint32_t step)
{
    static const double at[6] = {-28.8, -24, -9, 9, 24, 28.8};
    return (60 * (step / 6) + at[step % 6]) * MESO_PI / 180;
}

/* How far out the hexagon reaches there, with edges a little rounded; 1 at most. */
static double hexagon_reach(double angle)
{
    double within = fmod(angle + 7 * MESO_PI / 6, MESO_PI / 3) - MESO_PI / 6;
    return fmin(cos(MESO_PI / 6) / cos(within), 0.985);
}

/* Round inside, a hexagon outside; chamfers are cones, which cut the hexagon's corners lower than its sides. */
static void add_nut(MesoSwatchMaker *maker, const Frame *frame, double radius, double half_height)
{
    uint32_t first = maker->vertex_count;
    for (uint32_t r = 0; r < 36; r++) {
        double angle = hexagon_angle(r), reach = hexagon_reach(angle);
        for (uint32_t s = 0; s < 18; s++) {
            double out = NUT[s][0], height = NUT[s][1];
            if (out >= 0.95) {
                out = reach;
                if (fabs(height) >= 0.79)
                    height = copysign(1 - 0.55 * (reach - 0.80), height);
            }
            Vec p = place(frame, radius * out * cos(angle), radius * out * sin(angle), half_height * height);
            meso_maker_vertex(maker, p.x, p.y, p.z);
        }
    }
    meso_maker_tube(maker, first, 36, 18, true, 0);
}

/* Rows of hexagons, each half a pitch further; strewn ones are turned, and have less room each. */
static void make_nuts(MesoSwatchMaker *maker)
{
    double jitter = (double)maker->recipe.jitter, stray = fmin(jitter, 0.1) / 2;
    double radius = NUT_RADIUS - stray * sqrt(2), row = sqrt(0.75);
    for (uint32_t j = 0; j < maker->recipe.rows; j++)
        for (uint32_t i = 0; i < maker->recipe.columns; i++) {
            double scale = jitter > 0 ? stray / jitter : 0;
            Vec centre = {i + 0.25 + 0.5 * (j % 2) + scale * meso_maker_jitter(maker),
                          (j + 0.5) * row + scale * meso_maker_jitter(maker), 0};
            Frame frame = lean(centre, MESO_PI / 6 + 40 * meso_maker_jitter(maker), meso_maker_jitter(maker));
            add_nut(maker, &frame, radius, (double)maker->recipe.thickness / 2);
        }
}

static const MesoMakerMaterial MAIL[2] = {{"steel", {{0.66f, 0.66f, 0.67f}, 0.3f, 1}},
                                          {"dark steel", {{0.44f, 0.45f, 0.48f}, 0.35f, 1}}};
static const MesoMakerMaterial RINGS[2] = {{"gold", {{0.95f, 0.73f, 0.35f}, 0.25f, 1}},
                                           {"silver", {{0.85f, 0.85f, 0.84f}, 0.25f, 1}}};
static const MesoMakerMaterial NUTS[1] = {{"zinc", {{0.66f, 0.69f, 0.72f}, 0.35f, 1}}};

const MesoSwatchMethod meso_swatch_ring_methods[3] = {
    {{.name = "mail", .columns = 2, .rows = 8, .sides = 12, .thickness = 0.12f}, 1, 2, 2, MAIL, 2, make_mail},
    {{.name = "rings", .columns = 3, .rows = 3, .sides = 12, .thickness = 0.1f}, 1, 1, 2, RINGS, 2, make_rings},
    {{.name = "nuts", .columns = 4, .rows = 4, .sides = 18, .thickness = 0.45f}, 1, 2, 2, NUTS, 1, make_nuts},
};
