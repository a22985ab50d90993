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

/* ---- the chair: the border of the cells within blocks, made smooth ---- */

enum { CHAIR_X = 26, CHAIR_Y = 26, CHAIR_Z = 54, CHAIR_VERTICES = (CHAIR_X + 1) * (CHAIR_Y + 1) * (CHAIR_Z + 1) };

static const double CHAIR_CELL = 0.06;

/* First and last cells of seat, back, its posts, legs. */
static const int CHAIR_BLOCKS[8][6] = {
    {0, 0, 22, 25, 25, 26}, {0, 21, 35, 25, 25, 53}, {0, 21, 27, 4, 25, 34}, {21, 21, 27, 25, 25, 34},
    {0, 0, 0, 4, 4, 21},    {21, 0, 0, 25, 4, 21},   {0, 21, 0, 4, 25, 21},  {21, 21, 0, 25, 25, 21}};

static bool in_chair(int x, int y, int z)
{
    for (int i = 0; i < 8; i++) {
        const int *b = CHAIR_BLOCKS[i];
        if (x >= b[0] && y >= b[1] && z >= b[2] && x <= b[3] && y <= b[4] && z <= b[5])
            return true;
    }
    return false;
}

static uint32_t chair_vertex(const int at[3])
{
    return (uint32_t)((at[2] * (CHAIR_Y + 1) + at[1]) * (CHAIR_X + 1) + at[0]);
}

/* The corners of a cell's side, wound so that its normal leaves the cell. */
static void chair_side(const int cell[3], int axis, int up, uint32_t quad[4])
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int k = 0; k < 4; k++) {
        int at[3];
        at[axis] = cell[axis] + up;
        at[(axis + 1) % 3] = cell[(axis + 1) % 3] + around[k][0];
        at[(axis + 2) % 3] = cell[(axis + 2) % 3] + around[k][1];
        quad[up ? k : 3 - k] = chair_vertex(at);
    }
}

static uint32_t chair_quads(uint32_t (*quads)[4])
{
    uint32_t count = 0;
    for (int z = 0; z < CHAIR_Z; z++)
        for (int y = 0; y < CHAIR_Y; y++)
            for (int x = 0; x < CHAIR_X; x++)
                for (int side = 0; in_chair(x, y, z) && side < 6; side++) {
                    int cell[3] = {x, y, z}, next[3] = {x, y, z}, axis = side / 2, up = side % 2;
                    next[axis] += up ? 1 : -1;
                    if (!in_chair(next[0], next[1], next[2]))
                        chair_side(cell, axis, up, quads[count++]);
                }
    return count;
}

/* Moves each vertex `by` of the way to the mean of its neighbours. */
static void chair_smooth(MesoVec3 *points, uint32_t count, uint32_t (*quads)[4], double by)
{
    static double sum[CHAIR_VERTICES][4];
    memset(sum, 0, sizeof sum);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 4; k++) {
            MesoVec3 next = points[quads[i][(k + 1) % 4]];
            double *to = sum[quads[i][k]];
            to[0] += (double)next.x, to[1] += (double)next.y, to[2] += (double)next.z, to[3] += 1;
        }
    for (uint32_t i = 0; i < CHAIR_VERTICES; i++)
        if (sum[i][3] > 0) {
            double x = (double)points[i].x, y = (double)points[i].y, z = (double)points[i].z, n = sum[i][3];
            points[i] = point(x + by * (sum[i][0] / n - x), y + by * (sum[i][1] / n - y), z + by * (sum[i][2] / n - z));
        }
}

static void write_chair(void)
{
    static MesoVec3 points[CHAIR_VERTICES];
    static uint32_t quads[6 * CHAIR_X * CHAIR_Y * CHAIR_Z][4], names[CHAIR_VERTICES];
    uint32_t count = chair_quads(quads), named = 0;
    for (int z = 0; z <= CHAIR_Z; z++)
        for (int y = 0; y <= CHAIR_Y; y++)
            for (int x = 0; x <= CHAIR_X; x++)
                points[chair_vertex((int[]){x, y, z})] =
                    point((x - 13) * CHAIR_CELL, (y - 13) * CHAIR_CELL, (z - 27) * CHAIR_CELL);
    for (int round = 0; round < 24; round++) {
        chair_smooth(points, count, quads, 0.5);
        chair_smooth(points, count, quads, -0.3);
    }
    printf("# chair\n");
    for (uint32_t i = 0; i < 4 * count; i++) {
        uint32_t vertex = quads[i / 4][i % 4];
        if (names[vertex] > 0)
            continue;
        names[vertex] = ++named;
        MesoVec3 p = points[vertex];
        printf("v %.6f %.6f %.6f 0.07 0.04 0.02\n", (double)p.x, (double)p.y, (double)p.z);
    }
    for (uint32_t i = 0; i < count; i++)
        printf("f %u %u %u %u\n", names[quads[i][0]], names[quads[i][1]], names[quads[i][2]], names[quads[i][3]]);
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
