#include "libcore/replicate/plan/exemplars.h"

#include <float.h>

#include "libcore/base/random.h"
#include "libcore/field/triangle_frames.h"

enum { NEAR = 64, RING = 24, MIDDLES = 12000, PAIRS = 40, BINS = MESO_EXEMPLAR_BINS, WIDE = 256 };

/* The largest triangle of a bin, over the mean one. */
static const double LARGEST = 12;

double meso_smallest_angle(double a2, double b2, double c2)
{
    double least = fmin(a2, fmin(b2, c2)), others = a2 + b2 + c2 - least, m = a2 * b2 + b2 * c2 + c2 * a2;
    double product = m - least * others;      /* of the two longer sides */
    double cosine = product > 0 ? (others - least) / (2 * sqrt(product)) : 1;
    return acos(fmax(-1, fmin(1, cosine)));
}

/* ---- originals ---- */

static MesoVec3 heading_at_rest(const MesoTriangulation *rest, const MesoDetail *detail)
{
    MesoTriangleFrame frame = meso_frame(rest, detail->point.triangle);
    return meso_frame_out(&frame, (MesoComplex){cos((double)detail->angle), sin((double)detail->angle)});
}

static float turn_from(const MesoTriangulation *rest, const MesoDetail *detail, const MesoDetail *other)
{
    MesoTriangleFrame frame = meso_frame(rest, detail->point.triangle);
    MesoComplex there = meso_frame_in(&frame, heading_at_rest(rest, other));
    return detail->angle - (float)atan2(there.im, there.re);
}

static void know_original(MesoOriginal *original, const MesoTriangulation *rest, const MesoWeb *web,
                          const MesoDetail *details, uint32_t i)
{
    uint32_t ring[RING], count = meso_web_ring(web, web->fixed_count + i, ring, RING), nearest = MESO_NO_INDEX;
    float aspect = original->aspect = meso_detail_aspect(&details[i]);
    MesoVec3 heading = aspect == 1 ? (MesoVec3){0, 0, 0} : heading_at_rest(rest, &details[i]);
    for (uint32_t k = 0; k < MESO_ORIGINAL_NEAR; k++)
        original->near[k] = INFINITY;
    for (uint32_t r = 0; r < count && r < RING; r++) {
        if (ring[r] < web->fixed_count)
            continue;
        MesoVec3 apart = meso_vec3_sub(web->positions[ring[r]], web->positions[web->fixed_count + i]);
        double arc = meso_web_arc2(web->normals[web->fixed_count + i], web->normals[ring[r]]);
        float d = (float)sqrt((double)meso_detail_norm2(apart, heading, aspect) * arc);
        if (d < original->near[0])
            nearest = ring[r] - web->fixed_count;
        for (uint32_t k = 0; k < MESO_ORIGINAL_NEAR; k++)
            if (d < original->near[k]) {
                float further = original->near[k];
                original->near[k] = d;
                d = further;
            }
    }
    original->nearest = nearest;
    original->turn = nearest == MESO_NO_INDEX ? 0 : turn_from(rest, &details[i], &details[nearest]);
}

static void know_areas(MesoExemplars *e, const MesoWeb *web)
{
    double sum = 0, angles = 0;
    uint32_t count = 0;
    for (uint32_t t = 0; t < web->triangle_count; t++) {
        const uint32_t *c = web->corners + 3 * (size_t)t;
        double area = meso_web_area(web, t);
        bool inner = true;
        for (uint32_t k = 0; k < 3; k++) {
            if (c[k] >= web->fixed_count)
                e->originals[c[k] - web->fixed_count].area += (float)(area / 3);
            else
                inner = false;
        }
        if (!inner)
            continue;
        sum += area;
        angles += meso_smallest_angle(meso_web_length2(web, c[0], c[1]), meso_web_length2(web, c[1], c[2]),
                                      meso_web_length2(web, c[2], c[0]));
        count++;
    }
    e->area = count ? sum / count : 1;
    e->angle = count ? angles / count : 1;
    e->most = LARGEST * e->area;
}

/* ---- triangles ---- */

/* Details near one, laid into its tangent plane at their distances. */
typedef struct Vicinity {
    uint32_t count;
    uint32_t details[NEAR];
    double places[NEAR][2];
} Vicinity;

static void add_near(Vicinity *v, const MesoWeb *web, uint32_t node)
{
    if (node < web->fixed_count || v->count == NEAR)
        return;
    uint32_t detail = node - web->fixed_count;
    for (uint32_t i = 0; i < v->count; i++)
        if (v->details[i] == detail)
            return;
    v->details[v->count++] = detail;
}

static void lay_out(Vicinity *v, const MesoWeb *web)
{
    uint32_t middle = web->fixed_count + v->details[0];
    MesoVec3 n = web->normals[middle], axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(axis, n), axis), y = meso_vec3_cross(n, x);
    for (uint32_t i = 0; i < v->count; i++) {
        MesoVec3 d = meso_vec3_sub(web->positions[web->fixed_count + v->details[i]], web->positions[middle]);
        double a = meso_vec3_dot(d, x), b = meso_vec3_dot(d, y), flat = sqrt(a * a + b * b);
        double length = i ? sqrt(meso_web_length2(web, middle, web->fixed_count + v->details[i])) : 0;
        double scale = flat > 0 ? length / flat : 0;
        v->places[i][0] = a * scale;
        v->places[i][1] = b * scale;
    }
}

/* It, and so many rings around it. */
static void gather(Vicinity *v, const MesoWeb *web, uint32_t detail, uint32_t rings)
{
    uint32_t ring[RING], begin = 0;
    v->count = 0;
    add_near(v, web, web->fixed_count + detail);
    for (uint32_t r = 0; r < rings; r++) {
        uint32_t end = v->count;
        for (; begin < end; begin++) {
            uint32_t count = meso_web_ring(web, web->fixed_count + v->details[begin], ring, RING);
            for (uint32_t i = 0; i < count && i < RING; i++)
                add_near(v, web, ring[i]);
        }
    }
    lay_out(v, web);
}

static double twice_area(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double apart2(const double *a, const double *b)
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

/* False where it is larger than `most`, has no details inside, or more than there is room for. */
static bool make_exemplar(MesoExemplar *out, const Vicinity *v, uint32_t i, uint32_t j, uint32_t k, double most)
{
    const double *a = v->places[i], *b = v->places[j], *c = v->places[k];
    double area = twice_area(a, b, c);
    if (area < 0) {
        const double *swap = b;
        uint32_t index = j;
        b = c;
        c = swap;
        j = k;
        k = index;
        area = -area;
    }
    if (!(area > 0 && area <= 2 * most))
        return false;
    *out = (MesoExemplar){.area = (float)(area / 2), .corners = {v->details[i], v->details[j], v->details[k]},
                          .angle = (float)meso_smallest_angle(apart2(a, b), apart2(b, c), apart2(c, a))};
    for (uint32_t p = 0; p < v->count; p++) {
        double w[3] = {twice_area(v->places[p], b, c), twice_area(a, v->places[p], c), twice_area(a, b, v->places[p])};
        if (p == i || p == j || p == k || !(w[0] > 0 && w[1] > 0 && w[2] > 0))
            continue;
        if (out->inside_count == MESO_EXEMPLAR_INSIDE)
            return false;
        for (uint32_t s = 0; s < 3; s++)
            out->weights[out->inside_count][s] = (float)(w[s] / area);
        out->inside[out->inside_count++] = v->details[p];
    }
    return out->inside_count > 0;
}

static uint32_t bin_of(double x, double most)
{
    double at = x / most * BINS;
    return at < BINS - 1 ? (uint32_t)fmax(0, at) : BINS - 1;
}

static void keep(MesoExemplars *e, uint32_t *met, const MesoExemplar *exemplar, MesoRandom *random)
{
    uint32_t bin = bin_of((double)exemplar->area, e->most) * BINS + bin_of((double)exemplar->angle, MESO_PI / 3);
    MesoExemplar *room = &e->bins[(size_t)bin * MESO_EXEMPLAR_BIN_ROOM];
    uint32_t at = met[bin]++;
    if (at < MESO_EXEMPLAR_BIN_ROOM)
        e->bin_counts[bin] = at + 1;
    else
        at = meso_random_below(random, met[bin]);
    if (at < MESO_EXEMPLAR_BIN_ROOM)
        room[at] = *exemplar;
}

/*
 * All triangles with a detail and two near it, of few details as good as all that there are; where there are many, so
 * many around some of them.
 */
static void meet_triangles(MesoExemplars *e, uint32_t *met, const MesoWeb *web, uint64_t seed)
{
    MesoRandom random;
    meso_random_init(&random, seed, 3);
    uint32_t middles = e->original_count < MIDDLES ? e->original_count : MIDDLES;
    bool all = e->original_count < 1000;
    uint32_t rings = e->original_count <= WIDE ? 3 : 2;
    for (uint32_t m = 0; m < middles; m++) {
        Vicinity v;
        MesoExemplar exemplar;
        gather(&v, web, (uint32_t)((uint64_t)m * e->original_count / middles), rings);
        for (uint32_t i = 1; all && i < v.count; i++)
            for (uint32_t k = i + 1; k < v.count; k++)
                if (make_exemplar(&exemplar, &v, 0, i, k, e->most))
                    keep(e, met, &exemplar, &random);
        for (uint32_t n = 0; !all && n < PAIRS && v.count > 3; n++) {
            uint32_t i = 1 + meso_random_below(&random, v.count - 1), k = 1 + meso_random_below(&random, v.count - 1);
            if (i != k && make_exemplar(&exemplar, &v, 0, i, k, e->most))
                keep(e, met, &exemplar, &random);
        }
    }
}

MesoStatus meso_exemplars_build(MesoExemplars *out, MesoArena *arena, const MesoTriangulation *rest, const MesoWeb *web,
                                const MesoDetail *details, uint64_t seed, MesoError *error)
{
    *out = (MesoExemplars){.original_count = web->node_count - web->fixed_count};
    out->originals = MESO_NEW(arena, MesoOriginal, out->original_count, error);
    out->bin_counts = MESO_NEW(arena, uint32_t, BINS * BINS, error);
    out->keys = MESO_NEW(arena, MesoExemplarKey, BINS * BINS * MESO_EXEMPLAR_BIN_ROOM, error);
    out->bins = MESO_NEW(arena, MesoExemplar, BINS * BINS * MESO_EXEMPLAR_BIN_ROOM, error);
    uint32_t *met = MESO_NEW(arena, uint32_t, BINS * BINS, error);
    if (!out->originals || !out->bin_counts || !out->keys || !out->bins || !met)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < out->original_count; i++)
        know_original(&out->originals[i], rest, web, details, i);
    know_areas(out, web);
    for (uint32_t i = 0; i < out->original_count; i++) {
        out->originals[i].log_area = logf(fmaxf(out->originals[i].area, FLT_MIN));
        out->originals[i].kind = details[i].kind;
        out->originals[i].log_size = logf(fmaxf(details[i].size, FLT_MIN));
    }
    meet_triangles(out, met, web, seed);
    for (uint32_t i = 0; i < BINS * BINS * MESO_EXEMPLAR_BIN_ROOM; i++)
        out->keys[i] = (MesoExemplarKey){out->bins[i].area, out->bins[i].angle, out->bins[i].inside_count};
    return MESO_OK;
}

/* ---- the most similar ---- */

typedef struct Nearest {
    const MesoExemplar **out;
    double errors[64];
    uint32_t count, room;
} Nearest;

static void consider(Nearest *n, const MesoExemplar *exemplar, double error)
{
    uint32_t at = n->count;
    if (at == n->room && !(error < n->errors[at - 1]))
        return;
    if (at == n->room)
        at--;
    else
        n->count++;
    for (; at > 0 && error < n->errors[at - 1]; at--) {
        n->errors[at] = n->errors[at - 1];
        n->out[at] = n->out[at - 1];
    }
    n->errors[at] = error;
    n->out[at] = exemplar;
}

static void consider_bin(Nearest *n, const MesoExemplars *e, uint32_t bin, double area, double angle, uint32_t limit)
{
    const MesoExemplar *room = &e->bins[(size_t)bin * MESO_EXEMPLAR_BIN_ROOM];
    const MesoExemplarKey *keys = &e->keys[(size_t)bin * MESO_EXEMPLAR_BIN_ROOM];
    for (uint32_t i = 0; i < e->bin_counts[bin]; i++) {
        double by_area = fabs(area - (double)keys[i].area) / e->area;
        double by_angle = fabs(angle - (double)keys[i].angle) / e->angle;
        if (keys[i].inside_count <= limit)
            consider(n, &room[i], by_area > by_angle ? by_area : by_angle);
    }
}

uint32_t meso_exemplars_near(const MesoExemplars *e, double area, double angle, uint32_t inside_limit,
                             const MesoExemplar **out, uint32_t room)
{
    Nearest nearest = {.out = out, .room = room < 64 ? room : 64};
    int32_t row = (int32_t)bin_of(area, e->most), column = (int32_t)bin_of(angle, MESO_PI / 3);
    /*
     * its own bin, where that has many to choose from, and else rings of bins around it until there are enough; of few
     * originals all bins, so that none is more similar
     */
    bool few = e->original_count <= WIDE, many = !few && e->bin_counts[row * BINS + column] >= 3 * nearest.room;
    for (int32_t ring = 0, more = many ? 0 : 1; ring < BINS && more >= 0; ring++) {
        for (int32_t r = row - ring; r <= row + ring; r++)
            for (int32_t c = column - ring; c <= column + ring; c++) {
                bool edge = r == row - ring || r == row + ring || c == column - ring || c == column + ring;
                if (edge && r >= 0 && r < BINS && c >= 0 && c < BINS)
                    consider_bin(&nearest, e, (uint32_t)(r * BINS + c), area, angle, inside_limit);
            }
        more -= !few && nearest.count == nearest.room;
    }
    return nearest.count;
}
