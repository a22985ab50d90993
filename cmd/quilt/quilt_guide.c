#include "cmd/quilt/quilt_guide.h"

#include <string.h>

#include "formats/mesh/point_file.h"
#include "libcore/field/direction_field.h"

/* The attribute that the directions of a file become; no file's own attribute has such a name. */
static const char *const GUIDE_NAME = "--guide";

/* How strongly directions that are given hold where others are found between them. */
static const float HOLD = 100;

static const char *const FIELD = "field=";

float meso_quilt_guide_turn(const MesoQuiltArguments *a)
{
    return strcmp(a->guide, "smooth") == 0 || strcmp(a->guide, "auto") == 0 ? 0.3f : 0;
}

static bool is_word(const char *guide)
{
    static const char *const words[] = {"smooth", "auto", "u", "v", "none"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(guide, words[i]) == 0)
            return true;
    return strncmp(guide, FIELD, strlen(FIELD)) == 0;
}

/* ---- files ---- */

/* In the command that products record the file has no folder, as operands have none. */
static MesoStatus record_name(MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    if (tool->provenance.detail != MESO_PROVENANCE_NAMES)
        return MESO_OK;
    const char *name = meso_provenance_name(a->guide, &tool->arena, &tool->error);
    const MesoOptionChange changes[] = {{"guide", name}, {NULL, NULL}};
    tool->provenance.command_line = name ? meso_tool_command(tool, changes, &tool->arena, &tool->error) : NULL;
    return tool->provenance.command_line ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_quilt_guide_add(MesoPolygonMesh *mesh, MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    MesoInput input;
    const MesoVec3 *directions;
    uint32_t count;
    if (is_word(a->guide))
        return MESO_OK;
    MesoStatus status = meso_tool_open_input(tool, &input, a->guide, "guide");
    if (status)
        return status;
    status = meso_points_read(&directions, &count, &tool->arena, &input, &tool->error);
    meso_input_close(&input);
    if (!status)
        status = record_name(a);
    if (!status && count != mesh->face_count)
        status = meso_fail(&tool->error, MESO_ERR_INPUT, "%s: has %u directions; the surface has %u faces", a->guide,
                           count, mesh->face_count);
    MesoAttribute *attributes = status ? NULL : MESO_NEW(&tool->arena, MesoAttribute, mesh->attribute_count + 1,
                                                         &tool->error);
    if (!attributes)
        return status ? status : MESO_ERR_MEMORY;
    if (mesh->attribute_count)
        memcpy(attributes, mesh->attributes, mesh->attribute_count * sizeof *attributes);
    attributes[mesh->attribute_count++] = (MesoAttribute){
        .name = GUIDE_NAME, .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_FLOAT, .width = 3, .entry_count = count,
        .values = (void *)(uintptr_t)directions};
    mesh->attributes = attributes;
    return MESO_OK;
}

/* ---- attributes ---- */

/* Three numbers of an element, which may be an attribute or several. */
typedef struct Vector {
    const MesoAttribute *attributes[3];
    uint32_t components[3];
} Vector;

/* NAME with three numbers, or the numbers NAMEx NAMEy NAMEz, or NAME_x and so on. */
static bool find_vector(Vector *vector, const MesoPolygonMesh *mesh, const char *name, MesoAttributeDomain domain,
                        MesoArena *arena)
{
    const MesoAttribute *whole = meso_polygon_attribute_on(mesh, name, domain);
    if (whole && whole->width == 3) {
        *vector = (Vector){{whole, whole, whole}, {0, 1, 2}};
        return true;
    }
    for (uint32_t choice = 0; choice < 2; choice++) {
        uint32_t found = 0;
        for (uint32_t i = 0; i < 3; i++) {
            const char *number = meso_arena_print(arena, NULL, "%s%s%c", name, choice ? "_" : "", "xyz"[i]);
            uint32_t *component = &vector->components[i];
            vector->attributes[i] = number ? meso_polygon_number_on(mesh, number, domain, component) : NULL;
            found += vector->attributes[i] != NULL;
        }
        if (found == 3)
            return true;
    }
    return false;
}

static MesoStatus take_attribute(MesoVec3 *guide, const MesoPolygonMesh *mesh, const MesoTriangulation *base,
                                 const char *name, MesoQuiltArguments *a)
{
    Vector vector;
    MesoTool *tool = &a->tool;
    if (!find_vector(&vector, mesh, name, MESO_ON_FACES, &tool->arena) &&
        !find_vector(&vector, mesh, name, MESO_ON_VERTICES, &tool->arena))
        return meso_fail(&tool->error, MESO_ERR_INPUT, "--guide: the surface has no vector attribute '%s': a PLY file "
                         "would give it as the properties %sx %sy %sz of faces or vertices", name, name, name, name);
    for (uint32_t t = 0; t < base->triangle_count; t++) {
        double x[3];
        for (uint32_t i = 0; i < 3; i++)
            x[i] = meso_polygon_face_number(mesh, vector.attributes[i], vector.components[i], base->faces[t]);
        guide[t] = (MesoVec3){(float)x[0], (float)x[1], (float)x[2]};
    }
    return MESO_OK;
}

/* ---- texture coordinates ---- */

static MesoVec2 uv_at(const MesoPolygonMesh *mesh, const MesoAttribute *uv, uint32_t corner)
{
    uint32_t element = uv->domain == MESO_ON_CORNERS ? corner : mesh->corners[corner];
    uint32_t entry = meso_attribute_entry(uv, element);
    return entry == MESO_NO_INDEX ? (MesoVec2){NAN, NAN} : meso_attribute_vec2(uv, entry);
}

/* Where the coordinate grows fastest in the triangle: n x (sum of its values times the sides across). */
static MesoVec3 gradient(const MesoPolygonMesh *mesh, const MesoAttribute *uv, uint32_t face, bool v)
{
    MesoVec3 p[3], sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        p[k] = mesh->positions[mesh->corners[3 * face + k]];
    MesoVec3 normal = meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0]));
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec2 at = uv_at(mesh, uv, 3 * face + k);
        sum = meso_vec3_mad(sum, v ? at.y : at.x, meso_vec3_sub(p[(k + 2) % 3], p[(k + 1) % 3]));
    }
    return meso_vec3_cross(meso_vec3_direction(normal, normal), sum);
}

static MesoStatus take_texture(MesoVec3 *guide, const MesoPolygonMesh *mesh, const MesoTriangulation *base, bool v,
                               MesoQuiltArguments *a)
{
    const MesoAttribute *uv = meso_polygon_attribute_on(mesh, "uv", MESO_ON_CORNERS);
    uv = uv ? uv : meso_polygon_attribute_on(mesh, "uv", MESO_ON_VERTICES);
    if (!uv || uv->width < 2)
        return meso_fail(&a->tool.error, MESO_ERR_INPUT, "--guide: the surface has no texture coordinates");
    for (uint32_t t = 0; t < base->triangle_count; t++)
        guide[t] = gradient(mesh, uv, base->faces[t], v);
    return MESO_OK;
}

/* ---- fields ---- */

/* Where the swatch may be turned by a sixth, a quarter or half, directions need not be told apart beyond that. */
static uint32_t symmetry_of(uint32_t turns)
{
    static const uint32_t symmetries[] = {4, 6, 3, 2};
    for (size_t i = 0; i < sizeof symmetries / sizeof *symmetries; i++)
        if (turns % symmetries[i] == 0)
            return symmetries[i];
    return 1;
}

/* Directions into the triangles' planes, unit or 0. Returns how many are 0. */
static uint32_t flatten(MesoVec3 *guide, const MesoTriangulation *base)
{
    uint32_t missing = 0;
    for (uint32_t t = 0; t < base->triangle_count; t++) {
        const uint32_t *v = &base->corners[3 * (size_t)t];
        MesoVec3 a = base->positions[v[0]], zero = {0, 0, 0}, given = meso_vec3_direction(guide[t], zero);
        MesoVec3 normal = meso_vec3_direction(meso_vec3_cross(meso_vec3_sub(base->positions[v[1]], a),
                                                              meso_vec3_sub(base->positions[v[2]], a)), zero);
        MesoVec3 flat = meso_vec3_mad(given, -meso_vec3_dot(given, normal), normal);
        /* what stands within a thousandth upright has no direction in the plane worth following */
        guide[t] = meso_vec3_length(flat) > 1e-3f ? meso_vec3_direction(flat, zero) : zero;
        missing += meso_vec3_dot(guide[t], guide[t]) == 0;
    }
    return missing;
}

/* The smoothest field between what is there. `weights` [triangle_count]. */
static MesoStatus smooth(MesoVec3 **guide, float *weights, const MesoTriangulation *base, MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    MesoDirectionField field;
    uint32_t symmetry = symmetry_of(a->turns);
    MesoStatus status = meso_direction_field_smooth(&field, &tool->arena, base, symmetry, *guide, weights,
                                                    &tool->error);
    if (status)
        return status;
    *guide = field.directions;
    json_object_set_new(tool->report, "singularities", json_integer(field.singularity_count));
    if (field.singularity_count)
        meso_tool_say(tool, "the field of directions has %u singularities%s", field.singularity_count,
                      symmetry < 4 ? "; with --turns 4 it may have weaker ones" : "");
    return MESO_OK;
}

/* From where the surface bends most; flat parts follow. */
static MesoStatus find_auto(MesoVec3 **guide, float *weights, const MesoTriangulation *base, MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = meso_principal_directions(*guide, weights, &scratch, base, &tool->error);
    meso_arena_release(&scratch);
    return status ? status : smooth(guide, weights, base, a);
}

static MesoStatus find_given(MesoVec3 **guide, float *weights, const MesoPolygonMesh *mesh,
                             const MesoTriangulation *base, MesoQuiltArguments *a)
{
    bool texture = strcmp(a->guide, "u") == 0 || strcmp(a->guide, "v") == 0;
    const char *name = is_word(a->guide) ? a->guide + strlen(FIELD) : GUIDE_NAME;
    MesoStatus status = texture ? take_texture(*guide, mesh, base, *a->guide == 'v', a)
                                : take_attribute(*guide, mesh, base, name, a);
    if (status)
        return status;
    uint32_t missing = flatten(*guide, base);
    if (missing == 0)
        return MESO_OK;
    for (uint32_t t = 0; t < base->triangle_count; t++)
        weights[t] = meso_vec3_dot((*guide)[t], (*guide)[t]) > 0 ? HOLD : 0;
    meso_tool_say(&a->tool, "%u of %u triangles have no direction of their own: they follow their neighbours", missing,
                  base->triangle_count);
    return smooth(guide, weights, base, a);
}

MesoStatus meso_quilt_guide_find(MesoVec3 **guide, const MesoPolygonMesh *mesh, const MesoTriangulation *base,
                                 MesoQuiltArguments *a)
{
    MesoTool *tool = &a->tool;
    *guide = NULL;
    if (strcmp(a->guide, "none") == 0)
        return MESO_OK;
    *guide = MESO_NEW(&tool->arena, MesoVec3, base->triangle_count, &tool->error);
    float *weights = MESO_NEW(&tool->arena, float, base->triangle_count, &tool->error);
    if (!*guide || !weights)
        return MESO_ERR_MEMORY;
    if (strcmp(a->guide, "smooth") == 0 && a->plane) {
        for (uint32_t t = 0; t < base->triangle_count; t++)
            (*guide)[t] = (MesoVec3){1, 0, 0};
        return MESO_OK;
    }
    return strcmp(a->guide, "smooth") == 0 ? smooth(guide, weights, base, a)
        : strcmp(a->guide, "auto") == 0 ? find_auto(guide, weights, base, a)
                                        : find_given(guide, weights, mesh, base, a);
}
