/* What meso-replicate is told. */
#ifndef MESO_REPLICATE_ARGUMENTS_H
#define MESO_REPLICATE_ARGUMENTS_H

#include "cmd/common/scene_output.h"

typedef struct MesoReplicateArguments {
    MesoTool tool;
    MesoSceneOutput output;
    const char *mesh;           /* --mesh: file of the surface at rest; NULL: the clip has it */
    const char *frames;         /* --frames; NULL: all */
    float frames_per_second;    /* --fps */
    uint32_t substeps;          /* --substeps */
    const char *mode;           /* --mode: plan, play, paper */
    const char *births;         /* --births: usual, exemplars, statistics */
    float alpha, beta, gamma, mu, ramp;     /* --alpha, --beta, --gamma, --mu, --ramp; 0: the default */
    const char *state;          /* --state; NULL: none is kept */
    const char *plan;           /* --plan; NULL: none is kept */
    const char *report;         /* --report; NULL: none */
    const char *surface;        /* --surface: a material; NULL: it is not shown where it need not */
    uint32_t fineness;          /* --fineness */
    bool instances;             /* --instances */
    const char *deform;         /* --deform: a kind, or a file; NULL: details replicate */
    uint32_t count;             /* --count: frames of --deform */
    float amount;               /* --amount of --deform */
    struct {
        bool alpha, beta, gamma, mu, amount;
    } given;
} MesoReplicateArguments;

/* --up */
static inline bool meso_replicate_z_up(const MesoReplicateArguments *arguments)
{
    return arguments->output.up[0] == 'z';
}

static inline MesoVec3 meso_replicate_up(const MesoReplicateArguments *arguments)
{
    return meso_replicate_z_up(arguments) ? (MesoVec3){0, 0, 1} : (MesoVec3){0, 1, 0};
}

#endif
