#include "cmd/replicate/replicate_clip.h"

#include <string.h>
#include <strings.h>

#include "formats/mesh/mesh_read.h"
#include "libcore/mesh/edit/ear_clip.h"
#include "libcore/mesh/point/vertex_normals.h"

/* ---- the surface at rest ---- */

MesoStatus meso_replicate_drop_normals(MesoPolygonMesh *mesh, MesoTool *tool)
{
    MesoAttribute *kept = MESO_NEW(&tool->arena, MesoAttribute, mesh->attribute_count, &tool->error);
    uint32_t count = 0;
    if (!kept)
        return MESO_ERR_MEMORY;
    for (uint32_t a = 0; a < mesh->attribute_count; a++)
        if (strcmp(mesh->attributes[a].name, "normal") != 0)
            kept[count++] = mesh->attributes[a];
    mesh->attributes = kept;
    mesh->attribute_count = count;
    return MESO_OK;
}

static MesoStatus triangulate(MesoReplicateClip *c)
{
    MesoTool *tool = c->tool;
    const MesoInput *input = meso_clip_mesh_input(c->file);
    MesoSurface surface;
    uint32_t face = MESO_NO_INDEX;
    MesoStatus status = meso_surface_build(&surface, &tool->arena, &c->polygons, tool->threads, &tool->error);
    if (!status)
        status = meso_surface_require(&surface, MESO_NEEDS_MANIFOLD, &face, &tool->error);
    if (status == MESO_ERR_INPUT)
        return meso_mesh_fail_at_face(input, face, &tool->error);
    c->triangles = c->polygons;
    if (!status && c->polygons.side_count != 3)
        status = meso_mesh_cut_faces(&c->triangles, &tool->arena, &c->polygons, &tool->error);
    if (!status && c->polygons.side_count != 3)
        status = meso_surface_build(&surface, &tool->arena, &c->triangles, tool->threads, &tool->error);
    return status ? status : meso_triangulation_init(&c->rest, &surface, 0, 0, &tool->error);
}

static const MesoVec3 *show_positions(void *context, uint32_t frame, MesoError *error)
{
    const MesoReplicateClip *c = context;
    (void)error;
    return (int64_t)frame == c->number ? c->positions : c->before;
}

static MesoStatus make_room(MesoReplicateClip *c)
{
    MesoVec3 **const arrays[] = {&c->positions, &c->before, &c->normals};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (!(*arrays[i] = MESO_NEW(&c->tool->arena, MesoVec3, c->rest.vertex_count, &c->tool->error)))
            return MESO_ERR_MEMORY;
    c->frame_count = meso_clip_frame_count(c->file);
    c->number = -1;
    c->clip = (MesoClip){&c->rest, c->frame_count, show_positions, c};
    return MESO_OK;
}

static bool is_animation(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".glb") == 0 || strcasecmp(dot, ".gltf") == 0);
}

static MesoStatus note_input(MesoTool *tool, const MesoInput *input)
{
    MesoStatus status = meso_paths_add_input(&tool->paths, input->path, &tool->arena, &tool->error);
    return status ? status : meso_provenance_add(&tool->provenance, "surface", input, &tool->arena, &tool->error);
}

MesoStatus meso_replicate_clip_open(MesoReplicateClip *c, MesoReplicateArguments *a, const char *path)
{
    MesoTool *tool = c->tool = &a->tool;
    const MesoClipSource source = {
        .path = path, .rest = a->mesh, .frames_per_second = (double)a->frames_per_second, .thread_count = tool->threads,
        .weld = is_animation(path), .ahead = true};
    MesoStatus status = meso_clip_open(&c->file, &source, &tool->error);
    if (!status)
        status = note_input(tool, meso_clip_mesh_input(c->file));
    if (status)
        return status;
    c->polygons = *meso_clip_mesh(c->file);
    status = meso_replicate_drop_normals(&c->polygons, tool);
    if (!status)
        status = triangulate(c);
    return status ? status : make_room(c);
}

void meso_replicate_clip_close(MesoReplicateClip *c)
{
    meso_triangulation_release(&c->rest);
    meso_clip_release(c->file);
}

/* ---- frames ---- */

int32_t meso_replicate_clip_number(const MesoReplicateClip *c, uint32_t frame)
{
    return meso_clip_frame_number(c->file, frame);
}

MesoStatus meso_replicate_clip_find(const MesoReplicateClip *c, int32_t number, uint32_t *frame)
{
    uint32_t low = 0, high = c->frame_count;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (meso_replicate_clip_number(c, middle) < number)
            low = middle + 1;
        else
            high = middle;
    }
    *frame = low;
    if (low < c->frame_count && meso_replicate_clip_number(c, low) == number)
        return MESO_OK;
    return meso_fail(&c->tool->error, MESO_ERR_INPUT, "%s: no frame %d; there are %d to %d", c->tool->operands[1],
                     number, meso_replicate_clip_number(c, 0), meso_replicate_clip_number(c, c->frame_count - 1));
}

MesoStatus meso_replicate_clip_load(MesoReplicateClip *c, uint32_t frame)
{
    const MesoVec3 *all = meso_clip_place_frame(c->file, frame, &c->tool->error);
    if (!all)
        return c->tool->error.status;
    MesoVec3 *before = c->before;
    bool first = c->number < 0;
    c->before = c->positions;
    c->positions = before;
    for (uint32_t v = 0; v < c->rest.vertex_count; v++)
        c->positions[v] = all[c->rest.origins[v]];
    if (first)
        memcpy(c->before, c->positions, c->rest.vertex_count * sizeof *c->before);
    c->polygons.positions = (MesoVec3 *)(uintptr_t)all;     /* read alone */
    c->number = meso_replicate_clip_number(c, frame);
    MesoTriangulation now = c->rest;
    now.positions = c->positions;
    meso_vertex_normals(c->normals, &now);
    return MESO_OK;
}

void meso_replicate_clip_resume(MesoReplicateClip *c, const MesoVec3 *positions, int32_t number)
{
    memcpy(c->positions, positions, c->rest.vertex_count * sizeof *c->positions);
    c->number = number;
}
