#include "formats/mesh/mesh_read.h"

#include <ctype.h>
#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "formats/product/file_kind.h"
#include "libcore/mesh/edit/face_loops.h"

typedef struct MeshKind {
    const char *extensions[2];
    unsigned content;           /* of MesoFileKind */
    MesoStatus (*read)(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                       MesoError *error);
    uint32_t (*face_line)(MesoArena *scratch, const MesoInput *input, uint32_t face);   /* NULL: it has no lines */
} MeshKind;

static const MeshKind kinds[] = {
    {{".obj", NULL}, MESO_FILE_OBJ, meso_obj_read, meso_obj_face_line},
    {{".ply", NULL}, MESO_FILE_PLY, meso_ply_read, meso_ply_face_line},
    {{".off", NULL}, MESO_FILE_OFF, meso_off_read, meso_off_face_line},
    {{".glb", ".gltf"}, MESO_FILE_GLB | MESO_FILE_GLTF, meso_gltf_read, NULL},
    {{".drc", NULL}, MESO_FILE_DRC, meso_draco_read, NULL},
};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

static bool equal_ignoring_case(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == *b)
        a++, b++;
    return !*a && !*b;
}

static const MeshKind *kind_by_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *extension = strrchr(slash ? slash : path, '.');
    for (uint32_t k = 0; extension && k < KIND_COUNT; k++)
        for (uint32_t e = 0; e < 2; e++)
            if (kinds[k].extensions[e] && equal_ignoring_case(extension, kinds[k].extensions[e]))
                return &kinds[k];
    return NULL;
}

/* For names without a known extension, such as standard input. Comments alone may go on as OBJ. */
static const MeshKind *kind_by_content(const MesoInput *input)
{
    MesoFileKind content = meso_file_kind(input);
    size_t mark = meso_input_mark(input);
    if (mark < input->size && input->data[mark] == '#' && content == MESO_FILE_UNKNOWN)
        content = MESO_FILE_OBJ;
    for (uint32_t k = 0; k < KIND_COUNT; k++)
        if (kinds[k].content & content)
            return &kinds[k];
    return NULL;
}

static const MeshKind *kind_of(const MesoInput *input)
{
    const MeshKind *kind = kind_by_name(input->path);
    return kind ? kind : kind_by_content(input);
}

MesoStatus meso_mesh_fail_at_face(const MesoInput *input, uint32_t face, MesoError *error)
{
    const MeshKind *kind = kind_of(input);
    MesoArena scratch;
    char message[sizeof error->message];
    uint32_t line = 0;
    meso_arena_init(&scratch);
    if (face != MESO_NO_INDEX && kind && kind->face_line)
        line = kind->face_line(&scratch, input, face);
    meso_arena_release(&scratch);
    if (!error || !line)
        return meso_fail_prefix(error, input->path);
    memcpy(message, error->message, sizeof message);
    return meso_fail(error, error->status, "%s:%u: %s", input->path, line, message);
}

static MesoStatus check_elements(const MesoPolygonMesh *mesh, const MesoInput *input, uint32_t thread_count,
                                 MesoError *error)
{
    uint32_t face;
    MesoStatus status = meso_polygon_mesh_check(mesh, thread_count, &face, error);
    return status == MESO_ERR_INPUT ? meso_mesh_fail_at_face(input, face, error) : status;
}

static MesoStatus check(const MesoPolygonMesh *mesh, const MesoInput *input, uint32_t thread_count, MesoError *error)
{
    MesoStatus status = check_elements(mesh, input, thread_count, error);
    if (!status && mesh->face_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: mesh has no faces", input->path);
    return status;
}

static MesoStatus read_unchecked(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                                 MesoError *error)
{
    *mesh = (MesoPolygonMesh){0};
    if (input->size == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: empty file", input->path);
    const MeshKind *kind = kind_of(input);
    if (!kind)
        return meso_fail(error, MESO_ERR_INPUT, "%s: not a mesh; OBJ, PLY, OFF, glTF and Draco are read", input->path);
    return kind->read(mesh, arena, input, thread_count, error);
}

MesoStatus meso_polygon_mesh_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                  uint32_t thread_count, MesoError *error)
{
    MesoError ignored;
    error = error ? error : &ignored;
    MesoStatus status = read_unchecked(mesh, arena, input, thread_count, error);
    return status ? status : check(mesh, input, thread_count, error);
}

MesoStatus meso_polygon_mesh_read_vertices(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                           uint32_t thread_count, MesoError *error)
{
    MesoStatus status = read_unchecked(mesh, arena, input, thread_count, error);
    return status ? status : check_elements(mesh, input, thread_count, error);
}

static bool has_vertices_at_corners(const MesoPolygonMesh *mesh)
{
    for (uint32_t c = 0; c < mesh->corner_count; c++)
        if (mesh->corners[c] >= mesh->vertex_count)
            return false;
    return true;
}

/* Where the loops do not help either, the error is that of the mesh as it is. */
MesoStatus meso_polygon_mesh_read_loops(MesoPolygonMesh *mesh, uint32_t *looped, MesoArena *arena,
                                        const MesoInput *input, uint32_t thread_count, MesoError *error)
{
    MesoPolygonMesh cut;
    MesoError as_it_is;
    *looped = 0;
    MesoStatus status = read_unchecked(mesh, arena, input, thread_count, error);
    if (status)
        return status;
    status = check(mesh, input, thread_count, error);
    if (status != MESO_ERR_INPUT || !has_vertices_at_corners(mesh))
        return status;
    as_it_is = *error;
    status = meso_mesh_cut_loops(&cut, arena, mesh, looped, error);
    if (!status)
        status = check(&cut, input, thread_count, error);
    if (status == MESO_ERR_INPUT)
        *error = as_it_is;
    *mesh = status ? *mesh : cut;
    return status;
}

MesoStatus meso_mesh_texture_problem(const MesoInput *input, uint32_t thread_count, MesoError *error)
{
    const MeshKind *kind = kind_of(input);
    MesoPolygonMesh mesh;
    MesoArena scratch;
    if (!kind || kind->read != meso_obj_read)
        return MESO_OK;
    meso_arena_init(&scratch);
    MesoStatus status = meso_obj_read_strictly(&mesh, &scratch, input, thread_count, error);
    if (!status)
        status = check(&mesh, input, thread_count, error);
    meso_arena_release(&scratch);
    return status;
}
