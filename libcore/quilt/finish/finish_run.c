/* All steps after a quilt has grown. */
#include <string.h>

#include "libcore/quilt/finish/finish_work.h"

/* Unit normals of the base's vertices, by area: for distances between points of the layer. */
static MesoStatus find_normals(MesoFinishWork *work, MesoError *error)
{
    const MesoTriangulation *mesh = &work->base->mesh;
    work->normals = MESO_NEW(work->arena, MesoVec3, mesh->vertex_count, error);
    if (!work->normals)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = &mesh->corners[3 * (size_t)t];
        MesoVec3 a = mesh->positions[corner[0]];
        MesoVec3 area = meso_vec3_cross(meso_vec3_sub(mesh->positions[corner[1]], a),
                                        meso_vec3_sub(mesh->positions[corner[2]], a));
        for (uint32_t k = 0; k < 3; k++)
            work->normals[corner[k]] = meso_vec3_add(work->normals[corner[k]], area);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        work->normals[v] = meso_vec3_direction(work->normals[v], (MesoVec3){0, 0, 1});
    return MESO_OK;
}

/* Nothing but whole elements without open ends, and no border: they stay as they are. */
static bool is_finished(const MesoFinishWork *work)
{
    bool strands = false;
    for (uint32_t e = 0; e < work->swatch->element_count; e++)
        strands |= work->swatch->kinds[e] == MESO_ELEMENT_STRAND;
    return !strands && !work->swatch->loop_count && !work->base->inside;
}

/* Where the work has arrays of its own, those of the quilt can go, but for what its elements are. */
static MesoStatus forget(MesoQuilt *quilt, MesoFinishWork *work, MesoError *error)
{
    if (!work->options->spent || !quilt->vertices || work->vertices == quilt->vertices)
        return MESO_OK;
    uint32_t *origins = MESO_NEW(work->arena, uint32_t, quilt->element_count, error);
    if (!origins)
        return MESO_ERR_MEMORY;
    if (quilt->element_count)
        memcpy(origins, quilt->element_origins, quilt->element_count * sizeof *origins);
    *quilt = (MesoQuilt){.element_count = quilt->element_count, .element_origins = origins, .report = quilt->report};
    meso_arena_release(work->options->spent);
    return MESO_OK;
}

static MesoStatus finish(MesoQuilt *quilt, MesoArena *arena, MesoFinishWork *work, MesoError *error)
{
    MesoStatus status = find_normals(work, error);
    if (!status && work->options->scale > 0)
        status = meso_finish_relax(quilt, work, error);
    if (!status)
        status = meso_finish_cut(work, quilt, error);
    if (!status)
        status = forget(quilt, work, error);
    if (!status && work->options->scale > 0)
        status = meso_finish_level(work, quilt, error);
    if (!status && work->options->scale > 0)
        status = meso_finish_part(work, error);
    if (!status)
        status = meso_finish_close(work, error);
    if (!status)
        status = forget(quilt, work, error);
    return status ? status : meso_finish_gather(quilt, arena, work, error);
}

MesoStatus meso_quilt_finish(MesoQuilt *quilt, MesoArena *arena, const MesoQuiltBase *base, const MesoSwatch *swatch,
                             const MesoFinishOptions *options, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoFinishWork work = {.base = base, .swatch = swatch, .options = options, .report = &quilt->report,
                           .arena = &scratch};
    quilt->report.open_count = 0;
    MesoStatus status = MESO_OK;
    if (!is_finished(&work)) {
        status = finish(quilt, arena, &work, error);
        if (status && options->spent)
            *quilt = (MesoQuilt){.report = quilt->report};
    } else {
        for (uint32_t v = 0; v < quilt->vertex_count; v++)
            quilt->vertices[v] = meso_finish_original(&work, quilt->vertices[v]);
    }
    meso_arena_release(&scratch);
    return status;
}
