/*
 * Writes what the pictures of details that replicate are made of as an OBJ file to standard output: surfaces, and meshes
 * that stand on them, from their origins up along z and with x along their heading.
 *
 *     make_scenery creature|sail|hill|scale|tree
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/math/vec.h"

static const double TURN = 6.283185307179586;

static void put_vertex(MesoVec3 p)
{
    printf("v %.6f %.6f %.6f\n", (double)p.x, (double)p.y, (double)p.z);
}

/* ---- a creature: where a sum of rounded limbs ends ---- */

typedef struct Limb {
    MesoVec3 from, to;
    float thick[2];         /* at both ends */
} Limb;

/* It looks along x and stands along z; its other side is its mirror image. */
static const Limb limbs[] = {
    {{-0.75f, 0, 0.78f}, {0.45f, 0, 0.84f}, {0.36f, 0.34f}},        /* body */
    {{0.4f, 0, 0.86f}, {0.95f, 0, 1.22f}, {0.25f, 0.17f}},          /* neck */
    {{0.95f, 0, 1.24f}, {1.32f, 0, 1.18f}, {0.2f, 0.11f}},          /* head */
    {{-0.8f, 0, 0.8f}, {-1.5f, 0, 0.52f}, {0.27f, 0.13f}},          /* tail */
    {{-1.5f, 0, 0.52f}, {-2.2f, 0, 0.62f}, {0.13f, 0.05f}},
    {{0.35f, 0.2f, 0.72f}, {0.45f, 0.36f, 0.34f}, {0.18f, 0.12f}},  /* legs */
    {{0.45f, 0.36f, 0.34f}, {0.42f, 0.36f, 0.02f}, {0.12f, 0.11f}},
    {{-0.7f, 0.22f, 0.7f}, {-0.62f, 0.4f, 0.36f}, {0.22f, 0.13f}},
    {{-0.62f, 0.4f, 0.36f}, {-0.72f, 0.4f, 0.02f}, {0.13f, 0.11f}},
};

static double distance_to(const Limb *limb, MesoVec3 p)
{
    MesoVec3 along = meso_vec3_sub(limb->to, limb->from), from = meso_vec3_sub(p, limb->from);
    float s = fminf(fmaxf(meso_vec3_dot(along, from) / meso_vec3_dot(along, along), 0), 1);
    MesoVec3 d = meso_vec3_sub(from, meso_vec3_scale(along, s));
    return (double)(meso_vec3_length(d) - (limb->thick[0] + s * (limb->thick[1] - limb->thick[0])));
}

/* Negative inside; limbs run into each other. */
static double creature_at(MesoVec3 p)
{
    const double soft = 0.045;
    double sum = 0;
    p.y = fabsf(p.y);
    for (size_t i = 0; i < sizeof limbs / sizeof *limbs; i++)
        sum += exp(-distance_to(&limbs[i], p) / soft);
    return -soft * log(sum);
}

enum { NX = 118, NY = 50, NZ = 52 };

static const MesoVec3 low = {-2.45f, -0.8f, -0.2f};
static const float cell = 0.034f;

static MesoVec3 grid_at(uint32_t x, uint32_t y, uint32_t z)
{
    return (MesoVec3){low.x + cell * (float)x, low.y + cell * (float)y, low.z + cell * (float)z};
}

static uint32_t number_of(uint32_t x, uint32_t y, uint32_t z)
{
    return (z * NY + y) * NX + x;
}

/* The middle of where a cell's edges are crossed, moved onto the surface; false where none is. */
static int find_vertex(const double *values, uint32_t x, uint32_t y, uint32_t z, MesoVec3 *place)
{
    MesoVec3 sum = {0, 0, 0};
    float count = 0;
    for (uint32_t a = 0; a < 8; a++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t b = a | 1u << k;
            if (b == a)
                continue;
            double va = values[number_of(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2))];
            double vb = values[number_of(x + (b & 1), y + (b >> 1 & 1), z + (b >> 2))];
            if ((va < 0) == (vb < 0))
                continue;
            MesoVec3 pa = grid_at(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2));
            MesoVec3 pb = grid_at(x + (b & 1), y + (b >> 1 & 1), z + (b >> 2));
            sum = meso_vec3_add(sum, meso_vec3_lerp(pa, pb, (float)(va / (va - vb))));
            count++;
        }
    *place = count > 0 ? meso_vec3_scale(sum, 1 / count) : sum;
    return count > 0;
}

/* A vertex for each cell that the surface goes through, a quad for each edge ("Constrained Elastic Surface Nets", 1998). */
static void put_creature(void)
{
    double *values = malloc(sizeof *values * NX * NY * NZ);
    uint32_t *vertices = calloc((size_t)NX * NY * NZ, sizeof *vertices), count = 0;
    if (!values || !vertices)
        exit(33);
    for (uint32_t z = 0; z < NZ; z++)
        for (uint32_t y = 0; y < NY; y++)
            for (uint32_t x = 0; x < NX; x++)
                values[number_of(x, y, z)] = creature_at(grid_at(x, y, z));
    for (uint32_t z = 0; z + 1 < NZ; z++)
        for (uint32_t y = 0; y + 1 < NY; y++)
            for (uint32_t x = 0; x + 1 < NX; x++) {
                MesoVec3 place;
                if (!find_vertex(values, x, y, z, &place))
                    continue;
                vertices[number_of(x, y, z)] = ++count;
                put_vertex(place);
            }
    for (uint32_t z = 1; z + 1 < NZ; z++)
        for (uint32_t y = 1; y + 1 < NY; y++)
            for (uint32_t x = 1; x + 1 < NX; x++)
                for (uint32_t k = 0; k < 3; k++) {
                    const uint32_t step[3] = {1, NX, NX * NY};
                    uint32_t at = number_of(x, y, z), u = step[(k + 1) % 3], v = step[(k + 2) % 3];
                    int inside = values[at] < 0;
                    if (inside == (values[at + step[k]] < 0))
                        continue;
                    uint32_t quad[4] = {vertices[at], vertices[at - u], vertices[at - u - v], vertices[at - v]};
                    printf("f %u %u %u %u\n", quad[0], quad[inside ? 1 : 3], quad[2], quad[inside ? 3 : 1]);
                }
    free(values);
    free(vertices);
}

/* ---- sheets ---- */

/* Of `columns` x `rows` quads; `place` by shares of both sides. */
static void put_sheet(uint32_t columns, uint32_t rows, MesoVec3 (*place)(double u, double v))
{
    for (uint32_t j = 0; j <= rows; j++)
        for (uint32_t i = 0; i <= columns; i++)
            put_vertex(place((double)i / columns, (double)j / rows));
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            uint32_t a = j * (columns + 1) + i + 1, b = a + columns + 1;
            printf("f %u %u %u %u\n", a, a + 1, b + 1, b);
        }
}

/* A square sail, narrower above, with some wind in it and a round foot. */
static MesoVec3 sail_at(double u, double v)
{
    double wide = 1.15 - 0.25 * v, x = wide * (2 * u - 1), belly = (1 - (2 * u - 1) * (2 * u - 1)) * v * (1 - v);
    double foot = 0.18 * (1 - (2 * u - 1) * (2 * u - 1)) * (1 - v);
    return (MesoVec3){(float)x, (float)(-0.8 * belly), (float)(2 * v + foot - 1)};
}

static double mound(double x, double y, double at_x, double at_y, double wide)
{
    return exp(-((x - at_x) * (x - at_x) + (y - at_y) * (y - at_y)) / (wide * wide));
}

static MesoVec3 hill_at(double u, double v)
{
    double x = 4 * u - 2, y = 4 * v - 2;
    double z = 0.45 * mound(x, y, 0.1, 0.2, 0.9) + 0.25 * mound(x, y, -1.2, -0.6, 0.6) +
               0.2 * mound(x, y, 1.2, -0.9, 0.5) + 0.03 * sin(3 * x + 1) * sin(2.6 * y);
    return (MesoVec3){(float)x, (float)y, (float)z};
}

/* ---- what stands on them ---- */

/* A ring of `sides` vertices around z. */
static void put_ring(uint32_t sides, double radius, double z, double lean)
{
    for (uint32_t i = 0; i < sides; i++) {
        double a = TURN * i / sides, r = radius * (1 + 0.12 * lean * cos(5 * a));
        put_vertex((MesoVec3){(float)(r * cos(a)), (float)(r * sin(a)), (float)z});
    }
}

/* Quads between two rings, of which the lower begins at vertex `first`. */
static void join_rings(uint32_t first, uint32_t sides)
{
    for (uint32_t i = 0; i < sides; i++) {
        uint32_t j = (i + 1) % sides;
        printf("f %u %u %u %u\n", first + i, first + j, first + sides + j, first + sides + i);
    }
}

/* A fir: a trunk and three cones. */
static void put_tree(void)
{
    static const struct { double radius, low, high; } cones[] = {
        {0.3, 0.22, 0.62}, {0.24, 0.45, 0.82}, {0.17, 0.66, 1.05}};
    const uint32_t sides = 10;
    uint32_t first = 1;
    printf("usemtl trunk\n");
    put_ring(sides, 0.05, -0.05, 0);
    put_ring(sides, 0.04, 0.3, 0);
    join_rings(first, sides);
    first += 2 * sides;
    printf("usemtl needles\n");
    for (int c = 0; c < 3; c++, first += 2 * sides) {
        put_ring(sides, cones[c].radius, cones[c].low, 1);
        put_ring(sides, 0.012, cones[c].high, 0);
        join_rings(first, sides);
        printf("f");
        for (uint32_t i = sides; i-- > 0;)
            printf(" %u", first + i);
        printf("\nf");
        for (uint32_t i = 0; i < sides; i++)
            printf(" %u", first + sides + i);
        printf("\n");
    }
}

/* A shield with a keel, its root before the origin and its round end raised behind it; it lies over the next one. */
static MesoVec3 scale_at(double u, double v, double under)
{
    double x = v - 0.35, wide = 0.46 * sqrt(fmax(0, 1 - pow(1.06 * v - 0.06, 4))) * (0.75 + 0.5 * v * (1 - v));
    double y = wide * (2 * u - 1), keel = 0.09 * (1 - fabs(2 * u - 1)) * (1 - 0.4 * v);
    double lift = 0.05 + 0.16 * v;
    return (MesoVec3){(float)x, (float)y, (float)(under > 0 ? lift - 0.05 : lift + keel)};
}

static void put_scale(void)
{
    const uint32_t columns = 6, rows = 7;
    for (uint32_t side = 0; side < 2; side++)
        for (uint32_t j = 0; j <= rows; j++)
            for (uint32_t i = 0; i <= columns; i++)
                put_vertex(scale_at((double)i / columns, 0.02 + 0.97 * j / rows, side));
    uint32_t half = (columns + 1) * (rows + 1);
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            uint32_t a = j * (columns + 1) + i + 1, b = a + columns + 1;
            printf("f %u %u %u %u\n", a, b, b + 1, a + 1);
            printf("f %u %u %u %u\n", half + a, half + a + 1, half + b + 1, half + b);
        }
    for (uint32_t j = 0; j < rows; j++) {       /* its rims */
        uint32_t a = j * (columns + 1) + 1, b = a + columns + 1, c = a + columns, d = b + columns;
        printf("f %u %u %u %u\n", a, half + a, half + b, b);
        printf("f %u %u %u %u\n", c, d, half + d, half + c);
    }
    for (uint32_t i = 1; i <= columns; i++) {
        uint32_t a = i, b = rows * (columns + 1) + i;
        printf("f %u %u %u %u\n", a, a + 1, half + a + 1, half + a);
        printf("f %u %u %u %u\n", b, half + b, half + b + 1, b + 1);
    }
}

int main(int argc, char **argv)
{
    const char *what = argc == 2 ? argv[1] : "";
    if (strcmp(what, "creature") == 0)
        put_creature();
    else if (strcmp(what, "sail") == 0)
        put_sheet(36, 36, sail_at);
    else if (strcmp(what, "hill") == 0)
        put_sheet(64, 64, hill_at);
    else if (strcmp(what, "scale") == 0)
        put_scale();
    else if (strcmp(what, "tree") == 0)
        put_tree();
    else {
        fprintf(stderr, "usage: make_scenery creature|sail|hill|scale|tree\n");
        return 2;
    }
    return 0;
}
