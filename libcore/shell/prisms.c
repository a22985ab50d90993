#include "libcore/shell/prisms.h"

#include <string.h>

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
    layer->flat = MESO_NEW(arena, uint8_t, layer->mesh->triangle_count, error);
    return layer->rises && layer->normals && layer->thickness && layer->flat ? MESO_OK : MESO_ERR_MEMORY;
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

/* From the full thickness; back to what there was where that is no better. */
static MesoStatus optimise(MesoPrismLayer *layer, Sums *best, const double *thickness, MesoArena *scratch,
                           MesoError *error)
{
    uint32_t count = layer->mesh->vertex_count;
    MesoVec3d *kept = MESO_NEW(scratch, MesoVec3d, count, error);
    if (!kept)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < count; v++) {
        kept[v] = layer->rises[v];
        layer->thickness[v] = thickness[v];
        layer->rises[v] = meso_vec3d_scale(layer->normals[v], thickness[v]);
    }
    MesoStatus status = meso_prism_solve(layer, scratch, error);
    if (status)
        return status;
    meso_prism_face(layer);
    status = meso_prism_lower_folds(layer, NULL, scratch, error);
    if (status)
        return status;
    meso_prism_raise(layer);
    status = relax(layer, scratch, error);
    if (status)
        return status;
    Sums after = measure(layer);
    if (meso_shell_stretch_sixth(&after.there) <= meso_shell_stretch_sixth(&best->there))
        *best = after;
    else
        for (uint32_t v = 0; v < count; v++)
            layer->rises[v] = kept[v];
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
    MesoStatus status = allocate(layer, scratch, error);
    double *thickness = MESO_NEW(scratch, double, layer->mesh->vertex_count, error);
    if (status || !thickness)
        return MESO_ERR_MEMORY;
    meso_prism_normals(layer);
    if (layer->mesh->vertex_count)
        memcpy(thickness, layer->thickness, layer->mesh->vertex_count * sizeof *thickness);
    status = lower(layer, scratch, error);
    if (status)
        return status;
    Sums before = measure(layer), after = before;
    if (wants_least && layer->high > layer->low)
        status = optimise(layer, &after, thickness, scratch, error);
    *report = (MesoPrismReport){meso_shell_stretch(&before.there), meso_shell_stretch(&after.there),
                                meso_shell_stretch(&before.back), meso_shell_stretch(&after.back), 0, 1,
                                after.inverted_count};
    count_limits(report, layer, thickness);
    return status;
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
