#include "formats/surface_groups.h"

#include <string.h>

bool meso_face_names_match(MesoGroupKind kind, const char *names, const char *name)
{
    size_t length = strlen(name);
    if (strcmp(names, name) == 0)
        return true;
    if (kind != MESO_GROUP_GROUP || length == 0)
        return false;
    for (const char *word = names; *word;) {
        size_t size = strcspn(word, " ");
        if (size == length && memcmp(word, name, length) == 0)
            return true;
        word += size;
        word += strspn(word, " ");
    }
    return false;
}

const MesoFaceAttribute *meso_face_attribute(const MesoSurfaceGroups *groups, const char *name)
{
    for (uint32_t a = 0; a < groups->attribute_count; a++)
        if (strcmp(groups->attributes[a].name, name) == 0)
            return &groups->attributes[a];
    return NULL;
}

void meso_groups_begin(MesoGroupsBuilder *builder, MesoArena *arena)
{
    *builder = (MesoGroupsBuilder){.arena = arena};
    for (uint32_t k = 0; k < MESO_GROUP_KINDS; k++)
        builder->current[k] = MESO_NO_INDEX;
}

void meso_groups_release(MesoGroupsBuilder *builder)
{
    for (uint32_t k = 0; k < MESO_GROUP_KINDS; k++) {
        json_decref(builder->numbers[k]);
        builder->numbers[k] = NULL;
    }
}

/* Room for one more of `count` elements: the array, or a copy of twice the size. NULL: out of memory. */
static void *grow(MesoArena *arena, void *array, size_t count, size_t *room, size_t size, MesoError *error)
{
    if (array && count < *room)
        return array;
    size_t larger = *room ? 2 * *room : 64;
    void *copy = meso_arena_alloc(arena, larger, size, error);
    if (copy && count)
        memcpy(copy, array, count * size);
    if (copy)
        *room = larger;
    return copy;
}

static void *grow_32(MesoArena *arena, void *array, uint32_t count, uint32_t *room, size_t size, MesoError *error)
{
    size_t wide = *room;
    void *copy = grow(arena, array, count, &wide, size, error);
    *room = (uint32_t)wide;
    return copy;
}

static MesoStatus out_of_memory(MesoError *error)
{
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the groups of a mesh");
}

static char *copy_bytes(MesoArena *arena, const char *bytes, size_t size, MesoError *error)
{
    char *copy = MESO_NEW(arena, char, size + 1, error);
    if (copy && size)
        memcpy(copy, bytes, size);
    return copy;
}

MesoStatus meso_groups_name(MesoGroupsBuilder *builder, MesoGroupKind kind, const char *name, size_t size,
                            MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(builder->arena);
    char *copy = copy_bytes(builder->arena, name, size, error);
    if (!copy)
        return MESO_ERR_MEMORY;
    if (!builder->numbers[kind] && !(builder->numbers[kind] = json_object()))
        return out_of_memory(error);
    const json_t *known = json_object_get(builder->numbers[kind], copy);
    if (known) {
        builder->current[kind] = (uint32_t)json_integer_value(known);
        meso_arena_rewind(builder->arena, mark);
        return MESO_OK;
    }
    const char **names = grow_32(builder->arena, builder->names[kind], builder->name_count[kind],
                                 &builder->name_room[kind], sizeof *names, error);
    if (!names)
        return MESO_ERR_MEMORY;
    builder->names[kind] = names;
    names[builder->name_count[kind]] = copy;
    builder->current[kind] = builder->name_count[kind]++;
    if (json_object_set_new_nocheck(builder->numbers[kind], copy, json_integer(builder->current[kind])))
        return out_of_memory(error);
    return MESO_OK;
}

MesoStatus meso_groups_face(MesoGroupsBuilder *builder, MesoError *error)
{
    uint32_t *of_face = grow_32(builder->arena, builder->of_face, builder->face_count, &builder->face_room,
                                MESO_GROUP_KINDS * sizeof *of_face, error);
    if (!of_face)
        return MESO_ERR_MEMORY;
    builder->of_face = of_face;
    memcpy(of_face + MESO_GROUP_KINDS * (size_t)builder->face_count++, builder->current, sizeof builder->current);
    return MESO_OK;
}

MesoStatus meso_groups_column(MesoGroupsBuilder *builder, const char *name, size_t size, bool of_vertices,
                              double scale, uint32_t *column, MesoError *error)
{
    MesoGroupsColumn *columns = grow_32(builder->arena, builder->columns, builder->column_count,
                                        &builder->column_room, sizeof *columns, error);
    char *copy = copy_bytes(builder->arena, name, size, error);
    if (!columns || !copy)
        return MESO_ERR_MEMORY;
    builder->columns = columns;
    *column = builder->column_count++;
    columns[*column] = (MesoGroupsColumn){.name = copy, .of_vertices = of_vertices, .scale = scale};
    return MESO_OK;
}

MesoStatus meso_groups_value(MesoGroupsBuilder *builder, uint32_t column, double value, MesoError *error)
{
    MesoGroupsColumn *values = &builder->columns[column];
    double *array = grow(builder->arena, values->values, values->count, &values->room, sizeof *array, error);
    if (!array)
        return MESO_ERR_MEMORY;
    values->values = array;
    array[values->count++] = value * values->scale;
    return MESO_OK;
}

MesoStatus meso_groups_texture(MesoGroupsBuilder *builder, float u, MesoError *error)
{
    float *array = grow_32(builder->arena, builder->texture_u, builder->texture_count, &builder->texture_room,
                           sizeof *array, error);
    if (!array)
        return MESO_ERR_MEMORY;
    builder->texture_u = array;
    array[builder->texture_count++] = u;
    return MESO_OK;
}

MesoStatus meso_groups_corner_texture(MesoGroupsBuilder *builder, uint32_t texture, MesoError *error)
{
    uint32_t *array = grow_32(builder->arena, builder->corner_textures, builder->corner_count, &builder->corner_room,
                              sizeof *array, error);
    if (!array)
        return MESO_ERR_MEMORY;
    builder->corner_textures = array;
    array[builder->corner_count++] = texture;
    return MESO_OK;
}

const MesoGroupsColumn *meso_groups_find(const MesoGroupsBuilder *builder, const char *name, bool of_vertices,
                                         uint32_t count)
{
    for (uint32_t c = 0; c < builder->column_count; c++) {
        const MesoGroupsColumn *column = &builder->columns[c];
        if (column->of_vertices == of_vertices && column->count == count && strcmp(column->name, name) == 0)
            return column;
    }
    return NULL;
}

static MesoStatus finish_names(const MesoGroupsBuilder *builder, MesoGroupKind kind, MesoFaceNames *names,
                               MesoArena *arena, MesoError *error)
{
    uint32_t count = builder->name_count[kind];
    names->names = MESO_NEW(arena, const char *, count, error);
    names->of_face = MESO_NEW(arena, uint32_t, builder->face_count, error);
    if (!names->names || !names->of_face)
        return MESO_ERR_MEMORY;
    names->count = count;
    for (uint32_t i = 0; i < count; i++)
        if (!(names->names[i] = meso_arena_copy_text(arena, builder->names[kind][i], error)))
            return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < builder->face_count; f++)
        names->of_face[f] = builder->of_face[MESO_GROUP_KINDS * (size_t)f + kind];
    return MESO_OK;
}

static MesoStatus finish_column(const MesoGroupsColumn *column, MesoSurfaceGroups *groups, MesoArena *arena,
                                const uint32_t *corner_vertices, MesoError *error)
{
    MesoFaceAttribute *attribute = &groups->attributes[groups->attribute_count++];
    attribute->of_vertices = column->of_vertices;
    attribute->name = meso_arena_copy_text(arena, column->name, error);
    attribute->values = MESO_NEW(arena, double, groups->face_count, error);
    if (!attribute->name || !attribute->values)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < groups->face_count; f++) {
        const uint32_t *corners = corner_vertices + 4 * (size_t)f;
        attribute->values[f] = !column->of_vertices
            ? column->values[f]
            : 0.25 * (column->values[corners[0]] + column->values[corners[1]] + column->values[corners[2]] +
                      column->values[corners[3]]);
    }
    return MESO_OK;
}

MesoStatus meso_groups_finish(MesoGroupsBuilder *builder, MesoSurfaceGroups *groups, MesoArena *arena,
                              uint32_t vertex_count, uint32_t face_count, const uint32_t *corner_vertices,
                              MesoError *error)
{
    MesoStatus status = MESO_OK;
    *groups = (MesoSurfaceGroups){.face_count = face_count};
    groups->attributes = MESO_NEW(arena, MesoFaceAttribute, builder->column_count, error);
    if (!groups->attributes)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < MESO_GROUP_KINDS && builder->face_count == face_count && !status; k++)
        status = finish_names(builder, (MesoGroupKind)k, &groups->names[k], arena, error);
    for (uint32_t of_vertices = 0; of_vertices < 2; of_vertices++)
        for (uint32_t c = 0; c < builder->column_count && !status; c++) {
            const MesoGroupsColumn *column = &builder->columns[c];
            if (column->of_vertices == of_vertices && column->count == (of_vertices ? vertex_count : face_count))
                status = finish_column(column, groups, arena, corner_vertices, error);
        }
    return status;
}
