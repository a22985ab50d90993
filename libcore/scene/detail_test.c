/* What thinning keeps, and how far the rest lies from it. */
#include <math.h>

#include "libcore/base/check.h"
#include "libcore/scene/detail.h"

enum { SIDES = 128 };

static const float RADIUS = 0.25f;

static MesoSweepColumn columns[SIDES + 1];

static void make_circle(void)
{
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * 3.14159265358979323846 * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)};
        MesoVec2 s = {RADIUS * n.x, RADIUS * n.y};
        columns[i] = (MesoSweepColumn){s, s, n, n, 0, i < SIDES, .absent = 0};
    }
}

static float farthest(const uint32_t *kept, uint32_t count)
{
    float worst = 0;
    for (uint32_t k = 0; k + 1 < count; k++) {
        MesoVec2 middle = meso_vec2_lerp(columns[kept[k]].start, columns[kept[k + 1]].start, 0.5f);
        worst = fmaxf(worst, RADIUS - meso_vec2_length(middle));
    }
    return worst;
}

static void test_columns(void)
{
    uint32_t kept[SIDES + 1];
    make_circle();
    CHECK(meso_detail_columns(columns, SIDES + 1, 0, kept) == SIDES + 1);
    uint32_t before = SIDES + 2;
    for (float tolerance = 1e-4f; tolerance < 1; tolerance *= 4) {
        uint32_t count = meso_detail_columns(columns, SIDES + 1, tolerance, kept);
        CHECK(count >= 6 && count <= before);       /* 75 degrees a step at most */
        CHECK(kept[0] == 0 && kept[count - 1] == SIDES);
        CHECK(farthest(kept, count) <= tolerance);
        before = count;
    }
    CHECK(before <= 8);

    /* Runs end where columns do not join; both ends stay. */
    columns[40].joins_next = 0;
    uint32_t count = meso_detail_columns(columns, SIDES + 1, 1, kept);
    bool end = false, begin = false;
    for (uint32_t k = 0; k < count; k++) {
        end = end || kept[k] == 40;
        begin = begin || kept[k] == 41;
    }
    CHECK(end && begin);
    CHECK(meso_detail_columns(columns, 0, 1, kept) == 0);
    CHECK(meso_detail_columns(columns, 1, 1, kept) == 1);
}

/* A quarter circle of radius 1: chords of n steps are off by about (pi / 2n)^2 / 8. */
static void test_rings(void)
{
    const float k = 0.5522847f;
    make_circle();
    MesoSweepInstance instance = {{{1, 0, 0}, {1, k, 0}, {k, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}},
                                  {{0, 1, 0}, {-1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    MesoSweptKind kind = {.column_count = SIDES + 1, .division_count = 100, .instance_count = 1};
    MesoScene scene = {.kinds = &kind, .columns = columns, .sweeps = &instance, .kind_count = 1,
                       .sweep_count = 1, .section_scale = 1};
    CHECK(meso_detail_rings(&scene, &kind, 0) == 100);
    uint32_t fine = meso_detail_rings(&scene, &kind, 1e-3f);
    uint32_t coarse = meso_detail_rings(&scene, &kind, 1e-1f);
    float step = 1.5707963f / (float)(fine - 1);
    CHECK(step * step / 8 * (1 + RADIUS) <= 1e-3f && fine < 60);
    CHECK(coarse >= 3 && coarse < fine);
    kind.division_count = 5;
    CHECK(meso_detail_rings(&scene, &kind, 1e-6f) == 5);

    MesoSweepInstance line = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 0, 1}, {0, 0, 1}},
                              {{1, 0, 0}, {1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    scene.sweeps = &line;
    kind.division_count = 100;
    CHECK(meso_detail_rings(&scene, &kind, 1e-3f) == 2);
    kind.cap = true;
    CHECK(meso_detail_rings(&scene, &kind, 1e-3f) > 10);
}

int main(void)
{
    test_columns();
    test_rings();
    return 0;
}
