/* More columns for sweeps that have a crease. */
#ifndef MESO_CREASE_COLUMNS_H
#define MESO_CREASE_COLUMNS_H

#include "libcore/scene/scene.h"

/*
 * A crease folds a section along a line that wanders over it on the way (scene.h): what of a chord w lies beyond the
 * line keeps a part k of its distance to it. With a share s of it there the section is off the chord, at the angle
 * that is worst, by w s (1 - s) (1 - k) / (2 - (1 - k) s), and by w (a - b) / (a + b) at most, a = sqrt(2) and
 * b = sqrt(1 + k). Flat sides are one chord, however wide. Kinds of sweeps of which some have creases are cut up in
 * two, and those that have get columns between the ends, with which chords are off by no more than `tolerance` (scene
 * units).
 *
 * from   gets [kind_count of the scene then] the kinds that kinds are of, or NULL: no sweep has a crease, and all stays
 *
 * Sweeps are reordered within their kinds. Rings at the ends stay. O(sweeps + columns), and nothing where there is no
 * crease. What is new lives in `arena`.
 */
MesoStatus meso_crease_columns(MesoScene *scene, uint32_t **from, MesoArena *arena, float tolerance, MesoError *error);

#endif
