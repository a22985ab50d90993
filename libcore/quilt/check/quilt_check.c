#include "libcore/quilt/check/quilt_check.h"

#include "libcore/base/clock.h"

/* How far a whole element's volume may be off. */
#define VOLUME_TOLERANCE 0.1

typedef struct Checking {
    MesoQuiltCheck *check;
    MesoArena *arena;
    const MesoQuilt *quilt;
    const MesoSwatch *swatch;
    MesoCheckMesh mesh, sample;     /* of the quilt, of the swatch */
    double scale, height_scale;
    float offset;
    const MesoTriangulation *base;
    double tiles;                   /* tiles of the swatch that the surface's area is */
    uint32_t window_count, thread_count;
} Checking;

static double area_of(const MesoTriangulation *base)
{
    double area = 0;
    for (uint32_t t = 0; t < base->triangle_count; t++) {
        const uint32_t *v = &base->corners[3 * (size_t)t];
        MesoVec3 a = base->positions[v[0]];
        MesoVec3 b = meso_vec3_sub(base->positions[v[1]], a), c = meso_vec3_sub(base->positions[v[2]], a);
        area += (double)meso_vec3_length(meso_vec3_cross(b, c)) / 2;
    }
    return area;
}

/* ---- elements ---- */

static bool is_merged(const Checking *c, uint32_t element)
{
    for (uint32_t t = c->mesh.triangle_begin[element]; t < c->mesh.triangle_begin[element + 1]; t++)
        if (c->sample.elements[c->quilt->triangle_origins[t]] != c->quilt->element_origins[element])
            return true;
    return false;
}

static void check_whole(const Checking *c, const MesoElementShape *shape, const MesoElementShape *original)
{
    MesoQuiltCheck *check = c->check;
    check->whole_count++;
    if (shape->triangle_count != original->triangle_count || shape->euler != original->euler ||
        shape->open_count != original->open_count || shape->piece_count != original->piece_count) {
        check->changed_count++;
        return;
    }
    double volume = original->volume * c->scale * c->scale * c->height_scale;
    double share = volume > 0 ? shape->volume / volume : 1;
    check->squeezed_count += share < 1 - VOLUME_TOLERANCE || share > 1 + VOLUME_TOLERANCE;
    bool first = check->whole_count - check->changed_count == 1;
    check->least_volume = first || share < check->least_volume ? share : check->least_volume;
    check->largest_volume = first || share > check->largest_volume ? share : check->largest_volume;
}

static MesoStatus check_elements(const Checking *c, MesoError *error)
{
    MesoQuiltCheck *check = c->check;
    MesoElementShape *shapes = MESO_NEW(c->arena, MesoElementShape, c->mesh.element_count, error);
    MesoElementShape *originals = MESO_NEW(c->arena, MesoElementShape, c->sample.element_count, error);
    if (!shapes || !originals)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_check_shapes(shapes, c->arena, &c->mesh, error);
    if (!status)
        status = meso_check_shapes(originals, c->arena, &c->sample, error);
    if (status)
        return status;
    double area = 0, sample_area = 0;
    for (uint32_t e = 0; e < c->sample.element_count; e++) {
        sample_area += originals[e].area;
        check->expected_whole_count += c->swatch->kinds[e] == MESO_ELEMENT_WHOLE ? c->tiles : 0;
    }
    check->least_volume = check->largest_volume = 1;
    for (uint32_t e = 0; e < c->mesh.element_count; e++) {
        uint32_t origin = c->quilt->element_origins[e];
        area += shapes[e].area;
        check->apart_count += shapes[e].piece_count != 1;
        check->merged_count += is_merged(c, e);
        if (c->swatch->kinds[origin] == MESO_ELEMENT_WHOLE)
            check_whole(c, &shapes[e], &originals[origin]);
        else
            check->strand_count++;
    }
    meso_check_sections(&check->sections, &c->mesh, &c->sample, c->quilt, c->swatch, c->scale * c->height_scale);
    check->expected_triangle_count = c->tiles * c->sample.triangle_count;
    check->area_share = area / (sample_area * c->scale * c->scale * c->tiles);
    return MESO_OK;
}

/* ---- all of it ---- */

static MesoStatus check_crossings(const Checking *c, MesoError *error)
{
    MesoQuiltCheck *check = c->check;
    MesoStatus status = meso_check_crossings(&check->crossings, c->arena, &c->mesh, c->thread_count, error);
    if (!status)
        status = meso_check_crossings(&check->swatch_crossings, c->arena, &c->sample, c->thread_count, error);
    const MesoCrossings *s = &check->swatch_crossings;
    check->expected_crossings = (double)(s->between_count + s->within_count) * c->tiles;
    return status;
}

static MesoStatus check_seams(const Checking *c, MesoError *error)
{
    return meso_check_seams(&c->check->seams, c->arena, &c->mesh, error);
}

static MesoStatus check_cover(const Checking *c, MesoError *error)
{
    return meso_check_cover(&c->check->cover, c->arena, c->quilt, c->swatch, c->base, (float)c->scale, error);
}

static MesoStatus check_likeness(const Checking *c, MesoError *error)
{
    const MesoLikenessOptions options = {(float)c->scale, (float)c->height_scale, c->offset, c->window_count,
                                          c->thread_count};
    return meso_check_likeness(&c->check->likeness, c->arena, c->quilt, c->swatch, c->mesh.positions, c->base, &options,
                               error);
}

static MesoStatus check_all(Checking *c, const MesoVec3 *positions, MesoError *error)
{
    MesoStatus (*const parts[])(const Checking *, MesoError *) = {
        check_elements, check_crossings, check_seams, check_cover, check_likeness,
    };
    double start = meso_seconds();
    MesoStatus status = meso_check_mesh_of_quilt(&c->mesh, &c->check->faults, c->arena, c->quilt, positions,
                                                 c->thread_count, error);
    if (!status)
        status = meso_check_mesh_of_swatch(&c->sample, c->arena, c->swatch, error);
    for (size_t i = 0; i < sizeof parts / sizeof *parts && !status && !c->check->faults.unplaced_count; i++) {
        status = parts[i](c, error);
        double now = meso_seconds();
        c->check->seconds[i] = now - start;
        start = now;
    }
    return status;
}

MesoStatus meso_quilt_check(MesoQuiltCheck *check, MesoArena *arena, const MesoQuilt *quilt, const MesoSwatch *swatch,
                            const MesoVec3 *positions, const MesoTriangulation *base,
                            const MesoQuiltCheckOptions *options, MesoError *error)
{
    *check = (MesoQuiltCheck){0};
    Checking c = {.check = check, .arena = arena, .quilt = quilt, .swatch = swatch, .scale = (double)options->scale,
                  .base = base, .offset = options->offset, .window_count = options->window_count,
                  .thread_count = options->thread_count};
    c.height_scale = options->height_scale > 0 ? (double)options->height_scale : c.scale;
    c.tiles = area_of(base) / (c.scale * c.scale * (double)swatch->size.x * (double)swatch->size.y);
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoStatus status = check_all(&c, positions, error);
    meso_arena_rewind(arena, mark);
    return status;
}
