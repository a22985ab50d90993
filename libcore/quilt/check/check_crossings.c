#include "libcore/quilt/check/check_crossings.h"

#include <stdatomic.h>

#include "libcore/base/parallel.h"
#include "libcore/shell/box_tree.h"

enum { GRAIN = 1 << 11 };

typedef struct Search {
    const MesoCheckMesh *mesh;
    const MesoBoxTree *tree;
    _Atomic uint64_t between, within, one_patch;
    _Atomic uint8_t *meets;     /* [element_count] */
} Search;

/* What one triangle meets. */
typedef struct Probe {
    Search *search;
    uint32_t triangle;
    uint64_t between, within, one_patch;
} Probe;

static MesoVec3 corner_at(const MesoCheckMesh *mesh, uint32_t triangle, uint32_t k)
{
    return mesh->positions[mesh->corners[3 * (size_t)triangle + k]];
}

typedef struct Vec3d {
    double x, y, z;
} Vec3d;

/* Positions are single precision: their differences and products are all but exact in doubles. */
static Vec3d from(MesoVec3 origin, MesoVec3 p)
{
    return (Vec3d){(double)p.x - (double)origin.x, (double)p.y - (double)origin.y, (double)p.z - (double)origin.z};
}

static double volume(MesoVec3 a, MesoVec3 b, MesoVec3 c, MesoVec3 d)
{
    Vec3d u = from(a, b), v = from(a, c), w = from(a, d);
    return (u.y * v.z - u.z * v.y) * w.x + (u.z * v.x - u.x * v.z) * w.y + (u.x * v.y - u.y * v.x) * w.z;
}

static bool segment_crosses(MesoVec3 p, MesoVec3 q, const MesoVec3 *t)
{
    double above = volume(t[0], t[1], t[2], p), below = volume(t[0], t[1], t[2], q);
    if (!((above > 0 && below < 0) || (above < 0 && below > 0)))
        return false;
    double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

/* Side k of one that has no vertex of the other. */
static bool side_is_free(const uint32_t *v, uint32_t k, const uint32_t *w)
{
    for (uint32_t i = 0; i < 3; i++)
        if (v[k] == w[i] || v[(k + 1) % 3] == w[i])
            return false;
    return true;
}

/* Neighbours in a vertex may cross with the sides across from it; those along an edge can only lie on each other. */
static bool triangles_cross(const MesoCheckMesh *mesh, uint32_t s, uint32_t t)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)s], *w = &mesh->corners[3 * (size_t)t];
    MesoVec3 p[3], q[3];
    for (uint32_t k = 0; k < 3; k++) {
        p[k] = corner_at(mesh, s, k);
        q[k] = corner_at(mesh, t, k);
    }
    for (uint32_t k = 0; k < 3; k++)
        if ((side_is_free(v, k, w) && segment_crosses(p[k], p[(k + 1) % 3], q)) ||
            (side_is_free(w, k, v) && segment_crosses(q[k], q[(k + 1) % 3], p)))
            return true;
    return false;
}

/* Each pair once, by its lower triangle. */
static void test_pair(void *context, uint32_t other)
{
    Probe *probe = context;
    const MesoCheckMesh *mesh = probe->search->mesh;
    uint32_t t = probe->triangle;
    if (other <= t || !triangles_cross(mesh, t, other))
        return;
    bool between = mesh->elements[t] != mesh->elements[other];
    probe->between += between;
    probe->within += !between;
    probe->one_patch += !mesh->patches || mesh->patches[t] == mesh->patches[other];
    atomic_store_explicit(&probe->search->meets[mesh->elements[t]], 1, memory_order_relaxed);
    atomic_store_explicit(&probe->search->meets[mesh->elements[other]], 1, memory_order_relaxed);
}

/* Along the tree's curve, so that what is near in space is near in time. */
static void search_range(void *context, uint64_t begin, uint64_t end)
{
    Search *search = context;
    Probe probe = {.search = search};
    for (uint64_t i = begin; i < end; i++) {
        probe.triangle = search->tree->order[i];
        meso_box_tree_query(search->tree, search->tree->boxes[i], test_pair, &probe);
    }
    atomic_fetch_add(&search->between, probe.between);
    atomic_fetch_add(&search->within, probe.within);
    atomic_fetch_add(&search->one_patch, probe.one_patch);
}

MesoStatus meso_check_crossings(MesoCrossings *crossings, MesoArena *scratch, const MesoCheckMesh *mesh,
                                uint32_t thread_count, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoBoxTree tree;
    Search search = {.mesh = mesh, .tree = &tree};
    search.meets = MESO_NEW(scratch, _Atomic uint8_t, mesh->element_count, error);
    MesoBox *boxes = MESO_NEW(scratch, MesoBox, mesh->triangle_count, error);
    if (!search.meets || !boxes)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const MesoVec3 points[3] = {corner_at(mesh, t, 0), corner_at(mesh, t, 1), corner_at(mesh, t, 2)};
        boxes[t] = meso_box_of(points, 3);
    }
    MesoStatus status = meso_box_tree_build(&tree, scratch, boxes, mesh->triangle_count, error);
    if (status)
        return status;
    meso_parallel_for(thread_count, mesh->triangle_count, GRAIN, search_range, &search);
    *crossings = (MesoCrossings){.between_count = search.between, .within_count = search.within,
                                 .one_patch_count = search.one_patch};
    for (uint32_t e = 0; e < mesh->element_count; e++)
        crossings->element_count += search.meets[e];
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
