/* What the writers of GLB share: runs of parts by material, and the JSON part of the file. */
#ifndef MESO_GLB_PARTS_H
#define MESO_GLB_PARTS_H

#include "formats/scene/draco_mesh.h"
#include "formats/scene/glb/glb_instances.h"
#include "formats/scene/mesh_window.h"

/* A range of parts of one material. */
typedef struct MesoGlbRun {
    MesoPartRange range;
    uint32_t material;
    uint64_t face_count;
} MesoGlbRun;

/*
 * The parts that have faces, in runs of one material that go over `most_faces` only where one part does; from the part
 * `apart` on, each is a run. Runs of one material lie next to each other in `*runs` [*count], in the order of the parts
 * otherwise. O(parts).
 */
MesoStatus meso_glb_runs(MesoGlbRun **runs, uint32_t *count, const MesoSceneParts *parts, uint64_t most_faces,
                         uint32_t apart, MesoArena *arena, MesoError *error);

/* What meshoptimizer made of one array. */
typedef struct MesoGlbStream {
    uint64_t at, size;              /* in the binary part; size 0: there is none */
    uint64_t plain_at;              /* where it is decoded to */
    uint32_t stride;
} MesoGlbStream;

enum {
    MESO_GLB_POSITION, MESO_GLB_NORMAL, MESO_GLB_UV, MESO_GLB_COLOR, MESO_GLB_INDICES, MESO_GLB_IDS,
    MESO_GLB_STREAMS = MESO_GLB_IDS + MESO_ID_CHANNELS
};

/* Of one primitive. Positions are whole numbers of steps from the origin. */
typedef struct MesoGlbMeshopt {
    MesoGlbStream of[MESO_GLB_STREAMS];
    uint64_t plain_end;             /* of all up to this one */
    MesoVec3 origin;
    float step;
} MesoGlbMeshopt;

/* Triangles of one material, which share no vertex with others. */
typedef struct MesoGlbPrimitive {
    uint32_t material;
    uint64_t vertex_count, triangle_count;
    MesoVec3 low, high;             /* box of the positions, as they are stored */
    uint64_t vertices_at;           /* offset in the binary part: rows of vertices, or what Draco made */
    uint64_t indices_at;            /* 32 bits each; not with Draco */
    const MesoDracoResult *draco;   /* NULL: not by Draco */
    const MesoGlbMeshopt *meshopt;  /* NULL: not by meshoptimizer */
    const MesoGlbInstanceSet *instances;    /* of the node; NULL: none */
    uint64_t instances_at;          /* their translations, rotations, scales and channels of ids, one after the other */
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
MesoStatus meso_glb_write_meshopt(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                  MesoError *error);
MesoStatus meso_glb_write_draco(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                MesoError *error);

#endif
