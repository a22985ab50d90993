#include "formats/scene/surface_frame.h"

#include <math.h>
#include <string.h>

/* ---- lengths ---- */

static float distance(const MesoMeshVertex *a, const MesoMeshVertex *b)
{
    return meso_vec3_length(meso_vec3_sub(b->position, a->position));
}

/* Which bit of a column's absence speaks of a ring. */
static uint32_t absence_on(const MesoSweptKind *kind, uint32_t ring)
{
    return ring == 0 ? MESO_ABSENT_START : ring + 1 == kind->division_count ? MESO_ABSENT_END : MESO_ABSENT_BETWEEN;
}

/*
 * Of the vertices from `*at` on, which are moved past; those of the ring before begin at `before`. The first column is
 * on all rings; one that the ring before lacks has come as far along as its neighbour.
 */
static void measure_ring(MesoVec2 *out, const MesoMeshVertex *vertices, const MesoSweepColumn *columns,
                         const MesoSweptKind *kind, uint32_t ring, uint64_t before, uint64_t *at)
{
    const uint32_t here = absence_on(kind, ring), there = ring ? absence_on(kind, ring - 1) : ~0u;
    const uint64_t begin = *at;
    bool joined = true;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        bool has_before = ring && !(columns[c].absent & there);
        uint64_t last = before;
        before += has_before;
        joined = joined && (c == 0 || columns[c - 1].joins_next);
        if (columns[c].absent & here)
            continue;
        MesoVec2 *to = &out[*at];
        *to = *at == begin ? (MesoVec2){0, 0} : to[-1];
        if (*at > begin && joined)
            to->x += distance(&vertices[*at - 1], &vertices[*at]);
        if (has_before)
            to->y = out[last].y + distance(&vertices[last], &vertices[*at]);
        joined = true;
        ++*at;
    }
}

void meso_surface_lengths(const MesoSceneParts *parts, uint32_t part, const MesoMeshVertex *vertices, MesoVec2 *out)
{
    const MesoScene *scene = parts->scene;
    if (part >= scene->sweep_count) {
        for (uint64_t i = 0; i < parts->vertex_begin[part + 1] - parts->vertex_begin[part]; i++)
            out[i] = vertices[i].uv;
        return;
    }
    const MesoSweptKind *kind = &scene->kinds[meso_scene_kind(scene, part)];
    uint64_t before = 0, at = 0;
    for (uint32_t ring = 0; ring < kind->division_count; ring++) {
        uint64_t begin = at;
        measure_ring(out, vertices, scene->columns + kind->column_begin, kind, ring, before, &at);
        before = begin;
    }
}

/* ---- tangents ---- */

/* Adds where u grows, as long as the triangle is large, and in w the sign of its area in texture coordinates. */
static void add_triangle(const MesoMeshVertex *vertices, const uint32_t v[3], MesoTangent *out)
{
    const MesoMeshVertex *a = &vertices[v[0]], *b = &vertices[v[1]], *c = &vertices[v[2]];
    MesoVec3 p = meso_vec3_sub(b->position, a->position), q = meso_vec3_sub(c->position, a->position);
    MesoVec2 s = meso_vec2_sub(b->uv, a->uv), t = meso_vec2_sub(c->uv, a->uv);
    float area = s.x * t.y - t.x * s.y;
    float size = meso_vec3_length(meso_vec3_cross(p, q));
    MesoVec3 along = meso_vec3_sub(meso_vec3_scale(p, t.y), meso_vec3_scale(q, s.y));
    float length = meso_vec3_length(along);
    if (!(fabsf(area) > 0) || !(length > 0))
        return;
    along = meso_vec3_scale(along, (area < 0 ? -size : size) / length);
    for (int k = 0; k < 3; k++) {
        MesoTangent *to = &out[v[k]];
        *to = (MesoTangent){to->x + along.x, to->y + along.y, to->z + along.z, to->w + (area < 0 ? -size : size)};
    }
}

/* Without the part along the normal, and unit; any across the normal for what is none. */
static MesoTangent finished(MesoTangent sum, MesoVec3 normal)
{
    MesoVec3 axis = fabsf(normal.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 any = meso_vec3_unit(meso_vec3_cross(axis, normal), axis), t = {sum.x, sum.y, sum.z};
    t = meso_vec3_unit(t, any);
    t = meso_vec3_mad(t, -meso_vec3_dot(t, normal), normal);
    t = meso_vec3_length(t) > 1e-3f ? meso_vec3_unit(t, any) : any;     /* shorter, rounding gives its direction */
    return (MesoTangent){t.x, t.y, t.z, sum.w < 0 ? -1 : 1};
}

void meso_surface_tangents(uint64_t vertex_count, const MesoMeshVertex *vertices, uint64_t face_count,
                           const MesoMeshFace *faces, MesoTangent *out)
{
    memset(out, 0, vertex_count * sizeof *out);
    for (uint64_t f = 0; f < face_count; f++) {
        const uint32_t *v = faces[f].v;
        add_triangle(vertices, (const uint32_t[]){v[0], v[1], v[2]}, out);
        if (v[3] != MESO_NO_INDEX)
            add_triangle(vertices, (const uint32_t[]){v[0], v[2], v[3]}, out);
    }
    for (uint64_t i = 0; i < vertex_count; i++)
        out[i] = finished(out[i], vertices[i].normal);
}
