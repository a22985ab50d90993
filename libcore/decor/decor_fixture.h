/* What every finished pattern must keep, checked without looking at how it is done. For tests and fuzz entries. */
#ifndef MESO_DECOR_FIXTURE_H
#define MESO_DECOR_FIXTURE_H

#include <stdlib.h>

#include "libcore/base/check.h"
#include "libcore/decor/decor.h"
#include "libcore/decor/region/region_shape.h"
#include "libcore/mesh/cut/triangle_area.h"

static inline double meso_fixture_surface_area(const MesoTriangulation *mesh)
{
    double area = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        area += meso_triangle_area(mesh, t);
    return area;
}

/* Whether a walk goes on across a side: of all, or of what walls part. */
static inline bool meso_fixture_goes_on(const MesoTriangulation *mesh, uint32_t half_edge, bool open)
{
    return mesh->twins[half_edge] != MESO_NO_INDEX && !(open && meso_side_is_wall(mesh, half_edge));
}

/*
 * V - E + F of all triangles, or of those of one label, opened along its walls: vertices are counted once for each
 * fan of theirs between walls.
 */
static inline int64_t meso_fixture_region_euler(const MesoTriangulation *mesh, uint32_t label)
{
    bool open = label != MESO_NO_INDEX;
    int64_t faces = 0, twice = 0, vertices = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (open && mesh->labels[t] != label)
            continue;
        faces++;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t corner = 3 * t + k;
            twice += meso_fixture_goes_on(mesh, corner, open) ? 1 : 2;
            /* a fan is counted at its lowest corner */
            bool lowest = true, closed = false;
            for (int turned = 0; turned < 2 && !closed; turned++) {
                MesoFan fan = {corner, turned};
                while (!closed && meso_fixture_goes_on(mesh, meso_fan_exit(fan), open) && meso_fan_next(mesh, &fan)) {
                    closed = fan.corner == corner;
                    lowest &= fan.corner >= corner;
                }
            }
            vertices += lowest;
        }
    }
    return vertices - twice / 2 + faces;
}

static inline uint32_t meso_fixture_flood(const MesoTriangulation *mesh, uint32_t first, uint8_t *seen, uint32_t *stack)
{
    uint32_t depth = 0, count = 0;
    stack[depth++] = first;
    seen[first] = 1;
    while (depth > 0) {
        uint32_t t = stack[--depth];
        count++;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t across = mesh->twins[3 * t + k];
            if (across == MESO_NO_INDEX || seen[across / 3] || mesh->labels[across / 3] != mesh->labels[t])
                continue;
            seen[across / 3] = 1;
            stack[depth++] = across / 3;
        }
    }
    return count;
}

/*
 * Leaves are connected, and as large as the tree says; the first label may be of several pieces where the surface
 * is.
 */
static inline void meso_fixture_check_connected(const MesoDecor *decor)
{
    const MesoTriangulation *mesh = &decor->mesh;
    uint8_t *seen = calloc(mesh->triangle_count, 1);
    uint32_t *stack = malloc(mesh->triangle_count * sizeof *stack);
    uint32_t *pieces = calloc(decor->tree.region_count, sizeof *pieces);
    CHECK(seen && stack && pieces);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (seen[t])
            continue;
        uint32_t label = mesh->labels[t], count = meso_fixture_flood(mesh, t, seen, stack);
        CHECK(decor->tree.regions[label].child_count == 0);
        pieces[label]++;
        CHECK(label == 0 || (pieces[label] == 1 && count >= decor->tree.regions[label].triangle_count));
    }
    free(seen);
    free(stack);
    free(pieces);
}

static inline void meso_fixture_check_regions(const MesoDecor *decor, bool orientable, bool moved)
{
    MesoArena arena;
    MesoRegionLists lists;
    MesoRegionFacts facts;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_region_lists_build(&lists, &arena, &decor->tree, &decor->mesh, &error) == MESO_OK);
    CHECK(meso_region_facts(&facts, &arena, &decor->tree, &decor->mesh, &error) == MESO_OK);
    double leaves = 0, all = meso_fixture_surface_area(&decor->mesh);
    for (uint32_t r = 0; r < decor->tree.region_count; r++) {
        const MesoRegion *region = &decor->tree.regions[r];
        double children = 0;
        for (uint32_t i = 0; i < region->child_count; i++) {
            children += facts.shapes[region->child_begin + i].area;
            CHECK(decor->tree.regions[region->child_begin + i].parent == r);
        }
        if (region->child_count > 0) {
            CHECK(fabs(children - facts.shapes[r].area) <= 1e-6 * all);
            continue;
        }
        leaves += facts.shapes[r].area;
        CHECK(lists.begin[r + 1] > lists.begin[r]);
        CHECK(moved || fabs(region->area - facts.shapes[r].area) <= 1e-6 * all);
        int64_t holes = 2 - (int64_t)facts.shapes[r].borders - meso_fixture_region_euler(&decor->mesh, r);
        CHECK(r == 0 || (holes >= 0 && (!orientable || holes % 2 == 0)));
    }
    CHECK(fabs(leaves - all) <= 1e-6 * all);
    meso_arena_release(&arena);
}

#endif
