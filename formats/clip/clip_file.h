/*
 * Clips: the frames of one mesh that moves, whatever files they are in.
 *
 *     body-%04d.obj       numbered meshes of any kind that is read, all with the same faces
 *     body.pc2, body.mdd  a cache of positions, with a mesh that has the faces
 *     body.glb            an animation, sampled (gltf_clip.h)
 *
 * Positions are in the order of the rest mesh's vertices, which is that of its file, without those that were welded to
 * an earlier one. Where the mesh has become a
 * triangulation, vertex v of that is vertex origins[v] of the mesh (triangulation.h).
 */
#ifndef MESO_CLIP_FILE_H
#define MESO_CLIP_FILE_H

#include "formats/clip/frame_list.h"
#include "formats/file/input.h"
#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoClipFile MesoClipFile;

typedef struct MesoClipSource {
    const char *path;               /* as above */
    const char *rest;               /* file of the mesh at rest; NULL: the first frame, where it has faces */
    const MesoFrameList *frames;    /* NULL: all that there are. Of one file they are counted from 1 */
    double frames_per_second;       /* of an animation; 0: 24 */
    uint32_t thread_count;          /* for the mesh at rest and what is not read ahead; 0: all cores */
    bool weld;                      /* vertices in one place at rest become one: glTF splits them at seams */
    bool ahead;                     /* reads the next frame while this one is used: two are held, and not one */
} MesoClipSource;

/*
 * Opens a clip and reads its mesh at rest; the frames are read when they are asked for. `frames` is copied.
 * MESO_ERR_USAGE for a path that is no clip, and a cache without a mesh; MESO_ERR_INPUT for a mesh and a cache that do
 * not fit, a frame that a file does not have, and, where `frames` is NULL, no frames or the first that is missing
 * between others; else what
 * mesh_read.h, point_cache.h and gltf_clip.h say.
 */
MesoStatus meso_clip_open(MesoClipFile **clip, const MesoClipSource *source, MesoError *error);

/* NULL is allowed. */
void meso_clip_release(MesoClipFile *clip);

/* The mesh at rest, with its attributes; those that differ along seams are of corners where it was welded. */
const MesoPolygonMesh *meso_clip_mesh(const MesoClipFile *clip);

/* The file that it is from, for messages about its faces; open until the clip is released. */
const MesoInput *meso_clip_mesh_input(const MesoClipFile *clip);

uint32_t meso_clip_frame_count(const MesoClipFile *clip);

/* The frame's number among the files, or in the cache. */
int32_t meso_clip_frame_number(const MesoClipFile *clip, uint32_t frame);

/*
 * Positions of a frame, from 0 to meso_clip_frame_count() - 1, in any order: [vertex_count] of the mesh, until the next
 * call. NULL with MESO_ERR_INPUT for a file that is missing, names the first vertex that is not finite, or the first
 * face that is another than at rest. O(size of the frame's file). Not to be called from two threads on one clip.
 */
const MesoVec3 *meso_clip_place_frame(MesoClipFile *clip, uint32_t frame, MesoError *error);

#endif
