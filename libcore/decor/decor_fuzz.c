/* Patterns: whatever the surface and the steps, regions and scene are as promised, or it says why not. */
#include "libcore/decor/decor_fixture.h"
#include "libcore/decor/decor_scene.h"
#include "libcore/mesh/cut/mesh_cut_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* ---- surfaces ---- */

enum { SOUP_VERTICES = 14, SOUP_FACES = 30 };

/* Uses of the undirected edge of two vertices in the faces so far. */
static uint32_t edge_uses(const uint32_t *corners, uint32_t count, uint32_t a, uint32_t b)
{
    uint32_t uses = 0;
    for (uint32_t c = 0; c < count; c++) {
        uint32_t from = corners[c], to = corners[c % 3 == 2 ? c - 2 : c + 1];
        uses += (from == a && to == b) || (from == b && to == a);
    }
    return uses;
}

/* Any faces that leave no edge with three: parts, one-sided ones, fans that touch in a vertex, pillows. */
static MesoTriangulation soup(MesoChoices *choices)
{
    MesoVec3 positions[SOUP_VERTICES];
    uint32_t corners[3 * SOUP_FACES] = {0, 1, 2}, count = 3, tries = 1 + meso_choose(choices, SOUP_FACES - 1);
    for (uint32_t v = 0; v < SOUP_VERTICES; v++)
        positions[v] = (MesoVec3){meso_choose_share(choices), meso_choose_share(choices), meso_choose_share(choices)};
    for (uint32_t i = 0; i < tries; i++) {
        uint32_t *t = corners + count;
        for (int k = 0; k < 3; k++)
            t[k] = meso_choose(choices, SOUP_VERTICES);
        bool fits = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        for (int k = 0; k < 3 && fits; k++)
            fits = edge_uses(corners, count, t[k], t[(k + 1) % 3]) < 2;
        count += fits ? 3 : 0;
    }
    return meso_fixture_triangulation(positions, SOUP_VERTICES, corners, count / 3);
}

static MesoTriangulation choose_mesh(MesoChoices *choices, bool *orientable)
{
    uint32_t kind = meso_choose(choices, 8);
    *orientable = kind != 3 && kind != 7;
    switch (kind) {
    case 0: return meso_fixture_sheet(1 + meso_choose(choices, 9), 1 + meso_choose(choices, 5), 0.3f);
    case 1: return meso_fixture_crumpled(choices, 2 + meso_choose(choices, 5));
    case 2: return meso_fixture_torus(3 + meso_choose(choices, 8), 3 + meso_choose(choices, 4), 0.4f);
    case 3: return meso_fixture_moebius(5 + 2 * meso_choose(choices, 10));
    case 4: return meso_fixture_pillow();
    case 5: return meso_fixture_octahedron();
    case 6: return meso_fixture_crumpled(choices, 2);
    default: return soup(choices);
    }
}

/* Sizes that files may have. */
static void scale(MesoTriangulation *mesh, MesoChoices *choices)
{
    static const float sizes[] = {1, 1, 1, 1e-6f, 1e4f, 0, 1e-18f, 1e12f};
    float size = sizes[meso_choose(choices, sizeof sizes / sizeof *sizes)];
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        mesh->positions[v] = meso_vec3_scale(mesh->positions[v], size);
}

/* ---- patterns ---- */

enum { NESTING = 2, MATERIALS = 3 };

typedef struct Making {
    MesoChoices *choices;
    MesoArena *arena;
    uint32_t depth;
    bool moves;
} Making;

static void *room(Making *m, size_t count, size_t size)
{
    MesoError error;
    void *room = meso_arena_alloc(m->arena, count, size, &error);
    CHECK(room);
    return room;
}
#define ROOM(m, type, count) ((type *)room(m, count, sizeof(type)))

static uint32_t choose(Making *m, uint32_t bound)
{
    return meso_choose(m->choices, bound);
}

static float choose_share(Making *m)
{
    return meso_clamp_share(meso_choose_share(m->choices), 1);
}

static MesoVec3 choose_place(Making *m)
{
    return (MesoVec3){choose_share(m), choose_share(m), choose_share(m)};
}

static MesoRange choose_range(Making *m, float most)
{
    uint32_t how = choose(m, 8);
    return (MesoRange){how == 0 ? most * choose_share(m) : -INFINITY, how == 1 ? most * choose_share(m) : INFINITY};
}

static MesoSelector make_selector(Making *m)
{
    static const char *const paths[] = {NULL, NULL, ".", "*", "**", "*/*", "cell", "stripe.1", "**/band", "dot/**"};
    static const char *tags[] = {"band", "inside", "dot", "background", "stripe", "cell", "surface", "none"};
    MesoSelector s = {.path = paths[choose(m, sizeof paths / sizeof *paths)], .share = 1};
    s.tags = tags + choose(m, 6);
    s.tag_count = choose(m, 4) == 0 ? 1 + choose(m, 2) : 0;
    s.level = (MesoSelectLevel)choose(m, 3);
    s.borders = choose_range(m, 4);
    s.corners = choose_range(m, 4);
    s.aspect = choose_range(m, 4);
    s.area = choose_range(m, 2);
    s.area_share = choose_range(m, 1);
    switch (choose(m, 8)) {
    case 0: s.has_point = true; s.point = choose_place(m); break;
    case 1: s.colors = 2 + choose(m, 3); s.color = choose(m, s.colors); break;
    case 2: s.share = choose_share(m); break;
    case 3: s.every = choose(m, 4); s.from = choose(m, 3); break;
    case 4: s.largest = choose(m, 5); break;
    default: break;
    }
    return s;
}

static MesoSeedSpec make_seed(Making *m, bool point)
{
    MesoSeedSpec s = {.kind = point ? MESO_SEED_POINT : (MesoSeedKind)choose(m, MESO_SEED_POISSON + 1)};
    if (s.kind == MESO_SEED_FACE && choose(m, 8))
        s.kind = MESO_SEED_POISSON;     /* there are no faces here: an error */
    s.of = (MesoSeedKind)choose(m, MESO_SEED_SIDE + 1);
    s.loop = choose(m, 3);
    s.corners[0] = choose(m, 5);
    s.corners[1] = choose(m, 5);
    s.point = choose_place(m);
    s.count = choose(m, 10);
    s.spacing = 0.02f + choose_share(m);
    s.relative = true;      /* in scene units there could be a million of them in one triangle */
    s.on_border = choose(m, 4) == 0;
    s.from_border = !s.on_border && choose(m, 2);
    s.border_slack = s.from_border ? choose_share(m) : 0;
    return s;
}

static MesoSeedSet make_seeds(Making *m)
{
    uint32_t count = 1 + choose(m, 3);
    MesoSeedSpec *specs = ROOM(m, MesoSeedSpec, count);
    for (uint32_t i = 0; i < count; i++)
        specs[i] = make_seed(m, false);
    return (MesoSeedSet){specs, count};
}

static MesoFieldSpec make_field(Making *m)
{
    MesoFieldSpec field = {.from = make_seeds(m), .blend = choose(m, 3) == 0};
    if (field.blend)
        field.to = make_seeds(m);
    if (choose(m, 4) == 0)
        field.noise = (MesoNoise){(MesoNoiseOf)(1 + choose(m, 2)), choose_share(m), 8 * choose_share(m),
                                  choose(m, 2), choose(m, 256)};
    return field;
}

static MesoLevels make_levels(Making *m)
{
    MesoLevels levels = {.unit = (MesoLevelUnit)choose(m, 3)};
    float *values = ROOM(m, float, 3);
    levels.value_count = choose(m, 4);
    for (uint32_t i = 0; i < levels.value_count; i++)
        values[i] = choose_share(m);
    levels.values = values;
    levels.count = choose(m, 6);
    if (choose(m, 2)) {         /* by tens, as above */
        levels.count = 0;
        levels.every = 0.02f + choose_share(m);
        levels.unit = MESO_LEVEL_SHARE;
    }
    return levels;
}

static MesoAfterSplit make_after(Making *m, bool painted, bool displaced)
{
    static const char *const tags[] = {NULL, "band", "inside", "dot", "stripe", "cell"};
    uint32_t *materials = ROOM(m, uint32_t, MATERIALS);
    MesoAfterSplit a = {.tag = tags[choose(m, 6)], .painted = painted, .displaced = displaced};
    a.name = choose(m, 4) == 0 ? "name" : NULL;
    a.by = (MesoPaintBy)choose(m, 4);
    a.material_count = 1 + choose(m, MATERIALS);
    for (uint32_t i = 0; i < a.material_count; i++)
        materials[i] = choose(m, MATERIALS);
    a.materials = materials;
    a.displacement = (MesoDisplacement){choose_share(m) - 0.5f, choose(m, 2), choose_share(m), choose_share(m),
                                        choose_share(m)};
    m->moves |= displaced;
    return a;
}

static MesoMacro make_steps(Making *m);

static MesoGrowth make_growth(Making *m)
{
    MesoGrowth g = {.rule_count = 1 + choose(m, 3), .depth = 1 + choose(m, 3), .smallest = 0.2f * choose_share(m)};
    MesoRule *rules = ROOM(m, MesoRule, g.rule_count);
    for (uint32_t i = 0; i < g.rule_count; i++) {
        rules[i] = (MesoRule){.weight = choose_share(m), .most = choose(m, 3)};
        rules[i].where = make_selector(m);
        rules[i].macro = make_steps(m);
    }
    g.rules = rules;
    g.grouping = (MesoGrouping)choose(m, 4);
    g.cycle = choose(m, 4);
    g.rest = choose(m, 3) == 0 ? choose_share(m) : 0;
    return g;
}

static MesoStep make_step(Making *m)
{
    MesoStep step = {.kind = (MesoStepKind)choose(m, m->depth < NESTING ? MESO_STEP_GROW + 1 : MESO_STEP_MACRO),
                     .place = "step", .on = make_selector(m)};
    if (step.kind == MESO_STEP_MACRO) {
        step.macro = make_steps(m);
        return step;
    }
    if (step.kind == MESO_STEP_GROW) {
        step.growth = make_growth(m);
        return step;
    }
    bool alone = step.kind == MESO_STEP_PAINT || step.kind == MESO_STEP_DISPLACE;
    step.field = make_field(m);
    step.levels = make_levels(m);
    step.line_count = 1 + choose(m, 12);
    step.closed = choose(m, 2);
    step.point_count = (step.closed ? 3 : 2) + choose(m, 2);
    MesoSeedSpec *points = ROOM(m, MesoSeedSpec, step.point_count);
    for (uint32_t i = 0; i < step.point_count; i++)
        points[i] = make_seed(m, true);
    step.points = points;
    step.after_count = alone ? 1 : choose(m, 3);
    MesoAfterSplit *after = ROOM(m, MesoAfterSplit, step.after_count + 1);
    for (uint32_t i = 0; i < step.after_count; i++)
        after[i] = make_after(m, step.kind == MESO_STEP_PAINT || (!alone && choose(m, 2)),
                              step.kind == MESO_STEP_DISPLACE || (!alone && choose(m, 3) == 0));
    step.after = after;
    return step;
}

static MesoMacro make_steps(Making *m)
{
    MesoMacro macro = {.name = "steps", .step_count = 1 + choose(m, 3)};
    MesoStep *steps = ROOM(m, MesoStep, macro.step_count);
    m->depth++;
    for (uint32_t i = 0; i < macro.step_count; i++)
        steps[i] = make_step(m);
    m->depth--;
    macro.steps = steps;
    return macro;
}

/* ---- what comes of it ---- */

static void check_finite(const MesoDecor *decor)
{
    for (uint32_t v = 0; v < decor->mesh.vertex_count; v++)
        CHECK(isfinite(decor->mesh.positions[v].x + decor->mesh.positions[v].y + decor->mesh.positions[v].z));
    for (uint32_t i = 0; i < 2 * decor->line_count; i++)
        CHECK(isfinite(decor->lines[i].x + decor->lines[i].y + decor->lines[i].z));
}

static void check_scene(const MesoDecor *decor, const MesoPattern *pattern, MesoArena *arena)
{
    MesoScene scene;
    MesoError error = {0};
    uint32_t faces = 0;
    CHECK(meso_decor_scene(&scene, arena, decor, pattern, &(MesoDecorValues)MESO_DECOR_NO_VALUES, &error) == MESO_OK);
    for (uint32_t i = 0; i < scene.body_count; i++) {
        CHECK(scene.bodies[i].face_count > 0 && scene.placed[i].material < scene.material_count);
        for (uint32_t c = 0; c < 3 * scene.bodies[i].face_count; c++)
            CHECK(scene.bodies[i].corners[c] < scene.bodies[i].vertex_count);
        faces += scene.bodies[i].face_count;
    }
    CHECK(faces == decor->mesh.triangle_count);
}

static void check_all(const MesoDecor *decor, int64_t euler, bool orientable, bool moves)
{
    MesoError error = {0};
    MesoStatus status = meso_triangulation_check(&decor->mesh, &error);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(status == MESO_OK);
    CHECK(meso_fixture_euler(&decor->mesh) == euler);
    check_finite(decor);
    meso_fixture_check_connected(decor);
    meso_fixture_check_regions(decor, orientable, moves);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const MesoMaterial materials[MATERIALS] = {{{0.1f, 0.2f, 0.3f}, 0.5f, 0}, {{1, 1, 1}, 1, 1}};
    static const char *const names[MATERIALS] = {"a", "b", "c"};
    bool orientable;
    MesoArena arena;
    MesoError error = {0};
    MesoChoices choices = {.bytes = data, .left = size};
    meso_arena_init(&arena);
    MesoDecor decor = {.mesh = choose_mesh(&choices, &orientable), .keep_lines = meso_choose(&choices, 2)};
    scale(&decor.mesh, &choices);
    int64_t euler = meso_fixture_euler(&decor.mesh);
    Making making = {.choices = &choices, .arena = &arena};
    MesoDecorOptions options = {.engine = (MesoGeodesicEngine)meso_choose(&choices, 3), .region_limit = 400,
                                .step_limit = meso_choose(&choices, 8), .triangle_limit = 20000};
    options.seed = meso_choose(&choices, 256);
    MesoMacro program = make_steps(&making);
    const MesoPattern pattern = {program.steps, program.step_count, materials, names, MATERIALS};
    MesoStatus status = meso_decor_run(&decor, &arena, &pattern, &options, &error);
    CHECK(status == MESO_OK || status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT);
    if (!status) {
        check_all(&decor, euler, orientable, making.moves);
        check_scene(&decor, &pattern, &arena);
    }
    meso_triangulation_release(&decor.mesh);
    meso_arena_release(&arena);
    return 0;
}
