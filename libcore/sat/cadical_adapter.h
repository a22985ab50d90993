/*
 * CaDiCaL (a solver of propositional formulas, incremental) behind a C
 * interface. A literal is a variable's number, from 1, with a sign.
 */
#ifndef MESO_CADICAL_ADAPTER_H
#define MESO_CADICAL_ADAPTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcore/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Literal of what always holds; its negation never does. For callers that drop it: CaDiCaL does not know it. */
#define MESO_LITERAL_TRUE INT32_MAX

typedef struct MesoSat MesoSat;

typedef enum MesoSatAnswer { MESO_SAT_UNKNOWN, MESO_SAT_YES, MESO_SAT_NO } MesoSatAnswer;

/*
 * A formula without clauses. `proof`, which may be NULL, gets the DRAT proof in
 * its textual form, in pieces, until the release; it returns false where it
 * cannot take more. MESO_ERR_MEMORY or MESO_ERR_INTERNAL.
 */
MesoStatus meso_sat_init(MesoSat **sat, bool (*proof)(void *context, const char *data, size_t size),
                         void *context, MesoError *error);

/*
 * To be called before the first clause where clauses will be added after a question, and there is a
 * proof. CaDiCaL takes back what eliminates variables when clauses with them come, but does
 * not say so in the proof; here nothing is eliminated.
 */
MesoStatus meso_sat_expect_clauses(MesoSat *sat, MesoError *error);

/* NULL is allowed. */
void meso_sat_release(MesoSat *sat);

/* Adds the clause of literals [count]; the empty one makes the formula false. */
MesoStatus meso_sat_add(MesoSat *sat, const int32_t *literals, uint32_t count, MesoError *error);

/*
 * The same for a clause that unit propagation shows to follow from what the formula
 * holds by now, as the opposites of the assumptions that failed do: it stands in the proof too.
 */
MesoStatus meso_sat_add_implied(MesoSat *sat, const int32_t *literals, uint32_t count, MesoError *error);

/* The variable is not to be eliminated: it will be assumed again and again. */
MesoStatus meso_sat_freeze(MesoSat *sat, int32_t variable, MesoError *error);

/* Conflicts met so far, in all calls: clauses learned, and now and then one from elsewhere. */
uint64_t meso_sat_conflicts(const MesoSat *sat);

/* Decisions on the variable try `literal` first, until the next meso_sat_forget_phases(). */
MesoStatus meso_sat_phase(MesoSat *sat, int32_t literal, MesoError *error);

/* From here on decisions follow CaDiCaL's own phases. */
MesoStatus meso_sat_forget_phases(MesoSat *sat, MesoError *error);

/*
 * Asks for an assignment under the assumptions [count], for at most
 * `conflict_limit` conflicts, or until `stop`, which may be NULL, returns true.
 * The answer depends on the calls so far alone, unless `stop` had a say in it.
 */
MesoStatus meso_sat_solve(MesoSat *sat, MesoSatAnswer *answer, const int32_t *assumptions,
                          uint32_t count, uint32_t conflict_limit, bool (*stop)(void *context),
                          void *context, MesoError *error);

/* After MESO_SAT_YES: whether `literal` is true. */
bool meso_sat_value(MesoSat *sat, int32_t literal);

/* After MESO_SAT_NO: whether the assumption `literal` had a part in it. */
bool meso_sat_failed(MesoSat *sat, int32_t literal);

#ifdef __cplusplus
}
#endif

#endif
