#include "formats/decor/curve_file.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/mesh/point_file.h"
#include "libcore/base/grow.h"

typedef struct Reading {
    MesoArena *arena;
    const MesoInput *input;
    const MesoVec3 *vertices;       /* [vertex_count] */
    uint32_t vertex_count, so_far;  /* so many before this line */
    uint32_t line;
    MesoVec3 *points;
    uint8_t *breaks;
    uint32_t count, point_room, break_room;
    MesoError *error;
} Reading;

static MesoStatus add_point(Reading *r, MesoVec3 p, bool first)
{
    const MesoVec3 *last = r->count > 0 ? &r->points[r->count - 1] : NULL;
    if (first && last && last->x == p.x && last->y == p.y && last->z == p.z)
        return MESO_OK;
    r->points = MESO_GROW(r->arena, r->points, r->count, r->point_room, 64, r->error);
    r->breaks = r->points ? MESO_GROW(r->arena, r->breaks, r->count, r->break_room, 64, r->error) : NULL;
    if (!r->breaks)
        return MESO_ERR_MEMORY;
    r->points[r->count] = p;
    r->breaks[r->count++] = first;
    return MESO_OK;
}

/* "l 1 2/7 -1", behind the letter; `text` ends with a zero. */
static MesoStatus read_line(Reading *r, const char *text)
{
    bool first = true;
    MesoStatus status = MESO_OK;
    while (!status) {
        text += strspn(text, " \t");
        if (*text == 0 || *text == '#')
            break;
        char *end;
        long number = strtol(text, &end, 10);
        long vertex = number < 0 ? (long)r->so_far + number : number - 1;
        if (end == text || vertex < 0 || (unsigned long)vertex >= r->vertex_count)
            return meso_fail(r->error, MESO_ERR_INPUT, "%s:%u: a line is made of numbers of vertices, which are from 1 "
                             "to %u", r->input->path, r->line, r->vertex_count);
        text = end + strcspn(end, " \t");
        status = add_point(r, r->vertices[vertex], first);
        first = false;
    }
    return status;
}

static MesoStatus read_lines(Reading *r, char *text)
{
    MesoStatus status = MESO_OK;
    while (*text && !status) {
        size_t length = strcspn(text, "\r\n");
        char *next = text + length + (text[length] == '\r' && text[length + 1] == '\n' ? 2 : text[length] ? 1 : 0);
        text[length] = 0;
        text += strspn(text, " \t");
        r->line++;
        r->so_far += text[0] == 'v' && (text[1] == ' ' || text[1] == '\t');
        if (text[0] == 'l' && (text[1] == ' ' || text[1] == '\t'))
            status = read_line(r, text + 1);
        text = next;
    }
    return status;
}

static MesoStatus read_obj(Reading *r)
{
    size_t size = r->input->size, mark = meso_input_mark(r->input);
    char *text = meso_arena_alloc(r->arena, size - mark + 1, 1, r->error);
    if (!text)
        return MESO_ERR_MEMORY;
    memcpy(text, r->input->data + mark, size - mark);
    return read_lines(r, text);
}

static MesoStatus take_all(Reading *r)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < r->vertex_count && !status; i++)
        status = add_point(r, r->vertices[i], i == 0);
    return status;
}

MesoStatus meso_curves_read(MesoCurves *curves, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Reading r = {.arena = arena, .input = input, .error = error};
    const char *dot = strrchr(input->path, '.');
    MesoStatus status = meso_points_read(&r.vertices, &r.vertex_count, arena, input, error);
    if (!status && dot && strcasecmp(dot, ".obj") == 0)
        status = read_obj(&r);
    if (!status && r.count == 0)
        status = take_all(&r);
    if (!status)
        *curves = (MesoCurves){r.count, r.points, r.breaks};
    return status;
}
