/*
 * Parts of GLB files of instances: the JSON part is made first, and names the pieces of the binary part, which are then
 * written in that order. All pieces are made of words of 32 bits, and so all are aligned.
 */
#ifndef MESO_INSTANCE_GLB_PARTS_H
#define MESO_INSTANCE_GLB_PARTS_H

#include <jansson.h>

#include "formats/file/output.h"
#include "formats/replicate/instance_scene.h"

enum { MESO_GLB_FLOAT = 5126, MESO_GLB_UINT = 5125 };

typedef struct MesoGlbParts {
    json_t *views, *accessors, *meshes, *nodes, *materials;     /* owned by `root` */
    json_t *root;
    uint64_t size;          /* of the binary part so far */
    uint32_t count;         /* of accessors */
    int failed;             /* of Jansson: memory is out */
} MesoGlbParts;

void meso_glb_begin(MesoGlbParts *glb);
void meso_glb_release(MesoGlbParts *glb);

/* The next piece; `target` 0: none. Returns the accessor's number. */
uint32_t meso_glb_accessor(MesoGlbParts *glb, const char *type, int component, uint32_t count, uint32_t width,
                           int target);

/* Which the format wants of positions. */
void meso_glb_bounds(MesoGlbParts *glb, uint32_t accessor, const MesoVec3 *positions, uint32_t count);

/* A mesh with its material, and a node of it, which comes back: the caller may say more of it. */
json_t *meso_glb_mesh(MesoGlbParts *glb, const MesoInstanceShape *shape, const MesoVec3 *positions,
                      const MesoVec3 *normals);

/* Writes all up to the pieces. MESO_ERR_LIMIT beyond 4 GiB, MESO_ERR_INPUT without a node. */
MesoStatus meso_glb_finish(MesoGlbParts *glb, const MesoInstanceScene *scene, MesoOutput *output, MesoError *error);

/* The pieces of a mesh. */
MesoStatus meso_glb_write_mesh(const MesoInstanceShape *shape, const MesoVec3 *positions, const MesoVec3 *normals,
                               MesoOutput *output, MesoError *error);

#endif
