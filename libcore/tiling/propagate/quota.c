#include "libcore/tiling/propagate/quota.h"

MesoStatus meso_quota_track_init(MesoQuotaTrack *track, MesoArena *arena,
                                 const MesoConstraints *constraints, uint32_t word_count,
                                 MesoError *error)
{
    *track = (MesoQuotaTrack){.word_count = word_count};
    if (!constraints || constraints->quota_count == 0)
        return MESO_OK;
    track->count = constraints->quota_count;
    track->quotas = constraints->quotas;
    track->counts = MESO_NEW(arena, MesoQuotaCount, track->count, error);
    track->scratch = MESO_NEW(arena, uint64_t, word_count, error);
    return track->counts && track->scratch ? MESO_OK : MESO_ERR_MEMORY;
}

typedef struct Membership {
    bool inside, possible;
} Membership;

static Membership membership(const MesoQuotaTrack *track, uint32_t quota, const uint64_t *bits)
{
    uint64_t in = 0, out = 0;
    for (uint32_t w = 0; bits && w < track->word_count; w++) {
        in |= bits[w] & track->quotas[quota].variants[w];
        out |= bits[w] & ~track->quotas[quota].variants[w];
    }
    return (Membership){in && !out, in != 0};
}

void meso_quota_change(MesoQuotaTrack *track, const uint64_t *before, const uint64_t *after)
{
    for (uint32_t q = 0; q < track->count; q++) {
        Membership was = membership(track, q, before), is = membership(track, q, after);
        track->counts[q].inside += (uint32_t)is.inside - (uint32_t)was.inside;
        track->counts[q].possible += (uint32_t)is.possible - (uint32_t)was.possible;
    }
}

MesoQuotaCall meso_quota_call(const MesoQuotaTrack *track, uint32_t quota)
{
    MesoQuotaCount count = track->counts[quota];
    const MesoQuota *rule = &track->quotas[quota];
    if (count.inside > rule->most || count.possible < rule->least)
        return MESO_QUOTA_BROKEN;
    if (count.inside == count.possible)
        return MESO_QUOTA_CALM;
    if (count.inside == rule->most)
        return MESO_QUOTA_USED_UP;
    return count.possible == rule->least ? MESO_QUOTA_NEEDS_ALL : MESO_QUOTA_CALM;
}

bool meso_quota_narrow(MesoQuotaTrack *track, uint32_t quota, MesoQuotaCall call, const uint64_t *bits)
{
    Membership is = membership(track, quota, bits);
    const uint64_t *variants = track->quotas[quota].variants;
    if (!is.possible || is.inside)
        return false;
    for (uint32_t w = 0; w < track->word_count; w++)
        track->scratch[w] = bits[w] & (call == MESO_QUOTA_USED_UP ? ~variants[w] : variants[w]);
    return true;
}
