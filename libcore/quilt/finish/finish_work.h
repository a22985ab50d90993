/* What the steps at the end of a quilt share. */
#ifndef MESO_FINISH_WORK_H
#define MESO_FINISH_WORK_H

#include "libcore/quilt/finish/quilt_finish.h"

typedef struct MesoFinishWork {
    const MesoQuiltBase *base;
    const MesoSwatch *swatch;
    const MesoFinishOptions *options;
    bool levelled;              /* strands are at the heights of the swatch, but for what joins need */
    MesoVec3 *normals;          /* [base->mesh.vertex_count] unit */
    uint32_t vertex_count, triangle_count, vertex_room, triangle_room;
    MesoQuiltVertex *vertices;  /* [vertex_count] over base->mesh; these and what follows may be the quilt's own */
    uint32_t *origins;          /* [vertex_count] vertex of the swatch */
    uint8_t *at_border;         /* [vertex_count] 1: the border has made it */
    uint32_t *corners;          /* [3 * triangle_count] */
    uint32_t *triangle_origins; /* [triangle_count] triangle of the swatch */
    uint32_t *patches;          /* [triangle_count] */
    uint32_t *elements;         /* [triangle_count] element of the quilt before */
    MesoQuiltReport *report;
    MesoArena *arena;           /* of all this */
} MesoFinishWork;

/* Room for so many in all; what is there stays. MESO_ERR_LIMIT, MESO_ERR_MEMORY. */
MesoStatus meso_finish_reserve(MesoFinishWork *work, uint64_t vertex_count, uint64_t triangle_count, MesoError *error);

/* There has to be room. */
uint32_t meso_finish_add_vertex(MesoFinishWork *work, MesoQuiltVertex vertex, uint32_t origin, bool at_border);
void meso_finish_add_triangle(MesoFinishWork *work, const uint32_t *corners, uint32_t origin, uint32_t patch,
                              uint32_t element);

/* ---- places ---- */

/* The foot of a vertex on the surface, and the vertex itself. */
MesoVec3 meso_finish_foot(const MesoFinishWork *work, MesoQuiltVertex vertex);
MesoVec3 meso_finish_point(const MesoFinishWork *work, MesoQuiltVertex vertex);

/* In the triangle of the original. */
MesoQuiltVertex meso_finish_original(const MesoFinishWork *work, MesoQuiltVertex vertex);

/* Walks from a triangle towards a point near the surface; at an end of the surface, to the nearest place there. */
MesoQuiltVertex meso_finish_locate(const MesoFinishWork *work, uint32_t triangle, MesoVec3 foot, float height);

/* base->inside at a place; 1 where there is no border. */
float meso_finish_inside(const MesoFinishWork *work, MesoQuiltVertex vertex);

/* ---- steps ---- */

/* Moves strands along the surface to where they lie around each other as in the swatch, as far as joins allow, but not
 * where the swatch has whole elements that grow from none; gives strands the sections that they have in the swatch, and
 * its heights, but for what joins need. Nothing moves where all is as it should be along the surface. */
MesoStatus meso_finish_relax(MesoQuilt *quilt, MesoFinishWork *work, MesoError *error);

/* Takes over what a quilt has on this side of the borders: its very arrays where there are none. */
MesoStatus meso_finish_cut(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error);

/* Closes loops of open edges. */
MesoStatus meso_finish_close(MesoFinishWork *work, MesoError *error);

/* Takes slow drifts of height out of strands that are not levelled yet, and all of them out of whole elements, before
 * strands are closed. `quilt`: what it was before. */
MesoStatus meso_finish_level(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error);

/* Parts strands that run through each other where they cross, by their heights. */
MesoStatus meso_finish_part(MesoFinishWork *work, MesoError *error);

/* Makes the quilt of what there is, but for small pieces. */
MesoStatus meso_finish_gather(MesoQuilt *quilt, MesoArena *arena, MesoFinishWork *work, MesoError *error);

#endif
