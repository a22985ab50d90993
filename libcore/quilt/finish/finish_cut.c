/* The quilt, cut along the borders of the surface. */
#include "libcore/quilt/finish/finish_work.h"
#include "libcore/quilt/seam/clip.h"

/* Halvings on the way to the border: 2^-14 of an edge of the swatch is nothing. */
enum { HALVINGS = 14 };

enum { ROOM_LEAST = 1024 };

typedef struct Cutter {
    MesoFinishWork *work;
    const MesoQuilt *quilt;
    float *values;              /* [quilt->vertex_count] inside */
    MesoArena scratch;
} Cutter;

static bool is_whole(const Cutter *c, uint32_t element)
{
    return c->work->swatch->kinds[c->quilt->element_origins[element]] == MESO_ELEMENT_WHOLE;
}

static void range_of(const Cutter *c, uint32_t element, float *least, float *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    for (uint32_t v = c->quilt->vertex_begin[element]; v < c->quilt->vertex_begin[element + 1]; v++) {
        *least = fminf(*least, c->values[v]);
        *most = fmaxf(*most, c->values[v]);
    }
}

static void copy_element(Cutter *c, uint32_t element)
{
    const MesoQuilt *quilt = c->quilt;
    uint32_t first = quilt->vertex_begin[element], to = c->work->vertex_count;
    for (uint32_t v = first; v < quilt->vertex_begin[element + 1]; v++)
        meso_finish_add_vertex(c->work, quilt->vertices[v], quilt->origins[v], false);
    for (uint32_t t = quilt->triangle_begin[element]; t < quilt->triangle_begin[element + 1]; t++) {
        const uint32_t *corner = &quilt->corners[3 * (size_t)t];
        uint32_t moved[3] = {corner[0] - first + to, corner[1] - first + to, corner[2] - first + to};
        meso_finish_add_triangle(c->work, moved, quilt->triangle_origins[t], quilt->patches[t], element);
    }
}

/*
 * Where an edge that begins inside crosses the border. Values at its ends are linear in the triangles of the base, not
 * along the edge: the way is halved over the surface itself.
 */
static MesoQuiltVertex border_place(const Cutter *c, MesoQuiltVertex from, MesoQuiltVertex to)
{
    MesoVec3 a = meso_finish_foot(c->work, from), b = meso_finish_foot(c->work, to);
    MesoQuiltVertex best = from;
    float low = 0, high = 1;
    for (int i = 0; i < HALVINGS; i++) {
        float middle = 0.5f * (low + high);
        MesoQuiltVertex place = meso_finish_locate(c->work, best.triangle, meso_vec3_lerp(a, b, middle),
                                                   from.height + middle * (to.height - from.height));
        if (meso_finish_inside(c->work, place) > 0) {
            low = middle;
            best = place;
        } else {
            high = middle;
        }
    }
    return best;
}

static void take_clipped(Cutter *c, const MesoClip *clip, uint32_t element)
{
    const MesoQuilt *quilt = c->quilt;
    uint32_t first = quilt->vertex_begin[element], to = c->work->vertex_count;
    for (uint32_t i = 0; i < clip->kept_count; i++)
        meso_finish_add_vertex(c->work, quilt->vertices[first + clip->vertices[i]],
                               quilt->origins[first + clip->vertices[i]], false);
    for (uint32_t i = 0; i < clip->made_count; i++) {
        uint32_t inner = first + clip->ends[2 * (size_t)i], outer = first + clip->ends[2 * (size_t)i + 1];
        meso_finish_add_vertex(c->work, border_place(c, quilt->vertices[inner], quilt->vertices[outer]),
                               quilt->origins[inner], true);
    }
    for (uint32_t t = 0; t < clip->triangle_count; t++) {
        uint32_t from = quilt->triangle_begin[element] + clip->origins[t], moved[3];
        for (uint32_t k = 0; k < 3; k++)
            moved[k] = clip->corners[3 * (size_t)t + k] + to;
        meso_finish_add_triangle(c->work, moved, quilt->triangle_origins[from], quilt->patches[from], element);
    }
    c->work->report->border_count += clip->loop_count;
}

static MesoStatus cut_element(Cutter *c, uint32_t element, MesoError *error)
{
    const MesoQuilt *quilt = c->quilt;
    uint32_t first = quilt->vertex_begin[element], begin = quilt->triangle_begin[element];
    uint32_t vertices = quilt->vertex_begin[element + 1] - first;
    uint32_t triangles = quilt->triangle_begin[element + 1] - begin;
    MesoArenaMark mark = meso_arena_mark(&c->scratch);
    uint32_t *corners = MESO_NEW(&c->scratch, uint32_t, 3 * (size_t)triangles, error);
    if (!corners)
        return MESO_ERR_MEMORY;
    for (size_t i = 0; i < 3 * (size_t)triangles; i++)
        corners[i] = quilt->corners[3 * (size_t)begin + i] - first;
    MesoClip clip;
    MesoStatus status = meso_clip_positive(&clip, &c->scratch, &c->values[first], vertices, corners, triangles, error);
    if (!status)
        take_clipped(c, &clip, element);
    meso_arena_rewind(&c->scratch, mark);
    return status;
}

/* Triangles that the border crosses. */
static uint64_t count_crossed(const Cutter *c)
{
    uint64_t crossed = 0;
    for (uint32_t t = 0; t < c->quilt->triangle_count; t++) {
        const uint32_t *corner = &c->quilt->corners[3 * (size_t)t];
        bool in = c->values[corner[0]] > 0;
        crossed += (c->values[corner[1]] > 0) != in || (c->values[corner[2]] > 0) != in;
    }
    return crossed;
}

/* The quilt's own arrays, which may change and be of no use to it then; no vertex is at a border. */
static MesoStatus take_all(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error)
{
    work->at_border = MESO_NEW(work->arena, uint8_t, quilt->vertex_count, error);
    work->elements = MESO_NEW(work->arena, uint32_t, quilt->triangle_count, error);
    if (!work->at_border || !work->elements)
        return MESO_ERR_MEMORY;
    work->vertex_count = work->vertex_room = quilt->vertex_count;
    work->triangle_count = work->triangle_room = quilt->triangle_count;
    work->vertices = quilt->vertices;
    work->origins = quilt->origins;
    work->corners = quilt->corners;
    work->triangle_origins = quilt->triangle_origins;
    work->patches = quilt->patches;
    for (uint32_t e = 0; e < quilt->element_count; e++)
        for (uint32_t t = quilt->triangle_begin[e]; t < quilt->triangle_begin[e + 1]; t++)
            work->elements[t] = e;
    return MESO_OK;
}

MesoStatus meso_finish_cut(MesoFinishWork *work, const MesoQuilt *quilt, MesoError *error)
{
    if (!work->base->inside)
        return take_all(work, quilt, error);
    Cutter c = {.work = work, .quilt = quilt};
    meso_arena_init(&c.scratch);
    c.values = MESO_NEW(&c.scratch, float, quilt->vertex_count, error);
    MesoStatus status = c.values ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t v = 0; !status && v < quilt->vertex_count; v++)
        c.values[v] = meso_finish_inside(work, quilt->vertices[v]);
    if (!status) {
        /*
         * Two points for each triangle that is crossed, and a triangle more; then an edge is open, and closed by one
         * triangle, around a point for three of them or more. And some room for what is open already.
         */
        uint64_t crossed = count_crossed(&c), some = ROOM_LEAST + quilt->triangle_count / 64;
        status = meso_finish_reserve(work, quilt->vertex_count + 2 * crossed + (crossed + some) / 3,
                                     quilt->triangle_count + 2 * crossed + some, error);
    }
    for (uint32_t e = 0; !status && e < quilt->element_count; e++) {
        float least, most;
        range_of(&c, e, &least, &most);
        bool whole = is_whole(&c, e);
        if (least > 0 || (whole && most > 0 && least >= -work->options->overhang))
            copy_element(&c, e);
        else if (whole)
            work->report->border_removed_count += most > 0;
        else if (most > 0)
            status = cut_element(&c, e, error);
    }
    meso_arena_release(&c.scratch);
    return status;
}
