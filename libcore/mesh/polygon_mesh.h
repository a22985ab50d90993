/*
 * Polygon mesh: polygons of any size as a file has them, in its order, with
 * its attributes. What readers fill, what meso-mesh works on, and what a
 * surface (surface.h) is built from.
 */
#ifndef MESO_POLYGON_MESH_H
#define MESO_POLYGON_MESH_H

#include "libcore/mesh/attribute.h"

/*
 * Coordinates beyond this are refused: products of two lengths, which all
 * later stages form in single precision, would no longer be finite.
 */
#define MESO_COORDINATE_LIMIT 1e18f

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

/* The attribute "normal" of corners, or else of vertices, with three numbers; or NULL. Those of faces are no
 * shading. */
const MesoAttribute *meso_polygon_normals(const MesoPolygonMesh *mesh);

/*
 * The same for one number: `name` is an attribute of width 1, or what the file calls a component ("red",
 * "fieldx"), whose place goes to `component`.
 */
const MesoAttribute *meso_polygon_number(const MesoPolygonMesh *mesh, const char *name, uint32_t *component);
const MesoAttribute *meso_polygon_number_on(const MesoPolygonMesh *mesh, const char *name,
                                            MesoAttributeDomain domain, uint32_t *component);

/* A number of a face: its own, or the mean over its vertices or corners. NaN where one of them has none. */
double meso_polygon_face_number(const MesoPolygonMesh *mesh, const MesoAttribute *attribute, uint32_t component,
                                uint32_t face);

/*
 * Checks what no reader may leave unchecked: corners below vertex_count, three sides or more a face and no
 * vertex twice in one, entries of attributes in range, positions finite and within
 * MESO_COORDINATE_LIMIT. MESO_ERR_INPUT names the first face, or else the first vertex, counted from 1; the
 * number of that face from 0, or MESO_NO_INDEX, goes to `face`, which may be NULL. O(corners), on `thread_count`
 * threads (0: all cores); the same for any number of them.
 */
MesoStatus meso_polygon_mesh_check(const MesoPolygonMesh *mesh, uint32_t thread_count, uint32_t *face,
                                   MesoError *error);

#endif
