/*
 * Pieces of strands by the triangle that they lie in, and by the part of it: where many lie in one triangle it is
 * quartered, and where many lie in a quarter so is this. However dense it grows, few are near a place. A piece lies in
 * each part that it goes through.
 */
#ifndef MESO_GROWTH_CELLS_H
#define MESO_GROWTH_CELLS_H

#include "libcore/growth/space/growth_room.h"
#include "libcore/growth/ground/growth_ground.h"
#include "libcore/math/four.h"

/* A straight way through a triangle. */
typedef struct MesoGrowthPiece {
    MesoComplex ends[2];        /* in the triangle's frame */
    uint32_t triangle;
    bool turned;
} MesoGrowthPiece;

/*
 * Pieces of one cell, as many as are looked at together: roughly, on a grid of the triangle. The last of them is the
 * newest.
 */
enum { MESO_GROWTH_LANES = 4, MESO_GROWTH_GRID = 0xffff };

typedef struct MesoGrowthBlock {
    MesoFourBits from, to;      /* ends: x, and y above it; of the lanes beyond `count`, no matter what */
    uint32_t piece[MESO_GROWTH_LANES];
    uint32_t next;              /* older ones of the same cell */
    uint8_t count;
    uint8_t placed;             /* bit i: piece i is of a placed shape, which may be crossed */
    uint16_t chain;             /* blocks of the cell up to this one; no more are counted than fit */
} MesoGrowthBlock;

static inline void meso_growth_fetch_block(const MesoGrowthBlock *block)
{
    __builtin_prefetch(block);
    __builtin_prefetch(&block->chain);
}

static inline uint32_t meso_growth_newest(const MesoGrowthBlock *block)
{
    return block->piece[block->count - 1];
}

/* Heads that are not blocks: with the number of the first of four cells. */
#define MESO_GROWTH_QUARTERED 0x80000000u

typedef struct MesoGrowthCells {
    const MesoWalkGround *ground;
    uint32_t *heads;            /* newest blocks: [triangle_count] of triangles, then of quarters; or quartered */
    MesoGrowthBlock *blocks;
    MesoComplex (*ends)[2];     /* [piece_count] of pieces, exactly, as they have grown */
    uint32_t *elements;         /* [piece_count] whose they are */
    uint32_t head_count, head_room, block_count, block_room, piece_count, ends_room, element_room;
    uint32_t unused;            /* blocks that are free again, one after another */
} MesoGrowthCells;

static inline bool meso_growth_is_quartered(uint32_t head)
{
    return head >= MESO_GROWTH_QUARTERED && head != MESO_NO_INDEX;
}

MesoStatus meso_growth_cells_init(MesoGrowthCells *cells, const MesoWalkGround *ground, MesoError *error);
void meso_growth_cells_release(MesoGrowthCells *cells);

/* False where memory is out. */
bool meso_growth_cells_add(MesoGrowthCells *cells, const MesoGrowthPiece *piece, uint32_t element, bool placed);

/* Asks for the memory of a piece; nothing where there is none of that number. */
static inline void meso_growth_fetch_piece(const MesoGrowthCells *cells, uint32_t piece)
{
    if (piece >= cells->piece_count)
        return;
    __builtin_prefetch(&cells->ends[piece]);
    __builtin_prefetch(&cells->elements[piece]);
}

/* Asks for the memory of what lies where pieces do. */
void meso_growth_cells_fetch(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count);

/* The same of heads alone; to write to them where pieces are added soon, and then of the blocks that these name. */
void meso_growth_cells_fetch_heads(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count,
                                   bool to_write);
void meso_growth_cells_fetch_newest(const MesoGrowthCells *cells, const MesoGrowthPiece *pieces, uint32_t count);

/* ---- looking ---- */

/* Quarters, which are squares, that are still to be looked at: three of each size, and four of the last. */
enum { MESO_GROWTH_QUARTERINGS = 16, MESO_GROWTH_CELL_STACK = 3 * MESO_GROWTH_QUARTERINGS + 1 };

typedef struct MesoGrowthCell {
    uint32_t head;
    double half;                /* of the square's side */
    MesoComplex middle;
} MesoGrowthCell;

typedef struct MesoGrowthSight {
    const MesoGrowthCells *cells;
    const MesoComplex *ends;    /* of a segment; NULL: a disc */
    MesoComplex center;
    double radius;
    double size;
    uint32_t count;
    MesoGrowthCell stack[MESO_GROWTH_CELL_STACK];
} MesoGrowthSight;

/* Of the cells of a triangle through which a segment with these ends goes; of all where it is NULL. */
void meso_growth_sight(MesoGrowthSight *sight, const MesoGrowthCells *cells, uint32_t triangle,
                       const MesoComplex ends[2]);

/* Of those that a disc reaches. */
void meso_growth_sight_around(MesoGrowthSight *sight, const MesoGrowthCells *cells, uint32_t triangle,
                              MesoComplex center, double radius);

/* The newest block of the next cell that has any; MESO_NO_INDEX after the last. */
uint32_t meso_growth_next_cell(MesoGrowthSight *sight);

#endif
