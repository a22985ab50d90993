#include "libcore/growth/shape/bend.h"

#include <string.h>

void meso_bent_bodies(const MesoBending *bending, MesoBody *out)
{
    for (uint32_t i = 0; i < bending->span_count; i++) {
        size_t offset = (size_t)i * bending->shape->body.vertex_count;
        out[i] = bending->shape->body;
        out[i].positions = bending->positions + offset;
        out[i].normals = bending->normals + offset;
    }
}

/* `rows` of `size` bytes, `times` over. */
static void *repeat(MesoArena *arena, const void *rows, size_t size, uint32_t times, MesoError *error)
{
    char *all = meso_arena_alloc(arena, times, size, error);
    for (size_t i = 0; all && i < times; i++)
        memcpy(all + i * size, rows, size);
    return all;
}

static uint32_t *repeat_corners(MesoArena *arena, const MesoBody *one, uint32_t times, MesoError *error)
{
    size_t count = (size_t)one->face_width * one->face_count;
    uint32_t *all = meso_arena_alloc(arena, times, count * sizeof *all, error);
    for (uint32_t i = 0; all && i < times; i++)
        for (size_t k = 0; k < count; k++)
            all[i * count + k] = one->corners[k] == MESO_NO_INDEX ? MESO_NO_INDEX
                                                                  : one->corners[k] + i * one->vertex_count;
    return all;
}

MesoStatus meso_bent_body(const MesoBending *bending, MesoArena *arena, MesoBody *out, MesoError *error)
{
    const MesoBody *one = &bending->shape->body;
    uint32_t times = bending->span_count;
    uint64_t vertices = (uint64_t)times * one->vertex_count, faces = (uint64_t)times * one->face_count;
    if (vertices >= UINT32_MAX || faces >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "%u shapes of %u vertices and %u faces are too many for a body",
                         times, one->vertex_count, one->face_count);
    *out = *one;
    out->vertex_count = (uint32_t)vertices;
    out->face_count = (uint32_t)faces;
    out->positions = bending->positions;
    out->normals = bending->normals;
    out->corners = repeat_corners(arena, one, times, error);
    if (one->uvs)
        out->uvs = repeat(arena, one->uvs, one->vertex_count * sizeof *one->uvs, times, error);
    if (one->colors)
        out->colors = repeat(arena, one->colors, one->vertex_count * sizeof *one->colors, times, error);
    return out->corners && (out->uvs || !one->uvs) && (out->colors || !one->colors) ? MESO_OK : MESO_ERR_MEMORY;
}
