#include "cmd/grow/grow_contexts.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "cmd/grow/grow_sources.h"
#include "libcore/field/direction_field.h"

/* ---- what sources share ---- */

MesoStatus meso_grow_source_fail(const MesoGrowSources *s, MesoStatus status, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return meso_fail(&s->tool->error, status, "%s:%u: %s: %s", s->tool->operands[0], s->source->line, s->what, text);
}

const char *meso_grow_source_path(const MesoGrowSources *s, const char *file)
{
    size_t length = s->folder ? strlen(s->folder) : 0;
    if (*file == '/' || length == 0)
        return file;
    return meso_arena_print(&s->tool->arena, &s->tool->error, "%s%s%s", s->folder,
                            s->folder[length - 1] == '/' ? "" : "/", file);
}

MesoStatus meso_grow_source_open(const MesoGrowSources *s, MesoInput *input, const char *file, const char *role)
{
    const char *path = meso_grow_source_path(s, file);
    return path ? meso_tool_open_input(s->tool, input, path, role) : MESO_ERR_MEMORY;
}

static void set_source(MesoGrowSources *s, const char *kind, const MesoGrammarSource *source)
{
    s->source = source;
    s->what = !source->name ? kind : meso_arena_print(&s->tool->arena, NULL, "%s '%s'", kind, source->name);
    s->what = s->what ? s->what : kind;
}

/* ---- maps ---- */

static MesoStatus fill_map(MesoGrowSources *s, MesoGrowthMap *map)
{
    switch (s->source->kind) {
    case MESO_MAP_IMAGE: return meso_grow_map_image(s, map);
    case MESO_MAP_ATTRIBUTE: return meso_grow_map_attribute(s, map);
    case MESO_MAP_REGION: return meso_grow_map_region(s, map);
    case MESO_MAP_BORDER: case MESO_MAP_POINTS: case MESO_MAP_CURVE: return meso_grow_map_distance(s, map);
    default: return meso_fail(&s->tool->error, MESO_ERR_INTERNAL, "a map of no kind");
    }
}

/* ---- fields ---- */

/* Those of least curvature lie across those of the largest. */
static MesoStatus find_principal(MesoGrowSources *s)
{
    MesoTool *tool = s->tool;
    const MesoTriangulation *mesh = s->ground->mesh;
    float *weights = MESO_NEW(&tool->arena, float, mesh->triangle_count, &tool->error);
    for (uint32_t i = 0; i < 2 && weights; i++)
        if (!(s->principal[i] = MESO_NEW(&tool->arena, MesoVec3, mesh->triangle_count, &tool->error)))
            weights = NULL;
    if (!weights)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_principal_directions(s->principal[0], weights, &tool->arena, mesh, &tool->error);
    for (uint32_t t = 0; t < mesh->triangle_count && !status; t++) {
        MesoTriangleFrame frame = meso_frame(mesh, t);
        MesoComplex along = meso_frame_in(&frame, s->principal[0][t]);
        if (!(weights[t] > 0))
            along = (MesoComplex){0, 0};
        s->principal[0][t] = meso_frame_out(&frame, along);
        s->principal[1][t] = meso_frame_out(&frame, (MesoComplex){-along.im, along.re});
    }
    return status;
}

static MesoStatus fill_principal(MesoGrowSources *s, MesoGrowthField *field)
{
    MesoStatus status = s->principal[0] ? MESO_OK : find_principal(s);
    field->kind = MESO_GROWTH_LINE;
    field->vectors = s->principal[s->source->values[0].index];
    return status;
}

static MesoStatus fill_given(MesoGrowSources *s, MesoGrowthField *field)
{
    MesoVec3 *vectors = NULL;
    MesoStatus status = meso_grow_attribute_vectors(s, &vectors);
    field->kind = MESO_GROWTH_GIVEN;
    field->vectors = vectors;
    return status;
}

static MesoStatus fill_field(MesoGrowSources *s, MesoGrowthField *field)
{
    const MesoGrammarValue *values = s->source->values;
    const MesoVec3 up = s->ground->up;
    field->reversed = s->source->reversed;
    for (uint32_t i = 0; i < 3; i++)
        field->vector[i] = values[i].number;
    switch (s->source->kind) {
    case MESO_FIELD_UP:
        field->kind = MESO_GROWTH_TOWARDS;
        field->vector[0] = (double)up.x;
        field->vector[1] = (double)up.y;
        field->vector[2] = (double)up.z;
        return MESO_OK;
    case MESO_FIELD_WORLD: field->kind = MESO_GROWTH_TOWARDS; return MESO_OK;
    case MESO_FIELD_POINT: field->kind = MESO_GROWTH_TO_POINT; return MESO_OK;
    case MESO_FIELD_GRADIENT:
        field->kind = MESO_GROWTH_UPHILL;
        field->map = values[0].index;
        return MESO_OK;
    case MESO_FIELD_ATTRIBUTE: return fill_given(s, field);
    case MESO_FIELD_PRINCIPAL: return fill_principal(s, field);
    case MESO_FIELD_RANDOM: field->kind = MESO_GROWTH_ANY; return MESO_OK;
    default: return meso_fail(&s->tool->error, MESO_ERR_INTERNAL, "a direction of no kind");
    }
}

/* ---- places ---- */

typedef struct PlaceRoom {
    MesoMeshPoint *points;
    uint8_t *breaks;
    uint32_t *begin;
} PlaceRoom;

static MesoStatus read_places(MesoGrowSources *s, MesoGrowPoints *files)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < s->grammar->seed_count && !status; i++) {
        const MesoGrammarSource *source = &s->grammar->seeds[i].places;
        bool curve = source->kind == MESO_SEEDS_CURVE;
        set_source(s, "seed", source);
        if (curve || source->kind == MESO_SEEDS_POINTS)
            status = meso_grow_points(s, source->values[0].text, curve, &files[i]);
    }
    return status;
}

static MesoStatus gather_places(MesoGrowSources *s, MesoGrowthPlaces *places)
{
    MesoTool *tool = s->tool;
    uint32_t seeds = s->grammar->seed_count, count = 0;
    MesoGrowPoints *files = MESO_NEW(&tool->arena, MesoGrowPoints, seeds, &tool->error);
    MesoStatus status = files ? read_places(s, files) : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < seeds && !status; i++)
        count += files[i].count;
    PlaceRoom room = {NULL, NULL, NULL};
    if (!status) {
        room.points = MESO_NEW(&tool->arena, MesoMeshPoint, count, &tool->error);
        room.breaks = MESO_NEW(&tool->arena, uint8_t, count, &tool->error);
        room.begin = MESO_NEW(&tool->arena, uint32_t, seeds + 1, &tool->error);
        status = room.points && room.breaks && room.begin ? MESO_OK : MESO_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < seeds && !status; i++) {
        for (uint32_t k = 0; k < files[i].count; k++) {
            room.points[room.begin[i] + k] = files[i].points[k];
            room.breaks[room.begin[i] + k] = files[i].breaks ? files[i].breaks[k] : 0;
        }
        room.begin[i + 1] = room.begin[i] + files[i].count;
    }
    *places = (MesoGrowthPlaces){count, room.points, room.breaks, room.begin};
    return status;
}

/* ---- all ---- */

MesoStatus meso_grow_contexts(MesoGrowthContexts *out, MesoGrowthPlaces *places, MesoTool *tool,
                              const MesoGrammar *grammar, const MesoPolygonMesh *polygons,
                              const MesoGrowthGround *ground, const char *grammar_folder)
{
    MesoGrowSources s = {.tool = tool, .grammar = grammar, .polygons = polygons, .ground = ground,
                         .folder = grammar_folder};
    MesoGrowthMap *maps = MESO_NEW(&tool->arena, MesoGrowthMap, grammar->map_count, &tool->error);
    MesoGrowthField *fields = MESO_NEW(&tool->arena, MesoGrowthField, grammar->field_count, &tool->error);
    MesoStatus status = maps && fields ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < grammar->map_count && !status; i++) {
        set_source(&s, "map", &grammar->maps[i]);
        status = fill_map(&s, &maps[i]);
    }
    for (uint32_t i = 0; i < grammar->field_count && !status; i++) {
        set_source(&s, "field", &grammar->fields[i]);
        status = fill_field(&s, &fields[i]);
    }
    if (!status)
        status = gather_places(&s, places);
    *out = (MesoGrowthContexts){ground, grammar->map_count, grammar->field_count, maps, fields, tool->seed};
    return status;
}
