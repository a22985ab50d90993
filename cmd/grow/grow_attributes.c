/* Maps and fields that the surface's own file carries. */
#include <math.h>
#include <string.h>

#include "cmd/grow/grow_sources.h"
#include "libcore/base/nearest.h"

/* Names of numbers that the surface has: attributes, and what files call their components. */
static MesoNearest nearest_number(const MesoPolygonMesh *mesh, const char *name)
{
    MesoNearest nearest = meso_nearest(name, strlen(name));
    for (uint32_t a = 0; a < mesh->attribute_count; a++) {
        const MesoAttribute *attribute = &mesh->attributes[a];
        if (attribute->width > 0)
            meso_nearest_try(&nearest, attribute->name);
        for (uint32_t c = 0; attribute->components && c < attribute->width; c++)
            if (attribute->components[c])
                meso_nearest_try(&nearest, attribute->components[c]);
    }
    return nearest;
}

static MesoStatus fail_without(const MesoGrowSources *s, const char *name, const char *what)
{
    MesoNearest nearest = nearest_number(s->polygons, name);
    const MesoAttribute *named = meso_polygon_attribute(s->polygons, name);
    if (named && named->width == 0)
        return meso_grow_source_fail(s, MESO_ERR_INPUT, "'%s' of the surface holds names, no numbers: region(\"NAME\") "
                                     "is 1 where one of them stands", name);
    if (nearest.best && strcmp(nearest.best, name) != 0)
        return meso_grow_source_fail(s, MESO_ERR_INPUT, "the surface has no %s '%s'; is '%s' meant?", what, name,
                                     nearest.best);
    return meso_grow_source_fail(s, MESO_ERR_INPUT, "the surface has no %s '%s'", what, name);
}

/* ---- numbers ---- */

typedef struct Number {
    const MesoAttribute *attribute;
    uint32_t component;
} Number;

/* By an attribute's name and a component, or by the component's own name. */
static MesoStatus find_number(const MesoGrowSources *s, Number *number)
{
    const char *name = s->source->values[0].text;
    double component = s->source->values[1].number;
    number->attribute = meso_polygon_attribute(s->polygons, name);
    if (number->attribute && number->attribute->width > 0) {
        if (!(component >= 0 && component < number->attribute->width && component == floor(component)))
            return meso_grow_source_fail(s, MESO_ERR_INPUT, "'%s' has components from 0 to %u, and none '%g'", name,
                                         number->attribute->width - 1, component);
        number->component = (uint32_t)component;
        return MESO_OK;
    }
    number->attribute = meso_polygon_number(s->polygons, name, &number->component);
    return number->attribute ? MESO_OK : fail_without(s, name, "attribute");
}

/* Of an element of the polygons; where a file gives none it is 0. */
static MesoStatus take_number(const MesoGrowSources *s, const Number *number, uint32_t element, float *value)
{
    static const char *const elements[] = {"vertex", "face", "corner"};
    uint32_t entry = meso_attribute_entry(number->attribute, element);
    double x = entry == MESO_NO_INDEX ? 0 : meso_attribute_number(number->attribute, entry, number->component);
    if (!(fabs(x) <= (double)MESO_COORDINATE_LIMIT))
        return meso_grow_source_fail(s, MESO_ERR_INPUT, "'%s' of the surface is %g at %s %u", number->attribute->name,
                                     x, elements[number->attribute->domain], element + 1);
    *value = (float)x;
    return MESO_OK;
}

/* Values by the triangulation's elements, of which there are `count`. */
static uint32_t element_of(const MesoGrowSources *s, MesoAttributeDomain domain, uint32_t i)
{
    const MesoTriangulation *mesh = s->ground->mesh;
    return domain == MESO_ON_VERTICES ? mesh->origins[i]
         : domain == MESO_ON_FACES    ? mesh->faces[i]
                                      : 3 * mesh->faces[i / 3] + i % 3;
}

static uint32_t element_count(const MesoGrowSources *s, MesoAttributeDomain domain)
{
    const MesoTriangulation *mesh = s->ground->mesh;
    return domain == MESO_ON_VERTICES ? mesh->vertex_count
         : domain == MESO_ON_FACES    ? mesh->triangle_count
                                      : 3 * mesh->triangle_count;
}

MesoStatus meso_grow_map_attribute(MesoGrowSources *s, MesoGrowthMap *map)
{
    static const MesoGrowthDomain domains[] = {MESO_GROWTH_BY_VERTEX, MESO_GROWTH_BY_TRIANGLE, MESO_GROWTH_BY_CORNER};
    Number number;
    MesoStatus status = find_number(s, &number);
    if (status)
        return status;
    MesoAttributeDomain domain = number.attribute->domain;
    uint32_t count = element_count(s, domain);
    float *values = MESO_NEW(&s->tool->arena, float, count, &s->tool->error);
    status = values ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count && !status; i++)
        status = take_number(s, &number, element_of(s, domain, i), &values[i]);
    map->domain = domains[domain];
    map->values = values;
    return status;
}

/* ---- vectors ---- */

static bool find_components(const MesoGrowSources *s, const char *name, const char *separator,
                            MesoAttributeDomain domain, Number numbers[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        char text[256];
        if (snprintf(text, sizeof text, "%s%s%c", name, separator, "xyz"[i]) >= (int)sizeof text)
            return false;
        numbers[i].attribute = meso_polygon_number_on(s->polygons, text, domain, &numbers[i].component);
        if (!numbers[i].attribute)
            return false;
    }
    return true;
}

/* An attribute of three numbers, or three with endings x y z or _x _y _z. */
static MesoStatus find_vector(const MesoGrowSources *s, Number numbers[3])
{
    static const MesoAttributeDomain domains[] = {MESO_ON_FACES, MESO_ON_VERTICES, MESO_ON_CORNERS};
    const char *name = s->source->values[0].text;
    for (uint32_t d = 0; d < 3; d++) {
        const MesoAttribute *attribute = meso_polygon_attribute_on(s->polygons, name, domains[d]);
        for (uint32_t i = 0; i < 3; i++)
            numbers[i] = (Number){attribute, i};
        if ((attribute && attribute->width == 3) || find_components(s, name, "", domains[d], numbers) ||
            find_components(s, name, "_", domains[d], numbers))
            return MESO_OK;
    }
    return fail_without(s, name, "attribute of three numbers,");
}

MesoStatus meso_grow_attribute_vectors(MesoGrowSources *s, MesoVec3 **vectors)
{
    Number numbers[3];
    MesoStatus status = find_vector(s, numbers);
    if (status)
        return status;
    const MesoTriangulation *mesh = s->ground->mesh;
    *vectors = MESO_NEW(&s->tool->arena, MesoVec3, mesh->triangle_count, &s->tool->error);
    if (!*vectors)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count && !status; t++) {
        float sum[3] = {0, 0, 0};
        for (uint32_t i = 0; i < 9 && !status; i++) {
            MesoAttributeDomain domain = numbers[i / 3].attribute->domain;
            uint32_t corner = 3 * t + i % 3;
            uint32_t at = domain == MESO_ON_VERTICES ? mesh->corners[corner] : domain == MESO_ON_FACES ? t : corner;
            float value = 0;
            status = take_number(s, &numbers[i / 3], element_of(s, domain, at), &value);
            sum[i / 3] += value;
        }
        (*vectors)[t] = (MesoVec3){sum[0], sum[1], sum[2]};
    }
    return status;
}
