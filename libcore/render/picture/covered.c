#include "libcore/render/picture/covered.h"

void meso_covered_add(MesoWindow *box, const MesoImage *band, uint32_t first_row)
{
    bool empty = box->width == 0;
    uint32_t left = empty ? UINT32_MAX : box->x, right = empty ? 0 : box->x + box->width;
    uint32_t top = empty ? UINT32_MAX : box->y, bottom = empty ? 0 : box->y + box->height;
    for (uint32_t y = 0; y < band->height; y++)
        for (uint32_t x = 0; x < band->width; x++) {
            if (!(band->color[4 * ((size_t)y * band->width + x) + 3] > 0))
                continue;
            left = x < left ? x : left;
            right = x + 1 > right ? x + 1 : right;
            top = first_row + y < top ? first_row + y : top;
            bottom = first_row + y + 1 > bottom ? first_row + y + 1 : bottom;
        }
    if (right > 0)
        *box = (MesoWindow){left, top, right - left, bottom - top};
}
