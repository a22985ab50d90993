/*
 * Tile set: interfaces with their cross-sections, and tiles with their sweeps
 * (MesoGen, section 3.2). Plain arrays; built by the readers in formats/,
 * checked by meso_tile_set_check() (tile_set_check.h), then only read.
 */
#ifndef MESO_TILE_SET_H
#define MESO_TILE_SET_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"
#include "libcore/scene/material.h"
#include "libcore/tiling/tile/label.h"

/*
 * Sides of a tile. 0 +X, 1 +Y, 2 -X, 3 -Y; corner i is where side i starts:
 * (1,0), (1,1), (0,1), (0,0) in the tile's unit square. Sides 4 and 5 are
 * the top and the bottom of the shell: they carry sweeps and take no part in
 * tiling.
 */
enum { MESO_SIDE_TOP = 4, MESO_SIDE_BOTTOM = 5, MESO_SIDE_COUNT = 6 };

/* Levels of a drawing; a chain a + b + c + ... to the left counts as one. */
enum { MESO_CSG_NESTING = 64 };

typedef enum MesoCsgKind {
    MESO_CSG_DISC,          /* ellipse inscribed in the box of `size` */
    MESO_CSG_UNION,
    MESO_CSG_DIFFERENCE,    /* left without right */
    MESO_CSG_BOX
} MesoCsgKind;

/* Node of a drawing. `center`, `size`, `angle` are of discs and boxes, `left` and `right` of the rest. */
typedef struct MesoCsgNode {
    MesoCsgKind kind;
    uint32_t left, right;   /* nodes; always smaller than the node's own index */
    MesoVec2 center;        /* in the interface's unit square: x along the side, y up through the shell */
    MesoVec2 size;          /* full extents, in edge lengths */
    float angle;            /* radians, counter-clockwise */
} MesoCsgNode;

/* One closed region of an interface's drawing. */
typedef struct MesoSection {
    const char *name;       /* unique within its interface */
    uint32_t interface;
    uint32_t csg_root;
    MesoMaterial material;
} MesoSection;

typedef struct MesoInterface {
    const char *name;       /* unique */
    uint32_t section_begin, section_count;
    float color[3];         /* for schemes and previews */
    bool border_exempt;     /* never on a side without neighbour */
    bool border_only;       /* only there */
} MesoInterface;

typedef struct MesoSweep {
    uint32_t from_side, to_side;
    uint32_t from_section, to_section;  /* into the set's sections */
    bool half_turn;                     /* turns the end section by half a turn */
    float turn;                         /* and by this much more, in turns [0,1) */
    int32_t turns;                      /* whole turns more along the way, [-64,64]; they change no end */
    float tangent_scale;                /* factor on the handles of its trajectories; 0 stands for 1 */
} MesoSweep;

/* A mesh of the artist's that a tile carries along. */
typedef struct MesoInnerMesh {
    const char *file;       /* relative to the tile set's folder; "" for none */
    float transform[12];    /* row-major 3 x 4, mesh to tile: [0,1] x [0,1] x [0,1/2], the
                               shell being half an edge length high, as in drawings */
    MesoMaterial material;
} MesoInnerMesh;

typedef struct MesoTile {
    const char *name;       /* unique */
    uint32_t side_count;    /* 4 or 6 */
    /* See label.h; 0 on sides 4 and 5 only. Sides from side_count on are 0. */
    int32_t labels[MESO_SIDE_COUNT];
    uint32_t sweep_begin, sweep_count;
    uint32_t inner_begin, inner_count;
    float tangent_scale;                /* on those of all its sweeps; 0 stands for 1 */
    bool rotation, flip_x, flip_y;      /* transforms that it allows */
    bool ignored;                       /* kept in the set, not used in tilings */
} MesoTile;

typedef struct MesoTileSet {
    uint32_t interface_count, section_count, csg_count;
    uint32_t tile_count, sweep_count, inner_count;
    MesoInterface *interfaces;
    MesoSection *sections;
    MesoCsgNode *csg;
    MesoTile *tiles;
    MesoSweep *sweeps;
    MesoInnerMesh *inners;
    bool default_rotation, default_flip_x, default_flip_y;  /* for tiles to come */
} MesoTileSet;

#endif
