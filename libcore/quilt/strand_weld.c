/*
 * Strands welded: where a patch fits what is there vertex by vertex, as copies of a periodic swatch do, each triangle is
 * the older quilt's or the patch's, and nothing is cut.
 */
#include <stdlib.h>
#include <string.h>

#include "libcore/quilt/quilt_work.h"

/* Vertices of both sides are one within this share of a mean edge of the swatch. */
#define SAME 0.02f

/* What has a directed edge: triangles of either side, and such as stay or come. */
enum { OLD_HAS = 1, OLD_STAYS = 2, NEW_HAS = 4, NEW_COMES = 8 };

typedef struct EdgeEntry {
    uint32_t from, to, has;     /* has 0: free */
} EdgeEntry;

typedef struct Welder {
    const MesoStrandSide *old_side, *new_side;
    const MesoQuiltStep *step;
    const MesoQuiltWork *work;
    MesoStrandWeld *weld;
    uint32_t *cells;            /* [cell_room] first old vertex of a cell of space, or MESO_NO_INDEX */
    uint32_t *next;             /* [old vertex_count] of the same cell */
    uint32_t cell_room;         /* a power of 2, as is the other */
    EdgeEntry *edges;
    uint32_t edge_room;
} Welder;

static uint32_t power_above(uint64_t count)
{
    uint32_t room = 16;
    while (room < count && room < UINT32_MAX / 2)
        room *= 2;
    return room;
}

/* ---- vertices ---- */

static uint32_t cell_at(const Welder *w, int64_t x, int64_t y, int64_t z)
{
    uint64_t hash = (uint64_t)x * UINT64_C(0x9e3779b97f4a7c15) ^ (uint64_t)y * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                    (uint64_t)z * UINT64_C(0x165667b19e3779f9);
    return (uint32_t)(hash >> 29) & (w->cell_room - 1);
}

/* Cells are ten times as wide as what is the same. */
static void cell_of(const Welder *w, MesoVec3 p, double shift, int64_t cell[3])
{
    double width = 10.0 * SAME * w->work->swatch->mean_edge;
    cell[0] = (int64_t)floor((p.x + shift * width) / width);
    cell[1] = (int64_t)floor((p.y + shift * width) / width);
    cell[2] = (int64_t)floor((p.z + shift * width) / width);
}

static void index_old(Welder *w)
{
    memset(w->cells, 0xff, w->cell_room * sizeof *w->cells);
    for (uint32_t v = 0; v < w->old_side->vertex_count; v++) {
        int64_t cell[3];
        cell_of(w, w->old_side->positions[v], 0, cell);
        uint32_t *head = &w->cells[cell_at(w, cell[0], cell[1], cell[2])];
        w->next[v] = *head;
        *head = v;
    }
}

/* The old vertex at a point; MESO_NO_INDEX: none. */
static uint32_t find_old(const Welder *w, MesoVec3 p)
{
    int64_t low[3], high[3];
    cell_of(w, p, -0.1, low);
    cell_of(w, p, 0.1, high);
    float least = SAME * w->work->swatch->mean_edge;
    uint32_t best = MESO_NO_INDEX;
    for (int64_t z = low[2]; z <= high[2]; z++)
        for (int64_t y = low[1]; y <= high[1]; y++)
            for (int64_t x = low[0]; x <= high[0]; x++)
                for (uint32_t v = w->cells[cell_at(w, x, y, z)]; v != MESO_NO_INDEX; v = w->next[v]) {
                    float distance = meso_vec3_length(meso_vec3_sub(w->old_side->positions[v], p));
                    if (distance < least) {
                        least = distance;
                        best = v;
                    }
                }
    return best;
}

/* ---- edges ---- */

static EdgeEntry *edge_entry(const Welder *w, uint32_t from, uint32_t to)
{
    uint64_t hash = ((uint64_t)from << 32 | to) * UINT64_C(0x9e3779b97f4a7c15);
    uint32_t at = (uint32_t)(hash >> 32) & (w->edge_room - 1);
    while (w->edges[at].has && (w->edges[at].from != from || w->edges[at].to != to))
        at = (at + 1) & (w->edge_room - 1);
    return &w->edges[at];
}

/* Adds to what a triangle's edges have; false where that is there already. */
static bool add_edges(Welder *w, const uint32_t corner[3], uint32_t has)
{
    bool single = true;
    for (int k = 0; k < 3; k++) {
        EdgeEntry *entry = edge_entry(w, corner[k], corner[(k + 1) % 3]);
        single &= !(entry->has & has);
        *entry = (EdgeEntry){corner[k], corner[(k + 1) % 3], entry->has | has};
    }
    return single;
}

/* A new triangle in the numbers of both sides: those of old vertices, and behind them those of new ones. */
static void new_corners(const Welder *w, uint32_t triangle, uint32_t corner[3])
{
    for (size_t k = 0; k < 3; k++) {
        uint32_t v = w->new_side->corners[3 * (size_t)triangle + k], same = w->weld->same[v];
        corner[k] = same != MESO_NO_INDEX ? same : w->old_side->vertex_count + v;
    }
}

static float side_of(const MesoStrandSide *side, uint32_t triangle)
{
    const uint32_t *corner = &side->corners[3 * (size_t)triangle];
    return side->values[corner[0]] + side->values[corner[1]] + side->values[corner[2]];
}

/* Each triangle is one side's; a new one that is an old one as well comes where that goes. */
static bool share_out(Welder *w)
{
    const MesoStrandSide *old_side = w->old_side, *new_side = w->new_side;
    bool single = true;
    for (uint32_t t = 0; t < old_side->triangle_count; t++) {
        w->weld->old_stays[t] = side_of(old_side, t) > 0;
        single &= add_edges(w, &old_side->corners[3 * (size_t)t], OLD_HAS);
        if (w->weld->old_stays[t])
            add_edges(w, &old_side->corners[3 * (size_t)t], OLD_STAYS);
    }
    for (uint32_t t = 0; t < new_side->triangle_count; t++) {
        uint32_t corner[3], twins = 0, staying = 0;
        new_corners(w, t, corner);
        for (int k = 0; k < 3; k++) {
            uint32_t has = edge_entry(w, corner[k], corner[(k + 1) % 3])->has;
            twins += (has & OLD_HAS) != 0;
            staying += (has & OLD_STAYS) != 0;
        }
        w->weld->new_comes[t] = twins == 3 ? staying < 3 : side_of(new_side, t) > 0;
        single &= add_edges(w, corner, NEW_HAS);
        if (w->weld->new_comes[t])
            add_edges(w, corner, NEW_COMES);
    }
    return single;
}

/* Whether something is done at a vertex of either side, so that no flaw may be left there. */
static bool is_done(const Welder *w, uint32_t number)
{
    uint32_t old_count = w->old_side->vertex_count;
    MesoVec3 p = number < old_count ? w->old_side->positions[number] : w->new_side->positions[number - old_count];
    float b1, b2;
    uint32_t t = meso_quilt_plane_locate(&w->step->plane, (MesoVec2){p.x, p.y}, &b1, &b2);
    return t != MESO_NO_INDEX && w->work->covers[w->step->chart.triangles[t]] == MESO_COVER_DONE;
}

/* Along the line between both sides, edges of what stays have to be edges of what comes, but for where nothing is done. */
static bool fits(const Welder *w)
{
    for (uint32_t i = 0; i < w->edge_room; i++) {
        const EdgeEntry *edge = &w->edges[i];
        if (!(edge->has & (OLD_STAYS | NEW_COMES)))
            continue;
        if ((edge->has & OLD_STAYS) && (edge->has & NEW_COMES))
            return false;
        uint32_t across = edge_entry(w, edge->to, edge->from)->has;
        bool had = edge->has & OLD_STAYS ? across & OLD_HAS : across & NEW_HAS;
        if (had && !(across & (OLD_STAYS | NEW_COMES)) && is_done(w, edge->from) && is_done(w, edge->to))
            return false;
    }
    return true;
}

MesoStatus meso_strands_try_weld(MesoStrandWeld *weld, bool *welded, const MesoStrandSide *old_side,
                                 const MesoStrandSide *new_side, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                 MesoArena *arena, MesoError *error)
{
    *welded = false;
    *weld = (MesoStrandWeld){.old_side = *old_side, .new_side = *new_side};
    weld->same = MESO_NEW(arena, uint32_t, new_side->vertex_count, error);
    weld->old_stays = MESO_NEW(arena, bool, old_side->triangle_count, error);
    weld->new_comes = MESO_NEW(arena, bool, new_side->triangle_count, error);
    MesoArenaMark mark = meso_arena_mark(arena);
    Welder w = {.old_side = old_side, .new_side = new_side, .step = step, .work = work, .weld = weld};
    w.cell_room = power_above(2 * (uint64_t)old_side->vertex_count);
    w.edge_room = power_above(8 * ((uint64_t)old_side->triangle_count + new_side->triangle_count));
    w.cells = MESO_NEW(arena, uint32_t, w.cell_room, error);
    w.next = MESO_NEW(arena, uint32_t, old_side->vertex_count, error);
    w.edges = MESO_NEW(arena, EdgeEntry, w.edge_room, error);
    if (!weld->same || !weld->old_stays || !weld->new_comes || !w.cells || !w.next || !w.edges)
        return MESO_ERR_MEMORY;
    index_old(&w);
    for (uint32_t v = 0; v < new_side->vertex_count; v++)
        weld->same[v] = find_old(&w, new_side->positions[v]);
    *welded = share_out(&w) && fits(&w);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

MesoStatus meso_strands_commit_weld(const MesoStrandWeld *weld, const MesoQuiltStep *step, MesoQuiltWork *work,
                                    MesoArena *arena, MesoError *error)
{
    const MesoStrandSide *old_side = &weld->old_side, *new_side = &weld->new_side;
    MesoComposite *composite = &work->composite;
    uint32_t *names = MESO_NEW(arena, uint32_t, new_side->vertex_count, error);
    if (!names)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < new_side->vertex_count; v++)
        names[v] = weld->same[v] == MESO_NO_INDEX ? MESO_NO_INDEX : old_side->vertices[weld->same[v]];
    for (uint32_t t = 0; t < old_side->triangle_count; t++)
        if (!weld->old_stays[t])
            composite->corners[3 * (size_t)old_side->triangles[t]] = MESO_NO_INDEX;
    for (uint32_t t = 0; t < new_side->triangle_count; t++) {
        uint32_t corners[3];
        for (size_t k = 0; k < 3 && weld->new_comes[t]; k++) {
            uint32_t v = new_side->corners[3 * (size_t)t + k];
            MesoQuiltVertex place = {.triangle = step->seed};
            if (names[v] == MESO_NO_INDEX) {
                meso_quilt_plane_from(&step->plane, new_side->positions[v], &place);    /* they lie on the chart */
                names[v] = meso_composite_add_vertex(composite, place, new_side->vertices[v], error);
            }
            if (names[v] == MESO_NO_INDEX)
                return error ? error->status : MESO_ERR_MEMORY;
            corners[k] = names[v];
        }
        if (weld->new_comes[t] && meso_composite_add_triangle(composite, corners, new_side->triangles[t], step->patch,
                                                              error) == MESO_NO_INDEX)
            return error ? error->status : MESO_ERR_MEMORY;
    }
    step->tally->report.weld_count++;
    return MESO_OK;
}
