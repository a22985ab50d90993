/*
 * Relaxation on small surfaces: what is straight stays, zigzags straighten, strands part in order, hollow ones as they
 * are meant to, planes at their ends do not cross, joints are whole.
 */
#include "libcore/tiling/relax/relax.h"

#include <math.h>

#include "libcore/tiling/relax/relax_work.h"
#include "libcore/tiling/strand/expansion_fixture.h"

/* ---- grids of one tile: a strand each way, the one along x lower by `rise` halves of the wall ---- */

typedef struct Weave {
    MesoCsgNode csg[4];
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

/*
 * The one along x is hollow, a tenth wider than its hole. Where it only grazes the other one as drawn, it gets out of
 * it; where it lies deep in it, it is meant to, and stays.
 */
static void test_hollow(MesoArena *arena)
{
    static const float widths[2] = {0.2f, 0.3f}, rises[2] = {0.22f, 0.05f};
    for (uint32_t i = 0; i < 2; i++) {
        Weave w;
        make_weave(&w, widths[i], rises[i], 2);
        w.csg[2] = w.csg[3] = w.csg[1];
        w.csg[2].size = (MesoVec2){0.2f, 0.2f};
        w.csg[1].size = (MesoVec2){0.3f, 0.3f};
        w.csg[3] = (MesoCsgNode){MESO_CSG_DIFFERENCE, 1, 2, {0, 0}, {0, 0}, 0};
        w.sections[1].csg_root = 3;
        w.model.tile_set.csg_count = 4;
        lay(&w, arena, 5, 0);
        MesoRelaxReport report = relax(&w.model, arena, 40, 1);
        CHECK(report.intersections[0] == (i == 0 ? 25 : 0) && report.intersections[1] == 0);
        CHECK((report.move_most > 0.01f) == (i == 0));
    }
}

/* How well the planes at the ends of a link lie behind each other, as relax_bends.c has it. */
static float order_of(const MesoRelaxWork *work, const MesoRelaxLink *link)
{
    const MesoRelaxNode *start = &work->nodes[link->node[0]], *end = &work->nodes[link->node[1]];
    MesoVec3 from = meso_vec3_scale(start->tangent, link->sign[0]), to = meso_vec3_scale(end->tangent, -link->sign[1]);
    return meso_vec3_dot(meso_vec3_sub(end->point, start->point), meso_vec3_add(from, to)) / link->bound -
           2 * meso_vec3_length(meso_vec3_cross(from, to));
}

static float least_order(const MesoRelaxWork *work, uint32_t n)
{
    float least = INFINITY;
    for (uint32_t i = work->end_begin[n]; i < work->end_begin[n + 1]; i++)
        least = fminf(least, order_of(work, &work->links[work->ends[i] / 2]));
    return least;
}

static float random_in(uint32_t *state, float most)
{
    *state = *state * 1664525 + 1013904223;
    return most * ((float)(*state >> 8) / (1 << 23) - 1);
}

/* Pushes and turns the end of a link by any vector. */
static void ask(MesoRelaxLink *link, uint32_t end, uint32_t *state)
{
    for (uint32_t k = 0; k < 2; k++) {
        float most = k ? 1 : 0.3f;
        MesoVec3 asked = {random_in(state, most), random_in(state, most), random_in(state, most)};
        (k ? link->turn : link->push)[end] = asked;
        (k ? link->turn_weight : link->push_weight)[end] = 1;
    }
}

/* Whatever contacts ask of a joint of elbows as wide as their slots: planes at their ends do not come to cross. */
static void test_order(MesoArena *arena)
{
    Weave w;
    uint32_t state = 1, moved = 0;
    make_weave(&w, 1, 0, 2);
    w.sections[1].csg_root = 0;
    w.sweeps[0] = (MesoSweep){.from_side = 3, .to_side = 0, .from_section = 1, .to_section = 0};
    w.sweeps[1] = (MesoSweep){.from_side = 2, .to_side = 1, .from_section = 0, .to_section = 1};
    lay(&w, arena, 5, 0.6f);
    MesoRelaxWork work = {.model = &w.model, .options = meso_map_options_resolve(w.model.options, 1)};
    CHECK(meso_relax_build(&work, arena, NULL) == MESO_OK);
    for (uint32_t i = 0; i < work.link_count; i++) {
        meso_relax_trace(&work.links[i], work.nodes);
        work.links[i].room = work.links[i].clear = 10;
    }
    meso_relax_bound_bends(&work, 0, work.joint_count);
    for (uint32_t trial = 0; trial < 4000; trial++) {
        uint32_t n = trial % work.joint_count, end = work.ends[work.end_begin[n]];
        MesoRelaxLink before = work.links[end / 2];
        MesoRelaxNode node = work.nodes[n];
        float least = fminf(least_order(&work, n), 0.25f);
        if (!node.free)
            continue;
        ask(&work.links[end / 2], end % 2, &state);
        meso_relax_part(&work, n, n + 1);
        moved += memcmp(&work.next[n], &node.move, sizeof node.move) != 0;
        work.nodes[n].move = work.next[n];
        meso_relax_place(&work.nodes[n]);
        CHECK(least_order(&work, n) > least - 1e-4f);
        work.nodes[n] = node;
        work.links[end / 2] = before;
    }
    CHECK(moved > 500);
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
    test_hollow(&arena);
    test_order(&arena);
    test_joints(&arena);
    test_threads(&arena);
    meso_arena_release(&arena);
    return 0;
}
