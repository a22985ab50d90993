#include "formats/mesh/point_file.h"

#include <math.h>
#include <string.h>

#include "formats/mesh/mesh_read.h"
#include "formats/mesh/number_text.h"
#include "libcore/base/grow.h"

typedef struct Rows {
    MesoArena *arena;
    MesoVec3 *points;
    uint32_t count, room;
    const char *path;
    uint32_t line;
    MesoError *error;
} Rows;

static bool is_between(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';'; }
static bool is_end(char c) { return c == '\0' || c == '\n' || c == '\r' || c == '#'; }

static const char *skip(const char *at)
{
    while (is_between(*at))
        at++;
    return at;
}

static bool is_heading(const Rows *rows, const char *at)
{
    float number;
    return rows->count == 0 && !is_end(*at) && !meso_text_float(at, &number);
}

static MesoStatus add_row(Rows *rows, const char *at)
{
    float x[3];
    for (uint32_t i = 0; i < 3; i++) {
        const char *end = meso_text_float(skip(at), &x[i]);
        if (!end || !(is_between(*end) || is_end(*end)) || !isfinite(x[i]))
            return meso_fail(rows->error, MESO_ERR_INPUT, "%s:%u: a row is three finite numbers", rows->path,
                             rows->line);
        at = end;
    }
    for (uint32_t i = 0; i < 3; i++)
        if (!(fabsf(x[i]) <= MESO_COORDINATE_LIMIT))
            return meso_fail(rows->error, MESO_ERR_INPUT, "%s:%u: %g lies beyond the largest coordinate, %g", rows->path,
                             rows->line, (double)x[i], (double)MESO_COORDINATE_LIMIT);
    rows->points = MESO_GROW(rows->arena, rows->points, rows->count, rows->room, 64, rows->error);
    if (!rows->points)
        return MESO_ERR_MEMORY;
    rows->points[rows->count++] = (MesoVec3){x[0], x[1], x[2]};
    return MESO_OK;
}

/* `text` ends with a zero. */
static MesoStatus read_rows(Rows *rows, const char *text)
{
    MesoStatus status = MESO_OK;
    bool headed = false;
    while (*text && !status) {
        const char *at = skip(text);
        rows->line++;
        if (!headed && is_heading(rows, at))
            headed = true;
        else if (!is_end(*at))
            status = add_row(rows, at);
        text += strcspn(text, "\r\n");
        text += text[0] == '\r' && text[1] == '\n' ? 2 : *text ? 1 : 0;
    }
    return status;
}

static MesoStatus read_table(Rows *rows, const MesoInput *input)
{
    size_t mark = meso_input_mark(input), size = input->size - mark;
    char *text = meso_arena_alloc(rows->arena, size + 1, 1, rows->error);
    if (!text)
        return MESO_ERR_MEMORY;
    memcpy(text, input->data + mark, size);
    if (memchr(text, '\0', size))
        return meso_fail(rows->error, MESO_ERR_INPUT, "%s: not text", rows->path);
    return read_rows(rows, text);
}

static bool is_table(const char *path)
{
    static const char *const extensions[] = {".csv", ".txt", ".xyz"};
    size_t length = strlen(path);
    for (uint32_t i = 0; length >= 4 && i < 3; i++)
        if (strcmp(path + length - 4, extensions[i]) == 0)
            return true;
    return false;
}

MesoStatus meso_points_read(const MesoVec3 **points, uint32_t *count, MesoArena *arena, const MesoInput *input,
                            MesoError *error)
{
    Rows rows = {.arena = arena, .path = input->path, .error = error};
    MesoPolygonMesh mesh = {0};
    bool table = is_table(input->path);
    MesoStatus status = table ? read_table(&rows, input)
                              : meso_polygon_mesh_read_vertices(&mesh, arena, input, 1, error);
    *points = table ? rows.points : mesh.positions;
    *count = table ? rows.count : mesh.vertex_count;
    if (!status && *count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: no points", input->path);
    return status;
}
