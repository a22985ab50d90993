/* A pattern carried out: the surface cut, its regions in a tree. */
#ifndef MESO_DECOR_H
#define MESO_DECOR_H

#include "libcore/decor/pattern.h"
#include "libcore/decor/region/region_tree.h"
#include "libcore/geodesic/geodesic.h"

typedef struct MesoDecorOptions {
    uint64_t seed;
    MesoGeodesicEngine engine;
    uint32_t threads;           /* 0: all cores */
    uint32_t step_limit;        /* operations after which it ends; 0: none */
    uint32_t region_limit;      /* MESO_ERR_LIMIT beyond */
    uint64_t triangle_limit;    /* MESO_ERR_LIMIT beyond */
    void (*progress)(void *context, uint64_t done, uint64_t total);
    /* A step that had nothing to do, or did less than it says, and why; NULL: nobody wants to know. */
    void (*note)(void *context, const char *place, const char *text);
    void *context;
} MesoDecorOptions;

typedef struct MesoDecor {
    MesoTriangulation mesh;     /* cut and moved; owned */
    MesoRegionTree tree;        /* in the arena */
    uint32_t operation_count;   /* splits, displacements and paintings that were done */
    const MesoPolygonMesh *surface; /* that the mesh was made of, for seeds by its faces; NULL: there are none */
    MesoArena *arena;           /* of tree and lines */
    bool keep_lines;            /* of the caller's: whether `lines` are wanted */
    MesoVec3 *lines;            /* [2 * line_count] ends of all segments along which was cut, in order */
    uint32_t *line_steps;       /* [line_count] the operation */
    uint32_t line_count, line_room;
} MesoDecor;

/*
 * Carries out a pattern on decor->mesh, which the caller has made (meso_triangulation_init()) and releases. Leaves
 * of the tree partition the surface, each is connected, and its border is closed loops; the mesh is as watertight as
 * it was. The same result for any number of threads. MESO_ERR_LIMIT where a limit is met; MESO_ERR_INPUT with the
 * step's place where it asks for what cannot be; MESO_ERR_MEMORY. On failure mesh and tree are of no use.
 */
MesoStatus meso_decor_run(MesoDecor *decor, MesoArena *arena, const MesoPattern *pattern,
                          const MesoDecorOptions *options, MesoError *error);

#endif
