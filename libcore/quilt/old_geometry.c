/* The quilt over a chart, in its plane. */
#include "libcore/base/grow.h"
#include "libcore/quilt/quilt_work.h"

static uint32_t count_listed(const MesoQuiltWork *work, const MesoChart *chart, uint32_t *wholes)
{
    const MesoComposite *c = &work->composite;
    uint32_t triangles = 0;
    *wholes = 0;
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        for (uint32_t t = c->triangle_head[chart->triangles[i]]; t != MESO_NO_INDEX; t = c->next[t])
            triangles++;
        for (uint32_t w = c->whole_head[chart->triangles[i]]; w != MESO_NO_INDEX; w = c->wholes[w].next)
            ++*wholes;
    }
    return triangles;
}

/* Room for so many vertices; what is there stays. */
static MesoStatus reserve(MesoOldGeometry *old, uint32_t *room, uint32_t wanted, MesoArena *arena, MesoError *error)
{
    uint32_t count = old->vertex_count;
    uint32_t *vertices = meso_arena_enlarge(arena, old->vertices, count, wanted, sizeof *vertices, error);
    MesoVec3 *positions = meso_arena_enlarge(arena, old->positions, count, wanted, sizeof *positions, error);
    MesoVec3 *normals = meso_arena_enlarge(arena, old->normals, count, wanted, sizeof *normals, error);
    if (!vertices || !positions || !normals)
        return MESO_ERR_MEMORY;
    old->vertices = vertices;
    old->positions = positions;
    old->normals = normals;
    *room = wanted;
    return MESO_OK;
}

/* Number of a vertex in the step; MESO_NO_INDEX where it lies outside of the chart. There has to be room. */
static uint32_t load_vertex(MesoOldGeometry *old, const MesoQuiltStep *step, MesoComposite *composite, uint32_t vertex)
{
    uint32_t *mark = &composite->marks[vertex];
    if (*mark == MESO_NO_INDEX) {
        MesoVec3 point;
        if (!meso_quilt_plane_to(&step->plane, composite->vertices[vertex], &point))
            return MESO_NO_INDEX;
        *mark = old->vertex_count;
        old->vertices[*mark] = vertex;
        old->positions[*mark] = point;
        old->vertex_count++;
    }
    return *mark;
}

static void load_triangle(MesoOldGeometry *old, const MesoQuiltStep *step, MesoComposite *composite, uint32_t triangle)
{
    uint32_t *to = &old->corners[3 * (size_t)old->triangle_count];
    for (size_t k = 0; k < 3; k++) {
        to[k] = load_vertex(old, step, composite, composite->corners[3 * (size_t)triangle + k]);
        if (to[k] == MESO_NO_INDEX)
            return;     /* it reaches out of the chart, where nothing is changed */
    }
    MesoVec3 a = old->positions[to[0]];
    MesoVec3 area = meso_vec3_cross(meso_vec3_sub(old->positions[to[1]], a), meso_vec3_sub(old->positions[to[2]], a));
    for (size_t k = 0; k < 3; k++)
        old->normals[to[k]] = meso_vec3_add(old->normals[to[k]], area);
    old->triangles[old->triangle_count++] = triangle;
}

MesoStatus meso_old_geometry_load(MesoQuiltStep *step, MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoOldGeometry *old = &step->old;
    MesoComposite *composite = &work->composite;
    const MesoChart *chart = &step->chart;
    *old = (MesoOldGeometry){0};
    for (uint32_t i = 0; i < chart->triangle_count; i++)
        meso_composite_tidy(composite, chart->triangles[i]);
    uint32_t wholes, triangles = count_listed(work, chart, &wholes);
    old->triangles = MESO_NEW(arena, uint32_t, triangles, error);
    old->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)triangles, error);
    old->wholes = MESO_NEW(arena, uint32_t, wholes, error);
    old->centres = MESO_NEW(arena, MesoVec3, wholes, error);
    /* of meshes that close there are half as many vertices as triangles */
    uint32_t room = 0;
    MesoStatus status = reserve(old, &room, triangles / 2 + triangles / 8 + 64, arena, error);
    if (!old->triangles || !old->corners || !old->wholes || !old->centres || status)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        uint32_t under = chart->triangles[i];
        for (uint32_t t = composite->triangle_head[under]; t != MESO_NO_INDEX; t = composite->next[t]) {
            if (room - old->vertex_count < 3 && (status = reserve(old, &room, 2 * room, arena, error)))
                return status;
            load_triangle(old, step, composite, t);
        }
        for (uint32_t w = composite->whole_head[under]; w != MESO_NO_INDEX; w = composite->wholes[w].next) {
            meso_quilt_plane_to(&step->plane, composite->wholes[w].centre, &old->centres[old->whole_count]);
            old->wholes[old->whole_count++] = w;
        }
    }
    for (uint32_t v = 0; v < old->vertex_count; v++)
        old->normals[v] = meso_vec3_unit(old->normals[v], (MesoVec3){0, 0, 1});
    return MESO_OK;
}

void meso_old_geometry_forget(const MesoQuiltStep *step, MesoQuiltWork *work)
{
    for (uint32_t v = 0; v < step->old.vertex_count; v++)
        work->composite.marks[step->old.vertices[v]] = MESO_NO_INDEX;
}
