#include "cmd/solve/solve_surface.h"

#include <stdio.h>
#include <string.h>

#include "cmd/common/input_kind.h"
#include "formats/mesh/surface_field.h"
#include "libcore/mesh/orientation.h"

static const char field_prefix[] = "field=";

static const char *attribute_of(const char *orient)
{
    size_t length = sizeof field_prefix - 1;
    return strncmp(orient, field_prefix, length) == 0 ? orient + length : NULL;
}

MesoStatus meso_orient_check(const MesoOrientArguments *orient, MesoError *error)
{
    const char *how = orient->how, *attribute = attribute_of(how);
    if (strcmp(how, "file") == 0 || strcmp(how, "comb") == 0 || strcmp(how, "u,v") == 0)
        return MESO_OK;
    if (attribute && *attribute)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "--orient: '%s' is not file, comb, field=ATTRIBUTE or u,v", how);
}

typedef struct Orienting {
    MesoTool *tool;
    const char *orient;
    const MesoInput *input;
    const MesoQuadSurface *quads;   /* not turned */
    MesoSolveSurface *surface;
    uint32_t without;           /* faces that the field says nothing about */
} Orienting;

static MesoStatus follow_field(Orienting *o)
{
    MesoTool *tool = o->tool;
    MesoVec3 *directions = NULL;
    const char *attribute = attribute_of(o->orient);
    MesoArenaMark mark = meso_arena_mark(&tool->arena);
    MesoStatus status = attribute ? meso_surface_attribute_field(&directions, &tool->arena, o->quads, o->input, attribute,
                                                                 &tool->error)
                                  : meso_surface_texture_field(&directions, &tool->arena, o->quads, o->input, &tool->error);
    if (!status)
        o->without = meso_orientation_along(o->surface->quarters, &o->surface->mesh, directions);
    meso_arena_rewind(&tool->arena, mark);
    if (!status && o->without == o->surface->mesh.face_count)
        return meso_fail(&tool->error, MESO_ERR_INPUT, "%s: %s gives no face a direction", o->input->path, o->orient);
    return status;
}

static MesoStatus find_quarters(Orienting *o)
{
    MesoTool *tool = o->tool;
    MesoSolveSurface *surface = o->surface;
    surface->quarters = MESO_NEW(&tool->arena, uint8_t, surface->graph.slot_count, &tool->error);
    if (!surface->quarters)
        return MESO_ERR_MEMORY;
    if (strcmp(o->orient, "file") == 0)
        return MESO_OK;
    if (strcmp(o->orient, "comb") == 0)
        return meso_orientation_comb(surface->quarters, &tool->arena, &surface->graph, &tool->error);
    return follow_field(o);
}

static MesoStatus report_orientation(const Orienting *o, uint32_t disagreeing, uint32_t singular,
                                     const uint32_t *vertices)
{
    json_t *list = json_array();
    int failed = list == NULL;
    for (uint32_t i = 0; i < singular && i < MESO_REPORT_SINGULAR && !failed; i++)
        failed |= json_array_append_new(list, json_integer(vertices[i]));
    json_t *object = json_pack("{sssIsIsIso}", "orient", o->orient, "disagreeing_edges", (json_int_t)disagreeing,
                               "slots_without_direction", (json_int_t)o->without,
                               "singular_corners", (json_int_t)singular, "singular_vertices", list);
    failed |= json_object_set_new(o->tool->report, "orientation", object);
    return failed ? meso_fail(&o->tool->error, MESO_ERR_MEMORY, "out of memory for the report") : MESO_OK;
}

/* What cannot agree, in numbers, before the sides are renamed. */
static MesoStatus tell_orientation(const Orienting *o)
{
    MesoTool *tool = o->tool;
    const MesoSlotGraph *graph = &o->surface->graph;
    uint32_t singular, vertices[MESO_REPORT_SINGULAR];
    uint32_t disagreeing = meso_orientation_disagreeing(graph, o->surface->quarters);
    MesoStatus status = meso_orientation_singular(&singular, vertices, MESO_REPORT_SINGULAR, &tool->arena,
                                                  &o->surface->mesh, graph, &tool->error);
    if (status)
        return status;
    char without[64] = "";
    if (o->without)
        snprintf(without, sizeof without, ", %u slots without a direction", o->without);
    meso_tool_say_of(tool, o->input->path, "orient %s: %u of %u edges disagree, %u singular corner%s%s", o->orient,
                     disagreeing, graph->edge_count - graph->border_count, singular, singular == 1 ? "" : "s", without);
    return report_orientation(o, disagreeing, singular, vertices);
}

static MesoStatus orient(Orienting *o)
{
    MesoStatus status = find_quarters(o);
    if (!status)
        status = tell_orientation(o);
    MesoTool *tool = o->tool;
    if (!status)
        status = meso_orientation_turn_graph(&o->surface->graph, &tool->arena, o->surface->quarters, &tool->error);
    if (!status)
        status = meso_orientation_turn_mesh(&o->surface->mesh, &tool->arena, o->surface->quarters, &tool->error);
    return status;
}

static MesoStatus judge(MesoTool *tool, const MesoSurfaceWish *wish, const MesoSolveSurface *surface,
                        const MesoWindCounts *wound)
{
    MesoSurfaceJudge judge = {.path = wish->path, .mesh = &surface->mesh, .graph = &surface->graph,
                              .wound = wound, .set = wish->set, .strict = wish->strict};
    return meso_tool_judge_surface(tool, &judge);
}

MesoStatus meso_tool_read_surface(MesoTool *tool, const MesoSurfaceWish *wish, MesoSolveSurface *surface)
{
    MesoInput input;
    MesoQuadSurface quads;
    MesoWindCounts wound = {0};
    *surface = (MesoSolveSurface){0};
    MesoStatus status = meso_tool_open_place(tool, &input, wish->path, &MESO_PLACE_SURFACE);
    if (status)
        return status;
    memcpy(surface->hash, input.hash, sizeof surface->hash);
    status = (wish->pairs ? meso_quad_surface_read_pairs : meso_quad_surface_read)(&quads, &tool->arena, &input,
                                                                                   tool->threads, &tool->error);
    if (!status)
        status = meso_quad_surface_wind(&quads, &tool->arena, &input, NULL, &surface->over, &wound, tool->threads,
                                        &tool->error);
    if (!status) {
        surface->file = quads.surface;
        surface->mesh = quads.mesh;
        surface->graph = quads.graph;
        status = judge(tool, wish, surface, &wound);
    }
    if (!status && wish->orient.given) {
        Orienting o = {.tool = tool, .orient = wish->orient.how, .input = &input, .quads = &quads, .surface = surface};
        status = orient(&o);
    }
    meso_input_close(&input);
    return status;
}
