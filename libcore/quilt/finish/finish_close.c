/* Loops of open edges, closed. */
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_work.h"
#include "libcore/quilt/seam/section.h"

/* Longer loops are closed around a point: ears take the square of their number. */
enum { EARS_LIMIT = 512 };

/* Loops along a border are strips where they are so many times as long as high; what may be missing at their end. */
#define NARROW 4
#define GAP_MOST 0.1f

/* Of half-edges. */
enum { IS_OPEN = 1, IS_WALKED = 2 };

/* Elements are looked at together up to so many triangles, or one by itself. */
enum { BLOCK_LEAST = 4096 };

/* Some whole elements: no edge leads from one of them to others. */
typedef struct Block {
    uint32_t first, end;        /* triangles */
    uint32_t open;              /* half-edges that are */
} Block;

typedef struct Closer {
    MesoFinishWork *work;
    uint32_t half_edge_first, half_edge_count;
    uint32_t vertex_first, vertex_count;
    uint32_t *begin;            /* [vertex_count + 1] half-edges by the vertex at which they begin */
    uint32_t *leaving;          /* [half_edge_count] */
    uint8_t *marks;             /* [half_edge_count] IS_OPEN, IS_WALKED */
    uint32_t *stack_places;     /* [vertex_count] place in the walk, or MESO_NO_INDEX */
    uint32_t stack_count;
    uint32_t *stack;            /* [open half-edges] half-edges of a walk */
    uint32_t *loop;             /* [open half-edges] vertices of a loop */
    uint32_t *places;           /* [open half-edges] where these are among the points */
    MesoVec3 *points;           /* [vertex_count] where those of a loop are in space */
    MesoArena scratch;
} Closer;

static uint8_t *mark_of(const Closer *c, uint32_t h)
{
    return &c->marks[h - c->half_edge_first];
}

static uint32_t *stack_place_of(const Closer *c, uint32_t vertex)
{
    return &c->stack_places[vertex - c->vertex_first];
}

static uint32_t next_of(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static uint32_t edge_between(const Closer *c, uint32_t a, uint32_t b)
{
    uint32_t at = a - c->vertex_first;
    if (at >= c->vertex_count)
        return MESO_NO_INDEX;   /* it has come since */
    for (uint32_t i = c->begin[at]; i < c->begin[at + 1]; i++)
        if (c->work->corners[next_of(c->leaving[i])] == b)
            return c->leaving[i];
    return MESO_NO_INDEX;
}

static void list_leaving(Closer *c)
{
    const uint32_t *corners = &c->work->corners[c->half_edge_first];
    uint32_t *begin = c->begin, first = c->vertex_first;
    for (uint32_t h = 0; h < c->half_edge_count; h++)
        begin[corners[h] - first + 1]++;
    for (uint32_t v = 0; v < c->vertex_count; v++)
        begin[v + 1] += begin[v];
    for (uint32_t h = c->half_edge_count; h-- > 0;)     /* fills each list from its end */
        c->leaving[--begin[corners[h] - first + 1]] = c->half_edge_first + h;
    /* now begin[v + 1] is where the list of v begins */
    for (uint32_t v = 0; v < c->vertex_count; v++)
        begin[v] = begin[v + 1];
    begin[c->vertex_count] = c->half_edge_count;
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
        c->marks[h] = twin_of(c, c->half_edge_first + h) == MESO_NO_INDEX ? IS_OPEN : 0;
        count += c->marks[h];
    }
    return count;
}

/* The open half-edge that goes on where one ends: around the vertex, through the triangles. */
static uint32_t go_on(const Closer *c, uint32_t h)
{
    uint32_t next = next_of(h);
    for (uint32_t guard = 0; !(*mark_of(c, next) & IS_OPEN) && guard < c->half_edge_count; guard++)
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
        if (along != MESO_NO_INDEX || (against != MESO_NO_INDEX && !(*mark_of(c, against) & IS_OPEN)))
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
            if (across != MESO_NO_INDEX && *mark_of(c, across) & IS_OPEN)
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
    MesoSection section = {.count = count, .vertices = c->places, .positions = c->points};
    bool closed = false;
    MesoStatus status = at_border ? try_strip(&closed, corners, c, &section, error) : MESO_OK;
    if (!status && !closed && count <= EARS_LIMIT) {
        meso_section_measure(&section);
        status = meso_section_cap(corners, &c->scratch, &section, error);
        closed = true;
    }
    for (size_t k = 0; closed && !status && k < 3 * ((size_t)count - 2); k++)
        corners[k] += c->vertex_first;
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
        uint32_t vertex = c->work->corners[c->stack[from + i]];
        c->loop[i] = vertex;
        c->places[i] = vertex - c->vertex_first;
        c->points[c->places[i]] = meso_finish_point(c->work, c->work->vertices[vertex]);
        *stack_place_of(c, vertex) = MESO_NO_INDEX;
    }
    c->stack_count = from;
    return close_loop(c, count, beside, error);
}

/* Along the open edges from one on. Where the walk comes by a vertex again, a loop has closed. */
static MesoStatus walk(Closer *c, uint32_t first, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t h = first; !status && !(*mark_of(c, h) & IS_WALKED); h = go_on(c, h)) {
        uint32_t vertex = c->work->corners[h];
        if (*stack_place_of(c, vertex) != MESO_NO_INDEX)
            status = take_loop(c, *stack_place_of(c, vertex), error);
        *mark_of(c, h) |= IS_WALKED;
        *stack_place_of(c, vertex) = c->stack_count;
        c->stack[c->stack_count++] = h;
    }
    return status ? status : take_loop(c, 0, error);
}

/* Looks at a block, to scratch. */
static MesoStatus look_at(Closer *c, Block *block, MesoError *error)
{
    const uint32_t *corners = c->work->corners;
    uint32_t first = MESO_NO_INDEX, last = 0;
    for (size_t h = 3 * (size_t)block->first; h < 3 * (size_t)block->end; h++) {
        first = corners[h] < first ? corners[h] : first;
        last = corners[h] > last ? corners[h] : last;
    }
    c->half_edge_first = 3 * block->first;
    c->half_edge_count = 3 * (block->end - block->first);
    c->vertex_first = first;
    c->vertex_count = last - first + 1;
    c->begin = MESO_NEW(&c->scratch, uint32_t, (size_t)c->vertex_count + 1, error);
    c->leaving = MESO_NEW_BARE(&c->scratch, uint32_t, c->half_edge_count, error);
    c->marks = MESO_NEW_BARE(&c->scratch, uint8_t, c->half_edge_count, error);
    if (!c->begin || !c->leaving || !c->marks)
        return MESO_ERR_MEMORY;
    list_leaving(c);
    block->open = find_open(c);
    return MESO_OK;
}

static MesoStatus close_block(Closer *c, Block *block, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(&c->scratch);
    MesoStatus status = look_at(c, block, error);
    if (status)
        return status;
    c->stack_places = MESO_NEW_BARE(&c->scratch, uint32_t, c->vertex_count, error);
    c->stack = MESO_NEW_BARE(&c->scratch, uint32_t, block->open, error);
    c->loop = MESO_NEW_BARE(&c->scratch, uint32_t, block->open, error);
    c->places = MESO_NEW_BARE(&c->scratch, uint32_t, block->open, error);
    c->points = MESO_NEW_BARE(&c->scratch, MesoVec3, c->vertex_count, error);
    if (!c->stack_places || !c->stack || !c->loop || !c->places || !c->points)
        return MESO_ERR_MEMORY;
    memset(c->stack_places, 0xff, c->vertex_count * sizeof *c->stack_places);
    for (uint32_t h = 0; !status && h < c->half_edge_count; h++)
        if (c->marks[h] == IS_OPEN)
            status = walk(c, c->half_edge_first + h, error);
    meso_arena_rewind(&c->scratch, mark);
    return status;
}

/* ---- blocks ---- */

/* Triangles by element; those that are beside each other and of one are together. */
static uint32_t list_blocks(Block *blocks, const MesoFinishWork *work)
{
    uint32_t count = 0, first = 0;
    for (uint32_t t = 1; t <= work->triangle_count; t++)
        if (t == work->triangle_count || (t - first >= BLOCK_LEAST && work->elements[t] != work->elements[t - 1])) {
            blocks[count++] = (Block){first, t, 0};
            first = t;
        }
    return count;
}

typedef struct Count {
    Closer *closers;            /* [workers] */
    Block *blocks;
    MesoStatus *statuses;       /* [blocks] */
} Count;

static void count_range(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Count *count = context;
    for (uint64_t i = begin; i < end; i++) {
        Closer *c = &count->closers[worker];
        MesoArenaMark mark = meso_arena_mark(&c->scratch);
        count->statuses[i] = look_at(c, &count->blocks[i], NULL);
        meso_arena_rewind(&c->scratch, mark);
    }
}

/* How many half-edges are open in each block, and in all. */
static MesoStatus count_open(uint64_t *open, Block *blocks, uint32_t block_count, MesoFinishWork *work,
                             MesoError *error)
{
    uint32_t workers = work->options->thread_count ? work->options->thread_count : meso_parallel_cores();
    workers = workers < block_count ? workers : block_count;
    Count count = {MESO_NEW(work->arena, Closer, workers, error), blocks,
                   MESO_NEW(work->arena, MesoStatus, block_count, error)};
    if (!count.closers || !count.statuses)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < workers; i++)
        count.closers[i].work = work;
    if (block_count)
        meso_parallel_team(workers, block_count, 1, count_range, &count);
    for (uint32_t i = 0; i < workers; i++)
        meso_arena_release(&count.closers[i].scratch);
    *open = 0;
    for (uint32_t i = 0; i < block_count; i++) {
        if (count.statuses[i])
            return meso_fail(error, count.statuses[i], "out of memory: %u triangles", blocks[i].end - blocks[i].first);
        *open += blocks[i].open;
    }
    return MESO_OK;
}

MesoStatus meso_finish_close(MesoFinishWork *work, MesoError *error)
{
    uint64_t open;
    Block *blocks = MESO_NEW(work->arena, Block, (size_t)work->triangle_count / BLOCK_LEAST + 1, error);
    if (!blocks)
        return MESO_ERR_MEMORY;
    uint32_t count = list_blocks(blocks, work);
    MesoStatus status = count_open(&open, blocks, count, work, error);
    if (!status)
        status = meso_finish_reserve(work, work->vertex_count + open / 3, work->triangle_count + open, error);
    Closer c = {.work = work};
    for (uint32_t i = 0; !status && i < count; i++)
        if (blocks[i].open)
            status = close_block(&c, &blocks[i], error);
    meso_arena_release(&c.scratch);
    return status;
}
