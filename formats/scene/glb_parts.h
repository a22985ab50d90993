/* What the writers of GLB share: runs of parts by material, and the JSON part of the file. */
#ifndef MESO_GLB_PARTS_H
#define MESO_GLB_PARTS_H

#include "formats/scene/draco_mesh.h"
#include "formats/scene/mesh_window.h"

/* A range of parts of one material. */
typedef struct MesoGlbRun {
    MesoPartRange range;
    uint32_t material;
    uint64_t face_count;
} MesoGlbRun;

/*
 * The parts that have faces, in runs of one material that go over `most_faces` only where one part does. Runs of one
 * material lie next to each other in `*runs` [*count], in the order of the parts otherwise. O(parts).
 */
MesoStatus meso_glb_runs(MesoGlbRun **runs, uint32_t *count, const MesoSceneParts *parts, uint64_t most_faces,
                         MesoArena *arena, MesoError *error);

/* Triangles of one material, which share no vertex with others. */
typedef struct MesoGlbPrimitive {
    uint32_t material;
    uint64_t vertex_count, triangle_count;
    MesoVec3 low, high;             /* box of the positions */
    uint64_t vertices_at;           /* offset in the binary part: rows of vertices, or what Draco made */
    uint64_t indices_at;            /* 32 bits each; not with Draco */
    const MesoDracoResult *draco;   /* NULL: plain */
} MesoGlbPrimitive;

/* Bytes of one vertex, plain: as in MesoMeshVertex, its colour where the scene has some, 4 an id, and what the options
 * have of lengths and tangents. */
uint32_t meso_glb_stride(const MesoScene *scene, const MesoMeshWriteOptions *options);

/*
 * The JSON part: a root, below it a node with a mesh for each material, and in it the primitives [count], of which
 * those of one material lie next to each other. `size` is that of the binary part. Padded with spaces to 4 bytes;
 * NULL with `error` filled.
 */
const char *meso_glb_json(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          const MesoGlbPrimitive *primitives, uint32_t count, uint64_t size, MesoArena *arena,
                          MesoError *error);

enum { MESO_GLB_HEAD = 20, MESO_GLB_BINARY_HEAD = 8 };

/* Heads of the file with its JSON part, and of the binary part. MESO_ERR_LIMIT where the file would pass 4 GiB. */
MesoStatus meso_glb_heads(uint32_t head[5], uint32_t binary_head[2], size_t json_size, uint64_t size,
                          const MesoMeshWriteOptions *options, MesoError *error);

/* Each writes one kind of GLB; see mesh_file.h. */
MesoStatus meso_glb_write_plain(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                MesoError *error);
MesoStatus meso_glb_write_draco(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                MesoError *error);

#endif
