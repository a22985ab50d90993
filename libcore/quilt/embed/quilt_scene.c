#include "libcore/quilt/embed/quilt_scene.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/quilt/embed/quilt_embed.h"
#include "libcore/quilt/embed/quilt_normals.h"

enum { CHANNELS = 3, GRAIN = 16 };

/* A body in the making: triangles of one element and one material. */
typedef struct Run {
    uint32_t element, material;
    uint32_t begin, end;        /* in `order` */
    uint32_t first_vertex;      /* of all bodies' vertices; until they are counted, how many it has */
} Run;

typedef struct Building {
    const MesoQuilt *quilt;
    const MesoSwatch *swatch;
    const MesoVec3 *positions;
    MesoQuiltNormals normals;
    uint32_t *order;            /* [triangle_count] triangles by element, then material, then number */
    uint32_t run_count;
    Run *runs;                  /* [run_count] */
    uint32_t *element_runs;     /* [element_count + 1] */
    uint32_t *copies;           /* [group_count] first corner of the body with that normal, or MESO_NO_INDEX */
    uint32_t *next;             /* [3 * triangle_count] first corner with the same normal and other coordinates */
    uint32_t *numbers;          /* [3 * triangle_count] vertex of the body at a corner */
    MesoVec3 *out_positions, *out_normals;
    MesoVec2 *out_uvs;
    uint32_t *out_corners;
} Building;

/* ---- bodies ---- */

static uint32_t material_of(const Building *b, uint32_t triangle)
{
    return b->swatch->materials[b->quilt->triangle_origins[triangle]];
}

typedef struct Key {
    uint32_t material, triangle;
} Key;

static int compare_keys(const void *a, const void *b)
{
    const Key *x = a, *y = b;
    if (x->material != y->material)
        return x->material < y->material ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* Most elements have one material, and are not sorted. */
static void sort_element(const Building *b, Key *keys, uint32_t begin, uint32_t end)
{
    bool sorted = true;
    for (uint32_t t = begin; t < end; t++) {
        keys[t - begin] = (Key){material_of(b, t), t};
        sorted = sorted && (t == begin || keys[t - begin - 1].material <= keys[t - begin].material);
    }
    if (!sorted)
        qsort(keys, end - begin, sizeof *keys, compare_keys);
    for (uint32_t t = begin; t < end; t++)
        b->order[t] = keys[t - begin].triangle;
}

static uint32_t run_end(const Building *b, uint32_t begin, uint32_t last)
{
    uint32_t end = begin + 1;
    while (end < last && material_of(b, b->order[end]) == material_of(b, b->order[begin]))
        end++;
    return end;
}

/* Called twice: counts, then fills. */
static uint32_t list_runs(const Building *b, Run *runs)
{
    uint32_t count = 0;
    for (uint32_t e = 0; e < b->quilt->element_count; e++) {
        uint32_t last = b->quilt->triangle_begin[e + 1];
        if (runs)
            b->element_runs[e] = count;
        for (uint32_t t = b->quilt->triangle_begin[e], end; t < last; t = end) {
            end = run_end(b, t, last);
            if (runs)
                runs[count] = (Run){e, material_of(b, b->order[t]), t, end, 0};
            count++;
        }
    }
    return count;
}

static MesoStatus make_runs(Building *b, MesoArena *scratch, MesoError *error)
{
    const MesoQuilt *quilt = b->quilt;
    uint32_t largest = 0;
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        uint32_t size = quilt->triangle_begin[e + 1] - quilt->triangle_begin[e];
        largest = size > largest ? size : largest;
    }
    Key *keys = MESO_NEW(scratch, Key, largest, error);
    b->order = MESO_NEW(scratch, uint32_t, quilt->triangle_count, error);
    b->element_runs = MESO_NEW(scratch, uint32_t, (size_t)quilt->element_count + 1, error);
    if (!keys || !b->order || !b->element_runs)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < quilt->element_count; e++)
        sort_element(b, keys, quilt->triangle_begin[e], quilt->triangle_begin[e + 1]);
    b->run_count = list_runs(b, NULL);
    b->runs = MESO_NEW(scratch, Run, b->run_count, error);
    if (!b->runs)
        return MESO_ERR_MEMORY;
    b->element_runs[quilt->element_count] = list_runs(b, b->runs);
    return MESO_OK;
}

/* ---- vertices ---- */

/* Of the swatch, where the triangle there has them; else those of the vertex that it is next to. */
static MesoVec2 uv_at(const Building *b, uint32_t corner)
{
    const MesoSwatch *swatch = b->swatch;
    uint32_t origin = b->quilt->origins[b->quilt->corners[corner]], first = 3 * b->quilt->triangle_origins[corner / 3];
    for (uint32_t k = 0; k < 3 && swatch->corner_uvs; k++)
        if (swatch->corners[first + k] == origin)
            return swatch->corner_uvs[first + k];
    return swatch->uvs ? swatch->uvs[origin] : (MesoVec2){0, 0};
}

static bool same_uv(const Building *b, uint32_t x, uint32_t y)
{
    if (!b->swatch->uvs && !b->swatch->corner_uvs)
        return true;
    MesoVec2 p = uv_at(b, x), q = uv_at(b, y);
    return memcmp(&p, &q, sizeof p) == 0;
}

/* The vertex of the body at a corner, a new one where there is none like it. */
static uint32_t number_at(const Building *b, uint32_t corner, uint32_t *count)
{
    uint32_t *at = &b->copies[meso_quilt_normal_group(&b->normals, b->quilt, corner)];
    while (*at != MESO_NO_INDEX && !same_uv(b, *at, corner))
        at = &b->next[*at];
    if (*at == MESO_NO_INDEX) {
        *at = corner;
        b->next[corner] = MESO_NO_INDEX;
        b->numbers[corner] = (*count)++;
    }
    return b->numbers[*at];
}

/* Elements have no vertex in common: each has its own part of the arrays. */
static void number_elements(void *context, uint64_t begin, uint64_t end)
{
    const Building *b = context;
    for (uint32_t r = b->element_runs[begin]; r < b->element_runs[end]; r++) {
        Run *run = &b->runs[r];
        for (uint32_t i = run->begin; i < run->end; i++)
            for (uint32_t c = 3 * b->order[i], k = 0; k < 3; k++)
                b->copies[meso_quilt_normal_group(&b->normals, b->quilt, c + k)] = MESO_NO_INDEX;
        for (uint32_t i = run->begin; i < run->end; i++)
            for (uint32_t c = 3 * b->order[i], k = 0; k < 3; k++)
                b->numbers[c + k] = number_at(b, c + k, &run->first_vertex);
    }
}

static void fill_elements(void *context, uint64_t begin, uint64_t end)
{
    const Building *b = context;
    for (uint32_t r = b->element_runs[begin]; r < b->element_runs[end]; r++)
        for (uint32_t i = b->runs[r].begin; i < b->runs[r].end; i++)
            for (uint32_t c = 3 * b->order[i], k = 0; k < 3; k++) {
                size_t vertex = (size_t)b->runs[r].first_vertex + b->numbers[c + k];
                b->out_corners[3 * (size_t)i + k] = b->numbers[c + k];
                b->out_positions[vertex] = b->positions[b->quilt->corners[c + k]];
                b->out_normals[vertex] = b->normals.normals[meso_quilt_normal_group(&b->normals, b->quilt, c + k)];
                if (b->out_uvs)
                    b->out_uvs[vertex] = uv_at(b, c + k);
            }
}

static MesoStatus make_vertices(Building *b, MesoArena *arena, MesoArena *scratch, uint32_t *vertex_count,
                                uint32_t thread_count, MesoError *error)
{
    const size_t corner_count = 3 * (size_t)b->quilt->triangle_count;
    bool mapped = b->swatch->uvs || b->swatch->corner_uvs;
    b->copies = MESO_NEW(scratch, uint32_t, b->normals.group_count, error);
    b->next = MESO_NEW(scratch, uint32_t, corner_count, error);
    b->numbers = MESO_NEW(scratch, uint32_t, corner_count, error);
    if (!b->copies || !b->next || !b->numbers)
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, b->quilt->element_count, GRAIN, number_elements, b);
    uint32_t total = 0;
    for (uint32_t r = 0; r < b->run_count; r++) {
        uint32_t count = b->runs[r].first_vertex;
        b->runs[r].first_vertex = total;
        total += count;
    }
    *vertex_count = total;
    b->out_positions = MESO_NEW(arena, MesoVec3, total, error);
    b->out_normals = MESO_NEW(arena, MesoVec3, total, error);
    b->out_uvs = mapped ? MESO_NEW(arena, MesoVec2, total, error) : NULL;
    b->out_corners = MESO_NEW(arena, uint32_t, corner_count, error);
    if (!b->out_positions || !b->out_normals || !b->out_corners || (mapped && !b->out_uvs))
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, b->quilt->element_count, GRAIN, fill_elements, b);
    return MESO_OK;
}

/* ---- the scene ---- */

static MesoStatus set_bodies(MesoScene *scene, const Building *b, uint32_t vertex_count, MesoArena *arena,
                             MesoError *error)
{
    scene->body_count = scene->placed_count = b->run_count;
    scene->bodies = MESO_NEW(arena, MesoBody, b->run_count, error);
    scene->placed = MESO_NEW(arena, MesoPlacedBody, b->run_count, error);
    if (!scene->bodies || !scene->placed)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < b->run_count; r++) {
        const Run *run = &b->runs[r];
        uint32_t end = r + 1 < b->run_count ? b->runs[r + 1].first_vertex : vertex_count;
        scene->bodies[r] = (MesoBody){
            .vertex_count = end - run->first_vertex, .face_count = run->end - run->begin, .face_width = 3,
            .positions = b->out_positions + run->first_vertex, .normals = b->out_normals + run->first_vertex,
            .uvs = b->out_uvs ? b->out_uvs + run->first_vertex : NULL,
            .corners = b->out_corners + 3 * (size_t)run->begin};
        scene->placed[r] = (MesoPlacedBody){.body = r, .material = run->material, .ids = run->element};
    }
    return MESO_OK;
}

static MesoStatus set_ids(MesoScene *scene, const MesoQuilt *quilt, const MesoSwatch *swatch, MesoArena *arena,
                          MesoError *error)
{
    uint32_t patches = 0;
    scene->id_row_count = quilt->element_count;
    scene->ids = MESO_NEW(arena, uint32_t, CHANNELS * (size_t)quilt->element_count, error);
    if (!scene->ids)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        uint32_t triangle = quilt->triangle_begin[e];
        uint32_t patch = triangle < quilt->triangle_begin[e + 1] ? quilt->patches[triangle] : 0;
        const uint32_t row[CHANNELS] = {e, patch, quilt->element_origins[e]};
        memcpy(&scene->ids[CHANNELS * (size_t)e], row, sizeof row);
        patches = patch >= patches ? patch + 1 : patches;
    }
    scene->channel_count = CHANNELS;
    scene->channels[0] = (MesoIdChannel){"element", quilt->element_count, NULL};
    scene->channels[1] = (MesoIdChannel){"patch", patches, NULL};
    scene->channels[2] = (MesoIdChannel){"swatch", swatch->element_count, NULL};
    return MESO_OK;
}

/* Copies: the arrays of a scene may be written to. */
static MesoStatus set_materials(MesoScene *scene, const MesoSwatch *swatch, MesoArena *arena, MesoError *error)
{
    uint32_t count = swatch->material_count;
    scene->material_count = count;
    scene->materials = MESO_NEW(arena, MesoMaterial, count, error);
    scene->material_names = MESO_NEW(arena, const char *, count, error);
    if (!scene->materials || !scene->material_names)
        return MESO_ERR_MEMORY;
    for (uint32_t m = 0; m < count; m++) {
        scene->materials[m] = swatch->looks[m];
        scene->material_names[m] = swatch->material_names[m];
    }
    return MESO_OK;
}

static MesoStatus build(MesoScene *scene, MesoArena *arena, MesoArena *scratch, Building *b, uint32_t thread_count,
                        MesoError *error)
{
    uint32_t vertex_count = 0;
    MesoStatus status = meso_quilt_normals(&b->normals, scratch, b->quilt, b->swatch, b->positions, thread_count,
                                           error);
    if (!status)
        status = make_runs(b, scratch, error);
    if (!status)
        status = make_vertices(b, arena, scratch, &vertex_count, thread_count, error);
    if (!status)
        status = set_bodies(scene, b, vertex_count, arena, error);
    if (!status)
        status = set_ids(scene, b->quilt, b->swatch, arena, error);
    return status ? status : set_materials(scene, b->swatch, arena, error);
}

MesoStatus meso_quilt_scene(MesoScene *scene, MesoArena *arena, const MesoQuilt *quilt, const MesoSwatch *swatch,
                            const MesoVec3 *positions, uint32_t thread_count, MesoError *error)
{
    Building b = {.quilt = quilt, .swatch = swatch, .positions = positions};
    MesoArena scratch;
    *scene = (MesoScene){0};
    if (quilt->triangle_count > (UINT32_MAX - 1) / 3)
        return meso_fail(error, MESO_ERR_LIMIT, "a quilt of %u triangles is beyond what can be shown",
                         quilt->triangle_count);
    meso_arena_init(&scratch);
    MesoStatus status = build(scene, arena, &scratch, &b, thread_count, error);
    meso_arena_release(&scratch);
    if (!status)
        meso_scene_measure(scene);
    return status;
}

MesoStatus meso_quilt_show(MesoScene *scene, MesoArena *arena, const MesoQuilt *quilt, const MesoSwatch *swatch,
                           const MesoTriangulation *base, MesoQuiltEmbedding embedding, uint32_t thread_count,
                           MesoError *error)
{
    MesoArena scratch;
    MesoQuiltHeights heights = meso_quilt_heights(quilt);
    meso_arena_init(&scratch);
    MesoVec3 *positions = MESO_NEW(&scratch, MesoVec3, quilt->vertex_count, error);
    MesoStatus status = positions ? meso_quilt_lay(positions, NULL, quilt, base, embedding, thread_count, error)
                                  : MESO_ERR_MEMORY;
    if (!status)
        status = meso_quilt_scene(scene, arena, quilt, swatch, positions, thread_count, error);
    meso_arena_release(&scratch);
    if (status)
        return status;
    scene->thickness = heights.high - heights.low;
    return MESO_OK;
}
