/* Pieces, those that are too small left out, as the elements of a quilt over the original surface. */
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/quilt/finish/finish_work.h"
#include "libcore/quilt/swatch/swatch_elements.h"

/*
 * A stub of a round strand that is one and a half times its radius long has points 2.5 radii apart, and none further:
 * sqrt(1.5^2 + 2^2).
 */
#define DEBRIS_SPAN 2.5f

typedef struct Gatherer {
    MesoFinishWork *work;
    const MesoQuilt *before;
    uint32_t *sets;             /* [vertex_count] what hangs together, by its root */
    uint32_t *pieces;           /* [vertex_count] by root: number of the piece, or MESO_NO_INDEX */
    uint32_t piece_count;
    uint32_t *elements;         /* [piece_count] element of the quilt before */
    uint32_t *ends;             /* [piece_count] a vertex at an end of the piece */
    float *spans;               /* [piece_count] the farthest from there */
    uint8_t *dropped;           /* [piece_count] */
    float *reaches;             /* [swatch->element_count] largest reach of open ends */
    MesoArena scratch;
} Gatherer;

static uint32_t piece_of(const Gatherer *g, uint32_t vertex)
{
    return g->pieces[meso_sets_root(g->sets, vertex)];
}

/* Pieces by their first triangle. */
static MesoStatus find_pieces(Gatherer *g, MesoError *error)
{
    const MesoFinishWork *work = g->work;
    size_t vertices = (size_t)work->vertex_count + 1;
    g->sets = MESO_NEW(&g->scratch, uint32_t, vertices, error);
    g->pieces = MESO_NEW(&g->scratch, uint32_t, vertices, error);
    g->elements = MESO_NEW(&g->scratch, uint32_t, vertices / 3 + 1, error);
    if (!g->sets || !g->pieces || !g->elements)
        return MESO_ERR_MEMORY;
    meso_sets_init(g->sets, work->vertex_count);
    memset(g->pieces, 0xff, vertices * sizeof *g->pieces);
    for (uint32_t t = 0; t < work->triangle_count; t++)
        for (uint32_t k = 1; k < 3; k++)
            meso_sets_join(g->sets, work->corners[3 * t], work->corners[3 * t + k]);
    for (uint32_t t = 0; t < work->triangle_count; t++) {
        uint32_t *piece = &g->pieces[meso_sets_root(g->sets, work->corners[3 * t])];
        if (*piece == MESO_NO_INDEX) {
            g->elements[g->piece_count] = work->elements[t];
            *piece = g->piece_count++;
        }
    }
    return MESO_OK;
}

/* ---- small pieces ---- */

static void measure_ends(Gatherer *g)
{
    const MesoSwatch *swatch = g->work->swatch;
    for (uint32_t l = 0; l < swatch->loop_count; l++) {
        uint32_t begin = swatch->loop_begin[l], end = swatch->loop_begin[l + 1];
        MesoVec3 centre = {0, 0, 0};
        for (uint32_t i = begin; i < end; i++)
            centre = meso_vec3_mad(centre, 1 / (float)(end - begin), swatch->positions[swatch->loop_vertices[i]]);
        float *reach = &g->reaches[meso_swatch_element(swatch, swatch->loop_vertices[begin])];
        for (uint32_t i = begin; i < end; i++) {
            MesoVec3 point = swatch->positions[swatch->loop_vertices[i]];
            *reach = fmaxf(*reach, meso_vec3_length(meso_vec3_sub(point, centre)));
        }
    }
}

/* The vertex of each piece that is farthest from its end; that becomes the end. */
static MesoStatus sweep_pieces(Gatherer *g, MesoError *error)
{
    const MesoFinishWork *work = g->work;
    uint32_t *farthest = MESO_NEW(&g->scratch, uint32_t, g->piece_count, error);
    if (!farthest)
        return MESO_ERR_MEMORY;
    memcpy(farthest, g->ends, g->piece_count * sizeof *farthest);
    memset(g->spans, 0, g->piece_count * sizeof *g->spans);
    for (uint32_t v = 0; v < work->vertex_count; v++) {
        uint32_t piece = piece_of(g, v);
        if (piece == MESO_NO_INDEX)
            continue;
        MesoVec3 end = meso_finish_point(work, work->vertices[g->ends[piece]]);
        float d = meso_vec3_length(meso_vec3_sub(meso_finish_point(work, work->vertices[v]), end));
        if (d > g->spans[piece]) {
            g->spans[piece] = d;
            farthest[piece] = v;
        }
    }
    memcpy(g->ends, farthest, g->piece_count * sizeof *farthest);
    return MESO_OK;
}

static MesoStatus drop_small(Gatherer *g, MesoError *error)
{
    MesoFinishWork *work = g->work;
    g->ends = MESO_NEW(&g->scratch, uint32_t, g->piece_count, error);
    g->spans = MESO_NEW(&g->scratch, float, g->piece_count, error);
    g->dropped = MESO_NEW(&g->scratch, uint8_t, g->piece_count, error);
    g->reaches = MESO_NEW(&g->scratch, float, work->swatch->element_count, error);
    if (!g->ends || !g->spans || !g->dropped || !g->reaches)
        return MESO_ERR_MEMORY;
    measure_ends(g);
    for (uint32_t v = work->vertex_count; v-- > 0;)
        if (piece_of(g, v) != MESO_NO_INDEX)
            g->ends[piece_of(g, v)] = v;
    MesoStatus status = sweep_pieces(g, error);
    if (!status)
        status = sweep_pieces(g, error);
    for (uint32_t p = 0; !status && p < g->piece_count; p++) {
        uint32_t element = g->before->element_origins[g->elements[p]];
        float least = DEBRIS_SPAN * g->reaches[element] * work->options->scale;
        g->dropped[p] = work->swatch->kinds[element] == MESO_ELEMENT_STRAND && g->spans[p] < least;
        work->report->debris_count += g->dropped[p];
    }
    return status;
}

/* ---- the quilt ---- */

static float within(float value, float most)
{
    return value > 0 ? value < most ? value : most : 0;
}

/* In the original's triangle; what the border has made lies in it. */
static MesoQuiltVertex original_place(const MesoFinishWork *work, uint32_t v)
{
    MesoQuiltVertex to = meso_finish_original(work, work->vertices[v]);
    if (work->at_border[v]) {
        to.b1 = within(to.b1, 1);
        to.b2 = within(to.b2, 1 - to.b1);
    }
    return to;
}

/* Numbers the pieces that stay, and counts what they have, one place on. */
static MesoStatus count_elements(MesoQuilt *quilt, MesoArena *arena, Gatherer *g, uint32_t *numbers, MesoError *error)
{
    const MesoFinishWork *work = g->work;
    for (uint32_t p = 0; p < g->piece_count; p++)
        numbers[p] = g->dropped[p] ? MESO_NO_INDEX : quilt->element_count++;
    quilt->vertex_begin = MESO_NEW(arena, uint32_t, (size_t)quilt->element_count + 1, error);
    quilt->triangle_begin = MESO_NEW(arena, uint32_t, (size_t)quilt->element_count + 1, error);
    quilt->element_origins = MESO_NEW(arena, uint32_t, quilt->element_count, error);
    if (!quilt->vertex_begin || !quilt->triangle_begin || !quilt->element_origins)
        return MESO_ERR_MEMORY;
    for (uint32_t p = 0; p < g->piece_count; p++)
        if (numbers[p] != MESO_NO_INDEX)
            quilt->element_origins[numbers[p]] = g->before->element_origins[g->elements[p]];
    for (uint32_t v = 0; v < work->vertex_count; v++) {
        uint32_t piece = piece_of(g, v);
        if (piece != MESO_NO_INDEX && !g->dropped[piece])
            quilt->vertex_begin[numbers[piece] + 1]++;
    }
    for (uint32_t t = 0; t < work->triangle_count; t++) {
        uint32_t piece = piece_of(g, work->corners[3 * t]);
        if (!g->dropped[piece])
            quilt->triangle_begin[numbers[piece] + 1]++;
    }
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        quilt->vertex_begin[e + 1] += quilt->vertex_begin[e];
        quilt->triangle_begin[e + 1] += quilt->triangle_begin[e];
    }
    quilt->vertex_count = quilt->vertex_begin[quilt->element_count];
    quilt->triangle_count = quilt->triangle_begin[quilt->element_count];
    return MESO_OK;
}

/*
 * Nothing is asked of what was there before but the elements' origins: it makes room for what comes of it, where that
 * does not come from these very arrays.
 */
static MesoStatus make_room(MesoQuilt *quilt, const Gatherer *g, MesoArena *arena, MesoError *error)
{
    const MesoQuilt *before = g->before;
    if (before->vertices && g->work->vertices != before->vertices && quilt->vertex_count <= before->vertex_count &&
        quilt->triangle_count <= before->triangle_count) {
        quilt->vertices = before->vertices;
        quilt->origins = before->origins;
        quilt->corners = before->corners;
        quilt->triangle_origins = before->triangle_origins;
        quilt->patches = before->patches;
        return MESO_OK;
    }
    quilt->vertices = MESO_NEW(arena, MesoQuiltVertex, quilt->vertex_count, error);
    quilt->origins = MESO_NEW(arena, uint32_t, quilt->vertex_count, error);
    quilt->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)quilt->triangle_count, error);
    quilt->triangle_origins = MESO_NEW(arena, uint32_t, quilt->triangle_count, error);
    quilt->patches = MESO_NEW(arena, uint32_t, quilt->triangle_count, error);
    return quilt->vertices && quilt->origins && quilt->corners && quilt->triangle_origins && quilt->patches
               ? MESO_OK : MESO_ERR_MEMORY;
}

/* `places` [vertex_count] comes to be where each vertex has gone; `at` [element_count] is scratch. */
static void fill(MesoQuilt *quilt, const Gatherer *g, const uint32_t *numbers, uint32_t *places, uint32_t *at)
{
    const MesoFinishWork *work = g->work;
    memcpy(at, quilt->vertex_begin, quilt->element_count * sizeof *at);
    for (uint32_t v = 0; v < work->vertex_count; v++) {
        uint32_t piece = piece_of(g, v);
        if (piece == MESO_NO_INDEX || g->dropped[piece])
            continue;
        uint32_t to = places[v] = at[numbers[piece]]++;
        quilt->vertices[to] = original_place(work, v);
        quilt->origins[to] = work->origins[v];
    }
    memcpy(at, quilt->triangle_begin, quilt->element_count * sizeof *at);
    for (uint32_t t = 0; t < work->triangle_count; t++) {
        uint32_t piece = piece_of(g, work->corners[3 * t]);
        if (g->dropped[piece])
            continue;
        uint32_t to = at[numbers[piece]]++;
        quilt->triangle_origins[to] = work->triangle_origins[t];
        quilt->patches[to] = work->patches[t];
        for (uint32_t k = 0; k < 3; k++)
            quilt->corners[3 * to + k] = places[work->corners[3 * t + k]];
    }
}

static MesoStatus gather(MesoQuilt *quilt, MesoArena *arena, Gatherer *g, MesoError *error)
{
    MesoStatus status = find_pieces(g, error);
    if (!status)
        status = drop_small(g, error);
    if (status)
        return status;
    uint32_t *numbers = MESO_NEW(&g->scratch, uint32_t, g->piece_count, error);
    uint32_t *places = MESO_NEW(&g->scratch, uint32_t, g->work->vertex_count, error);
    uint32_t *at = MESO_NEW(&g->scratch, uint32_t, g->piece_count, error);
    if (!numbers || !places || !at)
        return MESO_ERR_MEMORY;
    status = count_elements(quilt, arena, g, numbers, error);
    if (!status)
        status = make_room(quilt, g, arena, error);
    if (!status)
        fill(quilt, g, numbers, places, at);
    return status;
}

MesoStatus meso_finish_gather(MesoQuilt *quilt, MesoArena *arena, MesoFinishWork *work, MesoError *error)
{
    MesoQuilt before = *quilt;
    Gatherer g = {.work = work, .before = &before};
    meso_arena_init(&g.scratch);
    *quilt = (MesoQuilt){.report = before.report};
    MesoStatus status = gather(quilt, arena, &g, error);
    meso_arena_release(&g.scratch);
    return status;
}
