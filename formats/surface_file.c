#include "formats/surface_file.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "formats/gltf_read_adapter.h"
#include "formats/mesh_scan.h"
#include "formats/mesh_triangles.h"
#include "formats/openmesh_adapter.h"
#include "formats/product/file_kind.h"
#include "libcore/mesh/slot_graph.h"

typedef enum FileKind { KIND_OBJ, KIND_PLY, KIND_OFF, KIND_GLB, KIND_COUNT, KIND_UNKNOWN } FileKind;

static const char *const extensions[][2] = {
    [KIND_OBJ] = {".obj", ".obj"}, [KIND_PLY] = {".ply", ".ply"},
    [KIND_OFF] = {".off", ".off"}, [KIND_GLB] = {".glb", ".gltf"},
};

static bool equal_ignoring_case(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == *b)
        a++, b++;
    return !*a && !*b;
}

static FileKind kind_by_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *extension = strrchr(slash ? slash : path, '.');
    for (FileKind kind = 0; extension && kind < KIND_COUNT; kind++)
        if (equal_ignoring_case(extension, extensions[kind][0]) ||
            equal_ignoring_case(extension, extensions[kind][1]))
            return kind;
    return KIND_UNKNOWN;
}

/* For names without a known extension, such as standard input. Comments alone may go on as OBJ. */
static FileKind kind_by_content(const MesoInput *input)
{
    size_t mark = meso_input_mark(input);
    switch (meso_file_kind(input)) {
    case MESO_FILE_OBJ: return KIND_OBJ;
    case MESO_FILE_PLY: return KIND_PLY;
    case MESO_FILE_OFF: return KIND_OFF;
    case MESO_FILE_GLB:
    case MESO_FILE_GLTF: return KIND_GLB;
    default: return mark < input->size && input->data[mark] == '#' ? KIND_OBJ : KIND_UNKNOWN;
    }
}

/* Compares what OpenMesh reads with a scan, element by element. */
typedef struct Comparison {
    const MesoMeshScan *scan;
    uint32_t vertex_count, face_count;
    uint32_t wrong_vertex, wrong_face;      /* first that differs, or MESO_NO_INDEX */
} Comparison;

/* Six digits: OpenMesh may round a double twice on its way to a float. */
static bool agree(float a, float b)
{
    return fabsf(a - b) <= 1e-6f * fabsf(b);
}

static void compare_vertex(void *context, float x, float y, float z)
{
    Comparison *comparison = context;
    uint32_t v = comparison->vertex_count++;
    if (v >= comparison->scan->vertex_count || comparison->wrong_vertex != MESO_NO_INDEX)
        return;
    MesoVec3 p = comparison->scan->positions[v];
    if (!agree(x, p.x) || !agree(y, p.y) || !agree(z, p.z))
        comparison->wrong_vertex = v;
}

static void compare_face(void *context, const uint32_t *vertices, uint32_t count)
{
    Comparison *comparison = context;
    const MesoMeshScan *scan = comparison->scan;
    uint32_t f = comparison->face_count++;
    if (f >= scan->face_count || comparison->wrong_face != MESO_NO_INDEX)
        return;
    uint32_t begin = meso_mesh_scan_begin(scan, f);
    bool same = scan->face_ends[f] - begin == count;
    for (uint32_t i = 0; i < count && same && !scan->relative; i++)
        same = vertices[i] == scan->corner_vertices[begin + i];
    if (!same)
        comparison->wrong_face = f;
}

static MesoStatus cross_check(const MesoMeshScan *scan, FileKind kind, const char *path, MesoError *error)
{
    static const MesoOpenMeshKind kinds[] = {[KIND_OBJ] = MESO_OPENMESH_OBJ, [KIND_PLY] = MESO_OPENMESH_PLY,
                                             [KIND_OFF] = MESO_OPENMESH_OFF};
    Comparison comparison = {.scan = scan, .wrong_vertex = MESO_NO_INDEX, .wrong_face = MESO_NO_INDEX};
    MesoOpenMeshSink sink = {&comparison, compare_vertex, compare_face};
    if (!scan->bytes)
        return MESO_OK;
    if (meso_openmesh_read(kinds[kind], scan->bytes, scan->size, &sink, error))
        return meso_fail_prefix(error, path);
    if (comparison.wrong_vertex != MESO_NO_INDEX)
        return meso_fail(error, MESO_ERR_INPUT, "%s: OpenMesh reads vertex %u otherwise than the file has it",
                         path, comparison.wrong_vertex + 1);
    if (comparison.wrong_face != MESO_NO_INDEX)
        return meso_mesh_scan_fail(scan, path, comparison.wrong_face, error,
                                   "is read by OpenMesh otherwise than the file has it");
    if (comparison.vertex_count != scan->vertex_count || comparison.face_count != scan->face_count)
        return meso_fail(error, MESO_ERR_INPUT, "%s: OpenMesh reads %u vertices and %u faces of %u and %u",
                         path, comparison.vertex_count, comparison.face_count, scan->vertex_count,
                         scan->face_count);
    return MESO_OK;
}

/* Says whether a glTF is sound before it says that it is of no use. */
static MesoStatus refuse_gltf(const MesoInput *input, MesoError *error)
{
    uint32_t mesh_count;
    MesoStatus status = meso_gltf_parse(input, &mesh_count, error);
    if (status)
        return status;
    return meso_fail(error, MESO_ERR_INPUT, "%s: glTF holds triangles, which cannot be used yet: a macrosurface "
                     "needs quads; export OBJ, PLY or OFF", input->path);
}

/* Reads every element of the file to `scan`, by the kind that it turns out to be; `groups` may be NULL. */
static MesoStatus scan_file(MesoMeshScan *scan, FileKind *kind, MesoGroupsBuilder *groups, MesoArena *arena,
                            const MesoInput *input, MesoError *error)
{
    if (input->size == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: empty file", input->path);
    *kind = kind_by_name(input->path);
    if (*kind == KIND_UNKNOWN)
        *kind = kind_by_content(input);
    if (*kind == KIND_UNKNOWN)
        return meso_fail(error, MESO_ERR_INPUT, "%s: not a mesh; OBJ, PLY and OFF are read", input->path);
    if (*kind == KIND_GLB)
        return refuse_gltf(input, error);
    MesoStatus status = *kind == KIND_OBJ   ? meso_obj_scan_groups(scan, groups, arena, input, error)
                        : *kind == KIND_PLY ? meso_ply_scan_groups(scan, groups, arena, input, error)
                                            : meso_off_scan(scan, arena, input, error);
    if (!status && scan->face_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: mesh has no faces", input->path);
    return status;
}

MesoStatus meso_mesh_scan_file(MesoMeshScan *scan, MesoGroupsBuilder *groups, MesoArena *arena,
                               const MesoInput *input, MesoError *error)
{
    FileKind kind;
    return scan_file(scan, &kind, groups, arena, input, error);
}

static MesoStatus check_quads(const MesoMeshScan *scan, const char *path, MesoError *error)
{
    for (uint32_t f = 0; f < scan->face_count; f++) {
        uint32_t sides = scan->face_ends[f] - meso_mesh_scan_begin(scan, f);
        if (sides != 4)
            return meso_mesh_scan_fail(scan, path, f, error,
                                       "has %u sides; every face of a macrosurface must be a quad", sides);
    }
    return MESO_OK;
}

/* An edge with three faces fails here, in the slot graph, which is built only for that. */
static MesoStatus build_surface(MesoQuadMesh *mesh, MesoArena *arena, MesoMeshScan *scan, const char *path,
                                MesoError *error)
{
    MesoSlotGraph graph;
    bool normals = scan->normal_count > 0;
    MesoStatus status = meso_quad_mesh_build(mesh, arena, scan->vertex_count, scan->positions,
                                             scan->normal_count, scan->normals, scan->face_count,
                                             scan->corner_vertices, normals ? scan->corner_normals : NULL,
                                             error);
    if (!status)
        status = meso_slot_graph_build(&graph, scan->arena, mesh, error);
    return status ? meso_fail_prefix(error, path) : MESO_OK;
}

static MesoStatus read_surface(MesoQuadMesh *mesh, MesoSurfaceGroups *groups, MesoArena *arena,
                               const MesoInput *input, MesoError *error)
{
    MesoMeshScan scan;
    MesoArena scratch;
    MesoGroupsBuilder builder;
    FileKind kind;
    meso_arena_init(&scratch);
    meso_groups_begin(&builder, &scratch);
    MesoStatus status = scan_file(&scan, &kind, groups ? &builder : NULL, &scratch, input, error);
    if (!status)
        status = check_quads(&scan, input->path, error);
    if (!status)
        status = cross_check(&scan, kind, input->path, error);
    if (!status)
        status = build_surface(mesh, arena, &scan, input->path, error);
    if (!status && groups)
        status = meso_groups_finish(&builder, groups, arena, scan.vertex_count, scan.face_count,
                                    scan.corner_vertices, error);
    meso_groups_release(&builder);
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_surface_read(MesoQuadMesh *mesh, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    return read_surface(mesh, NULL, arena, input, error);
}

MesoStatus meso_surface_read_groups(MesoQuadMesh *mesh, MesoSurfaceGroups *groups, MesoArena *arena,
                                    const MesoInput *input, MesoError *error)
{
    return read_surface(mesh, groups, arena, input, error);
}

MesoStatus meso_triangle_mesh_read(MesoTriangleMesh *mesh, MesoArena *arena, const MesoInput *input,
                                   MesoError *error)
{
    MesoMeshScan scan;
    MesoArena scratch;
    FileKind kind;
    meso_arena_init(&scratch);
    MesoStatus status = scan_file(&scan, &kind, NULL, &scratch, input, error);
    if (!status)
        status = cross_check(&scan, kind, input->path, error);
    if (!status && meso_mesh_scan_triangulate(mesh, arena, &scan, error))
        status = meso_fail_prefix(error, input->path);
    meso_arena_release(&scratch);
    return status;
}
