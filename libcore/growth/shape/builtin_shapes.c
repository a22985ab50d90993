#include "libcore/growth/shape/terminal_shape.h"

#include <math.h>

typedef struct Point {
    double x, y, z;
} Point;

/*
 * A shape is one or two sheets: the places of a grid over the unit square. The derivative along u, cross that along v,
 * points outward.
 */
typedef struct Recipe {
    Point (*place)(double u, double v, uint32_t sheet);
    uint32_t sheet_count;
    uint32_t across, across_more;   /* divisions of u at detail 0, and more of them a detail */
    uint32_t along, along_more;     /* of v */
    bool u_wraps, v_wraps;
    bool has_poles;                 /* v of 0 and of 1 is a point each */
} Recipe;

const char *const meso_builtin_shape_names[MESO_BUILTIN_SHAPES] = {"leaf", "scale", "bead", "link", "tube"};

static Point tube_place(double u, double v, uint32_t sheet)
{
    (void)sheet;
    return (Point){v, 0.5 * cos(2 * MESO_PI * u), 0.5 * sin(2 * MESO_PI * u)};
}

static Point bead_place(double u, double v, uint32_t sheet)
{
    (void)sheet;
    double radius = v == 0 || v == 1 ? 0 : 0.5 * sin(MESO_PI * v);
    return (Point){0.5 - 0.5 * cos(MESO_PI * v), radius * cos(2 * MESO_PI * u), radius * sin(2 * MESO_PI * u)};
}

/* An ellipse offset by a round rod, drawn where a link is 1.6 times as long as wide. */
static Point link_place(double u, double v, uint32_t sheet)
{
    (void)sheet;
    const double length = 1.6, rod = 0.12, a = length / 2 - rod, b = 0.5 - rod;
    double c = cos(2 * MESO_PI * u), s = sin(2 * MESO_PI * u), out = rod * cos(2 * MESO_PI * v);
    double stretch = out / sqrt(b * c * b * c + a * s * a * s);
    return (Point){(length / 2 - (a + stretch * b) * c) / length, (b + stretch * a) * s,
                   -rod * sin(2 * MESO_PI * v)};
}

/* A sheet's place from that of the middle: sheet 0 looks up, and goes from the left to the right; 1 is its back. */
static Point sheet_place(double u, double v, uint32_t sheet, double half, double middle, double thickness)
{
    double s = sheet == 0 ? 1 - 2 * u : 2 * u - 1;
    return (Point){v, half * s, middle + (sheet == 0 ? 0.5 : -0.5) * thickness};
}

/* Widest at 0.4 of its length; rises from its root, hangs again at the tip, and nowhere comes below its root. */
static Point leaf_place(double u, double v, uint32_t sheet)
{
    double s = 2 * u - 1, half = 0.5 * pow(v / 0.4, 0.6) * pow((1 - v) / 0.6, 0.9);
    double middle = 0.75 * v * (1.25 - v) + 0.5 * half * (sqrt(s * s + 0.02) - sqrt(0.02));
    return sheet_place(u, v, sheet, half, middle, 0.24 * half * half * (1 - s * s));
}

/* Flat below, and rising a little, so that it covers the root of the next. */
static Point scale_place(double u, double v, uint32_t sheet)
{
    double s = 2 * u - 1, half = 0.5 * sqrt(1 - pow(fabs(2 * pow(v, 0.9) - 1), 2.6));
    double thickness = 0.5 * half * (1 - s * s) * (1 - 0.5 * v);
    return sheet_place(u, v, sheet, half, 0.12 * v + 0.5 * thickness, thickness);
}

static const Recipe recipes[MESO_BUILTIN_SHAPES] = {
    [MESO_BUILTIN_LEAF] = {leaf_place, 2, 2, 2, 4, 2, false, false, true},
    [MESO_BUILTIN_SCALE] = {scale_place, 2, 2, 2, 4, 2, false, false, true},
    [MESO_BUILTIN_BEAD] = {bead_place, 1, 6, 2, 4, 2, true, false, true},
    [MESO_BUILTIN_LINK] = {link_place, 1, 8, 4, 4, 2, true, true, false},
    [MESO_BUILTIN_TUBE] = {tube_place, 1, 6, 2, 2, 1, true, false, false},
};

/* ---- meshes of recipes ---- */

typedef struct Grid {
    const Recipe *recipe;
    uint32_t across, along;
    uint32_t vertex_count, triangle_count;
    MesoVec3 *positions, *normals;
    MesoVec2 *uvs;
    uint32_t *corners;
} Grid;

/* Rows of shapes that end in points are dense there. */
static double row_v(const Grid *grid, uint32_t row)
{
    double v = (double)row / grid->along;
    return grid->recipe->has_poles && row > 0 && row < grid->along ? 0.5 - 0.5 * cos(MESO_PI * v) : v;
}

static bool is_pole(const Grid *grid, uint32_t row)
{
    return grid->recipe->has_poles && (row == 0 || row == grid->along);
}

static double between(double low, double x, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* By central differences, a little away from rims and poles, where there is no derivative. */
static MesoVec3 grid_normal(const Recipe *recipe, double u, double v, uint32_t sheet)
{
    const double step = 1e-4, margin = 0.02;
    if (!recipe->u_wraps)
        u = between(margin, u, 1 - margin);
    if (!recipe->v_wraps)
        v = between(margin, v, 1 - margin);
    Point u0 = recipe->place(u - step, v, sheet), u1 = recipe->place(u + step, v, sheet);
    Point v0 = recipe->place(u, v - step, sheet), v1 = recipe->place(u, v + step, sheet);
    Point a = {u1.x - u0.x, u1.y - u0.y, u1.z - u0.z}, b = {v1.x - v0.x, v1.y - v0.y, v1.z - v0.z};
    Point n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    double length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    return (MesoVec3){(float)(n.x / length), (float)(n.y / length), (float)(n.z / length)};
}

static void add_vertex(Grid *grid, double u, double v, uint32_t sheet)
{
    const Recipe *recipe = grid->recipe;
    Point p = recipe->place(recipe->u_wraps && u == 1 ? 0 : u, recipe->v_wraps && v == 1 ? 0 : v, sheet);
    grid->positions[grid->vertex_count] = (MesoVec3){(float)p.x, (float)p.y, (float)p.z};
    grid->normals[grid->vertex_count] = grid_normal(recipe, u, v, sheet);
    grid->uvs[grid->vertex_count++] = (MesoVec2){(float)u, (float)v};
}

/* A ball's poles look along its axis: no difference across finds that exactly. */
static void add_pole(Grid *grid, double v, uint32_t sheet)
{
    add_vertex(grid, 0.5, v, sheet);
    if (grid->recipe->u_wraps)
        grid->normals[grid->vertex_count - 1] = (MesoVec3){v == 0 ? -1 : 1, 0, 0};
}

static void add_triangle(Grid *grid, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *corner = grid->corners + 3 * (size_t)grid->triangle_count++;
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
}

/* Between the row from `here` and that from `ahead`. */
static void add_row_faces(Grid *grid, uint32_t row, uint32_t here, uint32_t ahead)
{
    for (uint32_t i = 0; i < grid->across; i++) {
        if (is_pole(grid, row))
            add_triangle(grid, here, ahead + i + 1, ahead + i);
        else if (is_pole(grid, row + 1))
            add_triangle(grid, here + i, here + i + 1, ahead);
        else {
            add_triangle(grid, here + i, here + i + 1, ahead + i + 1);
            add_triangle(grid, here + i, ahead + i + 1, ahead + i);
        }
    }
}

static void add_sheet(Grid *grid, uint32_t sheet)
{
    uint32_t before = 0;
    for (uint32_t row = 0; row <= grid->along; row++) {
        uint32_t here = grid->vertex_count;
        if (is_pole(grid, row))
            add_pole(grid, row_v(grid, row), sheet);
        else
            for (uint32_t i = 0; i <= grid->across; i++)
                add_vertex(grid, (double)i / grid->across, row_v(grid, row), sheet);
        if (row > 0)
            add_row_faces(grid, row - 1, before, here);
        before = here;
    }
}

static MesoStatus make_grid(Grid *grid, MesoArena *scratch, const Recipe *recipe, uint32_t detail, MesoError *error)
{
    *grid = (Grid){.recipe = recipe, .across = recipe->across + detail * recipe->across_more,
                   .along = recipe->along + detail * recipe->along_more};
    size_t most = (size_t)recipe->sheet_count * (grid->across + 1) * (grid->along + 1);
    grid->positions = MESO_NEW(scratch, MesoVec3, most, error);
    grid->normals = MESO_NEW(scratch, MesoVec3, most, error);
    grid->uvs = MESO_NEW(scratch, MesoVec2, most, error);
    grid->corners = MESO_NEW(scratch, uint32_t, 6 * most, error);
    if (!grid->positions || !grid->normals || !grid->uvs || !grid->corners)
        return MESO_ERR_MEMORY;
    for (uint32_t sheet = 0; sheet < recipe->sheet_count; sheet++)
        add_sheet(grid, sheet);
    return MESO_OK;
}

static MesoStatus build(MesoTerminalShape *out, MesoArena *arena, const Recipe *recipe, uint32_t detail, MesoError *error)
{
    Grid grid;
    MesoArena scratch;
    meso_arena_init(&scratch);
    uint32_t finest = detail < MESO_SHAPE_DETAIL_MAX ? detail : MESO_SHAPE_DETAIL_MAX;
    MesoStatus status = make_grid(&grid, &scratch, recipe, finest, error);
    if (!status) {
        MesoBody mesh = {grid.vertex_count, grid.triangle_count, 3, grid.positions, grid.normals, grid.uvs, NULL,
                         grid.corners};
        status = meso_terminal_shape_build(out, arena, &mesh, MESO_SHAPE_ALONG_X, error);
    }
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_builtin_shape(MesoTerminalShape *out, MesoArena *arena, MesoBuiltinShape kind, uint32_t detail,
                              MesoError *error)
{
    return build(out, arena, &recipes[kind], detail, error);
}

MesoStatus meso_tube_shape(MesoTerminalShape *out, MesoArena *arena, uint32_t sides, uint32_t detail, MesoError *error)
{
    Recipe recipe = recipes[MESO_BUILTIN_TUBE];
    recipe.across = sides < 3 ? 3 : sides > MESO_SHAPE_SIDES_MAX ? MESO_SHAPE_SIDES_MAX : sides;
    recipe.across_more = 0;
    return build(out, arena, &recipe, detail, error);
}
