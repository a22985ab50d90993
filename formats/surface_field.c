#include "formats/surface_field.h"

#include <assert.h>

#include "formats/mesh_scan.h"
#include "libcore/mesh/orientation.h"

typedef struct FieldReader {
    MesoArena scratch;
    MesoGroupsBuilder groups;
    const MesoQuadMesh *mesh;
    const MesoInput *input;
} FieldReader;

/* `reader` needs field_release() in any case. */
static MesoStatus field_scan(FieldReader *reader, const MesoQuadMesh *mesh, const MesoInput *input, bool textures,
                             MesoError *error)
{
    MesoMeshScan scan;
    *reader = (FieldReader){.mesh = mesh, .input = input};
    meso_arena_init(&reader->scratch);
    meso_groups_begin(&reader->groups, &reader->scratch);
    reader->groups.textures = textures;
    MesoStatus status = meso_mesh_scan_file(&scan, &reader->groups, &reader->scratch, input, error);
    if (!status && scan.face_count != mesh->face_count)
        return meso_fail(error, MESO_ERR_INPUT, "%s: has changed while it was read", input->path);
    return status;
}

static void field_release(FieldReader *reader)
{
    meso_groups_release(&reader->groups);
    meso_arena_release(&reader->scratch);
}

/* ---- attributes ---- */

/* Columns of the properties NAMEx NAMEy NAMEz, or NAME_x and so on; false where they are not all there. */
static bool find_vector(FieldReader *reader, const char *attribute, const char *separator, bool of_vertices,
                        const MesoGroupsColumn *columns[3])
{
    uint32_t count = of_vertices ? reader->mesh->vertex_count : reader->mesh->face_count;
    for (uint32_t i = 0; i < 3; i++) {
        const char *name = meso_arena_print(&reader->scratch, NULL, "%s%s%c", attribute, separator, "xyz"[i]);
        columns[i] = name ? meso_groups_find(&reader->groups, name, of_vertices, count) : NULL;
        if (!columns[i])
            return false;
    }
    return true;
}

static void add_up(MesoVec3 *directions, const MesoQuadMesh *mesh, const MesoGroupsColumn *const columns[3],
                   bool of_vertices)
{
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *corners = mesh->face_vertices + 4 * (size_t)f;
        double sum[3] = {0};
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t c = 0; c < (of_vertices ? 4 : 1); c++)
                sum[i] += columns[i]->values[of_vertices ? corners[c] : f];
        directions[f] = (MesoVec3){(float)sum[0], (float)sum[1], (float)sum[2]};
    }
}

/* Of faces before vertices. */
static bool take_attribute(MesoVec3 *directions, FieldReader *reader, const char *attribute)
{
    const MesoGroupsColumn *columns[3];
    for (uint32_t choice = 0; choice < 4; choice++) {
        bool of_vertices = choice >= 2;
        if (find_vector(reader, attribute, choice % 2 ? "_" : "", of_vertices, columns)) {
            add_up(directions, reader->mesh, columns, of_vertices);
            return true;
        }
    }
    return false;
}

MesoStatus meso_surface_attribute_read(MesoVec3 **directions, MesoArena *arena, const MesoQuadMesh *mesh,
                                       const MesoInput *input, const char *attribute, MesoError *error)
{
    FieldReader reader;
    MesoStatus status = field_scan(&reader, mesh, input, false, error);
    if (!status) {
        *directions = MESO_NEW(arena, MesoVec3, mesh->face_count, error);
        status = *directions ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (!status && !take_attribute(*directions, &reader, attribute))
        status = meso_fail(error, MESO_ERR_INPUT, "%s: has no vector attribute '%s': a PLY file would give it as the "
                           "properties %sx %sy %sz of faces or vertices", input->path, attribute, attribute,
                           attribute, attribute);
    field_release(&reader);
    return status;
}

/* ---- texture coordinates ---- */

/* Not a number, so that no gradient comes of it, where a corner has no coordinate. */
static bool take_texture(float *values, const FieldReader *reader)
{
    static const char *const names[] = {"s", "u", "texture_u"};
    const MesoGroupsBuilder *groups = &reader->groups;
    const MesoQuadMesh *mesh = reader->mesh;
    uint32_t corner_count = 4 * mesh->face_count;
    if (groups->texture_count) {
        assert(groups->corner_count == corner_count);
        for (uint32_t c = 0; c < corner_count; c++) {
            uint32_t texture = groups->corner_textures[c];
            values[c] = texture == MESO_NO_INDEX ? NAN : groups->texture_u[texture];
        }
        return true;
    }
    const MesoGroupsColumn *column = NULL;
    for (size_t i = 0; i < sizeof names / sizeof *names && !column; i++)
        column = meso_groups_find(groups, names[i], true, mesh->vertex_count);
    for (uint32_t c = 0; column && c < corner_count; c++)
        values[c] = (float)column->values[mesh->face_vertices[c]];
    return column != NULL;
}

MesoStatus meso_surface_texture_read(MesoVec3 **directions, MesoArena *arena, const MesoQuadMesh *mesh,
                                     const MesoInput *input, MesoError *error)
{
    FieldReader reader;
    float *values = NULL;
    MesoStatus status = field_scan(&reader, mesh, input, true, error);
    if (!status) {
        values = MESO_NEW(&reader.scratch, float, 4 * (size_t)mesh->face_count, error);
        *directions = values ? MESO_NEW(arena, MesoVec3, mesh->face_count, error) : NULL;
        status = *directions ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (!status && !take_texture(values, &reader))
        status = meso_fail(error, MESO_ERR_INPUT, "%s: has no texture coordinates: an OBJ file would give them as "
                           "'vt', a PLY file as the properties s and t, or u and v, of vertices", input->path);
    if (!status)
        meso_orientation_gradient(*directions, mesh, values);
    field_release(&reader);
    return status;
}
