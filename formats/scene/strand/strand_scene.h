/* Scenes made over for files: open strands closed, strands numbered, strands as one mesh each. */
#ifndef MESO_STRAND_SCENE_H
#define MESO_STRAND_SCENE_H

#include "formats/scene/strand/sweep_strands.h"
#include "libcore/scene/parts.h"

/*
 * `out` is `in`, with a cap (scene.h) on each open end of a strand: those that the surface's borders cut. It
 * starts with the end's own ring, to the bit, and shares the arrays that stay. O(scene). MESO_ERR_MEMORY.
 */
MesoStatus meso_strand_scene_cap(MesoScene *out, MesoArena *arena, const MesoScene *in, MesoError *error);

/*
 * `out` is `in`, with one channel more, "strand", in the order of `strands`; what belongs to none has the
 * number behind the last. As `in` where that has
 * such a channel already, no sweeps, or no channel left. O(scene). MESO_ERR_MEMORY.
 */
MesoStatus meso_strand_scene_number(MesoScene *out, MesoArena *arena, const MesoScene *in, const MesoStrands *strands,
                                    MesoError *error);

/*
 * `out` has a body for each strand in place of its sweeps: vertices at the same place, to the bit, are one, and
 * what then is no triangle or quad any more is left out. So a strand is closed but for the ends that are open.
 * Normals are the mean of those that met; u goes around and v along the strand, 1 a sweep. A body has its first
 * sweep's material, and of ids only "strand" is left, as above. All is held in memory. MESO_ERR_MEMORY,
 * MESO_ERR_LIMIT.
 */
MesoStatus meso_strand_scene_weld(MesoScene *out, MesoArena *arena, const MesoScene *in, const MesoStrands *strands,
                                  uint32_t thread_count, MesoError *error);

#endif
