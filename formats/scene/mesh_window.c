#include "formats/scene/mesh_window.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/file/float_text.h"
#include "formats/json/json_text.h"
#include "libcore/base/parallel.h"

enum { SCRATCH_ALIGNMENT = 64 };

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

static uint64_t text_bound(const MesoMeshPass *pass, const MesoSceneParts *parts, uint32_t begin,
                           uint32_t end)
{
    uint64_t vertices = parts->vertex_begin[end] - parts->vertex_begin[begin];
    uint64_t faces = parts->face_begin[end] - parts->face_begin[begin];
    return round_up((uint64_t)(end - begin) * pass->part_bytes + vertices * pass->vertex_bytes +
                    faces * pass->face_bytes);
}

static uint64_t chunk_bound(const MesoMeshPass *pass, const MesoSceneParts *parts, uint32_t begin,
                            uint32_t end)
{
    uint64_t vertices = parts->vertex_begin[end] - parts->vertex_begin[begin];
    uint64_t faces = parts->face_begin[end] - parts->face_begin[begin];
    return text_bound(pass, parts, begin, end) + round_up(vertices * pass->vertex_scratch) +
           round_up(faces * pass->face_scratch);
}

/* Item 0 writes the full window; the others format a chunk of the one that is being filled. */
static void run_item(void *context, uint64_t begin, uint64_t end)
{
    Run *run = context;
    const MesoSceneParts *parts = run->stream->parts;
    for (uint64_t item = begin; item < end; item++) {
        if (item > 0) {
            Chunk *chunk = &run->filling->chunks[item - 1];
            uint64_t text = text_bound(run->pass, parts, chunk->begin, chunk->end);
            chunk->size = run->pass->format(run->pass->context, parts, chunk->begin, chunk->end,
                                            chunk->data, chunk->data + text);
            assert(chunk->size <= text);
            continue;
        }
        for (uint32_t i = 0; i < run->full->chunk_count && !run->status; i++) {
            const Chunk *chunk = &run->full->chunks[i];
            run->status = meso_output_write_at(run->stream->output, run->stream->offset,
                                               chunk->data, chunk->size, &run->error);
            run->stream->offset += chunk->size;
        }
    }
}

/* The next part to format, and how many are behind it. */
typedef struct Cursor {
    const MesoPartRange *ranges;
    uint32_t range_count, range, part;
    uint64_t parts_done, part_count;
} Cursor;

static uint64_t largest_part(const MesoMeshPass *pass, const MesoSceneParts *parts, const Cursor *cursor)
{
    uint64_t largest = 0;
    for (uint32_t i = 0; i < cursor->range_count; i++)
        for (uint32_t part = cursor->ranges[i].begin; part < cursor->ranges[i].end; part++) {
            uint64_t bound = chunk_bound(pass, parts, part, part + 1);
            largest = bound > largest ? bound : largest;
        }
    return largest;
}

static Cursor begin_ranges(const MesoPartRange *ranges, uint32_t count)
{
    Cursor cursor = {ranges, count, 0, count ? ranges[0].begin : 0, 0, 0};
    for (uint32_t i = 0; i < count; i++)
        cursor.part_count += ranges[i].end - ranges[i].begin;
    return cursor;
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

/* Gives a chunk as many parts of the cursor's range as its memory holds, at least one. */
static void cut_chunk(Chunk *chunk, uint64_t capacity, const MesoMeshPass *pass, const MesoSceneParts *parts,
                      Cursor *cursor)
{
    const uint32_t range_end = cursor->ranges[cursor->range].end;
    chunk->begin = cursor->part++;
    while (cursor->part < range_end && chunk_bound(pass, parts, chunk->begin, cursor->part + 1) <= capacity)
        cursor->part++;
    chunk->end = cursor->part;
    cursor->parts_done += chunk->end - chunk->begin;
}

static void cut_window(Window *window, uint32_t chunk_capacity, uint64_t capacity, const MesoMeshPass *pass,
                       const MesoSceneParts *parts, Cursor *cursor)
{
    window->chunk_count = 0;
    while (window->chunk_count < chunk_capacity && cursor->range < cursor->range_count) {
        if (cursor->part < cursor->ranges[cursor->range].end)
            cut_chunk(&window->chunks[window->chunk_count++], capacity, pass, parts, cursor);
        else if (++cursor->range < cursor->range_count)
            cursor->part = cursor->ranges[cursor->range].begin;
    }
}

static void report(const MesoMeshStream *stream, uint64_t work, const Cursor *cursor)
{
    const MesoMeshWriteOptions *options = stream->options;
    double share = cursor->part_count ? (double)cursor->parts_done / (double)cursor->part_count : 1;
    if (options->progress)
        options->progress(options->progress_context, stream->done + (uint64_t)(share * (double)work),
                          stream->total);
}

static MesoStatus run_windows(Run *run, Window windows[2], uint32_t chunk_capacity,
                              uint64_t capacity, Cursor *cursor, uint64_t work)
{
    const MesoSceneParts *parts = run->stream->parts;
    uint32_t threads = run->stream->options->thread_count;
    run->filling = &windows[0];
    run->full = &windows[1];
    do {
        cut_window(run->filling, chunk_capacity, capacity, run->pass, parts, cursor);
        meso_parallel_for(threads, (uint64_t)run->filling->chunk_count + 1, 1, run_item, run);
        Window *full = run->filling;
        run->filling = run->full;
        run->full = full;
        report(run->stream, work, cursor);
    } while (!run->status && run->full->chunk_count > 0);
    return run->status;
}

MesoStatus meso_mesh_stream_run(MesoMeshStream *stream, const MesoMeshPass *pass, uint64_t work,
                                MesoError *error)
{
    const MesoPartRange all = {0, stream->parts->part_count};
    Cursor cursor = begin_ranges(stream->ranges ? stream->ranges : &all, stream->ranges ? stream->range_count : 1);
    uint64_t capacity = largest_part(pass, stream->parts, &cursor);
    if (capacity < MESO_WINDOW_CHUNK)
        capacity = MESO_WINDOW_CHUNK;
    uint64_t chunks = MESO_WINDOW_BYTES / capacity;
    uint32_t chunk_capacity = chunks > 0 ? (uint32_t)chunks : 1;

    MesoArena arena;
    meso_arena_init(&arena);
    Window windows[2];
    Run run = {.stream = stream, .pass = pass};
    MesoStatus status = make_window(&windows[0], &arena, chunk_capacity, capacity, error);
    if (!status)
        status = make_window(&windows[1], &arena, chunk_capacity, capacity, error);
    if (!status) {
        status = run_windows(&run, windows, chunk_capacity, capacity, &cursor, work);
        if (status && error)
            *error = run.error;
    }
    meso_arena_release(&arena);
    stream->done += work;
    return status;
}

static MesoStatus check_names(const MesoScene *scene, const char *kind, MesoError *error)
{
    for (uint32_t c = 0; c < scene->channel_count; c++)
        if (scene->channels[c].names && scene->channels[c].count > UINT16_MAX)
            return meso_fail(error, MESO_ERR_LIMIT, "too many names for %s: %u %ss, at most %u", kind,
                             scene->channels[c].count, scene->channels[c].name, UINT16_MAX);
    if (scene->material_count > UINT16_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "too many names for %s: %u materials, at most %u", kind,
                         scene->material_count, UINT16_MAX);
    return MESO_OK;
}

MesoStatus meso_mesh_check_counts(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                                  const char *kind, MesoError *error)
{
    uint64_t vertices = parts->vertex_begin[parts->part_count];
    uint64_t faces = parts->face_begin[parts->part_count];
    if (vertices == 0 || faces == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no geometry to write: the scene has no sweeps and no bodies");
    if (vertices > UINT32_MAX - 1 || faces > UINT32_MAX - 1)
        return meso_fail(error, MESO_ERR_LIMIT,
                         "too large for %s: %llu vertices and %llu faces, at most %u of each%s%s", kind,
                         (unsigned long long)vertices, (unsigned long long)faces, UINT32_MAX - 1,
                         MESO_MESH_SMALLER(options));
    return check_names(parts->scene, kind, error);
}

/* Names are UTF-8: one that was cut off within a character loses the rest of it. */
void meso_mesh_material_name(const MesoScene *scene, uint32_t material, char name[MESO_MESH_NAME])
{
    snprintf(name, MESO_MESH_NAME, "%s", scene->material_names[material]);
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

const char *meso_mesh_names(const char *const *names, uint32_t count, MesoArena *arena, MesoError *error)
{
    json_t *array = json_array();
    bool complete = array != NULL;
    for (uint32_t i = 0; complete && i < count; i++)
        complete = json_array_append_new(array, meso_json_string(names[i])) == 0;
    return names_text(array, complete, arena, error);
}

const char *meso_mesh_material_names(const MesoScene *scene, MesoArena *arena, MesoError *error)
{
    json_t *array = json_array();
    bool complete = array != NULL;
    for (uint32_t i = 0; complete && i < scene->material_count; i++) {
        char name[MESO_MESH_NAME];
        meso_mesh_material_name(scene, i, name);
        complete = json_array_append_new(array, meso_json_string(name)) == 0;
    }
    return names_text(array, complete, arena, error);
}

const char *meso_mesh_names_key(const MesoIdChannel *channel, MesoArena *arena, MesoError *error)
{
    return meso_arena_print(arena, error, "%ss", channel->name);
}

/* What stands before, between and behind the lengths of all strands. */
static const char *strand_text(const MesoMeshWriteOptions *options, const char *begin, const char *mark, bool numbered,
                               const char *end, MesoArena *arena, MesoError *error)
{
    enum { NUMBER = 12 };
    size_t item = strlen(mark) + NUMBER + MESO_FLOAT_TEXT + 4;
    size_t size = strlen(begin) + options->strand_count * item + strlen(end) + 1;
    char *text = meso_arena_alloc(arena, size, 1, error), *out = text;
    if (!text)
        return NULL;
    out += sprintf(out, "%s", begin);
    for (uint32_t i = 0; i < options->strand_count; i++) {
        out += sprintf(out, "%s", i || numbered ? mark : "");
        out += numbered ? sprintf(out, "%u ", i) : 0;
        out = meso_float_text(options->strand_lengths[i], out);
        if (numbered)
            *out++ = '\n';
    }
    sprintf(out, "%s", end);
    return text;
}

const char *meso_mesh_strand_lines(const MesoMeshWriteOptions *options, const char *mark, MesoArena *arena,
                                   MesoError *error)
{
    const char *line = meso_arena_print(arena, error, "%sstrand_length ", mark);
    return line ? strand_text(options, "", line, true, "", arena, error) : NULL;
}

const char *meso_mesh_strand_array(const MesoMeshWriteOptions *options, MesoArena *arena, MesoError *error)
{
    return options->strand_count ? strand_text(options, "[", ",", false, "]", arena, error) : "";
}

const char *meso_mesh_provenance(const MesoMeshWriteOptions *options, MesoArena *arena,
                                 MesoError *error)
{
    return options->provenance ? meso_provenance_text(options->provenance, arena, error) : "";
}
