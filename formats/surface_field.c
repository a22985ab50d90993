#include "formats/surface_field.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "formats/mesh_scan.h"
#include "libcore/surface/orientation.h"

/* Scans with `extras`, whose arrays live in `scratch`. */
static MesoStatus scan_again(MesoMeshExtras *extras, MesoArena *scratch, const MesoQuadMesh *mesh,
                             const MesoInput *input, MesoError *error)
{
    MesoMeshScan scan;
    MesoStatus status = meso_mesh_scan_file(&scan, extras, scratch, input, error);
    if (!status && scan.face_count != mesh->face_count)
        return meso_fail(error, MESO_ERR_INPUT, "%s: has changed while it was read", input->path);
    return status;
}

/* ---- attributes ---- */

static const char *const component_names[6] = {"x", "y", "z", "_x", "_y", "_z"};

static MesoStatus ask_for_attribute(MesoMeshExtras *extras, const char *attribute, const char *path,
                                    MesoError *error)
{
    for (uint32_t i = 0; i < 6; i++) {
        MesoScanColumn *column = &extras->columns[extras->column_count++];
        int size = snprintf(column->name, sizeof column->name, "%s%s", attribute, component_names[i]);
        if (size < 0 || (size_t)size >= sizeof column->name)
            return meso_fail(error, MESO_ERR_INPUT, "%s: no attribute has a name as long as '%s'", path,
                             attribute);
    }
    return MESO_OK;
}

static void add_up(MesoVec3 *directions, const MesoQuadMesh *mesh, const MesoScanColumn *columns, bool of_faces)
{
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *corners = mesh->face_vertices + 4 * (size_t)f;
        MesoVec3 sum = {0, 0, 0};
        for (uint32_t i = 0; i < (of_faces ? 1 : 4); i++) {
            MesoVec3 one = of_faces ? (MesoVec3){columns[0].of_faces[f], columns[1].of_faces[f], columns[2].of_faces[f]}
                                    : (MesoVec3){columns[0].of_vertices[corners[i]], columns[1].of_vertices[corners[i]],
                                                 columns[2].of_vertices[corners[i]]};
            sum = meso_vec3_add(sum, one);
        }
        directions[f] = sum;
    }
}

/* The first complete triple, of faces before vertices. */
static bool take_attribute(MesoVec3 *directions, const MesoQuadMesh *mesh, const MesoMeshExtras *extras)
{
    for (uint32_t choice = 0; choice < 4; choice++) {
        const MesoScanColumn *columns = extras->columns + 3 * (choice % 2);
        bool of_faces = choice < 2, complete = true;
        for (uint32_t i = 0; i < 3; i++)
            complete = complete && (of_faces ? columns[i].of_faces : columns[i].of_vertices) != NULL;
        if (complete) {
            add_up(directions, mesh, columns, of_faces);
            return true;
        }
    }
    return false;
}

MesoStatus meso_surface_attribute_read(MesoVec3 **directions, MesoArena *arena, const MesoQuadMesh *mesh,
                                       const MesoInput *input, const char *attribute, MesoError *error)
{
    MesoMeshExtras extras = {0};
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = ask_for_attribute(&extras, attribute, input->path, error);
    if (!status)
        status = scan_again(&extras, &scratch, mesh, input, error);
    if (!status) {
        *directions = MESO_NEW(arena, MesoVec3, mesh->face_count, error);
        status = *directions ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (!status && !take_attribute(*directions, mesh, &extras))
        status = meso_fail(error, MESO_ERR_INPUT, "%s: has no vector attribute '%s': a PLY file would give it as the "
                           "properties %sx %sy %sz of faces or vertices", input->path, attribute, attribute,
                           attribute, attribute);
    meso_arena_release(&scratch);
    return status;
}

/* ---- texture coordinates ---- */

/* Not a number, so that no gradient comes of it, where a corner has no coordinate. */
static bool take_texture(float *values, const MesoQuadMesh *mesh, const MesoMeshExtras *extras)
{
    uint32_t corner_count = 4 * mesh->face_count;
    if (extras->texture_count) {
        assert(extras->corner_texture_count == corner_count);
        for (uint32_t c = 0; c < corner_count; c++) {
            uint32_t texture = extras->corner_textures[c];
            values[c] = texture == MESO_NO_INDEX ? NAN : extras->texture_u[texture];
        }
        return true;
    }
    for (uint32_t i = 0; i < extras->column_count; i++) {
        const float *of_vertices = extras->columns[i].of_vertices;
        for (uint32_t c = 0; of_vertices && c < corner_count; c++)
            values[c] = of_vertices[mesh->face_vertices[c]];
        if (of_vertices)
            return true;
    }
    return false;
}

MesoStatus meso_surface_texture_read(MesoVec3 **directions, MesoArena *arena, const MesoQuadMesh *mesh,
                                     const MesoInput *input, MesoError *error)
{
    MesoMeshExtras extras = {.textures = true, .column_count = 3,
                             .columns = {{.name = "s"}, {.name = "u"}, {.name = "texture_u"}}};
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = scan_again(&extras, &scratch, mesh, input, error);
    float *values = status ? NULL : MESO_NEW(&scratch, float, 4 * (size_t)mesh->face_count, error);
    *directions = values ? MESO_NEW(arena, MesoVec3, mesh->face_count, error) : NULL;
    if (!status && !*directions)
        status = MESO_ERR_MEMORY;
    if (!status && !take_texture(values, mesh, &extras))
        status = meso_fail(error, MESO_ERR_INPUT, "%s: has no texture coordinates: an OBJ file would give them as "
                           "'vt', a PLY file as the properties s and t, or u and v, of vertices", input->path);
    if (!status)
        meso_orientation_gradient(*directions, mesh, values);
    meso_arena_release(&scratch);
    return status;
}
