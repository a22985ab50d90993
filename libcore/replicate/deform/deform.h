/*
 * Deformations that test clips are made of: each a formula of space, so that areas and lengths after it are known.
 * A deformation is a list of steps; each acts on what those before it have made, with a share of its amount that goes
 * by key times.
 */
#ifndef MESO_DEFORM_H
#define MESO_DEFORM_H

#include <stdbool.h>
#include <stdint.h>

#include "libcore/base/error.h"
#include "libcore/math/vec.h"

typedef enum MesoDeformKind {
    MESO_DEFORM_STRETCH,    /* lengths along `axis` become `amount` times as long: 1 + share (amount - 1) */
    MESO_DEFORM_SCALE,      /* so do all lengths */
    MESO_DEFORM_TWIST,      /* one end is turned about `axis` against the other by `amount` radians */
    MESO_DEFORM_BEND,       /* a line along `axis` becomes an arc of `amount` radians, as long, hollow towards `up` */
    MESO_DEFORM_INFLATE,    /* what is nearer to `center` than `radius` goes away from it: the middle by `amount` */
    MESO_DEFORM_KINDS
} MesoDeformKind;

typedef struct MesoDeformKey {
    float time, share;
} MesoDeformKey;

typedef struct MesoDeformStep {
    MesoDeformKind kind;
    MesoVec3 axis, up;          /* unit length, at right angles */
    bool centered;              /* `center` is given; else the middle of the box around what is deformed */
    MesoVec3 center;
    float radius;               /* > 0, of inflation */
    float amount;
    uint32_t key_count;         /* 0: none of it at time 0, all at 1 */
    const MesoDeformKey *keys;  /* [key_count] by ascending time; linear between them, constant before and after */
} MesoDeformStep;

/* The share of a step at a time. */
double meso_deform_share(const MesoDeformStep *step, double time);

/*
 * Positions at `time`, in [0,1]. A plane across `up` through the center is bent into a cylinder without stretch;
 * inflation is by (1 - (d / radius)^2)^2 at distance d. Steps whose share is 0 leave every bit as it was.
 *
 * out        [count] may be `positions`
 *
 * MESO_ERR_INPUT names the first vertex that goes beyond MESO_COORDINATE_LIMIT. O(count * step_count) on
 * `thread_count` threads (0: all cores), the same for any number of them.
 */
MesoStatus meso_deform(MesoVec3 *out, const MesoVec3 *positions, uint32_t count, const MesoDeformStep *steps,
                       uint32_t step_count, double time, uint32_t thread_count, MesoError *error);

/*
 * A step of a kind as it suits a mesh: twice as long or large, half a turn along its longest side, bent into half a
 * circle towards its shortest, or blown up from its middle by half its longest side.
 */
MesoDeformStep meso_deform_usual(MesoDeformKind kind, const MesoVec3 *positions, uint32_t count);

/* "stretch", "scale" ..., ended by NULL. */
extern const char *const meso_deform_names[MESO_DEFORM_KINDS + 1];

#endif
