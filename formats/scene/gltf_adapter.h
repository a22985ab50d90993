/* A GLB file around meshes that Draco has encoded, by the tinygltf library. */
#ifndef MESO_GLTF_ADAPTER_H
#define MESO_GLTF_ADAPTER_H

#include "formats/scene/draco_adapter.h"

/* One material: a material, a mesh and a node of the same name. */
typedef struct MesoGltfMesh {
    const char *name;
    const MesoMaterial *material;
    uint32_t piece_begin, piece_end;    /* primitives; at least one */
} MesoGltfMesh;

typedef struct MesoGltfScene {
    const char *generator;
    const char *provenance;             /* to asset.extras.provenance; "" for none */
    uint32_t channel_count;
    const MesoIdChannel *channels;      /* [channel_count] names go to asset.extras, "tiles" for "tile" */
    bool colored;
    const char *smaller;                /* what would make the file smaller, for messages; may be NULL */
    uint32_t mesh_count;
    const MesoGltfMesh *meshes;         /* [mesh_count] */
    MesoDracoResult *pieces;            /* [piece_end of the last mesh] encoded for_gltf */
} MesoGltfScene;

/* Appends `size` bytes to the file. */
typedef MesoStatus MesoGltfSink(void *context, const void *data, size_t size, MesoError *error);

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Writes `scene` as GLB with KHR_draco_mesh_compression (required): accessors
 * POSITION, NORMAL, TEXCOORD_0, COLOR_0 where colored, and one for each channel
 * after its name: _TILE, and where it has no names (_SLOT) the low and high 16
 * bits. Takes over the pieces' data: all are released, on failure too. Holds
 * them twice at its peak. MESO_ERR_LIMIT where the file would pass 4 GiB.
 */
MesoStatus meso_gltf_write(const MesoGltfScene *scene, MesoGltfSink *sink, void *context,
                           MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
