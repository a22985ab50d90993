#include "libcore/decor/decor.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/random.h"
#include "libcore/decor/decor_work.h"
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/mesh/cut/triangle_area.h"

/* ---- what steps share ---- */

MesoStatus meso_decor_refresh(MesoDecorWork *work, MesoError *error)
{
    MesoDecor *decor = work->decor;
    meso_arena_rewind(&work->tables, work->tables_begin);
    work->member = MESO_NEW(&work->tables, uint8_t, decor->tree.region_count, error);
    if (!work->member)
        return MESO_ERR_MEMORY;
    if (decor->mesh.vertex_count > work->field_room) {
        uint32_t room = decor->mesh.vertex_room;
        free(work->field);
        free(work->other);
        work->field_room = 0;
        work->field = malloc(room * sizeof *work->field);
        work->other = malloc(room * sizeof *work->other);
        if (!work->field || !work->other)
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory: fields of %u vertices", room);
        work->field_room = room;
    }
    return meso_region_lists_build(&work->lists, &work->tables, &decor->tree, &decor->mesh, error);
}

uint64_t meso_decor_random(const MesoDecorWork *work, uint32_t region, MesoDecorDraw draw)
{
    MesoRandom random;
    meso_random_init(&random, work->options->seed,
                     (uint64_t)region << 32 | work->decor->operation_count << 3 | (uint64_t)draw);
    return meso_random_next(&random);
}

float meso_decor_random_share(const MesoDecorWork *work, uint32_t region, MesoDecorDraw draw)
{
    return (float)(meso_decor_random(work, region, draw) >> 40) * 0x1p-24f;
}

MesoStatus meso_decor_normals(MesoDecorWork *work, MesoError *error)
{
    const MesoTriangulation *mesh = &work->decor->mesh;
    work->normals = MESO_NEW(work->scratch, MesoVec3, mesh->vertex_count, error);
    if (!work->normals)
        return MESO_ERR_MEMORY;
    meso_vertex_normals(work->normals, mesh);
    return MESO_OK;
}

MesoStatus meso_decor_shape(MesoDecorWork *work, uint32_t region, MesoRegionShape *shape, MesoError *error)
{
    const MesoRegionTree *tree = &work->decor->tree;
    MesoDomain domain;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    MesoStatus status = meso_region_domain(&domain, work->member, work->scratch, tree, &work->lists, &work->decor->mesh,
                                           region, error);
    if (!status)
        status = meso_region_shape(shape, work->scratch, &work->decor->mesh, &domain, error);
    meso_region_domain_end(tree, region, work->member);
    meso_arena_rewind(work->scratch, mark);
    return status;
}

void meso_decor_note(const MesoDecorWork *work, const MesoStep *step, const char *text)
{
    if (work->options->note)
        work->options->note(work->options->context, step->place, text);
}

/* ---- steps ---- */

static uint32_t *regions_of(MesoDecorWork *work, const MesoTargets *targets, MesoError *error)
{
    uint32_t *regions = MESO_NEW(work->scratch, uint32_t, targets->count, error);
    for (uint32_t i = 0; regions && i < targets->count; i++)
        regions[i] = targets->targets[i].region;
    return regions;
}

/* Painting and moving of what a split has made: [first, region_count). */
static MesoStatus look_after(MesoDecorWork *work, const MesoStep *step, uint32_t first, MesoError *error)
{
    const MesoRegionTree *tree = &work->decor->tree;
    uint32_t count = tree->region_count - first;
    MesoStatus status = MESO_OK;
    uint32_t *regions = MESO_NEW(work->scratch, uint32_t, count, error);
    if (!regions)
        return MESO_ERR_MEMORY;
    for (uint32_t a = 0; a < step->after_count && !status; a++) {
        const MesoAfterSplit *after = &step->after[a];
        uint32_t chosen = 0;
        for (uint32_t i = 0; i < count; i++)
            if (!after->tag || strcmp(after->tag, tree->regions[first + i].tag) == 0)
                regions[chosen++] = first + i;
        if (after->painted)
            meso_decor_paint(work, after, regions, chosen);
        if (after->displaced && chosen > 0)
            status = meso_decor_displace(work, step, &after->displacement, regions, chosen, error);
    }
    return status;
}

static MesoStatus split_and_look_after(MesoDecorWork *work, const MesoStep *step, const MesoTargets *targets,
                                       MesoError *error)
{
    uint32_t before = work->decor->tree.region_count;
    MesoStatus status = meso_decor_split(work, step, targets, error);
    if (!status && work->decor->tree.region_count > work->options->region_limit)
        return meso_fail(error, MESO_ERR_LIMIT, "%u regions, over the limit of %u",
                         work->decor->tree.region_count, work->options->region_limit);
    if (!status)
        status = meso_decor_refresh(work, error);
    return status ? status : look_after(work, step, before, error);
}

static MesoStatus run_on(MesoDecorWork *work, const MesoStep *step, const MesoTargets *targets, MesoError *error)
{
    uint32_t *regions = regions_of(work, targets, error);
    MesoStatus status = MESO_OK;
    if (!regions)
        return MESO_ERR_MEMORY;
    switch (step->kind) {
    case MESO_STEP_MACRO:
        return meso_decor_run_steps(work, step->macro.steps, step->macro.step_count, regions, targets->count, error);
    case MESO_STEP_GROW:
        return meso_decor_grow(work, step, targets, error);
    case MESO_STEP_PAINT:
        meso_decor_paint(work, step->after, regions, targets->count);
        break;
    case MESO_STEP_DISPLACE:
        status = meso_decor_displace(work, step, &step->after->displacement, regions, targets->count, error);
        break;
    default:
        status = split_and_look_after(work, step, targets, error);
    }
    work->decor->operation_count++;
    if (work->options->progress)
        work->options->progress(work->options->context, work->decor->operation_count, 0);
    return status;
}

static bool is_at_end(const MesoDecorWork *work)
{
    return work->options->step_limit > 0 && work->decor->operation_count >= work->options->step_limit;
}

MesoStatus meso_decor_run_steps(MesoDecorWork *work, const MesoStep *steps, uint32_t step_count,
                                const uint32_t *scopes, uint32_t scope_count, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < step_count && !status && !is_at_end(work); i++) {
        MesoTargets targets;
        MesoArenaMark mark = meso_arena_mark(work->scratch);
        work->normals = NULL;
        status = meso_decor_select(work, &steps[i].on, scopes, scope_count, &targets, error);
        if (!status && targets.count == 0)
            meso_decor_note(work, &steps[i], "no region is selected: nothing is done");
        else if (!status)
            status = run_on(work, &steps[i], &targets, error);
        if ((status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT) && !work->placed) {
            meso_fail_prefix(error, steps[i].place);
            work->placed = true;
        }
        meso_arena_rewind(work->scratch, mark);
    }
    return status;
}

static MesoStatus measure_faces(MesoDecorWork *work, MesoArena *arena, MesoError *error)
{
    const MesoTriangulation *mesh = &work->decor->mesh;
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        count = mesh->faces[t] >= count ? mesh->faces[t] + 1 : count;
    work->face_areas = MESO_NEW(arena, float, count, error);
    if (!work->face_areas)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        work->face_areas[mesh->faces[t]] = (float)meso_triangle_area(mesh, t);
    return MESO_OK;
}

static MesoStatus run_all(MesoDecorWork *work, MesoError *error)
{
    const uint32_t root = 0;
    MesoStatus status = meso_geodesic_init(&work->solver, &work->decor->mesh, work->options->engine, error);
    if (!status)
        status = meso_decor_refresh(work, error);
    if (!status)
        status = meso_decor_run_steps(work, work->pattern->steps, work->pattern->step_count, &root, 1, error);
    meso_geodesic_release(work->solver);
    return status;
}

MesoStatus meso_decor_run(MesoDecor *decor, MesoArena *arena, const MesoPattern *pattern,
                          const MesoDecorOptions *options, MesoError *error)
{
    MesoArena scratch;
    MesoDecorWork work = {.decor = decor, .pattern = pattern, .options = options, .scratch = &scratch};
    if (decor->mesh.triangle_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "the surface has no faces");
    MesoStatus status = meso_region_tree_init(&decor->tree, arena, &decor->mesh, error);
    if (status)
        return status;
    meso_arena_init(&scratch);
    meso_arena_init(&work.tables);
    work.tables_begin = meso_arena_mark(&work.tables);
    decor->arena = arena;
    status = measure_faces(&work, arena, error);
    if (!status)
        status = run_all(&work, error);
    free(work.field);
    free(work.other);
    meso_arena_release(&work.tables);
    meso_arena_release(&scratch);
    return status;
}
