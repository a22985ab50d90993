#include "libcore/growth/scene/growth_scene.h"

#include <string.h>

enum { BRANCH, RULE, SHAPE, GENERATION, CHANNELS };

/* Elements of one branch and shape: a body. */
typedef struct Run {
    uint32_t shape, begin, count;   /* of the sorted elements */
} Run;

typedef struct Showing {
    const MesoGrown *grown;
    const MesoGrammar *grammar;
    const MesoGrowthShapes *shapes;
    uint32_t *order;            /* elements with shapes, by shape, then by branch, then as they have grown */
    MesoSpan *spans;            /* theirs, in that order */
    uint32_t *shape_begin;      /* [shape count + 1] into it */
    Run *runs;
    uint32_t run_count;
    MesoVec3 *positions, *normals;
    bool tinted;                /* any element, shown or not */
    MesoMeshColor *colors;      /* NULL where nothing is tinted */
    MesoBox box;
    size_t *vertex_begin;       /* [shape count + 1] */
    MesoBody *patterns;         /* [shape count] corners and uvs of the longest run; others have the first of them */
} Showing;

/* ---- order ---- */

/* From how many there are of each key, at `begin` + 1, to where each key's begin. */
static void add_up(uint32_t *begin, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++)
        begin[k + 1] += begin[k];
}

/* Elements with shapes by branch; `begin` [branch count + 1], 0, is scratch. Their number. */
static uint32_t sort_by_branch(Showing *s, uint32_t *begin, uint32_t *out)
{
    const MesoGrown *grown = s->grown;
    for (uint32_t i = 0; i < grown->element_count; i++) {
        const MesoGrowthElement *element = &grown->elements[i];
        begin[element->branch + 1] += element->shape != MESO_NO_INDEX;
        s->tinted |= element->tint != 0;
    }
    add_up(begin, grown->branch_count);
    for (uint32_t i = 0; i < grown->element_count; i++)
        if (grown->elements[i].shape != MESO_NO_INDEX)
            out[begin[grown->elements[i].branch]++] = i;
    return grown->branch_count ? begin[grown->branch_count - 1] : 0;
}

/* By shape, in the same order otherwise. */
static void sort_by_shape(Showing *s, const uint32_t *order, uint32_t element_count)
{
    const MesoGrowthElement *elements = s->grown->elements;
    uint32_t count = s->shapes->count, *begin = s->shape_begin;
    for (uint32_t i = 0; i < element_count; i++)
        begin[elements[order[i]].shape + 1]++;
    add_up(begin, count);
    for (uint32_t i = 0; i < element_count; i++)
        s->order[begin[elements[order[i]].shape]++] = order[i];
    memmove(begin + 1, begin, count * sizeof *begin);
    begin[0] = 0;
}

static MesoStatus put_in_order(Showing *s, MesoArena *arena, MesoArena *scratch, MesoError *error)
{
    const MesoGrown *grown = s->grown;
    uint32_t shapes = s->shapes->count, branches = grown->branch_count;
    uint32_t *begin = MESO_NEW(scratch, uint32_t, (size_t)branches + 1, error);
    s->order = MESO_NEW(scratch, uint32_t, grown->element_count, error);
    uint32_t *by_branch = shapes > 1 ? MESO_NEW(scratch, uint32_t, grown->element_count, error) : s->order;
    s->shape_begin = MESO_NEW(scratch, uint32_t, (size_t)shapes + 1, error);
    s->vertex_begin = MESO_NEW(scratch, size_t, (size_t)shapes + 1, error);
    s->patterns = MESO_NEW(arena, MesoBody, shapes, error);
    if (!begin || !s->order || !by_branch || !s->shape_begin || !s->vertex_begin || !s->patterns)
        return MESO_ERR_MEMORY;
    uint32_t count = sort_by_branch(s, begin, by_branch);
    if (shapes > 1)
        sort_by_shape(s, by_branch, count);
    else
        s->shape_begin[shapes] = count;
    for (uint32_t k = 0; k < shapes; k++)
        s->vertex_begin[k + 1] = s->vertex_begin[k] + (size_t)(s->shape_begin[k + 1] - s->shape_begin[k]) *
                                                          s->shapes->shapes[k].body.vertex_count;
    return MESO_OK;
}

static MesoStatus find_runs(Showing *s, MesoArena *scratch, MesoError *error)
{
    enum { AHEAD = 16 };
    const MesoGrowthElement *elements = s->grown->elements;
    uint32_t count = s->shape_begin[s->shapes->count], shape = MESO_NO_INDEX, branch = MESO_NO_INDEX;
    s->spans = MESO_NEW(scratch, MesoSpan, count, error);
    s->runs = MESO_NEW(scratch, Run, count, error);
    if (!s->runs || !s->spans)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const MesoGrowthElement *element = &elements[s->order[i]];
        __builtin_prefetch(&elements[s->order[i + AHEAD < count ? i + AHEAD : i]]);
        if (shape != element->shape || branch != element->branch)
            s->runs[s->run_count++] = (Run){.shape = shape = element->shape, .begin = i};
        branch = element->branch;
        s->runs[s->run_count - 1].count++;
        s->spans[i] = element->span;
    }
    return MESO_OK;
}

/* ---- what runs have in common ---- */

static MesoStatus make_pattern(Showing *s, uint32_t shape, MesoArena *arena, MesoError *error)
{
    MesoBending bending = {.shape = &s->shapes->shapes[shape]};
    for (uint32_t i = 0; i < s->run_count; i++)
        if (s->runs[i].shape == shape && s->runs[i].count > bending.span_count)
            bending.span_count = s->runs[i].count;
    return bending.span_count ? meso_bent_body(&bending, arena, &s->patterns[shape], error) : MESO_OK;
}

static MesoStatus make_patterns(Showing *s, MesoArena *arena, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < s->shapes->count && !status; k++)
        status = make_pattern(s, k, arena, error);
    return status;
}

/* ---- vertices ---- */

static MesoStatus bend_shape(Showing *s, uint32_t shape, MesoArena *scratch, uint32_t thread_count, uint32_t *folds,
                             MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint32_t begin = s->shape_begin[shape], count = s->shape_begin[shape + 1] - begin;
    uint8_t *folded = folds ? MESO_NEW(scratch, uint8_t, count, error) : NULL;
    MesoBox *boxes = MESO_NEW(scratch, MesoBox, meso_bend_box_count(count), error);
    if (!boxes || (folds && !folded))
        return MESO_ERR_MEMORY;
    MesoBending bending = {&s->shapes->shapes[shape], s->grown->joints, count, s->spans + begin,
                           s->positions + s->vertex_begin[shape], s->normals + s->vertex_begin[shape], folded, boxes};
    meso_bend(&bending, thread_count);
    for (uint32_t i = 0; i < meso_bend_box_count(count); i++) {
        meso_box_add(&s->box, boxes[i].low);
        meso_box_add(&s->box, boxes[i].high);
    }
    for (uint32_t i = 0; folds && i < count; i++)
        *folds += folded[i];
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

static uint8_t to_byte(float x)
{
    return (uint8_t)(fminf(fmaxf(x, 0), 1) * 255 + 0.5f);
}

/* From white at 0 to autumn at 1. */
static MesoMeshColor color_of(float tint)
{
    float t = fminf(fmaxf(tint, 0), 1);
    return (MesoMeshColor){to_byte(1 - 0.1f * t), to_byte(1 - 0.6f * t), to_byte(1 - 0.85f * t)};
}

static void color_shape(Showing *s, uint32_t shape)
{
    const MesoBody *body = &s->shapes->shapes[shape].body;
    MesoMeshColor *out = s->colors + s->vertex_begin[shape];
    for (uint32_t i = s->shape_begin[shape]; i < s->shape_begin[shape + 1]; i++) {
        MesoMeshColor color = color_of(s->grown->elements[s->order[i]].tint);
        for (uint32_t v = 0; v < body->vertex_count; v++, out++) {
            MesoMeshColor own = body->colors ? body->colors[v] : (MesoMeshColor){255, 255, 255};
            *out = (MesoMeshColor){(uint8_t)(own.r * color.r / 255), (uint8_t)(own.g * color.g / 255),
                                   (uint8_t)(own.b * color.b / 255)};
        }
    }
}

static MesoStatus make_vertices(Showing *s, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                                uint32_t *folds, MesoError *error)
{
    size_t total = s->vertex_begin[s->shapes->count];
    s->positions = MESO_NEW(arena, MesoVec3, total, error);
    s->normals = MESO_NEW(arena, MesoVec3, total, error);
    s->colors = s->tinted ? MESO_NEW(arena, MesoMeshColor, total, error) : NULL;
    if (!s->positions || !s->normals || (!s->colors && s->tinted))
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < s->shapes->count; k++) {
        MesoStatus status = bend_shape(s, k, scratch, thread_count, folds, error);
        if (status)
            return status;
        if (s->colors)
            color_shape(s, k);
    }
    return MESO_OK;
}

/* ---- the scene ---- */

static MesoBody body_of(const Showing *s, const Run *run)
{
    const MesoBody *one = &s->shapes->shapes[run->shape].body;
    size_t first = s->vertex_begin[run->shape] +
                   (size_t)(run->begin - s->shape_begin[run->shape]) * one->vertex_count;
    MesoBody body = s->patterns[run->shape];
    body.vertex_count = run->count * one->vertex_count;
    body.face_count = run->count * one->face_count;
    body.positions = s->positions + first;
    body.normals = s->normals + first;
    if (s->colors)
        body.colors = s->colors + first;
    return body;
}

static MesoStatus set_bodies(MesoScene *scene, const Showing *s, MesoArena *arena, MesoError *error)
{
    uint32_t count = s->run_count;
    scene->body_count = scene->placed_count = scene->id_row_count = count;
    scene->bodies = MESO_NEW(arena, MesoBody, count, error);
    scene->placed = MESO_NEW(arena, MesoPlacedBody, count, error);
    scene->ids = MESO_NEW(arena, uint32_t, CHANNELS * (size_t)count, error);
    if (!scene->bodies || !scene->placed || !scene->ids)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const Run *run = &s->runs[i];
        const MesoGrowthElement *first = &s->grown->elements[s->order[run->begin]];
        const uint32_t row[CHANNELS] = {first->branch, first->rule, first->shape, first->generation};
        scene->bodies[i] = body_of(s, run);
        scene->placed[i] = (MesoPlacedBody){.body = i, .material = s->shapes->material_of[run->shape], .ids = i};
        memcpy(&scene->ids[CHANNELS * (size_t)i], row, sizeof row);
    }
    return MESO_OK;
}

static MesoStatus set_channels(MesoScene *scene, const Showing *s, MesoArena *arena, MesoError *error)
{
    uint32_t rules = s->grammar->rule_count, shapes = s->shapes->count;
    const char **rule_names = MESO_NEW(arena, const char *, rules, error);
    const char **shape_names = MESO_NEW(arena, const char *, shapes, error);
    if (!rule_names || !shape_names)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < rules; i++)
        rule_names[i] = s->grammar->rules[i].name;
    for (uint32_t i = 0; i < shapes; i++)
        shape_names[i] = s->shapes->names[i];
    scene->channel_count = CHANNELS;
    scene->channels[BRANCH] = (MesoIdChannel){"branch", s->grown->branch_count, NULL};
    scene->channels[RULE] = (MesoIdChannel){"rule", rules, rule_names};
    scene->channels[SHAPE] = (MesoIdChannel){"shape", shapes, shape_names};
    scene->channels[GENERATION] = (MesoIdChannel){"generation", s->grown->generation_count, NULL};
    return MESO_OK;
}

/* Copies: the arrays of a scene may be written to. */
static MesoStatus set_materials(MesoScene *scene, const MesoGrowthShapes *shapes, MesoArena *arena, MesoError *error)
{
    uint32_t count = shapes->material_count;
    scene->material_count = count;
    scene->materials = MESO_NEW(arena, MesoMaterial, count, error);
    scene->material_names = MESO_NEW(arena, const char *, count, error);
    if (!scene->materials || !scene->material_names)
        return MESO_ERR_MEMORY;
    if (count) {
        memcpy(scene->materials, shapes->materials, count * sizeof *scene->materials);
        memcpy(scene->material_names, shapes->material_names, count * sizeof *scene->material_names);
    }
    return MESO_OK;
}

/* Many arrays of some hundred KiB. */
static void reserve_order(const MesoGrown *grown, MesoArena *scratch)
{
    meso_arena_reserve(scratch, grown->element_count * (2 * sizeof(uint32_t) + sizeof(MesoSpan)) +
                                    grown->branch_count * (sizeof(uint32_t) + sizeof(Run)));
}

/* Positions and normals come first: what is a little over shares their last page. */
static void reserve_bodies(const Showing *s, MesoArena *arena)
{
    meso_arena_reserve(arena, s->vertex_begin[s->shapes->count] * (2 * sizeof(MesoVec3) + sizeof(MesoMeshColor)) +
                                  s->run_count * (sizeof(MesoBody) + sizeof(MesoPlacedBody) +
                                                  CHANNELS * sizeof(uint32_t)));
}

static MesoStatus show(MesoScene *scene, Showing *s, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                       uint32_t *folds, MesoError *error)
{
    reserve_order(s->grown, scratch);
    MesoStatus status = put_in_order(s, arena, scratch, error);
    if (!status)
        status = find_runs(s, scratch, error);
    if (!status)
        reserve_bodies(s, arena);
    if (!status)
        status = make_patterns(s, arena, error);
    if (!status)
        status = make_vertices(s, arena, scratch, thread_count, folds, error);
    scene->box = s->box;
    if (!status)
        status = set_bodies(scene, s, arena, error);
    if (!status)
        status = set_channels(scene, s, arena, error);
    if (!status)
        status = set_materials(scene, s->shapes, arena, error);
    return status;
}

MesoStatus meso_growth_show(MesoScene *scene, MesoArena *arena, const MesoGrown *grown, const MesoGrammar *grammar,
                            const MesoGrowthShapes *shapes, uint32_t thread_count, uint32_t *folds, MesoError *error)
{
    Showing showing = {.grown = grown, .grammar = grammar, .shapes = shapes, .box = meso_box_empty()};
    MesoArena scratch;
    *scene = (MesoScene){0};
    if (folds)
        *folds = 0;
    meso_arena_init(&scratch);
    MesoStatus status = show(scene, &showing, arena, &scratch, thread_count, folds, error);
    meso_arena_release(&scratch);
    return status;
}
