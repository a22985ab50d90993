/*
 * Bodies in model files (.meso), version 1.1: a mesh, of any method or none, as a scene. Chunks:
 *
 *     prov      provenance, JSON text
 *     body      u32[4 * body_count]: vertices, faces, material and row of ids of each body
 *     bodydesc  JSON text: {"channels": [{"name", "count", "names"}], "materials": [{"name", "albedo",
 *               "roughness", "metallic"}]}; "names" only where the channel has them
 *     bodyids   u32[rows * channels]
 *     bodypos, bodynrm  f32[3 * sum of vertices]      bodyuv   f32[2 * sum], or empty
 *     bodycol   u8[3 * sum], or empty                 bodyface u32[4 * sum of faces]: vertices of the
 *               body, counter-clockwise; the fourth is 2^32 - 1 for a triangle
 */
#ifndef MESO_MODEL_BODY_H
#define MESO_MODEL_BODY_H

#include "formats/file/container.h"
#include "formats/product/provenance.h"
#include "libcore/scene/scene.h"

/* Writes a scene without sweeps; its bodies are put where they are placed. O(vertices + faces). */
MesoStatus meso_body_write(const MesoScene *scene, const MesoProvenance *provenance, MesoOutput *output,
                           MesoError *error);

/* True where `input` is a model whose method is a body. O(size). */
bool meso_model_has_body(const MesoInput *input);

/*
 * The scene of a container with a chunk 'body', checked: numbers in range, positions and normals
 * finite. It points into the container's data and into `arena`. O(vertices + faces).
 */
MesoStatus meso_body_read(MesoScene *scene, MesoArena *arena, const MesoContainer *container, const char *path,
                          MesoError *error);

#endif
