/* What a cut has left of regions: connected pieces, and the regions that they become. */
#ifndef MESO_PIECES_H
#define MESO_PIECES_H

#include "libcore/decor/decor_work.h"

typedef struct MesoPiece {
    uint32_t leaf;          /* that it is part of */
    uint32_t first;         /* lowest triangle */
    uint32_t triangle_count;
    uint32_t kind;          /* of the caller's: band, cell; by which pieces of a leaf are put in order */
    double area;
    double level;           /* mean of the field over the area */
} MesoPiece;

typedef struct MesoPieces {
    MesoPiece *pieces;      /* [count] those of one leaf in a row, by their lowest triangle */
    uint32_t count, room;
    uint32_t *piece_of;     /* [triangle_count] or MESO_NO_INDEX */
    uint32_t *stack;        /* [largest leaf] of the flood */
} MesoPieces;

/*
 * A field at the corners of the triangles of several domains, over a cut. Triangles find their row; once cut, parts
 * that have come behind find it as parts.
 */
typedef struct MesoCornerField {
    uint32_t *row;          /* [triangles before the cut], or MESO_NO_INDEX; behind the rows: a part, after the cut */
    float *values;          /* [3 * row_count] */
    uint32_t row_count, row_room;
    const MesoCutReport *report;    /* of the cut; NULL before it */
    uint32_t *parent_row;           /* [parts] row of the triangle before the cut, or MESO_NO_INDEX */
    uint32_t *part_of;              /* [new triangles] */
} MesoCornerField;

/* Room for the pieces of a mesh, none yet, whose leaves have at most so many triangles. */
MesoStatus meso_pieces_init(MesoPieces *pieces, MesoArena *arena, const MesoTriangulation *mesh, uint32_t largest_leaf,
                            MesoError *error);

/*
 * Floods the triangles of a leaf between walls, and adds its pieces, with the mean of a field (NULL: none).
 * O(triangles of the leaf).
 */
MesoStatus meso_pieces_add(MesoPieces *pieces, MesoArena *arena, const MesoDecorWork *work, uint32_t leaf,
                           const MesoCornerField *field, MesoError *error);

/*
 * Joins pieces from number `begin` on that are smaller than a part of a triangle of the surface, to which lines
 * cannot be told apart, to the neighbour of the same leaf that they share the most border with, and takes down the
 * walls between. Pieces stay in order. face_area [faces of the surface]. O(triangles of small pieces), and of all
 * where there are any.
 */
MesoStatus meso_pieces_join_small(MesoPieces *pieces, MesoDecorWork *work, uint32_t begin, MesoError *error);

/* Makes the field answer for the triangles after a cut. O(parts). MESO_ERR_MEMORY alone. */
MesoStatus meso_corner_field_cut(MesoCornerField *field, MesoArena *arena, const MesoTriangulation *mesh,
                                 const MesoCutReport *report, MesoError *error);

/* What pieces of a kind become. */
typedef struct MesoPieceLook {
    const char *tag, *name;
    float level;
} MesoPieceLook;

/*
 * Makes children of the leaf whose pieces are [begin, end), ordered by kind, and the largest first, whatever the
 * mesh's order, and gives their triangles their labels. `look` says what a piece becomes.
 */
MesoStatus meso_pieces_become_regions(MesoPieces *pieces, MesoDecorWork *work, uint32_t begin, uint32_t end,
                                      MesoPieceLook (*look)(void *context, const MesoPiece *piece), void *context,
                                      MesoError *error);

#endif
