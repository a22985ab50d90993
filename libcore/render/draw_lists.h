/* A scene's geometry in GL buffers, and the calls that draw it. */
#ifndef MESO_DRAW_LISTS_H
#define MESO_DRAW_LISTS_H

#include "libcore/render/gl_functions.h"
#include "libcore/render/projection.h"
#include "libcore/scene/scene.h"

/* Instances of one kind share a pattern of columns and rings. */
typedef struct MesoDrawSweep {
    uint32_t kind;
    uint32_t base_vertex, index_begin, index_count;
    uint32_t instance_begin, instance_count;    /* of those selected */
    float reach;            /* how far the kind's surface lies from its control points, as of meso_sweep_hull() */
} MesoDrawSweep;

/* Consecutive placed bodies of one material. */
typedef struct MesoDrawBodies {
    uint32_t material;
    uint32_t index_begin, index_count;
} MesoDrawBodies;

typedef struct MesoDrawLists {
    const MesoGl *gl;
    const MesoScene *scene;
    uint32_t sweep_count, bodies_count;
    MesoDrawSweep *sweeps;
    MesoDrawBodies *bodies;
    MesoScene near;             /* the scene, with sweeps or cages relative to the view's anchor, as all in GL */
    GLuint pattern_vertices, pattern_indices, instances, cages, sweep_array;
    MesoSweepInstance *selected;        /* [sweep_count of the scene] scratch of meso_draw_lists_select() */
    GLuint body_vertices, body_indices, body_array;
} MesoDrawLists;

/* Programs that draw the three sorts of geometry for one purpose. */
typedef struct MesoDrawPrograms {
    GLuint sweep, cap, body;
} MesoDrawPrograms;

/*
 * Uploads `scene`, thinned so that the picture of `view`, `height` pixels high, changes by less than
 * `tolerance_pixels` (0: not thinned). The tables go to `arena`. After a failure the lists are empty.
 */
MesoStatus meso_draw_lists_init(MesoDrawLists *lists, MesoArena *arena, const MesoGl *gl,
                                const MesoScene *scene, const MesoView *view, uint32_t height,
                                float tolerance_pixels, MesoError *error);
void meso_draw_lists_release(MesoDrawLists *lists);

/* What the fragments write. */
typedef enum MesoDrawPurpose {
    MESO_DRAW_SURFACE,      /* the targets of MesoSurfaceTarget */
    MESO_DRAW_PACKED,       /* normal and material in one */
    MESO_DRAW_DEPTH         /* depth alone */
} MesoDrawPurpose;

/* For what `scene` has: bodies with colours of their own, sections that deform. */
MesoStatus meso_draw_programs_init(MesoDrawPrograms *programs, const MesoGl *gl, MesoDrawPurpose purpose,
                                   const MesoScene *scene, MesoError *error);
void meso_draw_programs_release(MesoDrawPrograms *programs, const MesoGl *gl);

/*
 * Selects the sweeps that `clip_from_world` may show for the draws to come: those
 * whose bounding sphere meets its frustum. NULL selects all. Bodies are always
 * drawn. O(sweeps).
 */
void meso_draw_lists_select(MesoDrawLists *lists, const MesoMatrix *clip_from_world);

/*
 * Draws what is selected to the bound framebuffer. Where `view` is not NULL the
 * fragments get their depth along it and the materials.
 */
void meso_draw_lists_draw(const MesoDrawLists *lists, const MesoDrawPrograms *programs,
                          const MesoMatrix *clip_from_world, const MesoView *view);

#endif
