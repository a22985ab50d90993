/*
 * A part's header is that of the whole but for the counts and for the lines
 * "comment whole PARTS VERTICES FACES" and "comment run PART PARTS VERTEX
 * VERTICES FACE FACES", one for each run of parts: where it lies in the whole.
 */
#include "formats/scene/part/ply_join.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/scene/part/selection.h"

enum { LINE = 4096, CHUNK = 1 << 20, WIDEST = 17 + 64 };

/* A run of one file, with its rows. */
typedef struct Run {
    MesoSelectedRun at;
    uint32_t file;
    const uint8_t *vertices;
    const uint8_t *faces;           /* its first row */
    uint64_t base;                  /* vertices of the file before it */
} Run;

typedef struct Part {
    const MesoInput *input;
    const uint8_t *body;
    uint64_t vertex_count, face_count;
    uint32_t run_begin, run_end;
} Part;

typedef struct Join {
    Part *parts;                    /* [count] */
    uint32_t count, run_count;
    Run *runs;                      /* [run_count] in the order of the whole */
    uint64_t part_total, vertex_total, face_total;
    uint32_t vertex_bytes, tail_bytes;
    uint8_t *buffer;                /* [CHUNK] */
    MesoArena *arena;
} Join;

/* ---- headers ---- */

/* The next line of a header, without its end; false behind the last. */
static bool next_line(const MesoInput *input, size_t *at, const char **line, size_t *size)
{
    const uint8_t *end = *at < input->size ? memchr(input->data + *at, '\n', input->size - *at) : NULL;
    if (!end)
        return false;
    *line = (const char *)input->data + *at;
    *size = (size_t)(end - (const uint8_t *)*line);
    *at += *size + 1;
    return true;
}

static bool begins(const char *line, size_t size, const char *with)
{
    return size >= strlen(with) && memcmp(line, with, strlen(with)) == 0;
}

/* Up to 6 whole numbers behind a word; how many there are. */
static int numbers_of(const char *line, size_t size, const char *word, uint64_t numbers[6])
{
    char text[LINE];
    if (size >= sizeof text || !begins(line, size, word))
        return 0;
    memcpy(text, line, size);
    text[size] = 0;
    return sscanf(text + strlen(word), "%" SCNu64 "%" SCNu64 "%" SCNu64 "%" SCNu64 "%" SCNu64 "%" SCNu64, &numbers[0],
                  &numbers[1], &numbers[2], &numbers[3], &numbers[4], &numbers[5]);
}

/* Bytes of a property of the types that we write; 0 for others. */
static uint32_t bytes_of(const char *line, size_t size)
{
    static const struct { const char *type; uint32_t bytes; } types[] = {
        {"property float ", 4}, {"property uchar ", 1}, {"property ushort ", 2}, {"property uint ", 4}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (begins(line, size, types[i].type))
            return types[i].bytes;
    return 0;
}

static MesoStatus refuse(const Part *part, MesoError *error)
{
    return meso_fail(error, MESO_ERR_INPUT, "%s: no part of a PLY file: meso-map --slots or --shard makes them",
                     part->input->path);
}

/* Lines that differ between the parts of one product. */
static bool is_own(const char *line, size_t size)
{
    return begins(line, size, "comment run ") || begins(line, size, "element vertex ") ||
           begins(line, size, "element face ");
}

/* `runs` NULL only counts. */
static MesoStatus read_header(Join *join, Part *part, Run *runs, MesoError *error)
{
    const char *line;
    size_t size, at = 0;
    uint64_t n[6] = {0};
    uint32_t vertex_bytes = 0, tail_bytes = 0, run_count = 0;
    bool faces = false, whole = false;
    part->body = NULL;
    while (!part->body && next_line(part->input, &at, &line, &size)) {
        if (numbers_of(line, size, "comment run ", n) == 6) {
            if (runs)
                runs[run_count].at = (MesoSelectedRun){(uint32_t)n[0], (uint32_t)n[1], n[2], n[3], n[4], n[5]};
            run_count++;
        } else if (numbers_of(line, size, "comment whole ", n) == 3) {
            whole = true;
            join->part_total = n[0];
            join->vertex_total = n[1];
            join->face_total = n[2];
        } else if (numbers_of(line, size, "element vertex ", n) == 1) {
            part->vertex_count = n[0];
        } else if (numbers_of(line, size, "element face ", n) == 1) {
            part->face_count = n[0];
            faces = true;
        } else if (bytes_of(line, size)) {
            *(faces ? &tail_bytes : &vertex_bytes) += bytes_of(line, size);
        } else if (begins(line, size, "end_header")) {
            part->body = part->input->data + at;
        }
    }
    join->vertex_bytes = vertex_bytes;
    join->tail_bytes = tail_bytes;
    part->run_end = part->run_begin + run_count;
    bool good = part->body && whole && run_count > 0 && vertex_bytes > 0 && tail_bytes < WIDEST - 17;
    return good ? MESO_OK : refuse(part, error);
}

/* That two parts say the same of the whole. */
static bool agree(const MesoInput *a, const MesoInput *b)
{
    const char *line[2] = {"", ""};
    size_t size[2] = {0, 0}, at[2] = {0, 0};
    const MesoInput *inputs[2] = {a, b};
    while (!begins(line[0], size[0], "end_header")) {
        for (int i = 0; i < 2; i++)
            do
                if (!next_line(inputs[i], &at[i], &line[i], &size[i]))
                    return false;
            while (is_own(line[i], size[i]));
        if (size[0] != size[1] || memcmp(line[0], line[1], size[0]) != 0)
            return false;
    }
    return true;
}

/* ---- rows ---- */

static const uint8_t *next_face(const Join *join, const uint8_t *row, const uint8_t *end)
{
    size_t size = end - row > 0 ? 1 + 4 * (size_t)row[0] + join->tail_bytes : 0;
    return size && (row[0] == 3 || row[0] == 4) && (size_t)(end - row) >= size ? row + size : NULL;
}

/* Where the runs of a file have their rows. */
static MesoStatus find_rows(const Join *join, const Part *part, Run *runs, MesoError *error)
{
    const uint8_t *end = part->input->data + part->input->size;
    uint64_t vertices = 0, faces = 0;
    if (part->vertex_count > (uint64_t)(end - part->body) / join->vertex_bytes)
        return refuse(part, error);
    const uint8_t *row = part->body + part->vertex_count * join->vertex_bytes;
    for (Run *run = runs; run < runs + (part->run_end - part->run_begin); run++) {
        if (run->at.vertex_count > part->vertex_count - vertices || run->at.face_count > part->face_count - faces)
            return refuse(part, error);
        run->base = vertices;
        run->vertices = part->body + vertices * join->vertex_bytes;
        run->faces = row;
        vertices += run->at.vertex_count;
        faces += run->at.face_count;
        for (uint64_t f = 0; f < run->at.face_count; f++)
            if (!(row = next_face(join, row, end)))
                return refuse(part, error);
    }
    return vertices == part->vertex_count && faces == part->face_count && row == end ? MESO_OK : refuse(part, error);
}

static int compare_runs(const void *x, const void *y)
{
    const Run *a = x, *b = y;
    return (a->at.part > b->at.part) - (a->at.part < b->at.part);
}

/* One after the other, they are the whole. */
static MesoStatus check_whole(const Join *join, MesoError *error)
{
    MesoSelectedRun next = {0};
    for (uint32_t i = 0; i <= join->run_count; i++) {
        const Run *run = i < join->run_count ? &join->runs[i] : NULL;
        uint64_t part = run ? run->at.part : join->part_total;
        if (part < next.part)
            return meso_fail(error, MESO_ERR_INPUT, "%s: has what another part has: part %" PRIu64 " of %" PRIu64,
                             join->parts[run ? run->file : 0].input->path, part, join->part_total);
        if (part > next.part)
            return meso_fail(error, MESO_ERR_INPUT, "parts %u to %" PRIu64 " of %" PRIu64 " are in none of the files",
                             next.part, part - 1, join->part_total);
        if ((run ? run->at.vertex : join->vertex_total) != next.vertex ||
            (run ? run->at.face : join->face_total) != next.face)
            return refuse(&join->parts[run ? run->file : 0], error);
        if (run)
            next = (MesoSelectedRun){run->at.part + run->at.part_count, 0, run->at.vertex + run->at.vertex_count, 0,
                                     run->at.face + run->at.face_count, 0};
    }
    return MESO_OK;
}

static MesoStatus read_parts(Join *join, const MesoInput *inputs, uint32_t count, MesoError *error)
{
    join->parts = MESO_NEW(join->arena, Part, count, error);
    join->buffer = MESO_NEW(join->arena, uint8_t, CHUNK, error);
    if (!join->parts || !join->buffer)
        return MESO_ERR_MEMORY;
    for (join->count = 0; join->count < count; join->count++) {
        Part *part = &join->parts[join->count];
        *part = (Part){.input = &inputs[join->count], .run_begin = join->run_count};
        MesoStatus status = read_header(join, part, NULL, error);
        if (status)
            return status;
        if (!agree(&inputs[0], part->input))
            return meso_fail(error, MESO_ERR_INPUT, "%s: a part of another product than '%s'", part->input->path,
                             inputs[0].path);
        join->run_count = part->run_end;
    }
    join->runs = MESO_NEW(join->arena, Run, join->run_count, error);
    if (!join->runs)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        Run *runs = join->runs + join->parts[i].run_begin;
        read_header(join, &join->parts[i], runs, NULL);
        for (Run *run = runs; run < join->runs + join->parts[i].run_end; run++)
            run->file = i;
        MesoStatus status = find_rows(join, &join->parts[i], runs, error);
        if (status)
            return status;
    }
    qsort(join->runs, join->run_count, sizeof *join->runs, compare_runs);
    return check_whole(join, error);
}

/* ---- the whole ---- */

static MesoStatus write_header(const Join *join, MesoOutput *output, MesoError *error)
{
    const char *line = "";
    size_t size = 0, at = 0;
    MesoStatus status = MESO_OK;
    while (!status && !begins(line, size, "end_header") && next_line(join->parts[0].input, &at, &line, &size)) {
        if (begins(line, size, "comment run ") || begins(line, size, "comment whole "))
            continue;
        if (begins(line, size, "element vertex "))
            status = meso_output_print(output, error, "element vertex %" PRIu64 "\n", join->vertex_total);
        else if (begins(line, size, "element face "))
            status = meso_output_print(output, error, "element face %" PRIu64 "\n", join->face_total);
        else
            status = meso_output_write(output, line, size + 1, error);
    }
    return status;
}

/* A face's corners count from the whole's first vertex. */
static MesoStatus write_faces(const Join *join, const Run *run, MesoOutput *output, MesoError *error)
{
    const uint8_t *row = run->faces;
    const uint32_t shift = (uint32_t)(run->at.vertex - run->base);
    MesoStatus status = MESO_OK;
    size_t used = 0;
    for (uint64_t f = 0; f < run->at.face_count && !status; f++) {
        size_t size = 1 + 4 * (size_t)row[0] + join->tail_bytes;
        memcpy(join->buffer + used, row, size);
        for (uint32_t k = 0; k < row[0]; k++) {
            uint32_t corner;
            memcpy(&corner, row + 1 + 4 * (size_t)k, sizeof corner);
            corner += shift;
            memcpy(join->buffer + used + 1 + 4 * (size_t)k, &corner, sizeof corner);
        }
        row += size;
        used += size;
        if (used + WIDEST > CHUNK || f + 1 == run->at.face_count) {
            status = meso_output_write(output, join->buffer, used, error);
            used = 0;
        }
    }
    return status;
}

static MesoStatus write_whole(const Join *join, MesoOutput *output, MesoError *error)
{
    MesoStatus status = write_header(join, output, error);
    for (uint32_t i = 0; i < join->run_count && !status; i++)
        status = meso_output_write(output, join->runs[i].vertices, join->runs[i].at.vertex_count * join->vertex_bytes,
                                   error);
    for (uint32_t i = 0; i < join->run_count && !status; i++)
        status = write_faces(join, &join->runs[i], output, error);
    return status;
}

MesoStatus meso_ply_join(const MesoInput *parts, uint32_t count, MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    Join join = {.arena = &arena};
    MesoStatus status = read_parts(&join, parts, count, error);
    if (!status)
        status = write_whole(&join, output, error);
    meso_arena_release(&arena);
    return status;
}
