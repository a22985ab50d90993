#include "libcore/quilt/phase/weave_pitch.h"

#include <math.h>

/* Strands run along a side by that cosine at least, within the plane. */
#define COSINE_LEAST 0.8f

/* Pitches that are tried: parts of a side, between these, by steps of a share of a part. */
#define PARTS_LEAST 2.5
#define PARTS_MOST 48.0
#define PARTS_STEP 0.02

/* Of the multiples of a pitch on a side so many have a strand, at least, but for one at the end. */
#define TAKEN_LEAST 0.8

/* What of all rings lies at multiples of the pitch, at least. */
#define SHARE_LEAST 0.75

/* Pitches are alike that differ by less, as a share; and what of all heights is that of a chequered weave, at least. */
#define ALIKE 0.05
#define CHEQUERED_LEAST 0.5

static bool is_along(MesoVec3 axis, int side)
{
    float across = side ? axis.x : axis.y, length = sqrtf(axis.x * axis.x + axis.y * axis.y);
    return length > 0 && fabsf(across) >= COSINE_LEAST * length;
}

typedef struct Wave {
    double re, im;
    uint32_t count;
} Wave;

static Wave sum_waves(const MesoVec3 *middles, const MesoVec3 *axes, uint32_t count, int side, double pitch)
{
    Wave wave = {0};
    for (uint32_t r = 0; r < count; r++) {
        if (!is_along(axes[r], side))
            continue;
        double angle = 2 * MESO_PI * (double)(side ? middles[r].y : middles[r].x) / pitch;
        wave.re += cos(angle);
        wave.im += sin(angle);
        wave.count++;
    }
    return wave;
}

/* Whether there is a strand at most multiples: few strands lie at multiples of some pitch by chance. */
static bool is_taken(double pitch, double offset, const MesoVec3 *middles, const MesoVec3 *axes, uint32_t count,
                     int side, double size)
{
    bool taken[(int)PARTS_MOST + 2] = {false};
    uint32_t number = 0;
    for (uint32_t r = 0; r < count; r++) {
        double at = floor(((double)(side ? middles[r].y : middles[r].x) - offset) / pitch + 0.5);
        if (!is_along(axes[r], side) || !(at >= 0 && at <= PARTS_MOST) || taken[(int)at])
            continue;
        taken[(int)at] = true;
        number++;
    }
    return number + 1 >= TAKEN_LEAST * size / pitch;
}

static bool find_pitch(double *pitch, double *offset, const MesoVec3 *middles, const MesoVec3 *axes, uint32_t count,
                       int side, double size)
{
    double most = SHARE_LEAST;
    bool found = false;
    for (double parts = PARTS_LEAST; parts < PARTS_MOST; parts += PARTS_STEP) {
        Wave wave = sum_waves(middles, axes, count, side, size / parts);
        double share = wave.count ? sqrt(wave.re * wave.re + wave.im * wave.im) / wave.count : 0;
        if (found && share < most)
            break;      /* finer ones are parts of it */
        if (!(share > most))
            continue;
        found = true;
        most = share;
        *pitch = size / parts;
        *offset = *pitch * atan2(wave.im, wave.re) / (2 * MESO_PI);
    }
    return found && is_taken(*pitch, *offset < 0 ? *offset + *pitch : *offset, middles, axes, count, side, size);
}

/* Heights along strands of one side as a chequered weave has them, of all that they are above and below their mean. */
static double chequered_share(const MesoWeavePitch *pitch, const MesoVec3 *middles, const MesoVec3 *axes,
                              uint32_t count, int side)
{
    double mean = 0, re = 0, im = 0, sum = 0;
    uint32_t number = 0;
    for (uint32_t r = 0; r < count; r++)
        if (is_along(axes[r], side)) {
            mean += (double)middles[r].z;
            number++;
        }
    mean = number ? mean / number : 0;
    for (uint32_t r = 0; r < count; r++) {
        if (!is_along(axes[r], side))
            continue;
        double x = ((double)middles[r].x - pitch->offsets[0]) / pitch->pitches[0];
        double y = ((double)middles[r].y - pitch->offsets[1]) / pitch->pitches[1], up = (double)middles[r].z - mean;
        re += up * cos(MESO_PI * (x + y));
        im += up * cos(MESO_PI * (x - y));
        sum += fabs(up);
    }
    return sum > 0 ? fmax(fabs(re), fabs(im)) / sum : 0;
}

bool meso_weave_pitch(MesoWeavePitch *pitch, const MesoVec3 *middles, const MesoVec3 *axes, uint32_t count,
                      MesoVec2 size)
{
    *pitch = (MesoWeavePitch){0};
    if (!find_pitch(&pitch->pitches[0], &pitch->offsets[0], middles, axes, count, 0, (double)size.x) ||
        !find_pitch(&pitch->pitches[1], &pitch->offsets[1], middles, axes, count, 1, (double)size.y))
        return false;
    pitch->alike = fabs(pitch->pitches[0] - pitch->pitches[1]) < ALIKE * pitch->pitches[0];
    pitch->chequered = pitch->alike &&
                       chequered_share(pitch, middles, axes, count, 0) > CHEQUERED_LEAST &&
                       chequered_share(pitch, middles, axes, count, 1) > CHEQUERED_LEAST;
    return true;
}
