/* What the steps of meso_prisms_build() share: the layer while its directions are found. */
#ifndef MESO_PRISM_LAYER_H
#define MESO_PRISM_LAYER_H

#include "libcore/base/arena.h"
#include "libcore/math/vec3d.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoPrismLayer {
    const MesoTriangulation *mesh;
    double low, high;
    uint32_t thread_count;
    MesoVec3d *rises;       /* [vertex_count] directions as they are */
    MesoVec3d *normals;     /* [vertex_count] unit; 0 where a vertex has no side */
    double *thickness;      /* [vertex_count] the wanted length along the normal */
    double *areas;          /* [triangle_count] twice */
    uint8_t *flat;          /* [triangle_count] 1: too low to have a side; not looked at */
} MesoPrismLayer;

static inline MesoVec3d meso_prism_corner(const MesoPrismLayer *layer, uint32_t vertex, double height)
{
    return meso_vec3d_mad(meso_vec3d(layer->mesh->positions[vertex]), height, layer->rises[vertex]);
}

/* Twice the area, times the unit normal. */
static inline MesoVec3d meso_prism_base(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    MesoVec3d p = meso_vec3d(mesh->positions[v[0]]);
    return meso_vec3d_cross(meso_vec3d_sub(meso_vec3d(mesh->positions[v[1]]), p),
                            meso_vec3d_sub(meso_vec3d(mesh->positions[v[2]]), p));
}

/* The three tetrahedra of a prism, by its corners 0 to 2 below and 3 to 5 above; neighbours split a wall alike. */
void meso_prism_split(const uint32_t vertices[3], uint8_t tetrahedra[3][4]);

/* ---- prism_folds.c: a prism by itself ---- */

/* Sets normals, thickness, rises, areas and flat. */
void meso_prism_normals(MesoPrismLayer *layer);

/* Turns directions towards the normals until they are well outside of all triangles around. */
void meso_prism_face(MesoPrismLayer *layer);

/*
 * Whether all tetrahedra between any two heights of the prism are positive, by `margin`: the least share of the flat
 * prism's volume that they must have, for as long directions.
 */
bool meso_prism_stands(const MesoPrismLayer *layer, uint32_t triangle, double margin);

/* meso_prism_stands() for all around a vertex. */
bool meso_prism_ring_stands(const MesoPrismLayer *layer, uint32_t vertex, double margin);

/* Makes directions shorter until all prisms stand: all there are, or those around vertices that are marked. */
MesoStatus meso_prism_lower_folds(MesoPrismLayer *layer, const uint8_t *marked, MesoArena *scratch, MesoError *error);

/* Longer again where they are below the wanted thickness, as far as prisms stand. */
void meso_prism_raise(MesoPrismLayer *layer);

/* ---- prism_overlaps.c: prisms that meet others ---- */

/*
 * Makes directions shorter until no prism meets another. What has been lowered here wants to be no longer: thickness
 * is what is left. `lowered`: whether anything was.
 */
MesoStatus meso_prism_lower_overlaps(MesoPrismLayer *layer, bool *lowered, MesoArena *scratch, MesoError *error);

/* ---- prism_relax.c ---- */

/*
 * Directions near the least stretch by one sparse system; prisms may not stand then. Leaves them where the system is
 * larger than pays, or not positive definite in doubles: sweeps need no start.
 */
MesoStatus meso_prism_solve(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error);

/* Turns directions for less stretch; all prisms stand before and after. */
MesoStatus meso_prism_relax(MesoPrismLayer *layer, MesoArena *scratch, MesoError *error);

#define MESO_PRISM_MARGIN 0.02  /* far above what rounding to floats can do */

#endif
