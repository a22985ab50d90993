/* Sweeps that are made whenever they are wanted (MesoSweepMaker, in scene.h). */
#ifndef MESO_SWEEP_MAKER_H
#define MESO_SWEEP_MAKER_H

#include "libcore/scene/scene.h"

/* A sweep of a scene, whether it is stored or made. */
static inline MesoSweepInstance meso_scene_sweep(const MesoScene *scene, uint32_t sweep)
{
    MesoSweepInstance made;
    if (!scene->maker)
        return scene->sweeps[sweep];
    scene->maker->make(scene->maker->context, sweep, &made);
    return made;
}

static inline uint32_t meso_scene_sweep_ids(const MesoScene *scene, uint32_t sweep)
{
    return scene->maker ? scene->maker->ids(scene->maker->context, sweep) : scene->sweeps[sweep].ids;
}

/* The distance from its hull within which all of an instance of `kind` lies, where sections keep their shape. */
static inline float meso_made_reach(const MesoScene *scene, uint32_t kind, const MesoSweepInstance *sweep)
{
    float radius = scene->maker->kind_radii[kind], rise = MESO_CAP_RISE * scene->section_scale * sweep->size[0];
    return radius > rise ? radius : rise;
}

/* What holds bundle `bundle` of a scene that has been measured, whatever is rounded on the way. */
static inline MesoBox meso_scene_bundle_box(const MesoScene *scene, uint32_t bundle)
{
    const float rounding = 1e-6f;
    MesoBox box = scene->maker->bundle_boxes[bundle];
    float x = fmaxf(fabsf(box.low.x), fabsf(box.high.x)), y = fmaxf(fabsf(box.low.y), fabsf(box.high.y));
    return meso_box_wider(box, rounding * (x + y + fmaxf(fabsf(box.low.z), fabsf(box.high.z))));
}

/* Workers that meso_scene_each_bundle() has at most. */
enum { MESO_BUNDLE_WORKERS = 64 };

/*
 * Makes the hulls of all bundles of a scene that has a maker, on its threads, and calls `body` with each; no two at
 * once with the same worker, below MESO_BUNDLE_WORKERS.
 */
void meso_scene_each_bundle(const MesoScene *scene, void *context,
                            void (*body)(void *context, uint32_t worker, uint32_t bundle, const MesoMadeSweep *made,
                                         uint32_t count));

#endif
