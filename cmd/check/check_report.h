/* What was found: lines, JSON, and what of it is too much. */
#ifndef MESO_CHECK_REPORT_H
#define MESO_CHECK_REPORT_H

#include "cmd/check/check_input.h"

/* What is allowed; a bound counts where it is given. */
typedef struct MesoCheckBounds {
    float gap, angle, depth, thickness;
    uint32_t open, crossings, floating, faults;
    struct {
        bool gap, angle, depth, thickness, open, crossings, floating, fast;
    } given;
    bool fast;
} MesoCheckBounds;

typedef struct MesoCheckFindings {
    const MesoCheckInput *input;
    const MesoInspection *inspection;
    const MesoCheckBounds *bounds;
} MesoCheckFindings;

/* The report's object "check"; the caller owns it, and it is NULL where memory is out. */
json_t *meso_check_json(const MesoCheckFindings *findings);

/* A line for what the mesh is, and one for each kind of fault, to standard output. */
MesoStatus meso_check_print(const MesoCheckFindings *findings, MesoError *error);

/* MESO_ERR_NO with all bounds that are exceeded; MESO_ERR_INPUT for one of what cannot be looked for. */
MesoStatus meso_check_judge(const MesoCheckFindings *findings, MesoError *error);

#endif
