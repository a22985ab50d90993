/* Which columns join each other on the rings between the ends of a sweep. */
#ifndef MESO_INNER_COLUMN_H
#define MESO_INNER_COLUMN_H

#include "libcore/scene/scene.h"

/* The column that one of `columns` [of the kind] joins there; MESO_NO_INDEX: none, or it is not there itself. */
static inline uint32_t meso_next_inner_column(const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t c)
{
    if (columns[c].absent & MESO_ABSENT_BETWEEN)
        return MESO_NO_INDEX;
    while (c + 1 < kind->column_count && columns[c].joins_next)
        if (!(columns[++c].absent & MESO_ABSENT_BETWEEN))
            return c;
    return MESO_NO_INDEX;
}

#endif
