#include "formats/decor/tree_file.h"

#include <math.h>

#include "formats/json/json_text.h"
#include "libcore/decor/region/region_shape.h"

static json_t *numbers(const uint32_t *values, uint32_t count)
{
    json_t *array = json_array();
    for (uint32_t i = 0; array && i < count; i++)
        if (json_array_append_new(array, json_integer(values[i]))) {
            json_decref(array);
            return NULL;
        }
    return array;
}

static json_t *range(uint32_t begin, uint32_t count)
{
    json_t *array = json_array();
    for (uint32_t i = 0; array && i < count; i++)
        if (json_array_append_new(array, json_integer(begin + i))) {
            json_decref(array);
            return NULL;
        }
    return array;
}

/* Infinite where a region is all border. */
static json_t *finite_real(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *region_json(const MesoDecor *decor, const MesoRegionFacts *facts, uint32_t number, const char *path)
{
    const MesoRegion *region = &decor->tree.regions[number];
    const MesoRegionShape *shape = &facts->shapes[number];
    json_t *object = json_object();
    int failed = json_object_set_new(object, "path", meso_json_string(path));
    failed |= json_object_set_new(object, "name", meso_json_string(region->name));
    failed |= json_object_set_new(object, "tag", meso_json_string(region->tag));
    failed |= json_object_set_new(object, "number", json_integer(region->number));
    failed |= json_object_set_new(object, "depth", json_integer(region->depth));
    failed |= json_object_set_new(object, "operation", json_integer(region->step));
    failed |= json_object_set_new(object, "area", json_real(shape->area));
    failed |= json_object_set_new(object, "perimeter", json_real(shape->perimeter));
    failed |= json_object_set_new(object, "borders", json_integer(shape->borders));
    failed |= json_object_set_new(object, "corners", json_integer(shape->corners));
    failed |= json_object_set_new(object, "aspect", finite_real(shape->aspect));
    if (region->child_count > 0) {
        failed |= json_object_set_new(object, "children", range(region->child_begin, region->child_count));
    } else {
        uint32_t begin = facts->neighbour_begin[number], end = facts->neighbour_begin[number + 1];
        failed |= json_object_set_new(object, "triangles", json_integer(region->triangle_count));
        failed |= json_object_set_new(object, "neighbours", numbers(facts->neighbours + begin, end - begin));
    }
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

static json_t *tree_json(const MesoDecor *decor, const MesoRegionFacts *facts, const MesoProvenance *provenance,
                         MesoArena *arena)
{
    json_t *root = json_object(), *regions = json_array();
    int failed = json_object_set_new(root, "format", json_string("meso-regions"));
    failed |= json_object_set_new(root, "version", json_integer(MESO_REGIONS_VERSION));
    failed |= json_object_set_new(root, "provenance", meso_provenance_json(provenance));
    failed |= json_object_set_new(root, "operations", json_integer(decor->operation_count));
    failed |= json_object_set_new(root, "regions", regions);
    for (uint32_t r = 0; r < decor->tree.region_count && !failed; r++) {
        const char *path = meso_region_path(&decor->tree, arena, r, NULL);
        failed = !path || json_array_append_new(regions, region_json(decor, facts, r, path));
    }
    if (!failed)
        return root;
    json_decref(root);
    return NULL;
}

MesoStatus meso_tree_write(const MesoDecor *decor, const MesoProvenance *provenance, MesoOutput *output,
                           MesoError *error)
{
    MesoArena arena;
    MesoRegionFacts facts;
    meso_arena_init(&arena);
    MesoStatus status = meso_region_facts(&facts, &arena, &decor->tree, &decor->mesh, error);
    json_t *root = status ? NULL : tree_json(decor, &facts, provenance, &arena);
    if (!status)
        status = root ? meso_json_write(root, output, error) : meso_fail(error, MESO_ERR_MEMORY,
                                                                         "out of memory: the tree");
    json_decref(root);
    meso_arena_release(&arena);
    return status;
}
