#include "libcore/decor/region/region_tree.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/point/surface_point.h"
#include "libcore/mesh/cut/triangle_area.h"

MesoStatus meso_region_tree_init(MesoRegionTree *tree, MesoArena *arena, const MesoTriangulation *mesh,
                                 MesoError *error)
{
    *tree = (MesoRegionTree){.region_count = 1, .region_room = 64, .arena = arena};
    tree->regions = MESO_NEW(arena, MesoRegion, tree->region_room, error);
    if (!tree->regions)
        return MESO_ERR_MEMORY;
    double area = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        area += meso_triangle_area(mesh, t);
    tree->regions[0] = (MesoRegion){
        .parent = MESO_NO_INDEX, .tag = "surface", .name = "surface", .material = {MESO_NO_INDEX},
        .triangle_count = mesh->triangle_count, .area = area,
    };
    return MESO_OK;
}

MesoStatus meso_region_tree_split(MesoRegionTree *tree, uint32_t leaf, uint32_t count, const MesoRegion *like,
                                  uint32_t *first, MesoError *error)
{
    *first = tree->region_count;
    for (uint32_t i = 0; i < count; i++) {
        tree->regions = MESO_GROW(tree->arena, tree->regions, tree->region_count, tree->region_room, 64, error);
        if (!tree->regions)
            return MESO_ERR_MEMORY;
        MesoRegion *child = &tree->regions[tree->region_count++];
        *child = *like;
        child->parent = leaf;
        child->child_begin = child->child_count = 0;
        child->number = i;
        child->depth = tree->regions[leaf].depth + 1;
    }
    tree->regions[leaf].child_begin = *first;
    tree->regions[leaf].child_count = count;
    return MESO_OK;
}

bool meso_region_is_within(const MesoRegionTree *tree, uint32_t region, uint32_t ancestor)
{
    while (region > ancestor && region != MESO_NO_INDEX)
        region = tree->regions[region].parent;
    return region == ancestor;
}

uint32_t meso_region_painted(const MesoRegionTree *tree, uint32_t region)
{
    while (region != MESO_NO_INDEX && tree->regions[region].material[0] == MESO_NO_INDEX)
        region = tree->regions[region].parent;
    return region;
}

const char *meso_region_path(const MesoRegionTree *tree, MesoArena *arena, uint32_t region, MesoError *error)
{
    const MesoRegion *r = &tree->regions[region];
    if (r->parent == MESO_NO_INDEX)
        return r->name;
    if (r->parent == 0)
        return meso_arena_print(arena, error, "%s.%u", r->name, r->number);
    const char *above = meso_region_path(tree, arena, r->parent, error);
    return above ? meso_arena_print(arena, error, "%s/%s.%u", above, r->name, r->number) : NULL;
}

/* ---- paths ---- */

/* One part of a path, `length` bytes, against one region. */
static bool fits_part(const MesoRegion *region, const char *part, size_t length)
{
    size_t name = strlen(region->name);
    if (length == 1 && *part == '*')
        return true;
    if (length == name && memcmp(part, region->name, name) == 0)
        return true;
    if (length <= name + 1 || memcmp(part, region->name, name) != 0 || part[name] != '.')
        return false;
    char *end;
    unsigned long number = strtoul(part + name + 1, &end, 10);
    return end == part + length && number == region->number;
}

static const char *next_part(const char *part)
{
    part += strcspn(part, "/");
    return part + strspn(part, "/");
}

static bool is_any_number(const char *part)
{
    return strcspn(part, "/") == 2 && memcmp(part, "**", 2) == 0;
}

/*
 * The regions from below the scope to the one asked for, against a path. Where a part fails, the last '**' takes one
 * region more: an earlier one need not, since what it would give up can always go to the last.
 */
static bool fits_way(const MesoRegionTree *tree, const uint32_t *way, uint32_t length, const char *path)
{
    const char *after_any = NULL;
    uint32_t any = 0, i = 0;
    path += strspn(path, "/");
    while (i < length || is_any_number(path)) {
        if (is_any_number(path)) {
            path = after_any = next_part(path);
            any = i;
        } else if (i < length && *path && fits_part(&tree->regions[way[i]], path, strcspn(path, "/"))) {
            path = next_part(path);
            i++;
        } else if (after_any && any < length) {
            path = after_any;
            i = ++any;
        } else {
            return false;
        }
    }
    return *path == 0;
}

/* Deeper than this, nothing fits: patterns end long before. */
enum { DEEPEST = 256 };

bool meso_region_fits_path(const MesoRegionTree *tree, uint32_t scope, uint32_t region, const char *path)
{
    uint32_t way[DEEPEST], length = tree->regions[region].depth - tree->regions[scope].depth;
    if (length > DEEPEST)
        return false;
    for (uint32_t i = length; i-- > 0; region = tree->regions[region].parent)
        way[i] = region;
    return region == scope && fits_way(tree, way, length, strcmp(path, ".") == 0 ? "" : path);
}

/* ---- triangles ---- */

MesoStatus meso_region_lists_build(MesoRegionLists *lists, MesoArena *arena, const MesoRegionTree *tree,
                                   const MesoTriangulation *mesh, MesoError *error)
{
    lists->begin = MESO_NEW(arena, uint32_t, (size_t)tree->region_count + 2, error);
    lists->triangles = MESO_NEW(arena, uint32_t, mesh->triangle_count, error);
    if (!lists->begin || !lists->triangles)
        return MESO_ERR_MEMORY;
    uint32_t *place = lists->begin + 1;    /* counts shifted by one, so that filling leaves the beginnings */
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        place[mesh->labels[t] + 1]++;
    for (uint32_t r = 0; r < tree->region_count; r++)
        place[r + 1] += place[r];
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        lists->triangles[place[mesh->labels[t]]++] = t;
    return MESO_OK;
}

void meso_region_each_leaf(const MesoRegionTree *tree, uint32_t region,
                           void (*visit)(void *context, uint32_t leaf), void *context)
{
    const MesoRegion *r = &tree->regions[region];
    if (r->child_count == 0)
        visit(context, region);
    for (uint32_t i = 0; i < r->child_count; i++)
        meso_region_each_leaf(tree, r->child_begin + i, visit, context);
}

typedef struct Gathering {
    const MesoRegionLists *lists;
    uint8_t *member;
    uint32_t *triangles;    /* NULL: only counted */
    uint32_t count, leaves;
} Gathering;

static void gather_leaf(void *context, uint32_t leaf)
{
    Gathering *g = context;
    uint32_t begin = g->lists->begin[leaf], count = g->lists->begin[leaf + 1] - begin;
    g->member[leaf] = 1;
    if (g->triangles && count)
        memcpy(g->triangles + g->count, g->lists->triangles + begin, count * sizeof *g->triangles);
    g->count += count;
    g->leaves++;
}


/* Domains with more than this share of the mesh's triangles are found by a look at all, and not by sorting. */
enum { SORT_SHARE = 64 };

static void pick_triangles(Gathering *g, const MesoTriangulation *mesh)
{
    g->count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (g->member[mesh->labels[t]])
            g->triangles[g->count++] = t;
}

MesoStatus meso_region_domain(MesoDomain *domain, uint8_t *member, MesoArena *arena, const MesoRegionTree *tree,
                              const MesoRegionLists *lists, const MesoTriangulation *mesh, uint32_t region,
                              MesoError *error)
{
    Gathering g = {.lists = lists, .member = member};
    meso_region_each_leaf(tree, region, gather_leaf, &g);
    *domain = (MesoDomain){.member = member, .triangle_count = g.count};
    if (g.leaves == 1) {
        domain->triangles = lists->triangles + lists->begin[region];
        if (tree->regions[region].child_count == 0)
            return MESO_OK;
    }
    g.triangles = MESO_NEW(arena, uint32_t, g.count, error);
    if (!g.triangles)
        return MESO_ERR_MEMORY;
    if (g.count > mesh->triangle_count / SORT_SHARE) {
        pick_triangles(&g, mesh);
    } else {
        g.count = 0;
        meso_region_each_leaf(tree, region, gather_leaf, &g);
        qsort(g.triangles, g.count, sizeof *g.triangles, meso_by_number);
    }
    domain->triangles = g.triangles;
    return MESO_OK;
}

static void forget_leaf(void *context, uint32_t leaf)
{
    uint8_t *member = context;
    member[leaf] = 0;
}

void meso_region_domain_end(const MesoRegionTree *tree, uint32_t region, uint8_t *member)
{
    meso_region_each_leaf(tree, region, forget_leaf, member);
}
