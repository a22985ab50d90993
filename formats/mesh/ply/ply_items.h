/* Items of binary PLY files whose bytes lie at the same places in all of them, copied to where they go in a mesh. */
#ifndef MESO_PLY_ITEMS_H
#define MESO_PLY_ITEMS_H

#include "formats/mesh/ply/ply_header.h"

/* Numbers that lie beside each other in items and in the mesh. */
typedef struct MesoPlyRun {
    uint32_t count;             /* of numbers */
    size_t offset;              /* in an item */
    MesoScalar from, to;
    unsigned char *out;         /* of item 0 */
    size_t stride;              /* of what is at `out` */
} MesoPlyRun;

typedef struct MesoPlyItems {
    const unsigned char *data;  /* of item 0 */
    size_t stride;
    bool big;
    uint32_t run_count;
    MesoPlyRun runs[MESO_PLY_PROPERTIES];
} MesoPlyItems;

/* Of a number in a file. */
double meso_ply_number(MesoScalar type, const unsigned char *bytes, bool big);
int64_t meso_ply_integer(MesoScalar type, const unsigned char *bytes, bool big);

/* Copies one number, in the type that it is kept in, to `out`. Indices that are negative become 2^31 or more. */
void meso_ply_put(const MesoPlyProperty *property, unsigned char *out, const unsigned char *bytes, bool big);

/* `count` numbers of `property` lie at `offset` in each item and go to `out`, `stride` apart; runs that adjoin
 * become one. */
void meso_ply_add_run(MesoPlyItems *items, const MesoPlyProperty *property, uint32_t count, size_t offset,
                      size_t stride);

/* Copies items [begin, end). */
void meso_ply_copy_items(const MesoPlyItems *items, uint32_t begin, uint32_t end);

#endif
