#include "libcore/quilt/swatch/swatch_finer.h"

#include <math.h>

/* Triangles are the same within this part of the mean edge. */
static const double ALIKE = 0.01;

/* Beyond so many there are no triangles to tell copies by, or nothing that a finer period would be of use for. */
enum { MOST_COPIES = 64 };

typedef struct Spot {
    double at[3], area[3];      /* the middle, wrapped into the tile; the area vector */
    uint32_t material, next;    /* in the list of its cell */
} Spot;

typedef struct Spots {
    Spot *spots;                /* [count] */
    uint32_t *first;            /* [mask + 1] of the list of a cell's hash, or MESO_NO_INDEX */
    uint32_t count, mask;
    double period[2];           /* 0: not periodic */
    double tolerance, cell;
} Spots;

static double wrapped(double x, double period)
{
    return period > 0 ? x - period * floor(x / period) : x;
}

static uint32_t hash_cell(const Spots *s, const int64_t cell[3])
{
    uint64_t h = (uint64_t)cell[0] * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 29) + (uint64_t)cell[1] * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 32) + (uint64_t)cell[2] * 0x94d049bb133111ebu;
    return (uint32_t)(h ^ h >> 31) & s->mask;
}

static Spot spot_of(const Spots *s, const MesoSwatch *swatch, uint32_t triangle)
{
    Spot spot = {.material = swatch->materials[triangle]};
    MesoVec3 p[3];
    for (uint32_t k = 0; k < 3; k++)
        p[k] = swatch->positions[swatch->corners[3 * (size_t)triangle + k]];
    MesoVec3 area = meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0]));
    const double sums[3] = {(double)p[0].x + p[1].x + p[2].x, (double)p[0].y + p[1].y + p[2].y,
                            (double)p[0].z + p[1].z + p[2].z};
    const double areas[3] = {area.x, area.y, area.z};
    for (int k = 0; k < 3; k++) {
        spot.at[k] = wrapped(sums[k] / 3, k < 2 ? s->period[k] : 0);
        spot.area[k] = areas[k];
    }
    return spot;
}

static MesoStatus gather(Spots *s, const MesoSwatch *swatch, MesoArena *scratch, MesoError *error)
{
    *s = (Spots){.count = swatch->triangle_count, .period = {swatch->period.x, swatch->period.y},
                 .tolerance = ALIKE * (double)swatch->mean_edge, .cell = (double)swatch->mean_edge / 2};
    s->mask = 1;
    while (s->mask < s->count)
        s->mask = 2 * s->mask + 1;
    s->spots = MESO_NEW(scratch, Spot, s->count, error);
    s->first = MESO_NEW(scratch, uint32_t, (size_t)s->mask + 1, error);
    if (!s->spots || !s->first)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i <= s->mask; i++)
        s->first[i] = MESO_NO_INDEX;
    for (uint32_t t = 0; t < s->count; t++) {
        Spot spot = spot_of(s, swatch, t);
        int64_t cell[3];
        for (int k = 0; k < 3; k++)
            cell[k] = (int64_t)floor(spot.at[k] / s->cell);
        uint32_t *first = &s->first[hash_cell(s, cell)];
        spot.next = *first;
        s->spots[t] = spot;
        *first = t;
    }
    return MESO_OK;
}

static bool is_alike(const Spots *s, const Spot *a, const double at[3], const Spot *b)
{
    double off = 0, turned = 0, area = 0;
    for (int k = 0; k < 3; k++) {
        double x = fabs(a->at[k] - at[k]), turn = a->area[k] - b->area[k];
        if (k < 2 && s->period[k] > 0)
            x = fmin(x, s->period[k] - x);
        off = fmax(off, x);
        turned += turn * turn;
        area += b->area[k] * b->area[k];
    }
    /* corners that are off by the tolerance turn and grow a triangle by so much of its sides */
    double allowed = 8 * s->tolerance * sqrt(sqrt(area)) + 4 * s->tolerance * s->tolerance;
    return a->material == b->material && off <= s->tolerance && turned <= allowed * allowed;
}

/* Whether there is one like `spot` at a place: in the cells that are within the tolerance. */
static bool is_there(const Spots *s, const double place[3], const Spot *spot)
{
    for (uint32_t corner = 0; corner < 8; corner++) {
        int64_t cell[3];
        for (int k = 0; k < 3; k++) {
            double x = place[k] + (corner >> k & 1 ? s->tolerance : -s->tolerance);
            cell[k] = (int64_t)floor(wrapped(x, k < 2 ? s->period[k] : 0) / s->cell);
        }
        for (uint32_t i = s->first[hash_cell(s, cell)]; i != MESO_NO_INDEX; i = s->spots[i].next)
            if (is_alike(s, &s->spots[i], place, spot))
                return true;
    }
    return false;
}

static bool maps_onto_itself(const Spots *s, int along, double by)
{
    for (uint32_t i = 0; i < s->count; i++) {
        double place[3] = {s->spots[i].at[0], s->spots[i].at[1], s->spots[i].at[2]};
        place[along] = wrapped(place[along] + by, s->period[along]);
        if (!is_there(s, place, &s->spots[i]))
            return false;
    }
    return true;
}

static uint32_t count_copies(const Spots *s, int along)
{
    uint32_t copies = 1;
    for (uint32_t n = 2; n <= MOST_COPIES && s->period[along] > 4 * s->tolerance * n; n++)
        if (s->count % n == 0 && maps_onto_itself(s, along, s->period[along] / n))
            copies = n;
    return copies;
}

MesoStatus meso_swatch_refine_period(MesoSwatch *swatch, MesoArena *scratch, MesoError *error)
{
    Spots spots;
    if ((!swatch->periodic_x && !swatch->periodic_y) || !(swatch->mean_edge > 0))
        return MESO_OK;
    MesoStatus status = gather(&spots, swatch, scratch, error);
    if (status)
        return status;
    if (swatch->periodic_x)
        swatch->period.x = (float)(spots.period[0] / count_copies(&spots, 0));
    if (swatch->periodic_y)
        swatch->period.y = (float)(spots.period[1] / count_copies(&spots, 1));
    return MESO_OK;
}
