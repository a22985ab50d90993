/* Materials of the faces of a polygon mesh, and what they look like. */
#ifndef MESO_SWATCH_LOOKS_H
#define MESO_SWATCH_LOOKS_H

#include "libcore/quilt/swatch/swatch.h"

/*
 * Fills the materials of `swatch`, in `arena`, and `material_of` [mesh->face_count], by the first faces that have
 * them. Faces without one have "none".
 */
MesoStatus meso_swatch_find_looks(MesoSwatch *swatch, uint32_t *material_of, MesoArena *arena,
                                  const MesoPolygonMesh *mesh, MesoError *error);

#endif
