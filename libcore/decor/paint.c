#include "libcore/decor/decor_work.h"

/* Between neighbours of a ramp there are so many steps: each is a material of its own in files. */
enum { RAMP_STEPS = 32 };

static void paint_ramp(MesoRegion *region, const MesoAfterSplit *paint)
{
    float level = region->level > 0 ? region->level < 1 ? region->level : 1 : 0;
    float place = roundf(level * (float)(RAMP_STEPS * (paint->material_count - 1))) / RAMP_STEPS;
    uint32_t low = (uint32_t)place;
    low = low + 1 < paint->material_count ? low : paint->material_count - 1;
    region->material[0] = paint->materials[low];
    region->material[1] = paint->materials[low + 1 < paint->material_count ? low + 1 : low];
    region->mix = place - (float)low;
}

static void paint_region(const MesoDecorWork *work, MesoRegion *region, uint32_t number, const MesoAfterSplit *paint)
{
    uint32_t chosen = 0;
    if (paint->by == MESO_PAINT_RAMP) {
        paint_ramp(region, paint);
        return;
    }
    if (paint->by == MESO_PAINT_CYCLE)
        chosen = region->number % paint->material_count;
    if (paint->by == MESO_PAINT_RANDOM)
        chosen = (uint32_t)(meso_decor_random(work, number, MESO_DRAW_MATERIAL) % paint->material_count);
    region->material[0] = region->material[1] = paint->materials[chosen];
    region->mix = 0;
}

/* What was painted below a region before is painted over. */
static void forget_below(MesoRegionTree *tree, uint32_t region)
{
    for (uint32_t i = 0; i < tree->regions[region].child_count; i++) {
        uint32_t child = tree->regions[region].child_begin + i;
        tree->regions[child].material[0] = MESO_NO_INDEX;
        forget_below(tree, child);
    }
}

void meso_decor_paint(MesoDecorWork *work, const MesoAfterSplit *paint, const uint32_t *regions, uint32_t count)
{
    MesoRegionTree *tree = &work->decor->tree;
    for (uint32_t i = 0; i < count && paint->material_count > 0; i++) {
        paint_region(work, &tree->regions[regions[i]], regions[i], paint);
        forget_below(tree, regions[i]);
    }
}
