/* What recipes for swatches make their meshes with. */
#ifndef MESO_SWATCH_MAKER_H
#define MESO_SWATCH_MAKER_H

#include "libcore/base/random.h"
#include "libcore/quilt/swatch/swatch_make.h"
#include "libcore/scene/material.h"

typedef struct MesoMakerMaterial {
    const char *name;
    MesoMaterial look;
} MesoMakerMaterial;

/* A mesh that grows; nothing grows once memory is out. */
typedef struct MesoSwatchMaker {
    MesoSwatchRecipe recipe;    /* with nothing that is left out */
    MesoRandom random;
    const MesoMakerMaterial *materials;
    uint32_t material_count;

    MesoArena *scratch;
    MesoError *error;
    MesoStatus status;
    uint32_t vertex_count, face_count, corner_count;
    size_t vertex_room, face_room, corner_room;
    MesoVec3 *positions;        /* [vertex_count] */
    uint32_t *corners;          /* [corner_count] */
    MesoVec2 *uvs;              /* [corner_count] */
    uint32_t *face_end;         /* [face_count] where its corners end */
    uint32_t *material_of;      /* [face_count] */
} MesoSwatchMaker;

/* A recipe: what is left out becomes `usual`; `make` adds the elements. */
typedef struct MesoSwatchMethod {
    MesoSwatchRecipe usual;
    uint32_t columns_multiple, rows_multiple, least_multiple;   /* without jitter: so many times these, or more */
    const MesoMakerMaterial *materials;
    uint32_t material_count;
    void (*make)(MesoSwatchMaker *maker);
} MesoSwatchMethod;

extern const MesoSwatchMethod meso_swatch_strand_methods[3], meso_swatch_ring_methods[3],
    meso_swatch_leaf_methods[2], meso_swatch_fruit_methods[1];

/* The new vertex. */
uint32_t meso_maker_vertex(MesoSwatchMaker *maker, double x, double y, double z);

/* A face of four sides, or of three where v[3] is MESO_NO_INDEX. */
void meso_maker_face(MesoSwatchMaker *maker, const uint32_t v[4], const MesoVec2 uv[4], uint32_t material);

/*
 * Quads between `rings` rings of `sides` vertices each that begin at `first`, ring by ring, each counter-clockwise
 * as seen from where the rings go to; `closed`: and from the last to the first.
 */
void meso_maker_tube(MesoSwatchMaker *maker, uint32_t first, uint32_t rings, uint32_t sides, bool closed,
                     uint32_t material);

/* Triangles from a ring to the vertex `tip`, in front of it (`ahead`: where the rings go to) or behind. */
void meso_maker_fan(MesoSwatchMaker *maker, uint32_t ring, uint32_t sides, uint32_t tip, bool ahead, uint32_t material);

/* A random number from -1 to 1, times the jitter. */
double meso_maker_jitter(MesoSwatchMaker *maker);

/* The same, but at most `most` either way. */
double meso_maker_stray(MesoSwatchMaker *maker, double most);

/* The mesh in `arena`, with its attributes. MESO_ERR_MEMORY alone. */
MesoStatus meso_maker_finish(MesoPolygonMesh *mesh, MesoArena *arena, const MesoSwatchMaker *maker, MesoError *error);

#endif
