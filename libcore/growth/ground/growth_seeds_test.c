#include "libcore/growth/ground/growth_seeds.h"

#include "libcore/geodesic/transport/walk_fixture.h"
#include "libcore/growth/ground/ground_fixture.h"
#include "libcore/growth/ground/surface_reach.h"

#define HEAD "meso-grow 1 unit m "
#define RULE " rule A() -> stop"

static MesoGroundScene scene;

static MesoGrowthStarts seeds(const char *text, uint64_t seed, uint32_t threads)
{
    MesoGrowthStarts starts;
    MesoError error;
    meso_ground_scene_read(&scene, text);
    if (meso_growth_seeds(&starts, &scene.arena, &scene.grammar, &scene.contexts, NULL, seed, threads, &error)) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    return starts;
}

/* ---- distances between seeds ---- */

typedef struct Nearest {
    const MesoGrowthStarts *starts;
    const uint32_t *first;          /* [triangle_count] seed in a triangle */
    const uint32_t *next;           /* [count] */
    uint32_t self;                  /* does not count */
    double least;
} Nearest;

static void look_from(void *context, const MesoReachView *view)
{
    Nearest *nearest = context;
    for (uint32_t s = nearest->first[view->triangle]; s != MESO_NO_INDEX; s = nearest->next[s])
        if (s != nearest->self)
            nearest->least = fmin(nearest->least, meso_view_distance(&scene.ground.walk, view,
                                                                     nearest->starts->starts[s].tip.weight));
}

static void nearest_init(Nearest *nearest, const MesoGrowthStarts *starts)
{
    uint32_t *first = malloc(scene.mesh.triangle_count * sizeof *first);
    uint32_t *next = malloc((starts->count + 1) * sizeof *next);
    CHECK(first && next);
    for (uint32_t t = 0; t < scene.mesh.triangle_count; t++)
        first[t] = MESO_NO_INDEX;
    for (uint32_t s = 0; s < starts->count; s++) {
        uint32_t *head = &first[starts->starts[s].tip.triangle];
        next[s] = *head;
        *head = s;
    }
    *nearest = (Nearest){.starts = starts, .first = first, .next = next};
}

static void nearest_release(const Nearest *nearest)
{
    free((void *)nearest->first);
    free((void *)nearest->next);
}

static double height_of(const MesoTip *tip)
{
    double at[3];
    meso_tip_position(&scene.mesh, tip, at);
    return at[2];
}

typedef struct Spread {
    double nearest, farthest;       /* of seeds from each other; of points from the nearest seed */
} Spread;

static double distance_to_others(MesoReach *reach, const Nearest *like, const MesoTip *from, double within)
{
    Nearest nearest = *like;
    MesoSurfacePlace place = {from->triangle, {from->weight[0], from->weight[1], from->weight[2]}};
    nearest.least = INFINITY;
    CHECK(meso_reach_tell(reach, &place, within, look_from, &nearest, NULL) == MESO_OK);
    return nearest.least;
}

static Spread measure(const MesoGrowthStarts *starts, double within, uint32_t points)
{
    MesoReach *reach;
    MesoRandom random;
    Spread spread = {INFINITY, 0};
    Nearest nearest;
    CHECK(meso_reach_init(&reach, &scene.arena, &scene.mesh, &scene.ground.walk, 1, NULL) == MESO_OK);
    nearest_init(&nearest, starts);
    for (uint32_t s = 0; s < starts->count; s++) {
        nearest.self = s;
        spread.nearest = fmin(spread.nearest, distance_to_others(reach, &nearest, &starts->starts[s].tip, within));
    }
    meso_random_init(&random, 9, 0);
    for (uint32_t i = 0; i < points; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground.walk, &random);
        nearest.self = MESO_NO_INDEX;
        spread.farthest = fmax(spread.farthest, distance_to_others(reach, &nearest, &tip, within));
    }
    nearest_release(&nearest);
    return spread;
}

/* ---- Poisson ---- */

/* No two nearer than the radius, and no point farther from all than that. */
static void check_poisson(MesoTriangulation mesh, const char *text, double radius, uint32_t least, uint32_t points)
{
    meso_ground_scene_init(&scene, mesh);
    MesoGrowthStarts starts = seeds(text, 1, 1);
    CHECK(starts.count >= least);
    Spread spread = measure(&starts, 1.1 * radius, points);
    CHECK(spread.nearest >= radius * (1 - 1e-9));
    CHECK(spread.farthest <= radius * (1 + 1.0 / 400));
    meso_ground_scene_release(&scene);
}

static void test_poisson(void)
{
    const char *tenth = HEAD "seed A() on poisson(10 cm)" RULE;
    check_poisson(meso_fixture_sheet(1, 1, 1), tenth, 0.1, 70, 1000);
    check_poisson(meso_fixture_sheet(40, 40, 0.025f), tenth, 0.1, 70, 1000);
    check_poisson(meso_fixture_sphere(2, 0, 2), tenth, 0.1, 700, 1000);
    check_poisson(meso_fixture_sphere(20, 0.5f, 2), tenth, 0.1, 800, 1000);
    check_poisson(meso_fixture_bumpy_torus(24, 12), tenth, 0.1, 400, 1000);
    check_poisson(meso_fixture_moebius(), tenth, 0.1, 200, 1000);
    check_poisson(meso_fixture_sphere(10, 0.5f, 2), HEAD "seed A() on poisson(3 m)" RULE, 3, 1, 20);
}

/* Fronts, for darts that see many triangles, are off by less than a triangle is wide. */
static void test_fine(void)
{
    meso_ground_scene_init(&scene, meso_fixture_sphere(40, 0.5f, 2));
    MesoGrowthStarts starts = seeds(HEAD "seed A() on poisson(80 cm)" RULE, 1, 1);
    Spread spread = measure(&starts, 1, 30);
    CHECK(starts.count > 8 && spread.nearest >= 0.8 * (1 - 0.01) && spread.farthest <= 0.8 * (1 + 0.01));
    meso_ground_scene_release(&scene);
}

/* As far from each other as the larger radius, and as dense as it wants. */
static void test_varying(void)
{
    uint32_t below = 0;
    meso_ground_scene_init(&scene, meso_fixture_sphere(20, 0.5f, 2));
    MesoGrowthStarts starts = seeds(HEAD "seed A() on poisson(12 cm + 0.06 * z)" RULE, 1, 1);
    MesoReach *reach;
    Nearest nearest;
    CHECK(meso_reach_init(&reach, &scene.arena, &scene.mesh, &scene.ground.walk, 1, NULL) == MESO_OK);
    nearest_init(&nearest, &starts);
    for (uint32_t i = 0; i < starts.count; i++)
        below += height_of(&starts.starts[i].tip) < 0;
    CHECK(below > 3 * (starts.count - below) / 2 && starts.count > 500);
    for (uint32_t i = 0; i < starts.count; i++) {
        const MesoTip *tip = &starts.starts[i].tip;
        double radius = 0.12 + 0.06 * height_of(tip);
        nearest.self = i;
        CHECK(distance_to_others(reach, &nearest, tip, 1.01 * radius) >= radius * (1 - 1e-6));
    }
    nearest_release(&nearest);
    meso_ground_scene_release(&scene);
    /* none where it is not above 0 */
    meso_ground_scene_init(&scene, meso_fixture_sheet(2, 2, 0.5f));
    starts = seeds(HEAD "seed A() on poisson((x - 0.5 m) * 0.2)" RULE, 1, 1);
    CHECK(starts.count > 20);
    for (uint32_t i = 0; i < starts.count; i++) {
        double at[3];
        meso_tip_position(&scene.mesh, &starts.starts[i].tip, at);
        CHECK(at[0] > 0.5);
    }
    meso_ground_scene_release(&scene);
}

/* Field by field: structures have gaps. */
static bool are_same(const MesoGrowthStart *a, const MesoGrowthStart *b, uint32_t count)
{
    bool same = true;
    for (uint32_t i = 0; i < count; i++)
        same = same && a[i].seed == b[i].seed && a[i].key == b[i].key && a[i].tip.triangle == b[i].tip.triangle &&
               a[i].tip.turned == b[i].tip.turned &&
               !memcmp(a[i].tip.weight, b[i].tip.weight, sizeof a[i].tip.weight) &&
               a[i].tip.heading.re == b[i].tip.heading.re && a[i].tip.heading.im == b[i].tip.heading.im;
    return same;
}

/* The same places with other numbers of faces and vertices, other threads; others with another seed. */
static void test_numbering(const char *text)
{
    MesoTriangulation a = meso_fixture_sphere(6, 0.3f, 4);
    uint32_t vertices = a.vertex_count, triangles = a.triangle_count;
    MesoVec3 *positions = malloc(vertices * sizeof *positions);
    uint32_t *corners = malloc(3 * (size_t)triangles * sizeof *corners);
    CHECK(positions && corners);
    for (uint32_t v = 0; v < vertices; v++)
        positions[vertices - 1 - v] = a.positions[v];
    for (uint32_t c = 0; c < 3 * triangles; c++)
        corners[3 * (triangles - 1 - c / 3) + (c + 1) % 3] = vertices - 1 - a.corners[c];
    static float one = 1;
    meso_ground_scene_init(&scene, a);
    scene.maps[0] = (MesoGrowthMap){.values = &one};
    MesoGrowthStarts first = seeds(text, 1, 1), again = seeds(text, 1, 3), other = seeds(text, 2, 1);
    CHECK(first.count == again.count && first.count > 0);
    CHECK(are_same(first.starts, again.starts, first.count));
    CHECK(first.count != other.count || !are_same(first.starts, other.starts, first.count));
    double (*places)[3] = malloc(first.count * sizeof *places);
    uint64_t *keys = malloc(first.count * sizeof *keys);
    uint32_t count = first.count;
    CHECK(places && keys);
    for (uint32_t i = 0; i < count; i++) {
        meso_tip_position(&scene.mesh, &first.starts[i].tip, places[i]);
        keys[i] = first.starts[i].key;
        for (uint32_t k = 0; k < i; k++)
            CHECK(keys[k] != keys[i]);
    }
    meso_ground_scene_release(&scene);
    meso_ground_scene_init(&scene, meso_fixture_triangulation(positions, vertices, corners, triangles));
    scene.maps[0] = (MesoGrowthMap){.values = &one};
    MesoGrowthStarts turned = seeds(text, 1, 1);
    CHECK(turned.count == count);
    for (uint32_t i = 0; i < count; i++) {
        double at[3];
        meso_tip_position(&scene.mesh, &turned.starts[i].tip, at);
        CHECK(keys[i] == turned.starts[i].key && meso_fixture_apart(at, places[i]) < 1e-12);
    }
    meso_ground_scene_release(&scene);
    free(places), free(keys), free(positions), free(corners);
}

/* ---- other places ---- */

static uint32_t count_left(const MesoGrowthStarts *starts, double x)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < starts->count; i++) {
        double at[3];
        meso_tip_position(&scene.mesh, &starts->starts[i].tip, at);
        count += at[0] < x;
    }
    return count;
}

/* Density 2x over a square: a quarter of it lies in the left half. A change on one side leaves the other as it was. */
static void test_density(void)
{
    meso_ground_scene_init(&scene, meso_fixture_sheet(20, 20, 0.05f));
    float *values = malloc(scene.mesh.vertex_count * sizeof *values);
    for (uint32_t v = 0; v < scene.mesh.vertex_count; v++)
        values[v] = scene.mesh.positions[v].x;
    scene.maps[0] = (MesoGrowthMap){.domain = MESO_GROWTH_BY_VERTEX, .values = values};
    const char *text = HEAD "map d = attribute(\"d\") seed A() on density(d, 20000)" RULE;
    MesoGrowthStarts starts = seeds(text, 1, 1);
    CHECK(starts.count == 20000);
    CHECK(abs((int)count_left(&starts, 0.5) - 5000) < 4 * 62 && abs((int)count_left(&starts, 0.25) - 1250) < 4 * 35);
    for (uint32_t v = 0; v < scene.mesh.vertex_count; v++)
        values[v] = scene.mesh.positions[v].x < 0.49f ? 0 : values[v];
    MesoGrowthStarts changed = seeds(text, 1, 1);
    CHECK(changed.count == 20000 && count_left(&changed, 0.449) == 0);
    /* all that was on the right is there still, in its order */
    uint32_t found = 0, right = 0;
    for (uint32_t i = 0, k = 0; i < starts.count; i++) {
        double at[3];
        meso_tip_position(&scene.mesh, &starts.starts[i].tip, at);
        if (at[0] < 0.51)
            continue;
        right++;
        while (k < changed.count && changed.starts[k].key != starts.starts[i].key)
            k++;
        found += k < changed.count;
    }
    CHECK(right > 14000 && found == right);
    for (uint32_t v = 0; v < scene.mesh.vertex_count; v++)
        values[v] = -1;
    starts = seeds(text, 1, 1);
    CHECK(starts.count == 0);
    free(values);
    meso_ground_scene_release(&scene);
}

static void test_lines(void)
{
    meso_ground_scene_init(&scene, meso_fixture_sheet(4, 3, 1));
    MesoGrowthStarts starts = seeds(HEAD "seed A() on border(1 m)" RULE, 1, 1);
    CHECK(starts.count == 14);
    for (uint32_t i = 0; i < 14; i++) {
        double a[3], b[3];
        meso_tip_position(&scene.mesh, &starts.starts[i].tip, a);
        meso_tip_position(&scene.mesh, &starts.starts[(i + 1) % 14].tip, b);
        CHECK(fabs(meso_fixture_apart(a, b) - 1) < 1e-9);
        CHECK(i > 0 || (a[0] == 0 && a[1] == 0));
    }
    starts = seeds(HEAD "seed A() on border(30 m)" RULE, 1, 1);
    CHECK(starts.count == 1);
    /* the integral of 1 / (1 + x) along two sides and across two ends */
    starts = seeds(HEAD "seed A() on border((1 m + x) / 10)" RULE, 1, 1);
    CHECK(abs((int)starts.count - (int)(10 * (2 * log(5) + 3 + 3.0 / 5))) <= 4);
    starts = seeds(HEAD "seed A() on at(1.25 m, 2.5 m, 7 m)" RULE, 1, 1);
    double at[3];
    meso_tip_position(&scene.mesh, &starts.starts[0].tip, at);
    CHECK(starts.count == 1 && fabs(at[0] - 1.25) < 1e-6 && fabs(at[1] - 2.5) < 1e-6 && at[2] == 0);
    starts = seeds(HEAD "seed A() on vertices" RULE, 1, 1);
    CHECK(starts.count == 20);
    starts = seeds(HEAD "seed A() on vertices(0)" RULE, 1, 1);
    CHECK(starts.count == 0);
    meso_ground_scene_release(&scene);
    meso_ground_scene_init(&scene, meso_fixture_moebius());
    starts = seeds(HEAD "seed A() on border(10 cm)" RULE, 1, 1);
    CHECK(starts.count > 100 && starts.count < 160);
    meso_ground_scene_release(&scene);
    meso_ground_scene_init(&scene, meso_fixture_sphere(20, 0.3f, 1));
    starts = seeds(HEAD "seed A() on border(10 cm) seed A() on vertices(0.25)" RULE, 1, 1);
    CHECK(abs((int)starts.count - 1000) < 4 * 28);
    meso_ground_scene_release(&scene);
}

/* ---- conditions and headings ---- */

/* Places that are left out change nothing of the others. */
static void test_where(void)
{
    meso_ground_scene_init(&scene, meso_fixture_sphere(10, 0.3f, 4));
    scene.fields[0] = (MesoGrowthField){.kind = MESO_GROWTH_TOWARDS, .vector = {0, 0, 1}};
    MesoGrowthStarts all = seeds(HEAD "seed A() on poisson(20 cm) face up" RULE, 1, 1);
    MesoGrowthStarts high = seeds(HEAD "seed A() on poisson(20 cm) where z > 0.2 m face up" RULE, 1, 2);
    MesoGrowthStarts few = seeds(HEAD "seed A() on poisson(20 cm) where z > 0.2 m count 7 face up" RULE, 1, 1);
    MesoGrowthStarts some = seeds(HEAD "seed A() on poisson(20 cm) where chance(0.5) and clear(1 m)" RULE, 1, 1);
    CHECK(few.count == 7 && are_same(few.starts, high.starts, 7));
    CHECK(some.count > all.count / 3 && some.count < 2 * all.count / 3);
    uint32_t k = 0;
    for (uint32_t i = 0; i < all.count; i++) {
        if (height_of(&all.starts[i].tip) <= 0.2)
            continue;
        CHECK(k < high.count && are_same(&all.starts[i], &high.starts[k], 1));
        k++;
        MesoWalk walk = {.tip = all.starts[i].tip, .length = 1e-4};
        meso_walks(&scene.ground.walk, &walk, 1, NULL);
        CHECK(height_of(&walk.tip) > height_of(&all.starts[i].tip));
    }
    CHECK(k == high.count);
    meso_ground_scene_release(&scene);
}

static void fail(const char *text, MesoStatus status, const char *message)
{
    MesoGrowthStarts starts;
    MesoError error;
    meso_ground_scene_read(&scene, text);
    CHECK(meso_growth_seeds(&starts, &scene.arena, &scene.grammar, &scene.contexts, NULL, 1, 1, &error) == status);
    CHECK_TEXT(error.message, message);
}

static void test_errors(void)
{
    meso_ground_scene_init(&scene, meso_fixture_sheet(2, 2, 1));
    fail(HEAD "\n\nseed A() on poisson(1 m / (x - x) * 1 m)" RULE, MESO_ERR_INPUT,
         "line 3: the radius is no number at a place");
    fail(HEAD "\nseed A() on border(1 m * 0)" RULE, MESO_ERR_INPUT, "line 2: the spacing is not above 0");
    fail(HEAD "seed A() on poisson(0.1 mm)" RULE, MESO_ERR_LIMIT,
         "the radius of 'poisson' is too small for so much surface");
    fail(HEAD "\nseed A() on poisson(-1 m)" RULE, MESO_ERR_INPUT, "line 2: the radius of 'poisson' is not above 0");
    meso_ground_scene_release(&scene);
}

/* ---- meshes that are none ---- */

/* Vertices in one place, in rows, far off; triangles without area. */
static void break_mesh(MesoTriangulation *mesh, MesoRandom *random)
{
    uint32_t kind = meso_random_below(random, 5);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 *p = &mesh->positions[v];
        bool chosen = meso_random_below(random, 3) == 0;
        if (kind == 0 && chosen)
            *p = mesh->positions[meso_random_below(random, mesh->vertex_count)];
        if (kind == 1)
            p->y = p->z = chosen ? 0 : p->y;
        if (kind == 2 && chosen)
            *p = meso_vec3_scale(*p, powf(10, 5 * meso_fixture_signed(random)));
        if (kind == 3)
            *p = (MesoVec3){meso_fixture_signed(random), meso_fixture_signed(random), meso_fixture_signed(random)};
        if (kind == 4)
            *p = (MesoVec3){0, 0, 0};
    }
}

/* Every kind of seeds comes to an end, at places that are some. */
static void test_broken(uint32_t count)
{
    static const char *const texts[] = {
        HEAD "seed A() on poisson(0.1 extent) face up" RULE,
        HEAD "seed A() on poisson((0.12 + 0.06 * noise(0.3 extent)) * 1 extent) face up" RULE,
        HEAD "map d = attribute(\"d\") seed A() on density(d, 50)" RULE, HEAD "seed A() on border(0.1 extent)" RULE,
        HEAD "seed A() on vertices(0.5) seed A() on at(1 m, 0, 0) where slope < 90 deg" RULE,
    };
    static float one = 1;
    MesoRandom random;
    meso_random_init(&random, 6, 0);
    for (uint32_t i = 0; i < count; i++) {
        MesoTriangulation mesh = i % 2 ? meso_fixture_torus(4, 3, 0.4f) : meso_fixture_sheet(3, 3, 0.7f);
        break_mesh(&mesh, &random);
        meso_ground_scene_init(&scene, mesh);
        scene.maps[0] = (MesoGrowthMap){.values = &one};
        MesoGrowthStarts starts;
        MesoError error;
        meso_ground_scene_read(&scene, texts[i / 2 % 5]);
        MesoStatus status = meso_growth_seeds(&starts, &scene.arena, &scene.grammar, &scene.contexts, NULL, i, 1,
                                              &error);
        CHECK(status == MESO_OK);
        for (uint32_t s = 0; s < starts.count; s++) {
            const MesoTip *tip = &starts.starts[s].tip;
            CHECK(tip->triangle < mesh.triangle_count);
            CHECK(fabs(tip->weight[0] + tip->weight[1] + tip->weight[2] - 1) < 1e-12);
            for (uint32_t k = 0; k < 3; k++)
                CHECK(tip->weight[k] >= 0 && tip->weight[k] <= 1);
            CHECK(fabs(hypot(tip->heading.re, tip->heading.im) - 1) < 1e-12);
        }
        meso_ground_scene_release(&scene);
    }
}

int main(void)
{
    test_broken(150);
    test_poisson();
    test_fine();
    test_varying();
    test_numbering(HEAD "seed A() on poisson(15 cm)" RULE);
    test_numbering(HEAD "seed A() on vertices(0.5)" RULE);
    test_numbering(HEAD "map d = attribute(\"d\") seed A() on density(d, 500)" RULE);
    test_density();
    test_lines();
    test_where();
    test_errors();
    return 0;
}
