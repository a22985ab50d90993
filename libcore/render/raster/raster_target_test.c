/*
 * Triangles on targets: every place of a mesh without gaps is drawn once, as exact arithmetic says, for triangles far
 * under a pixel and far over the target, one sample a pixel and sixteen; nearness wins; the same with wide vectors.
 */
#include "libcore/render/raster/raster_target.h"

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { CELLS = 8, PLACES = MESO_RASTER_LANES * CELLS * CELLS, ROOM = 4096 };

typedef struct Picture {
    MesoRasterLanes lanes;
    float nearness[PLACES];
    uint32_t ids[PLACES];
} Picture;

static MesoRasterTarget clear(Picture *picture, uint32_t samples)
{
    picture->lanes = meso_raster_lanes(samples);
    const MesoRasterTarget target = {&picture->lanes, CELLS, CELLS, picture->nearness, picture->ids};
    meso_raster_clear(&target, -INFINITY);
    return target;
}

static void place_at(const Picture *picture, uint32_t place, int64_t *x, int64_t *y)
{
    uint32_t cell = place / MESO_RASTER_LANES, lane = place % MESO_RASTER_LANES;
    *x = (int64_t)(cell % CELLS) * picture->lanes.cell + picture->lanes.x[lane];
    *y = (int64_t)(cell / CELLS) * picture->lanes.cell + picture->lanes.y[lane];
}

static int64_t cross(MesoRasterVertex a, MesoRasterVertex b, int64_t x, int64_t y)
{
    return ((int64_t)b.x - a.x) * (y - a.y) - ((int64_t)b.y - a.y) * (x - a.x);
}

/* 1 inside, -1 outside, 0 on the rim. */
static int side_of(const MesoRasterVertex *v, const uint32_t *c, int64_t x, int64_t y)
{
    int64_t area = cross(v[c[0]], v[c[1]], v[c[2]].x, v[c[2]].y), sign = area < 0 ? -1 : 1;
    int64_t least = INT64_MAX;
    for (int k = 0; k < 3 && area != 0; k++) {
        int64_t e = sign * cross(v[c[k]], v[c[(k + 1) % 3]], x, y);
        least = e < least ? e : least;
    }
    return area == 0 || least < 0 ? -1 : least > 0;
}

/* A grid of n by n quads over `extent` units, its inner vertices moved at random: n n 2 triangles. */
static uint32_t make_grid(MesoRasterVertex *v, uint32_t *corners, uint32_t n, int32_t extent, MesoRandom *random)
{
    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++) {
            int32_t step = extent / (int32_t)n;
            bool inner = i > 0 && j > 0 && i < n && j < n && step > 4;
            int32_t dx = inner ? (int32_t)meso_random_below(random, (uint32_t)step / 2) - step / 4 : 0;
            int32_t dy = inner ? (int32_t)meso_random_below(random, (uint32_t)step / 2) - step / 4 : 0;
            v[j * (n + 1) + i] = (MesoRasterVertex){(int32_t)i * step + dx, (int32_t)j * step + dy, 1};
        }
    uint32_t count = 0;
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            const uint32_t quad[6] = {a, b, c, a, c, d};
            memcpy(corners + 3 * count, quad, sizeof quad);
            count += 2;
        }
    return count;
}

static void test_mesh(uint32_t samples, uint32_t n, int32_t extent, MesoRandom *random)
{
    static MesoRasterVertex v[ROOM];
    static uint32_t corners[6 * ROOM];
    static Picture picture, plain;
    uint32_t count = make_grid(v, corners, n, extent, random);
    MesoRasterTarget target = clear(&picture, samples), other = clear(&plain, samples);
    meso_raster_draw(&target, v, corners, count, 1, false);
    meso_raster_draw_plain(&other, v, corners, count, 1, false);
    CHECK(memcmp(picture.ids, plain.ids, sizeof plain.ids) == 0);
    CHECK(memcmp(picture.nearness, plain.nearness, sizeof plain.nearness) == 0);
    for (uint32_t place = 0; place < PLACES; place++) {
        int64_t x, y;
        uint32_t id = picture.ids[place], inside = 0, rims = 0, owner = 0;
        place_at(&picture, place, &x, &y);
        for (uint32_t t = 0; t < count; t++) {
            int side = side_of(v, corners + 3 * t, x, y);
            inside += side > 0;
            rims += side == 0;
            owner = side > 0 ? t + 1 : owner;
        }
        CHECK(inside <= 1);
        if (inside == 1)
            CHECK(id == owner);
        else if (rims > 1)                  /* between neighbours: one of them has it */
            CHECK(id > 0 && side_of(v, corners + 3 * (id - 1), x, y) == 0);
        else
            CHECK(id == 0 || rims == 1);
    }

    /* Nothing has two owners: drawn one after the other at the same nearness, each leaves the others' alone. */
    uint32_t total = 0, alone = 0;
    for (uint32_t place = 0; place < PLACES; place++)
        total += picture.ids[place] > 0;
    for (uint32_t t = 0; t < count; t++) {
        target = clear(&picture, samples);
        meso_raster_draw(&target, v, corners + 3 * t, 1, 1, false);
        for (uint32_t place = 0; place < PLACES; place++)
            alone += picture.ids[place];
    }
    CHECK(alone == total);
}

/* Two crossing triangles: each place has the nearer one, at the nearness of its plane; one side only, where asked. */
static void test_nearness(uint32_t samples)
{
    static Picture picture;
    const MesoRasterVertex v[6] = {{-300, -200, 0}, {9000, 100, 8}, {200, 9000, 2}, {-300, -200, 8}, {9000, 100, 0}, {200, 9000, 3}};
    const uint32_t corners[6] = {0, 1, 2, 3, 5, 4};
    MesoRasterTarget target = clear(&picture, samples);
    meso_raster_draw(&target, v, corners, 2, 7, false);
    for (uint32_t place = 0; place < PLACES; place++) {
        int64_t x, y;
        place_at(&picture, place, &x, &y);
        if (side_of(v, corners, x, y) <= 0)
            continue;
        double area = (double)cross(v[0], v[1], v[2].x, v[2].y);
        double b = (double)cross(v[2], v[0], x, y) / area, c = (double)cross(v[0], v[1], x, y) / area;
        double one = 8 * b + 2 * c, two = 8 * (1 - b - c) + 3 * c;
        CHECK(fabs((double)picture.nearness[place] - fmax(one, two)) < 1e-4);
        CHECK(fabs(one - two) < 1e-4 || picture.ids[place] == (one > two ? 7 : 8));
    }
    target = clear(&picture, samples);
    meso_raster_draw(&target, v, corners, 2, 7, true);
    for (uint32_t place = 0; place < PLACES; place++)
        CHECK(picture.ids[place] == 0 || picture.ids[place] == 8);
}

int main(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t samples = 1; samples <= 16; samples *= 4) {
        int32_t extent = CELLS * meso_raster_lanes(samples).cell;
        test_mesh(samples, 1, extent, &random);
        test_mesh(samples, 1, 64 * extent, &random);
        test_mesh(samples, 7, extent, &random);
        test_mesh(samples, 7, extent - 77, &random);
        test_mesh(samples, 24, extent, &random);
        test_mesh(samples, 24, extent / 8, &random);
        test_nearness(samples);
    }
    return 0;
}
