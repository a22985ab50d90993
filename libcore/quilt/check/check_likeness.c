#include "libcore/quilt/check/check_likeness.h"

#include <string.h>

#include "libcore/quilt/check/check_places.h"
#include "libcore/quilt/check/check_window.h"
#include "libcore/quilt/match/triangle_distance.h"

enum {
    WINDOWS = 32,
    TRIES = 32 * WINDOWS,   /* some places are too near to a border, or have nothing over them */
    LEAST_POINTS = 12,
    MOST_POINTS = 250,
    PLACES = 16,            /* of the swatch that are looked at more closely */
    SLIDES = 2              /* of them from where a better one is looked for nearby */
};

/* Radius of a window as a share of the tile's shorter side. */
#define RADIUS 0.15f

/* Voxels along the longer side of the tile. */
#define VOXELS 72

typedef struct Comparison {
    const MesoQuilt *quilt;
    const MesoSwatch *swatch;
    const MesoVec3 *positions;      /* or NULL */
    const MesoTriangulation *base;
    const MesoLikenessOptions *options;
    MesoArena *scratch;
    MesoMatchField field;
    MesoNearestMesh sample;         /* the swatch */
    MesoMatchPoint *sample_points;
    float radius, reach;
    float clear;                    /* no border is so near to a window's middle */
    /* by triangle of the base, the triangles of the quilt whose first corner is over it */
    uint32_t *begin, *triangles;
    MesoPlaces places;
    uint32_t *visits, visit;        /* [triangle_count of the base] the last window that has seen it */
    uint32_t *queue;
    uint32_t *locals, *sample_locals;
    uint32_t *stand_of;             /* [vertex_count of the quilt] the whole element that it is of, or MESO_NO_INDEX */
    struct Stand *stands;           /* [element_count] */
} Comparison;

/* Where a whole element stands: its middle in space and in the layer, and what is up there. */
typedef struct Stand {
    MesoVec3 middle, foot, up;
    float height;
} Stand;

/* Where a window is laid on the swatch. */
typedef struct Placing {
    double cosine, sine;    /* by which the swatch is turned in the window */
    MesoVec2 shift;         /* the place on the swatch that is under the window's middle */
} Placing;

/* The plane of a window. */
typedef struct Frame {
    MesoVec3 origin, x, y;
} Frame;

/* ---- preparation ---- */

static uint32_t triangle_base(const Comparison *c, uint32_t triangle)
{
    return c->quilt->vertices[c->quilt->corners[3 * (size_t)triangle]].triangle;
}

static MesoStatus sort_triangles(Comparison *c, MesoError *error)
{
    uint32_t count = c->base->triangle_count;
    c->begin = MESO_NEW(c->scratch, uint32_t, (size_t)count + 2, error);
    c->triangles = MESO_NEW(c->scratch, uint32_t, c->quilt->triangle_count, error);
    if (!c->begin || !c->triangles)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < c->quilt->triangle_count; t++)
        c->begin[triangle_base(c, t) + 2]++;
    for (uint32_t t = 0; t < count; t++)
        c->begin[t + 2] += c->begin[t + 1];
    for (uint32_t t = 0; t < c->quilt->triangle_count; t++)
        c->triangles[c->begin[triangle_base(c, t) + 1]++] = t;
    return MESO_OK;
}

static MesoStatus prepare_base(Comparison *c, MesoError *error)
{
    c->visits = MESO_NEW(c->scratch, uint32_t, c->base->triangle_count, error);
    c->queue = MESO_NEW(c->scratch, uint32_t, c->base->triangle_count, error);
    if (!c->visits || !c->queue)
        return MESO_ERR_MEMORY;
    return meso_places_init(&c->places, c->scratch, c->base, error);
}

static MesoStatus prepare_swatch(Comparison *c, MesoError *error)
{
    const MesoSwatch *swatch = c->swatch;
    c->sample_points = MESO_NEW(c->scratch, MesoMatchPoint, swatch->vertex_count, error);
    c->locals = MESO_NEW(c->scratch, uint32_t, c->quilt->vertex_count, error);
    c->sample_locals = MESO_NEW(c->scratch, uint32_t, swatch->vertex_count, error);
    if (!c->sample_points || !c->locals || !c->sample_locals)
        return MESO_ERR_MEMORY;
    memset(c->locals, 0xff, c->quilt->vertex_count * sizeof *c->locals);
    memset(c->sample_locals, 0xff, swatch->vertex_count * sizeof *c->sample_locals);
    for (uint32_t v = 0; v < swatch->vertex_count; v++)
        c->sample_points[v] = (MesoMatchPoint){swatch->positions[v], swatch->normals[v]};
    c->radius = RADIUS * fminf(swatch->size.x, swatch->size.y);
    c->reach = c->radius + 2 * swatch->mean_edge;
    c->clear = c->radius + meso_window_border(swatch);
    MesoStatus status = meso_nearest_mesh_build(&c->sample, c->scratch, c->sample_points, swatch->corners,
                                                swatch->triangle_count, error);
    float longer = fmaxf(swatch->size.x, swatch->size.y);
    return status ? status : meso_match_field_build(&c->field, c->scratch, swatch, 1 / swatch->mean_edge,
                                                    longer / VOXELS, c->options->thread_count, error);
}

/* ---- windows of the quilt ---- */

static MesoVec3 base_corner(const MesoTriangulation *base, uint32_t corner)
{
    return base->positions[base->corners[corner]];
}

/* The triangles of the base within `reach` of a point of `seed`; false where a border is within `clear`. */
static bool flood(Comparison *c, uint32_t *count, uint32_t seed, MesoVec3 point, float reach, float clear)
{
    const MesoTriangulation *base = c->base;
    c->visits[seed] = ++c->visit;
    c->queue[0] = seed;
    *count = 1;
    for (uint32_t i = 0; i < *count; i++)
        for (uint32_t h = 3 * c->queue[i]; h < 3 * c->queue[i] + 3; h++) {
            uint32_t across = base->twins[h];
            MesoVec3 a = base_corner(base, h), b = base_corner(base, meso_next_corner(h));
            float square = meso_segment_square(meso_vec3_sub(point, a), meso_vec3_sub(b, a));
            if (across == MESO_NO_INDEX && square <= clear * clear)
                return false;
            if (across == MESO_NO_INDEX || square > reach * reach || c->visits[across / 3] == c->visit)
                continue;
            c->visits[across / 3] = c->visit;
            c->queue[(*count)++] = across / 3;
        }
    return true;
}

static MesoVec3 foot_of(const Comparison *c, const MesoQuiltVertex *q)
{
    const float weights[3] = {1 - q->b1 - q->b2, q->b1, q->b2};
    MesoVec3 foot = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        foot = meso_vec3_mad(foot, weights[k], base_corner(c->base, 3 * q->triangle + k));
    return foot;
}

static MesoVec3 normal_of(const Comparison *c, uint32_t triangle)
{
    MesoVec3 a = base_corner(c->base, 3 * triangle), b = meso_vec3_sub(base_corner(c->base, 3 * triangle + 1), a);
    return meso_vec3_cross(b, meso_vec3_sub(base_corner(c->base, 3 * triangle + 2), a));
}

static void find_stand(Comparison *c, uint32_t element)
{
    uint32_t first = c->quilt->vertex_begin[element], end = c->quilt->vertex_begin[element + 1];
    Stand *stand = &c->stands[element];
    float share = 1 / (float)(end - first);
    for (uint32_t v = first; v < end; v++) {
        const MesoQuiltVertex *q = &c->quilt->vertices[v];
        stand->middle = meso_vec3_mad(stand->middle, share, c->positions[v]);
        stand->foot = meso_vec3_mad(stand->foot, share, foot_of(c, q));
        stand->height += share * q->height;
        stand->up = meso_vec3_add(stand->up, meso_vec3_direction(normal_of(c, q->triangle), (MesoVec3){0, 0, 0}));
        c->stand_of[v] = element;
    }
    stand->up = meso_vec3_direction(stand->up, (MesoVec3){0, 0, 1});
}

static MesoStatus find_stands(Comparison *c, MesoError *error)
{
    if (!c->positions)
        return MESO_OK;
    c->stand_of = MESO_NEW(c->scratch, uint32_t, c->quilt->vertex_count, error);
    c->stands = MESO_NEW(c->scratch, Stand, c->quilt->element_count, error);
    if (!c->stand_of || !c->stands)
        return MESO_ERR_MEMORY;
    memset(c->stand_of, 0xff, c->quilt->vertex_count * sizeof *c->stand_of);
    for (uint32_t e = 0; e < c->quilt->element_count; e++)
        if (c->swatch->kinds[c->quilt->element_origins[e]] == MESO_ELEMENT_WHOLE)
            find_stand(c, e);
    return MESO_OK;
}

/* The shortest turn that takes `from` to `to`. */
static MesoVec3 turned_with(MesoVec3 v, MesoVec3 from, MesoVec3 to)
{
    float cosine = meso_vec3_dot(from, to);
    if (cosine < -0.9f)
        return v;
    MesoVec3 axis = meso_vec3_cross(from, to), moved = meso_vec3_mad(meso_vec3_scale(v, cosine), 1, meso_vec3_cross(axis, v));
    return meso_vec3_mad(moved, meso_vec3_dot(axis, v) / (1 + cosine), axis);
}

static MesoVec3 place_in(const Comparison *c, const Frame *frame, uint32_t vertex)
{
    const MesoQuiltVertex *q = &c->quilt->vertices[vertex];
    const float scale = c->options->scale;
    MesoVec3 foot, beside = {0, 0, 0};
    float height = q->height;
    if (c->positions && c->stand_of[vertex] != MESO_NO_INDEX) {
        const Stand *stand = &c->stands[c->stand_of[vertex]];
        MesoVec3 normal = meso_vec3_cross(frame->x, frame->y);
        beside = turned_with(meso_vec3_sub(c->positions[vertex], stand->middle), stand->up, normal);
        foot = stand->foot;
        height = stand->height + meso_vec3_dot(beside, normal);
    } else {
        foot = foot_of(c, q);
    }
    MesoVec3 at = meso_vec3_add(meso_vec3_sub(foot, frame->origin), beside);
    return (MesoVec3){meso_vec3_dot(at, frame->x) / scale, meso_vec3_dot(at, frame->y) / scale,
                      (height - c->options->offset) / c->options->height_scale};
}

/* A place, and the plane there. */
static Frame random_frame(const Comparison *c, MesoRandom *random, uint32_t *triangle)
{
    Frame frame = {.origin = meso_places_next(&c->places, random, triangle)};
    MesoVec3 a = base_corner(c->base, 3 * *triangle), b = meso_vec3_sub(base_corner(c->base, 3 * *triangle + 1), a);
    MesoVec3 side = meso_vec3_sub(base_corner(c->base, 3 * *triangle + 2), a);
    frame.x = meso_vec3_direction(b, (MesoVec3){1, 0, 0});
    frame.y = meso_vec3_cross(meso_vec3_direction(meso_vec3_cross(b, side), (MesoVec3){0, 0, 1}), frame.x);
    return frame;
}

static MesoStatus take_window(MesoWindow *window, Comparison *c, const Frame *frame, uint32_t near_count,
                              MesoError *error)
{
    uint32_t candidates = 0;
    for (uint32_t i = 0; i < near_count; i++)
        candidates += c->begin[c->queue[i] + 1] - c->begin[c->queue[i]];
    MesoStatus status = meso_window_init(window, c->scratch, candidates, c->radius, c->reach, c->locals, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < near_count; i++)
        for (uint32_t j = c->begin[c->queue[i]]; j < c->begin[c->queue[i] + 1]; j++) {
            const uint32_t *v = &c->quilt->corners[3 * (size_t)c->triangles[j]];
            const MesoVec3 places[3] = {place_in(c, frame, v[0]), place_in(c, frame, v[1]), place_in(c, frame, v[2])};
            meso_window_add(window, v, places);
        }
    return MESO_OK;
}

/* How the swatch is turned in the window: its edges there, against themselves in the swatch. */
static Placing turn_of(const Comparison *c, const MesoWindow *window)
{
    Placing placing = {0};
    for (uint32_t h = 0; h < 3 * window->triangle_count; h++) {
        uint32_t a = window->corners[h], b = window->corners[meso_next_corner(h)];
        MesoVec3 p = meso_vec3_sub(window->points[b].position, window->points[a].position);
        MesoVec3 q = meso_vec3_sub(c->swatch->positions[c->quilt->origins[window->vertices[b]]],
                                   c->swatch->positions[c->quilt->origins[window->vertices[a]]]);
        placing.cosine += (double)(p.x * q.x + p.y * q.y);
        placing.sine += (double)(q.x * p.y - q.y * p.x);
    }
    double length = sqrt(placing.cosine * placing.cosine + placing.sine * placing.sine);
    placing.cosine = length > 0 ? placing.cosine / length : 1;
    placing.sine = length > 0 ? placing.sine / length : 0;
    return placing;
}

/* ---- a window on the swatch ---- */

static MesoVec3 turned_back(MesoVec3 p, const Placing *placing)
{
    float c = (float)placing->cosine, s = (float)placing->sine;
    return (MesoVec3){c * p.x + s * p.y, c * p.y - s * p.x, p.z};
}

/* Moves a place as long as that makes it better, by steps down to a hundredth of a voxel or so; returns its cost. */
static float slide(MesoVec2 *shift, const Comparison *c, const MesoMatchPoint *points, uint32_t count)
{
    static const float ways[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    float cost = meso_match_cost(&c->field, points, NULL, count, *shift, 0, 1);
    for (float step = c->field.voxel / 2; step > c->field.voxel / 100;) {
        bool better = false;
        for (int k = 0; k < 4 && !better; k++) {
            MesoVec2 next = {shift->x + step * ways[k][0], shift->y + step * ways[k][1]};
            float price = meso_match_cost(&c->field, points, NULL, count, next, 0, 1);
            if ((better = price < cost)) {
                *shift = next;
                cost = price;
            }
        }
        if (!better)
            step /= 2;
    }
    return cost;
}

/* Where the point nearest to the middle is in the swatch: a place to begin with. */
static MesoVec2 origin_of(const Comparison *c, const MesoWindow *window, const Placing *placing)
{
    uint32_t nearest = window->inside[0];
    for (uint32_t i = 0; i < window->inside_count; i++) {
        MesoVec3 p = window->points[window->inside[i]].position, q = window->points[nearest].position;
        nearest = p.x * p.x + p.y * p.y < q.x * q.x + q.y * q.y ? window->inside[i] : nearest;
    }
    MesoVec3 at = c->swatch->positions[c->quilt->origins[window->vertices[nearest]]];
    MesoVec3 p = turned_back(window->points[nearest].position, placing);
    return (MesoVec2){at.x - p.x, at.y - p.y};
}

/* What is known of a window before it is laid on the swatch. */
typedef struct Hint {
    bool is_quilt;      /* its points have origins */
    MesoVec2 home;      /* else where it is from: places within a radius do not count */
} Hint;

/* Places to slide from, of a window whose points are turned back already. */
static MesoStatus find_places(MesoVec2 *shifts, uint32_t *found, const Comparison *c, const MesoWindow *window,
                              const MesoMatchPoint *points, uint32_t count, const Placing *placing, const Hint *hint,
                              MesoError *error)
{
    MesoMatch matches[PLACES];
    uint32_t match_count = 0, kept = 0;
    const float r = c->radius;
    MesoStatus status = meso_match_search(matches, &match_count, PLACES, 2 * c->field.voxel, &c->field, c->scratch,
                                          points, NULL, count, (MesoVec2){-r, -r}, (MesoVec2){r, r}, 0, 1, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < match_count; i++)
        if (hint->is_quilt || meso_vec2_length(meso_vec2_sub(matches[i].shift, hint->home)) >= r)
            matches[kept++] = matches[i];
    if (kept)
        kept = meso_match_refine(matches, kept, kept < SLIDES ? kept : SLIDES, &c->field, points, NULL, count, 1);
    *found = 0;
    for (uint32_t i = 0; i < kept; i++)
        shifts[(*found)++] = matches[i].shift;
    if (hint->is_quilt)
        shifts[(*found)++] = origin_of(c, window, placing);
    return MESO_OK;
}

/* The best place for a window. */
static MesoStatus find_place(Placing *placing, bool *found, const Comparison *c, const MesoWindow *window,
                             const MesoMatchPoint *points, uint32_t count, const Hint *hint, MesoError *error)
{
    MesoVec2 shifts[SLIDES + 1];
    uint32_t shift_count;
    float least = INFINITY;
    MesoStatus status = find_places(shifts, &shift_count, c, window, points, count, placing, hint, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < shift_count; i++) {
        float cost = slide(&shifts[i], c, points, count);
        if (cost < least) {
            least = cost;
            placing->shift = shifts[i];
        }
    }
    *found = shift_count > 0;
    return MESO_OK;
}

/* Mean distances both ways. */
static MesoStatus compare(double *distance, const Comparison *c, const MesoWindow *window, const MesoMatchPoint *points,
                          uint32_t count, const Placing *placing, MesoError *error)
{
    MesoNearestMesh there;
    MesoStatus status = meso_nearest_mesh_build(&there, c->scratch, window->points, window->corners,
                                                window->triangle_count, error);
    if (status)
        return status;
    double to = 0, from = 0;
    uint32_t from_count = 0;
    const MesoVec3 shift = {placing->shift.x, placing->shift.y, 0};
    const Placing back = {.cosine = placing->cosine, .sine = -placing->sine};
    for (uint32_t i = 0; i < count; i++)
        to += (double)meso_nearest_distance(&c->sample, meso_vec3_add(points[i].position, shift), c->radius);
    for (uint32_t v = 0; v < c->swatch->vertex_count; v++) {
        MesoVec3 p = meso_vec3_sub(c->swatch->positions[v], shift);
        if (p.x * p.x + p.y * p.y > c->radius * c->radius)
            continue;
        from += (double)meso_nearest_distance(&there, turned_back(p, &back), c->radius);
        from_count++;
    }
    *distance = 0.5 * (to / count + (from_count ? from / from_count : 0));
    return MESO_OK;
}

/* The distance of a window whose turn is known from its best place; found: there is such. */
static MesoStatus measure(double *distance, bool *found, const Comparison *c, const MesoWindow *window,
                          Placing placing, const Hint *hint, MesoError *error)
{
    uint32_t stride = window->inside_count / MOST_POINTS + 1, count = 0;
    MesoMatchPoint *points = MESO_NEW(c->scratch, MesoMatchPoint, window->inside_count, error);
    if (!points)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < window->inside_count; i += stride) {
        MesoMatchPoint point = window->points[window->inside[i]];
        points[count++] = (MesoMatchPoint){turned_back(point.position, &placing), turned_back(point.normal, &placing)};
    }
    MesoStatus status = find_place(&placing, found, c, window, points, count, hint, error);
    return status || !*found ? status : compare(distance, c, window, points, count, &placing, error);
}

/* ---- all windows ---- */

static MesoStatus measure_quilt_window(MesoLikeness *likeness, Comparison *c, MesoRandom *random, MesoError *error)
{
    MesoWindow window;
    uint32_t seed, near_count;
    Frame frame = random_frame(c, random, &seed);
    float scale = c->options->scale;
    if (!flood(c, &near_count, seed, frame.origin, fmaxf(c->reach, c->clear) * scale, c->clear * scale))
        return MESO_OK;
    MesoStatus status = take_window(&window, c, &frame, near_count, error);
    if (status)
        return status;
    meso_window_finish(&window);
    double distance = 0;
    bool found = false;
    if (window.inside_count >= LEAST_POINTS)
        status = measure(&distance, &found, c, &window, turn_of(c, &window), &(Hint){.is_quilt = true}, error);
    if (status || !found)
        return status;
    likeness->distance += distance;
    likeness->largest_distance = fmax(likeness->largest_distance, distance);
    likeness->window_count++;
    return MESO_OK;
}

static MesoStatus measure_swatch_window(MesoLikeness *likeness, Comparison *c, MesoRandom *random, MesoError *error)
{
    const MesoSwatch *swatch = c->swatch;
    MesoVec3 middle = {c->radius + (swatch->size.x - 2 * c->radius) * (float)meso_random_share(random),
                       c->radius + (swatch->size.y - 2 * c->radius) * (float)meso_random_share(random), 0};
    MesoWindow window;
    MesoStatus status = meso_window_init(&window, c->scratch, swatch->triangle_count, c->radius, c->reach,
                                         c->sample_locals, error);
    if (status)
        return status;
    for (uint32_t t = 0; t < swatch->triangle_count; t++) {
        const uint32_t *v = &swatch->corners[3 * (size_t)t];
        const MesoVec3 places[3] = {meso_vec3_sub(swatch->positions[v[0]], middle),
                                    meso_vec3_sub(swatch->positions[v[1]], middle),
                                    meso_vec3_sub(swatch->positions[v[2]], middle)};
        meso_window_add(&window, v, places);
    }
    meso_window_finish(&window);
    double distance = 0;
    bool found = false;
    if (window.inside_count >= LEAST_POINTS)
        status = measure(&distance, &found, c, &window, (Placing){.cosine = 1},
                         &(Hint){.home = {middle.x, middle.y}}, error);
    if (status || !found)
        return status;
    likeness->swatch_distance += distance;
    likeness->swatch_window_count++;
    return MESO_OK;
}

static MesoStatus measure_all(MesoLikeness *likeness, Comparison *c, MesoError *error)
{
    MesoStatus status = MESO_OK;
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t i = 0; i < TRIES && likeness->window_count < WINDOWS && !status; i++) {
        MesoArenaMark mark = meso_arena_mark(c->scratch);
        status = measure_quilt_window(likeness, c, &random, error);
        meso_arena_rewind(c->scratch, mark);
    }
    for (uint32_t i = 0; i < TRIES && likeness->swatch_window_count < WINDOWS && !status; i++) {
        MesoArenaMark mark = meso_arena_mark(c->scratch);
        status = measure_swatch_window(likeness, c, &random, error);
        meso_arena_rewind(c->scratch, mark);
    }
    likeness->distance /= likeness->window_count ? likeness->window_count : 1;
    likeness->swatch_distance /= likeness->swatch_window_count ? likeness->swatch_window_count : 1;
    likeness->radius = (double)c->radius;
    return status;
}

MesoStatus meso_check_likeness(MesoLikeness *likeness, MesoArena *scratch, const MesoQuilt *quilt,
                               const MesoSwatch *swatch, const MesoVec3 *positions, const MesoTriangulation *base,
                               const MesoLikenessOptions *options, MesoError *error)
{
    *likeness = (MesoLikeness){0};
    if (quilt->triangle_count == 0 || base->triangle_count == 0)
        return MESO_OK;
    Comparison c = {.quilt = quilt, .swatch = swatch, .positions = positions, .base = base, .options = options,
                    .scratch = scratch};
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoStatus status = sort_triangles(&c, error);
    if (!status)
        status = prepare_base(&c, error);
    if (!status)
        status = find_stands(&c, error);
    if (!status)
        status = prepare_swatch(&c, error);
    if (!status)
        status = measure_all(likeness, &c, error);
    meso_arena_rewind(scratch, mark);
    return status;
}
