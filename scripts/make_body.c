/*
 * Writes one of the bodies that the pictures of quilts are grown over as an OBJ file to standard output, with texture
 * coordinates: u goes around a body, v along it.
 *
 *     make_body torso|cup|chair|bust|column|fish
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "libcore/math/vec.h"

static const double TURN = 6.283185307179586;

/* A place of a body: `u` around, `v` along, both from 0 to 1. */
typedef MesoVec3 (*Place)(double u, double v);

typedef struct Body {
    const char *name;
    Place place;
    uint32_t around, along;     /* quads */
    bool low_pole, high_pole;   /* closed by triangles there */
    double turns, slope;        /* of u around the body, and along it: texture that winds */
    double color[3];            /* linear */
} Body;

static double bump(double x, double middle, double width)
{
    double d = (x - middle) / width;
    return exp(-d * d);
}

/* From 0 at `low` to 1 at `high`, without a corner. */
static double rise(double x, double low, double high)
{
    double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

static MesoVec3 point(double x, double y, double z)
{
    return (MesoVec3){(float)x, (float)y, (float)z};
}

/* ---- bodies ---- */

/* From the hips to the neck, open at both ends. */
static MesoVec3 on_torso(double u, double v)
{
    double c = cos(TURN * u), s = sin(TURN * u), neck = rise(v, 0.8, 0.97);
    double wide = 0.62 - 0.12 * bump(v, 0.3, 0.2) + 0.2 * bump(v, 0.78, 0.25) - 0.02 * v;
    double deep = 0.42 - 0.05 * bump(v, 0.3, 0.2) + 0.06 * bump(v, 0.62, 0.2);
    double chest = s < 0 ? 1 + 0.2 * bump(v, 0.62, 0.12) * (bump(c, 0.45, 0.35) + bump(c, -0.45, 0.35)) : 1;
    double x = (wide + neck * (0.24 - wide)) * c, y = (deep + neck * (0.22 - deep)) * s * chest;
    return point(x, y, 2 * v - 0.1 * neck - 0.06 * bump(v, 0.82, 0.1) * c * c);
}

/* One profile, turned: from the middle of the bottom up outside, over the rim, and down to the middle inside. */
static MesoVec3 on_cup(double u, double v)
{
    static const double profile[][2] = {{0, 0}, {0.4, 0}, {0.5, 0.04}, {0.62, 0.3}, {0.72, 0.8}, {0.78, 1.25},
                                        {0.75, 1.31}, {0.71, 1.26}, {0.66, 0.85}, {0.55, 0.36}, {0.4, 0.14}, {0, 0.1}};
    enum { LAST = sizeof profile / sizeof *profile - 1 };
    double t = v * LAST;
    int i = t >= LAST ? LAST - 1 : (int)t;
    double f = t - i, w[4] = {(1 - f) * (1 - f) * (1 - f) / 6, (3 * f * f * f - 6 * f * f + 4) / 6,
                              (3 * f * (1 + f - f * f) + 1) / 6, f * f * f / 6}, at[2] = {0, 0};
    for (int k = 0; k < 4; k++) {
        int j = i + k - 1;
        /* mirrored at the axis */
        const double *p = profile[j < 0 ? -j : j > LAST ? 2 * LAST - j : j];
        at[0] += w[k] * (j < 0 || j > LAST ? -p[0] : p[0]);
        at[1] += w[k] * p[1];
    }
    return point(at[0] * cos(TURN * u), at[0] * sin(TURN * u), at[1]);
}

/* A head on its neck, open at the breast. */
static MesoVec3 on_bust(double u, double v)
{
    double c = cos(TURN * u), s = sin(TURN * u), front = fmax(-s, 0);
    double head = sqrt(fmax(0, 1 - pow((v - 0.7) / 0.3, 2))), shoulders = 1 - rise(v, 0.02, 0.3);
    double r = v > 0.62 ? 0.52 * head : 0.52 * sqrt(1 - pow(0.08 / 0.3, 2)) - 0.2 * (1 - rise(v, 0.38, 0.62));
    double x = (r + 0.75 * shoulders) * c, y = (1.15 * r + 0.22 * shoulders) * s;
    double face = bump(c, 0, 0.2) * front;
    y -= 0.14 * face * bump(v, 0.66, 0.06) + 0.05 * face * bump(v, 0.5, 0.06) - 0.05 * front * bump(v, 0.74, 0.05);
    y -= 0.08 * front * bump(v, 0.48, 0.08);
    return point(x, y - 0.1 * rise(v, 0.3, 0.6), 2.3 * v);
}

/* Its texture winds around it. */
static MesoVec3 on_column(double u, double v)
{
    double r = 0.5 - 0.06 * v + 0.14 * bump(v, 0, 0.05) + 0.12 * bump(v, 1, 0.05);
    return point(r * cos(TURN * u), r * sin(TURN * u), 4 * v);
}

/* From the nose to the tail along x, flat behind. */
static MesoVec3 on_fish(double u, double v)
{
    double c = cos(TURN * u), s = sin(TURN * u), tail = rise(v, 0.78, 1), body = sin(TURN / 2 * pow(v, 0.75));
    double high = 0.52 * pow(fmax(body, 0), 0.7) * (1 - 0.75 * rise(v, 0.45, 0.85)) + 0.75 * tail * sqrt(fmax(0, 1 - v));
    double wide = 0.3 * pow(fmax(body, 0), 0.8) * (1 - 0.8 * rise(v, 0.4, 0.85)) + 0.02 * (1 - rise(v, 0.97, 1));
    double fin = 0.35 * bump(v, 0.42, 0.13) * pow(fmax(s, 0), 8);
    return point(2.6 * v + 0.25 * tail * s * s, wide * c * (v > 0 && v < 1), (high + fin) * s * (v > 0));
}

static const Body BODIES[] = {
    {"torso", on_torso, 64, 72, false, false, 1, 0, {0.09, 0.05, 0.04}},
    {"cup", on_cup, 72, 110, true, true, 1, 0, {0.5, 0.5, 0.5}},
    {"bust", on_bust, 72, 90, false, true, 1, 0, {0.2, 0.07, 0.03}},
    {"column", on_column, 48, 96, false, false, 1, 1.1, {0.5, 0.47, 0.4}},
    {"fish", on_fish, 56, 100, true, true, -1, 0, {0.03, 0.07, 0.07}},
};
enum { BODY_COUNT = sizeof BODIES / sizeof *BODIES };

/* ---- files ---- */

static uint32_t vertex_at(const Body *b, uint32_t first, uint32_t column, uint32_t row)
{
    uint32_t below = b->low_pole ? 1 : 0;
    if (b->low_pole && row == 0)
        return first;
    if (b->high_pole && row == b->along)
        return first + below + b->around * (b->along - below);
    return first + below + b->around * (row - below) + column % b->around;
}

static void write_corner(const Body *b, uint32_t column, uint32_t row)
{
    printf(" %u/%u", vertex_at(b, 1, column, row), row * (b->around + 1) + column + 1);
}

static void write_face(const Body *b, uint32_t column, uint32_t row)
{
    printf("f");
    write_corner(b, column, row);
    if (!(b->low_pole && row == 0))
        write_corner(b, column + 1, row);
    write_corner(b, column + 1, row + 1);
    if (!(b->high_pole && row + 1 == b->along))
        write_corner(b, column, row + 1);
    printf("\n");
}

static void write_body(const Body *b)
{
    printf("# %s\n", b->name);
    for (uint32_t row = 0; row <= b->along; row++) {
        bool pole = (b->low_pole && row == 0) || (b->high_pole && row == b->along);
        for (uint32_t column = 0; column < (pole ? 1 : b->around); column++) {
            MesoVec3 p = b->place((double)column / b->around, (double)row / b->along);
            printf("v %.6f %.6f %.6f %g %g %g\n", (double)p.x, (double)p.y, (double)p.z, b->color[0], b->color[1],
                   b->color[2]);
        }
    }
    for (uint32_t row = 0; row <= b->along; row++)
        for (uint32_t column = 0; column <= b->around; column++) {
            double u = (double)column / b->around, v = (double)row / b->along;
            printf("vt %.6f %.6f\n", b->turns * u + b->slope * v, v);
        }
    for (uint32_t row = 0; row < b->along; row++)
        for (uint32_t column = 0; column < b->around; column++)
            write_face(b, column, row);
}

/* Six blocks with round edges: seat, back, four legs. */
static MesoVec3 on_block(double u, double v, const double block[6])
{
    double z = -cos(TURN / 2 * v), r = sin(TURN / 2 * v), p[3] = {r * cos(TURN * u), r * sin(TURN * u), z}, sum = 0;
    for (int k = 0; k < 3; k++)
        sum += pow(fabs(p[k]), 5);
    double by = pow(sum, -0.2);
    return point(block[0] + block[3] * by * p[0], block[1] + block[4] * by * p[1], block[2] + block[5] * by * p[2]);
}

static void write_chair(void)
{
    static const double blocks[6][6] = {
        {0, 0, 0, 0.75, 0.75, 0.14}, {0, 0.68, 1, 0.72, 0.13, 0.72},
        {-0.6, -0.6, -0.9, 0.14, 0.14, 0.66}, {0.6, -0.6, -0.9, 0.14, 0.14, 0.66},
        {-0.6, 0.6, -0.9, 0.14, 0.14, 0.66}, {0.6, 0.6, -0.9, 0.14, 0.14, 0.66}};
    enum { N = 48, M = 32 };
    const Body shape = {.around = N, .along = M, .low_pole = true, .high_pole = true};
    printf("# chair\n");
    for (uint32_t i = 0; i < 6; i++)
        for (uint32_t row = 0; row <= M; row++)
            for (uint32_t column = 0; column < (row % M ? N : 1); column++) {
                MesoVec3 p = on_block((double)column / N, (double)row / M, blocks[i]);
                printf("v %.6f %.6f %.6f 0.07 0.04 0.02\n", (double)p.x, (double)p.y, (double)p.z);
            }
    for (uint32_t i = 0; i < 6; i++)
        for (uint32_t row = 0; row < M; row++)
            for (uint32_t column = 0; column < N; column++) {
                uint32_t first = 1 + i * (N * (M - 1) + 2);
                printf("f %u", vertex_at(&shape, first, column, row));
                if (row > 0)
                    printf(" %u", vertex_at(&shape, first, column + 1, row));
                printf(" %u", vertex_at(&shape, first, column + 1, row + 1));
                printf(row + 1 < M ? " %u\n" : "\n", vertex_at(&shape, first, column, row + 1));
            }
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "chair") == 0) {
        write_chair();
        return fflush(stdout) != 0;
    }
    for (int i = 0; argc == 2 && i < BODY_COUNT; i++)
        if (strcmp(argv[1], BODIES[i].name) == 0) {
            write_body(&BODIES[i]);
            return fflush(stdout) != 0;
        }
    fprintf(stderr, "usage: make_body torso|cup|chair|bust|column|fish\n");
    return 2;
}
