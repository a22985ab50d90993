#include "libcore/chart/geometry_image.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grow.h"
#include "libcore/mesh/cut/triangle_area.h"

/* Texels between the charts' box and the border of the square. */
static const double margin = 2;

/* How deep a centre may lie in two triangles, in texels: what rounding coordinates to floats may do to slivers. */
static const float overlap_depth = 1e-3f;

typedef struct Builder {
    MesoGeometryImage *image;
    MesoArena *arena, *scratch;
    const MesoTriangulation *mesh;
    const MesoVec3 *normals;
    float *depths;              /* [size * size] of the centre within the texel's triangle, negative outside */
    uint32_t pointer_room;
    MesoError *error;
} Builder;

/* ---- charts ---- */

static MesoStatus set_uvs(Builder *b, const MesoVec2 *corner_uv)
{
    MesoGeometryImage *image = b->image;
    size_t count = 3 * (size_t)b->mesh->triangle_count;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t c = 0; c < count; c++) {
        if (!isfinite(corner_uv[c].x) || !isfinite(corner_uv[c].y))
            return meso_fail(b->error, MESO_ERR_INPUT, "face %u has coordinates that are no numbers",
                             b->mesh->faces[c / 3] + 1);
        low[0] = fmin(low[0], corner_uv[c].x), high[0] = fmax(high[0], corner_uv[c].x);
        low[1] = fmin(low[1], corner_uv[c].y), high[1] = fmax(high[1], corner_uv[c].y);
    }
    double side = fmax(high[0] - low[0], high[1] - low[1]);
    double scale = side > 0 ? (image->size - 2 * margin) / side : 0;
    double flat = 0, whole = 0;
    for (size_t c = 0; c < count; c++)
        image->uv[c] = (MesoVec2){(float)(margin + scale * (corner_uv[c].x - low[0])),
                                  (float)(margin + scale * (corner_uv[c].y - low[1]))};
    for (uint32_t t = 0; t < b->mesh->triangle_count; t++) {
        const MesoVec2 *uv = &image->uv[3 * (size_t)t];
        flat += 0.5 * fabs(((double)uv[1].x - uv[0].x) * ((double)uv[2].y - uv[0].y) -
                           ((double)uv[1].y - uv[0].y) * ((double)uv[2].x - uv[0].x));
        whole += meso_triangle_area(b->mesh, t);
    }
    image->texels_per_unit = flat > 0 && whole > 0 ? sqrt(flat / whole) : 1;
    return MESO_OK;
}

static bool equal(MesoVec2 a, MesoVec2 b)
{
    return a.x == b.x && a.y == b.y;
}

static bool is_seam(const Builder *b, uint32_t half_edge)
{
    const MesoVec2 *uv = b->image->uv;
    uint32_t across = b->mesh->twins[half_edge];
    if (across == MESO_NO_INDEX)
        return true;
    bool alike = b->mesh->corners[across] != b->mesh->corners[half_edge];
    uint32_t begin = alike ? meso_next_corner(across) : across, end = alike ? across : meso_next_corner(across);
    return !equal(uv[half_edge], uv[begin]) || !equal(uv[meso_next_corner(half_edge)], uv[end]);
}

static MesoStatus find_charts(Builder *b)
{
    MesoGeometryImage *image = b->image;
    uint32_t n = b->mesh->triangle_count;
    uint32_t *parent = MESO_NEW(b->scratch, uint32_t, n, b->error);
    if (!parent)
        return MESO_ERR_MEMORY;
    meso_sets_init(parent, n);
    for (uint32_t h = 0; h < 3 * n; h++)
        if (is_seam(b, h))
            image->seams[h / 3] |= (uint8_t)(1u << h % 3);
        else
            meso_sets_join(parent, h / 3, b->mesh->twins[h] / 3);
    /* roots are the smallest of their sets, and so numbered before the others */
    for (uint32_t t = 0; t < n; t++) {
        uint32_t root = meso_sets_root(parent, t);
        image->triangle_chart[t] = root == t ? image->chart_count++ : image->triangle_chart[root];
    }
    return MESO_OK;
}

/* ---- texels ---- */

/* A triangle in the image: counter-clockwise or not, its sides' inner normals by the way it is wound. */
typedef struct Flat {
    double x[3], y[3];
    double normal_x[3], normal_y[3];
} Flat;

static Flat flat_of(const MesoGeometryImage *image, uint32_t triangle)
{
    Flat flat;
    for (uint32_t k = 0; k < 3; k++) {
        flat.x[k] = image->uv[3 * (size_t)triangle + k].x;
        flat.y[k] = image->uv[3 * (size_t)triangle + k].y;
    }
    double area = (flat.x[1] - flat.x[0]) * (flat.y[2] - flat.y[0]) - (flat.y[1] - flat.y[0]) * (flat.x[2] - flat.x[0]);
    for (uint32_t k = 0; k < 3; k++) {
        double x = flat.x[(k + 1) % 3] - flat.x[k], y = flat.y[(k + 1) % 3] - flat.y[k], length = sqrt(x * x + y * y);
        double by = length > 0 ? (area < 0 ? -1 : 1) / length : 0;
        flat.normal_x[k] = -by * y;
        flat.normal_y[k] = by * x;
    }
    return flat;
}

/* How deep a texel's centre lies in the triangle; false where its square does not touch it (separating axes). */
static bool texel_depth(const Flat *flat, double x, double y, double *depth)
{
    *depth = INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        double distance = flat->normal_x[k] * (x - flat->x[k]) + flat->normal_y[k] * (y - flat->y[k]);
        if (distance + 0.5 * (fabs(flat->normal_x[k]) + fabs(flat->normal_y[k])) < 0)
            return false;
        *depth = fmin(*depth, distance);
    }
    return true;
}

static double least_of(const double v[3])
{
    return fmin(v[0], fmin(v[1], v[2]));
}

static double most_of(const double v[3])
{
    return fmax(v[0], fmax(v[1], v[2]));
}

static MesoStatus draw_triangle(Builder *b, uint32_t triangle)
{
    MesoGeometryImage *image = b->image;
    Flat flat = flat_of(image, triangle);
    uint32_t last = image->size - 1;
    uint32_t right = (uint32_t)fmin(most_of(flat.x), last), bottom = (uint32_t)fmin(most_of(flat.y), last);
    for (uint32_t y = (uint32_t)least_of(flat.y); y <= bottom; y++)
        for (uint32_t x = (uint32_t)least_of(flat.x); x <= right; x++) {
            size_t i = (size_t)y * image->size + x;
            MesoTexel *texel = &image->texels[i];
            double depth;
            if (!texel_depth(&flat, x + 0.5, y + 0.5, &depth))
                continue;
            if (depth > overlap_depth && b->depths[i] > overlap_depth)
                return meso_fail(b->error, MESO_ERR_INPUT, "faces %u and %u have the same coordinates within",
                                 b->mesh->faces[texel->triangle] + 1, b->mesh->faces[triangle] + 1);
            if (texel->triangle == MESO_NO_INDEX || (float)depth > b->depths[i]) {
                texel->triangle = triangle;
                b->depths[i] = (float)depth;
            }
        }
    return MESO_OK;
}

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

/* Of the nearest point of a side. Returns its squared distance. */
static double weigh_side(const Flat *flat, uint32_t k, double x, double y, double weight[3])
{
    uint32_t next = (k + 1) % 3;
    double sx = flat->x[next] - flat->x[k], sy = flat->y[next] - flat->y[k], square = sx * sx + sy * sy;
    double at = square > 0 ? clamp(((x - flat->x[k]) * sx + (y - flat->y[k]) * sy) / square, 0, 1) : 0;
    double dx = flat->x[k] + at * sx - x, dy = flat->y[k] + at * sy - y;
    weight[(k + 2) % 3] = 0;
    weight[k] = 1 - at;
    weight[next] = at;
    return dx * dx + dy * dy;
}

/* Of the triangle's point that is nearest to a texel's centre. */
static void weigh(const Flat *flat, double x, double y, double weight[3])
{
    double heights[3], depth = INFINITY, least = INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t far = (k + 2) % 3;
        double distance = flat->normal_x[k] * (x - flat->x[k]) + flat->normal_y[k] * (y - flat->y[k]);
        heights[far] = flat->normal_x[k] * (flat->x[far] - flat->x[k]) +
                       flat->normal_y[k] * (flat->y[far] - flat->y[k]);
        weight[far] = distance / heights[far];
        depth = fmin(depth, distance);
    }
    if (depth >= 0 && least_of(heights) > 0)
        return;
    for (uint32_t k = 0; k < 3; k++) {
        double of_side[3];
        double square = weigh_side(flat, k, x, y, of_side);
        if (square < least) {
            least = square;
            memcpy(weight, of_side, sizeof of_side);
        }
    }
}

/* The surface's direction along which u grows. */
static MesoVec3 tangent_of(const Builder *b, uint32_t triangle)
{
    const uint32_t *c = &b->mesh->corners[3 * (size_t)triangle];
    const MesoVec2 *uv = &b->image->uv[3 * (size_t)triangle];
    const MesoVec3 *p = b->mesh->positions;
    MesoVec3 first = meso_vec3_sub(p[c[1]], p[c[0]]), second = meso_vec3_sub(p[c[2]], p[c[0]]);
    float v1 = uv[1].y - uv[0].y, v2 = uv[2].y - uv[0].y;
    float area = (uv[1].x - uv[0].x) * v2 - v1 * (uv[2].x - uv[0].x);
    float sign = area < 0 ? -1 : 1;
    MesoVec3 along = meso_vec3_sub(meso_vec3_scale(first, sign * v2), meso_vec3_scale(second, sign * v1));
    return meso_vec3_direction(along, meso_vec3_direction(first, (MesoVec3){1, 0, 0}));
}

static MesoVec3 normal_of(const Builder *b, uint32_t triangle, const float weight[3])
{
    const uint32_t *c = &b->mesh->corners[3 * (size_t)triangle];
    const MesoVec3 *p = b->mesh->positions;
    MesoVec3 cross = meso_vec3_cross(meso_vec3_sub(p[c[1]], p[c[0]]), meso_vec3_sub(p[c[2]], p[c[0]]));
    MesoVec3 own = meso_vec3_direction(cross, (MesoVec3){0, 0, 1}), sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3 && b->normals; k++)
        sum = meso_vec3_mad(sum, weight[k], b->normals[c[k]]);
    return meso_vec3_unit(sum, own);
}

static void fill_texel(const Builder *b, uint32_t i)
{
    MesoTexel *texel = &b->image->texels[i];
    const uint32_t *c = &b->mesh->corners[3 * (size_t)texel->triangle];
    Flat flat = flat_of(b->image, texel->triangle);
    double weight[3];
    weigh(&flat, i % b->image->size + 0.5, i / b->image->size + 0.5, weight);
    texel->position = (MesoVec3){0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        texel->weight[k] = (float)weight[k];
        texel->position = meso_vec3_mad(texel->position, texel->weight[k], b->mesh->positions[c[k]]);
    }
    texel->normal = normal_of(b, texel->triangle, texel->weight);
    texel->tangent = tangent_of(b, texel->triangle);
}

static MesoStatus draw(Builder *b)
{
    uint32_t count = b->image->size * b->image->size;
    b->depths = MESO_NEW(b->scratch, float, count, b->error);
    if (!b->depths)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        b->image->texels[i].triangle = b->image->texels[i].pointer = MESO_NO_INDEX;
    MesoStatus status = MESO_OK;
    for (uint32_t t = 0; t < b->mesh->triangle_count && !status; t++)
        status = draw_triangle(b, t);
    for (uint32_t i = 0; i < count && !status; i++)
        if (b->image->texels[i].triangle != MESO_NO_INDEX)
            fill_texel(b, i);
    return status;
}

/* ---- pointers ---- */

/* The nearest texel of a chart to a point on its border, which may lie in another's. */
static uint32_t texel_near(const MesoGeometryImage *image, uint32_t chart, const double at[2])
{
    enum { REACH = 2 };
    uint32_t best = meso_texel_at(image, at[0], at[1]);
    double least = INFINITY;
    if (meso_texel_chart(image, best) == chart)
        return best;
    best = MESO_NO_INDEX;
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) {
            double x = floor(at[0]) + dx + 0.5, y = floor(at[1]) + dy + 0.5;
            double square = (x - at[0]) * (x - at[0]) + (y - at[1]) * (y - at[1]);
            uint32_t texel = meso_texel_at(image, x, y);
            if (square < least && meso_texel_chart(image, texel) == chart) {
                least = square;
                best = texel;
            }
        }
    return best;
}

/* A side in the image, from corner to corner of the mesh, and whether its triangle is on its left. */
typedef struct Border {
    double from[2], along[2];
    bool left;
} Border;

static double length_of(const Border *border)
{
    return sqrt(border->along[0] * border->along[0] + border->along[1] * border->along[1]);
}

static Border border_of(const MesoGeometryImage *image, uint32_t half_edge, bool reversed)
{
    const MesoVec2 *uv = image->uv;
    MesoVec2 a = uv[half_edge], b = uv[meso_next_corner(half_edge)], far = uv[meso_previous_corner(half_edge)];
    bool left = ((double)b.x - a.x) * ((double)far.y - a.y) - ((double)b.y - a.y) * ((double)far.x - a.x) >= 0;
    MesoVec2 begin = reversed ? b : a, end = reversed ? a : b;
    return (Border){{begin.x, begin.y}, {(double)end.x - begin.x, (double)end.y - begin.y}, left != reversed};
}

static uint32_t texel_along(const MesoGeometryImage *image, uint32_t half_edge, const Border *border, double at)
{
    const double place[2] = {border->from[0] + at * border->along[0], border->from[1] + at * border->along[1]};
    return texel_near(image, image->triangle_chart[half_edge / 3], place);
}

static MesoStatus add_pointer(Builder *b, const MesoTexelPointer *pointer)
{
    MesoGeometryImage *image = b->image;
    image->pointers = MESO_GROW(b->arena, image->pointers, image->pointer_count, b->pointer_room, 1024, b->error);
    if (!image->pointers)
        return MESO_ERR_MEMORY;
    image->pointers[image->pointer_count++] = *pointer;
    return MESO_OK;
}

/* Directions along one border become such along the other, and those out of the one lead into the other. */
static void set_turn(MesoTexelPointer *pointer, const Border *out, const Border *in)
{
    double ox = out->along[0], oy = out->along[1], ix = in->along[0], iy = in->along[1];
    pointer->mirrored = out->left == in->left;
    oy = pointer->mirrored ? -oy : oy;
    double re = ix * ox + iy * oy, im = iy * ox - ix * oy, length = sqrt(re * re + im * im);
    pointer->turn[0] = length > 0 ? re / length : 1;
    pointer->turn[1] = length > 0 ? im / length : 0;
}

/* From the one texel to the other and back, where both are. */
static MesoStatus add_pair(Builder *b, MesoTexelPointer *there, MesoTexelPointer *back)
{
    if (there->from == MESO_NO_INDEX || back->from == MESO_NO_INDEX)
        return MESO_OK;
    there->to = back->from;
    back->to = there->from;
    MesoStatus status = add_pointer(b, there);
    return status ? status : add_pointer(b, back);
}

/* Over a side that has another across, at less than half a texel along it in both charts. */
static MesoStatus point_across(Builder *b, uint32_t half_edge, uint32_t across)
{
    const MesoGeometryImage *image = b->image;
    bool alike = b->mesh->corners[across] != b->mesh->corners[half_edge];
    Border out = border_of(image, half_edge, false), in = border_of(image, across, alike);
    uint32_t count = 1 + (uint32_t)(2 * fmax(length_of(&out), length_of(&in)));
    MesoTexelPointer there = {.half_edge = half_edge}, back = {.half_edge = across};
    MesoStatus status = MESO_OK;
    set_turn(&there, &out, &in);
    set_turn(&back, &in, &out);
    for (uint32_t i = 0; i < count && !status; i++) {
        double at = (i + 0.5) / count;
        there.from = texel_along(image, half_edge, &out, at);
        there.share = (float)at;
        back.from = texel_along(image, across, &in, at);
        back.share = (float)(alike ? 1 - at : at);
        status = add_pair(b, &there, &back);
    }
    return status;
}

/* Where the surface ends. */
static MesoStatus point_nowhere(Builder *b, uint32_t half_edge)
{
    Border out = border_of(b->image, half_edge, false);
    uint32_t count = 1 + (uint32_t)(2 * length_of(&out));
    MesoTexelPointer pointer = {.half_edge = half_edge, .to = MESO_NO_INDEX, .turn = {1, 0}};
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++) {
        pointer.share = (float)((i + 0.5) / count);
        pointer.from = texel_along(b->image, half_edge, &out, (i + 0.5) / count);
        if (pointer.from != MESO_NO_INDEX)
            status = add_pointer(b, &pointer);
    }
    return status;
}

/* By all but where on the side they lead over it. */
static int compare_ways(const MesoTexelPointer *p, const MesoTexelPointer *q)
{
    if (p->from != q->from)
        return p->from < q->from ? -1 : 1;
    if (p->to != q->to)
        return p->to < q->to ? -1 : 1;
    return p->half_edge < q->half_edge ? -1 : p->half_edge > q->half_edge;
}

static int compare_pointers(const void *a, const void *b)
{
    const MesoTexelPointer *p = a, *q = b;
    int order = compare_ways(p, q);
    return order ? order : p->share < q->share ? -1 : p->share > q->share;
}

/* Sorts them, each once, and tells the texels where theirs begin. */
static void order_pointers(MesoGeometryImage *image)
{
    uint32_t kept = 0;
    if (image->pointer_count)
        qsort(image->pointers, image->pointer_count, sizeof *image->pointers, compare_pointers);
    for (uint32_t i = 0; i < image->pointer_count; i++)
        if (kept == 0 || compare_ways(&image->pointers[kept - 1], &image->pointers[i]) != 0)
            image->pointers[kept++] = image->pointers[i];
    image->pointer_count = kept;
    for (uint32_t i = kept; i-- > 0;)
        image->texels[image->pointers[i].from].pointer = i;
}

static MesoStatus point(Builder *b)
{
    MesoStatus status = MESO_OK;
    for (uint32_t h = 0; h < 3 * b->mesh->triangle_count && !status; h++) {
        uint32_t across = b->mesh->twins[h];
        if (!(b->image->seams[h / 3] >> h % 3 & 1))
            continue;
        if (across == MESO_NO_INDEX)
            status = point_nowhere(b, h);
        else if (h < across)
            status = point_across(b, h, across);
    }
    order_pointers(b->image);
    return status;
}

/* ---- the whole ---- */

static MesoStatus build(Builder *b, const MesoVec2 *corner_uv)
{
    MesoGeometryImage *image = b->image;
    size_t n = b->mesh->triangle_count;
    image->texels = MESO_NEW(b->arena, MesoTexel, (size_t)image->size * image->size, b->error);
    image->uv = MESO_NEW(b->arena, MesoVec2, 3 * n, b->error);
    image->triangle_chart = MESO_NEW(b->arena, uint32_t, n, b->error);
    image->seams = MESO_NEW(b->arena, uint8_t, n, b->error);
    if (!image->texels || !image->uv || !image->triangle_chart || !image->seams)
        return MESO_ERR_MEMORY;
    MesoStatus status = set_uvs(b, corner_uv);
    if (!status)
        status = find_charts(b);
    if (!status)
        status = draw(b);
    return status ? status : point(b);
}

MesoStatus meso_geometry_image_build(MesoGeometryImage *image, MesoArena *arena, const MesoTriangulation *mesh,
                                     const MesoVec2 *corner_uv, const MesoVec3 *normals, uint32_t size,
                                     MesoError *error)
{
    MesoArena scratch;
    Builder builder = {.image = image, .arena = arena, .scratch = &scratch, .mesh = mesh, .normals = normals,
                       .error = error};
    *image = (MesoGeometryImage){.size = size};
    if (size < MESO_GEOMETRY_IMAGE_LEAST || size > MESO_GEOMETRY_IMAGE_MOST)
        return meso_fail(error, MESO_ERR_USAGE, "a geometry image has from %u to %u texels a side, not %u",
                         MESO_GEOMETRY_IMAGE_LEAST, MESO_GEOMETRY_IMAGE_MOST, size);
    meso_arena_init(&scratch);
    MesoStatus status = build(&builder, corner_uv);
    meso_arena_release(&scratch);
    return status;
}
