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

/* By state e + 8 d and octant: its place on the curve, and the state within it times 8. */
typedef struct HilbertTable {
    uint8_t place_and_state[STATES][8];
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

static void fill_table(HilbertTable *table)
{
    for (uint32_t d = 0; d < AXES; d++)
        for (uint32_t e = 0; e < 8; e++)
            for (uint32_t octant = 0; octant < 8; octant++) {
                uint32_t place = gray_inverse(rotated(octant ^ e, AXES - (d + 1) % AXES));
                uint32_t entry = e ^ rotated(entry_of(place), d + 1), axis = (d + axis_of(place) + 1) % AXES;
                table->place_and_state[e + 8 * d][octant] = (uint8_t)(place | (entry + 8 * axis) << 3);
            }
}

static uint32_t hilbert_key(const HilbertTable *table, const uint32_t cell[AXES])
{
    uint32_t key = 0, state = 0;
    for (uint32_t bit = BITS; bit-- > 0;) {
        uint32_t octant = (cell[0] >> bit & 1) | (cell[1] >> bit & 1) << 1 | (cell[2] >> bit & 1) << 2;
        uint32_t step = table->place_and_state[state][octant];
        key = key << AXES | (step & 7);
        state = step >> 3;
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

/* Keys above, vertices below. */
static void fill_keys(const MesoVec3 *positions, uint32_t count, uint64_t *items)
{
    HilbertTable table;
    fill_table(&table);
    Grid grid = grid_of(positions, count);
    for (uint32_t v = 0; v < count; v++) {
        MesoVec3 p = positions[v];
        uint32_t cell[AXES] = {cell_of(p.x, grid.low.x, grid.scale), cell_of(p.y, grid.low.y, grid.scale),
                               cell_of(p.z, grid.low.z, grid.scale)};
        items[v] = (uint64_t)hilbert_key(&table, cell) << 32 | v;
    }
}

static void sort_by_digit(uint64_t *from, uint64_t *to, uint32_t count, uint32_t shift)
{
    uint32_t begins[RADIX + 1] = {0};
    for (uint32_t i = 0; i < count; i++)
        begins[(from[i] >> shift & (RADIX - 1)) + 1]++;
    for (uint32_t d = 0; d < RADIX; d++)
        begins[d + 1] += begins[d];
    for (uint32_t i = 0; i < count; i++)
        to[begins[from[i] >> shift & (RADIX - 1)]++] = from[i];
}

static bool order_vertices(const MesoVec3 *positions, uint32_t count, uint32_t *old)
{
    uint64_t *items = malloc((2 * (size_t)count + 1) * sizeof *items);
    if (!items)
        return false;
    uint64_t *spare = items + count;
    fill_keys(positions, count, items);
    sort_by_digit(items, spare, count, 32);
    sort_by_digit(spare, items, count, 32 + BITS);
    sort_by_digit(items, spare, count, 32 + 2 * BITS);
    for (uint32_t v = 0; v < count; v++)
        old[v] = (uint32_t)spare[v];
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

/* By counting, twice over the corners: nothing but numbers of triangles is moved. */
static bool order_triangles(const uint32_t *corners, uint32_t count, const uint32_t *new_vertex, uint32_t vertex_count,
                            uint32_t *old)
{
    uint32_t *begins = calloc((size_t)vertex_count + 1, sizeof *begins);
    uint32_t *keys = malloc(((size_t)count + 1) * sizeof *keys);
    bool done = begins && keys;
    if (done) {
        for (uint32_t t = 0; t < count; t++) {
            keys[t] = least_vertex(corners + 3 * (size_t)t, new_vertex);
            begins[keys[t] + 1]++;
        }
        for (uint32_t v = 0; v < vertex_count; v++)
            begins[v + 1] += begins[v];
        for (uint32_t t = 0; t < count; t++)
            old[begins[keys[t]]++] = t;
    }
    free(begins);
    free(keys);
    return done;
}

MesoStatus meso_locality_order(const MesoVec3 *positions, uint32_t vertex_count, const uint32_t *corners,
                               uint32_t triangle_count, uint32_t *old_vertex, uint32_t *old_triangle, MesoError *error)
{
    uint32_t *new_vertex = malloc(((size_t)vertex_count + 1) * sizeof *new_vertex);
    bool done = new_vertex && order_vertices(positions, vertex_count, old_vertex);
    if (done) {
        for (uint32_t v = 0; v < vertex_count; v++)
            new_vertex[old_vertex[v]] = v;
        done = order_triangles(corners, triangle_count, new_vertex, vertex_count, old_triangle);
    }
    free(new_vertex);
    return done ? MESO_OK : meso_fail(error, MESO_ERR_MEMORY, "out of memory: the order of %u vertices", vertex_count);
}
