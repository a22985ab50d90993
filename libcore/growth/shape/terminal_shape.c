#include "libcore/growth/shape/terminal_shape.h"

#include <stdlib.h>
#include <string.h>

typedef struct Place {
    float along;
    uint32_t vertex;
} Place;

/* From the mesh to the shape: x = (along - origin) / length, y and z = across / width. */
typedef struct Fit {
    MesoShapeAxis axis;
    float origin, length, width;
} Fit;

static int compare_places(const void *a, const void *b)
{
    const Place *p = a, *q = b;
    if (p->along != q->along)
        return p->along < q->along ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

static MesoVec3 turn(MesoShapeAxis axis, MesoVec3 p)
{
    return axis == MESO_SHAPE_ALONG_Z ? (MesoVec3){p.z, p.x, p.y} : p;
}

static MesoStatus find_fit(Fit *fit, const MesoBody *mesh, MesoShapeAxis axis, MesoError *error)
{
    MesoBox box = meso_box_empty();
    *fit = (Fit){.axis = axis};
    if (mesh->vertex_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "the shape has no vertices");
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!meso_vec3_finite(mesh->positions[v]) || !meso_vec3_finite(mesh->normals[v]))
            return meso_fail(error, MESO_ERR_INPUT, "vertex %u of the shape is not finite", v);
        meso_box_add(&box, turn(axis, mesh->positions[v]));
    }
    *fit = (Fit){axis, box.low.x, box.high.x - box.low.x, fmaxf(box.high.y - box.low.y, box.high.z - box.low.z)};
    if (!(fit->length > 0 && isfinite(fit->length)))
        return meso_fail(error, MESO_ERR_INPUT, "the shape has no length along %c",
                         axis == MESO_SHAPE_ALONG_Z ? 'z' : 'x');
    if (!(fit->width > 0 && isfinite(fit->width)))
        return meso_fail(error, MESO_ERR_INPUT, "the shape is a line along %c",
                         axis == MESO_SHAPE_ALONG_Z ? 'z' : 'x');
    return MESO_OK;
}

/* Rings of the sorted places, which come to lie on them; returns how many. */
static uint32_t gather_rings(Place *places, uint32_t count, float *along, uint32_t *ring_begin)
{
    uint32_t rings = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || places[i].along - along[rings - 1] > MESO_RING_TOLERANCE) {
            ring_begin[rings] = i;
            along[rings++] = places[i].along;
        }
    }
    ring_begin[rings] = count;
    along[rings - 1] = 1;
    for (uint32_t ring = 0; ring < rings; ring++)
        for (uint32_t i = ring_begin[ring]; i < ring_begin[ring + 1]; i++)
            places[i].along = along[ring];
    return rings;
}

typedef struct Arrays {
    MesoVec3 *positions, *normals;
    MesoVec2 *uvs;
    MesoMeshColor *colors;
    uint32_t *corners;
} Arrays;

static bool allocate(Arrays *arrays, MesoTerminalShape *out, MesoArena *arena, const MesoBody *mesh, MesoError *error)
{
    size_t count = mesh->vertex_count;
    *arrays = (Arrays){.positions = MESO_NEW(arena, MesoVec3, count, error),
                       .normals = MESO_NEW(arena, MesoVec3, count, error),
                       .uvs = mesh->uvs ? MESO_NEW(arena, MesoVec2, count, error) : NULL,
                       .colors = mesh->colors ? MESO_NEW(arena, MesoMeshColor, count, error) : NULL,
                       .corners = MESO_NEW(arena, uint32_t, (size_t)mesh->face_width * mesh->face_count, error)};
    out->along = MESO_NEW(arena, float, count, error);
    out->ring_begin = MESO_NEW(arena, uint32_t, count + 1, error);
    return arrays->positions && arrays->normals && arrays->corners && out->along && out->ring_begin &&
           (arrays->uvs || !mesh->uvs) && (arrays->colors || !mesh->colors);
}

static void fill_vertices(Arrays *arrays, const MesoBody *mesh, const Fit *fit, const Place *places, uint32_t *row)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        uint32_t v = places[i].vertex;
        MesoVec3 p = turn(fit->axis, mesh->positions[v]), n = turn(fit->axis, mesh->normals[v]);
        arrays->positions[i] = (MesoVec3){places[i].along, p.y / fit->width, p.z / fit->width};
        arrays->normals[i] = meso_vec3_direction((MesoVec3){n.x * fit->length, n.y * fit->width, n.z * fit->width},
                                                 (MesoVec3){0, 0, 1});
        if (arrays->uvs)
            arrays->uvs[i] = mesh->uvs[v];
        if (arrays->colors)
            arrays->colors[i] = mesh->colors[v];
        row[v] = i;
    }
}

MesoStatus meso_terminal_shape_build(MesoTerminalShape *out, MesoArena *arena, const MesoBody *mesh,
                                     MesoShapeAxis axis, MesoError *error)
{
    Arrays arrays;
    Fit fit;
    *out = (MesoTerminalShape){.ring_count = 0};
    MesoStatus status = find_fit(&fit, mesh, axis, error);
    if (status)
        return status;
    if (!allocate(&arrays, out, arena, mesh, error))
        return MESO_ERR_MEMORY;
    MesoArenaMark mark = meso_arena_mark(arena);
    Place *places = MESO_NEW(arena, Place, mesh->vertex_count, error);
    uint32_t *row = MESO_NEW(arena, uint32_t, mesh->vertex_count, error);
    if (!places || !row)
        return MESO_ERR_MEMORY;

    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        places[v] = (Place){(turn(axis, mesh->positions[v]).x - fit.origin) / fit.length, v};
    qsort(places, mesh->vertex_count, sizeof *places, compare_places);
    out->ring_count = gather_rings(places, mesh->vertex_count, out->along, out->ring_begin);
    fill_vertices(&arrays, mesh, &fit, places, row);
    for (size_t i = 0; i < (size_t)mesh->face_width * mesh->face_count; i++)
        arrays.corners[i] = mesh->corners[i] == MESO_NO_INDEX ? MESO_NO_INDEX : row[mesh->corners[i]];
    out->body = (MesoBody){mesh->vertex_count, mesh->face_count, mesh->face_width, arrays.positions, arrays.normals,
                           arrays.uvs, arrays.colors, arrays.corners};
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}
