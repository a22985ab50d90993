/*
 * Model: tile set, macrosurface, assignment and mapping options, the compact
 * procedural form of a mesostructure (MesoGen, section 3.2). It owns nothing;
 * its parts live in the arenas of whoever made them.
 */
#ifndef MESO_MODEL_H
#define MESO_MODEL_H

#include "libcore/mesh/quad_mesh.h"
#include "libcore/mesh/slot_graph.h"
#include "libcore/mesh/triangle_mesh.h"
#include "libcore/scene/scene.h"
#include "libcore/shell/shell_form.h"
#include "libcore/tiling/problem/assignment.h"
#include "libcore/tiling/tile/tile_set.h"

/* What the section scale is the length of. */
typedef enum MesoSectionSize {
    MESO_SECTION_SCENE,     /* one edge length in the drawings, everywhere */
    MESO_SECTION_SLOT       /* the same on slots of mean size; sections grow and shrink with their slots */
} MesoSectionSize;

extern const char *const meso_section_size_names[];     /* ended by NULL */

/* What becomes of tubes in bends that are narrower than they are wide. */
typedef enum MesoBends {
    MESO_BENDS_MITRED,      /* they do not fold back on themselves, as far as that can be (scene.h) */
    MESO_BENDS_DRAWN        /* they do, as drawn (MesoGen) */
} MesoBends;

extern const char *const meso_bends_names[];    /* ended by NULL */

/* What a tolerance is measured in. */
typedef enum MesoToleranceUnit {
    MESO_TOLERANCE_EDGE,    /* the mean edge length of the surface */
    MESO_TOLERANCE_SCENE    /* scene units */
} MesoToleranceUnit;

extern const char *const meso_tolerance_unit_names[];   /* ended by NULL */

/* Bounds of a tolerance that is not 0, in edge lengths; in scene units it may be any length. */
#define MESO_TOLERANCE_LEAST 1e-5f
#define MESO_TOLERANCE_MOST 1.0f

/* Lengths in scene units. Zero (or negative) lengths stand for the default in brackets. */
typedef struct MesoMapOptions {
    float thickness;        /* height of the shell is half of it [mean edge length] */
    float offset;           /* of the shell's bottom along the normals; 0 is the default */
    float section_scale;    /* length of one edge length in the drawings [mean edge length] */
    float tangent_scale;    /* factor on the handles of trajectories [1] */
    float section_step;     /* sampling step of contours in edge lengths [0.02] */
    uint32_t divisions;     /* vertices along a sweep [12], at least 2 */
    uint32_t normals;       /* MesoShellNormals */
    uint32_t side;          /* MesoShellSide */
    uint32_t limit_folds;   /* 1: the shell is lowered where it would fold */
    uint32_t frame;         /* a MesoFrameRule (scene.h) */
    uint32_t section_size;  /* a MesoSectionSize */
    float tolerance;        /* of steps along and around, instead of divisions and section step; 0 is none */
    uint32_t tolerance_in;  /* a MesoToleranceUnit */
    uint32_t deform;        /* a MesoSweepDeform (scene.h) */
    uint32_t bends;         /* a MesoBends */
    uint32_t relax;         /* steps of relaxation (relax.h), at most MESO_RELAX_MOST; 0: none */
} MesoMapOptions;

enum { MESO_RELAX_MOST = 10000 };

/* How far the joints of a relaxed model are from where they were: a MesoWallMove in whole numbers. */
typedef struct MesoJointMove {
    int16_t along, rise;            /* of 1 / MESO_JOINT_PLACES */
    int16_t lean_along, lean_rise;  /* of 1 / MESO_JOINT_LEANS */
} MesoJointMove;

enum { MESO_JOINT_PLACES = 32767, MESO_JOINT_LEANS = 16384 };

/* Bounds of the factors and the lifts of a shell's vertices. */
#define MESO_FACTOR_LEAST 1e-4f
#define MESO_FACTOR_MOST 1e4f
#define MESO_LIFT_MOST (4 * MESO_COORDINATE_LIMIT)

typedef struct MesoModel {
    MesoTileSet tile_set;
    MesoQuadMesh surface;
    MesoSlotGraph graph;                /* of the surface */
    MesoAssignment assignment;
    MesoMapOptions options;
    MesoJointMove *joints;              /* [joint_count] by their numbers (strand_joints.h), or NULL: none has moved */
    uint32_t joint_count;               /* where they have */
    float *factors, *lifts;             /* [surface.vertex_count] of the shell (shell_form.h), or NULL */
    MesoTriangleMesh *inner_meshes;     /* [tile_set.inner_count], empty where there is none */
} MesoModel;

/*
 * Name of the first of the resolved options that no geometry can be made with,
 * or NULL: lengths under MESO_SHORTEST_EDGE or over 4 MESO_COORDINATE_LIMIT,
 * tangent scales outside [1e-6, 1e3], section steps outside [1e-4, 1],
 * divisions outside [2, 4096], rules that there are not, and what is not a number.
 */
const char *meso_map_options_problem(const MesoMapOptions *options);

/* The tolerance of resolved options in scene units, or 0, for a surface of that mean edge length; within its bounds. */
float meso_map_options_tolerance(const MesoMapOptions *options, float mean_edge_length);

/* `options` with every default filled in from the mean edge length. */
MesoMapOptions meso_map_options_resolve(MesoMapOptions options, float mean_edge_length);

/* Whether sweeps have the same trajectories and sections under both: all but the steps that they are cut up by. */
bool meso_map_options_same_form(const MesoMapOptions *a, const MesoMapOptions *b);

/* The model's shell, with its options resolved; what it needs lives in `arena`. MESO_ERR_MEMORY alone. */
MesoStatus meso_model_shell(MesoShell *shell, MesoArena *arena, const MesoModel *model, MesoError *error);

#endif
