#include "libcore/quilt/check/check_window.h"

#include "libcore/quilt/match/triangle_distance.h"

float meso_window_border(const MesoSwatch *swatch)
{
    float most = 0;
    for (uint32_t e = 0; e < swatch->element_count; e++)
        most = swatch->kinds[e] == MESO_ELEMENT_WHOLE ? fmaxf(most, 2 * swatch->radii[e]) : most;
    return most;
}

MesoStatus meso_window_init(MesoWindow *window, MesoArena *arena, uint32_t triangle_count, float radius, float reach,
                            uint32_t *locals, MesoError *error)
{
    *window = (MesoWindow){.radius = radius, .reach = reach, .locals = locals};
    window->points = MESO_NEW(arena, MesoMatchPoint, 3 * (size_t)triangle_count, error);
    window->vertices = MESO_NEW(arena, uint32_t, 3 * (size_t)triangle_count, error);
    window->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)triangle_count, error);
    window->inside = MESO_NEW(arena, uint32_t, 3 * (size_t)triangle_count, error);
    return window->points && window->vertices && window->corners && window->inside ? MESO_OK : MESO_ERR_MEMORY;
}

static bool is_within(MesoVec3 p, float radius)
{
    return p.x * p.x + p.y * p.y <= radius * radius;
}

void meso_window_add(MesoWindow *window, const uint32_t *vertices, const MesoVec3 *places)
{
    if (!is_within(places[0], window->reach) && !is_within(places[1], window->reach) &&
        !is_within(places[2], window->reach))
        return;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t *local = &window->locals[vertices[k]];
        if (*local == MESO_NO_INDEX) {
            *local = window->point_count++;
            window->points[*local].position = places[k];
            window->vertices[*local] = vertices[k];
        }
        window->corners[3 * window->triangle_count + k] = *local;
    }
    window->triangle_count++;
}

static void add_normals(MesoWindow *window)
{
    MesoMatchPoint *points = window->points;
    for (uint32_t t = 0; t < window->triangle_count; t++) {
        const uint32_t *v = &window->corners[3 * (size_t)t];
        MesoVec3 a = points[v[0]].position, b = meso_vec3_sub(points[v[1]].position, a);
        MesoVec3 area = meso_vec3_cross(b, meso_vec3_sub(points[v[2]].position, a));
        for (int k = 0; k < 3; k++)
            points[v[k]].normal = meso_vec3_add(points[v[k]].normal, area);
    }
    for (uint32_t i = 0; i < window->point_count; i++)
        points[i].normal = meso_vec3_direction(points[i].normal, (MesoVec3){0, 0, 1});
}

void meso_window_finish(MesoWindow *window)
{
    add_normals(window);
    for (uint32_t i = 0; i < window->point_count; i++) {
        window->locals[window->vertices[i]] = MESO_NO_INDEX;
        if (is_within(window->points[i].position, window->radius))
            window->inside[window->inside_count++] = i;
    }
}

/* ---- the nearest triangle ---- */

MesoStatus meso_nearest_mesh_build(MesoNearestMesh *mesh, MesoArena *arena, const MesoMatchPoint *points,
                                   const uint32_t *corners, uint32_t triangle_count, MesoError *error)
{
    *mesh = (MesoNearestMesh){.points = points, .corners = corners};
    MesoBox *boxes = MESO_NEW(arena, MesoBox, triangle_count, error);
    if (!boxes)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < triangle_count; t++) {
        const uint32_t *v = &corners[3 * (size_t)t];
        const MesoVec3 places[3] = {points[v[0]].position, points[v[1]].position, points[v[2]].position};
        boxes[t] = meso_box_of(places, 3);
    }
    return meso_box_tree_build(&mesh->tree, arena, boxes, triangle_count, error);
}

typedef struct Probe {
    const MesoNearestMesh *mesh;
    MesoVec3 point;
    float square;
} Probe;

static void probe_triangle(void *context, uint32_t triangle)
{
    Probe *probe = context;
    const uint32_t *v = &probe->mesh->corners[3 * (size_t)triangle];
    const MesoMatchPoint *p = probe->mesh->points;
    float square = meso_triangle_square(probe->point, p[v[0]].position, p[v[1]].position, p[v[2]].position);
    probe->square = square < probe->square ? square : probe->square;
}

/* Boxes around the point grow until what is found lies within one. */
float meso_nearest_distance(const MesoNearestMesh *mesh, MesoVec3 point, float most)
{
    Probe probe = {.mesh = mesh, .point = point, .square = most * most};
    for (float size = most / 64; size < 2 * most; size *= 2) {
        MesoBox box = meso_box_empty();
        meso_box_add_around(&box, point, size);
        meso_box_tree_query(&mesh->tree, box, probe_triangle, &probe);
        if (probe.square <= size * size)
            break;
    }
    return sqrtf(probe.square);
}
