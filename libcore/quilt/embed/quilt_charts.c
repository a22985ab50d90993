#include "libcore/quilt/embed/quilt_charts.h"

#include "libcore/base/parallel.h"
#include "libcore/chart/atlas.h"
#include "libcore/shell/shell_map.h"

enum { GRAIN = 1 << 11, RELAXATIONS = 4 };

typedef struct Mapping {
    MesoVec3 *positions;
    const MesoQuilt *quilt;
    const MesoShellMap *map;
} Mapping;

static void map_range(void *context, uint64_t begin, uint64_t end)
{
    const Mapping *m = context;
    for (uint64_t v = begin; v < end; v++) {
        MesoQuiltVertex x = m->quilt->vertices[v];
        m->positions[v] = meso_shell_map_point(m->map, x.triangle, x.b1, x.b2, x.height);
    }
}

static uint32_t count_seams(const MesoQuilt *quilt, const MesoAtlas *atlas)
{
    uint32_t count = 0;
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        uint32_t first = quilt->vertex_begin[e], end = quilt->vertex_begin[e + 1], v = first;
        while (v < end && atlas->triangle_chart[quilt->vertices[v].triangle] ==
                              atlas->triangle_chart[quilt->vertices[first].triangle])
            v++;
        count += v < end;
    }
    return count;
}

static void report(MesoQuiltLay *lay, const MesoShellMapReport *map, const MesoAtlas *atlas,
                   const MesoQuilt *quilt)
{
    MesoPrismReport *layer = &lay->layer;
    layer->stretch_before = map->stretch_before;
    layer->stretch_after = map->stretch_after;
    layer->stretch_before_inverse = map->stretch_before_inverse;
    layer->stretch_after_inverse = map->stretch_after_inverse;
    layer->inverted_count = map->inverted_count;
    lay->flat_count = map->flat_count;
    lay->plain_count = map->plain_count;
    lay->chart_count = atlas->chart_count;
    lay->area_ratio = atlas->largest_ratio;
    lay->seam_count = count_seams(quilt, atlas);
}

MesoStatus meso_quilt_embed_charts(MesoVec3 *positions, MesoQuiltLay *lay, MesoArena *scratch,
                                   const MesoQuilt *quilt, const MesoTriangulation *base, const MesoVec3 *directions,
                                   MesoQuiltHeights heights, uint32_t thread_count, MesoError *error)
{
    MesoAtlas atlas;
    MesoShellMap map;
    MesoShellMapReport mapped;
    const MesoChartOptions charts = {.relaxations = RELAXATIONS};
    const MesoShellMapOptions layer = {.low = heights.low, .high = heights.high};
    MesoStatus status = meso_atlas_build(&atlas, scratch, base, &charts, error);
    if (!status)
        status = meso_shell_map_build(&map, &mapped, scratch, base, &atlas, directions, &layer, error);
    if (status)
        return status;
    Mapping mapping = {positions, quilt, &map};
    meso_parallel_for(thread_count, quilt->vertex_count, GRAIN, map_range, &mapping);
    report(lay, &mapped, &atlas, quilt);
    return MESO_OK;
}
