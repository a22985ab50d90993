#include "libcore/mesh/orientation.h"

#include <stdlib.h>
#include <string.h>

/* Quarter under which side `side` of the file has direction `direction`. */
static uint8_t quarter_for(uint32_t side, uint32_t direction)
{
    return (uint8_t)((side - direction) & 3u);
}

/* Quarter that the neighbour across half-edge `h` needs to agree with its slot. */
static uint8_t quarter_across(const MesoSlotGraph *graph, const uint8_t *quarters, uint32_t h)
{
    uint32_t direction = (h - quarters[h / 4]) & 3u;
    return quarter_for(graph->twin[h] & 3u, direction + 2);
}

/* ---- carrying a direction ---- */

enum { UNSEEN = 4 };

/* Breadth-first: `list` [slot_count] is the queue. */
static void carry(uint8_t *quarters, uint32_t *list, const MesoSlotGraph *graph)
{
    memset(quarters, UNSEEN, graph->slot_count);
    for (uint32_t start = 0; start < graph->slot_count; start++) {
        uint32_t head = 0, tail = 0;
        if (quarters[start] != UNSEEN)
            continue;
        quarters[start] = 0;
        list[tail++] = start;
        while (head < tail) {
            uint32_t slot = list[head++];
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t h = 4 * slot + k, twin = graph->twin[h];
                if (twin == MESO_NO_INDEX || quarters[twin / 4] != UNSEEN)
                    continue;
                quarters[twin / 4] = quarter_across(graph, quarters, h);
                list[tail++] = twin / 4;
            }
        }
    }
}

/* The quarter that most neighbours of `slot` ask for, if more do than for its own; its own otherwise. */
static uint8_t majority(const MesoSlotGraph *graph, const uint8_t *quarters, uint32_t slot)
{
    uint32_t votes[4] = {0};
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t twin = graph->twin[4 * (size_t)slot + k];
        if (twin != MESO_NO_INDEX && twin / 4 != slot)
            votes[quarter_across(graph, quarters, twin)]++;
    }
    uint8_t best = quarters[slot];
    for (uint8_t q = 0; q < 4; q++)
        if (votes[q] > votes[best])
            best = q;
    return best;
}

/*
 * Each change lowers the number of disagreeing edges, so that there are no more
 * changes than those. `list` is a ring of the slots to look at, each in it once:
 * those in it are marked in `waiting` [slot_count], zeroed.
 */
static void outvote(uint8_t *quarters, uint32_t *list, uint8_t *waiting, const MesoSlotGraph *graph)
{
    uint32_t size = graph->slot_count, head = 0, count = 0;
    for (uint32_t s = 0; s < size; s++)
        if (majority(graph, quarters, s) != quarters[s]) {
            list[count++] = s;
            waiting[s] = 1;
        }
    while (count) {
        uint32_t slot = list[head];
        head = head + 1 == size ? 0 : head + 1;
        count--;
        waiting[slot] = 0;
        uint8_t best = majority(graph, quarters, slot);
        if (best == quarters[slot])
            continue;
        quarters[slot] = best;
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t twin = graph->twin[4 * (size_t)slot + k];
            if (twin == MESO_NO_INDEX || waiting[twin / 4])
                continue;
            uint64_t end = (uint64_t)head + count++;
            list[end < size ? end : end - size] = twin / 4;
            waiting[twin / 4] = 1;
        }
    }
}

MesoStatus meso_orientation_comb(uint8_t *quarters, MesoArena *scratch, const MesoSlotGraph *graph,
                                 MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint32_t *list = MESO_NEW(scratch, uint32_t, graph->slot_count, error);
    uint8_t *waiting = MESO_NEW(scratch, uint8_t, graph->slot_count, error);
    if (!list || !waiting) {
        meso_arena_rewind(scratch, mark);
        return MESO_ERR_MEMORY;
    }
    carry(quarters, list, graph);
    outvote(quarters, list, waiting, graph);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

/* ---- following a direction ---- */

static MesoVec3 corner(const MesoQuadMesh *mesh, uint32_t face, uint32_t i)
{
    return mesh->positions[mesh->face_vertices[4 * (size_t)face + (i & 3u)]];
}

/* Twice the way from the middle of the side opposite to `side` to its own: the derivative along it. */
static MesoVec3 across(const MesoQuadMesh *mesh, uint32_t face, uint32_t side)
{
    MesoVec3 own = meso_vec3_add(corner(mesh, face, side), corner(mesh, face, side + 1));
    MesoVec3 opposite = meso_vec3_add(corner(mesh, face, side + 2), corner(mesh, face, side + 3));
    return meso_vec3_sub(own, opposite);
}

/*
 * Cosines below this are rounding: a direction along the normal points to no
 * side. A vector of floats is off by some 1e-7 of its length.
 */
static const float least_cosine = 1e-6f;

uint32_t meso_orientation_along(uint8_t *quarters, const MesoQuadMesh *mesh,
                                const MesoVec3 *directions)
{
    const MesoVec3 zero = {0, 0, 0};
    uint32_t without = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        MesoVec3 direction = meso_vec3_unit(directions[f], zero);
        float best = least_cosine;
        uint32_t side = MESO_NO_INDEX;
        for (uint32_t k = 0; k < 4; k++) {
            float cosine = meso_vec3_dot(meso_vec3_unit(across(mesh, f, k), zero), direction);
            if (cosine > best) {
                best = cosine;
                side = k;
            }
        }
        without += side == MESO_NO_INDEX;
        quarters[f] = (uint8_t)(side == MESO_NO_INDEX ? 0 : side);
    }
    return without;
}

/*
 * With the derivatives X and Y of the position and a and b of the value along
 * the face's two axes, the gradient is the vector g of the plane of X and Y with
 * g.X = a and g.Y = b; scaled here by the determinant, which is positive, so
 * that its direction is right and nothing is divided by what may vanish.
 */
void meso_orientation_gradient(MesoVec3 *directions, const MesoQuadMesh *mesh, const float *values)
{
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const float *u = values + 4 * (size_t)f;
        MesoVec3 x = meso_vec3_scale(across(mesh, f, 0), 1 / mesh->mean_edge_length);
        MesoVec3 y = meso_vec3_scale(across(mesh, f, 1), 1 / mesh->mean_edge_length);
        float a = u[0] + u[1] - u[2] - u[3], b = u[1] + u[2] - u[3] - u[0];
        float xx = meso_vec3_dot(x, x), xy = meso_vec3_dot(x, y), yy = meso_vec3_dot(y, y);
        directions[f] = meso_vec3_add(meso_vec3_scale(x, a * yy - b * xy),
                                      meso_vec3_scale(y, b * xx - a * xy));
    }
}

/* ---- what remains ---- */

uint32_t meso_orientation_disagreeing(const MesoSlotGraph *graph, const uint8_t *quarters)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 4 * graph->slot_count; h++) {
        uint32_t twin = graph->twin[h];
        count += twin != MESO_NO_INDEX && h < twin &&
                 quarter_across(graph, quarters, h) != quarters[twin / 4];
    }
    return count;
}

/* The half-edge at which the neighbour across `h` leaves the vertex again, going around it. */
static uint32_t step_around(const MesoQuadMesh *mesh, uint32_t twin, uint32_t vertex)
{
    uint32_t slot = twin & ~3u, side = twin & 3u;
    bool starts = mesh->face_vertices[twin] == vertex;
    return slot | ((starts ? side + 3 : side + 1) & 3u);
}

/*
 * Faces around the vertex that half-edge `start` begins at, or 0 where a border
 * is met, or a corner that was seen before, whose own walk met one.
 */
static uint32_t count_around(const MesoQuadMesh *mesh, const MesoSlotGraph *graph, uint32_t start,
                             uint8_t *seen)
{
    uint32_t vertex = mesh->face_vertices[start], count = 0;
    for (uint32_t h = start;;) {
        uint32_t next = (h & ~3u) | ((h + 1) & 3u);
        uint32_t at = mesh->face_vertices[h] == vertex ? h : next;
        if (seen[at])
            return at == start ? count : 0;
        seen[at] = 1;
        count++;
        if (graph->twin[h] == MESO_NO_INDEX)
            return 0;
        h = step_around(mesh, graph->twin[h], vertex);
    }
}

static int compare_vertices(const void *a, const void *b)
{
    uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

MesoStatus meso_orientation_singular(uint32_t *count, uint32_t *vertices, uint32_t room,
                                     MesoArena *scratch, const MesoQuadMesh *mesh,
                                     const MesoSlotGraph *graph, MesoError *error)
{
    uint32_t half_edges = 4 * graph->slot_count;
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint8_t *seen = MESO_NEW(scratch, uint8_t, half_edges, error);
    uint32_t *found = seen ? MESO_NEW(scratch, uint32_t, half_edges, error) : NULL;
    *count = 0;
    for (uint32_t h = 0; found && h < half_edges; h++) {
        uint32_t faces = seen[h] ? 0 : count_around(mesh, graph, h, seen);
        if (faces != 0 && faces != 4)
            found[(*count)++] = mesh->face_vertices[h];
    }
    if (found) {
        qsort(found, *count, sizeof *found, compare_vertices);
        for (uint32_t i = 0; i < *count && i < room; i++)
            vertices[i] = found[i];
    }
    meso_arena_rewind(scratch, mark);
    return found ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- application ---- */

/* A copy of `from` [4 * count], each four of it started where `quarters` say; NULL: out of memory. */
static uint32_t *turned(MesoArena *arena, const uint32_t *from, uint32_t count, const uint8_t *quarters,
                        MesoError *error)
{
    uint32_t *to = MESO_NEW(arena, uint32_t, (size_t)count * 4, error);
    for (size_t i = 0; to && i < 4 * (size_t)count; i++)
        to[i] = from[(i & ~(size_t)3) | ((i + quarters[i / 4]) & 3)];
    return to;
}

MesoStatus meso_orientation_turn_mesh(MesoQuadMesh *mesh, MesoArena *arena, const uint8_t *quarters, MesoError *error)
{
    mesh->face_vertices = turned(arena, mesh->face_vertices, mesh->face_count, quarters, error);
    mesh->face_normals = turned(arena, mesh->face_normals, mesh->face_count, quarters, error);
    return mesh->face_vertices && mesh->face_normals ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_orientation_turn_graph(MesoSlotGraph *graph, MesoArena *arena, const uint8_t *quarters,
                                       MesoError *error)
{
    graph->twin = turned(arena, graph->twin, graph->slot_count, quarters, error);
    for (size_t h = 0; graph->twin && h < 4 * (size_t)graph->slot_count; h++) {
        uint32_t *twin = &graph->twin[h];
        if (*twin != MESO_NO_INDEX)
            *twin = (*twin & ~3u) | ((*twin - quarters[*twin / 4]) & 3u);
    }
    return graph->twin ? MESO_OK : MESO_ERR_MEMORY;
}
