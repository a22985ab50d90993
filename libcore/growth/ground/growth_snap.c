#include "libcore/growth/ground/growth_snap.h"

#include "libcore/base/parallel.h"
#include "libcore/decor/region/surface_point.h"

typedef struct Snap {
    const MesoTriangulation *mesh;
    const MesoDomain *domain;
    const MesoVec3 *points;
    MesoMeshPoint *out;
} Snap;

static void snap_points(void *context, uint64_t begin, uint64_t end)
{
    const Snap *snap = context;
    for (uint64_t i = begin; i < end; i++)
        snap->out[i] = meso_surface_point(snap->mesh, snap->domain, snap->points[i]);
}

MesoStatus meso_growth_snap(const MesoGrowthGround *ground, MesoArena *scratch, const MesoVec3 *points, uint32_t count,
                            MesoMeshPoint *out, uint32_t thread_count, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint32_t *triangles = MESO_NEW(scratch, uint32_t, ground->mesh->triangle_count, error);
    if (!triangles)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < ground->mesh->triangle_count; t++)
        triangles[t] = t;
    MesoDomain all = {.triangle_count = ground->mesh->triangle_count, .triangles = triangles};
    Snap snap = {ground->mesh, &all, points, out};
    meso_parallel_for(thread_count, count, 16, snap_points, &snap);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
