#include "cmd/replicate/replicate_maps.h"

#include <string.h>

#include "formats/image/image_read.h"
#include "formats/quilt/quilt_move.h"
#include "libcore/base/nearest.h"

static MesoStatus fail_without(const MesoReplicateGround *g, const char *name, const char *what)
{
    MesoNearest nearest = meso_nearest(name, strlen(name));
    for (uint32_t a = 0; a < g->triangles->attribute_count; a++)
        if (g->triangles->attributes[a].width > 0)
            meso_nearest_try(&nearest, g->triangles->attributes[a].name);
    bool near = nearest.best && strcmp(nearest.best, name) != 0;
    return meso_fail(&g->tool->error, MESO_ERR_INPUT, "%s: the surface has no attribute '%s'%s%s%s%s",
                     g->tool->operands[0], name, what, near ? "; is '" : "", near ? nearest.best : "",
                     near ? "' meant?" : "");
}

/* From 0 at `low` to 1 at `high`. */
static bool bring(const MesoDetailMap *map, double value, float *out)
{
    double share = (value - (double)map->low) / ((double)map->high - (double)map->low);
    *out = (float)fmin(fmax(share, 0), 1);
    return isfinite(value);
}

/* ---- attributes ---- */

/* The polygons' element that an element of the triangulation is. */
static uint32_t element_of(const MesoTriangulation *mesh, const MesoPolygonMesh *triangles, MesoAttributeDomain domain,
                           uint32_t i)
{
    if (domain != MESO_ON_CORNERS)
        return domain == MESO_ON_VERTICES ? mesh->origins[i] : mesh->faces[i];
    uint32_t corner = 3 * mesh->faces[i / 3], vertex = mesh->origins[mesh->corners[i]];
    while (triangles->corners[corner] != vertex)
        corner++;
    return corner;
}

static MesoStatus map_of_attribute(MesoGrowthMap *map, const MesoReplicateGround *g, const MesoDetailMap *wanted)
{
    static const MesoGrowthDomain domains[] = {MESO_GROWTH_BY_VERTEX, MESO_GROWTH_BY_TRIANGLE, MESO_GROWTH_BY_CORNER};
    const MesoTriangulation *mesh = g->ground.mesh;
    uint32_t component = wanted->channel;
    const MesoAttribute *attribute = meso_polygon_attribute(g->triangles, wanted->attribute);
    if (!attribute || attribute->width == 0)
        attribute = meso_polygon_number(g->triangles, wanted->attribute, &component);
    if (!attribute || component >= attribute->width)
        return fail_without(g, wanted->attribute, attribute ? " with so many channels" : "");
    MesoAttributeDomain domain = attribute->domain;
    uint32_t count = domain == MESO_ON_VERTICES ? mesh->vertex_count
                   : domain == MESO_ON_FACES    ? mesh->triangle_count : 3 * mesh->triangle_count;
    float *values = MESO_NEW(&g->tool->arena, float, count, &g->tool->error);
    if (!values)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t entry = meso_attribute_entry(attribute, element_of(mesh, g->triangles, domain, i));
        double value = entry == MESO_NO_INDEX ? 0 : meso_attribute_number(attribute, entry, component);
        if (!bring(wanted, value, &values[i]))
            return meso_fail(&g->tool->error, MESO_ERR_INPUT, "%s: '%s' of the surface is not finite",
                             g->tool->operands[0], wanted->attribute);
    }
    *map = (MesoGrowthMap){.domain = domains[domain], .values = values};
    return MESO_OK;
}

/* ---- pictures ---- */

static MesoStatus corner_uvs(MesoVec2 **out, const MesoReplicateGround *g, const char *image)
{
    const MesoTriangulation *mesh = g->ground.mesh;
    uint32_t face;
    MesoVec2 *uvs;
    MesoStatus status = meso_corner_uvs(&uvs, &g->tool->arena, g->triangles, &face, &g->tool->error);
    if (status)
        return status;
    if (!uvs)
        return meso_fail(&g->tool->error, MESO_ERR_INPUT, "%s: '%s' needs texture coordinates, and the surface has "
                         "none%s", g->tool->operands[0], image, face == MESO_NO_INDEX ? "" : " on some faces");
    *out = MESO_NEW(&g->tool->arena, MesoVec2, 3 * (size_t)mesh->triangle_count, &g->tool->error);
    for (uint32_t c = 0; *out && c < 3 * mesh->triangle_count; c++)
        (*out)[c] = uvs[element_of(mesh, g->triangles, MESO_ON_CORNERS, c)];
    return *out ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus map_of_image(MesoGrowthMap *map, const MesoReplicateGround *g, const MesoDetailMap *wanted)
{
    MesoTool *tool = g->tool;
    MesoPicture picture;
    MesoVec2 *uvs = NULL;
    const MesoInput *input = meso_replicate_file(g->files, wanted->image, "image");
    MesoStatus status = input ? meso_image_read(&picture, &tool->arena, input, &tool->error) : tool->error.status;
    if (!status && wanted->channel >= picture.channel_count)
        status = meso_fail(&tool->error, MESO_ERR_INPUT, "%s: '%s' has %u channels, and no channel %u",
                           tool->operands[0], wanted->image, picture.channel_count, wanted->channel);
    if (!status)
        status = corner_uvs(&uvs, g, wanted->image);
    if (status)
        return status;
    size_t count = (size_t)picture.width * picture.height;
    float *pixels = picture.values + wanted->channel * count;
    for (size_t i = 0; i < count; i++)
        if (!bring(wanted, (double)pixels[i], &pixels[i]))
            return meso_fail(&tool->error, MESO_ERR_INPUT, "%s: '%s' has no number in column %zu of row %zu",
                             tool->operands[0], wanted->image, i % picture.width + 1, i / picture.width + 1);
    *map = (MesoGrowthMap){.domain = MESO_GROWTH_BY_IMAGE, .uvs = uvs,
                           .image = {picture.width, picture.height, pixels, false, MESO_GROWTH_REPEAT}};
    return MESO_OK;
}

MesoStatus meso_replicate_map(MesoGrowthMap *map, const MesoReplicateGround *g, const MesoDetailMap *wanted)
{
    static const float one = 1;
    *map = (MesoGrowthMap){.domain = MESO_GROWTH_CONSTANT, .values = &one};
    if (!wanted->given)
        return MESO_OK;
    return wanted->attribute ? map_of_attribute(map, g, wanted) : map_of_image(map, g, wanted);
}

/* ---- vectors ---- */

MesoStatus meso_replicate_vectors(MesoVec3 **out, const MesoReplicateGround *g, const char *name)
{
    const MesoTriangulation *mesh = g->ground.mesh;
    const MesoAttribute *attribute = meso_polygon_attribute_on(g->triangles, name, MESO_ON_FACES);
    if (!attribute)
        attribute = meso_polygon_attribute_on(g->triangles, name, MESO_ON_VERTICES);
    if (!attribute || attribute->width != 3)
        return fail_without(g, name, " of three numbers");
    MesoVec3 *vectors = *out = MESO_NEW(&g->tool->arena, MesoVec3, mesh->triangle_count, &g->tool->error);
    if (!vectors)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t at = attribute->domain == MESO_ON_FACES ? t : mesh->corners[3 * t + k];
            uint32_t entry = meso_attribute_entry(attribute, element_of(mesh, g->triangles, attribute->domain, at));
            MesoVec3 v = entry == MESO_NO_INDEX ? (MesoVec3){0, 0, 0} : meso_attribute_vec3(attribute, entry);
            vectors[t] = meso_vec3_finite(v) ? meso_vec3_add(vectors[t], v) : vectors[t];
        }
    return MESO_OK;
}
