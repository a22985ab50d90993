/*
 * With x = sum b_i (p_i + h d_i) over a flat prism of its triangle's shape, the integral E of the square of equation 8
 * is quadratic in the directions, and each has the same weight along all axes; the volume V is linear in each single
 * direction. The logarithm of the normalised stretch's square, log E - 2/3 log V, is therefore stationary in one
 * direction, others held, where E - s V is with s = 2/3 E / V: at a point that is found by one division. Sweeps over
 * vertices take it, as far as prisms stand: the barrier against what E alone does not see.
 */
#include "libcore/base/team.h"
#include "libcore/math/sparse_cholesky.h"
#include "libcore/shell/prism_layer.h"

typedef struct Relaxation {
    MesoPrismLayer *layer;
    double lengths[3];      /* integrals of 1, h and h squared from low to high */
    double (*flats)[4];     /* [triangle_count] area, and the products of gradients of corners 1,2  2,0  0,1 */
    double slope;           /* s */
} Relaxation;

/* Product of the gradients of the weights of two corners; those of one corner follow, as all add up to 0. */
static double gradients(const double flat[4], uint32_t i, uint32_t j)
{
    return i == j ? -flat[1 + (i + 1) % 3] - flat[1 + (i + 2) % 3] : flat[1 + 3 - i - j];
}

static void measure(Relaxation *relax)
{
    const MesoTriangulation *mesh = relax->layer->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->corners[3 * (size_t)t];
        MesoVec3d sides[3];
        for (uint32_t k = 0; k < 3; k++)
            sides[k] = meso_vec3d_sub(meso_vec3d(mesh->positions[v[(k + 2) % 3]]),
                                      meso_vec3d(mesh->positions[v[(k + 1) % 3]]));
        double area = 0.5 * relax->layer->areas[t];
        relax->flats[t][0] = area;
        for (uint32_t k = 0; k < 3; k++)
            relax->flats[t][1 + k] = meso_vec3d_dot(sides[(k + 1) % 3], sides[(k + 2) % 3]) / (4 * area * area);
    }
}

static MesoStatus init(Relaxation *relax, MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    double low = layer->low, high = layer->high;
    *relax = (Relaxation){layer, {high - low, (high * high - low * low) / 2,
                                  (high * high * high - low * low * low) / 3}, NULL, 2};
    relax->flats = meso_arena_alloc(scratch, layer->mesh->triangle_count, sizeof *relax->flats, error);
    if (!relax->flats)
        return MESO_ERR_MEMORY;
    measure(relax);
    return MESO_OK;
}

/* Weights of d_i . d_j and of d_i . p_j in half the derivative of E. */
static double rise_weight(const Relaxation *relax, const double flat[4], uint32_t i, uint32_t j)
{
    return flat[0] * (gradients(flat, i, j) * relax->lengths[2] + relax->lengths[0] * (i == j ? 2 : 1) / 12);
}

static double place_weight(const Relaxation *relax, const double flat[4], uint32_t i, uint32_t j)
{
    return flat[0] * gradients(flat, i, j) * relax->lengths[1];
}

/* ---- volume ---- */

typedef struct Prism {
    MesoVec3d places[3], rises[3];
} Prism;

static inline __attribute__((always_inline)) Prism prism_of(const Relaxation *relax, uint32_t triangle, uint32_t from)
{
    Prism prism;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t v = relax->layer->mesh->corners[3 * (size_t)triangle + (from + k) % 3];
        prism.places[k] = meso_vec3d(relax->layer->mesh->positions[v]);
        prism.rises[k] = relax->layer->rises[v];
    }
    return prism;
}

/* The integral over heights of twice the lid's area, as a vector. */
static inline __attribute__((always_inline)) MesoVec3d lid_integral(const Relaxation *relax, const Prism *prism)
{
    const MesoVec3d *p = prism->places, *d = prism->rises;
    MesoVec3d a = meso_vec3d_sub(p[1], p[0]), da = meso_vec3d_sub(d[1], d[0]);
    MesoVec3d b = meso_vec3d_sub(p[2], p[0]), db = meso_vec3d_sub(d[2], d[0]);
    MesoVec3d sum = meso_vec3d_scale(meso_vec3d_cross(a, b), relax->lengths[0]);
    sum = meso_vec3d_mad(sum, relax->lengths[1], meso_vec3d_add(meso_vec3d_cross(a, db), meso_vec3d_cross(da, b)));
    return meso_vec3d_mad(sum, relax->lengths[2], meso_vec3d_cross(da, db));
}

static MesoVec3d mean_rise(const Prism *prism)
{
    return meso_vec3d_scale(meso_vec3d_add(meso_vec3d_add(prism->rises[0], prism->rises[1]), prism->rises[2]), 1.0 / 3);
}

/* Of the volume by the first corner's direction. */
static inline __attribute__((always_inline)) MesoVec3d volume_derivative(const Relaxation *relax, const Prism *prism)
{
    MesoVec3d across = meso_vec3d_scale(meso_vec3d_sub(prism->places[1], prism->places[2]), relax->lengths[1]);
    across = meso_vec3d_mad(across, relax->lengths[2], meso_vec3d_sub(prism->rises[1], prism->rises[2]));
    MesoVec3d sum = meso_vec3d_scale(lid_integral(relax, prism), 1.0 / 3);
    return meso_vec3d_scale(meso_vec3d_add(sum, meso_vec3d_cross(across, mean_rise(prism))), 0.5);
}

/* s for the directions as they are. */
static double slope_of(const Relaxation *relax)
{
    const MesoPrismLayer *layer = relax->layer;
    double energy = 0, volume = 0;
    for (uint32_t t = 0; t < layer->mesh->triangle_count; t++) {
        if (layer->flat[t])
            continue;
        const double *flat = relax->flats[t];
        Prism prism = prism_of(relax, t, 0);
        volume += 0.5 * meso_vec3d_dot(lid_integral(relax, &prism), mean_rise(&prism));
        energy += 2 * flat[0] * relax->lengths[0];      /* of the triangle itself */
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j < 3; j++)
                energy += rise_weight(relax, flat, i, j) * meso_vec3d_dot(prism.rises[i], prism.rises[j]) +
                          2 * place_weight(relax, flat, i, j) * meso_vec3d_dot(prism.rises[i], prism.places[j]);
    }
    return volume > 0 ? 2.0 / 3 * energy / volume : 2;
}

/* With the height along the normal that is wanted, or, where folds have lowered it, one between that and what it is. */
static MesoVec3d keep_thickness(const MesoPrismLayer *layer, uint32_t vertex, MesoVec3d rise)
{
    MesoVec3d normal = layer->normals[vertex];
    double most = layer->thickness[vertex], own = meso_vec3d_dot(layer->rises[vertex], normal);
    double least = own < most ? own : most, height = meso_vec3d_dot(rise, normal);
    double kept = height < most ? height : most;
    return meso_vec3d_mad(rise, (kept > least ? kept : least) - height, normal);
}

/* ---- all directions at once ---- */

/* Half the derivative of s V - E by each direction, where the directions do not count for E; and the weights in E. */
static void add_terms(const Relaxation *relax, uint32_t triangle, MesoTriplet *triplets, size_t *count, double *right)
{
    const uint32_t *v = &relax->layer->mesh->corners[3 * (size_t)triangle];
    const double *flat = relax->flats[triangle];
    for (uint32_t i = 0; i < 3; i++) {
        Prism prism = prism_of(relax, triangle, i);
        MesoVec3d sum = meso_vec3d_scale(volume_derivative(relax, &prism), 0.5 * relax->slope);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t j = (i + k) % 3;
            sum = meso_vec3d_mad(sum, -place_weight(relax, flat, i, j), prism.places[k]);
            if (v[i] >= v[j])
                triplets[(*count)++] = (MesoTriplet){v[i], v[j], rise_weight(relax, flat, i, j)};
        }
        right[3 * (size_t)v[i]] += sum.x;
        right[3 * (size_t)v[i] + 1] += sum.y;
        right[3 * (size_t)v[i] + 2] += sum.z;
    }
}

/* Vertices without a triangle that counts stand alone. */
static size_t add_lonely(const MesoPrismLayer *layer, uint8_t *met, MesoTriplet *triplets, size_t count)
{
    for (uint32_t t = 0; t < layer->mesh->triangle_count; t++)
        for (uint32_t k = 0; k < 3 && !layer->flat[t]; k++)
            met[layer->mesh->corners[3 * (size_t)t + k]] = 1;
    for (uint32_t v = 0; v < layer->mesh->vertex_count; v++)
        if (!met[v])
            triplets[count++] = (MesoTriplet){v, v, 1};
    return count;
}

MesoStatus meso_prism_solve(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    const uint32_t most = 1u << 17;     /* vertices: a second or two, some hundred MB */
    const MesoTriangulation *mesh = layer->mesh;
    if (mesh->vertex_count > most)
        return MESO_OK;
    MesoArenaMark mark = meso_arena_mark(scratch);
    Relaxation relax;
    MesoCholesky factor;
    size_t count = 0;
    MesoStatus status = init(&relax, layer, scratch, error);
    size_t most_terms = 6 * (size_t)mesh->triangle_count + mesh->vertex_count;
    MesoTriplet *triplets = MESO_NEW(scratch, MesoTriplet, most_terms, error);
    double *right = MESO_NEW(scratch, double, 3 * (size_t)mesh->vertex_count, error);
    uint8_t *met = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    if (status || !triplets || !right || !met)
        return MESO_ERR_MEMORY;
    relax.slope = slope_of(&relax);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (!layer->flat[t])
            add_terms(&relax, t, triplets, &count, right);
    count = add_lonely(layer, met, triplets, count);
    status = meso_cholesky_analyse(&factor, scratch, mesh->vertex_count, triplets, count, error);
    if (!status)
        status = meso_cholesky_factor(&factor, triplets, count, error);
    if (!status) {
        meso_cholesky_solve(&factor, right, 3);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            if (met[v])
                layer->rises[v] = keep_thickness(layer, v, (MesoVec3d){right[3 * (size_t)v], right[3 * (size_t)v + 1],
                                                                       right[3 * (size_t)v + 2]});
    }
    meso_arena_rewind(scratch, mark);
    return status == MESO_ERR_INPUT ? MESO_OK : status;
}

/* ---- sweeps ---- */

/* The stationary point of E - s V in one direction. */
static MesoVec3d best_rise(const Relaxation *relax, uint32_t vertex)
{
    const MesoPrismLayer *layer = relax->layer;
    MesoFan fan = meso_fan_first(layer->mesh, vertex);
    uint32_t first = fan.corner;
    MesoVec3d sum = {0, 0, 0};
    double weight = 0;
    do {
        uint32_t t = fan.corner / 3;
        if (layer->flat[t])
            continue;
        const double *flat = relax->flats[t];
        Prism prism = prism_of(relax, t, fan.corner % 3);
        weight += rise_weight(relax, flat, fan.corner % 3, fan.corner % 3);
        sum = meso_vec3d_mad(sum, 0.5 * relax->slope, volume_derivative(relax, &prism));
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t j = (fan.corner + k) % 3;
            sum = meso_vec3d_mad(sum, -place_weight(relax, flat, fan.corner % 3, j), prism.places[k]);
            if (k > 0)
                sum = meso_vec3d_mad(sum, -rise_weight(relax, flat, fan.corner % 3, j), prism.rises[k]);
        }
    } while (meso_fan_next(layer->mesh, &fan) && fan.corner != first);
    return weight > 0 ? meso_vec3d_scale(sum, 1 / weight) : layer->rises[vertex];
}

static void move_vertex(Relaxation *relax, uint32_t vertex)
{
    enum { STEPS = 4 };
    const double margin = 0.1;      /* further away from folds than they must be */
    MesoPrismLayer *layer = relax->layer;
    MesoVec3d old = layer->rises[vertex], best = keep_thickness(layer, vertex, best_rise(relax, vertex));
    MesoVec3d way = meso_vec3d_sub(best, old);
    double step = 1;
    for (uint32_t k = 0; k < STEPS; k++, step /= 2) {
        layer->rises[vertex] = meso_vec3d_mad(old, step, way);
        if (meso_prism_ring_stands(layer, vertex, margin))
            return;
    }
    layer->rises[vertex] = old;
}

/*
 * A vertex looks at those around it as they are after all before it: it can be moved with the others of its level, one
 * after the highest of those. So each has the same direction as if they were moved one by one.
 */
typedef struct Levels {
    uint32_t count;
    uint32_t *begin;        /* [count + 1] into the order */
    uint32_t *order;        /* vertices, of those that may be moved */
} Levels;

/* Vertices of a level that one thread moves at a time. */
enum { TOGETHER = 8 };

static bool may_move(const MesoPrismLayer *layer, uint32_t vertex)
{
    return layer->mesh->vertex_corner[vertex] != MESO_NO_INDEX &&
           meso_vec3d_dot(layer->normals[vertex], layer->normals[vertex]) > 0;
}

/* From 1 on; `levels` of lower vertices are known. */
static uint32_t level_of(const MesoTriangulation *mesh, const uint32_t *levels, uint32_t vertex)
{
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner, most = 0;
    do {
        uint32_t triangle = fan.corner / 3;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->corners[3 * (size_t)triangle + k];
            most = v < vertex && levels[v] > most ? levels[v] : most;
        }
    } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    return most + 1;
}

static MesoStatus find_levels(Levels *levels, const MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    uint32_t count = layer->mesh->vertex_count, *level = MESO_NEW(scratch, uint32_t, count, error);
    levels->order = MESO_NEW(scratch, uint32_t, count, error);
    levels->count = 0;
    if (!level || !levels->order)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < count; v++)
        if (may_move(layer, v)) {
            level[v] = level_of(layer->mesh, level, v);
            levels->count = level[v] > levels->count ? level[v] : levels->count;
        }
    levels->begin = MESO_NEW(scratch, uint32_t, (size_t)levels->count + 2, error);
    if (!levels->begin)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < count; v++)
        if (level[v])
            levels->begin[level[v] + 1]++;
    for (uint32_t l = 0; l < levels->count; l++)
        levels->begin[l + 2] += levels->begin[l + 1];
    for (uint32_t v = 0; v < count; v++)
        if (level[v])
            levels->order[levels->begin[level[v]]++] = v;
    return MESO_OK;
}

/* Vertices of a level. */
typedef struct Level {
    Relaxation *relax;
    const uint32_t *vertices;
} Level;

static void move_range(void *context, uint64_t begin, uint64_t end)
{
    const Level *level = context;
    for (uint64_t i = begin; i < end; i++)
        move_vertex(level->relax, level->vertices[i]);
}

MesoStatus meso_prism_relax(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    enum { SWEEPS = 8 };
    MesoArenaMark mark = meso_arena_mark(scratch);
    Relaxation relax;
    Levels levels;
    if (init(&relax, layer, scratch, error) || find_levels(&levels, layer, scratch, error))
        return MESO_ERR_MEMORY;
    MesoTeam *team = meso_team_begin(layer->thread_count);
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        relax.slope = slope_of(&relax);
        for (uint32_t l = 0; l < levels.count; l++) {
            uint32_t begin = levels.begin[l];
            meso_team_for(team, levels.begin[l + 1] - begin, TOGETHER, move_range,
                          &(Level){&relax, &levels.order[begin]});
        }
    }
    meso_team_end(team);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
