#include "cmd/grow/grow_backdrop.h"

#include <string.h>

#include "cmd/grow/grow_material.h"
#include "formats/model/scene_of_mesh.h"

/* `array` [count] in the arena with room for `more`; NULL when memory is out. */
static void *with_room(MesoTool *tool, const void *array, size_t count, size_t more, size_t size)
{
    char *larger = meso_arena_alloc(&tool->arena, count + more, size, &tool->error);
    if (larger && count)
        memcpy(larger, array, count * size);
    return larger;
}

#define WITH_ROOM(tool, array, count, more) with_room(tool, array, count, more, sizeof *(array))

/* The row of ids of the surface: one more in each channel. */
static MesoStatus add_ids(MesoScene *scene, MesoTool *tool)
{
    scene->ids = WITH_ROOM(tool, scene->ids, (size_t)scene->id_row_count * scene->channel_count, scene->channel_count);
    if (!scene->ids)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        MesoIdChannel *channel = &scene->channels[c];
        scene->ids[(size_t)scene->id_row_count * scene->channel_count + c] = channel->count;
        if (channel->names) {
            channel->names = WITH_ROOM(tool, channel->names, channel->count, 1);
            if (!channel->names)
                return MESO_ERR_MEMORY;
            channel->names[channel->count] = "surface";
        }
        channel->count++;
    }
    scene->id_row_count++;
    return MESO_OK;
}

static MesoStatus add_material(MesoScene *scene, MesoTool *tool, const char *text)
{
    MesoMaterial look = {{0.5f, 0.5f, 0.5f}, 0.7f, 0};
    char name[MESO_GROW_NAME];
    MesoStatus status = meso_grow_material(&look, name, text, &tool->error);
    if (status) {
        tool->error.status = MESO_ERR_USAGE;
        meso_fail_prefix(&tool->error, "--surface");
        return MESO_ERR_USAGE;
    }
    scene->materials = WITH_ROOM(tool, scene->materials, scene->material_count, 1);
    scene->material_names = WITH_ROOM(tool, scene->material_names, scene->material_count, 1);
    const char *copy = meso_arena_copy_text(&tool->arena, name, &tool->error);
    if (!scene->materials || !scene->material_names || !copy)
        return MESO_ERR_MEMORY;
    scene->materials[scene->material_count] = look;
    scene->material_names[scene->material_count++] = copy;
    return MESO_OK;
}

MesoStatus meso_grow_backdrop(MesoScene *scene, MesoTool *tool, const MesoPolygonMesh *mesh, const char *text)
{
    MesoScene shown;
    MesoPolygonMesh bare = *mesh;
    const MesoAttribute *normals = meso_polygon_normals(mesh);
    bare.attribute_count = normals ? 1 : 0;
    bare.attributes = (MesoAttribute *)normals;
    MesoStatus status = add_material(scene, tool, text);
    if (!status)
        status = meso_scene_of_mesh(&shown, &tool->arena, &bare, &tool->error);
    if (!status)
        status = add_ids(scene, tool);
    if (status)
        return status;
    scene->bodies = WITH_ROOM(tool, scene->bodies, scene->body_count, shown.body_count);
    scene->placed = WITH_ROOM(tool, scene->placed, scene->placed_count, shown.body_count);
    if (!scene->bodies || !scene->placed)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < shown.body_count; i++) {
        scene->placed[scene->placed_count++] = (MesoPlacedBody){
            .body = scene->body_count, .material = scene->material_count - 1, .ids = scene->id_row_count - 1,
            .place = MESO_PLACED_HERE};
        scene->bodies[scene->body_count++] = shown.bodies[i];
    }
    meso_scene_measure(scene);
    return MESO_OK;
}
