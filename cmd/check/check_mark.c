#include "cmd/check/check_mark.h"

#include <string.h>

#include "formats/scene/mesh_file.h"

enum { KINDS = MESO_FAULT_COUNT + 1 };  /* the last: sound */

/* Linear colours that tell neighbours apart: around the circle of hues by the golden angle. */
static MesoMaterial material_of(uint32_t kind)
{
    MesoMaterial material = {{0.6f, 0.6f, 0.6f}, 0.7f, 0};
    if (kind == MESO_FAULT_COUNT)
        return material;
    for (uint32_t c = 0; c < 3; c++) {
        float hue = fmodf((float)kind * 0.618034f + (float)c / 3, 1);
        material.albedo[c] = 0.05f + 0.95f * fminf(fmaxf(2 - fabsf(6 * hue - 3), 0), 1);
    }
    return material;
}

/* The first fault of a triangle; KINDS where it cannot be shown. A leak is known by its open edges. */
static uint32_t kind_of(const MesoCheckFindings *findings, uint32_t t)
{
    const MesoInspectedMesh *mesh = &findings->input->mesh;
    uint32_t marks = findings->inspection->marks[t] & ~(1u << MESO_FAULT_LEAK), kind = 0;
    if (!meso_vec3_finite(meso_inspected_middle(mesh, t)))
        return KINDS;
    while (kind < MESO_FAULT_COUNT && !(marks >> kind & 1))
        kind++;
    return kind;
}

typedef struct Marking {
    const MesoCheckFindings *findings;
    MesoScene scene;
    MesoVec3 *positions, *normals;
    MesoMeshColor *colors;
    uint32_t *corners;
    uint64_t vertex, corner;
} Marking;

static MesoVec3 normal_at(const MesoInspectedMesh *mesh, size_t half, MesoVec3 flat)
{
    uint32_t number = !mesh->normals ? MESO_NO_INDEX : mesh->normal_of ? mesh->normal_of[half] : mesh->corners[half];
    return number == MESO_NO_INDEX ? flat : meso_vec3_direction(mesh->normals[number], flat);
}

/* Triangles by themselves, so that each has its own colour and normals. */
static void put_triangle(Marking *marking, uint32_t t, MesoMeshColor color)
{
    const MesoInspectedMesh *mesh = &marking->findings->input->mesh;
    MesoVec3 p[3], up = {0, 0, 1};
    for (uint32_t k = 0; k < 3; k++)
        p[k] = mesh->positions[mesh->corners[3 * (size_t)t + k]];
    MesoVec3 flat = meso_vec3_direction(meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0])), up);
    for (uint32_t k = 0; k < 3; k++) {
        marking->positions[marking->vertex] = p[k];
        marking->normals[marking->vertex] = normal_at(mesh, 3 * (size_t)t + k, flat);
        marking->colors[marking->vertex++] = color;
    }
}

static MesoMeshColor color_of(const MesoMaterial *material)
{
    return (MesoMeshColor){(uint8_t)(255 * material->albedo[0]), (uint8_t)(255 * material->albedo[1]),
                           (uint8_t)(255 * material->albedo[2])};
}

/* One body for all triangles of a kind, white under their colours. */
static void put_kind(Marking *marking, uint32_t kind)
{
    MesoScene *scene = &marking->scene;
    uint64_t first = marking->vertex, corner = marking->corner;
    const MesoMaterial look = material_of(kind);
    for (uint32_t t = 0; t < marking->findings->input->mesh.triangle_count; t++)
        if (kind_of(marking->findings, t) == kind)
            put_triangle(marking, t, color_of(&look));
    uint32_t count = (uint32_t)(marking->vertex - first);
    if (count == 0)
        return;
    for (uint32_t i = 0; i < count; i++)
        marking->corners[marking->corner++] = i;
    scene->bodies[scene->body_count] = (MesoBody){
        .vertex_count = count, .face_count = count / 3, .face_width = 3, .positions = marking->positions + first,
        .normals = marking->normals + first, .colors = marking->colors + first, .corners = marking->corners + corner};
    scene->placed[scene->body_count] = (MesoPlacedBody){.body = scene->body_count, .material = kind, .ids = kind};
    scene->placed_count = ++scene->body_count;
}

static MesoStatus allocate(Marking *marking, MesoArena *arena, MesoError *error)
{
    MesoScene *scene = &marking->scene;
    size_t count = 3 * (size_t)marking->findings->input->mesh.triangle_count;
    marking->positions = MESO_NEW(arena, MesoVec3, count, error);
    marking->normals = MESO_NEW(arena, MesoVec3, count, error);
    marking->colors = MESO_NEW(arena, MesoMeshColor, count, error);
    marking->corners = MESO_NEW(arena, uint32_t, count, error);
    scene->materials = MESO_NEW(arena, MesoMaterial, KINDS, error);
    scene->material_names = MESO_NEW(arena, const char *, KINDS, error);
    scene->ids = MESO_NEW(arena, uint32_t, KINDS, error);
    scene->bodies = MESO_NEW(arena, MesoBody, KINDS, error);
    scene->placed = MESO_NEW(arena, MesoPlacedBody, KINDS, error);
    return marking->positions && marking->normals && marking->colors && marking->corners && scene->materials &&
           scene->material_names && scene->ids && scene->bodies && scene->placed ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_check_mark(const MesoCheckFindings *findings, MesoTool *tool, MesoOutput *output)
{
    MesoSceneParts parts;
    Marking marking = {.findings = findings};
    MesoScene *scene = &marking.scene;
    MesoStatus status = allocate(&marking, &tool->arena, &tool->error);
    if (status)
        return status;
    for (uint32_t kind = 0; kind < KINDS; kind++) {
        scene->material_names[kind] = kind < MESO_FAULT_COUNT ? MESO_FAULT_NAMES[kind] : "sound";
        scene->materials[kind] = (MesoMaterial){{1, 1, 1}, 0.7f, 0};
        scene->ids[kind] = kind;
        put_kind(&marking, kind);
    }
    scene->material_count = scene->id_row_count = KINDS;
    scene->channel_count = 1;
    scene->channels[0] = (MesoIdChannel){"fault", KINDS, scene->material_names};
    meso_scene_measure(scene);
    status = meso_scene_parts_init(&parts, &tool->arena, scene, &tool->error);
    const MesoMeshWriteOptions options = {.thread_count = tool->threads, .provenance = &tool->provenance};
    return status ? status : meso_ply_write(&parts, &options, output, &tool->error);
}
