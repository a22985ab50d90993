/*
 * Shapes in GL buffers, and the calls that draw them: what a GPU is given, whose shaders bend the sweeps.
 */
#ifndef MESO_DRAW_LISTS_H
#define MESO_DRAW_LISTS_H

#include "libcore/render/gl/gl_functions.h"
#include "libcore/render/projection.h"
#include "libcore/render/raster/shapes.h"
#include "libcore/scene/sweep.h"

/* Instances of one kind share a pattern of columns and rings. */
typedef struct MesoDrawSweep {
    uint32_t kind;
    uint32_t base_vertex, index_begin, index_count;
    uint32_t instance_begin, instance_count;    /* of those selected */
    float reach;            /* how far the kind's surface lies from its control points, as of meso_sweep_hull() */
    MesoKindReach profiles;
} MesoDrawSweep;

typedef struct MesoDrawLists {
    const MesoGl *gl;
    const MesoShapes *shapes;   /* all in GL is relative to their anchor */
    uint32_t sweep_count, body_index_count;
    MesoDrawSweep *sweeps;
    GLuint pattern_vertices, pattern_indices, instances, cages, sweep_array;
    MesoSweepInstance *selected;        /* [sweep_count of the scene] scratch of meso_draw_lists_select() */
    GLuint body_vertices, body_indices, body_array;
} MesoDrawLists;

/* Programs that draw the three sorts of geometry. */
typedef struct MesoDrawPrograms {
    GLuint sweep, cap, body;
    bool creased;               /* the first of them knows creases */
} MesoDrawPrograms;

/*
 * Uploads the shapes' scene, thinned so that the picture of `view`, `height` pixels high, changes by less than
 * `tolerance_pixels` (0: not thinned). The tables go to `arena`. After a failure the lists are empty.
 */
MesoStatus meso_draw_lists_init(MesoDrawLists *lists, MesoArena *arena, const MesoGl *gl, const MesoShapes *shapes,
                                const MesoView *view, uint32_t height, float tolerance_pixels, MesoError *error);
void meso_draw_lists_release(MesoDrawLists *lists);

/* For what `scene` has: sections that deform, creases. `detailed`: fragments have uv and colour too. */
MesoStatus meso_draw_programs_init(MesoDrawPrograms *programs, const MesoGl *gl, const MesoScene *scene, bool detailed,
                                   MesoError *error);
void meso_draw_programs_release(MesoDrawPrograms *programs, const MesoGl *gl);

/*
 * Selects the sweeps that `clip_from_world` may show for the draws to come: those whose hull meets its frustum. Bodies
 * are always drawn. O(sweeps).
 */
void meso_draw_lists_select(MesoDrawLists *lists, const MesoMatrix *clip_from_world);

/* Draws what is selected to the bound framebuffer: shape, depth along `view`, normal, place along the shape. */
void meso_draw_lists_draw(const MesoDrawLists *lists, const MesoDrawPrograms *programs,
                          const MesoMatrix *clip_from_world, const MesoView *view);

#endif
