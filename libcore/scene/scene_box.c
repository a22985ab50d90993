/* The box around a scene. */
#include "libcore/scene/cell.h"
#include "libcore/scene/placed.h"

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

void meso_scene_measure(MesoScene *scene)
{
    scene->box = meso_box_empty();
    for (uint32_t k = 0; k < scene->kind_count; k++)
        add_kind(&scene->box, scene, &scene->kinds[k]);
    for (uint32_t i = 0; i < scene->placed_count; i++)
        add_placed(&scene->box, scene, &scene->placed[i]);
}
