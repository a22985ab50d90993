/*
 * Relaxation: joints of strands move within the walls between slots, and trajectories lean over there, so that strands
 * follow alignments beyond one slot and keep apart. (MesoGen places each slot's trajectories by the slot alone, which
 * its Figure 10 names as its limit: b and d for alignments, a and c for intersections.)
 *
 * Unknowns are a place in the wall and a direction a joint, which both slots share, so that sweeps still end on the
 * same floats and in one direction. A step moves, from the state before it,
 *
 *     directions  towards the mean of the chords to the next joints and of the directions there
 *     places      so that each chord halves the angle between the directions at its ends, as it does on a circle
 *     both        back by a share, so that what changes nothing stays
 *
 * which leaves straight lines and circles alone, as far as it makes the sweeps beside the joint less bent, by the sum
 * of squared curvatures; and then pushes sweeps apart where their sections overlap, as long as none becomes bent
 * sharper than one was around there, or too sharply for its section, and planes at the ends do not come to cross. The
 * last steps do that alone. What lies within each other in a flat square slot is meant, and left; but where a section
 * is hollow, what only grazes it there gets out of it.
 */
#ifndef MESO_RELAX_H
#define MESO_RELAX_H

#include "libcore/tiling/strand/model.h"

/* Of two numbers the first is before, the second after. */
typedef struct MesoRelaxReport {
    uint32_t steps;             /* that were done; 0: nothing was */
    uint32_t joints;            /* that may move */
    uint64_t intersections[2];  /* pairs of sweeps that overlap, which are not meant to */
    float bend_mean[2];         /* root mean square of curvatures times the radius of the section, by length */
    float bend_most[2];         /* the largest of them */
    float move_most;            /* how far a joint has moved, in scene units */
} MesoRelaxReport;

/*
 * Fills in the joints of a model, in `arena`, after as many steps as its options say; 0 takes them away. Joints at
 * borders, on top and bottom and where a cap closes a section stay; so does each where strands of both slots do not
 * meet. A joint is moved by at most a quarter of its wall, and its section stays inside the shell as far as it was. No
 * strand passes through another one: a step is short against the way between them.
 *
 * report   may be NULL
 *
 * Sections are known by how far they reach around their trajectory, in sixteen directions; inner meshes are in
 * nobody's way. The same for any number of threads. O(steps * (sweeps + pairs of sweeps near each other)), with some
 * 1100 bytes of scratch a sweep and 16 a pair. MESO_ERR_USAGE where sections deform, MESO_ERR_MEMORY, and
 * what meso_model_expand() refuses in the shell.
 */
MesoStatus meso_model_relax(MesoModel *model, MesoRelaxReport *report, MesoArena *arena, uint32_t thread_count,
                            MesoError *error);

#endif
