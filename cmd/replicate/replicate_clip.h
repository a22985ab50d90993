/* The clip that details are on: its surface at rest as triangles, and each frame of it. */
#ifndef MESO_REPLICATE_CLIP_H
#define MESO_REPLICATE_CLIP_H

#include "cmd/replicate/replicate_arguments.h"
#include "formats/clip/clip_file.h"
#include "libcore/replicate/plan/replicate.h"

typedef struct MesoReplicateClip {
    MesoTool *tool;
    MesoClipFile *file;
    MesoPolygonMesh polygons;       /* as the file has them, where the frame is; without normals */
    MesoPolygonMesh triangles;      /* the same faces cut; at rest */
    MesoTriangulation rest;         /* owned, with `origins` by the polygons' vertices */
    uint32_t frame_count;           /* of the whole clip */
    int32_t number;                 /* of the frame that is loaded; -1: none */
    MesoVec3 *positions, *before;   /* [rest.vertex_count] of the frame, and of the one before it */
    MesoVec3 *normals;              /* [rest.vertex_count] of the frame */
    MesoClip clip;                  /* for replicate.h; shows these two */
} MesoReplicateClip;

/* Opens FRAMES, whose first frame, or else --mesh, is the surface at rest. MESO_ERR_INPUT where it is no manifold. */
MesoStatus meso_replicate_clip_open(MesoReplicateClip *clip, MesoReplicateArguments *arguments, const char *path);
void meso_replicate_clip_close(MesoReplicateClip *clip);

/* The number of a frame of the clip, from 0. */
int32_t meso_replicate_clip_number(const MesoReplicateClip *clip, uint32_t frame);

/* The frame of that number; MESO_ERR_INPUT where the clip has none. */
MesoStatus meso_replicate_clip_find(const MesoReplicateClip *clip, int32_t number, uint32_t *frame);

/* Loads a frame, and keeps the one that was loaded as the one before. MESO_ERR_INPUT as of clip_file.h. */
MesoStatus meso_replicate_clip_load(MesoReplicateClip *clip, uint32_t frame);

/* What files say of normals is so at rest alone. */
MesoStatus meso_replicate_drop_normals(MesoPolygonMesh *mesh, MesoTool *tool);

/* As if no frame had been loaded. */
static inline void meso_replicate_clip_rewind(MesoReplicateClip *clip) { clip->number = -1; }

/* Takes places as those of the frame before the next one. */
void meso_replicate_clip_resume(MesoReplicateClip *clip, const MesoVec3 *positions, int32_t number);

#endif
