/* What the steps of an inspection share. */
#ifndef MESO_INSPECT_WORK_H
#define MESO_INSPECT_WORK_H

#include "libcore/check/inspect_tree.h"
#include "libcore/check/inspection.h"
#include "libcore/math/vec3d.h"

/* Instead of a half-edge across. */
#define MESO_MATE_NONE MESO_NO_INDEX            /* the edge is open */
#define MESO_MATE_MANY (MESO_NO_INDEX - 1)      /* it has more than two triangles */
#define MESO_MATE_OUT (MESO_NO_INDEX - 2)       /* the triangle is left out */

/* Half-edge 3 t + k runs from corner k of triangle t to the next. */
typedef struct MesoInspectWork {
    const MesoInspectedMesh *mesh;
    const MesoInspectionOptions *options;
    MesoArena *arena, *scratch;     /* of the result; of the whole inspection */
    MesoInspection *result;
    uint32_t *places;       /* [3 * triangle_count] places of the corners, below place_count */
    uint32_t place_count;
    uint32_t *mates;        /* [3 * triangle_count] half-edge across, or one of the above */
    uint32_t *pieces;       /* [triangle_count] below piece_count, in the order of their first triangles */
    uint32_t *parts;        /* [triangle_count] the same of what shares vertices of the mesh */
    uint32_t *things;       /* [triangle_count] below thing_count */
    uint32_t piece_count, part_count, thing_count;
    MesoInspectTree tree;   /* over the triangles that are not left out, owned by their things */
    double rounding;        /* what the coordinates' own rounding may move a point by */
    uint32_t *thing_ids;    /* [thing_count] as in the mesh; NULL: they are pieces */
} MesoInspectWork;

static inline uint32_t meso_half_next(uint32_t half)
{
    return half % 3 == 2 ? half - 2 : half + 1;
}

static inline MesoVec3 meso_inspect_corner(const MesoInspectedMesh *mesh, uint32_t half)
{
    return mesh->positions[mesh->corners[half]];
}

static inline uint32_t meso_inspect_slot(const MesoInspectWork *work, uint32_t half)
{
    return work->mesh->slots ? work->mesh->slots[half / 3] : 0;
}

/* Number of the normal at a corner, or MESO_NO_INDEX. */
static inline uint32_t meso_inspect_normal_at(const MesoInspectedMesh *mesh, uint32_t half)
{
    if (!mesh->normals)
        return MESO_NO_INDEX;
    return mesh->normal_of ? mesh->normal_of[half] : mesh->corners[half];
}

/* Twice the area's vector. */
static inline MesoVec3d meso_inspect_area(const MesoInspectedMesh *mesh, uint32_t triangle)
{
    MesoVec3d a = meso_vec3d(meso_inspect_corner(mesh, 3 * triangle));
    MesoVec3d b = meso_vec3d(meso_inspect_corner(mesh, 3 * triangle + 1));
    MesoVec3d c = meso_vec3d(meso_inspect_corner(mesh, 3 * triangle + 2));
    return meso_vec3d_cross(meso_vec3d_sub(b, a), meso_vec3d_sub(c, a));
}

static inline bool meso_inspect_is_finite(const MesoInspectedMesh *mesh, uint32_t triangle)
{
    for (uint32_t k = 0; k < 3; k++)
        if (!meso_vec3_finite(meso_inspect_corner(mesh, 3 * triangle + k)))
            return false;
    return true;
}

/* Notes a fault of one triangle; `size` is 0 where it has none. Of equals the first stays. Not for threads. */
static inline void meso_inspect_note(MesoInspectWork *work, MesoFault fault, uint32_t triangle, double size)
{
    MesoFinding *finding = &work->result->findings[fault];
    finding->count++;
    work->result->marks[triangle] |= 1u << fault;
    if (finding->triangle == MESO_NO_INDEX || size > finding->worst) {
        finding->triangle = triangle;
        finding->worst = size;
    }
}

/* A triangle in space; `normal` is of unit length, and 0 where it has no area. */
typedef struct MesoInspectTriangle {
    MesoVec3d p[3], normal;
} MesoInspectTriangle;

static inline MesoInspectTriangle meso_inspect_triangle(const MesoInspectedMesh *mesh, uint32_t t)
{
    MesoInspectTriangle triangle;
    for (uint32_t k = 0; k < 3; k++)
        triangle.p[k] = meso_vec3d(meso_inspect_corner(mesh, 3 * t + k));
    MesoVec3d area = meso_inspect_area(mesh, t);
    double length = meso_vec3d_length(area);
    triangle.normal = meso_vec3d_scale(area, length > 0 ? 1 / length : 0);
    return triangle;
}

/* Where a side goes through the inside of a triangle. */
typedef struct MesoInspectHole {
    MesoVec3d at, inner;    /* the point, and the end of the side that is behind the triangle */
} MesoInspectHole;

/* Whether the side from p to q goes through the inside of `t`, by more than `rounding`. */
bool meso_inspect_pierces(const MesoInspectTriangle *t, MesoVec3d p, MesoVec3d q, double rounding,
                          MesoInspectHole *hole);

/* Two triangles that cut through each other, and how many pairs of their things do in the same place. */
typedef struct MesoInspectCut {
    uint32_t a, b;          /* things, a <= b */
    uint32_t s, t;          /* triangles of a and b */
    uint64_t pairs;
} MesoInspectCut;

/* How far two things that cut through each other at `cuts` [count], all of the same two, get into each other; at most
 * `most` triangles of each are followed. */
double meso_inspect_depth(const MesoInspectWork *work, const MesoInspectCut *cuts, uint32_t count, uint32_t most);

/* Counts a joint of two half-edges along one edge, and notes by how much their normals differ. */
void meso_inspect_joint(MesoInspectWork *work, uint32_t half, uint32_t other);

/* Where in its slot's hexahedron a ring lies: at a border, at a lid, or elsewhere, where it has another side. */
typedef enum MesoInspectEnd { MESO_END_INSIDE, MESO_END_BORDER, MESO_END_LID } MesoInspectEnd;

/* Of a ring of this size around `middle` that ends `outward`; elsewhere, where there are no hexahedra. */
MesoInspectEnd meso_inspect_end(const MesoInspectedMesh *mesh, uint32_t slot, MesoVec3d middle, MesoVec3d outward,
                                double size);

/* The steps, in their order; each leaves its scratch behind it. */
MesoStatus meso_inspect_places(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_edges(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_pieces(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_normals(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_rings(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_solids(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_folds(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_floats(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_triangle_tree(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_crossings(MesoInspectWork *work, MesoError *error);
MesoStatus meso_inspect_thickness(MesoInspectWork *work, MesoError *error);

#endif
