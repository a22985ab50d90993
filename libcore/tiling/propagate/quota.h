/* Quotas during a search: how many slots hold, and how many may still hold, some variants. */
#ifndef MESO_QUOTA_H
#define MESO_QUOTA_H

#include "libcore/tiling/problem/constraints.h"

typedef struct MesoQuotaCount {
    uint32_t inside;            /* slots whose domain has only variants of the quota */
    uint32_t possible;          /* slots whose domain has one */
} MesoQuotaCount;

typedef struct MesoQuotaTrack {
    uint32_t count, word_count;
    const MesoQuota *quotas;    /* [count] */
    MesoQuotaCount *counts;     /* [count] */
    uint64_t *scratch;          /* [word_count] */
} MesoQuotaTrack;

/* What the counts call for. */
typedef enum MesoQuotaCall {
    MESO_QUOTA_CALM,
    MESO_QUOTA_USED_UP,         /* no slot may take one any more that is free not to */
    MESO_QUOTA_NEEDS_ALL,       /* every slot that may take one must */
    MESO_QUOTA_BROKEN           /* too many hold one, or too few can */
} MesoQuotaCall;

/* All counts at 0; arrays live in `arena`. `constraints` may be NULL: no quotas. */
MesoStatus meso_quota_track_init(MesoQuotaTrack *track, MesoArena *arena,
                                 const MesoConstraints *constraints, uint32_t word_count,
                                 MesoError *error);

/* A slot's domain goes from `before` to `after` (NULL: there was, or is, none). O(quotas * words). */
void meso_quota_change(MesoQuotaTrack *track, const uint64_t *before, const uint64_t *after);

MesoQuotaCall meso_quota_call(const MesoQuotaTrack *track, uint32_t quota);

/*
 * The part of domain `bits` that `call`, USED_UP or NEEDS_ALL, leaves, in
 * `scratch`; false where that is all of it. Never empty.
 */
bool meso_quota_narrow(MesoQuotaTrack *track, uint32_t quota, MesoQuotaCall call, const uint64_t *bits);

#endif
