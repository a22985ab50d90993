#include "cmd/quilt/quilt_surface.h"

#include <stdlib.h>
#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/quilt/quilt_guide.h"
#include "formats/mesh/mesh_read.h"
#include "libcore/math/box.h"
#include "libcore/mesh/edit/ear_clip.h"

/* ---- planes ---- */

/* One side of "LxW": digits and a point, more than 0. */
static bool read_side(const char *text, size_t length, float *side)
{
    char number[32];
    if (length == 0 || length >= sizeof number || strspn(text, "0123456789.") < length)
        return false;
    memcpy(number, text, length);
    number[length] = 0;
    char *end;
    *side = strtof(number, &end);
    return *end == 0 && *side > 0 && *side < 1e12f;
}

static MesoStatus parse_plane(const char *text, MesoVec2 *size, MesoError *error)
{
    const char *cross = strchr(text, 'x');
    if (cross && read_side(text, (size_t)(cross - text), &size->x) && read_side(cross + 1, strlen(cross + 1), &size->y))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "option '--plane' needs two lengths, as 12x8, not '%s'", text);
}

MesoStatus meso_quilt_plane_check(MesoQuiltArguments *a)
{
    MesoVec2 size;
    return a->plane ? parse_plane(a->plane, &size, &a->tool.error) : MESO_OK;
}

/* Four triangles around the middle, so that none has all of its vertices on the border; from the origin, z up. */
static MesoStatus make_plane(MesoPolygonMesh *mesh, MesoQuiltArguments *a)
{
    static const uint32_t corners[12] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    MesoError *error = &a->tool.error;
    MesoVec2 size = {0, 0};
    MesoStatus status = parse_plane(a->plane, &size, error);
    if (status)
        return status;
    *mesh = (MesoPolygonMesh){.vertex_count = 5, .face_count = 4, .corner_count = 12, .side_count = 3};
    mesh->positions = MESO_NEW(&a->tool.arena, MesoVec3, 5, error);
    mesh->corners = MESO_NEW(&a->tool.arena, uint32_t, 12, error);
    mesh->attributes = MESO_NEW(&a->tool.arena, MesoAttribute, 1, error);
    if (!mesh->positions || !mesh->corners || !mesh->attributes)
        return MESO_ERR_MEMORY;
    mesh->positions[1].x = mesh->positions[2].x = size.x;
    mesh->positions[2].y = mesh->positions[3].y = size.y;
    mesh->positions[4] = (MesoVec3){size.x / 2, size.y / 2, 0};
    memcpy(mesh->corners, corners, sizeof corners);
    return MESO_OK;
}

/* ---- files ---- */

static MesoStatus read_file(MesoPolygonMesh *mesh, MesoQuiltArguments *a, MesoInput *input, const char *path)
{
    MesoTool *tool = &a->tool;
    MesoStatus status = meso_tool_open_place(tool, input, path, &MESO_PLACE_SURFACE);
    return status ? status : meso_polygon_mesh_read(mesh, &tool->arena, input, tool->threads, &tool->error);
}

/* Faults are named by the faces of the file, before these are cut. */
static MesoStatus require_whole(const MesoPolygonMesh *mesh, MesoQuiltArguments *a, const MesoInput *input)
{
    MesoTool *tool = &a->tool;
    MesoSurface surface;
    uint32_t face = MESO_NO_INDEX;
    MesoArenaMark mark = meso_arena_mark(&tool->arena);
    MesoStatus status = meso_surface_build(&surface, &tool->arena, mesh, tool->threads, &tool->error);
    if (!status)
        status = meso_surface_require(&surface, MESO_NEEDS_MANIFOLD | MESO_NEEDS_ORIENTED, &face, &tool->error);
    if (status == MESO_ERR_INPUT)
        meso_mesh_fail_at_face(input, face, &tool->error);
    meso_arena_rewind(&tool->arena, mark);
    return status;
}

static MesoStatus cut_faces(MesoQuiltSurface *s, MesoQuiltArguments *a)
{
    MesoPolygonMesh cut;
    if (s->polygons.side_count == 3)
        return MESO_OK;
    MesoStatus status = meso_mesh_cut_faces(&cut, &a->tool.arena, &s->polygons, &a->tool.error);
    if (!status)
        s->polygons = cut;
    return status;
}

static MesoStatus triangulate(MesoQuiltSurface *s, MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    MesoSurface surface;
    MesoStatus status = meso_surface_build(&surface, &tool->arena, &s->polygons, tool->threads, &tool->error);
    if (!status)
        status = meso_triangulation_init(&s->base, &surface, 0, 0, &tool->error);
    if (status)
        return status;
    MesoBox box = meso_box_of(s->base.positions, s->base.vertex_count);
    MesoVec3 sides = meso_vec3_sub(box.high, box.low);
    s->longest_side = fmaxf(sides.x, fmaxf(sides.y, sides.z));
    return MESO_OK;
}

/* Texture coordinates, so that the quilt can be carried over; not those that are not everywhere. */
static MesoStatus keep_texture(MesoQuiltSurface *s, MesoQuiltArguments *a)
{
    uint32_t without;
    MesoVec2 *uvs;
    const MesoTriangulation *base = &s->base;
    MesoTool *tool = &a->tool;
    MesoStatus status = meso_corner_uvs(&uvs, &tool->arena, &s->polygons, &without, &tool->error);
    if (status || !uvs)
        return status;
    s->uvs = MESO_NEW(&tool->arena, MesoVec2, 3 * (size_t)base->triangle_count, &tool->error);
    for (uint32_t c = 0; s->uvs && c < 3 * base->triangle_count; c++) {
        uint32_t corner = 3 * base->faces[c / 3], vertex = base->origins[base->corners[c]];
        while (s->polygons.corners[corner] != vertex)
            corner++;
        s->uvs[c] = uvs[corner];
    }
    return s->uvs ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_quilt_surface_read(MesoQuiltSurface *s, MesoQuiltArguments *a, MesoInput *input, const char *path)
{
    MesoStatus status = a->plane ? make_plane(&s->polygons, a) : read_file(&s->polygons, a, input, path);
    if (!status && !a->plane)
        status = require_whole(&s->polygons, a, input);
    if (status)
        return status;
    s->mark = meso_surface_mark(&s->polygons);
    status = meso_quilt_guide_add(&s->polygons, a);
    if (!status)
        status = cut_faces(s, a);
    if (!status)
        status = triangulate(s, a);
    if (!status)
        status = keep_texture(s, a);
    return status ? status : meso_quilt_guide_find(&s->guide, &s->polygons, &s->base, a);
}

void meso_quilt_surface_release(MesoQuiltSurface *s)
{
    meso_triangulation_release(&s->base);
}
