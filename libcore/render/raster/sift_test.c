/* What is left of triangles of all sizes: those that some sample sees, wherever a driver rounds corners to. */
#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/render/raster/sift.h"

enum { FACES = 600, WIDTH = 96, HEIGHT = 64, TRIALS = 6 };

static MesoArena arena;
static MesoError error;

/* Triangles about as large as pixels, slivers, and some that are larger than the picture, before and behind the eye. */
typedef struct Soup {
    MesoVec3 positions[3 * FACES], normals[3 * FACES];
    uint32_t corners[3 * FACES], ids[1];
    MesoMaterial material;
    MesoBody body;
    MesoPlacedBody placed;
    MesoScene scene;
    MesoShapes shapes;
} Soup;

static float between(MesoRandom *random, float low, float high)
{
    return low + (high - low) * (float)meso_random_below(random, 1 << 20) / (1 << 20);
}

static MesoVec3 around(MesoRandom *random, MesoVec3 middle, MesoVec3 reach)
{
    float x = between(random, -reach.x, reach.x), y = between(random, -reach.y, reach.y);
    return meso_vec3_add(middle, (MesoVec3){x, y, between(random, -reach.z, reach.z)});
}

/* Every seventh is a needle, whose third corner lies next to the second. */
static void make_soup(Soup *s, MesoRandom *random)
{
    *s = (Soup){0};
    for (uint32_t f = 0; f < FACES; f++) {
        float size = f % 50 == 0 ? 4 : f % 3 == 0 ? 0.1f : 0.02f;
        MesoVec3 at = around(random, (MesoVec3){0, 0, 0}, (MesoVec3){1, 1, 1}), *p = s->positions + 3 * f;
        for (uint32_t k = 0; k < 3; k++) {
            p[k] = around(random, at, (MesoVec3){size, f % 5 ? size : 0.02f * size, size});
            s->normals[3 * f + k] = (MesoVec3){0, 0, 1};
            s->corners[3 * f + k] = 3 * f + k;
        }
        if (f % 7 == 0)
            p[2] = around(random, p[1], (MesoVec3){2e-4f, 2e-4f, 0});
    }
    s->body = (MesoBody){3 * FACES, FACES, 3, s->positions, s->normals, NULL, NULL, s->corners};
    s->scene = (MesoScene){.material_count = 1, .materials = &s->material, .id_row_count = 1, .ids = s->ids,
                           .section_scale = 1, .body_count = 1, .bodies = &s->body, .placed_count = 1,
                           .placed = &s->placed};
    meso_scene_measure(&s->scene);
    CHECK(meso_shapes_init(&s->shapes, &arena, &s->scene, (MesoVec3){0, 0, 0}, 1, &error) == MESO_OK);
}

static MesoRasterJob make_job(const Soup *s, uint32_t samples, bool parallel)
{
    return (MesoRasterJob){.shapes = &s->shapes, .width = WIDTH, .height = HEIGHT, .samples = samples,
                           .view = {.eye = {0, 0, 4}, .right = {1, 0, 0}, .down = {0, -1, 0}, .forward = {0, 0, -1},
                                    .parallel = parallel, .focal = parallel ? 40 : 160, .middle_x = WIDTH / 2,
                                    .middle_y = HEIGHT / 2, .near_depth = parallel ? 0 : 0.5f}};
}

/* Which samples each face is left for, and how many in all. */
typedef struct Left {
    const Soup *soup;
    uint32_t samples;
    uint16_t bits[FACES];
    uint64_t count, sum;        /* `sum` depends on the order */
} Left;

static void note(Left *left, const MesoSiftBatch *batch, uint32_t sample, const uint32_t *at)
{
    uint32_t face = 0;
    for (; face < FACES; face++) {
        bool same = true;
        for (uint32_t k = 0; k < 3; k++)
            same = same && memcmp(&batch->vertices[at[k]].position, &left->soup->positions[3 * face + k],
                                  sizeof(MesoVec3)) == 0;
        if (same)
            break;
    }
    CHECK(face < FACES && batch->vertices[at[0]].color[1] == 255 && batch->vertices[at[0]].normal.z == 1);
    CHECK(left->soup->shapes.runs[batch->vertices[at[0]].shape].face_begin <= face);
    CHECK(!(left->bits[face] & 1u << sample));
    left->bits[face] |= (uint16_t)(1u << sample);
    left->count++;
    left->sum = left->sum * 31 + face;
}

static MesoStatus take(void *context, const MesoSiftBatch *batch, MesoError *failure)
{
    Left *left = context;
    (void)failure;
    for (uint32_t i = 0; i < MESO_RASTER_LANES; i++) {
        CHECK(i < left->samples || batch->index_counts[i] == 0);
        for (uint32_t k = 0; k < batch->index_counts[i]; k += 3)
            if (batch->indices[i][k] != batch->indices[i][k + 2])   /* the second half of a triangle is none */
                note(left, batch, i, &batch->indices[i][k]);
    }
    return MESO_OK;
}

/* Pixels, and the depth. */
static MesoVec3 project(const MesoRasterView *view, MesoVec3 p)
{
    MesoVec3 q = meso_raster_from_eye(view, p);
    float scale = view->parallel ? view->focal : view->focal / q.z;
    return (MesoVec3){view->middle_x + scale * q.x, view->middle_y + scale * q.y, q.z};
}

static bool holds(const double p[3][2], double x, double y)
{
    int before = 0, after = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = p[k], *b = p[(k + 1) % 3];
        double side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
        before += side < 0;
        after += side > 0;
    }
    return before == 3 || after == 3;
}

/* Its corners in pixels; false where one lies behind the near plane. */
static bool project_face(const MesoRasterJob *job, const Soup *soup, uint32_t face, double p[3][2], float depths[2])
{
    bool before = true;
    depths[0] = INFINITY;
    depths[1] = -INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 at = project(&job->view, soup->positions[3 * face + k]);
        before = before && at.z > job->view.near_depth;
        depths[0] = fminf(depths[0], at.z);
        depths[1] = fmaxf(depths[1], at.z);
        p[k][0] = (double)at.x;
        p[k][1] = (double)at.y;
    }
    return before;
}

/* All faces, with corners rounded somehow. */
typedef struct Rounded {
    MesoRasterLanes lanes;
    uint32_t bits;              /* of the driver */
    bool before[FACES];         /* the near plane */
    float depths[FACES][2];     /* least and largest */
    double corners[FACES][TRIALS][3][2];
} Rounded;

static void round_faces(Rounded *r, const MesoRasterJob *job, const Soup *soup, uint32_t bits, MesoRandom *random)
{
    r->lanes = meso_raster_lanes(job->samples);
    r->bits = bits;
    for (uint32_t f = 0; f < FACES; f++) {
        r->before[f] = project_face(job, soup, f, r->corners[f][0], r->depths[f]);
        for (uint32_t trial = 1; trial < TRIALS; trial++)
            for (uint32_t k = 0; k < 3; k++)
                for (uint32_t c = 0; c < 2; c++)
                    r->corners[f][trial][k][c] =
                        r->corners[f][0][k][c] + (double)(between(random, -1, 1) / (float)(2u << bits));
    }
}

/* In how many of the roundings the face holds the place. */
static uint32_t times_held(const Rounded *r, uint32_t face, double x, double y)
{
    uint32_t times = 0;
    for (uint32_t trial = 0; trial < TRIALS; trial++)
        times += holds((const double (*)[2])r->corners[face][trial], x, y);
    return times;
}

/* Whether another face that is left for that sample is before it there, however corners are rounded. */
static bool is_hidden(const Rounded *r, const Left *left, uint32_t face, uint32_t sample, double x, double y)
{
    for (uint32_t g = 0; g < FACES; g++)
        if (r->before[g] && left->bits[g] & 1u << sample && r->depths[g][1] < r->depths[face][0] &&
            times_held(r, g, x, y) == TRIALS)
            return true;
    return false;
}

/* Samples of the window that the face may hold; those that are not left are hidden wherever it may. */
static uint32_t check_face(const Rounded *r, MesoWindow window, const Left *left, uint32_t face)
{
    uint32_t bits = 0;
    for (uint32_t y = window.y; y < window.y + window.height; y++)
        for (uint32_t x = window.x; x < window.x + window.width; x++)
            for (uint32_t i = 0; i < r->lanes.samples; i++) {
                double px = x + r->lanes.x[i] / 256., py = y + r->lanes.y[i] / 256.;
                bool out = !(left->bits[face] & 1u << i);
                if ((!out && bits & 1u << i) || times_held(r, face, px, py) == 0)
                    continue;
                bits |= 1u << i;
                CHECK(!out || is_hidden(r, left, face, i, px, py));
            }
    return bits;
}

/* None is left out that is seen; few are left that hold no sample, where the shape is before us. */
static void check_left(const MesoRasterJob *job, MesoWindow window, uint32_t bits, const Left *left,
                       MesoRandom *random)
{
    static Rounded rounded;
    uint32_t held = 0, kept = 0;
    round_faces(&rounded, job, left->soup, bits, random);
    for (uint32_t begin = 0; begin < FACES; begin += MESO_SHAPE_FACES) {
        bool before = true;
        uint32_t end = begin + MESO_SHAPE_FACES < FACES ? begin + MESO_SHAPE_FACES : FACES;
        for (uint32_t f = begin; f < end; f++)
            before = before && rounded.before[f];
        for (uint32_t f = begin; f < end; f++) {
            if (!rounded.before[f])
                continue;
            uint32_t may = check_face(&rounded, window, left, f);
            held += before ? (uint32_t)__builtin_popcount(may) : 0;
            kept += before ? (uint32_t)__builtin_popcount(left->bits[f]) : 0;
        }
    }
    CHECK(held > 20 && 10 * kept <= (job->samples == 1 ? 13u : 17u) * held + 20);
}

static void test_window(const Soup *s, uint32_t samples, bool parallel, MesoWindow window, uint32_t bits,
                        MesoRandom *random)
{
    MesoRasterJob job = make_job(s, samples, parallel);
    Left left = {.soup = s, .samples = samples}, other = left;
    CHECK(meso_sift(&job, window, bits, 1, take, &left, &error) == MESO_OK);
    CHECK(meso_sift(&job, window, bits, 3, take, &other, &error) == MESO_OK);
    CHECK(left.count == other.count && left.sum == other.sum);
    check_left(&job, window, bits, &left, random);
}

static MesoStatus refuse(void *context, const MesoSiftBatch *batch, MesoError *failure)
{
    (void)context;
    (void)batch;
    return meso_fail(failure, MESO_ERR_LIMIT, "no more");
}

/* ---- layers ---- */

/* Two sheets of small triangles, one behind the other: a body each. */
enum { ROWS = 40, COLUMNS = 60, SHEETS = 2, PLACES = (ROWS + 1) * (COLUMNS + 1), SHEET_FACES = 2 * ROWS * COLUMNS };

typedef struct Layers {
    MesoVec3 positions[SHEETS][PLACES], normals[PLACES];
    uint32_t corners[3 * SHEET_FACES], ids[1], counts[SHEETS], parts;
    MesoMaterial material;
    MesoBody bodies[SHEETS];
    MesoPlacedBody placed[SHEETS];
    MesoScene scene;
    MesoShapes shapes;
} Layers;

/* The far one comes first in the scene. */
static void make_layers(Layers *s)
{
    *s = (Layers){0};
    for (uint32_t i = 0; i < PLACES; i++) {
        float x = 0.08f * ((float)(i % (COLUMNS + 1)) - COLUMNS / 2);
        float y = 0.08f * ((float)(i / (COLUMNS + 1)) - ROWS / 2);
        s->normals[i] = (MesoVec3){0, 0, 1};
        for (uint32_t k = 0; k < SHEETS; k++)
            s->positions[k][i] = (MesoVec3){x, y, (float)k - 0.5f};
    }
    for (uint32_t q = 0; q < ROWS * COLUMNS; q++) {
        uint32_t a = q / COLUMNS * (COLUMNS + 1) + q % COLUMNS, c = a + COLUMNS + 1;
        const uint32_t corners[6] = {a, a + 1, c + 1, a, c + 1, c};
        memcpy(s->corners + 6 * q, corners, sizeof corners);
    }
    for (uint32_t k = 0; k < SHEETS; k++) {
        s->bodies[k] = (MesoBody){PLACES, SHEET_FACES, 3, s->positions[k], s->normals, NULL, NULL, s->corners};
        s->placed[k] = (MesoPlacedBody){.body = k};
    }
    s->scene = (MesoScene){.material_count = 1, .materials = &s->material, .id_row_count = 1, .ids = s->ids,
                           .section_scale = 1, .body_count = SHEETS, .bodies = s->bodies, .placed_count = SHEETS,
                           .placed = s->placed};
    meso_scene_measure(&s->scene);
    CHECK(meso_shapes_init(&s->shapes, &arena, &s->scene, (MesoVec3){0, 0, 0}, 1, &error) == MESO_OK);
}

static MesoStatus count_layers(void *context, const MesoSiftBatch *batch, MesoError *failure)
{
    Layers *s = context;
    (void)failure;
    s->parts++;
    for (uint32_t i = 0; i < MESO_RASTER_LANES; i++)
        for (uint32_t k = 0; k < batch->index_counts[i]; k += 3)
            s->counts[batch->vertices[batch->indices[i][k]].position.z > 0]++;
    return MESO_OK;
}

/* All of the near one comes, and of the other what lies between its triangles, as far as they may be rounded. */
static void test_layers(void)
{
    static Layers s;
    make_layers(&s);
    for (uint32_t samples = 1; samples <= 16; samples *= 4)
        for (uint32_t parallel = 0; parallel < 2; parallel++) {
            MesoRasterJob job = {.shapes = &s.shapes, .width = 2 * WIDTH, .height = 2 * HEIGHT, .samples = samples,
                                 .view = {.eye = {0, 0, 4}, .right = {1, 0, 0}, .down = {0, -1, 0},
                                          .forward = {0, 0, -1}, .parallel = parallel, .focal = parallel ? 40 : 160,
                                          .middle_x = WIDTH, .middle_y = HEIGHT, .near_depth = parallel ? 0 : 0.5f}};
            s.parts = s.counts[0] = s.counts[1] = 0;
            CHECK(meso_sift(&job, (MesoWindow){0, 0, 2 * WIDTH, 2 * HEIGHT}, 8, 2, count_layers, &s, &error) ==
                  MESO_OK);
            CHECK(s.parts == (samples == 1 ? 2 : 6));
            CHECK(s.counts[1] > SHEET_FACES / 2 && 3 * s.counts[0] < s.counts[1]);
        }
}

int main(void)
{
    static Soup s;
    MesoRandom random;
    meso_arena_init(&arena);
    meso_random_init(&random, 7, 0);
    make_soup(&s, &random);
    const MesoWindow whole = {0, 0, WIDTH, HEIGHT}, part = {32, 16, 37, 21}, square = {16, 0, 64, 64};
    for (uint32_t samples = 1; samples <= 16; samples *= 4)
        for (uint32_t parallel = 0; parallel < 2; parallel++) {
            test_window(&s, samples, parallel, part, 4, &random);
            test_window(&s, samples, parallel, square, 8, &random);
        }
    test_window(&s, 1, false, whole, 4, &random);
    MesoRasterJob job = make_job(&s, 1, false);
    CHECK(meso_sift(&job, whole, 4, 1, refuse, NULL, &error) == MESO_ERR_LIMIT);
    test_layers();
    meso_arena_release(&arena);
    return 0;
}
