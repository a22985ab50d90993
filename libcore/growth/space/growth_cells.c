#include "libcore/growth/space/growth_cells.h"

#include <stdlib.h>
#include <string.h>

/* Blocks of a cell from which on it may be quartered: at this number, and whenever it has doubled. */
enum { MANY = 8 };

/* Of a triangle's size: cells reach so much farther than the squares that they are, for whatever is rounded. */
static const double beyond = 1e-9;

MesoStatus meso_growth_cells_init(MesoGrowthCells *cells, const MesoWalkGround *ground, MesoError *error)
{
    *cells = (MesoGrowthCells){.ground = ground, .unused = MESO_NO_INDEX};
    uint32_t count = ground->triangle_count;
    if (!meso_make_room((void **)&cells->heads, &cells->head_room, (uint64_t)count + 1, sizeof *cells->heads))
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u triangles", count);
    memset(cells->heads, 0xff, count * sizeof *cells->heads);
    cells->head_count = count;
    return MESO_OK;
}

void meso_growth_cells_release(MesoGrowthCells *cells)
{
    free(cells->heads);
    free(cells->blocks);
    free(cells->ends);
    free(cells->elements);
}

/* ---- squares ---- */

/* The triangle itself: its longest side is the base of its frame. */
static MesoComplex middle_of(double size)
{
    return (MesoComplex){0.5 * size, 0.5 * size};
}

static MesoComplex middle_of_quarter(MesoComplex middle, double half, uint32_t k)
{
    double by = 0.5 * half;
    return (MesoComplex){middle.re + (k & 1 ? by : -by), middle.im + (k & 2 ? by : -by)};
}

/* Bits: on which sides of the middle, that of less and that of more, a stretch from a to b is, or may be. */
static inline uint32_t sides_of(double a, double b, double half, double slack)
{
    double least = a < b ? a : b, most = a < b ? b : a;
    uint32_t less = (least <= slack) & (most >= -half - slack), more = (most >= -slack) & (least <= half + slack);
    return less | more << 1;
}

/*
 * Bit k: a segment goes through quarter k of a square, or may do so. Its box reaches the quarter's, and the quarter's
 * middle lies no farther from its line than a corner of the quarter may.
 */
static inline uint32_t quarters_through(const MesoComplex ends[2], MesoComplex middle, double half, double size)
{
    static const uint8_t of_columns[4] = {0, 0x5, 0xa, 0xf}, of_rows[4] = {0, 0x3, 0xc, 0xf};
    double x0 = ends[0].re - middle.re, y0 = ends[0].im - middle.im;
    double x1 = ends[1].re - middle.re, y1 = ends[1].im - middle.im;
    double slack = beyond * size, by = 0.5 * half, x = x1 - x0, y = y1 - y0;
    double turn = x * y0 - y * x0, reach = (fabs(x) + fabs(y)) * (by + slack);
    double rises = (x - y) * by, falls = (x + y) * by;
    uint32_t near = (uint32_t)(fabs(turn + rises) <= reach) | (uint32_t)(fabs(turn + falls) <= reach) << 1 |
                    (uint32_t)(fabs(turn - falls) <= reach) << 2 | (uint32_t)(fabs(turn - rises) <= reach) << 3;
    return near & of_columns[sides_of(x0, x1, half, slack)] & of_rows[sides_of(y0, y1, half, slack)];
}

/* ---- growing ---- */

/* A square of heads[slot]. */
typedef struct Place {
    uint32_t slot, depth;
    MesoComplex middle;
    double half;                /* of its side */
    double size;                /* of the triangle */
} Place;

static Place quarter_of(const Place *place, uint32_t first, uint32_t k)
{
    return (Place){first + k, place->depth + 1, middle_of_quarter(place->middle, place->half, k), 0.5 * place->half,
                   place->size};
}

/* False where memory is out. */
static bool begin_block(MesoGrowthCells *cells, uint32_t slot)
{
    uint32_t number = cells->unused, head = cells->heads[slot];
    if (number != MESO_NO_INDEX)
        cells->unused = cells->blocks[number].next;
    else if (meso_make_room((void **)&cells->blocks, &cells->block_room, (uint64_t)cells->block_count + 1,
                            sizeof *cells->blocks))
        number = cells->block_count++;
    else
        return false;
    MesoGrowthBlock *block = &cells->blocks[number];
    uint16_t chain = head == MESO_NO_INDEX ? 0 : cells->blocks[head].chain;
    block->from = block->to = (MesoFourBits){0, 0, 0, 0};
    block->count = block->placed = 0;
    block->chain = chain < UINT16_MAX ? (uint16_t)(chain + 1) : chain;
    block->next = head;
    cells->heads[slot] = number;
    return true;
}

/* The nearest point of the grid, on which a unit of the triangle's frame is `scale` long. */
static inline int32_t on_grid(MesoComplex at, double scale)
{
    double x = at.re * scale + 0.5, y = at.im * scale + 0.5;
    uint32_t column = x > 0 ? x < MESO_GROWTH_GRID ? (uint32_t)x : MESO_GROWTH_GRID : 0;
    uint32_t row = y > 0 ? y < MESO_GROWTH_GRID ? (uint32_t)y : MESO_GROWTH_GRID : 0;
    return (int32_t)(column | row << 16);
}

static inline bool append(MesoGrowthCells *cells, uint32_t slot, double size, uint32_t piece, bool placed)
{
    uint32_t head = cells->heads[slot];
    if ((head == MESO_NO_INDEX || cells->blocks[head].count == MESO_GROWTH_LANES) && !begin_block(cells, slot))
        return false;
    MesoGrowthBlock *block = &cells->blocks[cells->heads[slot]];
    const MesoComplex *ends = cells->ends[piece];
    double scale = MESO_GROWTH_GRID / size;
    uint32_t lane = block->count++;
    block->from[lane] = on_grid(ends[0], scale);
    block->to[lane] = on_grid(ends[1], scale);
    block->piece[lane] = piece;
    block->placed = (uint8_t)(block->placed | placed << lane);
    return true;
}

/* Whether few pieces go through more than one of the quarters. */
static bool is_worth_it(const MesoGrowthCells *cells, const Place *place)
{
    uint32_t pieces = 0, parts = 0;
    for (uint32_t i = cells->heads[place->slot]; i != MESO_NO_INDEX; i = cells->blocks[i].next) {
        const MesoGrowthBlock *block = &cells->blocks[i];
        for (uint32_t lane = 0; lane < block->count; lane++) {
            const MesoComplex *ends = cells->ends[block->piece[lane]];
            pieces++;
            parts += (uint32_t)__builtin_popcount(quarters_through(ends, place->middle, place->half, place->size));
        }
    }
    return 2 * parts <= 3 * pieces;
}

/* Oldest first, as they are added to quarters. */
static uint32_t reversed(MesoGrowthCells *cells, uint32_t head)
{
    uint32_t before = MESO_NO_INDEX;
    while (head != MESO_NO_INDEX) {
        uint32_t next = cells->blocks[head].next;
        cells->blocks[head].next = before;
        before = head;
        head = next;
    }
    return before;
}

static bool add_to(MesoGrowthCells *cells, const Place *place, uint32_t piece, bool placed);

static bool quarter(MesoGrowthCells *cells, const Place *place)
{
    uint32_t first = cells->head_count, at = reversed(cells, cells->heads[place->slot]);
    if (!meso_make_room((void **)&cells->heads, &cells->head_room, (uint64_t)first + 4, sizeof *cells->heads))
        return false;
    cells->head_count += 4;
    for (uint32_t k = 0; k < 4; k++)
        cells->heads[first + k] = MESO_NO_INDEX;
    cells->heads[place->slot] = MESO_GROWTH_QUARTERED | first;
    while (at != MESO_NO_INDEX) {
        MesoGrowthBlock block = cells->blocks[at];
        cells->blocks[at].next = cells->unused;
        cells->unused = at;
        at = block.next;
        for (uint32_t lane = 0; lane < block.count; lane++)
            if (!add_to(cells, place, block.piece[lane], block.placed >> lane & 1))
                return false;
    }
    return true;
}

/* Whether a cell, which is not quartered, might be now: where its last block is full, and their number as is said. */
static bool is_due(const MesoGrowthCells *cells, uint32_t head)
{
    const MesoGrowthBlock *block = &cells->blocks[head];
    return block->count == MESO_GROWTH_LANES && block->chain >= MANY && (block->chain & (block->chain - 1)) == 0;
}

static bool add_to(MesoGrowthCells *cells, const Place *place, uint32_t piece, bool placed)
{
    uint32_t head = cells->heads[place->slot];
    if (head < MESO_GROWTH_QUARTERED && is_due(cells, head) && place->depth < MESO_GROWTH_QUARTERINGS &&
        is_worth_it(cells, place) && !quarter(cells, place))
        return false;
    head = cells->heads[place->slot];
    if (!meso_growth_is_quartered(head))
        return append(cells, place->slot, place->size, piece, placed);
    uint32_t left = quarters_through(cells->ends[piece], place->middle, place->half, place->size);
    for (; left; left &= left - 1) {
        Place part = quarter_of(place, head & ~MESO_GROWTH_QUARTERED, (uint32_t)__builtin_ctz(left));
        if (!add_to(cells, &part, piece, placed))
            return false;
    }
    return true;
}

bool meso_growth_cells_add(MesoGrowthCells *cells, const MesoGrowthPiece *piece, uint32_t element, bool placed)
{
    uint32_t number = cells->piece_count, head = cells->heads[piece->triangle];
    double size = cells->ground->lengths[piece->triangle];
    if (!meso_make_room((void **)&cells->ends, &cells->ends_room, (uint64_t)number + 1, sizeof *cells->ends) ||
        !meso_make_room((void **)&cells->elements, &cells->element_room, (uint64_t)number + 1,
                        sizeof *cells->elements))
        return false;
    cells->ends[number][0] = piece->ends[0];
    cells->ends[number][1] = piece->ends[1];
    cells->elements[number] = element;
    cells->piece_count++;
    if (head == MESO_NO_INDEX || (head < MESO_GROWTH_QUARTERED && !is_due(cells, head)))
        return append(cells, piece->triangle, size, number, placed);
    const Place place = {piece->triangle, 0, middle_of(size), 0.5 * size, size};
    return add_to(cells, &place, number, placed);
}

/* ---- memory ---- */

/* Pieces at a time, whose blocks are asked for together, and how many of each cell. */
enum { TOGETHER = 64, DEEP = 3 };

/* Newest block of the cell that a piece begins in. */
static uint32_t cell_at(const MesoGrowthCells *cells, const MesoGrowthPiece *piece)
{
    uint32_t head = cells->heads[piece->triangle];
    if (!meso_growth_is_quartered(head))
        return head;
    double by = 0.5 * cells->ground->lengths[piece->triangle];
    MesoComplex middle = {by, by};
    while (meso_growth_is_quartered(head)) {
        uint32_t right = piece->ends[0].re > middle.re, up = piece->ends[0].im > middle.im;
        head = cells->heads[(head & ~MESO_GROWTH_QUARTERED) + right + 2 * up];
        by *= 0.5;
        middle.re += right ? by : -by;
        middle.im += up ? by : -by;
    }
    return head;
}

static void fetch_together(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count)
{
    uint32_t at[TOGETHER];
    for (uint32_t i = 0; i < count; i++)
        at[i] = cell_at(cells, &pieces[i]);
    for (uint32_t k = 0; k < DEEP; k++)
        for (uint32_t i = 0; i < count; i++) {
            if (k > 0 && at[i] != MESO_NO_INDEX)
                at[i] = cells->blocks[at[i]].next;
            if (at[i] != MESO_NO_INDEX)
                meso_growth_fetch_block(&cells->blocks[at[i]]);
        }
}

void meso_growth_cells_fetch(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count)
{
    for (uint32_t i = 0; i < count; i += TOGETHER)
        fetch_together(cells, pieces + i, count - i < TOGETHER ? count - i : TOGETHER);
}

void meso_growth_cells_fetch_heads(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count,
                                   bool to_write)
{
    for (uint32_t i = 0; i < count; i++)
        if (to_write)
            __builtin_prefetch(&cells->heads[pieces[i].triangle], 1);
        else
            __builtin_prefetch(&cells->heads[pieces[i].triangle]);
}

void meso_growth_cells_fetch_newest(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t head = cells->heads[pieces[i].triangle];
        if (head < MESO_GROWTH_QUARTERED)
            __builtin_prefetch(&cells->blocks[head], 1);
    }
}

/* ---- looking ---- */

void meso_growth_sight(MesoGrowthSight *sight, const MesoGrowthCells *cells, uint32_t triangle,
                       const MesoComplex ends[2])
{
    sight->cells = cells;
    sight->ends = ends;
    sight->center = (MesoComplex){0, 0};
    sight->radius = INFINITY;
    sight->size = cells->ground->lengths[triangle];
    sight->count = 1;
    sight->stack[0] = (MesoGrowthCell){cells->heads[triangle], 0.5 * sight->size, middle_of(sight->size)};
}

void meso_growth_sight_around(MesoGrowthSight *sight, const MesoGrowthCells *cells, uint32_t triangle,
                              MesoComplex center, double radius)
{
    meso_growth_sight(sight, cells, triangle, NULL);
    sight->center = center;
    sight->radius = radius;
}

static bool reaches(const MesoGrowthSight *sight, MesoComplex middle, double half)
{
    double x = fabs(sight->center.re - middle.re) - half, y = fabs(sight->center.im - middle.im) - half;
    x = x > 0 ? x : 0;
    y = y > 0 ? y : 0;
    return x * x + y * y <= sight->radius * sight->radius;
}

/* Bit k: what is looked for may lie in quarter k of a square. */
static uint32_t quarters_in_sight(const MesoGrowthSight *sight, MesoComplex middle, double half)
{
    uint32_t quarters = 0;
    if (sight->ends)
        return quarters_through(sight->ends, middle, half, sight->size);
    for (uint32_t k = 0; k < 4; k++)
        quarters |= (uint32_t)reaches(sight, middle_of_quarter(middle, half, k), 0.5 * half + beyond * sight->size)
                    << k;
    return quarters;
}

uint32_t meso_growth_next_cell(MesoGrowthSight *sight)
{
    while (sight->count) {
        MesoGrowthCell cell = sight->stack[--sight->count];
        if (!meso_growth_is_quartered(cell.head)) {
            if (cell.head != MESO_NO_INDEX)
                return cell.head;
            continue;
        }
        const uint32_t *heads = &sight->cells->heads[cell.head & ~MESO_GROWTH_QUARTERED];
        uint32_t left = quarters_in_sight(sight, cell.middle, cell.half);
        for (; left; left &= left - 1) {
            uint32_t k = (uint32_t)__builtin_ctz(left);
            if (heads[k] != MESO_NO_INDEX)
                sight->stack[sight->count++] =
                    (MesoGrowthCell){heads[k], 0.5 * cell.half, middle_of_quarter(cell.middle, cell.half, k)};
        }
    }
    return MESO_NO_INDEX;
}
