#include "libcore/quilt/swatch/swatch_maker.h"

#include <math.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/edit/face_area.h"

/* ---- growing ---- */

/* One more of what there are `count` of: false, with the maker's status, where they could not be counted. */
static bool has_room(MesoSwatchMaker *maker, uint32_t count)
{
    if (count >= MESO_NO_INDEX - 1 && !maker->status)
        maker->status = meso_fail(maker->error, MESO_ERR_LIMIT, "a swatch of %u columns and %u rows is too large",
                                  maker->recipe.columns, maker->recipe.rows);
    return !maker->status;
}

uint32_t meso_maker_vertex(MesoSwatchMaker *maker, double x, double y, double z)
{
    if (!has_room(maker, maker->vertex_count))
        return 0;
    maker->positions = MESO_GROW(maker->scratch, maker->positions, maker->vertex_count, maker->vertex_room, 1024,
                                 maker->error);
    if (!maker->positions) {
        maker->status = MESO_ERR_MEMORY;
        return 0;
    }
    maker->positions[maker->vertex_count] = (MesoVec3){(float)x, (float)y, (float)z};
    return maker->vertex_count++;
}

static void add_corner(MesoSwatchMaker *maker, uint32_t vertex, MesoVec2 uv)
{
    size_t room = maker->corner_room;
    if (!has_room(maker, maker->corner_count))
        return;
    maker->uvs = MESO_GROW(maker->scratch, maker->uvs, maker->corner_count, room, 4096, maker->error);
    maker->corners = MESO_GROW(maker->scratch, maker->corners, maker->corner_count, maker->corner_room, 4096,
                               maker->error);
    if (!maker->uvs || !maker->corners) {
        maker->status = MESO_ERR_MEMORY;
        return;
    }
    maker->uvs[maker->corner_count] = uv;
    maker->corners[maker->corner_count++] = vertex;
}

void meso_maker_face(MesoSwatchMaker *maker, const uint32_t v[4], const MesoVec2 uv[4], uint32_t material)
{
    for (int k = 0; k < 4 && !maker->status; k++)
        if (k < 3 || v[3] != MESO_NO_INDEX)
            add_corner(maker, v[k], uv[k]);
    if (maker->status)
        return;
    size_t room = maker->face_room;
    maker->face_end = MESO_GROW(maker->scratch, maker->face_end, maker->face_count, room, 1024, maker->error);
    maker->material_of = MESO_GROW(maker->scratch, maker->material_of, maker->face_count, maker->face_room, 1024,
                                   maker->error);
    if (!maker->face_end || !maker->material_of) {
        maker->status = MESO_ERR_MEMORY;
        return;
    }
    maker->material_of[maker->face_count] = material;
    maker->face_end[maker->face_count++] = maker->corner_count;
}

void meso_maker_tube(MesoSwatchMaker *maker, uint32_t first, uint32_t rings, uint32_t sides, bool closed,
                     uint32_t material)
{
    uint32_t bands = closed ? rings : rings - 1;
    for (uint32_t r = 0; r < bands; r++)
        for (uint32_t s = 0; s < sides; s++) {
            uint32_t a = first + r * sides, b = first + (r + 1) % rings * sides, t = (s + 1) % sides;
            float u0 = (float)s / (float)sides, u1 = (float)(s + 1) / (float)sides;
            float v0 = (float)r / (float)bands, v1 = (float)(r + 1) / (float)bands;
            uint32_t v[4] = {a + s, a + t, b + t, b + s};
            MesoVec2 uv[4] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
            meso_maker_face(maker, v, uv, material);
        }
}

void meso_maker_fan(MesoSwatchMaker *maker, uint32_t ring, uint32_t sides, uint32_t tip, bool ahead, uint32_t material)
{
    for (uint32_t s = 0; s < sides; s++) {
        uint32_t a = ring + s, b = ring + (s + 1) % sides;
        float u0 = (float)s / (float)sides, u1 = (float)(s + 1) / (float)sides, v = ahead ? 1 : 0;
        uint32_t corners[4] = {ahead ? a : b, ahead ? b : a, tip, MESO_NO_INDEX};
        MesoVec2 uv[4] = {{ahead ? u0 : u1, v}, {ahead ? u1 : u0, v}, {(u0 + u1) / 2, v}, {0, 0}};
        meso_maker_face(maker, corners, uv, material);
    }
}

double meso_maker_jitter(MesoSwatchMaker *maker)
{
    double unit = (double)(meso_random_next(&maker->random) >> 11) * 0x1p-53;
    return (2 * unit - 1) * (double)maker->recipe.jitter;
}

double meso_maker_stray(MesoSwatchMaker *maker, double most)
{
    return fmax(-most, fmin(most, meso_maker_jitter(maker)));
}

/* ---- the mesh ---- */

/* Sums of the area vectors of the faces around. */
static float *make_normals(const MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error)
{
    MesoVec3 *normals = MESO_NEW(arena, MesoVec3, mesh->vertex_count, error);
    for (uint32_t f = 0; normals && f < mesh->face_count; f++) {
        MesoAreaVector area = meso_face_area(mesh, f);
        for (uint32_t c = mesh->face_begin[f]; c < mesh->face_begin[f + 1]; c++) {
            MesoVec3 *sum = &normals[mesh->corners[c]];
            *sum = meso_vec3_add(*sum, (MesoVec3){(float)area.x, (float)area.y, (float)area.z});
        }
    }
    for (uint32_t v = 0; normals && v < mesh->vertex_count; v++)
        normals[v] = meso_vec3_unit(normals[v], (MesoVec3){0, 0, 1});
    return (float *)normals;
}

static MesoStatus add_looks(MesoPolygonMesh *mesh, MesoArena *arena, const MesoSwatchMaker *maker, MesoError *error)
{
    uint32_t count = maker->material_count;
    const char **names = MESO_NEW(arena, const char *, count, error);
    float *albedo = MESO_NEW(arena, float, 3 * (size_t)count, error), *rough = MESO_NEW(arena, float, count, error);
    float *metal = MESO_NEW(arena, float, count, error);
    uint32_t *of = MESO_NEW(arena, uint32_t, mesh->face_count, error);
    if (!names || !albedo || !rough || !metal || !of)
        return MESO_ERR_MEMORY;
    memcpy(of, maker->material_of, mesh->face_count * sizeof *of);
    for (uint32_t m = 0; m < count; m++) {
        const MesoMaterial *look = &maker->materials[m].look;
        names[m] = maker->materials[m].name;
        memcpy(albedo + 3 * m, look->albedo, sizeof look->albedo);
        rough[m] = look->roughness;
        metal[m] = look->metallic;
    }
    MesoAttribute made[4] = {
        {.name = "material", .names = names}, {.name = "albedo", .width = 3, .values = albedo},
        {.name = "roughness", .width = 1, .values = rough}, {.name = "metallic", .width = 1, .values = metal}};
    for (int i = 0; i < 4; i++) {
        made[i].domain = MESO_ON_FACES;
        made[i].scalar = MESO_SCALAR_FLOAT;
        made[i].entry_count = count;
        made[i].entry_of = of;
        mesh->attributes[mesh->attribute_count++] = made[i];
    }
    return MESO_OK;
}

MesoStatus meso_maker_finish(MesoPolygonMesh *mesh, MesoArena *arena, const MesoSwatchMaker *maker, MesoError *error)
{
    *mesh = (MesoPolygonMesh){.vertex_count = maker->vertex_count, .face_count = maker->face_count,
                              .corner_count = maker->corner_count};
    mesh->positions = MESO_NEW(arena, MesoVec3, mesh->vertex_count, error);
    mesh->face_begin = MESO_NEW(arena, uint32_t, (size_t)mesh->face_count + 1, error);
    mesh->corners = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    mesh->attributes = MESO_NEW(arena, MesoAttribute, 6, error);
    MesoVec2 *uvs = MESO_NEW(arena, MesoVec2, mesh->corner_count, error);
    if (!mesh->positions || !mesh->face_begin || !mesh->corners || !mesh->attributes || !uvs)
        return MESO_ERR_MEMORY;
    memcpy(mesh->positions, maker->positions, mesh->vertex_count * sizeof *mesh->positions);
    memcpy(mesh->face_begin + 1, maker->face_end, mesh->face_count * sizeof *mesh->face_begin);
    memcpy(mesh->corners, maker->corners, mesh->corner_count * sizeof *mesh->corners);
    memcpy(uvs, maker->uvs, mesh->corner_count * sizeof *uvs);
    float *normals = make_normals(mesh, arena, error);
    if (!normals)
        return MESO_ERR_MEMORY;
    mesh->attributes[mesh->attribute_count++] =
        (MesoAttribute){.name = "normal", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_FLOAT, .width = 3,
                        .entry_count = mesh->vertex_count, .values = normals};
    mesh->attributes[mesh->attribute_count++] =
        (MesoAttribute){.name = "uv", .domain = MESO_ON_CORNERS, .scalar = MESO_SCALAR_FLOAT, .width = 2,
                        .entry_count = mesh->corner_count, .values = uvs};
    return add_looks(mesh, arena, maker, error);
}
