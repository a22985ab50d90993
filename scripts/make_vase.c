/*
 * Writes the demo's vase as an OBJ file to standard output: a surface of
 * revolution with an open top and a bottom closed by a disk, all of quads.
 *
 *     make_vase [COLUMNS ROWS]     columns a multiple of 4
 */
#include <stdio.h>
#include <stdlib.h>

#include "scripts/quad_obj.h"

/* Control points (radius, height) of a uniform cubic B-spline, foot to lip. */
static const MesoVec2 profile[] = {
    {0.66f, 0.00f}, {0.76f, 0.00f}, {0.87f, 0.02f}, {0.88f, 0.18f}, {0.90f, 0.44f}, {1.08f, 0.78f},
    {1.27f, 1.20f}, {1.28f, 1.72f}, {1.06f, 2.16f}, {0.78f, 2.48f}, {0.68f, 2.78f}, {0.74f, 3.04f},
    {0.90f, 3.20f}, {1.02f, 3.24f}
};

enum {
    PROFILE_COUNT = sizeof profile / sizeof *profile,
    SAMPLES = 4096,             /* of the profile, for its length */
    DISK_RINGS = 2,
    FOOT_ROW = 8                /* counted from 1 at the disk */
};

static MesoVec2 control(int i)
{
    return profile[i < 0 ? 0 : i >= PROFILE_COUNT ? PROFILE_COUNT - 1 : i];
}

/* Point of the spline at `t` in [0,1]; both ends are on the curve, with the end tangents of the polygon. */
static MesoVec2 profile_point(float t)
{
    float x = t * (float)(PROFILE_COUNT + 1);
    int i = x >= (float)(PROFILE_COUNT + 1) ? PROFILE_COUNT : (int)x;
    float s = x - (float)i, r = 1 - s;
    float w[4] = {r * r * r / 6, (3 * s * s * s - 6 * s * s + 4) / 6, (3 * r * r * r - 6 * r * r + 4) / 6,
                  s * s * s / 6};
    MesoVec2 sum = {0, 0};
    for (int k = 0; k < 4; k++) {
        MesoVec2 p = control(i + k - 2);
        sum = meso_vec2_add(sum, (MesoVec2){w[k] * p.x, w[k] * p.y});
    }
    return sum;
}

/*
 * Rows whose heights are proportional to their radius keep the quads square,
 * as 4 * side of them go around: length is measured in units of the radius.
 */
static void profile_rows(MesoVec2 *rows, uint32_t row_count)
{
    static float length[SAMPLES + 1];
    for (int i = 1; i <= SAMPLES; i++) {
        MesoVec2 a = profile_point((float)(i - 1) / SAMPLES), b = profile_point((float)i / SAMPLES);
        length[i] = length[i - 1] + meso_vec2_length(meso_vec2_sub(b, a)) / (0.5f * (a.x + b.x));
    }
    int i = 0;
    for (uint32_t r = 0; r <= row_count; r++) {
        float want = length[SAMPLES] * (float)r / (float)row_count;
        while (i < SAMPLES - 1 && length[i + 1] <= want)
            i++;
        float step = length[i + 1] - length[i];
        rows[r] = profile_point(((float)i + (step > 0 ? fminf((want - length[i]) / step, 1) : 1)) / SAMPLES);
    }
}

/*
 * The faces of row FOOT_ROW begin at the opposite corner, so that their tiles
 * stand on their heads: a tile that allows no rotation has its place there,
 * or everywhere but there.
 */
static void make_vase(ObjMesh *mesh, uint32_t side, const MesoVec2 *rows, uint32_t row_count)
{
    uint32_t around = 4 * side, below = obj_disk(mesh, side, DISK_RINGS);

    /* The disk lies in the plane y = 0 and is seen from below; x and z of its vertices turn the way
     * that the columns do. */
    for (uint32_t v = below; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        mesh->positions[v] = (MesoVec3){rows[0].x * p.x, rows[0].y, -rows[0].x * p.y};
    }
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t *v = &mesh->faces[4 * (size_t)f], swap = v[1];
        v[1] = v[3], v[3] = swap;
    }
    for (uint32_t r = 1; r <= row_count; r++) {
        uint32_t above = mesh->vertex_count;
        for (uint32_t k = 0; k < around; k++) {
            double angle = 2 * acos(-1) * k / around;
            obj_vertex(mesh, (MesoVec3){rows[r].x * (float)cos(angle), rows[r].y, -rows[r].x * (float)sin(angle)});
        }
        for (uint32_t k = 0; k < around; k++) {
            uint32_t next = (k + 1) % around;
            if (r == FOOT_ROW)
                obj_face(mesh, above + k, below + k, below + next, above + next);
            else
                obj_face(mesh, below + next, above + next, above + k, below + k);
        }
        below = above;
    }
}

int main(int argc, char **argv)
{
    int columns = argc == 3 ? atoi(argv[1]) : 64, row_count = argc == 3 ? atoi(argv[2]) : 46;
    if ((argc != 1 && argc != 3) || columns < 8 || columns > 4096 || columns % 4 || row_count < 4 ||
        row_count > 65536) {
        fprintf(stderr, "usage: make_vase [COLUMNS ROWS]\n");
        return 2;
    }
    MesoVec2 *rows = calloc((size_t)row_count + 1, sizeof *rows);
    if (!rows)
        return 1;
    profile_rows(rows, (uint32_t)row_count);
    ObjMesh mesh = {0};
    make_vase(&mesh, (uint32_t)columns / 4, rows, (uint32_t)row_count);
    free(rows);
    obj_finish(&mesh, "vase");
    return 0;
}
