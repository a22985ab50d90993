/*
 * Writes a carnival mask as an OBJ file to standard output: a face with two
 * holes for the eyes, open behind, all of quads. It is seen from +z, with y up.
 */
#include <stdio.h>
#include <stdlib.h>

#include "scripts/quad_obj.h"

/* The face is a disk, whose grid of SIDE x SIDE quads has two gaps: blocks of quads, mirrored. */
enum { SIDE = 24, RINGS = 3, EYE_COLUMN = 4, EYE_ROW = 13, EYE_COLUMNS = 6, EYE_ROWS = 3 };

/* An eye in the plane of the unit disk: the middle of the one at x > 0, and half its width and height. */
static const MesoVec2 eye_middle = {0.41f, 0.16f}, eye_size = {0.21f, 0.1f};

/* The corner of an eye that is away from the nose is higher, by this share of the distance from its middle. */
static const float eye_slant = 0.18f;

/* Far less than between any two vertices of the disk. */
static const float weld_distance = 1e-5f;

/* Gaussian bumps on the face: middle, width and height each. */
typedef struct Bump {
    MesoVec2 middle, size;
    float height;
} Bump;

static const Bump bumps[] = {
    {{0, -0.02f}, {0.10f, 0.20f}, 0.14f},           /* bridge of the nose */
    {{0, -0.16f}, {0.13f, 0.10f}, 0.22f},           /* its tip */
    {{0, -0.44f}, {0.22f, 0.07f}, 0.09f},           /* lips */
    {{0, -0.53f}, {0.16f, 0.05f}, 0.06f},
    {{0.42f, -0.12f}, {0.22f, 0.16f}, 0.06f},       /* cheeks */
    {{-0.42f, -0.12f}, {0.22f, 0.16f}, 0.06f},
    {{0.38f, 0.38f}, {0.28f, 0.08f}, 0.06f},        /* brows */
    {{-0.38f, 0.38f}, {0.28f, 0.08f}, 0.06f}
};

static bool is_eye(uint32_t column, uint32_t row)
{
    uint32_t mirrored = column < SIDE / 2 ? column : SIDE - 1 - column;
    return mirrored >= EYE_COLUMN && mirrored < EYE_COLUMN + EYE_COLUMNS && row >= EYE_ROW && row < EYE_ROW + EYE_ROWS;
}

/*
 * Where the grid's point (i, j) at the border of an eye has its place: a square's border is bent to an ellipse.
 * Points within the gap fall on one at its border, to be welded to it.
 */
static MesoVec3 eyelid(uint32_t i, uint32_t j)
{
    bool right = i > SIDE / 2;
    uint32_t mirrored = right ? SIDE - i : i;
    if (mirrored > EYE_COLUMN && mirrored < EYE_COLUMN + EYE_COLUMNS && j < EYE_ROW + EYE_ROWS)
        j = EYE_ROW;
    float a = 1 - 2 * (float)(mirrored - EYE_COLUMN) / EYE_COLUMNS, b = 2 * (float)(j - EYE_ROW) / EYE_ROWS - 1;
    float x = a * sqrtf(1 - b * b / 2) * eye_size.x, y = b * sqrtf(1 - a * a / 2) * eye_size.y;
    return (MesoVec3){(right ? 1.0f : -1.0f) * (eye_middle.x + x), eye_middle.y + y + eye_slant * x, 0};
}

/* Takes the quads of the eyes, which are among the last SIDE x SIDE, out, and puts the vertices around them in their place. */
static void cut_eyes(ObjMesh *mesh, bool *fixed)
{
    uint32_t begin = mesh->face_count - SIDE * SIDE, kept = begin;
    for (uint32_t f = begin; f < mesh->face_count; f++) {
        uint32_t i = (f - begin) % SIDE, j = (f - begin) / SIDE, *v = &mesh->faces[4 * (size_t)f];
        if (is_eye(i, j)) {
            const uint32_t corners[4][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
            for (int k = 0; k < 4; k++) {
                mesh->positions[v[k]] = eyelid(corners[k][0], corners[k][1]);
                fixed[v[k]] = true;
            }
        } else {
            for (int k = 0; k < 4; k++)
                mesh->faces[4 * (size_t)kept + (size_t)k] = v[k];
            kept++;
        }
    }
    mesh->face_count = kept;
}

/* The grid's first corner is at the angle 0; it belongs at the lower left. */
static MesoVec3 upright(MesoVec3 p)
{
    return (MesoVec3){sqrtf(0.5f) * (p.y - p.x), -sqrtf(0.5f) * (p.x + p.y), 0};
}

/* Bends the disk to a face. */
static MesoVec3 lifted(MesoVec3 p)
{
    float z = sqrtf(fmaxf(1.08f - p.x * p.x - p.y * p.y, 0)) * 0.85f;
    for (size_t i = 0; i < sizeof bumps / sizeof *bumps; i++) {
        float dx = (p.x - bumps[i].middle.x) / bumps[i].size.x, dy = (p.y - bumps[i].middle.y) / bumps[i].size.y;
        z += bumps[i].height * expf(-dx * dx - dy * dy);
    }
    float chin = 1 - 0.22f * fmaxf(-p.y, 0) * fmaxf(-p.y, 0);
    return (MesoVec3){p.x * chin, p.y * 1.32f, z};
}

int main(void)
{
    ObjMesh mesh = {0};
    obj_disk(&mesh, SIDE, RINGS);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        mesh.positions[v] = upright(mesh.positions[v]);
    bool *fixed = calloc(mesh.vertex_count, sizeof *fixed);
    if (!fixed)
        return 1;
    for (uint32_t v = 0; v < 4 * SIDE; v++)
        fixed[v] = true;
    cut_eyes(&mesh, fixed);
    obj_smooth(&mesh, fixed);
    free(fixed);
    obj_weld(&mesh, 0, weld_distance);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        mesh.positions[v] = lifted(mesh.positions[v]);
    obj_finish(&mesh, "mask");
    return 0;
}
