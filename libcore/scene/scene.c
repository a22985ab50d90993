#include "libcore/scene/scene.h"

const char *const meso_frame_rule_names[] = {"paper", "minimal", NULL};
const char *const meso_sweep_deform_names[] = {"curves", "shape", NULL};

uint32_t meso_scene_kind(const MesoScene *scene, uint32_t sweep)
{
    uint32_t low = 0, high = scene->kind_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (scene->kinds[middle].instance_begin <= sweep)
            low = middle;
        else
            high = middle;
    }
    return low;
}

float meso_scene_kind_size(const MesoScene *scene, const MesoSweptKind *kind)
{
    float size = 0;
    if (scene->maker)
        return scene->maker->kind_sizes[kind - scene->kinds];
    for (uint32_t i = 0; i < kind->instance_count; i++) {
        const MesoSweepInstance *sweep = &scene->sweeps[kind->instance_begin + i];
        for (uint32_t end = 0; end < 2; end++)      /* fmaxf() is a call */
            size = sweep->size[end] > size ? sweep->size[end] : size;
    }
    return size;
}

float meso_scene_kind_radius(const MesoScene *scene, const MesoSweptKind *kind)
{
    float radius = 0;
    if (scene->maker && scene->maker->kind_radii)
        return scene->maker->kind_radii[kind - scene->kinds];
    for (uint32_t c = 0; c < kind->column_count; c++) {
        const MesoSweepColumn *column = &scene->columns[kind->column_begin + c];
        radius = fmaxf(radius, fmaxf(meso_vec2_length(column->start), meso_vec2_length(column->end)));
    }
    return radius * meso_scene_kind_size(scene, kind) * scene->section_scale;
}

bool meso_scene_is_colored(const MesoScene *scene)
{
    for (uint32_t i = 0; i < scene->body_count; i++)
        if (scene->bodies[i].colors)
            return true;
    return false;
}
