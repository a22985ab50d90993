#include "formats/mesh/surface_number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a number is taken from. */
typedef struct Source {
    const MesoNumberWish *wish;
    const MesoAttribute *attribute;
    uint32_t component;
    float *of_names;            /* [entry_count] of an attribute of names */
} Source;

static MesoStatus fail_pair(const MesoNumberWish *wish, const char *pair, MesoError *error)
{
    return meso_fail(error, MESO_ERR_USAGE, "--%s: '%.*s' is not NAME=NUMBER from %g to %g", wish->option,
                     (int)strcspn(pair, ","), pair, (double)wish->low, (double)wish->high);
}

static uint32_t find_name(const MesoAttribute *attribute, const char *name, size_t length)
{
    uint32_t entry = 0;
    while (entry < attribute->entry_count &&
           (strlen(attribute->names[entry]) != length || memcmp(attribute->names[entry], name, length) != 0))
        entry++;
    return entry;
}

/* A=1,B=0.5 */
static MesoStatus read_pairs(Source *source, const char *pairs, MesoArena *arena, const char *path, MesoError *error)
{
    const MesoNumberWish *wish = source->wish;
    const MesoAttribute *attribute = source->attribute;
    source->of_names = MESO_NEW(arena, float, attribute->entry_count, error);
    if (!source->of_names)
        return MESO_ERR_MEMORY;
    for (uint32_t entry = 0; entry < attribute->entry_count; entry++)
        source->of_names[entry] = wish->otherwise;
    for (const char *pair = pairs; *pair;) {
        char *end;
        size_t length = strcspn(pair, "=,");
        float value = pair[length] == '=' ? strtof(pair + length + 1, &end) : NAN;
        if (length == 0 || pair[length] != '=' || end == pair + length + 1 || (*end && *end != ',') ||
            !(value >= wish->low && value <= wish->high))
            return fail_pair(wish, pair, error);
        uint32_t entry = find_name(attribute, pair, length);
        if (entry == attribute->entry_count)
            return meso_fail(error, MESO_ERR_INPUT, "%s: no %s is named '%.*s' (--%s)", path, attribute->name,
                             (int)length, pair, wish->option);
        source->of_names[entry] = value;
        pair = *end ? end + 1 : end;
    }
    return MESO_OK;
}

static MesoStatus find_source(Source *source, MesoArena *arena, const MesoPolygonMesh *mesh, const char *path,
                              MesoError *error)
{
    const MesoNumberWish *wish = source->wish;
    size_t length = strcspn(wish->what, ":");
    const char *pairs = wish->what[length] ? wish->what + length + 1 : NULL;
    const char *name = meso_arena_print(arena, error, "%.*s", (int)length, wish->what);
    if (!name)
        return MESO_ERR_MEMORY;
    source->attribute = pairs ? meso_polygon_attribute(mesh, name)
                              : meso_polygon_number(mesh, name, &source->component);
    if (!source->attribute || (pairs && source->attribute->width > 0))
        return meso_fail(error, MESO_ERR_INPUT, "%s: has no attribute '%s' of %s (--%s)", path, name,
                         pairs ? "names" : "numbers", wish->option);
    return pairs ? read_pairs(source, pairs, arena, path, error) : MESO_OK;
}

/* Of the corner `c` of `face`; NaN where it has none. */
static double number_at(const Source *source, const MesoPolygonMesh *mesh, uint32_t face, uint32_t c)
{
    const MesoAttribute *attribute = source->attribute;
    uint32_t element = attribute->domain == MESO_ON_VERTICES ? mesh->corners[c]
                     : attribute->domain == MESO_ON_FACES ? face : c;
    uint32_t entry = meso_attribute_entry(attribute, element);
    if (source->of_names)
        return entry == MESO_NO_INDEX ? (double)source->wish->otherwise : (double)source->of_names[entry];
    return entry == MESO_NO_INDEX ? (double)source->wish->otherwise
                                  : meso_attribute_number(attribute, entry, source->component);
}

/* The mean over the corners at each vertex. */
static MesoStatus average(float *numbers, const Source *source, MesoArena *scratch, const MesoPolygonMesh *mesh,
                          const char *path, MesoError *error)
{
    const MesoNumberWish *wish = source->wish;
    double *sums = MESO_NEW(scratch, double, mesh->vertex_count, error);
    uint32_t *counts = MESO_NEW(scratch, uint32_t, mesh->vertex_count, error);
    if (!sums || !counts)
        return MESO_ERR_MEMORY;
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        uint32_t begin = meso_polygon_begin(mesh, face), end = begin + meso_polygon_sides(mesh, face);
        for (uint32_t c = begin; c < end; c++) {
            double number = number_at(source, mesh, face, c);
            if (!(number >= (double)wish->low && number <= (double)wish->high))
                return meso_fail(error, MESO_ERR_INPUT, "%s: '%s' is %g at vertex %u; from %g to %g is possible (--%s)",
                                 path, source->attribute->name, number, mesh->corners[c] + 1, (double)wish->low,
                                 (double)wish->high, wish->option);
            sums[mesh->corners[c]] += number;
            counts[mesh->corners[c]]++;
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        numbers[v] = counts[v] ? (float)(sums[v] / counts[v]) : wish->otherwise;
    return MESO_OK;
}

MesoStatus meso_surface_numbers(float **numbers, MesoArena *arena, const MesoPolygonMesh *mesh,
                                const MesoNumberWish *wish, const char *path, MesoError *error)
{
    MesoArena scratch;
    Source source = {.wish = wish};
    meso_arena_init(&scratch);
    *numbers = MESO_NEW(arena, float, mesh->vertex_count, error);
    MesoStatus status = *numbers ? find_source(&source, &scratch, mesh, path, error) : MESO_ERR_MEMORY;
    if (!status)
        status = average(*numbers, &source, &scratch, mesh, path, error);
    meso_arena_release(&scratch);
    return status;
}
