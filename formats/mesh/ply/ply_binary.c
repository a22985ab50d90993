#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "formats/mesh/ply/ply_body.h"
#include "formats/mesh/ply/ply_items.h"
#include "formats/mesh/ply/ply_layout.h"
#include "libcore/base/parallel.h"

enum { GRAIN = 1 << 14 };

/* Where a block of GRAIN items begins, in elements whose items are not all as long. */
typedef struct Block {
    size_t offset;
    uint32_t corners;
} Block;

/* An element on its way into the mesh. */
typedef struct Reading {
    MesoPly *ply;
    MesoPlyElement *element;
    MesoPolygonMesh *mesh;
    MesoArena *arena, *scratch;
    const unsigned char *data;      /* of the element */
    size_t size;                    /* from there to the end of the file */
    uint32_t thread_count;
    bool big;
    MesoError *error;

    uint32_t item_count;            /* items that are all there */
    size_t used;                    /* their bytes */
    uint64_t corner_count;
    uint32_t least_sides, most_sides;
    bool negative;                  /* the item behind them has a list of negative length; else the file ends in it */
    uint32_t *widths;               /* [properties] of lists of corners; see ply_layout.h */
    MesoPlyItems *items;            /* where all items are as long as the first */
    uint32_t *list_counts;          /* [properties] of the first item */
    Block *blocks;                  /* else */
    atomic_bool differs;
    atomic_uint_fast32_t wrong;     /* first item with a number that cannot be, or MESO_NO_INDEX */
} Reading;

static void note_wrong(Reading *reading, uint32_t item)
{
    uint_fast32_t first = atomic_load(&reading->wrong);
    while (item < first && !atomic_compare_exchange_weak(&reading->wrong, &first, item)) {}
}

static MesoStatus fail_item(const Reading *reading, uint32_t item, const char *what)
{
    return meso_fail(reading->error, MESO_ERR_INPUT, "%s: %s %u %s", reading->ply->path, reading->element->name,
                     item + 1, what);
}

/* ---- where items lie ---- */

/*
 * Bytes of the item at `at`, with the lengths of its lists to `counts` (may be NULL). Returns false where it does not
 * end before `limit`, or, with `*negative` set, where a list has a negative length.
 */
static bool measure_item(const MesoPlyElement *element, const unsigned char *at, const unsigned char *limit, bool big,
                         uint32_t *counts, size_t *size, bool *negative)
{
    const unsigned char *begin = at;
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        size_t each = meso_scalar_size(p->type), count = 1;
        if (p->list) {
            uint32_t count_size = meso_scalar_size(p->count_type);
            if ((size_t)(limit - at) < count_size)
                return false;
            int64_t length = meso_ply_integer(p->count_type, at, big);
            *negative = length < 0;
            if (*negative)
                return false;
            at += count_size;
            count = (size_t)length;
            if (counts)
                counts[p - element->properties] = (uint32_t)length;
        }
        if ((size_t)(limit - at) < each * count)
            return false;
        at += each * count;
    }
    *size = (size_t)(at - begin);
    return true;
}

static uint32_t indices_of(const MesoPlyElement *element, const uint32_t *counts)
{
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++)
        if (p->role == MESO_PLY_INDICES)
            return counts[p - element->properties];
    return 0;
}

/* Whether the lists of items have the lengths that those of the first have: then all of them lie where its do. */
static void compare_lists(void *context, uint64_t begin, uint64_t end)
{
    Reading *reading = context;
    const MesoPlyElement *element = reading->element;
    size_t stride = reading->items->stride, offset = 0;
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        uint32_t count = p->list ? reading->list_counts[p - element->properties] : 1;
        if (p->list) {
            const unsigned char *at = reading->data + begin * stride + offset;
            for (uint64_t i = begin; i < end; i++, at += stride)
                if (meso_ply_integer(p->count_type, at, reading->big) != count) {
                    atomic_store(&reading->differs, true);
                    return;
                }
            offset += meso_scalar_size(p->count_type);
        }
        offset += (size_t)count * meso_scalar_size(p->type);
    }
}

/* Goes through all items, one by one. */
static MesoStatus walk_items(Reading *reading)
{
    const MesoPlyElement *element = reading->element;
    const unsigned char *at = reading->data, *limit = reading->data + reading->size;
    uint32_t most = reading->size < element->count ? (uint32_t)reading->size : element->count, counts[MESO_PLY_PROPERTIES];
    reading->blocks = MESO_NEW(reading->scratch, Block, most / GRAIN + 1, reading->error);
    if (!reading->blocks)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < element->count; i++) {
        size_t size;
        if (!measure_item(element, at, limit, reading->big, counts, &size, &reading->negative))
            break;
        if (i % GRAIN == 0)
            reading->blocks[i / GRAIN] = (Block){(size_t)(at - reading->data), (uint32_t)reading->corner_count};
        uint32_t sides = indices_of(element, counts);
        meso_ply_note_widths(reading->widths, element, counts);
        reading->least_sides = sides < reading->least_sides ? sides : reading->least_sides;
        reading->most_sides = sides > reading->most_sides ? sides : reading->most_sides;
        reading->corner_count += sides;
        reading->item_count++;
        at += size;
    }
    reading->used = (size_t)(at - reading->data);
    return MESO_OK;
}

static MesoStatus find_items(Reading *reading)
{
    const MesoPlyElement *element = reading->element;
    bool negative = false;
    reading->items = MESO_NEW(reading->scratch, MesoPlyItems, 1, reading->error);
    reading->list_counts = MESO_NEW(reading->scratch, uint32_t, MESO_PLY_PROPERTIES, reading->error);
    reading->widths = MESO_NEW(reading->scratch, uint32_t, MESO_PLY_PROPERTIES, reading->error);
    if (!reading->items || !reading->list_counts || !reading->widths)
        return MESO_ERR_MEMORY;
    reading->items->data = reading->data;
    reading->items->big = reading->big;
    if (!element->count || !measure_item(element, reading->data, reading->data + reading->size, reading->big,
                                         reading->list_counts, &reading->items->stride, &negative)) {
        reading->negative = negative;
        reading->items->stride = 1;
        return MESO_OK;
    }
    size_t fit = reading->size / reading->items->stride;
    reading->item_count = fit < element->count ? (uint32_t)fit : element->count;
    if (element->lists && reading->item_count == element->count)
        meso_parallel_for(reading->thread_count, element->count, GRAIN, compare_lists, reading);
    if (element->lists && (reading->item_count < element->count || atomic_load(&reading->differs))) {
        reading->item_count = 0;
        reading->items = NULL;
        return walk_items(reading);
    }
    uint32_t sides = indices_of(element, reading->list_counts);
    reading->least_sides = reading->most_sides = sides;
    meso_ply_note_widths(reading->widths, element, reading->list_counts);
    reading->corner_count = (uint64_t)sides * reading->item_count;
    reading->used = reading->item_count * reading->items->stride;
    return MESO_OK;
}

/* ---- copying ---- */

static void add_runs(Reading *reading)
{
    const MesoPlyElement *element = reading->element;
    size_t offset = 0;
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        uint32_t count = p->list ? reading->list_counts[p - element->properties] : 1;
        offset += p->list ? meso_scalar_size(p->count_type) : 0;
        size_t stride = !p->list ? p->stride : (size_t)reading->most_sides * p->stride;
        meso_ply_add_run(reading->items, p, count, offset, stride);
        offset += (size_t)count * meso_scalar_size(p->type);
    }
}

/* The numbers of an item at `at`, which may have lists of any length; returns its end. */
static const unsigned char *copy_item(const Reading *reading, const unsigned char *at, uint32_t item, uint32_t corner,
                                      uint32_t *sides)
{
    for (const MesoPlyProperty *p = reading->element->properties; p < reading->element->properties_end; p++) {
        uint32_t count = 1, size = meso_scalar_size(p->type);
        size_t first = p->list ? corner : item, step = meso_scalar_size(p->to);
        if (p->list) {
            count = (uint32_t)meso_ply_integer(p->count_type, at, reading->big);
            at += meso_scalar_size(p->count_type);
        }
        if (p->role == MESO_PLY_INDICES)
            *sides = count;
        for (uint32_t k = 0; p->out && k < count; k++)
            meso_ply_put(p, p->out + first * p->stride + k * step, at + (size_t)k * size, reading->big);
        at += (size_t)count * size;
    }
    return at;
}

static void copy_block(const Reading *reading, uint32_t begin, uint32_t end)
{
    const Block *block = &reading->blocks[begin / GRAIN];
    const unsigned char *at = reading->data + block->offset;
    uint32_t corner = block->corners;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t sides = 0;
        at = copy_item(reading, at, i, corner, &sides);
        if (reading->element->kind == MESO_PLY_FACES && reading->mesh->face_begin)
            reading->mesh->face_begin[i] = corner;
        corner += sides;
    }
}

/* ---- numbers that cannot be ---- */

static bool all_finite(const float *numbers, size_t count)
{
    uint32_t wrong = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        wrong |= (bits & 0x7fffffff) >= 0x7f800000;
    }
    return !wrong;
}

static bool is_normal(const MesoAttribute *attribute)
{
    static const char *const names[] = {"normal", "nx", "ny", "nz"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (attribute->domain == MESO_ON_VERTICES && strcmp(attribute->name, names[i]) == 0)
            return true;
    return false;
}

static bool has_finite_position(const MesoPolygonMesh *mesh, uint32_t v)
{
    return meso_vec3_finite(mesh->positions[v]);
}

/* Normals are floats in the end, whatever the file has. */
static bool has_finite_normal(const MesoAttribute *attribute, uint32_t v)
{
    for (uint32_t c = 0; c < attribute->width; c++)
        if (!(fabs(meso_attribute_number(attribute, v, c)) <= (double)FLT_MAX))
            return false;
    return true;
}

static void check_vertices(Reading *reading, uint32_t begin, uint32_t end)
{
    const MesoPolygonMesh *mesh = reading->mesh;
    if (!all_finite(&mesh->positions[begin].x, 3 * (size_t)(end - begin)))
        for (uint32_t v = begin; v < end; v++)
            if (!has_finite_position(mesh, v))
                note_wrong(reading, v);
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++) {
        if (!is_normal(a) || (a->scalar == MESO_SCALAR_FLOAT &&
                              all_finite((const float *)a->values + (size_t)begin * a->width,
                                         (size_t)(end - begin) * a->width)))
            continue;
        for (uint32_t v = begin; v < end; v++)
            if (!has_finite_normal(a, v))
                note_wrong(reading, v);
    }
}

static bool is_signed(const MesoPlyElement *element)
{
    const MesoPlyProperty *p = element->properties;
    while (p->role != MESO_PLY_INDICES)
        p++;
    return p->type == MESO_SCALAR_INT8 || p->type == MESO_SCALAR_INT16 || p->type == MESO_SCALAR_INT32;
}

static void check_corners(Reading *reading, uint32_t begin, uint32_t end)
{
    const MesoPolygonMesh *mesh = reading->mesh;
    uint32_t first = is_signed(reading->element) ? (uint32_t)1 << 31 : UINT32_MAX, wrong = 0;
    for (uint32_t c = meso_polygon_begin(mesh, begin); c < meso_polygon_begin(mesh, end - 1) + meso_polygon_sides(mesh, end - 1); c++)
        wrong |= mesh->corners[c] >= first;
    for (uint32_t f = begin; wrong && f < end; f++)
        for (uint32_t k = 0; k < meso_polygon_sides(mesh, f); k++)
            if (mesh->corners[meso_polygon_begin(mesh, f) + k] >= first)
                note_wrong(reading, f);
}

static MesoStatus fail_wrong(const Reading *reading, uint32_t item)
{
    if (reading->element->kind == MESO_PLY_FACES)
        return fail_item(reading, item, is_signed(reading->element) ? "has a negative vertex index"
                                                                    : "has a vertex index that is too large");
    return fail_item(reading, item, has_finite_position(reading->mesh, item) ? "has a normal that is not finite" : "is not finite");
}

/* ---- elements ---- */

static void copy_range(void *context, uint64_t begin, uint64_t end)
{
    Reading *reading = context;
    if (reading->items)
        meso_ply_copy_items(reading->items, (uint32_t)begin, (uint32_t)end);
    else
        copy_block(reading, (uint32_t)begin, (uint32_t)end);
    if (reading->element->kind == MESO_PLY_VERTICES)
        check_vertices(reading, (uint32_t)begin, (uint32_t)end);
}

static void check_range(void *context, uint64_t begin, uint64_t end)
{
    check_corners(context, (uint32_t)begin, (uint32_t)end);
}

static MesoStatus make_room(Reading *reading)
{
    MesoPolygonMesh *mesh = reading->mesh;
    if (reading->element->kind == MESO_PLY_VERTICES)
        return meso_ply_make_vertices(reading->element, mesh, reading->arena, reading->item_count, reading->error);
    if (reading->corner_count > MESO_MESH_LIMIT)
        return meso_fail(reading->error, MESO_ERR_LIMIT, "mesh has more than %u elements of a kind", MESO_MESH_LIMIT);
    uint32_t side_count = reading->least_sides == reading->most_sides ? reading->most_sides : 0;
    MesoStatus status = meso_ply_make_faces(reading->element, mesh, reading->arena, reading->item_count,
                                            (uint32_t)reading->corner_count, side_count, reading->widths, reading->error);
    if (!status && mesh->face_begin)
        mesh->face_begin[mesh->face_count] = mesh->corner_count;
    return status;
}

static MesoStatus read_items(Reading *reading)
{
    MesoStatus status = make_room(reading);
    if (status)
        return status;
    if (reading->items)
        add_runs(reading);
    meso_parallel_for(reading->thread_count, reading->item_count, GRAIN, copy_range, reading);
    if (reading->element->kind == MESO_PLY_FACES)
        meso_parallel_for(reading->thread_count, reading->item_count, GRAIN, check_range, reading);
    uint32_t wrong = (uint32_t)atomic_load(&reading->wrong);
    return wrong == MESO_NO_INDEX ? MESO_OK : fail_wrong(reading, wrong);
}

static MesoStatus read_element(Reading *reading)
{
    MesoStatus status = find_items(reading);
    if (!status && reading->element->kind != MESO_PLY_UNKNOWN)
        status = read_items(reading);
    if (status || reading->item_count == reading->element->count)
        return status;
    if (reading->negative)
        return fail_item(reading, reading->item_count, "has a list of negative length");
    return meso_fail(reading->error, MESO_ERR_INPUT, "%s: file ends in %s %u of %u", reading->ply->path,
                     reading->element->name, reading->item_count + 1, reading->element->count);
}

MesoStatus meso_ply_read_binary(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                uint32_t thread_count, MesoError *error)
{
    size_t at = ply->body;
    for (uint32_t e = 0; e < ply->element_count; e++) {
        MesoArena scratch;
        Reading reading = {
            .ply = ply, .element = &ply->elements[e], .mesh = mesh, .arena = arena, .scratch = &scratch,
            .data = input->data + at, .size = input->size - at, .thread_count = thread_count,
            .big = ply->form == MESO_PLY_BIG, .error = error, .least_sides = MESO_NO_INDEX, .wrong = MESO_NO_INDEX};
        meso_arena_init(&scratch);
        MesoStatus status = read_element(&reading);
        meso_arena_release(&scratch);
        if (status)
            return status;
        at += reading.used;
    }
    if (at < input->size)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %zu bytes more than the header counts", ply->path,
                         input->size - at);
    return MESO_OK;
}
