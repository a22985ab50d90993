#include "libcore/replicate/detail/surface_detail.h"

#include "libcore/base/parallel.h"
#include "libcore/field/triangle_frames.h"

enum { GRAIN = 1024 };

typedef struct Placing {
    MesoPlacedDetail *out;
    const MesoTriangulation *rest;
    const MesoVec3 *positions, *normals;
    const MesoDetail *details;
    const float *grown;
} Placing;

/* Sides 0 and 2 of a triangle, from its first corner. */
static void sides_of(const MesoTriangulation *rest, const MesoVec3 *positions, uint32_t triangle, MesoVec3 sides[2])
{
    const uint32_t *corners = rest->corners + 3 * (size_t)triangle;
    for (int k = 0; k < 2; k++)
        sides[k] = meso_vec3_sub(positions[corners[k + 1]], positions[corners[0]]);
}

/* Columns of F, from the frame of the triangle at rest to space now. False where the triangle had no area. */
static bool deformation(const Placing *p, uint32_t triangle, MesoVec3 columns[2])
{
    MesoVec3 before[2], now[2];
    sides_of(p->rest, p->rest->positions, triangle, before);
    sides_of(p->rest, p->positions, triangle, now);
    const MesoTriangleFrame frame = meso_frame(p->rest, triangle);
    MesoComplex a = meso_frame_in(&frame, before[0]), b = meso_frame_in(&frame, before[1]);
    double area = a.re * b.im - a.im * b.re;
    if (!(fabs(area) > 0))
        return false;
    /* F (a b) = (now[0] now[1]) */
    float xa = (float)(b.im / area), xb = (float)(-a.im / area), ya = (float)(-b.re / area), yb = (float)(a.re / area);
    columns[0] = meso_vec3_mad(meso_vec3_scale(now[0], xa), xb, now[1]);
    columns[1] = meso_vec3_mad(meso_vec3_scale(now[0], ya), yb, now[1]);
    return true;
}

/*
 * R d, for a direction d in the triangle's frame: U = (C + sqrt(det C) I) / sqrt(tr C + 2 sqrt(det C)), C = F'F. Not of
 * unit length where the triangle has none now.
 */
static MesoVec3 turned(const MesoVec3 columns[2], float x, float y)
{
    double a = meso_vec3_dot(columns[0], columns[0]), b = meso_vec3_dot(columns[0], columns[1]);
    double c = meso_vec3_dot(columns[1], columns[1]), root = sqrt(fmax(0, a * c - b * b));
    double scale = sqrt(a + c + 2 * root), det = (a + root) * (c + root) - b * b;
    if (!(det > 0))
        return (MesoVec3){0, 0, 0};
    double u = scale * ((c + root) * x - b * y) / det, v = scale * ((a + root) * y - b * x) / det;
    return meso_vec3_mad(meso_vec3_scale(columns[0], (float)u), (float)v, columns[1]);
}

static MesoVec3 normal_at(const Placing *p, const MesoMeshPoint *point)
{
    return meso_vec3_unit(meso_detail_position(p->rest, p->normals, point), (MesoVec3){0, 0, 1});
}

/* Any direction at right angles to one of unit length. */
static MesoVec3 across(MesoVec3 n)
{
    MesoVec3 axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    return meso_vec3_unit(meso_vec3_cross(n, axis), axis);
}

static MesoPlacedDetail place(const Placing *p, const MesoDetail *detail, float grown)
{
    MesoPlacedDetail out = {.position = meso_detail_position(p->rest, p->positions, &detail->point),
                            .normal = normal_at(p, &detail->point)};
    MesoVec3 columns[2], heading = {0, 0, 0};
    if (deformation(p, detail->point.triangle, columns))
        heading = turned(columns, cosf(detail->angle), sinf(detail->angle));
    heading = meso_vec3_mad(heading, -meso_vec3_dot(heading, out.normal), out.normal);
    bool there = meso_vec3_length(heading) > 1e-6f;
    out.tangent = there ? meso_vec3_unit(heading, heading) : across(out.normal);
    out.size = there ? grown * detail->size : 0;
    out.width = there ? grown * detail->width : 0;
    return out;
}

static void place_range(void *context, uint64_t begin, uint64_t end)
{
    const Placing *p = context;
    for (uint64_t i = begin; i < end; i++)
        p->out[i] = place(p, &p->details[i], p->grown ? p->grown[i] : 1);
}

void meso_details_place(MesoPlacedDetail *out, const MesoTriangulation *rest, const MesoVec3 *positions,
                        const MesoVec3 *normals, const MesoDetail *details, const float *grown, uint32_t count,
                        uint32_t thread_count)
{
    Placing placing = {out, rest, positions, normals, details, grown};
    meso_parallel_for(thread_count, count, GRAIN, place_range, &placing);
}

MesoVec3 meso_detail_heading(const MesoTriangulation *rest, const MesoVec3 *positions, const MesoDetail *detail)
{
    const Placing p = {.rest = rest, .positions = positions};
    const MesoVec3 none = {0, 0, 0};
    MesoVec3 columns[2];
    if (!deformation(&p, detail->point.triangle, columns))
        return none;
    return meso_vec3_unit(turned(columns, cosf(detail->angle), sinf(detail->angle)), none);
}

static double area_of(const MesoTriangulation *rest, const MesoVec3 *positions, uint32_t triangle)
{
    MesoVec3 sides[2];
    sides_of(rest, positions, triangle, sides);
    return 0.5 * (double)meso_vec3_length(meso_vec3_cross(sides[0], sides[1]));
}

double meso_stretch_of_area(const MesoTriangulation *rest, const MesoVec3 *positions, uint32_t triangle)
{
    double before = area_of(rest, rest->positions, triangle);
    return before > 0 ? area_of(rest, positions, triangle) / before : 0;
}
