#include "formats/model/scene_backdrop.h"

#include <string.h>

#include "formats/model/scene_of_mesh.h"
#include "formats/scene/material_text.h"

enum { MOST_MATERIALS = UINT16_MAX };

/* A longer copy of an array; NULL where memory is out. */
static void *longer(const void *array, size_t count, size_t more, size_t size, MesoArena *arena, MesoError *error)
{
    void *copy = meso_arena_alloc(arena, count + more, size, error);
    if (copy && count)
        memcpy(copy, array, count * size);
    return copy;
}

static MesoStatus make_room(MesoScene *s, const MesoScene *shown, MesoArena *arena, MesoError *error)
{
    if ((uint64_t)s->material_count + shown->material_count > MOST_MATERIALS)
        return meso_fail(error, MESO_ERR_LIMIT, "with those of the surface there are over %d materials", MOST_MATERIALS);
    s->bodies = longer(s->bodies, s->body_count, shown->body_count, sizeof *s->bodies, arena, error);
    s->placed = longer(s->placed, s->placed_count, shown->placed_count, sizeof *s->placed, arena, error);
    s->materials = longer(s->materials, s->material_count, shown->material_count, sizeof *s->materials, arena, error);
    s->material_names = longer(s->material_names, s->material_count, shown->material_count, sizeof *s->material_names,
                               arena, error);
    s->ids = longer(s->ids, (size_t)s->id_row_count * s->channel_count, s->channel_count, sizeof *s->ids, arena, error);
    return s->bodies && s->placed && s->materials && s->material_names && s->ids ? MESO_OK : MESO_ERR_MEMORY;
}

/* One more in each channel. */
static MesoStatus add_ids(MesoScene *s, MesoArena *arena, MesoError *error)
{
    for (uint32_t c = 0; c < s->channel_count; c++) {
        MesoIdChannel *channel = &s->channels[c];
        s->ids[(size_t)s->id_row_count * s->channel_count + c] = channel->count;
        if (channel->names) {
            channel->names = longer(channel->names, channel->count, 1, sizeof *channel->names, arena, error);
            if (!channel->names)
                return MESO_ERR_MEMORY;
            channel->names[channel->count] = "surface";
        }
        channel->count++;
    }
    s->id_row_count++;
    return MESO_OK;
}

static void add_bodies(MesoScene *s, const MesoScene *shown)
{
    for (uint32_t b = 0; b < shown->body_count; b++)
        s->bodies[s->body_count + b] = shown->bodies[b];
    for (uint32_t m = 0; m < shown->material_count; m++) {
        s->materials[s->material_count + m] = shown->materials[m];
        s->material_names[s->material_count + m] = shown->material_names[m];
    }
    for (uint32_t p = 0; p < shown->placed_count; p++) {
        MesoPlacedBody placed = shown->placed[p];
        placed.body += s->body_count;
        placed.material += s->material_count;
        placed.ids = s->id_row_count;
        s->placed[s->placed_count++] = placed;
    }
    s->body_count += shown->body_count;
    s->material_count += shown->material_count;
}

static bool is_own(const char *material)
{
    return strcmp(material, "own") == 0;
}

/* The mesh as a scene of one material, without what it looks like itself. */
static MesoStatus show_plainly(MesoScene *shown, MesoArena *arena, const MesoPolygonMesh *mesh, const char *material,
                               MesoError *error)
{
    static const MesoMaterial STONE = {{0.5f, 0.5f, 0.5f}, 0.7f, 0};
    MesoPolygonMesh bare = *mesh;
    const MesoAttribute *normals = meso_polygon_normals(mesh);
    char name[MESO_MATERIAL_NAME];
    bare.attribute_count = normals ? 1 : 0;
    bare.attributes = (MesoAttribute *)normals;
    MesoMaterial look = STONE;
    MesoStatus status = meso_material_of_text(&look, name, material, error);
    if (!status)
        status = meso_scene_of_mesh(shown, arena, &bare, error);
    if (status)
        return status;
    const char *copy = meso_arena_copy_text(arena, name, error);
    for (uint32_t m = 0; m < shown->material_count; m++) {
        shown->materials[m] = look;
        shown->material_names[m] = copy;
    }
    return copy ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_scene_add_backdrop(MesoScene *scene, MesoArena *arena, const MesoPolygonMesh *mesh,
                                   const char *material, MesoError *error)
{
    MesoScene shown;
    MesoStatus status = is_own(material) ? meso_scene_of_mesh(&shown, arena, mesh, error)
                                         : show_plainly(&shown, arena, mesh, material, error);
    if (!status)
        status = make_room(scene, &shown, arena, error);
    if (status)
        return status;
    add_bodies(scene, &shown);
    status = add_ids(scene, arena, error);
    meso_scene_measure(scene);
    return status;
}

MesoStatus meso_scene_check_backdrop(const char *material, MesoError *error)
{
    MesoMaterial look;
    char name[MESO_MATERIAL_NAME];
    MesoError wrong = {0};
    if (!material || is_own(material) || meso_material_of_text(&look, name, material, &wrong) == MESO_OK)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "--surface: %s", wrong.message);
}
