#include "libcore/chart/box_pack.h"

#include <stdlib.h>

typedef struct Box {
    MesoVec2 size;
    uint32_t number;
} Box;

static int compare_boxes(const void *left, const void *right)
{
    const Box *a = left, *b = right;
    if (a->size.y != b->size.y)
        return a->size.y > b->size.y ? -1 : 1;
    return a->number < b->number ? -1 : a->number > b->number;
}

/* Shelf by shelf from below, in a square of the given side; false where that is too small. */
static bool fill_shelves(MesoVec2 *lows, const Box *boxes, uint32_t count, float side, float gap)
{
    float x = gap, y = gap, shelf = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (x > gap && x + boxes[i].size.x + gap > side) {
            x = gap;
            y += shelf + gap;
            shelf = 0;
        }
        if (x + boxes[i].size.x + gap > side || y + boxes[i].size.y + gap > side)
            return false;
        lows[boxes[i].number] = (MesoVec2){x, y};
        x += boxes[i].size.x + gap;
        shelf = fmaxf(shelf, boxes[i].size.y);
    }
    return true;
}

MesoStatus meso_boxes_pack(MesoVec2 *lows, float *side, MesoArena *scratch, const MesoVec2 *sizes, uint32_t count,
                           float gap, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    Box *boxes = MESO_NEW(scratch, Box, count, error);
    if (!boxes)
        return MESO_ERR_MEMORY;
    float low = 0, high = 0;
    for (uint32_t i = 0; i < count; i++) {
        boxes[i] = (Box){sizes[i], i};
        low = fmaxf(low, fmaxf(sizes[i].x, sizes[i].y));
    }
    qsort(boxes, count, sizeof *boxes, compare_boxes);
    low = low > 0 ? low : 1;
    for (high = low; !fill_shelves(lows, boxes, count, high, gap * high);)
        high *= 2;
    while (high - low > 1e-3f * low) {
        float middle = 0.5f * (low + high);
        if (fill_shelves(lows, boxes, count, middle, gap * middle))
            high = middle;
        else
            low = middle;
    }
    fill_shelves(lows, boxes, count, high, gap * high);
    *side = high;
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
