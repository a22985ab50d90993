/*
 * Polygon mesh: polygons of any size as a file has them, in its order, with
 * its attributes. What readers fill, what meso-mesh works on, and what a
 * surface (surface.h) is built from.
 */
#ifndef MESO_POLYGON_MESH_H
#define MESO_POLYGON_MESH_H

#include "libcore/mesh/attribute.h"

typedef struct MesoPolygonMesh {
    uint32_t vertex_count, face_count, corner_count;
    uint32_t side_count;        /* of every face, where all have as many; else 0 */
    MesoVec3 *positions;        /* [vertex_count] */
    uint32_t *face_begin;       /* [face_count + 1] into corners; NULL where side_count > 0 */
    uint32_t *corners;          /* [corner_count] vertices, face by face */
    uint32_t attribute_count;
    MesoAttribute *attributes;  /* [attribute_count] */
} MesoPolygonMesh;

static inline uint32_t meso_polygon_begin(const MesoPolygonMesh *mesh, uint32_t face)
{
    return mesh->face_begin ? mesh->face_begin[face] : face * mesh->side_count;
}

static inline uint32_t meso_polygon_sides(const MesoPolygonMesh *mesh, uint32_t face)
{
    return mesh->face_begin ? mesh->face_begin[face + 1] - mesh->face_begin[face] : mesh->side_count;
}

/* Face of a corner. O(1) where all faces have as many sides, else O(log faces). */
uint32_t meso_polygon_face(const MesoPolygonMesh *mesh, uint32_t corner);

/* Vertices, faces or corners of the mesh. */
uint32_t meso_polygon_elements(const MesoPolygonMesh *mesh, MesoAttributeDomain domain);

/* The attribute `name` of the first of these domains that has it: faces, vertices, corners; or NULL. */
const MesoAttribute *meso_polygon_attribute(const MesoPolygonMesh *mesh, const char *name);
const MesoAttribute *meso_polygon_attribute_on(const MesoPolygonMesh *mesh, const char *name,
                                               MesoAttributeDomain domain);

/*
 * The same for one number: `name` is an attribute of width 1, or what the file calls a component ("red",
 * "fieldx"), whose place goes to `component`.
 */
const MesoAttribute *meso_polygon_number(const MesoPolygonMesh *mesh, const char *name, uint32_t *component);

/*
 * Checks what no reader may leave unchecked: positions finite and within
 * MESO_COORDINATE_LIMIT, corners below vertex_count, three sides or more a face and no
 * vertex twice in one, entries of attributes in range. MESO_ERR_INPUT names the first vertex
 * or face, counted from 1. O(corners), on `thread_count` threads (0: all cores).
 */
MesoStatus meso_polygon_mesh_check(const MesoPolygonMesh *mesh, uint32_t thread_count, MesoError *error);

#endif
