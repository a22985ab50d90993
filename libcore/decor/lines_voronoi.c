#include "libcore/decor/operators.h"
#include "libcore/geodesic/cells/voronoi.h"

MesoStatus meso_decor_voronoi(MesoSplit *split, MesoSplitTarget *target, const MesoDomain *domain, MesoError *error)
{
    MesoDecorWork *work = split->work;
    MesoSeeds seeds;
    MesoStatus status = meso_decor_seeds(work, &split->step->field.from, target->region, domain, &seeds, error);
    if (status)
        return status;
    if (seeds.point_count < 2) {
        target->idle = "cells need two points or more";
        return MESO_OK;
    }
    const MesoVoronoiQuery query = {domain, seeds.point_count, seeds.point_list, work->options->threads};
    return meso_voronoi_trace(&split->lines, NULL, NULL, work->scratch, &work->decor->mesh, work->solver, &query,
                              error);
}
