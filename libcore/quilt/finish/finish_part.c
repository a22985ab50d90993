/*
 * Strands that run through each other, parted. Where patches do not fit, a strand may come to cross another at its own
 * height, or to lie in one beside it. Of two that cross, the one that lies higher there on the whole goes up and the
 * other one down, as far as their sections need; of two side by side each gives way. What is next to it along the
 * strand follows. Rings move as wholes.
 */
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_part_work.h"
#include "libcore/quilt/quilt_work.h"

/* Courses are no steeper than this says. */
#define COSINE_LEAST 0.5f

/* What of their sections strands of the swatch may lie in each other before they are left as they are. */
#define SWATCH_MOST 0.2f

/* Steps of parting; each but the last ones is smoothed after, less and less, so that none is given back in the end. */
enum { STEPS = 32, SMOOTH_STEPS = 24 };

/* Of what is before and after a ring, at first. */
#define SMOOTH 0.25f

/* What becomes of rings. */
typedef struct Moves {
    MesoVec3 *asides;                   /* [ring_count] along the surface */
    float *heights;                     /* [ring_count] */
} Moves;

/* What rings are made of. */
typedef struct Tubes {
    uint32_t vertex_count, triangle_count;
    const MesoVec3 *feet;               /* [vertex_count] */
    const float *heights;               /* [vertex_count] */
    const uint32_t *corners;            /* [3 * triangle_count] */
    uint32_t *of_vertex;                /* [vertex_count] ring, or MESO_NO_INDEX */
} Tubes;

/* ---- rings ---- */

static void link_rings(MesoPartRing *rings, uint32_t a, uint32_t b)
{
    MesoVec3 d = meso_vec3_sub(rings[b].foot, rings[a].foot);
    MesoPartRing *ring = &rings[a];
    ring->step += meso_vec3_length(d);
    ring->links++;
    float side = meso_vec3_dot(ring->axis, d) < 0 ? -1 : 1;
    ring->axis = meso_vec3_mad(ring->axis, side, d);
    if (ring->next[0] == MESO_NO_INDEX)
        ring->next[0] = b;
    else if (ring->next[0] != b && ring->next[1] == MESO_NO_INDEX)
        ring->next[1] = b;
}

/* Of a strand's course against the surface. */
static float cosine_of(const MesoPartRing *rings, uint32_t r)
{
    const MesoPartRing *a = &rings[rings[r].next[0] == MESO_NO_INDEX ? r : rings[r].next[0]];
    const MesoPartRing *b = &rings[rings[r].next[1] == MESO_NO_INDEX ? r : rings[r].next[1]];
    float way = meso_vec3_length(meso_vec3_sub(b->foot, a->foot)), rise = b->height - a->height;
    float length = sqrtf(way * way + rise * rise);
    return length > 0 ? fmaxf(way / length, COSINE_LEAST) : 1;
}

static void measure_rings(MesoPartRing *rings, uint32_t count, const Tubes *tubes)
{
    for (uint32_t r = 0; r < count; r++)
        rings[r] = (MesoPartRing){.next = {MESO_NO_INDEX, MESO_NO_INDEX}, .low = INFINITY, .high = -INFINITY};
    for (uint32_t v = 0; v < tubes->vertex_count; v++) {
        if (tubes->of_vertex[v] == MESO_NO_INDEX)
            continue;
        MesoPartRing *ring = &rings[tubes->of_vertex[v]];
        ring->first = ring->count++ ? ring->first : v;
        ring->foot = meso_vec3_add(ring->foot, tubes->feet[v]);
        ring->height += tubes->heights[v];
        ring->low = fminf(ring->low, tubes->heights[v]);
        ring->high = fmaxf(ring->high, tubes->heights[v]);
    }
    for (uint32_t r = 0; r < count; r++) {
        rings[r].foot = meso_vec3_scale(rings[r].foot, 1 / (float)rings[r].count);
        rings[r].height /= (float)rings[r].count;
        rings[r].half_height = (rings[r].high - rings[r].low) / 2;
    }
    for (uint32_t c = 0; c < 3 * tubes->triangle_count; c++) {
        uint32_t a = tubes->of_vertex[tubes->corners[c]], b = tubes->of_vertex[tubes->corners[meso_next_corner(c)]];
        if (a == b || a == MESO_NO_INDEX || b == MESO_NO_INDEX)
            continue;
        link_rings(rings, a, b);
        link_rings(rings, b, a);
    }
    for (uint32_t r = 0; r < count; r++) {
        rings[r].axis = meso_vec3_direction(rings[r].axis, (MesoVec3){0, 0, 0});
        rings[r].step = rings[r].links ? rings[r].step / (float)rings[r].links : 0;
    }
    for (uint32_t r = 0; r < count; r++)
        rings[r].thickness = rings[r].half_height / cosine_of(rings, r);
    for (uint32_t v = 0; v < tubes->vertex_count; v++) {
        if (tubes->of_vertex[v] == MESO_NO_INDEX)
            continue;
        MesoPartRing *ring = &rings[tubes->of_vertex[v]];
        MesoVec3 off = meso_vec3_sub(tubes->feet[v], ring->foot);
        ring->side = meso_vec3_dot(off, off) > meso_vec3_dot(ring->side, ring->side) ? off : ring->side;
        off = meso_vec3_mad(off, -meso_vec3_dot(off, ring->axis), ring->axis);
        ring->half_width = fmaxf(ring->half_width, meso_vec3_length(off));
    }
}

static MesoStatus build(MesoParting *s, const MesoFinishWork *work, const Tubes *tubes, uint32_t ring_count,
                        MesoError *error)
{
    *s = (MesoParting){.ring_count = ring_count, .thread_count = work->options->thread_count, .arena = work->arena};
    s->rings = MESO_NEW(s->arena, MesoPartRing, ring_count, error);
    if (!s->rings)
        return MESO_ERR_MEMORY;
    measure_rings(s->rings, ring_count, tubes);
    return MESO_OK;
}

/* ---- parting ---- */

/* Of two that cross, by how much they are nearer to each other than their sections need. */
static float lacking(const MesoParting *s, const MesoPartContact *contact, const Moves *moves)
{
    float apart = s->rings[contact->ring].height - s->rings[contact->other].height;
    if (moves)
        apart += moves->heights[contact->ring] - moves->heights[contact->other];
    return contact->gap - contact->sign * apart;
}

/* The same of two side by side, whose sections are ellipses; `way`: to the ring, along the surface. */
static float lacking_beside(MesoVec3 *way, const MesoParting *s, const MesoPartContact *contact, const Moves *moves)
{
    const MesoPartRing *a = &s->rings[contact->ring], *b = &s->rings[contact->other];
    MesoVec3 d = meso_vec3_sub(a->foot, b->foot);
    float up = a->height - b->height, high = a->half_height + b->half_height;
    if (moves) {
        d = meso_vec3_add(d, meso_vec3_sub(moves->asides[contact->ring], moves->asides[contact->other]));
        up += moves->heights[contact->ring] - moves->heights[contact->other];
    }
    if (!(fabsf(up) < high))
        return 0;
    d = meso_vec3_mad(d, -meso_vec3_dot(d, b->axis), b->axis);
    d = meso_vec3_mad(d, -meso_vec3_dot(d, a->normal), a->normal);
    *way = meso_vec3_direction(d, meso_vec3_cross(a->normal, b->axis));
    return MESO_PART_ROOM * (a->half_width + b->half_width) * sqrtf(1 - up * up / (high * high)) - meso_vec3_length(d);
}

static void push_apart(const MesoParting *s, MesoVec3 *pushes, const MesoPartContact *contact, const Moves *moves)
{
    MesoVec3 way;
    float lack = lacking_beside(&way, s, contact, moves);
    if (!(lack > 0))
        return;
    /* the other one is in contact with this one, too, mostly: each does half of it */
    pushes[contact->ring] = meso_vec3_mad(pushes[contact->ring], lack / 4, way);
    pushes[contact->other] = meso_vec3_mad(pushes[contact->other], -lack / 4, way);
}

/* The layer: that of the swatch. */
typedef struct Bounds {
    float low, high;
} Bounds;

/* What moves are made of. */
typedef struct Pushes {
    float *ups, *downs;                 /* [ring_count] */
    MesoVec3 *asides;                   /* [ring_count] */
} Pushes;

/* Each of two that cross does half of it; where there is no room in the layer, the other one does the rest. */
static void push_over(const MesoParting *s, Pushes *pushes, const MesoPartContact *contact, const Moves *moves,
                      Bounds bounds)
{
    float lack = lacking(s, contact, moves);
    uint32_t upper = contact->sign > 0 ? contact->ring : contact->other;
    uint32_t lower = contact->sign > 0 ? contact->other : contact->ring;
    float above = fmaxf(bounds.high - s->rings[upper].high - moves->heights[upper], 0);
    float below = fmaxf(s->rings[lower].low + moves->heights[lower] - bounds.low, 0);
    float up = fminf(fmaxf(lack / 2, lack - below), above), down = fminf(lack - up, below);
    pushes->ups[upper] = fmaxf(pushes->ups[upper], up);
    pushes->downs[lower] = fmaxf(pushes->downs[lower], down);
}

static void push(const MesoParting *s, Moves *moves, Pushes *pushes, Bounds bounds)
{
    memset(pushes->ups, 0, s->ring_count * sizeof *pushes->ups);
    memset(pushes->downs, 0, s->ring_count * sizeof *pushes->downs);
    memset(pushes->asides, 0, s->ring_count * sizeof *pushes->asides);
    for (uint32_t k = 0; k < s->contact_count; k++) {
        const MesoPartContact *contact = &s->contacts[k];
        if (contact->beside)
            push_apart(s, pushes->asides, contact, moves);
        else
            push_over(s, pushes, contact, moves, bounds);
    }
    for (uint32_t r = 0; r < s->ring_count; r++) {
        moves->heights[r] += pushes->ups[r] - pushes->downs[r];
        moves->asides[r] = meso_vec3_add(moves->asides[r], pushes->asides[r]);
    }
}

/* Rings do not leave the layer, and go aside no further than they are wide. */
static void bound(Moves *moves, const MesoPartRing *ring, uint32_t r, Bounds bounds)
{
    moves->heights[r] = fmaxf(moves->heights[r], fminf(0, bounds.low - ring->low));
    moves->heights[r] = fminf(moves->heights[r], fmaxf(0, bounds.high - ring->high));
    float length = meso_vec3_length(moves->asides[r]);
    if (ring->held)
        moves->asides[r] = (MesoVec3){0, 0, 0};
    else if (length > ring->half_width)
        moves->asides[r] = meso_vec3_scale(moves->asides[r], ring->half_width / length);
}

/* What is before and after a ring has that share each, a quarter for ways aside; `before` is scratch. */
static void smooth(const MesoParting *s, Moves *moves, Pushes *before, Bounds bounds, float share)
{
    memcpy(before->ups, moves->heights, s->ring_count * sizeof *before->ups);
    memcpy(before->asides, moves->asides, s->ring_count * sizeof *before->asides);
    for (uint32_t r = 0; r < s->ring_count; r++) {
        const uint32_t *next = s->rings[r].next;
        uint32_t a = next[0] == MESO_NO_INDEX ? r : next[0], b = next[1] == MESO_NO_INDEX ? r : next[1];
        moves->heights[r] = before->ups[r] * (1 - 2 * share) + (before->ups[a] + before->ups[b]) * share;
        moves->asides[r] = meso_vec3_mad(meso_vec3_scale(before->asides[r], 0.5f), 0.25f,
                                         meso_vec3_add(before->asides[a], before->asides[b]));
        bound(moves, &s->rings[r], r, bounds);
    }
}

static bool is_lacking(const MesoParting *s, const MesoPartContact *contact)
{
    MesoVec3 way;
    return (contact->beside ? lacking_beside(&way, s, contact, NULL) : lacking(s, contact, NULL)) > 0;
}

/* `any`: something lies in something else. */
static MesoStatus find_moves(Moves *moves, bool *any, const MesoParting *s, Bounds bounds, MesoError *error)
{
    *any = false;
    for (uint32_t k = 0; k < s->contact_count && !*any; k++)
        *any = is_lacking(s, &s->contacts[k]);
    if (!*any)
        return MESO_OK;
    uint32_t count = s->ring_count;
    Pushes pushes = {MESO_NEW(s->arena, float, count, error), MESO_NEW(s->arena, float, count, error),
                     MESO_NEW(s->arena, MesoVec3, count, error)};
    *moves = (Moves){MESO_NEW(s->arena, MesoVec3, count, error), MESO_NEW(s->arena, float, count, error)};
    if (!pushes.ups || !pushes.downs || !pushes.asides || !moves->asides || !moves->heights)
        return MESO_ERR_MEMORY;
    for (int step = 0; step < STEPS; step++) {
        push(s, moves, &pushes, bounds);
        smooth(s, moves, &pushes, bounds, SMOOTH * fmaxf(0, 1 - (float)step / SMOOTH_STEPS));
    }
    return MESO_OK;
}

/* ---- of the swatch, and of the quilt ---- */

/* Whether strands of the swatch lie in each other: then that is how it looks. */
static MesoStatus look_at_swatch(bool *parted, const MesoStrandRings *named, const MesoFinishWork *work,
                                 MesoError *error)
{
    MesoParting s;
    const MesoSwatch *swatch = work->swatch;
    MesoArena *arena = work->arena;
    MesoVec3 *feet = MESO_NEW(arena, MesoVec3, swatch->vertex_count, error);
    float *heights = MESO_NEW(arena, float, swatch->vertex_count, error);
    if (!feet || !heights)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < swatch->vertex_count; v++) {
        feet[v] = (MesoVec3){swatch->positions[v].x, swatch->positions[v].y, 0};
        heights[v] = swatch->positions[v].z;
    }
    const Tubes tubes = {swatch->vertex_count, swatch->triangle_count, feet,
                         heights, swatch->corners, named->of_vertex};
    MesoStatus status = build(&s, work, &tubes, named->count, error);
    for (uint32_t r = 0; r < named->count && !status; r++)
        s.rings[r].normal = (MesoVec3){0, 0, 1};
    if (!status)
        status = meso_part_find_contacts(&s, error);
    if (status)
        return status;
    *parted = true;
    for (uint32_t k = 0; k < s.contact_count && *parted; k++)
        *parted = s.contacts[k].beside || lacking(&s, &s.contacts[k], NULL) <= SWATCH_MOST * s.contacts[k].gap;
    return MESO_OK;
}

/* Rings of the swatch, as far as they hang together here. */
static uint32_t name_rings(uint32_t *of_vertex, uint32_t *sets, const MesoStrandRings *named,
                           const MesoFinishWork *work)
{
    uint32_t count = 0;
    meso_sets_init(sets, work->vertex_count);
    for (uint32_t v = 0; v < work->vertex_count; v++)
        of_vertex[v] = named->of_vertex[work->origins[v]];
    for (uint32_t c = 0; c < 3 * work->triangle_count; c++) {
        uint32_t a = work->corners[c], b = work->corners[meso_next_corner(c)];
        if (of_vertex[a] == of_vertex[b] && of_vertex[a] != MESO_NO_INDEX)
            meso_sets_join(sets, a, b);
    }
    for (uint32_t v = 0; v < work->vertex_count; v++)
        if (of_vertex[v] != MESO_NO_INDEX) {
            uint32_t root = meso_sets_root(sets, v);
            of_vertex[v] = root == v ? count++ : of_vertex[root];
        }
    return count;
}

static MesoVec3 normal_under(const MesoFinishWork *work, uint32_t vertex)
{
    const MesoTriangulation *mesh = &work->base->mesh;
    const uint32_t *corners = &mesh->corners[3 * (size_t)work->vertices[vertex].triangle];
    MesoVec3 a = mesh->positions[corners[0]], b = meso_vec3_sub(mesh->positions[corners[1]], a);
    return meso_vec3_direction(meso_vec3_cross(b, meso_vec3_sub(mesh->positions[corners[2]], a)), (MesoVec3){0, 0, 0});
}

/* Borders have made some of a ring: it stays where they are. */
static void hold_borders(MesoParting *s, const Tubes *tubes, const MesoFinishWork *work)
{
    for (uint32_t v = 0; v < tubes->vertex_count; v++)
        if (work->at_border[v] && tubes->of_vertex[v] != MESO_NO_INDEX)
            s->rings[tubes->of_vertex[v]].held = true;
}

static void move_vertex(MesoFinishWork *work, uint32_t v, MesoVec3 foot, MesoVec3 aside, float up)
{
    MesoQuiltVertex *vertex = &work->vertices[v];
    if (aside.x != 0 || aside.y != 0 || aside.z != 0)
        *vertex = meso_finish_locate(work, vertex->triangle, meso_vec3_add(foot, aside), vertex->height);
    vertex->height += up;
}

/* Vertices are moved by blocks of so many. */
enum { BLOCK = 4096 };

typedef struct Mover {
    MesoFinishWork *work;
    const Tubes *tubes;
    const Moves *moves;
} Mover;

static void move_range(void *context, uint64_t begin, uint64_t end)
{
    const Mover *m = context;
    for (uint32_t v = (uint32_t)begin; v < end; v++) {
        uint32_t ring = m->tubes->of_vertex[v];
        if (ring != MESO_NO_INDEX)
            move_vertex(m->work, v, m->tubes->feet[v], m->moves->asides[ring], m->moves->heights[ring]);
    }
}

static MesoStatus part_quilt(MesoFinishWork *work, const MesoStrandRings *named, MesoError *error)
{
    uint32_t n = work->vertex_count;
    MesoArena *arena = work->arena;
    uint32_t *of_vertex = MESO_NEW(arena, uint32_t, n, error), *sets = MESO_NEW(arena, uint32_t, n, error);
    MesoVec3 *feet = MESO_NEW(arena, MesoVec3, n, error);
    float *heights = MESO_NEW(arena, float, n, error);
    if (!of_vertex || !sets || !feet || !heights)
        return MESO_ERR_MEMORY;
    uint32_t count = name_rings(of_vertex, sets, named, work);
    for (uint32_t v = 0; v < n; v++) {
        feet[v] = meso_finish_foot(work, work->vertices[v]);
        heights[v] = work->vertices[v].height;
    }
    MesoParting s;
    Moves moves;
    bool any;
    const Tubes tubes = {n, work->triangle_count, feet, heights, work->corners, of_vertex};
    MesoStatus status = build(&s, work, &tubes, count, error);
    for (uint32_t r = 0; r < count && !status; r++)
        s.rings[r].normal = normal_under(work, s.rings[r].first);
    if (!status)
        status = meso_part_find_contacts(&s, error);
    if (status)
        return status;
    hold_borders(&s, &tubes, work);
    const MesoFinishOptions *o = work->options;
    float top = o->offset + (o->height_scale > 0 ? o->height_scale : o->scale) * work->swatch->size.z;
    status = find_moves(&moves, &any, &s, (Bounds){o->offset, top}, error);
    if (!status && any)
        meso_parallel_for(o->thread_count, n, BLOCK, move_range, &(Mover){work, &tubes, &moves});
    return status;
}

MesoStatus meso_finish_part(MesoFinishWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->arena);
    MesoStrandRings named;
    bool parted = false, has_strands = false;
    for (uint32_t e = 0; e < work->swatch->element_count; e++)
        has_strands |= work->swatch->kinds[e] == MESO_ELEMENT_STRAND;
    if (!has_strands)
        return MESO_OK;
    MesoStatus status = meso_strands_find_rings(&named, work->swatch, work->arena, error);
    if (!status)
        status = look_at_swatch(&parted, &named, work, error);
    if (!status && parted)
        status = part_quilt(work, &named, error);
    meso_arena_rewind(work->arena, mark);
    return status;
}
