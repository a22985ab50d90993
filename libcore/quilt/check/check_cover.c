#include "libcore/quilt/check/check_cover.h"

#include "libcore/quilt/check/check_places.h"
#include "libcore/quilt/check/check_window.h"

enum {
    PLACES_A_TILE = 100,
    LEAST_PLACES = 1000,
    MOST_PLACES = 1 << 16,
    SWATCH_STEPS = 100      /* along each side of the tile */
};

/* So much of the tile, on all sides, is not asked: what would reach over its sides from the next tile is not there. */
#define MARGIN 0.15f

/* The triangles of the quilt, let down. */
static MesoStatus lay_down_quilt(MesoNearestMesh *ground, MesoArena *arena, const MesoQuilt *quilt,
                                 const MesoTriangulation *base, MesoError *error)
{
    MesoMatchPoint *feet = MESO_NEW(arena, MesoMatchPoint, quilt->vertex_count, error);
    if (!feet)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < quilt->vertex_count; v++) {
        const MesoQuiltVertex *q = &quilt->vertices[v];
        const float weights[3] = {1 - q->b1 - q->b2, q->b1, q->b2};
        for (uint32_t k = 0; k < 3; k++)
            feet[v].position = meso_vec3_mad(feet[v].position, weights[k],
                                             base->positions[base->corners[3 * (size_t)q->triangle + k]]);
    }
    return meso_nearest_mesh_build(ground, arena, feet, quilt->corners, quilt->triangle_count, error);
}

static MesoStatus lay_down_swatch(MesoNearestMesh *ground, MesoArena *arena, const MesoSwatch *swatch, MesoError *error)
{
    MesoMatchPoint *feet = MESO_NEW(arena, MesoMatchPoint, swatch->vertex_count, error);
    if (!feet)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < swatch->vertex_count; v++)
        feet[v].position = (MesoVec3){swatch->positions[v].x, swatch->positions[v].y, 0};
    return meso_nearest_mesh_build(ground, arena, feet, swatch->corners, swatch->triangle_count, error);
}

/* Sides along borders, as triangles without area. */
static MesoStatus list_borders(MesoNearestMesh *borders, MesoArena *arena, const MesoTriangulation *base,
                               MesoError *error)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 3 * base->triangle_count; h++)
        count += base->twins[h] == MESO_NO_INDEX;
    MesoMatchPoint *points = MESO_NEW(arena, MesoMatchPoint, 2 * (size_t)count, error);
    uint32_t *corners = MESO_NEW(arena, uint32_t, 3 * (size_t)count, error);
    if (!points || !corners)
        return MESO_ERR_MEMORY;
    count = 0;
    for (uint32_t h = 0; h < 3 * base->triangle_count; h++) {
        if (base->twins[h] != MESO_NO_INDEX)
            continue;
        points[2 * count].position = base->positions[base->corners[h]];
        points[2 * count + 1].position = base->positions[base->corners[meso_next_corner(h)]];
        corners[3 * count] = 2 * count;
        corners[3 * count + 1] = corners[3 * count + 2] = 2 * count + 1;
        count++;
    }
    return meso_nearest_mesh_build(borders, arena, points, corners, count, error);
}

static MesoStatus measure_swatch(MesoCover *cover, MesoArena *scratch, const MesoSwatch *swatch, MesoError *error)
{
    MesoNearestMesh ground;
    MesoStatus status = lay_down_swatch(&ground, scratch, swatch, error);
    if (status)
        return status;
    float most = fmaxf(swatch->size.x, swatch->size.y);
    for (uint32_t i = 0; i < SWATCH_STEPS * SWATCH_STEPS; i++) {
        float x = MARGIN + (1 - 2 * MARGIN) * ((float)(i % SWATCH_STEPS) + 0.5f) / SWATCH_STEPS;
        float y = MARGIN + (1 - 2 * MARGIN) * ((float)(i / SWATCH_STEPS) + 0.5f) / SWATCH_STEPS;
        MesoVec3 place = {x * swatch->size.x, y * swatch->size.y, 0};
        cover->swatch_widest = fmax(cover->swatch_widest, (double)meso_nearest_distance(&ground, place, most));
    }
    return MESO_OK;
}

static MesoStatus measure_quilt(MesoCover *cover, MesoArena *scratch, const MesoQuilt *quilt, const MesoSwatch *swatch,
                                const MesoTriangulation *base, double scale, MesoError *error)
{
    MesoNearestMesh ground, borders;
    MesoPlaces places;
    MesoRandom random;
    MesoStatus status = lay_down_quilt(&ground, scratch, quilt, base, error);
    if (!status)
        status = list_borders(&borders, scratch, base, error);
    if (!status)
        status = meso_places_init(&places, scratch, base, error);
    if (status)
        return status;
    double tile = (double)swatch->size.x * (double)swatch->size.y * scale * scale;
    double wanted = PLACES_A_TILE * meso_places_area(&places) / tile;
    double may = 1.25 * cover->swatch_widest + 0.5 * (double)swatch->mean_edge;
    float most = 2 * (float)(scale * (double)fmaxf(swatch->size.x, swatch->size.y));
    float border = (float)scale * meso_window_border(swatch);
    cover->place_count = (uint32_t)fmin(fmax(wanted, LEAST_PLACES), MOST_PLACES);
    meso_random_init(&random, 2, 0);
    for (uint32_t i = 0; i < cover->place_count; i++) {
        uint32_t triangle;
        MesoVec3 place = meso_places_next(&places, &random, &triangle);
        float far = meso_nearest_distance(&ground, place, most);
        if (far == 0 || meso_nearest_distance(&borders, place, most) < far + border)
            continue;
        cover->widest = fmax(cover->widest, (double)far / scale);
        cover->empty_count += (double)far / scale > may;
    }
    return MESO_OK;
}

MesoStatus meso_check_cover(MesoCover *cover, MesoArena *scratch, const MesoQuilt *quilt, const MesoSwatch *swatch,
                            const MesoTriangulation *base, float scale, MesoError *error)
{
    *cover = (MesoCover){0};
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoStatus status = base->triangle_count ? measure_swatch(cover, scratch, swatch, error) : MESO_OK;
    if (!status && base->triangle_count)
        status = measure_quilt(cover, scratch, quilt, swatch, base, (double)scale, error);
    meso_arena_rewind(scratch, mark);
    return status;
}
