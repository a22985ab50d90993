/*
 * Pictures of woven threads, from those of many pixels to those of a part of one, drawn as finely as they need and with
 * all that they have: the same within a step of 8 bits, and closed where these are.
 */
#include "libcore/render/picture/painter.h"

#include "libcore/base/check.h"

enum { SIDES = 16, FINE_SIDES = 50, RINGS = 7, GROUPS = 5, WIDTH = 128, BAND = 32, HEIGHT = GROUPS * BAND,
       SWEEPS = 2048, BLOCK = 16 };

/* Pixels from the middle of a thread; threads of a group lie as far apart as three of them. */
static const float RADII[GROUPS] = {6, 3, 1.5f, 0.7f, 0.35f};

static MesoArena arena;
static MesoError error;
static MesoMaterial materials[2] = {{{0.75f, 0.25f, 0.125f}, 0.5f, 0}, {{0.125f, 0.5f, 0.75f}, 0.25f, 0}};
static MesoSweepColumn columns[SIDES + 1 + FINE_SIDES + 1];
static MesoSweptKind kinds[GROUPS];
static MesoSweepInstance sweeps[SWEEPS];
static uint32_t ids[1];
static MesoScene scene;

static void make_circle(MesoSweepColumn *out, uint32_t sides)
{
    for (uint32_t i = 0; i <= sides; i++) {
        double angle = -2 * MESO_PI * (i % sides) / sides;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)};
        out[i] = (MesoSweepColumn){n, n, n, n, (float)i / (float)sides, i < sides, .absent = 0};
    }
}

/* Part `i` of a thread that goes up and down along x, over and under, at `y`. */
static MesoSweepInstance wave(float y, float radius, uint32_t i, uint32_t thread)
{
    float length = 6 * radius, rise = (i + thread) % 2 ? radius : -radius, x = length * (float)i;
    MesoSweepInstance sweep = {.p = {{x, y, -rise}, {x + 0.4f * length, y, -rise}, {x + 0.6f * length, y, rise},
                                     {x + length, y, rise}},
                               .up = {{0, 1, 0}, {0, 1, 0}}, .direction = {{1, 0, 0}, {1, 0, 0}},
                               .size = {radius, radius}};
    return sweep;
}

static MesoSweptKind kind_of(uint32_t column_begin, uint32_t sides, uint32_t instance_begin)
{
    return (MesoSweptKind){.column_begin = column_begin, .column_count = sides + 1, .joint_count = sides,
                           .division_count = RINGS, .instance_begin = instance_begin};
}

static void make_scene(uint32_t kind_count, uint32_t sweep_count)
{
    scene = (MesoScene){.channel_count = 1, .channels = {{"slot", 1, NULL}}, .material_count = 2,
                        .materials = materials, .id_row_count = 1, .ids = ids, .section_scale = 1, .thickness = 1,
                        .kind_count = kind_count, .column_count = SIDES + 1 + FINE_SIDES + 1,
                        .sweep_count = sweep_count, .kinds = kinds, .columns = columns, .sweeps = sweeps};
    meso_scene_measure(&scene);
}

/* Threads of each group in a band of the picture. */
static void make_threads(void)
{
    uint32_t count = 0;
    for (uint32_t g = 0; g < GROUPS; g++) {
        float radius = RADII[g];
        uint32_t threads = (uint32_t)(BAND / (3 * radius)), parts = (uint32_t)(WIDTH / (6 * radius)) + 1;
        kinds[g] = kind_of(0, SIDES, count);
        kinds[g].start_material = kinds[g].end_material = g % 2;
        for (uint32_t t = 0; t < threads; t++)
            for (uint32_t i = 0; i < parts && count < SWEEPS; i++)
                sweeps[count++] = wave((float)(g * BAND) + radius * (1.5f + 3 * (float)t), radius, i, t);
        kinds[g].instance_count = count - kinds[g].instance_begin;
    }
    make_scene(GROUPS, count);
}

/* One thread, of whose parts every other has another number of sides. */
static void make_seams(void)
{
    enum { PARTS = 4 };         /* of each kind */
    for (uint32_t k = 0; k < 2; k++) {
        kinds[k] = kind_of(k ? SIDES + 1 : 0, k ? FINE_SIDES : SIDES, PARTS * k);
        kinds[k].instance_count = PARTS;
        for (uint32_t i = 0; i < PARTS; i++)
            sweeps[PARTS * k + i] = wave(HEIGHT / 2.f, RADII[0], 2 * i + k, 0);
    }
    make_scene(2, 2 * PARTS);
}

/* So many units high. */
static MesoImage draw(float height, uint32_t samples, bool full)
{
    MesoRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = samples, .full_detail = full};
    const MesoVec3 middle = {WIDTH / 2.f, HEIGHT / 2.f, 0};
    options.camera = (MesoCamera){meso_vec3_add(middle, (MesoVec3){3, 5, 500}), middle, {0, 1, 0}, 40, height};
    MesoImage image;
    CHECK(meso_tile_picture(&image, &arena, &scene, &options, 1, &error) == MESO_OK);
    return image;
}

/* As a screen shows it, over black. */
static double shown(float x)
{
    return pow(fmin(fmax((double)x, 0), 1), 1 / 2.2);
}

/* Roots of mean squares of what a group's pixels differ by, and its blocks. */
typedef struct Difference {
    double pixels, blocks;
} Difference;

/* Groups lie one above the other, and away from the borders. */
static Difference compare(const MesoImage *a, const MesoImage *b, uint32_t group)
{
    double pixels = 0, blocks = 0;
    uint32_t top = HEIGHT - (group + 1) * BAND;
    for (uint32_t block = 0; block < BAND / BLOCK * (WIDTH / BLOCK); block++)
        for (uint32_t c = 0; c < 3; c++) {
            double sum = 0;
            for (uint32_t i = 0; i < BLOCK * BLOCK; i++) {
                size_t x = block % (WIDTH / BLOCK) * BLOCK + i % BLOCK;
                size_t y = top + block / (WIDTH / BLOCK) * BLOCK + i / BLOCK;
                size_t at = 4 * (y * WIDTH + x) + c;
                double difference = shown(b->color[at]) - shown(a->color[at]);
                pixels += difference * difference;
                sum += difference;
            }
            blocks += sum / (BLOCK * BLOCK) * (sum / (BLOCK * BLOCK));
        }
    return (Difference){sqrt(pixels / (3 * BAND * WIDTH)), sqrt(blocks * BLOCK * BLOCK / (3 * BAND * WIDTH))};
}

/* Of 16 samples each that sees something else would be a 16th of a thread's colour: few of them may. */
static void test_difference(void)
{
    make_threads();
    MesoImage full = draw(HEIGHT, 16, true), detail = draw(HEIGHT, 16, false);
    for (uint32_t g = 0; g < GROUPS; g++) {
        Difference d = compare(&full, &detail, g);
        CHECK(d.pixels < 1. / 255 && d.blocks < 0.25 / 255);
    }
}

static bool is_full_around(const MesoImage *image, size_t x, size_t y)
{
    for (size_t i = 0; i < 9; i++)
        if (!(image->color[4 * ((y + i / 3 - 1) * WIDTH + x + i % 3 - 1) + 3] > 0.999f))
            return false;
    return true;
}

/* Nothing is seen through a thread whose parts are thinned each in its way, from near and far. */
static void test_seams(void)
{
    make_seams();
    uint32_t inside = 0;
    for (uint32_t i = 0; i < 12; i++) {
        float height = HEIGHT * exp2f(0.5f * (float)(i / 3) - 1);
        uint32_t samples = 1u << 2 * (i % 3);
        MesoImage full = draw(height, samples, true), detail = draw(height, samples, false);
        for (size_t y = 1; y + 1 < HEIGHT; y++)
            for (size_t x = 1; x + 1 < WIDTH; x++) {
                if (!is_full_around(&full, x, y))
                    continue;
                CHECK(detail.color[4 * (y * WIDTH + x) + 3] > 0.999f);
                inside++;
            }
    }
    CHECK(inside > 5000);
}

int main(void)
{
    meso_arena_init(&arena);
    make_circle(columns, SIDES);
    make_circle(columns + SIDES + 1, FINE_SIDES);
    test_difference();
    test_seams();
    meso_arena_release(&arena);
    return 0;
}
