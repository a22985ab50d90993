/* What has grown, as a scene: bodies by branch and shape, ids, tints, folds, and that threads do not matter. */
#include "libcore/growth/engine/growth_fixture.h"
#include "libcore/growth/scene/growth_scene.h"

enum { SHAPES = 3 };

typedef struct Show {
    MesoGrowthScenery scenery;
    MesoGrown grown;
    MesoTerminalShape shapes[SHAPES];
    MesoMaterial materials[2];
    MesoGrowthShapes table;
    MesoScene scene;
    uint32_t folds;
} Show;

static const char *const shape_names[SHAPES] = {"cord", "unused", "dot"};
static const char *const material_names[2] = {"red", "blue"};
static const uint32_t material_of[SHAPES] = {1, 0, 0};

static const char two_shapes[] =
    "meso-grow 1\nshape cord = tube(sides: 5) shape unused = leaf shape dot = bead\nlimit generations 6\n"
    "seed A(1) on vertices\n"
    "rule A(w) -> { turn(normal(0, 20 deg)) step(5 cm, shape: cord, width: 1 cm, cross: true)\n"
    " step(2 cm, cross: true) place dot(1 cm, width: 1 cm%s)\n"
    " if chance(0.3) { branch { turn(50 deg) A(w) } } A(w) }\n";

static void show_init(Show *s, MesoTriangulation mesh, const char *text, uint32_t starts)
{
    *s = (Show){.scenery = {.values = {1}}};
    meso_scenery_init(&s->scenery, mesh);
    meso_scenery_read(&s->scenery, text);
    meso_scenery_strew(&s->scenery, starts, 5);
    s->grown = meso_scenery_grow(&s->scenery, &s->scenery.arena, 1);
    MesoArena *arena = &s->scenery.arena;
    CHECK(!meso_tube_shape(&s->shapes[0], arena, 5, 0, NULL));
    CHECK(!meso_builtin_shape(&s->shapes[1], arena, MESO_BUILTIN_LEAF, 0, NULL));
    CHECK(!meso_builtin_shape(&s->shapes[2], arena, MESO_BUILTIN_BEAD, 0, NULL));
    s->materials[0].roughness = 0.25f;
    s->table = (MesoGrowthShapes){SHAPES, s->shapes, shape_names, 2, s->materials, material_names, material_of};
}

static void show(Show *s, uint32_t thread_count)
{
    CHECK(!meso_growth_show(&s->scene, &s->scenery.arena, &s->grown, &s->scenery.grammar, &s->table, thread_count,
                            &s->folds, NULL));
}

static uint32_t id_of(const MesoScene *scene, uint32_t body, uint32_t channel)
{
    return scene->ids[(size_t)scene->placed[body].ids * scene->channel_count + channel];
}

/* Elements of a branch and a shape, in the order of their growth. */
static uint32_t elements_of(const MesoGrown *grown, uint32_t branch, uint32_t shape, uint32_t *first)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < grown->element_count; i++)
        if (grown->elements[i].branch == branch && grown->elements[i].shape == shape && count++ == 0)
            *first = i;
    return count;
}

/* ---- bodies and ids ---- */

static void test_bodies(void)
{
    Show s;
    char text[600];
    snprintf(text, sizeof text, two_shapes, "");
    show_init(&s, meso_fixture_bumpy_torus(60, 30), text, 9);
    show(&s, 1);
    const MesoScene *scene = &s.scene;
    uint32_t shown = 0, last = 0;
    CHECK(scene->body_count <= 2 * s.grown.branch_count && scene->body_count > s.grown.branch_count);
    CHECK(scene->placed_count == scene->body_count && s.grown.branch_count > 15);
    CHECK(scene->channel_count == 4 && strcmp(scene->channels[0].name, "branch") == 0);
    CHECK(strcmp(scene->channels[1].names[0], "A") == 0 && strcmp(scene->channels[2].names[2], "dot") == 0);
    CHECK(scene->channels[2].count == SHAPES && scene->channels[3].count == s.grown.generation_count);
    for (uint32_t b = 0; b < scene->body_count; b++) {
        const MesoBody *body = &scene->bodies[b];
        uint32_t branch = id_of(scene, b, 0), shape = id_of(scene, b, 2), first = 0;
        uint32_t count = elements_of(&s.grown, branch, shape, &first);
        CHECK(shape != 1 && count > 0 && scene->placed[b].body == b);
        CHECK(scene->placed[b].material == material_of[shape]);
        CHECK(id_of(scene, b, 1) == s.grown.elements[first].rule);
        CHECK(id_of(scene, b, 3) == s.grown.elements[first].generation);
        CHECK(body->vertex_count == count * s.shapes[shape].body.vertex_count && !body->colors);
        CHECK(body->face_count == count * s.shapes[shape].body.face_count);
        for (uint32_t c = 0; c < body->face_width * body->face_count; c++)
            CHECK(body->corners[c] < body->vertex_count || body->corners[c] == MESO_NO_INDEX);
        /* its first vertices are those of its first element, bent alone */
        MesoVec3 positions[64], normals[64];
        const MesoBending bending = {&s.shapes[shape], s.grown.joints, 1, &s.grown.elements[first].span, positions,
                                     normals, NULL, NULL};
        CHECK(s.shapes[shape].body.vertex_count <= 64);
        meso_bend(&bending, 1);
        CHECK(!memcmp(positions, body->positions, s.shapes[shape].body.vertex_count * sizeof *positions));
        CHECK(!memcmp(normals, body->normals, s.shapes[shape].body.vertex_count * sizeof *normals));
        for (uint32_t v = 0; v < body->vertex_count; v++)
            for (uint32_t k = 0; k < 3; k++)
                CHECK((&body->positions[v].x)[k] >= (&scene->box.low.x)[k] &&
                      (&body->positions[v].x)[k] <= (&scene->box.high.x)[k]);
        CHECK(shape >= last);
        last = shape;
        shown += count;
    }
    for (uint32_t i = 0; i < s.grown.element_count; i++)
        shown -= s.grown.elements[i].shape != MESO_NO_INDEX;
    CHECK(shown == 0 && scene->material_count == 2 && scene->materials[0].roughness == 0.25f);
    CHECK(strcmp(scene->material_names[1], "blue") == 0);
    meso_scenery_release(&s.scenery);
}

/* ---- tints ---- */

/* Where anything has a tint all have colours: white at 0, each element all over in its own. */
static void test_tints(void)
{
    Show s;
    char text[600];
    snprintf(text, sizeof text, two_shapes, ", tint: rand(0, 1)");
    show_init(&s, meso_fixture_bumpy_torus(60, 30), text, 9);
    show(&s, 1);
    uint32_t dots = 0;
    for (uint32_t b = 0; b < s.scene.body_count; b++) {
        const MesoBody *body = &s.scene.bodies[b];
        uint32_t shape = id_of(&s.scene, b, 2), vertices = s.shapes[shape].body.vertex_count, i = 0;
        CHECK(body->colors);
        elements_of(&s.grown, id_of(&s.scene, b, 0), shape, &i);
        for (uint32_t v = 0; v < body->vertex_count; v++) {
            if (shape == 0)
                CHECK(body->colors[v].r == 255 && body->colors[v].g == 255 && body->colors[v].b == 255);
            else
                CHECK(!memcmp(&body->colors[v], &body->colors[v / vertices * vertices], sizeof *body->colors));
        }
        if (shape == 2) {
            CHECK(fabsf((float)body->colors[0].g - 255 * (1 - 0.6f * s.grown.elements[i].tint)) < 1);
            dots++;
        }
    }
    CHECK(dots > 9);
    meso_scenery_release(&s.scenery);
}

/* ---- folds, threads, nothing ---- */

static void test_folds(void)
{
    static const char *const texts[2] = {
        "meso-grow 1\nshape a = tube(sides: 5) shape b = leaf shape c = bead\n"
        "limit generations 8\nseed A() on vertices\n"
        "rule A() -> { step(5 cm, 90 deg, shape: a, width: 1 cm, cross: true) A() }\n",
        "meso-grow 1\nshape a = tube(sides: 5) shape b = leaf shape c = bead\n"
        "limit generations 8\nseed A() on vertices\n"
        "rule A() -> { step(5 cm, 90 deg, shape: a, width: 30 cm, cross: true) A() }\n"};
    for (uint32_t wide = 0; wide < 2; wide++) {
        Show s;
        show_init(&s, meso_fixture_sheet(20, 20, 0.1f), texts[wide], 3);
        show(&s, 1);
        CHECK((s.folds > 10) == (wide == 1) && (s.folds == 0) == (wide == 0) && s.folds <= s.grown.element_count);
        meso_scenery_release(&s.scenery);
    }
}

static void test_threads(void)
{
    static const uint32_t threads[] = {2, 7};
    Show s;
    char text[600];
    snprintf(text, sizeof text, two_shapes, ", tint: rand(0, 1)");
    show_init(&s, meso_fixture_bumpy_torus(60, 30), text, 300);
    show(&s, 1);
    MesoScene one = s.scene;
    for (uint32_t i = 0; i < 2; i++) {
        show(&s, threads[i]);
        CHECK(s.scene.body_count == one.body_count && !memcmp(&s.scene.box, &one.box, sizeof one.box));
        CHECK(!memcmp(s.scene.ids, one.ids, 4 * (size_t)one.id_row_count * sizeof *one.ids));
        for (uint32_t b = 0; b < one.body_count; b++) {
            const MesoBody *x = &one.bodies[b], *y = &s.scene.bodies[b];
            CHECK(x->vertex_count == y->vertex_count);
            CHECK(!memcmp(x->positions, y->positions, x->vertex_count * sizeof *x->positions));
            CHECK(!memcmp(x->normals, y->normals, x->vertex_count * sizeof *x->normals));
            CHECK(!memcmp(x->colors, y->colors, x->vertex_count * sizeof *x->colors));
        }
    }
    meso_scenery_release(&s.scenery);
}

/* Cords over the sides of large triangles, as long as these allow to bend them by their width. */
static void test_folds_on_coarse(void)
{
    static const char text[] =
        "meso-grow 1\nshape cord = tube(sides: 5) shape unused = leaf shape dot = bead\nlimit generations 12\n"
        "seed A() on vertices\nrule A() -> { turn(normal(0, 20 deg))\n"
        " step(12 cm, normal(0, 4 deg), shape: cord, width: 3 cm, cross: true) A() }\n";
    Show s;
    show_init(&s, meso_fixture_torus(16, 8, 0.4f), text, 20);
    CHECK(!meso_growth_lift(&s.grown, &s.scenery.arena, &s.scenery.ground, 1, NULL));
    show(&s, 1);
    CHECK(s.grown.divided > 0 && s.grown.raised > 0 && s.folds == 0);
    meso_scenery_release(&s.scenery);
}

static void test_nothing(void)
{
    Show s;
    char text[600];
    snprintf(text, sizeof text, two_shapes, "");
    show_init(&s, meso_fixture_sheet(2, 2, 1), text, 0);
    show(&s, 2);
    CHECK(s.scene.body_count == 0 && s.scene.placed_count == 0 && s.folds == 0 && s.scene.material_count == 2);
    meso_scenery_release(&s.scenery);
}

int main(void)
{
    test_bodies();
    test_tints();
    test_folds();
    test_folds_on_coarse();
    test_threads();
    test_nothing();
    return 0;
}
