/*
 * Reports of meso-solve (.json), version 1:
 *
 *     {"format": "meso-report", "version": 1, "tool": "meso-solve",
 *      "verdict": "solved", "unsolvable" or "gave-up",
 *      "decided_by": "propagation", "search", "counting", "parity", "probing" or "exact"; where the solver gave up,
 *          the limit: "attempts", "conflicts" or "stop"
 *      "reason": why, in words, where it is not plain that a slot is left without a tile
 *      "core": {"minimal": true or false, "slots": [numbers], "tiles": [names], "border_rules": [interfaces],
 *          "constraints": [names]}      where unsolvable, and a set that cannot hold together was found
 *      "budget": "attempts", "observations", "conflicts", "cuts", "counted", "formula" or "time",
 *      "decided_at_best": slots,
 *      "conflicts": that the exact engine met                      where the solver gave up
 *      "hot_spots": [{"slot", "dead_ends"}, ...]: the slots with most dead ends, where there are any, unless solved
 *      "attempts", "observations", "jumps", "repairs", "slots", "variants": numbers,
 *      "tiles": {name: slots that hold it, ...}                    where solved
 *      "constraints": {"backtracks": choices taken back, "violations": {name: times, ...},
 *          "kept", "changed": slots, where an assignment was to be kept, and
 *          "fewest": true where it is proved that no assignment changes fewer}     where there are any
 *      "strands": {"count", "loops", "cyclic", "sweeps", "shortest", "longest": numbers,
 *          "lengths": [strands of 1 sweep, of 2 and 3, of 4 to 7, ...]}    where solved
 *      "dead_end_total": met, "dead_ends": the ones that were kept
 *          [{"slot", "attempt", "initial",
 *            "sides": [{"border": true or false, "labels": ["a", "b'", ...]}, x 4]}, ...],
 *      "provenance": {...}}
 *
 * Labels go by name, "a'" for the flipped one. Other keys are passed over.
 */
#ifndef MESO_REPORT_FILE_H
#define MESO_REPORT_FILE_H

#include <jansson.h>

#include "formats/file/input.h"
#include "formats/product/provenance.h"
#include "libcore/tiling/solve/solve.h"

enum { MESO_REPORT_VERSION = 1 };

typedef struct MesoReport {
    MesoVerdict verdict;
    uint32_t attempts;
    uint64_t observations;
    uint32_t slot_count, variant_count;
    uint64_t dead_end_total;
    uint32_t dead_end_count;
    MesoDeadEnd *dead_ends;     /* labels by the codes of the set that it was read with */
    char tiles_hash[33];        /* of the tile set's file that it is about, 32 digits; "" where it does not say */
} MesoReport;

/* "solved", "unsolvable", "gave-up" */
const char *meso_verdict_name(MesoVerdict verdict);

/* False where `name` is none of them. */
bool meso_verdict_parse(const char *name, MesoVerdict *verdict);

/* Slots by tile name, in the set's order; tiles without a slot too, ignored ones not. NULL when memory is out. */
json_t *meso_report_histogram(const MesoAssignment *assignment, const MesoTileSet *set);

/* "propagation", "search", "counting", "parity", "probing", "exact", "attempts", "conflicts", "stop" */
const char *meso_decider_name(MesoDecider decider);

/*
 * Sets in `object` the keys from "verdict" to "dead_ends"; whatever else makes
 * a report is the caller's. `problem` is what `result` was solved with. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_report_fill(json_t *object, const MesoSolveResult *result, const MesoTilingProblem *problem,
                            MesoError *error);

/*
 * Sets "strands" and, where the problem has any, "constraints" in `object`.
 * Arguments as above. MESO_ERR_MEMORY, or MESO_ERR_LIMIT as meso_strands_count().
 */
MesoStatus meso_report_fill_control(json_t *object, const MesoSolveResult *result, const MesoTilingProblem *problem,
                                    MesoError *error);

/* The value of "strands"; NULL when memory is out. */
json_t *meso_report_strands(const MesoStrandStatistics *statistics);

/* A whole report: format, version, tool, `content` as filled, provenance; NULL when memory is out. */
json_t *meso_report_to_json(const json_t *content, const MesoProvenance *provenance);

/*
 * Reads a report for use with `set`, into `arena`. MESO_ERR_INPUT names the file
 * and the place of what is wrong: JSON, format, version, values, an interface
 * that the set lacks. MESO_ERR_LIMIT where the dead ends need over 1 GiB.
 * O(size of the file).
 */
MesoStatus meso_report_read(MesoReport *report, MesoArena *arena, const MesoInput *input,
                            const MesoTileSet *set, MesoError *error);

#endif
