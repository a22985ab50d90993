/*
 * Results of a sweep over seeds: JSON lines, one a seed, in the order of the keys
 *
 *     {"seed": 7, "verdict": "solved", "decider": "search", "attempts": 1, "observations": 812,
 *      "dead_ends": 0, "tiles": {name: slots that hold it, ...},
 *      "strands": {"count": ..., "loops": ..., and so on},
 *      "assignment": "XXH3-128, 32 digits", "problem": "XXH3-128, 32 digits"}
 *
 * without blanks; "tiles", "strands" (as in report_file.h) and "assignment"
 * only where solved. A line depends on the problem and the seed alone: on no
 * other seed, thread, shard or path.
 */
#ifndef MESO_SEED_LINES_H
#define MESO_SEED_LINES_H

#include "formats/file/input.h"
#include "formats/product/provenance.h"
#include "libcore/tiling/solve/solve.h"

typedef struct MesoSeedLine {
    uint64_t seed;
    MesoVerdict verdict;
    uint32_t attempts;
    uint64_t observations;
    uint64_t strand_count, loop_count;
    uint64_t tile_squares;      /* sum of the squares of the numbers of slots by tile */
    uint64_t assignment[2];     /* hash, high word first; 0 where not solved */
    uint64_t problem[2];        /* the same */
    const char *text;           /* the line, without its end */
} MesoSeedLine;

/* Largest seed that a line can have: that of signed JSON integers. */
#define MESO_SEED_LIMIT ((uint64_t)INT64_MAX)

/*
 * What tells lines of one problem from those of another: the hash of the inputs
 * in the provenance, of the orientation [slot_count] (NULL: the file's), and
 * of `options`, a text that names whatever else the results depend on.
 */
void meso_seed_problem(uint64_t problem[2], const MesoProvenance *provenance, const uint8_t *quarters,
                       uint32_t slot_count, const char *options);

/* XXH3-128, of the tiles (u32 a slot) and of the transforms (u8 a slot), folded together. */
void meso_assignment_hash(uint64_t hash[2], const MesoAssignment *assignment);

/* Line of a result; its text lives in `arena`. MESO_ERR_MEMORY, or MESO_ERR_LIMIT as meso_strands_count(). */
MesoStatus meso_seed_line_make(MesoSeedLine *line, MesoArena *arena, uint64_t seed, const uint64_t problem[2],
                               const MesoSolveResult *result, const MesoTileSet *set, const MesoSlotGraph *graph,
                               MesoError *error);

/*
 * Reads lines in any order, from any number of shards one after the other, into
 * `arena`, ascending by seed, each seed once. What follows the last line's end was
 * cut off, and is passed over. MESO_ERR_INPUT names the line that is not one, that
 * belongs to none of `problems` [problem_count] (0: any will do), or that contradicts an earlier line of the
 * same seed. O(size + lines * log(lines)).
 */
MesoStatus meso_seed_lines_read(MesoSeedLine **lines, uint32_t *count, MesoArena *arena, const MesoInput *input,
                                const uint64_t (*problems)[2], uint32_t problem_count, MesoError *error);

#endif
