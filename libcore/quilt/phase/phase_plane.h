/* The plane of a patch, bent so that stripes are straight and a pitch apart in it. */
#ifndef MESO_PHASE_PLANE_H
#define MESO_PHASE_PLANE_H

#include "libcore/chart/chart.h"
#include "libcore/quilt/phase/stripe_phases.h"

/*
 * Moves places of a chart so that in its units the phase along x is 2 pi x / pitch, and across it the same, up to whole
 * turns: by least squares, so that where stripes end inside, both of their sides give way. No triangle is turned over,
 * or comes to have less than a quarter of its area: where one would, moves are smoothed around it.
 *
 * places           [chart->vertex_count]
 * chart_triangles  [triangle_count of the mesh] of the chart, or MESO_NO_INDEX
 * guides           [triangle_count of the mesh] as phases->directions
 * angle            of the guide on the whole, in the chart: places are turned back by it
 * scale            of the phases' units in those of the places
 *
 * O(chart) times steps of conjugate gradients. MESO_ERR_MEMORY.
 */
MesoStatus meso_phase_plane(MesoVec2 *places, MesoArena *scratch, const MesoChart *chart,
                            const uint32_t *chart_triangles, const MesoStripePhases *phases, const MesoVec3 *guides,
                            float angle, float scale, MesoError *error);

#endif
