/* Fruit: apples with their stems. */
#include <math.h>

#include "libcore/quilt/swatch/swatch_maker.h"

/* From the bud to the stem: parts of the radius. */
static const double APPLE[7][2] = {{0.16, -0.80}, {0.50, -0.86}, {0.82, -0.42}, {1.0, 0.12},
                                   {0.86, 0.62},  {0.50, 0.86},  {0.18, 0.74}};

typedef struct Apple {
    double x, y, z, radius, turn, lean_x, lean_y;
} Apple;

/* A point of the apple that stands upright, leant. */
static uint32_t add_point(MesoSwatchMaker *maker, const Apple *apple, double x, double y, double z)
{
    return meso_maker_vertex(maker, apple->x + apple->radius * (x + apple->lean_x * z),
                             apple->y + apple->radius * (y + apple->lean_y * z),
                             apple->z + apple->radius * (z - apple->lean_x * x - apple->lean_y * y));
}

static void add_cap(MesoSwatchMaker *maker, const Apple *apple, uint32_t ring, uint32_t sides, double x, double y,
                    double z, bool ahead, uint32_t material)
{
    uint32_t tip = add_point(maker, apple, x, y, z);
    meso_maker_fan(maker, ring, sides, tip, ahead, material);
}

static void add_body(MesoSwatchMaker *maker, const Apple *apple)
{
    uint32_t sides = maker->recipe.sides, first = maker->vertex_count, rings = sizeof APPLE / sizeof *APPLE;
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t s = 0; s < sides; s++) {
            double angle = 2 * MESO_PI * s / sides + apple->turn, lobes = 1 + 0.02 * cos(5 * angle) * (r < 2);
            add_point(maker, apple, lobes * APPLE[r][0] * cos(angle), lobes * APPLE[r][0] * sin(angle), APPLE[r][1]);
        }
    meso_maker_tube(maker, first, rings, sides, false, 0);
    add_cap(maker, apple, first, sides, 0, 0, -0.70, false, 0);
    add_cap(maker, apple, first + (rings - 1) * sides, sides, 0, 0, 0.56, true, 0);
}

/* It stands in the hollow, without touching it: elements may not cut each other. */
static void add_stem(MesoSwatchMaker *maker, const Apple *apple)
{
    enum { SIDES = 5, RINGS = 3 };
    static const double at[RINGS][3] = {{0.0, 0.64, 0.045}, {0.03, 0.82, 0.04}, {0.12, 1.06, 0.055}};
    uint32_t first = maker->vertex_count;
    double c = cos(apple->turn), t = sin(apple->turn);
    for (uint32_t r = 0; r < RINGS; r++)
        for (uint32_t s = 0; s < SIDES; s++) {
            double angle = 2 * MESO_PI * s / SIDES, wide = at[r][2] * (double)maker->recipe.thickness;
            add_point(maker, apple, at[r][0] * c + wide * cos(angle), at[r][0] * t + wide * sin(angle), at[r][1]);
        }
    meso_maker_tube(maker, first, RINGS, SIDES, false, 1);
    add_cap(maker, apple, first, SIDES, 0, 0, 0.62, false, 1);
    add_cap(maker, apple, first + (RINGS - 1) * SIDES, SIDES, at[2][0] * c, at[2][0] * t, 1.08, true, 1);
}

/* Rows, each half a pitch further; strewn ones are leant, turned, of different sizes, and have less room each. */
static void make_apples(MesoSwatchMaker *maker)
{
    double jitter = (double)maker->recipe.jitter, stray = fmin(jitter, 0.16) / 2;
    double scale = jitter > 0 ? stray / jitter : 0;
    for (uint32_t j = 0; j < maker->recipe.rows; j++)
        for (uint32_t i = 0; i < maker->recipe.columns; i++) {
            Apple apple = {.radius = 0.47 - stray * sqrt(2) - fabs(meso_maker_jitter(maker)) / 4};
            apple.x = i + 0.25 + 0.5 * (j % 2) + scale * meso_maker_jitter(maker);
            apple.y = (j + 0.5) * sqrt(0.75) + scale * meso_maker_jitter(maker);
            apple.z = meso_maker_jitter(maker) / 2;
            apple.turn = 40 * meso_maker_jitter(maker);
            apple.lean_x = meso_maker_jitter(maker) / 2;
            apple.lean_y = meso_maker_jitter(maker) / 2;
            add_body(maker, &apple);
            add_stem(maker, &apple);
        }
}

static const MesoMakerMaterial APPLES[2] = {{"apple", {{0.62f, 0.06f, 0.04f}, 0.35f, 0}},
                                            {"stem", {{0.16f, 0.09f, 0.04f}, 0.8f, 0}}};

const MesoSwatchMethod meso_swatch_fruit_methods[1] = {
    {{.name = "apples", .columns = 5, .rows = 4, .sides = 12, .thickness = 1}, 1, 2, 2, APPLES, 2, make_apples},
};
