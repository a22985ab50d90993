#include "libcore/quilt/match/nearest_faces.h"

#include "libcore/math/box.h"
#include "libcore/quilt/match/triangle_distance.h"

/* ---- voxels that faces come near ---- */

/* Voxels from `begin` to `end` whose centres lie within a voxel of an extent; none: begin is not below end. */
static void range_near(float low, float high, float origin, float side, uint32_t count, uint32_t *begin, uint32_t *end)
{
    float first = floorf((low - origin) / side - 0.5f), last = floorf((high - origin) / side - 0.5f) + 2;
    *begin = first > 0 ? first < (float)count ? (uint32_t)first : count : 0;
    *end = last > 0 ? last < (float)count ? (uint32_t)last : count : 0;
}

/* Squares are in voxels. */
static void paint(float *squares, uint32_t *faces, const MesoVoxelGrid *grid, const MesoVec3 corners[3], uint32_t face)
{
    uint32_t begin[3], end[3];
    MesoBox box = meso_box_of(corners, 3);
    range_near(box.low.x, box.high.x, grid->low.x, grid->side, grid->count[0], &begin[0], &end[0]);
    range_near(box.low.y, box.high.y, grid->low.y, grid->side, grid->count[1], &begin[1], &end[1]);
    range_near(box.low.z, box.high.z, grid->low.z, grid->side, grid->count[2], &begin[2], &end[2]);
    float unit = 1 / (grid->side * grid->side);
    for (uint32_t z = begin[2]; z < end[2]; z++)
        for (uint32_t y = begin[1]; y < end[1]; y++)
            for (uint32_t x = begin[0]; x < end[0]; x++) {
                size_t v = ((size_t)z * grid->count[1] + y) * grid->count[0] + x;
                MesoVec3 p = meso_voxel_centre(grid, x, y, z);
                float square = unit * meso_triangle_square(p, corners[0], corners[1], corners[2]);
                if (square <= 1 && square < squares[v]) {
                    squares[v] = square;
                    faces[v] = face;
                }
            }
}

/* ---- the transform ---- */

/* Parabolas over one line, of which those of the lower envelope are kept. */
typedef struct Lines {
    float *values, *begins;     /* [longest] the square at a place, and where a parabola comes to be lowest */
    uint32_t *faces, *tops;     /* [longest] faces at a place, and the tops of parabolas */
    float *halves;              /* [longest] 1 / (2 k) */
} Lines;

static uint32_t longest_of(const MesoVoxelGrid *grid)
{
    uint32_t longest = grid->count[0] > grid->count[1] ? grid->count[0] : grid->count[1];
    return grid->count[2] > longest ? grid->count[2] : longest;
}

size_t meso_nearest_faces_scratch(const MesoVoxelGrid *grid)
{
    return 5 * sizeof(float) * ((size_t)longest_of(grid) + 1);
}

static Lines make_lines(const MesoVoxelGrid *grid, void *scratch)
{
    size_t length = (size_t)longest_of(grid) + 1;
    float *words = scratch;
    Lines lines = {words, words + length, (uint32_t *)scratch + 2 * length, (uint32_t *)scratch + 3 * length,
                   words + 4 * length};
    for (size_t k = 1; k < length; k++)
        lines.halves[k] = 0.5f / (float)k;
    return lines;
}

/* Copies a line out; returns the number of its parabolas that count. */
static uint32_t find_envelope(Lines *lines, const float *squares, const uint32_t *faces, size_t stride, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t q = 0; q < count; q++) {
        float value = squares[q * stride];
        lines->values[q] = value;
        lines->faces[q] = faces[q * stride];
        if (!(value < INFINITY))
            continue;
        float begin = -INFINITY;
        while (kept > 0) {
            uint32_t top = lines->tops[kept - 1];
            begin = (value - lines->values[top]) * lines->halves[q - top] + 0.5f * (float)(q + top);
            if (begin > lines->begins[kept - 1])
                break;
            kept--;
            begin = -INFINITY;
        }
        lines->tops[kept] = q;
        lines->begins[kept++] = begin;
    }
    return kept;
}

static void transform_line(Lines *lines, float *squares, uint32_t *faces, size_t stride, uint32_t count)
{
    uint32_t kept = find_envelope(lines, squares, faces, stride, count);
    if (kept == 0)
        return;
    for (uint32_t q = 0, k = 0; q < count; q++) {
        while (k + 1 < kept && lines->begins[k + 1] <= (float)q)
            k++;
        uint32_t top = lines->tops[k];
        float off = (float)q - (float)top;
        squares[q * stride] = lines->values[top] + off * off;
        faces[q * stride] = lines->faces[top];
    }
}

static void transform(float *squares, uint32_t *faces, const MesoVoxelGrid *grid, void *scratch)
{
    size_t row = grid->count[0], layer = row * grid->count[1];
    Lines lines = make_lines(grid, scratch);
    for (size_t line = 0; line < (size_t)grid->count[1] * grid->count[2]; line++)
        transform_line(&lines, squares + line * row, faces + line * row, 1, grid->count[0]);
    for (size_t z = 0; z < grid->count[2]; z++)
        for (size_t x = 0; x < row; x++)
            transform_line(&lines, squares + z * layer + x, faces + z * layer + x, row, grid->count[1]);
    for (size_t line = 0; line < layer; line++)
        transform_line(&lines, squares + line, faces + line, layer, grid->count[2]);
}

/* ---- all of it ---- */

static void corners_of(MesoVec3 triangle[3], const MesoVec3 *positions, const uint32_t *corners, uint32_t face)
{
    for (uint32_t k = 0; k < 3; k++)
        triangle[k] = positions[corners[3 * (size_t)face + k]];
}

void meso_nearest_faces(uint32_t *faces, float *squares, const MesoVoxelGrid *grid, const MesoVec3 *positions,
                        const uint32_t *corners, const uint32_t *list, uint32_t list_count, void *scratch)
{
    MesoVec3 triangle[3];
    for (size_t v = 0; v < meso_voxel_count(grid); v++) {
        squares[v] = INFINITY;
        faces[v] = MESO_NO_INDEX;
    }
    for (uint32_t i = 0; i < list_count; i++) {
        corners_of(triangle, positions, corners, list[i]);
        paint(squares, faces, grid, triangle, list[i]);
    }
    transform(squares, faces, grid, scratch);
}
