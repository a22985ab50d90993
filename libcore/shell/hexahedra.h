/*
 * Shell: the space between the offset surfaces of a macrosurface, one
 * hexahedron a slot (MesoGen, section 3.5), and the ports on its faces where
 * sweeps begin and end.
 */
#ifndef MESO_SHELL_H
#define MESO_SHELL_H

#include "libcore/math/cage.h"
#include "libcore/math/square.h"
#include "libcore/mesh/slot_graph.h"

/* The shell of one surface; keeps pointers to its arguments. */
typedef struct MesoShell {
    const MesoQuadMesh *mesh;
    const MesoSlotGraph *graph;
    const MesoVec3 *normals;        /* of unit length */
    const uint32_t *face_normals;   /* [4 * face_count] into normals: along which the corners rise */
    float bottom, top;              /* heights of the two surfaces along the normals; */
    const float *levels;            /* [2 * vertex_count] those of each vertex instead, or NULL */
} MesoShell;

/* From `offset` along the mesh's normals to half the thickness above it. What else there is: shell_form.h. */
MesoShell meso_shell_make(const MesoQuadMesh *mesh, const MesoSlotGraph *graph,
                          float offset, float thickness);

/* Where a cross-section lies on a face of a slot's hexahedron. */
typedef struct MesoPort {
    MesoVec3 point;         /* of the cross-section's centre */
    MesoVec3 up;            /* the drawing's y direction; not of unit length */
    MesoVec3 inward;        /* unit normal of the hexahedron's face, into the slot */
} MesoPort;

/* A wall of a slot's hexahedron, as the half-edge that speaks for its edge runs. */
typedef struct MesoWall {
    MesoVec3 low[2], high[2];   /* corners at the bottom and the top: where the edge starts and where it ends */
    MesoVec3 up;                /* not of unit length */
    MesoVec3 normal;            /* of unit length, into the slot of that half-edge; 0 without a direction */
    bool reversed;              /* the asking side runs the other way */
} MesoWall;

/* How a section is moved within its wall, and its trajectory leant over there. */
typedef struct MesoWallMove {
    float along, rise;          /* in widths and heights of the wall, as it runs */
    float lean_along, lean_rise;    /* tangents of the angles from its normal */
} MesoWallMove;

MesoWall meso_shell_wall(const MesoShell *shell, uint32_t slot, uint32_t side);

/* The wall's point at (x, y) of its unit square. */
MesoVec3 meso_wall_point(const MesoWall *wall, float x, float y);

/* Unit vectors in the wall, along it and across that, up. */
void meso_wall_axes(const MesoWall *wall, MesoVec3 axes[2]);

/* Where `center` of an interface's unit square lies on it, seen by the asking side. */
static inline MesoVec2 meso_wall_place(const MesoWall *wall, MesoVec2 center, bool flipped)
{
    /* Seen along the edge that speaks, the other side's drawing is mirrored, and so is its flip. */
    return (MesoVec2){flipped != wall->reversed ? 1 - center.x : center.x, center.y};
}

/*
 * Port on a wall, side 0..3 of `slot`: the point lies at `center` of the
 * interface's unit square, mirrored in x where `flipped`. The normal of the wall
 * is the cross product of its diagonals. `move`, which may be NULL, moves the point and leans the normal over.
 *
 * Two slots that meet at an edge, run along it in opposite directions and show
 * opposite labels there get the same floats for `point` and `up`, and exactly
 * opposite `inward`: all is computed from the edge, with the mean of the two
 * faces' corner normals. O(1). MESO_ERR_INPUT for a wall without a direction.
 */
MesoStatus meso_shell_wall_port(const MesoShell *shell, uint32_t slot, uint32_t side, MesoVec2 center, bool flipped,
                                const MesoWallMove *move, MesoPort *port, MesoError *error);

/* The same on a wall that is there already: that of the slot's side. */
MesoStatus meso_wall_port(const MesoWall *wall, uint32_t slot, uint32_t side, MesoVec2 center, bool flipped,
                          const MesoWallMove *move, MesoPort *port, MesoError *error);

/*
 * Counts the slots with a side where meso_shell_wall_port() fails whatever is
 * drawn there, and writes the first `room` of them, ascending, to `slots`. O(slots).
 */
uint32_t meso_shell_without_walls(const MesoShell *shell, uint32_t *slots, uint32_t room);

/*
 * Port on the top or bottom of `slot` for a
 * tile under `transform`, whose label there is `flipped`. Drawings are seen from
 * outside the shell: on the top, x and y are the tile's; on the bottom x runs
 * the other way.
 */
MesoStatus meso_shell_lid_port(const MesoShell *shell, uint32_t slot, bool bottom,
                               MesoTransform transform, MesoVec2 center, bool flipped,
                               MesoPort *port, MesoError *error);

/* A shell of one slot, [0,1] x [0,1] x [0,1/2], whose corners are those of the unit square. */
typedef struct MesoShellCell {
    MesoVec3 corners[4], up;
    uint32_t vertices[4], normals[4], twins[4];
    MesoQuadMesh mesh;
    MesoSlotGraph graph;
    MesoShell shell;        /* points into all of these */
} MesoShellCell;

void meso_shell_cell_init(MesoShellCell *cell);

/* Where a corner of the surface is lifted to, the bottom or the top. */
MesoVec3 meso_shell_corner(const MesoShell *shell, uint32_t slot, uint32_t corner, bool top);

/* The slot's hexahedron: the unit square's corners as in tile_set.h, from the bottom to the top. */
MesoCage meso_shell_cage(const MesoShell *shell, uint32_t slot);

#endif
