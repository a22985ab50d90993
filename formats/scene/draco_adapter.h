/* One mesh to Draco's bitstream, by the Draco library. */
#ifndef MESO_DRACO_ADAPTER_H
#define MESO_DRACO_ADAPTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcore/base/error.h"
#include "libcore/scene/parts.h"

/* Ids from here on do not survive Draco's 32-bit attributes. */
enum { MESO_DRACO_ID_LIMIT = 1 << 30 };

/* At least one vertex and one face, and fewer than 2^31 / 3 triangles. */
typedef struct MesoDracoMesh {
    const MesoScene *scene;
    uint32_t vertex_count, face_count, part_count;
    const MesoMeshVertex *vertices; /* [vertex_count] finite */
    const MesoMeshColor *colors;    /* [vertex_count], or NULL */
    const MesoMeshFace *faces;      /* [face_count] quads are cut along corners 0 and 2 */
    const MesoPart *parts;      /* [part_count] */
    const uint32_t *part_end;       /* [part_count] vertex after the last of each part */
} MesoDracoMesh;

typedef struct MesoDracoText {
    const char *key;                /* at most 255 bytes */
    const char *value;
} MesoDracoText;

typedef struct MesoDracoOptions {
    uint32_t position_bits, normal_bits, uv_bits;   /* in [1, 30] */
    uint32_t speed;                 /* 0 best to 10 fastest */
    /* Positions lie in this box; meshes that share it share the grid that positions are rounded to. */
    MesoBox box;
    bool colored;
    /* Ids without names as two 16-bit components, low then high, and no materials: what glTF can say. */
    bool for_gltf;
    uint32_t text_count;            /* metadata of the geometry */
    const MesoDracoText *texts;     /* [text_count] */
} MesoDracoOptions;

typedef struct MesoDracoResult {
    uint8_t *data;                  /* [size] to be freed by meso_draco_result_release() */
    size_t size;
    /* What a decoder will give, and the box of its positions; only for_gltf, as it takes time. */
    uint32_t vertex_count, triangle_count;
    MesoVec3 decoded_low, decoded_high;
    uint32_t position_id, normal_id, uv_id, color_id, material_id;  /* unique ids, or MESO_NO_INDEX */
    uint32_t channel_id[MESO_ID_CHANNELS];
} MesoDracoResult;

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Encodes `mesh` with attributes POSITION, NORMAL, TEX_COORD, COLOR where it
 * has any, and a generic one for each channel of ids and "material", named by
 * attribute metadata. Draco may drop
 * degenerate triangles and reorder all. Several threads may encode at once; the
 * bytes depend on the arguments alone. O(triangles).
 * MESO_ERR_MEMORY, or MESO_ERR_INTERNAL with what Draco says.
 */
MesoStatus meso_draco_encode(const MesoDracoMesh *mesh, const MesoDracoOptions *options,
                             MesoDracoResult *result, MesoError *error);

void meso_draco_result_release(MesoDracoResult *result);

#ifdef __cplusplus
}
#endif

#endif
