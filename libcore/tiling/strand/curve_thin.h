/* Which points of closed curves stay, so that chords between them are as near as a tolerance asks for. */
#ifndef MESO_CURVE_THIN_H
#define MESO_CURVE_THIN_H

#include "libcore/tiling/strand/profile_set.h"

/* Indices go on and around. */
typedef struct MesoClosedCurve {
    const MesoVec2 *points;     /* [count] */
    uint32_t count;
} MesoClosedCurve;

/*
 * Curves of equal counts, from the first to the last in equal blends, that are to keep the same points; one, or more.
 */
typedef struct MesoCurveRow {
    const MesoClosedCurve *curves;
    uint32_t curve_count;
    const bool *fixed;          /* [count] these stay, where they are */
    bool *kept;                 /* [count] gets those that stay */
    MesoVec2 *shifts[2];        /* [count] of the first and the last curve, to where they go */
} MesoCurveRow;

/*
 * Keeps as few points as the limits allow, about evenly off, between those that are fixed, or from `first` all around.
 * The others that stay move out of the bends, so that a curve lies as far outside of its chords as inside, which takes
 * seven chords for ten; no chord stands for a turn of over 60 degrees.
 *
 * off   [curve_count] gets what chords are off, at most
 */
void meso_curves_thin(const MesoCurveRow *row, uint32_t first, MesoColumnLimits limits, float *off);

float meso_distance_to_chord(MesoVec2 p, MesoVec2 a, MesoVec2 b);

/*
 * Chords that the curve takes between its points a and b, which one chord `from` `to` stands for: an arc's height falls
 * with the square of their number. One chord is so far `off`, if that is more than before.
 */
float meso_chord_pieces(const MesoClosedCurve *curve, uint32_t a, uint32_t b, MesoVec2 from, MesoVec2 to,
                        const MesoColumnLimits *limits, float *off);

#endif
