/*
 * Swatches: a small piece of a texture that is geometry, as it is cut into elements and laid over the plane (Zhou
 * and others, "Mesh Quilting For Geometric Texture Synthesis", 2006). The plane is x and y, z is up. The tile from
 * the origin to `size` is what stands for the texture; elements may overhang it. Elements are what hangs together:
 * closed ones, which are placed whole or not at all, and strands, which run on through the sides of the tile and may
 * be cut.
 */
#ifndef MESO_SWATCH_H
#define MESO_SWATCH_H

#include "libcore/mesh/polygon_mesh.h"
#include "libcore/scene/material.h"

typedef enum MesoElementKind { MESO_ELEMENT_WHOLE, MESO_ELEMENT_STRAND } MesoElementKind;

typedef struct MesoSwatch {
    uint32_t vertex_count, triangle_count, element_count;
    MesoVec3 *positions;        /* [vertex_count] z from 0 to size.z */
    MesoVec3 *normals;          /* [vertex_count] unit, outward */
    MesoVec2 *uvs;              /* [vertex_count], where corners differ that of the first of them; or NULL */
    MesoVec2 *corner_uvs;       /* [3 * triangle_count] or NULL: where the corners at some vertex differ */
    uint32_t *corners;          /* [3 * triangle_count] */
    uint32_t *twins;            /* [3 * triangle_count] half-edge across, or MESO_NO_INDEX */
    uint32_t *materials;        /* [triangle_count] */
    uint32_t *vertex_begin, *triangle_begin;    /* [element_count + 1] those of an element are consecutive */
    uint8_t *kinds;             /* [element_count] MesoElementKind */
    MesoVec3 *centres;          /* [element_count] of the box around it */
    float *radii;               /* [element_count] how far it reaches from there in the plane */
    MesoVec3 size;
    float mean_edge;
    uint32_t open_edge_count;

    /* Open ends, and which end goes on where another comes in from the next tile. */
    uint32_t loop_count;
    uint32_t *loop_begin;       /* [loop_count + 1] */
    uint32_t *loop_vertices;    /* [open_edge_count] in the order of the half-edges along them */
    uint32_t *mates;            /* [vertex_count] of a vertex at the high side of a period the one at the low side whose
                                   place it takes in the next tile; else MESO_NO_INDEX */
    bool periodic_x, periodic_y;
    MesoVec2 period;            /* moves by it map the texture onto itself; size is a multiple. 0 where not periodic */

    uint32_t material_count;
    MesoMaterial *looks;        /* [material_count] */
    const char **material_names;    /* [material_count] */
} MesoSwatch;

typedef struct MesoSwatchOptions {
    int up;             /* axis that is up, 0, 1 or 2; -1: the thinnest side of the box */
    int periodic;       /* bits 1 (x) and 2 (y): where it has to be periodic; 0: it is not taken so; -1: find out */
    MesoVec2 period;    /* known, as of the mesh after it is turned up; 0: find out */
} MesoSwatchOptions;

/*
 * The swatch of a checked mesh. Faces become triangles, wound alike within an element and outward: by the volume
 * that it encloses, of strands that which caps would close. Vertices at which several fans of faces touch become
 * several. Materials are those of the faces' attribute "material", by what "albedo", "roughness" and "metallic" say
 * of the first such face; "normal" and "uv" are taken where they are there.
 *
 * With up 1, (x, y, z) comes to stand as (x, -z, y); with 0, as (y, z, x).
 *
 * Periodic along x is a mesh whose open ends towards x meet those on the other side by one move, within a hundredth
 * of the mean edge, vertex by vertex; without such ends, one whose elements stand in rows of equals along x, two or
 * more of them, equally spaced, all rows over the same length. Equals have their vertices in the same order. Ends
 * are then made to meet exactly: high = low + size, in floats. The tile is so long, and its period the finest that maps
 * triangles onto triangles (swatch_finer.h). Without a period the tile is as wide as the open ends stand apart, or,
 * without such, as the centres of the elements do and the widest gap between two of them in that direction.
 *
 * O(corners) and sorting. MESO_ERR_INPUT with the face where it is no manifold or has one side only, or is not
 * periodic where it has to be; MESO_ERR_MEMORY.
 */
MesoStatus meso_swatch_build(MesoSwatch *swatch, MesoArena *arena, const MesoPolygonMesh *mesh,
                             const MesoSwatchOptions *options, MesoError *error);

/*
 * A periodic swatch, repeated along the periodic directions until its tile covers `cover`. Ends that meet are one:
 * strands become longer elements; periods stay. Materials are shared with `swatch`. O(the result).
 * MESO_ERR_INTERNAL for one that is not periodic, MESO_ERR_LIMIT beyond what can be counted, MESO_ERR_MEMORY.
 */
MesoStatus meso_swatch_repeat(MesoSwatch *larger, MesoArena *arena, const MesoSwatch *swatch, MesoVec2 cover,
                              MesoError *error);

#endif
