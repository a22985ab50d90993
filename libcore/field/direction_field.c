#include "libcore/field/direction_field.h"

#include "libcore/base/random.h"
#include "libcore/field/field_comb.h"
#include "libcore/field/field_singularities.h"
#include "libcore/math/sparse_cholesky.h"

/* Steps of inverse iteration, and the change of a direction, squared, below which they end. */
enum { STEPS = 24 };
static const double settled = 1e-10;

typedef struct Smoother {
    const MesoTriangulation *mesh;
    uint32_t symmetry;
    const MesoTriangleFrame *frames;        /* [triangle_count] */
    MesoComplex *targets;           /* [triangle_count] guides to the power of the symmetry, times how they pull */
    uint8_t *guided;                /* [triangle_count] whether its part of the surface has a guide */
    double mean_area;
    MesoTriplet *triplets;
    size_t triplet_count;
    MesoArena *scratch;
    MesoError *error;
} Smoother;

/* ---- the energy ---- */

/* Length of a side over the distance of the centroids at it. */
static double side_weight(const Smoother *s, uint32_t half_edge, uint32_t across)
{
    const double thinnest = 1e-3;   /* of the side's square: the area that two triangles have at least */
    MesoVec3 a = s->mesh->positions[s->mesh->corners[half_edge]];
    MesoVec3 b = s->mesh->positions[s->mesh->corners[meso_next_corner(half_edge)]];
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z, square = x * x + y * y + z * z;
    double area = s->frames[half_edge / 3].area + s->frames[across / 3].area;
    return square > 0 ? 1.5 * square / fmax(area, thinnest * square) : thinnest;
}

static void add_term(Smoother *s, uint32_t row, uint32_t column, double value)
{
    s->triplets[s->triplet_count++] = (MesoTriplet){row, column, value};
}

/* weight * |z_t - turn z_s|^2 for a triangle and one of a higher number across its side. */
static void add_side(Smoother *s, uint32_t half_edge, uint32_t across, double weight)
{
    uint32_t low = 2 * (half_edge / 3), high = 2 * (across / 3);
    MesoComplex turn = meso_complex_power(meso_frame_turn(s->mesh, s->frames, half_edge, across), s->symmetry);
    add_term(s, high, low, -weight * turn.re);
    add_term(s, high, low + 1, weight * turn.im);
    add_term(s, high + 1, low, -weight * turn.im);
    add_term(s, high + 1, low + 1, -weight * turn.re);
}

/* The guide of a triangle, as a complex number of length 1; false where it has none. */
static bool guide_of(const Smoother *s, const MesoVec3 *guides, const float *weights, uint32_t triangle,
                     MesoComplex *guide)
{
    if (!guides || !weights || !(weights[triangle] > 0))
        return false;
    MesoComplex along = meso_frame_in(&s->frames[triangle], guides[triangle]);
    double length = along.re * along.re + along.im * along.im;
    *guide = meso_complex_unit(along);
    return length > 0 && length < INFINITY;
}

static void add_energy(Smoother *s, const MesoVec3 *guides, const float *weights)
{
    /* so little that fields which are not alike anywhere stay far from it, and a field without energy has a solution */
    const double least = 1e-8;
    const MesoTriangulation *mesh = s->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double sum = 0;
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t across = meso_frame_across(mesh, h);
            if (across == MESO_NO_INDEX || across / 3 == t)
                continue;
            double weight = side_weight(s, h, across);
            sum += weight;
            if (across / 3 > t)
                add_side(s, h, across, weight);
        }
        MesoComplex guide;
        double pull = 0;
        if (guide_of(s, guides, weights, t, &guide)) {
            pull = (sum > 0 ? sum : 1) * weights[t];
            guide = meso_complex_power(guide, s->symmetry);
            s->targets[t] = (MesoComplex){pull * guide.re, pull * guide.im};
            s->guided[t] = 1;
        }
        for (uint32_t k = 0; k < 2; k++)
            add_term(s, 2 * t + k, 2 * t + k, sum + pull + least * (1 + s->frames[t].area / s->mean_area));
    }
}

/* ---- parts of the surface ---- */

/* Has `guided` say of each triangle whether there is a guide in its part. */
static MesoStatus spread_guides(Smoother *s)
{
    uint32_t *stack = MESO_NEW(s->scratch, uint32_t, s->mesh->triangle_count, s->error), count = 0;
    if (!stack)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++)
        if (s->guided[t])
            stack[count++] = t;
    while (count) {
        uint32_t t = stack[--count];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t across = meso_frame_across(s->mesh, h);
            if (across == MESO_NO_INDEX || s->guided[across / 3])
                continue;
            s->guided[across / 3] = 1;
            stack[count++] = across / 3;
        }
    }
    return MESO_OK;
}

/*
 * The longest side of the box around all, where it lies along a triangle, and a little at random: symmetric surfaces
 * have smooth fields of which the side has no part, and what is not there does not grow.
 */
static void set_start(const Smoother *s, MesoComplex *field)
{
    const double little = 0.003;
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    const MesoTriangulation *mesh = s->mesh;
    MesoVec3 low = mesh->positions[mesh->corners[0]], high = low;
    for (uint32_t c = 1; c < 3 * mesh->triangle_count; c++) {
        MesoVec3 p = mesh->positions[mesh->corners[c]];
        low = (MesoVec3){fminf(low.x, p.x), fminf(low.y, p.y), fminf(low.z, p.z)};
        high = (MesoVec3){fmaxf(high.x, p.x), fmaxf(high.y, p.y), fmaxf(high.z, p.z)};
    }
    MesoVec3 size = meso_vec3_sub(high, low), axis = {1, 0, 0};
    if (size.y > size.x && size.y >= size.z)
        axis = (MesoVec3){0, 1, 0};
    else if (size.z > size.x)
        axis = (MesoVec3){0, 0, 1};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        field[t] = meso_complex_power(meso_frame_in(&s->frames[t], axis), s->symmetry);
        field[t].re += little * (0x1p-63 * (double)meso_random_next(&random) - 1);
        field[t].im += little * (0x1p-63 * (double)meso_random_next(&random) - 1);
    }
}

/* ---- the solution ---- */

/* Guides where there are, and the field before, by area, where there are none in a part. */
static void set_right_side(const Smoother *s, double *right, const MesoComplex *field)
{
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        double area = s->frames[t].area / s->mean_area;
        right[2 * (size_t)t] = s->guided[t] ? s->targets[t].re : area * field[t].re;
        right[2 * (size_t)t + 1] = s->guided[t] ? s->targets[t].im : area * field[t].im;
    }
}

/* To a length that numbers hold; the largest change of a direction, squared. */
static double take_solution(const Smoother *s, MesoComplex *field, const double *solution)
{
    double largest = 0, change = 0;
    for (size_t i = 0; i < 2 * (size_t)s->mesh->triangle_count; i++)
        largest = fmax(largest, fabs(solution[i]));
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        MesoComplex next = {solution[2 * (size_t)t] / largest, solution[2 * (size_t)t + 1] / largest};
        MesoComplex before = meso_complex_unit(field[t]), after = meso_complex_unit(next);
        double re = after.re - before.re, im = after.im - before.im;
        change = fmax(change, re * re + im * im);
        field[t] = largest > 0 ? next : field[t];
    }
    return change;
}

/* Inverse iteration, by which the smoothest field outgrows all others; guides are met by its first step. */
static MesoStatus solve_field(Smoother *s, MesoComplex *field)
{
    MesoCholesky factor;
    uint32_t count = 2 * s->mesh->triangle_count;
    double *right = MESO_NEW(s->scratch, double, count, s->error);
    if (!right)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_cholesky_analyse(&factor, s->scratch, count, s->triplets, s->triplet_count, s->error);
    if (!status)
        status = meso_cholesky_factor(&factor, s->triplets, s->triplet_count, s->error);
    double change = INFINITY;
    for (uint32_t step = 0; step < STEPS && !status && change > settled; step++) {
        set_right_side(s, right, field);
        meso_cholesky_solve(&factor, right, 1);
        change = take_solution(s, field, right);
    }
    return status;
}

/* ---- the field ---- */

static MesoStatus make_frames(Smoother *s)
{
    uint32_t n = s->mesh->triangle_count;
    MesoTriangleFrame *frames = MESO_NEW(s->scratch, MesoTriangleFrame, n, s->error);
    s->targets = MESO_NEW(s->scratch, MesoComplex, n, s->error);
    s->guided = MESO_NEW(s->scratch, uint8_t, n, s->error);
    s->triplets = MESO_NEW(s->scratch, MesoTriplet, 8 * (size_t)n, s->error);
    if (!frames || !s->targets || !s->guided || !s->triplets)
        return MESO_ERR_MEMORY;
    double area = 0;
    for (uint32_t t = 0; t < n; t++) {
        frames[t] = meso_frame(s->mesh, t);
        area += frames[t].area;
    }
    s->mean_area = area > 0 ? area / n : 1;
    s->frames = frames;
    return MESO_OK;
}

static MesoStatus check_arguments(const MesoTriangulation *mesh, const float *weights, MesoError *error)
{
    if (mesh->triangle_count >= 1u << 30)
        return meso_fail(error, MESO_ERR_LIMIT, "%u triangles are too many for a direction field",
                         mesh->triangle_count);
    for (uint32_t t = 0; weights && t < mesh->triangle_count; t++)
        if (!(weights[t] >= 0 && weights[t] < INFINITY))
            return meso_fail(error, MESO_ERR_INPUT, "weight %g of triangle %u is not a number from 0 on",
                             (double)weights[t], t);
    return MESO_OK;
}

static MesoStatus list_singularities(MesoDirectionField *field, MesoArena *arena, const Smoother *s,
                                     const MesoFieldPowers *powers)
{
    uint32_t vertex_count = s->mesh->vertex_count;
    int *turns = MESO_NEW(s->scratch, int, vertex_count, s->error);
    if (!turns)
        return MESO_ERR_MEMORY;
    meso_field_turns(turns, powers);
    for (uint32_t v = 0; v < vertex_count; v++)
        field->singularity_count += turns[v] != 0;
    field->singularities = MESO_NEW(arena, uint32_t, field->singularity_count, s->error);
    field->indices = MESO_NEW(arena, float, field->singularity_count, s->error);
    if (!field->singularities || !field->indices)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0, n = 0; v < vertex_count; v++)
        if (turns[v]) {
            field->singularities[n] = v;
            field->indices[n++] = (float)turns[v] / (float)s->symmetry;
        }
    return MESO_OK;
}

static MesoStatus smooth_field(MesoDirectionField *field, MesoArena *arena, Smoother *s, const MesoVec3 *guides,
                               const float *weights)
{
    uint32_t n = s->mesh->triangle_count;
    MesoComplex *powers = MESO_NEW(s->scratch, MesoComplex, n, s->error);
    MesoStatus status = powers ? make_frames(s) : MESO_ERR_MEMORY;
    if (status)
        return status;
    add_energy(s, guides, weights);
    status = spread_guides(s);
    if (status)
        return status;
    set_start(s, powers);
    status = solve_field(s, powers);
    if (status)
        return status;
    for (uint32_t t = 0; t < n; t++)
        powers[t] = meso_complex_unit(powers[t]);
    MesoFieldPowers by_power = {s->mesh, s->symmetry, s->frames, powers};
    status = list_singularities(field, arena, s, &by_power);
    return status ? status : meso_field_comb(field->directions, s->scratch, &by_power, guides, weights, s->error);
}

MesoStatus meso_direction_field_smooth(MesoDirectionField *field, MesoArena *arena, const MesoTriangulation *mesh,
                                       uint32_t symmetry, const MesoVec3 *guides, const float *weights,
                                       MesoError *error)
{
    MesoArena scratch;
    MesoStatus status = check_arguments(mesh, weights, error);
    if (status)
        return status;
    meso_arena_init(&scratch);
    *field = (MesoDirectionField){.symmetry = symmetry};
    field->directions = MESO_NEW(arena, MesoVec3, mesh->triangle_count, error);
    Smoother smoother = {.mesh = mesh, .symmetry = symmetry, .scratch = &scratch, .error = error};
    if (!field->directions)
        status = MESO_ERR_MEMORY;
    else if (mesh->triangle_count)
        status = smooth_field(field, arena, &smoother, guides, weights);
    meso_arena_release(&scratch);
    return status;
}
