/* Meshes cut along their edges. */
#include "libcore/base/disjoint_sets.h"
#include "libcore/quilt/seam/clip.h"

/* A directed edge of a triangle at the cut. */
typedef struct EdgeEntry {
    uint32_t from, to;
    uint32_t half_edge;         /* of a triangle that is kept, plus 1; 0: free */
    bool dropped;               /* of one that is not */
} EdgeEntry;

typedef struct Cutter {
    const float *values;
    const uint32_t *corners;
    uint32_t vertex_count, triangle_count;
    uint8_t *touched;           /* [vertex_count] TOUCHES */
    EdgeEntry *edges;           /* [edge_room] a power of 2; of triangles at vertices of both */
    uint32_t edge_room;
    uint32_t *fans;             /* [3 * triangle_count] corners in one fan of kept triangles, by the lowest */
    uint32_t *made;             /* [3 * triangle_count] by that corner: made vertex plus 1 */
    uint32_t *next, *previous;  /* [made] along the border */
} Cutter;

enum { TOUCHES_KEPT = 1, TOUCHES_DROPPED = 2, TOUCHES_BOTH = 3 };

static uint32_t next_of(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static bool is_kept(const Cutter *c, uint32_t triangle)
{
    const uint32_t *corner = &c->corners[3 * (size_t)triangle];
    return (c->values[corner[0]] > 0) & (c->values[corner[1]] > 0) & (c->values[corner[2]] > 0);
}

static bool is_at_cut(const Cutter *c, uint32_t half_edge)
{
    return c->touched[c->corners[half_edge]] == TOUCHES_BOTH && c->touched[c->corners[next_of(half_edge)]] == TOUCHES_BOTH;
}

static EdgeEntry *entry_of(const Cutter *c, uint32_t from, uint32_t to)
{
    uint64_t hash = ((uint64_t)from << 32 | to) * UINT64_C(0x9e3779b97f4a7c15);
    uint32_t at = (uint32_t)(hash >> 32) & (c->edge_room - 1);
    while ((c->edges[at].half_edge || c->edges[at].dropped) && (c->edges[at].from != from || c->edges[at].to != to))
        at = (at + 1) & (c->edge_room - 1);
    return &c->edges[at];
}

/* Vertices of what is kept and of what is not; at how many corners both meet. */
static uint32_t mark_touched(Cutter *c)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        uint8_t touches = is_kept(c, t) ? TOUCHES_KEPT : TOUCHES_DROPPED;
        for (size_t k = 0; k < 3; k++)
            c->touched[c->corners[3 * (size_t)t + k]] |= touches;
    }
    for (uint32_t h = 0; h < 3 * c->triangle_count; h++)
        count += c->touched[c->corners[h]] == TOUCHES_BOTH;
    return count;
}

/* False where an edge is there twice. */
static bool list_edges(Cutter *c)
{
    for (uint32_t h = 0; h < 3 * c->triangle_count; h++) {
        uint32_t from = c->corners[h], to = c->corners[next_of(h)];
        if (c->touched[from] != TOUCHES_BOTH && c->touched[to] != TOUCHES_BOTH)
            continue;
        EdgeEntry *entry = entry_of(c, from, to);
        if (entry->half_edge || entry->dropped)
            return false;
        bool kept = is_kept(c, h / 3);
        *entry = (EdgeEntry){from, to, kept ? h + 1 : 0, !kept};
    }
    return true;
}

/* Corners at one vertex that kept triangles with a common edge have are one fan. */
static void join_fans(Cutter *c)
{
    for (uint32_t h = 0; h < 3 * c->triangle_count; h++) {
        uint32_t from = c->corners[h], to = c->corners[next_of(h)];
        if (!is_kept(c, h / 3) || (c->touched[from] != TOUCHES_BOTH && c->touched[to] != TOUCHES_BOTH))
            continue;
        const EdgeEntry *across = entry_of(c, to, from);
        if (!across->half_edge)
            continue;
        uint32_t twin = across->half_edge - 1;
        meso_sets_join(c->fans, h, next_of(twin));
        meso_sets_join(c->fans, next_of(h), twin);
    }
}

/* The vertex of a corner of a kept triangle, made where its fan has none yet. */
static uint32_t vertex_at(Cutter *c, MesoClip *clip, const uint32_t *kept, uint32_t h)
{
    uint32_t v = c->corners[h];
    if (c->touched[v] != TOUCHES_BOTH)
        return kept[v];
    uint32_t *made = &c->made[meso_sets_root(c->fans, h)];
    if (!*made) {
        clip->ends[2 * (size_t)clip->made_count] = clip->ends[2 * (size_t)clip->made_count + 1] = v;
        clip->shares[clip->made_count] = 0;
        c->next[clip->made_count] = c->previous[clip->made_count] = MESO_NO_INDEX;
        *made = ++clip->made_count;
    }
    return clip->kept_count + *made - 1;
}

static void take_triangles(Cutter *c, MesoClip *clip, const uint32_t *kept)
{
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        if (!is_kept(c, t))
            continue;
        for (uint32_t k = 0; k < 3; k++)
            clip->corners[3 * (size_t)clip->triangle_count + k] = vertex_at(c, clip, kept, 3 * t + k);
        clip->origins[clip->triangle_count++] = t;
    }
}

/* Edges of kept triangles across which one is not. */
static void link_border(Cutter *c, const MesoClip *clip)
{
    for (uint32_t i = 0; i < clip->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t h = 3 * clip->origins[i] + k;
            if (!is_at_cut(c, h) || !entry_of(c, c->corners[next_of(h)], c->corners[h])->dropped)
                continue;
            uint32_t from = clip->corners[3 * (size_t)i + k] - clip->kept_count;
            uint32_t to = clip->corners[3 * (size_t)i + (k + 1) % 3] - clip->kept_count;
            c->next[from] = to;
            c->previous[to] = from;
        }
}

static void add_loop(MesoClip *clip, Cutter *c, uint32_t first)
{
    uint32_t at = clip->loop_begin[clip->loop_count], made = first;
    do {
        uint32_t next = c->next[made];
        clip->loops[at++] = clip->kept_count + made;
        c->next[made] = c->previous[made] = made;   /* done */
        made = next;
    } while (made != MESO_NO_INDEX && made != first);
    clip->loop_begin[++clip->loop_count] = at;
}

/* Open ones first, from their beginnings; then what is left, which closes. Vertices of no cut edge are in none. */
static void collect_loops(MesoClip *clip, Cutter *c)
{
    for (uint32_t made = 0; made < clip->made_count; made++)
        if (c->previous[made] == MESO_NO_INDEX && c->next[made] != MESO_NO_INDEX)
            add_loop(clip, c, made);
    clip->open_count = clip->loop_count;
    for (uint32_t made = 0; made < clip->made_count; made++)
        if (c->next[made] != made && c->next[made] != MESO_NO_INDEX)
            add_loop(clip, c, made);
}

/* `made`: no more vertices than that are made. */
static MesoStatus make_room(MesoClip *clip, const Cutter *c, MesoArena *arena, uint32_t made, MesoError *error)
{
    clip->vertices = MESO_NEW(arena, uint32_t, c->vertex_count, error);
    clip->ends = MESO_NEW(arena, uint32_t, 2 * (size_t)made, error);
    clip->shares = MESO_NEW(arena, float, made, error);
    clip->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)c->triangle_count, error);
    clip->origins = MESO_NEW(arena, uint32_t, c->triangle_count, error);
    clip->loop_begin = MESO_NEW(arena, uint32_t, (size_t)made + 1, error);
    clip->loops = MESO_NEW(arena, uint32_t, made, error);
    return clip->vertices && clip->ends && clip->shares && clip->corners && clip->origins && clip->loop_begin &&
           clip->loops ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus make_scratch(Cutter *c, MesoArena *arena, uint32_t made, MesoError *error)
{
    size_t corner_count = 3 * (size_t)c->triangle_count;
    while (c->edge_room < 4 * (uint64_t)made && c->edge_room < UINT32_MAX / 2)
        c->edge_room *= 2;
    c->edges = MESO_NEW(arena, EdgeEntry, c->edge_room, error);
    c->fans = MESO_NEW(arena, uint32_t, corner_count, error);
    c->made = MESO_NEW(arena, uint32_t, corner_count, error);
    c->next = MESO_NEW(arena, uint32_t, made, error);
    c->previous = MESO_NEW(arena, uint32_t, made, error);
    return c->edges && c->fans && c->made && c->next && c->previous ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_clip_whole(MesoClip *clip, MesoArena *arena, const float *values, uint32_t vertex_count,
                           const uint32_t *corners, uint32_t triangle_count, MesoError *error)
{
    *clip = (MesoClip){0};
    Cutter c = {.values = values, .corners = corners, .vertex_count = vertex_count, .triangle_count = triangle_count,
                .edge_room = 16, .touched = MESO_NEW(arena, uint8_t, vertex_count, error)};
    if (!c.touched)
        return MESO_ERR_MEMORY;
    uint32_t made = mark_touched(&c);
    MesoStatus status = make_room(clip, &c, arena, made, error);
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(arena);
    uint32_t *kept = MESO_NEW(arena, uint32_t, vertex_count, error);
    if (!kept || make_scratch(&c, arena, made, error))
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < vertex_count; v++)
        if (c.touched[v] == TOUCHES_KEPT) {
            kept[v] = clip->kept_count;
            clip->vertices[clip->kept_count++] = v;
        }
    meso_sets_init(c.fans, 3 * triangle_count);
    bool manifold = list_edges(&c);
    if (manifold) {
        join_fans(&c);
        take_triangles(&c, clip, kept);
        link_border(&c, clip);
        collect_loops(clip, &c);
    }
    meso_arena_rewind(arena, mark);
    return manifold ? MESO_OK : meso_fail(error, MESO_ERR_INPUT, "triangles do not fit together where they are cut");
}
