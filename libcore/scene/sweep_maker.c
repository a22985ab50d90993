#include "libcore/scene/sweep_maker.h"

#include "libcore/base/parallel.h"

typedef struct Bundles {
    const MesoSweepMaker *maker;
    void *context;
    void (*body)(void *context, uint32_t worker, uint32_t bundle, const MesoMadeSweep *made, uint32_t count);
} Bundles;

static void make_all_hulls(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    const Bundles *b = context;
    MesoMadeSweep made[MESO_BUNDLE_SWEEPS];
    for (uint64_t bundle = begin; bundle < end; bundle++) {
        uint32_t count = b->maker->make_hulls(b->maker->context, (uint32_t)bundle, made);
        b->body(b->context, worker, (uint32_t)bundle, made, count);
    }
}

void meso_scene_each_bundle(const MesoScene *scene, void *context,
                            void (*body)(void *context, uint32_t worker, uint32_t bundle, const MesoMadeSweep *made,
                                         uint32_t count))
{
    const MesoSweepMaker *maker = scene->maker;
    uint32_t workers = maker->thread_count ? maker->thread_count : meso_parallel_cores();
    Bundles bundles = {maker, context, body};
    workers = workers < MESO_BUNDLE_WORKERS ? workers : MESO_BUNDLE_WORKERS;
    meso_parallel_team(workers, maker->bundle_count, 256, make_all_hulls, &bundles);
}
