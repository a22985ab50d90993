#include "cmd/grow/grow_surface.h"

#include "cmd/common/input_kind.h"
#include "formats/mesh/surface_read.h"
#include "libcore/mesh/edit/ear_clip.h"

static MesoStatus triangulate(MesoGrowSurface *s, MesoTool *tool, MesoSurface *surface)
{
    MesoPolygonMesh cut;
    MesoStatus status = MESO_OK;
    s->polygons = surface->mesh;
    if (s->polygons.side_count != 3) {
        status = meso_mesh_cut_faces(&cut, &tool->arena, &s->polygons, &tool->error);
        if (!status)
            status = meso_surface_build(surface, &tool->arena, &cut, tool->threads, &tool->error);
        s->polygons = cut;
    }
    return status ? status : meso_triangulation_init(&s->mesh, surface, 0, 0, &tool->error);
}

MesoStatus meso_grow_surface_read(MesoGrowSurface *s, MesoGrowArguments *a, MesoInput *input, const char *path)
{
    MesoTool *tool = &a->tool;
    MesoSurface surface;
    MesoStatus status = meso_tool_open_place(tool, input, path, &MESO_PLACE_SURFACE);
    if (!status)
        status = meso_surface_read(&surface, &tool->arena, input, MESO_NEEDS_MANIFOLD, tool->threads, &tool->error);
    if (!status)
        status = triangulate(s, tool, &surface);
    return status ? status : meso_growth_ground_build(&s->ground, &tool->arena, &s->mesh, a->up, tool->threads,
                                                      &tool->error);
}

void meso_grow_surface_release(MesoGrowSurface *s)
{
    meso_triangulation_release(&s->mesh);
}
