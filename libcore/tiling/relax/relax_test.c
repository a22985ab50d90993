/* Relaxation on small surfaces: what is straight stays, zigzags straighten, strands part in order, joints are whole. */
#include "libcore/tiling/relax/relax.h"

#include <math.h>

#include "libcore/tiling/relax/relax_work.h"
#include "libcore/tiling/strand/expansion_fixture.h"

/* ---- grids of one tile: a strand each way, the one along x lower by `rise` halves of the wall ---- */

typedef struct Weave {
    MesoCsgNode csg[2];
    MesoSection sections[2];
    MesoInterface interfaces[2];
    MesoSweep sweeps[2];
    MesoTile tiles[1];
    MesoModel model;
} Weave;

static void make_weave(Weave *w, float width, float rise, uint32_t sweep_count)
{
    *w = (Weave){0};
    w->csg[0] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.5f, 0.5f - rise}, {width, width}, 0};
    w->csg[1] = (MesoCsgNode){MESO_CSG_DISC, 0, 0, {0.5f, 0.5f + rise}, {width, width}, 0};
    w->sections[0] = (MesoSection){"1", 0, 0, GREY};
    w->sections[1] = (MesoSection){"1", 1, 1, GREY};
    w->interfaces[0] = (MesoInterface){"a", 0, 1, {0, 0, 0}, false, false};
    w->interfaces[1] = (MesoInterface){"b", 1, 1, {0, 0, 0}, false, false};
    w->sweeps[0] = (MesoSweep){.from_side = 3, .to_side = 1, .from_section = 1, .to_section = 1};
    w->sweeps[1] = (MesoSweep){.from_side = 0, .to_side = 2};
    w->tiles[0] = (MesoTile){.name = "t", .side_count = 4, .labels = {1, 2, -1, -2}, .sweep_count = sweep_count};
    w->model.tile_set = (MesoTileSet){.interface_count = 2, .section_count = 2, .csg_count = 2, .tile_count = 1,
                                      .sweep_count = sweep_count, .interfaces = w->interfaces,
                                      .sections = w->sections, .csg = w->csg, .tiles = w->tiles, .sweeps = w->sweeps};
}

/* An n x n grid on the plane, every other row of vertices shifted; side 0 of each face looks to +x. */
static void lay(Weave *w, MesoArena *arena, uint32_t n, float shift)
{
    uint32_t row = n + 1, count = n * n;
    MesoVec3 *positions = MESO_NEW(arena, MesoVec3, row * row, NULL);
    uint32_t *corners = MESO_NEW(arena, uint32_t, 4 * count, NULL);
    CHECK(positions && corners);
    for (uint32_t i = 0; i < row * row; i++)
        positions[i] = (MesoVec3){(float)(i % row) + (i / row % 2 ? shift : 0), (float)(i / row), 0};
    for (uint32_t f = 0; f < count; f++) {
        uint32_t at = f % n + f / n * row;
        const uint32_t face[4] = {at + 1, at + 1 + row, at + row, at};
        memcpy(corners + 4 * f, face, sizeof face);
    }
    CHECK(meso_quad_mesh_build(&w->model.surface, arena, row * row, positions, 0, NULL, count, corners, NULL, NULL) ==
          MESO_OK);
    CHECK(meso_slot_graph_build(&w->model.graph, arena, &w->model.surface, NULL) == MESO_OK);
    w->model.assignment = (MesoAssignment){count, MESO_NEW(arena, uint32_t, count, NULL),
                                           MESO_NEW(arena, MesoTransform, count, NULL)};
    w->model.options = (MesoMapOptions){.thickness = 1, .section_scale = 1};
}

static MesoRelaxReport relax(MesoModel *model, MesoArena *arena, uint32_t steps, uint32_t threads)
{
    MesoRelaxReport report;
    MesoError error;
    model->options.relax = steps;
    CHECK(meso_model_relax(model, &report, arena, threads, &error) == MESO_OK);
    return report;
}

static void test_straight(MesoArena *arena)
{
    Weave w;
    make_weave(&w, 0.1f, 0.3f, 2);
    lay(&w, arena, 4, 0);
    MesoRelaxReport report = relax(&w.model, arena, 20, 1);
    CHECK(report.joints == 24 && report.move_most == 0 && report.bend_mean[1] < 1e-6f);
    CHECK(report.intersections[0] == 0 && report.intersections[1] == 0);
    for (uint32_t j = 0; j < 40; j++)
        CHECK(w.model.joints[j].along == 0 && w.model.joints[j].rise == 0 && w.model.joints[j].lean_along == 0 &&
              w.model.joints[j].lean_rise == 0);
    relax(&w.model, arena, 0, 1);
    CHECK(!w.model.joints);
}

/* The strands along y: how far joints inside lie from the line in the middle of where the rows are. */
static float off_line(const Weave *w, MesoArena *arena, float middle)
{
    MesoScene scene = expand(&w->model, NULL, arena);
    float most = 0;
    for (uint32_t i = 0; i < scene.sweep_count; i++)
        for (uint32_t e = 0; e < 2; e++) {
            const MesoSweepInstance *s = &scene.sweeps[i];
            MesoVec3 p = s->p[e ? 3 : 0];
            if (s->p[0].x != s->p[1].x || p.y < 2.5f || p.y > 5.5f)     /* the others, or near the fixed ends */
                continue;
            most = fmaxf(most, fabsf(p.x - floorf(p.x) - middle));
        }
    return most;
}

static void test_zigzag(MesoArena *arena)
{
    Weave w;
    float before = INFINITY;
    make_weave(&w, 0.1f, 0, 1);
    lay(&w, arena, 8, 0.3f);
    for (uint32_t steps = 4; steps <= 64; steps *= 2) {
        MesoRelaxReport report = relax(&w.model, arena, steps, 1);
        CHECK(report.bend_mean[1] < 0.8f * report.bend_mean[0] && report.bend_most[1] <= report.bend_most[0]);
        CHECK(report.bend_mean[1] <= before && report.move_most <= MESO_RELAX_REACH + 1e-5f);
        before = report.bend_mean[1];
    }
    w.model.joints = NULL;
    CHECK(off_line(&w, arena, 0.65f) > 0.14f);
    relax(&w.model, arena, 64, 1);
    CHECK(off_line(&w, arena, 0.65f) < 0.03f);
}

/* Elbows that go up a diagonal like stairs: but for those at the border, whose ends stay, they become straight. */
static void test_stairs(MesoArena *arena)
{
    Weave w;
    make_weave(&w, 0.1f, 0, 2);
    w.sections[1].csg_root = 0;
    w.sweeps[0] = (MesoSweep){.from_side = 3, .to_side = 0, .from_section = 1, .to_section = 0};
    w.sweeps[1] = (MesoSweep){.from_side = 2, .to_side = 1, .from_section = 0, .to_section = 1};
    lay(&w, arena, 6, 0);
    MesoRelaxReport report = relax(&w.model, arena, 40, 1);
    CHECK(report.bend_mean[1] < 0.5f * report.bend_mean[0] && report.bend_most[1] <= report.bend_most[0]);
}

/* What crosses is parted, the lower one stays below; what goes through the other's middle is left. */
static void test_crossing(MesoArena *arena)
{
    Weave w;
    make_weave(&w, 0.2f, 0.1f, 2);
    lay(&w, arena, 6, 0);
    MesoRelaxReport report = relax(&w.model, arena, 40, 1);
    CHECK(report.intersections[0] == 36 && report.intersections[1] == 0);
    MesoScene scene = expand(&w.model, NULL, arena);
    float low[36], high[36];
    for (uint32_t i = 0; i < scene.sweep_count; i++) {
        const MesoSweepInstance *s = &scene.sweeps[i];
        float z = (s->p[0].z + 3 * s->p[1].z + 3 * s->p[2].z + s->p[3].z) / 8;
        bool along_x = fabsf(s->p[3].x - s->p[0].x) > 0.5f;
        (along_x ? low : high)[s->ids] = z;
    }
    for (uint32_t slot = 0; slot < 36; slot++)
        CHECK(high[slot] - low[slot] > 0.19f && low[slot] > 0 && high[slot] < 0.5f);

    make_weave(&w, 0.2f, 0, 2);
    lay(&w, arena, 3, 0);
    report = relax(&w.model, arena, 10, 1);
    CHECK(report.intersections[0] == 0 && report.move_most == 0);
}

/* Both slots of an edge end their sweeps on the same floats, in the same or the opposite direction. */
static void test_joints(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[16] = {0}, joined = 0;
    MesoTransform transform[16] = {0};
    make_tile_set(&s);
    make_grid(&s, arena, 4, tile, transform);
    MesoRelaxReport report = relax(&s.model, arena, 12, 2);
    CHECK(report.joints == 24 && report.move_most > 0.01f && report.bend_mean[1] < report.bend_mean[0]);
    MesoScene scene = expand(&s.model, NULL, arena);
    for (uint32_t a = 0; a < 2 * scene.sweep_count; a++)
        for (uint32_t b = 0; b < a; b++) {
            const MesoSweepInstance *one = &scene.sweeps[a / 2], *two = &scene.sweeps[b / 2];
            MesoVec3 p = one->p[a % 2 ? 3 : 0], q = two->p[b % 2 ? 3 : 0], d = one->direction[a % 2];
            MesoVec3 e = two->direction[b % 2], back = meso_vec3_scale(e, -1);
            if (one->ids == two->ids || memcmp(&p, &q, sizeof p) != 0)
                continue;
            CHECK(memcmp(&d, &e, sizeof d) == 0 || memcmp(&d, &back, sizeof d) == 0);
            CHECK(memcmp(&one->up[a % 2], &two->up[b % 2], sizeof p) == 0);
            joined++;
        }
    CHECK(joined >= 24);
}

static void test_threads(MesoArena *arena)
{
    static const uint32_t threads[] = {1, 2, 7};
    MesoJointMove *first = NULL;
    Weave w;
    make_weave(&w, 0.2f, 0.1f, 2);
    lay(&w, arena, 30, 0.2f);
    for (uint32_t i = 0; i < 3; i++) {
        relax(&w.model, arena, 6, threads[i]);
        CHECK(!first || memcmp(first, w.model.joints, 2 * 30 * 31 * sizeof *first) == 0);
        first = w.model.joints;
    }
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_straight(&arena);
    test_zigzag(&arena);
    test_stairs(&arena);
    test_crossing(&arena);
    test_joints(&arena);
    test_threads(&arena);
    meso_arena_release(&arena);
    return 0;
}
