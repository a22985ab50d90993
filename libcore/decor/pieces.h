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
    uint32_t *stack;        /* of the flood */
} MesoPieces;

/*
 * Values of a field at the triangles of several domains, over a cut: `rows` says where a triangle's
 * three corners stand, before the cut.
 */
typedef struct MesoCornerField {
    uint32_t *row;          /* [triangles before the cut], or MESO_NO_INDEX */
    float *values;          /* [3 * rows] */
    uint32_t row_count;
} MesoCornerField;

/* Room for the pieces of a mesh, none yet. */
MesoStatus meso_pieces_init(MesoPieces *pieces, MesoArena *arena, const MesoTriangulation *mesh, MesoError *error);

/*
 * Floods the triangles of a leaf between walls, and adds its pieces. value[triangle_count] is averaged; NULL: none.
 * O(triangles of the leaf).
 */
MesoStatus meso_pieces_add(MesoPieces *pieces, MesoArena *arena, const MesoDecorWork *work, uint32_t leaf,
                           const float *value, MesoError *error);

/*
 * Joins pieces from number `begin` on that are smaller than a part of a triangle of the surface, to which lines
 * cannot be told apart, to the neighbour of the same leaf that they share the most border with, and takes down the
 * walls between. Pieces stay in order. face_area [faces of the surface]. O(triangles of small pieces), and of all
 * where there are any.
 */
MesoStatus meso_pieces_join_small(MesoPieces *pieces, MesoDecorWork *work, uint32_t begin, MesoError *error);

/*
 * Value of each triangle after a cut: the mean over its corners, of parts at their centres. [triangle_count] in the
 * arena; NULL when memory is out. O(triangles).
 */
float *meso_corner_field_after(const MesoCornerField *field, MesoArena *arena, const MesoTriangulation *mesh,
                               const MesoCutReport *report, MesoError *error);

/* What pieces of a kind become. */
typedef struct MesoPieceLook {
    const char *tag, *name;
    float level;
} MesoPieceLook;

/*
 * Makes children of the leaf whose pieces are [begin, end), ordered by kind and lowest triangle, and gives their
 * triangles their labels. `look` says what a piece becomes.
 */
MesoStatus meso_pieces_become_regions(MesoPieces *pieces, MesoDecorWork *work, uint32_t begin, uint32_t end,
                                      MesoPieceLook (*look)(void *context, const MesoPiece *piece), void *context,
                                      MesoError *error);

#endif
