#include "formats/scene/mesh_window.h"

#include <assert.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/file/float_text.h"
#include "formats/json/json_text.h"
#include "libcore/base/parallel.h"

enum { SCRATCH_ALIGNMENT = 64 };

/* What one pass runs with. Each thread formats a range of parts, and writes it itself while it is in its caches. */
typedef struct Run {
    MesoMeshStream *stream;
    const MesoMeshPass *pass;
    uint64_t capacity;              /* bytes of a thread's memory */
    uint8_t *memory;                /* [threads * capacity] */
    uint32_t range_count;
    MesoPartRange *ranges;          /* [RANGES_A_WINDOW] */
    pthread_mutex_t lock;
    pthread_cond_t next;
    uint64_t turn;                  /* range whose place in the file is known */
    MesoStatus status;
    MesoError error;
} Run;

enum { RANGES_A_WINDOW = 128 };

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

/* Where the bytes of a range go, once those of all before it are counted; whether they are wanted. */
static bool take_place(Run *run, uint64_t range, size_t size, uint64_t *offset)
{
    pthread_mutex_lock(&run->lock);
    while (run->turn != range)
        pthread_cond_wait(&run->next, &run->lock);
    *offset = run->stream->offset;
    run->stream->offset += size;
    run->turn++;
    bool good = !run->status;
    pthread_cond_broadcast(&run->next);
    pthread_mutex_unlock(&run->lock);
    return good;
}

/* Of ranges that fail at once, one is told: they fail for the same reason. */
static void note_failure(Run *run, MesoStatus status, const MesoError *error)
{
    pthread_mutex_lock(&run->lock);
    if (!run->status) {
        run->status = status;
        run->error = *error;
    }
    pthread_mutex_unlock(&run->lock);
}

static void run_range(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Run *run = context;
    const MesoSceneParts *parts = run->stream->parts;
    uint8_t *data = run->memory + worker * run->capacity;
    for (uint64_t i = begin; i < end; i++) {
        const MesoPartRange *range = &run->ranges[i];
        uint64_t text = text_bound(run->pass, parts, range->begin, range->end), offset;
        size_t size = run->pass->format(run->pass->context, parts, range->begin, range->end, data, data + text);
        MesoError error;
        assert(size <= text);
        if (!take_place(run, i, size, &offset))
            continue;
        MesoStatus status = meso_output_write_at(run->stream->output, offset, data, size, &error);
        if (status)
            note_failure(run, status, &error);
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

/* Gives a range as many parts of the cursor's as a thread's memory holds, at least one. */
static MesoPartRange cut_range(const Run *run, Cursor *cursor)
{
    const MesoSceneParts *parts = run->stream->parts;
    MesoPartRange range = {cursor->part, cursor->part + 1};
    while (range.end < cursor->ranges[cursor->range].end &&
           chunk_bound(run->pass, parts, range.begin, range.end + 1) <= run->capacity)
        range.end++;
    cursor->part = range.end;
    cursor->parts_done += range.end - range.begin;
    return range;
}

static void cut_window(Run *run, Cursor *cursor)
{
    run->range_count = 0;
    while (run->range_count < RANGES_A_WINDOW && cursor->range < cursor->range_count) {
        if (cursor->part < cursor->ranges[cursor->range].end)
            run->ranges[run->range_count++] = cut_range(run, cursor);
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

static void run_windows(Run *run, uint32_t threads, Cursor *cursor, uint64_t work)
{
    pthread_mutex_init(&run->lock, NULL);
    pthread_cond_init(&run->next, NULL);
    for (cut_window(run, cursor); run->range_count > 0 && !run->status; cut_window(run, cursor)) {
        run->turn = 0;
        meso_parallel_team(threads, run->range_count, 1, run_range, run);
        report(run->stream, work, cursor);
    }
    pthread_cond_destroy(&run->next);
    pthread_mutex_destroy(&run->lock);
}

MesoStatus meso_mesh_stream_run(MesoMeshStream *stream, const MesoMeshPass *pass, uint64_t work,
                                MesoError *error)
{
    const MesoPartRange all = {0, stream->parts->part_count};
    Cursor cursor = begin_ranges(stream->ranges ? stream->ranges : &all, stream->ranges ? stream->range_count : 1);
    uint32_t threads = stream->options->thread_count;
    Run run = {.stream = stream, .pass = pass, .capacity = largest_part(pass, stream->parts, &cursor)};
    if (run.capacity < MESO_WINDOW_CHUNK)
        run.capacity = MESO_WINDOW_CHUNK;
    threads = threads ? threads : meso_parallel_cores();
    threads = threads < RANGES_A_WINDOW ? threads : RANGES_A_WINDOW;

    MesoArena arena;
    meso_arena_init(&arena);
    run.ranges = MESO_NEW(&arena, MesoPartRange, RANGES_A_WINDOW, error);
    run.memory = run.ranges ? meso_arena_alloc(&arena, threads, run.capacity, error) : NULL;
    MesoStatus status = run.memory ? MESO_OK : MESO_ERR_MEMORY;
    if (!status) {
        run_windows(&run, threads, &cursor, work);
        status = run.status;
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
