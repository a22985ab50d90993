/*
 * Models of tiles in model files (.meso), version 1.0, 1.2 with 'mapping' or 1.4 where they are relaxed: all
 * that a renderer needs. Chunks:
 *
 *     prov      provenance, JSON text
 *     tiles     tile set, JSON text as in .tiles.json
 *     options   MesoMapOptions, resolved: f32 thickness, offset, section_scale, tangent_scale,
 *               section_step, u32 divisions
 *     mapping   the other MesoMapOptions, JSON text (model_mapping.h); only where one is not at its default
 *     joint     i16[4 * joint_count]: MesoJointMove by the numbers of strand_joints.h; where 'mapping' has "relax" only
 *     position  f32[3 * vertex_count]       normal   f32[3 * normal_count]
 *     face      u32[4 * face_count]         facenorm u32[4 * face_count]
 *               corners in the slots' order: not the surface file's where slots were oriented
 *     tile      u32[face_count]             xform    u8[face_count]
 *     zjoint, zface, zfacenrm, ztile   the same, packed (packed_chunk.h), in relaxed models since 1.4; plain in 1.3
 *     inner     u32[2 * inner_count]: vertex and triangle count of each inner mesh
 *     innerpos, innernrm  f32[3 * sum]      innertri u32[3 * sum]
 */
#ifndef MESO_MODEL_FILE_H
#define MESO_MODEL_FILE_H

#include "formats/file/container.h"
#include "formats/product/provenance.h"
#include "libcore/tiling/strand/model.h"

/* The newest version of .meso, whatever is in it. */
enum { MESO_MODEL_MAJOR = 1 };

MesoStatus meso_model_write(const MesoModel *model, const MesoProvenance *provenance,
                            MesoOutput *output, MesoError *error);

/* Reads and checks everything: mesh, tile set, assignment against both. `provenance` may be NULL. */
MesoStatus meso_model_read(MesoModel *model, const char **provenance, MesoArena *arena,
                           const MesoInput *input, MesoError *error);

/* The same in two parts, of a container that is open. `path` is for messages. */
MesoStatus meso_model_provenance(const char **provenance, MesoArena *arena, const MesoContainer *container,
                                 const char *path, MesoError *error);
MesoStatus meso_model_take(MesoModel *model, MesoArena *arena, const MesoContainer *container, const char *path,
                           MesoError *error);

#endif
