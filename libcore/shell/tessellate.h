/*
 * Tessellation: the polygons of a structure, part by part, so that a writer
 * holds only a window of them. A part is one instance of a sweep or one inner
 * mesh in a slot; parts are numbered sweeps first, in the order of
 * structure.h, so that all parts of one material lie together.
 */
#ifndef MESO_TESSELLATE_H
#define MESO_TESSELLATE_H

#include "libcore/shell/structure.h"

typedef struct MesoMeshVertex {
    MesoVec3 position;
    MesoVec3 normal;    /* unit length, outward */
    MesoVec2 uv;        /* u around, v along */
} MesoMeshVertex;

/* Counter-clockwise seen from outside. */
typedef struct MesoMeshFace {
    uint32_t v[4];      /* v[3] is MESO_NO_INDEX for a triangle */
} MesoMeshFace;

typedef struct MesoMeshPart {
    uint32_t slot, tile;
    uint32_t material;  /* cross-section at the start, or section_count + inner mesh */
} MesoMeshPart;

typedef struct MesoTessellation {
    const MesoStructure *structure;
    uint32_t part_count;
    uint64_t *vertex_begin;     /* [part_count + 1] */
    uint64_t *face_begin;       /* [part_count + 1] */
    uint64_t triangle_count;    /* with quads as two */
} MesoTessellation;

/* Counts everything; tessellates nothing yet. O(parts). */
MesoStatus meso_tessellation_init(MesoTessellation *tessellation, MesoArena *arena,
                                  const MesoStructure *structure, MesoError *error);

MesoMeshPart meso_tessellation_part(const MesoTessellation *tessellation, uint32_t part);

/*
 * Vertices of the parts [begin, end), in order, to `out`, which holds
 * vertex_begin[end] - vertex_begin[begin] of them; and their faces, whose
 * indices count from the first vertex of part `begin` plus `base`. Threads may
 * call these for different ranges; the results do not depend on the ranges.
 */
void meso_tessellation_vertices(const MesoTessellation *tessellation, uint32_t begin, uint32_t end,
                                MesoMeshVertex *out);
void meso_tessellation_faces(const MesoTessellation *tessellation, uint32_t begin, uint32_t end,
                             uint32_t base, MesoMeshFace *out);

/* P of structure.h for one instance of a swept kind at v in [0,1], with the profile point s(v) in edge lengths. */
MesoVec3 meso_sweep_point(const MesoStructure *structure, const MesoSweepInstance *sweep, MesoVec2 profile, float v);

/* Materials of all parts: sections, then inner meshes. */
uint32_t meso_structure_material_count(const MesoStructure *structure);
const MesoMaterial *meso_structure_material(const MesoStructure *structure, uint32_t material);
/* "interface/section" or "tile/inner N", to `out` of `size` bytes. */
void meso_structure_material_name(const MesoStructure *structure, uint32_t material,
                                  char *out, unsigned size);

#endif
