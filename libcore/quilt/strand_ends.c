/* Ends of strands, drawn back to where they have room. */
#include "libcore/quilt/quilt_work.h"

/* Strands side by side need so much of both reaches; ends are drawn back by so many rings at most. */
#define ROOM 0.9f
enum { BACK_MOST = 14 };

/* Rings side by side: by the cosine between strands, and by how far along them, in steps. */
#define COSINE_LEAST 0.7f
#define ALONG_MOST 0.6f

/* One side's rings in the plane; positive values stay. */
typedef struct EndSide {
    const MesoStrandRings *rings;
    const MesoVec3 *middles, *axes;
    float *values;
} EndSide;

static bool lacks_room(const EndSide *side, uint32_t r, const EndSide *other, uint32_t q)
{
    if (!(other->values[q] > 0) || (side == other && q == r))
        return false;
    MesoVec3 axis = side->axes[r], apart = meso_vec3_sub(other->middles[q], side->middles[r]);
    float room = ROOM * (side->rings->reaches[r] + other->rings->reaches[q]);
    if (fabsf(apart.x) > 2 * room || fabsf(apart.y) > 2 * room)
        return false;
    float along = meso_vec3_dot(apart, axis), cosine = meso_vec3_dot(axis, other->axes[q]);
    if (fabsf(along) > ALONG_MOST * other->rings->steps[q] || fabsf(cosine) < COSINE_LEAST)
        return false;
    return meso_vec3_length(meso_vec3_mad(apart, -along, axis)) < room;
}

static bool has_room(const EndSide *side, uint32_t r, const EndSide sides[2])
{
    for (int k = 0; k < 2; k++)
        for (uint32_t q = 0; q < sides[k].rings->count; q++)
            if (lacks_room(side, r, &sides[k], q))
                return false;
    return true;
}

/* From the ring at an end inwards, to the first that has room. Whether any has been taken away. */
static bool draw_back(const EndSide *side, const EndSide sides[2], uint32_t ring)
{
    uint32_t before = MESO_NO_INDEX, taken[BACK_MOST], count = 0;
    while (count < BACK_MOST && ring != MESO_NO_INDEX && side->values[ring] > 0 && !has_room(side, ring, sides)) {
        const uint32_t *next = &side->rings->next[2 * (size_t)ring];
        taken[count++] = ring;
        uint32_t inner = next[0] != before && next[0] != MESO_NO_INDEX && side->values[next[0]] > 0 ? next[0] : next[1];
        before = ring;
        ring = inner == taken[count > 1 ? count - 2 : 0] ? MESO_NO_INDEX : inner;
    }
    for (uint32_t i = 0; i < count; i++)
        side->values[taken[i]] = -1e-3f * side->rings->steps[taken[i]];
    return count;
}

bool meso_strands_draw_back(MesoRingShares *shares, const MesoStrandSide *old_side, const MesoStrandSide *new_side,
                            const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    const EndSide sides[2] = {
        {&step->old_rings, step->old_rings.middles, step->old_rings.axes, shares->old_values},
        {&work->rings, shares->new_middles, shares->new_axes, shares->new_values},
    };
    bool changed = false;
    for (uint32_t s = 0; s < old_side->section_count; s++)
        if (old_side->partners[s] == MESO_NO_INDEX)
            changed |= draw_back(&sides[0], sides, old_side->rings[s]);
    for (uint32_t s = 0; s < new_side->section_count; s++)
        if (new_side->partners[s] == MESO_NO_INDEX)
            changed |= draw_back(&sides[1], sides, new_side->rings[s]);
    return changed;
}
