#include "libcore/mesh/edit/ear_clip.h"

#include <math.h>

#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/origins.h"

typedef struct Point {
    double x, y;
} Point;

/* One face: a ring of corners that have not been clipped. */
typedef struct Ring {
    const MesoPolygonMesh *mesh;
    MesoMeshCopies *copies;
    uint32_t begin, face;
    Point *points;              /* [largest face] in the face's plane, which is seen from outside */
    uint32_t *next, *before;    /* [largest face] */
    uint32_t *hollow;           /* [hollow_count] corners that were not convex at first */
    uint32_t hollow_count;
} Ring;

static void add_triangle(const Ring *ring, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t *corners = ring->mesh->corners + ring->begin;
    meso_mesh_copies_corner(ring->copies, ring->begin + a, corners[a]);
    meso_mesh_copies_corner(ring->copies, ring->begin + b, corners[b]);
    meso_mesh_copies_corner(ring->copies, ring->begin + c, corners[c]);
    meso_mesh_copies_face(ring->copies, ring->face);
}

/* ---- quads ---- */

static double squared_distance(MesoVec3 a, MesoVec3 b)
{
    double x = (double)a.x - b.x, y = (double)a.y - b.y, z = (double)a.z - b.z;
    return x * x + y * y + z * z;
}

/* Whether both triangles on the sides of the diagonal from corner k are wound as the quad is. */
static bool lies_inside(const MesoVec3 p[4], MesoAreaVector area, uint32_t k)
{
    MesoVec3 a = p[k], b = p[k + 1], c = p[k + 2], d = p[(k + 3) % 4];
    return meso_area_dot(meso_area_between(a, b, c), area) > 0 && meso_area_dot(meso_area_between(a, c, d), area) > 0;
}

/* Squares of diagonals that differ by less are equal. */
#define DIAGONAL_TIE 0.9999

static void cut_quad(const Ring *ring)
{
    MesoVec3 p[4];
    for (uint32_t k = 0; k < 4; k++)
        p[k] = ring->mesh->positions[ring->mesh->corners[ring->begin + k]];
    MesoAreaVector area = meso_face_area(ring->mesh, ring->face);
    bool first = lies_inside(p, area, 0), second = lies_inside(p, area, 1);
    /* equal but for rounding, diagonals are the same everywhere: copies of a quad are cut alike */
    if (second && (!first || squared_distance(p[1], p[3]) < DIAGONAL_TIE * squared_distance(p[0], p[2]))) {
        add_triangle(ring, 0, 1, 3);
        add_triangle(ring, 1, 2, 3);
        return;
    }
    add_triangle(ring, 0, 1, 2);
    add_triangle(ring, 0, 2, 3);
}

/* ---- others ---- */

static double turn(Point a, Point b, Point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Along the axis on which the area vector is longest; turns keep their sign. */
static void project(const Ring *ring, uint32_t sides)
{
    MesoAreaVector n = meso_face_area(ring->mesh, ring->face);
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    for (uint32_t i = 0; i < sides; i++) {
        MesoVec3 p = ring->mesh->positions[ring->mesh->corners[ring->begin + i]];
        Point q = x >= y && x >= z ? (Point){(double)p.y, (double)p.z}
                  : y >= z         ? (Point){(double)p.z, (double)p.x}
                                   : (Point){(double)p.x, (double)p.y};
        if ((x >= y && x >= z ? n.x : y >= z ? n.y : n.z) < 0)
            q.x = -q.x;
        ring->points[i] = q;
    }
}

static bool is_convex(const Ring *ring, uint32_t i)
{
    return turn(ring->points[ring->before[i]], ring->points[i], ring->points[ring->next[i]]) > 0;
}

static bool same_point(Point a, Point b)
{
    return a.x == b.x && a.y == b.y;
}

/* Convex, and without another corner in its triangle; only hollow ones can be the first that comes in. */
static bool is_ear(const Ring *ring, uint32_t i)
{
    Point a = ring->points[ring->before[i]], b = ring->points[i], c = ring->points[ring->next[i]];
    if (!is_convex(ring, i))
        return false;
    for (uint32_t k = 0; k < ring->hollow_count; k++) {
        uint32_t h = ring->hollow[k];
        Point p = ring->points[h];
        bool clipped = ring->next[ring->before[h]] != h;
        if (clipped || same_point(p, a) || same_point(p, b) || same_point(p, c))
            continue;
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
            return false;
    }
    return true;
}

static void clip(const Ring *ring, uint32_t i)
{
    uint32_t before = ring->before[i], next = ring->next[i];
    add_triangle(ring, before, i, next);
    ring->next[before] = next;
    ring->before[next] = before;
}

/* Where a whole round finds no ear, as in faces without area, the next corner goes. */
static void cut_polygon(Ring *ring, uint32_t sides)
{
    ring->hollow_count = 0;
    project(ring, sides);
    for (uint32_t i = 0; i < sides; i++) {
        ring->next[i] = i + 1 < sides ? i + 1 : 0;
        ring->before[i] = i > 0 ? i - 1 : sides - 1;
    }
    for (uint32_t i = 0; i < sides; i++)
        if (!is_convex(ring, i))
            ring->hollow[ring->hollow_count++] = i;
    uint32_t at = 1, tried = 0;
    for (uint32_t left = sides; left > 3;) {
        if (tried < left && !is_ear(ring, at)) {
            tried++;
            at = ring->next[at];
            continue;
        }
        uint32_t next = ring->next[at];
        clip(ring, at);
        left--;
        tried = 0;
        at = ring->next[next];      /* not the same corner again and again: no slivers where there need be none */
    }
    add_triangle(ring, ring->before[at], at, ring->next[at]);
}

static MesoStatus init_ring(Ring *ring, MesoArena *scratch, MesoError *error)
{
    uint32_t most = ring->mesh->side_count;
    for (uint32_t f = 0; f < ring->mesh->face_count && ring->mesh->face_begin; f++)
        most = meso_polygon_sides(ring->mesh, f) > most ? meso_polygon_sides(ring->mesh, f) : most;
    ring->points = MESO_NEW(scratch, Point, most, error);
    ring->next = MESO_NEW(scratch, uint32_t, most, error);
    ring->before = MESO_NEW(scratch, uint32_t, most, error);
    ring->hollow = MESO_NEW(scratch, uint32_t, most, error);
    return ring->points && ring->next && ring->before && ring->hollow ? MESO_OK : MESO_ERR_MEMORY;
}

static void cut_face(Ring *ring, uint32_t face)
{
    uint32_t sides = meso_polygon_sides(ring->mesh, face);
    ring->face = face;
    ring->begin = meso_polygon_begin(ring->mesh, face);
    if (sides == 3)
        add_triangle(ring, 0, 1, 2);
    else if (sides == 4)
        cut_quad(ring);
    else
        cut_polygon(ring, sides);
}

MesoStatus meso_mesh_cut_faces(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, MesoError *error)
{
    MesoArena scratch;
    MesoMeshCopies copies;
    Ring ring = {.mesh = from, .copies = &copies};
    meso_arena_init(&scratch);
    uint64_t triangles = from->corner_count - 2 * (uint64_t)from->face_count;
    MesoStatus status = meso_mesh_copies_init(&copies, &scratch, triangles, 3 * triangles, error);
    if (!status)
        status = init_ring(&ring, &scratch, error);
    for (uint32_t f = 0; f < from->face_count && !status; f++)
        cut_face(&ring, f);
    if (!status)
        status = meso_mesh_copies_build(mesh, arena, from, &copies, error);
    meso_arena_release(&scratch);
    return status;
}
