/*
 * What the example grammars grow on the example surfaces, taken at its word: strands are smooth, nothing is below the
 * surface, what keeps clear is clear, and what keeps to paint is on it.
 */
#include <math.h>

#include "cmd/grow/grow_contexts.h"
#include "cmd/grow/grow_surface.h"
#include "formats/file/test_folder.h"
#include "formats/growth/grammar_file.h"
#include "libcore/growth/engine/growth.h"
#include "libcore/growth/ground/growth_snap.h"

enum { SAMPLES = 16 };

static TestFolder folder;

typedef struct Scene {
    MesoGrowArguments arguments;
    MesoGrowSurface surface;
    MesoInput surface_input, grammar_input;
    MesoGrammar grammar;
    MesoGrowthContexts contexts;
    MesoGrowthPlaces places;
    MesoGrowthStarts starts;
    MesoGrown grown;
} Scene;

static void must(const MesoTool *tool, MesoStatus status)
{
    if (status) {
        fprintf(stderr, "%s\n", tool->error.message);
        exit(1);
    }
}

/* What an environment's variable names, as scripts/run-tests sets it, or what it is from the root of the tree. */
static const char *place_of(const char *variable, const char *otherwise)
{
    const char *path = getenv(variable);
    return path ? path : otherwise;
}

static const char *make_surface(const char *name)
{
    char command[1200];
    const char *path = test_path(&folder, name);
    snprintf(command, sizeof command, "'%s/make_%s' >'%s'", place_of("generators", "build/release/scripts"), name,
             path);
    CHECK(system(command) == 0);
    return path;
}

/* ---- scenes ---- */

static void grow(Scene *s, const char *grammar, const char *surface)
{
    const char *testdata = place_of("testdata", "testdata");
    MesoTool *tool = &s->arguments.tool;
    *s = (Scene){.arguments = {.tool = {.quiet = true, .threads = 1, .seed = 0}, .up = {0, 1, 0}}};
    meso_arena_init(&tool->arena);
    const char *grammars = meso_arena_print(&tool->arena, NULL, "%s/grammars", testdata);
    const char *path = meso_arena_print(&tool->arena, NULL, "%s/%s.grammar", grammars, grammar);
    CHECK(path);
    const char *operands[] = {path, surface};
    tool->operands = operands;
    must(tool, meso_grow_surface_read(&s->surface, &s->arguments, &s->surface_input, surface));
    must(tool, meso_input_open(&s->grammar_input, path, &tool->error));
    const MesoGrammarOptions reading = {.extent = s->surface.ground.extent};
    must(tool, meso_grammar_file_read(&s->grammar, &tool->arena, &s->grammar_input, &reading, &tool->error));
    must(tool, meso_grow_contexts(&s->contexts, &s->places, tool, &s->grammar, &s->surface.polygons,
                                  &s->surface.ground, grammars));
    must(tool, meso_growth_seeds(&s->starts, &tool->arena, &s->grammar, &s->contexts, &s->places, 0, 1, &tool->error));
}

static void finish(Scene *s, const MesoGrowthOptions *options)
{
    MesoTool *tool = &s->arguments.tool;
    must(tool, meso_grow(&s->grown, &tool->arena, options, &tool->error));
    must(tool, meso_growth_lift(&s->grown, &tool->arena, &s->surface.ground, 1, &tool->error));
}

static MesoGrowthOptions options_of(const Scene *s)
{
    return (MesoGrowthOptions){.grammar = &s->grammar, .contexts = &s->contexts, .starts = &s->starts,
                               .thread_count = 1, .elements = 20000};
}

static void release(Scene *s)
{
    meso_input_close(&s->grammar_input);
    meso_input_close(&s->surface_input);
    meso_grow_surface_release(&s->surface);
    meso_arena_release(&s->arguments.tool.arena);
}

/* Whether an element is of a strand: shapes that are swept are, in these grammars. */
static bool is_strand(const Scene *s, const MesoGrowthElement *element)
{
    if (element->shape == MESO_NO_INDEX)
        return true;
    uint16_t kind = s->grammar.shapes[element->shape].kind;
    return kind == MESO_SHAPE_TUBE || kind == MESO_SHAPE_SECTION;
}

/* ---- smoothness ---- */

static bool is_same_place(const MesoMeshPoint *a, const MesoMeshPoint *b)
{
    return a->triangle == b->triangle && memcmp(a->weight, b->weight, sizeof a->weight) == 0;
}

/* Where a branch's step begins at the place where its last one ended, they meet in the same floats and one tangent. */
static uint32_t check_successors(const Scene *s)
{
    const MesoGrown *g = &s->grown;
    uint32_t count = 0;
    uint32_t *last = MESO_NEW(&((Scene *)s)->arguments.tool.arena, uint32_t, g->branch_count, NULL);
    CHECK(last || !g->branch_count);
    for (uint32_t b = 0; b < g->branch_count; b++)
        last[b] = MESO_NO_INDEX;
    for (uint32_t i = 0; i < g->element_count; i++) {
        const MesoGrowthElement *element = &g->elements[i];
        if (!is_strand(s, element))
            continue;
        uint32_t from = element->span.from, to = last[element->branch];
        if (to != MESO_NO_INDEX && is_same_place(&g->points[from], &g->points[to])) {
            const MesoJoint *a = &g->joints[to], *b = &g->joints[from];
            CHECK(memcmp(&a->position, &b->position, sizeof a->position) == 0);
            CHECK(meso_vec3_length(meso_vec3_sub(a->tangent, b->tangent)) < 1e-5f);
            CHECK(meso_vec3_length(meso_vec3_sub(a->normal, b->normal)) < 1e-5f);
            count++;
        }
        last[element->branch] = element->span.to;
    }
    return count;
}

/* ---- depth ---- */

static bool is_on_border(const Scene *s, const MesoMeshPoint *point)
{
    const uint32_t *twins = s->surface.ground.walk.faces[point->triangle].twins;
    for (uint32_t k = 0; k < 3; k++)
        if (twins[k] == MESO_NO_INDEX && point->weight[(k + 2) % 3] < 1e-4f)
            return true;
    return false;
}

/* How far a point is below the surface that is nearest to it, if it is. */
static float depth_at(const Scene *s, MesoVec3 p, const MesoMeshPoint *near)
{
    const MesoTriangulation *mesh = &s->surface.mesh;
    const uint32_t *c = &mesh->corners[3 * (size_t)near->triangle];
    MesoVec3 a = mesh->positions[c[0]], q = {0, 0, 0};
    MesoVec3 n = meso_vec3_cross(meso_vec3_sub(mesh->positions[c[1]], a), meso_vec3_sub(mesh->positions[c[2]], a));
    const double weight[3] = {(double)near->weight[0], (double)near->weight[1], (double)near->weight[2]};
    bool inside = true;
    for (uint32_t k = 0; k < 3; k++) {
        q = meso_vec3_mad(q, near->weight[k], mesh->positions[c[k]]);
        inside &= near->weight[k] > 1e-4f;
    }
    if (!inside)    /* on a side or a corner the triangle's own normal does not tell */
        n = meso_growth_normal(&s->surface.ground, near->triangle, weight, false);
    MesoVec3 up = meso_vec3_sub(p, q);
    return meso_vec3_dot(up, n) < 0 && !is_on_border(s, near) ? meso_vec3_length(up) : 0;
}

/* Numbers of the pieces that a surface consists of, by triangle; how many. */
static uint32_t number_pieces(const Scene *s, uint32_t *piece)
{
    const MesoWalkGround *walk = &s->surface.ground.walk;
    uint32_t count = 0, waiting = 0;
    uint32_t *stack = malloc(walk->triangle_count * sizeof *stack);
    CHECK(stack);
    memset(piece, 0xff, walk->triangle_count * sizeof *piece);
    for (uint32_t t = 0; t < walk->triangle_count; t++) {
        if (piece[t] != MESO_NO_INDEX)
            continue;
        piece[t] = count++;
        for (stack[waiting++] = t; waiting > 0;) {
            const MesoWalkFace *face = &walk->faces[stack[--waiting]];
            for (uint32_t k = 0; k < 3; k++)
                if (face->twins[k] != MESO_NO_INDEX && piece[face->twins[k] / 3] == MESO_NO_INDEX) {
                    piece[face->twins[k] / 3] = count - 1;
                    stack[waiting++] = face->twins[k] / 3;
                }
        }
    }
    free(stack);
    return count;
}

/* The points of the axes of the elements on one piece of the surface, and the nearest of that piece. */
typedef struct Axes {
    uint32_t count;
    uint32_t *elements;
    MesoVec3 *points;           /* [count * (SAMPLES + 1)] */
    MesoMeshPoint *near;
} Axes;

static Axes axes_on(const Scene *s, MesoArena *arena, const uint32_t *piece, uint32_t number)
{
    const MesoGrown *g = &s->grown;
    const MesoTriangulation *mesh = &s->surface.mesh;
    Axes axes = {0, MESO_NEW(arena, uint32_t, g->element_count, NULL),
                 MESO_NEW(arena, MesoVec3, (size_t)g->element_count * (SAMPLES + 1), NULL),
                 MESO_NEW(arena, MesoMeshPoint, (size_t)g->element_count * (SAMPLES + 1), NULL)};
    uint32_t *corners = MESO_NEW(arena, uint32_t, 3 * (size_t)mesh->triangle_count, NULL);
    uint32_t *own = MESO_NEW(arena, uint32_t, mesh->triangle_count, NULL), own_count = 0;
    CHECK(axes.elements && axes.points && axes.near && corners && own);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (piece[t] == number) {
            memcpy(&corners[3 * (size_t)own_count], &mesh->corners[3 * (size_t)t], 3 * sizeof *corners);
            own[own_count++] = t;
        }
    for (uint32_t i = 0; i < g->element_count; i++) {
        const MesoSpan *span = &g->elements[i].span;
        if (piece[g->points[span->from].triangle] != number)
            continue;
        for (uint32_t k = 0; k <= SAMPLES; k++)
            axes.points[axes.count * (SAMPLES + 1) + k] =
                meso_bend_frame(&g->joints[span->from], &g->joints[span->to], (float)k / SAMPLES).origin;
        axes.elements[axes.count++] = i;
    }
    MesoTriangulation part = *mesh;
    part.corners = corners;
    part.triangle_count = own_count;
    uint32_t total = axes.count * (SAMPLES + 1);
    CHECK(meso_growth_snap(&part, arena, axes.points, total, axes.near, 1, NULL) == MESO_OK);
    for (uint32_t i = 0; i < total; i++)
        axes.near[i].triangle = own[axes.near[i].triangle];
    return axes;
}

/* Elements whose axes are below the piece of surface that they are on by more than a hundredth of their lengths. Pieces
 * may lie in one another, as those of the teapot do. */
static uint32_t count_deep(const Scene *s)
{
    const MesoGrown *g = &s->grown;
    MesoArena arena;
    meso_arena_init(&arena);
    uint32_t *piece = MESO_NEW(&arena, uint32_t, s->surface.mesh.triangle_count, NULL);
    CHECK(piece);
    uint32_t count = 0;
    for (uint32_t number = number_pieces(s, piece); number-- > 0;) {
        Axes axes = axes_on(s, &arena, piece, number);
        for (uint32_t i = 0; i < axes.count; i++) {
            const MesoSpan *span = &g->elements[axes.elements[i]].span;
            MesoVec3 chord = meso_vec3_sub(g->joints[span->to].position, g->joints[span->from].position);
            float length = meso_vec3_length(chord);
            float depth = 0;
            for (uint32_t k = i * (SAMPLES + 1); k < (i + 1) * (SAMPLES + 1); k++)
                depth = fmaxf(depth, depth_at(s, axes.points[k], &axes.near[k]));
            count += depth > 0.01f * length;
        }
    }
    meso_arena_release(&arena);
    return count;
}

/* ---- clearance ---- */

enum { MOST_STEPS = 8000, PLACES = 8 };

/* A step that was to be clear of what had grown before it. */
typedef struct Step {
    uint64_t key;
    uint32_t root;              /* branch of its seed */
    uint32_t triangle, piece;   /* that it ends on */
    float clear, length;
    MesoVec3 places[PLACES + 1];
} Step;

typedef struct Steps {
    const Scene *scene;
    uint32_t count;
    Step steps[MOST_STEPS];
} Steps;

/* Its way, walked back from its end. */
static void note_step(void *context, const MesoGrowthEvent *event)
{
    Steps *steps = context;
    const MesoGrowthGround *ground = &steps->scene->surface.ground;
    const double *values = event->command->values;
    if (!event->accepted || event->command->order != MESO_GROWTH_STEP || !(values[MESO_GROWTH_CLEAR] > 0))
        return;
    CHECK(steps->count < MOST_STEPS);
    Step *step = &steps->steps[steps->count++];
    *step = (Step){.key = event->key, .clear = (float)values[MESO_GROWTH_CLEAR],
                   .length = (float)values[MESO_GROWTH_AMOUNT], .triangle = event->tip.triangle};
    MesoWalk walk = {.tip = event->tip};
    meso_tip_turn(&walk.tip, MESO_PI - 0.5 * values[MESO_GROWTH_ANGLE]);
    for (uint32_t k = 0; k <= PLACES; k++) {
        step->places[k] = meso_growth_position(ground, walk.tip.triangle, walk.tip.weight);
        walk.length = values[MESO_GROWTH_AMOUNT] / PLACES;
        meso_walks(&ground->walk, &walk, 1, &(MesoWalkOptions){0});
    }
}

static void find_roots(const Scene *s, Steps *steps)
{
    const MesoGrown *g = &s->grown;
    uint32_t *piece = malloc(s->surface.mesh.triangle_count * sizeof *piece);
    CHECK(piece);
    number_pieces(s, piece);
    for (uint32_t i = 0; i < steps->count; i++) {
        uint32_t b = 0;
        while (g->branches[b].key != steps->steps[i].key)
            b++;
        for (; g->branches[b].parent != MESO_NO_INDEX; b = g->branches[b].parent)
            continue;
        steps->steps[i].root = b;
        steps->steps[i].piece = piece[steps->steps[i].triangle];
    }
    free(piece);
}

static float distance(const Step *a, const Step *b)
{
    float least = INFINITY;
    if (meso_vec3_length(meso_vec3_sub(a->places[0], b->places[0])) > a->length + b->length + b->clear)
        return least;
    for (uint32_t i = 0; i <= PLACES; i++)
        for (uint32_t k = 0; k <= PLACES; k++)
            least = fminf(least, meso_vec3_length(meso_vec3_sub(a->places[i], b->places[k])));
    return least;
}

/* No step is nearer than it may be to one of another seed, on the same piece, that was there before it. */
static uint32_t check_clearances(const Scene *s, Steps *steps)
{
    uint32_t near = 0;
    find_roots(s, steps);
    for (uint32_t i = 0; i < steps->count; i++)
        for (uint32_t k = 0; k < i; k++) {
            const Step *step = &steps->steps[i], *before = &steps->steps[k];
            if (step->root == before->root || step->piece != before->piece)
                continue;
            float apart = distance(before, step);
            CHECK(apart > 0.9999f * step->clear);
            near += apart < 2 * step->clear;
        }
    return near;
}

/* ---- paint ---- */

/* Pixels between the axes of strands and the paint that they keep to. */
static double farthest_from_paint(Scene *s)
{
    const MesoGrown *g = &s->grown;
    const MesoGrowthMap *map = &s->contexts.maps[0];
    MesoArena *arena = &s->arguments.tool.arena;
    double most = 0;
    uint32_t total = g->element_count * (SAMPLES + 1);
    MesoVec3 *points = MESO_NEW(arena, MesoVec3, total, NULL);
    MesoMeshPoint *near = MESO_NEW(arena, MesoMeshPoint, total, NULL);
    CHECK(points && near && map->domain == MESO_GROWTH_BY_IMAGE);
    for (uint32_t i = 0; i < total; i++) {
        const MesoSpan *span = &g->elements[i / (SAMPLES + 1)].span;
        points[i] = meso_bend_frame(&g->joints[span->from], &g->joints[span->to],
                                    (float)(i % (SAMPLES + 1)) / SAMPLES).origin;
    }
    CHECK(meso_growth_snap(&s->surface.mesh, arena, points, total, near, 1, NULL) == MESO_OK);
    for (uint32_t i = 0; i < total; i++) {
        const double weight[3] = {(double)near[i].weight[0], (double)near[i].weight[1], (double)near[i].weight[2]};
        if (!is_strand(s, &g->elements[i / (SAMPLES + 1)]) ||
            meso_map_value(&s->surface.ground, map, near[i].triangle, weight) > 0.5)
            continue;
        double x = 0, y = 0, least = 9;
        for (uint32_t k = 0; k < 3; k++) {
            x += weight[k] * (double)map->uvs[3 * (size_t)near[i].triangle + k].x * map->image.width;
            y += weight[k] * (double)map->uvs[3 * (size_t)near[i].triangle + k].y * map->image.height;
        }
        for (int row = (int)y - 3; row <= (int)y + 3; row++)
            for (int column = (int)x - 3; column <= (int)x + 3; column++) {
                int64_t width = map->image.width, height = map->image.height;
                if (row < 0 || row >= height ||
                    map->image.pixels[(height - 1 - row) * width + (column + width) % width] <= 0.5f)
                    continue;
                double dx = fmax(fmax(column - x, x - column - 1), 0), dy = fmax(fmax(row - y, y - row - 1), 0);
                least = fmin(least, hypot(dx, dy));
            }
        most = fmax(most, least);
    }
    return most;
}

static void test_paint(void)
{
    Scene s;
    grow(&s, "painted", make_surface("column"));
    MesoGrowthOptions options = options_of(&s);
    finish(&s, &options);
    CHECK(s.grown.element_count > 1000 && farthest_from_paint(&s) <= 1);
    release(&s);
}

/* ---- all of them ---- */

static uint32_t deep, met, near;

static void test_scene(const char *grammar, const char *surface)
{
    static Steps steps;
    Scene s;
    grow(&s, grammar, surface);
    steps.scene = &s;
    steps.count = 0;
    MesoGrowthOptions options = options_of(&s);
    options.event = note_step;
    options.context = &steps;
    finish(&s, &options);
    CHECK(s.grown.element_count > 400);
    met += check_successors(&s);
    near += check_clearances(&s, &steps);
    deep += count_deep(&s);
    release(&s);
}

int main(void)
{
    static const char *const surfaces[] = {"vase", "teapot", "mask", "torus_knot"};
    static const char *const grammars[] = {"ivy", "lace", "cracks", "scales", "feathers", "chains", "coral"};
    folder = test_folder_make();
    for (uint32_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++) {
        const char *surface = make_surface(surfaces[i]);
        for (uint32_t k = 0; k < sizeof grammars / sizeof *grammars; k++)
            test_scene(grammars[k], surface);
    }
    CHECK(met > 10000 && near > 100 && deep == 0);
    test_paint();
    test_folder_remove(&folder);
    return 0;
}
