/*
 * Structure: what a model expands to, still procedural: kinds of sweeps with
 * their rings of profile points, and the instances of each kind with their
 * trajectories. Both the tessellator (tessellate.h) and the renderer draw from
 * these same tables.
 *
 * A point of an instance of a swept kind, at column c and v in [0,1]:
 *
 *     B(v)    cubic Bezier over p[0..3] (MesoGen, section 3.5)
 *     T(v)    unit B'(v); at the ends exactly direction[0], direction[1]
 *     X(v)    unit cross(lerp(up[0], up[1], v), T)        Y(v) = cross(T, X)
 *     w(v)    v v (3 - 2 v)
 *     s(v)    lerp(c.start, c.end, w)                      in edge lengths
 *     P(v)    B + section_scale * (s.x X + s.y Y)
 *
 * with the normal n.x X + n.y Y - tilt T made unit, where n is the 2D normal
 * interpolated like s and tilt = section_scale w'(v) dot(c.end - c.start, n) / |B'|.
 *
 * A cap has the straight axis T = direction[0], X and Y from up[0], s = start, and
 *
 *     P(v) = p[0] + section_scale * ((1 - v^4) (s.x X + s.y Y) + MESO_CAP_RISE v T)
 *
 * with the normal MESO_CAP_RISE (n.x X + n.y Y) + 4 v^3 dot(s, n) T made unit.
 * (The prototype's dome, radius 1 - t^2 and rise sqrt(t) / 8, with t = v^2.)
 */
#ifndef MESO_STRUCTURE_H
#define MESO_STRUCTURE_H

#include "libcore/shell/model.h"
#include "libcore/tile/contour.h"

/* Height of a cap over its interface, in edge lengths (the prototype's). */
#define MESO_CAP_RISE 0.125f

/* One line of vertices along a sweep. */
typedef struct MesoSweepColumn {
    MesoVec2 start, end;                /* profile points at v 0 and 1, edge lengths */
    MesoVec2 start_normal, end_normal;  /* outward, as long as the chord that they are normal to */
    float u;                            /* around, in [0,1] */
    uint32_t joins_next;                /* 1 if quads lie between this column and the next */
} MesoSweepColumn;

typedef struct MesoSweepKind {
    uint32_t column_begin, column_count;
    uint32_t joint_count;               /* columns that join the next */
    uint32_t division_count;            /* vertices along */
    uint32_t instance_begin, instance_count;
    uint32_t tile, sweep;               /* sweep is MESO_NO_INDEX for a cap */
    uint32_t start_side, end_side;      /* of the tile; equal for a cap */
    uint32_t start_section, end_section;
    bool mirrored;                      /* the tile's transform flips */
    bool cap;
} MesoSweepKind;

typedef struct MesoSweepInstance {
    MesoVec3 p[4];              /* control points; a cap has p[1..3] along its axis */
    MesoVec3 up[2];             /* drawing's y direction at both ends; not of unit length */
    MesoVec3 direction[2];      /* unit tangents at both ends, from start to end */
    uint32_t slot;
} MesoSweepInstance;

/* Coordinates of inner meshes in their tile, in tiles: those of the shell, which follow the product of
 * three of them, stay finite. */
#define MESO_INNER_LIMIT 1e6f

/* A tile's inner mesh in a slot. */
typedef struct MesoInnerInstance {
    uint32_t inner;     /* into tile_set.inners and inner_meshes */
    uint32_t slot;
} MesoInnerInstance;

typedef struct MesoStructure {
    const MesoModel *model;
    MesoMapOptions options;             /* resolved */
    uint32_t kind_count, column_count, instance_count, inner_count;
    MesoSweepKind *kinds;
    MesoSweepColumn *columns;
    MesoSweepInstance *instances;       /* by kind, then slot */
    MesoInnerInstance *inners;          /* by inner, then slot */
} MesoStructure;

/*
 * Expands a model whose assignment has been checked. `structure` keeps
 * pointers into `model`. Sweeps that meet at an edge, from either slot, end on
 * the same floats: their frames come from the edge alone and their rings from
 * the interface alone. O(slots * sweeps a tile).
 * MESO_ERR_INPUT where a face of the shell has no direction (a slot whose
 * corners coincide), naming the slot, and where a tile's inner mesh reaches
 * beyond MESO_INNER_LIMIT, naming tile and mesh.
 */
MesoStatus meso_structure_build(MesoStructure *structure, MesoArena *arena,
                                const MesoModel *model, uint32_t thread_count, MesoError *error);

/*
 * The same over contours that the caller made: `contours` of the model's tile
 * set, sampled in any way.
 */
MesoStatus meso_structure_build_over(MesoStructure *structure, MesoArena *arena,
                                     const MesoModel *model, const MesoContourSet *contours,
                                     uint32_t thread_count, MesoError *error);

/* Where the tile has a point of its inner mesh. */
static inline MesoVec3 meso_inner_point(const MesoInnerMesh *inner, MesoVec3 p)
{
    const float *m = inner->transform;
    return (MesoVec3){m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                      m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

/* Kind of an instance. O(log kinds). */
uint32_t meso_structure_kind(const MesoStructure *structure, uint32_t instance);

/* Box around all control points, widened by the profiles and inner meshes. */
void meso_structure_bounds(const MesoStructure *structure, MesoVec3 *low, MesoVec3 *high);

#endif
