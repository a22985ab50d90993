/* Beginning at vertices and passing them, and what directions become on their way around. */
#include "libcore/geodesic/transport/vertex_tip.h"

#include "libcore/geodesic/transport/walk_fixture.h"

static double heading_gap(const MesoTip *a, const MesoTip *b)
{
    return hypot(a->heading.re - b->heading.re, a->heading.im - b->heading.im);
}

static uint32_t corner_of(const MesoTip *tip)
{
    for (uint32_t k = 0; k < 3; k++)
        if (tip->weight[k] == 1)
            return 3 * tip->triangle + k;
    CHECK(false);
    return 0;
}

/* A pyramid of `count` triangles, the tip last. */
static MesoTriangulation pyramid(uint32_t count, float height)
{
    MesoVec3 *positions = malloc((count + 1) * sizeof *positions);
    uint32_t *corners = malloc(3 * sizeof *corners * count);
    CHECK(positions && corners);
    for (uint32_t i = 0; i < count; i++) {
        double a = 2 * MESO_PI * i / count;
        uint32_t next = (i + 1) % count, face[3] = {i, next, count};
        positions[i] = (MesoVec3){(float)cos(a), (float)sin(a), 0};
        for (uint32_t k = 0; k < 3; k++)     /* whichever corner is first */
            corners[3 * i + (k + i) % 3] = face[k];
    }
    positions[count] = (MesoVec3){0, 0, height};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, count + 1, corners, count);
    free(positions);
    free(corners);
    return mesh;
}

/* Over the tips of pyramids of any number of sides: as much angle left as right. */
static void test_pyramids(void)
{
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t count = 3; count < 3000; count += count / 2) {
        MesoWalkScene scene;
        meso_walk_scene_init(&scene, pyramid(count, 1.5f));
        uint32_t corner = scene.mesh.vertex_corner[count];
        MesoVertexTurn turn = meso_vertex_turn(&scene.ground, corner);
        double flat = 2 * asin(sin(MESO_PI / count) / sqrt(1 + 1.5 * 1.5));
        CHECK(turn.closed && turn.before == 0 && fabs(turn.angle - count * flat) < 1e-4);
        for (uint32_t i = 0; i < 50; i++) {
            MesoTip away, on, opposite;
            double angle = 20 * meso_fixture_uniform(&random) - 10;
            CHECK(meso_vertex_tip(&scene.ground, corner, angle, &away));
            CHECK(meso_vertex_tip(&scene.ground, corner, angle + MESO_PI, &opposite));
            on = meso_fixture_back(away);
            CHECK(meso_tip_pass_vertex(&scene.ground, &on, corner_of(&on) % 3));
            CHECK(on.triangle == opposite.triangle && heading_gap(&on, &opposite) < 1e-11 && !on.turned);
            /* both ways from the tip end in their triangles' sides at the rim */
            MesoWalk walk = meso_fixture_walk(&scene.ground, on, 10, NULL);
            CHECK(walk.stop == MESO_WALK_BORDER && walk.crossings == 0);
            on = meso_fixture_back(on);
            CHECK(meso_tip_pass_vertex(&scene.ground, &on, corner_of(&on) % 3));
            CHECK(on.triangle == away.triangle && heading_gap(&on, &away) < 1e-11);
        }
        meso_walk_scene_release(&scene);
    }
}

/* Where a sheet is flat, angles are those of the plane; at its borders they are scaled. */
static void test_sheet(void)
{
    MesoWalkScene scene;
    enum { N = 4 };
    meso_walk_scene_init(&scene, meso_fixture_sheet(N, N, 0.5f));
    for (uint32_t c = 0; c < 3 * scene.mesh.triangle_count; c++) {
        uint32_t v = scene.mesh.corners[c], row = v / (N + 1), column = v % (N + 1);
        int edges = (row == 0 || row == N) + (column == 0 || column == N);
        MesoVertexTurn turn = meso_vertex_turn(&scene.ground, c);
        double scale = edges == 2 ? 2 : 1, side[3];
        CHECK(turn.closed == (edges == 0) && fabs(turn.angle - (edges ? MESO_PI / edges : 2 * MESO_PI)) < 1e-12);
        meso_walk_direction(&scene.mesh, c / 3, meso_walk_side(&scene.ground.faces[c / 3], c % 3), side);
        for (uint32_t i = 0; i < 100; i++) {
            MesoTip tip;
            double at[3], heading[3], angle = 2 * MESO_PI * i / 100 + 0.01, flat = angle / scale;
            double to[3] = {side[0] * cos(flat) - side[1] * sin(flat), side[0] * sin(flat) + side[1] * cos(flat), 0};
            bool in = edges == 0 || flat <= turn.angle - turn.before;
            CHECK(meso_vertex_tip(&scene.ground, c, angle, &tip) == in);
            CHECK(edges == 0 || meso_vertex_tip(&scene.ground, c, -angle, &tip) == (flat <= turn.before));
            if (!in)
                continue;
            CHECK(meso_vertex_tip(&scene.ground, c, angle, &tip));
            meso_fixture_place(&scene.mesh, &tip, at, heading);
            CHECK(scene.mesh.corners[corner_of(&tip)] == v && meso_fixture_apart(to, heading) < 1e-13);
            MesoTip on = meso_fixture_back(tip);
            CHECK(meso_tip_pass_vertex(&scene.ground, &on, corner_of(&on) % 3) == (edges == 0));
        }
        /* along the borders, both ways */
        MesoTip tip;
        CHECK(edges == 0 || meso_vertex_tip(&scene.ground, c, -turn.before * scale, &tip));
        CHECK(edges == 0 || meso_vertex_tip(&scene.ground, c, (turn.angle - turn.before) * scale, &tip));
    }
    meso_walk_scene_release(&scene);
}

/* Whether the triangle of `there` is wound against that of `here`, another corner at the vertex. */
static bool is_turned(const MesoTriangulation *mesh, uint32_t here, uint32_t there)
{
    for (int way = 0; way < 2; way++) {
        MesoFan fan = {here, way == 1};
        do {
            if (fan.corner == there)
                return fan.turned != (way == 1);
        } while (meso_fan_next(mesh, &fan) && fan.corner != here);
    }
    CHECK(false);
    return false;
}

static void check_passing(const MesoWalkScene *scene, MesoTip tip)
{
    MesoTip on = meso_fixture_back(tip), turned = on;
    uint32_t before = corner_of(&tip);
    on.turned = false;
    turned.turned = true;
    bool passes = meso_tip_pass_vertex(&scene->ground, &on, before % 3);
    CHECK(meso_tip_pass_vertex(&scene->ground, &turned, before % 3) == passes);
    CHECK(!passes || on.turned == is_turned(&scene->mesh, before, corner_of(&on)));
    CHECK(!passes || turned.turned == !on.turned);
}

/* The same tip from whichever corner it is asked, all around every vertex. */
static void check_corners(MesoTriangulation mesh)
{
    MesoWalkScene scene;
    MesoRandom random;
    meso_walk_scene_init(&scene, mesh);
    meso_random_init(&random, 2, 0);
    for (uint32_t corner = 0; corner < 3 * scene.mesh.triangle_count; corner++) {
        MesoTip tip, same;
        if (!meso_vertex_tip(&scene.ground, corner, 12 * meso_fixture_uniform(&random) - 6, &tip))
            continue;
        uint32_t there = corner_of(&tip);
        CHECK(scene.mesh.corners[there] == scene.mesh.corners[corner]);
        CHECK(tip.turned == is_turned(&scene.mesh, corner, there));
        CHECK(meso_vertex_tip(&scene.ground, there, meso_vertex_angle(&scene.ground, there, tip.heading), &same));
        CHECK(corner_of(&same) == there && !same.turned && heading_gap(&same, &tip) < 1e-12);
        check_passing(&scene, tip);
        /* it leads into its triangle */
        CHECK(meso_fixture_walk(&scene.ground, tip, 1e-6, NULL).crossings == 0);
    }
    meso_walk_scene_release(&scene);
}

/* Once around a vertex, against the clock, a direction turns by what the angles there lack of a full turn. */
static void check_defects(MesoTriangulation mesh, double euler_number)
{
    MesoWalkScene scene;
    double sum = 0;
    meso_walk_scene_init(&scene, mesh);
    for (uint32_t v = 0; v < scene.mesh.vertex_count; v++) {
        uint32_t corner = scene.mesh.vertex_corner[v];
        MesoFan fan = {corner, false};
        MesoComplex direction = {1, 0};
        do {
            uint32_t side = meso_fan_exit(fan);
            direction = meso_walk_across(&scene.ground, side / 3, side % 3, direction);
            CHECK(meso_fan_next(&scene.mesh, &fan));
        } while (fan.corner != corner);
        double defect = 2 * MESO_PI - meso_vertex_turn(&scene.ground, corner).angle;
        CHECK(fabs(direction.re - cos(defect)) < 1e-11 && fabs(direction.im - sin(defect)) < 1e-11);
        sum += defect;
    }
    CHECK(fabs(sum - 2 * MESO_PI * euler_number) < 1e-8);
    meso_walk_scene_release(&scene);
}

/* Three quarter circles with left turns between them bound an eighth of the sphere. */
static void test_octant(void)
{
    MesoWalkScene scene;
    MesoRandom random;
    meso_walk_scene_init(&scene, meso_fixture_ball(100));
    meso_random_init(&random, 3, 0);
    for (uint32_t i = 0; i < 100; i++) {
        MesoTip tip = meso_fixture_tip(&scene.ground, &random), end = tip;
        double from[3], along[3], to[3], heading[3];
        for (uint32_t k = 0; k < 3; k++) {
            end = meso_fixture_walk(&scene.ground, end, MESO_PI / 2, NULL).tip;
            meso_tip_turn(&end, MESO_PI / 2);
        }
        meso_fixture_place(&scene.mesh, &tip, from, along);
        meso_fixture_place(&scene.mesh, &end, to, heading);
        CHECK(meso_fixture_apart(from, to) < 0.02 && meso_fixture_apart(along, heading) < 0.05);
    }
    meso_walk_scene_release(&scene);
}

/* Vertices in the same place, on lines, or far apart: no tip, or one that can be walked with. */
static void test_broken(uint32_t count)
{
    MesoTriangulation mesh = meso_fixture_torus(4, 3, 0.4f);
    MesoRandom random;
    uint32_t tips = 0, none = 0;
    meso_random_init(&random, 4, 0);
    for (uint32_t i = 0; i < count; i++) {
        MesoWalkScene scene = {.mesh = mesh};
        meso_arena_init(&scene.arena);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (uint32_t k = 0; k < 3; k++) {
                float x = meso_fixture_signed(&random);
                const float values[3] = {roundf(x), k ? 0 : roundf(2 * x), x * powf(10, 30 * x)};
                (&mesh.positions[v].x)[k] = values[i % 3];
            }
        CHECK(meso_walk_ground_build(&scene.ground, &scene.arena, &mesh, NULL, 1, NULL) == MESO_OK);
        for (uint32_t c = 0; c < 3 * mesh.triangle_count; c += 7) {
            MesoTip tip;
            if (!meso_vertex_tip(&scene.ground, c, 9 * meso_fixture_signed(&random), &tip)) {
                none++;
                continue;
            }
            MesoWalkOptions options = {.crossing_limit = 1000};
            CHECK(mesh.corners[corner_of(&tip)] == mesh.corners[c]);
            meso_fixture_walk(&scene.ground, tip, 1, &options);
            tips++;
            meso_tip_pass_vertex(&scene.ground, &tip, corner_of(&tip) % 3);
            meso_fixture_walk(&scene.ground, tip, 1, &options);
        }
        meso_arena_release(&scene.arena);
    }
    CHECK(tips > count && none > 0);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    test_pyramids();
    test_sheet();
    check_corners(meso_fixture_bumpy_torus(40, 16));
    check_corners(meso_fixture_moebius());
    check_corners(meso_fixture_sheet(5, 5, 1));
    check_defects(meso_fixture_bumpy_torus(60, 24), 0);
    check_defects(meso_fixture_ball(12), 2);
    test_octant();
    test_broken(1000);
    return 0;
}
