/* A piece of geometry around a place of a plane, to be compared with a swatch. */
#ifndef MESO_CHECK_WINDOW_H
#define MESO_CHECK_WINDOW_H

#include "libcore/quilt/match/match_search.h"
#include "libcore/shell/box_tree.h"

typedef struct MesoWindow {
    uint32_t point_count, triangle_count;
    MesoMatchPoint *points;     /* [point_count] around the origin of the plane, in units of the swatch */
    uint32_t *corners;          /* [3 * triangle_count] */
    uint32_t inside_count;
    uint32_t *inside;           /* [inside_count] points within the radius */
    float radius, reach;        /* triangles are there that come within the reach */
    uint32_t *locals;           /* by vertex of the mesh that it is taken from; MESO_NO_INDEX for those not in it */
    uint32_t *vertices;         /* [point_count] of that mesh */
} MesoWindow;

/* How far from a border whole elements may be missing, since they would lie across it: the largest one's width. */
float meso_window_border(const MesoSwatch *swatch);

/* A mesh whose nearest triangle is asked for. */
typedef struct MesoNearestMesh {
    const MesoMatchPoint *points;
    const uint32_t *corners;
    MesoBoxTree tree;
} MesoNearestMesh;

/* Room for what `triangle_count` triangles may add; `locals` as of the mesh, none of them set. In `arena`. */
MesoStatus meso_window_init(MesoWindow *window, MesoArena *arena, uint32_t triangle_count, float radius, float reach,
                            uint32_t *locals, MesoError *error);

/* Adds a triangle, if it comes within the reach: its vertices in the mesh, and their places. */
void meso_window_add(MesoWindow *window, const uint32_t *vertices, const MesoVec3 *places);

/* After all triangles: normals, and what is inside; `locals` are as they were before. */
void meso_window_finish(MesoWindow *window);

MesoStatus meso_nearest_mesh_build(MesoNearestMesh *mesh, MesoArena *arena, const MesoMatchPoint *points,
                                   const uint32_t *corners, uint32_t triangle_count, MesoError *error);

/* The distance to the nearest triangle, `most` where none is nearer. */
float meso_nearest_distance(const MesoNearestMesh *mesh, MesoVec3 point, float most);

#endif
