#include "libcore/base/grow.h"
#include "libcore/quilt/finish/finish_work.h"

/* Steps of a walk at most: points to be found are next to where it begins. */
enum { WALK_LIMIT = 256 };

MesoStatus meso_finish_reserve(MesoFinishWork *work, uint64_t vertex_count, uint64_t triangle_count, MesoError *error)
{
    if (vertex_count > MESO_NO_INDEX / 3 || triangle_count > MESO_NO_INDEX / 3)
        return meso_fail(error, MESO_ERR_LIMIT, "the quilt has more than %u triangles", MESO_NO_INDEX / 3);
    size_t vertices = vertex_count + 1, triangles = triangle_count + 1;
    if (vertices <= work->vertex_room && triangles <= work->triangle_room)
        return MESO_OK;
    uint32_t v = work->vertex_count, t = work->triangle_count;
#define ENLARGE(array, count, room, width) \
    (work->array = meso_arena_enlarge(work->arena, work->array, (width) * (size_t)(count), (width) * (room), \
                                      sizeof *work->array, error))
    if (!ENLARGE(vertices, v, vertices, 1) || !ENLARGE(origins, v, vertices, 1) ||
        !ENLARGE(at_border, v, vertices, 1) || !ENLARGE(corners, t, triangles, 3) ||
        !ENLARGE(triangle_origins, t, triangles, 1) || !ENLARGE(patches, t, triangles, 1) ||
        !ENLARGE(elements, t, triangles, 1))
        return MESO_ERR_MEMORY;
#undef ENLARGE
    work->vertex_room = (uint32_t)vertices;
    work->triangle_room = (uint32_t)triangles;
    return MESO_OK;
}

uint32_t meso_finish_add_vertex(MesoFinishWork *work, MesoQuiltVertex vertex, uint32_t origin, bool at_border)
{
    uint32_t v = work->vertex_count++;
    work->vertices[v] = vertex;
    work->origins[v] = origin;
    work->at_border[v] = at_border;
    return v;
}

void meso_finish_add_triangle(MesoFinishWork *work, const uint32_t *corners, uint32_t origin, uint32_t patch,
                              uint32_t element)
{
    uint32_t t = work->triangle_count++;
    memcpy(&work->corners[3 * (size_t)t], corners, 3 * sizeof *corners);
    work->triangle_origins[t] = origin;
    work->patches[t] = patch;
    work->elements[t] = element;
}

static const uint32_t *corners_of(const MesoFinishWork *work, uint32_t triangle)
{
    return &work->base->mesh.corners[3 * (size_t)triangle];
}

MesoVec3 meso_finish_foot(const MesoFinishWork *work, MesoQuiltVertex vertex)
{
    const uint32_t *corner = corners_of(work, vertex.triangle);
    const MesoVec3 *positions = work->base->mesh.positions;
    MesoVec3 p = meso_vec3_scale(positions[corner[0]], 1 - vertex.b1 - vertex.b2);
    p = meso_vec3_mad(p, vertex.b1, positions[corner[1]]);
    return meso_vec3_mad(p, vertex.b2, positions[corner[2]]);
}

MesoVec3 meso_finish_point(const MesoFinishWork *work, MesoQuiltVertex vertex)
{
    const uint32_t *corner = corners_of(work, vertex.triangle);
    MesoVec3 n = meso_vec3_scale(work->normals[corner[0]], 1 - vertex.b1 - vertex.b2);
    n = meso_vec3_mad(n, vertex.b1, work->normals[corner[1]]);
    n = meso_vec3_mad(n, vertex.b2, work->normals[corner[2]]);
    return meso_vec3_mad(meso_finish_foot(work, vertex), vertex.height, n);
}

MesoQuiltVertex meso_finish_original(const MesoFinishWork *work, MesoQuiltVertex vertex)
{
    const MesoVec2 *corner = &work->base->corner_weights[3 * (size_t)vertex.triangle];
    float b0 = 1 - vertex.b1 - vertex.b2;
    return (MesoQuiltVertex){work->base->triangles[vertex.triangle],
                             b0 * corner[0].x + vertex.b1 * corner[1].x + vertex.b2 * corner[2].x,
                             b0 * corner[0].y + vertex.b1 * corner[1].y + vertex.b2 * corner[2].y, vertex.height};
}

float meso_finish_inside(const MesoFinishWork *work, MesoQuiltVertex vertex)
{
    const float *inside = work->base->inside;
    if (!inside)
        return 1;
    const uint32_t *corner = corners_of(work, vertex.triangle);
    return (1 - vertex.b1 - vertex.b2) * inside[corner[0]] + vertex.b1 * inside[corner[1]] +
           vertex.b2 * inside[corner[2]];
}

/* Weights of a triangle's corners at the foot of a point in its plane. */
static void weigh(double weight[3], const MesoFinishWork *work, uint32_t triangle, MesoVec3 point)
{
    const uint32_t *corner = corners_of(work, triangle);
    const MesoVec3 *positions = work->base->mesh.positions;
    MesoVec3 o = positions[corner[0]], p = meso_vec3_sub(point, o);
    MesoVec3 a = meso_vec3_sub(positions[corner[1]], o), b = meso_vec3_sub(positions[corner[2]], o);
    double aa = meso_vec3_dot(a, a), ab = meso_vec3_dot(a, b), bb = meso_vec3_dot(b, b);
    double pa = meso_vec3_dot(p, a), pb = meso_vec3_dot(p, b), area = aa * bb - ab * ab;
    weight[1] = area > 0 ? (pa * bb - pb * ab) / area : 1.0 / 3;
    weight[2] = area > 0 ? (pb * aa - pa * ab) / area : 1.0 / 3;
    weight[0] = 1 - weight[1] - weight[2];
}

static MesoQuiltVertex clamped(uint32_t triangle, const double weight[3], float height)
{
    double w[3], sum = 0;
    for (int k = 0; k < 3; k++)
        sum += w[k] = weight[k] > 0 ? weight[k] : 0;
    return (MesoQuiltVertex){triangle, (float)(w[1] / sum), (float)(w[2] / sum), height};
}

MesoQuiltVertex meso_finish_locate(const MesoFinishWork *work, uint32_t triangle, MesoVec3 foot, float height)
{
    uint32_t before = MESO_NO_INDEX;
    double weight[3];
    for (int step = 0;; step++) {
        weigh(weight, work, triangle, foot);
        uint32_t least = weight[1] < weight[0] ? 1 : 0;
        least = weight[2] < weight[least] ? 2 : least;
        /* the side across from the corner with the least weight leads there */
        uint32_t across = work->base->mesh.twins[3 * triangle + (least + 1) % 3];
        if (weight[least] >= 0 || across == MESO_NO_INDEX || across / 3 == before || step == WALK_LIMIT)
            return clamped(triangle, weight, height);
        before = triangle;
        triangle = across / 3;
    }
}
