#include <stdlib.h>

#include "libcore/decor/operators.h"
#include "libcore/geodesic/isoline.h"

/* More levels than this in one region are somebody's mistake of scale. */
enum { MOST_LEVELS = 1 << 16 };

static float unit_of(const MesoSplit *split, const MesoSplitTarget *target)
{
    if (split->step->levels.unit == MESO_LEVEL_SHARE)
        return target->largest;
    if (split->step->levels.unit == MESO_LEVEL_SIZE)
        return (float)sqrt(split->work->decor->tree.regions[target->region].area);
    return 1;
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* Levels inside the field, ascending, each once. */
static MesoStatus choose_levels(MesoSplit *split, MesoSplitTarget *target, MesoError *error)
{
    const MesoLevels *levels = &split->step->levels;
    float unit = unit_of(split, target), largest = target->largest;
    double every = (double)levels->every * (double)unit;
    double regular = levels->count ? levels->count : every > 0 ? (double)largest / every : 0;
    if (regular > MOST_LEVELS)
        return meso_fail(error, MESO_ERR_INPUT, "%.0f levels in one region, over the limit of %d",
                         regular, MOST_LEVELS);
    uint32_t count = levels->value_count + (uint32_t)regular, kept = 0;
    target->levels = MESO_NEW(split->work->scratch, float, (size_t)count + 1, error);
    if (!target->levels)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < levels->value_count; i++)
        target->levels[kept++] = levels->values[i] * unit;
    for (uint32_t i = 1; i <= (uint32_t)regular; i++)
        target->levels[kept++] = levels->count ? largest * (float)i / (float)(levels->count + 1) : (float)(i * every);
    qsort(target->levels, kept, sizeof *target->levels, by_value);
    for (uint32_t i = 0; i < kept; i++) {
        float level = target->levels[i];
        if (level > 0 && level < largest && (target->level_count == 0 ||
                                             level > target->levels[target->level_count - 1]))
            target->levels[target->level_count++] = level;
    }
    return MESO_OK;
}

/* The field at the corners of the domain's triangles, for what the cut will leave of them. */
static void keep_field(MesoSplit *split, const MesoDomain *domain)
{
    const MesoTriangulation *mesh = &split->work->decor->mesh;
    MesoCornerField *kept = &split->field;
    for (uint32_t i = 0; i < domain->triangle_count; i++) {
        uint32_t t = domain->triangles[i];
        kept->row[t] = kept->row_count;
        for (uint32_t k = 0; k < 3; k++)
            kept->values[3 * (size_t)kept->row_count + k] = split->work->field[mesh->corners[3 * (size_t)t + k]];
        kept->row_count++;
    }
}

MesoStatus meso_decor_contour(MesoSplit *split, MesoSplitTarget *target, const MesoDomain *domain, MesoError *error)
{
    MesoDecorWork *work = split->work;
    MesoFieldFacts facts;
    MesoStatus status = meso_decor_field(work, &split->step->field, target->region, domain, &facts, error);
    if (status)
        return status;
    target->largest = facts.largest;
    target->points = facts.points;
    if (!(facts.largest > 0)) {
        target->idle = meso_decor_flat_reason(&facts);
        return MESO_OK;
    }
    status = choose_levels(split, target, error);
    if (status)
        return status;
    keep_field(split, domain);
    if (target->level_count == 0) {
        target->idle = "no level lies inside the field";
        return MESO_OK;
    }
    const MesoIsolineQuery query = {domain, work->field, target->levels, target->level_count};
    return meso_isolines_trace(&split->lines, work->scratch, &work->decor->mesh, &query, error);
}
