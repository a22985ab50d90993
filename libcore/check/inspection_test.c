/* Faults that are planted are found, where they are, and nothing else is. */
#include "libcore/base/random.h"
#include "libcore/check/inspect_work.h"
#include "libcore/check/linked_rings_fixture.h"

#define NEAR(a, b, by) CHECK(fabs((double)(a) - (double)(b)) <= (by))

static MesoArena arena;

static MesoInspection inspect_with(const Model *m, uint32_t threads, double thinnest)
{
    MesoInspection found;
    MesoInspectedMesh mesh = model_mesh(m);
    const MesoInspectionOptions options = {.thread_count = threads, .crossings = true, .thickness = true,
                                           .thinnest = thinnest};
    CHECK(meso_inspect(&found, &arena, &mesh, &options, NULL) == MESO_OK);
    return found;
}

static bool same(const MesoInspection *a, const MesoInspection *b, uint32_t triangles)
{
    return memcmp(a->findings, b->findings, sizeof a->findings) == 0 && a->pair_count == b->pair_count &&
           memcmp(a->marks, b->marks, triangles * sizeof *a->marks) == 0 && a->thinnest == b->thinnest &&
           memcmp(a->pairs, b->pairs, a->pair_count * sizeof *a->pairs) == 0;
}

/* ---- the faults ---- */

static void move_ring(Model *m)
{
    for (uint32_t k = 0; k < AROUND; k++)
        m->positions[sweep_vertex(0, 3, ALONG - 1, k)].z += 0.05f;
}

/* One vertex of a ring alone: the rings open there for two edges. */
static void move_vertex(Model *m)
{
    m->positions[sweep_vertex(0, 3, ALONG - 1, 4)].z += 0.03f;
}

static void flip_face(Model *m)
{
    uint32_t *corners = &m->corners[3 * sweep_triangle(0, 2, 3, 5)], swapped = corners[1];
    corners[1] = corners[2];
    corners[2] = swapped;
}

static void lose_position(Model *m)
{
    m->positions[sweep_vertex(0, 2, 3, 5)].y = NAN;
}

static void lose_normal(Model *m)
{
    m->normals[sweep_vertex(0, 2, 3, 5)].y = INFINITY;
}

static void double_face(Model *m)
{
    const uint32_t *corners = &m->corners[3 * sweep_triangle(1, 2, 3, 5)];
    model_triangle(m, corners[1], corners[2], corners[0], 2, 1);
}

static void double_face_backwards(Model *m)
{
    const uint32_t *corners = &m->corners[3 * sweep_triangle(1, 2, 3, 5)];
    model_triangle(m, corners[2], corners[1], corners[0], 2, 1);
}

static MesoVec3 middle(MesoVec3 a, MesoVec3 b)
{
    return (MesoVec3){(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
}

/* Cuts the triangle across the side from its corner k on; gives the new vertex. */
static uint32_t split_side(Model *m, uint32_t triangle, uint32_t k)
{
    uint32_t *corners = &m->corners[3 * triangle];
    uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
    uint32_t v = model_vertex(m, middle(m->positions[a], m->positions[b]), m->normals[a]);
    corners[(k + 1) % 3] = v;
    model_triangle(m, v, b, c, m->slots[triangle], m->things[triangle]);
    return v;
}

/* On the last ring of a slot, where the next one has no such vertex: side d c of the quad's first triangle. */
static void t_joint_between(Model *m)
{
    split_side(m, sweep_triangle(0, 3, ALONG - 2, 1), 1);
}

static void t_joint_within(Model *m)
{
    split_side(m, sweep_triangle(0, 3, 2, 1), 1);
}

static void flat_face(Model *m)
{
    uint32_t t = sweep_triangle(0, 3, 2, 1), a = m->corners[3 * t + 1], b = m->corners[3 * t + 2];
    uint32_t v = split_side(m, t, 1);
    model_triangle(m, a, b, v, 3, 0);
}

static void collapsed_face(Model *m)
{
    uint32_t a = sweep_vertex(0, 3, 2, 1), b = sweep_vertex(0, 3, 2, 2);
    model_triangle(m, a, b, b, 3, 0);
}

static void drop_triangle(Model *m, uint32_t t)
{
    uint32_t last = --m->triangle_count;
    memcpy(&m->corners[3 * t], &m->corners[3 * last], 3 * sizeof *m->corners);
    m->slots[t] = m->slots[last];
    m->things[t] = m->things[last];
}

static void lose_face(Model *m)
{
    drop_triangle(m, sweep_triangle(0, 2, 3, 5));
}

/* One end of a sweep taken back by a row of quads. */
static void open_end(Model *m)
{
    for (uint32_t k = 2 * AROUND; k-- > 0;)
        drop_triangle(m, sweep_triangle(0, 3, ALONG - 2, 0) + k);
}

/* The same, where nothing is beyond the side between both slots: one of the rings lies there. */
static void end_at_border(Model *m)
{
    open_end(m);
    m->across[4 * 3 + 2] = m->across[4 * 4] = MESO_NO_INDEX;
}

/* The same where the tube folds back on one side in its last row: there it comes to the rim from beyond. */
static void fold_back_at_border(Model *m)
{
    end_at_border(m);
    MesoVec3 across = meso_vec3_sub(m->positions[sweep_vertex(0, 4, 0, 0)],
                                    m->positions[sweep_vertex(0, 4, 0, AROUND / 2)]);
    for (uint32_t k = 3; k <= 9; k++) {
        MesoVec3 rim = m->positions[sweep_vertex(0, 4, 0, k)], *p = &m->positions[sweep_vertex(0, 4, 1, k)];
        *p = meso_vec3_mad(meso_vec3_lerp(*p, rim, 1.4f), 0.4f, across);
    }
}

/* An open cup whose rim is at the lid of a slot. */
static void end_at_lid(Model *m)
{
    put_tetrahedron(m, (MesoVec3){1.9f, 1.9f, 0.25f}, 0.25f, 0, 7);
    m->triangle_count--;
}

/* A vertex on the inner side of a sweep, taken over the next one. */
static void fold_back(Model *m)
{
    const MesoVec3 *next = &m->positions[sweep_vertex(0, 2, 4, AROUND / 2)];
    MesoVec3 *p = &m->positions[sweep_vertex(0, 2, 3, AROUND / 2)];
    *p = meso_vec3_lerp(*p, *next, 1.5f);
}

static void shift_ring(Model *m, uint32_t ring, float x, float y, float z)
{
    for (uint32_t v = ring * SLOTS * SWEEP_VERTICES; v < (ring + 1) * SLOTS * SWEEP_VERTICES; v++)
        m->positions[v] = meso_vec3_add(m->positions[v], (MesoVec3){x, y, z});
}

/* So far that the first one's inner edge is 0.2 deep in it. */
static void cross(Model *m)
{
    shift_ring(m, 1, (float)(BIG_RADIUS - 2 * SMALL_RADIUS) + 0.2f, 0, 0);
}

static void cross_itself(Model *m)
{
    cross(m);
    memset(m->things, 0, sizeof m->things);
}

/* Linked no more. */
static void float_away(Model *m)
{
    shift_ring(m, 1, 7, 0, 0);
}

static void float_small(Model *m)
{
    put_tetrahedron(m, (MesoVec3){0, 0, 9}, 0.3f, 100, 7);
}

static void pinch_section(Model *m)
{
    double u = 2 * MESO_PI * (2 * (ALONG - 1) + 3) / (SLOTS * (ALONG - 1));
    MesoVec3 at = {(float)(BIG_RADIUS * cos(u)), (float)(BIG_RADIUS * sin(u)), 0};
    for (uint32_t k = 0; k < AROUND; k++) {
        MesoVec3 *p = &m->positions[sweep_vertex(0, 2, 3, k)];
        *p = meso_vec3_lerp(at, *p, 0.05f);
    }
}

static void turn_normal(Model *m)
{
    MesoVec3 *normal = &m->normals[sweep_vertex(0, 2, 3, 5)];
    *normal = meso_vec3_scale(*normal, -1);
}

/* Of a whole triangle, corners of its own. */
static void turn_normals(Model *m)
{
    uint32_t t = sweep_triangle(0, 2, 3, 5);
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t v = m->corners[3 * t + k];
        m->corners[3 * t + k] = model_vertex(m, m->positions[v], meso_vec3_scale(m->normals[v], -1));
    }
}

/* Of a whole triangle, with those of its neighbours at its corners. */
static void turn_shared_normals(Model *m)
{
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 *normal = &m->normals[m->corners[3 * sweep_triangle(0, 2, 3, 5) + k]];
        *normal = meso_vec3_scale(*normal, -1);
    }
}

static void vanish_normal(Model *m)
{
    m->normals[sweep_vertex(0, 2, 3, 5)] = (MesoVec3){0, 0, 0};
}

/* By 5 degrees about z, where the normals of the ring that are along z stay. */
static void bend_joint(Model *m)
{
    double c = cos(5 * MESO_PI / 180), s = sin(5 * MESO_PI / 180);
    for (uint32_t k = 0; k < AROUND; k++) {
        MesoVec3 *n = &m->normals[sweep_vertex(0, 3, ALONG - 1, k)], old = *n;
        n->x = (float)(c * (double)old.x - s * (double)old.y);
        n->y = (float)(s * (double)old.x + c * (double)old.y);
    }
}

static void fold_slot(Model *m)
{
    MesoVec3 floor = m->cages[8 * 5];
    m->cages[8 * 5 + 4] = (MesoVec3){floor.x, floor.y, floor.z - 0.2f};
}

/* A fin on an edge that has its two triangles. */
static void third_face(Model *m)
{
    uint32_t a = sweep_vertex(0, 2, 3, 0), b = sweep_vertex(0, 2, 4, 0);
    MesoVec3 n = m->normals[a], side = {-n.y, n.x, 0};
    uint32_t v = model_vertex(m, meso_vec3_mad(m->positions[a], 0.3f, n), side);
    uint32_t w = model_vertex(m, m->positions[a], (MesoVec3){0, 0, 1});
    uint32_t x = model_vertex(m, m->positions[b], (MesoVec3){0, 0, 1});
    m->normals[v] = (MesoVec3){0, 0, 1};
    model_triangle(m, v, x, w, 2, 0);
}

/* A second sweep of a slot that begins where the first does, and ends apart. */
static void share_section(Model *m)
{
    uint32_t first = m->vertex_count;
    for (uint32_t v = 0; v < 2 * AROUND; v++) {
        uint32_t from = sweep_vertex(0, 2, v / AROUND, v % AROUND);
        model_vertex(m, m->positions[from], m->normals[from]);
    }
    for (uint32_t k = 0; k < AROUND; k++) {
        uint32_t a = first + k, b = first + (k + 1) % AROUND;
        m->positions[a + AROUND].z += 0.05f;
        model_triangle(m, a, a + AROUND, b + AROUND, 2, 0);
        model_triangle(m, a, b + AROUND, b, 2, 0);
    }
}

/* Something that stands on a vertex with its tip. */
static void touching_fans(Model *m)
{
    put_tetrahedron(m, m->positions[sweep_vertex(0, 2, 3, 3)], 0.3f, 2, 0);
}

static void turn_inside_out(Model *m)
{
    for (uint32_t t = SLOTS * SWEEP_TRIANGLES; t < m->triangle_count; t++) {
        uint32_t swapped = m->corners[3 * t];
        m->corners[3 * t] = m->corners[3 * t + 1];
        m->corners[3 * t + 1] = swapped;
    }
    for (uint32_t v = SLOTS * SWEEP_VERTICES; v < m->vertex_count; v++)
        m->normals[v] = meso_vec3_scale(m->normals[v], -1);
}

static void wind_sweep_back(Model *m)
{
    for (uint32_t t = sweep_triangle(1, 2, 0, 0); t < sweep_triangle(1, 3, 0, 0); t++) {
        uint32_t swapped = m->corners[3 * t];
        m->corners[3 * t] = m->corners[3 * t + 1];
        m->corners[3 * t + 1] = swapped;
    }
}

/* Nothing is wrong with these. */
static void no_fault(Model *m)
{
    (void)m;
}

static void huge_ids(Model *m)
{
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        m->slots[t] = UINT32_MAX - 1 - m->slots[t];
        m->things[t] = UINT32_MAX - 1 - 1000 * m->things[t];
    }
}

static void mirrored_cages(Model *m)
{
    for (uint32_t i = 0; i < 8 * m->cage_count; i++)
        m->cages[i].z = -m->cages[i].z;
}

/* One stands with its tip on the lid of another. */
static void touching_things(Model *m)
{
    put_tetrahedron(m, (MesoVec3){-1, -1, 0}, 0.25f, 100, 7);
    put_tetrahedron(m, (MesoVec3){-1, -1, 0.25f}, 0.25f, 101, 8);
}

typedef struct Expected {
    MesoFault fault;
    uint64_t count;         /* 0 ends a list */
} Expected;

static const struct {
    const char *name;
    void (*plant)(Model *m);
    Expected found[7];
    MesoFault sized;            /* of which the size is known */
    double size, by;
} CASES[] = {
    {"nothing", no_fault, {{0, 0}}, 0, 0, 0},
    {"huge ids", huge_ids, {{0, 0}}, 0, 0, 0},
    {"mirrored cages", mirrored_cages, {{0, 0}}, 0, 0, 0},
    {"touching things", touching_things, {{0, 0}}, 0, 0, 0},
    {"moved ring", move_ring, {{MESO_FAULT_GAP, 2}, {MESO_FAULT_OPEN, 2}, {MESO_FAULT_LEAK, 1}},
     MESO_FAULT_GAP, 0.05, 1e-6},
    {"moved vertex", move_vertex, {{MESO_FAULT_GAP, 2}, {MESO_FAULT_OPEN, 2}, {MESO_FAULT_LEAK, 1}},
     MESO_FAULT_GAP, 0.03, 2e-3},
    {"flipped face", flip_face, {{MESO_FAULT_WINDING, 3}, {MESO_FAULT_INVERTED, 1}}, 0, 0, 0},
    {"NaN", lose_position, {{MESO_FAULT_NUMBER, 6}}, 0, 0, 0},
    {"infinite normal", lose_normal, {{MESO_FAULT_NUMBER, 6}}, 0, 0, 0},
    {"doubled face", double_face, {{MESO_FAULT_DOUBLE, 1}}, 0, 0, 0},
    {"face doubled backwards", double_face_backwards, {{MESO_FAULT_DOUBLE, 1}}, 0, 0, 0},
    {"T-joint between slots", t_joint_between,
     {{MESO_FAULT_T_JOINT, 1}, {MESO_FAULT_GAP, 2}, {MESO_FAULT_OPEN, 2}, {MESO_FAULT_LEAK, 1}},
     MESO_FAULT_GAP, 0, 1e-6},
    {"T-joint within a slot", t_joint_within, {{MESO_FAULT_T_JOINT, 1}, {MESO_FAULT_OPEN, 1}, {MESO_FAULT_LEAK, 1}},
     0, 0, 0},
    {"flat face", flat_face, {{MESO_FAULT_FLAT, 1}}, 0, 0, 0},
    {"collapsed face", collapsed_face, {{MESO_FAULT_FLAT, 1}}, 0, 0, 0},
    {"lost face", lose_face, {{MESO_FAULT_OPEN, 1}, {MESO_FAULT_LEAK, 1}}, 0, 0, 0},
    {"open end", open_end, {{MESO_FAULT_GAP, 2}, {MESO_FAULT_OPEN, 2}, {MESO_FAULT_LEAK, 1}},
     MESO_FAULT_GAP, 0.3, 0.05},
    {"end at a border", end_at_border, {{MESO_FAULT_OPEN, 2}, {MESO_FAULT_BORDER, 1}, {MESO_FAULT_LEAK, 1}}, 0, 0, 0},
    {"end at a border that folds back", fold_back_at_border,
     {{MESO_FAULT_OPEN, 2}, {MESO_FAULT_BORDER, 1}, {MESO_FAULT_LEAK, 1}, {MESO_FAULT_PINCH, UINT64_MAX},
      {MESO_FAULT_SELF_CROSSING, UINT64_MAX}, {MESO_FAULT_THIN, UINT64_MAX}}, 0, 0, 0},
    {"end at a lid", end_at_lid, {{MESO_FAULT_OPEN, 1}, {MESO_FAULT_LID, 1}, {MESO_FAULT_LEAK, 1}}, 0, 0, 0},
    {"surface that folds back", fold_back, {{MESO_FAULT_PINCH, 2}, {MESO_FAULT_SELF_CROSSING, UINT64_MAX}}, 0, 0, 0},
    {"turned normals of a triangle", turn_normals, {{MESO_FAULT_INVERTED, 1}}, 0, 0, 0},
    {"turned normals of a triangle and beside it", turn_shared_normals,
     {{MESO_FAULT_INVERTED, 1}, {MESO_FAULT_NORMAL, 15}}, 0, 0, 0},
    {"crossing", cross, {{MESO_FAULT_CROSSING, 1}}, MESO_FAULT_CROSSING, 0.2, 0.03},
    {"crossing itself", cross_itself, {{MESO_FAULT_SELF_CROSSING, UINT64_MAX}}, MESO_FAULT_SELF_CROSSING, 0.2, 0.03},
    {"floating ring", float_away, {{MESO_FAULT_FLOATING, 1}}, 0, 0, 0},
    {"floating crumb", float_small, {{MESO_FAULT_FLOATING, 1}}, 0, 0, 0},
    {"thin section", pinch_section, {{MESO_FAULT_THIN, UINT64_MAX}}, MESO_FAULT_THIN, 0.04, 2e-3},
    {"turned normal", turn_normal, {{MESO_FAULT_NORMAL, 6}}, 0, 0, 0},
    {"vanished normal", vanish_normal, {{MESO_FAULT_NORMAL, 6}}, 0, 0, 0},
    {"bent joint", bend_joint, {{MESO_FAULT_ANGLE, AROUND}}, MESO_FAULT_ANGLE, 5, 1e-4},
    {"folded slot", fold_slot, {{MESO_FAULT_FOLD, 1}}, 0, 0, 0},
    {"third face on an edge", third_face, {{MESO_FAULT_EDGE, 1}, {MESO_FAULT_OPEN, 1}, {MESO_FAULT_LEAK, 1}}, 0, 0, 0},
    {"shared section", share_section,
     {{MESO_FAULT_BRANCH, AROUND}, {MESO_FAULT_OPEN, 1}, {MESO_FAULT_LEAK, 1}, {MESO_FAULT_SELF_CROSSING, UINT64_MAX}},
     0, 0, 0},
    {"touching fans", touching_fans, {{MESO_FAULT_VERTEX, 1}}, 0, 0, 0},
    {"inside out", turn_inside_out, {{MESO_FAULT_INSIDE_OUT, 1}}, 0, 0, 0},
    {"sweep wound back", wind_sweep_back, {{MESO_FAULT_WINDING, 2 * AROUND}, {MESO_FAULT_INVERTED, SWEEP_TRIANGLES}},
     0, 0, 0},
};

static uint64_t expected_count(const Expected *expected, MesoFault fault)
{
    for (; expected->count; expected++)
        if (expected->fault == fault)
            return expected->count;
    return 0;
}

static bool all_good = true;

static void check_case(size_t i)
{
    static Model m;
    bool good = true;
    model_make(&m);
    CASES[i].plant(&m);
    MesoInspection found = inspect_with(&m, 1, 0.1);
    for (uint32_t f = 0; f < MESO_FAULT_COUNT; f++) {
        uint64_t wanted = expected_count(CASES[i].found, (MesoFault)f), count = found.findings[f].count;
        if (wanted == UINT64_MAX ? count > 0 : count == wanted)
            continue;
        fprintf(stderr, "%s: %llu of '%s', not %llu\n", CASES[i].name, (unsigned long long)count, MESO_FAULT_NAMES[f],
                (unsigned long long)wanted);
        good = false;
    }
    double size = found.findings[CASES[i].sized].worst;
    if (CASES[i].by > 0 && !(fabs(size - CASES[i].size) <= CASES[i].by)) {
        fprintf(stderr, "%s: %s of %g, not %g\n", CASES[i].name, MESO_FAULT_NAMES[CASES[i].sized], size, CASES[i].size);
        good = false;
    }
    all_good = all_good && good;
    MesoInspection again = inspect_with(&m, 2, 0.1);
    CHECK(same(&found, &again, m.triangle_count));
    again = inspect_with(&m, 7, 0.1);
    CHECK(same(&found, &again, m.triangle_count));
}

static void planted_faults_are_found_and_nothing_else(void)
{
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        check_case(i);
    CHECK(all_good);
}

/* ---- sizes, against formulas ---- */

static void sizes_are_those_of_tori(void)
{
    static Model m;
    model_make(&m);
    MesoInspection found = inspect_with(&m, 1, 0);
    double around = AROUND * SMALL_RADIUS * SMALL_RADIUS * sin(2 * MESO_PI / AROUND) / 2;
    NEAR(found.volume, 2 * 2 * MESO_PI * BIG_RADIUS * around, 0.02 * found.volume);
    NEAR(found.usual_thickness, 2 * SMALL_RADIUS, 0.1);
    NEAR(found.thinnest, 2 * SMALL_RADIUS, 0.1);
    CHECK(found.piece_count == 2 && found.thing_count == 2 && found.closed_count == 2);
    CHECK(found.slot_joints == 2 * SLOTS * AROUND);
    CHECK(found.vertex_count == 2 * SLOTS * (ALONG - 1) * AROUND);
    NEAR(found.box.low.x, -2.4, 1e-6);
}

/* A box as 12 triangles; its walls are as thick as it is wide. */
static void put_box(Model *m, MesoVec3 low, MesoVec3 high, uint32_t thing)
{
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2},
                                          {1, 3, 7, 5}};
    uint32_t first = m->vertex_count;
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 p = {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
        MesoVec3 n = {i & 1 ? 0.577f : -0.577f, i & 2 ? 0.577f : -0.577f, i & 4 ? 0.577f : -0.577f};
        model_vertex(m, p, n);
    }
    for (uint32_t q = 0; q < 6; q++) {
        model_triangle(m, first + quads[q][0], first + quads[q][1], first + quads[q][2], thing, thing);
        model_triangle(m, first + quads[q][0], first + quads[q][2], first + quads[q][3], thing, thing);
    }
}

/* Sticks of two triangles a side, of which no vertex is in the other. */
static void long_triangles_have_depths(void)
{
    static Model m;
    memset(&m, 0, sizeof m);
    put_box(&m, (MesoVec3){-5, -0.5f, -0.5f}, (MesoVec3){5, 0.5f, 0.5f}, 0);
    put_box(&m, (MesoVec3){-0.2f, -4, 0.2f}, (MesoVec3){0.3f, 4, 0.9f}, 1);
    MesoInspection found = inspect_with(&m, 1, 0);
    CHECK(found.pair_count == 1 && found.pairs[0].a == 0 && found.pairs[0].b == 1);
    CHECK(found.pairs[0].depth > 0.1 && found.pairs[0].depth < 0.5);
    CHECK(found.findings[MESO_FAULT_SELF_CROSSING].count == 0);
    NEAR(found.volume, 10 + 0.5 * 8 * 0.7, 1e-5);
}

static void boxes_that_share_a_wall_only_touch(void)
{
    static Model m;
    memset(&m, 0, sizeof m);
    put_box(&m, (MesoVec3){0, 0, 0}, (MesoVec3){1, 1, 1}, 0);
    put_box(&m, (MesoVec3){1, 0.25f, 0.25f}, (MesoVec3){2, 0.75f, 0.75f}, 1);
    MesoInspection found = inspect_with(&m, 1, 0);
    CHECK(found.pair_count == 0 && found.findings[MESO_FAULT_FLOATING].count == 0);
}

/* ---- the tree against all pairs ---- */

static float random_unit(MesoRandom *random)
{
    return (float)meso_random_below(random, 1 << 20) / (1 << 20);
}

static uint64_t count_all_pairs(const MesoInspectedMesh *mesh, double rounding)
{
    uint64_t count = 0;
    for (uint32_t s = 0; s < mesh->triangle_count; s++)
        for (uint32_t t = 0; t < s; t++) {
            MesoInspectTriangle a = meso_inspect_triangle(mesh, s), b = meso_inspect_triangle(mesh, t);
            MesoInspectHole hole;
            bool crosses = false;
            for (uint32_t k = 0; k < 3; k++)
                crosses = crosses || meso_inspect_pierces(&a, b.p[k], b.p[(k + 1) % 3], rounding, &hole) ||
                          meso_inspect_pierces(&b, a.p[k], a.p[(k + 1) % 3], rounding, &hole);
            count += crosses;
        }
    return count;
}

static void trees_find_what_all_pairs_do(void)
{
    static Model m;
    MesoRandom random;
    memset(&m, 0, sizeof m);
    meso_random_init(&random, 5, 0);
    for (uint32_t t = 0; t < 600; t++) {
        MesoVec3 p = {random_unit(&random), random_unit(&random), random_unit(&random)};
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3 by = {random_unit(&random), random_unit(&random), random_unit(&random)};
            model_vertex(&m, meso_vec3_mad(p, 0.2f, by), (MesoVec3){0, 0, 1});
        }
        model_triangle(&m, 3 * t, 3 * t + 1, 3 * t + 2, 0, 0);
    }
    MesoInspection found = inspect_with(&m, 2, 0);
    MesoInspectedMesh mesh = model_mesh(&m);
    uint64_t pairs = count_all_pairs(&mesh, 1.2e-7 * 1.2);
    CHECK(pairs > 100 && found.findings[MESO_FAULT_SELF_CROSSING].count == pairs);
    CHECK(found.findings[MESO_FAULT_OPEN].count == 600 && found.open_edges == 1800);
}

/* Each of many triangles of its own at one edge ends a part of its slot there; of two that share vertices one does not. */
static void many_parts_meet_at_an_edge(void)
{
    static Model m;
    for (uint32_t shared = 0; shared < 2; shared++) {
        memset(&m, 0, sizeof m);
        for (uint32_t t = 0; t < 40; t++) {
            float angle = (float)t * 0.15f;
            model_vertex(&m, (MesoVec3){0, 0, 0}, (MesoVec3){0, 0, 1});
            model_vertex(&m, (MesoVec3){0, 0, 1}, (MesoVec3){0, 0, 1});
            model_vertex(&m, (MesoVec3){cosf(angle), sinf(angle), 0.5f}, (MesoVec3){0, 0, 1});
            uint32_t first = 3 * t, start = shared && t == 39 ? 0 : first;
            model_triangle(&m, start, first + 1, first + 2, 0, 0);
        }
        MesoInspection found = inspect_with(&m, 1, 0);
        CHECK(found.findings[MESO_FAULT_BRANCH].count == !shared && found.findings[MESO_FAULT_EDGE].count == shared);
    }
}

static void nothing_is_no_trouble(void)
{
    static Model m;
    memset(&m, 0, sizeof m);
    MesoInspection found = inspect_with(&m, 1, 0);
    for (uint32_t f = 0; f < MESO_FAULT_COUNT; f++)
        CHECK(found.findings[f].count == 0);
    model_vertex(&m, (MesoVec3){NAN, 0, 0}, (MesoVec3){0, 0, 1});
    model_triangle(&m, 0, 0, 0, 0, 0);
    found = inspect_with(&m, 1, 0);
    CHECK(found.findings[MESO_FAULT_NUMBER].count == 1 && found.findings[MESO_FAULT_FLAT].count == 1);
}

int main(void)
{
    meso_arena_init(&arena);
    planted_faults_are_found_and_nothing_else();
    sizes_are_those_of_tori();
    long_triangles_have_depths();
    boxes_that_share_a_wall_only_touch();
    trees_find_what_all_pairs_do();
    many_parts_meet_at_an_edge();
    nothing_is_no_trouble();
    meso_arena_release(&arena);
    return 0;
}
