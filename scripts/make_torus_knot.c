/*
 * Writes a torus knot, a closed tube of quads, as an OBJ file to standard
 * output. It lies in the plane z = 0, to be looked at from +z.
 *
 *     make_torus_knot [P Q]     P turns about the axis, Q through the hole, without a common divisor (2 3)
 */
#include <stdio.h>
#include <stdlib.h>

#include "scripts/quad_obj.h"

enum {
    AROUND = 16,                /* quads around the tube */
    ALONG = 96                  /* quads along it in each turn about the axis */
};

static const float axis_radius = 1.6f, torus_radius = 0.7f, tube_radius = 0.33f;

/* Where the middle of the tube is at `t`, an angle, and the torus' normal there. */
static MesoVec3 knot_point(int p, int q, double t, MesoVec3 *normal)
{
    float around = (float)(p * t), through = (float)(q * t);
    *normal = (MesoVec3){cosf(through) * cosf(around), cosf(through) * sinf(around), sinf(through)};
    MesoVec3 axis = {axis_radius * cosf(around), axis_radius * sinf(around), 0};
    return meso_vec3_add(axis, meso_vec3_scale(*normal, torus_radius));
}

/* The frame of the torus comes back to where it began, as that of a curve by itself need not. */
static void add_ring(ObjMesh *mesh, int p, int q, double t)
{
    const double step = 1e-2;
    MesoVec3 normal, other, middle = knot_point(p, q, t, &normal);
    MesoVec3 along = meso_vec3_sub(knot_point(p, q, t + step, &other), knot_point(p, q, t - step, &other));
    MesoVec3 side = meso_vec3_unit(meso_vec3_cross(along, normal), (MesoVec3){0, 0, 1});
    for (int k = 0; k < AROUND; k++) {
        float angle = (float)(2 * acos(-1) * k / AROUND);
        MesoVec3 out = meso_vec3_add(meso_vec3_scale(normal, cosf(angle)), meso_vec3_scale(side, sinf(angle)));
        obj_vertex(mesh, meso_vec3_add(middle, meso_vec3_scale(out, tube_radius)));
    }
}

static int greatest_common_divisor(int a, int b)
{
    return b ? greatest_common_divisor(b, a % b) : a;
}

int main(int argc, char **argv)
{
    int p = argc == 3 ? atoi(argv[1]) : 2, q = argc == 3 ? atoi(argv[2]) : 3;
    if ((argc != 1 && argc != 3) || p < 1 || p > 64 || q < 1 || q > 64 || greatest_common_divisor(p, q) != 1) {
        fprintf(stderr, "usage: make_torus_knot [P Q]\n");
        return 2;
    }
    ObjMesh mesh = {0};
    uint32_t along = (uint32_t)p * ALONG;
    for (uint32_t r = 0; r < along; r++)
        add_ring(&mesh, p, q, 2 * acos(-1) * r / along);
    for (uint32_t r = 0; r < along; r++)
        for (uint32_t k = 0; k < AROUND; k++) {
            uint32_t here = r * AROUND, there = (r + 1) % along * AROUND, next = (k + 1) % AROUND;
            obj_face(&mesh, here + k, here + next, there + next, there + k);
        }
    obj_finish(&mesh, "torus knot");
    return 0;
}
