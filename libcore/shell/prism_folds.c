#include "libcore/shell/prism_layer.h"

/* ---- tetrahedra ---- */

/* Vertices a < b < c: a wall is cut from the lower corner of the lesser vertex to the upper of the greater. */
void meso_prism_split(const uint32_t vertices[3], uint8_t tetrahedra[3][4])
{
    uint8_t a = 0, b = 1, c = 2;
    bool odd = false;
    for (uint32_t pass = 0; pass < 3; pass++) {
        uint8_t *first = pass == 1 ? &b : &a, *second = pass == 1 ? &c : &b;
        if (vertices[*first] > vertices[*second]) {
            uint8_t kept = *first;
            *first = *second;
            *second = kept;
            odd = !odd;
        }
    }
    const uint8_t split[3][4] = {{a, b, c, (uint8_t)(c + 3)},
                                 {a, b, (uint8_t)(c + 3), (uint8_t)(b + 3)},
                                 {a, (uint8_t)(b + 3), (uint8_t)(c + 3), (uint8_t)(a + 3)}};
    for (uint32_t t = 0; t < 3; t++)
        for (uint32_t k = 0; k < 4; k++)
            tetrahedra[t][k] = split[t][odd && k > 0 && k < 3 ? 3 - k : k];
}

/* ---- normals ---- */

/* The least share of a direction along the normals of the triangles around a vertex; and the triangle. */
static double least_share(const MesoPrismLayer *layer, uint32_t vertex, MesoVec3d direction, uint32_t *least)
{
    MesoFan fan = meso_fan_first(layer->mesh, vertex);
    uint32_t first = fan.corner;
    double share = INFINITY;
    do {
        uint32_t t = fan.corner / 3;
        if (layer->flat[t])
            continue;
        MesoVec3d base = meso_prism_base(layer->mesh, t);
        double s = meso_vec3d_dot(base, direction) / layer->areas[t];
        if (s < share) {
            share = s;
            *least = t;
        }
    } while (meso_fan_next(layer->mesh, &fan) && fan.corner != first);
    return share;
}

/* A direction that all triangles face: from the mean normal towards those that face it least. 0 where there is none. */
static MesoVec3d facing_direction(const MesoPrismLayer *layer, uint32_t vertex, MesoVec3d mean)
{
    enum { STEPS = 64 };
    const double enough = 0.1;
    MesoVec3d best = {0, 0, 0}, at = mean;
    double best_share = MESO_PRISM_MARGIN * 1.5;
    for (uint32_t step = 0; step < STEPS; step++) {
        uint32_t least = 0;
        double length = meso_vec3d_length(at);
        MesoVec3d unit = length > 0 ? meso_vec3d_scale(at, 1 / length) : at;
        double share = least_share(layer, vertex, unit, &least);
        if (share == INFINITY)
            break;
        if (share > best_share) {
            best_share = share;
            best = unit;
        }
        if (share > enough)
            break;
        MesoVec3d base = meso_prism_base(layer->mesh, least);
        at = meso_vec3d_mad(unit, 0.25 / (1 + 0.1 * step) / layer->areas[least], base);
    }
    return best;
}

/* How long a direction must be so that the lids around are as high as wanted, in the mean of their areas. */
static double mean_thickness(const MesoPrismLayer *layer, uint32_t vertex)
{
    const double most = 2;
    MesoFan fan = meso_fan_first(layer->mesh, vertex);
    uint32_t first = fan.corner;
    double once = 0, twice = 0;
    do {
        MesoVec3d base = meso_prism_base(layer->mesh, fan.corner / 3);
        double area = layer->areas[fan.corner / 3], along = meso_vec3d_dot(base, layer->normals[vertex]);
        if (area > 0) {
            once += along;
            twice += along * along / area;
        }
    } while (meso_fan_next(layer->mesh, &fan) && fan.corner != first);
    return once > 0 && twice > 0 ? fmin(once / twice, most) : 1;
}

static bool is_flat(const MesoTriangulation *mesh, uint32_t triangle, double area)
{
    const double thinnest = 1e-5;
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    double longest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3d side = meso_vec3d_sub(meso_vec3d(mesh->positions[v[k]]), meso_vec3d(mesh->positions[v[(k + 1) % 3]]));
        longest = fmax(longest, meso_vec3d_dot(side, side));
    }
    return !(area > thinnest * longest);
}

void meso_prism_normals(MesoPrismLayer *layer)
{
    const MesoTriangulation *mesh = layer->mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        layer->normals[v] = (MesoVec3d){0, 0, 0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        MesoVec3d base = meso_prism_base(mesh, t);
        layer->areas[t] = meso_vec3d_length(base);
        layer->flat[t] = is_flat(mesh, t, layer->areas[t]);
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3d *sum = &layer->normals[mesh->corners[3 * (size_t)t + k]];
            *sum = meso_vec3d_add(*sum, base);
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3d mean = layer->normals[v];
        layer->normals[v] = (MesoVec3d){0, 0, 0};
        layer->thickness[v] = 1;
        if (mesh->vertex_corner[v] != MESO_NO_INDEX) {
            layer->normals[v] = facing_direction(layer, v, mean);
            layer->thickness[v] = mean_thickness(layer, v);
        }
        layer->rises[v] = meso_vec3d_scale(layer->normals[v], layer->thickness[v]);
    }
}

void meso_prism_face(MesoPrismLayer *layer)
{
    enum { STEPS = 8 };
    const double enough = 0.1;
    for (uint32_t v = 0; v < layer->mesh->vertex_count; v++) {
        MesoVec3d upright = meso_vec3d_scale(layer->normals[v], meso_vec3d_dot(layer->rises[v], layer->normals[v]));
        for (uint32_t step = 0; step < STEPS && layer->mesh->vertex_corner[v] != MESO_NO_INDEX; step++) {
            uint32_t least;
            if (least_share(layer, v, layer->rises[v], &least) > enough * meso_vec3d_length(layer->rises[v]))
                break;
            MesoVec3d half = meso_vec3d_scale(meso_vec3d_add(layer->rises[v], upright), 0.5);
            layer->rises[v] = step + 1 < STEPS ? half : upright;
        }
    }
}

/* ---- folds ---- */

/* Of the lowest and of the highest height. */
typedef double Two __attribute__((vector_size(16)));
typedef int64_t TwoBits __attribute__((vector_size(16)));

typedef struct Side {
    Two x, y, z;
} Side;

static inline Side side_of(const MesoPrismLayer *layer, uint32_t from, uint32_t to)
{
    const Two heights = {layer->low, layer->high};
    MesoVec3d flat = meso_vec3d_sub(meso_vec3d(layer->mesh->positions[to]), meso_vec3d(layer->mesh->positions[from]));
    MesoVec3d more = meso_vec3d_sub(layer->rises[to], layer->rises[from]);
    return (Side){flat.x + heights * more.x, flat.y + heights * more.y, flat.z + heights * more.z};
}

/* Whether `rise`, `before` at one height and `after` at one have a determinant of `least` or more, at all heights. */
static inline bool stands_at(MesoVec3d rise, Side before, Side after, double least)
{
    Two x = rise.y * before.z - rise.z * before.y, y = rise.z * before.x - rise.x * before.z;
    Two z = rise.x * before.y - rise.y * before.x;
    Two same = x * after.x + y * after.y + z * after.z;
    x = (Two){x[1], x[0]}, y = (Two){y[1], y[0]}, z = (Two){z[1], z[0]};
    TwoBits all = (same >= least) & (x * after.x + y * after.y + z * after.z >= least);
    return all[0] & all[1];
}

/*
 * At corner b with a before and c after it, a tetrahedron of a split has three of its sides along X_b(h) - X_a(h),
 * X_c(k) - X_b(k) and d_b, for two heights h and k. Their determinant is linear in h and in k, so that it is positive
 * for all of them where it is at the four pairs of the lowest and the highest.
 */
bool meso_prism_stands(const MesoPrismLayer *layer, uint32_t triangle, double margin)
{
    if (layer->flat[triangle])
        return true;
    const uint32_t *v = &layer->mesh->corners[3 * (size_t)triangle];
    Side sides[3];
    for (uint32_t k = 0; k < 3; k++)
        sides[k] = side_of(layer, v[k], v[(k + 1) % 3]);
    double area = layer->areas[triangle];
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3d rise = layer->rises[v[k]];
        if (!stands_at(rise, sides[(k + 2) % 3], sides[k], margin * area * meso_vec3d_length(rise)))
            return false;
    }
    return true;
}

bool meso_prism_ring_stands(const MesoPrismLayer *layer, uint32_t vertex, double margin)
{
    if (layer->mesh->vertex_corner[vertex] == MESO_NO_INDEX)
        return true;
    MesoFan fan = meso_fan_first(layer->mesh, vertex);
    uint32_t first = fan.corner;
    do {
        if (!meso_prism_stands(layer, fan.corner / 3, margin))
            return false;
    } while (meso_fan_next(layer->mesh, &fan) && fan.corner != first);
    return true;
}

/* Triangles to look at, each at most once in the queue. */
typedef struct Queue {
    uint32_t *ring;         /* [room] */
    uint8_t *waits;         /* [room] */
    uint32_t room, first, count;
} Queue;

static void push(Queue *queue, uint32_t triangle)
{
    if (queue->waits[triangle])
        return;
    queue->waits[triangle] = 1;
    queue->ring[(queue->first + (uint64_t)queue->count++) % queue->room] = triangle;
}

static uint32_t pop(Queue *queue)
{
    uint32_t triangle = queue->ring[queue->first];
    queue->waits[triangle] = 0;
    queue->first = (queue->first + 1) % queue->room;
    queue->count--;
    return triangle;
}

/* A direction below the least share of its length goes, and with it all that it can fold. */
static void lower_vertex(MesoPrismLayer *layer, Queue *queue, uint32_t vertex)
{
    const double step = 0.85, least = 1e-6;
    MesoVec3d lowered = meso_vec3d_scale(layer->rises[vertex], step);
    if (meso_vec3d_length(lowered) < least)
        lowered = (MesoVec3d){0, 0, 0};
    layer->rises[vertex] = lowered;
    MesoFan fan = meso_fan_first(layer->mesh, vertex);
    uint32_t first = fan.corner;
    do
        push(queue, fan.corner / 3);
    while (meso_fan_next(layer->mesh, &fan) && fan.corner != first);
}

/* Longer again by bisection, as far as the prisms around stand. */
static void raise_vertex(MesoPrismLayer *layer, uint32_t vertex)
{
    enum { STEPS = 5 };
    MesoVec3d low = layer->rises[vertex], full = meso_vec3d_scale(layer->normals[vertex], layer->thickness[vertex]);
    double height = meso_vec3d_dot(low, layer->normals[vertex]);
    if (height > 0)
        full = meso_vec3d_scale(low, layer->thickness[vertex] / height);
    MesoVec3d more = meso_vec3d_sub(full, low);
    double stands = 0;
    for (double step = 1; step > 1.0 / (1 << STEPS); step /= 2) {
        double to = fmin(stands + step, 1);
        layer->rises[vertex] = meso_vec3d_mad(low, to, more);
        if (meso_prism_ring_stands(layer, vertex, MESO_PRISM_MARGIN))
            stands = to;
        if (stands == 1)
            break;
    }
    layer->rises[vertex] = meso_vec3d_mad(low, stands, more);
}

static bool is_marked(const MesoTriangulation *mesh, const uint8_t *marked, uint32_t triangle)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    return !marked || marked[v[0]] || marked[v[1]] || marked[v[2]];
}

MesoStatus meso_prism_lower_folds(MesoPrismLayer *layer, const uint8_t *marked, MesoArena *scratch, MesoError *error)
{
    const MesoTriangulation *mesh = layer->mesh;
    MesoArenaMark mark = meso_arena_mark(scratch);
    Queue queue = {MESO_NEW(scratch, uint32_t, mesh->triangle_count, error),
                   MESO_NEW(scratch, uint8_t, mesh->triangle_count, error), mesh->triangle_count, 0, 0};
    if (!queue.ring || !queue.waits)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (is_marked(mesh, marked, t))
            push(&queue, t);
    while (queue.count > 0) {
        uint32_t t = pop(&queue);
        for (uint32_t k = 0; k < 3 && !meso_prism_stands(layer, t, MESO_PRISM_MARGIN); k++)
            lower_vertex(layer, &queue, mesh->corners[3 * (size_t)t + k]);
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

void meso_prism_raise(MesoPrismLayer *layer)
{
    for (uint32_t pass = 0; pass < 2; pass++)
        for (uint32_t v = 0; v < layer->mesh->vertex_count; v++)
            if (meso_vec3d_dot(layer->rises[v], layer->normals[v]) < 0.9999 * layer->thickness[v])
                raise_vertex(layer, v);
}
