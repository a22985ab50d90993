/*
 * Scene: what every method ends in, and all that writers and the renderer
 * read: materials, channels of ids with their names, tubes, and bodies where
 * they are placed. It knows no method and no adjacency. It owns nothing; its
 * arrays live in the arenas of whoever made it.
 *
 * A point of an instance of a swept kind, at column c and v in [0,1]:
 *
 *     B(v)    cubic Bezier over p[0..3] (MesoGen, section 3.5)
 *     T(v)    unit lerp(unit B'(u), E(u), m); at the ends exactly direction[0], direction[1]; u is v, and m the mitre,
 *             but for creases
 *     X(v)    by the scene's rule of frames, across T             Y(v) = cross(T, X)
 *     w(v)    v v (3 - 2 v)
 *     R(a)    turns by the angle a, from X to Y
 *     a, b    size[0] c.start, size[1] c.end;   with their middles a', b': size[0] middle[0], size[1] middle[1]
 *     q(v)    lerp(a - a', R(-turn) (b - b'), w)
 *     s(v)    R(twist w) (lerp(a', b', w) + R(turn w) q)
 *     P(v)    B + section_scale * (s.x X + s.y Y)
 *
 * Shapes are blended where they are not turned, and turned then: a section that turns keeps its width. Where nothing
 * turns, s is lerp(a, b, w); at v 1 it is b, in the plane of the end's own up. The normal is n.x X + n.y Y - tilt T
 * made unit, where n is turned like s from the 2D normal that is interpolated like q, and tilt is
 * section_scale / |B'| times dot(n, s'(v)). Where a chord of a section that turns is reversed on the way, its columns'
 * own normals are interpolated between the ends: they stay across it, which those do not that are round at the ends.
 *
 * The rules of frames:
 *
 *     paper      X = unit cross(lerp(up[0], up[1], v), T); twist is 0
 *     minimal    X starts as unit cross(up[0], T) and turns about T no more than it has to: MESO_FRAME_STEPS equal
 *                steps of the double reflection of "Computation of Rotation Minimizing Frames" (Wang et al. 2008),
 *                the last one cut off at v; twist is the angle that is then left to unit cross(up[1], T)
 *
 * A mitre keeps the rings of a bend from crossing that is narrower than the section is wide, where the tube would fold
 * back on itself: E turns evenly, by length, from direction[0] to direction[1], by way of p[3] - p[0] if these are
 * over 120 degrees apart. Where there is one, the normal between the ends lies across the line along the sweep, which
 * is not always that of T: dot(T, P'(v)) n - dot(n, B'(v) + section_scale s'(v)) T made unit.
 *
 * A crease keeps a tube from folding that no mitre does, as its ends lie within each other's sections, or as its frame
 * would flip. Its mitre is MESO_CREASED k + m, with k 1, 2, 3 or 4 and m in [0,1]:
 *
 *     u(v)    v + 2^(1-k) (w(v) - v): with k 1 rings do not turn at the ends; with k 4 w(w(v)): nor next to them
 *     E(u)    also by way of p[3] - p[0] where that is over 90 degrees from an end's direction; in any case it is there
 *             after the part |p[1] - p[0]| of |p[1] - p[0]| + |p[3] - p[2]| of the length, a tenth at least
 *     X(v)    as unit cross(up[0], T), and turned no more than it has to be, in MESO_FRAME_STEPS equal steps straight
 *             from one T to the next, the last one cut off at v, whatever the rule; twist is what is then left
 *     b(v)    section_scale (dot(X, T'), dot(Y, T')) / dot(B', T); rings meet where dot(s, b) is 1
 *
 * and what of s lies inwards, where dot(s, b) > 0, keeps of its length along b only a part: such that the furthest of
 * the section, R from its trajectory, stays at 0.2 + 0.55 t / (1 + t) of that way, where it were at R |b|, which is
 * 0.2 + 0.55 t; all of it where that is below 0.2, and at the ends, which are the neighbours', too: nearer to one than
 * 1/16, of what is not kept the square of the part of that way is. The normal is that of a mitre, frames that turn
 * about T counted in.
 *
 * A cap has the straight axis T = direction[0], X and Y from up[0], s = size[0] start, and
 *
 *     P(v) = p[0] + section_scale * ((1 - v^4) (s.x X + s.y Y) + MESO_CAP_RISE size[0] v T)
 *
 * with the normal MESO_CAP_RISE size[0] (n.x X + n.y Y) + 4 v^3 dot(s, n) T made unit.
 * (The prototype's dome, radius 1 - t^2 and rise sqrt(t) / 8, with t = v^2.)
 *
 * Under MESO_SWEEP_SHAPE all of this happens in a cell, [0,1] x [0,1] x [0,1/2], in units of its edge, and what comes
 * out of it is bent into the sweep's cage (cell.h).
 */
#ifndef MESO_SCENE_H
#define MESO_SCENE_H

#include "libcore/base/arena.h"
#include "libcore/math/box.h"
#include "libcore/math/cage.h"
#include "libcore/math/square.h"
#include "libcore/scene/material.h"

/* Height of a cap over its end, in units of the profiles (the prototype's). */
#define MESO_CAP_RISE 0.125f

/* Steps of the rule of frames that turns least. */
enum { MESO_FRAME_STEPS = 8 };

/* A sweep whose mitre is no less has a crease. */
#define MESO_CREASED 2.0f

/* Its largest k. */
#define MESO_CREASE_EASES 4

/*
 * What tells the parts of a scene apart: "slot" and "tile", "region", "element". Each part has one id in every
 * channel, and so has each pixel of a picture. Ids of channels with names fit in 16 bits in files.
 */
enum { MESO_ID_CHANNELS = 4, MESO_CHANNEL_NAME = 32 };

typedef struct MesoIdChannel {
    const char *name;           /* lower-case letters, digits and '_', under MESO_CHANNEL_NAME bytes */
    uint32_t count;             /* ids are below it */
    const char **names;         /* [count], or NULL: numbers are their own names */
} MesoIdChannel;

/* ---- tubes ---- */

/* One line of vertices along a sweep. */
typedef struct MesoSweepColumn {
    MesoVec2 start, end;                /* profile points at v 0 and 1, in units of the profiles */
    MesoVec2 start_normal, end_normal;  /* outward, as long as the chord that they are normal to */
    float u;                            /* around, in [0,1] */
    uint32_t joins_next;                /* 1 if quads lie between this column and the next */
    uint32_t absent;                    /* bits MESO_ABSENT_*: it has no vertex on such rings */
    uint32_t own;                       /* 1 if it has, between the ends, in place of the normals above, */
    MesoVec2 own_normals[2];            /* the normals at v 0 and 1 of the one chord that it speaks for */
} MesoSweepColumn;

/*
 * Ring r of n + 1 lies at r / n along its sweep's pace. Bowed, what lies between the ends is moved out of the bends, by
 * (P[r] - lerp(P[r - 1], P[r + 1], t)) / 8 of a column's points, of which the middle one lies at t of the way from the
 * one v to the other, so that its chords lie as far outside as inside. The ends stay, and those beside them are
 * MESO_END_NEARER of a step nearer.
 *
 * A ring at an end has the points that its own drawing needs, whatever else the sweep needs between: the next ring's
 * vertices of other columns fan out from the last column before that has one there. So do a ring's own towards the
 * next, where that has no such column. The first and the last column are on all rings.
 */
enum { MESO_ABSENT_START = 1, MESO_ABSENT_END = 2, MESO_ABSENT_BETWEEN = 4 };

/* 1 - sqrt(3) / 2: then a chord that is moved at one end alone is off as far as the next one. */
#define MESO_END_NEARER 0.134f

/* Rings of what is bowed are at most this many. */
enum { MESO_MOST_BOWED = 4096 };

/* Parts of a pace, which runs evenly within each. */
enum { MESO_PACE_PARTS = 16 };

/* Of bits that say how the quads of a sweep are split. */
enum { MESO_LEAN_WORDS = 4 };

/* Sweeps that share their columns. The columns run clockwise around the trajectory. */
typedef struct MesoSweptKind {
    uint32_t column_begin, column_count;
    uint32_t joint_count;               /* columns that join the next between the ends */
    uint32_t division_count;            /* vertices along, at least 2; at least 3 where some are absent */
    bool bowed;                         /* rings lie out of the bends: see there */
    uint32_t absent[3];                 /* columns that have no vertex at the start, at the end, on rings between */
    uint32_t more_joints[2];            /* faces of the first and of the last row, beyond those of others */
    uint32_t fans[2];                   /* that are triangles: their second column is absent on either side */
    uint32_t instance_begin, instance_count;
    uint32_t start_material, end_material;  /* drawn as a blend; files know the first */
    bool cap;
    float turn;                 /* of the section along the sweep, in radians, from X to Y */
    MesoVec2 middle[2];         /* about which it turns, at the start and at the end, in units of the profiles */
} MesoSweptKind;

/* How a sweep is cut up; all 0: evenly, with diagonals from quads' first corners. */
typedef struct MesoSweepSteps {
    uint16_t pace[MESO_PACE_PARTS - 1];     /* v at each part of the steps, of 65536; all 0: even */
    uint64_t leans[MESO_LEAN_WORDS];        /* of meso_sweep_leans() (sweep.h) */
} MesoSweepSteps;

typedef struct MesoSweepInstance {
    MesoVec3 p[4];              /* control points; a cap has p[1..3] along its axis */
    MesoVec3 up[2];             /* of the profile's y direction at both ends; not of unit length */
    MesoVec3 direction[2];      /* unit tangents at both ends, from start to end */
    uint32_t ids;               /* row of the scene's ids */
    float size[2];              /* factor on the profiles at both ends */
    float twist;                /* of the frame along the sweep, in radians; see the rules of frames */
    float mitre;                /* in [0,1]: 0, rings lie across the trajectory; 1, they turn evenly from end to end;
                                 * or a crease */
    uint32_t cage;              /* that its cell is bent into, where sections deform */
    MesoSweepSteps steps;
} MesoSweepInstance;

/*
 * Sweeps that are made whenever they are wanted (sweep_maker.h): a scene of many millions need not hold them. They come
 * in bundles of neighbours; what is made is the same each time, by whichever thread.
 */
enum { MESO_BUNDLE_SWEEPS = 64 };       /* at most */

typedef struct MesoMadeSweep {
    uint32_t sweep, kind;
    MesoSweepInstance instance;
} MesoMadeSweep;

typedef struct MesoSweepMaker {
    void *context;
    uint32_t bundle_count, thread_count;    /* threads that may make bundles; 0: all cores */
    const float *kind_sizes, *kind_radii;   /* [kind_count] as of meso_scene_kind_size(), meso_scene_kind_radius() */
    MesoBox *bundle_boxes;                  /* [bundle_count] around each bundle, from meso_scene_measure() */
    /*
     * Makes a bundle, by numbers in any order, each sweep in one bundle; returns how many. Twists and mitres, which
     * turn sections and rings within what these are hulls of, are 0, until add_turns() finds those of a sweep.
     */
    uint32_t (*make_hulls)(void *context, uint32_t bundle, MesoMadeSweep *out);
    void (*add_turns)(void *context, MesoMadeSweep *sweep);
    void (*make)(void *context, uint32_t sweep, MesoSweepInstance *out);
    uint32_t (*ids)(void *context, uint32_t sweep);   /* row of its ids */
} MesoSweepMaker;

/* How the frame of a sweep turns along it. */
typedef enum MesoFrameRule {
    MESO_FRAME_PAPER,       /* the up vector runs straight from end to end (MesoGen, section 3.5) */
    MESO_FRAME_MINIMAL      /* no more than the trajectory makes it, and what is left smoothly */
} MesoFrameRule;

extern const char *const meso_frame_rule_names[];   /* ended by NULL */

/* What becomes of cross-sections where a slot is not a cell. */
typedef enum MesoSweepDeform {
    MESO_SWEEP_CURVES,     /* they keep their shape: trajectories alone follow the slot (MesoGen, section 3.5) */
    MESO_SWEEP_SHAPE       /* they deform with it, as bodies in cages do */
} MesoSweepDeform;

extern const char *const meso_sweep_deform_names[];       /* ended by NULL */

/* ---- bodies ---- */

typedef struct MesoMeshVertex {
    MesoVec3 position;
    MesoVec3 normal;    /* unit length, outward */
    MesoVec2 uv;        /* of a sweep: u around, v along */
} MesoMeshVertex;

/* Counter-clockwise seen from outside. */
typedef struct MesoMeshFace {
    uint32_t v[4];      /* v[3] is MESO_NO_INDEX for a triangle */
} MesoMeshFace;

/* Linear, 255 for 1; times the material's albedo. */
typedef struct MesoMeshColor {
    uint8_t r, g, b;
} MesoMeshColor;

/* A mesh of triangles and quads. What has several materials or ids is several bodies, which may share arrays. */
typedef struct MesoBody {
    uint32_t vertex_count, face_count;
    uint32_t face_width;            /* 3: triangles; 4: as in MesoMeshFace */
    const MesoVec3 *positions;      /* [vertex_count] */
    const MesoVec3 *normals;        /* [vertex_count] unit length */
    const MesoVec2 *uvs;            /* [vertex_count], or NULL: all 0 */
    const MesoMeshColor *colors;    /* [vertex_count], or NULL: all white */
    const uint32_t *corners;        /* [face_width * face_count] */
} MesoBody;

/* Rows of a 3 x 4 matrix. */
typedef struct MesoFrame {
    float m[12];
} MesoFrame;

typedef enum MesoPlace {
    MESO_PLACED_HERE,       /* where the body's own coordinates say */
    MESO_PLACED_IN_FRAME,   /* under an affine frame */
    MESO_PLACED_IN_CAGE     /* under a frame into [0,1] x [0,1] x [0,1/2], turned there, and bent into a cage */
} MesoPlace;

typedef struct MesoPlacedBody {
    uint32_t body, material;
    uint32_t ids;           /* row of the scene's ids */
    uint32_t frame, cage;   /* where the place has them */
    MesoPlace place;
    MesoTransform turn;     /* in the cage */
} MesoPlacedBody;

/* ---- scenes ---- */

typedef struct MesoScene {
    uint32_t channel_count, material_count;
    MesoIdChannel channels[MESO_ID_CHANNELS];
    MesoMaterial *materials;        /* [material_count] */
    const char **material_names;    /* [material_count] */
    uint32_t id_row_count;
    uint32_t *ids;                  /* [id_row_count * channel_count], row by row */

    float section_scale;            /* scene units of one unit of the profiles */
    MesoFrameRule frame_rule;       /* of all sweeps, */
    MesoSweepDeform deform;              /* and of bodies in cages, too */
    float thickness;                /* of the layer that the scene makes, for ambient occlusion; 0: it is none */
    uint32_t kind_count, column_count, sweep_count;
    MesoSweptKind *kinds;           /* [kind_count] */
    MesoSweepColumn *columns;       /* [column_count] */
    MesoSweepInstance *sweeps;      /* [sweep_count] by kind; NULL where there is */
    const MesoSweepMaker *maker;    /* one that makes them, for those who ask for such scenes */

    uint32_t body_count, placed_count, frame_count, cage_count;
    MesoBody *bodies;               /* [body_count] */
    MesoPlacedBody *placed;         /* [placed_count] */
    MesoFrame *frames;              /* [frame_count] */
    MesoCage *cages;                /* [cage_count] */

    MesoBox box;                    /* around everything, from meso_scene_measure() */
} MesoScene;

/* Fills in the box: around all control points, widened by the profiles, cages and bodies. O(sweeps + vertices). */
void meso_scene_measure(MesoScene *scene);

/* The same by so many threads (0: all cores); the box is the same for any number. */
void meso_scene_measure_by(MesoScene *scene, uint32_t thread_count);

/* Kind of a sweep. O(log kinds). */
uint32_t meso_scene_kind(const MesoScene *scene, uint32_t sweep);

/*
 * The largest distance of a kind's profile from its trajectory, in scene units, or in units of the cell where sections
 * deform. O(columns + instances).
 */
float meso_scene_kind_radius(const MesoScene *scene, const MesoSweptKind *kind);

/* The largest size of a kind's instances. */
float meso_scene_kind_size(const MesoScene *scene, const MesoSweptKind *kind);

/* Id of a row in a channel. */
static inline uint32_t meso_scene_id(const MesoScene *scene, uint32_t row, uint32_t channel)
{
    return scene->ids[(size_t)row * scene->channel_count + channel];
}

/* True if some body has colours of its own: files then have them for all vertices. O(bodies). */
bool meso_scene_is_colored(const MesoScene *scene);

#endif
