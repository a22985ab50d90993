/*
 * Births by statistics: how many others there are at which distance, of all details together ("Analysis and Synthesis
 * of Point Distributions based on Pair Correlation", Oeztireli and Gross 2012), and how long edges of the web are, by
 * their mean and deviation. Of some places that are tried the one is taken whose distances, and the edges that it makes
 * and ends, bring the sums nearest to what they are at rest; what is left of the difference goes on to the next birth.
 * So groups stay groups, which triangles with details inside do not keep: those see no further than their sides. None
 * is born nearer to another than any is at rest, where there is a place that is not.
 */
#ifndef MESO_PAIR_TARGET_H
#define MESO_PAIR_TARGET_H

#include "libcore/replicate/plan/replicate_work.h"

/* Of the details at rest. MESO_ERR_MEMORY alone. O(details). */
MesoStatus meso_pair_target_build(MesoPairTarget *target, MesoReplication *r, MesoError *error);

/* Details are born in all blocks in which they are due; `due` in all. MESO_ERR_MEMORY, MESO_ERR_LIMIT. */
MesoStatus meso_bear_by_pairs(MesoReplication *r, uint32_t due, int32_t frame, MesoError *error);

/* Details die in all blocks in which MESO_SURPLUS more are than are due, or more; about `due` in all. */
MesoStatus meso_thin_by_pairs(MesoReplication *r, uint32_t due, int32_t frame, MesoError *error);

#endif
