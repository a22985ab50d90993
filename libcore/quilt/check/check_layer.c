#include "libcore/quilt/check/check_layer.h"

#include <string.h>

#include "libcore/quilt/match/triangle_distance.h"

/* Steps as rigid as possible: the plane is to have the surface's lengths. */
enum { RELAXATIONS = 8, PATCH_RELAXATIONS = 4 };

/* Part of a chart's radius that may be lost to rounding. */
#define RADIUS_SLACK 0.99f

/* ---- preparation ---- */

static uint32_t triangle_base(const MesoCheckLayer *layer, uint32_t triangle)
{
    return layer->quilt->vertices[layer->quilt->corners[3 * (size_t)triangle]].triangle;
}

static MesoStatus sort_triangles(MesoCheckLayer *layer, MesoArena *arena, MesoError *error)
{
    uint32_t count = layer->base->triangle_count;
    layer->begin = MESO_NEW(arena, uint32_t, (size_t)count + 2, error);
    layer->triangles = MESO_NEW(arena, uint32_t, layer->quilt->triangle_count, error);
    if (!layer->begin || !layer->triangles)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < layer->quilt->triangle_count; t++)
        layer->begin[triangle_base(layer, t) + 2]++;
    for (uint32_t t = 0; t < count; t++)
        layer->begin[t + 2] += layer->begin[t + 1];
    for (uint32_t t = 0; t < layer->quilt->triangle_count; t++)
        layer->triangles[layer->begin[triangle_base(layer, t) + 1]++] = t;
    return MESO_OK;
}

static MesoVec3 base_corner(const MesoTriangulation *base, uint32_t corner)
{
    return base->positions[base->corners[corner]];
}

static MesoVec3 foot_of(const MesoCheckLayer *layer, const MesoQuiltVertex *q)
{
    const float weights[3] = {1 - q->b1 - q->b2, q->b1, q->b2};
    MesoVec3 foot = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        foot = meso_vec3_mad(foot, weights[k], base_corner(layer->base, 3 * q->triangle + k));
    return foot;
}

static MesoVec3 normal_of(const MesoCheckLayer *layer, uint32_t triangle)
{
    MesoVec3 a = base_corner(layer->base, 3 * triangle);
    MesoVec3 b = meso_vec3_sub(base_corner(layer->base, 3 * triangle + 1), a);
    MesoVec3 area = meso_vec3_cross(b, meso_vec3_sub(base_corner(layer->base, 3 * triangle + 2), a));
    return meso_vec3_direction(area, (MesoVec3){0, 0, 0});
}

static void find_stand(MesoCheckLayer *layer, uint32_t element)
{
    uint32_t first = layer->quilt->vertex_begin[element], end = layer->quilt->vertex_begin[element + 1];
    MesoStand *stand = &layer->stands[element];
    float share = 1 / (float)(end - first), height = 0, nearest = INFINITY;
    MesoVec3 under = {0, 0, 0};
    for (uint32_t v = first; v < end; v++) {
        const MesoQuiltVertex *q = &layer->quilt->vertices[v];
        stand->middle = meso_vec3_mad(stand->middle, share, layer->positions[v]);
        under = meso_vec3_mad(under, share, foot_of(layer, q));
        height += share * q->height;
        stand->up = meso_vec3_add(stand->up, normal_of(layer, q->triangle));
        layer->stand_of[v] = element;
    }
    stand->up = meso_vec3_direction(stand->up, (MesoVec3){0, 0, 1});
    for (uint32_t v = first; v < end; v++) {
        MesoVec3 aside = meso_vec3_sub(under, foot_of(layer, &layer->quilt->vertices[v]));
        float length = meso_vec3_length(aside);
        if (!(length < nearest))
            continue;
        nearest = length;
        stand->foot = layer->quilt->vertices[v];
        stand->aside = aside;
    }
    stand->foot.height = height;
}

static MesoStatus find_stands(MesoCheckLayer *layer, MesoArena *arena, const MesoSwatch *swatch, MesoError *error)
{
    if (!layer->positions)
        return MESO_OK;
    const MesoQuilt *quilt = layer->quilt;
    layer->stand_of = MESO_NEW(arena, uint32_t, quilt->vertex_count, error);
    layer->stands = MESO_NEW(arena, MesoStand, quilt->element_count, error);
    if (!layer->stand_of || !layer->stands)
        return MESO_ERR_MEMORY;
    memset(layer->stand_of, 0xff, quilt->vertex_count * sizeof *layer->stand_of);
    for (uint32_t e = 0; e < quilt->element_count; e++)
        if (swatch->kinds[quilt->element_origins[e]] == MESO_ELEMENT_WHOLE)
            find_stand(layer, e);
    return MESO_OK;
}

static MesoStatus prepare_base(MesoCheckLayer *layer, MesoArena *arena, MesoError *error)
{
    uint32_t count = layer->base->triangle_count;
    layer->visits = MESO_NEW(arena, uint32_t, count, error);
    layer->queue = MESO_NEW(arena, uint32_t, count, error);
    layer->chart_triangles = MESO_NEW(arena, uint32_t, count, error);
    layer->patch_triangles = MESO_NEW(arena, uint32_t, count, error);
    layer->locals = MESO_NEW(arena, uint32_t, layer->quilt->vertex_count, error);
    if (!layer->visits || !layer->queue || !layer->chart_triangles || !layer->patch_triangles ||
        !layer->locals)
        return MESO_ERR_MEMORY;
    memset(layer->chart_triangles, 0xff, count * sizeof *layer->chart_triangles);
    memset(layer->patch_triangles, 0xff, count * sizeof *layer->patch_triangles);
    memset(layer->locals, 0xff, layer->quilt->vertex_count * sizeof *layer->locals);
    return meso_places_init(&layer->places, arena, layer->base, error);
}

MesoStatus meso_check_layer_init(MesoCheckLayer *layer, MesoArena *arena, const MesoQuilt *quilt,
                                 const MesoSwatch *swatch, const MesoVec3 *positions, const MesoTriangulation *base,
                                 float scale, float height_scale, float offset, MesoError *error)
{
    *layer = (MesoCheckLayer){.quilt = quilt, .positions = positions, .base = base, .scale = scale,
                              .height_scale = height_scale, .offset = offset};
    MesoStatus status = sort_triangles(layer, arena, error);
    if (!status)
        status = prepare_base(layer, arena, error);
    if (!status)
        status = find_stands(layer, arena, swatch, error);
    return status ? status : meso_chart_maker_init(&layer->maker, base, error);
}

void meso_check_layer_release(MesoCheckLayer *layer)
{
    meso_chart_maker_release(&layer->maker);
}

/* ---- a window ---- */

/* What is around a place, in the surface's units. */
typedef struct Surroundings {
    uint32_t seed, count;       /* triangles, in the layer's queue */
    MesoVec3 middle;
    float radius, reach, clear, extent;     /* the last is how far it goes */
    float longest_edge;
} Surroundings;

static Surroundings surroundings(const MesoCheckLayer *layer, MesoRandom *random, MesoWindowSize size)
{
    Surroundings around = {.radius = size.radius * layer->scale, .reach = size.reach * layer->scale,
                           .clear = size.clear * layer->scale};
    around.extent = fmaxf(around.reach, around.clear);
    around.middle = meso_places_next(&layer->places, random, &around.seed);
    return around;
}

/* The square of the distance of a triangle's nearest side. */
static float side_square(const MesoTriangulation *base, uint32_t triangle, MesoVec3 point)
{
    float least = INFINITY;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        MesoVec3 a = base_corner(base, h), b = base_corner(base, meso_next_corner(h));
        least = fminf(least, meso_segment_square(meso_vec3_sub(point, a), meso_vec3_sub(b, a)));
    }
    return least;
}

/* The triangles of the base within `extent`; false where a border is within `clear`. */
static bool flood(MesoCheckLayer *layer, Surroundings *around)
{
    const MesoTriangulation *base = layer->base;
    layer->visits[around->seed] = ++layer->visit;
    layer->queue[0] = around->seed;
    around->count = 1;
    for (uint32_t i = 0; i < around->count; i++)
        for (uint32_t h = 3 * layer->queue[i]; h < 3 * layer->queue[i] + 3; h++) {
            uint32_t across = base->twins[h];
            MesoVec3 a = base_corner(base, h), along = meso_vec3_sub(base_corner(base, meso_next_corner(h)), a);
            float square = meso_segment_square(meso_vec3_sub(around->middle, a), along);
            around->longest_edge = fmaxf(around->longest_edge, meso_vec3_length(along));
            if (across == MESO_NO_INDEX && square <= around->clear * around->clear)
                return false;
            if (across == MESO_NO_INDEX || square > around->extent * around->extent ||
                layer->visits[across / 3] == layer->visit)
                continue;
            layer->visits[across / 3] = layer->visit;
            layer->queue[around->count++] = across / 3;
        }
    return true;
}

/* The surface there laid flat. A chart has triangles that are all of them within its radius. */
static MesoStatus lay_flat(MesoQuiltPlane *plane, MesoChart *chart, bool *flat, MesoCheckLayer *layer,
                           const Surroundings *around, MesoArena *arena, MesoError *error)
{
    MesoVec3 centre = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        centre = meso_vec3_mad(centre, 1.0f / 3, base_corner(layer->base, 3 * around->seed + k));
    const MesoChartOptions options = {
        .radius = meso_vec3_length(meso_vec3_sub(around->middle, centre)) + fmaxf(around->reach, around->clear) +
                  around->longest_edge,
        .relaxations = RELAXATIONS,
    };
    MesoStatus status = meso_chart_grow(chart, arena, &layer->maker, around->seed, &options, error);
    if (!status)
        status = meso_quilt_plane_make(plane, arena, layer->base, chart, layer->chart_triangles, 0, layer->scale,
                                       layer->height_scale, layer->offset, error);
    *flat = !status;
    for (uint32_t i = 0; *flat && chart->radius < RADIUS_SLACK * options.radius && i < around->count; i++)
        *flat = layer->chart_triangles[layer->queue[i]] != MESO_NO_INDEX ||
                side_square(layer->base, layer->queue[i], around->middle) > around->radius * around->radius;
    return status;
}

/* The shortest turn that takes `from` to `to`. */
static MesoVec3 turned_with(MesoVec3 v, MesoVec3 from, MesoVec3 to)
{
    float cosine = meso_vec3_dot(from, to);
    if (cosine < -0.9f)
        return v;
    MesoVec3 axis = meso_vec3_cross(from, to);
    MesoVec3 moved = meso_vec3_add(meso_vec3_scale(v, cosine), meso_vec3_cross(axis, v));
    return meso_vec3_mad(moved, meso_vec3_dot(axis, v) / (1 + cosine), axis);
}

/* Where a vertex is in the plane; false outside of the chart. */
static bool place_in(MesoVec3 *place, const MesoCheckLayer *layer, const MesoQuiltPlane *plane, uint32_t vertex)
{
    if (!layer->positions || layer->stand_of[vertex] == MESO_NO_INDEX)
        return meso_quilt_plane_to(plane, layer->quilt->vertices[vertex], place);
    const MesoStand *stand = &layer->stands[layer->stand_of[vertex]];
    if (!meso_quilt_plane_to(plane, stand->foot, place))
        return false;
    MesoVec3 normal = normal_of(layer, stand->foot.triangle);
    MesoVec3 beside = turned_with(meso_vec3_sub(layer->positions[vertex], stand->middle), stand->up, normal);
    MesoVec2 way = meso_chart_direction(plane->chart, layer->base, layer->chart_triangles[stand->foot.triangle],
                                        meso_vec3_add(stand->aside, beside));
    *place = meso_vec3_add(*place, (MesoVec3){way.x / layer->scale, way.y / layer->scale,
                                              meso_vec3_dot(beside, normal) / layer->height_scale});
    return true;
}

/* Where the middle is in a plane that has its triangle. */
static MesoVec2 middle_in(const MesoCheckLayer *layer, const MesoQuiltPlane *plane, const Surroundings *around)
{
    uint32_t triangle = plane->chart_triangles[around->seed];
    MesoVec2 way = meso_chart_direction(plane->chart, layer->base, triangle,
                                        meso_vec3_sub(around->middle, base_corner(layer->base, 3 * around->seed)));
    return meso_vec2_add(plane->places[plane->chart->corners[3 * (size_t)triangle]],
                         (MesoVec2){way.x / layer->scale, way.y / layer->scale});
}

static void add_triangle(MesoWindow *window, const MesoCheckLayer *layer, const MesoQuiltPlane *plane, MesoVec2 middle,
                         uint32_t triangle)
{
    const uint32_t *v = &layer->quilt->corners[3 * (size_t)triangle];
    MesoVec3 places[3];
    for (uint32_t k = 0; k < 3; k++) {
        if (!place_in(&places[k], layer, plane, v[k]))
            return;
        places[k] = meso_vec3_sub(places[k], (MesoVec3){middle.x, middle.y, 0});
    }
    meso_window_add(window, v, places);
}

static MesoStatus take_window(MesoWindow *window, MesoCheckLayer *layer, const MesoQuiltPlane *plane,
                              const Surroundings *around, MesoArena *arena, MesoError *error)
{
    uint32_t candidates = 0;
    for (uint32_t i = 0; i < around->count; i++)
        candidates += layer->begin[layer->queue[i] + 1] - layer->begin[layer->queue[i]];
    MesoStatus status = meso_window_init(window, arena, candidates, around->radius / layer->scale,
                                         around->reach / layer->scale, layer->locals, error);
    if (status)
        return status;
    MesoVec2 middle = middle_in(layer, plane, around);
    for (uint32_t i = 0; i < around->count; i++)
        for (uint32_t j = layer->begin[layer->queue[i]]; j < layer->begin[layer->queue[i] + 1]; j++)
            add_triangle(window, layer, plane, middle, layer->triangles[j]);
    meso_window_finish(window);
    return MESO_OK;
}

MesoStatus meso_check_layer_window(MesoWindow *window, bool *found, MesoCheckLayer *layer, MesoArena *arena,
                                   MesoRandom *random, MesoWindowSize size, MesoError *error)
{
    Surroundings around = surroundings(layer, random, size);
    MesoChart chart;
    MesoQuiltPlane plane;
    *found = flood(layer, &around);
    if (!*found)
        return MESO_OK;
    MesoStatus status = lay_flat(&plane, &chart, found, layer, &around, arena, error);
    if (status)
        return status;
    if (*found)
        status = take_window(window, layer, &plane, &around, arena, error);
    meso_quilt_plane_forget(&plane);
    return status;
}

/* ---- the swatch in a window ---- */

/* From the swatch to a patch's plane, by the surface to the window's. */
typedef struct Bending {
    const MesoCheckLayer *layer;
    const MesoSwatch *swatch;
    const MesoQuiltPlane *patch, *plane;
    MesoVec2 home, patch_middle, middle;
    float cosine, sine;
} Bending;

static bool bend(MesoVec3 *place, const Bending *b, MesoVec3 p)
{
    MesoVec2 off = {p.x - b->home.x, p.y - b->home.y};
    MesoVec3 there = {b->patch_middle.x + b->cosine * off.x - b->sine * off.y,
                      b->patch_middle.y + b->sine * off.x + b->cosine * off.y, p.z};
    MesoQuiltVertex vertex;
    if (!meso_quilt_plane_from(b->patch, there, &vertex) || !meso_quilt_plane_to(b->plane, vertex, place))
        return false;
    place->x -= b->middle.x;
    place->y -= b->middle.y;
    return true;
}

/* Whole elements stand where their middle is, and are turned as the layer is there. */
static bool bend_vertex(MesoVec3 *place, const Bending *b, uint32_t element, uint32_t vertex)
{
    MesoVec3 p = b->swatch->positions[vertex];
    if (!b->layer->positions || b->swatch->kinds[element] != MESO_ELEMENT_WHOLE)
        return bend(place, b, p);
    MesoVec3 centre = b->swatch->centres[element], beside, ahead;
    MesoVec3 next = meso_vec3_add(centre, (MesoVec3){0.1f * b->swatch->mean_edge, 0, 0});
    if (!bend(place, b, centre) || !bend(&ahead, b, next))
        return false;
    ahead = meso_vec3_direction(meso_vec3_sub(ahead, *place), (MesoVec3){1, 0, 0});
    beside = meso_vec3_sub(p, centre);
    *place = meso_vec3_add(*place, (MesoVec3){ahead.x * beside.x - ahead.y * beside.y,
                                              ahead.y * beside.x + ahead.x * beside.y, beside.z});
    return true;
}

/* Whether all of it that is well within the window has a place; farther off, what has one. */
static bool add_bent(MesoWindow *window, const Bending *b)
{
    const MesoSwatch *swatch = b->swatch;
    float most = 1.5f * window->reach + swatch->mean_edge;
    for (uint32_t e = 0; e < swatch->element_count; e++)
        for (uint32_t t = swatch->triangle_begin[e]; t < swatch->triangle_begin[e + 1]; t++) {
            const uint32_t *v = &swatch->corners[3 * (size_t)t];
            MesoVec3 p = swatch->positions[v[0]], places[3];
            float away = meso_vec2_length((MesoVec2){p.x - b->home.x, p.y - b->home.y});
            bool placed = away <= most;
            for (uint32_t k = 0; k < 3 && placed; k++)
                placed = bend_vertex(&places[k], b, e, v[k]);
            if (placed)
                meso_window_add(window, v, places);
            else if (away <= window->radius)
                return false;
        }
    return true;
}

/* A triangle near the middle, larger ones as much more often. */
static uint32_t seed_nearby(const MesoCheckLayer *layer, const Surroundings *around, float most, MesoRandom *random)
{
    double sum = 0;
    uint32_t seed = around->seed;
    for (uint32_t i = 0; i < around->count; i++) {
        uint32_t triangle = layer->queue[i];
        if (triangle != around->seed && side_square(layer->base, triangle, around->middle) > most * most)
            continue;
        double area = layer->places.sums[triangle + 1] - layer->places.sums[triangle];
        sum += area;
        if (meso_random_share(random) * sum < area)
            seed = triangle;
    }
    return seed;
}

/* By the shares of a patch that quilts are grown with, if nothing else is said. */
static float patch_radius(const MesoSwatch *swatch)
{
    return 0.55f * hypotf(swatch->size.x, swatch->size.y) + 0.5f * meso_window_border(swatch);
}

static float patch_half(const MesoSwatch *swatch)
{
    return 0.275f * fminf(swatch->size.x, swatch->size.y);
}

static MesoStatus take_laid(MesoWindow *window, bool *found, double *turn, MesoCheckLayer *layer,
                            const MesoLaidSwatch *laid, const Surroundings *around, const MesoQuiltPlane *plane,
                            const MesoQuiltPlane *patch, MesoArena *arena, MesoRandom *random, MesoError *error)
{
    const MesoSwatch *swatch = laid->swatch;
    double angle = 2 * MESO_PI * meso_random_share(random);
    Bending b = {layer, swatch, patch, plane, laid->home, {0, 0}, middle_in(layer, plane, around), (float)cos(angle),
                 (float)sin(angle)};
    const MesoVec3 home = {laid->home.x, laid->home.y, 0};
    MesoVec3 here, ahead;
    MesoStatus status = meso_window_init(window, arena, swatch->triangle_count, around->radius / layer->scale,
                                         around->reach / layer->scale, laid->locals, error);
    *found = !status && layer->patch_triangles[around->seed] != MESO_NO_INDEX;
    if (!*found)
        return status;
    b.patch_middle = middle_in(layer, patch, around);
    *found = bend(&here, &b, home) &&
             bend(&ahead, &b, meso_vec3_add(home, (MesoVec3){0.5f * window->radius, 0, 0})) && add_bent(window, &b);
    if (*found)
        *turn = atan2((double)(ahead.y - here.y), (double)(ahead.x - here.x));
    meso_window_finish(window);
    return MESO_OK;
}

MesoStatus meso_check_layer_laid(MesoWindow *window, bool *found, double *turn, MesoCheckLayer *layer,
                                 const MesoLaidSwatch *laid, MesoArena *arena, MesoRandom *random, MesoWindowSize size,
                                 MesoError *error)
{
    Surroundings around = surroundings(layer, random, size);
    float half = patch_half(laid->swatch) * layer->scale;
    MesoChart chart, patch_chart;
    MesoQuiltPlane plane, patch;
    around.extent = fmaxf(around.extent, half);
    *found = flood(layer, &around);
    if (!*found)
        return MESO_OK;
    MesoStatus status = lay_flat(&plane, &chart, found, layer, &around, arena, error);
    if (status)
        return status;
    const MesoChartOptions options = {.radius = patch_radius(laid->swatch) * layer->scale,
                                      .relaxations = PATCH_RELAXATIONS};
    if (*found)
        status = meso_chart_grow(&patch_chart, arena, &layer->maker, seed_nearby(layer, &around, half, random),
                                 &options, error);
    if (*found && !status)
        status = meso_quilt_plane_make(&patch, arena, layer->base, &patch_chart, layer->patch_triangles, 0,
                                       layer->scale, layer->height_scale, layer->offset, error);
    if (*found && !status) {
        status = take_laid(window, found, turn, layer, laid, &around, &plane, &patch, arena, random, error);
        meso_quilt_plane_forget(&patch);
    }
    meso_quilt_plane_forget(&plane);
    return status;
}
