#include "libcore/scene/parts.h"

#include <assert.h>
#include <string.h>

#include "libcore/scene/placed.h"
#include "libcore/scene/sweep.h"

/* ---- counting ---- */

static uint64_t body_triangle_count(const MesoBody *body)
{
    uint64_t count = body->face_count;
    for (uint32_t i = 0; body->face_width == 4 && i < body->face_count; i++)
        count += body->corners[4 * (size_t)i + 3] != MESO_NO_INDEX;
    return count;
}

static void count_sweeps(MesoSceneParts *parts)
{
    const MesoScene *scene = parts->scene;
    uint64_t *vertices = parts->vertex_begin, *faces = parts->face_begin;
    for (uint32_t k = 0, part = 0; k < scene->kind_count; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        for (uint32_t i = 0; i < kind->instance_count; i++, part++) {
            vertices[part + 1] = vertices[part] + meso_sweep_vertex_count(kind);
            faces[part + 1] = faces[part] + meso_sweep_face_count(kind);
        }
        parts->triangle_count += meso_sweep_triangle_count(kind) * kind->instance_count;
    }
}

static void count_placed(MesoSceneParts *parts, const uint64_t *triangles)
{
    const MesoScene *scene = parts->scene;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        uint32_t part = scene->sweep_count + i;
        const MesoBody *body = &scene->bodies[scene->placed[i].body];
        parts->vertex_begin[part + 1] = parts->vertex_begin[part] + body->vertex_count;
        parts->face_begin[part + 1] = parts->face_begin[part] + body->face_count;
        parts->triangle_count += triangles[scene->placed[i].body];
    }
}

MesoStatus meso_scene_parts_init(MesoSceneParts *parts, MesoArena *arena, const MesoScene *scene,
                                 MesoError *error)
{
    uint64_t part_count = (uint64_t)scene->sweep_count + scene->placed_count;
    if (part_count >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "a scene of over 2^32 parts");
    *parts = (MesoSceneParts){
        .scene = scene,
        .part_count = (uint32_t)part_count,
        .vertex_begin = MESO_NEW(arena, uint64_t, part_count + 1, error),
        .face_begin = MESO_NEW(arena, uint64_t, part_count + 1, error),
    };
    if (!parts->vertex_begin || !parts->face_begin)
        return MESO_ERR_MEMORY;
    MesoArenaMark mark = meso_arena_mark(arena);
    uint64_t *triangles = MESO_NEW(arena, uint64_t, scene->body_count, error);
    if (!triangles)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < scene->body_count; i++)
        triangles[i] = body_triangle_count(&scene->bodies[i]);
    count_sweeps(parts);
    count_placed(parts, triangles);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* ---- parts ---- */

static const MesoSweptKind *kind_of_part(const MesoScene *scene, uint32_t part)
{
    return &scene->kinds[meso_scene_kind(scene, part)];
}

MesoPart meso_scene_part(const MesoSceneParts *parts, uint32_t part)
{
    const MesoScene *scene = parts->scene;
    assert(part < parts->part_count);
    if (part < scene->sweep_count)
        return (MesoPart){scene->sweeps[part].ids, kind_of_part(scene, part)->start_material};
    const MesoPlacedBody *placed = &scene->placed[part - scene->sweep_count];
    return (MesoPart){placed->ids, placed->material};
}

void meso_scene_vertices(const MesoSceneParts *parts, uint32_t begin, uint32_t end, MesoMeshVertex *out)
{
    const MesoScene *scene = parts->scene;
    uint64_t first = parts->vertex_begin[begin];
    for (uint32_t part = begin; part < end; part++) {
        MesoMeshVertex *to = out + (parts->vertex_begin[part] - first);
        if (part < scene->sweep_count)
            meso_sweep_vertices(scene, kind_of_part(scene, part), &scene->sweeps[part], to);
        else
            meso_placed_vertices(scene, &scene->placed[part - scene->sweep_count], to);
    }
}

void meso_scene_colors(const MesoSceneParts *parts, uint32_t begin, uint32_t end, MesoMeshColor *out)
{
    const MesoScene *scene = parts->scene;
    for (uint32_t part = begin; part < end; part++) {
        uint64_t count = parts->vertex_begin[part + 1] - parts->vertex_begin[part];
        const MesoMeshColor *colors = part < scene->sweep_count ? NULL
            : scene->bodies[scene->placed[part - scene->sweep_count].body].colors;
        if (colors)
            memcpy(out, colors, count * sizeof *out);
        else
            memset(out, 0xff, count * sizeof *out);
        out += count;
    }
}

void meso_scene_faces(const MesoSceneParts *parts, uint32_t begin, uint32_t end, uint32_t base,
                      MesoMeshFace *out)
{
    const MesoScene *scene = parts->scene;
    uint64_t first_vertex = parts->vertex_begin[begin], first_face = parts->face_begin[begin];
    for (uint32_t part = begin; part < end; part++) {
        uint32_t part_base = base + (uint32_t)(parts->vertex_begin[part] - first_vertex);
        MesoMeshFace *to = out + (parts->face_begin[part] - first_face);
        if (part < scene->sweep_count)
            meso_sweep_faces(scene, kind_of_part(scene, part), &scene->sweeps[part], part_base, to);
        else
            meso_placed_faces(scene, &scene->placed[part - scene->sweep_count], part_base, to);
    }
}
