/* Bodies: where whole elements lie in space, and who is near. */
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/math/vec3d.h"
#include "libcore/quilt/settle/settle_work.h"

/* Rounds of the search for a rotation; three or four are usual. */
enum { TURNS = 24 };

/* Bodies nearer to a border than that, as a share of their spacing, stay where they are. */
#define AT_BORDER 0.1f

/* Bodies that are bent have volumes off by as much at most. */
#define VOLUME_PLAY 0.07

/*
 * Where a body's root is, as a share of its height. On a surface that bulges, bodies stand further apart at their middle than
 * at their feet; there are as many of them as the area has room for if it is the feet that stand as in the swatch, and
 * they lie off each other as they are to if it is the middles.
 */
#define ROOT 0.5f

/* ---- the frame that fits best ---- */

/* Sums of products of places in space and in the swatch, by the swatch's axes, both from their middles. */
typedef struct Moments {
    MesoVec3d middle, rest_middle;
    MesoVec3d columns[3];
} Moments;

static Moments moments_of(const MesoVec3 *points, const MesoVec3 *rest, uint32_t count)
{
    Moments m = {0};
    for (uint32_t i = 0; i < count; i++) {
        m.middle = meso_vec3d_mad(m.middle, 1.0 / count, meso_vec3d(points[i]));
        m.rest_middle = meso_vec3d_mad(m.rest_middle, 1.0 / count, meso_vec3d(rest[i]));
    }
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3d p = meso_vec3d_sub(meso_vec3d(points[i]), m.middle);
        MesoVec3d q = meso_vec3d_sub(meso_vec3d(rest[i]), m.rest_middle);
        m.columns[0] = meso_vec3d_mad(m.columns[0], q.x, p);
        m.columns[1] = meso_vec3d_mad(m.columns[1], q.y, p);
        m.columns[2] = meso_vec3d_mad(m.columns[2], q.z, p);
    }
    return m;
}

/* An axis of length 1 across `up` towards `to`; false where there is none. */
static bool axis_towards(MesoVec3d *axis, MesoVec3d to, MesoVec3d up)
{
    MesoVec3d flat = meso_vec3d_mad(to, -meso_vec3d_dot(to, up), up);
    double length = meso_vec3d_length(flat);
    *axis = meso_vec3d_scale(flat, length > 0 ? 1 / length : 0);
    return length > 1e-6 * meso_vec3d_length(to);
}

/* Turns three axes by the rotation whose half vector, tan(angle/2) times its axis, is `w` (Cayley's). */
static MesoVec3d turned(MesoVec3d v, MesoVec3d w)
{
    MesoVec3d a = meso_vec3d_add(v, meso_vec3d_cross(w, v));
    return meso_vec3d_mad(v, 2 / (1 + meso_vec3d_dot(w, w)), meso_vec3d_cross(w, a));
}

/*
 * The rotation for which the sum of squared distances is least: axes r_k are turned by the sum of r_k x a_k until that is
 * none, a_k being what `moments` has for them ("A Robust Method to Extract the Rotational Part of Deformations",
 * Mueller, Bender, Chentanez and Macklin 2016).
 */
static void turn_to_fit(MesoVec3d r[3], const Moments *m)
{
    for (int i = 0; i < TURNS; i++) {
        MesoVec3d twist = {0, 0, 0};
        double along = 0;
        for (int k = 0; k < 3; k++) {
            twist = meso_vec3d_add(twist, meso_vec3d_cross(r[k], m->columns[k]));
            along += meso_vec3d_dot(r[k], m->columns[k]);
        }
        if (!(fabs(along) > 0))
            return;
        MesoVec3d half = meso_vec3d_scale(twist, 0.5 / fabs(along));
        for (int k = 0; k < 3; k++)
            r[k] = turned(r[k], half);
        if (meso_vec3d_dot(half, half) < 1e-16)
            return;
    }
}

static MesoVec3d unit(MesoVec3d v)
{
    double length = meso_vec3d_length(v);
    return meso_vec3d_scale(v, length > 0 ? 1 / length : 0);
}

/* The frame and the centre with which `rest` [count] lies best on `points`. */
static bool fit(MesoSettleBody *body, const MesoVec3 *points, const MesoVec3 *rest, uint32_t count, MesoVec3 up)
{
    Moments m = moments_of(points, rest, count);
    MesoVec3d r[3] = {{0, 0, 0}, {0, 0, 0}, meso_vec3d(up)};
    if (!axis_towards(&r[0], m.columns[0], r[2])) {
        MesoVec3d y;
        if (!axis_towards(&y, m.columns[1], r[2]))
            return false;
        r[0] = meso_vec3d_cross(y, r[2]);
    }
    r[1] = meso_vec3d_cross(r[2], r[0]);
    turn_to_fit(r, &m);
    r[2] = unit(r[2]);
    r[0] = unit(meso_vec3d_mad(r[0], -meso_vec3d_dot(r[0], r[2]), r[2]));
    r[1] = meso_vec3d_cross(r[2], r[0]);
    MesoVec3d centre = m.middle;
    const double back[3] = {-m.rest_middle.x, -m.rest_middle.y, -m.rest_middle.z};
    for (int k = 0; k < 3; k++)
        centre = meso_vec3d_mad(centre, back[k], r[k]);
    body->pose = (MesoPose){meso_vec3d_narrow(r[0]), meso_vec3d_narrow(r[1]), meso_vec3d_narrow(r[2]),
                            meso_vec3d_narrow(centre)};
    return meso_vec3_finite(body->pose.origin) && meso_vec3_finite(body->pose.x);
}

/* ---- who is near ---- */

static void cell_of(int32_t cell[3], const MesoSettleWork *work, MesoVec3 p)
{
    cell[0] = (int32_t)floorf(p.x / work->cell);
    cell[1] = (int32_t)floorf(p.y / work->cell);
    cell[2] = (int32_t)floorf(p.z / work->cell);
}

static uint32_t bucket_of(const MesoSettleWork *work, const int32_t cell[3])
{
    uint32_t hash = (uint32_t)cell[0] * 73856093u ^ (uint32_t)cell[1] * 19349663u ^ (uint32_t)cell[2] * 83492791u;
    return (hash ^ hash >> 15) & work->mask;
}

static void link_body(MesoSettleWork *work, uint32_t b)
{
    MesoSettleBody *body = &work->bodies[b];
    cell_of(body->cell, work, body->pose.origin);
    uint32_t *head = &work->buckets[bucket_of(work, body->cell)];
    body->next = *head;
    *head = b;
}

void meso_settle_list(MesoSettleWork *work, uint32_t b)
{
    MesoSettleBody *body = &work->bodies[b];
    int32_t cell[3];
    cell_of(cell, work, body->pose.origin);
    if (memcmp(cell, body->cell, sizeof cell) == 0)
        return;
    uint32_t *link = &work->buckets[bucket_of(work, body->cell)];
    while (*link != b)
        link = &work->bodies[*link].next;
    *link = body->next;
    link_body(work, b);
}

uint32_t meso_settle_near(uint32_t *found, uint32_t room, const MesoSettleWork *work, MesoVec3 point)
{
    int32_t middle[3], cell[3];
    uint32_t count = 0;
    cell_of(middle, work, point);
    for (int i = 0; i < 27; i++) {
        cell[0] = middle[0] + i % 3 - 1;
        cell[1] = middle[1] + i / 3 % 3 - 1;
        cell[2] = middle[2] + i / 9 - 1;
        for (uint32_t b = work->buckets[bucket_of(work, cell)]; b != MESO_NO_INDEX; b = work->bodies[b].next)
            if (memcmp(work->bodies[b].cell, cell, sizeof cell) == 0 && !work->bodies[b].gone && count < room)
                found[count++] = b;
    }
    return count;
}

/* ---- bodies ---- */

void meso_settle_set_root(const MesoSettleWork *work, MesoSettleBody *body)
{
    MesoQuiltVertex root = body->place;
    root.height *= ROOT;
    body->root = meso_settle_point(work, root);
}

/* The shortest turn from one direction to another. */
static void turn_with(MesoPose *pose, MesoVec3 from, MesoVec3 to)
{
    MesoVec3d a = meso_vec3d(from), b = meso_vec3d(to);
    double cosine = meso_vec3d_dot(a, b);
    if (cosine < -0.5)
        return;     /* across an edge as sharp as that nothing is as before */
    MesoVec3d half = meso_vec3d_scale(meso_vec3d_cross(a, b), 1 / (1 + cosine));
    MesoVec3d z = unit(turned(meso_vec3d(pose->z), half)), x = turned(meso_vec3d(pose->x), half);
    x = unit(meso_vec3d_mad(x, -meso_vec3d_dot(x, z), z));
    pose->x = meso_vec3d_narrow(x);
    pose->y = meso_vec3d_narrow(meso_vec3d_cross(z, x));
    pose->z = meso_vec3d_narrow(z);
}

bool meso_settle_move(const MesoSettleWork *work, MesoSettleBody *body, MesoVec3 to)
{
    MesoQuiltVertex place = body->place;
    float beyond, height = place.height;
    place.height *= ROOT;
    if (!meso_settle_locate(&place, &beyond, work, to) || beyond > 0)
        return false;
    place.height = height;
    turn_with(&body->pose, meso_settle_up(work, body->place), meso_settle_up(work, place));
    body->place = place;
    body->pose.origin = meso_settle_point(work, place);
    meso_settle_set_root(work, body);
    return true;
}

uint32_t meso_settle_add_body(MesoSettleWork *work, const MesoSettleBody *body, MesoError *error)
{
    if (!(work->bodies = MESO_GROW(work->arena, work->bodies, work->body_count, work->body_room, 64, error)))
        return MESO_NO_INDEX;
    MesoSettleBody *added = &work->bodies[work->body_count];
    *added = *body;
    link_body(work, work->body_count);
    return work->body_count++;
}

/* How far a place is from the sides of its triangle that are borders. */
static float distance_from_border(const MesoSettleWork *work, const MesoQuiltVertex *q)
{
    const uint32_t *v = &work->surface->corners[3 * (size_t)q->triangle];
    const float b[3] = {1 - q->b1 - q->b2, q->b1, q->b2};
    MesoVec3 p[3] = {work->surface->positions[v[0]], work->surface->positions[v[1]], work->surface->positions[v[2]]};
    float least = INFINITY;
    float area = meso_vec3_length(meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0])));
    for (uint32_t k = 0; k < 3; k++) {
        float side = meso_vec3_length(meso_vec3_sub(p[(k + 1) % 3], p[k]));
        if (work->surface->twins[3 * (size_t)q->triangle + k] == MESO_NO_INDEX && side > 0)
            least = fminf(least, b[(k + 2) % 3] * area / side);
    }
    return least;
}

/* What comes near a border is there as it was cut to be. */
static bool is_at_border(const MesoSettleWork *work, const MesoQuilt *quilt, uint32_t element)
{
    for (uint32_t v = quilt->vertex_begin[element]; v < quilt->vertex_begin[element + 1]; v++)
        if (distance_from_border(work, &quilt->vertices[v]) < AT_BORDER * work->spacing)
            return true;
    return false;
}

static double volume_of(const MesoVec3 *points, const uint32_t *corners, uint32_t triangle_count)
{
    double sum = 0;
    for (uint32_t t = 0; t < triangle_count; t++) {
        MesoVec3d o = meso_vec3d(points[0]), p[3];
        for (uint32_t k = 0; k < 3; k++)
            p[k] = meso_vec3d_sub(meso_vec3d(points[corners[3 * (size_t)t + k]]), o);
        sum += meso_vec3d_det(p[0], p[1], p[2]);
    }
    return sum / 6;
}

MesoStatus meso_settle_bend(MesoSettleBody *body, const MesoSettleWork *work, const MesoVec3 *positions, MesoError *error)
{
    const MesoSettleKind *kind = &work->kinds[body->kind];
    double volume = volume_of(positions, kind->corners, kind->triangle_count);
    double share = volume / volume_of(kind->points, kind->corners, kind->triangle_count);
    double wanted = share < 1 - VOLUME_PLAY ? 1 - VOLUME_PLAY : share > 1 + VOLUME_PLAY ? 1 + VOLUME_PLAY : share;
    if (!(share > 0) || kind->member_end - kind->member_begin != 1)
        return MESO_OK;
    body->points = MESO_NEW(work->arena, MesoVec3, kind->point_count, error);
    if (!body->points)
        return MESO_ERR_MEMORY;
    MesoVec3 still = {0, 0, 0};
    for (uint32_t i = 0; i < kind->point_count; i++)
        still = meso_vec3_mad(still, 1 / (float)kind->point_count, positions[i]);
    if (kind->root != MESO_NO_INDEX)
        still = positions[kind->root];
    float scale = (float)cbrt(wanted / share);
    for (uint32_t i = 0; i < kind->point_count; i++)
        body->points[i] = meso_vec3_mad(still, scale, meso_vec3_sub(positions[i], still));
    return MESO_OK;
}

/* The body of an element, where its layer has it. False where it has no shape to speak of. */
static bool find_body(MesoSettleBody *body, const MesoSettleWork *work, const MesoQuilt *quilt,
                      const MesoVec3 *positions, uint32_t element)
{
    uint32_t first = quilt->vertex_begin[element], origin = quilt->element_origins[element];
    uint32_t count = work->swatch->vertex_begin[origin + 1] - work->swatch->vertex_begin[origin];
    const MesoSettleKind *kind = &work->kinds[work->kind_of[origin]];
    if (quilt->vertex_begin[element + 1] - first != count)
        return false;
    *body = (MesoSettleBody){.kind = work->kind_of[origin], .element = element,
                             .patch = quilt->patches[quilt->triangle_begin[element]]};
    body->place = quilt->vertices[first];
    MesoVec3 middle = {0, 0, 0};
    for (uint32_t v = first; v < first + count; v++)
        middle = meso_vec3_mad(middle, 1 / (float)count, positions[v]);
    float beyond;
    if (!meso_settle_locate(&body->place, &beyond, work, middle))
        return false;
    if (!fit(body, &positions[first], kind->points, count, meso_settle_up(work, body->place)))
        return false;
    if (kind->root != MESO_NO_INDEX)    /* a leaf stays at its stem */
        body->pose.origin = meso_vec3_sub(positions[first + kind->root],
                                          meso_settle_to_space(&body->pose, kind->points[kind->root]));
    if (!meso_settle_locate(&body->place, &beyond, work, body->pose.origin))
        return false;
    meso_settle_set_root(work, body);
    body->stays = beyond > 0 || is_at_border(work, quilt, element);
    return true;
}

static MesoStatus make_buckets(MesoSettleWork *work, uint32_t count, MesoError *error)
{
    uint32_t buckets = 64;
    while (buckets < 2 * count && buckets < 1u << 30)
        buckets *= 2;
    work->mask = buckets - 1;
    work->cell = fmaxf(2 * work->reach, 2 * work->spacing);
    work->buckets = MESO_NEW(work->arena, uint32_t, buckets, error);
    if (!work->buckets)
        return MESO_ERR_MEMORY;
    memset(work->buckets, 0xff, buckets * sizeof *work->buckets);
    return MESO_OK;
}

MesoStatus meso_settle_find_bodies(MesoSettleWork *work, const MesoQuilt *quilt, const MesoVec3 *positions,
                                   MesoError *error)
{
    MesoStatus status = make_buckets(work, quilt->element_count, error);
    for (uint32_t e = 0; e < quilt->element_count && !status; e++) {
        MesoSettleBody body;
        if (work->kind_of[quilt->element_origins[e]] == MESO_NO_INDEX || !find_body(&body, work, quilt, positions, e))
            continue;
        if (work->fixed)
            status = meso_settle_bend(&body, work, &positions[quilt->vertex_begin[e]], error);
        if (!status && meso_settle_add_body(work, &body, error) == MESO_NO_INDEX)
            status = error ? error->status : MESO_ERR_MEMORY;
    }
    return status;
}
