/* Growth that reads maps: it keeps to what is painted, and an edit of a map changes those that read it alone. */
#include "libcore/growth/engine/growth_fixture.h"

enum { PIXELS = 128 };

/* A sheet with images over it, which a grammar's maps are in turn. */
typedef struct Painting {
    MesoGrowthScenery scenery;
    MesoVec2 *uvs;
    MesoGrowthMap *maps;
    float *pixels[2];
    double size;
} Painting;

static void painting_init(Painting *p, MesoTriangulation mesh, double size, const char *text, uint32_t starts)
{
    MesoGrowthScenery *s = &p->scenery;
    *p = (Painting){.scenery = {.values = {1, 1}}, .size = size};
    meso_scenery_init(s, mesh);
    meso_scenery_read(s, text);
    meso_scenery_strew(s, starts, 5);
    p->uvs = MESO_NEW(&s->arena, MesoVec2, 3 * (size_t)mesh.triangle_count, NULL);
    p->maps = MESO_NEW(&s->arena, MesoGrowthMap, 2, NULL);
    CHECK(p->uvs && p->maps);
    for (uint32_t c = 0; c < 3 * mesh.triangle_count; c++) {
        MesoVec3 at = mesh.positions[mesh.corners[c]];
        p->uvs[c] = (MesoVec2){at.x / (float)size, at.y / (float)size};
    }
    for (uint32_t i = 0; i < 2; i++) {
        p->pixels[i] = MESO_NEW(&s->arena, float, PIXELS * PIXELS, NULL);
        CHECK(p->pixels[i]);
        p->maps[i] = (MesoGrowthMap){.domain = MESO_GROWTH_BY_IMAGE, .uvs = p->uvs,
                                     .image = {PIXELS, PIXELS, p->pixels[i], true, MESO_GROWTH_CLAMP}};
    }
    s->contexts.maps = p->maps;
}

/* Whether a pixel is painted, by its column and its row from below. */
static float *pixel_of(const Painting *p, uint32_t map, int x, int y)
{
    return &p->pixels[map][(PIXELS - 1 - y) * PIXELS + x];
}

/* How far a point is from what is painted, in pixels, up to 3. */
static double away(const Painting *p, MesoVec3 at)
{
    double x = (double)at.x / p->size * PIXELS, y = (double)at.y / p->size * PIXELS, least = 3;
    for (int j = (int)y - 3; j <= (int)y + 3; j++)
        for (int i = (int)x - 3; i <= (int)x + 3; i++) {
            if (i < 0 || j < 0 || i >= PIXELS || j >= PIXELS || *pixel_of(p, 0, i, j) <= 0.5f)
                continue;
            double dx = fmax(fmax(i - x, x - i - 1), 0), dy = fmax(fmax(j - y, y - j - 1), 0);
            least = fmin(least, hypot(dx, dy));
        }
    return least;
}

/* The farthest that an axis comes from what is painted. */
static double farthest(const Painting *p, const MesoGrown *grown)
{
    double most = 0;
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoSpan *span = &grown->elements[i].span;
        for (int k = 0; k <= 64; k++)
            most = fmax(most, away(p, meso_bend_frame(&grown->joints[span->from], &grown->joints[span->to],
                                                      (float)k / 64).origin));
    }
    return most;
}

/* Gaps in the paint, as thin as one pixel and up to four, across and up, in fields of 5 pixels and more. */
static void paint_gaps(Painting *p)
{
    for (int y = 0; y < PIXELS; y++)
        for (int x = 0; x < PIXELS; x++)
            *pixel_of(p, 0, x, y) = x % 11 != 10 && (y % 17 < 13 || y % 34 == 30) && (x + y) % 29 != 0;
}

/* Steps of `pace` pixels keep to the paint, however large the triangles are. */
static void test_gaps(double pace, const char *turn, uint32_t squares)
{
    Painting p;
    char text[600];
    snprintf(text, sizeof text, "meso-grow 1\nmap paint = border\nshape cord = tube\nlimit generations 60\n"
             "limit elements 1500\nseed A() on vertices\n"
             "rule A() : paint > 0.5 m -> { turn(normal(0, 12 deg))\n"
             " step(%g m, %s, shape: cord, width: 1 mm, cross: true) while paint > 0.5 m else retry(12, 180 deg)\n"
             " branch { turn(normal(0, 90 deg)) A() } A() }\n", pace / PIXELS, turn);
    painting_init(&p, meso_fixture_sheet(squares, squares, 1.0f / (float)squares), 1, text, 400);
    paint_gaps(&p);
    MesoGrown grown = meso_scenery_grow(&p.scenery, &p.scenery.arena, 1);
    CHECK(grown.element_count > 500 && farthest(&p, &grown) <= 1);
    meso_scenery_release(&p.scenery);
}

/* ---- edits of a map ---- */

/* The elements of a branch, told from other growth by its key: what they are made of, in order. */
static uint64_t print_of(const MesoGrown *grown, uint32_t branch)
{
    uint64_t print = 14695981039346656037u;
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoGrowthElement *element = &grown->elements[i];
        if (element->branch != branch)
            continue;
        const MesoJoint joints[2] = {grown->joints[element->span.from], grown->joints[element->span.to]};
        const unsigned char *bytes = (const unsigned char *)joints;
        for (size_t k = 0; k < sizeof joints; k++)
            print = (print ^ bytes[k]) * 1099511628211u;
    }
    return print;
}

/* 1: the branch grew alike; 0: otherwise; -1: it is not there. */
static int is_in(const MesoGrown *grown, uint32_t branch, const MesoGrown *other)
{
    for (uint32_t b = 0; b < other->branch_count; b++)
        if (other->branches[b].key == grown->branches[branch].key)
            return print_of(grown, branch) == print_of(other, b);
    return -1;
}

/* Whether a branch, or one that it comes from, is of the second seed. */
static bool reads_second(const MesoGrown *grown, uint32_t branch)
{
    for (; grown->branches[branch].parent != MESO_NO_INDEX; branch = grown->branches[branch].parent)
        continue;
    return grown->branches[branch].seed == 1;
}

static void paint_stripes(const Painting *p, uint32_t map, int width)
{
    for (int y = 0; y < PIXELS; y++)
        for (int x = 0; x < PIXELS; x++)
            *pixel_of(p, map, x, y) = (float)(x / width % 2);
}

static void test_edit_of_map(void)
{
    Painting p;
    uint32_t counts[2] = {0}, same[2] = {0};
    painting_init(&p, meso_fixture_sheet(20, 20, 0.1f), 2,
                  "meso-grow 1\nmap one = border\nmap two = border\nshape cord = tube\nlimit generations 20\n"
                  "seed A() on vertices\nseed B() on vertices\n"
                  "rule A() -> { turn(one / 1 m * 9 deg + normal(0, 5 deg))\n"
                  " step(5 cm, shape: cord, width: 1 cm, cross: true) if chance(0.2) { branch { turn(50 deg) A() } } A() }\n"
                  "rule B() -> { turn(two / 1 m * 9 deg + normal(0, 5 deg))\n"
                  " step(5 cm, shape: cord, width: 1 cm, cross: true) if chance(0.2) { branch { turn(50 deg) B() } } B() }\n",
                  60);
    paint_stripes(&p, 0, 9);
    paint_stripes(&p, 1, 9);
    MesoGrown before = meso_scenery_grow(&p.scenery, &p.scenery.arena, 1);
    paint_stripes(&p, 1, 7);
    MesoGrown after = meso_scenery_grow(&p.scenery, &p.scenery.arena, 1);
    for (uint32_t b = 0; b < before.branch_count; b++) {
        counts[reads_second(&before, b)]++;
        same[reads_second(&before, b)] += is_in(&before, b, &after) == 1;
    }
    CHECK(counts[0] > 60 && same[0] == counts[0] && counts[1] > 60 && same[1] < counts[1] / 4);
    for (uint32_t b = 0; b < after.branch_count; b++)
        CHECK(reads_second(&after, b) || is_in(&after, b, &before) == 1);
    meso_scenery_release(&p.scenery);
}

int main(void)
{
    test_gaps(3, "0 deg", 2);
    test_gaps(12, "0 deg", 1);
    test_gaps(12, "0 deg", 90);
    test_gaps(8, "40 deg", 2);
    test_edit_of_map();
    return 0;
}
