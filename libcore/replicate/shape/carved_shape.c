#include "libcore/replicate/shape/carved_shape.h"

#include <stdlib.h>

#include "libcore/base/index.h"
#include "libcore/base/parallel.h"
#include "libcore/replicate/statistics/point_grid.h"

enum { GRAIN = 2048 };

/* Of its size: so far a hole pushes aside, where there is room; it takes so much of that at most. */
static const float REACH = 0.85f, WIDEST = 0.85f;

/* Of its distance from a border. */
static const float BESIDE_BORDER = 0.95f;

/* What faces away from a detail is another side of the surface. */
static const float SAME_SIDE = 0.1f;

/* ---- bumps ---- */

static float smooth(float x)
{
    x = fminf(fmaxf(x, 0), 1);
    return x * x * (3 - 2 * x);
}

/* Between the middles of pixels; what lies beyond is as the border. */
static float pixel_at(const MesoCarvedKind *kind, float u, float v)
{
    float x = fminf(fmaxf(u * (float)kind->width - 0.5f, 0), (float)(kind->width - 1));
    float y = fminf(fmaxf((1 - v) * (float)kind->rows - 0.5f, 0), (float)(kind->rows - 1));
    uint32_t i = (uint32_t)x, j = (uint32_t)y;
    uint32_t right = i + 1 < kind->width ? i + 1 : i, down = j + 1 < kind->rows ? j + 1 : j;
    float s = x - (float)i, t = y - (float)j;
    const float *above = kind->pixels + (size_t)j * kind->width, *below = kind->pixels + (size_t)down * kind->width;
    return (1 - t) * ((1 - s) * above[i] + s * above[right]) + t * ((1 - s) * below[i] + s * below[right]);
}

float meso_bump_height(const MesoCarvedKind *kind, float x, float y)
{
    const float pi = 3.14159265f, end = 0.0183156389f;      /* exp(-4) */
    float r = sqrtf(x * x + y * y), side = fmaxf(fabsf(x), fabsf(y));
    switch (kind->form) {
    case MESO_BUMP_AS_PICTURE:
        return side < 1 ? kind->height * pixel_at(kind, 0.5f + 0.5f * x, 0.5f + 0.5f * y) *
                          (1 - smooth((side - 0.85f) / 0.15f)) : 0;
    case MESO_BUMP_AS_RING:
        return r < 1 ? kind->height * sinf(pi * r) * sinf(pi * r) : 0;
    default:
        return r < 1 ? kind->height * (expf(-4 * r * r) - end) / (1 - end) : 0;
    }
}

/* ---- a frame ---- */

/* A vertex of a rim as the detail has it. */
typedef struct Rim {
    uint32_t detail;
    float angle, distance;
} Rim;

typedef struct Work {
    const MesoCarvedMesh *carved;
    const MesoCarvedFrame *frame;
    MesoVec3 *out;
    uint32_t *under;
    MesoPointGrid grid;
    uint32_t *numbers;          /* details that are in the grid */
    float *reach;               /* by detail: how far its hole pushes; in sizes */
    Rim *rims;           /* by detail, and around it */
    uint32_t *rim_begin;        /* [count + 1] by detail */
} Work;

/* A place in a detail's plane, as far from its middle as it is in space; in sizes. */
static MesoVec2 local_at(const MesoDetail *detail, const MesoPlacedDetail *placed, MesoVec3 place)
{
    MesoVec3 d = meso_vec3_sub(place, placed->position);
    float x = meso_vec3_dot(d, placed->tangent);
    float y = meso_vec3_dot(d, meso_vec3_cross(placed->normal, placed->tangent));
    float flat = sqrtf(x * x + y * y), scale = flat > 0 ? meso_vec3_length(d) / flat : 0;
    return (MesoVec2){scale * x / detail->size, scale * y / detail->width};
}

static float length_of(MesoVec2 v)
{
    return sqrtf(v.x * v.x + v.y * v.y);
}

static MesoVec3 at_rest(const MesoCarvedMesh *c, const MesoVec3 *values, uint32_t vertex)
{
    return meso_detail_position(c->mesh, values, &c->vertices[vertex].point);
}

/* Along the surface: what it is apart in the detail's plane, turned into the plane across `normal`. */
static MesoVec3 slide(const MesoDetail *detail, const MesoPlacedDetail *placed, MesoVec3 normal, MesoVec2 by)
{
    MesoVec3 move = meso_vec3_scale(placed->tangent, by.x * detail->size);
    move = meso_vec3_mad(move, by.y * detail->width, meso_vec3_cross(placed->normal, placed->tangent));
    MesoVec3 flat = meso_vec3_mad(move, -meso_vec3_dot(move, normal), normal);
    float before = meso_vec3_length(move), after = meso_vec3_length(flat);
    return after > 0 ? meso_vec3_scale(flat, before / after) : flat;
}

/* How much of the way between two holes is one's: a closed one has its part, too. */
static float weight_of(const MesoCarvedFrame *f, uint32_t detail)
{
    const MesoPlacedDetail *placed = &f->placed[detail];
    const MesoDetail *d = &f->details[detail];
    return fmaxf(placed->size, placed->width) + 0.3f * fmaxf(d->size, d->width);
}

/* How far a hole pushes: less where another one is near, by their sizes. */
static float reach_of(const Work *w, uint32_t detail)
{
    const MesoCarvedFrame *f = w->frame;
    const MesoPlacedDetail *own = &f->placed[detail];
    float weight = weight_of(f, detail), reach = REACH;
    for (uint32_t cell = 0; cell < MESO_POINT_CELLS; cell++) {
        MesoPointRange range = meso_point_grid_range(&w->grid, own->position, cell);
        for (uint32_t i = range.begin; i < range.end; i++) {
            uint32_t other = w->numbers[w->grid.order[i]];
            if (w->grid.keys[i] != range.key || other == detail ||
                f->kinds[f->details[other].kind].carving != MESO_CARVE_HOLE)
                continue;
            float apart = meso_vec3_length(meso_vec3_sub(f->placed[other].position, own->position));
            float share = weight / (weight + weight_of(f, other));
            reach = fminf(reach, apart * share / fmaxf(f->details[detail].size, f->details[detail].width));
        }
    }
    return reach;
}

static float open_share(const MesoCarvedFrame *f, uint32_t detail)
{
    return f->placed[detail].size / f->details[detail].size;
}

/* How far the rim is from the middle in a direction: between the two of it that lie to the sides. */
static float rim_towards(const Work *w, uint32_t detail, MesoVec2 direction)
{
    const float turn = 6.28318531f;
    uint32_t begin = w->rim_begin[detail], end = w->rim_begin[detail + 1], low = begin, high = end;
    float angle = atan2f(direction.y, direction.x);
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (w->rims[middle].angle <= angle)
            low = middle + 1;
        else
            high = middle;
    }
    const Rim *after = &w->rims[low < end ? low : begin], *before = &w->rims[low > begin ? low - 1 : end - 1];
    float from = angle - before->angle + (low > begin ? 0 : turn);
    float whole = after->angle - before->angle + (low > begin && low < end ? 0 : turn);
    float share = whole > 0 ? from / whole : 0;
    return (1 - share) * before->distance + share * after->distance;
}

/* The rim goes to the hole's radius, what is beyond goes aside. */
static void push_aside(const Work *w, uint32_t detail, uint32_t vertex, MesoVec3 normal, MesoVec3 *place)
{
    const MesoCarvedFrame *f = w->frame;
    const MesoDetail *d = &f->details[detail];
    bool on_rim = w->carved->vertices[vertex].rim == detail;
    float reach = w->reach[detail];
    MesoVec2 at = local_at(d, &f->placed[detail], *place);
    float distance = length_of(at), radius = fminf(0.5f * open_share(f, detail), WIDEST * reach);
    if ((!on_rim && !(distance < reach)) || !(distance > 0))
        return;
    float rim = on_rim ? distance : rim_towards(w, detail, at);
    if (!on_rim && !(rim < reach))
        return;
    float share = on_rim ? 0 : (distance - rim) / (reach - rim);
    float to = radius + (reach - radius) * fmaxf(share, 0);
    float by = to / distance - 1;
    *place = meso_vec3_add(*place, slide(d, &f->placed[detail], normal, (MesoVec2){by * at.x, by * at.y}));
}

/* False where the place is not under it. */
static bool height_under(const Work *w, uint32_t detail, MesoVec3 place, float *height)
{
    const MesoCarvedFrame *f = w->frame;
    const MesoDetail *d = &f->details[detail];
    MesoVec2 at = local_at(d, &f->placed[detail], place);
    float radius = 0.5f * open_share(f, detail);
    *height += sqrtf(f->placed[detail].size * f->placed[detail].width) *
               meso_bump_height(&f->kinds[d->kind], at.x / radius, at.y / radius);
    return length_of(at) < radius;
}

static void place_vertex(const Work *w, uint32_t vertex)
{
    const MesoCarvedFrame *f = w->frame;
    MesoVec3 place = at_rest(w->carved, f->positions, vertex), first = place;
    MesoVec3 normal = meso_vec3_unit(at_rest(w->carved, f->normals, vertex), (MesoVec3){0, 0, 1});
    uint32_t rim = w->carved->vertices[vertex].rim;
    float height = 0;
    uint32_t under = MESO_NO_INDEX;
    if (rim != MESO_NO_INDEX && rim < f->count)
        push_aside(w, rim, vertex, normal, &place);
    for (uint32_t cell = 0; cell < MESO_POINT_CELLS; cell++) {
        MesoPointRange range = meso_point_grid_range(&w->grid, first, cell);
        for (uint32_t i = range.begin; i < range.end; i++) {
            uint32_t detail = w->numbers[w->grid.order[i]];
            if (w->grid.keys[i] != range.key || meso_vec3_dot(f->placed[detail].normal, normal) < SAME_SIDE)
                continue;
            if (f->kinds[f->details[detail].kind].carving == MESO_CARVE_BUMP) {
                bool last = under == MESO_NO_INDEX || detail > under;
                under = height_under(w, detail, first, &height) && last ? detail : under;
            } else if (rim == MESO_NO_INDEX && w->rim_begin[detail] < w->rim_begin[detail + 1]) {
                push_aside(w, detail, vertex, normal, &place);
            }
        }
    }
    w->under[vertex] = under;
    w->out[vertex] = meso_vec3_mad(place, height, normal);
}

static void place_range(void *context, uint64_t begin, uint64_t end)
{
    for (uint64_t v = begin; v < end; v++)
        place_vertex(context, (uint32_t)v);
}

static void find_reaches(void *context, uint64_t begin, uint64_t end)
{
    const Work *w = context;
    for (uint64_t i = begin; i < end; i++)
        w->reach[w->numbers[i]] = reach_of(w, w->numbers[i]);
}

/* No hole pushes a border: its vertices are near enough to each other around a hole to speak for all of it. */
static void spare_borders(Work *w)
{
    const MesoCarvedFrame *f = w->frame;
    for (uint32_t t = 0; t < w->carved->triangle_count; t++)
        for (uint32_t k = 0; k < 6; k++) {
            const MesoCarvedTriangle *triangle = &w->carved->triangles[t];
            if (triangle->twins[k % 3] != MESO_NO_INDEX)
                continue;
            MesoVec3 at = at_rest(w->carved, f->positions, triangle->corners[(k + k / 3) % 3]);
            for (uint32_t cell = 0; cell < MESO_POINT_CELLS; cell++) {
                MesoPointRange range = meso_point_grid_range(&w->grid, at, cell);
                for (uint32_t i = range.begin; i < range.end; i++) {
                    uint32_t detail = w->numbers[w->grid.order[i]];
                    if (w->grid.keys[i] == range.key)
                        w->reach[detail] = fminf(w->reach[detail], BESIDE_BORDER * length_of(
                            local_at(&f->details[detail], &f->placed[detail], at)));
                }
            }
        }
}

static int by_angle(const void *a, const void *b)
{
    const Rim *x = a, *y = b;
    if (x->detail != y->detail)
        return x->detail < y->detail ? -1 : 1;
    if (x->angle != y->angle)
        return x->angle < y->angle ? -1 : 1;
    return (x->distance > y->distance) - (x->distance < y->distance);
}

/* Where rims are, on the surface as it is. */
static MesoStatus find_rims(Work *w, MesoArena *arena, MesoError *error)
{
    const MesoCarvedFrame *f = w->frame;
    uint32_t count = 0;
    for (uint32_t v = 0; v < w->carved->vertex_count; v++)
        count += w->carved->vertices[v].rim < f->count;
    w->rims = MESO_NEW(arena, Rim, count, error);
    w->rim_begin = MESO_NEW(arena, uint32_t, (size_t)f->count + 1, error);
    if (!w->rims || !w->rim_begin)
        return MESO_ERR_MEMORY;
    count = 0;
    for (uint32_t v = 0; v < w->carved->vertex_count; v++) {
        uint32_t rim = w->carved->vertices[v].rim;
        if (rim >= f->count)
            continue;
        MesoVec2 at = local_at(&f->details[rim], &f->placed[rim], at_rest(w->carved, f->positions, v));
        w->rims[count++] = (Rim){rim, atan2f(at.y, at.x), length_of(at)};
        w->rim_begin[rim + 1]++;
    }
    for (uint32_t i = 0; i < f->count; i++)
        w->rim_begin[i + 1] += w->rim_begin[i];
    qsort(w->rims, count, sizeof *w->rims, by_angle);
    return MESO_OK;
}

/* What does something to the surface: bumps that are there, and all holes, since those of size 0 are to be closed. */
static MesoStatus sort_details(Work *w, MesoArena *arena, MesoError *error)
{
    const MesoCarvedFrame *f = w->frame;
    MesoVec3 *places = MESO_NEW(arena, MesoVec3, f->count, error);
    w->numbers = MESO_NEW(arena, uint32_t, f->count, error);
    w->reach = MESO_NEW(arena, float, f->count, error);
    if (!places || !w->numbers || !w->reach)
        return MESO_ERR_MEMORY;
    uint32_t count = 0;
    float cell = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        MesoCarving carving = f->kinds[f->details[i].kind].carving;
        if (carving == MESO_CARVE_NOTHING || (carving == MESO_CARVE_BUMP && !(f->placed[i].size > 0)))
            continue;
        cell = fmaxf(cell, fmaxf(f->details[i].size, f->details[i].width));
        places[count] = f->placed[i].position;
        w->numbers[count++] = i;
    }
    return meso_point_grid_build(&w->grid, arena, places, count, cell > 0 ? 2 * cell : 1, error);
}

MesoStatus meso_carved_place(MesoVec3 *positions, uint32_t *under, const MesoCarvedMesh *carved,
                             const MesoCarvedFrame *frame, MesoError *error)
{
    Work work = {.carved = carved, .frame = frame, .out = positions, .under = under};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = sort_details(&work, &arena, error);
    if (!status)
        status = find_rims(&work, &arena, error);
    if (!status) {
        meso_parallel_for(frame->thread_count, work.grid.count, GRAIN, find_reaches, &work);
        spare_borders(&work);
        meso_parallel_for(frame->thread_count, carved->vertex_count, GRAIN, place_range, &work);
    }
    meso_arena_release(&arena);
    return status;
}
