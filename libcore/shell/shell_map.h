/*
 * Shell map: from the texture space of an atlas to the layer above a mesh, by
 * tetrahedra ("Shell Maps", Porumbescu et al. 2005), whose upper texture
 * coordinates are moved for less stretch ("Mesh Quilting for Geometric Texture
 * Synthesis", Zhou et al. 2006, section 3.2, equations 8 and 9).
 *
 * Texture space is the atlas's square in units of the surface, with heights as
 * third coordinate. Each chart's prism of a triangle, and that of the shell, are
 * cut into three tetrahedra in the same way.
 */
#ifndef MESO_SHELL_MAP_H
#define MESO_SHELL_MAP_H

#include "libcore/chart/atlas.h"
#include "libcore/shell/shell_tetrahedra.h"

typedef struct MesoShellMapOptions {
    float low, high;        /* heights of the two layers of vertices, low < high */
    uint32_t sweeps;        /* of the second optimisation; 0: 10 */
    bool plain;             /* no optimisation: the shell map of 2005 */
} MesoShellMapOptions;

/* Stretch by shell_stretch.h over all tetrahedra. */
typedef struct MesoShellMapReport {
    double stretch_before, stretch_after;                   /* from the texture to the shell */
    double stretch_before_inverse, stretch_after_inverse;   /* and back: the paper's */
    uint32_t inverted_count;    /* tetrahedra that are negative: none */
    uint32_t flat_count;        /* such without a volume: of triangles too low, or without a layer at a vertex */
    uint32_t plain_count;       /* triangles that have negative ones, whose points are those of their prisms instead */
} MesoShellMapReport;

/*
 * Keeps pointers to `mesh` and `directions` (prisms.h, made for the same heights, so that no tetrahedron is negative);
 * `report` may be NULL.
 *
 * First the paper's measure, from the shell to the texture, is made least: it is quadratic in the upper coordinates,
 * and so one sparse system does what the paper searches for at random. Where that is less in the other measure too it
 * is taken; sweeps of Newton's method over single vertices then lower that, and stop before a tetrahedron is flat. The
 * stretch from the texture is never above that of the plain map. Coordinates on borders of charts are held, so that
 * charts go on into each other.
 *
 * To `arena`; O(sweeps * triangles) and a sparse factorisation. MESO_ERR_INPUT for heights that are no layer,
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_shell_map_build(MesoShellMap *map, MesoShellMapReport *report, MesoArena *arena,
                                const MesoTriangulation *mesh, const MesoAtlas *atlas, const MesoVec3 *directions,
                                const MesoShellMapOptions *options, MesoError *error);

/*
 * Where the texture's point lies that has weights (1 - b1 - b2, b1, b2) in `triangle`'s place in the atlas, at height
 * `h`: in the tetrahedron that holds it, which may be over another triangle of the chart. Points out of the chart, or
 * out of the layer, go by the nearest of the tetrahedra that were looked at. O(triangles between).
 */
MesoVec3 meso_shell_map_point(const MesoShellMap *map, uint32_t triangle, float b1, float b2, float h);

#endif
