#include "cmd/quilt/quilt_swatch.h"

#include <string.h>

#include "cmd/common/input_kind.h"
#include "formats/json/json_text.h"
#include "formats/mesh/mesh_read.h"
#include "formats/mesh/write/mesh_write.h"
#include "libcore/quilt/swatch/swatch_make.h"

static const MesoInputPlace PLACE_SWATCH = {
    "SWATCH", "a mesh (OBJ, PLY, OFF, glTF or Draco)", "swatch",
    MESO_FILE_OBJ | MESO_FILE_PLY | MESO_FILE_OFF | MESO_FILE_GLB | MESO_FILE_GLTF | MESO_FILE_DRC};

/* A periodic tile is repeated to so many elements along a side, and so much of itself: patches have a choice then. */
static const float LEAST_ELEMENTS = 5, LEAST_TILES = 1.5f;

MesoStatus meso_quilt_swatch_make(MesoPolygonMesh *mesh, MesoQuiltArguments *a)
{
    const MesoSwatchRecipe recipe = {
        .name = a->swatch, .columns = a->columns, .rows = a->rows, .jitter = a->jitter, .seed = a->tool.seed,
        .sides = a->sides, .thickness = a->thickness};
    MesoStatus status = meso_swatch_make(mesh, &a->tool.arena, &recipe, &a->tool.error);
    return status == MESO_ERR_USAGE ? meso_fail_prefix(&a->tool.error, "--swatch") : status;
}

/* ---- periods ---- */

static int periodic_bits(const char *text)
{
    return strcmp(text, "auto") == 0 ? -1 : (strchr(text, 'x') ? 1 : 0) | (strchr(text, 'y') ? 2 : 0);
}

static bool is_periodic(const MesoSwatch *swatch)
{
    return swatch->periodic_x || swatch->periodic_y;
}

/* What the tile should cover, along one direction: as it is where it has periods enough. */
static float cover_along(const MesoSwatch *swatch, bool periodic, float size, float period)
{
    if (!periodic || size >= LEAST_ELEMENTS * period)
        return size;
    return size * fmaxf(LEAST_TILES, LEAST_ELEMENTS / sqrtf((float)swatch->element_count));
}

static MesoStatus repeat(MesoQuiltSwatch *s, MesoQuiltArguments *a)
{
    MesoSwatch larger, *swatch = &s->swatch;
    MesoVec2 cover = {cover_along(swatch, swatch->periodic_x, swatch->size.x, swatch->period.x),
                      cover_along(swatch, swatch->periodic_y, swatch->size.y, swatch->period.y)};
    if (!is_periodic(swatch))
        return MESO_OK;
    bool enough = cover.x <= swatch->size.x && cover.y <= swatch->size.y;
    MesoStatus status = enough ? MESO_OK
                               : meso_swatch_repeat(&larger, &a->tool.arena, swatch, cover, &a->tool.error);
    if (status)
        return status;
    if (!enough)
        *swatch = larger;
    const char *more = enough ? "" : "; it was repeated";
    if (swatch->periodic_x && swatch->periodic_y)
        meso_tool_say(&a->tool, "the swatch is periodic along x, by %g, and y, by %g%s", (double)swatch->period.x,
                      (double)swatch->period.y, more);
    else
        meso_tool_say(&a->tool, "the swatch is periodic along %s, by %g%s", swatch->periodic_x ? "x" : "y",
                      (double)(swatch->periodic_x ? swatch->period.x : swatch->period.y), more);
    return MESO_OK;
}

/* ---- the whole ---- */

static MesoStatus read_mesh(MesoPolygonMesh *mesh, MesoQuiltArguments *a, MesoInput *input, const char *path)
{
    MesoStatus status = meso_tool_open_place(&a->tool, input, path, &PLACE_SWATCH);
    if (!status)
        status = meso_polygon_mesh_read(mesh, &a->tool.arena, input, a->tool.threads, &a->tool.error);
    return status;
}

MesoStatus meso_quilt_swatch_read(MesoQuiltSwatch *s, MesoQuiltArguments *a, MesoInput *input, const char *path)
{
    MesoTool *tool = &a->tool;
    const char *const axes = "xyz", *axis = strchr(axes, *a->up);
    const MesoSwatchOptions options = {.up = strlen(a->up) == 1 && axis ? (int)(axis - axes) : -1,
                                       .periodic = periodic_bits(a->periodic)};
    MesoStatus status = a->swatch ? meso_quilt_swatch_make(&s->mesh, a) : read_mesh(&s->mesh, a, input, path);
    if (status)
        return status;
    status = meso_swatch_build(&s->swatch, &tool->arena, &s->mesh, &options, &tool->error);
    if (status == MESO_ERR_INPUT)
        meso_fail_prefix(&tool->error, a->swatch ? a->swatch : path);
    if (status)
        return status;
    s->tile = s->swatch.size;
    return repeat(s, a);
}

MesoStatus meso_quilt_swatch_write(const MesoPolygonMesh *mesh, MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    MesoOutput *output = NULL;
    const char *path = tool->output ? tool->output : "-";
    MesoMeshKind kind = meso_mesh_kind_of(path);
    if (kind == MESO_MESH_KINDS)
        return meso_fail(&tool->error, MESO_ERR_USAGE,
                         "a swatch is written as one of %s, not '%s'; for a quilt, give SURFACE or --plane",
                         meso_mesh_kind_names(), path);
    MesoStatus status = meso_output_open(&output, path, &tool->error);
    if (!status)
        status = meso_polygon_mesh_write(mesh, kind, &tool->provenance, output, &tool->error);
    status = meso_output_finish(output, status, &tool->error);
    json_object_set_new(tool->report, "vertices", json_integer(mesh->vertex_count));
    json_object_set_new(tool->report, "faces", json_integer(mesh->face_count));
    return status;
}

static json_t *pair(float x, float y)
{
    json_t *list = json_array();
    json_array_append_new(list, meso_json_shortest(x));
    json_array_append_new(list, meso_json_shortest(y));
    return list;
}

void meso_quilt_swatch_report(json_t *report, const MesoQuiltSwatch *s)
{
    const MesoSwatch *swatch = &s->swatch;
    uint32_t strands = 0;
    for (uint32_t e = 0; e < swatch->element_count; e++)
        strands += swatch->kinds[e] == MESO_ELEMENT_STRAND;
    json_t *object = json_object(), *size = pair(swatch->size.x, swatch->size.y);
    json_array_append_new(size, meso_json_shortest(swatch->size.z));
    json_object_set_new(object, "vertices", json_integer(swatch->vertex_count));
    json_object_set_new(object, "triangles", json_integer(swatch->triangle_count));
    json_object_set_new(object, "elements", json_integer(swatch->element_count));
    json_object_set_new(object, "strands", json_integer(strands));
    json_object_set_new(object, "size", size);
    json_object_set_new(object, "mean_edge", meso_json_shortest(swatch->mean_edge));
    json_object_set_new(object, "open_edges", json_integer(swatch->open_edge_count));
    if (is_periodic(swatch))
        json_object_set_new(object, "period", pair(swatch->period.x, swatch->period.y));
    json_object_set_new(report, "swatch", object);
}
