#include "formats/mesh_window.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json_text.h"
#include "libcore/base/parallel.h"

enum { SCRATCH_ALIGNMENT = 64, BOUNDS_VERTICES = 1 << 14 };

/* A range of parts, and the memory that its bytes go to. */
typedef struct Chunk {
    uint32_t begin, end;
    size_t size;        /* bytes formatted */
    uint8_t *data;
} Chunk;

typedef struct Window {
    uint32_t chunk_count;
    Chunk *chunks;      /* [chunk capacity of the run] */
} Window;

typedef struct Run {
    MesoMeshStream *stream;
    const MesoMeshPass *pass;
    Window *filling, *full;
    MesoStatus status;
    MesoError error;
} Run;

static uint64_t round_up(uint64_t size)
{
    return (size + SCRATCH_ALIGNMENT - 1) & ~(uint64_t)(SCRATCH_ALIGNMENT - 1);
}

static uint64_t text_bound(const MesoMeshPass *pass, const MesoTessellation *t, uint32_t begin,
                           uint32_t end)
{
    uint64_t vertices = t->vertex_begin[end] - t->vertex_begin[begin];
    uint64_t faces = t->face_begin[end] - t->face_begin[begin];
    return round_up((uint64_t)(end - begin) * pass->part_bytes + vertices * pass->vertex_bytes +
                    faces * pass->face_bytes);
}

static uint64_t chunk_bound(const MesoMeshPass *pass, const MesoTessellation *t, uint32_t begin,
                            uint32_t end)
{
    uint64_t vertices = t->vertex_begin[end] - t->vertex_begin[begin];
    uint64_t faces = t->face_begin[end] - t->face_begin[begin];
    return text_bound(pass, t, begin, end) + round_up(vertices * pass->vertex_scratch) +
           round_up(faces * pass->face_scratch);
}

/* Item 0 writes the full window; the others format a chunk of the one that is being filled. */
static void run_item(void *context, uint64_t begin, uint64_t end)
{
    Run *run = context;
    const MesoTessellation *t = run->stream->tessellation;
    for (uint64_t item = begin; item < end; item++) {
        if (item > 0) {
            Chunk *chunk = &run->filling->chunks[item - 1];
            uint64_t text = text_bound(run->pass, t, chunk->begin, chunk->end);
            chunk->size = run->pass->format(run->pass->context, t, chunk->begin, chunk->end,
                                            chunk->data, chunk->data + text);
            assert(chunk->size <= text);
            continue;
        }
        for (uint32_t i = 0; i < run->full->chunk_count && run->status == MESO_OK; i++) {
            const Chunk *chunk = &run->full->chunks[i];
            run->status = meso_output_write_at(run->stream->output, run->stream->offset,
                                               chunk->data, chunk->size, &run->error);
            run->stream->offset += chunk->size;
        }
    }
}

static uint64_t largest_part(const MesoMeshPass *pass, const MesoTessellation *t)
{
    uint64_t largest = 0;
    for (uint32_t part = 0; part < t->part_count; part++) {
        uint64_t bound = chunk_bound(pass, t, part, part + 1);
        largest = bound > largest ? bound : largest;
    }
    return largest;
}

static MesoStatus make_window(Window *window, MesoArena *arena, uint32_t chunk_count,
                              uint64_t capacity, MesoError *error)
{
    window->chunk_count = 0;
    window->chunks = MESO_NEW(arena, Chunk, chunk_count, error);
    uint8_t *data = window->chunks ? meso_arena_alloc(arena, chunk_count, capacity, error) : NULL;
    if (!data)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < chunk_count; i++)
        window->chunks[i].data = data + i * capacity;
    return MESO_OK;
}

/* Gives each chunk as many parts as its memory holds, at least one; returns the first part left. */
static uint32_t cut_window(Window *window, uint32_t chunk_capacity, uint64_t capacity,
                           const MesoMeshPass *pass, const MesoTessellation *t, uint32_t part)
{
    window->chunk_count = 0;
    while (window->chunk_count < chunk_capacity && part < t->part_count) {
        Chunk *chunk = &window->chunks[window->chunk_count++];
        chunk->begin = part++;
        while (part < t->part_count && chunk_bound(pass, t, chunk->begin, part + 1) <= capacity)
            part++;
        chunk->end = part;
    }
    return part;
}

static void report(const MesoMeshStream *stream, uint64_t work, uint32_t part)
{
    const MesoMeshWriteOptions *options = stream->options;
    uint64_t part_count = stream->tessellation->part_count;
    double share = part_count ? (double)part / (double)part_count : 1;
    if (options->progress)
        options->progress(options->progress_context, stream->done + (uint64_t)(share * (double)work),
                          stream->total);
}

static MesoStatus run_windows(Run *run, Window windows[2], uint32_t chunk_capacity,
                              uint64_t capacity, uint64_t work)
{
    const MesoTessellation *t = run->stream->tessellation;
    uint32_t threads = run->stream->options->thread_count;
    uint32_t part = 0;
    run->filling = &windows[0];
    run->full = &windows[1];
    do {
        part = cut_window(run->filling, chunk_capacity, capacity, run->pass, t, part);
        meso_parallel_for(threads, (uint64_t)run->filling->chunk_count + 1, 1, run_item, run);
        Window *full = run->filling;
        run->filling = run->full;
        run->full = full;
        report(run->stream, work, part);
    } while (run->status == MESO_OK && run->full->chunk_count > 0);
    return run->status;
}

MesoStatus meso_mesh_stream_run(MesoMeshStream *stream, const MesoMeshPass *pass, uint64_t work,
                                MesoError *error)
{
    uint64_t capacity = largest_part(pass, stream->tessellation);
    if (capacity < MESO_WINDOW_CHUNK)
        capacity = MESO_WINDOW_CHUNK;
    uint64_t chunks = MESO_WINDOW_BYTES / capacity;
    uint32_t chunk_capacity = chunks > 0 ? (uint32_t)chunks : 1;

    MesoArena arena;
    meso_arena_init(&arena);
    Window windows[2];
    Run run = {.stream = stream, .pass = pass};
    MesoStatus status = make_window(&windows[0], &arena, chunk_capacity, capacity, error);
    if (status == MESO_OK)
        status = make_window(&windows[1], &arena, chunk_capacity, capacity, error);
    if (status == MESO_OK) {
        status = run_windows(&run, windows, chunk_capacity, capacity, work);
        if (status != MESO_OK && error)
            *error = run.error;
    }
    meso_arena_release(&arena);
    stream->done += work;
    return status;
}

MesoStatus meso_mesh_check_counts(const MesoTessellation *t, const char *kind, MesoError *error)
{
    const MesoTileSet *set = &t->structure->model->tile_set;
    uint64_t vertices = t->vertex_begin[t->part_count];
    uint64_t faces = t->face_begin[t->part_count];
    if (vertices == 0 || faces == 0)
        return meso_fail(error, MESO_ERR_INPUT,
                         "no geometry to write: no tile of the assignment has sweeps or meshes");
    if (vertices > UINT32_MAX - 1 || faces > UINT32_MAX - 1)
        return meso_fail(error, MESO_ERR_LIMIT,
                         "too large for %s: %llu vertices and %llu faces, at most %u of each: "
                         "lower --divisions or raise --section-step", kind,
                         (unsigned long long)vertices, (unsigned long long)faces, UINT32_MAX - 1);
    if (set->tile_count > UINT16_MAX || meso_structure_material_count(t->structure) > UINT16_MAX)
        return meso_fail(error, MESO_ERR_LIMIT,
                         "too many names for %s: %u tiles and %u materials, at most %u of each", kind,
                         set->tile_count, meso_structure_material_count(t->structure), UINT16_MAX);
    return MESO_OK;
}

/* Boxes of ranges of parts, joined in the end. */
typedef struct Bounds {
    const MesoTessellation *tessellation;
    uint32_t *range_begin;      /* [range_count + 1] parts */
    MesoVec3 *low, *high;       /* [range_count] */
    uint32_t *bad_slot;         /* [range_count] slot of a vertex that is not finite, or MESO_NO_INDEX */
    MesoStatus *status;         /* [range_count] */
} Bounds;

static void widen(MesoVec3 *low, MesoVec3 *high, MesoVec3 p)
{
    *low = (MesoVec3){fminf(low->x, p.x), fminf(low->y, p.y), fminf(low->z, p.z)};
    *high = (MesoVec3){fmaxf(high->x, p.x), fmaxf(high->y, p.y), fmaxf(high->z, p.z)};
}

static uint32_t part_of_vertex(const MesoTessellation *t, uint32_t part, uint64_t vertex)
{
    while (t->vertex_begin[part + 1] <= vertex)
        part++;
    return part;
}

static void bound_range(const Bounds *bounds, uint64_t range, MesoMeshVertex *vertices, uint64_t count)
{
    const MesoTessellation *t = bounds->tessellation;
    uint32_t begin = bounds->range_begin[range];
    MesoVec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    meso_tessellation_vertices(t, begin, bounds->range_begin[range + 1], vertices);
    for (uint64_t i = 0; i < count; i++) {
        const MesoMeshVertex *v = &vertices[i];
        if (!meso_vec3_finite(v->position) || !meso_vec3_finite(v->normal)) {
            uint32_t part = part_of_vertex(t, begin, t->vertex_begin[begin] + i);
            bounds->bad_slot[range] = meso_tessellation_part(t, part).slot;
            return;
        }
        widen(&low, &high, v->position);
    }
    bounds->low[range] = low;
    bounds->high[range] = high;
}

static void bound_ranges(void *context, uint64_t begin, uint64_t end)
{
    const Bounds *bounds = context;
    const MesoTessellation *t = bounds->tessellation;
    for (uint64_t range = begin; range < end; range++) {
        uint64_t count = t->vertex_begin[bounds->range_begin[range + 1]] -
                         t->vertex_begin[bounds->range_begin[range]];
        MesoMeshVertex *vertices = calloc(count ? count : 1, sizeof *vertices);
        if (vertices)
            bound_range(bounds, range, vertices, count);
        else
            bounds->status[range] = MESO_ERR_MEMORY;
        free(vertices);
    }
}

/* Ranges of about BOUNDS_VERTICES; `range_begin` NULL only counts. */
static uint32_t cut_ranges(const MesoTessellation *t, uint32_t *range_begin)
{
    uint32_t count = 0;
    for (uint32_t part = 0; part < t->part_count; count++) {
        uint64_t first = t->vertex_begin[part];
        if (range_begin)
            range_begin[count] = part;
        do
            part++;
        while (part < t->part_count && t->vertex_begin[part + 1] - first <= BOUNDS_VERTICES);
        if (range_begin)
            range_begin[count + 1] = part;
    }
    return count;
}

static MesoStatus join_bounds(const Bounds *bounds, uint32_t count, MesoVec3 *low, MesoVec3 *high,
                              MesoError *error)
{
    *low = (MesoVec3){INFINITY, INFINITY, INFINITY};
    *high = (MesoVec3){-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        if (bounds->status[i] != MESO_OK)
            return meso_fail(error, bounds->status[i], "out of memory");
        if (bounds->bad_slot[i] != MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_INPUT, "slot %u: a vertex of its geometry is not finite",
                             bounds->bad_slot[i]);
        widen(low, high, bounds->low[i]);
        widen(low, high, bounds->high[i]);
    }
    return MESO_OK;
}

MesoStatus meso_mesh_bounds(const MesoTessellation *t, uint32_t thread_count, MesoVec3 *low,
                            MesoVec3 *high, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = MESO_ERR_MEMORY;
    uint32_t count = cut_ranges(t, NULL);
    Bounds bounds = {
        .tessellation = t,
        .range_begin = MESO_NEW(&arena, uint32_t, (size_t)count + 1, error),
        .low = MESO_NEW(&arena, MesoVec3, count, error),
        .high = MESO_NEW(&arena, MesoVec3, count, error),
        .bad_slot = MESO_NEW(&arena, uint32_t, count, error),
        .status = MESO_NEW(&arena, MesoStatus, count, error),
    };
    if (bounds.range_begin && bounds.low && bounds.high && bounds.bad_slot && bounds.status) {
        cut_ranges(t, bounds.range_begin);
        memset(bounds.bad_slot, 0xff, count * sizeof *bounds.bad_slot);
        meso_parallel_for(thread_count, count, 1, bound_ranges, &bounds);
        status = join_bounds(&bounds, count, low, high, error);
    }
    meso_arena_release(&arena);
    return status;
}

/* Names are UTF-8: one that was cut off within a character loses the rest of it. */
void meso_mesh_material_name(const MesoTessellation *t, uint32_t material, char name[MESO_MESH_NAME])
{
    meso_structure_material_name(t->structure, material, name, MESO_MESH_NAME);
    size_t length = strlen(name);
    if (length + 1 < MESO_MESH_NAME)
        return;
    while (length > 0 && ((unsigned char)name[length - 1] & 0xc0) == 0x80)
        length--;
    if (length > 0 && (unsigned char)name[length - 1] >= 0xc0)
        length--;
    name[length] = 0;
}

static const char *names_text(json_t *names, bool complete, MesoArena *arena, MesoError *error)
{
    char *text = complete ? json_dumps(names, JSON_COMPACT) : NULL;
    const char *copy = NULL;
    if (text)
        copy = meso_arena_copy_text(arena, text, error);
    else
        meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    free(text);
    json_decref(names);
    return copy;
}

const char *meso_mesh_tile_names(const MesoTessellation *t, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &t->structure->model->tile_set;
    json_t *names = json_array();
    bool complete = names != NULL;
    for (uint32_t i = 0; complete && i < set->tile_count; i++)
        complete = json_array_append_new(names, meso_json_string(set->tiles[i].name)) == 0;
    return names_text(names, complete, arena, error);
}

const char *meso_mesh_material_names(const MesoTessellation *t, MesoArena *arena, MesoError *error)
{
    json_t *names = json_array();
    bool complete = names != NULL;
    uint32_t count = meso_structure_material_count(t->structure);
    for (uint32_t i = 0; complete && i < count; i++) {
        char name[MESO_MESH_NAME];
        meso_mesh_material_name(t, i, name);
        complete = json_array_append_new(names, meso_json_string(name)) == 0;
    }
    return names_text(names, complete, arena, error);
}

const char *meso_mesh_provenance(const MesoMeshWriteOptions *options, MesoArena *arena,
                                 MesoError *error)
{
    return options->provenance ? meso_provenance_text(options->provenance, arena, error) : "";
}

/* Some readers of PLY and OBJ take no line over 1023 bytes. */
enum { PIECE = 960 };

const char *meso_mesh_provenance_lines(const MesoMeshWriteOptions *options, const char *mark, MesoArena *arena,
                                       MesoError *error)
{
    const char *text = meso_mesh_provenance(options, arena, error);
    size_t left = text ? strlen(text) : 0, count = left / (PIECE - 3) + 1;
    char *lines = text ? MESO_NEW(arena, char, left + count * (strlen(mark) + 16) + 1, error) : NULL;
    char *out = lines;
    for (bool first = true; lines && left > 0; first = false) {
        size_t size = left < PIECE ? left : PIECE;
        while (size < left && ((unsigned char)text[size] & 0xc0) == 0x80 && size > PIECE - 3)
            size--;     /* characters stay whole */
        out += sprintf(out, "%sprovenance%s %.*s\n", mark, first ? "" : "+", (int)size, text);
        text += size;
        left -= size;
    }
    return lines;
}
