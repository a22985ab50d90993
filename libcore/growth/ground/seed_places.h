/* Where seeds may be: places by their kinds, before anything is asked of them. Inside of growth_seeds.c. */
#ifndef MESO_SEED_PLACES_H
#define MESO_SEED_PLACES_H

#include "libcore/base/grow.h"
#include "libcore/growth/ground/growth_contexts.h"
#include "libcore/growth/ground/surface_reach.h"
#include "libcore/growth/language/grammar_draw.h"

/* The number is the place's own: of where it is rather than of how many came before, so that others may come and go. */
typedef struct MesoSeedPlace {
    MesoSurfacePlace at;
    uint64_t number;
} MesoSeedPlace;

/* A seed whose places are looked for. */
typedef struct MesoSeedWork {
    MesoArena *arena;
    const MesoGrammar *grammar;
    const MesoGrammarSeed *seed;
    const MesoGrowthContexts *contexts;
    uint64_t job;
    uint32_t thread_count;
    const MesoMeshPoint *points;    /* [point_count] that a file names for it */
    const uint8_t *breaks;          /* likewise; may be NULL */
    uint32_t point_count;
    MesoSeedPlace *places;          /* [count] found, in order */
    uint32_t count, room;
    MesoError *error;
} MesoSeedWork;

/* Of every kind: add places in their order. Errors as of meso_growth_seeds(). */
MesoStatus meso_places_poisson(MesoSeedWork *work);
MesoStatus meso_places_density(MesoSeedWork *work);
MesoStatus meso_places_points(MesoSeedWork *work);
MesoStatus meso_places_at(MesoSeedWork *work);
MesoStatus meso_places_vertices(MesoSeedWork *work);
MesoStatus meso_places_border(MesoSeedWork *work);
MesoStatus meso_places_curve(MesoSeedWork *work);

/* ---- what they share ---- */

MesoStatus meso_place_add(MesoSeedWork *work, const MesoSurfacePlace *at, uint64_t number);

/* The value of code at a place; of a branch before its first command there, with nothing grown. */
double meso_place_value(const MesoSeedWork *work, uint32_t code, const MesoTip *tip, uint64_t key);

/* A number of the seed's places that may depend on the place; `number` is for draws. */
double meso_place_number(const MesoSeedWork *work, const MesoGrammarValue *value, const MesoSurfacePlace *at,
                         uint64_t number);

/* MESO_ERR_INPUT: `what` at a place is no number, with the line of the text. */
MesoStatus meso_place_fault(const MesoSeedWork *work, const MesoGrammarValue *value, const char *what);

/* A hash of where a point of space is. */
static inline uint64_t meso_place_hash(MesoVec3 p)
{
    union {
        float value;
        uint32_t bits;
    } x = {p.x + 0.0f}, y = {p.y + 0.0f}, z = {p.z + 0.0f};   /* -0 is 0 */
    return meso_draw_mix(meso_draw_mix(((uint64_t)x.bits << 32 | y.bits) + 0x9e3779b97f4a7c15u) + z.bits);
}

static inline int meso_place_compare(MesoVec3 a, MesoVec3 b)
{
    if (a.x != b.x)
        return a.x < b.x ? -1 : 1;
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return a.z < b.z ? -1 : a.z > b.z;
}

/* A triangle by where its corners are, whatever their numbers and their order: `order` [3] is by position. */
uint64_t meso_place_triangle(const MesoTriangulation *mesh, uint32_t triangle, uint32_t order[3]);

double meso_place_area(const MesoTriangulation *mesh, uint32_t triangle);

#endif
