#include "libcore/shell/shell_map_relax.h"

#include "libcore/math/sparse_cholesky.h"
#include "libcore/shell/shell_stretch.h"

/* Gradients of the weights of a tetrahedron's corners, and its volume. */
typedef struct Weights {
    MesoVec3d gradients[4];
    double volume;
} Weights;

static Weights weights_of(const MesoVec3d corners[4])
{
    MesoVec3d a = meso_vec3d_sub(corners[1], corners[0]), b = meso_vec3d_sub(corners[2], corners[0]);
    MesoVec3d c = meso_vec3d_sub(corners[3], corners[0]), bc = meso_vec3d_cross(b, c);
    double det = meso_vec3d_dot(a, bc);
    Weights weights = {.volume = det / 6};
    weights.gradients[1] = meso_vec3d_scale(bc, 1 / det);
    weights.gradients[2] = meso_vec3d_scale(meso_vec3d_cross(c, a), 1 / det);
    weights.gradients[3] = meso_vec3d_scale(meso_vec3d_cross(a, b), 1 / det);
    for (uint32_t k = 1; k < 4; k++)
        weights.gradients[0] = meso_vec3d_sub(weights.gradients[0], weights.gradients[k]);
    return weights;
}

/* ---- the paper's measure: equation 9, least in one step ---- */

typedef struct System {
    const MesoShellMap *map;
    uint32_t *unknowns;     /* [vertex_count] */
    uint32_t count;
    MesoTriplet *triplets;
    size_t triplet_count;
    double *right;          /* [2 * count] */
} System;

/* The derivative of sum |T| |grad u|^2 / 2 over the shell's tetrahedra; the same for v. */
static void add_tetrahedron(System *system, const MesoShellPrism *prism, uint32_t triangle, uint32_t part)
{
    const MesoShellMap *map = system->map;
    const uint8_t *tetrahedron = prism->tetrahedra[part];
    MesoVec3d texture[4], shell[4];
    meso_shell_prism_part(prism, part, texture, shell);
    Weights weights = weights_of(shell);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t v = map->corners[3 * (size_t)triangle + tetrahedron[i] % 3];
        if (tetrahedron[i] < 3 || map->held[v])
            continue;
        for (uint32_t j = 0; j < 4; j++) {
            uint32_t w = map->corners[3 * (size_t)triangle + tetrahedron[j] % 3];
            double value = weights.volume * meso_vec3d_dot(weights.gradients[i], weights.gradients[j]);
            uint32_t row = system->unknowns[v], column = system->unknowns[w];
            if (tetrahedron[j] < 3 || map->held[w]) {
                system->right[2 * (size_t)row] -= value * map->low_uv[2 * (size_t)w];
                system->right[2 * (size_t)row + 1] -= value * map->low_uv[2 * (size_t)w + 1];
            } else if (row >= column) {
                system->triplets[system->triplet_count++] = (MesoTriplet){row, column, value};
            }
        }
    }
}

static MesoStatus solve(System *system, MesoArena *scratch, MesoError *error)
{
    MesoCholesky factor;
    MesoStatus status = meso_cholesky_analyse(&factor, scratch, system->count, system->triplets, system->triplet_count,
                                              error);
    if (!status)
        status = meso_cholesky_factor(&factor, system->triplets, system->triplet_count, error);
    if (!status)
        meso_cholesky_solve(&factor, system->right, 2);
    return status;
}

/* Tetrahedra of the texture must keep a share of their volume when upright. */
static bool is_upright_enough(const MesoShellPrism *prism)
{
    const double least = 0.05;
    MesoVec3d a = meso_vec3d_sub(prism->texture[1], prism->texture[0]);
    MesoVec3d b = meso_vec3d_sub(prism->texture[2], prism->texture[0]);
    double upright = (a.x * b.y - a.y * b.x) * (prism->texture[3].z - prism->texture[0].z);
    for (uint32_t part = 0; part < 3; part++) {
        MesoVec3d texture[4], shell[4];
        meso_shell_prism_part(prism, part, texture, shell);
        if (!(meso_tetrahedron_det(texture) >= least * upright))
            return false;
    }
    return true;
}

/* Goes back towards the upright prism wherever tetrahedra would be too flat, in the end all the way. */
static void hold_back(MesoShellMap *map)
{
    enum { ROUNDS = 64 };
    const double step = 0.7;
    bool again = true;
    for (uint32_t round = 0; again; round++) {
        again = false;
        for (uint32_t t = 0; t < map->mesh->triangle_count; t++) {
            MesoShellPrism prism = meso_shell_prism(map, t);
            const uint32_t *v = &map->corners[3 * (size_t)t];
            if ((map->held[v[0]] && map->held[v[1]] && map->held[v[2]]) || is_upright_enough(&prism))
                continue;
            again = round < ROUNDS;
            for (uint32_t k = 0; k < 6; k++) {
                size_t i = 2 * (size_t)v[k / 2] + k % 2;
                map->high_uv[i] = map->low_uv[i] + (round < ROUNDS ? step : 0) * (map->high_uv[i] - map->low_uv[i]);
            }
        }
    }
}

MesoStatus meso_shell_map_solve(MesoShellMap *map, MesoArena *scratch, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    System system = {.map = map, .unknowns = MESO_NEW(scratch, uint32_t, map->vertex_count, error)};
    if (!system.unknowns)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < map->vertex_count; v++)
        if (!map->held[v])
            system.unknowns[v] = system.count++;
    system.triplets = MESO_NEW(scratch, MesoTriplet, 15 * (size_t)map->mesh->triangle_count, error);
    system.right = MESO_NEW(scratch, double, 2 * (size_t)system.count, error);
    if (!system.triplets || !system.right)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < map->mesh->triangle_count; t++) {
        MesoShellPrism prism = meso_shell_prism(map, t);
        for (uint32_t part = 0; part < 3 && meso_shell_prism_stands(&prism); part++)
            add_tetrahedron(&system, &prism, t, part);
    }
    MesoStatus status = system.count ? solve(&system, scratch, error) : MESO_OK;
    for (uint32_t v = 0; v < map->vertex_count && !status; v++)
        for (uint32_t axis = 0; axis < 2 && !map->held[v]; axis++)
            map->high_uv[2 * (size_t)v + axis] = system.right[2 * (size_t)system.unknowns[v] + axis];
    meso_arena_rewind(scratch, mark);
    if (!status)
        hold_back(map);
    return status == MESO_ERR_INPUT ? MESO_OK : status;     /* not positive definite in doubles */
}

/* ---- the other measure ---- */

/*
 * The map from a tetrahedron of the texture has the derivative J, C = J'J. Where the corner whose weight has gradient g
 * moves by d, that becomes J (I - d g' / (1 + g.d)) and the volume V (1 + g.d), and so V |J|^2 becomes
 *
 *     V ((1 + g.d) tr C - 2 g.C d + |g|^2 d.C d / (1 + g.d))
 *
 * whose first derivative at 0 is V (tr C g - 2 C g); its second that of a convex function, 2 V |g|^2 C.
 */
typedef struct Step {
    double first[2], second[3];     /* second: xx, xy, yy */
} Step;

static void add_part(Step *step, const MesoShellPrism *prism, uint32_t part, uint32_t top)
{
    MesoVec3d texture[4], shell[4], columns[3] = {{0}}, g = {0, 0, 0};
    meso_shell_prism_part(prism, part, texture, shell);
    Weights weights = weights_of(texture);
    bool has_top = false;
    for (uint32_t k = 0; k < 4; k++) {
        MesoVec3d gradient = weights.gradients[k], x = shell[k];
        columns[0] = meso_vec3d_mad(columns[0], gradient.x, x);
        columns[1] = meso_vec3d_mad(columns[1], gradient.y, x);
        columns[2] = meso_vec3d_mad(columns[2], gradient.z, x);
        if (prism->tetrahedra[part][k] == top) {
            g = gradient;
            has_top = true;
        }
    }
    if (!has_top)
        return;
    MesoVec3d along = meso_vec3d_scale(columns[0], g.x);     /* J g */
    along = meso_vec3d_mad(meso_vec3d_mad(along, g.y, columns[1]), g.z, columns[2]);
    double xx = meso_vec3d_dot(columns[0], columns[0]), yy = meso_vec3d_dot(columns[1], columns[1]);
    double trace = xx + yy + meso_vec3d_dot(columns[2], columns[2]);
    double twice = 2 * weights.volume * meso_vec3d_dot(g, g);
    step->first[0] += weights.volume * (trace * g.x - 2 * meso_vec3d_dot(columns[0], along));
    step->first[1] += weights.volume * (trace * g.y - 2 * meso_vec3d_dot(columns[1], along));
    step->second[0] += twice * xx;
    step->second[1] += twice * meso_vec3d_dot(columns[0], columns[1]);
    step->second[2] += twice * yy;
}

/* V |J|^2 of the prism's tetrahedra; infinite where one is too flat. */
static double energy_of(const MesoShellPrism *prism)
{
    if (!is_upright_enough(prism))
        return INFINITY;
    double sum = 0;
    for (uint32_t part = 0; part < 3; part++) {
        MesoVec3d texture[4], shell[4];
        meso_shell_prism_part(prism, part, texture, shell);
        sum += meso_tetrahedron_stretch(texture, shell) * meso_tetrahedron_det(texture);
    }
    return sum;
}

/* Over the prisms around a vertex that is inside its chart, and so the same fan in the mesh. */
static double ring_energy(const MesoShellMap *map, uint32_t vertex, Step *step)
{
    MesoFan fan = meso_fan_first(map->mesh, map->origins[vertex]);
    uint32_t first = fan.corner;
    double sum = 0;
    do {
        MesoShellPrism prism = meso_shell_prism(map, fan.corner / 3);
        sum += energy_of(&prism);
        for (uint32_t part = 0; part < 3 && step; part++)
            add_part(step, &prism, part, 3 + fan.corner % 3);
    } while (meso_fan_next(map->mesh, &fan) && fan.corner != first);
    return sum;
}

static void move_vertex(MesoShellMap *map, uint32_t vertex)
{
    enum { TRIES = 4 };
    Step step = {{0, 0}, {0, 0, 0}};
    double *uv = &map->high_uv[2 * (size_t)vertex], old[2] = {uv[0], uv[1]};
    double before = ring_energy(map, vertex, &step);
    double det = step.second[0] * step.second[2] - step.second[1] * step.second[1];
    if (!(det > 0 && before < INFINITY))
        return;
    double way[2] = {-(step.second[2] * step.first[0] - step.second[1] * step.first[1]) / det,
                     -(step.second[0] * step.first[1] - step.second[1] * step.first[0]) / det};
    double share = 1;
    for (uint32_t i = 0; i < TRIES; i++, share /= 2) {
        uv[0] = old[0] + share * way[0];
        uv[1] = old[1] + share * way[1];
        if (ring_energy(map, vertex, NULL) < before)
            return;
    }
    uv[0] = old[0];
    uv[1] = old[1];
}

void meso_shell_map_sweep(MesoShellMap *map, uint32_t sweeps)
{
    for (uint32_t sweep = 0; sweep < sweeps; sweep++)
        for (uint32_t v = 0; v < map->vertex_count; v++)
            if (!map->held[v])
                move_vertex(map, v);
}
