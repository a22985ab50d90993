#include "libcore/replicate/plan/detail_cells.h"

enum { BINS = MESO_TARGET_BINS, NEAREST = MESO_ORIGINAL_NEAR, NEIGHBOURS = 27, OWN = NEIGHBOURS / 2 };

/* A detail that lives, with all that is asked of it in one place of memory. */
struct MesoDetailSpot {
    MesoVec3 place, normal;
    uint32_t detail;
    uint64_t cell;
};

struct MesoDetailSlot {
    uint32_t begin, end;        /* spots */
    uint32_t later;             /* the first of those that came later, or MESO_NO_INDEX */
};

typedef MesoDetailSpot Spot;
typedef MesoDetailSlot Slot;

static int32_t cell_at(float x, float width)
{
    return (int32_t)fminf(fmaxf(floorf(x / width), -1e9f), 1e9f);
}

/* The same for cells that are 2^21 apart alone. */
static uint64_t cell_of(int32_t x, int32_t y, int32_t z)
{
    const uint64_t mask = 0x1fffff;
    return ((uint64_t)(uint32_t)x & mask) << 42 | ((uint64_t)(uint32_t)y & mask) << 21 | ((uint64_t)(uint32_t)z & mask);
}

typedef struct Cell {
    int32_t x, y, z;
} Cell;

static Cell cell_under(const MesoDetailCells *cells, MesoVec3 p)
{
    return (Cell){cell_at(p.x, cells->radius), cell_at(p.y, cells->radius), cell_at(p.z, cells->radius)};
}

/* A neighbour; OWN is the cell itself, and k and NEIGHBOURS - 1 - k are on opposite sides. */
static uint64_t cell_beside(Cell cell, int32_t k)
{
    return cell_of(cell.x + k % 3 - 1, cell.y + k / 3 % 3 - 1, cell.z + k / 9 - 1);
}

static uint64_t cell_with(const MesoDetailCells *cells, MesoVec3 p)
{
    return cell_beside(cell_under(cells, p), OWN);
}

static uint32_t slot_of(const MesoDetailCells *cells, uint64_t cell)
{
    return (uint32_t)((cell ^ cell >> 31) * 0x9e3779b97f4a7c15u >> 32) & cells->mask;
}

void meso_cells_put(MesoDetailCells *cells, uint32_t detail, MesoVec3 place, MesoVec3 normal)
{
    Spot spot = {place, normal, detail, cell_with(cells, place)};
    Slot *slot = &cells->slots[slot_of(cells, spot.cell)];
    cells->next[cells->spot_count - cells->first_later] = slot->later;
    slot->later = cells->spot_count;
    cells->spots[cells->spot_count++] = spot;
}

void meso_cells_take(MesoDetailCells *cells, uint32_t detail, MesoVec3 place)
{
    Slot *slot = &cells->slots[slot_of(cells, cell_with(cells, place))];
    uint32_t at = slot->begin;
    while (cells->spots[at].detail != detail)
        at++;
    cells->spots[at] = cells->spots[--slot->end];
}

MesoStatus meso_cells_build(MesoDetailCells *cells, MesoReplication *r, double radius, uint32_t later,
                            MesoError *error)
{
    uint32_t n = r->detail_count;
    const MesoVec3 *places = r->web.positions + r->web.fixed_count, *normals = r->web.normals + r->web.fixed_count;
    *cells = (MesoDetailCells){.radius = (float)radius, .mask = 255};
    while (cells->mask < n)
        cells->mask = 2 * cells->mask + 1;
    cells->slots = MESO_NEW(&r->scratch, Slot, (size_t)cells->mask + 2, error);
    cells->spots = MESO_NEW(&r->scratch, Spot, (size_t)n + later + 1, error);
    cells->next = MESO_NEW(&r->scratch, uint32_t, (size_t)later + 1, error);
    if (!cells->slots || !cells->spots || !cells->next)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        if (meso_lives(r, i))
            cells->slots[slot_of(cells, cell_with(cells, places[i])) + 1].begin++;
    for (uint32_t s = 0; s <= cells->mask; s++) {
        cells->slots[s + 1].begin += cells->slots[s].begin;
        cells->slots[s].end = cells->slots[s].begin;
        cells->slots[s].later = MESO_NO_INDEX;
    }
    for (uint32_t i = 0; i < n; i++) {
        Spot spot = {places[i], normals[i], i, cell_with(cells, places[i])};
        if (meso_lives(r, i))
            cells->spots[cells->slots[slot_of(cells, spot.cell)].end++] = spot;
    }
    cells->spot_count = cells->first_later = cells->slots[cells->mask + 1].begin;
    return MESO_OK;
}

/* ---- around a place ---- */

static void see(MesoVicinity *v, uint32_t detail, float d2, float bins_a_length)
{
    float at = sqrtf(d2) * bins_a_length;
    if (at < BINS)
        v->counts.of[(uint32_t)at]++;
    if (d2 < v->near[0])
        v->nearest = detail;
    for (uint32_t k = 0; k < NEAREST; k++)
        if (d2 < v->near[k]) {
            float further = v->near[k];
            v->near[k] = d2;
            d2 = further;
        }
}

/* Squared; INFINITY where it is not seen from there. */
static float distance2_to(const Spot *spot, uint64_t cell, MesoVec3 place, MesoVec3 normal)
{
    MesoVec3 apart = meso_vec3_sub(spot->place, place);
    return spot->cell == cell && !(meso_vec3_dot(spot->normal, normal) < 0) ? meso_vec3_dot(apart, apart) : INFINITY;
}

void meso_cells_look(MesoVicinity *v, const MesoDetailCells *cells, MesoVec3 place, MesoVec3 normal, uint32_t self)
{
    float most2 = cells->radius * cells->radius, bins_a_length = BINS / cells->radius;
    *v = (MesoVicinity){.nearest = MESO_NO_INDEX};
    for (uint32_t k = 0; k < NEAREST; k++)
        v->near[k] = INFINITY;
    Cell under = cell_under(cells, place);
    for (int32_t k = 0; k < NEIGHBOURS; k++) {
        uint64_t cell = cell_beside(under, k);
        const Slot *slot = &cells->slots[slot_of(cells, cell)];
        for (uint32_t i = slot->begin; i < slot->end; i++) {
            float d2 = distance2_to(&cells->spots[i], cell, place, normal);
            if (d2 < most2 && cells->spots[i].detail != self)
                see(v, cells->spots[i].detail, d2, bins_a_length);
        }
        for (uint32_t i = slot->later; i != MESO_NO_INDEX; i = cells->next[i - cells->first_later]) {
            float d2 = distance2_to(&cells->spots[i], cell, place, normal);
            if (d2 < most2 && cells->spots[i].detail != self)
                see(v, cells->spots[i].detail, d2, bins_a_length);
        }
    }
}

/* ---- in the mean ---- */

/* Where all count each pair is met once, from one of its sides. */
static void count_from(uint64_t bins[BINS], const MesoDetailCells *cells, uint32_t at, bool all,
                       const uint8_t *left_out)
{
    const Spot *self = &cells->spots[at];
    float most2 = cells->radius * cells->radius, bins_a_length = BINS / cells->radius;
    uint64_t own = !left_out || !left_out[self->detail];
    Cell under = cell_under(cells, self->place);
    for (int32_t k = 0; k < (all ? OWN + 1 : NEIGHBOURS); k++) {
        uint64_t cell = cell_beside(under, k);
        const Slot *slot = &cells->slots[slot_of(cells, cell)];
        for (uint32_t i = slot->begin; i < slot->end; i++) {
            float d2 = distance2_to(&cells->spots[i], cell, self->place, self->normal);
            if (!(d2 < most2) || i == at || (all && k == OWN && i < at))
                continue;
            float bin = sqrtf(d2) * bins_a_length;
            if (bin < BINS)
                bins[(uint32_t)bin] += own + (all && (!left_out || !left_out[cells->spots[i].detail]));
        }
    }
}

MesoPairCounts meso_cells_mean(const MesoDetailCells *cells, uint32_t stride, const uint8_t *left_out,
                               uint32_t *counted)
{
    uint64_t bins[BINS] = {0};
    MesoPairCounts mean = {{0}};
    *counted = 0;
    for (uint32_t i = 0; i < cells->first_later; i++) {
        bool counts = !left_out || !left_out[cells->spots[i].detail];
        if (cells->spots[i].detail % stride != 0 || (stride > 1 && !counts))
            continue;
        count_from(bins, cells, i, stride == 1, left_out);
        *counted += counts;
    }
    for (uint32_t b = 0; b < BINS && *counted; b++)
        mean.of[b] = (double)bins[b] / *counted;
    return mean;
}
