#include "libcore/render/raster/shape_bodies.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/placed.h"

typedef struct Moving {
    const MesoScene *scene;
    const uint32_t *which;
    MesoVec3 **positions, **normals;
    bool failed;
} Moving;

static void move_bodies(void *context, uint64_t begin, uint64_t end)
{
    Moving *m = context;
    for (uint64_t i = begin; i < end; i++) {
        const MesoPlacedBody *placed = &m->scene->placed[m->which[i]];
        uint32_t count = m->scene->bodies[placed->body].vertex_count;
        MesoMeshVertex *vertices = malloc((count ? count : 1) * sizeof *vertices);
        if (!vertices) {
            __atomic_store_n(&m->failed, true, __ATOMIC_RELAXED);
            continue;
        }
        meso_placed_vertices(m->scene, placed, vertices);
        for (uint32_t v = 0; v < count; v++) {
            m->positions[i][v] = vertices[v].position;
            m->normals[i][v] = vertices[v].normal;
        }
        free(vertices);
    }
}

MesoStatus meso_shape_bodies(MesoShapeBodies *bodies, MesoArena *arena, const MesoScene *scene, uint32_t thread_count,
                             MesoError *error)
{
    uint32_t *which = MESO_NEW(arena, uint32_t, scene->placed_count, error), moved = 0;
    MesoVec3 **positions = MESO_NEW(arena, MesoVec3 *, scene->placed_count, error);
    MesoVec3 **normals = MESO_NEW(arena, MesoVec3 *, scene->placed_count, error);
    bodies->positions = MESO_NEW(arena, const MesoVec3 *, scene->placed_count, error);
    bodies->normals = MESO_NEW(arena, const MesoVec3 *, scene->placed_count, error);
    bodies->mirrored = MESO_NEW(arena, bool, scene->placed_count, error);
    if (!which || !positions || !normals || !bodies->positions || !bodies->normals || !bodies->mirrored)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const MesoPlacedBody *placed = &scene->placed[i];
        const MesoBody *body = &scene->bodies[placed->body];
        bodies->positions[i] = body->positions;
        bodies->normals[i] = body->normals;
        if (placed->place == MESO_PLACED_HERE)
            continue;
        bodies->mirrored[i] = meso_placed_is_mirrored(scene, placed);
        positions[moved] = MESO_NEW(arena, MesoVec3, body->vertex_count, error);
        normals[moved] = MESO_NEW(arena, MesoVec3, body->vertex_count, error);
        if (!positions[moved] || !normals[moved])
            return MESO_ERR_MEMORY;
        bodies->positions[i] = positions[moved];
        bodies->normals[i] = normals[moved];
        which[moved++] = i;
    }
    Moving m = {scene, which, positions, normals, false};
    meso_parallel_for(thread_count, moved, 16, move_bodies, &m);
    return m.failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the bodies") : MESO_OK;
}
