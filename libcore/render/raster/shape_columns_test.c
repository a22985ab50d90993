/*
 * Sections as each use of a shape needs them: the same sides to be seen and to be looked at, in a row; bands in place of
 * a small loop, which seen from any side are as wide as it is.
 */
#include "libcore/render/raster/shape_columns.h"

#include <string.h>

#include "libcore/base/check.h"

enum { SIDES = 32 };

static const float SIZE = 0.25f;

static MesoArena arena;
static MesoError error;
static MesoSweepColumn columns[2 * SIDES];
static MesoSweptKind kind;
static const MesoScene scene = {.columns = columns};

static void add_column(MesoVec2 at, MesoVec2 normal, bool joins_next)
{
    columns[kind.column_count++] = (MesoSweepColumn){at, at, normal, normal, 0, joins_next, .absent = 0};
}

/* Four sides, each with columns of its own at its ends. */
static void make_square(MesoVec2 middle)
{
    const MesoVec2 corners[5] = {{-SIZE, SIZE}, {SIZE, SIZE}, {SIZE, -SIZE}, {-SIZE, -SIZE}, {-SIZE, SIZE}};
    const MesoVec2 normals[4] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (uint32_t i = 0; i < 4; i++) {
        add_column(meso_vec2_add(middle, corners[i]), normals[i], true);
        add_column(meso_vec2_add(middle, corners[i + 1]), normals[i], false);
    }
}

static void make_circle(void)
{
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * MESO_PI * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)};
        add_column(meso_vec2_scale(n, SIZE), n, i < SIDES);
    }
}

/* Each side is between two places in a row. */
static void check_places(const MesoShapeColumns *chosen)
{
    uint32_t next = 0;
    for (uint32_t k = 0; k < chosen->place_count; k++) {
        CHECK(chosen->joined[k] < 2 && (!chosen->joined[k] || chosen->place_sides[k] == next));
        if (!chosen->joined[k])
            continue;
        CHECK(k + 1 < chosen->place_count && chosen->sides[next].from == chosen->places[k] &&
              chosen->sides[next].to == chosen->places[k + 1]);
        next++;
    }
    CHECK(next == chosen->side_count);
}

static MesoShapeColumns choose(float tolerance, MesoShapeUse use)
{
    MesoShapeColumns chosen;
    CHECK(meso_shape_columns(&chosen, &arena, &scene, &kind, 2, tolerance, use, &error) == MESO_OK);
    for (uint32_t s = 0; s < chosen.side_count; s++)
        CHECK(chosen.sides[s].from < chosen.count && chosen.sides[s].to < chosen.count);
    check_places(&chosen);
    return chosen;
}

static float along(const MesoShapeColumns *chosen, uint32_t i, double angle)
{
    MesoVec2 p = columns[chosen->kept[i]].start;
    return (float)(p.x * cos(angle) + p.y * sin(angle));
}

/* How wide its sides are, seen from there; a gap between them counts as nothing. */
static float width(const MesoShapeColumns *chosen, double angle)
{
    enum { PLACES = 2000 };
    uint32_t hit = 0;
    for (int k = 0; k < PLACES; k++) {
        float place = 2 * ((float)k / PLACES - 0.5f);
        bool any = false;
        for (uint32_t s = 0; s < chosen->side_count; s++) {
            float a = along(chosen, chosen->sides[s].from, angle), b = along(chosen, chosen->sides[s].to, angle);
            any = any || (place >= fminf(a, b) && place < fmaxf(a, b));
        }
        hit += any;
    }
    return 2 * (float)hit / PLACES;
}

static void test_square(void)
{
    kind = (MesoSweptKind){0};
    make_square((MesoVec2){0, 0});
    MesoShapeColumns whole = choose(0, MESO_SHAPE_WHOLE), seen = choose(0, MESO_SHAPE_SEEN);
    CHECK(whole.count == 8 && whole.side_count == 4 && whole.closed);
    CHECK(seen.count == 4 && seen.side_count == 4 && seen.closed && seen.reach == 0);
    for (uint32_t s = 0; s < 4; s++) {
        MesoVec2 a = columns[whole.kept[whole.sides[s].from]].start, b = columns[seen.kept[seen.sides[s].from]].start;
        MesoVec2 c = columns[whole.kept[whole.sides[s].to]].start, d = columns[seen.kept[seen.sides[s].to]].start;
        CHECK(a.x == b.x && a.y == b.y && c.x == d.x && c.y == d.y);
    }
    MesoShapeColumns large = choose(SIZE, MESO_SHAPE_SHADOW), small = choose(8 * SIZE, MESO_SHAPE_SHADOW);
    CHECK(large.count == 4 && large.side_count == 4 && large.closed && large.reach == 0);
    CHECK(small.count == 4 && small.side_count == 2 && !small.closed && small.reach == 8 * SIZE);
    for (int i = 0; i < 40; i++)
        CHECK(fabsf(width(&small, 0.1 * i) - width(&large, 0.1 * i)) < 2.5e-3f);
}

static void test_circle(void)
{
    kind = (MesoSweptKind){0};
    make_circle();
    MesoShapeColumns seen = choose(0.02f, MESO_SHAPE_SEEN), whole = choose(0.02f, MESO_SHAPE_WHOLE);
    CHECK(seen.closed && seen.side_count == whole.side_count && seen.count == whole.count - 1);
    CHECK(seen.sides[seen.side_count - 1].to == 0);
    MesoShapeColumns small = choose(8 * SIZE, MESO_SHAPE_SHADOW);
    for (int i = 0; i < 40; i++)
        CHECK(width(&small, 0.1 * i) > 0.7f * 2 * SIZE && width(&small, 0.1 * i) < 2.01f * SIZE);
}

/* Seen from all sides, in the mean; of those kept, wherever they have been moved to. */
static double mean_width(const MesoShapeColumns *chosen)
{
    enum { WAYS = 90 };
    double sum = 0;
    for (uint32_t i = 0; i < WAYS; i++) {
        double angle = MESO_PI * i / WAYS, low = INFINITY, high = -INFINITY;
        for (uint32_t k = 0; k < chosen->count; k++) {
            MesoVec2 p = chosen->stand_ins ? chosen->stand_ins[k].start : columns[chosen->kept[k]].start;
            double place = p.x * cos(angle) + p.y * sin(angle);
            low = fmin(low, place);
            high = fmax(high, place);
        }
        sum += (high - low) / WAYS;
    }
    return sum;
}

/* However few sides there are, and evenly as long; corners stay where they are. */
static void test_stand_ins(void)
{
    kind = (MesoSweptKind){0};
    make_circle();
    MesoShapeColumns all = choose(0, MESO_SHAPE_SEEN);
    CHECK(!all.stand_ins);
    for (float tolerance = 0.02f; tolerance < 2; tolerance *= 1.5f) {
        MesoShapeColumns few = choose(tolerance, MESO_SHAPE_SEEN), whole = choose(tolerance, MESO_SHAPE_WHOLE);
        CHECK(few.side_count < SIDES && fabs(mean_width(&few) / mean_width(&all) - 1) < 0.005);
        CHECK(memcmp(few.stand_ins, whole.stand_ins, few.count * sizeof *few.stand_ins) == 0);
        for (uint32_t s = 0; s + 1 < few.side_count; s++)
            CHECK(few.kept[s + 1] - few.kept[s] <= SIDES / few.side_count + 1);
    }
    kind = (MesoSweptKind){0};
    make_square((MesoVec2){0, 0});
    CHECK(!choose(SIZE, MESO_SHAPE_WHOLE).stand_ins);
}

/* Two loops are two times two bands; what is open stays as it is. */
static void test_others(void)
{
    kind = (MesoSweptKind){0};
    make_square((MesoVec2){-1, 0});
    make_square((MesoVec2){1, 0});
    MesoShapeColumns chosen = choose(8 * SIZE, MESO_SHAPE_SHADOW);
    CHECK(chosen.count == 8 && chosen.side_count == 4);
    kind = (MesoSweptKind){0};
    for (uint32_t i = 0; i < 8; i++)
        add_column((MesoVec2){0.01f * (float)i, i % 2 ? 0.02f : 0}, (MesoVec2){0, 1}, i < 7);
    chosen = choose(0, MESO_SHAPE_SEEN);
    CHECK(chosen.count == 8 && chosen.side_count == 7 && !chosen.closed);
    chosen = choose(8 * SIZE, MESO_SHAPE_SHADOW);
    CHECK(!chosen.closed && chosen.reach == 0);
    kind = (MesoSweptKind){0};
    chosen = choose(1, MESO_SHAPE_SHADOW);
    CHECK(chosen.count == 0 && chosen.side_count == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    test_square();
    test_circle();
    test_stand_ins();
    test_others();
    meso_arena_release(&arena);
    return 0;
}
