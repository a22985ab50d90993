#include "libcore/quilt/composite.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/large_pages.h"
#include "libcore/quilt/swatch/swatch_elements.h"

/* What has been taken away makes room when there is so much more than at the last packing, and a little. */
#define PACK_RATIO 1.15
#define PACK_LEAST 32768

/* An array that is owned by the composite, made larger; false where memory is out. */
static bool enlarge(void *array, uint32_t room, size_t width)
{
    void *larger = realloc(*(void **)array, room * width);
    if (larger)
        *(void **)array = larger;
    return larger;
}

static uint32_t larger_room(uint32_t room)
{
    uint64_t larger = (uint64_t)room + room / 8 + 1024;
    return larger < MESO_NO_INDEX / 3 ? (uint32_t)larger : MESO_NO_INDEX / 3;
}

static MesoStatus out_of_room(MesoError *error, uint32_t room, const char *what)
{
    if (room >= MESO_NO_INDEX / 3)
        return meso_fail(error, MESO_ERR_LIMIT, "more than %u %s", room, what);
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u %s", room, what);
}

MesoStatus meso_composite_init(MesoComposite *composite, uint32_t base_count, MesoError *error)
{
    *composite = (MesoComposite){.base_count = base_count, .triangle_limit = PACK_LEAST,
                                 .whole_vertex_limit = PACK_LEAST};
    size_t size = ((size_t)base_count + 1) * sizeof(uint32_t);
    composite->triangle_head = malloc(size);
    composite->whole_head = malloc(size);
    if (!composite->triangle_head || !composite->whole_head)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: lists of %u triangles", base_count);
    memset(composite->triangle_head, 0xff, size);
    memset(composite->whole_head, 0xff, size);
    return MESO_OK;
}

void meso_composite_release(MesoComposite *composite)
{
    free(composite->vertices);
    free(composite->vertex_origins);
    free(composite->marks);
    free(composite->corners);
    free(composite->triangle_origins);
    free(composite->patches);
    free(composite->next);
    free(composite->wholes);
    free(composite->whole_vertices);
    free(composite->caps);
    free(composite->triangle_head);
    free(composite->whole_head);
    *composite = (MesoComposite){0};
}

uint32_t meso_composite_add_vertex(MesoComposite *composite, MesoQuiltVertex vertex, uint32_t origin, MesoError *error)
{
    if (composite->vertex_count == composite->vertex_room) {
        uint32_t room = larger_room(composite->vertex_room);
        if (room == composite->vertex_room || !enlarge(&composite->vertices, room, sizeof *composite->vertices) ||
            !enlarge(&composite->vertex_origins, room, sizeof *composite->vertex_origins) ||
            !enlarge(&composite->marks, room, sizeof *composite->marks)) {
            out_of_room(error, room, "vertices");
            return MESO_NO_INDEX;
        }
        composite->vertex_room = room;
    }
    uint32_t v = composite->vertex_count++;
    composite->vertices[v] = vertex;
    composite->vertex_origins[v] = origin;
    composite->marks[v] = MESO_NO_INDEX;
    return v;
}

uint32_t meso_composite_add_triangle(MesoComposite *composite, const uint32_t *corners, uint32_t origin, uint32_t patch,
                                     MesoError *error)
{
    if (composite->triangle_count == composite->triangle_room) {
        uint32_t room = larger_room(composite->triangle_room);
        if (room == composite->triangle_room || !enlarge(&composite->corners, room, 3 * sizeof *composite->corners) ||
            !enlarge(&composite->triangle_origins, room, sizeof *composite->triangle_origins) ||
            !enlarge(&composite->patches, room, sizeof *composite->patches) ||
            !enlarge(&composite->next, room, sizeof *composite->next)) {
            out_of_room(error, room, "triangles");
            return MESO_NO_INDEX;
        }
        composite->triangle_room = room;
    }
    uint32_t t = composite->triangle_count++;
    memcpy(&composite->corners[3 * (size_t)t], corners, 3 * sizeof *corners);
    composite->triangle_origins[t] = origin;
    composite->patches[t] = patch;
    uint32_t *head = &composite->triangle_head[composite->vertices[corners[0]].triangle];
    composite->next[t] = *head;
    *head = t;
    return t;
}

uint32_t meso_composite_add_whole(MesoComposite *composite, uint32_t element, uint32_t patch, MesoQuiltVertex centre,
                                  const MesoQuiltVertex *vertices, uint32_t count, MesoError *error)
{
    if (composite->whole_count == composite->whole_room) {
        uint32_t room = larger_room(composite->whole_room);
        if (room == composite->whole_room || !enlarge(&composite->wholes, room, sizeof *composite->wholes)) {
            out_of_room(error, room, "elements");
            return MESO_NO_INDEX;
        }
        composite->whole_room = room;
    }
    while (composite->whole_vertex_room - composite->whole_vertex_count < count) {
        uint32_t room = larger_room(composite->whole_vertex_room);
        if (room == composite->whole_vertex_room ||
            !enlarge(&composite->whole_vertices, room, sizeof *composite->whole_vertices)) {
            out_of_room(error, room, "vertices");
            return MESO_NO_INDEX;
        }
        composite->whole_vertex_room = room;
    }
    uint32_t whole = composite->whole_count++;
    uint32_t *head = &composite->whole_head[centre.triangle];
    composite->wholes[whole] = (MesoPlacedWhole){.element = element, .vertex_begin = composite->whole_vertex_count,
                                                 .patch = patch, .next = *head, .centre = centre};
    *head = whole;
    memcpy(&composite->whole_vertices[composite->whole_vertex_count], vertices, count * sizeof *vertices);
    composite->whole_vertex_count += count;
    return whole;
}

MesoStatus meso_composite_add_cap(MesoComposite *composite, uint32_t triangle, MesoError *error)
{
    if (composite->cap_count == composite->cap_room) {
        uint32_t room = larger_room(composite->cap_room);
        if (room == composite->cap_room || !enlarge(&composite->caps, room, sizeof *composite->caps))
            return out_of_room(error, room, "caps");
        composite->cap_room = room;
    }
    composite->caps[composite->cap_count++] = triangle;
    return MESO_OK;
}

void meso_composite_tidy(MesoComposite *composite, uint32_t base_triangle)
{
    uint32_t *link = &composite->triangle_head[base_triangle];
    while (*link != MESO_NO_INDEX) {
        if (meso_composite_is_dead(composite, *link))
            *link = composite->next[*link];
        else
            link = &composite->next[*link];
    }
    link = &composite->whole_head[base_triangle];
    while (*link != MESO_NO_INDEX) {
        if (composite->wholes[*link].dead)
            *link = composite->wholes[*link].next;
        else
            link = &composite->wholes[*link].next;
    }
}

/* ---- packing ---- */

/* Gives back what an array has beyond some room. */
static void shrink(void *array, uint32_t room, size_t width)
{
    void *smaller = realloc(*(void **)array, room * width);
    if (smaller)
        *(void **)array = smaller;
}

static uint32_t room_for(uint32_t count)
{
    return count + count / 16 + 1024;
}

/* Numbers the vertices of what lives, in their order, in `marks`, and moves them there. */
static void pack_vertices(MesoComposite *c)
{
    uint32_t kept = 0;
    for (uint32_t t = 0; t < c->triangle_count; t++)
        for (size_t k = 0; k < 3 && !meso_composite_is_dead(c, t); k++)
            c->marks[c->corners[3 * (size_t)t + k]] = 0;
    for (uint32_t v = 0; v < c->vertex_count; v++) {
        if (c->marks[v] == MESO_NO_INDEX)
            continue;
        c->vertices[kept] = c->vertices[v];
        c->vertex_origins[kept] = c->vertex_origins[v];
        c->marks[v] = kept++;
    }
    c->vertex_count = kept;
}

/* Caps that live, before their triangles move. */
static void drop_dead_caps(MesoComposite *c)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->cap_count; i++)
        if (!meso_composite_is_dead(c, c->caps[i]))
            c->caps[kept++] = c->caps[i];
    c->cap_count = kept;
}

/*
 * Moves the triangles that live. `numbers` comes to be where each has gone, and of a dead one, where the first after it
 * in its list has that lives: lists go from what is new to what is old, and so to what has moved already.
 */
static void pack_triangles(MesoComposite *c, uint32_t *numbers)
{
    uint32_t kept = 0;
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        uint32_t next = c->next[t] == MESO_NO_INDEX ? MESO_NO_INDEX : numbers[c->next[t]];
        numbers[t] = next;
        if (meso_composite_is_dead(c, t))
            continue;
        for (size_t k = 0; k < 3; k++)
            c->corners[3 * (size_t)kept + k] = c->marks[c->corners[3 * (size_t)t + k]];
        c->triangle_origins[kept] = c->triangle_origins[t];
        c->patches[kept] = c->patches[t];
        c->next[kept] = next;
        numbers[t] = kept++;
    }
    c->triangle_count = kept;
}

/* Heads of lists and caps by the new numbers. */
static void renumber_triangles(MesoComposite *c, const uint32_t *numbers)
{
    for (uint32_t b = 0; b < c->base_count; b++)
        if (c->triangle_head[b] != MESO_NO_INDEX)
            c->triangle_head[b] = numbers[c->triangle_head[b]];
    for (uint32_t i = 0; i < c->cap_count; i++)
        c->caps[i] = numbers[c->caps[i]];
}

/* Room that has once been written to is kept for what comes, but for what is far too much. */
static void fit_rooms(MesoComposite *c)
{
    uint32_t vertices = room_for(c->vertex_count), triangles = room_for(c->triangle_count);
    if (c->vertex_room > vertices + vertices / 4) {
        c->vertex_room = vertices;
        shrink(&c->vertices, vertices, sizeof *c->vertices);
        shrink(&c->vertex_origins, vertices, sizeof *c->vertex_origins);
        shrink(&c->marks, vertices, sizeof *c->marks);
    }
    if (c->triangle_room > triangles + triangles / 4) {
        c->triangle_room = triangles;
        shrink(&c->corners, triangles, 3 * sizeof *c->corners);
        shrink(&c->triangle_origins, triangles, sizeof *c->triangle_origins);
        shrink(&c->patches, triangles, sizeof *c->patches);
        shrink(&c->next, triangles, sizeof *c->next);
    }
}

static void pack_strands(MesoComposite *c)
{
    size_t size = ((size_t)c->triangle_count + 1) * sizeof(uint32_t);
    uint32_t *numbers = meso_large_take(&size), marks = c->vertex_count;
    if (!numbers)
        return;     /* another time */
    pack_vertices(c);
    drop_dead_caps(c);
    pack_triangles(c, numbers);
    renumber_triangles(c, numbers);
    meso_large_give(numbers, size);
    memset(c->marks, 0xff, marks * sizeof *c->marks);
    fit_rooms(c);
}

static void pack_wholes(MesoComposite *c, const MesoSwatch *swatch)
{
    uint32_t *numbers = malloc(((size_t)c->whole_count + 1) * sizeof *numbers), kept = 0, vertices = 0;
    if (!numbers)
        return;
    for (uint32_t w = 0; w < c->whole_count; w++) {
        MesoPlacedWhole whole = c->wholes[w];
        uint32_t count = swatch->vertex_begin[whole.element + 1] - swatch->vertex_begin[whole.element];
        whole.next = whole.next == MESO_NO_INDEX ? MESO_NO_INDEX : numbers[whole.next];
        numbers[w] = whole.next;
        if (whole.dead)
            continue;
        memmove(&c->whole_vertices[vertices], &c->whole_vertices[whole.vertex_begin],
                count * sizeof *c->whole_vertices);
        whole.vertex_begin = vertices;
        vertices += count;
        numbers[w] = kept;
        c->wholes[kept++] = whole;
    }
    for (uint32_t b = 0; b < c->base_count; b++)
        if (c->whole_head[b] != MESO_NO_INDEX)
            c->whole_head[b] = numbers[c->whole_head[b]];
    free(numbers);
    c->whole_count = kept;
    c->whole_vertex_count = vertices;
    c->whole_vertex_room = room_for(vertices);
    shrink(&c->whole_vertices, c->whole_vertex_room, sizeof *c->whole_vertices);
}

static uint32_t pack_limit(uint32_t count)
{
    double limit = PACK_RATIO * count + PACK_LEAST;
    return limit < MESO_NO_INDEX ? (uint32_t)limit : MESO_NO_INDEX;
}

void meso_composite_pack(MesoComposite *composite, const MesoSwatch *swatch)
{
    bool strands = composite->triangle_count > composite->triangle_limit;
    bool wholes = composite->whole_vertex_count > composite->whole_vertex_limit;
    if (strands) {
        pack_strands(composite);
        composite->triangle_limit = pack_limit(composite->triangle_count);
    }
    if (wholes) {
        pack_wholes(composite, swatch);
        composite->whole_vertex_limit = pack_limit(composite->whole_vertex_count);
    }
}

/* ---- the end ---- */

typedef struct Gathering {
    const MesoComposite *composite;
    const MesoSwatch *swatch;
    uint32_t *sets;             /* [vertex_count] connected vertices of strands */
    uint32_t *set_element;      /* [vertex_count] by root */
    uint32_t *renumbered;       /* [vertex_count] */
} Gathering;

static uint32_t element_vertices(const MesoSwatch *swatch, uint32_t element)
{
    return swatch->vertex_begin[element + 1] - swatch->vertex_begin[element];
}

static uint32_t element_triangles(const MesoSwatch *swatch, uint32_t element)
{
    return swatch->triangle_begin[element + 1] - swatch->triangle_begin[element];
}

static void join_strands(Gathering *g)
{
    const MesoComposite *c = g->composite;
    meso_sets_init(g->sets, c->vertex_count);
    for (uint32_t t = 0; t < c->triangle_count; t++)
        if (!meso_composite_is_dead(c, t)) {
            const uint32_t *corner = &c->corners[3 * (size_t)t];
            meso_sets_join(g->sets, corner[0], corner[1]);
            meso_sets_join(g->sets, corner[0], corner[2]);
        }
}

/* Numbers strands by their first triangle; counts, one place on, what each of them has. */
static void count_strands(MesoQuilt *quilt, Gathering *g)
{
    const MesoComposite *c = g->composite;
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        if (meso_composite_is_dead(c, t))
            continue;
        uint32_t *element = &g->set_element[meso_sets_root(g->sets, c->corners[3 * (size_t)t])];
        if (*element == MESO_NO_INDEX) {
            *element = quilt->element_count++;
            quilt->element_origins[*element] = MESO_NO_INDEX;
        }
        quilt->triangle_begin[*element + 1]++;
        for (int k = 0; k < 3; k++) {
            uint32_t v = c->corners[3 * (size_t)t + (size_t)k];
            if (g->renumbered[v] == MESO_NO_INDEX) {
                g->renumbered[v] = 0;
                quilt->vertex_begin[*element + 1]++;
            }
        }
    }
}

static void count_wholes(MesoQuilt *quilt, const Gathering *g)
{
    const MesoComposite *c = g->composite;
    for (uint32_t w = 0; w < c->whole_count; w++)
        if (!c->wholes[w].dead) {
            uint32_t element = c->wholes[w].element;
            quilt->element_origins[quilt->element_count] = element;
            quilt->element_count++;
            quilt->vertex_begin[quilt->element_count] = element_vertices(g->swatch, element);
            quilt->triangle_begin[quilt->element_count] = element_triangles(g->swatch, element);
        }
}

/* `vertex_at`, `triangle_at`: [element_count] where the next one of each element goes. */
static void fill_strands(MesoQuilt *quilt, Gathering *g, uint32_t *vertex_at, uint32_t *triangle_at)
{
    const MesoComposite *c = g->composite;
    memset(g->renumbered, 0xff, ((size_t)c->vertex_count + 1) * sizeof *g->renumbered);
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        if (meso_composite_is_dead(c, t))
            continue;
        uint32_t element = g->set_element[meso_sets_root(g->sets, c->corners[3 * (size_t)t])];
        if (quilt->element_origins[element] == MESO_NO_INDEX)
            quilt->element_origins[element] =
                meso_swatch_element(g->swatch, g->swatch->corners[3 * (size_t)c->triangle_origins[t]]);
        uint32_t to = triangle_at[element]++;
        quilt->triangle_origins[to] = c->triangle_origins[t];
        quilt->patches[to] = c->patches[t];
        for (size_t k = 0; k < 3; k++) {
            uint32_t v = c->corners[3 * (size_t)t + k];
            if (g->renumbered[v] == MESO_NO_INDEX) {
                uint32_t place = g->renumbered[v] = vertex_at[element]++;
                quilt->vertices[place] = c->vertices[v];
                quilt->origins[place] = c->vertex_origins[v];
            }
            quilt->corners[3 * (size_t)to + k] = g->renumbered[v];
        }
    }
}

static void fill_wholes(MesoQuilt *quilt, const Gathering *g, uint32_t element)
{
    const MesoComposite *c = g->composite;
    const MesoSwatch *swatch = g->swatch;
    for (uint32_t w = 0; w < c->whole_count; w++) {
        const MesoPlacedWhole *whole = &c->wholes[w];
        if (whole->dead)
            continue;
        uint32_t from = swatch->vertex_begin[whole->element], to = quilt->vertex_begin[element];
        uint32_t count = element_vertices(swatch, whole->element);
        memcpy(&quilt->vertices[to], &c->whole_vertices[whole->vertex_begin], count * sizeof *quilt->vertices);
        for (uint32_t i = 0; i < count; i++)
            quilt->origins[to + i] = from + i;
        uint32_t at = quilt->triangle_begin[element];
        for (uint32_t t = swatch->triangle_begin[whole->element]; t < swatch->triangle_begin[whole->element + 1]; t++) {
            for (size_t k = 0; k < 3; k++)
                quilt->corners[3 * (size_t)at + k] = swatch->corners[3 * (size_t)t + k] - from + to;
            quilt->triangle_origins[at] = t;
            quilt->patches[at++] = whole->patch;
        }
        element++;
    }
}

static MesoStatus gather(MesoQuilt *quilt, Gathering *g, MesoArena *arena, MesoError *error)
{
    join_strands(g);
    count_strands(quilt, g);
    uint32_t strand_count = quilt->element_count;
    count_wholes(quilt, g);
    uint64_t vertices = 0, triangles = 0;
    for (uint32_t e = 1; e <= quilt->element_count; e++) {
        vertices += quilt->vertex_begin[e];
        triangles += quilt->triangle_begin[e];
        if (vertices > MESO_NO_INDEX / 3 || triangles > MESO_NO_INDEX / 3)
            return meso_fail(error, MESO_ERR_LIMIT, "the quilt has more than %u triangles", MESO_NO_INDEX / 3);
        quilt->vertex_begin[e] = (uint32_t)vertices;
        quilt->triangle_begin[e] = (uint32_t)triangles;
    }
    quilt->vertex_count = (uint32_t)vertices;
    quilt->triangle_count = (uint32_t)triangles;
    quilt->vertices = MESO_NEW(arena, MesoQuiltVertex, vertices, error);
    quilt->origins = MESO_NEW(arena, uint32_t, vertices, error);
    quilt->corners = MESO_NEW(arena, uint32_t, 3 * triangles, error);
    quilt->triangle_origins = MESO_NEW(arena, uint32_t, triangles, error);
    quilt->patches = MESO_NEW(arena, uint32_t, triangles, error);
    uint32_t *vertex_at = MESO_NEW(arena, uint32_t, strand_count, error);
    uint32_t *triangle_at = MESO_NEW(arena, uint32_t, strand_count, error);
    if (!quilt->vertices || !quilt->origins || !quilt->corners || !quilt->triangle_origins || !quilt->patches ||
        !vertex_at || !triangle_at)
        return MESO_ERR_MEMORY;
    memcpy(vertex_at, quilt->vertex_begin, strand_count * sizeof *vertex_at);
    memcpy(triangle_at, quilt->triangle_begin, strand_count * sizeof *triangle_at);
    fill_strands(quilt, g, vertex_at, triangle_at);
    fill_wholes(quilt, g, strand_count);
    return MESO_OK;
}

MesoStatus meso_composite_finish(MesoQuilt *quilt, MesoArena *arena, const MesoComposite *composite,
                                 const MesoSwatch *swatch, MesoError *error)
{
    size_t vertices = (size_t)composite->vertex_count + 1;
    Gathering g = {.composite = composite, .swatch = swatch};
    for (uint32_t i = 0; i < composite->cap_count; i++)
        quilt->report.cap_count += !meso_composite_is_dead(composite, composite->caps[i]);
    g.sets = malloc(vertices * sizeof *g.sets);
    g.set_element = malloc(vertices * sizeof *g.set_element);
    g.renumbered = malloc(vertices * sizeof *g.renumbered);
    uint32_t sets = 0;  /* at most: a strand has three vertices or more */
    MesoStatus status = MESO_OK;
    if (!g.sets || !g.set_element || !g.renumbered) {
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u vertices", composite->vertex_count);
    } else {
        memset(g.set_element, 0xff, vertices * sizeof *g.set_element);
        memset(g.renumbered, 0xff, vertices * sizeof *g.renumbered);
        sets = composite->vertex_count / 3 + composite->whole_count;
        quilt->vertex_begin = MESO_NEW(arena, uint32_t, (size_t)sets + 2, error);
        quilt->triangle_begin = MESO_NEW(arena, uint32_t, (size_t)sets + 2, error);
        quilt->element_origins = MESO_NEW(arena, uint32_t, (size_t)sets + 1, error);
        status = quilt->vertex_begin && quilt->triangle_begin && quilt->element_origins
                     ? gather(quilt, &g, arena, error) : MESO_ERR_MEMORY;
    }
    free(g.sets);
    free(g.set_element);
    free(g.renumbered);
    return status;
}
