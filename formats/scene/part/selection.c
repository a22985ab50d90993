#include "formats/scene/part/selection.h"

static bool is_selected(const MesoSceneParts *whole, const MesoSelectionRule *rule, uint32_t part)
{
    if (rule->shard_count > 0) {
        uint64_t total = whole->vertex_begin[whole->part_count], middle = whole->vertex_begin[part];
        unsigned __int128 share = (unsigned __int128)middle * rule->shard_count;
        return total > 0 && (uint32_t)(share / total) == rule->shard;
    }
    const MesoScene *scene = whole->scene;
    uint32_t id = scene->channel_count ? meso_scene_id(scene, meso_scene_part(whole, part).ids, 0) : part;
    return id >= rule->low && id <= rule->high;
}

/* `selection` with `runs` NULL only counts them. */
static void list_runs(MesoSelection *selection, const MesoSceneParts *whole, const MesoSelectionRule *rule)
{
    bool inside = false;
    selection->run_count = 0;
    for (uint32_t part = 0; part < whole->part_count; part++) {
        bool selected = is_selected(whole, rule, part);
        if (selected && !inside)
            selection->run_count++;
        inside = selected;
        if (!selected || !selection->runs)
            continue;
        MesoSelectedRun *run = &selection->runs[selection->run_count - 1];
        if (run->part_count++ == 0)
            *run = (MesoSelectedRun){part, 1, whole->vertex_begin[part], 0, whole->face_begin[part], 0};
        run->vertex_count = whole->vertex_begin[part + 1] - run->vertex;
        run->face_count = whole->face_begin[part + 1] - run->face;
    }
}

static void copy_sweeps(MesoScene *scene, const MesoSceneParts *whole, const MesoSelectionRule *rule)
{
    const MesoScene *from = whole->scene;
    scene->sweep_count = 0;
    for (uint32_t k = 0; k < from->kind_count; k++) {
        const MesoSweptKind *kind = &from->kinds[k];
        scene->kinds[k] = *kind;
        scene->kinds[k].instance_begin = scene->sweep_count;
        for (uint32_t i = 0; i < kind->instance_count; i++)
            if (is_selected(whole, rule, kind->instance_begin + i))
                scene->sweeps[scene->sweep_count++] = from->sweeps[kind->instance_begin + i];
        scene->kinds[k].instance_count = scene->sweep_count - scene->kinds[k].instance_begin;
    }
}

static void copy_placed(MesoScene *scene, const MesoSceneParts *whole, const MesoSelectionRule *rule)
{
    scene->placed_count = 0;
    for (uint32_t i = 0; i < whole->scene->placed_count; i++)
        if (is_selected(whole, rule, whole->scene->sweep_count + i))
            scene->placed[scene->placed_count++] = whole->scene->placed[i];
}

MesoStatus meso_selection_make(MesoSelection *selection, MesoArena *arena, const MesoSceneParts *whole,
                               const MesoSelectionRule *rule, MesoError *error)
{
    const MesoScene *from = whole->scene;
    *selection = (MesoSelection){.scene = *from, .part_count = whole->part_count,
                                 .vertex_count = whole->vertex_begin[whole->part_count],
                                 .face_count = whole->face_begin[whole->part_count]};
    MesoScene *scene = &selection->scene;
    list_runs(selection, whole, rule);
    if (selection->run_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "nothing is selected of %u parts", whole->part_count);
    selection->runs = MESO_NEW(arena, MesoSelectedRun, selection->run_count, error);
    scene->kinds = MESO_NEW(arena, MesoSweptKind, from->kind_count, error);
    scene->sweeps = MESO_NEW(arena, MesoSweepInstance, from->sweep_count, error);
    scene->placed = MESO_NEW(arena, MesoPlacedBody, from->placed_count, error);
    if (!selection->runs || !scene->kinds || !scene->sweeps || !scene->placed)
        return MESO_ERR_MEMORY;
    list_runs(selection, whole, rule);
    copy_sweeps(scene, whole, rule);
    copy_placed(scene, whole, rule);
    return MESO_OK;
}
