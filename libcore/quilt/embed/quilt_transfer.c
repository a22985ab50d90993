#include "libcore/quilt/embed/quilt_transfer.h"

#include <string.h>

/* Two triangles hold a place if it is so far inside of both, by weights: rounding is not why. */
static const double INSIDE = 1e-4;

/* A place in a triangle is beyond it by no more than rounding. */
static const double ROUNDING = -1e-6;

/* As far beyond a triangle, by weights, it may be taken where no other has the place. */
static const double BEYOND = -0.5;

/* Farther beyond it, by weights, nothing is continued: the triangle is too thin to tell how. */
static const double FAR = 1e4;

/* Triangles by cells of the box around all. */
typedef struct Grid {
    const MesoTextureMesh *mesh;
    double low[2], cells_a_unit[2];
    uint32_t count[2];
    uint32_t *begin;        /* [count[0] * count[1] + 1] of `members` */
    uint32_t *members;
} Grid;

typedef struct Place {
    double x, y;
} Place;

typedef struct Found {
    uint32_t triangle;
    double least;           /* of the weights */
} Found;

/* ---- triangles ---- */

static double area_of(const MesoVec2 *uv)
{
    return ((double)uv[1].x - uv[0].x) * ((double)uv[2].y - uv[0].y) -
           ((double)uv[1].y - uv[0].y) * ((double)uv[2].x - uv[0].x);
}

/* Weights of the corners at a place; false for a triangle without area. */
static bool weights_at(const MesoVec2 *uv, Place at, double weights[3])
{
    double area = area_of(uv), x = at.x - uv[0].x, y = at.y - uv[0].y;
    if (area == 0)
        return false;
    weights[1] = (x * ((double)uv[2].y - uv[0].y) - y * ((double)uv[2].x - uv[0].x)) / area;
    weights[2] = (y * ((double)uv[1].x - uv[0].x) - x * ((double)uv[1].y - uv[0].y)) / area;
    weights[0] = 1 - weights[1] - weights[2];
    return isfinite(weights[1]) && isfinite(weights[2]);
}

static Place place_of(const MesoVec2 *uv, double b1, double b2)
{
    double b0 = 1 - b1 - b2;
    return (Place){b0 * uv[0].x + b1 * uv[1].x + b2 * uv[2].x, b0 * uv[0].y + b1 * uv[1].y + b2 * uv[2].y};
}

/* ---- cells ---- */

static uint32_t cell_along(const Grid *grid, double at, int axis)
{
    double cell = floor((at - grid->low[axis]) * grid->cells_a_unit[axis]);
    return cell > 0 ? (uint32_t)fmin(cell, grid->count[axis] - 1.0) : 0;    /* NaN: the first */
}

typedef struct Cells {
    uint32_t low[2], high[2];
} Cells;

static Cells cells_of(const Grid *grid, uint32_t triangle)
{
    const MesoVec2 *uv = grid->mesh->corner_uvs + 3 * (size_t)triangle;
    return (Cells){{cell_along(grid, fminf(uv[0].x, fminf(uv[1].x, uv[2].x)), 0),
                    cell_along(grid, fminf(uv[0].y, fminf(uv[1].y, uv[2].y)), 1)},
                   {cell_along(grid, fmaxf(uv[0].x, fmaxf(uv[1].x, uv[2].x)), 0),
                    cell_along(grid, fmaxf(uv[0].y, fmaxf(uv[1].y, uv[2].y)), 1)}};
}

static uint64_t count_members(const Grid *grid)
{
    uint64_t count = 0;
    for (uint32_t t = 0; t < grid->mesh->triangle_count; t++) {
        Cells c = cells_of(grid, t);
        count += (uint64_t)(c.high[0] - c.low[0] + 1) * (c.high[1] - c.low[1] + 1);
    }
    return count;
}

static void set_cells(Grid *grid, const double sides[2], double cells)
{
    for (int k = 0; k < 2; k++) {
        double across = sides[1 - k] > 0 ? sides[k] / sides[1 - k] : 1;
        double count = floor(sqrt(cells * fmin(fmax(across, 1 / cells), cells)));
        grid->count[k] = count > 1 ? (uint32_t)count : 1;
        grid->cells_a_unit[k] = sides[k] > 0 ? grid->count[k] / sides[k] : 0;
    }
}

/* About as many cells as triangles; fewer where long triangles would be in too many of them. */
static void choose_cells(Grid *grid)
{
    const MesoTextureMesh *mesh = grid->mesh;
    const uint64_t most = 16 * ((uint64_t)mesh->triangle_count + 1);
    double high[2] = {-INFINITY, -INFINITY};
    grid->low[0] = grid->low[1] = INFINITY;
    for (size_t c = 0; c < 3 * (size_t)mesh->triangle_count; c++) {
        const double at[2] = {mesh->corner_uvs[c].x, mesh->corner_uvs[c].y};
        for (int k = 0; k < 2; k++) {
            grid->low[k] = fmin(grid->low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    const double sides[2] = {high[0] - grid->low[0], high[1] - grid->low[1]};
    for (double cells = fmax(mesh->triangle_count, 1);; cells /= 4) {
        set_cells(grid, sides, fmax(cells, 1));
        if (cells <= 1 || count_members(grid) <= most)
            return;
    }
}

static MesoStatus fill_cells(Grid *grid, MesoArena *scratch, MesoError *error)
{
    size_t cells = (size_t)grid->count[0] * grid->count[1];
    grid->begin = MESO_NEW(scratch, uint32_t, cells + 1, error);
    grid->members = MESO_NEW(scratch, uint32_t, count_members(grid), error);
    if (!grid->begin || !grid->members)
        return MESO_ERR_MEMORY;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t t = grid->mesh->triangle_count; t-- > 0;) {
            Cells c = cells_of(grid, t);
            for (uint32_t y = c.low[1]; y <= c.high[1]; y++)
                for (uint32_t x = c.low[0]; x <= c.high[0]; x++) {
                    uint32_t *end = &grid->begin[(size_t)y * grid->count[0] + x];
                    if (pass == 0)
                        ++*end;
                    else
                        grid->members[--*end] = t;
                }
        }
        for (size_t i = 0; i < cells && pass == 0; i++)
            grid->begin[i + 1] += grid->begin[i];
    }
    return MESO_OK;
}

/* ---- places ---- */

/* The triangle of one cell that has a place best; another that has it too goes to `second`. */
static void look_in(const Grid *grid, size_t cell, Place at, Found *best, Found *second)
{
    for (uint32_t i = grid->begin[cell]; i < grid->begin[cell + 1]; i++) {
        double w[3];
        uint32_t t = grid->members[i];
        if (t == best->triangle || !weights_at(grid->mesh->corner_uvs + 3 * (size_t)t, at, w))
            continue;
        Found found = {t, fmin(w[0], fmin(w[1], w[2]))};
        if (found.least > best->least) {
            *second = *best;
            *best = found;
        } else if (found.least > second->least) {
            *second = found;
        }
    }
}

/* In its own cell, or else around. */
static Found find(const Grid *grid, Place at, Found *second)
{
    Found best = {MESO_NO_INDEX, -INFINITY};
    uint32_t x = cell_along(grid, at.x, 0), y = cell_along(grid, at.y, 1);
    *second = best;
    look_in(grid, (size_t)y * grid->count[0] + x, at, &best, second);
    for (uint32_t j = y ? y - 1 : 0; best.least < ROUNDING && j <= y + 1 && j < grid->count[1]; j++)
        for (uint32_t i = x ? x - 1 : 0; i <= x + 1 && i < grid->count[0]; i++)
            if (i != x || j != y)
                look_in(grid, (size_t)j * grid->count[0] + i, at, &best, second);
    return best;
}

static MesoStatus carry(MesoQuiltVertex *vertex, const MesoTextureMesh *from, const Grid *grid, uint32_t *fault,
                        MesoError *error)
{
    const MesoVec2 *uv = from->corner_uvs + 3 * (size_t)vertex->triangle;
    /* the nearest place of the triangle itself tells the triangle, also for what lies beyond a border */
    double b0 = fmax(1 - (double)vertex->b1 - vertex->b2, 0), b1 = fmax(vertex->b1, 0), b2 = fmax(vertex->b2, 0);
    double sum = b0 + b1 + b2, weights[3] = {1, 0, 0};
    Place at = place_of(uv, b1 / sum, b2 / sum);
    Found second, best = find(grid, at, &second);
    if (!(best.least >= BEYOND))
        return meso_fail(error, MESO_ERR_INPUT, "no face has the texture coordinates %g %g, where the quilt has a "
                         "vertex", at.x, at.y);
    *fault = best.triangle;
    if (second.least > INSIDE)
        return meso_fail(error, MESO_ERR_INPUT, "has the same texture coordinates as another face, around %g %g: the "
                         "place of the quilt's vertex there is not clear", at.x, at.y);
    const MesoVec2 *to = grid->mesh->corner_uvs + 3 * (size_t)best.triangle;
    if ((area_of(uv) > 0) != (area_of(to) > 0))
        return meso_fail(error, MESO_ERR_INPUT, "is wound, in its texture coordinates, against the surface of the "
                         "quilt");
    if (!weights_at(to, place_of(uv, vertex->b1, vertex->b2), weights) || !(fabs(weights[1]) + fabs(weights[2]) < FAR))
        weights_at(to, at, weights);
    *fault = MESO_NO_INDEX;
    vertex->triangle = best.triangle;
    vertex->b1 = (float)weights[1];
    vertex->b2 = (float)weights[2];
    return MESO_OK;
}

MesoStatus meso_quilt_transfer(MesoQuilt *quilt, const MesoTextureMesh *from, const MesoTextureMesh *to,
                               uint32_t *fault, MesoError *error)
{
    MesoArena scratch;
    Grid grid = {.mesh = to};
    *fault = MESO_NO_INDEX;
    meso_arena_init(&scratch);
    choose_cells(&grid);
    MesoStatus status = fill_cells(&grid, &scratch, error);
    for (uint32_t v = 0; v < quilt->vertex_count && !status; v++)
        status = carry(&quilt->vertices[v], from, &grid, fault, error);
    meso_arena_release(&scratch);
    return status;
}
