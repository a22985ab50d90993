#include "libcore/growth/march/texture_march.h"

/*
 * Jumps one after another with less than a texel between: at a point where charts meet, a march could go round without
 * end. After some it lands in the middle of a texel, and so elsewhere; after many each costs a part of the way.
 */
enum { JUMPS_EXACT = 4, JUMPS_FREE = 16 };

/* A march under way. */
typedef struct March {
    const MesoTextureMarch *by;
    const MesoWalkOptions *options;
    uint32_t number, crossings, limit;
    MesoChartPlace place;
    MesoComplex heading;        /* in the frame of the triangle, of length 1 */
    double left;                /* of the length */
    uint32_t stalled;           /* jumps since it last went for a texel */
    double gone;                /* texels since the last jump */
} March;

/* ---- the chart's linear map in one triangle ---- */

/* Images in texels of the frame's axes. */
typedef struct ChartMap {
    MesoComplex x, y;
} ChartMap;

static ChartMap map_of(const MesoTextureMarch *by, uint32_t triangle)
{
    const MesoWalkFace *face = &by->ground->faces[triangle];
    const MesoVec2 *uv = &by->image->uv[3 * (size_t)triangle];
    uint32_t base = meso_walk_base(face), next = meso_next_side(base), far = meso_previous_side(base);
    double length = by->ground->lengths[triangle], height = length * face->apexes[base].im;
    double side = length * face->apexes[base].re;
    ChartMap map = {{by->image->texels_per_unit, 0}, {0, by->image->texels_per_unit}};
    if (!(length > 0))
        return map;
    map.x = (MesoComplex){((double)uv[next].x - uv[base].x) / length, ((double)uv[next].y - uv[base].y) / length};
    map.y = (MesoComplex){-map.x.im, map.x.re};
    if (height > 1e-9 * length)
        map.y = (MesoComplex){((double)uv[far].x - uv[base].x - side * map.x.re) / height,
                              ((double)uv[far].y - uv[base].y - side * map.x.im) / height};
    return map;
}

static MesoComplex to_texels(const ChartMap *map, MesoComplex direction)
{
    return (MesoComplex){direction.re * map->x.re + direction.im * map->y.re,
                         direction.re * map->x.im + direction.im * map->y.im};
}

/* Of length 1. Where the triangle has no area in the image, its sides there are all that is known. */
static MesoComplex from_texels(const ChartMap *map, MesoComplex d)
{
    double area = map->x.re * map->y.im - map->x.im * map->y.re;
    double square = map->x.re * map->x.re + map->x.im * map->x.im;
    if (!(fabs(area) > 1e-12 * square))
        return meso_complex_unit(meso_complex_times(d, meso_complex_conjugate(map->x)));
    MesoComplex direction = {d.re * map->y.im - d.im * map->y.re, d.im * map->x.re - d.re * map->x.im};
    if (area < 0)
        direction = (MesoComplex){-direction.re, -direction.im};
    return meso_complex_unit(direction);
}

/* ---- in space ---- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static MesoTip tip_of(const March *m)
{
    const MesoChartPlace *place = &m->place;
    return (MesoTip){place->triangle, place->turned, {place->weight[0], place->weight[1], place->weight[2]},
                     m->heading};
}

static void normal_of(const MesoTriangleFrame *frame, double normal[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = frame->x[j] * frame->y[k] - frame->x[k] * frame->y[j];
    }
}

/*
 * The heading in another triangle: turned with the normal by the shortest way, which for neighbours is as if they were
 * hinged. Where that is no way, what of it lies in the plane.
 */
static MesoComplex carry(const MesoTextureMarch *by, const MesoChartPlace *from, const MesoChartPlace *to,
                         MesoComplex heading)
{
    if (from->triangle == to->triangle)
        return heading;
    MesoTriangleFrame here = meso_frame(by->mesh, from->triangle), there = meso_frame(by->mesh, to->triangle);
    double normal[3], other[3], direction[3], along = 0, cosine = 0;
    normal_of(&here, normal);
    normal_of(&there, other);
    for (uint32_t i = 0; i < 3; i++) {
        other[i] = from->turned != to->turned ? -other[i] : other[i];
        direction[i] = heading.re * here.x[i] + heading.im * here.y[i];
        along += other[i] * direction[i];
        cosine += other[i] * normal[i];
    }
    for (uint32_t i = 0; i < 3 && cosine > -0.9; i++)
        direction[i] -= along / (1 + cosine) * (normal[i] + other[i]);
    return meso_complex_unit((MesoComplex){dot(there.x, direction), dot(there.y, direction)});
}

/* ---- over a seam ---- */

/* How well a jump to a texel keeps the direction: the cosine, and less where it is shorter than half a texel. */
static double rate(const MesoTextureMarch *by, uint32_t texel, const double position[3], const double direction[3])
{
    MesoVec3 at = by->image->texels[texel].position;
    const double way[3] = {at.x - position[0], at.y - position[1], at.z - position[2]};
    return dot(way, direction) / fmax(sqrt(dot(way, way)), 0.5 / by->image->texels_per_unit);
}

/* Of the pointers from a texel that which rates best, if it is better than `best`. */
static const MesoTexelPointer *better_pointer(const March *m, uint32_t texel, const double position[3],
                                              const double direction[3], double *best)
{
    const MesoGeometryImage *image = m->by->image;
    const MesoTexelPointer *found = NULL, *end = image->pointers + image->pointer_count;
    if (texel == MESO_NO_INDEX || image->texels[texel].pointer == MESO_NO_INDEX)
        return NULL;
    for (const MesoTexelPointer *p = &image->pointers[image->texels[texel].pointer]; p < end && p->from == texel; p++) {
        if (p->to == MESO_NO_INDEX)
            continue;
        double rating = rate(m->by, p->to, position, direction);
        if (rating > *best) {
            *best = rating;
            found = p;
        }
    }
    return found;
}

/* Of the pointers of the chart's texels around the place that which keeps the direction best; NULL: none leads on. */
static const MesoTexelPointer *find_pointer(const March *m)
{
    const MesoGeometryImage *image = m->by->image;
    int reach = m->by->neighbourhood ? (int)m->by->neighbourhood : 2;
    uint32_t chart = image->triangle_chart[m->place.triangle];
    const MesoTexelPointer *found = NULL;
    MesoTip tip = tip_of(m);
    double position[3], direction[3], best = 0;
    meso_tip_position(m->by->mesh, &tip, position);
    meso_walk_direction(m->by->mesh, tip.triangle, tip.heading, direction);
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++) {
            uint32_t texel = meso_texel_at(image, m->place.at[0] + dx, m->place.at[1] + dy);
            const MesoTexelPointer *better = meso_texel_chart(image, texel) == chart
                ? better_pointer(m, texel, position, direction, &best) : NULL;
            found = better ? better : found;
        }
    return found;
}

static bool turns_over(const MesoTriangulation *mesh, uint32_t half_edge)
{
    return mesh->corners[mesh->twins[half_edge]] == mesh->corners[half_edge];
}

static MesoComplex turn_with(const MesoTexelPointer *pointer, MesoComplex d)
{
    d = pointer->mirrored ? meso_complex_conjugate(d) : d;
    return meso_complex_times(d, (MesoComplex){pointer->turn[0], pointer->turn[1]});
}

static MesoChartPlace texel_place(const MesoGeometryImage *image, uint32_t texel, bool turned)
{
    const float *weight = image->texels[texel].weight;
    double sum = (double)weight[0] + weight[1] + weight[2];
    const double exact[3] = {weight[0] / sum, weight[1] / sum, weight[2] / sum};
    return meso_chart_place(image, image->texels[texel].triangle, turned, exact);
}

/* A point of a side in the image. */
static MesoComplex point_of(const MesoGeometryImage *image, uint32_t half_edge, double share)
{
    MesoVec2 a = image->uv[half_edge], b = image->uv[meso_next_corner(half_edge)];
    return (MesoComplex){a.x + share * ((double)b.x - a.x), a.y + share * ((double)b.y - a.y)};
}

/* Of a side, the place that is nearest to a point in the image. */
static MesoChartPlace nearest_on(const MesoGeometryImage *image, uint32_t half_edge, bool turned, const double to[2])
{
    MesoComplex a = point_of(image, half_edge, 0), b = point_of(image, half_edge, 1);
    double x = b.re - a.re, y = b.im - a.im, square = x * x + y * y, weight[3] = {0, 0, 0};
    double share = square > 0 ? ((to[0] - a.re) * x + (to[1] - a.im) * y) / square : 0;
    share = fmin(fmax(share, 0), 1);
    weight[half_edge % 3] = 1 - share;
    weight[meso_next_side(half_edge % 3)] = share;
    return meso_chart_place(image, half_edge / 3, turned, weight);
}

/*
 * The texel that a pointer leads to, or where the march would be there: it stands to the point of the seam, between the
 * pointer's texels, as it did before.
 */
static MesoChartPlace land(const March *m, const MesoTexelPointer *pointer)
{
    const MesoGeometryImage *image = m->by->image;
    const MesoTriangulation *mesh = m->by->mesh;
    bool turns = turns_over(mesh, pointer->half_edge);
    MesoChartPlace place = texel_place(image, pointer->to, m->place.turned != turns);
    if (m->by->snaps || m->stalled >= JUMPS_EXACT)
        return place;
    uint32_t crossings = 0;
    double share = pointer->share;
    MesoComplex here = point_of(image, pointer->half_edge, share);
    MesoComplex there = point_of(image, mesh->twins[pointer->half_edge], turns ? share : 1 - share);
    MesoComplex off = turn_with(pointer, (MesoComplex){m->place.at[0] - here.re, m->place.at[1] - here.im});
    const double to[2] = {there.re + off.re, there.im + off.im};
    uint32_t end = meso_chart_walk(image, mesh, &place, to, NULL, &crossings, MESO_WALK_CROSSINGS);
    return end == MESO_NO_INDEX ? place : nearest_on(image, end, place.turned, to);
}

/* The same place on the other side of a seam. */
static MesoChartPlace step_over(const March *m, uint32_t half_edge)
{
    const MesoTextureMarch *by = m->by;
    uint32_t across = by->mesh->twins[half_edge];
    bool turns = turns_over(by->mesh, half_edge);
    double weight[3] = {0, 0, 0};
    weight[turns ? across % 3 : meso_next_side(across % 3)] = m->place.weight[half_edge % 3];
    weight[turns ? meso_next_side(across % 3) : across % 3] = m->place.weight[meso_next_side(half_edge % 3)];
    return meso_chart_place(by->image, across / 3, m->place.turned != turns, weight);
}

/* What it costs to go from one place to another. */
static void pay(March *m, const MesoTip *from)
{
    double a[3], b[3], texel = 1 / m->by->image->texels_per_unit;
    MesoTip to = tip_of(m);
    meso_tip_position(m->by->mesh, from, a);
    meso_tip_position(m->by->mesh, &to, b);
    for (uint32_t i = 0; i < 3; i++)
        b[i] -= a[i];
    m->stalled = m->gone < 1 ? m->stalled + 1 : 0;
    m->gone = 0;
    m->left -= fmax(sqrt(dot(b, b)), m->stalled > JUMPS_FREE ? 0.5 * texel : 0);
}

static void jump(March *m, uint32_t half_edge)
{
    const MesoTextureMarch *by = m->by;
    const MesoTexelPointer *pointer = find_pointer(m);
    MesoTip from = tip_of(m);
    MesoChartPlace place = pointer ? land(m, pointer) : step_over(m, half_edge);
    /* by both tangents of both charts: an angle in a texture alone says little where a chart is sheared */
    m->heading = carry(by, &m->place, &place, m->heading);
    m->place = place;
    m->crossings++;
    pay(m, &from);
    if (by->jump)
        by->jump(by->context, &(MesoTextureJump){m->number, from, tip_of(m)});
}

/* ---- in a chart ---- */

/* To the middle of the texel, where that is the chart's, and not back: small steps would lead nowhere. */
static void snap(const March *m, double to[2])
{
    const MesoGeometryImage *image = m->by->image;
    uint32_t texel = meso_texel_at(image, to[0], to[1]);
    if (meso_texel_chart(image, texel) != image->triangle_chart[m->place.triangle])
        return;
    double middle[2], x = to[0] - m->place.at[0], y = to[1] - m->place.at[1];
    meso_texel_place(image, texel, middle);
    double ahead = (middle[0] - m->place.at[0]) * x + (middle[1] - m->place.at[1]) * y;
    if (ahead > 0.5 * (x * x + y * y)) {
        to[0] = middle[0];
        to[1] = middle[1];
    }
}

/* Straight on for the rest of the way, or with `metric` for a texel. Returns the half-edge where the chart ends. */
static uint32_t go(March *m)
{
    const MesoTextureMarch *by = m->by;
    ChartMap map = map_of(by, m->place.triangle);
    MesoComplex pace = to_texels(&map, m->heading), d = meso_complex_unit(pace);
    double scale = by->metric ? sqrt(pace.re * pace.re + pace.im * pace.im) : by->image->texels_per_unit;
    double length = m->left * scale, texels = by->metric ? fmin(length, 1) : length;
    bool last = texels == length;
    MesoChartPlace before = m->place;
    double to[2] = {before.at[0] + texels * d.re, before.at[1] + texels * d.im};
    MesoChartTell tell = {by->ground, m->options, m->number};
    if (by->snaps && last)
        snap(m, to);
    uint32_t half_edge = meso_chart_walk(by->image, by->mesh, &m->place, to, &tell, &m->crossings, m->limit);
    double x = m->place.at[0] - before.at[0], y = m->place.at[1] - before.at[1], gone = sqrt(x * x + y * y);
    m->gone += gone;
    m->left = half_edge == MESO_NO_INDEX && last && m->crossings < m->limit ? 0 : fmax(m->left - gone / scale, 0);
    if (by->metric) {
        m->heading = carry(by, &before, &m->place, m->heading);
    } else if (m->place.triangle != before.triangle) {
        map = map_of(by, m->place.triangle);
        m->heading = from_texels(&map, d);
    }
    return half_edge;
}

static void march(March *m, MesoWalk *walk)
{
    m->limit = m->options->crossing_limit ? m->options->crossing_limit : MESO_WALK_CROSSINGS;
    walk->stop = MESO_WALK_DONE;
    for (uint32_t legs = 1; m->left > 0; legs++) {
        uint32_t half_edge = go(m);
        bool border = half_edge != MESO_NO_INDEX && m->by->mesh->twins[half_edge] == MESO_NO_INDEX;
        /* where texels have next to no length, there is no end of them */
        bool limited = m->left > 0 && (m->crossings >= m->limit || legs >= m->limit);
        if (border || limited) {
            walk->stop = border ? MESO_WALK_BORDER : MESO_WALK_LIMIT;
            break;
        }
        if (half_edge != MESO_NO_INDEX && m->left > 0)
            jump(m, half_edge);
    }
    walk->tip = tip_of(m);
    walk->length = walk->stop == MESO_WALK_DONE ? 0 : fmax(m->left, 0);
    walk->crossings = m->crossings;
}

void meso_texture_walks(const void *context, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options)
{
    const MesoTextureMarch *by = context;
    const MesoWalkOptions none = {0};
    for (uint32_t i = 0; i < count; i++) {
        MesoTip *tip = &walks[i].tip;
        March m = {.by = by, .options = options ? options : &none, .number = i, .heading = tip->heading,
                   .left = walks[i].length};
        m.place = meso_chart_place(by->image, tip->triangle, tip->turned, tip->weight);
        march(&m, &walks[i]);
    }
}
