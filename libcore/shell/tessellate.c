#include "libcore/shell/tessellate.h"

#include <assert.h>
#include <stdio.h>

#include "libcore/shell/shell.h"
#include "libcore/shell/trajectory.h"

/* ---- counting ---- */

static uint64_t kind_vertex_count(const MesoSweepKind *kind)
{
    return (uint64_t)kind->column_count * kind->division_count;
}

static uint64_t kind_face_count(const MesoSweepKind *kind)
{
    return (uint64_t)kind->joint_count * (kind->division_count - 1);
}

/* A cap's last row are triangles. */
static uint64_t kind_triangle_count(const MesoSweepKind *kind)
{
    return 2 * kind_face_count(kind) - (kind->cap ? kind->joint_count : 0);
}

static const MesoTriangleMesh *inner_mesh(const MesoStructure *s, uint32_t inner_instance)
{
    return &s->model->inner_meshes[s->inners[inner_instance].inner];
}

MesoStatus meso_tessellation_init(MesoTessellation *tessellation, MesoArena *arena,
                                  const MesoStructure *structure, MesoError *error)
{
    uint32_t part_count = structure->instance_count + structure->inner_count;
    uint64_t *vertex_begin = MESO_NEW(arena, uint64_t, (size_t)part_count + 1, error);
    uint64_t *face_begin = MESO_NEW(arena, uint64_t, (size_t)part_count + 1, error);
    if (!vertex_begin || !face_begin)
        return MESO_ERR_MEMORY;

    uint32_t part = 0;
    uint64_t vertices = 0, faces = 0, triangles = 0;
    for (uint32_t k = 0; k < structure->kind_count; k++) {
        const MesoSweepKind *kind = &structure->kinds[k];
        for (uint32_t i = 0; i < kind->instance_count; i++) {
            triangles += kind_triangle_count(kind);
            vertex_begin[++part] = vertices += kind_vertex_count(kind);
            face_begin[part] = faces += kind_face_count(kind);
        }
    }
    for (uint32_t i = 0; i < structure->inner_count; i++) {
        triangles += inner_mesh(structure, i)->triangle_count;
        vertex_begin[++part] = vertices += inner_mesh(structure, i)->vertex_count;
        face_begin[part] = faces += inner_mesh(structure, i)->triangle_count;
    }
    *tessellation = (MesoTessellation){structure, part_count, vertex_begin, face_begin, triangles};
    return MESO_OK;
}

static const MesoSweepKind *kind_of_part(const MesoStructure *s, uint32_t part)
{
    return &s->kinds[meso_structure_kind(s, part)];
}

MesoMeshPart meso_tessellation_part(const MesoTessellation *tessellation, uint32_t part)
{
    const MesoStructure *s = tessellation->structure;
    assert(part < tessellation->part_count);
    if (part < s->instance_count) {
        const MesoSweepKind *kind = kind_of_part(s, part);
        return (MesoMeshPart){s->instances[part].slot, kind->tile, kind->start_section};
    }
    const MesoInnerInstance *inner = &s->inners[part - s->instance_count];
    return (MesoMeshPart){inner->slot, s->model->assignment.tile[inner->slot],
                          s->model->tile_set.section_count + inner->inner};
}

/* ---- sweeps ---- */

/* The plane of one ring, with lengths scaled from edge lengths to the scene. */
typedef struct Plane {
    MesoVec3 origin, x, y, tangent;
    float speed;    /* |B'| */
} Plane;

/*
 * X and Y span the plane across `tangent`. Where the up direction lies along
 * the tangent there is no such plane; any one across it will do.
 */
static Plane make_plane(MesoVec3 origin, MesoVec3 up, MesoVec3 tangent, float speed)
{
    MesoVec3 axis = fabsf(tangent.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 fallback = meso_vec3_unit(meso_vec3_cross(axis, tangent), axis);
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(up, tangent), fallback);
    return (Plane){origin, x, meso_vec3_cross(tangent, x), tangent, speed};
}

/* At the ends all comes from the ports alone: the neighbour computes the same floats. */
static Plane sweep_plane(const MesoSweepInstance *sweep, float v)
{
    if (v == 0 || v == 1) {
        uint32_t end = v == 1;
        float speed = 3 * meso_vec3_length(meso_vec3_sub(sweep->p[end ? 3 : 1], sweep->p[end ? 2 : 0]));
        return make_plane(sweep->p[end ? 3 : 0], sweep->up[end], sweep->direction[end], speed);
    }
    MesoVec3 derivative = meso_bezier_derivative(sweep->p, v);
    MesoVec3 tangent = meso_vec3_unit(derivative, sweep->direction[v > 0.5f]);
    return make_plane(meso_bezier_point(sweep->p, v), meso_vec3_lerp(sweep->up[0], sweep->up[1], v),
                      tangent, meso_vec3_length(derivative));
}

static MesoVec3 in_plane(const Plane *plane, MesoVec2 n)
{
    return (MesoVec3){n.x * plane->x.x + n.y * plane->y.x, n.x * plane->x.y + n.y * plane->y.y,
                      n.x * plane->x.z + n.y * plane->y.z};
}

static MesoMeshVertex sweep_vertex(const Plane *plane, MesoVec2 s, MesoVec3 normal, float scale,
                                   float u, float v)
{
    return (MesoMeshVertex){meso_vec3_mad(plane->origin, scale, in_plane(plane, s)),
                            meso_vec3_unit(normal, plane->x), {u, v}};
}

MesoVec3 meso_sweep_point(const MesoStructure *structure, const MesoSweepInstance *sweep, MesoVec2 profile, float v)
{
    Plane plane = sweep_plane(sweep, v);
    return meso_vec3_mad(plane.origin, structure->options.section_scale, in_plane(&plane, profile));
}

static void sweep_vertices(const MesoStructure *s, const MesoSweepKind *kind,
                           const MesoSweepInstance *sweep, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = s->columns + kind->column_begin;
    float scale = s->options.section_scale;
    uint32_t last = kind->division_count - 1;
    for (uint32_t ring = 0; ring <= last; ring++) {
        float v = (float)ring / (float)last, w = v * v * (3 - 2 * v);
        Plane plane = sweep_plane(sweep, v);
        float tilt_scale = plane.speed > 0 ? scale * 6 * v * (1 - v) / plane.speed : 0;
        for (uint32_t c = 0; c < kind->column_count; c++) {
            const MesoSweepColumn *column = &columns[c];
            MesoVec2 at = ring == 0 ? column->start : ring == last ? column->end
                        : meso_vec2_lerp(column->start, column->end, w);
            MesoVec2 n = meso_vec2_lerp(column->start_normal, column->end_normal, w);
            MesoVec2 change = meso_vec2_sub(column->end, column->start);
            float tilt = tilt_scale * (change.x * n.x + change.y * n.y);
            MesoVec3 normal = meso_vec3_mad(in_plane(&plane, n), -tilt, plane.tangent);
            *out++ = sweep_vertex(&plane, at, normal, scale, column->u, v);
        }
    }
}

static void cap_vertices(const MesoStructure *s, const MesoSweepKind *kind,
                         const MesoSweepInstance *cap, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = s->columns + kind->column_begin;
    float scale = s->options.section_scale;
    uint32_t last = kind->division_count - 1;
    for (uint32_t ring = 0; ring <= last; ring++) {
        float v = (float)ring / (float)last, radius = 1 - v * v * v * v;
        Plane plane = make_plane(cap->p[0], cap->up[0], cap->direction[0], 0);
        plane.origin = meso_vec3_mad(plane.origin, scale * MESO_CAP_RISE * v, plane.tangent);
        for (uint32_t c = 0; c < kind->column_count; c++) {
            MesoVec2 at = columns[c].start, n = columns[c].start_normal;
            float lean = 4 * v * v * v * (at.x * n.x + at.y * n.y);
            MesoVec3 normal = meso_vec3_mad(meso_vec3_scale(in_plane(&plane, n), MESO_CAP_RISE), lean, plane.tangent);
            *out++ = sweep_vertex(&plane, (MesoVec2){radius * at.x, radius * at.y}, normal, scale, columns[c].u, v);
        }
    }
}

/* The rings run clockwise around the tangent: along, then around is counter-clockwise from outside. */
static void sweep_faces(const MesoStructure *s, const MesoSweepKind *kind, uint32_t base, MesoMeshFace *out)
{
    const MesoSweepColumn *columns = s->columns + kind->column_begin;
    uint32_t width = kind->column_count, last = kind->division_count - 1;
    for (uint32_t ring = 0; ring < last; ring++)
        for (uint32_t c = 0; c < width; c++) {
            if (!columns[c].joins_next)
                continue;
            uint32_t here = base + ring * width + c, ahead = here + width;
            bool tip = kind->cap && ring + 1 == last;
            *out++ = (MesoMeshFace){{here, ahead, tip ? here + 1 : ahead + 1, tip ? MESO_NO_INDEX : here + 1}};
        }
}

/* ---- inner meshes ---- */

/* Position of a vertex of an inner mesh in the unit cube of the slot; a tile is half as high as wide. */
static MesoVec3 to_slot_cube(const MesoInnerMesh *inner, MesoTransform transform, MesoVec3 p)
{
    MesoVec3 q = meso_inner_point(inner, p);
    MesoVec2 at = meso_transform_point(transform, (MesoVec2){q.x, q.y});
    return (MesoVec3){at.x, at.y, 2 * q.z};
}

static float inner_determinant(const MesoInnerMesh *inner)
{
    const float *m = inner->transform;
    MesoVec3 x = {m[0], m[4], m[8]}, y = {m[1], m[5], m[9]}, z = {m[2], m[6], m[10]};
    return meso_vec3_dot(meso_vec3_cross(x, y), z);
}

static bool inner_is_mirrored(const MesoStructure *s, const MesoInnerInstance *instance)
{
    bool negative = inner_determinant(&s->model->tile_set.inners[instance->inner]) < 0;
    return negative != meso_transform_flips(s->model->assignment.transform[instance->slot]);
}

/*
 * The map of a slot is smooth, so its derivative along mesh axes is taken by
 * central differences of a thousandth of the tile; normals follow the
 * cofactors of that matrix.
 */
static MesoVec3 map_normal(const MesoShell *shell, uint32_t slot, const MesoInnerMesh *inner,
                           MesoTransform transform, MesoVec3 p, MesoVec3 n, bool mirrored)
{
    MesoVec3 d[3], steps[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const float *m = inner->transform;
    for (int k = 0; k < 3; k++) {
        float length = meso_vec3_length((MesoVec3){m[k], m[4 + k], m[8 + k]});
        float h = length > 0 ? 1e-3f / length : 0;
        MesoVec3 a = to_slot_cube(inner, transform, meso_vec3_mad(p, -h, steps[k]));
        MesoVec3 b = to_slot_cube(inner, transform, meso_vec3_mad(p, h, steps[k]));
        d[k] = meso_vec3_scale(meso_vec3_sub(meso_shell_point(shell, slot, b.x, b.y, b.z),
                                             meso_shell_point(shell, slot, a.x, a.y, a.z)),
                               length);
    }
    MesoVec3 x = meso_vec3_scale(meso_vec3_cross(d[1], d[2]), n.x);
    MesoVec3 y = meso_vec3_scale(meso_vec3_cross(d[2], d[0]), n.y);
    MesoVec3 z = meso_vec3_scale(meso_vec3_cross(d[0], d[1]), n.z);
    MesoVec3 mapped = meso_vec3_add(x, meso_vec3_add(y, z));
    return meso_vec3_direction(mirrored ? meso_vec3_scale(mapped, -1) : mapped, (MesoVec3){0, 0, 1});
}

static void inner_vertices(const MesoStructure *s, const MesoInnerInstance *instance, MesoMeshVertex *out)
{
    const MesoTriangleMesh *mesh = &s->model->inner_meshes[instance->inner];
    const MesoInnerMesh *inner = &s->model->tile_set.inners[instance->inner];
    MesoTransform transform = s->model->assignment.transform[instance->slot];
    MesoShell shell = meso_shell_make(&s->model->surface, NULL, &s->options);
    bool mirrored = inner_is_mirrored(s, instance);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        MesoVec3 q = to_slot_cube(inner, transform, mesh->positions[i]);
        out[i] = (MesoMeshVertex){
            meso_shell_point(&shell, instance->slot, q.x, q.y, q.z),
            map_normal(&shell, instance->slot, inner, transform, mesh->positions[i], mesh->normals[i], mirrored),
            {0, 0}};
    }
}

static void inner_faces(const MesoStructure *s, const MesoInnerInstance *instance, uint32_t base,
                        MesoMeshFace *out)
{
    const MesoTriangleMesh *mesh = &s->model->inner_meshes[instance->inner];
    uint32_t second = inner_is_mirrored(s, instance) ? 2 : 1;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = &mesh->triangles[3 * (size_t)i];
        out[i] = (MesoMeshFace){{base + t[0], base + t[second], base + t[3 - second], MESO_NO_INDEX}};
    }
}

/* ---- parts ---- */

void meso_tessellation_vertices(const MesoTessellation *tessellation, uint32_t begin, uint32_t end,
                                MesoMeshVertex *out)
{
    const MesoStructure *s = tessellation->structure;
    uint64_t first = tessellation->vertex_begin[begin];
    for (uint32_t part = begin; part < end; part++) {
        MesoMeshVertex *to = out + (tessellation->vertex_begin[part] - first);
        if (part >= s->instance_count) {
            inner_vertices(s, &s->inners[part - s->instance_count], to);
            continue;
        }
        const MesoSweepKind *kind = kind_of_part(s, part);
        (kind->cap ? cap_vertices : sweep_vertices)(s, kind, &s->instances[part], to);
    }
}

void meso_tessellation_faces(const MesoTessellation *tessellation, uint32_t begin, uint32_t end,
                             uint32_t base, MesoMeshFace *out)
{
    const MesoStructure *s = tessellation->structure;
    uint64_t first_vertex = tessellation->vertex_begin[begin], first_face = tessellation->face_begin[begin];
    for (uint32_t part = begin; part < end; part++) {
        uint32_t part_base = base + (uint32_t)(tessellation->vertex_begin[part] - first_vertex);
        MesoMeshFace *to = out + (tessellation->face_begin[part] - first_face);
        if (part < s->instance_count)
            sweep_faces(s, kind_of_part(s, part), part_base, to);
        else
            inner_faces(s, &s->inners[part - s->instance_count], part_base, to);
    }
}

/* ---- materials ---- */

uint32_t meso_structure_material_count(const MesoStructure *structure)
{
    return structure->model->tile_set.section_count + structure->model->tile_set.inner_count;
}

const MesoMaterial *meso_structure_material(const MesoStructure *structure, uint32_t material)
{
    const MesoTileSet *set = &structure->model->tile_set;
    return material < set->section_count ? &set->sections[material].material
                                         : &set->inners[material - set->section_count].material;
}

void meso_structure_material_name(const MesoStructure *structure, uint32_t material,
                                  char *out, unsigned size)
{
    const MesoTileSet *set = &structure->model->tile_set;
    if (material < set->section_count) {
        const MesoSection *section = &set->sections[material];
        snprintf(out, size, "%s/%s", set->interfaces[section->interface].name, section->name);
        return;
    }
    uint32_t inner = material - set->section_count;
    for (uint32_t t = 0; t < set->tile_count; t++)
        if (inner - set->tiles[t].inner_begin < set->tiles[t].inner_count)
            snprintf(out, size, "%s/inner %u", set->tiles[t].name, inner - set->tiles[t].inner_begin + 1);
}
