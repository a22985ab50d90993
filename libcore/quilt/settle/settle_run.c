/* Settling from a quilt to a quilt. */
#include "libcore/quilt/settle/quilt_settle.h"

#include <string.h>

#include "libcore/quilt/settle/settle_work.h"

/* How far beyond the heights that there are a body may reach, as a share of their range: the surface bends under it. */
#define HEIGHT_SLACK 0.3f

/* Heights as a share of their range that make no other layer. */
#define SAME_HEIGHT 0.01f

enum { FILLS = 2, RELAX_ROUNDS = 48, LAYER_ROUNDS = 4 };

typedef struct Settling {
    MesoSettleWork work;
    const MesoQuilt *before;
    MesoArena laid;             /* of: */
    MesoVec3 *positions;        /* [before->vertex_count], until what comes to be is known */
    uint32_t *body_of;          /* [before->element_count] that has it as its first member, or MESO_NO_INDEX */
    MesoQuiltVertex *places;    /* [point_count] of all bodies, one after the other */
    uint32_t *place_begin;      /* [body_count] */
    bool *kept;                 /* [body_count] it stays as it was */
    uint32_t *kept_bodies;      /* [kept_count] those */
    uint32_t kept_count;
} Settling;

static MesoStatus make_layer(Settling *s, MesoQuiltHeights heights, MesoError *error)
{
    MesoPrismReport report;
    return meso_quilt_layer(s->work.directions, &report, s->work.surface, heights, s->work.options.thread_count,
                            error);
}

static MesoStatus embed(Settling *s, MesoError *error)
{
    MesoQuiltHeights heights = meso_quilt_heights(s->before);
    float slack = HEIGHT_SLACK * (heights.high - heights.low);
    s->work.low = heights.low - slack;
    s->work.high = heights.high + slack;
    s->work.directions = MESO_NEW(s->work.arena, MesoVec3, s->work.surface->vertex_count, error);
    s->positions = MESO_NEW(&s->laid, MesoVec3, s->before->vertex_count, error);
    if (!s->work.directions || !s->positions)
        return MESO_ERR_MEMORY;
    MesoStatus status = make_layer(s, heights, error);
    if (!status)
        meso_quilt_embed(s->positions, s->before, s->work.surface, s->work.directions, 1);
    return status;
}

static MesoStatus list_bodies(Settling *s, MesoError *error)
{
    s->body_of = MESO_NEW(s->work.arena, uint32_t, s->before->element_count, error);
    if (!s->body_of)
        return MESO_ERR_MEMORY;
    memset(s->body_of, 0xff, s->before->element_count * sizeof *s->body_of);
    for (uint32_t b = 0; b < s->work.body_count; b++)
        s->body_of[s->work.bodies[b].element] = b;
    return MESO_OK;
}

/* Where there are strands, bodies are where the strands have them. */
static MesoStatus arrange(Settling *s, MesoError *error)
{
    MesoSettleWork *work = &s->work;
    if (!work->alone || !(work->spacing > 0) || !work->body_count)
        return MESO_OK;
    if (work->fixed)
        return work->options.partial ? MESO_OK : meso_settle_fill(work, error);
    MesoStatus status = MESO_OK;
    meso_settle_relax(work, RELAX_ROUNDS);
    for (int i = 0; i < FILLS && !status && !work->options.partial; i++) {
        status = meso_settle_fill(work, error);
        if (!status)
            meso_settle_relax(work, RELAX_ROUNDS);
    }
    if (status)
        return status;
    meso_settle_part(work);
    work->careful = true;   /* where others have gone */
    return work->linked && !work->options.partial ? meso_settle_fill(work, error) : MESO_OK;
}

/* ---- back into the layer ---- */

/* From the place before it along the body, or from where the vertex was. */
static bool place_point(MesoQuiltVertex *place, float *beyond, const Settling *s, const MesoSettleBody *body,
                        uint32_t i)
{
    MesoVec3 point = meso_settle_body_point(&s->work, body, i);
    if (meso_settle_locate(place, beyond, &s->work, point))
        return true;
    uint32_t element = body->element;
    if (element == MESO_NO_INDEX || i >= s->before->vertex_begin[element + 1] - s->before->vertex_begin[element])
        return false;
    *place = s->before->vertices[s->before->vertex_begin[element] + i];
    return meso_settle_locate(place, beyond, &s->work, point);
}

static bool place_body(Settling *s, uint32_t b, MesoQuiltVertex *places)
{
    const MesoSettleBody *body = &s->work.bodies[b];
    MesoQuiltVertex place = body->place;
    float beyond, overhang = body->stays ? INFINITY : s->work.options.overhang;
    for (uint32_t i = 0; i < s->work.kinds[body->kind].point_count; i++) {
        if (!place_point(&place, &beyond, s, body, i) || beyond > overhang ||
            place.height < s->work.low || place.height > s->work.high)
            return false;
        places[i] = place;
    }
    return true;
}

/* A rigid body that the layer is too low for is bent with it; one that does not fit then either is kept as it was. */
static MesoStatus place_or_bend(Settling *s, uint32_t b, MesoQuiltVertex *places, MesoError *error)
{
    MesoSettleBody *body = &s->work.bodies[b];
    s->kept[b] = !place_body(s, b, places);
    if (!s->kept[b] || body->points || body->element == MESO_NO_INDEX)
        return MESO_OK;
    MesoStatus status = meso_settle_bend(body, &s->work, &s->positions[s->before->vertex_begin[body->element]], error);
    s->kept[b] = !body->points || !place_body(s, b, places);
    return status;
}

static void add_height(MesoQuiltHeights *heights, float height)
{
    heights->low = fminf(heights->low, height);
    heights->high = fmaxf(heights->high, height);
}

static bool are_alike(MesoQuiltHeights a, MesoQuiltHeights b)
{
    float most = SAME_HEIGHT * (b.high - b.low);
    return fabsf(a.low - b.low) <= most && fabsf(a.high - b.high) <= most;
}

/* `heights`: those that the layer has to have then, with strands and what is kept. */
static MesoStatus place_bodies(Settling *s, MesoQuiltHeights *heights, MesoError *error)
{
    const MesoQuilt *before = s->before;
    *heights = (MesoQuiltHeights){0, 0};
    for (uint32_t e = 0; e < before->element_count; e++)
        for (uint32_t v = before->vertex_begin[e];
             s->body_of[e] == MESO_NO_INDEX && v < before->vertex_begin[e + 1]; v++)
            add_height(heights, before->vertices[v].height);
    for (uint32_t b = 0; b < s->work.body_count; b++) {
        if (s->work.bodies[b].gone || s->kept[b])
            continue;
        MesoQuiltVertex *places = &s->places[s->place_begin[b]];
        MesoStatus status = place_or_bend(s, b, places, error);
        if (status)
            return status;
        for (uint32_t i = 0; i < s->work.kinds[s->work.bodies[b].kind].point_count && !s->kept[b]; i++)
            add_height(heights, places[i].height);
    }
    return MESO_OK;
}

/* The layer has to be as high as the bodies are, which says anew where in it they are. */
static MesoStatus place_all(Settling *s, MesoError *error)
{
    uint64_t count = 0;
    MesoSettleWork *work = &s->work;
    s->place_begin = MESO_NEW(work->arena, uint32_t, work->body_count, error);
    s->kept = MESO_NEW(work->arena, bool, work->body_count, error);
    if (!s->place_begin || !s->kept)
        return MESO_ERR_MEMORY;
    for (uint32_t b = 0; b < work->body_count; b++) {
        s->place_begin[b] = (uint32_t)count;
        count += work->bodies[b].gone ? 0 : work->kinds[work->bodies[b].kind].point_count;
        if (count > MESO_NO_INDEX / 3)
            return meso_fail(error, MESO_ERR_LIMIT, "the quilt has more than %u vertices", MESO_NO_INDEX / 3);
    }
    s->places = MESO_NEW(work->arena, MesoQuiltVertex, count, error);
    if (!s->places)
        return MESO_ERR_MEMORY;
    MesoQuiltHeights made = meso_quilt_heights(s->before), wanted;
    MesoStatus status = place_bodies(s, &wanted, error);
    for (int i = 0; i < LAYER_ROUNDS && !status && !are_alike(made, wanted); i++) {
        made = wanted;
        status = make_layer(s, made, error);
        if (!status)
            status = place_bodies(s, &wanted, error);
    }
    return status;
}

/* ---- the quilt ---- */

/* An element as it comes to be: as it was, or a member of a body. */
typedef struct Source {
    uint32_t origin;            /* of the swatch */
    uint32_t element;           /* of the quilt before; MESO_NO_INDEX: it is placed anew */
    uint32_t patch;             /* where it is placed anew */
    const MesoQuiltVertex *places;
} Source;

typedef struct Sources {
    Source *list;
    uint32_t count;
} Sources;

static void add_body(Sources *sources, const Settling *s, uint32_t b)
{
    const MesoSettleBody *body = &s->work.bodies[b];
    const MesoSettleKind *kind = &s->work.kinds[body->kind];
    const uint32_t *begin = s->work.swatch->vertex_begin;
    uint32_t at = s->place_begin[b];
    for (uint32_t m = kind->member_begin; m < kind->member_end; m++) {
        uint32_t origin = s->work.members[m];
        sources->list[sources->count++] = (Source){origin, MESO_NO_INDEX, body->patch, &s->places[at]};
        at += begin[origin + 1] - begin[origin];
    }
}

/* The body that a carried element of the quilt belongs to; MESO_NO_INDEX: it has lost it. */
static uint32_t carrier_of(const Settling *s, uint32_t element)
{
    const MesoSettleWork *work = &s->work;
    uint32_t origin = s->before->element_origins[element], best = MESO_NO_INDEX;
    float least = INFINITY;
    for (uint32_t i = 0; i < s->kept_count; i++) {
        uint32_t b = s->kept_bodies[i];
        const MesoSettleBody *body = &work->bodies[b];
        if (body->patch != s->before->patches[s->before->triangle_begin[element]])
            continue;
        const MesoSettleKind *kind = &work->kinds[body->kind];
        bool carries = false;
        for (uint32_t m = kind->member_begin + 1; m < kind->member_end; m++)
            carries |= work->members[m] == origin;
        MesoVec3 p = s->positions[s->before->vertex_begin[element]];
        float d = meso_vec3_length(meso_vec3_sub(p, body->pose.origin));
        if (carries && d < 2 * kind->reach && d < least) {
            least = d;
            best = b;
        }
    }
    return best;
}

static MesoStatus list_sources(Sources *sources, Settling *s, MesoError *error)
{
    const MesoSettleWork *work = &s->work;
    const MesoQuilt *before = s->before;
    uint64_t most = before->element_count;
    for (uint32_t b = 0; b < work->body_count; b++)
        most += work->kinds[work->bodies[b].kind].member_end - work->kinds[work->bodies[b].kind].member_begin;
    sources->list = MESO_NEW(work->arena, Source, most, error);
    s->kept_bodies = MESO_NEW(work->arena, uint32_t, work->body_count, error);
    if (!sources->list || !s->kept_bodies)
        return MESO_ERR_MEMORY;
    for (uint32_t b = 0; b < work->body_count; b++)
        if (s->kept[b])
            s->kept_bodies[s->kept_count++] = b;
    for (uint32_t e = 0; e < before->element_count; e++) {
        uint32_t origin = before->element_origins[e], b = s->body_of[e];
        bool carried = work->swatch->kinds[origin] == MESO_ELEMENT_WHOLE && work->kind_of[origin] == MESO_NO_INDEX;
        if (b != MESO_NO_INDEX && work->bodies[b].gone)
            continue;
        if (b != MESO_NO_INDEX && !s->kept[b])
            add_body(sources, s, b);
        else if (!carried || carrier_of(s, e) != MESO_NO_INDEX)
            sources->list[sources->count++] = (Source){origin, e, 0, NULL};
    }
    for (uint32_t b = 0; b < work->body_count; b++)
        if (work->bodies[b].element == MESO_NO_INDEX && !work->bodies[b].gone && !s->kept[b])
            add_body(sources, s, b);
    return MESO_OK;
}

static MesoStatus make_room(MesoQuilt *quilt, MesoArena *arena, const Settling *s, const Sources *sources,
                            MesoError *error)
{
    const MesoQuilt *before = s->before;
    const MesoSwatch *swatch = s->work.swatch;
    quilt->element_count = sources->count;
    quilt->vertex_begin = MESO_NEW(arena, uint32_t, (size_t)sources->count + 1, error);
    quilt->triangle_begin = MESO_NEW(arena, uint32_t, (size_t)sources->count + 1, error);
    quilt->element_origins = MESO_NEW(arena, uint32_t, sources->count, error);
    if (!quilt->vertex_begin || !quilt->triangle_begin || !quilt->element_origins)
        return MESO_ERR_MEMORY;
    uint64_t vertices = 0, triangles = 0;
    for (uint32_t e = 0; e < sources->count; e++) {
        const Source *source = &sources->list[e];
        bool old = source->element != MESO_NO_INDEX;
        uint32_t from = old ? source->element : source->origin;
        const uint32_t *v = old ? before->vertex_begin : swatch->vertex_begin;
        const uint32_t *t = old ? before->triangle_begin : swatch->triangle_begin;
        vertices += v[from + 1] - v[from];
        triangles += t[from + 1] - t[from];
        if (vertices > MESO_NO_INDEX / 3 || triangles > MESO_NO_INDEX / 3)
            return meso_fail(error, MESO_ERR_LIMIT, "the quilt has more than %u triangles", MESO_NO_INDEX / 3);
        quilt->element_origins[e] = source->origin;
        quilt->vertex_begin[e + 1] = (uint32_t)vertices;
        quilt->triangle_begin[e + 1] = (uint32_t)triangles;
    }
    quilt->vertex_count = (uint32_t)vertices;
    quilt->triangle_count = (uint32_t)triangles;
    quilt->vertices = MESO_NEW(arena, MesoQuiltVertex, vertices, error);
    quilt->origins = MESO_NEW(arena, uint32_t, vertices, error);
    quilt->corners = MESO_NEW(arena, uint32_t, 3 * triangles, error);
    quilt->triangle_origins = MESO_NEW(arena, uint32_t, triangles, error);
    quilt->patches = MESO_NEW(arena, uint32_t, triangles, error);
    return quilt->vertices && quilt->origins && quilt->corners && quilt->triangle_origins && quilt->patches
               ? MESO_OK : MESO_ERR_MEMORY;
}

static void copy_old(MesoQuilt *quilt, const MesoQuilt *before, uint32_t to, uint32_t from)
{
    uint32_t first = before->vertex_begin[from], place = quilt->vertex_begin[to];
    for (uint32_t v = first; v < before->vertex_begin[from + 1]; v++) {
        quilt->vertices[v - first + place] = before->vertices[v];
        quilt->origins[v - first + place] = before->origins[v];
    }
    uint32_t at = quilt->triangle_begin[to];
    for (uint32_t t = before->triangle_begin[from]; t < before->triangle_begin[from + 1]; t++, at++) {
        for (size_t k = 0; k < 3; k++)
            quilt->corners[3 * (size_t)at + k] = before->corners[3 * (size_t)t + k] - first + place;
        quilt->triangle_origins[at] = before->triangle_origins[t];
        quilt->patches[at] = before->patches[t];
    }
}

static void copy_new(MesoQuilt *quilt, const MesoSwatch *swatch, uint32_t to, const Source *source)
{
    uint32_t first = swatch->vertex_begin[source->origin], place = quilt->vertex_begin[to];
    for (uint32_t v = first; v < swatch->vertex_begin[source->origin + 1]; v++) {
        quilt->vertices[v - first + place] = source->places[v - first];
        quilt->origins[v - first + place] = v;
    }
    uint32_t at = quilt->triangle_begin[to];
    uint32_t end = swatch->triangle_begin[source->origin + 1];
    for (uint32_t t = swatch->triangle_begin[source->origin]; t < end; t++, at++) {
        for (size_t k = 0; k < 3; k++)
            quilt->corners[3 * (size_t)at + k] = swatch->corners[3 * (size_t)t + k] - first + place;
        quilt->triangle_origins[at] = t;
        quilt->patches[at] = source->patch;
    }
}

static MesoStatus rebuild(MesoQuilt *quilt, MesoArena *arena, Settling *s, MesoError *error)
{
    Sources sources = {0};
    MesoStatus status = list_sources(&sources, s, error);
    meso_arena_release(&s->laid);
    *quilt = (MesoQuilt){.report = s->before->report};
    if (!status)
        status = make_room(quilt, arena, s, &sources, error);
    for (uint32_t e = 0; e < sources.count && !status; e++) {
        if (sources.list[e].element != MESO_NO_INDEX)
            copy_old(quilt, s->before, e, sources.list[e].element);
        else
            copy_new(quilt, s->work.swatch, e, &sources.list[e]);
    }
    return status;
}

static void count_all(MesoQuiltReport *report, const Settling *s)
{
    for (uint32_t b = 0; b < s->work.body_count; b++) {
        const MesoSettleBody *body = &s->work.bodies[b];
        bool there = !body->gone && !s->kept[b];
        report->settled_count += there && body->element != MESO_NO_INDEX;
        report->added_count += there && body->element == MESO_NO_INDEX;
    }
}

static MesoStatus settle(MesoQuilt *quilt, MesoArena *arena, Settling *s, MesoError *error)
{
    MesoStatus status = meso_settle_find_kinds(&s->work, error);
    if (!status)
        status = embed(s, error);
    if (!status)
        status = meso_settle_find_bodies(&s->work, s->before, s->positions, error);
    if (!status)
        status = list_bodies(s, error);
    if (!status)
        status = arrange(s, error);
    if (!status)
        status = place_all(s, error);
    if (!status)
        status = rebuild(quilt, arena, s, error);
    if (!status)
        count_all(&quilt->report, s);
    return status;
}

MesoStatus meso_quilt_settle(MesoQuilt *quilt, MesoArena *arena, const MesoTriangulation *surface,
                             const MesoSwatch *swatch, const MesoSettleOptions *options, MesoError *error)
{
    MesoQuilt before = *quilt;
    MesoArena scratch;
    Settling s = {.before = &before};
    bool any = false, alone = true;
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        any |= swatch->kinds[e] == MESO_ELEMENT_WHOLE;
        alone &= swatch->kinds[e] == MESO_ELEMENT_WHOLE;
    }
    if (!any || !quilt->element_count)
        return MESO_OK;
    meso_arena_init(&scratch);
    meso_arena_init(&s.laid);
    s.work = (MesoSettleWork){.surface = surface, .swatch = swatch, .options = *options, .alone = alone,
                              .arena = &scratch};
    if (!(options->height_scale > 0))
        s.work.options.height_scale = options->scale;
    MesoStatus status = settle(quilt, arena, &s, error);
    if (status)
        *quilt = before;
    meso_arena_release(&s.laid);
    meso_arena_release(&scratch);
    return status;
}
