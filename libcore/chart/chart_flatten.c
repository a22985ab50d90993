#include "libcore/chart/chart_flatten.h"

#include "libcore/math/sparse_cholesky.h"

/* ---- triangles ---- */

MesoFlatTriangle meso_flat_triangle(const MesoVec3 positions[3], double size, MesoPoint places[3])
{
    const double thinnest = 1e-4;
    double side[3][3], square[3];
    uint32_t longest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 a = positions[k], b = positions[(k + 1) % 3];
        side[k][0] = (double)b.x - a.x, side[k][1] = (double)b.y - a.y, side[k][2] = (double)b.z - a.z;
        square[k] = side[k][0] * side[k][0] + side[k][1] * side[k][1] + side[k][2] * side[k][2];
        longest = square[k] > square[longest] ? k : longest;
    }
    uint32_t a = longest, b = (longest + 1) % 3, c = (longest + 2) % 3;
    double x = side[a][1] * side[b][2] - side[a][2] * side[b][1], y = side[a][2] * side[b][0] - side[a][0] * side[b][2];
    double z = side[a][0] * side[b][1] - side[a][1] * side[b][0], length = sqrt(square[longest]), along = 0.5 * size;
    if (length > 0)
        along = -(side[a][0] * side[c][0] + side[a][1] * side[c][1] + side[a][2] * side[c][2]) / length;
    else
        length = size;
    double up = fmax(sqrt(x * x + y * y + z * z) / length, thinnest * length);
    MesoPoint own[3];
    own[a] = (MesoPoint){0, 0}, own[b] = (MesoPoint){length, 0}, own[c] = (MesoPoint){along, up};

    /* turned so that the first side runs along x */
    MesoPoint first = {own[1].x - own[0].x, own[1].y - own[0].y};
    double first_length = sqrt(first.x * first.x + first.y * first.y), area = 0.5 * length * up;
    for (uint32_t k = 0; k < 3; k++) {
        MesoPoint from = {own[k].x - own[0].x, own[k].y - own[0].y};
        places[k] = (MesoPoint){(from.x * first.x + from.y * first.y) / first_length,
                                (from.y * first.x - from.x * first.y) / first_length};
    }
    MesoFlatTriangle flat = {.area = area};
    for (uint32_t k = 0; k < 3; k++) {
        MesoPoint from = places[(k + 1) % 3], to = places[(k + 2) % 3];
        flat.gradients[k] = (MesoPoint){-(to.y - from.y) / (2 * area), (to.x - from.x) / (2 * area)};
    }
    return flat;
}

MesoAreaScales meso_area_scales(const MesoDisk *disk, const MesoPoint *places)
{
    MesoAreaScales scales = {INFINITY, 0, 0};
    double flat = 0, whole = 0;
    for (uint32_t t = 0; t < disk->triangle_count; t++) {
        MesoJacobian map = meso_jacobian(disk, places, t);
        double scale = meso_jacobian_area(&map);
        if (!(scale > 0 && scale < INFINITY))
            return (MesoAreaScales){0, 0, 0};
        scales.least = fmin(scales.least, scale);
        scales.largest = fmax(scales.largest, scale);
        flat += scale * disk->triangles[t].area;
        whole += disk->triangles[t].area;
    }
    scales.total = flat / whole;
    return scales;
}

/* ---- equations ---- */

typedef struct Equations {
    size_t count;
    MesoTriplet *triplets;
} Equations;

static void add_term(Equations *equations, uint32_t row, uint32_t column, double value)
{
    if (row < column) {
        uint32_t swapped = row;
        row = column;
        column = swapped;
    }
    equations->triplets[equations->count++] = (MesoTriplet){row, column, value};
}

/* Of the energy area / 2 |gradient|^2 of a function that is linear in the triangle. */
static double stiffness(const MesoFlatTriangle *flat, uint32_t i, uint32_t j)
{
    MesoPoint a = flat->gradients[i], b = flat->gradients[j];
    return flat->area * (a.x * b.x + a.y * b.y);
}

/* Where the border is halfway around from its first vertex, in sides. */
static uint32_t halfway_vertex(const MesoDisk *disk, uint32_t *next)
{
    for (uint32_t b = 0; b < disk->border_count; b++)
        next[disk->border[2 * b]] = disk->border[2 * b + 1];
    uint32_t at = disk->border[0];
    for (uint32_t step = 0; step < disk->border_count / 2; step++)
        at = next[at];
    return at;
}

/*
 * The energy of "Spectral Conformal Parameterization" (Mullen et al. 2008, equations 4 and 5), which is that of least
 * squares: Dirichlet's less the area, and the area is a sum over the border. Unknowns 2v and 2v + 1 are a vertex's.
 */
typedef struct Conformal {
    const MesoDisk *disk;
    uint32_t held[2];       /* vertices; at 0,0 and 1,0 */
    uint32_t *unknowns;     /* [vertex_count] */
    Equations equations;
    double *right;          /* [2 * (vertex_count - 2)] */
} Conformal;

static void add_conformal_term(Conformal *map, uint32_t v, uint32_t v_axis, uint32_t w, uint32_t w_axis, double value)
{
    if (map->unknowns[v] == MESO_NO_INDEX && map->unknowns[w] == MESO_NO_INDEX)
        return;
    if (map->unknowns[v] == MESO_NO_INDEX) {
        add_conformal_term(map, w, w_axis, v, v_axis, value);
    } else if (map->unknowns[w] == MESO_NO_INDEX) {
        if (w == map->held[1] && w_axis == 0)
            map->right[map->unknowns[v] + v_axis] -= value;
    } else {
        add_term(&map->equations, map->unknowns[v] + v_axis, map->unknowns[w] + w_axis, value);
    }
}

static void add_conformal_energy(Conformal *map)
{
    const MesoDisk *disk = map->disk;
    for (uint32_t t = 0; t < disk->triangle_count; t++) {
        const uint32_t *corners = &disk->corners[3 * (size_t)t];
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j <= i; j++)
                for (uint32_t axis = 0; axis < 2; axis++)
                    add_conformal_term(map, corners[i], axis, corners[j], axis, stiffness(&disk->triangles[t], i, j));
    }
    for (uint32_t b = 0; b < disk->border_count; b++) {
        uint32_t from = disk->border[2 * b], to = disk->border[2 * b + 1];
        add_conformal_term(map, from, 0, to, 1, -0.5);
        add_conformal_term(map, to, 0, from, 1, 0.5);
    }
}

static MesoStatus solve_once(Equations *equations, double *x, uint32_t count, MesoArena *scratch, MesoError *error)
{
    MesoCholesky factor;
    MesoStatus status = meso_cholesky_analyse(&factor, scratch, count, equations->triplets, equations->count, error);
    if (!status)
        status = meso_cholesky_factor(&factor, equations->triplets, equations->count, error);
    if (!status)
        meso_cholesky_solve(&factor, x, 1);
    return status;
}

MesoStatus meso_flatten_conformal(MesoPoint *places, MesoArena *scratch, const MesoDisk *disk, MesoError *error)
{
    uint32_t n = disk->vertex_count, free_count = 0;
    MesoArenaMark mark = meso_arena_mark(scratch);
    Conformal map = {.disk = disk};
    uint32_t *next = MESO_NEW(scratch, uint32_t, n, error);
    map.unknowns = MESO_NEW(scratch, uint32_t, n, error);
    map.right = MESO_NEW(scratch, double, 2 * (size_t)n, error);
    size_t term_count = 12 * (size_t)disk->triangle_count + 2 * (size_t)disk->border_count;
    map.equations.triplets = MESO_NEW_BARE(scratch, MesoTriplet, term_count, error);
    MesoStatus status = next && map.unknowns && map.right && map.equations.triplets ? MESO_OK : MESO_ERR_MEMORY;
    if (!status) {
        map.held[0] = disk->border[0];
        map.held[1] = halfway_vertex(disk, next);
        for (uint32_t v = 0; v < n; v++)
            map.unknowns[v] = v == map.held[0] || v == map.held[1] ? MESO_NO_INDEX : 2 * free_count++;
        add_conformal_energy(&map);
        status = solve_once(&map.equations, map.right, 2 * free_count, scratch, error);
    }
    if (!status)
        for (uint32_t v = 0; v < n; v++)
            places[v] = map.unknowns[v] == MESO_NO_INDEX ? (MesoPoint){v == map.held[1], 0}
                                                         : (MesoPoint){map.right[map.unknowns[v]],
                                                                       map.right[map.unknowns[v] + 1]};
    meso_arena_rewind(scratch, mark);
    return status;
}

/* ---- as rigid as possible ---- */

struct MesoRigidSteps {
    const MesoDisk *disk;
    MesoCholesky factor;    /* of all vertices but the first */
    MesoPoint *right;       /* [vertex_count] */
};

MesoRigidSteps *meso_rigid_steps_new(MesoArena *arena, const MesoDisk *disk, MesoError *error)
{
    MesoRigidSteps *steps = MESO_NEW(arena, MesoRigidSteps, 1, error);
    MesoPoint *right = MESO_NEW(arena, MesoPoint, disk->vertex_count, error);
    Equations equations = {0, MESO_NEW_BARE(arena, MesoTriplet, 6 * (size_t)disk->triangle_count, error)};
    if (!steps || !right || !equations.triplets)
        return NULL;
    for (uint32_t t = 0; t < disk->triangle_count; t++) {
        const uint32_t *corners = &disk->corners[3 * (size_t)t];
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j <= i; j++)
                if (corners[i] > 0 && corners[j] > 0)
                    add_term(&equations, corners[i] - 1, corners[j] - 1, stiffness(&disk->triangles[t], i, j));
    }
    *steps = (MesoRigidSteps){.disk = disk, .right = right};
    uint32_t count = disk->vertex_count - 1;
    if (meso_cholesky_analyse(&steps->factor, arena, count, equations.triplets, equations.count, error) ||
        meso_cholesky_factor(&steps->factor, equations.triplets, equations.count, error))
        return NULL;
    return steps;
}

void meso_rigid_step(MesoRigidSteps *steps, MesoPoint *places)
{
    const MesoDisk *disk = steps->disk;
    MesoPoint *right = steps->right;
    for (uint32_t v = 0; v < disk->vertex_count; v++)
        right[v] = (MesoPoint){0, 0};
    for (uint32_t t = 0; t < disk->triangle_count; t++) {
        MesoJacobian map = meso_jacobian(disk, places, t);
        double c = map.x.x + map.y.y, s = map.x.y - map.y.x, length = sqrt(c * c + s * s);
        c = length > 0 ? c / length : 1;
        s = length > 0 ? s / length : 0;
        for (uint32_t k = 0; k < 3; k++) {
            MesoPoint g = disk->triangles[t].gradients[k], *at = &right[disk->corners[3 * (size_t)t + k]];
            at->x += disk->triangles[t].area * (g.x * c - g.y * s);
            at->y += disk->triangles[t].area * (g.x * s + g.y * c);
        }
    }
    meso_cholesky_solve(&steps->factor, &right[1].x, 2);
    MesoPoint first = places[0];
    for (uint32_t v = 1; v < disk->vertex_count; v++)
        places[v] = (MesoPoint){first.x + right[v].x, first.y + right[v].y};
}
