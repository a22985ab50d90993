/* Meshes out: binary PLY, OBJ, STL, Draco, GLB. */
#ifndef MESO_MESH_FILE_H
#define MESO_MESH_FILE_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"
#include "formats/scene/part/selection.h"
#include "libcore/scene/parts.h"

typedef enum MesoGlbCompression {
    MESO_GLB_PLAIN,
    MESO_GLB_DRACO,             /* KHR_draco_mesh_compression */
    MESO_GLB_MESHOPT            /* EXT_meshopt_compression, KHR_mesh_quantization */
} MesoGlbCompression;

typedef struct MesoMeshWriteOptions {
    uint32_t thread_count;      /* 0: all cores */
    uint32_t position_bits;     /* Draco; 0: 14; meshopt, at most 16 */
    uint32_t normal_bits;       /* Draco, meshopt; 0: 10 */
    uint32_t speed;             /* Draco, 0 best to 10 fastest */
    MesoGlbCompression compression;
    bool lengths, tangents;     /* of GLB that is plain: TEXCOORD_1 and TANGENT, as in surface_frame.h */
    bool instances;             /* of GLB that is plain: bodies that lie rigidly at several places are there once */
    bool z_up;                  /* the scene's up is z, and not y; where the kind of file can say so */
    float unit;                 /* metres of one scene unit, likewise; 0: 1 */
    const MesoProvenance *provenance;
    const char *materials;      /* name of the file from meso_mtl_write(), for OBJ; NULL: none */
    const MesoSelection *selection;     /* what the parts are of, for PLY; NULL: they are the whole */
    uint32_t strand_count;      /* lengths of the channel "strand", but in STL and USD; 0: they are not told */
    const float *strand_lengths;        /* [strand_count] */
    const MesoBox *box;         /* of the whole, for Draco's grid; NULL: that of the parts */
    const char *smaller;        /* what would make the product smaller, for messages; may be NULL */
    /* Called now and then with the work done so far; may be NULL. */
    void (*progress)(void *context, uint64_t done, uint64_t total);
    void *progress_context;
} MesoMeshWriteOptions;

/* The most triangles in one .drc, for each of which Draco takes 160 bytes of memory at speeds of 6
 * and more, 300 below: 11 to 20 GB. */
enum { MESO_DRACO_TRIANGLES = 1 << 26 };

/*
 * Each writes all parts of a scene, with their ids in every channel: the ones
 * of a channel with names in 16 bits, beside the names, the others in 32. Where
 * a body has colours, all vertices have; in PLY they always have, times the
 * materials' albedo. PLY and OBJ stream in windows of
 * bounded size, whatever the mesh (a body is held whole), and so do STL and GLB that is
 * not compressed by Draco, which holds what it encodes: up to MESO_DRACO_TRIANGLES in
 * one .drc, a piece of one material at a time in .glb, beside the compressed
 * result. MESO_ERR_LIMIT beyond what a format can hold; MESO_ERR_INPUT for a
 * scene without geometry. Bytes do not depend on the thread count.
 */
MesoStatus meso_ply_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error);
MesoStatus meso_obj_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error);
MesoStatus meso_drc_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error);
MesoStatus meso_glb_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error);

/* Triangles with the normals of their planes, in the format's binary form, which holds no ids and no materials. */
MesoStatus meso_stl_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error);

/* Materials by the names that OBJ files use: Kd, and Pr and Pm for roughness and metallic. */
MesoStatus meso_mtl_write(const MesoScene *scene, const MesoProvenance *provenance, MesoOutput *output,
                          MesoError *error);

#endif
