#include "libcore/mesh/surface_check.h"

#include <math.h>
#include <string.h>

/* Thinner than this part of its longest side a face is a line; see the header. */
static const double THIN = 1e-6;

static uint32_t next_corner(uint32_t half_edge)
{
    return (half_edge & ~3u) | ((half_edge + 1) & 3u);
}

static bool is_reversed(const MesoQuadMesh *mesh, uint32_t half_edge, uint32_t twin)
{
    return mesh->face_vertices[half_edge] == mesh->face_vertices[twin];
}

static void name_pair(uint32_t pair[2], uint32_t half_edge, uint32_t twin)
{
    pair[0] = half_edge / 4;
    pair[1] = twin / 4;
}

/* ---- borders that lie on each other ---- */

/* Both ends of an edge, the lesser first; zeros of one sign, so that equal ends have equal bits. */
typedef struct Ends {
    float at[6];
} Ends;

static Ends ends_of(const MesoQuadMesh *mesh, uint32_t half_edge)
{
    MesoVec3 a = mesh->positions[mesh->face_vertices[half_edge]];
    MesoVec3 b = mesh->positions[mesh->face_vertices[next_corner(half_edge)]];
    bool ordered = a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    MesoVec3 low = ordered ? a : b, high = ordered ? b : a;
    return (Ends){{low.x + 0.0f, low.y + 0.0f, low.z + 0.0f, high.x + 0.0f, high.y + 0.0f, high.z + 0.0f}};
}

/* A finisher after each word: coordinates on a grid differ in few bits. */
static uint32_t hash_ends(const Ends *ends)
{
    uint32_t words[6];
    uint64_t hash = 0;
    memcpy(words, ends->at, sizeof words);
    for (int i = 0; i < 6; i++) {
        hash = (hash ^ words[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (uint32_t)(hash >> 16);
}

static bool has_length(const Ends *ends)
{
    return memcmp(ends->at, ends->at + 3, 3 * sizeof *ends->at) != 0;
}

/* The first border edge of each place, open addressing. */
typedef struct Places {
    uint32_t *half_edge;    /* [mask + 1] or MESO_NO_INDEX */
    bool *met;              /* [mask + 1] another one lies there */
    uint32_t mask;
} Places;

static uint32_t find_place(const Places *places, const MesoQuadMesh *mesh, const Ends *ends)
{
    uint32_t at = hash_ends(ends) & places->mask;
    for (;; at = (at + 1) & places->mask) {
        if (places->half_edge[at] == MESO_NO_INDEX)
            return at;
        Ends other = ends_of(mesh, places->half_edge[at]);
        if (memcmp(&other, ends, sizeof other) == 0)
            return at;
    }
}

static void place_border(MesoSurfaceFlaws *flaws, Places *places, const MesoQuadMesh *mesh, uint32_t half_edge)
{
    Ends ends = ends_of(mesh, half_edge);
    if (!has_length(&ends))
        return;
    uint32_t at = find_place(places, mesh, &ends), first = places->half_edge[at];
    if (first == MESO_NO_INDEX) {
        places->half_edge[at] = half_edge;
        return;
    }
    if (flaws->split_edges == 0)
        name_pair(flaws->split_faces, first, half_edge);
    flaws->split_edges += places->met[at] ? 1 : 2;
    places->met[at] = true;
}

static MesoStatus find_splits(MesoSurfaceFlaws *flaws, MesoArena *scratch, const MesoQuadMesh *mesh,
                              const MesoSlotGraph *graph, MesoError *error)
{
    uint64_t room = 16;
    while (room < 2 * (uint64_t)graph->border_count)
        room *= 2;
    Places places = {
        .half_edge = MESO_NEW(scratch, uint32_t, room, error),
        .met = MESO_NEW(scratch, bool, room, error),
        .mask = (uint32_t)(room - 1),
    };
    if (!places.half_edge || !places.met)
        return MESO_ERR_MEMORY;
    memset(places.half_edge, 0xff, room * sizeof *places.half_edge);
    for (uint32_t h = 0; h < 4 * graph->slot_count; h++)
        if (graph->twin[h] == MESO_NO_INDEX)
            place_border(flaws, &places, mesh, h);
    return MESO_OK;
}

/* ---- windings ---- */

/* Colours that must change across reversed edges alone; `colour` 2 is none yet. */
typedef struct Winding {
    const MesoQuadMesh *mesh;
    const MesoSlotGraph *graph;
    uint8_t *colour;        /* [slot_count] */
    uint32_t *queue;        /* [slot_count] */
    bool one_sided;         /* the piece at hand */
} Winding;

/* Fills the piece of `start`; the queue holds its slots. Returns their number. */
static uint32_t colour_piece(Winding *w, uint32_t start)
{
    uint32_t count = 0;
    w->one_sided = false;
    w->colour[start] = 0;
    w->queue[count++] = start;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t h = 4 * w->queue[i]; h < 4 * w->queue[i] + 4; h++) {
            uint32_t twin = w->graph->twin[h];
            if (twin == MESO_NO_INDEX)
                continue;
            uint8_t wanted = w->colour[h / 4] ^ is_reversed(w->mesh, h, twin);
            if (w->colour[twin / 4] == 2) {
                w->colour[twin / 4] = wanted;
                w->queue[count++] = twin / 4;
            } else if (w->colour[twin / 4] != wanted) {
                w->one_sided = true;
            }
        }
    return count;
}

/* Whether a corner at either end, of either face, has a normal that is summed over faces. */
static bool is_blurred(const MesoQuadMesh *mesh, uint32_t half_edge, uint32_t twin)
{
    const uint32_t corners[4] = {half_edge, next_corner(half_edge), twin, next_corner(twin)};
    bool blurred = false;
    for (int i = 0; i < 4; i++)
        blurred |= mesh->face_normals[corners[i]] >= mesh->given_normals;
    return blurred;
}

static void count_one_sided(MesoSurfaceFlaws *flaws, const Winding *w, uint32_t slot_count)
{
    uint32_t first = MESO_NO_INDEX;
    for (uint32_t i = 0; i < slot_count; i++)
        for (uint32_t h = 4 * w->queue[i]; h < 4 * w->queue[i] + 4; h++) {
            uint32_t twin = w->graph->twin[h];
            if (twin == MESO_NO_INDEX || h > twin || !is_reversed(w->mesh, h, twin))
                continue;
            flaws->blurred_edges += is_blurred(w->mesh, h, twin);
            first = h < first ? h : first;
        }
    if (flaws->one_sided_pieces++ == 0)
        name_pair(flaws->one_sided_faces, first, w->graph->twin[first]);
}

static MesoStatus find_windings(MesoSurfaceFlaws *flaws, MesoArena *scratch, const MesoQuadMesh *mesh,
                                const MesoSlotGraph *graph, MesoError *error)
{
    Winding w = {
        .mesh = mesh,
        .graph = graph,
        .colour = MESO_NEW(scratch, uint8_t, graph->slot_count, error),
        .queue = MESO_NEW(scratch, uint32_t, graph->slot_count, error),
    };
    if (!w.colour || !w.queue)
        return MESO_ERR_MEMORY;
    memset(w.colour, 2, graph->slot_count);
    for (uint32_t s = 0; s < graph->slot_count; s++) {
        if (w.colour[s] != 2)
            continue;
        uint32_t count = colour_piece(&w, s);
        flaws->pieces++;
        if (w.one_sided)
            count_one_sided(flaws, &w, count);
    }
    for (uint32_t h = 0; h < 4 * graph->slot_count; h++) {
        uint32_t twin = graph->twin[h];
        if (twin != MESO_NO_INDEX && h < twin && is_reversed(mesh, h, twin) && flaws->reversed_edges++ == 0)
            name_pair(flaws->reversed_faces, h, twin);
    }
    return MESO_OK;
}

/* ---- faces and corners ---- */

static bool is_flat(const MesoQuadMesh *mesh, uint32_t face)
{
    double sides[4][3], longest = 0, widest = 0;
    for (uint32_t i = 0; i < 4; i++) {
        MesoVec3 a = mesh->positions[mesh->face_vertices[4 * face + i]];
        MesoVec3 b = mesh->positions[mesh->face_vertices[4 * face + ((i + 1) & 3)]];
        double *d = sides[i];
        d[0] = (double)b.x - a.x, d[1] = (double)b.y - a.y, d[2] = (double)b.z - a.z;
        longest = fmax(longest, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    for (uint32_t i = 0; i < 4; i++) {
        const double *a = sides[i], *b = sides[(i + 1) & 3];
        double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
        widest = fmax(widest, x * x + y * y + z * z);
    }
    return widest <= THIN * THIN * longest * longest;
}

static void find_flat_faces(MesoSurfaceFlaws *flaws, const MesoQuadMesh *mesh)
{
    for (uint32_t f = 0; f < mesh->face_count; f++)
        if (is_flat(mesh, f) && flaws->flat_faces++ == 0)
            flaws->flat_face = f;
}

static void find_bare_corners(MesoSurfaceFlaws *flaws, const MesoQuadMesh *mesh)
{
    for (uint32_t c = 0; c < 4 * mesh->face_count && mesh->given_normals > 0; c++)
        if (mesh->face_normals[c] >= mesh->given_normals && flaws->bare_corners++ == 0)
            flaws->bare_face = c / 4;
    if (flaws->bare_corners == 4 * mesh->face_count)    /* normals that no corner uses are none */
        flaws->bare_corners = 0;
}

MesoStatus meso_surface_check(MesoSurfaceFlaws *flaws, MesoArena *scratch, const MesoQuadMesh *mesh,
                              const MesoSlotGraph *graph, MesoError *error)
{
    *flaws = (MesoSurfaceFlaws){.lost_normals = mesh->lost_normals};
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoStatus status = find_splits(flaws, scratch, mesh, graph, error);
    if (!status)
        status = find_windings(flaws, scratch, mesh, graph, error);
    find_flat_faces(flaws, mesh);
    find_bare_corners(flaws, mesh);
    meso_arena_rewind(scratch, mark);
    return status;
}
