#include "libcore/quilt/seam/bodies_meet.h"

#include "libcore/math/box.h"

static MesoVec3 corner(const MesoBodyPart *part, uint32_t triangle, uint32_t k)
{
    return part->points[part->corners[3 * (size_t)triangle + k] - part->first];
}

static MesoBox triangle_box(const MesoBodyPart *part, uint32_t triangle)
{
    MesoVec3 points[3] = {corner(part, triangle, 0), corner(part, triangle, 1), corner(part, triangle, 2)};
    return meso_box_of(points, 3);
}

static bool boxes_meet(const MesoBox *a, const MesoBox *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

static float volume(MesoVec3 a, MesoVec3 b, MesoVec3 c, MesoVec3 d)
{
    return meso_vec3_dot(meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a)), meso_vec3_sub(d, a));
}

/* Whether a segment whose ends are so far above a triangle goes through it. */
static bool segment_crosses(MesoVec3 p, float above, MesoVec3 q, float below, const MesoVec3 *t)
{
    if (!((above > 0 && below < 0) || (above < 0 && below > 0)))
        return false;
    float a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

bool meso_triangles_cross(const MesoVec3 *p, const MesoVec3 *q)
{
    float above_q[3], above_p[3];
    for (int k = 0; k < 3; k++) {
        above_q[k] = volume(q[0], q[1], q[2], p[k]);
        above_p[k] = volume(p[0], p[1], p[2], q[k]);
    }
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3;
        if (segment_crosses(p[k], above_q[k], p[l], above_q[l], q) ||
            segment_crosses(q[k], above_p[k], q[l], above_p[l], p))
            return true;
    }
    return false;
}

static bool parts_cross(const MesoBodyPart *a, uint32_t s, const MesoBodyPart *b, uint32_t t)
{
    const MesoVec3 p[3] = {corner(a, s, 0), corner(a, s, 1), corner(a, s, 2)};
    const MesoVec3 q[3] = {corner(b, t, 0), corner(b, t, 1), corner(b, t, 2)};
    return meso_triangles_cross(p, q);
}

/* Triangles of `b` that are looked at together. */
enum { CHUNK = 1024 };

typedef struct Chunk {
    uint32_t count;
    uint32_t triangles[CHUNK];
    MesoBox boxes[CHUNK];
} Chunk;

/* The next triangles of a part, from `*next` on, that reach into `common`. */
static void fill_chunk(Chunk *chunk, const MesoBodyPart *part, uint32_t *next, const MesoBox *common)
{
    chunk->count = 0;
    for (; *next < part->triangle_count && chunk->count < CHUNK; ++*next) {
        MesoBox box = triangle_box(part, *next);
        if (boxes_meet(&box, common)) {
            chunk->triangles[chunk->count] = *next;
            chunk->boxes[chunk->count++] = box;
        }
    }
}

static bool meets_chunk(const MesoBodyPart *a, const MesoBodyPart *b, const Chunk *chunk, const MesoBox *common)
{
    for (uint32_t s = 0; s < a->triangle_count; s++) {
        MesoBox box = triangle_box(a, s);
        if (!boxes_meet(&box, common))
            continue;
        for (uint32_t i = 0; i < chunk->count; i++)
            if (boxes_meet(&box, &chunk->boxes[i]) && parts_cross(a, s, b, chunk->triangles[i]))
                return true;
    }
    return false;
}

bool meso_bodies_meet(const MesoBodyPart *a, const MesoBodyPart *b)
{
    MesoBox p = meso_box_of(a->points, a->point_count), q = meso_box_of(b->points, b->point_count);
    if (!boxes_meet(&p, &q))
        return false;
    MesoBox common = {{p.low.x > q.low.x ? p.low.x : q.low.x, p.low.y > q.low.y ? p.low.y : q.low.y,
                       p.low.z > q.low.z ? p.low.z : q.low.z},
                      {p.high.x < q.high.x ? p.high.x : q.high.x, p.high.y < q.high.y ? p.high.y : q.high.y,
                       p.high.z < q.high.z ? p.high.z : q.high.z}};
    for (uint32_t next = 0; next < b->triangle_count;) {
        Chunk chunk;
        fill_chunk(&chunk, b, &next, &common);
        if (chunk.count && meets_chunk(a, b, &chunk, &common))
            return true;
    }
    return false;
}
