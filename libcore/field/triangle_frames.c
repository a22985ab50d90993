#include "libcore/field/triangle_frames.h"

static void side_of(double side[3], const MesoTriangulation *mesh, uint32_t half_edge)
{
    MesoVec3 a = mesh->positions[mesh->corners[half_edge]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(half_edge)]];
    side[0] = (double)b.x - a.x;
    side[1] = (double)b.y - a.y;
    side[2] = (double)b.z - a.z;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Something across a vector, for triangles without area. */
static void set_across(double y[3], const double x[3])
{
    uint32_t least = fabs(x[1]) < fabs(x[0]) ? 1 : 0;
    least = fabs(x[2]) < fabs(x[least]) ? 2 : least;
    for (uint32_t k = 0; k < 3; k++)
        y[k] = (k == least) - x[least] * x[k];
}

static bool make_unit(double v[3])
{
    double length = sqrt(dot(v, v));
    if (!(length > 0))
        return false;
    for (uint32_t k = 0; k < 3; k++)
        v[k] /= length;
    return true;
}

MesoTriangleFrame meso_frame(const MesoTriangulation *mesh, uint32_t triangle)
{
    const double thinnest = 1e-7;   /* of the longest side, below which floats do not tell where its plane is */
    double sides[3][3];
    uint32_t longest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        side_of(sides[k], mesh, 3 * triangle + k);
        longest = dot(sides[k], sides[k]) > dot(sides[longest], sides[longest]) ? k : longest;
    }
    MesoTriangleFrame frame = {{sides[longest][0], sides[longest][1], sides[longest][2]}, {0}, 0};
    double length = sqrt(dot(frame.x, frame.x));
    if (!make_unit(frame.x))
        frame.x[0] = 1;
    double along = dot(sides[(longest + 1) % 3], frame.x);
    for (uint32_t k = 0; k < 3; k++)
        frame.y[k] = sides[(longest + 1) % 3][k] - along * frame.x[k];
    double up = sqrt(dot(frame.y, frame.y));
    if (!(up > thinnest * length))
        set_across(frame.y, frame.x);
    make_unit(frame.y);
    frame.area = 0.5 * length * up;
    return frame;
}

static MesoComplex side_in(const MesoTriangulation *mesh, const MesoTriangleFrame *frame, uint32_t half_edge)
{
    double side[3];
    side_of(side, mesh, half_edge);
    return (MesoComplex){dot(side, frame->x), dot(side, frame->y)};
}

MesoComplex meso_frame_turn(const MesoTriangulation *mesh, const MesoTriangleFrame *frames, uint32_t half_edge,
                            uint32_t across)
{
    MesoComplex here = side_in(mesh, &frames[half_edge / 3], half_edge);
    MesoComplex there = side_in(mesh, &frames[across / 3], across);
    /* the half-edge across runs the other way */
    return meso_complex_unit(meso_complex_times((MesoComplex){-there.re, -there.im}, meso_complex_conjugate(here)));
}
