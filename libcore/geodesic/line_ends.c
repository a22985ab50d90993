#include "libcore/geodesic/geodesic_solver.h"

/* A line turns by more than 20 degrees there: below that, a planar front that is bent around it is nearly right. */
static const float bend = (float)(MESO_PI / 9);

static MesoVec3 spoke_of(const MesoGeodesicSolver *solver, uint32_t from, uint32_t to)
{
    const MesoGeodesicRow *a = &solver->rows[from], *b = &solver->rows[to];
    return (MesoVec3){b->x - a->x, b->y - a->y, b->z - a->z};
}

static float corner_angle(const MesoGeodesicSolver *solver, uint32_t vertex, uint32_t a, uint32_t b)
{
    MesoVec3 p = spoke_of(solver, vertex, a), q = spoke_of(solver, vertex, b);
    return atan2f(meso_vec3_length(meso_vec3_cross(p, q)), meso_vec3_dot(p, q));
}

static bool is_planar(const MesoGeodesicSolver *solver, uint32_t vertex)
{
    return signbit(solver->rows[vertex].distance);
}

/*
 * Whether the domain has room beside the line for more than both half planes: twice around a vertex that has no border,
 * so that every gap between spokes of the line is seen whole.
 */
static bool line_bends(const MesoGeodesicRun *run, uint32_t vertex)
{
    const MesoTriangulation *mesh = run->solver->mesh;
    const MesoDomain *domain = run->query->domain;
    if (mesh->vertex_corner[vertex] == MESO_NO_INDEX)
        return false;
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner, rounds = 0;
    float gap = -INFINITY;      /* from the last spoke of the line on; nothing before the first */
    do {
        uint32_t next = mesh->corners[meso_next_corner(fan.corner)];
        uint32_t previous = mesh->corners[meso_previous_corner(fan.corner)];
        if (is_planar(run->solver, fan.turned ? previous : next))
            gap = 0;
        gap += domain && !meso_domain_has(domain, mesh, fan.corner / 3) ? -INFINITY
                                                                       : corner_angle(run->solver, vertex, next, previous);
        if (gap > (float)MESO_PI + bend)
            return true;
    } while (meso_fan_next(mesh, &fan) && (fan.corner != first || ++rounds < 2));
    return false;
}

/* Neighbours are not both made points, or the line between them would be lost. */
static bool has_points_beside(const MesoGeodesicSolver *solver, uint32_t vertex)
{
    MesoOneRing ring = meso_one_ring(&solver->rings, vertex);
    for (uint32_t k = 0; k < ring.count; k++) {
        uint32_t beside = ring.spokes[k];
        bool seed = fabsf(solver->rows[beside].distance) < INFINITY;
        if (solver->states[beside] & MESO_VERTEX_MARKED || (seed && !is_planar(solver, beside)))
            return true;
    }
    return false;
}

void meso_geodesic_round_ends(const MesoGeodesicRun *run)
{
    const MesoGeodesicQuery *query = run->query;
    MesoGeodesicSolver *solver = run->solver;
    for (uint32_t i = 0; i < query->seed_count; i++) {
        uint32_t vertex = query->seeds[i].vertex;
        if (is_planar(solver, vertex) && !has_points_beside(solver, vertex) && line_bends(run, vertex))
            solver->states[vertex] |= MESO_VERTEX_MARKED;
    }
    for (uint32_t i = 0; i < query->seed_count; i++) {
        uint32_t vertex = query->seeds[i].vertex;
        if (solver->states[vertex] & MESO_VERTEX_MARKED)
            solver->rows[vertex].distance = fabsf(solver->rows[vertex].distance);
        solver->states[vertex] &= (uint8_t)~MESO_VERTEX_MARKED;
    }
}
