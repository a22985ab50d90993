#include "formats/mesh/ply/ply_layout.h"

#include <string.h>

typedef struct Planner {
    MesoPly *ply;
    const MesoPlyElement *element;
    MesoPolygonMesh *mesh;
    MesoArena *arena;
    MesoError *error;
} Planner;

/* While attributes have no room, `stride` of a property is the number of its attribute, plus 1, and `out` is not
 * used. */
static bool is_free(const MesoPlyProperty *property)
{
    return !property->list && property->role > MESO_PLY_Z && property->stride == 0;
}

static MesoPlyProperty *find_property(const Planner *planner, const char *name)
{
    for (MesoPlyProperty *p = planner->element->properties; p < planner->element->properties_end; p++)
        if (is_free(p) && strcmp(p->name, name) == 0)
            return p;
    return NULL;
}

static bool is_color(const char *name)
{
    return strcmp(name, "red") == 0 || strcmp(name, "green") == 0 || strcmp(name, "blue") == 0 || strcmp(name, "alpha") == 0;
}

static MesoStatus add_attribute(Planner *planner, const char *name, MesoPlyProperty *const *properties, uint32_t width)
{
    MesoAttribute *attribute = &planner->mesh->attributes[planner->mesh->attribute_count++];
    *attribute = (MesoAttribute){
        .name = name, .width = width, .scalar = properties[0]->type,
        .domain = planner->element->kind == MESO_PLY_FACES ? MESO_ON_FACES : MESO_ON_VERTICES,
        .components = MESO_NEW(planner->arena, const char *, width, planner->error)};
    if (!attribute->components)
        return MESO_ERR_MEMORY;
    attribute->normalized = is_color(properties[0]->name) &&
                            (attribute->scalar == MESO_SCALAR_UINT8 || attribute->scalar == MESO_SCALAR_UINT16);
    for (uint32_t c = 0; c < width; c++) {
        attribute->components[c] = properties[c]->name;
        properties[c]->stride = planner->mesh->attribute_count;
        if (properties[c]->type != attribute->scalar)
            attribute->scalar = MESO_SCALAR_FLOAT;
    }
    return MESO_OK;
}

/* An attribute of the properties `names` [width], where all are there and, unless `mixed`, of one type. */
static MesoStatus group(Planner *planner, const char *name, const char *const *names, uint32_t width, bool mixed)
{
    MesoPlyProperty *properties[4];
    for (uint32_t c = 0; c < width; c++) {
        properties[c] = find_property(planner, names[c]);
        if (!properties[c] || (!mixed && properties[c]->type != properties[0]->type))
            return MESO_OK;
    }
    return add_attribute(planner, name, properties, width);
}

static bool has_attribute(const Planner *planner, const char *name)
{
    MesoAttributeDomain domain = planner->element->kind == MESO_PLY_FACES ? MESO_ON_FACES : MESO_ON_VERTICES;
    return meso_polygon_attribute_on(planner->mesh, name, domain) != NULL;
}

static MesoStatus plan_known(Planner *planner)
{
    static const char *const normal[] = {"nx", "ny", "nz"}, *const rgba[] = {"red", "green", "blue", "alpha"};
    static const char *const pairs[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    MesoStatus status = group(planner, "normal", normal, 3, true);
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs && !status; i++)
        if (!has_attribute(planner, "uv"))
            status = group(planner, "uv", pairs[i], 2, false);
    if (!status)
        status = group(planner, "color", rgba, 4, false);
    if (!status && !has_attribute(planner, "color"))
        status = group(planner, "color", rgba, 3, false);
    return status;
}

/* A vector whose first number is `property`, if it is one. */
static MesoStatus plan_vector(Planner *planner, const MesoPlyProperty *property)
{
    size_t length = strlen(property->name);
    if (length < 2 || property->name[length - 1] != 'x')
        return MESO_OK;
    char *names[3];
    for (uint32_t c = 0; c < 3; c++) {
        names[c] = meso_arena_copy_text(planner->arena, property->name, planner->error);
        if (!names[c])
            return MESO_ERR_MEMORY;
        names[c][length - 1] = "xyz"[c];
    }
    size_t base = property->name[length - 2] == '_' ? length - 2 : length - 1;
    char *name = meso_arena_copy_text(planner->arena, property->name, planner->error);
    if (!name)
        return MESO_ERR_MEMORY;
    name[base] = 0;
    return base ? group(planner, name, (const char *const *)names, 3, false) : MESO_OK;
}

static MesoStatus plan_others(Planner *planner)
{
    MesoStatus status = MESO_OK;
    for (MesoPlyProperty *p = planner->element->properties; p < planner->element->properties_end && !status; p++) {
        if (is_free(p))
            status = plan_vector(planner, p);
        if (!status && is_free(p))
            status = add_attribute(planner, p->name, &p, 1);
    }
    return status;
}

/* Of corners, as far as the header tells. */
static void plan_lists(Planner *planner)
{
    for (MesoPlyProperty *p = planner->element->properties; p < planner->element->properties_end; p++) {
        if (!meso_ply_is_of_corners(p))
            continue;
        const char *name = p->role == MESO_PLY_TEXCOORD ? "uv" : p->name;
        bool bytes = p->type == MESO_SCALAR_UINT8 || p->type == MESO_SCALAR_UINT16;
        planner->mesh->attributes[planner->mesh->attribute_count++] = (MesoAttribute){
            .name = name, .domain = MESO_ON_CORNERS, .scalar = p->type, .normalized = bytes && strcmp(name, "color") == 0};
        p->stride = planner->mesh->attribute_count;
    }
}

MesoStatus meso_ply_plan(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error)
{
    MesoStatus status = MESO_OK;
    mesh->attributes = MESO_NEW(arena, MesoAttribute, ply->property_count + 1, error);
    if (!mesh->attributes)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < ply->element_count && !status; e++) {
        Planner planner = {ply, &ply->elements[e], mesh, arena, error};
        if (planner.element->kind == MESO_PLY_UNKNOWN)
            continue;
        status = plan_known(&planner);
        if (!status)
            status = plan_others(&planner);
        plan_lists(&planner);
    }
    return status;
}

/* ---- room ---- */

static void aim(MesoPlyProperty *property, void *out, uint32_t stride, MesoScalar to)
{
    property->out = out;
    property->stride = stride;
    property->to = to;
}

static MesoStatus make_attribute(MesoAttribute *attribute, MesoArena *arena, uint32_t count, MesoError *error)
{
    attribute->entry_count = count;
    attribute->values = meso_arena_alloc(arena, count, (size_t)attribute->width * meso_scalar_size(attribute->scalar),
                                         error);
    return attribute->values ? MESO_OK : MESO_ERR_MEMORY;
}

/* Of the scalars of an element, all but positions. */
static MesoStatus aim_scalars(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena, uint32_t count,
                              MesoError *error)
{
    for (MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        if (p->list || p->role <= MESO_PLY_Z)
            continue;
        MesoAttribute *attribute = &mesh->attributes[p->stride - 1];
        if (!attribute->values && make_attribute(attribute, arena, count, error))
            return MESO_ERR_MEMORY;
        uint32_t size = meso_scalar_size(attribute->scalar), component = 0;
        while (attribute->components[component] != p->name)
            component++;
        aim(p, (unsigned char *)attribute->values + (size_t)component * size, attribute->width * size,
            attribute->scalar);
    }
    return MESO_OK;
}

MesoStatus meso_ply_make_vertices(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena,
                                  uint32_t count, MesoError *error)
{
    mesh->vertex_count = count;
    mesh->positions = MESO_NEW(arena, MesoVec3, count, error);
    if (!mesh->positions)
        return MESO_ERR_MEMORY;
    for (MesoPlyProperty *p = element->properties; p < element->properties_end; p++)
        if (p->role <= MESO_PLY_Z)
            aim(p, (float *)mesh->positions + p->role, sizeof *mesh->positions, MESO_SCALAR_FLOAT);
    return aim_scalars(element, mesh, arena, count, error);
}

void meso_ply_note_widths(uint32_t *widths, const MesoPlyElement *element, const uint32_t *counts)
{
    uint32_t sides = 0;
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++)
        if (p->role == MESO_PLY_INDICES)
            sides = counts[p - element->properties];
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        uint32_t *width = &widths[p - element->properties], count = counts[p - element->properties];
        if (!meso_ply_is_of_corners(p))
            continue;
        if (*width == 0 && sides > 0)
            *width = count > 0 ? count / sides : MESO_NO_INDEX;
        if (count != (uint64_t)*width * sides)
            *width = MESO_NO_INDEX;
    }
}

void meso_ply_join_widths(uint32_t *widths, const uint32_t *others, const MesoPlyElement *element)
{
    for (uint32_t i = 0; i < element->properties_end - element->properties; i++) {
        if (widths[i] == 0)
            widths[i] = others[i];
        else if (others[i] != 0 && others[i] != widths[i])
            widths[i] = MESO_NO_INDEX;
    }
}

static MesoStatus aim_list(MesoPlyProperty *property, MesoPolygonMesh *mesh, MesoArena *arena, uint32_t width,
                           MesoError *error)
{
    MesoAttribute *attribute = &mesh->attributes[property->stride - 1];
    if (width == 0 || width == MESO_NO_INDEX || (property->role == MESO_PLY_TEXCOORD && width != 2))
        return MESO_OK;
    attribute->width = width;
    if (make_attribute(attribute, arena, mesh->corner_count, error))
        return MESO_ERR_MEMORY;
    aim(property, attribute->values, width * meso_scalar_size(property->type), property->type);
    return MESO_OK;
}

/* Lists that turned out to be of something else. */
static void drop_empty(MesoPolygonMesh *mesh)
{
    uint32_t kept = 0;
    for (uint32_t a = 0; a < mesh->attribute_count; a++)
        if (mesh->attributes[a].domain != MESO_ON_CORNERS || mesh->attributes[a].width > 0)
            mesh->attributes[kept++] = mesh->attributes[a];
    mesh->attribute_count = kept;
}

MesoStatus meso_ply_make_faces(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena,
                               uint32_t count, uint32_t corner_count, uint32_t side_count, const uint32_t *widths,
                               MesoError *error)
{
    mesh->face_count = count;
    mesh->corner_count = corner_count;
    mesh->side_count = side_count;
    mesh->corners = MESO_NEW(arena, uint32_t, corner_count, error);
    mesh->face_begin = side_count ? NULL : MESO_NEW(arena, uint32_t, (size_t)count + 1, error);
    if (!mesh->corners || (!side_count && !mesh->face_begin))
        return MESO_ERR_MEMORY;
    for (MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        if (p->role == MESO_PLY_INDICES)
            aim(p, mesh->corners, sizeof *mesh->corners, MESO_SCALAR_UINT32);
        if (meso_ply_is_of_corners(p) && aim_list(p, mesh, arena, widths[p - element->properties], error))
            return MESO_ERR_MEMORY;
    }
    MesoStatus status = aim_scalars(element, mesh, arena, count, error);
    drop_empty(mesh);
    return status;
}
