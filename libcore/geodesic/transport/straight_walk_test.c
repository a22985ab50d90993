/* Straightest walks against formulas, against themselves, and on meshes that are none. */
#include "libcore/geodesic/transport/straight_walk.h"

#include "libcore/geodesic/exact/exact_fixture.h"
#include "libcore/geodesic/transport/walk_fixture.h"

/* ---- formulas ---- */

/* A sheet from 0 to 9 and to 7: straight in the plane, as far as the border. */
static void test_sheet(void)
{
    MesoWalkScene scene;
    MesoRandom random;
    uint32_t counts[3] = {0, 0, 0};
    meso_walk_scene_init(&scene, meso_fixture_sheet(9, 7, 1));
    meso_random_init(&random, 1, 0);
    for (uint32_t i = 0; i < 2000; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        double from[3], along[3], to[3], heading[3], length = 8 * meso_fixture_uniform(&random);
        meso_fixture_place(&scene.mesh, &tip, from, along);
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, length, NULL);
        meso_fixture_place(&scene.mesh, &walk.tip, to, heading);
        double way = length - walk.length;
        CHECK(fabs(to[0] - from[0] - way * along[0]) < 1e-13 && fabs(to[1] - from[1] - way * along[1]) < 1e-13);
        CHECK(meso_fixture_apart(along, heading) < 1e-14);
        bool inside = from[0] + length * along[0] > 0 && from[0] + length * along[0] < 9 &&
                      from[1] + length * along[1] > 0 && from[1] + length * along[1] < 7;
        CHECK(inside == (walk.stop == MESO_WALK_DONE));
        CHECK(inside || fmin(fmin(to[0], 9 - to[0]), fmin(to[1], 7 - to[1])) < 1e-13);
        counts[walk.stop]++;
        /* from the border it leads nowhere, and back */
        if (!inside)
            CHECK(meso_fixture_walk(&scene.ground, walk.tip, 1, NULL).length > 1 - 1e-13);
        MesoWalk back = meso_fixture_walk(&scene.ground, meso_fixture_back(walk.tip), way, NULL);
        meso_tip_position(&scene.mesh, &back.tip, to);
        CHECK(meso_fixture_apart(from, to) < 1e-12);
    }
    CHECK(counts[MESO_WALK_DONE] > 500 && counts[MESO_WALK_BORDER] > 500 && counts[MESO_WALK_LIMIT] == 0);
    meso_walk_scene_release(&scene);
}

/* Along the sides of a sheet and through its vertices, from corners and sides, whichever triangle is asked. */
static void test_exact_places(void)
{
    MesoWalkScene scene;
    meso_walk_scene_init(&scene, meso_fixture_sheet(8, 8, 1));
    for (uint32_t t = 0; t < scene.mesh.triangle_count; t++)
        for (uint32_t k = 0; k < 6; k++)
            for (uint32_t turn = 0; turn < 8; turn++) {
                MesoTip tip = {.triangle = t};
                double from[3], to[3], along[3] = {cos(turn * MESO_PI / 4), sin(turn * MESO_PI / 4), 0};
                tip.weight[k % 3] = k < 3 ? 1 : 0.5;
                tip.weight[(k + 1) % 3] = k < 3 ? 0 : 0.5;
                CHECK(meso_tip_head(&tip, &scene.mesh, along));
                meso_tip_position(&scene.mesh, &tip, from);
                MesoWalk walk = meso_fixture_walk(&scene.ground, tip, 2, NULL);
                meso_tip_position(&scene.mesh, &walk.tip, to);
                for (uint32_t i = 0; i < 3; i++)
                    from[i] += (2 - walk.length) * along[i];
                CHECK(meso_fixture_apart(from, to) < 1e-14);
                bool near_border = fmin(fmin(to[0], 8 - to[0]), fmin(to[1], 8 - to[1])) < 1e-14;
                CHECK(walk.stop == MESO_WALK_DONE ? walk.length == 0 : near_border);
            }
    meso_walk_scene_release(&scene);
}

/* Along a border, where no rounding comes in, as far as its end. */
static void test_border(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}};
    const uint32_t corners[3] = {0, 1, 2};
    MesoWalkScene scene;
    meso_walk_scene_init(&scene, meso_fixture_triangulation(positions, 3, corners, 1));
    for (int way = -1; way <= 1; way += 2) {
        MesoTip tip = {0, false, {0.5, 0.5, 0}, {way, 0}};
        MesoWalk part = meso_fixture_walk(&scene.ground, tip, 1, NULL);
        CHECK(part.stop == MESO_WALK_DONE && part.tip.weight[way < 0 ? 0 : 1] == 0.75);
        MesoWalk all = meso_fixture_walk(&scene.ground, tip, 9, NULL);
        CHECK(all.stop == MESO_WALK_BORDER && all.tip.weight[way < 0 ? 0 : 1] == 1 && all.length == 7);
    }
    meso_walk_scene_release(&scene);
}

/* A prism of n sides around z: helices. */
static void test_tube(void)
{
    enum { SIDES = 17 };
    MesoWalkScene scene;
    MesoRandom random;
    meso_walk_scene_init(&scene, meso_fixture_tube(SIDES, 40, 40));
    meso_random_init(&random, 2, 0);
    double side = 2 * sin(MESO_PI / SIDES);
    for (uint32_t i = 0; i < 500; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        double from[3], along[3], to[3];
        meso_tip_position(&scene.mesh, &tip, from);
        from[2] = fmod(from[2], 40);
        double slope = 1.2 * (meso_fixture_uniform(&random) - 0.5);
        uint32_t column = tip.triangle / 2 % SIDES;
        double middle = 2 * MESO_PI * (column + 0.5) / SIDES;
        double towards[3] = {-sin(middle) * cos(slope), cos(middle) * cos(slope), sin(slope)};
        CHECK(meso_tip_head(&tip, &scene.mesh, towards));
        /* three times around brings it back, as high as the slope says */
        double length = 3 * SIDES * side / cos(slope);
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, length, NULL);
        meso_fixture_place(&scene.mesh, &walk.tip, to, along);
        double rise = (length - walk.length) * sin(slope);
        CHECK(fabs(to[2] - from[2] - rise) < 1e-5);
        if (walk.stop == MESO_WALK_DONE) {
            CHECK(fabs(to[0] - from[0]) < 1e-5 && fabs(to[1] - from[1]) < 1e-5);
            CHECK(meso_fixture_apart(along, towards) < 1e-5);
        } else {
            CHECK(to[2] < 1e-5 || to[2] > 40 - 1e-5);
        }
    }
    meso_walk_scene_release(&scene);
}

/* A sheet whose borders are glued into a flat torus: lines of rational slope close, and the same for a Klein bottle. */
static void test_glued(void)
{
    MesoWalkScene scene;
    MesoRandom random;
    enum { N = 6 };
    meso_walk_scene_init(&scene, meso_fixture_sheet(N, N, 1));
    for (uint32_t i = 0; i < N; i++) {
        /* of a square the first triangle has the low and the right side, the second the left and the high one */
        uint32_t low = 3 * (2 * i), high = 3 * (2 * (N * (N - 1) + i) + 1) + 1;
        uint32_t left = 3 * (2 * N * i + 1) + 2, right = 3 * (2 * (N * i + N - 1)) + 1;
        scene.ground.faces[low / 3].twins[low % 3] = high;
        scene.ground.faces[high / 3].twins[high % 3] = low;
        scene.ground.faces[left / 3].twins[left % 3] = right;
        scene.ground.faces[right / 3].twins[right % 3] = left;
    }
    meso_random_init(&random, 3, 0);
    for (uint32_t i = 0; i < 500; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        double from[3], to[3], heading[3];
        int p = (int)meso_random_below(&random, 9) - 4, q = (int)meso_random_below(&random, 9) - 4;
        double towards[3] = {p, q, 0}, length = N * hypot(p, q);
        if (!meso_tip_head(&tip, &scene.mesh, towards))
            continue;
        meso_tip_position(&scene.mesh, &tip, from);
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, length, NULL);
        meso_fixture_place(&scene.mesh, &walk.tip, to, heading);
        CHECK(walk.stop == MESO_WALK_DONE && meso_fixture_apart(from, to) < 1e-12);
        CHECK(fabs(heading[0] * q - heading[1] * p) < 1e-12 && heading[0] * p + heading[1] * q > 0);
    }
    meso_walk_scene_release(&scene);
}

/* Great circles come back as nearly as the polyhedron is a sphere. */
static void test_ball(void)
{
    MesoWalkScene scene;
    MesoRandom random;
    double mean = 0;
    meso_walk_scene_init(&scene, meso_fixture_ball(100));
    meso_random_init(&random, 4, 0);
    for (uint32_t i = 0; i < 200; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        double from[3], to[3];
        meso_tip_position(&scene.mesh, &tip, from);
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, 2 * MESO_PI, NULL);
        meso_tip_position(&scene.mesh, &walk.tip, to);
        CHECK(walk.stop == MESO_WALK_DONE && meso_fixture_apart(from, to) < 0.02);
        mean += meso_fixture_apart(from, to) / 200;
    }
    CHECK(mean < 0.004);
    meso_walk_scene_release(&scene);
}

/* ---- conserved ---- */

static void test_there_and_back(void)
{
    MesoWalkScene scene;
    MesoRandom random;
    meso_walk_scene_init(&scene, meso_fixture_bumpy_torus(320, 128));
    meso_random_init(&random, 6, 0);
    for (uint32_t i = 0; i < 3000; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        double from[3], along[3], to[3], heading[3];
        meso_fixture_place(&scene.mesh, &tip, from, along);
        MesoWalk there = meso_fixture_walk(&scene.ground, tip, 1, NULL);
        MesoWalk back = meso_fixture_walk(&scene.ground, meso_fixture_back(there.tip), 1, NULL);
        MesoTip end = meso_fixture_back(back.tip);
        meso_fixture_place(&scene.mesh, &end, to, heading);
        CHECK(meso_fixture_apart(from, to) < 1e-11 && meso_fixture_apart(along, heading) < 1e-10);
    }
    meso_walk_scene_release(&scene);
}

/* In twenty steps as in one, in company as alone. */
static void test_steps(void)
{
    enum { COUNT = 300 };
    MesoWalkScene scene;
    MesoRandom random;
    MesoWalk together[COUNT], alone[COUNT];
    meso_walk_scene_init(&scene, meso_fixture_bumpy_torus(100, 40));
    meso_random_init(&random, 7, 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        together[i] = (MesoWalk){.tip = tip, .length = 3 * meso_fixture_uniform(&random)};
        alone[i] = meso_fixture_walk(&scene.ground, tip, together[i].length, NULL);
        MesoTip step = tip;
        double a[3], b[3], along[3], heading[3];
        for (uint32_t k = 0; k < 20; k++)
            step = meso_fixture_walk(&scene.ground, step, together[i].length / 20, NULL).tip;
        meso_fixture_place(&scene.mesh, &step, a, along);
        meso_fixture_place(&scene.mesh, &alone[i].tip, b, heading);
        CHECK(meso_fixture_apart(a, b) < 1e-11 && meso_fixture_apart(along, heading) < 1e-9);
    }
    meso_walks(&scene.ground, together, COUNT, NULL);
    for (uint32_t i = 0; i < COUNT; i++) {
        CHECK(together[i].tip.triangle == alone[i].tip.triangle && together[i].crossings == alone[i].crossings);
        CHECK(memcmp(together[i].tip.weight, alone[i].tip.weight, sizeof alone[i].tip.weight) == 0);
        CHECK(memcmp(&together[i].tip.heading, &alone[i].tip.heading, sizeof alone[i].tip.heading) == 0);
    }
    meso_walk_scene_release(&scene);
}

/* ---- pieces ---- */

typedef struct Trail {
    const MesoWalkScene *scene;
    MesoWalkPiece last;
    MesoComplex carried;    /* the first heading, carried across each side */
    double length;
    uint32_t count;
} Trail;

static void check_piece(void *context, const MesoWalkPiece *piece)
{
    Trail *trail = context;
    const MesoWalkGround *ground = &trail->scene->ground;
    if (trail->count++ == 0) {
        CHECK(piece->enters == 3);
    } else {
        const MesoWalkFace *before = &ground->faces[trail->last.triangle];
        uint32_t side = trail->last.leaves;
        CHECK(side < 3 && before->twins[side] == 3 * piece->triangle + piece->enters);
        CHECK(piece->turned == (trail->last.turned != meso_walk_turns(before, side)));
        trail->carried = meso_walk_across(ground, trail->last.triangle, side, trail->carried);
        /* where one ends the next begins */
        double ends[2][3];
        for (uint32_t k = 0; k < 2; k++) {
            const MesoWalkPiece *at = k ? piece : &trail->last;
            MesoComplex corners[3];
            meso_walk_corners(ground, at->triangle, corners);
            uint32_t c = k ? piece->enters : side, next = meso_next_side(c);
            double share = hypot(at->ends[1 - k].re - corners[c].re, at->ends[1 - k].im - corners[c].im) /
                           hypot(corners[next].re - corners[c].re, corners[next].im - corners[c].im);
            MesoTip tip = {.triangle = at->triangle};
            tip.weight[c] = 1 - share;
            tip.weight[next] = share;
            meso_tip_position(&trail->scene->mesh, &tip, ends[k]);
        }
        CHECK(meso_fixture_apart(ends[0], ends[1]) < 1e-13);
    }
    MesoComplex way = {piece->ends[1].re - piece->ends[0].re, piece->ends[1].im - piece->ends[0].im};
    trail->length += hypot(way.re, way.im);
    CHECK(fabs(way.re * trail->carried.im - way.im * trail->carried.re) < 1e-12);
    trail->last = *piece;
}

static void check_pieces(MesoTriangulation mesh, uint64_t seed)
{
    MesoWalkScene scene;
    MesoRandom random;
    meso_walk_scene_init(&scene, mesh);
    meso_random_init(&random, seed, 0);
    for (uint32_t i = 0; i < 500; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        Trail trail = {.scene = &scene, .carried = tip.heading};
        MesoWalkOptions options = {.piece = check_piece, .context = &trail};
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, 2, &options);
        MesoWalk untold = meso_fixture_walk(&scene.ground, tip, 2, NULL);
        CHECK(memcmp(&walk.tip.weight, &untold.tip.weight, sizeof walk.tip.weight) == 0);
        CHECK(trail.count == walk.crossings + 1 && trail.last.triangle == walk.tip.triangle);
        CHECK(trail.last.turned == walk.tip.turned);
        CHECK((trail.last.leaves == 3) == (walk.stop == MESO_WALK_DONE));
        CHECK(fabs(trail.length - (2 - walk.length)) < 1e-12);
        /* what is carried along as the heading is, is the heading */
        CHECK(hypot(trail.carried.re - walk.tip.heading.re, trail.carried.im - walk.tip.heading.im) < 1e-10);
        MesoComplex left = {-tip.heading.im, tip.heading.re}, there = meso_tip_transport(&tip, &walk.tip, left);
        double sign = walk.tip.turned ? -1 : 1;
        CHECK(hypot(there.re + sign * walk.tip.heading.im, there.im - sign * walk.tip.heading.re) < 1e-14);
    }
    meso_walk_scene_release(&scene);
}

/* ---- bands that are wound against themselves ---- */

/* A band of flat squares, glued upside down: once around it is turned, on the other side; twice, as it was. */
static void test_band(void)
{
    enum { COLUMNS = 10, ROWS = 4 };
    MesoWalkScene scene;
    MesoRandom random;
    meso_walk_scene_init(&scene, meso_fixture_sheet(COLUMNS, ROWS, 1));
    for (uint32_t r = 0; r < ROWS; r++) {
        uint32_t left = 3 * (2 * COLUMNS * r + 1) + 2, right = 3 * (2 * (COLUMNS * (ROWS - r) - 1)) + 1;
        scene.ground.faces[left / 3].twins[left % 3] = right;
        scene.ground.faces[right / 3].twins[right % 3] = left;
        scene.ground.faces[left / 3].marks |= 1u << left % 3;
        scene.ground.faces[right / 3].marks |= 1u << right % 3;
    }
    meso_random_init(&random, 8, 0);
    for (uint32_t i = 0; i < 300; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        double slope = 0.1 * (meso_fixture_uniform(&random) - 0.5), towards[3] = {cos(slope), sin(slope), 0};
        double from[3], to[3], along[3];
        CHECK(meso_tip_head(&tip, &scene.mesh, towards));
        meso_tip_position(&scene.mesh, &tip, from);
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, COLUMNS / cos(slope), NULL);
        if (walk.stop != MESO_WALK_DONE)
            continue;
        meso_fixture_place(&scene.mesh, &walk.tip, to, along);
        CHECK(walk.tip.turned && fabs(to[0] - from[0]) < 1e-12);
        CHECK(fabs(to[1] - (ROWS - from[1] - COLUMNS * tan(slope))) < 1e-12);
        CHECK(fabs(along[0] - cos(slope)) < 1e-12 && fabs(along[1] + sin(slope)) < 1e-12);
        /* left is where it was to the walk, which is right to who looks from outside */
        meso_tip_turn(&walk.tip, 0.5);
        meso_fixture_place(&scene.mesh, &walk.tip, to, along);
        CHECK(fabs(along[1] + sin(slope + 0.5)) < 1e-12);
        meso_tip_turn(&walk.tip, -0.5);
        MesoWalk again = meso_fixture_walk(&scene.ground, walk.tip, COLUMNS / cos(slope), NULL);
        if (again.stop != MESO_WALK_DONE)
            continue;
        meso_fixture_place(&scene.mesh, &again.tip, to, along);
        CHECK(!again.tip.turned && fabs(to[1] - (from[1] + 2 * COLUMNS * tan(slope))) < 1e-12);
    }
    meso_walk_scene_release(&scene);
}

/* ---- grounds ---- */

/* The same record for any number of threads; frames are those of direction fields, whichever side is longest. */
static void test_ground(void)
{
    MesoWalkScene scene;
    meso_walk_scene_init(&scene, meso_fixture_bumpy_torus(100, 60));
    for (uint32_t threads = 2; threads <= 7; threads += 5) {
        MesoWalkGround other;
        CHECK(meso_walk_ground_build(&other, &scene.arena, &scene.mesh, NULL, threads, NULL) == MESO_OK);
        CHECK(memcmp(other.faces, scene.ground.faces, scene.mesh.triangle_count * sizeof *other.faces) == 0);
        CHECK(memcmp(other.lengths, scene.ground.lengths, scene.mesh.triangle_count * sizeof *other.lengths) == 0);
    }
    for (uint32_t h = 0; h < 3 * scene.mesh.triangle_count; h++) {
        MesoComplex along = meso_walk_side(&scene.ground.faces[h / 3], h % 3);
        double out[3], a[3], b[3];
        MesoTip tip = {.triangle = h / 3};
        meso_walk_direction(&scene.mesh, h / 3, along, out);
        tip.weight[h % 3] = 1;
        meso_tip_position(&scene.mesh, &tip, a);
        tip.weight[h % 3] = 0;
        tip.weight[meso_next_side(h % 3)] = 1;
        meso_tip_position(&scene.mesh, &tip, b);
        double length = meso_fixture_apart(a, b);
        for (uint32_t i = 0; i < 3; i++)
            a[i] += length * out[i];
        CHECK(meso_fixture_apart(a, b) < 1e-13);
        CHECK(length <= scene.ground.lengths[h / 3] * (1 + 1e-14));
    }
    meso_walk_scene_release(&scene);
}

/* Walks in a part of a mesh end where it does. */
static void test_domain(void)
{
    MesoWalkScene scene;
    MesoRandom random;
    const uint8_t member[2] = {0, 1};
    MesoDomain domain = {.member = member, .triangle_count = 0};
    scene.mesh = meso_fixture_u();
    meso_arena_init(&scene.arena);
    CHECK(meso_walk_ground_build(&scene.ground, &scene.arena, &scene.mesh, &domain, 2, NULL) == MESO_OK);
    meso_random_init(&random, 9, 0);
    for (uint32_t i = 0; i < 500; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random);
        if (!scene.mesh.labels[tip.triangle])
            continue;
        MesoWalk walk = meso_fixture_walk(&scene.ground, tip, 20, NULL);
        double p[3];
        meso_tip_position(&scene.mesh, &walk.tip, p);
        CHECK(walk.stop == MESO_WALK_BORDER && scene.mesh.labels[walk.tip.triangle]);
        CHECK(p[1] < 3 + 1e-12 || p[0] < 3 + 1e-12 || p[0] > 6 - 1e-12);
    }
    meso_walk_scene_release(&scene);
}

/* ---- meshes that are none ---- */

/* Vertices in few places, on a line, or far apart; sides joined at random, twisted or not. */
static void break_mesh(MesoWalkScene *scene, MesoRandom *random)
{
    uint32_t kind = meso_random_below(random, 5);
    for (uint32_t v = 0; v < scene->mesh.vertex_count; v++)
        for (uint32_t i = 0; i < 3; i++) {
            float x = meso_fixture_signed(random);
            const float values[5] = {roundf(x), i ? 0 : x, x * powf(10, 30 * meso_fixture_signed(random)),
                                     i == 2 ? 0 : roundf(2 * x), i ? 1e-30f * x : x};
            (&scene->mesh.positions[v].x)[i] = values[kind];
        }
    CHECK(meso_walk_ground_build(&scene->ground, &scene->arena, &scene->mesh, NULL, 1, NULL) == MESO_OK);
    uint32_t sides = 3 * scene->mesh.triangle_count;
    for (uint32_t n = meso_random_below(random, sides); n > 0; n--) {
        uint32_t a = meso_random_below(random, sides), b = meso_random_below(random, sides);
        scene->ground.faces[a / 3].twins[a % 3] = meso_random_below(random, 20) ? b : MESO_NO_INDEX;
        scene->ground.faces[a / 3].marks ^= meso_random_below(random, 2) << a % 3;
    }
}

static void test_broken(uint32_t count)
{
    MesoRandom random;
    meso_random_init(&random, 10, 0);
    MesoTriangulation sheet = meso_fixture_torus(4, 3, 0.4f);
    for (uint32_t i = 0; i < count; i++) {
        MesoWalkScene scene = {.mesh = sheet};
        meso_arena_init(&scene.arena);
        break_mesh(&scene, &random);
        for (uint32_t k = 0; k < 8; k++) {
            MesoTip tip = meso_fixture_tip(&scene.ground, &random);
            double length = pow(10, 6 * meso_fixture_uniform(&random) - 3);
            MesoWalkOptions options = {.crossing_limit = 2000};
            MesoWalk walk = meso_fixture_walk(&scene.ground, tip, length, &options);
            CHECK(walk.tip.triangle < scene.ground.triangle_count && walk.crossings <= 2000);
        }
        meso_arena_release(&scene.arena);
    }
    meso_triangulation_release(&sheet);
}

int main(void)
{
    test_sheet();
    test_exact_places();
    test_border();
    test_tube();
    test_glued();
    test_ball();
    test_there_and_back();
    test_steps();
    check_pieces(meso_fixture_bumpy_torus(100, 40), 11);
    check_pieces(meso_fixture_sheet(5, 5, 0.7f), 12);
    check_pieces(meso_fixture_moebius(), 13);
    test_band();
    test_ground();
    test_domain();
    test_broken(10000);
    return 0;
}
