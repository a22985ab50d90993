#include "cmd/decor/decor_surface.h"

#include "cmd/common/input_kind.h"
#include "formats/mesh/surface_read.h"
#include "libcore/mesh/edit/ear_clip.h"

/* Where the numbers of a scene stand among those that are carried along. */
static void plan_values(MesoDecorSurface *surface)
{
    const MesoPolygonMesh *mesh = &surface->triangles.mesh;
    surface->values = (MesoDecorValues)MESO_DECOR_NO_VALUES;
    surface->vertex_width = surface->corner_width = 0;
    if (meso_polygon_attribute_on(mesh, "uv", MESO_ON_CORNERS)) {
        surface->values.corner_uv = 0;
        surface->corner_width = 2;
    } else if (meso_polygon_attribute_on(mesh, "uv", MESO_ON_VERTICES)) {
        surface->values.vertex_uv = 0;
        surface->vertex_width = 2;
    }
    if (meso_polygon_attribute_on(mesh, "color", MESO_ON_VERTICES)) {
        surface->values.vertex_color = surface->vertex_width;
        surface->vertex_width += 3;
    }
}

MesoStatus meso_decor_surface_read(MesoDecorSurface *surface, MesoTool *tool, MesoInput *input, const char *path)
{
    MesoError *error = &tool->error;
    MesoPolygonMesh cut;
    MesoStatus status = meso_tool_open_place(tool, input, path, &MESO_PLACE_SURFACE);
    if (status)
        return status;
    status = meso_surface_read(&surface->triangles, &tool->arena, input, MESO_NEEDS_MANIFOLD, tool->threads, error);
    surface->polygons = surface->triangles.mesh;
    if (!status && surface->polygons.side_count != 3) {
        status = meso_mesh_cut_faces(&cut, &tool->arena, &surface->polygons, error);
        if (!status)
            status = meso_surface_build(&surface->triangles, &tool->arena, &cut, tool->threads, error);
    }
    if (status)
        meso_input_close(input);
    else
        plan_values(surface);
    return status;
}

/* Numbers of one element's entry; zeros where it has none. */
static void copy_numbers(float *values, uint32_t count, const MesoAttribute *attribute, uint32_t element)
{
    uint32_t entry = meso_attribute_entry(attribute, element);
    for (uint32_t i = 0; i < count; i++)
        values[i] = entry == MESO_NO_INDEX || i >= attribute->width
                        ? 0 : (float)meso_attribute_number(attribute, entry, i);
}

/* Whole numbers of colours stand for shares, normalized or not. */
static float color_scale(const MesoAttribute *color)
{
    if (color->normalized)
        return 1;
    return color->scalar == MESO_SCALAR_UINT8 ? 1 / 255.0f : color->scalar == MESO_SCALAR_UINT16 ? 1 / 65535.0f : 1;
}

static void fill_vertices(MesoTriangulation *mesh, const MesoDecorSurface *surface)
{
    const MesoPolygonMesh *from = &surface->triangles.mesh;
    const MesoAttribute *uv = meso_polygon_attribute_on(from, "uv", MESO_ON_VERTICES);
    const MesoAttribute *color = meso_polygon_attribute_on(from, "color", MESO_ON_VERTICES);
    for (uint32_t v = 0; v < mesh->vertex_count && mesh->vertex_width; v++) {
        float *values = mesh->vertex_values + (size_t)mesh->vertex_width * v;
        if (surface->values.vertex_uv != MESO_NO_INDEX)
            copy_numbers(values + surface->values.vertex_uv, 2, uv, mesh->origins[v]);
        if (surface->values.vertex_color == MESO_NO_INDEX)
            continue;
        values += surface->values.vertex_color;
        copy_numbers(values, 3, color, mesh->origins[v]);
        for (int c = 0; c < 3; c++)
            values[c] *= color_scale(color);
    }
}

/* Triangles may have been turned when they were numbered again: corners are found by their vertices. */
static void fill_corners(MesoTriangulation *mesh, const MesoDecorSurface *surface)
{
    const MesoPolygonMesh *from = &surface->triangles.mesh;
    const MesoAttribute *uv = meso_polygon_attribute_on(from, "uv", MESO_ON_CORNERS);
    for (uint32_t c = 0; c < 3 * mesh->triangle_count && mesh->corner_width; c++) {
        uint32_t corner = 3 * mesh->faces[c / 3], vertex = mesh->origins[mesh->corners[c]], k = 0;
        while (k < 2 && from->corners[corner + k] != vertex)
            k++;
        copy_numbers(mesh->corner_values + (size_t)mesh->corner_width * c, 2, uv, corner + k);
    }
}

MesoStatus meso_decor_surface_start(MesoTriangulation *mesh, const MesoDecorSurface *surface, MesoError *error)
{
    MesoStatus status = meso_triangulation_init(mesh, &surface->triangles, surface->vertex_width, surface->corner_width,
                                                error);
    if (status)
        return status;
    fill_vertices(mesh, surface);
    fill_corners(mesh, surface);
    return MESO_OK;
}
