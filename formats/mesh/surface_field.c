#include "formats/mesh/surface_field.h"

#include <math.h>
#include <stdio.h>

#include "formats/mesh/mesh_read.h"
#include "libcore/mesh/orientation.h"

/* ---- attributes ---- */

/* Three numbers of an element, which may be an attribute or several of different types. */
typedef struct VectorAttribute {
    const MesoAttribute *attributes[3];
    uint32_t components[3];
} VectorAttribute;

/* The numbers NAMEx NAMEy NAMEz, or NAME_x and so on; false where they are not all there. */
static bool find_vector(const MesoPolygonMesh *mesh, MesoArena *scratch, const char *name, const char *separator,
                        MesoAttributeDomain domain, VectorAttribute *vector)
{
    for (uint32_t i = 0; i < 3; i++) {
        const char *number = meso_arena_print(scratch, NULL, "%s%s%c", name, separator, "xyz"[i]);
        vector->attributes[i] = number ? meso_polygon_number_on(mesh, number, domain, &vector->components[i]) : NULL;
        if (!vector->attributes[i])
            return false;
    }
    return true;
}

static double sum_over_face(const MesoPolygonMesh *mesh, const MesoAttribute *attribute, uint32_t component,
                            uint32_t face)
{
    double sum = 0;
    if (attribute->domain == MESO_ON_FACES)
        return meso_attribute_number(attribute, face, component);
    for (uint32_t c = 4 * face; c < 4 * face + 4; c++)
        sum += meso_attribute_number(attribute, mesh->corners[c], component);
    return sum;
}

static void add_up(MesoVec3 *directions, const MesoPolygonMesh *mesh, const VectorAttribute *vector)
{
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        double sum[3];
        for (uint32_t i = 0; i < 3; i++)
            sum[i] = sum_over_face(mesh, vector->attributes[i], vector->components[i], f);
        directions[f] = (MesoVec3){(float)sum[0], (float)sum[1], (float)sum[2]};
    }
}

/* Of faces before vertices. */
static bool take_attribute(MesoVec3 *directions, const MesoPolygonMesh *mesh, MesoArena *scratch, const char *name)
{
    VectorAttribute vector;
    for (uint32_t choice = 0; choice < 4; choice++)
        if (find_vector(mesh, scratch, name, choice % 2 ? "_" : "", choice < 2 ? MESO_ON_FACES : MESO_ON_VERTICES,
                        &vector)) {
            add_up(directions, mesh, &vector);
            return true;
        }
    return false;
}

MesoStatus meso_surface_attribute_field(MesoVec3 **directions, MesoArena *arena, const MesoQuadSurface *surface,
                                        const MesoInput *input, const char *attribute, MesoError *error)
{
    MesoArena scratch;
    *directions = MESO_NEW(arena, MesoVec3, surface->mesh.face_count, error);
    if (!*directions)
        return MESO_ERR_MEMORY;
    meso_arena_init(&scratch);
    bool found = take_attribute(*directions, &surface->surface.mesh, &scratch, attribute);
    meso_arena_release(&scratch);
    if (found)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "%s: has no vector attribute '%s': a PLY file would give it as the "
                     "properties %sx %sy %sz of faces or vertices", input->path, attribute, attribute, attribute,
                     attribute);
}

/* ---- texture coordinates ---- */

/* The attribute, or else the first coordinate alone. */
static const MesoAttribute *find_textures(const MesoPolygonMesh *mesh)
{
    static const char *const names[] = {"s", "u", "texture_u"};
    uint32_t component;
    const MesoAttribute *textures = meso_polygon_attribute_on(mesh, "uv", MESO_ON_VERTICES);
    if (!textures)
        textures = meso_polygon_attribute_on(mesh, "uv", MESO_ON_CORNERS);
    for (size_t i = 0; i < sizeof names / sizeof *names && !textures; i++)
        textures = meso_polygon_number_on(mesh, names[i], MESO_ON_VERTICES, &component);
    return textures;
}

/* Not a number, so that no gradient comes of it, where a corner has no coordinate. */
static void take_textures(float *values, const MesoPolygonMesh *mesh, const MesoAttribute *textures)
{
    for (uint32_t c = 0; c < mesh->corner_count; c++) {
        uint32_t entry = meso_attribute_entry(textures, textures->domain == MESO_ON_CORNERS ? c : mesh->corners[c]);
        values[c] = entry == MESO_NO_INDEX ? NAN : (float)meso_attribute_number(textures, entry, 0);
    }
}

static MesoStatus fail_without(const MesoInput *input, MesoError *error)
{
    MesoStatus status = meso_mesh_texture_problem(input, 0, error);
    if (status)
        return status;
    return meso_fail(error, MESO_ERR_INPUT, "%s: has no texture coordinates: an OBJ file would give them as "
                     "'vt', a PLY file as the properties s and t, or u and v, of vertices", input->path);
}

MesoStatus meso_surface_texture_field(MesoVec3 **directions, MesoArena *arena, const MesoQuadSurface *surface,
                                      const MesoInput *input, MesoError *error)
{
    const MesoPolygonMesh *mesh = &surface->surface.mesh;
    const MesoAttribute *textures = find_textures(mesh);
    if (!textures)
        return fail_without(input, error);
    *directions = MESO_NEW(arena, MesoVec3, mesh->face_count, error);
    if (!*directions)
        return MESO_ERR_MEMORY;
    MesoArenaMark mark = meso_arena_mark(arena);
    float *values = MESO_NEW(arena, float, mesh->corner_count, error);
    if (!values)
        return MESO_ERR_MEMORY;
    take_textures(values, mesh, textures);
    meso_orientation_gradient(*directions, &surface->mesh, values);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}
