#include "libcore/quilt/seam/clip.h"

#include <string.h>

/* Points at least so far from the ends of their edge: triangles of no area help nobody. */
#define SHARE_LEAST 0.01f

typedef struct EdgeEntry {
    uint32_t low, high, made;   /* made: vertex, plus 1; 0: free */
} EdgeEntry;

typedef struct Clipper {
    const float *values;
    uint32_t *kept;             /* [vertex_count] number among the kept, or MESO_NO_INDEX */
    EdgeEntry *edges;           /* [edge_room] a power of 2 */
    uint32_t edge_room;
    uint32_t *next, *previous;  /* [made] along the border */
} Clipper;

static bool is_crossed(const float *values, const uint32_t *corner)
{
    bool a = values[corner[0]] > 0, b = values[corner[1]] > 0, c = values[corner[2]] > 0;
    return a != b || b != c;
}

/* The point on the edge from a positive vertex to another, made where it is new. */
static uint32_t cross_edge(Clipper *clipper, MesoClip *clip, uint32_t positive, uint32_t other)
{
    uint32_t low = positive < other ? positive : other, high = positive < other ? other : positive;
    uint64_t hash = ((uint64_t)low << 32 | high) * UINT64_C(0x9e3779b97f4a7c15);
    uint32_t at = (uint32_t)(hash >> 32) & (clipper->edge_room - 1);
    while (clipper->edges[at].made && (clipper->edges[at].low != low || clipper->edges[at].high != high))
        at = (at + 1) & (clipper->edge_room - 1);
    if (!clipper->edges[at].made) {
        uint32_t made = clip->made_count++;
        float a = clipper->values[positive], b = clipper->values[other];
        float share = a / (a - b);
        clip->ends[2 * made] = positive;
        clip->ends[2 * made + 1] = other;
        clip->shares[made] = share > SHARE_LEAST ? share < 1 - SHARE_LEAST ? share : 1 - SHARE_LEAST : SHARE_LEAST;
        clipper->next[made] = clipper->previous[made] = MESO_NO_INDEX;
        clipper->edges[at] = (EdgeEntry){low, high, made + 1};
    }
    return clip->kept_count + clipper->edges[at].made - 1;
}

static void add_triangle(MesoClip *clip, uint32_t a, uint32_t b, uint32_t c, uint32_t origin)
{
    uint32_t *corner = &clip->corners[3 * (size_t)clip->triangle_count];
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
    clip->origins[clip->triangle_count++] = origin;
}

/* The border goes on from one made vertex to another; false where it forks. */
static bool link_border(Clipper *clipper, const MesoClip *clip, uint32_t from, uint32_t to)
{
    uint32_t a = from - clip->kept_count, b = to - clip->kept_count;
    if (clipper->next[a] != MESO_NO_INDEX || clipper->previous[b] != MESO_NO_INDEX)
        return false;
    clipper->next[a] = b;
    clipper->previous[b] = a;
    return true;
}

/*
 *      a            c         one corner kept, or two
 *     / \          / \
 *    p---q        q---p
 *   /     \      /     \
 *  b-------c    a-------b
 */
static bool cut_triangle(Clipper *clipper, MesoClip *clip, const uint32_t *corner, uint32_t origin)
{
    const float *values = clipper->values;
    uint32_t positive = (values[corner[0]] > 0 ? 1U : 0) + (values[corner[1]] > 0) + (values[corner[2]] > 0);
    uint32_t k = 0; /* the corner that is alone on its side */
    while ((values[corner[k]] > 0) != (positive == 1))
        k++;
    uint32_t lone = corner[k], after = corner[(k + 1) % 3], before = corner[(k + 2) % 3];
    if (positive == 1) {
        uint32_t p = cross_edge(clipper, clip, lone, after), q = cross_edge(clipper, clip, lone, before);
        add_triangle(clip, clipper->kept[lone], p, q, origin);
        return link_border(clipper, clip, p, q);
    }
    uint32_t p = cross_edge(clipper, clip, before, lone), q = cross_edge(clipper, clip, after, lone);
    add_triangle(clip, clipper->kept[after], clipper->kept[before], p, origin);
    add_triangle(clip, clipper->kept[after], p, q, origin);
    return link_border(clipper, clip, p, q);
}

static void add_loop(MesoClip *clip, Clipper *clipper, uint32_t first)
{
    uint32_t at = clip->loop_begin[clip->loop_count], made = first;
    do {
        uint32_t next = clipper->next[made];
        clip->loops[at++] = clip->kept_count + made;
        clipper->next[made] = clipper->previous[made] = made;   /* done */
        made = next;
    } while (made != MESO_NO_INDEX && made != first);
    clip->loop_begin[++clip->loop_count] = at;
}

/* Open ones first, from their beginnings; then what is left, which closes. */
static void collect_loops(MesoClip *clip, Clipper *clipper)
{
    for (uint32_t made = 0; made < clip->made_count; made++)
        if (clipper->previous[made] == MESO_NO_INDEX)
            add_loop(clip, clipper, made);
    clip->open_count = clip->loop_count;
    for (uint32_t made = 0; made < clip->made_count; made++)
        if (clipper->next[made] != made)
            add_loop(clip, clipper, made);
}

static MesoStatus make_room(MesoClip *clip, Clipper *clipper, MesoArena *arena, const uint32_t *corners,
                            uint32_t vertex_count, uint32_t triangle_count, MesoError *error)
{
    uint32_t crossed = 0, kept = 0, whole = 0;
    for (uint32_t v = 0; v < vertex_count; v++)
        kept += clipper->values[v] > 0;
    for (uint32_t t = 0; t < triangle_count; t++) {
        bool cut = is_crossed(clipper->values, &corners[3 * (size_t)t]);
        crossed += cut;
        whole += !cut && clipper->values[corners[3 * (size_t)t]] > 0;
    }
    clipper->edge_room = 16;
    while (clipper->edge_room < 4 * (uint64_t)crossed && clipper->edge_room < UINT32_MAX / 2)
        clipper->edge_room *= 2;
    size_t made = 2 * (size_t)crossed, triangles = whole + 2 * (size_t)crossed;
    clip->vertices = MESO_NEW(arena, uint32_t, kept, error);
    clip->ends = MESO_NEW(arena, uint32_t, 2 * made, error);
    clip->shares = MESO_NEW(arena, float, made, error);
    clip->corners = MESO_NEW(arena, uint32_t, 3 * triangles, error);
    clip->origins = MESO_NEW(arena, uint32_t, triangles, error);
    clip->loop_begin = MESO_NEW(arena, uint32_t, made + 1, error);
    clip->loops = MESO_NEW(arena, uint32_t, made, error);
    if (!clip->vertices || !clip->ends || !clip->shares || !clip->corners || !clip->origins || !clip->loop_begin ||
        !clip->loops)
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

static MesoStatus make_scratch(Clipper *clipper, MesoArena *arena, uint32_t vertex_count, MesoError *error)
{
    clipper->kept = MESO_NEW(arena, uint32_t, vertex_count, error);
    clipper->edges = MESO_NEW(arena, EdgeEntry, clipper->edge_room, error);
    clipper->next = MESO_NEW(arena, uint32_t, clipper->edge_room, error);
    clipper->previous = MESO_NEW(arena, uint32_t, clipper->edge_room, error);
    return clipper->kept && clipper->edges && clipper->next && clipper->previous ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_clip_positive(MesoClip *clip, MesoArena *arena, const float *values, uint32_t vertex_count,
                              const uint32_t *corners, uint32_t triangle_count, MesoError *error)
{
    *clip = (MesoClip){0};
    Clipper clipper = {.values = values};
    MesoStatus status = make_room(clip, &clipper, arena, corners, vertex_count, triangle_count, error);
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(arena);
    if ((status = make_scratch(&clipper, arena, vertex_count, error)))
        return status;
    for (uint32_t v = 0; v < vertex_count; v++) {
        clipper.kept[v] = values[v] > 0 ? clip->kept_count : MESO_NO_INDEX;
        if (values[v] > 0)
            clip->vertices[clip->kept_count++] = v;
    }
    bool manifold = true;
    for (uint32_t t = 0; t < triangle_count && manifold; t++) {
        const uint32_t *corner = &corners[3 * (size_t)t];
        if (is_crossed(values, corner))
            manifold = cut_triangle(&clipper, clip, corner, t);
        else if (values[corner[0]] > 0)
            add_triangle(clip, clipper.kept[corner[0]], clipper.kept[corner[1]], clipper.kept[corner[2]], t);
    }
    if (manifold)
        collect_loops(clip, &clipper);
    meso_arena_rewind(arena, mark);
    return manifold ? MESO_OK : meso_fail(error, MESO_ERR_INPUT, "triangles do not fit together where they are cut");
}

void meso_clip_positions(MesoVec3 *to, const MesoClip *clip, const MesoVec3 *positions)
{
    for (uint32_t i = 0; i < clip->kept_count; i++)
        to[i] = positions[clip->vertices[i]];
    for (uint32_t i = 0; i < clip->made_count; i++)
        to[clip->kept_count + i] = meso_vec3_lerp(positions[clip->ends[2 * i]], positions[clip->ends[2 * i + 1]],
                                                  clip->shares[i]);
}
