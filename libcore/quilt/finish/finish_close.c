/* Loops of open edges, closed. */
#include <string.h>

#include "libcore/quilt/finish/finish_work.h"
#include "libcore/quilt/seam/section.h"

/* Longer loops are closed around a point: ears take the square of their number. */
enum { EARS_LIMIT = 512 };

/* Loops along a border are strips where they are so many times as long as high; what may be missing at their end. */
#define NARROW 4
#define GAP_MOST 0.1f

/* Of half-edges. */
enum { IS_OPEN = 1, IS_WALKED = 2 };

typedef struct Closer {
    MesoFinishWork *work;
    uint32_t half_edge_count;
    uint32_t *begin;            /* [vertex_count + 1] half-edges by the vertex at which they begin */
    uint32_t *leaving;          /* [half_edge_count] */
    uint8_t *marks;             /* [half_edge_count] IS_OPEN, IS_WALKED */
    uint32_t *stack_places;     /* [vertex_count] place in the walk, or MESO_NO_INDEX */
    uint32_t stack_count;
    uint32_t *stack;            /* [open half-edges] half-edges of a walk */
    uint32_t *loop;             /* [open half-edges] vertices of a loop */
    MesoVec3 *points;           /* [vertex_count] where those of a loop are in space */
    MesoArena scratch;
} Closer;

static uint32_t next_of(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static uint32_t edge_between(const Closer *c, uint32_t a, uint32_t b)
{
    for (uint32_t i = c->begin[a]; i < c->begin[a + 1]; i++)
        if (c->work->corners[next_of(c->leaving[i])] == b)
            return c->leaving[i];
    return MESO_NO_INDEX;
}

static void list_leaving(Closer *c)
{
    const uint32_t *corners = c->work->corners;
    for (uint32_t h = 0; h < c->half_edge_count; h++)
        c->begin[corners[h] + 1]++;
    for (uint32_t v = 0; v < c->work->vertex_count; v++)
        c->begin[v + 1] += c->begin[v];
    for (uint32_t h = c->half_edge_count; h-- > 0;)     /* fills each list from its end */
        c->leaving[--c->begin[corners[h] + 1]] = h;
    /* now begin[v + 1] is where the list of v begins */
    for (uint32_t v = 0; v < c->work->vertex_count; v++)
        c->begin[v] = c->begin[v + 1];
    c->begin[c->work->vertex_count] = c->half_edge_count;
}

/* The half-edge across one. */
static uint32_t twin_of(const Closer *c, uint32_t h)
{
    return edge_between(c, c->work->corners[next_of(h)], c->work->corners[h]);
}

/* The number of open half-edges. */
static uint32_t find_open(Closer *c)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < c->half_edge_count; h++) {
        c->marks[h] = twin_of(c, h) == MESO_NO_INDEX ? IS_OPEN : 0;
        count += c->marks[h];
    }
    return count;
}

/* The open half-edge that goes on where one ends: around the vertex, through the triangles. */
static uint32_t go_on(const Closer *c, uint32_t h)
{
    uint32_t next = next_of(h);
    for (uint32_t guard = 0; !(c->marks[next] & IS_OPEN) && guard < c->half_edge_count; guard++)
        next = next_of(twin_of(c, next));
    return next;
}

/* ---- strips along borders ---- */

/* Along the border at a place on it: where what is inside does not change. */
static MesoVec3 border_way(const MesoFinishWork *work, uint32_t triangle)
{
    const MesoTriangulation *mesh = &work->base->mesh;
    const uint32_t *corner = &mesh->corners[3 * (size_t)triangle];
    const float *inside = work->base->inside;
    MesoVec3 a = mesh->positions[corner[0]], b = meso_vec3_sub(mesh->positions[corner[1]], a);
    MesoVec3 way = meso_vec3_scale(meso_vec3_sub(mesh->positions[corner[2]], a), inside[corner[1]] - inside[corner[0]]);
    way = meso_vec3_mad(way, inside[corner[0]] - inside[corner[2]], b);
    return meso_vec3_direction(way, (MesoVec3){0, 0, 0});
}

/* Lays a loop along a border flat: x along the border, y up. False where it goes all around it, or is short. */
static bool lay_flat(MesoVec2 *places, const Closer *c, uint32_t count)
{
    const MesoFinishWork *work = c->work;
    MesoVec2 low = {0, INFINITY}, high = {0, -INFINITY};
    float at = 0;
    for (uint32_t i = 0; i < count; i++) {
        MesoQuiltVertex here = work->vertices[c->loop[i]], next = work->vertices[c->loop[(i + 1) % count]];
        MesoVec3 step = meso_vec3_sub(meso_finish_foot(work, next), meso_finish_foot(work, here));
        MesoVec3 way = meso_vec3_add(border_way(work, here.triangle), border_way(work, next.triangle));
        places[i] = (MesoVec2){at, here.height};
        low = (MesoVec2){fminf(low.x, at), fminf(low.y, here.height)};
        high = (MesoVec2){fmaxf(high.x, at), fmaxf(high.y, here.height)};
        at += copysignf(meso_vec3_length(step), meso_vec3_dot(step, way));
    }
    float length = high.x - low.x;
    return fabsf(at) < GAP_MOST * length && length > NARROW * (high.y - low.y);
}

static MesoStatus try_strip(bool *closed, uint32_t *corners, Closer *c, const MesoSection *section, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(&c->scratch);
    MesoVec2 *places = MESO_NEW(&c->scratch, MesoVec2, section->count, error);
    if (!places)
        return MESO_ERR_MEMORY;
    *closed = lay_flat(places, c, section->count) && meso_section_strip(corners, section, places);
    meso_arena_rewind(&c->scratch, mark);
    return MESO_OK;
}

/* ---- caps ---- */

/* Whether two corners of a cap that are no neighbours in the loop have an edge already. */
static bool has_chord_twice(const Closer *c, const uint32_t *corners, uint32_t count)
{
    for (uint32_t h = 0; h < 3 * count; h++) {
        uint32_t a = corners[h], b = corners[next_of(h)];
        uint32_t along = edge_between(c, a, b), against = edge_between(c, b, a);
        if (along != MESO_NO_INDEX || (against != MESO_NO_INDEX && !(c->marks[against] & IS_OPEN)))
            return true;
    }
    return false;
}

/*
 * Each triangle of a cap is of the patch that it lies beside, so that patches meet where they did before: a cap may be
 * as long as a whole border. Those that touch none are as the one before; the first: as `beside`.
 */
static void add_cap(Closer *c, const uint32_t *corners, uint32_t count, uint32_t beside)
{
    MesoFinishWork *work = c->work;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *corner = &corners[3 * (size_t)t];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t across = edge_between(c, corner[next_of(k)], corner[k]);
            if (across != MESO_NO_INDEX && c->marks[across] & IS_OPEN)
                beside = across / 3;
        }
        meso_finish_add_triangle(work, corner, work->triangle_origins[beside], work->patches[beside],
                                 work->elements[beside]);
    }
}

static MesoStatus close_around(Closer *c, uint32_t count, uint32_t beside)
{
    MesoFinishWork *work = c->work;
    MesoQuiltVertex first = work->vertices[c->loop[0]];
    MesoVec3 foot = {0, 0, 0};
    float height = 0, share = 1 / (float)count;
    bool at_border = true;
    for (uint32_t i = 0; i < count; i++) {
        foot = meso_vec3_mad(foot, share, meso_finish_foot(work, work->vertices[c->loop[i]]));
        height += share * work->vertices[c->loop[i]].height;
        at_border = at_border && work->at_border[c->loop[i]];
    }
    uint32_t middle = meso_finish_add_vertex(work, meso_finish_locate(work, first.triangle, foot, height),
                                             work->origins[c->loop[0]], at_border);
    for (uint32_t i = 0; i < count; i++)
        add_cap(c, (uint32_t[]){c->loop[(i + 1) % count], c->loop[i], middle}, 1, beside);
    return MESO_OK;
}

static MesoStatus close_loop(Closer *c, uint32_t count, uint32_t beside, MesoError *error)
{
    MesoFinishWork *work = c->work;
    bool at_border = true;
    for (uint32_t i = 0; i < count; i++)
        at_border = at_border && work->at_border[c->loop[i]];
    if (count < 3 || (at_border && work->options->open_borders)) {
        work->report->open_count++;
        return MESO_OK;
    }
    work->report->closed_count++;
    MesoArenaMark mark = meso_arena_mark(&c->scratch);
    uint32_t *corners = MESO_NEW(&c->scratch, uint32_t, 3 * (size_t)count, error);
    if (!corners)
        return MESO_ERR_MEMORY;
    MesoSection section = {.count = count, .vertices = c->loop, .positions = c->points};
    bool closed = false;
    MesoStatus status = at_border ? try_strip(&closed, corners, c, &section, error) : MESO_OK;
    if (!status && !closed && count <= EARS_LIMIT) {
        meso_section_measure(&section);
        status = meso_section_cap(corners, &c->scratch, &section, error);
        closed = true;
    }
    if (!status && (!closed || has_chord_twice(c, corners, count - 2)))
        status = close_around(c, count, beside);
    else if (!status)
        add_cap(c, corners, count - 2, beside);
    meso_arena_rewind(&c->scratch, mark);
    return status;
}

/* ---- loops ---- */

/* What has been walked since place `from` of the stack is a loop. */
static MesoStatus take_loop(Closer *c, uint32_t from, MesoError *error)
{
    uint32_t count = c->stack_count - from, beside = c->stack[from] / 3;
    for (uint32_t i = 0; i < count; i++) {
        c->loop[i] = c->work->corners[c->stack[from + i]];
        c->points[c->loop[i]] = meso_finish_point(c->work, c->work->vertices[c->loop[i]]);
        c->stack_places[c->loop[i]] = MESO_NO_INDEX;
    }
    c->stack_count = from;
    return close_loop(c, count, beside, error);
}

/* Along the open edges from one on. Where the walk comes by a vertex again, a loop has closed. */
static MesoStatus walk(Closer *c, uint32_t first, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t h = first; !status && !(c->marks[h] & IS_WALKED); h = go_on(c, h)) {
        uint32_t vertex = c->work->corners[h];
        if (c->stack_places[vertex] != MESO_NO_INDEX)
            status = take_loop(c, c->stack_places[vertex], error);
        c->marks[h] |= IS_WALKED;
        c->stack_places[vertex] = c->stack_count;
        c->stack[c->stack_count++] = h;
    }
    return status ? status : take_loop(c, 0, error);
}

static MesoStatus make_room(Closer *c, MesoError *error)
{
    size_t vertices = (size_t)c->work->vertex_count + 2, half_edges = (size_t)c->half_edge_count + 1;
    c->begin = MESO_NEW(&c->scratch, uint32_t, vertices, error);
    c->leaving = MESO_NEW(&c->scratch, uint32_t, half_edges, error);
    c->marks = MESO_NEW(&c->scratch, uint8_t, half_edges, error);
    c->stack_places = MESO_NEW(&c->scratch, uint32_t, vertices, error);
    if (!c->begin || !c->leaving || !c->marks || !c->stack_places)
        return MESO_ERR_MEMORY;
    memset(c->stack_places, 0xff, vertices * sizeof *c->stack_places);
    return MESO_OK;
}

static MesoStatus close_all(Closer *c, MesoError *error)
{
    MesoStatus status = make_room(c, error);
    if (status)
        return status;
    list_leaving(c);
    uint32_t open = find_open(c);
    c->stack = MESO_NEW(&c->scratch, uint32_t, open, error);
    c->loop = MESO_NEW(&c->scratch, uint32_t, open, error);
    c->points = MESO_NEW(&c->scratch, MesoVec3, open ? c->work->vertex_count : 0, error);
    if (!c->stack || !c->loop || !c->points)
        return MESO_ERR_MEMORY;
    status = meso_finish_reserve(c->work, c->work->vertex_count + (uint64_t)open / 3,
                                 c->work->triangle_count + (uint64_t)open, error);
    for (uint32_t h = 0; !status && h < c->half_edge_count; h++)
        if (c->marks[h] == IS_OPEN)
            status = walk(c, h, error);
    return status;
}

MesoStatus meso_finish_close(MesoFinishWork *work, MesoError *error)
{
    Closer c = {.work = work, .half_edge_count = 3 * work->triangle_count};
    meso_arena_init(&c.scratch);
    MesoStatus status = close_all(&c, error);
    meso_arena_release(&c.scratch);
    return status;
}
