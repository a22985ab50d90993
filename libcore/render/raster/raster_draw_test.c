/*
 * Triangles on targets: every place of a mesh without gaps is drawn once, as exact arithmetic says, for triangles far
 * under a pixel and far over the target, one sample a pixel and sixteen; nearness wins; the same by all machines, ring
 * by ring, and where what is behind all of a cell is left out.
 */
#include "libcore/render/raster/raster_draw.h"

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { CELLS = 8, PLACES = MESO_RASTER_LANES * CELLS * CELLS, ROOM = 4096, POINTS = 3 * ROOM };

typedef struct Picture {
    MesoRasterLanes lanes;
    float nearness[PLACES], farthest[CELLS * CELLS];
    uint32_t ids[PLACES];
} Picture;

static MesoRasterTarget clear(Picture *picture, uint32_t samples)
{
    picture->lanes = meso_raster_lanes(samples);
    const MesoRasterTarget target = {&picture->lanes, CELLS, CELLS, picture->nearness, picture->ids,
                                     picture->farthest};
    meso_raster_clear(&target, -INFINITY);
    return target;
}

/* Vertices as points, and what may be read behind them. */
typedef struct Points {
    int32_t x[POINTS + MESO_RASTER_SPARE], y[POINTS + MESO_RASTER_SPARE];
    float nearness[POINTS + MESO_RASTER_SPARE];
} Points;

static MesoRasterPoints points_of(Points *points, const MesoRasterVertex *v, uint32_t count)
{
    const MesoRasterPoints all = {points->x, points->y, points->nearness};
    memset(points, 0x7f, sizeof *points);
    for (uint32_t i = 0; i < count; i++)
        meso_raster_put_point(&all, i, v[i]);
    return all;
}

static void draw_by(MesoRasterMachine machine, const MesoRasterTarget *target, const MesoRasterVertex *v,
                    uint32_t vertex_count, const uint32_t *corners, uint32_t count, uint32_t id, bool one_sided)
{
    static Points room;
    MesoRasterPoints points = points_of(&room, v, vertex_count);
    MesoRasterQueue queue;
    meso_raster_begin(&queue, target);
    queue.machine = machine;
    meso_raster_add(&queue, &points, corners, count / 3, id, one_sided);
    meso_raster_add(&queue, &points, corners + 3 * (count / 3), count - count / 3, id + count / 3, one_sided);
    meso_raster_flush(&queue);
}

static void draw(const MesoRasterTarget *target, const MesoRasterVertex *v, uint32_t vertex_count,
                 const uint32_t *corners, uint32_t count, uint32_t id, bool one_sided)
{
    draw_by(meso_raster_machine(), target, v, vertex_count, corners, count, id, one_sided);
}

static void check_same(const Picture *a, const Picture *b)
{
    CHECK(memcmp(a->ids, b->ids, sizeof a->ids) == 0);
    CHECK(memcmp(a->nearness, b->nearness, sizeof a->nearness) == 0);
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
    static Picture picture, other;
    uint32_t count = make_grid(v, corners, n, extent, random), vertices = (n + 1) * (n + 1);
    MesoRasterTarget target = clear(&picture, samples);
    draw(&target, v, vertices, corners, count, 1, false);
    for (MesoRasterMachine machine = MESO_RASTER_PLAIN; machine < meso_raster_machine(); machine++) {
        MesoRasterTarget by_other = clear(&other, samples);
        draw_by(machine, &by_other, v, vertices, corners, count, 1, false);
        check_same(&picture, &other);
    }
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
        draw(&target, v, vertices, corners + 3 * t, 1, 1, false);
        for (uint32_t place = 0; place < PLACES; place++)
            alone += picture.ids[place];
    }
    CHECK(alone == total);
}

/* Two crossing triangles: each place has the nearer one, at the nearness of its plane; one side only, where asked. */
static void test_nearness(uint32_t samples)
{
    static Picture picture;
    const MesoRasterVertex v[6] = {{-300, -200, 0}, {9000, 100, 8}, {200, 9000, 2},
                                   {-300, -200, 8}, {9000, 100, 0}, {200, 9000, 3}};
    const uint32_t corners[6] = {0, 1, 2, 3, 5, 4};
    MesoRasterTarget target = clear(&picture, samples);
    draw(&target, v, 6, corners, 2, 7, false);
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
    draw(&target, v, 6, corners, 2, 7, true);
    for (uint32_t place = 0; place < PLACES; place++)
        CHECK(picture.ids[place] == 0 || picture.ids[place] == 8);
}

static int32_t around(MesoRandom *random, int32_t reach)
{
    return (int32_t)meso_random_below(random, 2 * (uint32_t)reach) - reach;
}

/* Crumpled rings anywhere about the target, the second of its sides missing: those that are looked at together are as
 * those one by one, whatever way they turn. */
static void test_rings(uint32_t samples, int32_t size, bool one_sided, MesoRandom *random)
{
    enum { RINGS = 40, WIDTH = 7, COUNT = RINGS * WIDTH, SIDES = WIDTH - 2 };
    static const uint32_t sides[WIDTH] = {0, UINT32_MAX, 1, 2, 3, 4, UINT32_MAX};
    static MesoRasterVertex v[COUNT];
    static uint32_t corners[6 * SIDES * (RINGS - 1)];
    static uint8_t joined[COUNT + MESO_RASTER_SPARE];
    static Picture one, all;
    static Points room;
    int32_t extent = CELLS * meso_raster_lanes(samples).cell, x = extent / 2, y = extent / 2;
    uint32_t count = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        if (i % WIDTH == 0) {
            x = extent / 2 + around(random, extent);
            y = i % 2 ? y : extent / 2 + around(random, extent);
        }
        v[i] = (MesoRasterVertex){x + around(random, size), y + around(random, size), (float)around(random, 1000)};
        joined[i] = i < COUNT - WIDTH && sides[i % WIDTH] != UINT32_MAX;
        const uint32_t quad[6] = {i, i + WIDTH, i + WIDTH + 1, i, i + WIDTH + 1, i + 1};
        if (joined[i])
            memcpy(corners + 3 * count, quad, sizeof quad);
        count += 2 * joined[i];
    }
    for (uint32_t i = COUNT - WIDTH; i < COUNT + MESO_RASTER_SPARE; i++)   /* may be anything */
        joined[i] = (uint8_t)meso_random_below(random, 256);
    MesoRasterTarget target = clear(&one, samples);
    draw_by(MESO_RASTER_PLAIN, &target, v, COUNT, corners, count, 5, one_sided);
    MesoRasterPoints points = points_of(&room, v, COUNT);
    const MesoRasterRings rings = {COUNT - WIDTH, WIDTH, joined, sides, SIDES};
    for (MesoRasterMachine machine = MESO_RASTER_PLAIN; machine <= meso_raster_machine(); machine++) {
        MesoRasterQueue queue;
        target = clear(&all, samples);
        meso_raster_begin(&queue, &target);
        queue.machine = machine;
        meso_raster_add_rings(&queue, &points, &rings, 5, one_sided);
        meso_raster_flush(&queue);
        check_same(&one, &all);
    }
}

/* Steep triangles over one another many times, and behind a plane that they touch: nothing is left out that is nearer
 * somewhere, as it is rounded, and no cell is told to be nearer than it is. */
static void test_farthest(uint32_t samples, MesoRandom *random)
{
    enum { COUNT = 3000, STEEPEST = 100000 };
    static MesoRasterVertex v[3 * COUNT];
    static uint32_t corners[3 * COUNT];
    static Picture picture, without;
    int32_t extent = CELLS * meso_raster_lanes(samples).cell;
    const MesoRasterVertex plane[3] = {{-extent, -extent, 200}, {4 * extent, -extent, 200}, {-extent, 4 * extent, 200}};
    const uint32_t whole[3] = {0, 1, 2};
    for (uint32_t t = 0; t < COUNT; t++) {
        int32_t x = (int32_t)meso_random_below(random, (uint32_t)extent), steep = t % 3 ? 10 : STEEPEST;
        int32_t y = (int32_t)meso_random_below(random, (uint32_t)extent), size = t % 7 ? 300 : 2000;
        for (uint32_t k = 0; k < 3; k++) {
            v[3 * t + k] = (MesoRasterVertex){x + around(random, size), y + around(random, size),
                                              (float)around(random, steep) / 1000};
            corners[3 * t + k] = 3 * t + k;
        }
    }
    MesoRasterTarget target = clear(&picture, samples), other = clear(&without, samples);
    other.farthest = NULL;
    for (uint32_t first = 0; first < COUNT; first += 1000) {
        draw(&target, v + 3 * first, 3000, corners, 1000, first + 1, false);
        draw(&other, v + 3 * first, 3000, corners, 1000, first + 1, false);
    }
    check_same(&picture, &without);
    draw(&target, plane, 3, whole, 1, COUNT + 1, false);
    draw(&other, plane, 3, whole, 1, COUNT + 1, false);
    for (uint32_t t = 0; t < COUNT; t++) {
        int64_t px, py;
        place_at(&picture, t % PLACES, &px, &py);
        v[3 * t] = (MesoRasterVertex){(int32_t)px, (int32_t)py, 200};
    }
    draw(&target, v, 3 * COUNT, corners, COUNT, COUNT + 2, false);
    draw(&other, v, 3 * COUNT, corners, COUNT, COUNT + 2, false);
    uint32_t rounded = 0;
    for (uint32_t place = 0; place < PLACES; place++)
        rounded += picture.nearness[place] > 200;
    CHECK(samples == 1 || rounded > 0);
    check_same(&picture, &without);
    uint32_t known = 0;
    for (uint32_t place = 0; place < PLACES; place++) {
        CHECK(picture.farthest[place / MESO_RASTER_LANES] <= picture.nearness[place]);
        known += picture.farthest[place / MESO_RASTER_LANES] > -INFINITY;
    }
    CHECK(samples == 1 || known > PLACES / 2);
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
        for (int32_t size = 4; size < 100000; size *= 5)
            for (uint32_t times = 0; times < 20; times++)
                test_rings(samples, size, times % 2, &random);
        test_farthest(samples, &random);
    }
    return 0;
}
