#include "libcore/mesh/cut/locality.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/math/box.h"

/*
 * "Compact Hilbert Indices" (Hamilton 2006): a cell is entered at corner e and
 * left along axis d; bits of the three coordinates, seen from there, are the
 * Gray code of the octant's place on the curve.
 */

enum { BITS = 10, AXES = 3, STATES = 8 * AXES, RADIX = 1 << BITS };

/* By state e + 8 d, and octant within octant: the place on the curve, and the state within times 64. */
typedef struct HilbertTable {
    uint16_t place_and_state[STATES][64];
} HilbertTable;

static uint32_t rotated(uint32_t bits, uint32_t left)
{
    left %= AXES;
    return (bits << left | bits >> (AXES - left)) & 7;
}

static uint32_t gray(uint32_t i)
{
    return i ^ i >> 1;
}

static uint32_t gray_inverse(uint32_t g)
{
    return g ^ g >> 1 ^ g >> 2;
}

static uint32_t entry_of(uint32_t place)
{
    return place == 0 ? 0 : gray(2 * ((place - 1) / 2));
}

static uint32_t axis_of(uint32_t place)
{
    uint32_t number = place == 0 ? 0 : place % 2 == 0 ? place - 1 : place;
    return number == 0 ? 0 : (uint32_t)__builtin_ctz(~number) % AXES;
}

/* The place of an octant; the state becomes that within it. */
static uint32_t step_down(uint32_t *state, uint32_t octant)
{
    uint32_t e = *state % 8, d = *state / 8;
    uint32_t place = gray_inverse(rotated(octant ^ e, AXES - (d + 1) % AXES));
    *state = (e ^ rotated(entry_of(place), d + 1)) + 8 * ((d + axis_of(place) + 1) % AXES);
    return place;
}

static void fill_table(HilbertTable *table)
{
    for (uint32_t s = 0; s < STATES; s++)
        for (uint32_t octants = 0; octants < 64; octants++) {
            uint32_t state = s, place = step_down(&state, octants / 8);
            place = 8 * place + step_down(&state, octants % 8);
            table->place_and_state[s][octants] = (uint16_t)(place | state << 6);
        }
}

/* Two bits of each coordinate, apart: those of a coordinate in an octant are three apart. */
static uint32_t octants_of(uint32_t x, uint32_t y, uint32_t z)
{
    static const uint8_t apart[4] = {0, 1, 8, 9};
    return apart[x & 3] | (uint32_t)apart[y & 3] << 1 | (uint32_t)apart[z & 3] << 2;
}

static uint32_t hilbert_key(const HilbertTable *table, const uint32_t cell[AXES])
{
    uint32_t key = 0, state = 0;
    for (uint32_t bit = BITS; bit > 0;) {
        bit -= 2;
        uint32_t step = table->place_and_state[state][octants_of(cell[0] >> bit, cell[1] >> bit, cell[2] >> bit)];
        key = key << 2 * AXES | (step & 63);
        state = step >> 6;
    }
    return key;
}

/* ---- vertices ---- */

typedef struct Grid {
    MesoVec3 low;
    float scale;    /* cells a unit of length */
} Grid;

static Grid grid_of(const MesoVec3 *positions, uint32_t count)
{
    MesoBox box = meso_box_of(positions, count);
    MesoVec3 extent = meso_vec3_sub(box.high, box.low);
    float size = fmaxf(extent.x, fmaxf(extent.y, extent.z));
    return (Grid){box.low, size > 0 ? (float)(RADIX - 1) / size : 0};
}

static uint32_t cell_of(float coordinate, float low, float scale)
{
    float cell = (coordinate - low) * scale;
    return cell > 0 ? cell < (float)(RADIX - 1) ? (uint32_t)cell : RADIX - 1 : 0;
}

/* How often each digit comes, then where its items begin: of each of the three digits. */
typedef struct Digits {
    uint32_t begins[AXES][RADIX];
} Digits;

/* Keys above, vertices below. */
static void fill_keys(const MesoVec3 *positions, uint32_t count, uint64_t *items, Digits *digits)
{
    HilbertTable table;
    fill_table(&table);
    Grid grid = grid_of(positions, count);
    for (uint32_t v = 0; v < count; v++) {
        MesoVec3 p = positions[v];
        uint32_t cell[AXES] = {cell_of(p.x, grid.low.x, grid.scale), cell_of(p.y, grid.low.y, grid.scale),
                               cell_of(p.z, grid.low.z, grid.scale)};
        uint32_t key = hilbert_key(&table, cell);
        items[v] = (uint64_t)key << 32 | v;
        for (uint32_t k = 0; k < AXES; k++)
            digits->begins[k][key >> BITS * k & (RADIX - 1)]++;
    }
    for (uint32_t k = 0; k < AXES; k++)
        for (uint32_t d = 0, begin = 0; d < RADIX; d++) {
            uint32_t size = digits->begins[k][d];
            digits->begins[k][d] = begin;
            begin += size;
        }
}

/* Where an item goes, by one of the digits of its key. */
static uint32_t next_place(Digits *digits, uint32_t k, uint64_t item)
{
    return digits->begins[k][item >> (32 + BITS * k) & (RADIX - 1)]++;
}

/* From the last digit to the first; of what the first says, only the vertices are wanted. */
static bool order_vertices(const MesoVec3 *positions, uint32_t count, const MesoLocality *order)
{
    uint64_t *items = malloc((2 * (size_t)count + 1) * sizeof *items);
    if (!items)
        return false;
    uint64_t *spare = items + count;
    Digits digits = {0};
    fill_keys(positions, count, items, &digits);
    for (uint32_t i = 0; i < count; i++)
        spare[next_place(&digits, 0, items[i])] = items[i];
    for (uint32_t i = 0; i < count; i++)
        items[next_place(&digits, 1, spare[i])] = spare[i];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t v = (uint32_t)items[i], place = next_place(&digits, 2, items[i]);
        order->old_vertex[place] = v;
        order->new_vertex[v] = place;
    }
    free(items);
    return true;
}

/* ---- triangles ---- */

static uint32_t least_vertex(const uint32_t *corners, const uint32_t *new_vertex)
{
    uint32_t a = new_vertex[corners[0]], b = new_vertex[corners[1]], c = new_vertex[corners[2]];
    a = a < b ? a : b;
    return a < c ? a : c;
}

/* By counting; until its place is known, a triangle's least vertex stands for it. */
static bool order_triangles(const uint32_t *corners, uint32_t count, uint32_t vertex_count, const MesoLocality *order)
{
    uint32_t *begins = calloc((size_t)vertex_count + 1, sizeof *begins), *places = order->new_triangle;
    if (!begins)
        return false;
    for (uint32_t t = 0; t < count; t++) {
        places[t] = least_vertex(corners + 3 * (size_t)t, order->new_vertex);
        begins[places[t] + 1]++;
    }
    for (uint32_t v = 0; v < vertex_count; v++)
        begins[v + 1] += begins[v];
    for (uint32_t t = 0; t < count; t++) {
        places[t] = begins[places[t]]++;
        order->old_triangle[places[t]] = t;
    }
    free(begins);
    return true;
}

MesoStatus meso_locality_order(const MesoVec3 *positions, uint32_t vertex_count, const uint32_t *corners,
                               uint32_t triangle_count, const MesoLocality *order, MesoError *error)
{
    if (order_vertices(positions, vertex_count, order) && order_triangles(corners, triangle_count, vertex_count, order))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory: the order of %u vertices", vertex_count);
}
