#include "cmd/replicate/replicate_originals.h"

#include <stdlib.h>

#include "cmd/replicate/replicate_places.h"
#include "libcore/base/random.h"
#include "libcore/field/triangle_frames.h"

/* A distribution, and what it draws from. */
typedef struct Drawing {
    const MesoReplicateGround *ground;
    const MesoDetailsFile *file;
    const MesoDetailDistribution *said;
    MesoRandom random;
    MesoGrowthMap sizes, density;
    MesoVec3 *headings;         /* [triangle_count] of an attribute; NULL: none */
} Drawing;

static double share_of(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) * 0x1p-53;
}

static double map_at(const Drawing *d, const MesoGrowthMap *map, const MesoMeshPoint *point)
{
    const double weight[3] = {(double)point->weight[0], (double)point->weight[1], (double)point->weight[2]};
    return meso_map_value(&d->ground->ground, map, point->triangle, weight);
}

static float between(const float range[2], double share)
{
    return (float)((double)range[0] + share * ((double)range[1] - (double)range[0]));
}

static uint32_t kind_at(const Drawing *d, double share)
{
    uint32_t kind = 0;
    while (kind + 1 < d->file->kind_count && !(share < (double)d->said->shares[kind]))
        share -= (double)d->said->shares[kind++];
    while (kind > 0 && !(d->said->shares[kind] > 0))    /* of rounding */
        kind--;
    return kind;
}

/* Laid into the triangle; any where it is across. */
static float angle_to(const Drawing *d, uint32_t triangle, MesoVec3 direction, double otherwise)
{
    const MesoTriangleFrame frame = meso_frame(d->ground->ground.mesh, triangle);
    MesoComplex along = meso_frame_in(&frame, direction);
    return (float)(along.re != 0 || along.im != 0 ? atan2(along.im, along.re) : otherwise);
}

static float heading_at(Drawing *d, const MesoDetailPlace *place)
{
    const double pi = 3.14159265358979323846;
    const MesoDetailHeading *heading = &d->said->heading;
    double random = 2 * pi * share_of(&d->random) - pi, spread = 2 * share_of(&d->random) - 1;
    uint32_t triangle = place->point.triangle;
    bool of_scene = d->said->source == MESO_DETAILS_OF_SCENE && heading->source != MESO_HEADING_SCENE;
    if (place->said.headed && !of_scene)
        return angle_to(d, triangle, place->said.direction, random);
    if (heading->source == MESO_HEADING_RANDOM || heading->source == MESO_HEADING_SCENE)
        return (float)random;
    MesoVec3 along = heading->source == MESO_HEADING_DIRECTION ? heading->direction : d->headings[triangle];
    return angle_to(d, triangle, along, random) + (float)(spread * (double)heading->spread);
}

/* Draws the same numbers whatever is said, so that what is said of one does not change the others. */
static bool draw(Drawing *d, const MesoDetailPlace *place, MesoDetail *out)
{
    const MesoDetailDistribution *said = d->said;
    double stays = share_of(&d->random), size = share_of(&d->random), aspect = share_of(&d->random);
    double kind = share_of(&d->random);
    bool own = isfinite(place->said.size) && !(said->source == MESO_DETAILS_OF_SCENE && said->sized);
    out->point = place->point;
    out->angle = heading_at(d, place);
    if (said->size_map.given)
        size = map_at(d, &d->sizes, &place->point);
    out->size = own ? place->said.size : between(said->size, size);
    out->width = out->size * (isfinite(place->said.aspect) ? place->said.aspect : between(said->aspect, aspect));
    out->kind = place->said.kind != MESO_NO_INDEX ? place->said.kind : kind_at(d, kind);
    bool dense = said->source == MESO_DETAILS_POISSON || said->source == MESO_DETAILS_SCATTERED;
    return dense || stays < map_at(d, &d->density, &place->point);
}

static MesoStatus add_distribution(MesoOriginals *out, const MesoReplicateGround *g, const MesoDetailsFile *file,
                                   uint32_t number)
{
    MesoTool *tool = g->tool;
    Drawing d = {.ground = g, .file = file, .said = &file->distributions[number]};
    MesoDetailPlaces places = {0};
    MesoStatus status = meso_replicate_map(&d.sizes, g, &d.said->size_map);
    meso_random_init(&d.random, tool->seed, 1 + number);
    if (!status)
        status = meso_replicate_map(&d.density, g, &d.said->density);
    if (!status && d.said->heading.source == MESO_HEADING_ATTRIBUTE)
        status = meso_replicate_vectors(&d.headings, g, d.said->heading.attribute);
    if (!status)
        status = meso_replicate_places(&places, g, d.said, &d.density, meso_random_next(&d.random));
    if (status)
        return status;
    MesoDetail *all = MESO_NEW(&tool->arena, MesoDetail, (size_t)out->count + places.count, &tool->error);
    if (!all)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < out->count; i++)
        all[i] = out->details[i];
    for (uint32_t i = 0; i < places.count; i++)
        out->count += draw(&d, &places.places[i], &all[out->count]);
    out->details = all;
    return MESO_OK;
}

/* `rank` is the number that a detail had, for the time of the sort. */
static int by_triangle(const void *a, const void *b)
{
    const MesoDetail *x = a, *y = b;
    if (x->point.triangle != y->point.triangle)
        return x->point.triangle < y->point.triangle ? -1 : 1;
    return x->rank < y->rank ? -1 : x->rank > y->rank;
}

MesoStatus meso_replicate_originals(MesoOriginals *out, const MesoReplicateGround *g, const MesoDetailsFile *file)
{
    MesoStatus status = MESO_OK;
    *out = (MesoOriginals){0};
    for (uint32_t i = 0; i < file->distribution_count && !status; i++)
        status = add_distribution(out, g, file, i);
    if (!status && out->count == 0)
        return meso_fail(&g->tool->error, MESO_ERR_INPUT, "%s: no detail has a place on the surface",
                         g->tool->operands[0]);
    for (uint32_t i = 0; i < out->count && !status; i++)
        out->details[i].rank = i;
    if (!status)
        qsort(out->details, out->count, sizeof *out->details, by_triangle);
    return status;
}
