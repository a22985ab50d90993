#include <string.h>

#include "libcore/mesh/half_edges.h"
#include "libcore/quilt/swatch/swatch.h"
#include "libcore/quilt/swatch/swatch_elements.h"
#include "libcore/quilt/swatch/swatch_tile.h"

/* Copies stand row by row along x. */
typedef struct Copies {
    const MesoSwatch *of;
    uint32_t columns, rows;
} Copies;

static uint32_t copy_of(const Copies *copies, uint32_t column, uint32_t row, uint32_t vertex)
{
    return (row * copies->columns + column) * copies->of->vertex_count + vertex;
}

/* A vertex of a copy: at its high side, that of the next copy, where there is one. */
static uint32_t joined(const Copies *copies, uint32_t column, uint32_t row, uint32_t vertex)
{
    uint32_t mate = copies->of->mates[vertex];
    if (mate != MESO_NO_INDEX) {
        bool along_x = meso_swatch_mates_along_x(copies->of, vertex);
        uint32_t right = column + along_x, behind = row + !along_x;
        if (right < copies->columns && behind < copies->rows)
            return copy_of(copies, right, behind, mate);
    }
    return copy_of(copies, column, row, vertex);
}

/* The mate of a vertex at the high side of the last copy is that of the first. */
static uint32_t far_mate(const Copies *copies, uint32_t column, uint32_t row, uint32_t vertex)
{
    uint32_t mate = copies->of->mates[vertex];
    if (mate == MESO_NO_INDEX)
        return mate;
    bool along_x = meso_swatch_mates_along_x(copies->of, vertex);
    return copy_of(copies, along_x ? 0 : column, along_x ? row : 0, mate);
}

static void add_copy(MesoSwatch *all, const Copies *copies, uint32_t column, uint32_t row)
{
    const MesoSwatch *of = copies->of;
    uint32_t first = copy_of(copies, column, row, 0);
    size_t half_edge = (size_t)(row * copies->columns + column) * 3 * of->triangle_count;
    for (uint32_t v = 0; v < of->vertex_count; v++) {
        MesoVec3 p = of->positions[v];
        p.x = (float)((double)p.x + column * (double)of->size.x);
        p.y = (float)((double)p.y + row * (double)of->size.y);
        all->positions[first + v] = p;
        all->normals[first + v] = of->normals[v];
        all->mates[first + v] = far_mate(copies, column, row, v);
        if (of->uvs)
            all->uvs[first + v] = of->uvs[v];
    }
    for (uint32_t h = 0; h < 3 * of->triangle_count; h++) {
        all->corners[half_edge + h] = joined(copies, column, row, of->corners[h]);
        if (of->uvs)
            all->corner_uvs[half_edge + h] = of->corner_uvs ? of->corner_uvs[h] : of->uvs[of->corners[h]];
    }
    memcpy(all->materials + half_edge / 3, of->materials, of->triangle_count * sizeof *of->materials);
}

/* Where strands go on, what runs along them begins anew: corners at a vertex need not agree. */
static MesoStatus make_copies(MesoSwatch *all, const Copies *copies, MesoArena *scratch, MesoError *error)
{
    const MesoSwatch *of = copies->of;
    uint32_t count = copies->columns * copies->rows;
    all->vertex_count = of->vertex_count * count;
    all->triangle_count = of->triangle_count * count;
    all->positions = MESO_NEW(scratch, MesoVec3, all->vertex_count, error);
    all->normals = MESO_NEW(scratch, MesoVec3, all->vertex_count, error);
    all->mates = MESO_NEW(scratch, uint32_t, all->vertex_count, error);
    all->corners = MESO_NEW(scratch, uint32_t, 3 * (size_t)all->triangle_count, error);
    all->materials = MESO_NEW(scratch, uint32_t, all->triangle_count, error);
    all->uvs = of->uvs ? MESO_NEW(scratch, MesoVec2, all->vertex_count, error) : NULL;
    all->corner_uvs = of->uvs ? MESO_NEW(scratch, MesoVec2, 3 * (size_t)all->triangle_count, error) : NULL;
    if (!all->positions || !all->normals || !all->mates || !all->corners || !all->materials ||
        (of->uvs && (!all->uvs || !all->corner_uvs)))
        return MESO_ERR_MEMORY;
    for (uint32_t row = 0; row < copies->rows; row++)
        for (uint32_t column = 0; column < copies->columns; column++)
            add_copy(all, copies, column, row);
    return MESO_OK;
}

static MesoStatus join_triangles(MesoSwatch *all, MesoArena *scratch, MesoError *error)
{
    MesoPolygonMesh mesh = {.vertex_count = all->vertex_count, .face_count = all->triangle_count,
                            .corner_count = 3 * all->triangle_count, .side_count = 3, .positions = all->positions,
                            .corners = all->corners};
    MesoHalfEdges edges;
    MesoStatus status = meso_half_edges_join(&edges, scratch, &mesh, 1, error);
    all->twins = edges.twin;
    return status;
}

static MesoStatus repeat(MesoSwatch *larger, MesoArena *arena, const Copies *copies, MesoArena *scratch,
                         MesoError *error)
{
    const MesoSwatch *of = copies->of;
    MesoSwatch all = {0};
    MesoStatus status = make_copies(&all, copies, scratch, error);
    if (!status)
        status = join_triangles(&all, scratch, error);
    if (!status)
        status = meso_swatch_sort(larger, arena, &all, error);
    if (!status)
        status = meso_swatch_find_loops(larger, arena, error);
    if (status)
        return status;
    larger->size = (MesoVec3){(float)copies->columns * of->size.x, (float)copies->rows * of->size.y, of->size.z};
    larger->periodic_x = of->periodic_x;
    larger->periodic_y = of->periodic_y;
    larger->period = of->period;
    larger->material_count = of->material_count;
    larger->looks = of->looks;
    larger->material_names = of->material_names;
    meso_swatch_snap(larger);
    meso_swatch_measure(larger);
    meso_swatch_find_kinds(larger);
    return MESO_OK;
}

/* How many copies it takes: none more for what rounding leaves. */
static double copies_for(bool periodic, float cover, float size)
{
    double count = periodic ? ceil((double)cover / (double)size - 1e-6) : 1;
    return count > 1 ? count : 1;
}

MesoStatus meso_swatch_repeat(MesoSwatch *larger, MesoArena *arena, const MesoSwatch *swatch, MesoVec2 cover,
                              MesoError *error)
{
    if (!swatch->periodic_x && !swatch->periodic_y)
        return meso_fail(error, MESO_ERR_INTERNAL, "a swatch that is not periodic is to be repeated");
    double columns = copies_for(swatch->periodic_x, cover.x, swatch->size.x);
    double rows = copies_for(swatch->periodic_y, cover.y, swatch->size.y);
    double most = fmax(swatch->vertex_count, 3.0 * swatch->triangle_count);
    if (!(columns * rows * most < (double)MESO_NO_INDEX))
        return meso_fail(error, MESO_ERR_LIMIT, "%g copies of a swatch of %u triangles are more than can be counted",
                         columns * rows, swatch->triangle_count);
    MesoArena scratch;
    meso_arena_init(&scratch);
    *larger = (MesoSwatch){0};
    Copies copies = {swatch, (uint32_t)columns, (uint32_t)rows};
    MesoStatus status = repeat(larger, arena, &copies, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}
