/*
 * Writes a column as an OBJ file to standard output, with texture coordinates once around and once up, so that it can be
 * painted: all of quads, open at both ends, its middle a little thicker.
 */
#include <stdio.h>

#include "scripts/quad_obj.h"

enum { AROUND = 96, UP = 144 };

static const double height = 4, radius = 0.5, swelling = 0.05;

/* How far a point at the share v of the height is from the axis: a foot, the shaft, a head. */
static double distance_at(double v)
{
    double foot = fmax(0, 1 - v / 0.06), head = fmax(0, 1 - (1 - v) / 0.06);
    return radius + swelling * sin(acos(-1) * v) + 0.16 * (foot * foot * (3 - 2 * foot) + head * head * (3 - 2 * head));
}

int main(void)
{
    printf("# column\n");
    for (int row = 0; row <= UP; row++)
        for (int column = 0; column < AROUND; column++) {
            double angle = 2 * acos(-1) * column / AROUND, v = (double)row / UP, r = distance_at(v);
            printf("v %.6f %.6f %.6f\n", r * sin(angle), height * v, r * cos(angle));
        }
    for (int row = 0; row <= UP; row++)
        for (int column = 0; column <= AROUND; column++)
            printf("vt %.6f %.6f\n", (double)column / AROUND, (double)row / UP);
    for (int row = 0; row < UP; row++)
        for (int column = 0; column < AROUND; column++) {
            int next = (column + 1) % AROUND, v = AROUND * row + 1, t = (AROUND + 1) * row + column + 1;
            printf("f %d/%d %d/%d %d/%d %d/%d\n", v + column, t, v + next, t + 1, v + AROUND + next, t + AROUND + 2,
                   v + AROUND + column, t + AROUND + 1);
        }
    return 0;
}
