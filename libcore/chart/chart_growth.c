#include "libcore/chart/chart_growth.h"

#include "libcore/chart/key_heap.h"

/* Vertices reached, by their numbers in the flood. */
typedef struct Flood {
    uint32_t count, room;
    uint32_t *vertices;     /* [count] of the mesh */
    double *distances;      /* [count] */
    uint32_t *chart_vertices;   /* [count] their numbers in the growth */
    uint8_t *settled;       /* [count] 1: the distance is final */
} Flood;

typedef struct Grower {
    const MesoTriangulation *mesh;
    MesoChartMaker *maker;
    MesoChartGrowth *growth;
    MesoArena *arena;
    Flood flood;
    double radius;
    MesoError *error;
} Grower;

/* ---- distances ---- */

static double distance_between(MesoVec3 a, MesoVec3 b)
{
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    return sqrt(x * x + y * y + z * z);
}

static MesoStatus enlarge_flood(Grower *grower)
{
    Flood *flood = &grower->flood;
    uint32_t count = flood->count, room = count ? 2 * count : 256;
    MesoArena *arena = grower->arena;
    flood->vertices = meso_arena_enlarge(arena, flood->vertices, count, room, sizeof *flood->vertices, grower->error);
    flood->distances = meso_arena_enlarge(arena, flood->distances, count, room, sizeof *flood->distances,
                                          grower->error);
    flood->settled = meso_arena_enlarge(arena, flood->settled, count, room, sizeof *flood->settled, grower->error);
    flood->room = room;
    return flood->vertices && flood->distances && flood->settled ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus reach_vertex(Grower *grower, MesoKeyHeap *heap, uint32_t vertex, double distance)
{
    Flood *flood = &grower->flood;
    uint32_t *number = &grower->maker->vertex_numbers[vertex];
    if (*number == MESO_NO_INDEX) {
        if (flood->count == flood->room && enlarge_flood(grower))
            return MESO_ERR_MEMORY;
        *number = flood->count++;
        flood->vertices[*number] = vertex;
        flood->distances[*number] = INFINITY;
    }
    if (flood->settled[*number] || !(distance < flood->distances[*number]))
        return MESO_OK;
    flood->distances[*number] = distance;
    return meso_heap_push(heap, grower->arena, distance, *number, grower->error);
}

/*
 * The distance of `x` by a straight line across side a b, to whose ends it is `da` and `db`: the source is unfolded to
 * the plane of the triangle. Infinite where the line does not cross the side.
 */
static double distance_across(MesoVec3 a, MesoVec3 b, MesoVec3 x, double da, double db)
{
    double length = distance_between(a, b), ax = distance_between(a, x), bx = distance_between(b, x);
    if (!(length > 0))
        return INFINITY;
    double along = (ax * ax - bx * bx + length * length) / (2 * length), up = ax * ax - along * along;
    double from = (da * da - db * db + length * length) / (2 * length), down = da * da - from * from;
    if (!(up > 0 && down >= 0))
        return INFINITY;
    up = sqrt(up);
    down = sqrt(down);
    double crossing = from + (along - from) * (down / (up + down));
    if (crossing < 0 || crossing > length)
        return INFINITY;
    return sqrt((along - from) * (along - from) + (up + down) * (up + down));
}

/* From a vertex whose distance is settled to the two others of a triangle. */
static MesoStatus spread_in_triangle(Grower *grower, MesoKeyHeap *heap, uint32_t corner)
{
    const MesoTriangulation *mesh = grower->mesh;
    uint32_t vertex = mesh->corners[corner];
    uint32_t others[2] = {mesh->corners[meso_next_corner(corner)], mesh->corners[meso_previous_corner(corner)]};
    double here = grower->flood.distances[grower->maker->vertex_numbers[vertex]];
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 2 && !status; k++) {
        MesoVec3 a = mesh->positions[vertex], b = mesh->positions[others[1 - k]], x = mesh->positions[others[k]];
        double distance = here + distance_between(a, x);
        uint32_t number = grower->maker->vertex_numbers[others[1 - k]];
        if (number != MESO_NO_INDEX && grower->flood.settled[number])
            distance = fmin(distance, distance_across(a, b, x, here, grower->flood.distances[number]));
        if (distance <= grower->radius)
            status = reach_vertex(grower, heap, others[k], distance);
    }
    return status;
}

static MesoStatus spread_from(Grower *grower, MesoKeyHeap *heap, uint32_t vertex)
{
    MesoFan fan = meso_fan_first(grower->mesh, vertex);
    uint32_t first = fan.corner;
    MesoStatus status;
    do {
        status = spread_in_triangle(grower, heap, fan.corner);
    } while (!status && meso_fan_next(grower->mesh, &fan) && fan.corner != first);
    return status;
}

static MesoStatus flood_vertices(Grower *grower, uint32_t seed)
{
    const MesoTriangulation *mesh = grower->mesh;
    const uint32_t *corners = &mesh->corners[3 * (size_t)seed];
    MesoKeyHeap heap = {0};
    MesoVec3 centre = meso_vec3_add(meso_vec3_add(mesh->positions[corners[0]], mesh->positions[corners[1]]),
                                    mesh->positions[corners[2]]);
    centre = meso_vec3_scale(centre, 1.0f / 3);
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++)
        status = reach_vertex(grower, &heap, corners[k], distance_between(centre, mesh->positions[corners[k]]));
    while (!status && heap.count) {
        uint32_t number = meso_heap_pop(&heap).item;
        if (grower->flood.settled[number])
            continue;
        grower->flood.settled[number] = 1;
        status = spread_from(grower, &heap, grower->flood.vertices[number]);
    }
    return status;
}

/* The farthest vertex of a triangle; infinite beyond the radius. */
static double triangle_distance(const Grower *grower, uint32_t triangle)
{
    double farthest = 0;
    for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; c++) {
        uint32_t number = grower->maker->vertex_numbers[grower->mesh->corners[c]];
        farthest = fmax(farthest, number == MESO_NO_INDEX ? INFINITY : grower->flood.distances[number]);
    }
    return farthest;
}

/* ---- triangles ---- */

static bool in_growth(const Grower *grower, uint32_t half_edge)
{
    return half_edge != MESO_NO_INDEX && grower->maker->triangle_numbers[half_edge / 3] != MESO_NO_INDEX;
}

/*
 * Whether the disk stays a disk: a triangle at one side of it brings a new vertex, one at two sides fills a notch of
 * the border. One at three would close a sphere, one at a side and a vertex across a ring.
 */
static bool keeps_disk(const Grower *grower, uint32_t triangle)
{
    const MesoTriangulation *mesh = grower->mesh;
    uint32_t shared = 0, opposite = 0;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++)
        if (in_growth(grower, meso_chart_across(mesh, h))) {
            shared++;
            opposite = mesh->corners[meso_previous_corner(h)];
        }
    if (shared != 1)
        return shared == 2;
    return grower->flood.chart_vertices[grower->maker->vertex_numbers[opposite]] == MESO_NO_INDEX;
}

static MesoStatus enlarge_growth(Grower *grower)
{
    MesoChartGrowth *g = grower->growth;
    MesoArena *arena = grower->arena;
    uint32_t count = g->triangle_count, room = count ? 2 * count : 256;
    g->triangles = meso_arena_enlarge(arena, g->triangles, count, room, sizeof *g->triangles, grower->error);
    g->corners = meso_arena_enlarge(arena, g->corners, 3 * (size_t)count, 3 * (size_t)room, sizeof *g->corners,
                                    grower->error);
    g->vertex_ends = meso_arena_enlarge(arena, g->vertex_ends, count, room, sizeof *g->vertex_ends, grower->error);
    g->reaches = meso_arena_enlarge(arena, g->reaches, count, room, sizeof *g->reaches, grower->error);
    g->triangle_room = room;
    return g->triangles && g->corners && g->vertex_ends && g->reaches ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus add_triangle(Grower *grower, uint32_t triangle, double reach)
{
    MesoChartGrowth *growth = grower->growth;
    uint32_t n = growth->triangle_count;
    if (n == growth->triangle_room && enlarge_growth(grower))
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t vertex = grower->mesh->corners[3 * (size_t)triangle + k];
        uint32_t *number = &grower->flood.chart_vertices[grower->maker->vertex_numbers[vertex]];
        if (*number == MESO_NO_INDEX) {
            *number = growth->vertex_count++;
            growth->vertices[*number] = vertex;
            growth->distances[*number] = grower->flood.distances[grower->maker->vertex_numbers[vertex]];
        }
        growth->corners[3 * (size_t)n + k] = *number;
    }
    growth->triangles[n] = triangle;
    growth->vertex_ends[n] = growth->vertex_count;
    growth->reaches[n] = n && reach < growth->reaches[n - 1] ? growth->reaches[n - 1] : reach;
    grower->maker->triangle_numbers[triangle] = n;
    growth->triangle_count++;
    return MESO_OK;
}

static MesoStatus push_neighbours(const Grower *grower, MesoKeyHeap *heap, uint32_t triangle)
{
    MesoStatus status = MESO_OK;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3 && !status; h++) {
        uint32_t across = meso_chart_across(grower->mesh, h);
        if (across == MESO_NO_INDEX || in_growth(grower, across) ||
            (grower->maker->taken && grower->maker->taken[across / 3]))
            continue;
        double distance = triangle_distance(grower, across / 3);
        if (distance <= grower->radius)
            status = meso_heap_push(heap, grower->arena, distance, across / 3, grower->error);
    }
    return status;
}

/* A triangle that may not come yet is pushed again by each of its neighbours that does. */
static MesoStatus add_triangles(Grower *grower, uint32_t seed)
{
    MesoKeyHeap heap = {0};
    MesoStatus status = add_triangle(grower, seed, 0);
    if (!status)
        status = push_neighbours(grower, &heap, seed);
    while (!status && heap.count) {
        MesoHeapEntry next = meso_heap_pop(&heap);
        if (grower->maker->triangle_numbers[next.item] != MESO_NO_INDEX || !keeps_disk(grower, next.item))
            continue;
        status = add_triangle(grower, next.item, next.key);
        if (!status)
            status = push_neighbours(grower, &heap, next.item);
    }
    return status;
}

static MesoStatus run_triangles(Grower *grower, uint32_t seed)
{
    Flood *flood = &grower->flood;
    flood->chart_vertices = MESO_NEW(grower->arena, uint32_t, flood->count, grower->error);
    grower->growth->vertices = MESO_NEW(grower->arena, uint32_t, flood->count, grower->error);
    grower->growth->distances = MESO_NEW(grower->arena, double, flood->count, grower->error);
    if (!flood->chart_vertices || !grower->growth->vertices || !grower->growth->distances)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < flood->count; i++)
        flood->chart_vertices[i] = MESO_NO_INDEX;
    return add_triangles(grower, seed);
}

MesoStatus meso_chart_growth_run(MesoChartGrowth *growth, MesoChartMaker *maker, uint32_t seed, double radius,
                                 MesoError *error)
{
    *growth = (MesoChartGrowth){0};
    Grower grower = {.mesh = maker->mesh, .maker = maker, .growth = growth, .arena = meso_chart_scratch(maker),
                     .radius = radius, .error = error};
    MesoStatus status = flood_vertices(&grower, seed);
    if (!status)
        status = run_triangles(&grower, seed);
    for (uint32_t i = 0; i < grower.flood.count; i++)
        maker->vertex_numbers[grower.flood.vertices[i]] = MESO_NO_INDEX;
    return status;
}

void meso_chart_growth_forget(const MesoChartGrowth *growth, MesoChartMaker *maker)
{
    for (uint32_t i = 0; i < growth->triangle_count; i++)
        maker->triangle_numbers[growth->triangles[i]] = MESO_NO_INDEX;
}
