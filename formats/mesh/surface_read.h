/* Surfaces from mesh files, of which a method may ask for quads or triangles. */
#ifndef MESO_SURFACE_READ_H
#define MESO_SURFACE_READ_H

#include "formats/file/input.h"
#include "libcore/mesh/edit/mesh_wind.h"
#include "libcore/mesh/slot_graph.h"
#include "libcore/mesh/surface.h"
#include "libcore/mesh/triangle_mesh.h"

/*
 * Reads a mesh (mesh_read.h), joins its half-edges, and asks for what `needs` says (of MesoSurfaceNeed; 0: nothing).
 * Further errors: those of meso_surface_require(), with file and line.
 */
MesoStatus meso_surface_read(MesoSurface *surface, MesoArena *arena, const MesoInput *input, unsigned needs,
                             uint32_t thread_count, MesoError *error);

/* A macrosurface: quads, no edge with three faces. The mesh and the graph are views of the surface. */
typedef struct MesoQuadSurface {
    MesoSurface surface;
    MesoQuadMesh mesh;
    MesoSlotGraph graph;
} MesoQuadSurface;

MesoStatus meso_quad_surface_read(MesoQuadSurface *surface, MesoArena *arena, const MesoInput *input,
                                  uint32_t thread_count, MesoError *error);

/* The same of triangles of which two in a row are a quad (triangle_pairs.h). */
MesoStatus meso_quad_surface_read_pairs(MesoQuadSurface *surface, MesoArena *arena, const MesoInput *input,
                                        uint32_t thread_count, MesoError *error);

/* The same of a mesh that was read from `input`, whose arrays the surface goes on to use. */
MesoStatus meso_quad_surface_make(MesoQuadSurface *surface, MesoArena *arena, const MesoPolygonMesh *mesh,
                                  const MesoInput *input, uint32_t thread_count, MesoError *error);

/*
 * Makes the surface anew with the faces of `over` [face_count] turned over, and cut open where it has one side only
 * (mesh_wind.h). `over` NULL: as they are found, where neighbours disagree; `found` gets them then, or NULL where
 * all agree and nothing is to be done.
 */
MesoStatus meso_quad_surface_wind(MesoQuadSurface *surface, MesoArena *arena, const MesoInput *input,
                                  const uint8_t *over, uint8_t **found, MesoWindCounts *counts, uint32_t thread_count,
                                  MesoError *error);

/* Any polygon mesh as triangles (triangle_mesh.h), for inner meshes. */
MesoStatus meso_triangle_mesh_read(MesoTriangleMesh *mesh, MesoArena *arena, const MesoInput *input,
                                   uint32_t thread_count, MesoError *error);

#endif
