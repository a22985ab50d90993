#include "cmd/replicate/replicate_carve.h"

#include <string.h>

#include "formats/image/image_read.h"
#include "formats/scene/material_json.h"
#include "formats/scene/material_text.h"

/* ---- beginning ---- */

static MesoStatus read_picture(MesoCarvedKind *out, MesoReplicateFiles *files, const char *name)
{
    MesoTool *tool = files->tool;
    MesoPicture picture;
    const MesoInput *input = meso_replicate_file(files, name, "image");
    MesoStatus status = input ? meso_image_read(&picture, &tool->arena, input, &tool->error) : tool->error.status;
    if (status)
        return status;
    for (size_t i = 0; i < (size_t)picture.width * picture.height; i++)
        if (!(fabsf(picture.values[i]) <= 1e6f))
            return meso_fail(&tool->error, MESO_ERR_INPUT, "%s: no height in column %zu of row %zu", input->path,
                             i % picture.width + 1, i / picture.width + 1);
    out->width = picture.width;
    out->rows = picture.height;
    out->pixels = picture.values;
    return MESO_OK;
}

static MesoStatus take_kind(MesoReplicateCarve *c, MesoReplicateFiles *files, const MesoDetailsFile *details,
                            uint32_t number)
{
    static const MesoBumpForm forms[] = {MESO_BUMP_AS_GAUSS, MESO_BUMP_AS_RING, MESO_BUMP_AS_PICTURE};
    const MesoDetailKind *kind = &details->kinds[number];
    MesoCarvedKind *carving = &c->carvings[number];
    if (kind->geometry == MESO_DETAIL_HOLE)
        carving->carving = MESO_CARVE_HOLE;
    if (kind->geometry != MESO_DETAIL_BUMP)
        return MESO_OK;
    *carving = (MesoCarvedKind){.carving = MESO_CARVE_BUMP, .form = forms[kind->profile], .height = kind->height};
    if (kind->own_material) {
        c->looks[number] = details->materials[kind->material];
        c->look_names[number] = details->material_names[kind->material];
    }
    return kind->profile == MESO_BUMP_IMAGE ? read_picture(carving, files, kind->file) : MESO_OK;
}

MesoStatus meso_replicate_carve_begin(MesoReplicateCarve *c, const MesoReplicateKinds *kinds,
                                      MesoReplicateFiles *files, const MesoDetailsFile *details,
                                      const MesoTriangulation *rest, uint32_t fineness)
{
    MesoTool *tool = files->tool;
    *c = (MesoReplicateCarve){.fineness = 1 / (float)fineness};
    if (!kinds->carved)
        return MESO_OK;
    c->kinds = kinds;
    c->carvings = MESO_NEW(&tool->arena, MesoCarvedKind, kinds->kind_count, &tool->error);
    c->looks = MESO_NEW(&tool->arena, MesoMaterial, kinds->kind_count, &tool->error);
    c->look_names = MESO_NEW(&tool->arena, const char *, kinds->kind_count, &tool->error);
    MesoStatus status = c->carvings && c->looks && c->look_names ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < kinds->kind_count && !status; i++)
        status = take_kind(c, files, details, i);
    return status ? status : meso_carved_init(&c->mesh, rest, &tool->error);
}

void meso_replicate_carve_end(MesoReplicateCarve *c)
{
    meso_carved_release(&c->mesh);
}

/* ---- a frame ---- */

static MesoStatus make_room(MesoReplicateCarve *c, MesoTool *tool)
{
    if (c->mesh.vertex_count > c->vertex_room) {
        c->vertex_room = c->mesh.vertex_count + c->mesh.vertex_count / 4;
        c->positions = MESO_NEW(&tool->arena, MesoVec3, c->vertex_room, &tool->error);
        c->normals = MESO_NEW(&tool->arena, MesoVec3, c->vertex_room, &tool->error);
        c->under = MESO_NEW(&tool->arena, uint32_t, c->vertex_room, &tool->error);
    }
    if (c->mesh.triangle_count > c->triangle_room) {
        c->triangle_room = c->mesh.triangle_count + c->mesh.triangle_count / 4;
        c->corners = MESO_NEW(&tool->arena, uint32_t, 3 * (size_t)c->triangle_room, &tool->error);
        c->roots = MESO_NEW(&tool->arena, uint32_t, c->triangle_room, &tool->error);
    }
    return c->positions && c->normals && c->corners && c->roots && c->under ? MESO_OK : MESO_ERR_MEMORY;
}

static void take_triangles(MesoReplicateCarve *c)
{
    c->triangle_count = 0;
    for (uint32_t t = 0; t < c->mesh.triangle_count; t++) {
        const MesoCarvedTriangle *triangle = &c->mesh.triangles[t];
        if (triangle->hole != MESO_NO_INDEX)
            continue;
        memcpy(c->corners + 3 * (size_t)c->triangle_count, triangle->corners, sizeof triangle->corners);
        c->roots[c->triangle_count++] = triangle->root;
    }
}

static void find_normals(MesoReplicateCarve *c)
{
    memset(c->normals, 0, c->mesh.vertex_count * sizeof *c->normals);
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        const uint32_t *v = c->corners + 3 * (size_t)t;
        MesoVec3 a = meso_vec3_sub(c->positions[v[1]], c->positions[v[0]]);
        MesoVec3 area = meso_vec3_cross(a, meso_vec3_sub(c->positions[v[2]], c->positions[v[0]]));
        for (uint32_t k = 0; k < 3; k++)
            c->normals[v[k]] = meso_vec3_add(c->normals[v[k]], area);
    }
    for (uint32_t v = 0; v < c->mesh.vertex_count; v++)
        c->normals[v] = meso_vec3_direction(c->normals[v], (MesoVec3){0, 0, 1});
}

MesoStatus meso_replicate_carve_details(MesoReplicateCarve *c, const MesoReplicateRun *r)
{
    MesoTool *tool = r->tool;
    MesoStatus status = MESO_OK;
    uint32_t before = c->mesh.carved_count;
    if (!c->kinds)
        return MESO_OK;
    for (uint32_t i = before; i < r->count && !status; i++)
        status = meso_carve(&c->mesh, &r->details[i], c->carvings[r->details[i].kind].carving, c->fineness,
                            &tool->error);
    if (!status)
        status = make_room(c, tool);
    if (!status && before < r->count)
        take_triangles(c);
    return status;
}

MesoStatus meso_replicate_carve_frame(MesoReplicateCarve *c, const MesoReplicateRun *r,
                                      const MesoPlacedDetail *placed)
{
    MesoTool *tool = r->tool;
    MesoStatus status = meso_replicate_carve_details(c, r);
    if (status || !c->kinds)
        return status;
    const MesoCarvedFrame frame = {c->carvings, r->details, placed, r->count, r->clip->positions, r->clip->normals,
                                   tool->threads};
    status = meso_carved_place(c->positions, c->under, &c->mesh, &frame, &tool->error);
    find_normals(c);
    return status;
}

/* ---- a mesh ---- */

typedef struct Dressing {
    const MesoReplicateCarve *carve;
    const MesoReplicateRun *run;
    MesoArena *arena;
    MesoError *error;
    MesoPolygonMesh *mesh;
} Dressing;

static MesoAttribute *add_attribute(const Dressing *d, const char *name, MesoAttributeDomain domain, uint32_t width,
                                    uint32_t count)
{
    MesoAttribute *attribute = &d->mesh->attributes[d->mesh->attribute_count];
    *attribute = (MesoAttribute){.name = name, .domain = domain, .scalar = MESO_SCALAR_FLOAT, .width = width,
                                 .entry_count = count};
    if (width > 0)
        attribute->values = MESO_NEW(d->arena, float, (size_t)width * count, d->error);
    else
        attribute->names = MESO_NEW(d->arena, const char *, count, d->error);
    if (!attribute->values && !attribute->names)
        return NULL;
    d->mesh->attribute_count++;
    return attribute;
}

/* Those of faces are their roots'. */
static MesoStatus keep_faces(const Dressing *d, const MesoAttribute *from)
{
    MesoAttribute *to = &d->mesh->attributes[d->mesh->attribute_count++];
    *to = *from;
    to->entry_of = MESO_NEW(d->arena, uint32_t, d->mesh->face_count, d->error);
    for (uint32_t f = 0; to->entry_of && f < d->mesh->face_count; f++)
        to->entry_of[f] = meso_attribute_entry(from, d->run->clip->rest.faces[d->carve->roots[f]]);
    return to->entry_of ? MESO_OK : MESO_ERR_MEMORY;
}

/* The entries of a root's three corners. */
static void root_entries(const Dressing *d, const MesoAttribute *from, uint32_t root, uint32_t entries[3])
{
    const MesoReplicateClip *clip = d->run->clip;
    uint32_t first = 3 * clip->rest.faces[root];
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t vertex = clip->rest.origins[clip->rest.corners[3 * root + k]], corner = first;
        while (clip->triangles.corners[corner] != vertex)
            corner++;
        entries[k] = meso_attribute_entry(from, from->domain == MESO_ON_CORNERS ? corner : vertex);
    }
}

/* Numbers of vertices and corners are interpolated, and of corners then; 0 where there is none. */
static MesoStatus keep_corners(const Dressing *d, const MesoAttribute *from)
{
    MesoAttribute *to = add_attribute(d, from->name, MESO_ON_CORNERS, from->width, 3 * d->mesh->face_count);
    uint32_t corner = 0;
    if (!to)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < d->carve->mesh.triangle_count; t++) {
        const MesoCarvedTriangle *triangle = &d->carve->mesh.triangles[t];
        uint32_t entries[3];
        if (triangle->hole != MESO_NO_INDEX)
            continue;
        root_entries(d, from, triangle->root, entries);
        for (uint32_t k = 0; k < 3; k++, corner++)
            for (uint32_t c = 0; c < from->width; c++) {
                const float *w = triangle->weights[k], all[3] = {1 - w[0] - w[1], w[0], w[1]};
                float *value = &((float *)to->values)[(size_t)corner * from->width + c];
                for (uint32_t i = 0; i < 3; i++)
                    *value += entries[i] == MESO_NO_INDEX
                        ? 0 : all[i] * (float)meso_attribute_number(from, entries[i], c);
            }
    }
    return MESO_OK;
}

static MesoStatus keep_attributes(const Dressing *d)
{
    const MesoPolygonMesh *from = &d->run->clip->triangles;
    MesoStatus status = MESO_OK;
    for (uint32_t a = 0; a < from->attribute_count && !status; a++) {
        const MesoAttribute *attribute = &from->attributes[a];
        if (attribute->domain == MESO_ON_FACES)
            status = keep_faces(d, attribute);
        else if (attribute->width > 0)
            status = keep_corners(d, attribute);
    }
    return status;
}

static bool has_looks(const MesoReplicateCarve *c)
{
    for (uint32_t k = 0; k < c->kinds->kind_count; k++)
        if (c->look_names[k])
            return true;
    return false;
}

/* The kind of bump that two of a face's corners are under; MESO_NO_INDEX: none. */
static uint32_t kind_over(const Dressing *d, uint32_t face)
{
    const uint32_t *v = d->carve->corners + 3 * (size_t)face;
    uint32_t kinds[3];
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t detail = d->carve->under[v[k]];
        kinds[k] = detail == MESO_NO_INDEX ? MESO_NO_INDEX : d->run->details[detail].kind;
    }
    return kinds[0] == kinds[1] || kinds[0] == kinds[2] ? kinds[0] : kinds[1] == kinds[2] ? kinds[1] : MESO_NO_INDEX;
}

/* All faces look the same, but for those under bumps that have looks of their own: entry 0, and one for each kind. */
static MesoStatus paint(const Dressing *d, const MesoMaterial *look, const char *name)
{
    const MesoReplicateCarve *c = d->carve;
    uint32_t count = c->kinds->kind_count + 1;
    uint32_t *entry_of = MESO_NEW(d->arena, uint32_t, d->mesh->face_count, d->error);
    MesoAttribute *names = entry_of ? add_attribute(d, "material", MESO_ON_FACES, 0, count) : NULL;
    MesoAttribute *albedo = names ? add_attribute(d, "albedo", MESO_ON_FACES, 3, count) : NULL;
    MesoAttribute *roughness = albedo ? add_attribute(d, "roughness", MESO_ON_FACES, 1, count) : NULL;
    MesoAttribute *metallic = roughness ? add_attribute(d, "metallic", MESO_ON_FACES, 1, count) : NULL;
    if (!metallic)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < count; k++) {
        bool own = k > 0 && c->look_names[k - 1];
        const MesoMaterial *here = own ? &c->looks[k - 1] : look;
        names->names[k] = own ? c->look_names[k - 1] : name;
        memcpy((float *)albedo->values + 3 * (size_t)k, here->albedo, sizeof here->albedo);
        ((float *)roughness->values)[k] = here->roughness;
        ((float *)metallic->values)[k] = here->metallic;
    }
    for (uint32_t f = 0; f < d->mesh->face_count; f++) {
        uint32_t kind = kind_over(d, f);
        entry_of[f] = kind != MESO_NO_INDEX && c->look_names[kind] ? kind + 1 : 0;
    }
    names->entry_of = albedo->entry_of = roughness->entry_of = metallic->entry_of = entry_of;
    return MESO_OK;
}

MesoStatus meso_replicate_carve_mesh(MesoPolygonMesh *mesh, const MesoReplicateCarve *c, const MesoReplicateRun *r,
                                     const char *surface)
{
    static const MesoMaterial STONE = {{0.5f, 0.5f, 0.5f}, 0.7f, 0};
    MesoTool *tool = r->tool;
    const Dressing d = {c, r, &tool->arena, &tool->error, mesh};
    MesoMaterial look = STONE;
    char name[MESO_MATERIAL_NAME] = "surface";
    bool own = strcmp(surface, "own") == 0;
    *mesh = (MesoPolygonMesh){.vertex_count = c->mesh.vertex_count, .face_count = c->triangle_count,
                              .corner_count = 3 * c->triangle_count, .side_count = 3, .positions = c->positions,
                              .corners = c->corners,
                              .attributes = MESO_NEW(d.arena, MesoAttribute, r->clip->triangles.attribute_count + 4u,
                                                     d.error)};
    if (!mesh->attributes)
        return MESO_ERR_MEMORY;
    if (own && !has_looks(c))
        return keep_attributes(&d);
    MesoStatus status = own ? MESO_OK : meso_material_of_text(&look, name, surface, d.error);
    const char *copy = status ? NULL : meso_arena_copy_text(d.arena, name, d.error);
    return status ? status : copy ? paint(&d, &look, copy) : MESO_ERR_MEMORY;
}
