#include "libcore/quilt/embed/quilt_normals.h"

#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/mesh/cut/triangulation.h"

enum { GRAIN = 16 };

/* cos 65 degrees: strands of six sides, 60 degrees from one to the next, are meant to be round. */
static const float SHARP = 0.4226183f;

typedef struct Work {
    MesoQuiltNormals *normals;
    const MesoQuilt *quilt;
    const MesoSwatch *swatch;
    const MesoVec3 *positions;
    uint8_t *sharp;             /* [triangle_count of the swatch] bit k: side k is an edge */
    uint32_t *corner_begin;     /* [vertex_count + 1] of `corners_at` */
    uint32_t *corners_at;       /* [3 * triangle_count] corners by vertex */
    uint32_t *leaving;          /* [vertex_count] place in that list of the corner whose side leads here */
    uint32_t *parents;          /* [3 * triangle_count] of places in the list of a vertex, as disjoint sets */
} Work;

static MesoVec3 area_vector(const MesoVec3 *positions, const uint32_t *corners)
{
    MesoVec3 a = positions[corners[0]];
    return meso_vec3_cross(meso_vec3_sub(positions[corners[1]], a), meso_vec3_sub(positions[corners[2]], a));
}

/* Turned against each other so far that the edge between them shows. */
static bool are_sharp(const MesoVec3 *positions, const uint32_t *x, const uint32_t *y)
{
    MesoVec3 a = meso_vec3_direction(area_vector(positions, x), (MesoVec3){0, 0, 0});
    MesoVec3 b = meso_vec3_direction(area_vector(positions, y), a);
    return meso_vec3_dot(a, a) > 0 && meso_vec3_dot(a, b) < SHARP;
}

/* ---- edges ---- */

/* False where the swatch has no edges at all. */
static bool find_sharp(const Work *w)
{
    const MesoSwatch *swatch = w->swatch;
    bool any = false;
    for (uint32_t h = 0; h < 3 * swatch->triangle_count; h++) {
        uint32_t twin = swatch->twins[h];
        if (twin == MESO_NO_INDEX ||
            !are_sharp(swatch->positions, &swatch->corners[h - h % 3], &swatch->corners[twin - twin % 3]))
            continue;
        w->sharp[h / 3] |= (uint8_t)(1 << h % 3);
        any = true;
    }
    return any;
}

/* Whether there is an edge between two neighbours of the quilt. */
static bool is_edge(const Work *w, uint32_t triangle, uint32_t other)
{
    const MesoSwatch *swatch = w->swatch;
    uint32_t x = w->quilt->triangle_origins[triangle], y = w->quilt->triangle_origins[other];
    if (x == y || !w->sharp[x] || !w->sharp[y])
        return false;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t twin = swatch->twins[3 * x + k];
        if (twin != MESO_NO_INDEX && twin / 3 == y)
            return w->sharp[x] >> k & 1;
    }
    const uint32_t *corners = w->quilt->corners;
    return are_sharp(w->positions, &corners[3 * (size_t)triangle], &corners[3 * (size_t)other]);
}

/* ---- groups ---- */

static void list_corners(const Work *w)
{
    const MesoQuilt *quilt = w->quilt;
    uint32_t total = 0;
    for (uint32_t c = 0; c < 3 * quilt->triangle_count; c++)
        w->corner_begin[quilt->corners[c]]++;
    for (uint32_t v = 0; v <= quilt->vertex_count; v++) {
        uint32_t count = w->corner_begin[v];
        w->corner_begin[v] = total;
        total += count;
    }
    for (uint32_t c = 0; c < 3 * quilt->triangle_count; c++)
        w->corners_at[w->corner_begin[quilt->corners[c]]++] = c;
    for (uint32_t v = quilt->vertex_count; v > 0; v--)
        w->corner_begin[v] = w->corner_begin[v - 1];
    w->corner_begin[0] = 0;
}

static uint32_t root_of(const uint32_t *parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i];
    return i;
}

/* Groups at one vertex, numbered by their first corners. Returns how many. */
static uint32_t group_corners(const Work *w, uint32_t vertex)
{
    const uint32_t *corners = w->quilt->corners, *at = w->corners_at + w->corner_begin[vertex];
    uint32_t count = w->corner_begin[vertex + 1] - w->corner_begin[vertex], groups = 0;
    uint32_t *parents = w->parents + w->corner_begin[vertex], *local = w->normals->local;
    for (uint32_t i = 0; i < count; i++) {
        parents[i] = i;
        w->leaving[corners[meso_next_corner(at[i])]] = i;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t other = w->leaving[corners[meso_previous_corner(at[i])]];
        if (other == MESO_NO_INDEX || is_edge(w, at[i] / 3, at[other] / 3))
            continue;
        uint32_t x = root_of(parents, i), y = root_of(parents, other);
        parents[x > y ? x : y] = x > y ? y : x;
    }
    for (uint32_t i = 0; i < count; i++) {
        w->leaving[corners[meso_next_corner(at[i])]] = MESO_NO_INDEX;
        local[at[i]] = parents[i] == i ? groups++ : local[at[root_of(parents, i)]];
    }
    return groups;
}

static void group_elements(void *context, uint64_t begin, uint64_t end)
{
    const Work *w = context;
    for (uint32_t v = w->quilt->vertex_begin[begin]; v < w->quilt->vertex_begin[end]; v++)
        w->normals->group_begin[v] = group_corners(w, v);
}

static MesoStatus find_groups(Work *w, MesoArena *arena, MesoArena *scratch, uint32_t thread_count, MesoError *error)
{
    const MesoQuilt *quilt = w->quilt;
    const size_t corner_count = 3 * (size_t)quilt->triangle_count;
    w->corner_begin = MESO_NEW(scratch, uint32_t, (size_t)quilt->vertex_count + 1, error);
    w->corners_at = MESO_NEW(scratch, uint32_t, corner_count, error);
    w->parents = MESO_NEW(scratch, uint32_t, corner_count, error);
    w->leaving = MESO_NEW(scratch, uint32_t, quilt->vertex_count, error);
    w->normals->local = MESO_NEW(arena, uint32_t, corner_count, error);
    if (!w->corner_begin || !w->corners_at || !w->parents || !w->leaving || !w->normals->local)
        return MESO_ERR_MEMORY;
    memset(w->leaving, 0xff, quilt->vertex_count * sizeof *w->leaving);
    list_corners(w);
    meso_parallel_for(thread_count, quilt->element_count, GRAIN, group_elements, w);
    return MESO_OK;
}

/* ---- sums ---- */

static void sum_elements(void *context, uint64_t begin, uint64_t end)
{
    const Work *w = context;
    const MesoQuilt *quilt = w->quilt;
    const MesoQuiltNormals *n = w->normals;
    for (uint32_t t = quilt->triangle_begin[begin]; t < quilt->triangle_begin[end]; t++) {
        MesoVec3 area = area_vector(w->positions, &quilt->corners[3 * (size_t)t]);
        for (uint32_t c = 3 * t; c < 3 * t + 3; c++) {
            MesoVec3 *sum = &n->normals[meso_quilt_normal_group(n, quilt, c)];
            *sum = meso_vec3_add(*sum, area);
        }
    }
    uint32_t first = n->group_begin[quilt->vertex_begin[begin]], last = n->group_begin[quilt->vertex_begin[end]];
    for (uint32_t g = first; g < last; g++)
        n->normals[g] = meso_vec3_direction(n->normals[g], (MesoVec3){0, 0, 1});
}

static MesoStatus make_groups(Work *w, MesoArena *arena, MesoArena *scratch, uint32_t thread_count, MesoError *error)
{
    const MesoQuilt *quilt = w->quilt;
    MesoQuiltNormals *n = w->normals;
    n->group_begin = MESO_NEW(arena, uint32_t, (size_t)quilt->vertex_count + 1, error);
    w->sharp = MESO_NEW(scratch, uint8_t, w->swatch->triangle_count, error);
    if (!n->group_begin || !w->sharp)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < quilt->vertex_count; v++)
        n->group_begin[v] = 1;
    MesoStatus status = find_sharp(w) ? find_groups(w, arena, scratch, thread_count, error) : MESO_OK;
    for (uint32_t v = 0; v <= quilt->vertex_count; v++) {
        uint32_t count = n->group_begin[v];
        n->group_begin[v] = n->group_count;
        n->group_count += count;
    }
    return status;
}

MesoStatus meso_quilt_normals(MesoQuiltNormals *normals, MesoArena *arena, const MesoQuilt *quilt,
                              const MesoSwatch *swatch, const MesoVec3 *positions, uint32_t thread_count,
                              MesoError *error)
{
    Work w = {.normals = normals, .quilt = quilt, .swatch = swatch, .positions = positions};
    MesoArena scratch;
    *normals = (MesoQuiltNormals){0};
    meso_arena_init(&scratch);
    MesoStatus status = make_groups(&w, arena, &scratch, thread_count, error);
    normals->normals = status ? NULL : MESO_NEW(arena, MesoVec3, normals->group_count, error);
    if (!status && !normals->normals)
        status = MESO_ERR_MEMORY;
    if (!status)
        meso_parallel_for(thread_count, quilt->element_count, GRAIN, sum_elements, &w);
    meso_arena_release(&scratch);
    return status;
}
