#include "cmd/grow/grow_uvs.h"

static const MesoAttribute *find_uvs(const MesoPolygonMesh *mesh)
{
    const MesoAttribute *uvs = meso_polygon_attribute_on(mesh, "uv", MESO_ON_CORNERS);
    return uvs ? uvs : meso_polygon_attribute_on(mesh, "uv", MESO_ON_VERTICES);
}

MesoStatus meso_grow_uvs(MesoVec2 **out, MesoArena *arena, const MesoPolygonMesh *polygons,
                         const MesoTriangulation *mesh, MesoError *error)
{
    const MesoAttribute *uvs = find_uvs(polygons);
    if (!uvs || uvs->width < 2)
        return meso_fail(error, MESO_ERR_INPUT, "texture coordinates, and the surface has none: an OBJ has them as "
                         "'vt', a PLY as s and t, or u and v, of vertices");
    MesoVec2 *all = *out = MESO_NEW(arena, MesoVec2, 3 * (size_t)mesh->triangle_count, error);
    if (!all)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++) {
        uint32_t face = mesh->faces[c / 3], corner = 3 * face + c % 3;
        bool by_corner = uvs->domain == MESO_ON_CORNERS;
        uint32_t entry = meso_attribute_entry(uvs, by_corner ? corner : polygons->corners[corner]);
        if (entry == MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_INPUT, "texture coordinates, and face %u of the surface's triangles has "
                             "none", face + 1);
        all[c] = meso_attribute_vec2(uvs, entry);
        if (!isfinite(all[c].x) || !isfinite(all[c].y))
            return meso_fail(error, MESO_ERR_INPUT, "texture coordinates, and those of face %u of the surface's "
                             "triangles are not finite", face + 1);
    }
    return MESO_OK;
}
