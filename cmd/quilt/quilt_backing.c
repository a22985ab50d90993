#include "cmd/quilt/quilt_backing.h"

#include <string.h>

#include "formats/model/scene_of_mesh.h"

enum { MOST_MATERIALS = UINT16_MAX };

/* A longer copy of an array; NULL where memory is out. */
static void *longer(const void *array, size_t count, size_t more, size_t size, MesoArena *arena, MesoError *error)
{
    void *copy = meso_arena_alloc(arena, count + more, size, error);
    if (copy && count)
        memcpy(copy, array, count * size);
    return copy;
}

static MesoStatus make_room(MesoScene *s, const MesoScene *backing, MesoArena *arena, MesoError *error)
{
    if ((uint64_t)s->material_count + backing->material_count > MOST_MATERIALS)
        return meso_fail(error, MESO_ERR_LIMIT, "the swatch and the surface have over %d materials", MOST_MATERIALS);
    s->bodies = longer(s->bodies, s->body_count, backing->body_count, sizeof *s->bodies, arena, error);
    s->placed = longer(s->placed, s->placed_count, backing->placed_count, sizeof *s->placed, arena, error);
    s->materials = longer(s->materials, s->material_count, backing->material_count, sizeof *s->materials, arena, error);
    s->material_names = longer(s->material_names, s->material_count, backing->material_count, sizeof *s->material_names,
                               arena, error);
    s->ids = longer(s->ids, (size_t)s->id_row_count * s->channel_count, s->channel_count, sizeof *s->ids, arena, error);
    return s->bodies && s->placed && s->materials && s->material_names && s->ids ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_quilt_add_backing(MesoScene *s, MesoArena *arena, const MesoPolygonMesh *mesh, MesoError *error)
{
    MesoScene backing;
    MesoStatus status = meso_scene_of_mesh(&backing, arena, mesh, error);
    if (!status)
        status = make_room(s, &backing, arena, error);
    if (status)
        return status;
    memcpy(s->bodies + s->body_count, backing.bodies, backing.body_count * sizeof *s->bodies);
    memcpy(s->materials + s->material_count, backing.materials, backing.material_count * sizeof *s->materials);
    memcpy(s->material_names + s->material_count, backing.material_names,
           backing.material_count * sizeof *s->material_names);
    for (uint32_t p = 0; p < backing.placed_count; p++) {
        MesoPlacedBody placed = backing.placed[p];
        placed.body += s->body_count;
        placed.material += s->material_count;
        placed.ids = s->id_row_count;
        s->placed[s->placed_count++] = placed;
    }
    for (uint32_t c = 0; c < s->channel_count; c++)
        s->ids[(size_t)s->id_row_count * s->channel_count + c] = s->channels[c].count++;
    s->id_row_count++;
    s->body_count += backing.body_count;
    s->material_count += backing.material_count;
    meso_scene_measure(s);
    return MESO_OK;
}
