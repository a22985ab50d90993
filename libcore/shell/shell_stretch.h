/*
 * Stretch of a map between two sets of tetrahedra ("Mesh Quilting for
 * Geometric Texture Synthesis", Zhou et al. 2006, section 3.2, equations 8
 * and 9): the root of the mean square of how much lengths grow, over all
 * directions and the whole volume.
 *
 * The paper's map goes from the shell to the texture. Sander et al. (2001),
 * whom it follows, go the other way, where 1 is the least value for a map that
 * keeps the volume; both are measured here, by turning the arguments around.
 */
#ifndef MESO_SHELL_STRETCH_H
#define MESO_SHELL_STRETCH_H

#include "libcore/math/vec3d.h"

/* Six times the volume; above 0 where corner 3 is seen with corners 0, 1, 2 clockwise. */
double meso_tetrahedron_det(const MesoVec3d corners[4]);

/*
 * Equation 8, squared, of the linear map that takes `from` to `to`: a third of the sum of the squares of all
 * derivatives. Infinite where `from` has no volume.
 */
double meso_tetrahedron_stretch(const MesoVec3d from[4], const MesoVec3d to[4]);

/* Sums over tetrahedra, of volumes with their sign. */
typedef struct MesoShellStretch {
    double squares;             /* of equation 8, times the volume of `from` */
    double from_volume, to_volume;
    uint32_t inverted_count;    /* whose volume has another sign in `to`, or none: they are in no other sum */
} MesoShellStretch;

void meso_shell_stretch_add(MesoShellStretch *sum, const MesoVec3d from[4], const MesoVec3d to[4]);

/*
 * The same for a map that is not linear, in samples: its derivatives along three axes at right angles of `from`, and
 * the volume there that they stand for. `back`: of the map from `to` to `from`.
 */
void meso_shell_stretch_sample(MesoShellStretch *sum, const MesoVec3d derivatives[3], double volume, bool back);

/*
 * Equation 9, times the cube root of from_volume / to_volume, so that a map that scales all alike has 1. (The paper
 * writes a square root, which is right on surfaces.) 1 where nothing was added.
 */
double meso_shell_stretch(const MesoShellStretch *sum);

/* Its sixth power, to compare: by products and quotients alone, and so the same everywhere. */
double meso_shell_stretch_sixth(const MesoShellStretch *sum);

#endif
