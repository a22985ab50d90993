/*
 * Parts: the polygons of a scene, part by part, so that a writer holds only a
 * window of them. A part is one sweep or one placed body; parts are numbered
 * sweeps first, in the order of the scene, so that those of one kind lie
 * together.
 */
#ifndef MESO_PARTS_H
#define MESO_PARTS_H

#include "libcore/scene/scene.h"

typedef struct MesoPart {
    uint32_t ids;       /* row of the scene's ids */
    uint32_t material;
} MesoPart;

typedef struct MesoSceneParts {
    const MesoScene *scene;
    uint32_t part_count;
    uint64_t *vertex_begin;     /* [part_count + 1] */
    uint64_t *face_begin;       /* [part_count + 1] */
    uint64_t triangle_count;    /* with quads as two */
} MesoSceneParts;

/* Counts everything; makes no vertices yet. O(parts + faces of bodies). MESO_ERR_LIMIT beyond 2^32 parts. */
MesoStatus meso_scene_parts_init(MesoSceneParts *parts, MesoArena *arena, const MesoScene *scene,
                                 MesoError *error);

MesoPart meso_scene_part(const MesoSceneParts *parts, uint32_t part);

/*
 * Vertices of the parts [begin, end), in order, to `out`, which holds
 * vertex_begin[end] - vertex_begin[begin] of them, and as many colours; and
 * their faces, whose indices count from the first vertex of part `begin` plus
 * `base`. Threads may call these for different ranges; the results do not
 * depend on the ranges.
 */
void meso_scene_vertices(const MesoSceneParts *parts, uint32_t begin, uint32_t end, MesoMeshVertex *out);
void meso_scene_colors(const MesoSceneParts *parts, uint32_t begin, uint32_t end, MesoMeshColor *out);
void meso_scene_faces(const MesoSceneParts *parts, uint32_t begin, uint32_t end, uint32_t base,
                      MesoMeshFace *out);

/*
 * Box around all vertices, by making them. MESO_ERR_INPUT names the part, by
 * its id in the first channel, where a vertex is not finite. O(vertices).
 */
MesoStatus meso_scene_parts_box(const MesoSceneParts *parts, uint32_t thread_count, MesoBox *box,
                                MesoError *error);

#endif
