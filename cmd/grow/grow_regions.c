/* Regions: of the surface's own file, or of a decorated surface in another one. */
#include <string.h>

#include "cmd/common/scene_input.h"
#include "cmd/grow/grow_sources.h"
#include "libcore/base/nearest.h"
#include "libcore/growth/ground/growth_snap.h"

/* What tells parts of a surface apart by names, the first ones first. */
static const char *const kinds[] = {"region", "tag", "group", "object", "material"};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

/* A region is in itself, and in those that it is a part of: "left/petal.3" in "left" and "left/petal". */
static bool is_in(const char *part, const char *whole)
{
    size_t length = strlen(whole);
    return strncmp(part, whole, length) == 0 && (part[length] == 0 || part[length] == '/' || part[length] == '.');
}

static MesoStatus fail_with(const MesoGrowSources *s, const MesoNearest *nearest)
{
    const char *name = s->source->values[0].text, *file = s->source->values[1].text;
    const char *where = file ? file : "the surface";
    if (nearest->best)
        return meso_grow_source_fail(s, MESO_ERR_INPUT, "no face of %s is in a region '%s'; is '%s' meant?", where,
                                     name, nearest->best);
    return meso_grow_source_fail(s, MESO_ERR_INPUT, "no face of %s is in a region '%s'", where, name);
}

/* ---- of the surface ---- */

/* The name of a face, or NULL. */
static const char *name_of(const MesoAttribute *attribute, uint32_t face, char number[32])
{
    uint32_t entry = meso_attribute_entry(attribute, face);
    if (entry == MESO_NO_INDEX)
        return NULL;
    if (attribute->width == 0)
        return attribute->names[entry];
    snprintf(number, 32, "%.9g", meso_attribute_number(attribute, entry, 0));
    return number;
}

/* How many faces are in the region; the values of others stay. */
static uint32_t mark_faces(const MesoGrowSources *s, const MesoAttribute *attribute, MesoNearest *nearest,
                           float *values)
{
    const char *wanted = s->source->values[0].text;
    uint32_t count = 0;
    char number[32];
    for (uint32_t t = 0; t < s->ground->mesh->triangle_count; t++) {
        const char *name = name_of(attribute, s->ground->mesh->faces[t], number);
        if (name && is_in(name, wanted)) {
            values[t] = 1;
            count++;
        }
    }
    for (uint32_t e = 0; attribute->width == 0 && e < attribute->entry_count; e++)
        meso_nearest_try(nearest, attribute->names[e]);
    return count;
}

static MesoStatus mark_own(const MesoGrowSources *s, float *values)
{
    MesoNearest nearest = meso_nearest(s->source->values[0].text, strlen(s->source->values[0].text));
    for (uint32_t i = 0; i < KIND_COUNT; i++) {
        const MesoAttribute *attribute = meso_polygon_attribute_on(s->polygons, kinds[i], MESO_ON_FACES);
        if (attribute && mark_faces(s, attribute, &nearest, values) > 0)
            return MESO_OK;
    }
    return fail_with(s, &nearest);
}

/* ---- of another file ---- */

/* The faces of a scene's bodies as triangles, with the row of ids that each has. */
typedef struct Soup {
    MesoTriangulation mesh;     /* positions and corners alone */
    uint32_t *rows;             /* [triangle_count] */
} Soup;

static uint32_t body_triangles(const MesoBody *body, uint32_t *corners, uint32_t base)
{
    uint32_t count = 0;
    for (uint32_t f = 0; f < body->face_count; f++) {
        const uint32_t *c = &body->corners[(size_t)body->face_width * f];
        uint32_t parts = body->face_width == 4 && c[3] != MESO_NO_INDEX ? 2 : 1;
        for (uint32_t i = 0; i < parts && corners; i++) {
            uint32_t *out = &corners[3 * (size_t)(count + i)];
            out[0] = base + c[0];
            out[1] = base + c[1 + i];
            out[2] = base + c[2 + i];
        }
        count += parts;
    }
    return count;
}

static MesoStatus make_soup(Soup *soup, const MesoScene *scene, MesoArena *arena, MesoError *error)
{
    size_t vertices = 0, triangles = 0;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        vertices += scene->bodies[scene->placed[i].body].vertex_count;
        triangles += body_triangles(&scene->bodies[scene->placed[i].body], NULL, 0);
    }
    if (vertices > UINT32_MAX / 4 || triangles > UINT32_MAX / 4)
        return meso_fail(error, MESO_ERR_LIMIT, "more than 2^30 triangles with regions");
    soup->mesh.positions = MESO_NEW(arena, MesoVec3, vertices, error);
    soup->mesh.corners = MESO_NEW(arena, uint32_t, 3 * triangles, error);
    soup->rows = MESO_NEW(arena, uint32_t, triangles, error);
    if (!soup->mesh.positions || !soup->mesh.corners || !soup->rows)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const MesoPlacedBody *placed = &scene->placed[i];
        const MesoBody *body = &scene->bodies[placed->body];
        if (placed->place != MESO_PLACED_HERE)
            continue;
        uint32_t *corners = &soup->mesh.corners[3 * (size_t)soup->mesh.triangle_count];
        uint32_t count = body_triangles(body, corners, soup->mesh.vertex_count);
        memcpy(soup->mesh.positions + soup->mesh.vertex_count, body->positions, body->vertex_count * sizeof(MesoVec3));
        for (uint32_t t = 0; t < count; t++)
            soup->rows[soup->mesh.triangle_count + t] = placed->ids;
        soup->mesh.vertex_count += body->vertex_count;
        soup->mesh.triangle_count += count;
    }
    return MESO_OK;
}

/* By number: 1 for ids whose name is in the region; how many there are. */
static uint32_t choose_ids(const MesoIdChannel *channel, const char *wanted, MesoNearest *nearest, uint8_t *chosen)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < channel->count; i++) {
        char number[32];
        snprintf(number, sizeof number, "%u", i);
        const char *name = channel->names ? channel->names[i] : number;
        chosen[i] = is_in(name, wanted);
        count += chosen[i];
        if (channel->names)
            meso_nearest_try(nearest, name);
    }
    return count;
}

/* Where the middle of a triangle is nearest to a chosen part. */
static MesoStatus mark_nearest(const MesoGrowSources *s, const Soup *soup, const MesoScene *scene, uint32_t channel,
                               const uint8_t *chosen, MesoArena *scratch, float *values)
{
    static const double middle[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    MesoTool *tool = s->tool;
    uint32_t count = s->ground->mesh->triangle_count;
    MesoVec3 *middles = MESO_NEW(scratch, MesoVec3, count, &tool->error);
    MesoMeshPoint *nearest = MESO_NEW(scratch, MesoMeshPoint, count, &tool->error);
    if (!middles || !nearest)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < count; t++)
        middles[t] = meso_growth_position(s->ground, t, middle);
    MesoStatus status = meso_growth_snap(&soup->mesh, scratch, middles, count, nearest, tool->threads, &tool->error);
    for (uint32_t t = 0; t < count && !status; t++)
        values[t] = chosen[meso_scene_id(scene, soup->rows[nearest[t].triangle], channel)];
    return status;
}

static MesoStatus mark_by_scene(const MesoGrowSources *s, const MesoScene *scene, MesoArena *scratch, float *values)
{
    MesoTool *tool = s->tool;
    const char *wanted = s->source->values[0].text;
    MesoNearest nearest = meso_nearest(wanted, strlen(wanted));
    Soup soup = {.rows = NULL};
    MesoStatus status = make_soup(&soup, scene, scratch, &tool->error);
    if (status)
        return status;
    for (uint32_t k = 0; k < KIND_COUNT; k++)
        for (uint32_t c = 0; c < scene->channel_count; c++) {
            const MesoIdChannel *channel = &scene->channels[c];
            uint8_t *chosen = MESO_NEW(scratch, uint8_t, channel->count, &tool->error);
            if (!chosen)
                return MESO_ERR_MEMORY;
            if (strcmp(channel->name, kinds[k]) == 0 && choose_ids(channel, wanted, &nearest, chosen) > 0 &&
                soup.mesh.triangle_count > 0)
                return mark_nearest(s, &soup, scene, c, chosen, scratch, values);
        }
    return fail_with(s, &nearest);
}

static MesoStatus mark_by_file(const MesoGrowSources *s, const char *file, float *values)
{
    MesoTool *tool = s->tool;
    MesoSceneReading reading = {.thread_count = tool->threads};
    MesoScene scene;
    MesoInput input;
    MesoArena scratch;
    const char *path = meso_grow_source_path(s, file);
    MesoStatus status = path ? meso_tool_read_scene(tool, &scene, &input, path, &reading) : MESO_ERR_MEMORY;
    if (status)
        return status;
    meso_arena_init(&scratch);
    status = mark_by_scene(s, &scene, &scratch, values);
    meso_arena_release(&scratch);
    meso_input_close(&input);
    return status;
}

MesoStatus meso_grow_map_region(MesoGrowSources *s, MesoGrowthMap *map)
{
    const char *file = s->source->values[1].text;
    float *values = MESO_NEW(&s->tool->arena, float, s->ground->mesh->triangle_count, &s->tool->error);
    if (!values)
        return MESO_ERR_MEMORY;
    map->domain = MESO_GROWTH_BY_TRIANGLE;
    map->values = values;
    return file ? mark_by_file(s, file, values) : mark_own(s, values);
}
