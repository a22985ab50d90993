/* What the steps of meso-mesh do, each by a function of the library. */
#include <string.h>

#include "cmd/mesh/mesh_steps.h"
#include "libcore/mesh/edit/ear_clip.h"
#include "libcore/mesh/edit/mesh_clean.h"
#include "libcore/mesh/edit/mesh_orient.h"
#include "libcore/mesh/edit/mesh_weld.h"
#include "libcore/mesh/edit/triangle_pairs.h"
#include "libcore/mesh/refine/mesh_decimate.h"

static void count(MesoMeshWork *work, const char *name, uint32_t number)
{
    work->counts[work->count_count++] = (MesoStepCount){name, number};
}

MesoStatus meso_mesh_run_weld(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoWeldCounts counts;
    MesoTool *tool = work->tool;
    MesoStatus status = meso_mesh_weld(result, &work->next, &work->mesh, step->number, &counts, &tool->error);
    count(work, "vertices_gone", counts.vertices_gone);
    count(work, "faces_gone", counts.faces_gone);
    count(work, "attributes_moved", counts.attributes_moved);
    return status;
}

MesoStatus meso_mesh_run_clean(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoCleanCounts counts;
    MesoTool *tool = work->tool;
    (void)step;
    MesoStatus status = meso_mesh_clean(result, &work->next, &work->mesh, &counts, &tool->error);
    count(work, "looped_faces", work->looped + counts.faces_looped);
    work->looped = 0;
    count(work, "flat_faces", counts.faces_flat);
    count(work, "double_faces", counts.faces_double);
    count(work, "unused_vertices", counts.vertices_unused);
    return status;
}

static MesoStatus join(MesoHalfEdges *edges, MesoArena *scratch, MesoMeshWork *work)
{
    MesoTool *tool = work->tool;
    return meso_half_edges_join(edges, scratch, &work->mesh, tool->threads, &tool->error);
}

MesoStatus meso_mesh_run_separate(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoArena scratch;
    MesoHalfEdges edges;
    uint32_t added = 0;
    MesoTool *tool = work->tool;
    (void)step;
    meso_arena_init(&scratch);
    MesoStatus status = join(&edges, &scratch, work);
    if (!status)
        status = meso_mesh_separate(result, &work->next, &work->mesh, &edges, &added, &tool->error);
    meso_arena_release(&scratch);
    count(work, "vertices_added", added);
    return status;
}

MesoStatus meso_mesh_run_orient(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoArena scratch;
    MesoHalfEdges edges;
    MesoOrientCounts counts = {0};
    MesoTool *tool = work->tool;
    (void)step;
    meso_arena_init(&scratch);
    MesoStatus status = join(&edges, &scratch, work);
    if (!status)
        status = meso_mesh_orient(result, &work->next, &work->mesh, &edges, &counts, &tool->error);
    meso_arena_release(&scratch);
    if (!status && counts.disagreeing)
        meso_tool_say(tool, "orient: what hangs together with face %u has one side only", counts.one_sided + 1);
    count(work, "faces_turned", counts.faces_turned);
    count(work, "pieces_turned", counts.pieces_turned);
    count(work, "edges_disagreeing", counts.disagreeing);
    return status;
}

MesoStatus meso_mesh_run_triangulate(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    (void)step;
    return meso_mesh_cut_faces(result, &work->next, &work->mesh, &work->tool->error);
}

MesoStatus meso_mesh_run_pair(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    (void)step;
    return meso_mesh_pair_triangles(result, &work->next, &work->mesh, NULL, &work->tool->error);
}

MesoStatus meso_mesh_run_subdivide(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoTool *tool = work->tool;
    return meso_mesh_subdivide(result, &work->next, &work->mesh, step->scheme, step->level_count, work->crease,
                               tool->threads, &tool->error);
}

/* Triangles that faces would be cut into. */
static uint64_t triangle_count(const MesoPolygonMesh *mesh)
{
    return mesh->corner_count - 2 * (uint64_t)mesh->face_count;
}

MesoStatus meso_mesh_run_decimate(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoTool *tool = work->tool;
    double target = step->percent ? step->number / 100 * (double)triangle_count(&work->mesh) : step->number;
    MesoStatus status = meso_mesh_decimate(result, &work->next, &work->mesh, (uint32_t)target, tool->threads,
                                           &tool->error);
    if (!status && (double)result->face_count > target)
        meso_tool_say(tool, "decimate: no more edges can go without folding the surface or changing what it is");
    return status;
}

MesoStatus meso_mesh_run_convert(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    (void)step;
    *result = work->mesh;
    return MESO_OK;
}
