#include "libcore/shell/prisms.h"

#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/shell/prism_layer.h"
#include "libcore/shell/shell_stretch.h"

static MesoStatus check_arguments(const MesoTriangulation *mesh, const MesoPrismOptions *options, MesoError *error)
{
    if (!(isfinite(options->low) && isfinite(options->high) && options->low <= options->high))
        return meso_fail(error, MESO_ERR_INPUT, "no layer from height %g to %g", (double)options->low,
                         (double)options->high);
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] != MESO_NO_INDEX && mesh->corners[mesh->twins[h]] == mesh->corners[h])
            return meso_fail(error, MESO_ERR_INPUT, "faces %u and %u are wound against each other",
                             mesh->faces[h / 3], mesh->faces[mesh->twins[h] / 3]);
    return MESO_OK;
}

static MesoStatus allocate(MesoPrismLayer *layer, MesoArena *arena, MesoError *error)
{
    uint32_t vertex_count = layer->mesh->vertex_count;
    layer->rises = MESO_NEW(arena, MesoVec3d, vertex_count, error);
    layer->normals = MESO_NEW(arena, MesoVec3d, vertex_count, error);
    layer->thickness = MESO_NEW(arena, double, vertex_count, error);
    layer->areas = MESO_NEW(arena, double, layer->mesh->triangle_count, error);
    layer->flat = MESO_NEW(arena, uint8_t, layer->mesh->triangle_count, error);
    return layer->rises && layer->normals && layer->thickness && layer->areas && layer->flat
               ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- stretch ---- */

/* The triangle laid flat: side 0 along x. */
typedef struct FlatTriangle {
    double length, along, up;   /* corners 0,0  length,0  along,up */
} FlatTriangle;

static FlatTriangle lay_flat(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    MesoVec3d p = meso_vec3d(mesh->positions[v[0]]);
    MesoVec3d a = meso_vec3d_sub(meso_vec3d(mesh->positions[v[1]]), p);
    MesoVec3d b = meso_vec3d_sub(meso_vec3d(mesh->positions[v[2]]), p);
    double length = meso_vec3d_length(a);
    return (FlatTriangle){length, meso_vec3d_dot(a, b) / length,
                          meso_vec3d_length(meso_prism_base(mesh, triangle)) / length};
}

typedef struct Sums {
    MesoShellStretch there, back;
    uint32_t inverted_count;    /* tetrahedra */
} Sums;

/* Gauss's points over heights, to the fifth power, and over the triangle to the second: exact on the way there. */
static void add_prism(Sums *sums, const MesoPrismLayer *layer, uint32_t triangle)
{
    static const double levels[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double weights[3] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
    const uint32_t *v = &layer->mesh->corners[3 * (size_t)triangle];
    FlatTriangle flat = lay_flat(layer->mesh, triangle);
    for (uint32_t i = 0; i < 3; i++) {
        double height = layer->low + levels[i] * (layer->high - layer->low);
        double volume = weights[i] * (layer->high - layer->low) * flat.length * flat.up / 6;
        MesoVec3d p = meso_prism_corner(layer, v[0], height), derivatives[3];
        derivatives[0] = meso_vec3d_scale(meso_vec3d_sub(meso_prism_corner(layer, v[1], height), p), 1 / flat.length);
        derivatives[1] = meso_vec3d_sub(meso_prism_corner(layer, v[2], height), p);
        derivatives[1] = meso_vec3d_scale(meso_vec3d_mad(derivatives[1], -flat.along, derivatives[0]), 1 / flat.up);
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3d rise = meso_vec3d_scale(layer->rises[v[k]], 4.0 / 6);
            rise = meso_vec3d_mad(rise, 1.0 / 6, layer->rises[v[(k + 1) % 3]]);
            derivatives[2] = meso_vec3d_mad(rise, 1.0 / 6, layer->rises[v[(k + 2) % 3]]);
            meso_shell_stretch_sample(&sums->there, derivatives, volume, false);
            meso_shell_stretch_sample(&sums->back, derivatives, volume, true);
        }
    }
}

static uint32_t count_inverted(const MesoPrismLayer *layer, uint32_t triangle)
{
    const double rounding = 1e-12;      /* where a corner has no direction, tetrahedra have no volume */
    const uint32_t *v = &layer->mesh->corners[3 * (size_t)triangle];
    uint8_t tetrahedra[3][4];
    uint32_t count = 0;
    meso_prism_split(v, tetrahedra);
    for (uint32_t i = 0; i < 3; i++) {
        MesoVec3d corners[4];
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t corner = tetrahedra[i][k];
            corners[k] = meso_prism_corner(layer, v[corner % 3], corner < 3 ? layer->low : layer->high);
        }
        double most = rounding;
        for (uint32_t k = 1; k < 4; k++)
            most *= meso_vec3d_length(meso_vec3d_sub(corners[k], corners[0]));
        count += meso_tetrahedron_det(corners) < -most;
    }
    return count;
}

static Sums measure(const MesoPrismLayer *layer)
{
    Sums sums = {0};
    for (uint32_t t = 0; t < layer->mesh->triangle_count; t++)
        if (!layer->flat[t] && layer->low < layer->high) {
            add_prism(&sums, layer, t);
            sums.inverted_count += count_inverted(layer, t);
        }
    return sums;
}

/* ---- steps ---- */

static MesoStatus lower(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    bool lowered;
    MesoStatus status = meso_prism_lower_folds(layer, NULL, scratch, error);
    if (!status) {
        meso_prism_raise(layer);
        status = meso_prism_lower_overlaps(layer, &lowered, scratch, error);
    }
    return status;
}

/* Turned, and lowered where that makes prisms meet; once more where it has, with what is left of the heights. */
static MesoStatus relax(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    bool lowered = true;
    MesoStatus status = MESO_OK;
    for (uint32_t pass = 0; pass < 2 && lowered && !status; pass++) {
        status = meso_prism_relax(layer, scratch, error);
        if (!status)
            status = meso_prism_lower_overlaps(layer, &lowered, scratch, error);
    }
    return status;
}

/*
 * Two ways to begin, at the same time: from normals, lowered until nothing meets, and from the solution of one system
 * at the full thickness, lowered until nothing folds.
 */
typedef struct Beginnings {
    MesoPrismLayer *layers[2];
    MesoArena *arenas[2];
    MesoStatus statuses[2];
    MesoError errors[2];
    Sums normal;                /* of what the first comes to */
} Beginnings;

static MesoStatus begin_solved(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error)
{
    MesoStatus status = meso_prism_solve(layer, scratch, error);
    if (status)
        return status;
    meso_prism_face(layer);
    status = meso_prism_lower_folds(layer, NULL, scratch, error);
    if (!status)
        meso_prism_raise(layer);
    return status;
}

static void begin_range(void *context, uint64_t begin, uint64_t end)
{
    Beginnings *b = context;
    for (uint64_t i = begin; i < end; i++) {
        b->statuses[i] = i ? begin_solved(b->layers[i], b->arenas[i], &b->errors[i])
                           : lower(b->layers[i], b->arenas[i], &b->errors[i]);
        if (!i && !b->statuses[i])
            b->normal = measure(b->layers[i]);
    }
}

/* As the layer is now, with directions of its own. */
static MesoStatus copy_layer(MesoPrismLayer *copy, const MesoPrismLayer *layer, MesoArena *arena, MesoError *error)
{
    size_t count = layer->mesh->vertex_count;
    *copy = *layer;
    copy->rises = MESO_NEW(arena, MesoVec3d, count, error);
    copy->thickness = MESO_NEW(arena, double, count, error);
    if (!copy->rises || !copy->thickness)
        return MESO_ERR_MEMORY;
    if (count) {
        memcpy(copy->rises, layer->rises, count * sizeof *copy->rises);
        memcpy(copy->thickness, layer->thickness, count * sizeof *copy->thickness);
    }
    return MESO_OK;
}

/* `solved` NULL: from normals alone. */
static MesoStatus begin_layers(Beginnings *b, MesoPrismLayer *layer, MesoPrismLayer *solved, MesoArena *scratch,
                               MesoError *error)
{
    MesoArena beside;
    meso_arena_init(&beside);
    *b = (Beginnings){.layers = {layer, solved}, .arenas = {scratch, &beside}};
    meso_parallel_for(layer->thread_count, solved ? 2 : 1, 1, begin_range, b);
    meso_arena_release(&beside);
    for (int i = 0; i < 2; i++)
        if (b->statuses[i]) {
            if (error)
                *error = b->errors[i];
            return b->statuses[i];
        }
    return MESO_OK;
}

/* Lengths as shares of those of the scaled normals. */
static void count_limits(MesoPrismReport *report, const MesoPrismLayer *layer, const double *thickness)
{
    const double rounding = 1e-6;
    report->least_limit = 1;
    report->limited_count = 0;
    for (uint32_t v = 0; v < layer->mesh->vertex_count; v++) {
        if (layer->mesh->vertex_corner[v] == MESO_NO_INDEX)
            continue;
        double share = meso_vec3d_dot(layer->rises[v], layer->normals[v]) / thickness[v];
        report->limited_count += share < 1 - rounding;
        report->least_limit = fminf(report->least_limit, (float)share);
    }
}

static MesoStatus build(MesoPrismLayer *layer, MesoPrismReport *report, MesoArena *scratch, bool wants_least,
                        MesoError *error)
{
    if (allocate(layer, scratch, error))
        return MESO_ERR_MEMORY;
    meso_prism_normals(layer);
    MesoPrismLayer solved;
    Beginnings beginnings;
    double *thickness = MESO_NEW(scratch, double, layer->mesh->vertex_count, error);
    if (!thickness)
        return MESO_ERR_MEMORY;
    if (layer->mesh->vertex_count)
        memcpy(thickness, layer->thickness, layer->mesh->vertex_count * sizeof *thickness);
    wants_least = wants_least && layer->high > layer->low;
    MesoStatus status = copy_layer(&solved, layer, scratch, error);
    if (!status)
        status = begin_layers(&beginnings, layer, wants_least ? &solved : NULL, scratch, error);
    if (!status && wants_least)
        status = relax(&solved, scratch, error);
    if (status)
        return status;
    Sums before = beginnings.normal, after = wants_least ? measure(&solved) : before;
    if (meso_shell_stretch_sixth(&after.there) <= meso_shell_stretch_sixth(&before.there) && wants_least)
        layer->rises = solved.rises;
    else
        after = before;
    *report = (MesoPrismReport){meso_shell_stretch(&before.there), meso_shell_stretch(&after.there),
                                meso_shell_stretch(&before.back), meso_shell_stretch(&after.back), 0, 1,
                                after.inverted_count};
    count_limits(report, layer, thickness);
    return MESO_OK;
}

MesoStatus meso_prisms_build(MesoVec3 *directions, MesoPrismReport *report, MesoArena *scratch,
                             const MesoTriangulation *mesh, const MesoPrismOptions *options, MesoError *error)
{
    MesoPrismReport own;
    MesoStatus status = check_arguments(mesh, options, error);
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoPrismLayer layer = {.mesh = mesh, .low = options->low, .high = options->high,
                            .thread_count = options->thread_count};
    status = build(&layer, report ? report : &own, scratch, options->optimise, error);
    for (uint32_t v = 0; v < mesh->vertex_count && !status; v++)
        directions[v] = meso_vec3d_narrow(layer.rises[v]);
    meso_arena_rewind(scratch, mark);
    return status;
}
