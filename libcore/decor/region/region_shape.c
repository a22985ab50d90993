#include "libcore/decor/region/region_shape.h"

#include <stdlib.h>

#include "libcore/mesh/cut/border_loops.h"

/* Sides a >= b of the rectangle with this area and perimeter: a + b = P / 2, a b = A. */
static double rectangle_aspect(double area, double perimeter)
{
    double half = perimeter / 4, root = half * half - area;
    if (!(root > 0) || !(area > 0))
        return 1;
    root = sqrt(root);
    return half > root ? (half + root) / (half - root) : INFINITY;
}

MesoStatus meso_region_shape(MesoRegionShape *shape, MesoArena *scratch, const MesoTriangulation *mesh,
                             const MesoDomain *domain, MesoError *error)
{
    MesoBorderLoops loops;
    MesoArenaMark mark = meso_arena_mark(scratch);
    *shape = (MesoRegionShape){0};
    MesoStatus status = meso_border_loops_find(&loops, scratch, mesh, domain, true, error);
    if (!status) {
        shape->area = loops.area;
        shape->borders = loops.loop_count;
        for (uint32_t i = 0; i < loops.loop_count; i++) {
            shape->corners += loops.loops[i].corner_count;
            shape->perimeter += (double)loops.loops[i].length;
        }
        shape->aspect = rectangle_aspect(loops.area, shape->perimeter);
    }
    meso_arena_rewind(scratch, mark);
    return status;
}

/* ---- facts ---- */

/* Pairs of labels across walls, both ways; counted only where `pairs` is NULL. */
static uint64_t find_pairs(const MesoTriangulation *mesh, uint64_t *pairs)
{
    uint64_t count = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        if (mesh->twins[h] == MESO_NO_INDEX || mesh->labels[h / 3] == mesh->labels[mesh->twins[h] / 3])
            continue;
        if (pairs)
            pairs[count] = (uint64_t)mesh->labels[h / 3] << 32 | mesh->labels[mesh->twins[h] / 3];
        count++;
    }
    return count;
}

static int by_pair(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

static MesoStatus find_neighbours(MesoRegionFacts *facts, MesoArena *arena, uint32_t region_count,
                                  const MesoTriangulation *mesh, MesoError *error)
{
    uint64_t count = find_pairs(mesh, NULL), kept = 0;
    uint64_t *pairs = MESO_NEW(arena, uint64_t, count, error);
    facts->neighbour_begin = MESO_NEW(arena, uint32_t, (size_t)region_count + 1, error);
    facts->neighbours = MESO_NEW(arena, uint32_t, count, error);
    if (!pairs || !facts->neighbour_begin || !facts->neighbours)
        return MESO_ERR_MEMORY;
    find_pairs(mesh, pairs);
    qsort(pairs, count, sizeof *pairs, by_pair);
    for (uint64_t i = 0; i < count; i++)
        if (i == 0 || pairs[i] != pairs[i - 1]) {
            facts->neighbour_begin[(pairs[i] >> 32) + 1]++;
            facts->neighbours[kept++] = (uint32_t)pairs[i];
        }
    for (uint32_t r = 0; r < region_count; r++)
        facts->neighbour_begin[r + 1] += facts->neighbour_begin[r];
    return MESO_OK;
}

MesoStatus meso_region_facts(MesoRegionFacts *facts, MesoArena *arena, const MesoRegionTree *tree,
                             const MesoTriangulation *mesh, MesoError *error)
{
    MesoRegionLists lists;
    uint8_t *member = MESO_NEW(arena, uint8_t, tree->region_count, error);
    facts->shapes = MESO_NEW(arena, MesoRegionShape, tree->region_count, error);
    MesoStatus status = member && facts->shapes ? meso_region_lists_build(&lists, arena, tree, mesh, error)
                                                : MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < tree->region_count && !status; r++) {
        MesoDomain domain;
        MesoArenaMark mark = meso_arena_mark(arena);
        status = meso_region_domain(&domain, member, arena, tree, &lists, mesh, r, error);
        if (!status)
            status = meso_region_shape(&facts->shapes[r], arena, mesh, &domain, error);
        meso_region_domain_end(tree, r, member);
        meso_arena_rewind(arena, mark);
    }
    return status ? status : find_neighbours(facts, arena, tree->region_count, mesh, error);
}
