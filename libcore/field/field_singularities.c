#include "libcore/field/field_singularities.h"

/*
 * How far the power turns across a side, from -pi to pi. From the lower half-edge, so that it is the very opposite from
 * the other one, and the turns around all vertices cancel.
 */
static double turn_across(const MesoFieldPowers *p, uint32_t half_edge, uint32_t across)
{
    if (across < half_edge)
        return -turn_across(p, across, half_edge);
    MesoComplex turn = meso_complex_power(meso_frame_turn(p->mesh, p->frames, half_edge, across), p->symmetry);
    MesoComplex carried = meso_complex_times(turn, p->powers[half_edge / 3]);
    MesoComplex change = meso_complex_times(p->powers[across / 3], meso_complex_conjugate(carried));
    return atan2(change.im, change.re);
}

static double corner_angle(const MesoTriangulation *mesh, uint32_t corner)
{
    MesoVec3 at = mesh->positions[mesh->corners[corner]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(corner)]];
    MesoVec3 c = mesh->positions[mesh->corners[meso_previous_corner(corner)]];
    double u[3] = {(double)b.x - at.x, (double)b.y - at.y, (double)b.z - at.z};
    double v[3] = {(double)c.x - at.x, (double)c.y - at.y, (double)c.z - at.z};
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return atan2(sqrt(x * x + y * y + z * z), u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
}

static int turns_around(const MesoFieldPowers *p, uint32_t vertex)
{
    const MesoTriangulation *mesh = p->mesh;
    uint32_t first = mesh->vertex_corner[vertex], corner = first;
    if (first == MESO_NO_INDEX)
        return 0;
    double angles = 0, turns = 0;
    do {
        uint32_t side = meso_previous_corner(corner), across = meso_frame_across(mesh, side);
        if (across == MESO_NO_INDEX)
            return 0;
        angles += corner_angle(mesh, corner);
        turns += turn_across(p, side, across);
        corner = across;
    } while (corner != first);
    return (int)lrint((p->symmetry * (2 * MESO_PI - angles) + turns) / (2 * MESO_PI));
}

void meso_field_turns(int *turns, const MesoFieldPowers *powers)
{
    for (uint32_t v = 0; v < powers->mesh->vertex_count; v++)
        turns[v] = turns_around(powers, v);
}
