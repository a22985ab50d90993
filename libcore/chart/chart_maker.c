#include "libcore/chart/chart_maker.h"

#include <stdlib.h>
#include <string.h>

static uint32_t *new_numbers(uint32_t count)
{
    uint32_t *numbers = malloc((count ? count : 1) * sizeof *numbers);
    if (numbers)
        memset(numbers, 0xff, count * sizeof *numbers);
    return numbers;
}

MesoStatus meso_chart_maker_init(MesoChartMaker *maker, const MesoTriangulation *mesh, MesoError *error)
{
    *maker = (MesoChartMaker){.mesh = mesh, .vertex_numbers = new_numbers(mesh->vertex_count),
                              .triangle_numbers = new_numbers(mesh->triangle_count)};
    meso_arena_init(&maker->own);
    /* a first block, which rewinding leaves where it is */
    if (maker->vertex_numbers && maker->triangle_numbers && meso_arena_alloc(&maker->own, 1, 1, NULL))
        return MESO_OK;
    meso_chart_maker_release(maker);
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory: marks of %u triangles", mesh->triangle_count);
}

void meso_chart_maker_release(MesoChartMaker *maker)
{
    free(maker->vertex_numbers);
    free(maker->triangle_numbers);
    meso_arena_release(&maker->own);
    *maker = (MesoChartMaker){0};
}
