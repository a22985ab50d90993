/*
 * Quilts (.quilt), version 1.1: the layer above a surface, with the surface itself, so that it can be embedded anew.
 * Chunks:
 *
 *     prov      provenance, JSON text
 *     head      u32[8]: vertices, triangles and elements of the quilt; vertices and triangles of the base; vertices,
 *               triangles and elements of the swatch
 *     surface   what the base was made of: u32[3] vertices, faces, corners; u32 how the quilt lies over it, of
 *               MesoQuiltEmbedding (1.0: 0); u64[2] hash of its faces
 *     vertex    {u32 triangle of the base; f32 weights of its corners 1 and 2; f32 height} a vertex
 *     origin    u32 a vertex: vertex of the swatch          corner    u32[3] a triangle
 *     triorig   u32 a triangle: triangle of the swatch      patch     u32 a triangle: step that has placed it
 *     vbegin, tbegin  u32[elements + 1]: vertices and triangles of each element
 *     elemorig  u32 an element: element of the swatch
 *     basepos   f32[3] a vertex of the base                 basecorn  u32[3] a triangle of it
 *     baseorig  u32 a vertex of the base: vertex of the surface's file
 *     baseuv    f32[2] a corner of the base, or empty; version 1.0 has none
 *     swpos     f32[3] a vertex of the swatch               swcorn    u32[3] a triangle of it
 *     swtwin    u32[3] a triangle: half-edge across, 2^32 - 1 for none
 *     swmat     u32 a triangle: material
 *     swuv      f32[2] a vertex, or empty                   swcuv     f32[2] a corner, or empty
 *     looks     JSON text: {"materials": [{"name", "albedo", "roughness", "metallic"}]}
 */
#ifndef MESO_QUILT_FILE_H
#define MESO_QUILT_FILE_H

#include "formats/file/container.h"
#include "formats/product/provenance.h"
#include "libcore/quilt/embed/quilt_lay.h"

enum { MESO_QUILT_MAJOR = 1 };

/* What tells the surface of a file from another of other faces; places do not count. */
typedef struct MesoSurfaceMark {
    uint32_t vertex_count, face_count, corner_count;
    uint64_t hash[2];           /* XXH3-128 of the corners and of the numbers of sides */
} MesoSurfaceMark;

MesoSurfaceMark meso_surface_mark(const MesoPolygonMesh *mesh);

typedef struct MesoQuiltFile {
    MesoQuilt quilt;            /* of a file: its report is 0 */
    MesoSwatch swatch;          /* of a file: what meso_quilt_scene() reads of it */
    MesoTriangulation base;     /* of a file: positions, corners, and `origins` by the surface's file, in an arena */
    MesoSurfaceMark surface;
    MesoQuiltEmbedding embedding;
    MesoVec2 *base_uvs;         /* [3 * base.triangle_count] texture coordinates of the base's corners, or NULL */
} MesoQuiltFile;

/* Vertices of the base that are none of the surface's stand as vertex 2^32 - 1. O(size). */
MesoStatus meso_quilt_write(const MesoQuiltFile *file, const MesoProvenance *provenance, MesoOutput *output,
                            MesoError *error);

/*
 * Reads and checks everything: numbers in range, elements that use none but their own vertices, floats finite. All to
 * `arena`; `input` may be closed then. `provenance` may be NULL. MESO_ERR_INPUT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_read(MesoQuiltFile *file, const char **provenance, MesoArena *arena, const MesoInput *input,
                           MesoError *error);

/* True where `input` begins as a quilt. */
bool meso_quilt_recognise(const MesoInput *input);

#endif
