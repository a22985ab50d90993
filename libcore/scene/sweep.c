#include "libcore/scene/sweep.h"

#include "libcore/math/bezier.h"

/* The plane of one ring, with lengths scaled from edge lengths to the scene. */
typedef struct Plane {
    MesoVec3 origin, x, y, tangent;
    float speed;    /* |B'| */
} Plane;

/*
 * X and Y span the plane across `tangent`. Where the up direction lies along
 * the tangent there is no such plane; any one across it will do.
 */
static Plane make_plane(MesoVec3 origin, MesoVec3 up, MesoVec3 tangent, float speed)
{
    MesoVec3 axis = fabsf(tangent.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 fallback = meso_vec3_unit(meso_vec3_cross(axis, tangent), axis);
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(up, tangent), fallback);
    return (Plane){origin, x, meso_vec3_cross(tangent, x), tangent, speed};
}

/* At the ends all comes from the ports alone: the neighbour computes the same floats. */
static Plane sweep_plane(const MesoSweepInstance *sweep, float v)
{
    if (v == 0 || v == 1) {
        uint32_t end = v == 1;
        float speed = 3 * meso_vec3_length(meso_vec3_sub(sweep->p[end ? 3 : 1], sweep->p[end ? 2 : 0]));
        return make_plane(sweep->p[end ? 3 : 0], sweep->up[end], sweep->direction[end], speed);
    }
    MesoVec3 derivative = meso_bezier_derivative(sweep->p, v);
    MesoVec3 tangent = meso_vec3_unit(derivative, sweep->direction[v > 0.5f]);
    return make_plane(meso_bezier_point(sweep->p, v), meso_vec3_lerp(sweep->up[0], sweep->up[1], v),
                      tangent, meso_vec3_length(derivative));
}

static MesoVec3 in_plane(const Plane *plane, MesoVec2 n)
{
    return (MesoVec3){n.x * plane->x.x + n.y * plane->y.x, n.x * plane->x.y + n.y * plane->y.y,
                      n.x * plane->x.z + n.y * plane->y.z};
}

static MesoMeshVertex sweep_vertex(const Plane *plane, MesoVec2 s, MesoVec3 normal, float scale,
                                   float u, float v)
{
    return (MesoMeshVertex){meso_vec3_mad(plane->origin, scale, in_plane(plane, s)),
                            meso_vec3_unit(normal, plane->x), {u, v}};
}

static void tube_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                          const MesoSweepGrid *grid, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    float scale = scene->section_scale;
    uint32_t last = grid->ring_count - 1;
    for (uint32_t ring = 0; ring <= last; ring++) {
        float v = (float)ring / (float)last, w = v * v * (3 - 2 * v);
        Plane plane = sweep_plane(sweep, v);
        float tilt_scale = plane.speed > 0 ? scale * 6 * v * (1 - v) / plane.speed : 0;
        for (uint32_t c = 0; c < grid->column_count; c++) {
            const MesoSweepColumn *column = &columns[grid->columns ? grid->columns[c] : c];
            MesoVec2 at = ring == 0 ? column->start : ring == last ? column->end
                        : meso_vec2_lerp(column->start, column->end, w);
            MesoVec2 n = meso_vec2_lerp(column->start_normal, column->end_normal, w);
            MesoVec2 change = meso_vec2_sub(column->end, column->start);
            float tilt = tilt_scale * (change.x * n.x + change.y * n.y);
            MesoVec3 normal = meso_vec3_mad(in_plane(&plane, n), -tilt, plane.tangent);
            *out++ = sweep_vertex(&plane, at, normal, scale, column->u, v);
        }
    }
}

static void cap_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *cap,
                         const MesoSweepGrid *grid, MesoMeshVertex *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    float scale = scene->section_scale;
    uint32_t last = grid->ring_count - 1;
    for (uint32_t ring = 0; ring <= last; ring++) {
        float v = (float)ring / (float)last, radius = 1 - v * v * v * v;
        Plane plane = make_plane(cap->p[0], cap->up[0], cap->direction[0], 0);
        plane.origin = meso_vec3_mad(plane.origin, scale * MESO_CAP_RISE * v, plane.tangent);
        for (uint32_t c = 0; c < grid->column_count; c++) {
            const MesoSweepColumn *column = &columns[grid->columns ? grid->columns[c] : c];
            MesoVec2 at = column->start, n = column->start_normal;
            float lean = 4 * v * v * v * (at.x * n.x + at.y * n.y);
            MesoVec3 normal = meso_vec3_mad(meso_vec3_scale(in_plane(&plane, n), MESO_CAP_RISE), lean, plane.tangent);
            *out++ = sweep_vertex(&plane, (MesoVec2){radius * at.x, radius * at.y}, normal, scale, column->u, v);
        }
    }
}

MesoVec3 meso_sweep_point(const MesoScene *scene, const MesoSweepInstance *sweep, MesoVec2 profile, float v)
{
    Plane plane = sweep_plane(sweep, v);
    return meso_vec3_mad(plane.origin, scene->section_scale, in_plane(&plane, profile));
}

void meso_sweep_grid(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                     const MesoSweepGrid *grid, MesoMeshVertex *out)
{
    (kind->cap ? cap_vertices : tube_vertices)(scene, kind, sweep, grid, out);
}

void meso_sweep_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out)
{
    const MesoSweepGrid whole = {.column_count = kind->column_count, .ring_count = kind->division_count};
    meso_sweep_grid(scene, kind, sweep, &whole, out);
}

/* The rings run clockwise around the tangent: along, then around is counter-clockwise from outside. */
void meso_sweep_faces(const MesoScene *scene, const MesoSweptKind *kind, uint32_t base, MesoMeshFace *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t width = kind->column_count, last = kind->division_count - 1;
    for (uint32_t ring = 0; ring < last; ring++)
        for (uint32_t c = 0; c < width; c++) {
            if (!columns[c].joins_next)
                continue;
            uint32_t here = base + ring * width + c, ahead = here + width;
            bool tip = kind->cap && ring + 1 == last;
            *out++ = (MesoMeshFace){{here, ahead, tip ? here + 1 : ahead + 1, tip ? MESO_NO_INDEX : here + 1}};
        }
}
