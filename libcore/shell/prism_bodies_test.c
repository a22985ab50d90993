#include "libcore/shell/prism_bodies.h"

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/shell/box_tree.h"
#include "libcore/shell/prism_layer.h"

/* No coordinate of a hull about that origin is larger. */
#define SIZE 8.0f
static const MesoVec3d ORIGIN = {0.5, 0.25, 0.5};

static double uniform(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) / 4503599627370496.0 - 1;
}

/* Upright over 0,0 1,0 0,1, of height 1; corners moved by up to `jitter`, then all. */
static MesoPrismBody body_at(MesoRandom *random, double jitter, MesoVec3d shift)
{
    static const MesoVec3d corners[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    static const uint32_t numbers[3] = {4, 9, 2};
    MesoPrismBody body;
    for (uint32_t k = 0; k < 6; k++) {
        MesoVec3d by = {uniform(random), uniform(random), uniform(random)};
        body.corners[k] = meso_vec3d_add(meso_vec3d_mad(corners[k], jitter, by), shift);
    }
    meso_prism_split(numbers, body.tetrahedra);
    return body;
}

/* Inside the hull: all corners with some weight. */
static MesoVec3d inner_point(MesoRandom *random, const MesoPrismBody *body, bool tetrahedron)
{
    MesoVec3d sum = {0, 0, 0};
    double whole = 0;
    uint32_t part = meso_random_below(random, 3);
    for (uint32_t k = 0; k < (tetrahedron ? 4 : 6); k++) {
        double weight = 1.01 + uniform(random);
        sum = meso_vec3d_mad(sum, weight, body->corners[tetrahedron ? body->tetrahedra[part][k] : k]);
        whole += weight;
    }
    return meso_vec3d_scale(sum, 1 / whole);
}

/* By a common point: no plane lies between bodies that have one. */
static void test_meet(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t i = 0; i < 3000; i++) {
        MesoPrismBody a = body_at(&random, 0.2, (MesoVec3d){0, 0, 0}), b = body_at(&random, 0.2, (MesoVec3d){0, 0, 0});
        MesoVec3d shift = meso_vec3d_sub(inner_point(&random, &a, true), inner_point(&random, &b, true));
        for (uint32_t k = 0; k < 6; k++)
            b.corners[k] = meso_vec3d_add(b.corners[k], shift);
        CHECK(!meso_prism_hulls_apart(&a, &b) && !meso_prism_tetrahedra_apart(&a, &b));
        CHECK(!meso_prism_hulls_apart(&b, &a) && !meso_prism_tetrahedra_apart(&b, &a));
        MesoPrismHull c = meso_prism_hull(&a, ORIGIN), d = meso_prism_hull(&b, ORIGIN);
        CHECK(!meso_prism_hulls_clear(&c, &d, SIZE) && !meso_prism_walls_clear(&c, &d, SIZE));
    }
}

/* By a plane: one body on each side of it, nearer than a hundredth of their size. */
static void test_apart(void)
{
    MesoRandom random;
    uint32_t told = 0, cleared = 0;
    meso_random_init(&random, 2, 0);
    for (uint32_t i = 0; i < 3000; i++) {
        MesoPrismBody a = body_at(&random, 0.2, (MesoVec3d){0, 0, 0}), b = body_at(&random, 0.2, (MesoVec3d){0, 0, 0});
        MesoVec3d axis = {uniform(&random), uniform(&random), uniform(&random)};
        double high = -INFINITY, low = INFINITY, square = meso_vec3d_dot(axis, axis);
        for (uint32_t k = 0; k < 6; k++) {
            high = fmax(high, meso_vec3d_dot(a.corners[k], axis));
            low = fmin(low, meso_vec3d_dot(b.corners[k], axis));
        }
        for (uint32_t k = 0; k < 6; k++)
            b.corners[k] = meso_vec3d_mad(b.corners[k], (high - low + 0.01 * sqrt(square)) / square, axis);
        CHECK(meso_prism_tetrahedra_apart(&a, &b) && meso_prism_tetrahedra_apart(&b, &a));
        told += meso_prism_hulls_apart(&a, &b);
        MesoPrismHull c = meso_prism_hull(&a, ORIGIN), d = meso_prism_hull(&b, ORIGIN);
        cleared += meso_prism_hulls_clear(&c, &d, SIZE) || meso_prism_walls_clear(&c, &d, SIZE);
    }
    CHECK(told > 2900 && cleared > 100);
}

/* Side by side, as most are: always told, by the way from one to the other. */
static void test_beside(void)
{
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (uint32_t i = 0; i < 1000; i++) {
        double angle = 4 * uniform(&random);
        MesoPrismBody a = body_at(&random, 0.1, (MesoVec3d){0, 0, 0});
        MesoPrismBody b = body_at(&random, 0.1, (MesoVec3d){3 * cos(angle), 3 * sin(angle), 0.2 * uniform(&random)});
        MesoPrismHull c = meso_prism_hull(&a, ORIGIN), d = meso_prism_hull(&b, ORIGIN);
        CHECK(meso_prism_hulls_clear(&c, &d, SIZE) && meso_prism_hulls_clear(&d, &c, SIZE));
    }
}

/* Neighbours touch in a whole wall, and are apart; a little nearer they meet. */
static void test_touch(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    MesoPrismBody a = body_at(&random, 0, (MesoVec3d){0, 0, 0}), b = a;
    for (uint32_t k = 0; k < 6; k++)
        b.corners[k].x = -b.corners[k].x;
    CHECK(meso_prism_tetrahedra_apart(&a, &b));
    for (uint32_t k = 0; k < 6; k++)
        b.corners[k].x += 1e-3;
    CHECK(!meso_prism_tetrahedra_apart(&a, &b));
}

typedef struct Hits {
    uint32_t count;
    uint8_t seen[500];
} Hits;

static void hit(void *context, uint32_t number)
{
    Hits *hits = context;
    CHECK(!hits->seen[number]);
    hits->seen[number] = 1;
    hits->count++;
}

static MesoBox any_box(MesoRandom *random)
{
    float x[6];
    for (uint32_t k = 0; k < 6; k++)
        x[k] = (float)uniform(random) * (k < 3 ? 1 : 0.1f);
    return (MesoBox){{x[0], x[1], x[2]}, {x[0] + fabsf(x[3]), x[1] + fabsf(x[4]), x[2] + fabsf(x[5])}};
}

static bool boxes_meet(MesoBox a, MesoBox b)
{
    return fmaxf(a.low.x, b.low.x) <= fminf(a.high.x, b.high.x) &&
           fmaxf(a.low.y, b.low.y) <= fminf(a.high.y, b.high.y) && fmaxf(a.low.z, b.low.z) <= fminf(a.high.z, b.high.z);
}

/* Each box that meets is found once, and no other, for every number of boxes: by looking at all. */
static void test_tree(void)
{
    MesoRandom random;
    MesoArena arena;
    MesoBox boxes[500];
    meso_random_init(&random, 4, 0);
    meso_arena_init(&arena);
    for (uint32_t count = 0; count < 500; count = count < 20 ? count + 1 : count + 53) {
        MesoBoxTree tree;
        for (uint32_t b = 0; b < count; b++)
            boxes[b] = any_box(&random);
        CHECK(meso_box_tree_build(&tree, &arena, boxes, count, NULL) == MESO_OK);
        for (uint32_t i = 0; i < 50; i++) {
            Hits hits = {0};
            MesoBox box = any_box(&random);
            meso_box_tree_query(&tree, box, hit, &hits);
            for (uint32_t b = 0; b < count; b++)
                CHECK(hits.seen[b] == boxes_meet(boxes[b], box));
        }
    }
    meso_arena_release(&arena);
}

typedef struct PairHits {
    uint32_t begin, end;
    uint8_t seen[500][500];     /* by places in the tree */
} PairHits;

static void hit_pair(void *context, uint32_t place, uint32_t other)
{
    PairHits *hits = context;
    CHECK(place >= hits->begin && place < hits->end && other > place && !hits->seen[place][other]);
    hits->seen[place][other] = 1;
}

/* Each pair of boxes that meet once. */
static void test_pairs(void)
{
    static PairHits hits;
    MesoRandom random;
    MesoArena arena;
    MesoBox boxes[500];
    meso_random_init(&random, 6, 0);
    meso_arena_init(&arena);
    for (uint32_t count = 0; count < 500; count = count < 20 ? count + 1 : count + 97) {
        MesoBoxTree tree;
        for (uint32_t b = 0; b < count; b++)
            boxes[b] = any_box(&random);
        CHECK(meso_box_tree_build(&tree, &arena, boxes, count, NULL) == MESO_OK);
        hits = (PairHits){0};
        for (hits.begin = 0; hits.begin < count; hits.begin = hits.end) {
            hits.end = hits.begin + 9 * MESO_BOX_TREE_LEAF < count ? hits.begin + 9 * MESO_BOX_TREE_LEAF : count;
            meso_box_tree_query_pairs(&tree, hits.begin, hits.end, hit_pair, &hits);
        }
        for (uint32_t p = 0; p < count; p++)
            for (uint32_t q = p + 1; q < count; q++)
                CHECK(hits.seen[p][q] == boxes_meet(boxes[tree.order[p]], boxes[tree.order[q]]));
    }
    meso_arena_release(&arena);
}

int main(void)
{
    test_meet();
    test_apart();
    test_beside();
    test_pairs();
    test_touch();
    test_tree();
    return 0;
}
