/*
 * Inspection: everything that can be wrong with triangles, whoever made them, and where. It knows no method and takes
 * nobody's word: what belongs together it finds itself, by positions that are the same floats.
 */
#ifndef MESO_INSPECTION_H
#define MESO_INSPECTION_H

#include "libcore/base/arena.h"
#include "libcore/base/index.h"
#include "libcore/math/box.h"

typedef struct MesoInspectedMesh {
    uint32_t vertex_count, triangle_count, normal_count;
    const MesoVec3 *positions;      /* [vertex_count] */
    const MesoVec3 *normals;        /* [normal_count], or NULL: it has none */
    const uint32_t *corners;        /* [3 * triangle_count] vertices */
    const uint32_t *normal_of;      /* [3 * triangle_count] normals, or MESO_NO_INDEX; NULL: those of the vertices */
    const uint32_t *slots;          /* [triangle_count] below MESO_NO_INDEX; NULL: it has none */
    const uint32_t *things;         /* the same of strands or elements; NULL: its pieces are these */
    uint32_t cage_count;
    const MesoVec3 *cages;          /* [8 * cage_count] the slots' hexahedra: around the bottom, then around the top */
    const uint32_t *across;         /* [4 * cage_count] the slot beyond each side, from bottom corner k to the next, or
                                     * MESO_NO_INDEX at a border */
} MesoInspectedMesh;

/*
 * What can be wrong. A joint is an edge of two triangles; a ring is a run of open edges of one slot; a piece hangs
 * together by joints; a thing is a strand or an element, or a piece where there are no ids.
 */
typedef enum MesoFault {
    MESO_FAULT_GAP,             /* rings of two slots that face each other; the distance of their points */
    MESO_FAULT_ANGLE,           /* joints of two slots; between the normals at their ends, in degrees */
    MESO_FAULT_OPEN,            /* rings */
    MESO_FAULT_BORDER,          /* of these, at a side of their hexahedron with no slot beyond it */
    MESO_FAULT_LID,             /* and at its top or bottom */
    MESO_FAULT_LEAK,            /* things with open edges */
    MESO_FAULT_T_JOINT,         /* ends of open edges within another open edge */
    MESO_FAULT_WINDING,         /* joints whose triangles are wound against each other */
    MESO_FAULT_INVERTED,        /* other triangles wound against the normals of all their corners */
    MESO_FAULT_PINCH,           /* triangles that are turned over as the surface folds back: normals go on there */
    MESO_FAULT_NORMAL,          /* other corners whose normal is behind their triangle, or has no length */
    MESO_FAULT_INSIDE_OUT,      /* closed pieces with a negative volume */
    MESO_FAULT_NUMBER,          /* triangles with a position or a normal that is not finite */
    MESO_FAULT_FLAT,            /* triangles without area */
    MESO_FAULT_DOUBLE,          /* triangles that are there before, wound either way */
    MESO_FAULT_BRANCH,          /* edges of more than two triangles where sweeps of one slot share a cross-section */
    MESO_FAULT_EDGE,            /* other edges of more than two triangles */
    MESO_FAULT_VERTEX,          /* places where several fans of triangles meet */
    MESO_FAULT_FOLD,            /* hexahedra that are turned inside out at a corner */
    MESO_FAULT_CROSSING,        /* pairs of things that cut through each other; how deep */
    MESO_FAULT_SELF_CROSSING,   /* pairs of triangles of one thing that do; how deep */
    MESO_FAULT_THIN,            /* places over something thinner than asked; the thinnest of all */
    MESO_FAULT_FLOATING,        /* pieces whose boxes hang together with most of the area by no chain of boxes */
    MESO_FAULT_COUNT
} MesoFault;

/* Names as in reports and marks: "gap", "self-crossing". */
extern const char *const MESO_FAULT_NAMES[MESO_FAULT_COUNT];

typedef struct MesoFinding {
    uint64_t count;
    double worst;               /* the largest, but for what is thin; 0 where the fault has no size */
    uint32_t triangle;          /* of the worst, or else of the first; MESO_NO_INDEX: none */
    uint32_t cage;              /* the same of a hexahedron */
} MesoFinding;

/* Two things that cut through each other; a < b. */
typedef struct MesoCrossingPair {
    uint32_t a, b;              /* as in `things` of the mesh; or pieces */
    uint64_t triangle_pairs;
    double depth;
    uint32_t triangle;          /* of a, the first */
} MesoCrossingPair;

typedef struct MesoInspectionOptions {
    uint32_t thread_count;      /* 0: all cores; no effect on the result */
    double thinnest;            /* what is thinner is a fault; 0: nothing is */
    bool crossings, thickness;  /* whether to look for these, which take most of the time */
} MesoInspectionOptions;

typedef struct MesoInspection {
    MesoFinding findings[MESO_FAULT_COUNT];
    uint32_t *marks;            /* [triangle_count] bits by fault */
    uint32_t pair_count;
    MesoCrossingPair *pairs;    /* [pair_count] ascending */

    uint32_t vertex_count;      /* places: vertices at one position are one */
    uint32_t piece_count, thing_count, closed_count;    /* things without open edges */
    uint64_t open_edges, slot_joints;
    uint32_t facing_rings;      /* rings that have one of another slot over against them: joints that are torn */
    MesoBox box;                /* around what is finite */
    double area, volume;        /* of the whole; the volume means something where all is closed */
    double shortest_edge, longest_edge, mean_edge;
    double thinnest, usual_thickness;   /* 0: not measured */
} MesoInspection;

/*
 * Inspects a mesh whose indices are in range. Positions that are the same floats are one place, and what meets there
 * is joined; triangles that have no area by their indices, or are there twice, are reported and then left out.
 *
 * Continuity: rings of two slots are paired where each is the other's nearest, they end in opposite directions, and lie
 * side by side no further apart than half of what their slots hold is wide, or end to end within half their own size.
 * The gap is the largest distance of a point of one from the other's line. Where there are hexahedra, rings that lie at
 * a lid or a border have no other side: these end as they are drawn, and are counted apart. A ring lies at a face of
 * its hexahedron that is within 60 degrees of where it ends, and within a twentieth of the ring's size.
 * Branches: the triangles of an edge are of one slot or two, and of as many parts, by the vertices that these share as
 * the mesh has them: each ends there. Their normals are compared as those of joints.
 * Pinches: triangles against their normals that hang together are the surface turned over, as that of a tube on the
 * inner side of a narrow bend, where along their outline there are more edges at which triangles turn by over 90
 * degrees and normals by less than the other way round, or with triangles that are wound against each other.
 * Crossings: triangles of which a side of one goes through the inside of the other, by more than the coordinates'
 * rounding; those that share a place only touch. The depth is how far below the surface of the one the other's
 * vertices get, followed inwards from where they cut through each other, over 32 triangles of each at most, fewer
 * where there are hundreds of pairs: it may be deeper.
 * Thickness: from each place (of those that lie within a sixteenth of the usual thickness, the first) inwards, along
 * the mean normal of its triangles, to the first triangle of the same piece that looks the other way.
 *
 * `marks` and `pairs` go to `arena`. O(n log n) and some 150 bytes a triangle, as long as triangles are small beside
 * the whole; the same for any number of threads. MESO_ERR_LIMIT for over 2^30 triangles; MESO_ERR_MEMORY.
 */
MesoStatus meso_inspect(MesoInspection *inspection, MesoArena *arena, const MesoInspectedMesh *mesh,
                        const MesoInspectionOptions *options, MesoError *error);

/* A triangle's middle, for messages. */
MesoVec3 meso_inspected_middle(const MesoInspectedMesh *mesh, uint32_t triangle);

#endif
