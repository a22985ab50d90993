/*
 * Models (.meso) as scenes: an envelope with the provenance and the chunks of one method, known by a chunk of
 * its own: 'tiles' (model_file.h) or 'body' (model_body.h). Quilts (.quilt) are read as models too.
 */
#ifndef MESO_MODEL_SCENE_H
#define MESO_MODEL_SCENE_H

#include "formats/file/input.h"
#include "libcore/scene/scene.h"
#include "libcore/tiling/relax/relax.h"

typedef struct MesoSceneReading {
    uint32_t thread_count;
    /* May change the mapping options that a tiling was stored with; NULL: they stay. One whose trajectories or sections
     * change is relaxed anew, if it is. */
    void (*remap)(void *context, MesoMapOptions *options);
    void *context;
    uint32_t stored_sweeps;     /* a tiling of more has a maker of them (sweep_maker.h), if that may be; 0: none has */
    /* Where a quilt's surface has moved to (quilt_move.h), and the file that it was read from; or NULL. */
    const MesoPolygonMesh *surface;
    const MesoInput *surface_input;
    const char *embedding;      /* how it lies over it, of MESO_QUILT_EMBEDDING_NAMES; NULL: as the quilt says */
    MesoRelaxReport relaxed;    /* gets what the relaxation did, where that was done anew; else all 0 */
    const MesoModel *tiling;    /* gets the model, in the arena, where it is one of tiles; else NULL */
    bool quilt;                 /* gets whether it is one */
    const char *provenance;     /* gets the provenance, in the arena */
} MesoSceneReading;

/*
 * Reads, checks and expands a model of any method. The scene points into `arena` and into `input`, which must
 * stay open. MESO_ERR_INPUT with the file's name, also where it holds no method that is known here.
 */
MesoStatus meso_scene_read(MesoScene *scene, MesoArena *arena, const MesoInput *input, MesoSceneReading *reading,
                           MesoError *error);

#endif
