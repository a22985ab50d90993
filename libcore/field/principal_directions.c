#include "libcore/field/direction_field.h"
#include "libcore/field/triangle_frames.h"

/* A symmetric 2 x 2 matrix in a triangle's frame, or 3 x 3 in space: xx xy yy, or xx xy xz yy yz zz. */
typedef struct Shape {
    double in[3];
} Shape;

typedef struct SpaceShape {
    double in[6];
    double area;
} SpaceShape;

typedef struct Bends {
    const MesoTriangulation *mesh;
    MesoTriangleFrame *frames;      /* [triangle_count] */
    MesoVec3 *normals;      /* [vertex_count] */
    SpaceShape *shapes;     /* [vertex_count] sums by area of the triangles around */
} Bends;

/* ---- normals ---- */

/* "Weights for Computing Vertex Normals from Facet Normals" (Max 1999): exact on a sphere. */
static void add_normals(const Bends *bends, double (*sums)[3], uint32_t triangle)
{
    const MesoTriangulation *mesh = bends->mesh;
    const MesoTriangleFrame *f = &bends->frames[triangle];
    double normal[3] = {f->x[1] * f->y[2] - f->x[2] * f->y[1], f->x[2] * f->y[0] - f->x[0] * f->y[2],
                        f->x[0] * f->y[1] - f->x[1] * f->y[0]};
    double squares[3];
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 a = mesh->positions[mesh->corners[3 * triangle + k]];
        MesoVec3 b = mesh->positions[mesh->corners[3 * triangle + (k + 1) % 3]];
        double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
        squares[k] = x * x + y * y + z * z;
    }
    for (uint32_t k = 0; k < 3; k++) {
        double sides = squares[k] * squares[(k + 2) % 3];
        for (uint32_t axis = 0; axis < 3 && sides > 0; axis++)
            sums[mesh->corners[3 * triangle + k]][axis] += f->area / sides * normal[axis];
    }
}

static MesoStatus make_normals(Bends *bends, MesoArena *scratch, MesoError *error)
{
    uint32_t n = bends->mesh->vertex_count;
    double (*sums)[3] = meso_arena_alloc(scratch, n, sizeof *sums, error);
    bends->normals = MESO_NEW(scratch, MesoVec3, n, error);
    if (!sums || !bends->normals)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < bends->mesh->triangle_count; t++)
        add_normals(bends, sums, t);
    for (uint32_t v = 0; v < n; v++) {
        double length = sqrt(sums[v][0] * sums[v][0] + sums[v][1] * sums[v][1] + sums[v][2] * sums[v][2]);
        if (length > 0)
            bends->normals[v] = (MesoVec3){(float)(sums[v][0] / length), (float)(sums[v][1] / length),
                                           (float)(sums[v][2] / length)};
    }
    return MESO_OK;
}

/* ---- shape operators ---- */

/* Solves [a b 0; b a + c b; 0 b c] x = r: the normal equations of a symmetric operator; zero where it has none. */
static Shape solve_shape(double a, double b, double c, const double r[3])
{
    double m = a + c, determinant = a * (m * c - b * b) - b * b * c;
    if (!(determinant > 1e-12 * m * m * m))
        return (Shape){{0, 0, 0}};
    double x0 = r[0] * (m * c - b * b) - b * (r[1] * c - b * r[2]);
    double x1 = a * (r[1] * c - b * r[2]) - b * r[0] * c;
    double x2 = a * (m * r[2] - b * r[1]) - b * (b * r[2] - r[0] * b);
    return (Shape){{x0 / determinant, x1 / determinant, x2 / determinant}};
}

/* What takes the sides of a triangle to the differences of the normals at their ends, by least squares. */
static Shape triangle_shape(const Bends *bends, uint32_t triangle)
{
    const MesoTriangulation *mesh = bends->mesh;
    double a = 0, b = 0, c = 0, right[3] = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t from = mesh->corners[3 * triangle + k], to = mesh->corners[3 * triangle + (k + 1) % 3];
        MesoTriangleFrame *frame = &bends->frames[triangle];
        MesoComplex side = meso_frame_in(frame, meso_vec3_sub(mesh->positions[to], mesh->positions[from]));
        MesoComplex bend = meso_frame_in(frame, meso_vec3_sub(bends->normals[to], bends->normals[from]));
        a += side.re * side.re;
        b += side.re * side.im;
        c += side.im * side.im;
        right[0] += side.re * bend.re;
        right[1] += side.re * bend.im + side.im * bend.re;
        right[2] += side.im * bend.im;
    }
    return solve_shape(a, b, c, right);
}

static void add_to_vertices(const Bends *bends, uint32_t triangle)
{
    const MesoTriangleFrame *f = &bends->frames[triangle];
    Shape shape = triangle_shape(bends, triangle);
    for (uint32_t k = 0; k < 3; k++) {
        SpaceShape *sum = &bends->shapes[bends->mesh->corners[3 * triangle + k]];
        uint32_t n = 0;
        sum->area += f->area;
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = i; j < 3; j++, n++)
                sum->in[n] += f->area * (shape.in[0] * f->x[i] * f->x[j] + shape.in[2] * f->y[i] * f->y[j] +
                                         shape.in[1] * (f->x[i] * f->y[j] + f->x[j] * f->y[i]));
    }
}

static double applied(const double in[6], const double a[3], const double b[3])
{
    return a[0] * (in[0] * b[0] + in[1] * b[1] + in[2] * b[2]) + a[1] * (in[1] * b[0] + in[3] * b[1] + in[4] * b[2]) +
           a[2] * (in[2] * b[0] + in[4] * b[1] + in[5] * b[2]);
}

/* The mean of those of its corners, which are smoother than its own. */
static Shape mean_shape(const Bends *bends, uint32_t triangle)
{
    const MesoTriangleFrame *f = &bends->frames[triangle];
    double in[6] = {0};
    for (uint32_t k = 0; k < 3; k++) {
        const SpaceShape *sum = &bends->shapes[bends->mesh->corners[3 * triangle + k]];
        for (uint32_t n = 0; n < 6 && sum->area > 0; n++)
            in[n] += sum->in[n] / (3 * sum->area);
    }
    return (Shape){{applied(in, f->x, f->x), applied(in, f->x, f->y), applied(in, f->y, f->y)}};
}

static void set_direction(const Bends *bends, uint32_t triangle, MesoVec3 *direction, float *weight)
{
    const double flat = 1e-4;   /* radians over a triangle: floats make some 1e-5 of their own */
    const MesoTriangleFrame *frame = &bends->frames[triangle];
    Shape shape = mean_shape(bends, triangle);
    double mean = 0.5 * (shape.in[0] + shape.in[2]), half = 0.5 * (shape.in[0] - shape.in[2]);
    double apart = sqrt(half * half + shape.in[1] * shape.in[1]);
    double most = fabs(mean) + apart, least = fabs(fabs(mean) - apart);
    /* twice the angle of the larger of both, which is that of the larger absolute one where the mean is not negative */
    MesoComplex twice = meso_complex_unit((MesoComplex){half, shape.in[1]});
    if (mean < 0)
        twice = (MesoComplex){-twice.re, -twice.im};
    *direction = meso_frame_out(frame, meso_complex_root(twice, 2));
    *weight = most * sqrt(frame->area) > flat ? (float)((most - least) / (most + least)) : 0;
}

MesoStatus meso_principal_directions(MesoVec3 *directions, float *weights, MesoArena *scratch,
                                     const MesoTriangulation *mesh, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    Bends bends = {.mesh = mesh, .frames = MESO_NEW(scratch, MesoTriangleFrame, mesh->triangle_count, error),
                   .shapes = MESO_NEW(scratch, SpaceShape, mesh->vertex_count, error)};
    MesoStatus status = bends.frames && bends.shapes ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t t = 0; !status && t < mesh->triangle_count; t++)
        bends.frames[t] = meso_frame(mesh, t);
    if (!status)
        status = make_normals(&bends, scratch, error);
    for (uint32_t t = 0; !status && t < mesh->triangle_count; t++)
        add_to_vertices(&bends, t);
    for (uint32_t t = 0; !status && t < mesh->triangle_count; t++)
        set_direction(&bends, t, &directions[t], &weights[t]);
    meso_arena_rewind(scratch, mark);
    return status;
}
