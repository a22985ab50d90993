/*
 * Looks through the geometry that a model expands to:
 *
 *     model_reference MODEL.meso...
 *
 * 1. every position and normal is finite
 * 2. across every inner edge, what one slot shows of a cross-section and what the
 *    other shows are rings of the very same floats
 * 3. every face is wound as its vertices' normals say, except where there is no
 *    one side: where a sweep bends so sharply that its inner side stands still or
 *    runs backwards (a fold), or where its profile turns inside out on the way
 *    from one end to the other; those are counted
 *
 * Prints what it counted; exit 1 if one of these does not hold.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "formats/model/model_file.h"
#include "libcore/math/bezier.h"
#include "libcore/scene/parts.h"
#include "libcore/tiling/strand/expansion.h"

/* The ring that a slot shows of one cross-section on one side, all contours. */
typedef struct Shown {
    uint32_t half, section;
    uint64_t hash;          /* of the sorted positions without repeats */
} Shown;

typedef struct Counts {
    uint64_t faces, folded, against, not_finite, met, apart;
} Counts;

/* ---- rings ---- */

static int compare_points(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(MesoVec3));
}

/* Order does not matter to the sum; repeats (seams, sharp corners) are left out of it. */
static uint64_t ring_hash(const MesoMeshVertex *ring, uint32_t count, MesoVec3 *scratch)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < count; i++)
        scratch[i] = meso_vec3_add(ring[i].position, (MesoVec3){0, 0, 0});     /* -0 is 0 */
    qsort(scratch, count, sizeof *scratch, compare_points);
    for (uint32_t i = 0; i < count; i++)
        if (i == 0 || compare_points(&scratch[i - 1], &scratch[i]) != 0)
            hash += XXH3_64bits(&scratch[i], sizeof *scratch);
    return hash;
}

static int compare_shown(const void *a, const void *b)
{
    const Shown *x = a, *y = b;
    if (x->half != y->half)
        return x->half < y->half ? -1 : 1;
    if (x->section != y->section)
        return x->section < y->section ? -1 : 1;
    return x->hash < y->hash ? -1 : x->hash > y->hash;
}

/* Several sweeps may end on one cross-section: one entry remains for each ring that differs. */
static uint32_t unique_shown(Shown *shown, uint32_t count)
{
    uint32_t kept = 0;
    qsort(shown, count, sizeof *shown, compare_shown);
    for (uint32_t i = 0; i < count; i++)
        if (kept == 0 || compare_shown(&shown[kept - 1], &shown[i]) != 0)
            shown[kept++] = shown[i];
    return kept;
}

static void compare_across(const Shown *shown, uint32_t count, const MesoSlotGraph *graph, Counts *counts)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t twin = graph->twin[shown[i].half];
        if (twin == MESO_NO_INDEX)
            continue;
        Shown other = {twin, shown[i].section, shown[i].hash};
        bool same = bsearch(&other, shown, count, sizeof other, compare_shown) != NULL;
        counts->met += same;
        counts->apart += !same;
    }
}

/* ---- faces ---- */

/* Corners 0 to 1 and 3 to 2 run along the sweep, 0 to 3 and 1 to 2 around it. */
static MesoVec3 side_of(const MesoMeshVertex *v, const MesoMeshFace *face, int from, int to)
{
    return meso_vec3_sub(v[face->v[to]].position, v[face->v[from]].position);
}

/* A face that has come to stand: less than a quarter of the way that its sweep goes there. */
static bool is_folded(const MesoScene *s, uint32_t part, const MesoSweptKind *kind,
                      const MesoMeshVertex *v, const MesoMeshFace *face)
{
    if (kind->cap)
        return false;
    float from = v[face->v[0]].uv.y, to = v[face->v[1]].uv.y;
    MesoVec3 step = meso_vec3_scale(meso_bezier_derivative(s->sweeps[part].p, 0.5f * (from + to)), to - from);
    float least = 0.25f * meso_vec3_dot(step, step);
    return meso_vec3_dot(side_of(v, face, 0, 1), step) < least ||
           meso_vec3_dot(side_of(v, face, 3, 2), step) < least ||
           meso_vec3_dot(side_of(v, face, 0, 3), side_of(v, face, 1, 2)) <= 0;
}

static bool agrees(const MesoMeshVertex *v, const MesoMeshFace *face)
{
    bool quad = face->v[3] != MESO_NO_INDEX;
    MesoVec3 diagonal = meso_vec3_sub(v[face->v[2]].position, v[face->v[0]].position);
    MesoVec3 other = meso_vec3_sub(v[face->v[quad ? 3 : 2]].position, v[face->v[1]].position);
    MesoVec3 shaded = {0, 0, 0};
    for (int k = 0; k < (quad ? 4 : 3); k++)
        shaded = meso_vec3_add(shaded, v[face->v[k]].normal);
    if (!quad)
        diagonal = meso_vec3_sub(v[face->v[1]].position, v[face->v[0]].position);
    return meso_vec3_dot(meso_vec3_cross(diagonal, other), shaded) >= 0;
}

static void look_at_part(const MesoSceneParts *t, uint32_t part, const MesoMeshVertex *v,
                         const MesoMeshFace *faces, Counts *counts)
{
    const MesoScene *s = t->scene;
    uint64_t vertex_count = t->vertex_begin[part + 1] - t->vertex_begin[part];
    uint64_t face_count = t->face_begin[part + 1] - t->face_begin[part];
    for (uint64_t i = 0; i < vertex_count; i++)
        counts->not_finite += !meso_vec3_finite(v[i].position) || !meso_vec3_finite(v[i].normal);
    for (uint64_t f = 0; f < face_count; f++) {
        counts->faces++;
        if (part < s->sweep_count &&
            is_folded(s, part, &s->kinds[meso_scene_kind(s, part)], v, &faces[f]))
            counts->folded++;
        else
            counts->against += !agrees(v, &faces[f]);
    }
}

/* ---- models ---- */

static void show_ends(const MesoSceneParts *t, const MesoModel *model, const MesoExpansion *expansion,
                      uint32_t part, const MesoMeshVertex *v, MesoVec3 *scratch, Shown *shown, uint32_t *count)
{
    const MesoScene *s = t->scene;
    const MesoSweptKind *kind = &s->kinds[meso_scene_kind(s, part)];
    const MesoKindOrigin *origin = &expansion->origins[meso_scene_kind(s, part)];
    uint32_t slot = s->sweeps[part].ids, width = kind->column_count;
    MesoTransform transform = model->assignment.transform[slot];
    for (int end = 0; end < (kind->cap ? 1 : 2); end++) {
        uint32_t side = end ? origin->end_side : origin->start_side;
        if (side >= 4)
            continue;
        const MesoMeshVertex *ring = v + (end ? (size_t)(kind->division_count - 1) * width : 0);
        shown[(*count)++] = (Shown){4 * slot + meso_transform_side(transform, side),
                                    end ? origin->end_section : origin->start_section,
                                    ring_hash(ring, width, scratch)};
    }
}

static MesoStatus look(MesoArena *arena, const MesoModel *model, Counts *counts, MesoError *error)
{
    MesoScene scene;
    MesoExpansion expansion;
    MesoSceneParts t;
    MesoStatus status = meso_model_expand(&scene, &expansion, arena, model, 0, error);
    if (!status)
        status = meso_scene_parts_init(&t, arena, &scene, error);
    if (status)
        return status;

    uint64_t most_vertices = 0, most_faces = 0;
    for (uint32_t part = 0; part < t.part_count; part++) {
        uint64_t vertices = t.vertex_begin[part + 1] - t.vertex_begin[part];
        uint64_t faces = t.face_begin[part + 1] - t.face_begin[part];
        most_vertices = vertices > most_vertices ? vertices : most_vertices;
        most_faces = faces > most_faces ? faces : most_faces;
    }
    MesoMeshVertex *v = MESO_NEW(arena, MesoMeshVertex, most_vertices, error);
    MesoMeshFace *faces = MESO_NEW(arena, MesoMeshFace, most_faces, error);
    MesoVec3 *scratch = MESO_NEW(arena, MesoVec3, most_vertices, error);
    Shown *shown = MESO_NEW(arena, Shown, 2 * (size_t)scene.sweep_count, error);
    uint32_t shown_count = 0;
    if (!v || !faces || !scratch || !shown)
        return MESO_ERR_MEMORY;
    for (uint32_t part = 0; part < t.part_count; part++) {
        meso_scene_vertices(&t, part, part + 1, v);
        meso_scene_faces(&t, part, part + 1, 0, faces);
        look_at_part(&t, part, v, faces, counts);
        if (part < scene.sweep_count)
            show_ends(&t, model, &expansion, part, v, scratch, shown, &shown_count);
    }
    compare_across(shown, unique_shown(shown, shown_count), &model->graph, counts);
    return MESO_OK;
}

int main(int argc, char **argv)
{
    bool good = argc > 1;
    for (int i = 1; i < argc; i++) {
        MesoArena arena;
        MesoInput input;
        MesoModel model;
        MesoError error;
        Counts c = {0};
        meso_arena_init(&arena);
        MesoStatus status = meso_input_open(&input, argv[i], &error);
        if (!status)
            status = meso_model_read(&model, NULL, &arena, &input, &error);
        if (!status)
            status = look(&arena, &model, &c, &error);
        if (status) {
            fprintf(stderr, "model_reference: %s\n", error.message);
            return (int)status;
        }
        printf("%s: %llu faces, %llu wound against their normals, %llu folded; rings across edges: %llu the same, "
               "%llu not; %llu vertices not finite\n", argv[i], (unsigned long long)c.faces,
               (unsigned long long)c.against, (unsigned long long)c.folded, (unsigned long long)c.met,
               (unsigned long long)c.apart, (unsigned long long)c.not_finite);
        good = good && c.faces > 0 && c.against == 0 && c.apart == 0 && c.not_finite == 0;
        meso_input_close(&input);
        meso_arena_release(&arena);
    }
    return good ? 0 : 1;
}
