/* The box around a scene. */
#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/placed.h"
#include "libcore/scene/sweep_maker.h"

/* A cap's own control points reach as high as it rises. */
static void add_kind(MesoBox *box, const MesoScene *scene, const MesoSweptKind *kind)
{
    float radius = meso_scene_kind_radius(scene, kind);
    for (uint32_t i = 0; i < kind->instance_count; i++) {
        MesoSweepHull hull = meso_sweep_hull(scene, &scene->sweeps[kind->instance_begin + i], radius);
        for (uint32_t k = 0; k < hull.count; k++)
            meso_box_add_around(box, hull.points[k], hull.reach);
    }
}

/* Boxes of kinds, one a worker. */
typedef struct KindBoxes {
    const MesoScene *scene;
    MesoBox boxes[MESO_BUNDLE_WORKERS];
} KindBoxes;

static void add_kinds(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    KindBoxes *all = context;
    for (uint64_t k = begin; k < end; k++)
        add_kind(&all->boxes[worker], all->scene, &all->scene->kinds[k]);
}

static void add_all_kinds(MesoBox *box, const MesoScene *scene, uint32_t thread_count)
{
    enum { KINDS_A_RANGE = 64, SWEEPS_LEAST = 1 << 14 };    /* fewer are done before a thread has begun */
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    workers = scene->sweep_count < SWEEPS_LEAST ? 1 : workers < MESO_BUNDLE_WORKERS ? workers : MESO_BUNDLE_WORKERS;
    KindBoxes all = {.scene = scene};
    for (uint32_t w = 0; w < workers; w++)
        all.boxes[w] = meso_box_empty();
    meso_parallel_team(workers, scene->kind_count, KINDS_A_RANGE, add_kinds, &all);
    for (uint32_t w = 0; w < workers; w++)
        meso_box_join(box, &all.boxes[w]);
}

/* Boxes of what is made, one a worker. */
typedef struct MadeBoxes {
    const MesoScene *scene;
    MesoBox boxes[MESO_BUNDLE_WORKERS];
} MadeBoxes;

/* Sections keep their shape: the hull is that of the control points, and reaches as far around each. */
static void add_bundle(void *context, uint32_t worker, uint32_t bundle, const MesoMadeSweep *made, uint32_t count)
{
    MadeBoxes *all = context;
    const MesoSweepMaker *maker = all->scene->maker;
    MesoBox around = meso_box_empty();
    for (uint32_t i = 0; i < count; i++) {
        MesoBox hull = meso_box_of(made[i].instance.p, 4);
        if (!(hull.low.x <= hull.high.x))
            continue;
        MesoBox box = meso_box_wider(hull, maker->kind_radii[made[i].kind]);
        meso_box_join(&all->boxes[worker], &box);
        box = meso_box_wider(hull, meso_made_reach(all->scene, made[i].kind, &made[i].instance));
        meso_box_join(&around, &box);
    }
    maker->bundle_boxes[bundle] = around;
}

static void add_made(MesoBox *box, const MesoScene *scene)
{
    MadeBoxes all = {.scene = scene};
    for (uint32_t w = 0; w < MESO_BUNDLE_WORKERS; w++)
        all.boxes[w] = meso_box_empty();
    meso_scene_each_bundle(scene, &all, add_bundle);
    for (uint32_t w = 0; w < MESO_BUNDLE_WORKERS; w++)
        meso_box_join(box, &all.boxes[w]);
}

static void add_placed(MesoBox *box, const MesoScene *scene, const MesoPlacedBody *placed)
{
    const MesoBody *body = &scene->bodies[placed->body];
    if (placed->place == MESO_PLACED_IN_CAGE) {
        const MesoCage *cage = &scene->cages[placed->cage];
        for (uint32_t i = 0; i < 8; i++)
            meso_box_add(box, meso_cage_point(cage, (float)(i & 1), (float)(i >> 1 & 1), (float)(i >> 2)));
        return;
    }
    for (uint32_t v = 0; v < body->vertex_count; v++)
        meso_box_add(box, meso_placed_point(scene, placed, body->positions[v]));
}

void meso_scene_measure_by(MesoScene *scene, uint32_t thread_count)
{
    scene->box = meso_box_empty();
    if (scene->maker)
        add_made(&scene->box, scene);
    else
        add_all_kinds(&scene->box, scene, thread_count);
    for (uint32_t i = 0; i < scene->placed_count; i++)
        add_placed(&scene->box, scene, &scene->placed[i]);
}

void meso_scene_measure(MesoScene *scene)
{
    meso_scene_measure_by(scene, 1);
}
