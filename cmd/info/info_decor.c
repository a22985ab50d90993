#include "cmd/info/info_decor.h"

#include <string.h>

#include "formats/decor/pattern_file.h"
#include "formats/decor/tree_file.h"
#include "formats/json/json_text.h"

static MesoStatus memory_if(int failed, MesoError *error)
{
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory: facts of a file") : MESO_OK;
}

/* One more of a name. */
static int add_one(json_t *counts, const char *name)
{
    json_int_t before = json_integer_value(json_object_get(counts, name));
    return json_object_set_new(counts, name, json_integer(before + 1));
}

static int put_provenance(json_t *facts, const json_t *root)
{
    json_t *provenance = json_object_get(root, "provenance");
    return provenance ? json_object_set(facts, "provenance", provenance) : 0;
}

/* Names of a table, in its order. */
static int put_names(json_t *facts, const char *key, json_t *table)
{
    json_t *names = json_array();
    const char *name;
    json_t *value;
    int failed = 0;
    json_object_foreach(table, name, value)
        failed |= json_array_append_new(names, meso_json_string(name));
    return failed | json_object_set_new(facts, key, names);
}

/* Steps as they stand there: macros are not written out. */
static MesoStatus put_pattern(json_t *facts, json_t *root, MesoError *error)
{
    static const char *const kinds[] = {"contour", "stream", "voronoi", "polyline", "paint", "displace", "macro",
                                        "grow", "steps"};
    json_t *steps = json_object_get(root, "steps"), *counts = json_object(), *step;
    size_t i;
    int failed = json_object_set_new(facts, "kind", json_string("pattern"));
    failed |= put_provenance(facts, root);
    failed |= put_names(facts, "materials", json_object_get(root, "materials"));
    failed |= put_names(facts, "macros", json_object_get(root, "macros"));
    failed |= json_object_set_new(facts, "steps", json_integer((json_int_t)json_array_size(steps)));
    json_array_foreach(steps, i, step) {
        size_t k = 0;
        while (k + 1 < sizeof kinds / sizeof *kinds && !json_object_get(step, kinds[k]))
            k++;
        failed |= add_one(counts, kinds[k]);
    }
    failed |= json_object_set_new(facts, "of", counts);
    return memory_if(failed, error);
}

static MesoStatus put_macros(json_t *facts, json_t *root, MesoError *error)
{
    int failed = json_object_set_new(facts, "kind", json_string("macros"));
    failed |= put_names(facts, "macros", json_object_get(root, "macros"));
    return memory_if(failed, error);
}

static MesoStatus put_regions(json_t *facts, json_t *root, const char *path, MesoError *error)
{
    json_t *regions = json_object_get(root, "regions"), *tags = json_object(), *region;
    json_int_t leaves = 0, depth = 0;
    size_t i;
    int failed = json_object_set_new(facts, "kind", json_string("regions"));
    failed |= put_provenance(facts, root);
    json_array_foreach(regions, i, region) {
        const char *tag = json_string_value(json_object_get(region, "tag"));
        json_int_t level = json_integer_value(json_object_get(region, "depth"));
        depth = level > depth ? level : depth;
        if (json_object_get(region, "children"))
            continue;
        leaves++;
        failed |= tag ? add_one(tags, tag) : 0;
    }
    failed |= json_object_set(facts, "operations", json_object_get(root, "operations"));
    failed |= json_object_set_new(facts, "regions", json_integer((json_int_t)json_array_size(regions)));
    failed |= json_object_set_new(facts, "leaves", json_integer(leaves));
    failed |= json_object_set_new(facts, "depth", json_integer(depth));
    failed |= json_object_set_new(facts, "tags", tags);
    if (!json_is_array(regions) || !json_is_integer(json_object_get(root, "operations")))
        return meso_fail(error, MESO_ERR_INPUT, "%s: a tree of regions needs \"operations\" and \"regions\"", path);
    return memory_if(failed, error);
}

bool meso_info_decor(json_t *facts, const char *format, json_t *root, const char *path, MesoStatus *status,
                     MesoError *error)
{
    bool pattern = strcmp(format, "meso-pattern") == 0, macros = strcmp(format, "meso-macros") == 0;
    if (!pattern && !macros && strcmp(format, "meso-regions") != 0)
        return false;
    int newest = pattern ? MESO_PATTERN_VERSION : macros ? MESO_MACROS_VERSION : MESO_REGIONS_VERSION;
    *status = meso_json_check_format(root, path, format, newest, error);
    if (!*status)
        *status = pattern ? put_pattern(facts, root, error) : macros ? put_macros(facts, root, error)
                                                                     : put_regions(facts, root, path, error);
    return true;
}
