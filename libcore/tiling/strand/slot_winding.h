/* Surfaces that are wound against their normals, wound along them. */
#ifndef MESO_SLOT_WINDING_H
#define MESO_SLOT_WINDING_H

#include "libcore/tiling/strand/model.h"

/*
 * `wound` is the model with the faces of each piece of its surface the other way round, all of which look against their
 * normals, and with its tiles mirrored there, so that each lies where it lay and shows what it showed. (Pieces some of
 * whose faces look along their normals stay: their neighbours meet as they are.) Its arrays are the model's, or live in
 * `arena`. O(face_count). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_model_wind(MesoModel *wound, const MesoModel *model, MesoArena *arena, MesoError *error);

#endif
