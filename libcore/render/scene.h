/* A structure's geometry in GL buffers, and the calls that draw it. */
#ifndef MESO_DRAW_SCENE_H
#define MESO_DRAW_SCENE_H

#include "libcore/render/gl_functions.h"
#include "libcore/render/projection.h"

/* Instances of one kind share a pattern of columns and rings. */
typedef struct MesoDrawSweep {
    uint32_t kind;
    uint32_t base_vertex, index_begin, index_count;
    uint32_t instance_begin, instance_count;    /* of those selected */
    float reach;            /* how far the kind's surface lies from its control points, scene units */
} MesoDrawSweep;

/* Consecutive inner meshes of one tile and material. */
typedef struct MesoDrawInner {
    uint32_t tile, material;
    uint32_t base_vertex, index_begin, index_count;
} MesoDrawInner;

typedef struct MesoScene {
    const MesoGl *gl;
    const MesoStructure *structure;
    uint32_t sweep_count, inner_count;
    MesoDrawSweep *sweeps;
    MesoDrawInner *inners;
    MesoVec3 low, high;                 /* bounds, relative to the view's anchor as all in GL */
    const MesoSweepInstance *placed;    /* [instance_count] of the structure, likewise */
    GLuint pattern_vertices, pattern_indices, instances, sweep_array;
    MesoSweepInstance *selected;        /* [instance_count] scratch of meso_scene_select() */
    GLuint inner_vertices, inner_indices, inner_array;
} MesoScene;

/* Programs that draw the three sorts of geometry for one purpose. */
typedef struct MesoScenePrograms {
    GLuint sweep, cap, inner;
} MesoScenePrograms;

/*
 * Uploads `structure`, thinned so that the picture of `view`, `height` pixels
 * high, changes by less than `tolerance_pixels` (0: not thinned). The scene's
 * tables go to `arena`. After a failure the scene is empty.
 */
MesoStatus meso_scene_init(MesoScene *scene, MesoArena *arena, const MesoGl *gl,
                           const MesoStructure *structure, const MesoView *view, uint32_t height,
                           float tolerance_pixels, MesoError *error);
void meso_scene_release(MesoScene *scene);

/* What the fragments write. */
typedef enum MesoScenePurpose {
    MESO_DRAW_SURFACE,      /* the targets of MesoSurfaceTarget */
    MESO_DRAW_PACKED,       /* normal and material in one */
    MESO_DRAW_DEPTH         /* depth alone */
} MesoScenePurpose;

MesoStatus meso_scene_programs_init(MesoScenePrograms *programs, const MesoGl *gl,
                                    MesoScenePurpose purpose, MesoError *error);
void meso_scene_programs_release(MesoScenePrograms *programs, const MesoGl *gl);

/*
 * Selects the sweeps that `clip_from_world` may show for the draws to come: those
 * whose bounding sphere meets its frustum. NULL selects all. Inner meshes are
 * always drawn. O(instances).
 */
void meso_scene_select(MesoScene *scene, const MesoMatrix *clip_from_world);

/*
 * Draws what is selected to the bound framebuffer. Where `view` is not NULL the
 * fragments get their depth along it and the materials.
 */
void meso_scene_draw(const MesoScene *scene, const MesoScenePrograms *programs,
                     const MesoMatrix *clip_from_world, const MesoView *view);

#endif
