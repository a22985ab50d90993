/*
 * Kinds that are alike: those of a lattice, whose places differ from each other by little, and what one of them has
 * around it all have. Most of a swatch stands at a side of it, where a half of what is to be around it is missing.
 */
#include <string.h>

#include "libcore/quilt/settle/settle_work.h"

/* Spreads are alike that differ by a smaller share of themselves. */
#define ALIKE 0.1f

/* Shares of the spacing: offsets that are the same; so far within the tile a body would be in the swatch. */
#define SAME 0.3f
#define WITHIN 0.3f

/* Those like each other that have more around them, each at another place, are of no lattice. */
enum { MOST_PLACES = 32 };

/* ---- spreads ---- */

static MesoSettleSpread spread_of(const MesoSettleKind *kind)
{
    double sums[6] = {0};
    MesoSettleSpread spread;
    for (uint32_t i = 0; i < kind->point_count; i++) {
        double x = (double)kind->points[i].x, y = (double)kind->points[i].y, z = (double)kind->points[i].z;
        const double products[6] = {x * x, y * y, z * z, x * y, x * z, y * z};
        for (int k = 0; k < 6; k++)
            sums[k] += products[k] / kind->point_count;
    }
    for (int k = 0; k < 6; k++)
        spread.of[k] = (float)sums[k];
    return spread;
}

MesoSettleSpread meso_settle_spread(const MesoSettleWork *work, const MesoSettleBody *body, const MesoPose *axes)
{
    const float *s = work->kinds[body->kind].spread.of;
    const MesoVec3 along[3] = {axes->x, axes->y, axes->z};
    MesoVec3 in[3], out[3];     /* the axes by the body's own, and times its spread */
    for (int k = 0; k < 3; k++) {
        MesoVec3 a = in[k] = meso_settle_from_space(&body->pose, along[k]);
        out[k] = (MesoVec3){s[0] * a.x + s[3] * a.y + s[4] * a.z, s[3] * a.x + s[1] * a.y + s[5] * a.z,
                            s[4] * a.x + s[5] * a.y + s[2] * a.z};
    }
    return (MesoSettleSpread){{meso_vec3_dot(in[0], out[0]), meso_vec3_dot(in[1], out[1]),
                               meso_vec3_dot(in[2], out[2]), meso_vec3_dot(in[0], out[1]),
                               meso_vec3_dot(in[0], out[2]), meso_vec3_dot(in[1], out[2])}};
}

bool meso_settle_alike(const MesoSettleSpread *a, const MesoSettleSpread *b)
{
    float all = 0, off = 0;
    for (int k = 0; k < 6; k++) {
        float d = a->of[k] - b->of[k];
        all += k < 3 ? a->of[k] + b->of[k] : 0;
        off += (k < 3 ? 1 : 2) * d * d;
    }
    return off <= ALIKE * ALIKE * all * all;
}

static void find_likenesses(MesoSettleWork *work)
{
    for (uint32_t k = 0; k < work->kind_count; k++) {
        uint32_t like = 0;
        work->kinds[k].spread = spread_of(&work->kinds[k]);
        while (like < k && (work->kinds[like].likeness != like ||
                            !meso_settle_alike(&work->kinds[like].spread, &work->kinds[k].spread)))
            like++;
        work->kinds[k].likeness = like;
    }
}

/* ---- what is around them ---- */

/* Whether the swatch would have what a kind has at an offset, if it had it. */
static bool is_within(const MesoSettleWork *work, uint32_t kind, MesoVec3 offset)
{
    const MesoSwatch *swatch = work->swatch;
    MesoVec3 centre = swatch->centres[work->members[work->kinds[kind].member_begin]];
    float x = centre.x + offset.x / work->options.scale, y = centre.y + offset.y / work->options.scale;
    float most = WITHIN * work->spacing / work->options.scale;
    return (swatch->periodic_x || (x > most && x < swatch->size.x - most)) &&
           (swatch->periodic_y || (y > most && y < swatch->size.y - most));
}

static bool has(const MesoSettleWork *work, uint32_t kind, const MesoSettleRelation *relation)
{
    const MesoVec2 offset = {relation->offset.x, relation->offset.y};
    const MesoSettleSpread *spread = &work->kinds[relation->kind].spread;
    return meso_settle_relation(work, kind, spread, offset, SAME * work->spacing) != MESO_NO_INDEX;
}

static bool is_same(const MesoSettleWork *work, const MesoSettleRelation *a, const MesoSettleRelation *b)
{
    MesoVec2 apart = {a->offset.x - b->offset.x, a->offset.y - b->offset.y};
    return meso_vec2_length(apart) < SAME * work->spacing &&
           meso_settle_alike(&work->kinds[a->kind].spread, &work->kinds[b->kind].spread);
}

/* Whether all that are like a kind have a relation, as far as the swatch would have it. */
static bool is_common(const MesoSettleWork *work, uint32_t like, const MesoSettleRelation *relation)
{
    for (uint32_t k = like; k < work->kind_count; k++)
        if (work->kinds[k].likeness == like && is_within(work, k, relation->offset) && !has(work, k, relation))
            return false;
    return true;
}

/* What all that are like a kind have around them. */
static uint32_t list_common(MesoSettleRelation places[MOST_PLACES], const MesoSettleWork *work, uint32_t like)
{
    uint32_t count = 0, common = 0;
    for (uint32_t k = like; k < work->kind_count; k++)
        for (uint32_t r = work->kinds[k].relation_begin;
             work->kinds[k].likeness == like && r < work->kinds[k].relation_end; r++) {
            uint32_t i = 0;
            while (i < count && !is_same(work, &places[i], &work->relations[r]))
                i++;
            if (i == MOST_PLACES)
                return 0;
            if (i == count)
                places[count++] = work->relations[r];
        }
    for (uint32_t i = 0; i < count; i++)
        if (is_common(work, like, &places[i]))
            places[common++] = places[i];
    return common;
}

/* Relations of all kinds, one kind after the other as they are like each other. */
typedef struct Relations {
    MesoSettleRelation *list;
    uint32_t count;
    uint32_t *begin, *end;      /* [kind_count] */
} Relations;

static void add_kind(Relations *all, const MesoSettleWork *work, uint32_t kind, const MesoSettleRelation *common,
                     uint32_t common_count)
{
    all->begin[kind] = all->count;
    for (uint32_t r = work->kinds[kind].relation_begin; r < work->kinds[kind].relation_end; r++)
        all->list[all->count++] = work->relations[r];
    for (uint32_t i = 0; i < common_count; i++)
        if (!is_within(work, kind, common[i].offset) && !has(work, kind, &common[i]))
            all->list[all->count++] = common[i];
    all->end[kind] = all->count;
}

MesoStatus meso_settle_borrow(MesoSettleWork *work, MesoError *error)
{
    size_t most = work->relation_count + MOST_PLACES * (size_t)work->kind_count;
    Relations all = {.list = MESO_NEW(work->arena, MesoSettleRelation, most, error),
                     .begin = MESO_NEW(work->arena, uint32_t, work->kind_count, error),
                     .end = MESO_NEW(work->arena, uint32_t, work->kind_count, error)};
    if (!all.list || !all.begin || !all.end)
        return MESO_ERR_MEMORY;
    find_likenesses(work);
    for (uint32_t like = 0; like < work->kind_count; like++) {
        MesoSettleRelation common[MOST_PLACES];
        if (work->kinds[like].likeness != like)
            continue;
        uint32_t count = list_common(common, work, like);
        for (uint32_t k = like; k < work->kind_count; k++)
            if (work->kinds[k].likeness == like)
                add_kind(&all, work, k, common, count);
    }
    for (uint32_t k = 0; k < work->kind_count; k++) {
        work->kinds[k].relation_begin = all.begin[k];
        work->kinds[k].relation_end = all.end[k];
    }
    work->relations = all.list;
    work->relation_count = all.count;
    return MESO_OK;
}
