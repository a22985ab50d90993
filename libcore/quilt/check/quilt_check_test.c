/* Faults are planted in a quilt that has none, each is found, and nothing else. */
#include "libcore/quilt/check/quilt_check.h"
#include "libcore/quilt/embed/quilt_embed.h"
#include "libcore/quilt/embed/quilt_fixture.h"

typedef struct Case {
    MesoArena arena;
    QuiltFixture f;
    MesoVec3 *positions;
} Case;

/* Two cubes of side 1 and half the height over eight tiles. */
static Case sound(void)
{
    Case c;
    MesoError error;
    meso_arena_init(&c.arena);
    c.f = quilt_fixture(&c.arena);
    c.f.swatch.kinds[0] = MESO_ELEMENT_WHOLE;   /* it fills its tile, and would be a strand */
    c.positions = MESO_NEW(&c.arena, MesoVec3, c.f.quilt.vertex_count, &error);
    MesoVec3 *directions = MESO_NEW(&c.arena, MesoVec3, c.f.base.vertex_count, &error);
    CHECK(c.positions && directions);
    meso_quilt_directions(directions, &c.f.base);
    meso_quilt_embed(c.positions, &c.f.quilt, &c.f.base, directions, 1);
    return c;
}

static MesoQuiltCheck measure(Case *c, uint32_t thread_count)
{
    MesoQuiltCheck check;
    MesoError error;
    size_t used = c->arena.used;
    CHECK(meso_quilt_check(&check, &c->arena, &c->f.quilt, &c->f.swatch, c->positions, &c->f.base,
                           &(MesoQuiltCheckOptions){.scale = 1, .height_scale = 0.5f, .thread_count = thread_count},
                           &error) == MESO_OK);
    CHECK(c->arena.used == used);
    return check;
}

static void release(Case *c)
{
    meso_triangulation_release(&c->f.base);
    meso_arena_release(&c->arena);
}

/* All counts of faults, one bit each. */
enum {
    UNPLACED = 1, OPEN = 2, CROWDED = 4, REVERSED = 8, COLLAPSED = 16, PINCHED = 32, CHANGED = 64, SQUEEZED = 128,
    MERGED = 256, APART = 512, CROSSED = 1024, FOLDED = 2048
};

static unsigned faults(const MesoQuiltCheck *k)
{
    const MesoMeshFaults *f = &k->faults;
    return (f->unplaced_count ? UNPLACED : 0u) | (f->open_count ? OPEN : 0u) | (f->crowded_count ? CROWDED : 0u) |
           (f->reversed_count ? REVERSED : 0u) | (f->collapsed_count ? COLLAPSED : 0u) |
           (f->pinched_count ? PINCHED : 0u) | (k->changed_count ? CHANGED : 0u) |
           (k->squeezed_count ? SQUEEZED : 0u) | (k->merged_count ? MERGED : 0u) | (k->apart_count ? APART : 0u) |
           (k->crossings.between_count ? CROSSED : 0u) | (k->crossings.within_count ? FOLDED : 0u);
}

static void test_sound(void)
{
    Case c = sound();
    MesoQuiltCheck k = measure(&c, 1);
    CHECK(faults(&k) == 0);
    CHECK(k.whole_count == 2 && k.strand_count == 0);
    CHECK(fabs(k.expected_whole_count - 8) < 1e-6 && fabs(k.expected_triangle_count - 96) < 1e-4);
    CHECK(fabs(k.least_volume - 1) < 1e-5 && fabs(k.largest_volume - 1) < 1e-5);
    /* cubes have area 6, these have 4, and there are two where there should be eight */
    CHECK(fabs(k.area_share - 2 * 4 / (8 * 6.0)) < 1e-5);
    release(&c);
}

static void test_hole(void)
{
    Case c = sound();
    c.f.quilt.triangle_count = --c.f.quilt.triangle_begin[2];
    MesoQuiltCheck k = measure(&c, 1);
    CHECK(faults(&k) == (OPEN | CHANGED));
    CHECK(k.faults.open_count == 3 && k.changed_count == 1);
    release(&c);
}

static void test_flipped(void)
{
    Case c = sound();
    uint32_t a = c.f.quilt.corners[0];
    c.f.quilt.corners[0] = c.f.quilt.corners[1];
    c.f.quilt.corners[1] = a;
    MesoQuiltCheck k = measure(&c, 1);
    /* the volume under it counts the wrong way, unless it goes through the point that volumes are told from */
    CHECK((faults(&k) & ~(unsigned)SQUEEZED) == REVERSED && k.faults.reversed_count == 3);
    release(&c);
}

/* The last triangle again, and one whose corners are two. */
static void test_crowded(void)
{
    Case c = sound();
    uint32_t *last = &c.f.quilt.corners[3 * c.f.quilt.triangle_count - 3];
    for (int k = 0; k < 3; k++)
        last[k] = last[k - 3];
    MesoQuiltCheck k = measure(&c, 1);
    CHECK((faults(&k) & (CROWDED | OPEN)) == (CROWDED | OPEN));
    last[1] = last[0];
    k = measure(&c, 1);
    CHECK(k.faults.collapsed_count == 1);
    release(&c);
}

static void test_unplaced(void)
{
    Case c = sound();
    c.positions[3].y = NAN;
    MesoQuiltCheck k = measure(&c, 1);
    CHECK(faults(&k) == UNPLACED && k.faults.unplaced_count == 1 && k.whole_count == 0);
    release(&c);
}

/* A corner of the second cube is that of the first. */
static void test_pinched(void)
{
    Case c = sound();
    uint32_t old = c.f.quilt.corners[36];
    for (uint32_t i = 36; i < 72; i++)
        if (c.f.quilt.corners[i] == old)
            c.f.quilt.corners[i] = 0;
    MesoQuiltCheck k = measure(&c, 1);
    CHECK(faults(&k) & PINCHED);
    CHECK(k.faults.pinched_count == 1 && (faults(&k) & (OPEN | CROWDED | REVERSED)) == 0);
    release(&c);
}

static void test_squeezed(void)
{
    Case c = sound();
    for (uint32_t v = 8; v < 16; v++)
        c.positions[v].z *= 0.8f;
    MesoQuiltCheck k = measure(&c, 1);
    CHECK(faults(&k) == SQUEEZED && k.squeezed_count == 1);
    CHECK(fabs(k.least_volume - 0.8) < 1e-5);
    release(&c);
}

static void test_pushed_together(void)
{
    Case c = sound();
    for (uint32_t v = 8; v < 16; v++)
        c.positions[v] = meso_vec3_add(c.positions[v], (MesoVec3){-1.3f, 0.1f, 0.1f});
    MesoQuiltCheck k = measure(&c, 1), again = measure(&c, 3);
    CHECK(faults(&k) == CROSSED && k.crossings.element_count == 2 && k.crossings.one_patch_count == 0);
    CHECK(k.crossings.between_count == again.crossings.between_count);
    CHECK(k.swatch_crossings.between_count + k.swatch_crossings.within_count == 0 && k.expected_crossings == 0);
    release(&c);
}

/* A corner is pushed out through the opposite side. */
static void test_folded(void)
{
    Case c = sound();
    c.positions[7] = meso_vec3_add(c.positions[7], (MesoVec3){-1.4f, -1.4f, -0.2f});
    MesoQuiltCheck k = measure(&c, 1);
    CHECK((faults(&k) & ~(unsigned)SQUEEZED) == FOLDED && k.crossings.one_patch_count == k.crossings.within_count);
    release(&c);
}

/* Both cubes are said to be one element. */
static void test_apart(void)
{
    Case c = sound();
    c.f.quilt.element_count = 1;
    c.f.quilt.triangle_begin[1] = c.f.quilt.triangle_begin[2];
    c.f.quilt.vertex_begin[1] = c.f.quilt.vertex_begin[2];
    MesoQuiltCheck k = measure(&c, 1);
    CHECK(faults(&k) == (APART | CHANGED));
    release(&c);
}

int main(void)
{
    test_sound();
    test_hole();
    test_flipped();
    test_crowded();
    test_unplaced();
    test_pinched();
    test_squeezed();
    test_pushed_together();
    test_folded();
    test_apart();
    return 0;
}
