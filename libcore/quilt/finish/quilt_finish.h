/*
 * What is left to do after a quilt has grown: cut along the surface's borders, open ends closed, small pieces taken
 * away, and all of it said by the triangles of the surface as it was given.
 */
#ifndef MESO_QUILT_FINISH_H
#define MESO_QUILT_FINISH_H

#include "libcore/quilt/base/quilt_base.h"
#include "libcore/quilt/quilt.h"

typedef struct MesoFinishOptions {
    float scale;            /* of MesoQuiltOptions; 0: pieces stay however small they are, strands where they are */
    float height_scale;     /* of MesoQuiltOptions */
    float offset;
    float overhang;         /* whole elements may reach beyond a border by so much, in the surface's units */
    uint32_t thread_count;  /* 0: all cores; no effect on the bytes */
    bool open_borders;      /* strands that a border cuts stay open there; else they are closed */
    MesoArena *spent;       /* has the quilt's arrays alone; released once they are of no use. NULL: they stay */
} MesoFinishOptions;

/*
 * Finishes a quilt over `base`->mesh, in place; of its arrays those that do not fit where they were are anew in `arena`
 * where any of this changes it:
 *
 * - Strands move along the surface to where they lie around each other as in the swatch, as far as that and their joins
 *   allow; not where the swatch has whole elements that grow from none of them, and so would not follow. Their sections
 *   are those of the swatch.
 * - Strands are cut where base->inside is 0, whole elements that reach further beyond than `overhang` are left out.
 * - Loops of open edges, wherever they come from, are closed by caps: long ones along a border by strips that follow
 *   it, flat ones by the ears of the loop, others, and those whose chords are edges already, around a point in their
 *   middle. So no edge is open on a closed surface, and with open_borders only those along borders.
 * - Pieces of strands no longer than about one and a half times the reach of their section are left out: those whose
 *   points are nowhere further apart than 2.5 times the largest reach of their swatch element's open ends.
 * - Strands come back to the heights that the swatch has them at, but for what joins need of them; whole elements
 *   beside them, all the way.
 * - Where they run through each other, strands that cross go over and under, and others lie side by side: as far as
 *   their sections need, and not where strands of the swatch lie in each other.
 * - Vertices have triangles and weights of the original that `base` comes from.
 * - Elements are what hangs together, in the order in which they were, pieces of one by their first triangle.
 *
 * Counts are added to the quilt's report; open_count is what is open in the end. O(quilt + base), and O(count^2) for a
 * flat cap. Where it fails and there is a spent arena, the quilt is empty. MESO_ERR_INPUT where triangles do not fit
 * together at a border, MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_finish(MesoQuilt *quilt, MesoArena *arena, const MesoQuiltBase *base, const MesoSwatch *swatch,
                             const MesoFinishOptions *options, MesoError *error);

#endif
