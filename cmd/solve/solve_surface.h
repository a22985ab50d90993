/* The surface of a solve: its slot graph, with the slots oriented as --orient says. */
#ifndef MESO_SOLVE_SURFACE_H
#define MESO_SOLVE_SURFACE_H

#include "cmd/common/surface_judge.h"
#include "cmd/common/tool.h"
#include "libcore/mesh/slot_graph.h"
#include "libcore/mesh/surface.h"

typedef struct MesoOrientArguments {
    const char *how;
    bool given;
} MesoOrientArguments;

#define MESO_ORIENT_DEFAULTS {"file", false}

#define MESO_ORIENT_OPTION(orient)                                                            \
    MESO_TEXT(0, "orient", "HOW", \
              "which side of a slot is direction 0: file (the first of its face, default), comb (as the " \
              "neighbours), field=ATTRIBUTE (along a vector attribute of a PLY), u,v (along u)", \
              &(orient).how, .given = &(orient).given)

/* Singular corners that a report lists. */
enum { MESO_REPORT_SINGULAR = 1000 };

typedef struct MesoSolveSurface {
    MesoSurface file;           /* as the file has it, with all attributes; wound alike */
    MesoQuadMesh mesh;          /* corners and */
    MesoSlotGraph graph;        /* sides as oriented */
    uint8_t *quarters;          /* [slot_count] see orientation.h; NULL: as in the file */
    uint8_t *over;              /* [slot_count] see mesh_wind.h; NULL: neighbours agree in the file */
    uint64_t hash[2];           /* of the file */
} MesoSolveSurface;

/* Whether it is one of the above. MESO_ERR_USAGE. */
MesoStatus meso_orient_check(const MesoOrientArguments *orient, MesoError *error);

typedef struct MesoSurfaceWish {
    const char *path;
    MesoOrientArguments orient;
    const MesoTileSet *set;     /* that will be grown on it */
    bool strict;                /* see surface_judge.h */
    bool pairs;                 /* two triangles in a row are a quad */
} MesoSurfaceWish;

/*
 * Reads a surface, notes it in the provenance, gives it one side, builds its slot graph, judges
 * it and orients it. Where `orient` is given, says in one line what remains of disagreement,
 * and puts it in the report as "orientation".
 */
MesoStatus meso_tool_read_surface(MesoTool *tool, const MesoSurfaceWish *wish, MesoSolveSurface *surface);

#endif
