/*
 * Growth by what it promises: joints, threads, ends of rules, edits, limits, conditions, and meshes that are none.
 *
 *   growth_test [MESHES]    so many broken meshes alone
 */
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/engine/growth_work.h"

static const char ivy[] =
    "meso-grow 1\nparam lean = 12 deg\nshape cord = tube\nshape dot = bead\nlimit elements 4000\n"
    "seed Shoot(1 cm) on vertices\n"
    "rule Shoot(w) -> {\n turn(normal(0, lean))\n"
    " step(5 cm, shape: cord, width: w, end: 0.99*w, clear: 2*w) else retry(3, 70 deg)\n"
    " if chance(0.3) { branch { move(1.5*w, 90 deg) Leaf(w) } branch { move(1.5*w, -90 deg) Leaf(w) } }\n"
    " choose { 80%: Shoot(0.99*w) 20%: { branch { turn(normal(70 deg, 8 deg)) Shoot(0.9*w) } Shoot(0.99*w) } } }\n"
    "rule Leaf(w) : clear(3*w) -> { turn(60 deg) place dot(2*w, 10 deg, lift: w, roll: 20 deg) }\n";

static void prepare(MesoGrowthScenery *scenery, MesoTriangulation mesh, const char *text, uint32_t starts)
{
    *scenery = (MesoGrowthScenery){.values = {1, 1, 1, 1}};
    meso_scenery_init(scenery, mesh);
    meso_scenery_read(scenery, text);
    meso_scenery_strew(scenery, starts, 5);
}

static bool are_same(const MesoGrown *a, const MesoGrown *b)
{
    if (a->joint_count != b->joint_count || a->element_count != b->element_count ||
        a->branch_count != b->branch_count || a->end != b->end || a->generation_count != b->generation_count)
        return false;
    for (uint32_t i = 0; i < a->branch_count; i++)
        if (a->branches[i].key != b->branches[i].key || a->branches[i].parent != b->branches[i].parent ||
            a->branches[i].element_begin != b->branches[i].element_begin)
            return false;
    return memcmp(a->joints, b->joints, a->joint_count * sizeof *a->joints) == 0 &&
           memcmp(a->points, b->points, a->joint_count * sizeof *a->points) == 0 &&
           memcmp(a->elements, b->elements, a->element_count * sizeof *a->elements) == 0;
}

/* ---- threads, and the trace ---- */

static void count_event(void *context, const MesoGrowthEvent *event)
{
    uint32_t *counts = context;
    counts[event->command->order] += event->accepted;
}

static void test_threads(void)
{
    static const uint32_t threads[] = {2, 7};
    MesoGrowthScenery scenery;
    prepare(&scenery, meso_fixture_bumpy_torus(60, 30), ivy, 300);
    MesoGrown one = meso_scenery_grow(&scenery, &scenery.arena, 1);
    CHECK(one.element_count <= 4000 && one.element_count > 3990 && one.end == MESO_GROWTH_ELEMENTS);
    CHECK(one.rules[0].refused > 20 && one.divided > 20);
    CHECK(one.rules[1].placed > 50);
    for (uint32_t i = 0; i < 2; i++) {
        MesoGrown other = meso_scenery_grow(&scenery, &scenery.arena, threads[i]);
        CHECK(are_same(&one, &other));
    }
    /* told turn by turn, it is the same growth */
    uint32_t counts[MESO_GROWTH_FAULT + 1] = {0};
    MesoGrown told;
    MesoGrowthOptions options = meso_scenery_options(&scenery, 2);
    options.event = count_event;
    options.context = counts;
    CHECK(!meso_grow(&told, &scenery.arena, &options, NULL) && are_same(&one, &told));
    CHECK(counts[MESO_GROWTH_STEP] == one.rules[0].steps && counts[MESO_GROWTH_PLACE] == one.rules[1].placed);
    CHECK(counts[MESO_GROWTH_TURN] > counts[MESO_GROWTH_STEP]);
    meso_scenery_release(&scenery);
}

/* More branches than a window has: what one has grown is written down while the next is tried. */
static void test_windows(void)
{
    MesoGrowthScenery scenery;
    prepare(&scenery, meso_fixture_bumpy_torus(60, 30), ivy, 3000);
    MesoGrown one = meso_scenery_grow(&scenery, &scenery.arena, 1);
    MesoGrown two = meso_scenery_grow(&scenery, &scenery.arena, 2);
    CHECK(one.generation_count > 1 && one.rules[0].steps > 2048 && one.rules[0].branches > 1000);
    CHECK(one.rules[1].placed > 50 && are_same(&one, &two));
    meso_scenery_release(&scenery);
}

/* ---- ends of rules ---- */

/* What is ahead where the code for a line begins, and after its first command. */
static void test_ahead(void)
{
    MesoGrowthScenery scenery;
    uint8_t ahead[100] = {0};
    prepare(&scenery, meso_fixture_sheet(4, 4, 1),
            "meso-grow 1\nmap m1 = attribute(\"a\")\nseed A() on vertices\n"
            "rule A() -> {\n"
            "  if chance(0.5) { B() }\n"
            "  step(1 m)\n"
            "  if m1 > 0.5 { move(1 m) }\n"
            "}\nrule B() -> step(1 m)\n", 1);
    const MesoGrammar *grammar = &scenery.grammar;
    CHECK(grammar->code_count <= 100);
    meso_growth_look_ahead(grammar, ahead);
    bool seen[10] = {false};
    for (uint32_t i = 0; i < grammar->code_count; i++) {
        uint32_t line = grammar->lines[i];
        if (line == 5 && !seen[5])
            CHECK(ahead[i] == MESO_AHEAD_END);
        if (line == 6 && !seen[6])
            CHECK(ahead[i] == 0);
        if (line == 7 && !seen[7])
            CHECK(ahead[i] == MESO_AHEAD_LOOK);
        seen[line] = true;
    }
    CHECK(seen[5] && seen[6] && seen[7] && ahead[grammar->code_count - 1] == MESO_AHEAD_END);
    meso_scenery_release(&scenery);
}

/* Rules that end, begin another or are refused right after a walk, or after a draw, a look or a turn, as when told. */
static void test_early_ends(void)
{
    MesoGrowthScenery scenery;
    prepare(&scenery, meso_fixture_bumpy_torus(60, 30),
            "meso-grow 1\nmap m1 = attribute(\"a\")\nlimit elements 3000\nseed A(1) on vertices\n"
            "rule A(n) -> { turn(normal(0, 20 deg)) step(4 cm, width: 2 mm) else B(n)\n"
            " choose { 6: A(n + 1) 1: { branch { turn(50 deg) A(1) } A(0.5*n) } 1: B(n) 1: stop } }\n"
            "rule B(n) -> { move(1 mm) turn(80 deg) step(2 cm, width: 1 mm, cross: true)\n"
            " if n > 3 and m1 > 0.5 and chance(0.7) { turn(80 deg) A(n) } }\n", 400);
    MesoGrown one = meso_scenery_grow(&scenery, &scenery.arena, 1);
    MesoGrown two = meso_scenery_grow(&scenery, &scenery.arena, 2);
    uint32_t counts[MESO_GROWTH_FAULT + 1] = {0};
    MesoGrown told;
    MesoGrowthOptions options = meso_scenery_options(&scenery, 1);
    options.event = count_event;
    options.context = counts;
    CHECK(!meso_grow(&told, &scenery.arena, &options, NULL));
    CHECK(one.element_count > 2900 && one.rules[0].refused > 100 && one.rules[1].steps > 100);
    CHECK(are_same(&one, &told) && are_same(&two, &told));
    CHECK(memcmp(one.rules, told.rules, 2 * sizeof *one.rules) == 0);
    meso_scenery_release(&scenery);
}

/* ---- memory ---- */

/* What is in an array stays in it as it moves; large ones are whole pages. */
static void test_room(void)
{
    uint64_t *array = NULL;
    uint32_t room = 0, moves = 0;
    for (uint32_t i = 0; i < 3000000; i++) {
        uint32_t before = room;
        CHECK(meso_make_room((void **)&array, &room, (uint64_t)i + 1, sizeof *array) && room > i);
        moves += room != before;
        CHECK(room == before || room < 50000 || (room * sizeof *array) % (1 << 21) == 0);
        array[i] = i;
    }
    for (uint32_t i = 0; i < 3000000; i++)
        CHECK(array[i] == i);
    CHECK(moves < 6);
    free(array);
}

/* ---- joints ---- */

/* Consecutive steps of a branch share a joint, the end of one element and the beginning of the next. */
static void test_joints(void)
{
    MesoGrowthScenery scenery;
    uint32_t shared = 0;
    prepare(&scenery, meso_fixture_sphere(24, 0.2f, 1), ivy, 18);
    MesoGrown grown = meso_scenery_grow(&scenery, &scenery.arena, 1);
    uint32_t *last = MESO_NEW(&scenery.arena, uint32_t, grown.branch_count, NULL);
    CHECK(last);
    memset(last, 0xff, grown.branch_count * sizeof *last);
    for (uint32_t i = 0; i < grown.element_count; i++) {
        const MesoGrowthElement *element = &grown.elements[i];
        if (element->shape != 0)
            continue;
        if (last[element->branch] == MESO_NO_INDEX)
            CHECK(grown.branches[element->branch].element_begin == i);
        else
            CHECK(grown.elements[last[element->branch]].span.to == element->span.from);
        shared += last[element->branch] != MESO_NO_INDEX;
        last[element->branch] = i;
    }
    for (uint32_t i = 0; i < grown.joint_count; i++) {
        const MesoJoint *joint = &grown.joints[i];
        const double weight[3] = {grown.points[i].weight[0], grown.points[i].weight[1], grown.points[i].weight[2]};
        MesoVec3 below = meso_growth_position(&scenery.ground, grown.points[i].triangle, weight);
        CHECK(fabsf(meso_vec3_length(joint->tangent) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_length(joint->normal) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_dot(joint->tangent, joint->normal)) < 1e-5f);
        CHECK(meso_vec3_length(meso_vec3_sub(joint->position, below)) < 0.06f);
    }
    CHECK(shared > 500);
    meso_scenery_release(&scenery);
}

/* On a plane the joint's tangent halves the angle between the chords; a step that turns makes the arc of a circle. */
static void test_tangents(void)
{
    MesoGrowthScenery scenery;
    prepare(&scenery, meso_fixture_sheet(10, 10, 1),
            "meso-grow 1\nshape cord = tube\nlimit generations 4\nseed A() on vertices\n"
            "rule A() -> { step(50 cm, 40 deg, shape: cord, width: 1 cm) A() }\n", 1);
    scenery.starts.starts[0].tip = (MesoTip){80, false, {0.3, 0.3, 0.4}, {1, 0}};
    MesoGrown grown = meso_scenery_grow(&scenery, &scenery.arena, 1);
    CHECK(grown.joint_count == 5 && grown.end == MESO_GROWTH_GENERATIONS && fabs(grown.length - 2) < 1e-12);
    for (uint32_t i = 0; i + 1 < 5; i++) {
        MesoVec3 chord = meso_vec3_sub(grown.joints[i + 1].position, grown.joints[i].position);
        CHECK(fabsf(meso_vec3_length(chord) - 0.5f) < 1e-6f);
        chord = meso_vec3_scale(chord, 2);
        CHECK(fabsf(meso_vec3_dot(chord, grown.joints[i].tangent) - cosf(20 * (float)MESO_PI / 180)) < 1e-5f);
        CHECK(fabsf(meso_vec3_dot(chord, grown.joints[i + 1].tangent) - cosf(20 * (float)MESO_PI / 180)) < 1e-5f);
    }
    meso_scenery_release(&scenery);
}

/* How deep a point lies in a ball of triangles, all of which face outward. */
static float depth_in_ball(const MesoTriangulation *mesh, MesoVec3 p)
{
    float depth = INFINITY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = &mesh->corners[3 * t];
        MesoVec3 a = mesh->positions[c[0]], u = meso_vec3_sub(mesh->positions[c[1]], a);
        MesoVec3 n = meso_vec3_cross(u, meso_vec3_sub(mesh->positions[c[2]], a));
        depth = fminf(depth, meso_vec3_dot(meso_vec3_sub(a, p), n) / meso_vec3_length(n));
    }
    return depth;
}

/* Axes of long steps over a coarse ball are not below it by more than `most` of their length. */
static void test_depth(const char *shape, uint32_t divisions, float most, bool divides)
{
    MesoGrowthScenery scenery;
    char text[300];
    snprintf(text, sizeof text, "meso-grow 1\nshape cord = %s\nlimit generations 8\nseed A() on vertices\n"
             "rule A() -> { turn(normal(0, 20 deg))\n"
             " step(70 cm, normal(0, 10 deg), shape: cord, width: 1 cm, cross: true)\n"
             " place cord(50 cm, width: 1 cm) A() }\n", shape);
    prepare(&scenery, meso_fixture_sphere(divisions, 0, 1), text, 18);
    MesoGrown grown = meso_scenery_grow(&scenery, &scenery.arena, 1);
    for (uint32_t i = 0; i < grown.element_count; i++) {
        const MesoSpan *span = &grown.elements[i].span;
        const MesoJoint *from = &grown.joints[span->from], *to = &grown.joints[span->to];
        float length = meso_vec3_length(meso_vec3_sub(to->position, from->position));
        for (float t = 0; t <= 1; t += 0.0625f)
            CHECK(depth_in_ball(&scenery.mesh, meso_bend_frame(from, to, t).origin) < most * length + 1e-5f);
    }
    CHECK(grown.depth <= 0.01f && (grown.divided > 0) == divides && grown.raised > 40);
    meso_scenery_release(&scenery);
}

/* ---- edits ---- */

static const char two_rules[] =
    "meso-grow 1\nshape cord = tube\nlimit generations 12\nseed A() on vertices\nseed B() on vertices\n"
    "rule A() -> { turn(normal(0, 20 deg)) step(5 cm, shape: cord, width: 1 cm, cross: true)\n"
    " if chance(0.2) { branch { turn(50 deg) A() } } A() }\n"
    "rule B() -> { turn(%s) step(5 cm, shape: cord, width: 1 cm, cross: true)\n"
    " if chance(0.2) { branch { turn(50 deg) B() } } B() }\n";

static bool has_branch(const MesoGrown *grown, const MesoGrown *other, uint32_t branch)
{
    for (uint32_t b = 0; b < other->branch_count; b++) {
        if (other->branches[b].key != grown->branches[branch].key)
            continue;
        uint32_t j = 0;
        for (uint32_t i = 0; i < grown->element_count; i++) {
            if (grown->elements[i].branch != branch)
                continue;
            while (j < other->element_count && other->elements[j].branch != b)
                j++;
            if (j == other->element_count)
                return false;
            const MesoSpan *s = &grown->elements[i].span, *t = &other->elements[j++].span;
            if (memcmp(&grown->joints[s->from], &other->joints[t->from], sizeof(MesoJoint)) ||
                memcmp(&grown->joints[s->to], &other->joints[t->to], sizeof(MesoJoint)))
                return false;
        }
        return true;
    }
    return false;
}

static void test_edits(void)
{
    MesoGrowthScenery scenery;
    char text[1000];
    snprintf(text, sizeof text, two_rules, "normal(0, 20 deg)");
    prepare(&scenery, meso_fixture_bumpy_torus(60, 30), text, 40);
    MesoGrown before = meso_scenery_grow(&scenery, &scenery.arena, 1);
    snprintf(text, sizeof text, two_rules, "normal(0, 10 deg) + normal(0, 5 deg)");
    meso_scenery_read(&scenery, text);
    MesoGrown after = meso_scenery_grow(&scenery, &scenery.arena, 1);
    uint32_t same[2] = {0}, all[2] = {0};
    for (uint32_t b = 0; b < before.branch_count; b++) {
        all[before.branches[b].seed]++;
        same[before.branches[b].seed] += has_branch(&before, &after, b);
    }
    CHECK(all[0] > 60 && all[0] == same[0] && same[1] < all[1] / 4);
    meso_scenery_release(&scenery);
}

/* ---- limits ---- */

static bool stop_at_three(void *context, uint32_t generation, uint64_t element_count)
{
    (void)context, (void)element_count;
    return generation < 3;
}

static void test_limits(void)
{
    MesoGrowthScenery scenery;
    MesoGrown grown;
    prepare(&scenery, meso_fixture_bumpy_torus(60, 30), ivy, 18);
    MesoGrowthOptions options = meso_scenery_options(&scenery, 2);
    options.elements = 100;
    CHECK(!meso_grow(&grown, &scenery.arena, &options, NULL));
    CHECK(grown.end == MESO_GROWTH_ELEMENTS && grown.element_count <= 100 && grown.element_count > 92);
    options.elements = 0;
    options.length = 1.99;
    CHECK(!meso_grow(&grown, &scenery.arena, &options, NULL));
    CHECK(grown.end == MESO_GROWTH_LENGTH && grown.length <= 1.99 && grown.length > 1.94);
    options.length = 0;
    options.generations = 5;
    CHECK(!meso_grow(&grown, &scenery.arena, &options, NULL));
    CHECK(grown.end == MESO_GROWTH_GENERATIONS && grown.generation_count == 5);
    options.generations = 0;
    options.progress = stop_at_three;
    CHECK(!meso_grow(&grown, &scenery.arena, &options, NULL));
    CHECK(grown.end == MESO_GROWTH_STOPPED && grown.generation_count == 3);
    for (uint32_t i = 0; i < grown.element_count; i++)
        CHECK(grown.elements[i].generation < 3 && grown.elements[i].span.to < grown.joint_count);
    meso_scenery_release(&scenery);
}

static void test_nothing(void)
{
    MesoGrowthScenery scenery;
    MesoError error = {0};
    prepare(&scenery, meso_fixture_sheet(2, 2, 1), "meso-grow 1\nparam most = 9\nseed A() on vertices\n"
            "rule A() -> { step(1 m / generation) A() }\n", 0);
    MesoGrown grown = meso_scenery_grow(&scenery, &scenery.arena, 1);
    CHECK(grown.end == MESO_GROWTH_ALL_DONE && !grown.element_count && !grown.branch_count && grown.length == 0);
    meso_scenery_strew(&scenery, 3, 1);
    MesoGrowthOptions options = meso_scenery_options(&scenery, 1);
    CHECK(meso_grow(&grown, &scenery.arena, &options, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "line 4: a value is not finite") == 0);
    meso_scenery_release(&scenery);
}

/* ---- conditions and borders ---- */

/* Steps stay where the condition holds, from end to end; at borders they are refused, and moves and shapes end. */
static void test_conditions(void)
{
    MesoGrowthScenery scenery;
    prepare(&scenery, meso_fixture_sheet(20, 20, 0.1f),
            "meso-grow 1\nshape cord = tube\nlimit generations 200\nlimit elements 3000\nseed A() on vertices\n"
            "rule A() : x > 0.5 m and x < 1.5 m -> { turn(normal(0, 30 deg))\n"
            " step(15 cm, shape: cord, width: 1 cm, cross: true) while x > 0.5 m and x < 1.5 m\n"
            "  else retry(20, 180 deg)\n"
            " branch { turn(80 deg) A() } A() }\n", 30);
    MesoGrown grown = meso_scenery_grow(&scenery, &scenery.arena, 1);
    CHECK(grown.element_count == 3000 && grown.rules[0].at_borders > 10);
    for (uint32_t i = 0; i < grown.joint_count; i++)
        CHECK(grown.joints[i].position.x > 0.5f - 1e-6f && grown.joints[i].position.x < 1.5f + 1e-6f);
    meso_scenery_release(&scenery);
}

/* Two sheets that lie near each other do not see each other. */
static void test_sheets(void)
{
    MesoGrowthScenery scenery;
    MesoVec3 positions[8];
    static const uint32_t corners[12] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    for (uint32_t i = 0; i < 8; i++)
        positions[i] = (MesoVec3){(float)(i % 4 == 1 || i % 4 == 2), (float)(i % 4 >= 2), i < 4 ? 0 : 0.01f};
    prepare(&scenery, meso_fixture_triangulation(positions, 8, corners, 4),
            "meso-grow 1\nshape cord = tube\nlimit generations 30\nseed A() on vertices\n"
            "rule A() -> { turn(normal(0, 30 deg)) step(5 cm, shape: cord, width: 1 cm, clear: 4 cm)\n"
            " if clear(10 cm) { branch { turn(80 deg) A() } } A() }\n", 40);
    MesoGrown both = meso_scenery_grow(&scenery, &scenery.arena, 1);
    uint32_t kept = 0, found = 0;
    for (uint32_t i = 0; i < 40; i++)
        if (scenery.starts.starts[i].tip.triangle < 2)
            scenery.starts.starts[kept++] = scenery.starts.starts[i];
    scenery.starts.count = kept;
    MesoGrown one = meso_scenery_grow(&scenery, &scenery.arena, 1);
    for (uint32_t b = 0; b < one.branch_count; b++)
        found += has_branch(&one, &both, b);
    CHECK(one.element_count > 30 && both.element_count > one.element_count + 30 && found == one.branch_count);
    meso_scenery_release(&scenery);
}

/* ---- meshes that are none ---- */

static void break_mesh(MesoGrowthScenery *scenery, MesoRandom *random)
{
    uint32_t kind = meso_random_below(random, 5), sides = 3 * scenery->mesh.triangle_count;
    for (uint32_t v = 0; v < scenery->mesh.vertex_count; v++)
        for (uint32_t i = 0; i < 3; i++) {
            float x = meso_fixture_signed(random);
            const float values[5] = {roundf(x), i ? 0 : x, x * powf(10, 10 * meso_fixture_signed(random)),
                                     i == 2 ? 0 : roundf(2 * x), i ? 1e-30f * x : x};
            (&scenery->mesh.positions[v].x)[i] = values[kind];
        }
    CHECK(!meso_walk_ground_build(&scenery->ground.walk, &scenery->arena, &scenery->mesh, NULL, 1, NULL));
    for (uint32_t n = meso_random_below(random, sides); n > 0; n--) {
        uint32_t a = meso_random_below(random, sides), b = meso_random_below(random, sides);
        scenery->ground.walk.faces[a / 3].twins[a % 3] = meso_random_below(random, 20) ? b : MESO_NO_INDEX;
        scenery->ground.walk.faces[a / 3].marks ^= meso_random_below(random, 2) << a % 3;
    }
}

static void test_broken(uint32_t count)
{
    MesoRandom random;
    meso_random_init(&random, 10, 0);
    MesoTriangulation sheet = meso_fixture_torus(4, 3, 0.4f);
    for (uint32_t i = 0; i < count; i++) {
        MesoGrowthScenery scenery = {.values = {1}};
        meso_scenery_init(&scenery, sheet);
        meso_scenery_read(&scenery, ivy);
        break_mesh(&scenery, &random);
        meso_scenery_strew(&scenery, 4, i);
        MesoGrown grown;
        MesoGrowthOptions options = meso_scenery_options(&scenery, 1);
        options.generations = 6;
        options.elements = 40;
        CHECK(!meso_grow(&grown, &scenery.arena, &options, NULL));
        CHECK(!meso_growth_lift(&grown, &scenery.arena, &scenery.ground, 1, NULL));
        for (uint32_t j = 0; j < grown.joint_count; j++)
            CHECK(meso_vec3_finite(grown.joints[j].position) && meso_vec3_finite(grown.joints[j].tangent));
        meso_arena_release(&scenery.arena);
    }
    meso_triangulation_release(&sheet);
}

int main(int argc, char **argv)
{
    if (argc > 1) {
        test_broken((uint32_t)strtoul(argv[1], NULL, 10));
        return 0;
    }
    test_threads();
    test_windows();
    test_ahead();
    test_early_ends();
    test_room();
    test_joints();
    test_tangents();
    test_depth("tube", 1, 0.03f, true);
    test_depth("tube", 4, 0.01f, false);
    test_depth("leaf", 4, 0.01f, false);
    test_edits();
    test_limits();
    test_nothing();
    test_conditions();
    test_sheets();
    test_broken(100);
    return 0;
}
