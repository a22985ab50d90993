#include "cmd/grow/grow_shapes.h"

#include <math.h>
#include <string.h>

#include "formats/scene/material_text.h"
#include "cmd/grow/grow_section.h"
#include "formats/mesh/mesh_read.h"
#include "formats/model/scene_of_mesh.h"
#include "formats/tiling/tiles/tiles_file.h"

/* Numbers of a source's values, as the language's tables have them. */
enum { FILE_VALUE = 0, ALONG_VALUE = 1, MESH_MATERIAL = 2, SECTION_NAME = 1, SECTION_MATERIAL = 2,
       BUILTIN_MATERIAL = 0, BUILTIN_DETAIL = 1, TUBE_SIDES = 2 };

typedef struct Maker {
    MesoTool *tool;
    const char *folder;
    uint32_t detail;            /* of built-in shapes; MESO_NO_INDEX: their own */
    MesoTerminalShape *shapes;
    MesoMaterial *materials;
    const char **material_names;
    uint32_t *material_of;
    uint32_t material_count;
} Maker;

const char *meso_grow_path(const char *folder, const char *name, MesoArena *arena, MesoError *error)
{
    return *name == '/' || !*folder ? name : meso_arena_print(arena, error, "%s/%s", folder, name);
}

/* ---- materials ---- */

/* As shapes look that say nothing. */
static const MesoMaterial LOOKS[MESO_BUILTIN_SHAPES] = {
    {{0.16f, 0.34f, 0.07f}, 0.55f, 0}, {{0.32f, 0.36f, 0.33f}, 0.35f, 0}, {{0.82f, 0.74f, 0.60f}, 0.25f, 0},
    {{0.58f, 0.57f, 0.55f}, 0.30f, 1}, {{0.30f, 0.19f, 0.10f}, 0.70f, 0},
};
static const MesoMaterial PLAIN = {{0.6f, 0.6f, 0.6f}, 0.5f, 0};

/* Materials of one name are one. */
static MesoStatus add_material(Maker *m, uint32_t shape, const char *text, MesoMaterial look, const char *otherwise)
{
    char name[MESO_MATERIAL_NAME];
    MesoError *error = &m->tool->error;
    snprintf(name, sizeof name, "%s", otherwise);
    MesoStatus status = text && *text ? meso_material_of_text(&look, name, text, error) : MESO_OK;
    if (status)
        return status;
    uint32_t at = 0;
    while (at < m->material_count && strcmp(m->material_names[at], name) != 0)
        at++;
    m->material_of[shape] = at;
    if (at < m->material_count)
        return MESO_OK;
    m->materials[at] = look;
    m->material_names[at] = meso_arena_copy_text(&m->tool->arena, name, error);
    m->material_count++;
    return m->material_names[at] ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- meshes ---- */

static uint8_t shade(float albedo, uint8_t own)
{
    return (uint8_t)lrintf(fminf(fmaxf(albedo, 0), 1) * (float)own);
}

/* All bodies of a mesh as one; what their materials differ in becomes colours. */
static MesoStatus merge(MesoBody *out, Maker *m, const MesoScene *scene)
{
    MesoArena *arena = &m->tool->arena;
    MesoError *error = &m->tool->error;
    size_t vertices = 0, corners = 0;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        vertices += scene->bodies[scene->placed[i].body].vertex_count;
        corners += 4 * (size_t)scene->bodies[scene->placed[i].body].face_count;
    }
    MesoVec3 *positions = MESO_NEW(arena, MesoVec3, vertices, error);
    MesoVec3 *normals = MESO_NEW(arena, MesoVec3, vertices, error);
    MesoVec2 *uvs = MESO_NEW(arena, MesoVec2, vertices, error);
    MesoMeshColor *colors = MESO_NEW(arena, MesoMeshColor, vertices, error);
    uint32_t *all = MESO_NEW(arena, uint32_t, corners, error);
    *out = (MesoBody){.face_width = 4, .positions = positions, .normals = normals, .uvs = uvs, .colors = colors,
                      .corners = all};
    if (!positions || !normals || !uvs || !colors || !all)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const MesoBody *body = &scene->bodies[scene->placed[i].body];
        const MesoMaterial *look = &scene->materials[scene->placed[i].material];
        uint32_t begin = out->vertex_count;
        for (uint32_t v = 0; v < body->vertex_count; v++) {
            MesoMeshColor own = body->colors ? body->colors[v] : (MesoMeshColor){255, 255, 255};
            positions[begin + v] = body->positions[v];
            normals[begin + v] = body->normals[v];
            uvs[begin + v] = body->uvs ? body->uvs[v] : (MesoVec2){0, 0};
            colors[begin + v] = (MesoMeshColor){shade(look->albedo[0], own.r), shade(look->albedo[1], own.g),
                                                shade(look->albedo[2], own.b)};
        }
        for (uint32_t f = 0; f < body->face_count; f++) {
            const uint32_t *from = body->corners + (size_t)body->face_width * f;
            uint32_t *to = all + 4 * ((size_t)out->face_count + f);
            for (uint32_t k = 0; k < 4; k++)
                to[k] = k < body->face_width && from[k] != MESO_NO_INDEX ? begin + from[k] : MESO_NO_INDEX;
        }
        out->vertex_count += body->vertex_count;
        out->face_count += body->face_count;
    }
    return MESO_OK;
}

static MesoStatus make_mesh(Maker *m, uint32_t shape, const MesoGrammarSource *source)
{
    MesoTool *tool = m->tool;
    MesoInput input;
    MesoPolygonMesh mesh;
    MesoScene scene = {0};
    MesoBody body;
    const char *path = meso_grow_path(m->folder, source->values[FILE_VALUE].text, &tool->arena, &tool->error);
    MesoStatus status = path ? meso_tool_open_input(tool, &input, path, "shape") : MESO_ERR_MEMORY;
    if (status)
        return status;
    status = meso_polygon_mesh_read(&mesh, &tool->arena, &input, tool->threads, &tool->error);
    if (!status)
        status = meso_scene_of_mesh(&scene, &tool->arena, &mesh, &tool->error);
    if (!status)
        status = merge(&body, m, &scene);
    meso_input_close(&input);
    MesoShapeAxis axis = source->values[ALONG_VALUE].index == 0 ? MESO_SHAPE_ALONG_Z : MESO_SHAPE_ALONG_X;
    if (!status)
        status = meso_terminal_shape_build(&m->shapes[shape], &tool->arena, &body, axis, &tool->error);
    MesoMaterial look = scene.placed_count ? scene.materials[scene.placed[0].material] : PLAIN;
    for (uint32_t c = 0; c < 3; c++)
        look.albedo[c] = 1;
    return status ? status : add_material(m, shape, source->values[MESH_MATERIAL].text, look, source->name);
}

/* ---- the others ---- */

static MesoStatus make_section(Maker *m, uint32_t shape, const MesoGrammarSource *source)
{
    MesoTool *tool = m->tool;
    MesoInput input;
    MesoTileSet set;
    uint32_t section = 0;
    const char *path = meso_grow_path(m->folder, source->values[FILE_VALUE].text, &tool->arena, &tool->error);
    MesoStatus status = path ? meso_tool_open_input(tool, &input, path, "shape") : MESO_ERR_MEMORY;
    if (status)
        return status;
    status = meso_tiles_read(&set, &tool->arena, &input, &tool->error);
    if (!status) {
        status = meso_grow_section(&m->shapes[shape], &section, &tool->arena, &set, source->values[SECTION_NAME].text,
                                   &tool->error);
        if (status == MESO_ERR_INPUT)
            meso_fail_prefix(&tool->error, path);
    }
    meso_input_close(&input);
    return status ? status : add_material(m, shape, source->values[SECTION_MATERIAL].text,
                                          set.sections[section].material, set.sections[section].name);
}

static uint32_t whole(double number, uint32_t most)
{
    return number > 0 ? (uint32_t)fmin(number, most) : 0;
}

static MesoStatus make_builtin(Maker *m, uint32_t shape, const MesoGrammarSource *source)
{
    MesoBuiltinShape kind = (MesoBuiltinShape)(source->kind - MESO_SHAPE_LEAF);
    uint32_t own = whole(source->values[BUILTIN_DETAIL].number, MESO_SHAPE_DETAIL_MAX);
    uint32_t detail = m->detail == MESO_NO_INDEX ? own : m->detail;
    MesoArena *arena = &m->tool->arena;
    MesoError *error = &m->tool->error;
    MesoStatus status = kind == MESO_BUILTIN_TUBE
        ? meso_tube_shape(&m->shapes[shape], arena, whole(source->values[TUBE_SIDES].number, MESO_SHAPE_SIDES_MAX),
                          detail, error)
        : meso_builtin_shape(&m->shapes[shape], arena, kind, detail, error);
    return status ? status : add_material(m, shape, source->values[BUILTIN_MATERIAL].text, LOOKS[kind],
                                          source->name ? source->name : meso_builtin_shape_names[kind]);
}

static MesoStatus make_shape(Maker *m, uint32_t shape, const MesoGrammarSource *source)
{
    MesoStatus status = source->kind == MESO_SHAPE_MESH ? make_mesh(m, shape, source)
        : source->kind == MESO_SHAPE_SECTION ? make_section(m, shape, source) : make_builtin(m, shape, source);
    if (status != MESO_ERR_INPUT || !source->name)
        return status;
    char place[96];
    snprintf(place, sizeof place, "shape '%.64s'", source->name);
    return meso_fail_prefix(&m->tool->error, place);
}

MesoStatus meso_grow_shapes(MesoGrowthShapes *shapes, MesoTool *tool, const MesoGrammar *grammar, const char *folder,
                            uint32_t detail)
{
    MesoArena *arena = &tool->arena;
    MesoError *error = &tool->error;
    uint32_t count = grammar->shape_count;
    const char **names = MESO_NEW(arena, const char *, count + 1, error);
    Maker m = {.tool = tool, .folder = folder, .detail = detail, .shapes = MESO_NEW(arena, MesoTerminalShape, count + 1, error),
               .materials = MESO_NEW(arena, MesoMaterial, count + 1, error),
               .material_names = MESO_NEW(arena, const char *, count + 1, error),
               .material_of = MESO_NEW(arena, uint32_t, count + 1, error)};
    if (!names || !m.shapes || !m.materials || !m.material_names || !m.material_of)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++) {
        names[i] = grammar->shapes[i].name ? grammar->shapes[i].name : "shape";
        status = make_shape(&m, i, &grammar->shapes[i]);
    }
    *shapes = (MesoGrowthShapes){.count = count, .shapes = m.shapes, .names = names, .material_count = m.material_count,
                                 .materials = m.materials, .material_names = m.material_names,
                                 .material_of = m.material_of};
    return status;
}
